// Box2D's limits of speed: where a structure is too fast for them, it is slowed as a whole, and what they
// took all the same is booked in the ledger.
#include <algorithm>
#include <cmath>
#include <utility>

#include "component.h"
#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

// Box2D moves a body by no more than 2 m and π/2 a step, each for itself, which would tear at the joints. So
// what is too fast is slowed here, where the joints can still answer to it; what is too fast after that, all
// together. So is what gets much faster by it: joints may give one body more than was taken from another, and
// more again in each pass.
void Component::limit_speed(const b2SolverData& data) {
  if (!direct()) return;
  constexpr double rounding = 1 - 1e-5;  // Box2D shall have nothing left to do
  constexpr double most_answered = 4;    // times the kinetic energy that there was
  const auto share = [&](double limit, double speed) {
    return std::min(1.0, rounding * limit / (solver.step() * speed));
  };
  const auto kinetic = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      const Body& b = solver.bodies[i];
      sum += b.mass * (b.v.x * b.v.x + b.v.y * b.v.y) + b.inertia * b.v.w * b.v.w;
    }
    return sum;
  };
  const auto slow = [this](double share) {
    report([share](Reports& r) { r.step.slowed = std::max(r.step.slowed, share); });
  };
  double before = 0;
  for (int pass = 0;; ++pass) {
    const double least =
        std::min(share(b2_maxTranslation, solver.fastest()), share(b2_maxRotation, solver.fastest_turn()));
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
          together ? least : share(b2_maxTranslation, std::sqrt(b.v.x * b.v.x + b.v.y * b.v.y));
      const double angular = together ? least : share(b2_maxRotation, std::abs(b.v.w));
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

double Component::close_ledger() {
  if (!std::exchange(account.open, false)) return 0;
  const float h = static_cast<float>(solver.step());
  double clamped = 0;
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
