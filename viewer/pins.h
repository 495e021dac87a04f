// Nodes of a scene: joints at a point, of all the beams that meet there.
#pragma once

#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/plane.h"

namespace ductile::viewer {

/// Joins these instead: two or more.
void set_bodies(JointBetweenDef& joint, const std::vector<std::string>& names);

/// The node at a point as it is to be: of the static bodies and the beams there, and of what else it held
/// before; one where there were several. Beams that cross pass each other where none ends. What it was
/// limited to stays.
void pin(SceneDef& scene, Point at);

}  // namespace ductile::viewer
