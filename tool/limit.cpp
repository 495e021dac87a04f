#include "command.h"

namespace ductile::tool {

void add_limit(CLI::App& app, std::string&) {
  CLI::App* command = app.add_subcommand("limit", "Collapse load factor and hinges by limit analysis");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile limit"); });
}

}  // namespace ductile::tool
