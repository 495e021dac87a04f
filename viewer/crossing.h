// A goal for who designs a level: a vehicle of a given weight gets across what moves.
#pragma once

#include <string>

#include "workbench.h"

namespace ductile::viewer {

/// Runs the scene from its start with a vehicle on top of the left end of what moves and is touched, which
/// drives to the right end. False, with a message, where there is nothing to drive on.
bool send_across(Workbench& bench, double mass, double size, double speed);

/// How far the vehicle of a frame is, for the user; empty where there is none.
std::string crossing_text(const Frame& frame);

}  // namespace ductile::viewer
