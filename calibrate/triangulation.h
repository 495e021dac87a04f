// Triangles of an outline.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// One side of an edge of a polygon, whose inside is on its left.
struct HalfEdge {
  int from, next, previous;
  int twin;  ///< on the other side; −1: the boundary
};

struct Triangulation {
  std::vector<Point> points;
  std::vector<HalfEdge> edges;
};

/// Constrained Delaunay, of the outline's own vertices without those in the middle of straight edges. Takes
/// rings that touch; of rings that cross by rounding it makes the best it can, and always ends.
Triangulation triangulate(const Outline& outline);

/// Adds vertices to the edges of the boundary: the feet of the corners opposite, so that edges across a strip
/// run across it. Delaunay again, but for those feet's own.
void add_feet(Triangulation& triangulation);

}  // namespace ductile::calibration
