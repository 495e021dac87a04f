#include "moments.h"

#include "plane.h"

namespace ductile {

double doubled_area(const Ring& ring) {
  double sum = 0;
  if (ring.empty()) return sum;
  const Point origin = ring.front();
  for (std::size_t i = 2; i < ring.size(); ++i) sum += cross(ring[i - 1] - origin, ring[i] - origin);
  return sum;
}

Moments moments(const Outline& outline) {
  // Green's theorem over the edges, about a vertex of the outline itself.
  double area = 0, polar = 0;
  Point first{};
  const Point origin = outline.outer.empty() ? Point{} : outline.outer.front();
  const auto add = [&](const Ring& ring, double sign) {
    if (ring.empty()) return;
    if (doubled_area(ring) < 0) sign = -sign;
    Point p = ring.back() - origin;
    for (const Point& vertex : ring) {
      const Point q = vertex - origin;
      const double c = sign * cross(p, q);
      area += c / 2;
      first = first + (c / 6) * (p + q);
      polar += c / 12 * (dot(p, p) + dot(p, q) + dot(q, q));
      p = q;
    }
  };
  add(outline.outer, 1);
  for (const Ring& hole : outline.holes) add(hole, -1);
  if (!(area > 0)) return {area, origin, 0};
  const Point centre = (1 / area) * first;
  return {area, origin + centre, polar - area * dot(centre, centre)};
}

}  // namespace ductile
