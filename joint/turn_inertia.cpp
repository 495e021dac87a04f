#include "turn_inertia.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ductile::dynamics {

namespace {

constexpr double safety = 2;       // s
constexpr double kept_time = 0.5;  // s that inertia is kept beyond its need

int root_of(std::vector<Clump>& clumps, int i) {
  while (clumps[z(i)].part_of != i) i = clumps[z(i)].part_of = clumps[z(clumps[z(i)].part_of)].part_of;
  return i;
}

void find_clumps(System& system) {
  for (std::size_t i = 0; i < system.free; ++i)
    system.clumps[i] = {static_cast<int>(i), system.bodies[i].mass};
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 || !(j.G[2] > 0) || flows(j.regime, 2) || !is_rigid(system.record(j), 2)) continue;
    const int a = root_of(system.clumps, j.a), b = root_of(system.clumps, j.b);
    if (a == b) continue;
    system.clumps[z(a)].mass += system.clumps[z(b)].mass;
    system.clumps[z(b)].part_of = a;
  }
}

// C of a joint for its last impulses, where what turns as one is `longer` times as long as its bodies.
double needed(const System& system, const Joint& j, double h, double longer) {
  // h T: the virial of the force over the way d from A's centre of mass to B's, which J has in the joint's
  // frame.
  const double along = -(j.J.av + j.J.bv), across = j.J.au + j.J.bu, l2 = along * along + across * across;
  const double virial = j.impulse[0] * along + j.impulse[1] * across;
  if (!(virial > 0 && l2 > 0)) return 0;
  const Body &a = system.bodies[z(j.a)], &b = system.bodies[z(j.b)];
  const double mass = (a.mass + b.mass) / 2, inertia = (a.inertia + b.inertia) / 2, m = longer * mass;
  const double alpha =
      safety * h * virial / (4 * longer * l2) + longer * std::max(0.0, mass / 4 - inertia / l2);
  return std::max(0.0, longer * longer * l2 * (alpha > m / 2 ? alpha * alpha / (4 * m) : alpha / 4 - m / 16));
}

// Finds clumps where they are asked for: what needs nothing with a joint's own bodies needs nothing at all.
class Needs {
 public:
  Needs(System& system, double h) : system_(system), h_(h) {}
  double operator()(const Joint& j) {
    const double alone = needed(system_, j, h_, 1);
    if (alone == 0) return 0;
    if (!std::exchange(known_, true)) find_clumps(system_);
    const auto clump = [&](int i) { return system_.clumps[z(root_of(system_.clumps, i))].mass; };
    const double own = system_.bodies[z(j.a)].mass + system_.bodies[z(j.b)].mass;
    return needed(system_, j, h_, (clump(j.a) + clump(j.b)) / own);
  }

 private:
  System& system_;
  double h_;
  bool known_ = false;
};

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
  Needs needs(system, h);
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 || j.frame.line) continue;
    const double need = needs(j);
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
  Needs needs(system, h);
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 || j.frame.line) continue;
    const double need = needs(j);
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

void add_turn_impulses(System& system, std::span<Vec3> g) {
  for (TurnInertia& t : system.turn_inertias) {
    t.impulse = t.inertia * (system.bodies[z(t.b)].v.w - system.bodies[z(t.a)].v.w - t.rate);
    g[z(t.a)].w -= t.impulse;
    g[z(t.b)].w += t.impulse;
  }
}

}  // namespace ductile::dynamics
