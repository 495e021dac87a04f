#include "touching.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

double extent_of(const Contact& c) { return length(c.to - c.from); }

bool continues(const Contact& a, const Contact& b, double gap) {
  const Point u = a.to - a.from, w = b.to - b.from;
  const double shorter = std::min(length(u), length(w));
  return length(b.from - a.to) <= std::min(3 * gap, shorter) && 3 * std::abs(a.apart - b.apart) <= shorter &&
         dot(u, w) > 0 && std::abs(cross(u, w)) <= 1e-6 * length(u) * length(w);
}

Contact joined_to(Contact a, const Contact& b) {
  a.to = b.to;
  if (std::abs(b.apart) > std::abs(a.apart)) a.apart = b.apart;
  return a;
}

// Whether the strip between the edges of c has that of m in it: the far side of a body or of a piece, which
// is no place to join.
bool hides(const Contact& m, const Contact& c, double least) {
  if (!(std::abs(m.apart) < std::abs(c.apart))) return false;
  const Point u = unit(c.to - c.from), over = m.apart * right(unit(m.to - m.from));
  double begin = extent_of(c), end = 0;
  for (const Point& corner : {m.from, m.to, m.from + over, m.to + over}) {
    const double along = dot(corner - c.from, u), out = dot(corner - c.from, right(u));
    if (out < std::min(0.0, c.apart) - least || out > std::max(0.0, c.apart) + least) return false;
    begin = std::min(begin, along);
    end = std::max(end, along);
  }
  return std::min(end, extent_of(c)) - std::max(begin, 0.0) > 3 * least;
}

}  // namespace

std::vector<Contact> touching(const Outline& a, const Outline& b, double gap, double least) {
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
          const auto apart = [&](double along) {
            return -cross(u, r - p + ((along - dot(r - p, u)) / dot(s - r, u)) * (s - r));
          };
          if (!(to - from > 3 * std::min(gap, least))) return;
          double nearer = apart(from), farther = apart(to);
          if (std::abs(nearer) > std::abs(farther)) std::swap(nearer, farther);
          const double tilt = std::abs(farther) - (nearer * farther > 0 ? std::abs(nearer) : 0);
          if (to - from > 3 * tilt) result.push_back({p + from * u, p + to * u, farther});
        });
      });
      std::sort(result.begin() + static_cast<std::ptrdiff_t>(before), result.end(),
                [&](const Contact& x, const Contact& y) { return dot(x.from - y.from, u) < 0; });
    });
    // One pass joins what continues; the last may continue in the first.
    std::vector<Contact> joined;
    for (std::size_t i = first; i < result.size(); ++i) {
      if (!joined.empty() && continues(joined.back(), result[i], gap))
        joined.back() = joined_to(joined.back(), result[i]);
      else
        joined.push_back(result[i]);
    }
    if (joined.size() > 1 && continues(joined.back(), joined.front(), gap)) {
      joined.front() = joined_to(joined.back(), joined.front());
      joined.pop_back();
    }
    result.resize(first);
    result.insert(result.end(), joined.begin(), joined.end());
  });
  return result;
}

void keep_shared(std::vector<Contact>& all, double gap, double least) {
  const std::vector<Contact> found = all;
  std::erase_if(all, [&](const Contact& c) {
    return std::any_of(found.begin(), found.end(), [&](const Contact& m) { return hides(m, c, least); });
  });
  double nearest = gap;
  for (const Contact& c : all) nearest = std::min(nearest, std::abs(c.apart));
  const auto keep = [&](const auto& counts) {
    if (std::none_of(all.begin(), all.end(), counts)) return false;
    std::erase_if(all, [&](const Contact& c) { return !counts(c); });
    return true;
  };
  keep([&](const Contact& c) { return extent_of(c) > 3 * gap; }) ||
      keep([](const Contact& c) { return extent_of(c) > 3 * std::abs(c.apart); }) ||
      keep([&](const Contact& c) { return std::abs(c.apart) <= nearest + least; });
}

}  // namespace ductile::calibration
