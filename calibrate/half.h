// What half of a piece gives beside a joint, where it is not as high as the joint's cut.
#pragma once

#include "ductile/section.h"

namespace ductile::calibration {

/// By how much a bar of the cut's section that gives as much is longer; below 0: shorter.
struct Longer {
  double along = 0;    ///< m, in N and Q
  double bending = 0;  ///< m
};

/// Of a joint: its cut as a piece has it.
struct Face {
  Point anchor, outward;  ///< outward: of length 1, across the cut, into the piece
  double height = 0;      ///< m
  double share = 1;       ///< of what lies behind it; the rest is other joints'
};

/// Where a piece has a step at the cut, its half is a bar as high as the chord h parallel to the cut, of
/// height H: ∫ (H/h − 1) ds and ∫ ((H/h)³ − 1) ds over `reach`. Elsewhere it is as high as the cut: along a
/// taper the trapezoidal rule, which joints are, is good to the square of a piece's length by itself, and
/// better than with means of 1/h³ between. So it is where the axis runs beside the outline, and in a piece
/// with holes.
Longer half_of(const Outline& piece, const Face& face, double reach);

}  // namespace ductile::calibration
