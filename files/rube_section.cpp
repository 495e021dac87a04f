#include "rube_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/moments.h"
#include "ductile/plane.h"

namespace ductile::rube {
namespace {

template <class Visit>
void for_each_edge(const Outline& outline, const Visit& visit) {
  const auto ring = [&](const Ring& points) {
    for (std::size_t i = 0; i < points.size(); ++i) visit(points[i], points[(i + 1) % points.size()]);
  };
  ring(outline.outer);
  for (const Ring& hole : outline.holes) ring(hole);
}

/// Of the area within the outer ring.
struct Shape {
  double area = 0;
  Point centroid;
  LongAxis axis;
  double extent = 0;       // along the axis
  double slenderness = 1;  // ratio of the radii of gyration

  explicit Shape(const Outline& outline) {
    const Outline ring{outline.outer, {}};
    const AreaMoments m = moments(ring);
    area = m.area;
    centroid = m.centroid;
    if (!(area > 0)) return;
    axis = long_axis(ring, m);
    extent = axis.high - axis.low;
    const double mean = m.polar() / 2, spread = std::hypot((m.xx - m.yy) / 2, m.xy);
    slenderness = mean > spread ? std::sqrt((mean + spread) / (mean - spread)) : unlimited;
  }
};

/// The stretch inside the outline, on the line through p along the unit vector v, that is nearest to p.
std::optional<std::array<Point, 2>> stretch(const Outline& outline, Point p, Point v) {
  std::vector<double> crossings;
  for_each_edge(outline, [&](Point a, Point b) {
    const double s = cross(v, a - p), t = cross(v, b - p);
    if ((s > 0) != (t > 0)) crossings.push_back(dot(v, a - p) + s / (s - t) * dot(v, b - a));
  });
  std::sort(crossings.begin(), crossings.end());
  std::optional<std::array<Point, 2>> nearest;
  double least = unlimited;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const double away = std::max({0.0, crossings[i], -crossings[i + 1]});
    if (away >= least) continue;
    least = away;
    nearest = {p + crossings[i] * v, p + crossings[i + 1] * v};
  }
  return nearest;
}

}  // namespace

bool share_an_edge(const Outline& a, const Outline& b, double gap) {
  bool shared = false;
  for_each_edge(a, [&](Point p, Point q) {
    const double size = length(q - p);
    if (shared || !(size > 6 * gap)) return;
    const Point u = (1 / size) * (q - p);
    for_each_edge(b, [&](Point r, Point s) {
      if (std::abs(cross(u, r - p)) > gap || std::abs(cross(u, s - p)) > gap) return;
      const auto [from, to] = std::minmax({dot(u, r - p), dot(u, s - p)});
      shared |= dot(u, s - r) < 0 && std::min(to, size) - std::max(from, 0.0) > 6 * gap;
    });
  });
  return shared;
}

namespace {

/// The cut perpendicular to u that is nearest to the anchor, from there inwards.
std::optional<std::array<Point, 2>> cut_across(const Outline& outline, const Shape& shape, Point anchor,
                                               Point u) {
  const Point out = anchor - shape.centroid;
  const auto at = [&](double along) {
    return stretch(outline, shape.centroid + along * u + dot(out, left(u)) * left(u), left(u));
  };
  const auto height = [](const auto& cut) { return cut ? length((*cut)[1] - (*cut)[0]) : 0; };
  const double away = dot(out, u), inwards = away > 0 ? -1 : 1;
  constexpr int steps = 100;
  for (int i = 0; i <= steps; ++i) {
    const double along = away * (1 - (i == 0 ? 1e-9 : double(i) / steps));
    const auto cut = at(along);
    const double own = height(cut);
    // Not at a tip or on a round end, where the outline is much higher one height further in.
    const double further = height(at(std::abs(along) > own ? along + inwards * own : 0));
    if (own >= shape.area / shape.extent / 10 && own >= 0.7 * further) return cut;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::array<Point, 2>> cut_at(const Outline& outline, Point anchor) {
  const Shape shape(outline);
  if (!(shape.area > 0) || !(shape.extent > 0)) return std::nullopt;
  const Point out = anchor - shape.centroid;
  const bool directed = shape.slenderness > 1.1 || !(length(out) > 0.25 * std::sqrt(shape.area));
  const Point u = directed ? shape.axis.direction : unit(out);
  const auto one = cut_across(outline, shape, anchor, u), other = cut_across(outline, shape, anchor, left(u));
  const auto height = [](const auto& cut) { return cut ? length((*cut)[1] - (*cut)[0]) : unlimited; };
  return height(other) < height(one) ? other : one;
}

}  // namespace ductile::rube
