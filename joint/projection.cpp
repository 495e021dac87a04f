#include "projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "drive.h"

namespace ductile::dynamics {

namespace {

void place_all(System& system, std::span<const Pose> at) {
  for (std::size_t i = 0; i < system.free; ++i) put(system.places[i], at[i]);
}

// The farthest coordinate and the longest arm, m; at least 1.
double reach_of(const System& system) {
  double reach = 1;
  for (std::size_t i = 0; i < system.free; ++i) {
    const Pose& p = system.places[i].pose;
    reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
  }
  for (const Joint& j : system.own_joints()) {
    for (const double arm : {j.frame.ax, j.frame.ay, j.frame.bx, j.frame.by})
      reach = std::max(reach, std::abs(arm));
  }
  return reach;
}

}  // namespace

void Projection::form(const System& system) {
  for (auto* v : {&g_, &d_, &z_}) v->assign(system.bodies.size(), {});
  poses_.assign(system.bodies.size(), {});
  start_.assign(system.bodies.size(), {});
  kept_.assign(system.joints.size(), {});
}

// ½|x − goal|²_M; its gradient into g_.
double Projection::pull(const System& system, std::span<const Pose> goal) {
  double sum = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    const auto& [pose, turn] = system.places[i];
    const double dx = pose.x - goal[i].x, dy = pose.y - goal[i].y, dw = pose.angle - goal[i].angle;
    g_[i] = {b.mass * (turn.c * dx + turn.s * dy), b.mass * (turn.c * dy - turn.s * dx), b.inertia * dw};
    sum += (b.mass * (dx * dx + dy * dy) + b.inertia * dw * dw) / 2;
  }
  return sum;
}

// ½ Σ G (gap − kept)² over the rows that hold; its gradient is added to g_.
double Projection::strain(System& system) {
  double sum = 0;
  for (std::size_t k = 0; k < system.own(); ++k) {
    Joint& j = system.joints[k];
    const Coupling& D = system.records[k].tangent;
    const Rows gap = locate(j, system.places), G{D.nn, D.qq, D.mm};
    Rows s;
    for (unsigned i = 0; i < 3; ++i) {
      const double strain = gap[i] - kept_[k][i];
      s[i] = G[i] * strain;
      sum += s[i] * strain / 2;
    }
    add_transposed(j, s, g_[z(j.a)], g_[z(j.b)]);
  }
  return sum;
}

// d = −H⁻¹g; |d|²_M. As M ≤ H, that is no more than gᵀH⁻¹g: where this is less than `enough`, d is not
// needed.
double Projection::correction(const System& system, const Hessian& hessian, std::span<Vec3> d,
                              double enough) {
  for (std::size_t i = 0; i < system.free; ++i) {
    if (system.bodies[i].inverse_inertia == 0) g_[i].w = 0;
    d[i] = -1.0 * g_[i];
  }
  if (hessian.forward(d.first(system.free)) < enough) return 0;
  hessian.backward(d.first(system.free));
  double size = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    size += b.mass * (d[i].x * d[i].x + d[i].y * d[i].y) + b.inertia * d[i].w * d[i].w;
  }
  return size;
}

// The correction where nothing pulls any more.
double Projection::let_go(Work& work) {
  std::fill_n(g_.begin(), work.system.free, Vec3{});
  strain(work.system);
  return correction(work.system, work.hessian, d_);
}

// Of d_, rad, at least 1: beyond that the tangent says nothing.
double Projection::largest_turn(const System& system) const {
  double turn = 1;
  for (std::size_t i = 0; i < system.free; ++i) turn = std::max(turn, std::abs(d_[i].w));
  return turn;
}

void Projection::displace_all(System& system, double t) const {
  for (std::size_t i = 0; i < system.free; ++i) displace(system.places[i], t * d_[i]);
}

// Gauss–Newton from poses_. κ multiplies what a step along the tangent misses the gaps by: the sum need not
// fall. What must fall is the step that comes next. A factor of other poses is good as long as it shortens
// that; where it does not, what its J and the present one differ by comes out multiplied by κ.
bool Projection::push_far(Work& work) {
  System& system = work.system;
  Hessian& hessian = work.hessian;
  const auto move = [&](double t) {
    for (std::size_t i = 0; i < system.free; ++i) {
      put(system.places[i], poses_[i]);
      displace(system.places[i], t * d_[i]);
    }
    pull(system, work.goal);
    strain(system);
  };
  move(0);
  double size = correction(system, hessian, d_);
  bool fresh = false;  // d_ is of a factor of its own poses
  for (int round = 0; !(size <= work.enough); ++round) {
    if (round == 20) return false;
    for (std::size_t i = 0; i < system.free; ++i) poses_[i] = system.places[i].pose;
    const double whole = 1 / largest_turn(system);
    for (double t = whole;;) {
      move(t);
      double next = correction(system, hessian, z_);
      const bool refactor = next > 0.01 * size;
      if (refactor) {
        hessian.refactor(system, false);
        next = correction(system, hessian, z_);
      }
      if (next <= (1 - t / 2) * size) {
        std::swap(d_, z_);
        size = next;
        fresh = refactor;
        break;
      }
      if (fresh) {
        t /= 2;
        if (t < 0.02 * whole) return false;
      } else {
        move(0);
        hessian.refactor(system, false);
        size = correction(system, hessian, d_);
        fresh = true;
      }
    }
  }
  return true;
}

// Where the nearest is not found (a joint that turns far under the pull), what keeps the gaps will do, from
// where the bodies were.
bool Projection::close_gaps(Work& work) {
  System& system = work.system;
  place_all(system, start_);
  for (int round = 0; round < 20; ++round) {
    let_go(work);
    work.hessian.refactor(system, false);
    const double last = let_go(work);
    const double turn = largest_turn(system);
    displace_all(system, 1 / turn);
    if (turn == 1 && last <= work.enough) return true;
  }
  return false;
}

// Rows that flow, and gaps that could not be kept (supports that were moved apart), take their new place as
// neutral: a push stores no energy.
void Projection::take_neutral(System& system, bool kept, double trifle, double rounding) const {
  for (std::size_t k = 0; k < system.own(); ++k) {
    Joint& j = system.joints[k];
    JointRecord& r = system.records[k];
    for (unsigned i = 0; i < 3; ++i) {
      const bool free = j.G[i] == 0;
      if (is_slack(j, r, i) && !free) continue;
      const double change = r.gap[i] - kept_[k][i];
      const bool closed = kept && r.m_eff[i] * change * change <= trifle + rounding * rounding * r.m_eff[i];
      if (closed && !free && !flows(j.regime, i)) continue;
      j.neutral[i] += change;
      if (!free) r.plastic.net[i] += change;
    }
  }
}

// Whether the push draws lines taut that were slack. These hold in the next try, as long as they are at rest:
// what they would be longer by, the next part of a step would close within a thousandth of a second.
bool Projection::draws_taut(System& system) const {
  bool any = false;
  for (const int at : system.slackening) {
    Joint& j = system.joints[z(at)];
    const JointRecord& r = system.records[z(at)];
    for (unsigned i = 0; i < 3; ++i) {
      if (!is_slack(j, r, i) || !(j.G[i] > 0) || !flows(j.regime, i) || beyond_slack(j, r, i) == 0) continue;
      j.regime = static_cast<std::uint8_t>(j.regime & ~(9u << i));
      any = true;
    }
  }
  return any;
}

bool Projection::project(System& system, Hessian& hessian, const Evaluation& last_solve, double h,
                         std::span<const Pose> goal, bool try_goal) {
  const auto drawn_taut = [&] {
    if (!draws_taut(system)) return false;
    place_all(system, start_);
    locate_all(system);
    return true;
  };
  const auto again = [&] { return project(system, hessian, last_solve, h, goal, try_goal); };
  hessian.factor_holding(system, last_solve.changed);
  double size = 0, distance = 0;  // |d|²_M; |goal|²_M / 2 where nothing is strained
  // It gives way by less than a thousandth: the structure holds it.
  const auto holds = [&] {
    return (size = correction(system, hessian, d_, 1e-6 * distance)) < 1e-6 * distance;
  };
  if (!try_goal) {
    distance = pull(system, goal);
    if (holds()) return true;
  }
  for (std::size_t k = 0; k < system.own(); ++k) kept_[k] = system.records[k].gap;
  for (const int at : system.slackening) {
    const Joint& j = system.joints[z(at)];
    for (unsigned i = 0; i < 3; ++i)
      if (is_slack(j, system.records[z(at)], i) && !flows(j.regime, i)) kept_[z(at)][i] = j.neutral[i];
  }
  for (std::size_t i = system.free; i < system.bodies.size(); ++i) put(system.places[i], goal[i]);
  for (std::size_t i = 0; i < system.free; ++i) start_[i] = poses_[i] = system.places[i].pose;
  double reach = reach_of(system);
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * reach;
  for (const Pose& p : goal) reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
  bool small = true;
  if (try_goal) {
    // Where all of it was moved alike, the goal itself is the better start. Otherwise, from where nothing is
    // strained, it is a push like any other.
    place_all(system, goal);
    const double pull_at_goal = pull(system, goal), at_goal = pull_at_goal + strain(system);
    place_all(system, start_);
    const double pulled = pull(system, goal), strained = strain(system);
    small = pulled + strained < at_goal && strained <= rigid_ratio * system.mass * rounding * rounding;
    if (small) distance = pulled;
    if (at_goal <= pulled + strained) {
      place_all(system, goal);
      pull(system, goal);
      strain(system);
    }
    for (std::size_t i = 0; i < system.free; ++i) poses_[i] = system.places[i].pose;
    if (holds()) {
      locate_all(system);
      return drawn_taut() ? again() : true;
    }
  }
  // As M ≤ H, the step is no longer than the way to the goal. Where it is, the factor is nothing but
  // rounding: over arms of a hundred kilometres a row is 1e19 times as stiff as its bodies are heavy.
  const bool sound = distance == 0 || size <= 4 * distance;
  small &= sound;
  Work work{system, hessian, goal, rounding, 1e-8 * size + rounding * rounding * system.mass};
  // A small push: let go of what the pull strains, which may be all of it, and of what a step along the
  // tangent misses the gaps by, its square.
  double last = size;
  for (int round = 0; small && (round == 0 || last > work.enough); ++round) {
    displace_all(system, 1);
    const double next = let_go(work);
    small = next <= (round == 0 ? last : std::max(work.enough, 1e-3 * last));
    last = next;
  }
  bool kept = sound && (small || push_far(work) || close_gaps(work));
  // What is still open closes in the next step, as fast as that is short, and what strains rows that are
  // parallel stays: neither may be more than rounding, or than a trifle of how the structure moves and is
  // loaded.
  const double trifle = std::min(work.enough, 1e-14 * h * h * (last_solve.speed2 + last_solve.impulse2) +
                                                  rounding * rounding * system.mass);
  if (kept) {
    if (!small) last = let_go(work);  // of the pull toward the goal, which has left strains of 1/κ of it
    displace_all(system, 1);
    for (double next; last > trifle && (next = let_go(work)) < 0.1 * last; last = next)
      displace_all(system, 1);
    // Nothing that is held goes farther than from one end of all there is to the other, nor around and
    // around.
    for (std::size_t i = 0; i < system.free && kept; ++i) {
      const Pose& p = system.places[i].pose;
      kept = std::abs(p.x) <= 4 * reach && std::abs(p.y) <= 4 * reach &&
             std::abs(p.angle - goal[i].angle) <= 100;
    }
  }
  if (!kept) place_all(system, goal);
  locate_all(system);
  if (kept && drawn_taut()) return again();
  take_neutral(system, kept, trifle, rounding);
  return kept;
}

}  // namespace ductile::dynamics
