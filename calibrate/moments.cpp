#include "ductile/moments.h"

#include <algorithm>
#include <cmath>

#include "ductile/plane.h"

namespace ductile {

AreaMoments moments(const Outline& outline) {
  // Green's theorem over the edges, about a vertex of the outline itself.
  AreaMoments m;
  Point first{};
  const Point origin = outline.outer.empty() ? Point{} : outline.outer.front();
  const auto add = [&](const Ring& ring, double sign) {
    if (ring.empty()) return;
    if (doubled_area(ring) < 0) sign = -sign;
    Point p = ring.back() - origin;
    for (const Point& vertex : ring) {
      const Point q = vertex - origin;
      const double c = sign * cross(p, q);
      m.area += c / 2;
      first = first + (c / 6) * (p + q);
      m.xx += c / 12 * (p.x * p.x + p.x * q.x + q.x * q.x);
      m.yy += c / 12 * (p.y * p.y + p.y * q.y + q.y * q.y);
      m.xy += c / 24 * (2 * p.x * p.y + p.x * q.y + q.x * p.y + 2 * q.x * q.y);
      p = q;
    }
  };
  add(outline.outer, 1);
  for (const Ring& hole : outline.holes) add(hole, -1);
  m.centroid = origin;
  if (!(m.area > 0)) return m;
  const Point c = (1 / m.area) * first;
  m.centroid = origin + c;
  m.xx -= m.area * c.x * c.x;
  m.yy -= m.area * c.y * c.y;
  m.xy -= m.area * c.x * c.y;
  return m;
}

namespace {

// At φ with tan 2φ = 2 xy/(xx − yy), from cos² φ = (1 + cos 2φ)/2 and 2 sin φ cos φ = sin 2φ: a root has the
// same bits with any C library, an arc tangent has not. With x ≥ 0.
Point principal_direction(const AreaMoments& m) {
  const double r = std::sqrt((m.xx - m.yy) * (m.xx - m.yy) + 4 * m.xy * m.xy);
  if (!(r > 0)) return {1, 0};
  const double larger = std::sqrt((1 + std::abs(m.xx - m.yy) / r) / 2),
               smaller = std::abs(m.xy) / (r * larger);
  if (m.xx >= m.yy) return {larger, m.xy < 0 ? -smaller : smaller};
  if (smaller < 1e-9) return {0, 1};
  return {smaller, m.xy < 0 ? -larger : larger};
}

}  // namespace

LongAxis long_axis(const Outline& outline, const AreaMoments& m) {
  LongAxis axis{principal_direction(m)};
  for (const Point& p : outline.outer) {
    axis.low = std::min(axis.low, dot(p - m.centroid, axis.direction));
    axis.high = std::max(axis.high, dot(p - m.centroid, axis.direction));
  }
  return axis;
}

}  // namespace ductile
