#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cstdio>

#include "plane.h"

namespace ductile {

int exact::orientation(Point a, Point b, Point c) {
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
