// For programs that hold their outlines as CGAL polygons. Optional: nothing else in ductile includes this, so
// only code that includes it compiles CGAL. Any kernel; its coordinates are rounded to double. LGPL parts of
// CGAL only.
#pragma once

#include <CGAL/Polygon_2.h>
#include <CGAL/Polygon_with_holes_2.h>

#include "ductile/section.h"

namespace ductile {

template <class Kernel, class Container>
Ring ring(const CGAL::Polygon_2<Kernel, Container>& polygon) {
  Ring ring;
  ring.reserve(polygon.size());
  for (const auto& p : polygon.container()) ring.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y())});
  return ring;
}

template <class Kernel, class Container>
Outline outline(const CGAL::Polygon_2<Kernel, Container>& polygon) {
  return {ring(polygon), {}};
}

/// The outer boundary must be bounded; validate() says so ("has 0 points") where it is not.
template <class Kernel, class Container>
Outline outline(const CGAL::Polygon_with_holes_2<Kernel, Container>& polygon) {
  Outline outline{ring(polygon.outer_boundary()), {}};
  for (auto hole = polygon.holes_begin(); hole != polygon.holes_end(); ++hole)
    outline.holes.push_back(ring(*hole));
  return outline;
}

}  // namespace ductile
