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
#include <utility>

#include "boundary.h"
#include "double_double.h"

namespace ductile {

/// A sum in double is taken where rounding leaves less of it, relative; else it is done at twice the
/// precision.
constexpr double trusted = 5e-14;

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

/// d / |d|; d finite and not zero.
template <class Real>
Vec<Real> unit(Point d) {
  const int exponent = std::ilogb(std::max(std::abs(d.x), std::abs(d.y)));
  const double x = std::scalbn(d.x, -exponent), y = std::scalbn(d.y, -exponent);
  const double inverse = 1 / std::sqrt(x * x + y * y);
  if constexpr (std::is_same_v<Real, double>) {
    return {x * inverse, y * inverse};
  } else {
    const Real square = two_product(x, x) + two_product(y, y);
    const double rest = to_double(Real(1.0) - square * two_product(inverse, inverse));
    const Real exact = quick_two_sum(inverse, inverse * rest / 2);  // one Newton step
    return {exact * x, exact * y};
  }
}

/// Area and first moments about the local origin: ∬ dA, ∬ x dA, ∬ y dA, weighted.
template <class Real>
struct Moments {
  Real A{}, Sx{}, Sy{};

  void add(const Moments& m, double weight) {
    A += m.A * weight;
    Sx += m.Sx * weight;
    Sy += m.Sy * weight;
  }
};

/// Calls `block(i, j)` for vertices i … j of the loop, some dozens at a time: sums of sums lose less than one
/// long sum.
template <class Block>
void in_blocks(const Boundary::Loop& loop, const Block& block) {
  constexpr std::size_t some = 64;
  for (std::size_t i = loop.begin; i < loop.end; i += some) block(i, std::min(i + some, loop.end));
}

/// Of one loop, positive when it runs counter-clockwise.
template <class Real>
Moments<Real> moments(const Boundary& boundary, const Boundary::Loop& loop) {
  Moments<Real> sum;
  in_blocks(loop, [&](std::size_t i, std::size_t end) {
    Real A = 0.0, Sx = 0.0, Sy = 0.0;
    for (Vec<Real> p = vertex<Real>(boundary, i); i < end;) {
      const Vec<Real> q = vertex<Real>(boundary, ++i);
      const Real cross = p.x * q.y - q.x * p.y;
      A += cross;
      Sx += (p.x + q.x) * cross;
      Sy += (p.y + q.y) * cross;
      p = q;
    }
    sum.A += A;
    sum.Sx += Sx;
    sum.Sy += Sy;
  });
  return {sum.A / Real(2.0), sum.Sx / Real(6.0), sum.Sy / Real(6.0)};
}

/// Of one loop about a line at s0 across d: ∬ (s − s0)² dA, positive when it runs counter-clockwise, and how
/// far it reaches to both sides.
template <class Real>
struct Bending {
  Real second{}, above{}, below{};
};

template <class Real>
Bending<Real> bending(const Boundary& boundary, const Boundary::Loop& loop, Vec<Real> d, Real s0) {
  Bending<Real> result;
  in_blocks(loop, [&](std::size_t i, std::size_t end) {
    Real sum = 0.0;
    Vec<Real> p = vertex<Real>(boundary, i);
    Real u1 = p.x * d.x + p.y * d.y - s0, w1 = p.y * d.x - p.x * d.y;
    while (i < end) {
      p = vertex<Real>(boundary, ++i);
      const Real u2 = p.x * d.x + p.y * d.y - s0, w2 = p.y * d.x - p.x * d.y;
      sum += (u1 * u1 + u1 * u2 + u2 * u2) * (u1 * w2 - u2 * w1);
      if (result.above < u2) result.above = u2;
      if (result.below < -u2) result.below = -u2;
      u1 = u2, w1 = w2;
    }
    result.second += sum;
  });
  result.second = result.second / Real(12.0);
  return result;
}

/// What a straight line at s0 across the section divides, weighted by strength h = (f_t + f_c)/2.
template <class Real>
struct Cut {
  Real difference{};  // G = Σ h ∬ sign(s − s0) dA, N: falls from +Σ hA to −Σ hA as s0 rises
  Real moment{};      // F = Σ h ∬ |s − s0| dA, N m: dF/ds0 = −G
  double chord = 0;   // c = Σ h · length of the line inside, N/m: dG/ds0 = −2c; of the line just below s0
  double chord_slope = 0;  // c' = dc/ds0, N/m²
  // No vertex is nearer below (> 0) and above (≥ 0), m. In between G is exactly G − 2ct − c't².
  double below = std::numeric_limits<double>::infinity(), above = std::numeric_limits<double>::infinity();
  bool inside = false;  // some edge crosses the line
};

/// Adds one run, edge by edge.
template <class Real>
void add_edges(Cut<Real>& cut, const Boundary& boundary, const Boundary::Run& run, Vec<Real> d, Real s0) {
  using std::abs;
  Real G = 0.0, F = 0.0;
  double chord = 0, slope = 0;
  Vec<Real> p = vertex<Real>(boundary, run.begin);
  Real u1 = p.x * d.x + p.y * d.y - s0, w1 = p.y * d.x - p.x * d.y, a1 = abs(u1);
  for (std::size_t i = run.begin + 1; i <= run.end; ++i) {
    p = vertex<Real>(boundary, i);
    const Real u2 = p.x * d.x + p.y * d.y - s0, w2 = p.y * d.x - p.x * d.y, a2 = abs(u2), dw = w2 - w1;
    const bool up1 = !(u1 < 0.0), up2 = !(u2 < 0.0);
    if (up1 == up2) {
      G += (a1 + a2) * dw;                      // mean |u| = |u1 + u2|/2
      F += (u1 * a1 + a1 * u2 + u2 * a2) * dw;  // mean u|u| = ±(u1² + u1 u2 + u2²)/3
    } else {
      const Real a = a1 + a2;
      G += (a1 * a1 + a2 * a2) / a * dw;            // mean |u| = (u1² + u2²)/(2 (|u1| + |u2|))
      F += (u1 * a1 * a1 + u2 * a2 * a2) / a * dw;  // mean u|u| = (u1 |u1|² + u2 |u2|²)/(3 (|u1| + |u2|))
      const double w = to_double(w1 + a1 / a * dw), dw_du = to_double(dw / (u2 - u1));
      chord += up1 ? w : -w;
      slope += up1 ? dw_du : -dw_du;
      cut.inside = true;
    }
    (up2 ? cut.above : cut.below) = std::min(up2 ? cut.above : cut.below, to_double(a2));
    u1 = u2, w1 = w2, a1 = a2;
  }
  cut.difference += G * (run.strength / 2);
  cut.moment += F * (Real(run.strength) / Real(6.0));
  cut.chord += run.strength * chord;
  cut.chord_slope += run.strength * slope;
}

template <class Real>
Cut<Real> cut(const Boundary& boundary, Vec<Real> d, Real s0) {
  Cut<Real> cut;
  for (const Boundary::Run& run : boundary.runs) {
    if constexpr (std::is_same_v<Real, double>) {
      const double middle = run.centre.x * d.x + run.centre.y * d.y - s0;
      const double away = std::abs(middle) - std::abs(run.half.x * d.x) - std::abs(run.half.y * d.y);
      if (away > 0) {  // all on one side: ∫ u dw and ∫ u² dw of the whole run
        const double v0 = run.dy * d.x - run.dx * d.y;
        const double v1 = (run.x_dy * d.x - run.x_dx * d.y) * d.x + (run.y_dy * d.x - run.y_dx * d.y) * d.y;
        const double v2 = (run.xx_dy * d.x - run.xx_dx * d.y) * d.x * d.x +
                          2 * (run.xy_dy * d.x - run.xy_dx * d.y) * d.x * d.y +
                          (run.yy_dy * d.x - run.yy_dx * d.y) * d.y * d.y;
        const double sign = std::copysign(1.0, middle);
        cut.difference += sign * (v1 - s0 * v0);
        cut.moment += sign * (v2 - s0 * (2 * v1 - s0 * v0)) / 2;
        (middle > 0 ? cut.above : cut.below) = std::min(middle > 0 ? cut.above : cut.below, away);
        continue;
      }
    }
    add_edges(cut, boundary, run, d, s0);
  }
  return cut;
}

/// Distances from the line at s0 to the nearest vertices below and above, m; infinite where there is none.
template <class Real>
std::pair<double, double> clearance(const Boundary& boundary, Vec<Real> d, Real s0) {
  double below = std::numeric_limits<double>::infinity(), above = below;
  for (std::size_t i = 0; i < boundary.local.size(); ++i) {
    const Vec<Real> p = vertex<Real>(boundary, i);
    const double u = to_double(p.x * d.x + p.y * d.y - s0);
    (u < 0 ? below : above) = std::min(u < 0 ? below : above, std::abs(u));
  }
  return {below, above};
}

}  // namespace ductile
