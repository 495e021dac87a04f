#include "ledger.h"

#include <utility>

#include "blow.h"
#include "drive.h"
#include "objective.h"

namespace ductile::dynamics {

namespace {

// The part of a body's velocity that joints do not change.
Vec3 prescribed_velocity(const System& system, int body) {
  const Body& b = system.bodies[z(body)];
  if (!system.is_free(body)) return b.v;
  return {0, 0, b.inverse_inertia == 0 ? b.v.w : 0};
}

}  // namespace

void Ledger::form(const System& system) {
  taken_.assign(system.joints.size(), {});
  moved_.assign(system.joints.size(), {});
  turns_.assign(system.bodies.size(), {});
  turn_inertias_.reserve(system.turn_inertias.capacity());
  returned_.reserve(system.returned.capacity());
}

void Ledger::see(const System& system) {
  joints_.assign(system.own_joints().begin(), system.own_joints().end());
  for (std::size_t i = 0; i < system.bodies.size(); ++i) turns_[i] = system.places[i].turn;
  turn_inertias_ = system.turn_inertias;
  returned_ = system.returned;
}

void Ledger::open(const System& system, std::span<const Vec3> before, double h) {
  see(system);
  for (std::size_t k = 0; k < system.own(); ++k) {
    const Joint& j = system.joints[k];
    const Rows v0 = relative_velocity(j, before[z(j.a)], before[z(j.b)]);
    const Rows v = relative_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
    const Rows prescribed =
        relative_velocity(j, prescribed_velocity(system, j.a), prescribed_velocity(system, j.b));
    for (unsigned i = 0; i < 3; ++i) {
      taken_[k][i] = j.impulse[i] * (v0[i] + v[i]) / 2;
      moved_[k][i] = h * v[i];
      energies.driven += j.impulse[i] * prescribed[i];
    }
  }
  for (const TurnInertia& t : turn_inertias_) {
    const double now = t.rate_of(system.bodies[z(t.a)].v, system.bodies[z(t.b)].v);
    energies.numerical += t.impulse * (now + t.rate_of(before[z(t.a)], before[z(t.b)])) / 2;
    energies.driven +=
        t.impulse * t.rate_of(prescribed_velocity(system, t.a), prescribed_velocity(system, t.b));
  }
  for (std::size_t i = 0; i < returned_.size(); ++i)
    energies.numerical -= dot(returned_[i], system.bodies[i].v + before[i]) / 2;
}

namespace {

// Of an implicit row: what flows did so at its cap, also where it held for a part of the step only.
double force_after(const Joint& j, const JointRecord& r, unsigned i) {
  return (flows(j.regime, i) ? impulse_at_yield(j, r, i) : j.impulse[i]) / r.law.h;
}

}  // namespace

void Ledger::account(const Joint& j, std::size_t index, JointRecord& r, const Rows& slip, const Rows& work) {
  const double h = r.law.h;
  for (unsigned i = 0; i < 3; ++i) {
    const double held = r.stored[i];
    r.stored[i] = 0;
    const double last = std::exchange(r.strain[i], 0), before = std::exchange(r.strain_before[i], last);
    if (!(j.G[i] > 0) || is_slack(j, r, i)) {
      energies.numerical += held;
      continue;
    }
    const double k = r.law.spring[i], delta = r.law.delta[i];
    const double e = strain_of_bias(j, i);
    const double u = moved_[index][i] - slip[i], p = h * j.rate[i], third = r.law.third[i];
    const double strain = delta < 1 ? e + u / 2 : last + (force_after(j, r, i) / k - last) / delta;
    r.strain[i] = strain;
    const double m = delta < 1 ? (u + p) / 2 : delta > 1 ? strain - last : (strain - before) / 2;
    const double unturned = third > 0 ? u - (j.moved[i] - p) / 2 : u;
    r.stored[i] = k / 2 * (strain * strain + r.law.detuning[i] * unturned * unturned + 2 * third * m * m);
    const double given = is_driven(r, i) ? -j.impulse[i] / h * slip[i] : 0;
    energies.driven += given;
    const double lost = taken_[index][i] + given - (r.stored[i] - held) - work[i];
    const double damped =
        third > 0 && delta > 0  // r
            ? 5 * m / 6 + (j.trend[i] + 2 * third * j.mean[i] + r.law.detuning[i] * j.moved[i]) / delta
            : m;
    const double damping = r.law.damping[i] / h * m * damped;
    energies.damping += damping;
    energies.numerical += lost - damping;
  }
}

void Ledger::close(std::span<const Vec3> change) {
  const auto own = [&](int body) { return into_own_frame(turns_[z(body)], change[z(body)]); };
  for (const Joint& j : joints_) {
    const Rows v = relative_velocity(j, own(j.a), own(j.b));
    for (unsigned i = 0; i < 3; ++i) energies.numerical += j.impulse[i] * v[i] / 2;
  }
  for (const TurnInertia& t : turn_inertias_)
    energies.numerical += t.impulse * t.rate_of(own(t.a), own(t.b)) / 2;
  for (std::size_t i = 0; i < returned_.size(); ++i)
    energies.numerical -= dot(returned_[i], own(static_cast<int>(i))) / 2;
}

}  // namespace ductile::dynamics
