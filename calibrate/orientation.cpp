#include "orientation.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace ductile::calibration {

int exact::orientation(Point a, Point b, Point c) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  return CGAL::orientation(Kernel::Point_2(a.x, a.y), Kernel::Point_2(b.x, b.y), Kernel::Point_2(c.x, c.y));
}

}  // namespace ductile::calibration
