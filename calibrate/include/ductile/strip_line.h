// Along which line the strip runs that a body is drawn as.
#pragma once

#include <array>

#include "ductile/calibrate.h"

namespace ductile {

/// In the outline's own coordinates: the line that is divided into pieces, that from the first to the last
/// cut, or the long axis, from end to end of the outline through its centroid, in the direction of x, then of
/// y.
std::array<Point, 2> strip_line(const BodyDef& body);

}  // namespace ductile
