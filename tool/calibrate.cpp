#include "command.h"

namespace ductile::tool {

void add_calibrate(CLI::App& app, std::string&) {
  CLI::App* command = app.add_subcommand("calibrate", "Split a scene's bodies and calibrate their joints");
  command->allow_extras();
  command->callback([] { throw NotYet("ductile calibrate"); });
}

}  // namespace ductile::tool
