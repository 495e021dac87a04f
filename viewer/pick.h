// Which joints and pieces of a frame are where.
#pragma once

#include <optional>
#include <vector>

#include "timeline.h"

namespace ductile::viewer {

/// The joint that is there nearest to a point, within `reach` m.
std::optional<std::size_t> joint_at(const Plan& plan, const Frame& frame, Point at, double reach);

/// The joints, broken ones too, whose anchors are in a box.
std::vector<std::size_t> joints_in(const Plan& plan, const Frame& frame, const Bounds& box);

/// The joints of at least that stage (colours.h).
std::vector<std::size_t> joints_from(const Frame& frame, double stage);

/// The last of the pieces, which is drawn on top, that covers a point.
std::optional<std::size_t> piece_at(const Plan& plan, const Frame& frame, Point at);

/// Of what was thrown in, what covers a point: an index into Frame::thrown.
std::optional<std::size_t> thrown_at(const Timeline& run, Point at);

/// The bodies that can move, as they are at t = 0, in a box; where there are none, all of them.
Bounds extent(const Plan& plan);

}  // namespace ductile::viewer
