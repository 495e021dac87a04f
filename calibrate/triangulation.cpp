#include "triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "ductile/moments.h"
#include "ductile/plane.h"
#include "orientation.h"
#include "regions.h"

namespace ductile::calibration {
namespace {

void make_twins(std::vector<HalfEdge>& edges, int a, int b) {
  edges[a].twin = b;
  edges[b].twin = a;
}

// Points of which some are taken away, in a tree of boxes.
class Remaining {
 public:
  explicit Remaining(std::vector<Point> points) : points_(std::move(points)), order_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    std::size_t leaves = 1;
    while (leaves * 8 < points_.size()) leaves *= 2;
    boxes_.resize(2 * leaves);
    leaf_.resize(points_.size());
    build(1, 0, order_.size());
  }

  void remove(int i) {
    Box& own = boxes_[leaf_[i]];
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(own.first);
    std::iter_swap(std::find(begin, begin + own.left, i), begin + own.left - 1);
    for (std::size_t b = leaf_[i]; b > 0; b /= 2) --boxes_[b].left;
  }

  /// Does any that is left lie in the triangle or on its sides, but not on its corners?
  bool any_in(Point a, Point b, Point c) const {
    const Point low{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})},
        high{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    std::size_t todo[64];
    std::size_t n = 0;
    todo[n++] = 1;
    while (n > 0) {
      const std::size_t at = todo[--n];
      const Box& box = boxes_[at];
      if (box.left == 0 || box.low.x > high.x || box.high.x < low.x || box.low.y > high.y ||
          box.high.y < low.y)
        continue;
      if (2 * at < boxes_.size()) {
        todo[n++] = 2 * at;
        todo[n++] = 2 * at + 1;
        continue;
      }
      for (std::size_t k = box.first; k < box.first + static_cast<std::size_t>(box.left); ++k) {
        const Point p = points_[order_[k]];
        if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y || p == a || p == b || p == c)
          continue;
        if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0) return true;
      }
    }
    return false;
  }

 private:
  struct Box {
    Point low, high;
    std::size_t first = 0;  // in order_, whose points that are left come first in a leaf
    int left = 0;           // of its points
  };

  void build(std::size_t at, std::size_t first, std::size_t last) {
    Box& box = boxes_[at];
    box = {points_[order_[first]], points_[order_[first]], first, static_cast<int>(last - first)};
    for (std::size_t k = first; k < last; ++k) {
      const Point p = points_[order_[k]];
      box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
      box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
      leaf_[order_[k]] = at;
    }
    if (2 * at >= boxes_.size()) return;
    const std::size_t half = first + (last - first) / 2;
    const auto begin = order_.begin();
    const bool wide = box.high.x - box.low.x > box.high.y - box.low.y;
    std::nth_element(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(half),
                     begin + static_cast<std::ptrdiff_t>(last), [&](int i, int j) {
                       return wide ? points_[i].x < points_[j].x : points_[i].y < points_[j].y;
                     });
    build(2 * at, first, half);
    build(2 * at + 1, half, last);
  }

  std::vector<Point> points_;
  std::vector<int> order_;
  std::vector<Box> boxes_;  // 1: all; 2i and 2i + 1: halves of i
  std::vector<std::size_t> leaf_;
};

// The nodes of a ring in its order, in blocks with a box around their edges: a search leaves out whole
// blocks.
class Blocks {
 public:
  struct Block {
    std::vector<int> nodes;
    Bounds around;
  };
  struct Place {
    std::size_t block = 0, index = 0;
  };

  const std::vector<Block>& all() const { return blocks_; }

  // Puts nodes after the one at a place; `add(node, box)` adds the edge from a node to a box.
  template <class Add>
  void insert(Place after, const std::vector<int>& nodes, const Add& add) {
    if (blocks_.empty()) blocks_.emplace_back();
    std::vector<int> all = std::move(blocks_[after.block].nodes);
    const auto at = all.empty() ? all.end() : all.begin() + static_cast<std::ptrdiff_t>(after.index) + 1;
    all.insert(at, nodes.begin(), nodes.end());
    std::vector<Block> parts((all.size() + most - 1) / most);
    for (std::size_t i = 0; i < all.size(); ++i) {
      Block& part = parts[i * parts.size() / all.size()];
      part.nodes.push_back(all[i]);
      add(all[i], part.around);
    }
    blocks_[after.block] = std::move(parts[0]);
    blocks_.insert(blocks_.begin() + static_cast<std::ptrdiff_t>(after.block) + 1,
                   std::make_move_iterator(parts.begin() + 1), std::make_move_iterator(parts.end()));
  }

 private:
  static constexpr std::size_t most = 64;  // nodes in a block
  std::vector<Block> blocks_;
};

// Triangles of an outline: holes are joined to the outer ring by bridges, then ears are cut off.
class EarClipping {
 public:
  explicit EarClipping(const Outline& outline) {
    const int outer = add_ring(outline.outer, false);
    std::vector<int> holes;
    for (const Ring& hole : outline.holes)
      if (const int node = add_ring(hole, true); node >= 0) holes.push_back(rightmost(node));
    if (outer < 0) return;
    // From right to left, so that what a hole is joined to is joined already.
    std::sort(holes.begin(), holes.end(), [&](int a, int b) { return at(a).x > at(b).x; });
    if (!holes.empty()) put_on({}, ring_from(outer));
    for (const int hole : holes) bridge(hole);
    clip(outer);
  }

  // Of three half-edges each.
  Triangulation triangles() && { return {std::move(points_), std::move(triangles_)}; }

 private:
  struct Node {
    int point, previous, next;
    int beyond =
        -1;  // what is on the other side of the edge to the next node: nothing, a half-edge, or bridge −2 − i
  };

  Point at(int node) const { return points_[nodes_[node].point]; }
  int previous(int node) const { return nodes_[node].previous; }
  int next(int node) const { return nodes_[node].next; }

  // A linked ring; returns one of its nodes, or −1.
  int add_ring(const Ring& ring, bool clockwise) {
    const bool reverse = (doubled_area(ring) < 0) != clockwise;
    const int first = static_cast<int>(nodes_.size());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point p = ring[reverse ? ring.size() - 1 - i : i];
      if (static_cast<int>(nodes_.size()) > first && p == points_.back()) continue;
      const int node = static_cast<int>(nodes_.size());
      nodes_.push_back({static_cast<int>(points_.size()), node - 1, node + 1});
      points_.push_back(p);
    }
    while (static_cast<int>(nodes_.size()) > first + 1 && points_.back() == at(first)) {
      nodes_.pop_back();
      points_.pop_back();
    }
    const int last = static_cast<int>(nodes_.size()) - 1;
    if (last < first) return -1;
    nodes_[first].previous = last;
    nodes_[last].next = first;
    return first;
  }

  int rightmost(int start) const {
    int best = start;
    for (int node = next(start); node != start; node = next(node))
      if (at(node).x > at(best).x || (at(node).x == at(best).x && at(node).y < at(best).y)) best = node;
    return best;
  }

  // Joins a hole's rightmost node to a node of the outer ring that it sees (Eberly, "Triangulation by Ear
  // Clipping", §3): the nearer end of the first edge to its right, or what lies between.
  void bridge(int hole) {
    const Point m = at(hole);
    double nearest = std::numeric_limits<double>::infinity();
    int seen = -1;
    visit({m, {std::numeric_limits<double>::infinity(), m.y}}, [&](int node, Blocks::Place) {
      const Point p = at(node), q = at(next(node));
      if (p.y <= m.y && m.y <= q.y && p.y < q.y && orientation(p, q, m) >= 0) {
        const double x = std::max(m.x, p.x + (m.y - p.y) / (q.y - p.y) * (q.x - p.x));
        if (x < nearest) {
          nearest = x;
          seen = q.y == m.y || (p.y != m.y && q.x > p.x) ? next(node) : node;
        }
      }
    });
    if (seen < 0) return;  // not inside: rings that rounding has pushed across each other

    // A node in the triangle of m, the point hit and the edge's end hides that end; of these, the one at the
    // least angle to the ray, then the nearest, is seen.
    const Point hit{nearest, m.y};
    const Point end = at(seen);
    double least = std::numeric_limits<double>::infinity();
    Point best = end;
    Blocks::Place place;  // of what is seen
    constexpr double everything = std::numeric_limits<double>::infinity();
    Bounds triangle = bounds_of(std::array{m, hit, end});
    if (hit == m || end.y == m.y) triangle.high.x = everything;  // it is a line, which goes on beyond its end
    if (hit == m) (end.y >= m.y ? triangle.high.y : triangle.low.y) = end.y >= m.y ? everything : -everything;
    visit(triangle, [&](int node, Blocks::Place its) {
      const Point p = at(node);
      if (node == seen) place = its;
      const bool above = end.y >= m.y;
      const bool in = p.x >= m.x && p != m &&
                      (above ? p.y >= m.y && orientation(m, end, p) <= 0 && orientation(hit, end, p) >= 0
                             : p.y <= m.y && orientation(m, end, p) >= 0 && orientation(hit, end, p) <= 0);
      if ((in || p == end || p == m) && sees(node, m)) {
        const double slope = p == m ? -1 : std::abs(p.y - m.y) / (p.x - m.x);
        if (slope < least || (slope == least && length(p - m) < length(best - m))) {
          least = slope;
          best = p;
          seen = node;
          place = its;
        }
      }
    });

    const int seen2 = static_cast<int>(nodes_.size()), hole2 = seen2 + 1;
    const int bridge = -2 - static_cast<int>(bridges_.size());
    bridges_.push_back(-1);
    nodes_.push_back({nodes_[seen].point, hole2, next(seen), nodes_[seen].beyond});
    nodes_.push_back({nodes_[hole].point, previous(hole), seen2, bridge});
    nodes_[seen].beyond = bridge;
    nodes_[next(seen)].previous = seen2;
    nodes_[previous(hole)].next = hole2;
    nodes_[seen].next = hole;
    nodes_[hole].previous = seen;
    std::vector<int> joined = ring_from(hole, hole2);
    joined.insert(joined.end(), {hole2, seen2});
    put_on(place, joined);
  }

  std::vector<int> ring_from(int first, int up_to = -1) const {
    std::vector<int> ring{first};
    for (int node = next(first); node != first && node != up_to; node = next(node)) ring.push_back(node);
    return ring;
  }

  void put_on(Blocks::Place after, const std::vector<int>& nodes) {
    joined_.insert(after, nodes, [&](int node, Bounds& box) {
      box.add(at(node));
      box.add(at(next(node)));
    });
  }

  // Of what is joined, in its order, all edges that meet a box, and some others: visit(node, place).
  template <class Visit>
  void visit(const Bounds& box, const Visit& visit) const {
    for (std::size_t b = 0; b < joined_.all().size(); ++b) {
      const auto& [nodes, around] = joined_.all()[b];
      for (std::size_t i = 0; around.meets(box) && i < nodes.size(); ++i) visit(nodes[i], {b, i});
    }
  }

  // Does the wedge of material at a node open towards a point? Straight on counts, so does the node itself.
  bool sees(int node, Point target) const {
    const Point p = at(node), before = at(previous(node)), after = at(next(node));
    if (p == target) return true;
    if (orientation(before, p, after) <= 0)
      return !(orientation(p, before, target) > 0 && orientation(after, p, target) > 0);
    const int side = orientation(before, p, target);
    return orientation(p, after, target) > 0 && (side > 0 || (side == 0 && dot(p - before, target - p) > 0));
  }

  void clip(int start) {
    std::vector<Point> corners;  // by node; those of rings that no bridge reaches are not in the way
    for (const Node& node : nodes_) corners.push_back(points_[node.point]);
    remaining_.emplace(std::move(corners));
    std::vector<bool> reached(nodes_.size());
    int node_of_ring = start;
    do {
      reached[node_of_ring] = true;
      node_of_ring = next(node_of_ring);
    } while (node_of_ring != start);
    for (std::size_t i = 0; i < reached.size(); ++i)
      if (!reached[i]) remaining_->remove(static_cast<int>(i));
    int node = start, tried = 0;
    for (int left = count(start); left > 3;) {
      const int side = orientation(at(previous(node)), at(node), at(next(node)));
      // A vertex in the middle of a straight edge of the outline is not needed; between triangles it is, so
      // that they stay neighbours.
      const bool idle = side == 0 && nodes_[previous(node)].beyond == -1 && nodes_[node].beyond == -1;
      if (idle || (side > 0 && is_ear(node)) || tried > left) {
        nodes_[previous(node)].beyond = side > 0 ? add_triangle(node) : -1;
        nodes_[previous(node)].next = next(node);
        nodes_[next(node)].previous = previous(node);
        remaining_->remove(node);
        --left;
        tried = 0;
        node = next(next(node));  // every other, which fans less
      } else {
        ++tried;
        node = next(node);
      }
      start = node;
    }
    if (orientation(at(previous(start)), at(start), at(next(start))) > 0)
      attach(add_triangle(start), nodes_[next(start)].beyond);
  }

  int count(int start) const {
    int n = 1;
    for (int node = next(start); node != start; node = next(node)) ++n;
    return n;
  }

  // The triangle of a node and its neighbours; returns its half-edge back from the next to the previous.
  int add_triangle(int node) {
    const int before = previous(node), e = static_cast<int>(triangles_.size());
    triangles_.push_back({nodes_[before].point, e + 1, e + 2, -1});
    triangles_.push_back({nodes_[node].point, e + 2, e, -1});
    triangles_.push_back({nodes_[next(node)].point, e, e + 1, -1});
    attach(e, nodes_[before].beyond);
    attach(e + 1, nodes_[node].beyond);
    return e + 2;
  }

  void attach(int edge, int beyond) {
    if (beyond >= 0) {
      make_twins(triangles_, edge, beyond);
    } else if (beyond < -1) {  // a bridge: its first side waits for the second
      int& other = bridges_[-2 - beyond];
      if (other >= 0)
        make_twins(triangles_, edge, other);
      else
        other = edge;
    }
  }

  // No other corner of what is left lies in the triangle, and its third side runs inside.
  bool is_ear(int node) const {
    const int before = previous(node), after = next(node);
    const Point a = at(before), b = at(node), c = at(after);
    return sees(before, c) && sees(after, a) && !remaining_->any_in(a, b, c);
  }

  std::vector<Point> points_;
  std::vector<Node> nodes_;
  std::vector<int> bridges_;
  Blocks joined_;  // the outer ring, with the holes that are joined to it
  std::vector<HalfEdge> triangles_;
  std::optional<Remaining> remaining_;  // corners
};

// Makes the fattest triangles that these vertices allow.
class Delaunay {
 public:
  explicit Delaunay(Triangulation& triangulation)
      : points_(triangulation.points), edges_(triangulation.edges) {}

  // Lawson's flips; their number is bounded in case rounding makes them go in circles.
  void run() {
    std::vector<int> suspects;
    for (int e = 0; e < size(); ++e)
      if (e < edges_[e].twin) suspects.push_back(e);
    for (int budget = 20 * size(); !suspects.empty() && budget > 0; --budget) {
      const int e = suspects.back(), f = edges_[e].twin;
      suspects.pop_back();
      if (f < 0) continue;
      const int a = from(e), b = from(f), c = from(edges_[e].previous), d = from(edges_[f].previous);
      if (!in_circle(a, b, c, d) || turn(d, b, c) <= 0 || turn(c, a, d) <= 0) continue;
      // a→b becomes d→c: triangles c a d and d b c.
      const int bc = edges_[e].next, ca = edges_[e].previous, ad = edges_[f].next, db = edges_[f].previous;
      edges_[e].from = d;
      edges_[f].from = c;
      link(e, ca, ad);
      link(f, db, bc);
      for (const int outer : {bc, ca, ad, db})
        if (edges_[outer].twin >= 0) suspects.push_back(outer);
    }
  }

 private:
  int size() const { return static_cast<int>(edges_.size()); }
  int from(int e) const { return edges_[e].from; }
  int turn(int a, int b, int c) const { return orientation(points_[a], points_[b], points_[c]); }
  // Makes a triangle of three half-edges.
  void link(int a, int b, int c) {
    edges_[a].next = edges_[c].previous = b;
    edges_[b].next = edges_[a].previous = c;
    edges_[c].next = edges_[b].previous = a;
  }

  // Is d inside the circle through a, b, c (counter-clockwise)?
  bool in_circle(int a, int b, int c, int d) const {
    const Point p = points_[a] - points_[d], q = points_[b] - points_[d], r = points_[c] - points_[d];
    const double one = dot(p, p) * cross(q, r), two = dot(q, q) * cross(r, p),
                 three = dot(r, r) * cross(p, q);
    return one + two + three > 1e-12 * (std::abs(one) + std::abs(two) + std::abs(three));
  }

  const std::vector<Point>& points_;
  std::vector<HalfEdge>& edges_;
};

double area_of(const Triangulation& triangles) {
  double area = 0;
  for (std::size_t e = 0; e + 2 < triangles.edges.size(); e += 3) {
    const auto corner = [&](std::size_t i) { return triangles.points[triangles.edges[e + i].from]; };
    area += cross(corner(1) - corner(0), corner(2) - corner(0)) / 2;
  }
  return area;
}

void append(Triangulation& all, const Triangulation& part) {
  const int points = static_cast<int>(all.points.size()), edges = static_cast<int>(all.edges.size());
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (const auto& [from, next, previous, twin] : part.edges)
    all.edges.push_back({from + points, next + edges, previous + edges, twin < 0 ? -1 : twin + edges});
}

}  // namespace

Triangulation triangulate(const Outline& outline) {
  Triangulation result = EarClipping(outline).triangles();
  // Where rings touch, the bridge of a hole may miss: then they are made one first.
  if (const double whole = moments(outline).area; std::abs(area_of(result) - whole) > 1e-9 * whole) {
    Triangulation apart;
    for (const Outline& region : regions(outline)) append(apart, EarClipping(region).triangles());
    if (std::abs(area_of(apart) - whole) < std::abs(area_of(result) - whole)) result = std::move(apart);
  }
  Delaunay(result).run();
  return result;
}

void add_feet(Triangulation& triangulation) {
  std::vector<HalfEdge>& edges = triangulation.edges;
  std::vector<Point>& points = triangulation.points;
  for (int pass = 0; pass < 3; ++pass) {
    const std::size_t before = edges.size();
    for (int e = 0; e < static_cast<int>(before); ++e) {
      if (edges[e].twin >= 0) continue;
      const int next = edges[e].next, previous = edges[e].previous;
      const Point a = points[edges[e].from], along = points[edges[next].from] - a,
                  apex = points[edges[previous].from];
      const double ll = dot(along, along), s = dot(apex - a, along) / ll;
      const double least = 0.25 * cross(along, apex - a) / ll;  // a quarter of the height from either end
      if (!(s > least && s < 1 - least)) continue;
      const Point foot = a + s * along;
      if (foot == a || foot == points[edges[next].from]) continue;
      // a→b, b→v, v→a becomes a→f, f→v, v→a and f→b, b→v, v→f.
      const int f = static_cast<int>(points.size()), v = edges[previous].from;
      const int fv = static_cast<int>(edges.size()), fb = fv + 1, vf = fv + 2;
      points.push_back(foot);
      edges.push_back({f, previous, e, vf});
      edges.push_back({f, next, vf, -1});
      edges.push_back({v, fb, next, fv});
      edges[e].next = fv;
      edges[previous].previous = fv;
      edges[next].next = vf;
      edges[next].previous = fb;
    }
    if (edges.size() == before) return;
    Delaunay(triangulation).run();
  }
}

}  // namespace ductile::calibration
