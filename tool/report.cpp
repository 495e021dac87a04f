#include "command.h"

namespace ductile::tool {

void add_report(CLI::App& app, std::string&) {
  CLI::App* command =
      app.add_subcommand("report", "Error against run time, stability, what was left out: a page with plots");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile report"); });
}

}  // namespace ductile::tool
