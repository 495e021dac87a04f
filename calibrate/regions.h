// An outline whose rings touch, as the regions that they bound together.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// The connected regions inside an outline that validate() accepts. Edges that a hole shares with another
/// ring are gone, and a ring that touched another is one with it, so that no two rings of the result have
/// more than rounding between them: a hole from side to side leaves two regions. A region's outer ring,
/// counter-clockwise, may pass through a point more than once. Vertices within 1e-9 of the outline's size of
/// each other, or of an edge, touch. Takes time by the square of the vertices.
std::vector<Outline> regions(const Outline& outline);

}  // namespace ductile::calibration
