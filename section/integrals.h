// Integrals over a section in closed form over its edges (Green's theorem), in either precision.
//
// With u = s − s0 and w the coordinate across (w = s turned by +90°), for every counter-clockwise boundary
//   ∬ sign(u) dA = ∮ |u| dw        ∬ |u| dA = ∮ ½ u|u| dw
// and u is linear on an edge, so each edge has a closed form; no polygon is ever clipped.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include "double_double.h"
#include "ductile/section.h"

namespace ductile {

/// The rings of all regions, end to end, relative to a local origin: an outline 10⁶ m away loses nothing but
/// what its own coordinates lost.
struct Boundary {
  struct Loop {
    std::size_t begin, end;  // vertices begin … end − 1; the last repeats the first
    std::size_t region;
    double sign;      // +1 where the solid is enclosed counter-clockwise (so −1 for a hole drawn that way)
    double strength;  // sign · (f_t + f_c)/2, Pa
  };
  Point origin;
  std::vector<Point> local;     // coordinate − origin, rounded
  std::vector<Point> residual;  // what the rounding left off, so that local + residual is exact
  std::vector<Loop> loops;

  double radius = 0;     // m: no vertex is farther from the origin
  double magnitude = 0;  // m: no coordinate as given is larger
  double reach = 0;      // N/m: Σ |strength| · length of the loops
};

template <class Real>
struct Vec {
  Real x, y;
};

template <class Real>
Vec<Real> vertex(const Boundary& boundary, std::size_t i) {
  const Point p = boundary.local[i];
  if constexpr (std::is_same_v<Real, double>) {
    return {p.x, p.y};
  } else {
    const Point r = boundary.residual[i];
    return {Real(p.x, r.x), Real(p.y, r.y)};
  }
}

/// d / |d|.
template <class Real>
Vec<Real> unit(Point d) {
  using std::sqrt;
  const double scale = std::max(std::abs(d.x), std::abs(d.y));
  const Real x = Real(d.x) / Real(scale), y = Real(d.y) / Real(scale);
  const Real length = sqrt(x * x + y * y);
  return {x / length, y / length};
}

/// Area, first and second moments about the local origin: ∬ dA, ∬ x dA, … , ∬ xy dA, weighted.
struct Moments {
  DoubleDouble A, Sx, Sy, Jxx, Jxy, Jyy;

  Moments& add(const Moments& m, double weight) {
    A += m.A * weight;
    Sx += m.Sx * weight;
    Sy += m.Sy * weight;
    Jxx += m.Jxx * weight;
    Jxy += m.Jxy * weight;
    Jyy += m.Jyy * weight;
    return *this;
  }
};

/// Of one loop, positive when it runs counter-clockwise.
Moments moments(const Boundary& boundary, const Boundary::Loop& loop);

/// What a straight line at s0 across the section divides, weighted by strength h = (f_t + f_c)/2.
template <class Real>
struct Cut {
  Real difference{};  // G = Σ h ∬ sign(s − s0) dA, N: falls from +Σ hA to −Σ hA as s0 rises
  Real moment{};      // F = Σ h ∬ |s − s0| dA, N m: dF/ds0 = −G
  double chord = 0;   // c = Σ h · length of the line inside, N/m: dG/ds0 = −2c; of the line just below s0
  double chord_slope = 0;  // dc/ds0, N/m²
  // Distance to the nearest vertex below (> 0) and above (≥ 0), m. In between G is exactly G − 2ct − c't².
  double below = std::numeric_limits<double>::infinity(), above = std::numeric_limits<double>::infinity();
  bool inside = false;  // some edge crosses the line
};

template <class Real>
Cut<Real> cut(const Boundary& boundary, Vec<Real> d, Real s0) {
  using std::abs;
  Cut<Real> cut;
  for (const Boundary::Loop& loop : boundary.loops) {
    Real G = 0.0, F = 0.0;
    double chord = 0, slope = 0;
    const Vec<Real> start = vertex<Real>(boundary, loop.begin);
    Real u1 = start.x * d.x + start.y * d.y - s0, w1 = start.y * d.x - start.x * d.y;
    Real a1 = abs(u1);
    for (std::size_t i = loop.begin + 1; i < loop.end; ++i) {
      const Vec<Real> p = vertex<Real>(boundary, i);
      const Real u2 = p.x * d.x + p.y * d.y - s0, w2 = p.y * d.x - p.x * d.y;
      const Real a2 = abs(u2), dw = w2 - w1;
      const bool up1 = !(u1 < 0.0), up2 = !(u2 < 0.0);
      if (up1 == up2) {
        G += (a1 + a2) * dw;                      // × ½: mean |u| = |u1 + u2|/2
        F += (u1 * a1 + a1 * u2 + u2 * a2) * dw;  // × 1/6: mean u|u| = ±(u1² + u1 u2 + u2²)/3
      } else {
        const Real a = a1 + a2;
        G += (a1 * a1 + a2 * a2) / a * dw;  // mean |u| = (u1² + u2²)/(2 (|u1| + |u2|))
        F += (u1 * a1 * a1 + u2 * a2 * a2) / a *
             dw;  // mean u|u| = (sgn u1 |u1|³ + sgn u2 |u2|³)/(3 (|u1| + |u2|))
        const double w = to_double(w1 + a1 / a * dw), dw_du = to_double(dw / (u2 - u1));
        chord += up1 ? w : -w;
        slope += up1 ? dw_du : -dw_du;
        cut.inside = true;
      }
      const double u = to_double(u2);
      if (up2)
        cut.above = std::min(cut.above, u);
      else
        cut.below = std::min(cut.below, -u);
      u1 = u2, w1 = w2, a1 = a2;
    }
    cut.difference += G * (loop.strength / 2);
    cut.moment += F * Real(loop.strength) / Real(6.0);
    cut.chord += loop.strength * chord;
    cut.chord_slope += loop.strength * slope;
  }
  return cut;
}

}  // namespace ductile
