#include "flow.h"

#include <algorithm>
#include <cmath>

#include "blow.h"
#include "drive.h"

namespace ductile::dynamics {

namespace {

// T₋ where a row's strain holds half of it, m.
double parted_before(const Joint& j, const JointRecord& r, unsigned i) {
  return j.is_newmark(i) ? parting(j, i, r.law.h) : 0;
}

}  // namespace

RatedLaw rated_law(const Joint& j, const JointRecord& r, unsigned i, double x) {
  if (!j.is_newmark(i)) return {j.G[i], x};
  const double h = r.law.h, k = r.law.spring[i], G = h * (h * k + r.law.damping[i]);
  const double parted = parted_before(j, r, i), e = strain_of_bias(j, i) - parted / 2;
  return {G, x - j.bias[i] + parted / h + h * k * e / G};
}

double slip_of(const Joint& j, const JointRecord& r, unsigned i) {
  // What breaks within the step holds at its cap until it does.
  const double h = r.law.h, yield = impulse_at_yield(j, r, i), s = r.held < 1 ? yield : j.impulse[i];
  if (r.material.rate != nullptr) {
    const auto [G, x] = rated_law(j, r, i, r.x[i]);
    return h * (x - yield / G);
  }
  const double parted = parted_before(j, r, i), e = strain_of_bias(j, i) - parted / 2;
  const double rate = s / j.G[i] - j.bias[i] + parted / h;
  const double limit = std::abs(yield) / (h * r.law.spring[i]);
  const double share = r.law.delta[i] < 1 ? (1 + r.law.delta[i]) / 2 : 1;
  return h * (r.x[i] - j.bias[i]) + parted - (std::clamp(e + share * h * rate, -limit, limit) - e);
}

namespace {

// The elastic strain at the step's end beyond that of the caps, of a spring that no step resolves, by which
// it rings from side to side: the caps bound the force in the step's middle, and not that. It would be thrown
// from cap to cap for good, and the slider take up nothing of it. Half of T is no strain.
double beyond_yield(const Joint& j, const JointRecord& r, unsigned i, double parted) {
  if (!j.is_newmark(i) || r.material.rate != nullptr) return 0;
  const double k = r.law.spring[i], e = strain_of_bias(j, i) + r.law.h * (r.x[i] - j.bias[i]) + parted / 2;
  return e - std::clamp(e, -r.material.cap_reverse[i] / k, r.material.cap[i] / k);
}

}  // namespace

void flow(Joint& j, JointRecord& r, const Rows& gap, const Rows& parted, const StepLaws& laws,
          const Motion& motion) {
  const double h = laws.step();
  Rows slip{};
  double work = 0;
  for (unsigned i = 0; i < 3; ++i) {
    if (!flows(j.regime, i) || !(j.G[i] > 0) || is_slack(j, r, i)) continue;
    slip[i] = motion.swept ? gap[i] - j.neutral[i] - j.impulse[i] / (h * r.law.spring[i])
                           : motion.share * slip_of(j, r, i);
    if (!motion.swept && j.is_newmark(i)) slip[i] += (parted[i] - parted_before(j, r, i)) / 2;
    work += j.impulse[i] * slip[i];
  }
  for (unsigned i = 0; i < 3; ++i) {
    if (!flows(j.regime, i) || !(j.G[i] > 0) || is_slack(j, r, i)) continue;
    const double s = impulse_at_yield(j, r, i);
    const double increment = slip[i];
    // On a yield surface single rows may give back, all three together never; but by rounding, at its apex.
    if (!(increment * r.x[i] > 0) && j.regime != on_surface) {
      j.neutral[i] += beyond_yield(j, r, i, parted[i]);
      continue;
    }
    j.neutral[i] += increment;
    if (is_driven(r, i)) continue;
    const double flowed = r.held * increment;
    r.plastic.net[i] += flowed;
    (increment > 0 ? r.plastic.forward : r.plastic.back)[i] += std::abs(flowed);
    if (work >= 0) r.dissipated[i] += s / h * flowed;
    if (r.material.hardening[i] > 0) {
      // Isotropic: the slider of modulus H in series with the spring raises the cap in both directions.
      const double growth = r.material.slider_modulus(i, r.law.spring[i]) * std::abs(increment);
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

}  // namespace ductile::dynamics
