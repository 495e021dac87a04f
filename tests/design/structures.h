// Bars of 1 m depth on their centre lines, for which beam theory has closed forms.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

inline Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// E I = 210e9/12 · h³, M_p = 350e6/4 · h².
inline const Material test_steel{.yield_stress = 350e6, .youngs_modulus = 210e9, .density = 7800};

/// A beam from (0, 0) to (length, 0), `height` high, in so many pieces, that no wall holds yet.
inline BodyDef beam(int pieces, double length = 20, double height = 1) {
  return {.name = "beam",
          .outline = {rectangle(0, -height / 2, length, height / 2), {}},
          .material = test_steel,
          .pieces = pieces,
          .along = {Point{0, 0}, Point{length, 0}}};
}
inline constexpr double plastic_moment = 350e6 / 4;  // of that beam, 1 m high

inline BodyDef wall(const std::string& name, double x0, double x1) {
  return {.name = name, .type = BodyType::static_body, .outline = {rectangle(x0, -2, x1, 2), {}}};
}

/// No weight, and bending alone yields.
inline SceneDef bending_only() {
  SceneDef scene;
  scene.gravity = {};
  scene.joint.axial = scene.joint.shear = unlimited;
  scene.joint.max_rotation = unlimited;
  return scene;
}

inline SceneDef cantilever(int pieces, double tip_load) {
  SceneDef scene = bending_only();
  scene.bodies = {wall("wall", -1, 0), beam(pieces)};
  scene.joints = {{.a = "wall", .b = "beam"}};
  scene.loads = {{.body = "beam", .at = {20, 0}, .force = {0, -tip_load}}};
  return scene;
}

inline SceneDef simply_supported(int pieces, double load) {
  SceneDef scene = bending_only();
  scene.bodies = {beam(pieces)};
  scene.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true},
                    {.body = "beam", .at = {20, 0}, .fix_y = true}};
  scene.loads = {{.body = "beam", .at = {10, 0}, .force = {0, -load}}};
  return scene;
}

inline SceneDef fixed_fixed(int pieces, double load) {
  SceneDef scene = bending_only();
  scene.bodies = {wall("left", -1, 0), wall("right", 20, 21), beam(pieces)};
  scene.joints = {{.a = "left", .b = "beam"}, {.a = "beam", .b = "right"}};
  scene.joints[1].overrides.axial = 0;  // so that nothing hangs on it as a rope
  scene.loads = {{.body = "beam", .at = {10, 0}, .force = {0, -load}}};
  return scene;
}

inline SceneDef propped(int pieces, double load) {
  SceneDef scene = cantilever(pieces, 0);
  scene.supports = {{.body = "beam", .at = {20, 0}, .fix_y = true}};
  scene.loads = {{.body = "beam", .at = {10, 0}, .force = {0, -load}}};
  return scene;
}

inline int joint_named(const Plan& plan, const std::string& name) {
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (plan.joints[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace ductile
