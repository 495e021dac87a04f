// Bézier curves and arcs of a path: the box around them, and chords within a tolerance.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ductile/turn.h"
#include "svg_path.h"

namespace ductile::svg {
namespace {

/// The largest half diameter of an ellipse with conjugate half diameters u and v.
double half_diameter(const Point& u, const Point& v) {
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
  return std::sqrt((uu + vv + length({uu - vv, 2 * uv})) / 2);
}

}  // namespace

double stretch(const Affine& to) { return half_diameter({to.a, to.b}, {to.c, to.d}); }

namespace {

/// Calls visit(t) where a coordinate of the curve turns back within it.
template <class Visit>
void for_each_turn(const Line&, const Point&, double Point::*, const Visit&) {}
template <class Visit>
void for_each_turn(const Cubic& curve, const Point& start, double Point::*x, const Visit& visit) {
  // P'(t)/3 = a t² + b t + c
  const double p = start.*x, q = curve.control1.*x, r = curve.control2.*x;
  const double a = curve.end.*x - 3 * r + 3 * q - p, b = 2 * (r - 2 * q + p), c = q - p;
  const double s = -(b + std::copysign(std::sqrt(b * b - 4 * a * c), b)) / 2;
  for (const double t : {s / a, c / s})
    if (t > 0 && t < 1) visit(t);
}
template <class Visit>
void for_each_turn(const Arc& arc, const Point&, double Point::*x, const Visit& visit) {
  const double first = std::atan2(arc.v.*x, arc.u.*x);  // u cos t + v sin t is largest there, least π later
  const auto [low, high] = std::minmax({arc.from, arc.from + arc.sweep});
  for (double k = std::ceil((low - first) / pi); first + k * pi < high; ++k)
    visit((first + k * pi - arc.from) / arc.sweep);
}

Point at(const Line& c, const Point&, double) { return c.end; }
Point at(const Cubic& c, const Point& start, double t) {
  const double s = 1 - t;
  return s * s * s * start + 3 * s * s * t * c.control1 + 3 * s * t * t * c.control2 + t * t * t * c.end;
}
Point at(const Arc& a, const Point&, double t) {
  const Turn turn = turn_of(a.from + t * a.sweep);
  return a.center + turn.c * a.u + turn.s * a.v;
}

}  // namespace

Bounds box_around(const std::vector<Subpath>& path) {
  Bounds box;
  for (const Subpath& subpath : path) {
    if (!subpath.drawn()) continue;
    Point start = subpath.start;
    box.add(start);
    for (const Curve& curve : subpath.curves) {
      std::visit(
          [&](const auto& c) {
            for (const auto x : {&Point::x, &Point::y})
              for_each_turn(c, start, x, [&](double t) { box.add(at(c, start, t)); });
            box.add(c.end);
            start = c.end;
          },
          curve);
    }
  }
  return box;
}

namespace {

constexpr double most_chords = 10'000;           // of one curve
constexpr std::size_t most_points = 10'000'000;  // of one shape

/// How many equal steps of the parameter keep the chords within the tolerance.
double chords(const Line&, const Point&, double) { return 1; }
double chords(const Cubic& c, const Point& start, double tolerance) {
  // A chord over a step δ is off by at most δ²/8 max|P''|, and |P''| <= 6 max of the second differences.
  const double bend =
      std::max(length(start - 2 * c.control1 + c.control2), length(c.control1 - 2 * c.control2 + c.end));
  return std::ceil(std::sqrt(6. / 8 * bend / tolerance));
}
double chords(const Arc& a, const Point&, double tolerance) {
  // Sagitta r (1 − cos δ/2) = 2 r sin² δ/4; at least a chord a quarter, for the ring to have an inside.
  const double r = half_diameter(a.u, a.v);
  const double step = 4 * std::asin(std::sqrt(std::min(tolerance / (2 * r), 1.)));
  return std::ceil(std::abs(a.sweep) / std::min(step, pi / 2));
}

}  // namespace

std::vector<Polyline> flatten(const std::vector<Subpath>& path, double tolerance) {
  const double near = tolerance / 100;
  std::size_t total = 0;
  std::vector<Polyline> lines;
  for (const Subpath& subpath : path) {
    if (!subpath.drawn()) continue;
    Polyline line{{subpath.start}, subpath.closed};
    Point start = subpath.start;
    const auto add = [&](const Point& p) {
      if (length(p - line.points.back()) > near) line.points.push_back(p);
    };
    for (const Curve& curve : subpath.curves) {
      std::visit(
          [&](const auto& c) {
            const double n = std::max(chords(c, start, tolerance), 1.);
            if (!(n <= most_chords) || (total += static_cast<std::size_t>(n)) > most_points) {
              throw ShapeError("curves",
                               "need more chords than " + std::to_string(static_cast<int>(most_chords)) +
                                   " a curve or " + std::to_string(most_points) + " a shape",
                               "give a larger tolerance");
            }
            for (int i = 1; i < n; ++i) add(at(c, start, i / n));
            add(c.end);
            start = c.end;
          },
          curve);
    }
    while (line.closed && line.points.size() > 1 &&
           length(line.points.back() - line.points.front()) <= near) {
      line.points.pop_back();
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace ductile::svg
