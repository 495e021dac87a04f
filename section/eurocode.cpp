// Rules of EN 1993-1-1:2005, and of EN 1993-1-5:2006 for class 4, that need a profile's parts by name.
#include <algorithm>
#include <cmath>
#include <limits>
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
    case Shape::channel: {
      // Its corners turn by a right angle less the slope's; an arc there fills r² (tan(turn/2) − turn/2).
      const double outstand = p.b - p.tw, turn = pi / 2 - std::atan(p.slope);
      return p.h * p.tw + 2 * outstand * (p.tf + p.slope * (outstand / 2 - p.u)) +
             2 * (p.r * p.r - p.toe * p.toe) * (std::tan(turn / 2) - turn / 2);
    }
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

double epsilon(double yield_stress) { return std::sqrt(235e6 / yield_stress); }

/// c/t of a web or side, and of what stands out from it or the other side; of an angle, of its legs.
struct Slenderness {
  double web, flange;
};
Slenderness slenderness(const Rolled& p) {
  switch (p.shape) {
    case Shape::i_section:
      return {(p.h - 2 * p.tf - 2 * p.r) / p.tw, (p.b - p.tw - 2 * p.r) / 2 / p.tf};
    case Shape::channel: {
      // The web is straight between the fillets' ends, which a slope moves toward each other.
      const double at_web = p.tf + p.slope * (p.b - p.u - p.tw),
                   fillet = p.r * (std::hypot(1, p.slope) - p.slope);
      return {(p.h - 2 * at_web - 2 * fillet) / p.tw, (p.b - p.tw - p.r) / p.tf};
    }
    case Shape::angle:
      return {p.h / p.tw, p.b / p.tw};
    case Shape::round_tube:
      return {p.h / p.tw, p.h / p.tw};
    case Shape::rectangular_tube:
      break;
  }
  // c = b − 3 t, between the corners' inner ends as EN 10210-2 rounds them.
  return {p.h / p.tw - 3, p.b / p.tw - 3};
}

/// (1 − ρ) c t, m², of a part of class 4 whose stress is uniform, ψ = 1: EN 1993-1-5 4.4 (2), tables 4.1
/// and 4.2.
double lost(double c_t, double t, double e, bool internal) {
  const double buckling = c_t / (28.4 * e * std::sqrt(internal ? 4 : 0.43)),
               rho = (buckling - (internal ? 0.22 : 0.188)) / (buckling * buckling);
  return (1 - std::min(rho, 1.0)) * c_t * t * t;
}

}  // namespace

double shear_area(const Rolled& p) {
  const double A = area(p);
  switch (p.shape) {
    case Shape::i_section:  // 6.2.6 (3) a; never below h_w t_w
      return A - 2 * p.b * p.tf + (p.tw + 2 * p.r) * p.tf;
    case Shape::channel: {
      // b, whose last t_f is the flange's at the web. Of a tapered flange, catalogues take it at the web's
      // face, of those higher than 300 mm at the web's centre line.
      const double from_back = p.h > 0.3 ? p.tw / 2 : p.tw;
      const double at_web = p.tf + p.slope * (p.b - p.u - from_back);
      return A - 2 * p.b * p.tf + (p.tw + p.r) * at_web;
    }
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
  const double e = epsilon(yield_stress);
  const auto [web, flange] = slenderness(p);
  switch (p.shape) {
    case Shape::i_section: {
      const int tip = outstand(flange, e);
      // About z the web lies on the neutral axis, and half of each flange is bent with its tip compressed:
      // held to the limits of uniform compression, which are the stricter ones.
      return {std::max(compressed(web, e), tip), std::max(bent(web, e), tip), tip};
    }
    case Shape::channel: {
      const int tip = outstand(flange, e);
      const int back = compressed(web, e);  // about z, when the back is in compression
      return {std::max(back, tip), std::max(bent(web, e), tip), std::max(back, tip)};
    }
    case Shape::angle: {
      const double s = 1 - 1e-12;
      const int pressed = std::max(web, flange) * s <= 15 * e && (web + flange) / 2 * s <= 11.5 * e ? 3 : 4;
      const int leg = std::max({3, outstand(web, e), outstand(flange, e)});
      return {pressed, leg, leg};
    }
    case Shape::round_tube: {
      const int wall = round_tube(web, e);
      return {wall, wall, wall};
    }
    case Shape::rectangular_tube:
      break;
  }
  return {std::max(compressed(web, e), compressed(flange, e)), std::max(bent(web, e), compressed(flange, e)),
          std::max(compressed(web, e), bent(flange, e))};
}

double effective_area(const Rolled& p, double yield_stress) {
  const double A = area(p), e = epsilon(yield_stress);
  if (section_class(p, yield_stress).compression < 4) return A;
  const auto [web, flange] = slenderness(p);
  const auto side = [&](double c_t) { return compressed(c_t, e) == 4 ? lost(c_t, p.tw, e, true) : 0; };
  const double tip = outstand(flange, e) == 4 ? lost(flange, p.tf, e, false) : 0;
  switch (p.shape) {
    case Shape::i_section:
      return A - side(web) - 4 * tip;
    case Shape::channel:
      return A - side(web) - 2 * tip;
    case Shape::angle:
      return A - lost(web, p.tw, e, false) - lost(flange, p.tw, e, false);
    case Shape::round_tube:
      return std::numeric_limits<double>::quiet_NaN();
    case Shape::rectangular_tube:
      break;
  }
  return A - 2 * side(web) - 2 * side(flange);
}

}  // namespace ductile
