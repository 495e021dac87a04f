#include "turn_inertia.h"

#include <algorithm>
#include <array>
#include <utility>

#include "objective.h"
#include "whole.h"

namespace ductile::dynamics {

namespace {

constexpr double safety = 2;         // s
constexpr double each_safety = 1.1;  // s of what turns each by itself
constexpr double kept_time = 0.5;    // s that inertia is kept beyond its need

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

// What a joint needs, and the masses that its rates move.
struct Need {
  std::array<double, 3> inertia{}, mass{};
  std::size_t count = 1;
  bool any() const { return inertia[0] > 0 || inertia[1] > 0 || inertia[2] > 0; }
};

// The rates where tension turns each body by itself: at which a line's anchors move across, A turns, and B
// turns.
void set_rows(const Joint& j, TurnInertia* t) {
  const Frame& f = j.frame;
  const Turn &a = j.J.axis_a, &b = j.J.axis_b;
  if (f.line) {
    t[0].row_a = {a.s, -a.c, -(f.ax * a.c + f.ay * a.s)};
    t[0].row_b = {-b.s, b.c, f.bx * b.c + f.by * b.s};
  }
  t[1].row_a = t[2].row_b = {0, 0, 1};
  t[1].row_b = t[2].row_a = {};
}

// What a joint needs whose bodies tension turns each by itself.
Need needed_by_each(const System& system, const Joint& j, double h) {
  std::array<TurnInertia, 3> t;
  set_rows(j, t.data());
  const Frame& f = j.frame;
  const Turn &a = j.J.axis_a, &b = j.J.axis_b;
  const double length = f.line ? system.record(j).gap[0] : 0, N = h * j.impulse[0], Q = h * j.impulse[1];
  // K, times h².
  const std::array<double, 3> stiffness{length > 0 ? N / length : 0,
                                        N * (f.ax * a.c + f.ay * a.s) + Q * (f.ay * a.c - f.ax * a.s),
                                        -N * (f.bx * b.c + f.by * b.s) - Q * (f.by * b.c - f.bx * b.s)};
  Need need{.count = 3};
  for (std::size_t i = 0; i < 3; ++i) {
    t[i].a = j.a, t[i].b = j.b;
    const double inverse = inverse_mass(system, t[i]);
    if (!(inverse > 0)) continue;
    need.mass[i] = 1 / inverse;
    need.inertia[i] = std::max(0.0, each_safety / 4 * stiffness[i] - need.mass[i] / 8);
  }
  return need;
}

// Finds clumps where they are asked for: what needs nothing with a joint's own bodies needs nothing at all.
class Needs {
 public:
  Needs(System& system, double h) : system_(system), h_(h) {}
  Need operator()(const Joint& j) {
    Need need;
    if (system_.turns_each(j)) need = needed_by_each(system_, j, h_);
    if (!j.frame.line && j.block >= 0) {
      need.inertia[0] = needed_between_pieces(j);
      const auto [lesser, greater] =
          std::minmax(system_.bodies[z(j.a)].inertia, system_.bodies[z(j.b)].inertia);
      need.mass[0] = lesser > 0 ? lesser : greater;  // what does not turn has none
    }
    // An inertia that is as good as rigid will do. Beside what a jammed joint would ask for, H would lose the
    // masses.
    for (std::size_t i = 0; i < need.count; ++i)
      need.inertia[i] = std::min(need.inertia[i], rigid_ratio * need.mass[i]);
    return need;
  }

 private:
  double needed_between_pieces(const Joint& j) {
    const double alone = needed(system_, j, h_, 1);
    if (alone == 0) return 0;
    if (!std::exchange(known_, true)) find_clumps(system_);
    const auto clump = [&](int i) { return system_.clumps[z(root_of(system_.clumps, i))].mass; };
    const double own = system_.bodies[z(j.a)].mass + system_.bodies[z(j.b)].mass;
    return needed(system_, j, h_, (clump(j.a) + clump(j.b)) / own);
  }

  System& system_;
  double h_;
  bool known_ = false;
};

// The rate where all turns as one by 1 rad/s, which is the moment of an impulse of 1, too.
double rate_of_turn(const System& system, const TurnInertia& t) {
  return t.rate_of(turning_about(system.places[z(t.a)], 0, 0), turning_about(system.places[z(t.b)], 0, 0));
}

// Finds wholes where they are asked for.
class Spins {
 public:
  explicit Spins(System& system) : system_(system) {}
  // The part of a rate that is its whole's turning as one.
  double operator()(const TurnInertia& t) {
    if (!system_.is_free(t.a) || !system_.is_free(t.b)) return 0;
    const double by = rate_of_turn(system_, t);
    if (by == 0) return 0;
    if (!std::exchange(known_, true)) find_wholes(system_);
    return by * whole_of(system_, t.a).spin;
  }

 private:
  System& system_;
  bool known_ = false;
};

// Scales what is not the whole's of a rate: else a spin would have to turn it up, too.
void scale_rate(TurnInertia& t, double by, Spins& spins) {
  const double even = spins(t);
  t.rate = even + by * (t.rate - even);
}

void raise(TurnInertia& t, double to, Spins& spins) {
  to = std::max(to, 1.3 * t.inertia);
  scale_rate(t, t.inertia / to, spins);
  t.inertia = to;
  t.highest = t.unneeded = 0;
}

// Of a joint, and made for it.
TurnInertia* of(System& system, const Joint& j) {
  int& index = system.record(j).turn_inertia;
  if (index < 0) {
    index = static_cast<int>(system.turn_inertias.size());
    for (int i = 0; i < (system.turns_each(j) ? 3 : 1); ++i)
      system.turn_inertias.push_back({.a = j.a, .b = j.b, .block = j.block});
  }
  TurnInertia* t = &system.turn_inertias[z(index)];
  if (system.turns_each(j)) set_rows(j, t);
  return t;
}

// Less than there was, after half a second of less need. Whether there is.
bool lower(TurnInertia& t, double need, double h) {
  t.highest = std::max(t.highest, need);
  t.unneeded += h;
  if (t.unneeded < kept_time) return false;
  const bool lowers = t.highest < t.inertia / 2;
  if (lowers) t.inertia = t.highest;
  t.highest = t.unneeded = 0;
  return lowers;
}

}  // namespace

double inverse_mass(const System& system, const TurnInertia& t) {
  const auto of_body = [&](int body, const Vec3& row) {
    if (!system.is_free(body)) return 0.0;
    const Body& b = system.bodies[z(body)];
    return b.inverse_mass * (row.x * row.x + row.y * row.y) + b.inverse_inertia * row.w * row.w;
  };
  return of_body(t.a, t.row_a) + of_body(t.b, t.row_b);
}

bool follow_tension(System& system, double h, double last_h) {
  Spins spins(system);
  // What is faster than steps is excited where they vary, as a swing by whoever stands on it: there it loses
  // of its rate what the steps differ by.
  if (last_h > 0 && h != last_h)
    for (TurnInertia& t : system.turn_inertias) scale_rate(t, std::min(h / last_h, last_h / h), spins);
  bool changed = false;
  Needs needs(system, h);
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 && !system.turns_each(j)) continue;
    const Need need = needs(j);
    if (!need.any() && system.record(j).turn_inertia < 0) continue;
    TurnInertia* t = of(system, j);
    for (std::size_t i = 0; i < need.count; ++i) {
      if (need.inertia[i] > t[i].inertia) {
        raise(t[i], need.inertia[i], spins);
        changed = true;
      } else {
        changed |= lower(t[i], need.inertia[i], h);
      }
    }
  }
  return changed;
}

bool raise_to_tension(System& system, double h) {
  bool raised = false;
  Needs needs(system, h);
  Spins spins(system);
  for (const Joint& j : system.own_joints()) {
    if (j.block < 0 && !system.turns_each(j)) continue;
    const Need need = needs(j);
    const int index = system.record(j).turn_inertia;
    for (std::size_t i = 0; i < need.count; ++i) {
      const double have = index < 0 ? 0 : system.turn_inertias[z(index) + i].inertia;
      if (need.inertia[i] <= 1.5 * have || need.inertia[i] <= 0.1 * need.mass[i]) continue;
      raise(of(system, j)[i], need.inertia[i], spins);
      raised = true;
    }
  }
  return raised;
}

bool return_moments(System& system) {
  system.returned.clear();
  bool any = false;
  for (const TurnInertia& t : system.turn_inertias) {
    if (t.impulse == 0 || !system.is_free(t.a) || !system.is_free(t.b)) continue;
    const double moment = t.impulse * rate_of_turn(system, t);
    if (moment == 0) continue;
    if (!std::exchange(any, true)) find_wholes(system);
    whole_of(system, t.a).moment += moment;
  }
  const auto is_owed = [](const Whole& w) { return !w.held && w.moment != 0; };
  if (!any || std::none_of(system.wholes.begin(), system.wholes.end(), is_owed)) return false;
  system.returned.assign(system.free, {});
  for (std::size_t i = 0; i < system.free; ++i) {
    const Whole& w = whole_of(system, static_cast<int>(i));
    if (!is_owed(w)) continue;
    Body& b = system.bodies[i];
    const Vec3 by = w.moment / w.inertia * turning_about(system.places[i], w.x, w.y);
    b.v += by;
    system.returned[i] = momentum(b, by);
  }
  return true;
}

void remember_turn_rates(System& system, std::span<const Vec3> velocities) {
  if (system.turn_inertias.empty()) return;
  for (const Joint& j : system.own_joints())
    if (j.frame.line && system.record(j).turn_inertia >= 0) of(system, j);
  for (TurnInertia& t : system.turn_inertias) t.rate = t.rate_of(velocities[z(t.a)], velocities[z(t.b)]);
}

void add_turn_impulses(System& system, std::span<Vec3> g) {
  for (TurnInertia& t : system.turn_inertias) {
    t.impulse = t.inertia * (t.rate_of(system.bodies[z(t.a)].v, system.bodies[z(t.b)].v) - t.rate);
    t.add(t.impulse, g[z(t.a)], g[z(t.b)]);
  }
}

}  // namespace ductile::dynamics
