// What a body is to be for the loads that the scene has. Knows neither window nor pointer.
#pragma once

#include <string>

#include "ductile/calibrate.h"

namespace ductile::viewer {

struct Sized {
  SceneDef scene;
  std::string what;  ///< for the user: what the body has become, and what decides it
};

/// The scene in which a body is as deep as it must be so that the factor on all loads that brings the first
/// joint to yield is `reserve`; a beam of a rolled profile is of the lightest of its series with at least
/// that reserve. Throws InvalidInput where none does.
Sized with_reserve(const SceneDef& scene, const std::string& body, double reserve);

}  // namespace ductile::viewer
