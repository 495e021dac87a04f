// On which side of a line a point is, exactly.
#pragma once

#include <cmath>

#include "ductile/plane.h"

namespace ductile::calibration {

namespace exact {
int orientation(Point a, Point b, Point c);
}

/// Sign of the doubled area of a, b, c, exactly: +1 where c is left of a→b, 0 where the three are collinear.
inline int orientation(Point a, Point b, Point c) {
  // The rounded determinant decides unless it is below its own error bound, (3 + 16u)u times the sum of the
  // magnitudes with u = 2⁻⁵³ (Shewchuk 1997, ccwerrboundA); underflow only ever sends the question on.
  const double l = (a.x - c.x) * (b.y - c.y), r = (a.y - c.y) * (b.x - c.x), determinant = l - r;
  const double bound = 3.3306690738754716e-16 * (std::abs(l) + std::abs(r)) + 1e-300;
  return determinant > bound ? 1 : determinant < -bound ? -1 : exact::orientation(a, b, c);
}

}  // namespace ductile::calibration
