// Profiles that have a name in a standard, and what EN 1993-1-1 says of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ductile/profiles.h"

namespace ductile {

enum class Shape { i_section, channel, angle, round_tube, rectangular_tube };

/// A hot-rolled or hot-finished profile: nominal dimensions, m. y is the axis across the height, as in EN
/// 1993; profiles.h has where each shape is drawn.
struct Rolled {
  std::string name;  ///< as the standard writes it: "IPE 300", "RHS 200x100x5"
  Shape shape = Shape::i_section;
  double h = 0, b = 0;  ///< height and width; an angle's legs, a round tube's diameter twice
  double tw = 0;        ///< web or wall
  double tf = 0;        ///< flange; tw where all is equally thick
  double r = 0;         ///< root or inner radius
  double toe = 0;       ///< toe radius of an angle or a tapered flange, outer radius of a rectangular tube
  double slope = 0;     ///< of a tapered flange's inner face
  double u = 0;         ///< from a tapered flange's tip to where it is tf thick
};

/// The profile of that name; blanks, case and × for x do not matter ("ipe300", "SHS100x5"), and HE 200 A is
/// HEA 200, U 200 is UPN 200. Throws InvalidInput that lists what there is. In tables: IPE 80 … 600, HEA,
/// HEB, HEM 100 … 1000, UB 127x76x13 … 914x419x388 and UC 152x152x23 … 356x406x634 (EN 10365), PFC 100x50x10
/// … 430x100x64, UPE 80 … 400 and UPN 80 … 400 (EN 10365), L (EN 10056-1). Of any size: CHS D x t, RHS H x B
/// x t and SHS B x t (EN 10210-2, corners of 1.5 t outside and t inside).
Rolled rolled(std::string_view name);

/// Whether a name is written as those are, whether or not there is such a profile: letters, then a size,
/// which no name of a file with a suffix is.
bool names_a_profile(std::string_view name);

/// All profiles of the tables.
std::vector<Rolled> rolled_profiles();

/// Its outline; `tolerance`: the farthest that a drawn curve is from the exact one, m.
Profile draw(const Rolled& profile, double tolerance = 1e-5);

/// A_v, m², for shear along the height: EN 1993-1-1 6.2.6 (3) a, b, f, g. A tapered flange (UPN) counts
/// beside the web as thick as it is there, as catalogues have it; with its nominal thickness, as the
/// standard's letter may be read, A_v were 1.5 to 4.5 % less. None of an angle, which the standard does not
/// name: 0.
double shear_area(const Rolled& profile);

/// Section classes of EN 1993-1-1 Table 5.2 (1: plastic with rotation, 2: plastic, 3: elastic, 4: buckles
/// before it yields).
struct Classes {
  int compression = 0;
  int bending_y = 0;  ///< about the axis across the height, either sense
  int bending_z = 0;  ///< about the other; the worse sense
};
/// f_y in Pa. An angle's least class is 3, as the table has no limits for it that would tell 1 and 2 apart.
Classes section_class(const Rolled& profile, double yield_stress);

/// A_eff, m², in uniform compression: parts of class 4 count with the width that EN 1993-1-5 4.4 leaves them,
/// each leg of an angle with its own; without such parts, A. NaN of a round tube of class 4, which EN
/// 1993-1-6 judges as a shell. f_y in Pa.
double effective_area(const Rolled& profile, double yield_stress);

}  // namespace ductile
