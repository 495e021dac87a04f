#include "split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "ductile/moments.h"
#include "orientation.h"

namespace ductile::calibration {
namespace {

// The outline and its cuts as one planar map. Every ring edge is a half-edge with the material on its left;
// every stretch of a cut inside the material (a chord) is a pair of them. What bounds a piece are cycles of
// `next`. `next` is a permutation whatever the rounding of the points, so tracing it always ends; and since
// the two halves of a chord cancel, the areas of the pieces always add up to that of the outline.
class PlanarMap {
 public:
  Split run(const Outline& outline, std::span<const Cut> cuts, const std::string& place,
            std::vector<int>* useless) {
    start(outline, cuts, place);
    useless_.clear();
    for (std::size_t first = 0, last; first < cuts_.size(); first = last) {
      for (last = first + 1; last < cuts_.size() && follows(first, last); ++last) {
      }
      meet(first, last);
    }
    find_chords();
    if (useless && !useless_.empty()) return list(*useless);
    same_.resize(points_.size());
    std::iota(same_.begin(), same_.end(), 0);
    for (const auto& [a, b] : touching_) unite(a, b);
    sort(edge_crossings_);
    refuse_double_cuts();
    if (useless && !useless_.empty()) return list(*useless);
    refuse_problems();
    find_chord_crossings();
    sort(chord_crossings_);
    link_edges();
    link_chords();
    if (!useless) refuse_problems();
    Split result = trace();
    if (useless && !useless_.empty()) return list(*useless);
    refuse_problems();
    return result;
  }

 private:
  struct Line {
    int from, to;  // points
    int cut = -1;  // −1: an edge of the outline
  };
  struct Crossing {
    int line;
    double s;  // from 0 to 1 along the line
    int point;
  };
  // A point of a cut at which the depth inside the material changes, just left and just right of the cut.
  struct Event {
    int cut;
    double t;
    int point, left, right;
  };
  struct HalfEdge {
    int from, to;
    int next = -1;     // along the boundary of the piece on the left
    int sibling = -1;  // another half-edge that arrives at the same point
    int cut = -1;
    int cycle = -1;
  };

  void start(const Outline& outline, std::span<const Cut> cuts, const std::string& place) {
    cuts_ = cuts;
    place_ = &place;
    problems_.clear();
    points_.clear();
    edges_.clear();
    chords_.clear();
    edge_crossings_.clear();
    chord_crossings_.clear();
    touching_.clear();
    half_edges_.clear();
    events_.clear();
    add_ring(outline.outer, false);
    for (const Ring& hole : outline.holes) add_ring(hole, true);
    size_ = bounds_of(points_).diagonal();
  }

  void add_ring(const Ring& ring, bool clockwise) {
    const std::size_t n = ring.size() - (ring.size() > 1 && ring.front() == ring.back() ? 1 : 0);
    const bool reverse = (doubled_area(ring) < 0) != clockwise;
    const int first = static_cast<int>(points_.size());
    for (std::size_t i = 0; i < n; ++i) {
      const int at = static_cast<int>(points_.size());
      points_.push_back(ring[reverse ? n - 1 - i : i]);
      edges_.push_back({at, i + 1 < n ? at + 1 : first});
    }
    vertices_ = points_.size();
  }

  // Is a cut parallel to an earlier one, and to the right of the one before it?
  bool follows(std::size_t first, std::size_t cut) const {
    const Cut &before = cuts_[cut - 1], &c = cuts_[cut];
    const Point w = c.to - c.from;
    return parallel(cuts_[first], c) && dot(w, cuts_[first].to - cuts_[first].from) > 0 &&
           cross(w, before.from - c.from) > 0;
  }

  // Where parallel cuts, each to the right of the one before, meet the edges. A vertex on a cut counts once
  // as right of it and once as left, as if the cut were displaced a little to its left and to its right.
  void meet(std::size_t first, std::size_t last) {
    const Point origin = cuts_[first].from, w = unit(cuts_[first].to - origin), across = right(w);
    places_.clear();
    for (std::size_t i = first; i < last; ++i) places_.push_back(dot(across, cuts_[i].from - origin));
    offsets_.clear();
    for (std::size_t i = 0; i < vertices_; ++i) offsets_.push_back(dot(across, points_[i] - origin));
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const auto [from, to, _] = edges_[i];
      const double a = offsets_[from], b = offsets_[to];
      auto place = std::lower_bound(places_.begin(), places_.end(), std::min(a, b) - tolerance());
      for (; place != places_.end() && *place <= std::max(a, b) + tolerance(); ++place) {
        const int a_side = side(*place - a), b_side = side(*place - b);  // 1: left of the cut
        if (a_side == b_side) continue;
        const std::size_t index = first + static_cast<std::size_t>(place - places_.begin());
        const int left = (a_side > 0) == (b_side > 0) ? 0
                         : b_side > 0                 ? -1
                                                      : 1;  // going left, it leaves material
        const int right = (a_side >= 0) == (b_side >= 0) ? 0 : b_side >= 0 ? -1 : 1;
        const int point = a_side == 0   ? from
                          : b_side == 0 ? to
                                        : cross_line(static_cast<int>(i), (*place - a) / (b - a), edges_[i]);
        events_.push_back(
            {static_cast<int>(index), dot(w, points_[point] - cuts_[index].from), point, left, right});
      }
    }
  }

  int side(double offset) const { return (offset > tolerance()) - (offset < -tolerance()); }

  // Where both displaced cuts run in material, so does the cut itself; where only one does, it runs along an
  // edge of the outline.
  void find_chords() {
    std::sort(events_.begin(), events_.end(),
              [](const Event& a, const Event& b) { return a.cut != b.cut ? a.cut < b.cut : a.t < b.t; });
    auto event = events_.begin();
    for (int index = 0; index < std::ssize(cuts_); ++index) {
      const Cut& cut = cuts_[index];
      const double extent = length(cut.to - cut.from), slack = 1e-6 * size_;
      const std::size_t before = chords_.size();
      int left = 0, right = 0;
      for (; event != events_.end() && event->cut == index; ++event) {
        left += event->left;
        right += event->right;
        const auto next = event + 1;
        if (next == events_.end() || next->cut != index || next->point == event->point) continue;
        if (points_[event->point] == points_[next->point])
          touching_.emplace_back(event->point, next->point);
        else if (left > 0 && right > 0 && next->t > slack && event->t < extent - slack) {
          chords_.push_back({event->point, next->point, index});
          if (event->t < -slack || next->t > extent + slack)
            problem(index, "ends inside the outline, at " + to_string(event->t < -slack ? cut.from : cut.to),
                    "move that end out of the outline");
        }
      }
      if (chords_.size() == before) problem(index, "misses the outline", "let it run from side to side");
    }
  }

  void refuse_double_cuts() {
    std::vector<std::array<int, 3>> ends;  // of chords, and their cuts
    for (const Line& c : chords_) {
      const auto [low, high] = std::minmax({same(c.from), same(c.to)});
      ends.push_back({low, high, c.cut});
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 1; i < ends.size(); ++i)
      if (ends[i][0] == ends[i - 1][0] && ends[i][1] == ends[i - 1][1] && ends[i][2] != ends[i - 1][2])
        problem(ends[i][2], "cuts where cut " + std::to_string(ends[i - 1][2]) + " does",
                "leave one of the two out");
  }

  // The point of an edge at which a cut crosses it.
  int cross_line(int index, double s, const Line& line) {
    const Point a = points_[line.from], b = points_[line.to], p = a + s * (b - a);
    if (p == a) return line.from;
    if (p == b) return line.to;
    points_.push_back(p);
    edge_crossings_.push_back({index, s, static_cast<int>(points_.size()) - 1});
    return edge_crossings_.back().point;
  }

  void find_chord_crossings() {
    if (std::all_of(cuts_.begin(), cuts_.end(), [&](const Cut& cut) { return parallel(cut, cuts_.front()); }))
      return;
    const auto low = [&](int i) { return std::min(points_[chords_[i].from].x, points_[chords_[i].to].x); };
    const auto high = [&](int i) { return std::max(points_[chords_[i].from].x, points_[chords_[i].to].x); };
    std::vector<int> order(chords_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) { return low(i) < low(j); });
    for (std::size_t first = 0; first < order.size(); ++first)
      for (std::size_t second = first + 1; second < order.size(); ++second) {
        const int i = std::min(order[first], order[second]), j = std::max(order[first], order[second]);
        if (low(order[second]) > high(order[first])) break;
        const Line &c = chords_[i], &d = chords_[j];
        if (c.cut == d.cut || parallel(cuts_[c.cut], cuts_[d.cut])) continue;
        if (same(c.from) == same(d.from) || same(c.from) == same(d.to) || same(c.to) == same(d.from) ||
            same(c.to) == same(d.to))
          continue;
        const Point a = points_[c.from], b = points_[c.to], p = points_[d.from], q = points_[d.to];
        if (orientation(a, b, p) * orientation(a, b, q) >= 0 ||
            orientation(p, q, a) * orientation(p, q, b) >= 0)
          continue;
        const double across = cross(b - a, q - p);
        const double s = cross(p - a, q - p) / across, t = cross(p - a, b - a) / across;
        points_.push_back(a + s * (b - a));
        same_.push_back(static_cast<int>(points_.size()) - 1);
        chord_crossings_.push_back({i, s, same_.back()});
        chord_crossings_.push_back({j, t, same_.back()});
      }
  }

  // But for rounding. Cuts so nearly parallel that cross inside are one cut within the tolerance.
  static bool parallel(const Cut& a, const Cut& b) {
    const Point u = a.to - a.from, w = b.to - b.from;
    return std::abs(cross(u, w)) <= 1e-12 * std::sqrt(dot(u, u) * dot(w, w));
  }

  // Along each line; crossings of one line nearer than the tolerance become one point. A point of an edge so
  // moves along that edge only, and a point inside moves with both pieces: no area changes.
  void sort(std::vector<Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return a.line != b.line ? a.line < b.line : a.s < b.s;
    });
    for (std::size_t i = 1; i < crossings.size(); ++i) {
      const Crossing &a = crossings[i - 1], &b = crossings[i];
      if (a.line == b.line && length(points_[a.point] - points_[b.point]) <= tolerance())
        unite(a.point, b.point);
    }
  }

  int same(int point) const {
    while (same_[point] != point) point = same_[point];
    return point;
  }
  void unite(int a, int b) { same_[std::max(same(a), same(b))] = std::min(same(a), same(b)); }

  // Calls visit(from, to) for every part of every line between the points that cross it.
  template <class Visit>
  void walk(const std::vector<Line>& lines, const std::vector<Crossing>& crossings, Visit visit) {
    auto crossing = crossings.begin();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      int at = same(lines[i].from);
      const auto go = [&](int to) {
        if (to != at) visit(lines[i], at, to);
        at = to;
      };
      for (; crossing != crossings.end() && crossing->line == static_cast<int>(i); ++crossing)
        go(same(crossing->point));
      go(same(lines[i].to));
    }
  }

  void link_edges() {
    arrivals_.assign(points_.size(), -1);
    departures_.assign(points_.size(), -1);
    std::vector<int> crowded;
    walk(edges_, edge_crossings_, [&](const Line&, int from, int to) {
      const int edge = static_cast<int>(half_edges_.size());
      half_edges_.push_back({from, to, -1, arrivals_[to]});
      if (arrivals_[to] >= 0) crowded.push_back(to);
      arrivals_[to] = edge;
      departures_[from] = edge;
    });
    for (std::size_t p = 0; p < arrivals_.size(); ++p)
      if (arrivals_[p] >= 0) half_edges_[arrivals_[p]].next = departures_[p];
    for (int point : crowded) link_crowded(point);
  }

  // Rings that touch at a point: the boundary that arrives there goes on along the first departure clockwise,
  // which closes the wedge of material on its left. So departures and arrivals alternate around the point as
  // opening and closing brackets do. They are matched as such, because rounding may exchange the two sides of
  // a spike: whatever it does, no two arrivals go on along the same departure.
  void link_crowded(int point) {
    struct Ray {
      double angle;
      int edge;
      bool departs;
    };
    std::vector<Ray> rays;
    const auto add = [&](int edge, int other, bool departs) {
      const Point away = points_[other] - points_[point];
      rays.push_back({std::atan2(away.y, away.x), edge, departs});
    };
    for (int e = arrivals_[point]; e >= 0; e = half_edges_[e].sibling) add(e, half_edges_[e].from, false);
    for (std::size_t d = 0; d < half_edges_.size(); ++d)
      if (half_edges_[d].from == point) add(static_cast<int>(d), half_edges_[d].to, true);
    std::sort(rays.begin(), rays.end(), [](const Ray& a, const Ray& b) {
      return a.angle != b.angle ? a.angle < b.angle : a.departs > b.departs;
    });
    std::vector<int> open;
    for (std::size_t i = 0; i < 2 * rays.size(); ++i) {  // twice around: what opens may close after a turn
      const Ray& ray = rays[i % rays.size()];
      if (ray.departs) {
        if (i < rays.size()) open.push_back(ray.edge);
      } else if (ray.edge >= 0 && !open.empty()) {
        half_edges_[ray.edge].next = open.back();
        open.pop_back();
        rays[i % rays.size()].edge = -1;
      }
    }
  }

  // Counter-clockwise angle from a to b, in (0, 2π].
  static double turn(Point a, Point b) {
    const double angle = std::atan2(cross(a, b), dot(a, b));
    return angle > 0 ? angle : angle + 2 * std::numbers::pi;
  }

  void link_chords() {
    walk(chords_, chord_crossings_, [&](const Line& chord, int from, int to) {
      const int there = static_cast<int>(half_edges_.size()), back = there + 1;
      const int before = arrival(from, points_[to] - points_[from]);
      const int after = arrival(to, points_[from] - points_[to]);
      half_edges_.push_back({from, to, -1, arrivals_[to], chord.cut});
      half_edges_.push_back({to, from, -1, arrivals_[from], chord.cut});
      arrivals_[to] = there;
      arrivals_[from] = back;
      half_edges_[there].next = after >= 0 ? half_edges_[after].next : back;
      half_edges_[back].next = before >= 0 ? half_edges_[before].next : there;
      if (before >= 0) half_edges_[before].next = there;
      if (after >= 0) half_edges_[after].next = back;
    });
  }

  // The half-edge that arrives at a point before the wedge of material into which `direction` points; −1
  // where nothing arrives yet.
  int arrival(int point, Point direction) const {
    const int first = arrivals_[point];
    if (first < 0 || half_edges_[first].sibling < 0) return first;
    for (int e = first; e >= 0; e = half_edges_[e].sibling) {
      const Point out = points_[half_edges_[half_edges_[e].next].to] - points_[point];
      if (turn(out, direction) < turn(out, points_[half_edges_[e].from] - points_[point])) return e;
    }
    return first;
  }

  // Counter-clockwise cycles are the outer boundaries of pieces, the others bound holes in them. Cycles
  // without area, as along a spike that is no wider than its points are round, are neither.
  Split trace() {
    struct Cycle {
      Ring hole;  // empty for an outer boundary, and for what has no area
      int piece = -1;
    };
    std::vector<Cycle> cycles;
    Split result;
    result.pieces.reserve(chords_.size() + 1);
    result.intervals.reserve(chords_.size());
    for (std::size_t start = 0; start < half_edges_.size(); ++start) {
      if (half_edges_[start].cycle >= 0) continue;
      std::size_t n = 0;
      for (int e = static_cast<int>(start); half_edges_[e].cycle < 0; e = half_edges_[e].next, ++n)
        half_edges_[e].cycle = static_cast<int>(cycles.size());
      Ring ring;
      ring.reserve(n);
      for (int e = static_cast<int>(start); ring.size() < n; e = half_edges_[e].next)
        ring.push_back(points_[half_edges_[e].from]);
      const double doubled = doubled_area(ring);
      if (std::abs(doubled) <= rounding_of(ring)) {
        cycles.push_back({});
      } else if (doubled > 0) {
        cycles.push_back({{}, static_cast<int>(result.pieces.size())});
        result.pieces.emplace_back().outer = std::move(ring);
      } else {
        cycles.push_back({std::move(ring)});
      }
    }
    std::vector<Bounds> around;
    for (const Outline& piece : result.pieces) around.push_back(bounds_of(piece.outer));
    for (Cycle& cycle : cycles) {
      if (cycle.hole.empty()) continue;
      for (std::size_t i = 0; i < result.pieces.size() && cycle.piece < 0; ++i)
        if (result.pieces.size() == 1 ||
            (around[i].contains(cycle.hole[0]) && surrounds(result.pieces[i].outer, cycle.hole)))
          cycle.piece = static_cast<int>(i);
      if (cycle.piece >= 0) result.pieces[cycle.piece].holes.push_back(std::move(cycle.hole));
    }

    for (std::size_t e = 0; e < half_edges_.size(); ++e) {
      const HalfEdge& half = half_edges_[e];
      if (half.cut < 0) continue;
      ++e;  // its other half
      const Interval interval{half.cut, cycles[half.cycle].piece, cycles[half_edges_[e].cycle].piece,
                              points_[half.from], points_[half.to]};
      if (interval.left < 0 || interval.right < 0) continue;
      if (interval.left == interval.right) {
        problem(half.cut,
                "separates nothing between " + to_string(interval.from) + " and " + to_string(interval.to),
                "cut the body apart, or leave this cut out");
        continue;
      }
      Interval* last = result.intervals.empty() ? nullptr : &result.intervals.back();
      if (last && last->cut == interval.cut && last->to == interval.from && last->left == interval.left &&
          last->right == interval.right)
        last->to = interval.to;
      else
        result.intervals.push_back(interval);
    }
    return result;
  }

  // Of a ring's doubled area: a point where a cut crosses an edge is off it by a few units in the last place
  // of the outline's size, which moves the edges beside it by as much.
  double rounding_of(const Ring& ring) const {
    double perimeter = length(ring.front() - ring.back());
    for (std::size_t i = 1; i < ring.size(); ++i) perimeter += length(ring[i] - ring[i - 1]);
    return 8 * std::numeric_limits<double>::epsilon() * size_ * perimeter;
  }

  static bool surrounds(const Ring& outer, const Ring& inner) {
    for (const Point& p : inner)
      if (const int where = locate(outer, p)) return where > 0;
    return true;  // touches with all its vertices
  }

  double tolerance() const { return 1e-9 * size_; }
  void problem(int cut, std::string what, std::string remedy) {
    problems_.push_back({*place_ + ", cut " + std::to_string(cut), std::move(what), std::move(remedy)});
    useless_.push_back(cut);
  }
  Split list(std::vector<int>& useless) {
    std::sort(useless_.begin(), useless_.end());
    useless_.erase(std::unique(useless_.begin(), useless_.end()), useless_.end());
    useless = useless_;
    return {};
  }
  void refuse_problems() {
    if (!problems_.empty()) throw InvalidInput(std::move(problems_));
  }

  std::span<const Cut> cuts_;
  const std::string* place_ = nullptr;
  std::vector<Problem> problems_;
  std::vector<int> useless_;  // the cuts that they are about
  double size_ = 0;
  std::vector<Point>
      points_;  // the rings' vertices, then where cuts cross edges, then where they cross each other
  std::size_t vertices_ = 0;
  std::vector<Line> edges_, chords_;
  std::vector<Crossing> edge_crossings_, chord_crossings_;
  std::vector<std::pair<int, int>> touching_;
  std::vector<int> same_;  // union-find over points that are one
  std::vector<HalfEdge> half_edges_;
  std::vector<int> departures_;           // per point, a half-edge that leaves it along the outline
  std::vector<int> arrivals_;             // per point, one half-edge that arrives there; siblings follow
  std::vector<double> offsets_, places_;  // of vertices and of parallel cuts, across the cuts
  std::vector<Event> events_;
};

}  // namespace

struct Splitter::Workspace {
  PlanarMap map;
};

Splitter::Splitter() : workspace_(std::make_unique<Workspace>()) {}
Splitter::~Splitter() = default;

Split Splitter::split(const Outline& outline, std::span<const Cut> cuts, const std::string& place,
                      std::vector<int>* useless) {
  return workspace_->map.run(outline, cuts, place, useless);
}

int locate(const Ring& ring, Point point) {
  // The half-line from the point to the right crosses the edges that go up or down past it.
  int winding = 0;
  Point a = ring.back();
  for (const Point& b : ring) {
    if ((a.y <= point.y) != (b.y <= point.y) || (a.y == point.y && b.y == point.y)) {
      const int side = orientation(a, b, point);
      if (side == 0) {
        if (std::min(a.x, b.x) <= point.x && point.x <= std::max(a.x, b.x)) return 0;
      } else if ((a.y <= point.y) != (b.y <= point.y) && (side > 0) == (b.y > a.y)) {
        winding += side;
      }
    } else if (b == point) {
      return 0;
    }
    a = b;
  }
  return winding != 0 ? 1 : -1;
}

}  // namespace ductile::calibration
