// Points of the plane and where things are in a frame.
#pragma once

#include <cmath>

#include "ductile/section.h"

namespace ductile::viewer {

inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
inline Point operator*(double s, Point p) { return {s * p.x, s * p.y}; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
inline double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
inline double length(Point p) { return std::hypot(p.x, p.y); }
/// Turned by +90°.
inline Point left(Point p) { return {-p.y, p.x}; }

/// A turn by an angle, rad.
struct Turn {
  explicit Turn(double angle) : c(std::cos(angle)), s(std::sin(angle)) {}
  Point operator*(Point p) const { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
  /// The other way round.
  Point back(Point p) const { return {c * p.x + s * p.y, -s * p.x + c * p.y}; }
  double c, s;
};

/// An axis-aligned box; empty until a point is in it.
struct Box {
  Point low{1e300, 1e300}, high{-1e300, -1e300};
  void add(Point p) {
    low = {std::fmin(low.x, p.x), std::fmin(low.y, p.y)};
    high = {std::fmax(high.x, p.x), std::fmax(high.y, p.y)};
  }
  bool empty() const { return low.x > high.x; }
  bool contains(Point p) const { return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y; }
  Point middle() const { return 0.5 * (low + high); }
  Point size() const { return high - low; }
};

}  // namespace ductile::viewer
