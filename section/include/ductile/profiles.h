// Cross-sections that have a name: plates, boxes, discs, tubes, and rolled steel beams.
//
// All are symmetric about both axes and drawn about their centre, width along x and height along y; lengths
// in m. Curves are drawn by points on them; what that changes is returned as a bound. Dimensions that make no
// profile throw InvalidInput, which names them.
#pragma once

#include <span>
#include <string_view>

#include "ductile/section.h"

namespace ductile {

struct Profile {
  Outline outline;
  double area_error = 0;     ///< m²: |area as drawn − area| is at most this
  double modulus_error = 0;  ///< m³: likewise W_elastic and W_plastic about the x and the y axis
};

namespace profiles {

/// Width b, height h.
Profile rectangle(double b, double h);
/// Outer width b and height h; side walls tw thick, top and bottom tf. Sharp corners.
Profile box(double b, double h, double tw, double tf);
/// `tolerance`: the farthest that the drawn edge is from the curve, m.
Profile disc(double diameter, double tolerance);
/// Outer diameter and wall.
Profile tube(double diameter, double thickness, double tolerance);
/// Height h, flange width b, web tw, flanges tf, and root fillets of radius r between them (0: none).
Profile i_section(double h, double b, double tw, double tf, double r, double tolerance);

/// Dimensions of a rolled section, mm, as its standard gives them.
struct Rolled {
  std::string_view name;   ///< "IPE 300"
  double h, b, tw, tf, r;  ///< mm
};

/// IPE 80 … 600 (EN 10365; Euronorm 19-57) and HEA, HEB 100 … 1000 (EN 10365; Euronorm 53-62).
std::span<const Rolled> rolled();

/// By name; blanks and case do not matter ("ipe300"). Throws InvalidInput where there is no such section.
Profile rolled(std::string_view name, double tolerance = 1e-5);

}  // namespace profiles
}  // namespace ductile
