// Vectors of the plane, for the .cpp files of this room.
#pragma once

#include <algorithm>
#include <cmath>
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
constexpr Point left(Point a) { return {-a.y, a.x}; }
constexpr Point right(Point a) { return {a.y, -a.x}; }
constexpr Point middle(Point a, Point b) { return {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2}; }
inline double length(Point a) { return std::sqrt(dot(a, a)); }  // of what does not over- or underflow: metres
inline Point unit(Point a) { return (1 / length(a)) * a; }

struct Box {
  Point low, high;
  double diagonal() const { return length(high - low); }
};
/// Around a point at least.
inline Box box_of(std::span<const Point> points) {
  Box box{points.front(), points.front()};
  for (const Point& p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

namespace exact {
int orientation(Point a, Point b, Point c);
}

/// Sign of the doubled area of a, b, c, exactly: +1 where c is left of a→b, 0 where the three are collinear.
inline int orientation(Point a, Point b, Point c) {
  // The rounded determinant decides unless it is below its own error bound, (3 + 16u)u times the sum of the
  // magnitudes with u = 2⁻⁵³ (Shewchuk 1997, ccwerrboundA); underflow only ever sends the question on.
  const double l = (a.x - c.x) * (b.y - c.y), r = (a.y - c.y) * (b.x - c.x), determinant = l - r;
  const double bound = 3.3306690738754716e-16 * (std::abs(l) + std::abs(r)) + 1e-300;
  return determinant > bound ? 1 : determinant < -bound ? -1 : exact::orientation(a, b, c);
}

/// For messages: "1.25" and "(1.25, -3)".
std::string to_string(double number);
std::string to_string(Point point);

}  // namespace ductile
