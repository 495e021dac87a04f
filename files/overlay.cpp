#include "overlay.h"

#include <algorithm>
#include <boost/polygon/polygon.hpp>  // segment_utils.hpp needs it
#include <boost/polygon/segment_utils.hpp>
#include <cmath>
#include <compare>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>

#include "svg_path.h"

namespace ductile::svg {
namespace {

/// A point of the grid. Differences stay within 2^30 and cross products within 2^61, so they are exact.
struct GridPoint {
  std::int32_t x, y;
  auto operator<=>(const GridPoint&) const = default;  // NOLINT(modernize-use-nullptr): the check misreads it
};
std::int64_t cross(GridPoint o, GridPoint p, GridPoint q) {
  return (std::int64_t{p.x} - o.x) * (std::int64_t{q.y} - o.y) -
         (std::int64_t{p.y} - o.y) * (std::int64_t{q.x} - o.x);
}

/// The grid over the layers, and the vertices that stand for their points.
class Grid {
 public:
  explicit Grid(const std::vector<Layer>& layers) {
    Bounds box;
    for (const Layer& layer : layers) {
      for (const Ring& ring : layer.rings) {
        for (const Point& p : ring) box.add(p);
      }
    }
    const Point size = box.size();
    middle_ = 0.5 * (box.low + box.high);
    // A power of two, so that going to the grid and back rounds once.
    const int exponent = std::ilogb(std::max({size.x, size.y, 1e-300})) + 1;
    scale_ = std::ldexp(1, 29 - exponent);
  }
  GridPoint node(const Point& p) {
    const Point q = scale_ * (p - middle_);
    const GridPoint node{static_cast<std::int32_t>(std::lround(q.x)),
                         static_cast<std::int32_t>(std::lround(q.y))};
    given_.emplace(key(node), p);
    return node;
  }
  bool given(GridPoint node) const { return given_.contains(key(node)); }
  Point point(GridPoint node) const {
    const auto found = given_.find(key(node));
    return found != given_.end() ? found->second
                                 : middle_ + 1 / scale_ * Point{double(node.x), double(node.y)};
  }

 private:
  static std::uint64_t key(GridPoint n) {
    return std::uint64_t{static_cast<std::uint32_t>(n.x)} << 32 | static_cast<std::uint32_t>(n.y);
  }
  Point middle_;
  double scale_ = 1;
  std::unordered_map<std::uint64_t, Point> given_;
};

/// A directed edge of the arrangement; its twin has the index with the last bit flipped, and the even one of
/// the two runs from left to right, upward where it is vertical.
struct HalfEdge {
  int from, to;   // vertices
  int next = -1;  // along the face on its left
  int face = -1;
};

/// The plane divided by the layers' rings, and how often each layer winds around each face.
class Arrangement {
 public:
  Arrangement(const std::vector<Layer>& layers, Grid& grid) : layers_(layers), grid_(grid) {
    divide();
    link();
    number_faces();
    wind();
  }

  template <class Inside>
  std::vector<Ring> boundary(const Inside& inside) const;

 private:
  using Winding = std::vector<int>;  // by layers

  void divide();
  void link();
  void number_faces();
  void wind();
  Winding outside_of(int vertex, int component) const;
  const Winding& change(int edge) const { return changes_[static_cast<std::size_t>(edge / 2)]; }
  const HalfEdge& edge(int e) const { return edges_[static_cast<std::size_t>(e)]; }
  GridPoint node(int vertex) const { return nodes_[static_cast<std::size_t>(vertex)]; }

  const std::vector<Layer>& layers_;
  Grid& grid_;
  std::vector<GridPoint> nodes_;
  std::vector<HalfEdge> edges_;
  std::vector<Winding>
      changes_;  // by pairs of edges: winding number left of the even one, less that on its right
  std::vector<std::vector<int>>
      fans_;  // by vertices: outgoing edges counter-clockwise from straight down, exclusive
  std::vector<Winding> windings_;  // by faces
};

/// More than this many pairs of edges whose boxes overlap would take too long.
constexpr std::size_t most_pairs = 4'000'000;
/// So would more than this many pairs of a crossing and an edge above or below it, which Boost looks at all.
constexpr std::size_t most_looks = 100'000'000;

using Segment = boost::polygon::segment_data<int>;

void refuse_entangled(const std::vector<Segment>& segments) {
  struct Span {
    int left, right, low, high;
    GridPoint a, b;
  };
  const auto refuse = [] {
    throw ShapeError("outline", "crosses itself too often", "draw it with fewer lines");
  };
  std::vector<Span> spans;
  spans.reserve(segments.size());
  for (const Segment& s : segments) {
    const GridPoint a{s.low().x(), s.low().y()}, b{s.high().x(), s.high().y()};
    spans.push_back({std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y), a, b});
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.left < b.left; });
  std::size_t pairs = 0, looks = 0;
  std::vector<double> crossings;  // x of each
  for (std::size_t i = 0; i < spans.size(); ++i) {
    const Span& s = spans[i];
    for (std::size_t j = i + 1; j < spans.size() && spans[j].left < s.right; ++j) {
      const Span& t = spans[j];
      if (++looks > 100 * most_pairs) refuse();
      if (t.low >= s.high || s.low >= t.high) continue;
      if (++pairs > most_pairs) refuse();
      const double c = double(cross(t.a, t.b, s.a)), d = double(cross(t.a, t.b, s.b));
      if (c * d < 0 && double(cross(s.a, s.b, t.a)) * double(cross(s.a, s.b, t.b)) < 0)
        crossings.push_back(s.a.x + c / (c - d) * (double(s.b.x) - s.a.x));
    }
  }
  std::sort(crossings.begin(), crossings.end());
  looks = 0;
  for (const Span& s : spans) {
    const auto first = std::lower_bound(crossings.begin(), crossings.end(), s.left);
    looks += static_cast<std::size_t>(std::upper_bound(first, crossings.end(), s.right) - first);
  }
  if (looks > most_looks) refuse();
}

void Arrangement::divide() {
  std::vector<Segment> segments;
  std::vector<std::size_t> layer_of;
  for (std::size_t l = 0; l < layers_.size(); ++l) {
    for (const Ring& ring : layers_[l].rings) {
      for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const GridPoint a = grid_.node(ring[j]), b = grid_.node(ring[i]);
        if (a == b) continue;
        segments.emplace_back(boost::polygon::point_data<int>(a.x, a.y),
                              boost::polygon::point_data<int>(b.x, b.y));
        layer_of.push_back(l);
      }
    }
  }
  refuse_entangled(segments);
  std::vector<std::pair<std::size_t, Segment>> parts;
  boost::polygon::intersect_segments(parts, segments.begin(), segments.end());

  std::map<std::pair<GridPoint, GridPoint>, Winding> found;
  for (const auto& [index, part] : parts) {
    GridPoint a{part.low().x(), part.low().y()}, b{part.high().x(), part.high().y()};
    if (a == b) continue;
    if (b < a) std::swap(a, b);
    auto& change = found[{a, b}];
    change.resize(layers_.size());
    // Rounding may turn a part straight down, but never around.
    const Segment& whole = segments[index];
    const auto along = [](int from, int to) { return std::int64_t{to} - from; };
    const std::int64_t same = along(a.x, b.x) * along(whole.low().x(), whole.high().x()) +
                              along(a.y, b.y) * along(whole.low().y(), whole.high().y());
    change[layer_of[index]] += same > 0 ? 1 : -1;
  }
  std::map<GridPoint, int> vertices;
  const auto vertex = [&](GridPoint n) {
    const auto [at, fresh] = vertices.emplace(n, static_cast<int>(nodes_.size()));
    if (fresh) nodes_.push_back(n);
    return at->second;
  };
  for (auto& [ends, change] : found) {
    if (std::all_of(change.begin(), change.end(), [](int c) { return c == 0; })) continue;
    const int a = vertex(ends.first), b = vertex(ends.second);
    edges_.push_back({a, b});
    edges_.push_back({b, a});
    changes_.push_back(std::move(change));
  }
}

void Arrangement::link() {
  fans_.resize(nodes_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e)
    fans_[static_cast<std::size_t>(edges_[e].from)].push_back(static_cast<int>(e));
  for (auto& fan : fans_) {
    std::sort(fan.begin(), fan.end(), [&](int e, int f) {
      const bool e_left = e % 2 != 0, f_left = f % 2 != 0;  // an odd edge goes left, or straight down
      if (e_left != f_left) return f_left;
      return cross(node(edge(e).from), node(edge(e).to), node(edge(f).to)) > 0;
    });
    for (std::size_t i = 0; i < fan.size(); ++i) {
      // Coming in along fan[i], one leaves by the next clockwise.
      const int clockwise = fan[(i + fan.size() - 1) % fan.size()];
      edges_[static_cast<std::size_t>(fan[i] ^ 1)].next = clockwise;
    }
  }
}

void Arrangement::number_faces() {
  int faces = 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (edges_[e].face >= 0) continue;
    for (int at = static_cast<int>(e); edge(at).face < 0; at = edge(at).next)
      edges_[static_cast<std::size_t>(at)].face = faces;
    ++faces;
  }
  windings_.resize(static_cast<std::size_t>(faces));
}

/// A component's face that surrounds it has the winding number of the plane around its leftmost vertex; each
/// edge changes it by what the edge says.
void Arrangement::wind() {
  std::vector<int> component(nodes_.size(), -1), order(nodes_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int v, int w) { return node(v) < node(w); });
  std::vector<int> leftmost;
  for (const int start : order) {
    if (component[static_cast<std::size_t>(start)] >= 0) continue;
    const int id = static_cast<int>(leftmost.size());
    leftmost.push_back(start);
    std::vector<int> stack{start};
    component[static_cast<std::size_t>(start)] = id;
    while (!stack.empty()) {
      const int v = stack.back();
      stack.pop_back();
      for (const int e : fans_[static_cast<std::size_t>(v)]) {
        int& of = component[static_cast<std::size_t>(edge(e).to)];
        if (of < 0) {
          of = id;
          stack.push_back(edge(e).to);
        }
      }
    }
  }
  if (leftmost.size() > 100 * most_pairs / std::max<std::size_t>(edges_.size(), 1) + 1) {
    throw ShapeError("outline", "has " + std::to_string(leftmost.size()) + " rings", "draw it with fewer");
  }
  for (std::size_t c = 0; c < leftmost.size(); ++c) {
    const int v = leftmost[c];
    // All its edges go right; what is left of it is on the left of the uppermost.
    const int top = fans_[static_cast<std::size_t>(v)].back();
    Winding around(layers_.size());
    if (c > 0) {
      const GridPoint p = node(v);
      for (std::size_t e = 0; e < edges_.size(); e += 2) {
        const GridPoint a = node(edges_[e].from), b = node(edges_[e].to);
        if (component[static_cast<std::size_t>(edges_[e].from)] == static_cast<int>(c)) continue;
        if (a.x <= p.x && p.x < b.x && cross(a, b, p) > 0) {
          for (std::size_t l = 0; l < around.size(); ++l) around[l] += changes_[e / 2][l];
        }
      }
    }
    std::vector<int> stack{top};
    windings_[static_cast<std::size_t>(edge(top).face)] = around;
    while (!stack.empty()) {
      const int first = stack.back();
      stack.pop_back();
      const Winding here = windings_[static_cast<std::size_t>(edge(first).face)];
      int at = first;
      do {
        Winding& there = windings_[static_cast<std::size_t>(edge(at ^ 1).face)];
        if (there.empty()) {
          there = here;
          const int sign = at % 2 == 0 ? -1 : 1;
          for (std::size_t l = 0; l < there.size(); ++l) there[l] += sign * change(at)[l];
          stack.push_back(at ^ 1);
        }
        at = edge(at).next;
      } while (at != first);
    }
  }
}

template <class Inside>
std::vector<Ring> Arrangement::boundary(const Inside& inside) const {
  std::vector<bool> in(windings_.size());
  for (std::size_t f = 0; f < in.size(); ++f) in[f] = inside(windings_[f]);
  const auto bounds = [&](int e) {
    return in[static_cast<std::size_t>(edge(e).face)] && !in[static_cast<std::size_t>(edge(e ^ 1).face)];
  };
  std::vector<bool> done(edges_.size());
  std::vector<Ring> rings;
  for (int first = 0; first < static_cast<int>(edges_.size()); ++first) {
    if (!bounds(first) || done[static_cast<std::size_t>(first)]) continue;
    std::vector<int> walk;  // vertices
    for (int at = first; !done[static_cast<std::size_t>(at)];) {
      done[static_cast<std::size_t>(at)] = true;
      walk.push_back(edge(at).from);
      at = edge(at).next;
      while (!bounds(at)) at = edge(at ^ 1).next;  // around the vertex through what is inside
    }
    // Where it passes a vertex twice, it is two rings that touch there.
    std::vector<int> open;
    std::unordered_map<int, std::size_t> place;
    const auto close = [&](std::size_t from) {
      Ring ring;
      const std::size_t n = open.size() - from;
      for (std::size_t i = 0; i < n; ++i) {
        const GridPoint p = node(open[from + (i + n - 1) % n]), q = node(open[from + i]),
                        r = node(open[from + (i + 1) % n]);
        // Crossings that nothing is left of lie on a straight line, but for the grid's rounding.
        const bool straight = std::abs(static_cast<double>(cross(p, q, r))) <=
                              2 * std::hypot(double(r.x) - p.x, double(r.y) - p.y);
        if (grid_.given(q) || !straight) ring.push_back(grid_.point(q));
      }
      for (std::size_t i = from; i < open.size(); ++i) place.erase(open[i]);
      open.resize(from);
      if (ring.size() >= 3) rings.push_back(std::move(ring));
    };
    for (const int v : walk) {
      if (const auto again = place.find(v); again != place.end()) close(again->second);
      place.emplace(v, open.size());
      open.push_back(v);
    }
    close(0);
  }
  return rings;
}

}  // namespace

double doubled_area_of(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 2; i < ring.size(); ++i) {
    sum += cross(ring[i - 1] - ring[0], ring[i] - ring[0]);
  }
  return sum;
}

std::vector<Ring> overlay(const std::vector<Layer>& layers, Overlay how) {
  Grid grid(layers);
  const Arrangement arrangement(layers, grid);
  return arrangement.boundary([&](const std::vector<int>& winding) {
    std::size_t covered = 0;
    bool first = false;
    for (std::size_t l = 0; l < layers.size() && l < winding.size(); ++l) {
      const bool in = layers[l].even_odd ? winding[l] % 2 != 0 : winding[l] != 0;
      covered += in;
      if (l == 0) first = in;
    }
    switch (how) {
      case Overlay::unite:
        return covered > 0;
      case Overlay::intersect:
        return covered == layers.size();
      default:
        return first && covered == 1;
    }
  });
}

std::vector<Outline> outlines(std::vector<Ring> rings) {
  std::vector<Outline> areas;
  std::vector<Bounds> boxes;
  std::sort(rings.begin(), rings.end(),
            [](const Ring& a, const Ring& b) { return doubled_area_of(a) > doubled_area_of(b); });
  for (Ring& ring : rings) {
    if (doubled_area_of(ring) > 0) {
      boxes.push_back(bounds_of(ring));
      areas.push_back({std::move(ring), {}});
      continue;
    }
    // Rings touch in points at most, so the middle of an edge is inside or outside; the smallest outline
    // around it is the hole's.
    const Point p = 0.5 * (ring[0] + ring[1]);
    for (std::size_t i = areas.size(); i-- > 0;) {
      if (!boxes[i].contains(p) || !contains(areas[i].outer, p)) continue;
      areas[i].holes.push_back(std::move(ring));
      break;
    }
  }
  return areas;
}

}  // namespace ductile::svg
