// Nodes of a scene: joints at a point, of all the beams that meet there.
#pragma once

#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "geometry.h"

namespace ductile::viewer {

std::vector<std::string> bodies_of(const JointBetweenDef& joint);
/// `names`: two or more.
void set_bodies(JointBetweenDef& joint, const std::vector<std::string>& names);

/// The node at a point as it is to be: of the static bodies and the beams there, and of what else it held
/// before; one where there were several. Beams that cross pass each other where none ends. What it was
/// limited to stays.
void pin(SceneDef& scene, Point at);

}  // namespace ductile::viewer
