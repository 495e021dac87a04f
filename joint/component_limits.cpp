// Box2D's limits of speed: where a structure is too fast for them, it is slowed as a whole, and what they
// took all the same is booked in the ledger.
#include <algorithm>
#include <cmath>
#include <utility>

#include "component.h"
#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

constexpr double just_within = 1 - 1e-5;  // Box2D shall have nothing left to do

// Of a speed, so that a body goes no further than the limit.
double share_allowed(double limit, double way) { return std::min(1.0, just_within * limit / way); }

}  // namespace

// Of all velocities, so that no body goes further than the limits in so many seconds.
double Component::share_within_limits(double h) const {
  return std::min(share_allowed(b2_maxTranslation, h * solver.fastest()),
                  share_allowed(b2_maxRotation, h * solver.fastest_turn()));
}

// Box2D moves a body by no more than 2 m and π/2 a step, each for itself, which would tear at the joints. So
// what is too fast is slowed here, where the joints can still answer to it; what is too fast after that, all
// together. So is what gets much faster by it: joints may give one body more than was taken from another, and
// more again in each pass.
void Component::limit_speed(const b2SolverData& data) {
  if (!direct()) return;
  constexpr double most_answered = 4;  // times the kinetic energy that there was
  const double h = solver.step();
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      const Body& b = solver.bodies[i];
      sum += b.mass * (b.v.x * b.v.x + b.v.y * b.v.y) + b.inertia * b.v.w * b.v.w;
    }
    return sum;
  };
  const auto slow = [this](double share) {
    solver.slow();
    report([share](Reports& r) { r.step.slowed = std::max(r.step.slowed, share); });
  };
  double before = 0;
  for (int pass = 0;; ++pass) {
    const double least = share_within_limits(h);
    if (least == 1) {
      if (pass > 0) slow(1 - kinetic() / before);
      return;
    }
    if (pass == 0) {
      before = kinetic();
      std::fill(account.lost.begin(), account.lost.end(), Vec3{});
    }
    const bool diverges = pass > 0 && !(kinetic() <= most_answered * before);
    for (std::size_t i = 0; i < solver.free_bodies() && diverges; ++i)
      solver.bodies[i].v_free += into_own_frame(solver.places[i].turn, std::exchange(account.lost[i], {}));
    if (diverges) solve(data);
    const bool together = pass == 4 || diverges;
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      Body& b = solver.bodies[i];
      const double linear =
          together ? least : share_allowed(b2_maxTranslation, h * std::sqrt(b.v.x * b.v.x + b.v.y * b.v.y));
      const double angular = together ? least : share_allowed(b2_maxRotation, h * std::abs(b.v.w));
      const Vec3 less{(1 - linear) * b.v.x, (1 - linear) * b.v.y, (1 - angular) * b.v.w};
      account.lost[i] += into_world(solver.places[i].turn, less);
      if (together) continue;
      b.v_free -= less;
      b.v -= less;
    }
    if (together) {
      solver.scale(least);
      slow(1 - kinetic() / before);
      return give(data);
    }
    solve(data);
  }
}

// The limits hold for each part of a step as well, by what it takes: from part to part bodies would get
// faster, without bound, where they spin so fast that one turns them far. All are slowed together. For the
// whole of the step they do not, as light pieces may go far faster for a part or two than they are thrown.
void Component::limit_speed_in_part() {
  const double share = share_within_limits(solver.step());
  if (share == 1) return;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Body& b = solver.bodies[i];
    if (mirrors[i].guest()) continue;
    account.lost_in_parts += (1 - share) * dot(momentum(b, b.v), solver.before[i] + share * b.v) / 2;
  }
  solver.scale(share);
  report([share](Reports& r) { r.step.slowed = std::max(r.step.slowed, 1 - share * share); });
}

double Component::close_ledger() {
  if (!std::exchange(account.open, false)) return 0;
  const float h = static_cast<float>(solver.step());
  double clamped = std::exchange(account.lost_in_parts, 0);
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    const Mirror& m = mirrors[i];
    solver.before[i] = {};
    if (i >= solver.free_bodies() || m.guest()) continue;
    const Vec3 v = in_doubles(velocity_of(*m.body));
    const Vec3 left = v - in_doubles(m.given);
    solver.before[i] = left;
    // 2 m and π/2 a step. The work of what took them back, with the mean of the velocities before and after.
    Vec3 lost = account.lost[i];
    if (h * m.given.v.Length() > b2_maxTranslation) lost -= {left.x, left.y, 0};
    if (h * std::abs(m.given.w) > b2_maxRotation) lost.w -= left.w;
    const Vec3 mean = 0.5 * (in_doubles(account.began[i]) + v);
    clamped += double{m.mass.mass} * (lost.x * mean.x + lost.y * mean.y) +
               solver.bodies[i].inertia * lost.w * mean.w;
  }
  solver.close_ledger(solver.before);
  return clamped;
}

}  // namespace ductile::dynamics
