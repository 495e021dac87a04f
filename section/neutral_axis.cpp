// The plastic neutral axis: the root of the falling, piecewise quadratic G(s) of Cut.
//
// Between two neighbouring vertex coordinates G is one quadratic, known exactly from a single pass over the
// edges. So each trial solves that quadratic; a root that falls within its range is the answer, any other is
// a Newton step with curvature, kept inside a bracket by bisection.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "section_data.h"

namespace ductile {
namespace {
constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Real>
struct Root {
  Real s, F;
  double chord;   // c there; infinite in a gap, where any s will do
  Real reported;  // s, or the middle of the gap that it borders
};

template <class Real>
Root<Real> search(const Boundary& boundary, Vec<Real> d, Real target, Real start) {
  constexpr bool is_double = std::is_same_v<Real, double>;
  const double ulp = (is_double ? eps : eps * eps) * boundary.radius;
  // N: what rounding of the coordinates as given may do to G. Two parts of equal strength with a gap between
  // them are meant to be equal when they differ by no more.
  const double rounding = 2 * eps * boundary.reach * boundary.magnitude;
  const auto is_gap = [&](const Cut<Real>& cut) {
    return !cut.inside && std::isfinite(cut.below) && std::isfinite(cut.above) &&
           std::abs(to_double(cut.difference - target)) <= rounding;
  };
  const auto middle = [&](Real s) {
    const auto [below, above] = clearance(boundary, d, s);
    return s + Real((above - below) / 2);
  };

  Real low = -boundary.radius, high = boundary.radius, s0 = start;
  double step = 2 * boundary.radius, step_before = step;
  for (;;) {
    const Cut<Real> here = cut<Real>(boundary, d, s0);
    const double rest = to_double(here.difference - target);
    (rest > 0 ? low : high) = s0;

    // rest − 2ct − c't² = 0, in the form that does not cancel.
    const double c = here.chord, discriminant = c * c + here.chord_slope * rest;
    const double t = rest == 0           ? 0
                     : discriminant >= 0 ? rest / (c + std::sqrt(discriminant))
                                         : rest / (2 * c);
    const bool in_range = discriminant >= 0 && -here.below <= t && t <= here.above && t * rest >= 0;
    const bool fine =
        is_double || std::abs(t) <= 1e-6 * boundary.radius;  // t has the digits of a double only
    const bool exhausted = to_double(high - low) <= ulp;
    if (rest == 0 || exhausted || (here.inside && (std::abs(t) <= ulp || (in_range && fine)))) {
      if (!here.inside) {
        const bool gap = is_gap(here);
        return {s0, here.moment, gap ? std::numeric_limits<double>::infinity() : 0, gap ? middle(s0) : s0};
      }
      const Real s = s0 + Real(t);
      const Real F = here.moment - (here.difference - Real((c + here.chord_slope * t / 3) * t)) * Real(t);
      // Near a vertex the root may be the rim of a gap.
      const double near = std::min(rounding / (2 * c), boundary.radius) + 4 * eps * boundary.radius;
      if (here.above - t <= near || here.below + t <= near) {
        for (const double side : {4 * near, -4 * near}) {
          const Cut<Real> probe = cut<Real>(boundary, d, s + Real(side));
          if (is_gap(probe)) return {s, F, c, middle(s + Real(side))};
        }
      }
      return {s, F, c, s};
    }

    Real next = s0 + Real(t);
    const bool newton = here.inside && low < next && next < high && 2 * std::abs(t) < step_before;
    if (!newton) next = (low + high) * Real(0.5);
    step_before = step;
    step = std::abs(to_double(next - s0));
    s0 = next;
  }
}
}  // namespace

NeutralAxis Section::Data::neutral_axis(Point direction, DoubleDouble target) const {
  const auto d = unit<double>(direction);
  const double H = to_double(strength.sum.A);
  const double centroid = (to_double(strength.sum.Sx) * d.x + to_double(strength.sum.Sy) * d.y) / H;
  const Root<double> quick = search<double>(boundary, d, to_double(target), centroid);

  const double error_G = boundary.rounding(strength.scatter, H);
  const double error_s = quick.chord > 0 ? error_G / (2 * quick.chord) : boundary.radius;
  const Point o = boundary.origin;
  if (std::max(error_s * H, error_G * boundary.radius) <= trusted * std::abs(quick.F))
    return {quick.s, quick.F, o.x * d.x + o.y * d.y + quick.reported, false};
  const auto dd = unit<DoubleDouble>(direction);
  const Root<DoubleDouble> fine = search<DoubleDouble>(boundary, dd, target, quick.s);
  return {fine.s, fine.F, to_double(dd.x * o.x + dd.y * o.y + fine.reported), true};
}

}  // namespace ductile
