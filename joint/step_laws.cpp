#include "step_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinematics.h"

namespace ductile::dynamics {

void StepLaws::set_law(Joint& j, JointRecord& r) const {
  r.law = make_law(r.material, r.m_eff, h_, elastic_ratio);
  j.G = r.law.G;
  j.elastic_range = r.law.elastic_range();
  j.free = j.G[0] == 0 || j.G[1] == 0 || j.G[2] == 0;
}

// The share of all drift that is not taken back in this step. Updates each joint's deferred drift.
double StepLaws::deferred_share(System& system, double h) {
  const double share = h < drift_time ? h / drift_time : 1;
  drift_time = std::max(h, drift_time - h);
  if (share == 1) return 0;
  find_gaps(system);
  double deferred = 0, all = 0;
  for (const Joint& j : system.joints) {
    JointRecord& r = system.record(j);
    double now = 0;
    for (unsigned i = 0; i < 3; ++i) {
      const double d = r.gap[i] - j.neutral[i] - elastic_strain(j, r, i);
      if (j.G[i] > 0) now += r.m_eff[i] * d * d;
    }
    deferred += h < r.law.h ? now : r.deferred_drift;
    all += now;
    r.deferred_drift = now;
  }
  const double waits = (1 - share) * (deferred < all ? std::sqrt(deferred / all) : 1);
  for (JointRecord& r : system.records) r.deferred_drift *= waits * waits;
  return waits;
}

// A rigid row's spring goes with the step, and keeps its force. Where a spring was edited, or a rigid one's
// masses, it keeps its force if it became stiffer, its strain if softer: no energy comes of it.
void StepLaws::follow_law(Joint& j, JointRecord& r, Rows& strain, double h) const {
  Rows spring = r.law.spring;
  const double longer = r.law.h > 0 ? h / r.law.h : 1;
  const std::array<bool, 3> was_rigid{is_rigid(r, 0), is_rigid(r, 1), is_rigid(r, 2)};
  set_law(j, r);
  for (unsigned i = 0; i < 3; ++i) {
    // The same force, but none larger than the step: what was rough in a short one would be a blow.
    j.impulse[i] *= std::min(1.0, longer);
    // What holds nothing any more, as both its bodies are held, forgets its force.
    if (!(r.law.spring[i] > 0)) j.neutral[i] = r.gap[i], strain[i] = 0;
    if (!(spring[i] > 0 && r.law.spring[i] > 0)) continue;
    const auto strain_by = [&](double by) {
      j.neutral[i] += strain[i] * (1 - by);
      strain[i] *= by;
      spring[i] /= by;
    };
    if (was_rigid[i] && is_rigid(r, i)) strain_by(longer * longer);
    if (r.law.spring[i] > spring[i]) strain_by(spring[i] / r.law.spring[i]);
  }
}

bool StepLaws::begin(System& system, double h) {
  const bool changed = h != h_ || !known_;
  known_ = true;
  h_ = h;
  const bool drifts = h < drift_time;
  const double waits = deferred_share(system, h);
  if (!changed && !drifts && !peculiar()) {
    if (std::exchange(system.biases_known, false)) return false;
    find_gaps(system);
    for (Joint& j : system.joints) set_equal_bias(j, system.record(j).gap, 1 / h_);
    return false;
  }
  find_gaps(system);
  for (Joint& j : system.joints) {
    JointRecord& r = system.record(j);
    Rows strain{};
    if (changed || drifts || damped_ || r.material.surface != nullptr)
      strain = {elastic_strain(j, r, 0), elastic_strain(j, r, 1), elastic_strain(j, r, 2)};
    if (changed) follow_law(j, r, strain, h);
    for (unsigned i = 0; i < 3; ++i) {
      double e = r.gap[i] - j.neutral[i];
      e -= waits * (e - strain[i]);
      j.bias[i] = r.law.relaxation[i] * e;
      if (r.law.damping[i] > 0) {
        // A damper would let constraint drift grow from step to step, and the spring store it.
        j.bias[i] = r.law.relaxation[i] * strain[i] + (e - strain[i]) / h;
      }
    }
    if (damped_ || changed || r.material.surface != nullptr) r.strain = strain;
  }
  if (changed) {
    damped_ = surfaces_ = false;
    for (const JointRecord& r : system.records) {
      damped_ |= r.law.damping[0] > 0 || r.law.damping[1] > 0 || r.law.damping[2] > 0;
      surfaces_ |= r.material.surface != nullptr;
    }
  }
  return changed;
}

}  // namespace ductile::dynamics
