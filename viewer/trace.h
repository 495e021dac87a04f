// What a test wants to know of a frame.
#pragma once

#include <string>

#include "desk.h"

namespace ductile::viewer {

/// The state of the bench, and where everything is on the screen, px: a line of JSON.
std::string trace_of(Workbench& bench, const Desk& desk);

}  // namespace ductile::viewer
