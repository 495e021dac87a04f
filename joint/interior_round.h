// What the rows of all joints report to a round of the interior point method: the distance of its iterate
// from the minimum, and the step that bounds allow.
#pragma once

#include <limits>

#include "system.h"

namespace ductile::dynamics {

/// How far an iterate is from the minimum, J.
struct Distance {
  double products = 0;  // Σ z p
  double lack = 0;      // what all that is to vanish adds to the gap
  double rounding = 0;  // what the last bits of s make of the gap
  double gap() const { return products + lack; }
};

/// The least compliance that a round gives a row of the effective mass m. The bodies take all of a row's lack
/// but 1/(1 + G/m): beyond G = 1e12 m that is lost among its last bits, and the row would go nowhere. What
/// this leaves of the lack, 1e-12, is for the next round. Only where a joint is torn open, its arms longer
/// than at rest, is a rigid row that stiff.
inline double least_compliance(double m) { return m > 0 ? 1e-12 / m : 0; }

/// The last bits of s, eight of them as rows of a body move each other, move its row by ε s/m_eff, which the
/// row answers by G: what s² is to be multiplied with for that to be a gap.
inline double last_bits(double G, double m_eff) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return 32 * (G > m_eff ? G : m_eff) * (epsilon / m_eff) * (epsilon / m_eff);
}

/// A direction, bound by bound.
struct Direction {
  double nearest = 0;            // 1/step to the first p or z that it brings to 0
  double change = 0, bends = 0;  // Σ z Δp + p Δz and Σ Δz Δp

  void see(double p, double z, double dp, double dz) {
    if (-dp > nearest * p) nearest = -dp / p;
    if (-dz > nearest * z) nearest = -dz / z;
    change += z * dp + p * dz;
    bends += dz * dp;
  }
  /// The largest step, up to 1, that goes no more than `reach` of the way to a bound.
  double step_within(double reach) const { return nearest > reach ? reach / nearest : 1; }
  /// Σ z p after a step.
  double products(double now, double step) const { return now + step * (change + step * bends); }
};

}  // namespace ductile::dynamics
