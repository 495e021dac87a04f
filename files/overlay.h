// Areas put over one another: united, cut by one another, taken away. Where rings cross or touch themselves
// or others, the result is that of exact arithmetic on a grid of 2^-28 of the drawing's size.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::svg {

/// Rings and the rule by which they fill: an odd winding number, or one that is not zero.
struct Layer {
  std::vector<Ring> rings;
  bool even_odd = false;
};

enum class Overlay { unite, intersect, subtract };  ///< the last: the first layer without the others

/// The rings around what the layers leave: the area is on the left of each, no ring crosses itself or
/// another, and where two touch, they touch in points. Vertices that the layers have keep their coordinates.
/// Throws ShapeError where the rings cross millions of times.
std::vector<Ring> overlay(const std::vector<Layer>& layers, Overlay how);

/// The connected areas that such rings bound, the largest first.
std::vector<Outline> outlines(std::vector<Ring> rings);

/// Twice the area on the left of the ring, less that on its right.
double doubled_area_of(const Ring& ring);

}  // namespace ductile::svg
