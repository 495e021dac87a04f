// The plane: vectors, bounds, rotations and frames, segments and rings. m and rad, unless said otherwise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <span>
#include <string>

#include "ductile/section.h"

namespace ductile {

constexpr Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
constexpr Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
constexpr Point operator-(Point a) { return {-a.x, -a.y}; }
constexpr Point operator*(double s, Point a) { return {s * a.x, s * a.y}; }
constexpr double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
constexpr double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
/// Turned by +90° and by −90°.
constexpr Point left(Point a) { return {-a.y, a.x}; }
constexpr Point right(Point a) { return {a.y, -a.x}; }
constexpr Point middle(Point a, Point b) { return {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2}; }
/// Of coordinates whose squares neither over- nor underflow.
inline double length(Point a) { return std::sqrt(dot(a, a)); }
inline Point unit(Point a) { return (1 / length(a)) * a; }

/// An axis-aligned box; empty until a point is in it.
struct Bounds {
  Point low{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  Point high{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest()};

  void add(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  bool empty() const { return low.x > high.x; }
  bool contains(Point p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  /// Are they no further apart than `gap` along either axis?
  bool meets(const Bounds& other, double gap = 0) const {
    return low.x <= other.high.x + gap && other.low.x <= high.x + gap && low.y <= other.high.y + gap &&
           other.low.y <= high.y + gap;
  }
  Point size() const { return high - low; }
  Point middle() const { return 0.5 * (low + high); }
  double diagonal() const { return length(size()); }
};
inline Bounds bounds_of(std::span<const Point> points) {
  Bounds bounds;
  for (const Point& p : points) bounds.add(p);
  return bounds;
}

/// A rotation by an angle.
struct Rotation {
  double cosine = 1, sine = 0;

  Rotation() = default;
  explicit Rotation(double angle) : cosine(std::cos(angle)), sine(std::sin(angle)) {}
  Point operator*(Point p) const { return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y}; }
  Point inverse(Point p) const { return {cosine * p.x + sine * p.y, cosine * p.y - sine * p.x}; }
};

/// A coordinate frame in the world, a body's for instance.
struct Frame {
  Point origin;
  double angle = 0;
  Rotation rotation{angle};

  Point world(Point local) const { return origin + rotation * local; }
  Point local(Point world) const { return rotation.inverse(world - origin); }
};

/// From a point to the nearest of a segment.
inline double distance(Point p, Point from, Point to) {
  const Point along = to - from;
  const double square = dot(along, along);
  const double share = square > 0 ? std::clamp(dot(p - from, along) / square, 0.0, 1.0) : 0;
  return length(p - from - share * along);
}

/// Is a point inside a simple ring? One on its edge may be either.
inline bool contains(const Ring& ring, Point p) {
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point a = ring[i], b = ring[j];
    if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}
/// In the outer ring and in no hole?
inline bool contains(const Outline& outline, Point p) {
  return contains(outline.outer, p) && std::none_of(outline.holes.begin(), outline.holes.end(),
                                                    [p](const Ring& hole) { return contains(hole, p); });
}

/// The chord of a simple ring through a point, m along a direction of length 1; 0 from outside.
inline double chord(const Ring& ring, Point at, Point along) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double back = -infinity, on = infinity;
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point a = ring[j] - at, b = ring[i] - at;
    const double from = cross(along, a), to = cross(along, b);
    if ((from > 0) == (to > 0)) continue;
    const double s = dot(along, a + (from / (from - to)) * (b - a));
    if (s > 0) {
      on = std::min(on, s);
      inside = !inside;
    } else {
      back = std::max(back, s);
    }
  }
  return inside && back > -infinity ? on - back : 0;
}

/// For messages: "1.25" and "(1.25, -3)".
inline std::string to_string(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}
inline std::string to_string(Point point) {
  return '(' + to_string(point.x) + ", " + to_string(point.y) + ')';
}

}  // namespace ductile
