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

/// Two columns on their feet at (0, 0) and (span, 0), and a beam whose centre line is at `height`, in four
/// pieces cut at the columns' inner faces and in the middle; all 1 m thick. `down` in the middle of the beam,
/// `along` at the height of its centre line.
struct Portal {
  double span = 20, height = 12, youngs_modulus = 210e9;
  SceneDef scene(double down, double along) const {
    const double under = height - 0.5;
    SceneDef s = bending_only();
    BodyDef left = beam(1);
    left.name = "left";
    left.outline = {rectangle(-0.5, 0, 0.5, under), {}};
    BodyDef right = left;
    right.name = "right";
    right.outline = {rectangle(span - 0.5, 0, span + 0.5, under), {}};
    BodyDef girder = beam(1);
    girder.outline = {rectangle(-0.5, under, span + 0.5, under + 1), {}};
    for (const double x : {0.5, span / 2, span - 0.5})
      girder.cuts.push_back({Point{x, under - 1}, Point{x, under + 2}});
    s.bodies = {
        {.name = "floor", .type = BodyType::static_body, .outline = {rectangle(-5, -1, span + 5, 0), {}}},
        left,
        right,
        girder};
    for (BodyDef& body : s.bodies)
      if (body.material) body.material->youngs_modulus = youngs_modulus;
    s.joints = {{.a = "floor", .b = "left"},
                {.a = "floor", .b = "right"},
                {.a = "left", .b = "beam"},
                {.a = "right", .b = "beam"}};
    s.loads = {{.body = "beam", .at = {span / 2, height}, .force = {0, -down}},
               {.body = "beam", .at = {-0.5, height}, .force = {along, 0}}};
    return s;
  }
  /// Hinges may form at feet, column heads and in the middle of the beam only: for sway and combined
  /// mechanisms.
  Plan hinged_in_columns(double down, double along) const {
    return without_yield(calibrate(scene(down, along)), {"beam/0-beam/1", "beam/2-beam/3"});
  }
  /// Hinges may form at the feet and in the beam: for its own mechanism.
  Plan hinged_in_beam(double down) const {
    return without_yield(calibrate(scene(down, 0)), {"left-beam/0", "right-beam/3"});
  }
  /// Both columns lean, the beam stays level: four hinges turn alike.
  double sway(double along) const { return 4 * plastic_moment / along / (height - 0.5); }
  /// The left half of the beam turns with the left column about its foot by θ, the right half by −θ about
  /// the point where the lines through the left foot and the middle hinge and along the right column meet:
  /// (span, 2 height). The right column turns by rθ.
  double combined(double down, double along) const {
    const double r = (height + 0.5) / (height - 0.5);
    return plastic_moment * (4 + 2 * r) / (along * height + down * span / 2);
  }
  double beam_alone(double down) const { return 8 * plastic_moment / down / (span - 1); }

  static Plan without_yield(Plan plan, const std::vector<std::string>& joints) {
    for (PlannedJoint& joint : plan.joints)
      for (const std::string& name : joints)
        if (joint.name == name) joint.M = joint.M_reverse = unlimited;
    return plan;
  }
};

inline int joint_named(const Plan& plan, const std::string& name) {
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (plan.joints[i].name == name) return static_cast<int>(i);
  return -1;
}

/// And a stone of two pieces beside it, that nothing holds.
inline SceneDef with_a_loose_stone(SceneDef scene) {
  BodyDef stone = beam(2, 1, 1);
  stone.name = "stone";
  stone.at = {10, 3};
  scene.bodies.push_back(stone);
  return scene;
}

}  // namespace ductile
