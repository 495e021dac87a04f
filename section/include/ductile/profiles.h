// Cross-sections that have a shape's name: plates, boxes, discs, tubes, I-sections, channels, angles.
//
// Width along x, height along y, m. Plates, boxes, discs, tubes and I-sections are drawn about their centre;
// a channel has the back of its web on the y axis and its flanges toward +x; an angle has its heel at the
// origin. Curves are drawn as polylines of exactly their area; what that changes elsewhere is returned as a
// bound. Dimensions that make no profile throw InvalidInput, which names them.
#pragma once

#include "ductile/section.h"

namespace ductile {

struct Profile {
  Outline outline;
  double modulus_error = 0;  ///< m³: |W as drawn − W| is at most this, elastic and plastic, about x and y
};

namespace profiles {

/// Width b, height h.
Profile rectangle(double b, double h);
/// Outer width b and height h; side walls tw thick, top and bottom tf. Sharp corners.
Profile box(double b, double h, double tw, double tf);
/// Walls t thick, corners of the given radii (0: sharp).
Profile hollow(double b, double h, double t, double outer_radius, double inner_radius, double tolerance);
/// `tolerance`: the farthest that the drawn edge is from the curve, m.
Profile disc(double diameter, double tolerance);
/// Outer diameter and wall.
Profile tube(double diameter, double thickness, double tolerance);
/// Height h, flange width b, web tw, flanges tf, and root fillets of radius r between them (0: none).
Profile i_section(double h, double b, double tw, double tf, double r, double tolerance);
/// The same of a channel with parallel flanges; b from the web's back to the flanges' tips.
Profile channel(double h, double b, double tw, double tf, double r, double tolerance);
/// A channel whose flanges taper toward their tips: `slope` of their inner faces, tf thick at u from the
/// tips, with the inner edge of each tip rounded by the toe radius.
Profile tapered_channel(double h, double b, double tw, double tf, double slope, double u, double root_radius,
                        double toe_radius, double tolerance);
/// Legs h (upright) and b, both t thick, a root fillet and toes rounded on their inner side.
Profile angle(double h, double b, double t, double root_radius, double toe_radius, double tolerance);

}  // namespace profiles
}  // namespace ductile
