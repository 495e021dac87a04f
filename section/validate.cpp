// Is this drawing a section? The answer by a plane sweep with exact predicates, which names what is wrong and
// where.
//
// The sweep (Shamos and Hoey 1976) walks a line over all vertices from left to right and keeps the edges that
// it crosses in order. Only neighbours in that order can be the next to cross. Where two do, the crossing is
// reported, one of them is taken out, and the order of the others stays right: so it goes on and finds the
// rest, in O(n log n). The order also knows how often each face is covered: once or not at all, else a hole
// lies outside or regions overlap.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "double_double.h"
#include "ductile/section.h"

namespace ductile {
namespace {

constexpr double largest = 1e50, smallest = 1e-50;  // m: their fourth powers times a modulus are doubles
constexpr std::size_t enough = 100;                 // problems of one kind that are worth telling

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string near(Point p) { return "near (" + number(p.x) + ", " + number(p.y) + ")"; }

bool before(Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// > 0 where r lies left of the line from p to q; the sign is exact.
int orientation(Point p, Point q, Point r) {
  using Exact = CGAL::Exact_predicates_inexact_constructions_kernel::Point_2;
  return CGAL::orientation(Exact(p.x, p.y), Exact(q.x, q.y), Exact(r.x, r.y));
}

bool strictly_apart(int a, int b) { return a * b < 0; }

/// Do the segments cross in a point inside both?
bool cross(Point a, Point b, Point p, Point q) {
  return strictly_apart(orientation(a, b, p), orientation(a, b, q)) &&
         strictly_apart(orientation(p, q, a), orientation(p, q, b));
}

Point crossing(Point a, Point b, Point p, Point q) {
  const double across_p = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  const double across_q = (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x);
  const double t = across_p == across_q ? 0.5 : across_p / (across_p - across_q);
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
}

double distance(Point p, Point a, Point b) {
  const double x = b.x - a.x, y = b.y - a.y, length2 = x * x + y * y;
  const double t = length2 > 0 ? std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

/// The ring without a closing point that repeats the first.
std::span<const Point> open(const Ring& ring) {
  std::span<const Point> points(ring);
  return points.size() > 1 && points.front() == points.back() ? points.first(points.size() - 1) : points;
}

/// A ring that the sweep looks at, and where it stands in the drawing; its name is put together when it is
/// needed.
struct Loop {
  std::span<const Point> ring;
  std::string_view prefix;
  std::size_t region = 0;
  bool of_section = false;  // the prefix is one of several regions
  bool hole = false;
  std::size_t index = 0;  // among the holes

  std::string place() const {
    return std::string(prefix) + (of_section ? "[" + std::to_string(region) + "]" : "") +
           (hole ? ".holes[" + std::to_string(index) + "]" : ".outer");
  }
};

/// What is wrong with a ring's points before one asks how its edges lie. Finite coordinates come first: a
/// predicate that is fed a NaN answers something.
std::vector<Problem> point_problems(const Loop& loop) {
  const std::span<const Point> ring = loop.ring;
  std::vector<Problem> problems;
  const auto vertex = [&](std::size_t i) { return loop.place() + "[" + std::to_string(i) + "]"; };
  for (std::size_t i = 0; i < ring.size() && problems.size() < enough; ++i) {
    const auto [x, y] = ring[i];
    if (!std::isfinite(x) || !std::isfinite(y))
      problems.push_back({vertex(i), "(" + number(x) + ", " + number(y) + ") is not finite",
                          "coordinates must be finite numbers, in metres"});
    else if (std::max(std::abs(x), std::abs(y)) > largest)
      problems.push_back({vertex(i), "(" + number(x) + ", " + number(y) + ") is too far away",
                          "coordinates must be within 1e50 m"});
  }
  if (!problems.empty()) return problems;
  if (ring.size() < 3)
    return {{loop.place(), "has " + std::to_string(ring.size()) + (ring.size() == 1 ? " point" : " points"),
             "a ring needs at least three"}};

  Point low = ring[0], high = ring[0];
  for (const Point p : ring) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  std::size_t corner = 1;
  while (corner < ring.size() && ring[corner] == ring[0]) ++corner;
  const bool flat = corner == ring.size() || std::all_of(ring.begin(), ring.end(), [&](Point p) {
                      return orientation(ring[0], ring[corner], p) == 0;
                    });
  if (flat)
    return {{loop.place(), "has no area: all its points lie on one line", "a ring must enclose an area"}};
  if (std::min(high.x - low.x, high.y - low.y) < smallest)
    return {{loop.place(), "is " + number(high.x - low.x) + " m by " + number(high.y - low.y) + " m",
             "a ring must be larger than 1e-50 m each way"}};

  for (std::size_t i = 0; i < ring.size() && problems.size() < enough; ++i) {
    const std::size_t next = (i + 1) % ring.size();
    if (ring[i] == ring[next])
      problems.push_back({vertex(next),
                          "repeats the point (" + number(ring[i].x) + ", " + number(ring[i].y) +
                              ") of vertex " + std::to_string(i),
                          "give each point once"});
  }
  return problems;
}

/// +1 where the ring runs counter-clockwise; for one that does not touch itself.
int turn(std::span<const Point> ring) {
  const auto i = static_cast<std::size_t>(std::min_element(ring.begin(), ring.end(), before) - ring.begin());
  return orientation(ring[(i + ring.size() - 1) % ring.size()], ring[i], ring[(i + 1) % ring.size()]);
}

/// Few edges are checked faster each against each: true where no two touch but neighbours at their common
/// vertex.
bool plainly_simple(std::span<const Point> ring) {
  constexpr std::size_t few = 128;
  const std::size_t n = ring.size();
  if (n > few) return false;
  struct Box {
    double left, right, low, high;
  };
  std::array<Box, few> boxes;
  for (std::size_t i = 0; i < n; ++i) {
    const Point p = ring[i], q = ring[i + 1 < n ? i + 1 : 0];
    boxes[i] = {std::min(p.x, q.x), std::max(p.x, q.x), std::min(p.y, q.y), std::max(p.y, q.y)};
    const Point r = ring[(i + 2) % n];
    if (orientation(p, q, r) == 0 && before(p, q) == before(r, q)) return false;  // runs back on itself
  }
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const Box a = boxes[i];
    for (std::size_t j = i + 2; j < (i == 0 ? n - 1 : n); ++j) {
      const Box& b = boxes[j];
      if (a.right < b.left || b.right < a.left || a.high < b.low || b.high < a.low) continue;
      const Point p = ring[i], q = ring[i + 1], r = ring[j], s = ring[j + 1 < n ? j + 1 : 0];
      if (orientation(p, q, r) * orientation(p, q, s) <= 0 &&
          orientation(r, s, p) * orientation(r, s, q) <= 0)
        return false;
    }
  }
  return true;
}

class Sweep {
 public:
  /// `tolerance`, m: different rings that overlap by no more than this are taken to touch.
  Sweep(std::span<const Loop> loops, double tolerance)
      : loops_(loops), tolerance_(tolerance), status_(Below{this}) {
    std::size_t count = 0;
    for (const Loop& loop : loops) count += loop.ring.size();
    edges_.reserve(count);
    for (std::size_t l = 0; l < loops.size(); ++l) {
      const auto ring = loops[l].ring;
      const int solid_left = loops.size() > 1 ? (loops[l].hole ? -1 : 1) * turn(ring) : 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point p = ring[i], q = ring[i + 1 < ring.size() ? i + 1 : 0];
        const bool forward = before(p, q);
        edges_.push_back(
            {forward ? p : q, forward ? q : p, l, i, forward, forward ? solid_left : -solid_left});
      }
    }
  }

  std::vector<Problem> problems() {
    walk();
    // Where an edge of one ring misses a vertex of another by rounding, lead it through the vertex and look
    // again.
    for (int round = 0; round < 20 && problems_.empty() && !splits_.empty(); ++round) {
      split_edges();
      walk();
    }
    return std::move(problems_);
  }

 private:
  struct Edge {
    Point left, right;
    std::size_t loop, index;  // runs from vertex `index` of its ring to the next
    bool forward;             // from left to right
    int solid_above;          // how the cover changes across it, upward: +1, −1
    bool removed = false;
    // Of the face above it, while in the status: how often it is covered, where its current bounds begin, and
    // whether they are apart there.
    int cover = 0;
    Point start{};
    bool wide = false;
  };
  struct Event {
    Point p;
    std::size_t edge;
    bool starts;
  };

  // The order from below to above of the edges under the sweep line, and of a point among them.
  struct At {
    Point p;
  };
  struct Below {
    using is_transparent = void;
    const Sweep* sweep;
    bool operator()(std::size_t a, std::size_t b) const { return a != b && sweep->below(a, b); }
    bool operator()(std::size_t e, At at) const { return sweep->side(e, at.p) > 0; }
    bool operator()(At at, std::size_t e) const { return sweep->side(e, at.p) < 0; }
  };
  using Status = std::set<std::size_t, Below>;

  /// > 0 where p lies above the edge.
  int side(std::size_t e, Point p) const { return orientation(edges_[e].left, edges_[e].right, p); }

  bool below(std::size_t a, std::size_t b) const {
    const bool a_first = !before(edges_[b].left, edges_[a].left);
    const std::size_t base = a_first ? a : b, later = a_first ? b : a;
    int later_above = side(base, edges_[later].left);
    if (later_above == 0) later_above = side(base, edges_[later].right);
    if (later_above == 0) return a < b;  // one runs along the other
    return a_first == (later_above > 0);
  }

  std::size_t edge_at(Status::iterator it) const { return it == status_.end() ? none : *it; }
  std::size_t edge_before(Status::iterator it) const { return it == status_.begin() ? none : *std::prev(it); }

  void walk() {
    splits_.clear();
    status_.clear();
    order_lost_ = false;
    std::vector<Event> events;
    events.reserve(2 * edges_.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      edges_[e].removed = false;
      events.push_back({edges_[e].left, e, true});
      events.push_back({edges_[e].right, e, false});
    }
    std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return before(a.p, b.p); });
    for (std::size_t i = 0, end; i < events.size() && problems_.size() < enough; i = end) {
      end = i + 1;
      while (end < events.size() && events[end].p == events[i].p) ++end;
      pass(std::span(events).subspan(i, end - i));
    }
    first_walk_ = false;
  }

  void pass(std::span<const Event> events) {
    const Point p = events.front().p;
    const auto [old_first, old_last] = status_.equal_range(At{p});
    end_faces(p, old_first, old_last);
    through_.clear();
    for (auto it = old_first; it != old_last; ++it)
      if (edges_[*it].right != p) through_.push_back(*it);
    if (first_walk_) report_touching(events);
    for (const Event& event : events)
      if (!event.starts && !edges_[event.edge].removed) status_.erase(event.edge);
    part_through();
    for (const Event& event : events)
      if (event.starts) status_.insert(event.edge);

    const auto [first, last] = status_.equal_range(At{p});
    const std::size_t under = edge_before(first), over = edge_at(last);
    int cover = under == none ? 0 : edges_[under].cover;
    for (auto it = first; it != last; ++it) edges_[*it].cover = cover += edges_[*it].solid_above;
    start_faces(p, first, last);

    if (first == last) {
      part_crossing(under, over);
    } else {
      const std::size_t lowest = *first, highest = *std::prev(last);
      part_crossing(under, lowest);
      if (!edges_[highest].removed) part_crossing(highest, over);
    }
  }

  /// Edges that pass through the vertex at hand, seen before those that end there were taken out, cross one
  /// another in it.
  void part_through() {
    for (std::size_t i = 1; i < through_.size(); ++i) {
      const std::size_t a = through_[i - 1], b = through_[i];
      if (!cross(edges_[a].left, edges_[a].right, edges_[b].left, edges_[b].right)) continue;
      if (!only_rounding(a, b)) report_crossing(a, b);
      take_out(b);
      through_[i] = a;
    }
  }

  Status::iterator take_out(std::size_t e) {
    order_lost_ = true;
    edges_[e].removed = true;
    return status_.erase(status_.find(e));
  }

  /// Where two neighbours cross farther on, reports it and takes one of them out.
  void part_crossing(std::size_t a, std::size_t b) {
    while (a != none && b != none &&
           cross(edges_[a].left, edges_[a].right, edges_[b].left, edges_[b].right)) {
      if (!only_rounding(a, b)) report_crossing(a, b);
      b = edge_at(take_out(b));
    }
  }

  /// Does one of two edges of different rings end on the other, but for rounding?
  bool only_rounding(std::size_t a, std::size_t b) {
    if (edges_[a].loop == edges_[b].loop) return !first_walk_;
    bool found = false;
    for (const auto& [e, other] : {std::pair{a, b}, std::pair{b, a}})
      for (const Point p : {edges_[e].left, edges_[e].right})
        if (distance(p, edges_[other].left, edges_[other].right) <= tolerance_) {
          splits_[other].push_back(p);
          found = true;
        }
    return found;
  }

  void split_edges() {
    for (auto& [e, points] : splits_) {
      std::sort(points.begin(), points.end(), before);
      for (const Point p : points) {
        if (!before(edges_[e].left, p) || !before(p, edges_[e].right)) continue;
        Edge part = edges_[e];
        part.right = p;
        edges_[e].left = p;
        edges_.push_back(part);
      }
    }
  }

  /// Vertices of a ring that fall on one another or on another edge of it.
  void report_touching(std::span<const Event> events) {
    const Point p = events.front().p;
    const auto at = [p] { return "(" + number(p.x) + ", " + number(p.y) + ")"; };
    // vertices at p; two events each
    touching_.clear();
    for (const Event& event : events) {
      const Edge& e = edges_[event.edge];
      const std::size_t size = loops_[e.loop].ring.size();
      touching_.push_back({e.loop, event.starts == e.forward ? e.index : (e.index + 1) % size});
    }
    std::sort(touching_.begin(), touching_.end());
    for (std::size_t i = 1; i < touching_.size(); ++i) {
      const auto [loop, vertex] = touching_[i];
      const auto [other_loop, other] = touching_[i - 1];
      if (loop == other_loop && vertex != other)
        problems_.push_back({loops_[loop].place() + "[" + std::to_string(vertex) + "]",
                             "is the same point " + at() + " as vertex " + std::to_string(other),
                             "a ring must not touch itself"});
    }
    for (const std::size_t e : through_) {
      const Edge& edge = edges_[e];
      const auto own =
          std::lower_bound(touching_.begin(), touching_.end(), std::pair{edge.loop, std::size_t{0}});
      if (own != touching_.end() && own->first == edge.loop)
        problems_.push_back({loops_[edge.loop].place() + "[" + std::to_string(own->second) + "]",
                             at() + " lies on edge " + std::to_string(edge.index),
                             "a ring must not touch itself"});
    }
  }

  void report_crossing(std::size_t a, std::size_t b) {
    const Point p = crossing(edges_[a].left, edges_[a].right, edges_[b].left, edges_[b].right);
    if (std::pair{edges_[a].loop, edges_[a].index} > std::pair{edges_[b].loop, edges_[b].index})
      std::swap(a, b);
    const Edge &e = edges_[a], &f = edges_[b];
    const std::string i = std::to_string(e.index), j = std::to_string(f.index);
    if (e.loop == f.loop) {
      problems_.push_back({loops_[e.loop].place(), "edges " + i + " and " + j + " cross " + near(p),
                           "a ring must not cross itself"});
    } else if (told_.insert({e.loop, f.loop}).second) {
      problems_.push_back(
          {loops_[f.loop].place(),
           "edge " + j + " crosses edge " + i + " of " + loops_[e.loop].place() + " " + near(p),
           remedy(e.loop, f.loop)});
    }
  }

  std::string remedy(std::size_t a, std::size_t b) const {
    return loops_[a].region == loops_[b].region
               ? "a hole must lie inside its outline and apart from other holes"
               : "regions may touch but not overlap";
  }

  // Every face must be covered once or not at all, but for slivers that rounding makes: those whose bounds,
  // from one event that touches them to the next, are nowhere apart by more than the tolerance, or that are
  // no longer than it. The faces that touch p lie between the edges through p (first … last) and their
  // neighbours, or around p.
  double away(Point p, std::size_t e) const {
    return e == none ? 0 : distance(p, edges_[e].left, edges_[e].right);
  }

  void start_faces(Point p, Status::iterator first, Status::iterator last) {
    if (loops_.size() < 2) return;
    const std::size_t under = edge_before(first), over = edge_at(last);
    const auto start = [&](std::size_t e, double width) {
      edges_[e].start = p;
      edges_[e].wide = width > tolerance_;
    };
    if (under != none) start(under, away(p, under) + (first == last ? away(p, over) : 0));
    for (auto it = first; it != last; ++it) start(*it, std::next(it) == last ? away(p, over) : 0);
  }

  void end_faces(Point p, Status::iterator first, Status::iterator last) {
    if (loops_.size() < 2) return;
    const std::size_t under = edge_before(first), over = edge_at(last);
    const auto end = [&](std::size_t e, double width) {
      const Edge& edge = edges_[e];
      if ((edge.cover < 0 || edge.cover > 1) && p.x - edge.start.x > tolerance_ &&
          (edge.wide || width > tolerance_))
        report_cover(e, edge.start);
    };
    if (under != none) end(under, away(p, under) + (first == last ? away(p, over) : 0));
    for (auto it = first; it != last; ++it) end(*it, std::next(it) == last ? away(p, over) : 0);
  }

  /// Who covers the face above edge e?
  void report_cover(std::size_t e, Point p) {
    if (problems_.size() >= enough || order_lost_ || ++reports_ > 10 * enough) return;
    std::map<std::size_t, int> cover;  // by loop
    for (const std::size_t other : status_) {
      cover[edges_[other].loop] += edges_[other].solid_above;
      if (other == e) break;
    }
    std::map<std::size_t, std::pair<std::size_t, int>> by_region;  // first loop and cover of each owner
    std::vector<std::size_t> holes;
    for (const auto& [loop, count] : cover) {
      by_region.try_emplace(loops_[loop].region, loop, 0).first->second.second += count;
      if (count < 0) holes.push_back(loop);
    }
    std::vector<std::size_t> covering;
    for (const auto& [region, entry] : by_region)
      if (entry.second > 0) covering.push_back(entry.first);
    if (covering.size() < 2) covering = holes;
    if (covering.empty()) return;
    const std::size_t b = covering.back(), a = covering.size() > 1 ? covering[covering.size() - 2] : none;
    if (!told_.insert({a, b}).second) return;
    if (a == none)
      problems_.push_back({loops_[b].place(), "lies outside its outline " + near(p), remedy(b, b)});
    else
      problems_.push_back(
          {loops_[b].place(), "overlaps " + loops_[a].place() + " in area " + near(p), remedy(a, b)});
  }

  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  std::span<const Loop> loops_;
  double tolerance_;
  std::vector<Edge> edges_;
  Status status_;
  bool first_walk_ = true;   // over the rings as given
  bool order_lost_ = false;  // edges were taken out, so the cover is not known
  std::size_t reports_ = 0;
  std::vector<std::size_t> through_;  // edges that contain the vertex at hand and go on
  std::vector<std::pair<std::size_t, std::size_t>> touching_;  // loop, vertex
  std::map<std::size_t, std::vector<Point>> splits_;           // edge → vertices of other rings on it
  std::set<std::pair<std::size_t, std::size_t>> told_;
  std::vector<Problem> problems_;
};

/// m: what rounding may move a point on an edge whose ends have coordinates as large as these.
double rounding(std::span<const Loop> loops) {
  double magnitude = 0;
  for (const Loop& loop : loops)
    for (const Point p : loop.ring) magnitude = std::max({magnitude, std::abs(p.x), std::abs(p.y)});
  return 8 * std::numeric_limits<double>::epsilon() * magnitude;
}

void add_loops(std::vector<Loop>& loops, const Outline& outline, const Loop& like) {
  loops.push_back(like);
  loops.back().ring = open(outline.outer);
  for (std::size_t h = 0; h < outline.holes.size(); ++h) {
    loops.push_back(like);
    loops.back().ring = open(outline.holes[h]);
    loops.back().hole = true;
    loops.back().index = h;
  }
}

/// What holes leave of the outlines, and the length of all rings.
std::pair<double, double> area_and_length(std::span<const Loop> loops) {
  DoubleDouble area;
  double length = 0;
  for (const Loop& loop : loops) {
    DoubleDouble twice;
    const Point o = loop.ring.front();
    Point p = loop.ring.back();
    for (const Point q : loop.ring) {
      twice += two_sum(p.x, -o.x) * two_sum(q.y, -o.y) - two_sum(q.x, -o.x) * two_sum(p.y, -o.y);
      length += std::hypot(q.x - p.x, q.y - p.y);
      p = q;
    }
    area += abs(twice) * (loop.hole ? -0.5 : 0.5);
  }
  return {to_double(area), length};
}

/// Do holes leave nothing of the outline but slivers that rounding makes?
bool all_holes(std::span<const Loop> loops, double tolerance) {
  const auto [area, length] = area_and_length(loops);
  return area <= tolerance * length;
}

/// A thickness t in a length L costs (L/t)² of the digits of a second moment; double-double has 32.
std::vector<Problem> thin_problems(std::span<const Loop> loops, const std::string& place) {
  constexpr double thinnest = 1e-9;
  double extent = 0;
  for (const Loop& loop : loops) {
    for (const Point p : loop.ring) {
      const Point o = loops.front().ring.front();
      extent = std::max({extent, std::abs(p.x - o.x), std::abs(p.y - o.y)});
    }
  }
  const double area = area_and_length(loops).first;
  if (area >= thinnest * extent * extent) return {};
  return {{place, number(area) + " m2 in an extent of " + number(extent) + " m",
           "too thin to compute with: the area must be at least 1e-9 of the extent's square"}};
}

void append(std::vector<Problem>& problems, std::vector<Problem> more) {
  problems.insert(problems.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

}  // namespace

namespace {
std::vector<Problem> validate(const Outline& outline, const Loop& like) {
  std::vector<Loop> loops;
  loops.reserve(1 + outline.holes.size());
  add_loops(loops, outline, like);
  std::vector<Problem> problems;
  std::vector<Loop> sound;
  for (const Loop& loop : loops) {
    auto found = point_problems(loop);
    if (found.empty()) sound.push_back(loop);
    append(problems, std::move(found));
  }
  if (!problems.empty()) {
    for (const Loop& loop : sound) append(problems, Sweep(std::span(&loop, 1), 0).problems());
    return problems;
  }
  if (loops.size() == 1 && plainly_simple(loops.front().ring)) return {};
  const double tolerance = rounding(loops);
  problems = Sweep(loops, tolerance).problems();
  if (problems.empty() && loops.size() > 1 && all_holes(loops, tolerance))
    problems.push_back({loops.front().place(), "has no area left: its holes fill it", "leave some material"});
  return problems;
}
}  // namespace

std::vector<Problem> validate(const Outline& outline, const std::string& place) {
  std::vector<Problem> problems = validate(outline, Loop{.prefix = place});
  if (!problems.empty()) return problems;
  std::vector<Loop> loops;
  add_loops(loops, outline, Loop{});
  return thin_problems(loops, place);
}

namespace {
template <class Place>
void check_stresses(std::vector<Problem>& problems, const Material& material, const Place& place) {
  const auto check = [&](const char* name, double value, bool may_be_zero) {
    if ((may_be_zero && value == 0) || (value >= smallest && value <= largest)) return;
    problems.push_back(
        {place(), std::string(name) + " is " + number(value) + " Pa",
         may_be_zero ? "it must be finite and not negative" : "it must be finite and above zero"});
  };
  check("yield stress", material.yield_stress, false);
  check("yield stress in compression", material.yield_stress_compression, true);
  check("shear yield stress", material.shear_yield_stress, true);
  check("Young's modulus", material.youngs_modulus, true);
}
}  // namespace

std::vector<Problem> validate(const Material& material, const std::string& place) {
  std::vector<Problem> problems;
  check_stresses(problems, material, [&] { return place; });
  return problems;
}

std::vector<Problem> validate(std::span<const Region> regions) {
  if (regions.empty()) return {{"regions", "is empty", "a section needs at least one region"}};
  std::vector<Problem> problems;
  bool outlines_sound = true;
  const bool E_known = std::any_of(regions.begin(), regions.end(),
                                   [](const Region& region) { return region.material.youngs_modulus > 0; });
  const auto loop_like = [](std::size_t r) {
    return Loop{.prefix = "regions", .region = r, .of_section = true};
  };
  for (std::size_t r = 0; r < regions.size(); ++r) {
    auto found = validate(regions[r].outline, loop_like(r));
    outlines_sound &= found.empty();
    append(problems, std::move(found));
    const auto place = [r] { return "regions[" + std::to_string(r) + "].material"; };
    check_stresses(problems, regions[r].material, place);
    if (E_known && regions[r].material.youngs_modulus == 0)
      problems.push_back({place(), "has no Young's modulus although another region has one",
                          "give it for all regions or for none"});
  }
  if (problems.empty()) {
    // The neutral axis lies so near the fibre that balances them that the rest cancels.
    double least = largest, most = 0;
    for (const Region& region : regions) {
      for (const double stress : {region.material.yield_stress, region.material.compression()}) {
        least = std::min(least, stress);
        most = std::max(most, stress);
      }
    }
    if (most > 1e9 * least)
      problems.push_back({"regions", "yield at " + number(least) + " Pa and at " + number(most) + " Pa",
                          "yield stresses must be within a factor of 1e9 of each other"});
  }
  if (outlines_sound) {
    std::vector<Loop> loops;
    for (std::size_t r = 0; r < regions.size(); ++r) add_loops(loops, regions[r].outline, loop_like(r));
    if (regions.size() > 1) append(problems, Sweep(loops, rounding(loops)).problems());
    if (problems.empty()) append(problems, thin_problems(loops, "regions"));
  }
  return problems;
}

}  // namespace ductile
