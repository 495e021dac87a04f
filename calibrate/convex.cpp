#include "convex.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ductile/calibrate.h"
#include "ductile/moments.h"
#include "orientation.h"
#include "triangulation.h"

namespace ductile::calibration {
namespace {

// The triangulation's triangles, merged to larger polygons.
class Parts {
 public:
  /// What is straight within `tolerance` of the outline's size counts as convex.
  Parts(const Triangulation& triangles, double tolerance)
      : points_(triangles.points),
        edges_(triangles.edges),
        straight_(tolerance * bounds_of(points_).diagonal()) {}

  // Hertel and Mehlhorn: leave out every edge whose absence leaves its ends convex, the longest first, which
  // does away with slivers.
  void merge(int most_vertices) {
    std::vector<std::pair<double, int>> inner;  // −length, half-edge
    for (int e = 0; e < size(); ++e)
      if (e < edges_[e].twin) inner.emplace_back(-length(points_[to(e)] - points_[from(e)]), e);
    std::sort(inner.begin(), inner.end());
    for (const auto& [_, e] : inner) {
      const int f = edges_[e].twin;
      const HalfEdge one = edges_[e], two = edges_[f];
      if (count(e) + count(f) - 2 > most_vertices || !convex(from(one.previous), from(e), to(two.next)) ||
          !convex(from(two.previous), from(f), to(one.next)))
        continue;
      edges_[one.previous].next = two.next;
      edges_[two.next].previous = one.previous;
      edges_[two.previous].next = one.next;
      edges_[one.next].previous = two.previous;
      edges_[e].next = edges_[f].next = -1;
    }
  }

  /// Afterwards edges are used up.
  std::vector<Ring> rings() {
    std::vector<Ring> result;
    for (int start = 0; start < size(); ++start) {
      if (edges_[start].next < 0) continue;
      Ring ring;
      ring.reserve(static_cast<std::size_t>(count(start)));
      for (int e = start; edges_[e].next >= 0;) {
        ring.push_back(points_[from(e)]);
        e = std::exchange(edges_[e].next, -1);
      }
      const double area = doubled_area(ring);
      make_strictly_convex(ring);
      area_ += area;
      changed_ += std::abs(doubled_area(ring) - area);
      if (ring.size() > 2) result.push_back(std::move(ring));
    }
    return result;
  }

  /// The share of their area that rings() had to change to make polygons convex.
  double changed() const { return changed_ / area_; }

 private:
  int size() const { return static_cast<int>(edges_.size()); }
  int from(int e) const { return edges_[e].from; }
  int to(int e) const { return edges_[edges_[e].next].from; }

  int count(int start) const {
    int n = 1;
    for (int e = edges_[start].next; e != start; e = edges_[e].next) ++n;
    return n;
  }

  // Straight on counts as convex; straight back, as at the foot of a spike without width, does not.
  bool convex(int a, int b, int c) const {
    const Point p = points_[b] - points_[a], q = points_[c] - points_[b];
    const double rounding = straight_ * length(p + q),
                 bend = straight_ > 0 ? cross(p, q) : orientation(points_[a], points_[b], points_[c]);
    return bend > rounding || (bend >= -rounding && dot(p, q) > 0);
  }

  static void make_strictly_convex(Ring& ring) {
    for (std::size_t i = 0, kept = 0; kept < ring.size() && ring.size() > 2;) {
      const std::size_t before = i == 0 ? ring.size() - 1 : i - 1, after = i + 1 == ring.size() ? 0 : i + 1;
      if (orientation(ring[before], ring[i], ring[after]) > 0) {
        ++kept;
        i = after;
      } else {
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
        kept = 0;
        i = i == 0 ? ring.size() - 1 : i - 1;
      }
    }
  }

  const std::vector<Point>& points_;
  std::vector<HalfEdge> edges_;
  double straight_ = 0;
  double area_ = 0, changed_ = 0;  // m², doubled
};

// The outline itself, where it is convex and small enough already.
bool is_convex_part(const Outline& outline, int most_vertices) {
  const Ring& ring = outline.outer;
  const std::size_t n = ring.size();
  if (!outline.holes.empty() || n > static_cast<std::size_t>(most_vertices)) return false;
  if (n < 3) return false;
  Point a = ring[n - 2], b = ring[n - 1];
  for (const Point& c : ring) {
    if (orientation(a, b, c) <= 0) return false;
    a = std::exchange(b, c);
  }
  return true;
}

}  // namespace

Ring hull(std::vector<Point> points) {  // Andrew's monotone chain
  std::sort(points.begin(), points.end(),
            [](Point a, Point b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  Ring result;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = result.size();
    for (const Point& p : points) {
      while (result.size() >= start + 2 && orientation(result[result.size() - 2], result.back(), p) <= 0)
        result.pop_back();
      result.push_back(p);
    }
    result.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return result;
}

double least_width(const Ring& convex) {  // rotating calipers: the vertex opposite an edge goes round with it
  const std::size_t n = convex.size();
  if (n < 3) return 0;
  double least = std::numeric_limits<double>::infinity();
  const double size = bounds_of(convex).diagonal();
  for (std::size_t i = 0, opposite = 1; i < n; ++i) {
    const Point p = convex[i], along = convex[(i + 1) % n] - p;
    const auto height = [&](std::size_t k) { return cross(along, convex[k % n] - p); };
    opposite = std::max(opposite, i + 1);
    // Of vertices almost in line with the edge, rounding decides which is higher.
    const double flat = 1e-12 * length(along) * size;
    while (opposite + 1 < i + n && (height(opposite) <= flat || height(opposite + 1) > height(opposite)))
      ++opposite;
    least = std::min(least, height(opposite) / length(along));
  }
  return least;
}

std::vector<Ring> convex_parts(const Outline& outline, int most_vertices) {
  if (is_convex_part(outline, most_vertices)) return std::vector<Ring>(1, outline.outer);
  const Triangulation triangles = triangulate(outline);
  if (triangles.edges.empty()) return {};
  // About spikes without width, straight on and straight back are a rounding apart: there only exact signs
  // tell.
  std::vector<Ring> rings;
  for (const double tolerance : {1e-12, 0.0}) {
    Parts parts(triangles, tolerance);
    parts.merge(most_vertices);
    rings = parts.rings();
    if (parts.changed() <= 1e-10) break;
  }
  return rings;
}

}  // namespace ductile::calibration

namespace ductile {

std::vector<Convex> convex_parts(const Piece& piece) {
  if (piece.circle > 0) return {};
  std::vector<Convex> parts = calibration::convex_parts(piece.outline, 8);  // b2_maxPolygonVertices
  for (Convex& part : parts)
    for (Point& p : part) p = p - piece.center;
  return parts;
}

}  // namespace ductile
