// The section at a joint between drawn bodies, whether they overlap there, touch, or stand a little apart.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "ductile/section.h"

namespace ductile::rube {

/// Do the outlines share a stretch of an edge, within `gap`, that is more than six gaps long? What
/// calibrate() joins along common edges.
bool share_an_edge(const Outline& a, const Outline& b, double gap);

/// The stretch that a straight cut at `anchor` takes out of the outline: the shorter one of the cuts across
/// its two principal axes, or, where it has none (a square, a disc), across the line to its centroid and
/// along it. Where the anchor is not inside, or on a tip or a round end, the cut is a little further in. None
/// where there is no such cut.
std::optional<std::array<Point, 2>> cut_at(const Outline& outline, Point anchor);

}  // namespace ductile::rube
