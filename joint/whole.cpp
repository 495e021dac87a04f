#include "whole.h"

#include "objective.h"

namespace ductile::dynamics {

namespace {

bool has_impulse(const Joint& j) { return j.impulse[0] != 0 || j.impulse[1] != 0 || j.impulse[2] != 0; }

void join(System& system, int a, int b) {
  if (!system.is_free(a) || !system.is_free(b)) {
    for (const int i : {a, b})
      if (system.is_free(i)) whole_of(system, i).held = true;
    return;
  }
  const int root = root_of(system.wholes, a), other = root_of(system.wholes, b);
  if (root == other) return;
  Whole &all = system.wholes[z(root)], &part = system.wholes[z(other)];
  part.part_of = root;
  all.held |= part.held;
  all.mass += part.mass;
  all.x += part.x;
  all.y += part.y;
}

}  // namespace

void find_wholes(System& system) {
  system.wholes.resize(system.free);
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    const Pose& at = system.places[i].pose;
    // What does not turn takes moments that nothing gives back.
    system.wholes[i] = {.part_of = static_cast<int>(i),
                        .held = b.inverse_inertia == 0,
                        .mass = b.mass,
                        .x = b.mass * at.x,
                        .y = b.mass * at.y};
  }
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    if (k < system.own() || has_impulse(j)) join(system, j.a, j.b);
  }
  for (std::size_t i = 0; i < system.free; ++i) {
    Whole& w = system.wholes[i];
    if (w.part_of == static_cast<int>(i)) w.x /= w.mass, w.y /= w.mass;
  }
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    Whole& w = whole_of(system, static_cast<int>(i));
    if (w.held) continue;
    const Vec3 R = turning_about(system.places[i], w.x, w.y);
    const Vec3 MR = momentum(b, R);
    w.inertia += dot(R, MR);
    w.spin += dot(MR, b.v_free);
  }
  for (Whole& w : system.wholes)
    if (w.inertia > 0) w.spin /= w.inertia;
}

}  // namespace ductile::dynamics
