#include "command.h"

namespace ductile::tool {

void add_simulate(CLI::App& app, std::string&) {
  CLI::App* command =
      app.add_subcommand("simulate", "Run a scene and report forces, usage, damage and energy");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile simulate"); });
}

}  // namespace ductile::tool
