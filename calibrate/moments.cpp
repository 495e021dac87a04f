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

LongAxis long_axis(const Outline& outline, const AreaMoments& m) {
  const double angle = std::atan2(2 * m.xy, m.xx - m.yy) / 2;
  LongAxis axis{std::abs(std::cos(angle)) > 1e-9 ? Point{std::cos(angle), std::sin(angle)} : Point{0, 1}};
  for (const Point& p : outline.outer) {
    axis.low = std::min(axis.low, dot(p - m.centroid, axis.direction));
    axis.high = std::max(axis.high, dot(p - m.centroid, axis.direction));
  }
  return axis;
}

}  // namespace ductile
