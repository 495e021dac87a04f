// Where the edges of two outlines lie upon each other.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// A straight stretch along which two outlines touch, in the direction of the first one's boundary: its
/// material is on the left, the other's on the right.
struct Contact {
  Point from, to;
};

/// All stretches where edges of a and b run against each other within `gap`; stretches that continue each
/// other in a straight line are one. Rings as split() makes them: outer counter-clockwise, holes clockwise.
std::vector<Contact> touching(const Outline& a, const Outline& b, double gap);

}  // namespace ductile::calibration
