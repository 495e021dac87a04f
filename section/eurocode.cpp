// Rules of EN 1993-1-1:2005 that need a profile's parts by name.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ductile/rolled.h"

namespace ductile {
namespace {

constexpr double pi = std::numbers::pi;

/// Gross area, m².
double area(const Rolled& p) {
  switch (p.shape) {
    case Shape::i_section:
      return 2 * p.b * p.tf + (p.h - 2 * p.tf) * p.tw + (4 - pi) * p.r * p.r;
    case Shape::channel:
      return 2 * p.b * p.tf + (p.h - 2 * p.tf) * p.tw + (2 - pi / 2) * p.r * p.r;
    case Shape::angle:
      return p.tw * (p.h + p.b - p.tw) + (1 - pi / 4) * (p.r * p.r - 2 * p.toe * p.toe);
    case Shape::round_tube:
      return pi * p.tw * (p.h - p.tw);
    case Shape::rectangular_tube:
      break;
  }
  return 2 * p.tw * (p.h + p.b - 2 * p.tw) - (4 - pi) * (p.toe * p.toe - p.r * p.r);
}

/// Table 5.2: the least class whose limit the slenderness keeps, else 4.
int of(double slenderness, double first, double second, double third) {
  // Dimensions are decimal: a limit that is met exactly is kept in spite of rounding.
  const double s = slenderness * (1 - 1e-12);
  return s <= first ? 1 : s <= second ? 2 : s <= third ? 3 : 4;
}
// Sheet 1, internal parts; sheet 2, outstand flanges; sheet 3, round tubes. e = ε.
int bent(double c_t, double e) { return of(c_t, 72 * e, 83 * e, 124 * e); }
int compressed(double c_t, double e) { return of(c_t, 33 * e, 38 * e, 42 * e); }
int outstand(double c_t, double e) { return of(c_t, 9 * e, 10 * e, 14 * e); }
int round_tube(double d_t, double e) { return of(d_t, 50 * e * e, 70 * e * e, 90 * e * e); }

}  // namespace

double shear_area(const Rolled& p) {
  const double A = area(p);
  switch (p.shape) {
    case Shape::i_section:  // 6.2.6 (3) a; never below h_w t_w
      return A - 2 * p.b * p.tf + (p.tw + 2 * p.r) * p.tf;
    case Shape::channel:  // b
      return A - 2 * p.b * p.tf + (p.tw + p.r) * p.tf;
    case Shape::angle:
      return 0;
    case Shape::round_tube:  // g
      return 2 * A / pi;
    case Shape::rectangular_tube:  // f, load parallel to the depth
      break;
  }
  return A * p.h / (p.b + p.h);
}

Classes section_class(const Rolled& p, double yield_stress) {
  const double e = std::sqrt(235e6 / yield_stress);
  switch (p.shape) {
    case Shape::i_section: {
      const double web = (p.h - 2 * p.tf - 2 * p.r) / p.tw, flange = (p.b - p.tw - 2 * p.r) / 2 / p.tf;
      const int tip = outstand(flange, e);
      // About z the web lies on the neutral axis, and half of each flange is bent with its tip compressed:
      // held to the limits of uniform compression, which are the stricter ones.
      return {std::max(compressed(web, e), tip), std::max(bent(web, e), tip), tip};
    }
    case Shape::channel: {
      const double web = (p.h - 2 * p.tf - 2 * p.r) / p.tw, flange = (p.b - p.tw - p.r) / p.tf;
      const int tip = outstand(flange, e);
      const int back = compressed(web, e);  // about z, when the back is in compression
      return {std::max(back, tip), std::max(bent(web, e), tip), std::max(back, tip)};
    }
    case Shape::angle: {
      const double leg = std::max(p.h, p.b) / p.tw, both = (p.b + p.h) / (2 * p.tw);
      const double s = 1 - 1e-12;
      const int pressed = leg * s <= 15 * e && both * s <= 11.5 * e ? 3 : 4;
      const int up = std::max(3, outstand(p.h / p.tw, e)), across = std::max(3, outstand(p.b / p.tw, e));
      return {pressed, std::max(up, across), std::max(up, across)};
    }
    case Shape::round_tube: {
      const int wall = round_tube(p.h / p.tw, e);
      return {wall, wall, wall};
    }
    case Shape::rectangular_tube:
      break;
  }
  // c = b − 3 t, between the corners' inner ends as EN 10210-2 rounds them.
  const double side = p.h / p.tw - 3, top = p.b / p.tw - 3;
  return {std::max(compressed(side, e), compressed(top, e)), std::max(bent(side, e), compressed(top, e)),
          std::max(compressed(side, e), bent(top, e))};
}

}  // namespace ductile
