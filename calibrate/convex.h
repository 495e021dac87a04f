// Convex parts of an outline, as Box2D's fixtures want them.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// Convex polygons of at most `most_vertices` vertices, counter-clockwise, that cover the outline without
/// overlap and use no other vertices than its own. Takes rings that touch; of rings that cross by rounding it
/// makes the best it can, and always ends.
std::vector<Ring> convex_parts(const Outline& outline, int most_vertices);

/// The convex hull, counter-clockwise, without collinear vertices.
Ring hull(std::vector<Point> points);

/// The least width of a convex, counter-clockwise ring over all directions, m.
double least_width(const Ring& convex);

}  // namespace ductile::calibration
