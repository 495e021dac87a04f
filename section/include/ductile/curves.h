// Curves as polylines that keep within a chord tolerance, for drawings and rolled profiles.
//
// Every function appends to a ring the points of a curve after its first and up to its last, so that pieces
// can be strung together. All points lie on the curve. An affine map of the control points or half axes maps
// the curve, so a drawing's transforms are applied before flattening, and the tolerance is then in metres.
#pragma once

#include "ductile/section.h"

namespace ductile {

/// The elliptic arc c + a cos φ + b sin φ for φ from `from` to `from + sweep` (rad; a negative sweep runs
/// backwards); a and b are conjugate half axes: perpendicular for an ellipse as drawn, anything after an
/// affine map. No chord is farther from the arc than `tolerance` m. Throws InvalidInput where that takes more
/// than 10⁵ points, or where a number is not finite.
void flatten_arc(Ring& ring, Point centre, Point a, Point b, double from, double sweep, double tolerance);

/// The cubic Bézier curve of the control points p0 … p3; the chord tolerance and errors as above.
void flatten_cubic(Ring& ring, Point p0, Point p1, Point p2, Point p3, double tolerance);

/// The quadratic Bézier curve of the control points p0 … p2; the chord tolerance and errors as above.
void flatten_quadratic(Ring& ring, Point p0, Point p1, Point p2, double tolerance);

}  // namespace ductile
