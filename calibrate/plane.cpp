#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cstdio>

#include "plane.h"

namespace ductile {

int orientation(Point a, Point b, Point c) {
  // The rounded determinant decides unless it is below its own error bound, (3 + 16u)u times the sum of the
  // magnitudes with u = 2⁻⁵³ (Shewchuk 1997, ccwerrboundA); underflow only ever sends the question on.
  const double l = (a.x - c.x) * (b.y - c.y), r = (a.y - c.y) * (b.x - c.x), determinant = l - r;
  const double bound = 3.3306690738754716e-16 * (std::abs(l) + std::abs(r));
  if (determinant > bound + 1e-300) return 1;
  if (determinant < -bound - 1e-300) return -1;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  return CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y));
}

std::string to_string(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}

std::string to_string(Point point) { return '(' + to_string(point.x) + ", " + to_string(point.y) + ')'; }

}  // namespace ductile
