// What is wrong with a scene before anything is made of it: numbers that a field may not hold, names that are
// taken or not there, fields that contradict each other.
#pragma once

#include <string>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile::calibration {

/// All of it, in the order of the scene.
std::vector<Problem> wrong_with(const SceneDef& scene);

/// What problems call a body.
std::string body_place(const BodyDef& body);

}  // namespace ductile::calibration
