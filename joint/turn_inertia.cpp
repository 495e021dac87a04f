#include "turn_inertia.h"

#include <algorithm>
#include <cmath>

namespace ductile::dynamics {

namespace {

constexpr double safety = 2;       // s
constexpr double kept_time = 0.5;  // s that inertia is kept beyond its need

// C of the joint for its last impulses.
double needed(const System& system, const Joint& j, double h) {
  // h T: the virial of the force over the way d from A's centre of mass to B's, which J has in the joint's
  // frame.
  const double along = -(j.J.av + j.J.bv), across = j.J.au + j.J.bu, l2 = along * along + across * across;
  const double virial = j.impulse[0] * along + j.impulse[1] * across;
  if (!(virial > 0 && l2 > 0)) return 0;
  const Body &a = system.bodies[z(j.a)], &b = system.bodies[z(j.b)];
  const double mass = (a.mass + b.mass) / 2, inertia = (a.inertia + b.inertia) / 2;
  const double alpha = safety * h * virial / (4 * l2) + std::max(0.0, mass / 4 - inertia / l2);
  return std::max(0.0, l2 * (alpha > mass / 2 ? alpha * alpha / (4 * mass) : alpha / 4 - mass / 16));
}

void raise(TurnInertia& t, double to) {
  t.rate *= t.inertia / to;
  t.inertia = to;
  t.highest = t.unneeded = 0;
}

TurnInertia& of(System& system, const Joint& j) {
  int& index = system.record(j).turn_inertia;
  if (index < 0) {
    index = static_cast<int>(system.turn_inertias.size());
    system.turn_inertias.push_back({.a = j.a, .b = j.b, .block = j.block});
  }
  return system.turn_inertias[z(index)];
}

}  // namespace

bool follow_tension(System& system, double h) {
  bool changed = false;
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 || j.frame.line) continue;
    const double need = needed(system, j, h);
    if (need == 0 && system.turn_inertias.empty()) continue;
    if (need > 0) of(system, j);
    if (system.record(j).turn_inertia < 0) continue;
    TurnInertia& t = of(system, j);
    if (need > t.inertia) {
      raise(t, std::max(need, 1.3 * t.inertia));
      changed = true;
      continue;
    }
    t.highest = std::max(t.highest, need);
    t.unneeded += h;
    if (t.unneeded < kept_time) continue;
    if (t.highest < t.inertia / 2) {
      t.inertia = t.highest;
      changed = true;
    }
    t.highest = t.unneeded = 0;
  }
  return changed;
}

bool raise_to_tension(System& system, double h) {
  bool raised = false;
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 || j.frame.line) continue;
    const double need = needed(system, j, h);
    if (need == 0) continue;
    const Body &a = system.bodies[z(j.a)], &b = system.bodies[z(j.b)];
    const int index = system.record(j).turn_inertia;
    const double have = index < 0 ? 0 : system.turn_inertias[z(index)].inertia;
    if (need <= 1.5 * have || need <= 0.1 * std::min(a.inertia, b.inertia)) continue;
    TurnInertia& t = of(system, j);
    raise(t, std::max(need, 1.3 * t.inertia));
    raised = true;
  }
  return raised;
}

void remember_turn_rates(System& system, std::span<const Vec3> velocities) {
  for (TurnInertia& t : system.turn_inertias) t.rate = velocities[z(t.b)].w - velocities[z(t.a)].w;
}

void add_turn_impulses(const System& system, std::span<Vec3> g) {
  for (const TurnInertia& t : system.turn_inertias) {
    const double moment = turn_impulse(t, system.bodies[z(t.a)].v, system.bodies[z(t.b)].v);
    g[z(t.a)].w -= moment;
    g[z(t.b)].w += moment;
  }
}

}  // namespace ductile::dynamics
