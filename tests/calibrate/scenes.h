// Scenes that several tests use.
#pragma once

#include "ductile/calibrate.h"

namespace ductile {

inline const Material test_steel{
    .yield_stress = 350e6, .youngs_modulus = 210e9, .density = 7800, .fracture_strain = 0.2};

inline Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// 20 m × 1 m × 1 m of steel that sticks out of a wall at x = 0.
inline SceneDef cantilever(int pieces) {
  SceneDef scene;
  scene.bodies.push_back(
      {.name = "wall", .type = BodyType::static_body, .outline = {rectangle(-1, -1, 0, 2), {}}});
  scene.bodies.push_back({.name = "beam",
                          .outline = {rectangle(0, 0, 20, 1), {}},
                          .material = test_steel,
                          .pieces = pieces,
                          .along = {Point{0, 0.5}, Point{20, 0.5}}});
  scene.joints.push_back({.a = "wall", .b = "beam"});
  return scene;
}

}  // namespace ductile
