// What a step minimises over the velocities v of all free bodies:
//
//   f(v) = ½ (v − v*)ᵀ M (v − v*) + Σ φ(J v + b)      ∇f(v) = M (v − v*) + Jᵀ s
//
// and, in both, what turn_inertia.h adds to the inertia of bodies that turn under tension.
//
// v* are the velocities without the structure's impulses, φ the potentials of row.h and s = φ' the impulses.
// f is strictly convex, so the solution exists and is unique whatever the mass ratio, loop or yield pattern.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kinematics.h"

namespace ductile::dynamics {

/// The norms and regimes that one evaluation finds.
struct Evaluation {
  double gradient2 = 0;                    // |∇f|² in the norm of M⁻¹, J
  double impulse2 = 0;                     // |v − v*|²_M, the square of the impulses' norm, J
  double speed2 = 0;                       // |v|²_M: twice the kinetic energy, J
  double fastest2 = 0, fastest_turn2 = 0;  // the largest |v|² and ω² of a body
  int changed = 0;                         // rows that flow in H and not here, or the other way round
  bool crossed = false;  // some joint's regime is another than before, or on a yield surface
  bool curved = false;   // some joint flows on its yield surface
  bool flows = false;    // some row is beyond its cap

  void keep(Tape& tape) {
    tape(gradient2, impulse2, speed2, fastest2, fastest_turn2, changed, crossed, curved, flows);
  }

  void see(const Body& b) {
    fastest2 = std::max(fastest2, b.v.x * b.v.x + b.v.y * b.v.y);
    fastest_turn2 = std::max(fastest_turn2, b.v.w * b.v.w);
  }
};

/// Whether no row of a joint flows at these impulses.
inline bool is_elastic(const Joint& j, const Rows& s) {
  const auto within = [&](unsigned i) { return std::abs(s[i]) <= j.elastic_range[i]; };
  return within(0) && within(1) && within(2);
}

/// Of a momentum, in the norm of M⁻¹.
inline double square(const Body& b, const Vec3& g) {
  return (g.x * g.x + g.y * g.y) * b.inverse_mass + g.w * g.w * b.inverse_inertia;
}

/// M v of one body.
inline Vec3 momentum(const Body& b, const Vec3& v) { return {b.mass * v.x, b.mass * v.y, b.inertia * v.w}; }

/// |v|²_M of one body: twice its kinetic energy, J.
inline double twice_kinetic(const Body& b, const Vec3& v) { return dot(v, momentum(b, v)); }

/// |g|² in the norm of M⁻¹; bodies that do not rotate take no moment.
double square(const System& system, std::span<Vec3> g);

/// Adds Jᵀ s to g and writes each joint's impulses, its regime, and the x of those that flow.
void add_impulses(System& system, std::span<Vec3> g, Evaluation& at);

/// ∇f into g at the bodies' v, once `change(i, body)` has changed each of them.
template <class Change>
Evaluation evaluate(System& system, std::span<Vec3> g, const Change& change) {
  Evaluation e;
  for (std::size_t i = 0; i < system.free; ++i) {
    Body& b = system.bodies[i];
    change(i, b);
    e.see(b);
    const Vec3 given = b.v - b.v_free;
    g[i] = momentum(b, given);
    e.impulse2 += dot(given, g[i]);
    e.speed2 += b.mass * (b.v.x * b.v.x + b.v.y * b.v.y) + b.inertia * b.v.w * b.v.w;
  }
  add_impulses(system, g, e);
  e.gradient2 = square(system, g);
  return e;
}

inline Evaluation evaluate(System& system, std::span<Vec3> g) {
  return evaluate(system, g, [](std::size_t, Body&) {});
}

/// x of all rows, from an evaluation at these velocities.
void find_x(System& system);

/// f at the last evaluation.
double objective(System& system, const Evaluation& at);

/// What the last bits of all impulses are in |∇f|².
double rounding_of_impulses(const System& system);

}  // namespace ductile::dynamics
