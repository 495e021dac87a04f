#include "command.h"

namespace ductile::tool {

void add_view(CLI::App& app, std::string&) {
  CLI::App* command = app.add_subcommand("view", "The window");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile view"); });
}

}  // namespace ductile::tool
