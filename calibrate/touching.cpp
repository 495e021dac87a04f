#include "touching.h"

#include <algorithm>
#include <cmath>

#include "ductile/plane.h"

namespace ductile::calibration {
namespace {

template <class Visit>
void for_each_ring(const Outline& outline, Visit visit) {
  visit(outline.outer);
  for (const Ring& hole : outline.holes) visit(hole);
}

template <class Visit>
void for_each_edge(const Ring& ring, Visit visit) {
  for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[i + 1 < ring.size() ? i + 1 : 0]);
}

// The part of the edge p→q within `gap` of the line through `origin` along the unit vector u, as coordinates
// along u, lowest first; empty where it runs the same way.
struct Range {
  double from, to;
};
Range shadow(Point origin, Point u, Point p, Point q, double gap) {
  const double s = dot(p - origin, u), t = dot(q - origin, u);
  if (t >= s) return {0, 0};
  const double a = cross(u, p - origin), b = cross(u, q - origin);
  double begin = 0, end = 1;  // of p→q
  for (const double sign : {1.0, -1.0}) {
    const double at_begin = gap - sign * a, at_end = gap - sign * b;  // ≥ 0 where within
    if (at_begin < 0 && at_end < 0) return {0, 0};
    if (at_begin < 0) begin = std::max(begin, at_begin / (at_begin - at_end));
    if (at_end < 0) end = std::min(end, at_begin / (at_begin - at_end));
  }
  if (begin >= end) return {0, 0};
  return {s + end * (t - s), s + begin * (t - s)};
}

bool continues(const Contact& a, const Contact& b, double gap) {
  const Point u = a.to - a.from, w = b.to - b.from;
  return length(b.from - a.to) <= gap && dot(u, w) > 0 &&
         std::abs(cross(u, w)) <= 1e-6 * length(u) * length(w);
}

}  // namespace

std::vector<Contact> touching(const Outline& a, const Outline& b, double gap) {
  std::vector<Contact> result;
  for_each_ring(a, [&](const Ring& ring) {
    const std::size_t first = result.size();
    for_each_edge(ring, [&](Point p, Point q) {
      const double extent = length(q - p);
      const Point u = unit(q - p);
      const std::size_t before = result.size();
      for_each_ring(b, [&](const Ring& other) {
        for_each_edge(other, [&](Point r, Point s) {
          const Range range = shadow(p, u, r, s, gap);
          const double from = std::max(range.from, 0.0), to = std::min(range.to, extent);
          if (to - from > 3 * gap) result.push_back({p + from * u, p + to * u});
        });
      });
      std::sort(result.begin() + static_cast<std::ptrdiff_t>(before), result.end(),
                [&](const Contact& x, const Contact& y) { return dot(x.from - y.from, u) < 0; });
    });
    // One pass joins what continues; the last may continue in the first.
    std::vector<Contact> joined;
    for (std::size_t i = first; i < result.size(); ++i) {
      if (!joined.empty() && continues(joined.back(), result[i], 3 * gap))
        joined.back().to = result[i].to;
      else
        joined.push_back(result[i]);
    }
    if (joined.size() > 1 && continues(joined.back(), joined.front(), 3 * gap)) {
      joined.front().from = joined.back().from;
      joined.pop_back();
    }
    result.resize(first);
    result.insert(result.end(), joined.begin(), joined.end());
  });
  return result;
}

}  // namespace ductile::calibration
