#include "command.h"

namespace ductile::tool {

void add_check(CLI::App& app, std::string&) {
  CLI::App* command =
      app.add_subcommand("check", "Static utilisation of every joint under the scene's loads");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile check"); });
}

}  // namespace ductile::tool
