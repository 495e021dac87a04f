// Scenes for the tests of the workbench.
#pragma once

#include "ductile/calibrate.h"

namespace ductile::viewer {

/// A steel bar of 10 × 1 × 1 m in `pieces`, held by a wall at its left end, whose root yields where `moment`
/// is below its own weight's 4e6 N m.
inline SceneDef cantilever(int pieces, double moment, double max_rotation = unlimited) {
  BodyDef wall, bar;
  wall.name = "wall";
  wall.type = BodyType::static_body;
  wall.outline.outer = {{-1, -1}, {0, -1}, {0, 2}, {-1, 2}};
  bar.name = "bar";
  bar.outline.outer = {{0, 0}, {10, 0}, {10, 1}, {0, 1}};
  bar.material = Material{.yield_stress = 400e6, .youngs_modulus = 200e9, .density = 8000};
  bar.pieces = pieces;
  SceneDef scene;
  scene.gravity = {0, -10};
  scene.bodies = {wall, bar};
  scene.joints = {{.a = "wall", .b = "bar", .overrides = {.moment = moment, .max_rotation = max_rotation}}};
  scene.joint.elastic = Elasticity::rigid;
  return scene;
}

}  // namespace ductile::viewer
