// Where the edges of two outlines lie upon each other.
#pragma once

#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// A straight stretch along which two outlines touch, in the direction of the first one's boundary: its
/// material is on the left, the other's on the right.
struct Contact {
  Point from, to;
  double apart = 0;  ///< of the edges, at most; below 0 where the outlines overlap
  int a = 0, b = 0;  ///< whose edges they are, for the caller
};

/// All stretches longer than 3 least where edges of a and b run against each other within `gap` and the
/// distance changes by less than a third of their length; stretches that continue each other in a straight
/// line are one. Rings as split() makes them: outer counter-clockwise, holes clockwise.
std::vector<Contact> touching(const Outline& a, const Outline& b, double gap, double least);

/// Leaves of all stretches of two bodies those that are edges which the bodies share: none across a nearer
/// one, and what is longer than three times the gap. Where the gap is too large for any, what is longer than
/// three times its own distance; where there is none either, the nearest.
void keep_shared(std::vector<Contact>& all, double gap, double least);

}  // namespace ductile::calibration
