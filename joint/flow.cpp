#include "flow.h"

#include <algorithm>
#include <cmath>

namespace ductile::dynamics {

void flow(Joint& j, JointRecord& r, const Rows& gap, const StepLaws& laws, const Motion& motion) {
  const double h = laws.step();
  // On a yield surface single rows may give back, all three together never; but by rounding, at its apex, or
  // where the solve did not end.
  double rate = 0;
  for (unsigned i = 0; i < 3 && j.regime == on_surface; ++i) {
    if (j.G[i] > 0) rate += j.impulse[i] * (r.x[i] - j.impulse[i] / j.G[i]);
  }
  for (unsigned i = 0; i < 3; ++i) {
    if (!flows(j.regime, i) || !(j.G[i] > 0)) continue;
    const double s = j.impulse[i];
    const double increment = motion.swept ? gap[i] - j.neutral[i] - elastic_strain(j, r, i)
                                          : motion.share * h * (r.x[i] - s / j.G[i]);
    if (!(increment * r.x[i] > 0) && j.regime != on_surface) continue;
    j.neutral[i] += increment;
    r.plastic.net[i] += increment;
    (increment > 0 ? r.plastic.forward : r.plastic.back)[i] += std::abs(increment);
    if (rate >= 0) r.dissipated[i] += s / h * increment;
    if (r.material.hardening[i] > 0) {
      // Isotropic: the cap reached is the cap from now on, in both directions.
      const double cap = (s > 0 ? r.material.cap : r.material.cap_reverse)[i];
      const double growth = std::max(0.0, std::abs(s) / h - cap);
      r.material.cap[i] += growth;
      r.material.cap_reverse[i] += growth;
      laws.set_law(j, r);
    }
  }
}

void follow_gap(Joint& j, const Rows& gap) {
  for (unsigned i = 0; i < 3; ++i) {
    if (j.G[i] == 0) j.neutral[i] = gap[i];
  }
}

void scale_strain(Joint& j, const JointRecord& r, double share) {
  const Rows& damping = r.law.damping;
  for (unsigned i = 0; i < 3; ++i) {
    if (!(damping[i] > 0)) continue;
    const double before = r.strain[i], after = before + share * (elastic_strain(j, r, i) - before);
    j.impulse[i] = j.G[i] / r.law.h * after - damping[i] * before;
  }
}

}  // namespace ductile::dynamics
