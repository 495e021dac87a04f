// The zero of a function of one scalar that rises monotonically, as the slope of a convex function does.
#pragma once

#include <cmath>
#include <limits>

namespace ductile::dynamics {

/// A value and its derivative.
struct Slope {
  double value, rise;
};

/// t where f'(t) is 0 to `enough`: Newton's method inside a bracket. `slope(t)` gives f' and f''; f'(0) < 0,
/// and f'(1) > 0 where `bracketed`. As f'' may know less than f', every fourth step halves the bracket,
/// whatever Newton says. A flat f, or 60 evaluations, end it where it is.
template <class SlopeAt>
double line_search(const SlopeAt& slope, double t, bool bracketed, double enough) {
  double low = bracketed ? 0 : 1, high = bracketed ? 1 : std::numeric_limits<double>::infinity();
  if (!(t > low && t < high)) t = 2;
  for (int i = 0; i < 60; ++i) {
    const Slope at = slope(t);
    if (std::abs(at.value) <= enough) break;
    (at.value < 0 ? low : high) = t;
    const double newton = t - at.value / at.rise;
    const bool halve = i % 4 == 3 && std::isfinite(high);
    if (newton > low && newton < high && !halve) {
      t = newton;
    } else if (std::isinf(high)) {
      t *= 2;
    } else {
      t = (low + high) / 2;
    }
    if (std::isfinite(high) && high - low <= 1e-15 * high) break;
  }
  return t;
}

}  // namespace ductile::dynamics
