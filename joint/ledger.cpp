#include "ledger.h"

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
  strains_.assign(system.joints.size(), {});
  turns_.assign(system.bodies.size(), {});
}

void Ledger::open(System& system, std::span<const Vec3> before, const Motion& motion) {
  joints_ = system.joints;
  // Implicit Euler counts with velocities as solved, before they were scaled.
  find_x(system, 1 / motion.share);
  for (std::size_t i = 0; i < system.bodies.size(); ++i) turns_[i] = system.places[i].turn;
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const JointRecord& r = system.records[k];
    const Rows v0 = relative_velocity(j, before[z(j.a)], before[z(j.b)]);
    for (unsigned i = 0; i < 3; ++i) {
      strains_[k][i] = r.law.damping[i] > 0      ? r.strain[i]
                       : r.law.relaxation[i] > 0 ? j.bias[i] / r.law.relaxation[i]
                                                 : 0;
      energies.numerical -= j.impulse[i] * ((2 - motion.share) * (r.x[i] - j.bias[i]) - v0[i]) / 2;
    }
    const Rows prescribed =
        relative_velocity(j, prescribed_velocity(system, j.a), prescribed_velocity(system, j.b));
    for (unsigned i = 0; i < 3; ++i) energies.driven += j.impulse[i] * prescribed[i];
  }
}

// Between the steps the strain went from the last e' to e: the chord that a turning piece moves along,
// rounding, pushes, a spring that goes with the step.
void Ledger::account(const Joint& j, std::size_t index, JointRecord& r, const Rows& booked) {
  const Rows& strain = strains_[index];
  const double h = r.law.h;
  for (unsigned i = 0; i < 3; ++i) {
    const double held = r.stored[i];
    r.stored[i] = 0;
    if (!(j.G[i] > 0)) {
      energies.numerical += held;
      continue;
    }
    const double k = r.law.spring[i], R = j.impulse[i] / h;
    const double v = r.x[i] - j.bias[i];
    const bool not_all = flows(j.regime, i) || r.law.damping[i] > 0;  // of the row's motion is elastic
    const double after = not_all ? elastic_strain(j, r, i) : strain[i] + h * v;
    const double change = after - strain[i];
    r.stored[i] = k * after * after / 2;
    energies.damping += r.law.damping[i] * change * change / h;
    energies.numerical += k * change * change / 2 + held - k * strain[i] * strain[i] / 2;
    if (not_all) {
      energies.numerical += R * (h * v - change) - (r.dissipated[i] - booked[i]);
    } else {
      energies.numerical += (R - k * after) * change;  // of impulses that are carried, not made of the strain
    }
  }
}

void Ledger::account_scaled(const Joint& j, JointRecord& r) {
  for (unsigned i = 0; i < 3; ++i) {
    if (!(r.law.damping[i] > 0)) continue;
    const double after = elastic_strain(j, r, i);
    energies.numerical += r.stored[i];
    r.stored[i] = r.law.spring[i] * after * after / 2;
    energies.numerical -= r.stored[i];
  }
}

void Ledger::close(std::span<const Vec3> change) {
  const auto own = [&](int body) {
    const Turn& t = turns_[z(body)];
    const Vec3& v = change[z(body)];
    return Vec3{t.c * v.x + t.s * v.y, t.c * v.y - t.s * v.x, v.w};
  };
  for (const Joint& j : joints_) {
    const Rows v = relative_velocity(j, own(j.a), own(j.b));
    for (unsigned i = 0; i < 3; ++i) energies.numerical += j.impulse[i] * v[i] / 2;
  }
}

}  // namespace ductile::dynamics
