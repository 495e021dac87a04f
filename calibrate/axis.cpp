#include "axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ductile/moments.h"

namespace ductile::calibration {
namespace {

// A branch that reaches no farther than so many of its widths is a corner (of 37° or more) or a bump.
constexpr double stub = 1.5;
// A hole with a diagonal above this many times area/perimeter of the outer ring (half the width of a strip)
// parts the strip in two; below, it only lightens it.
constexpr double parting = 3.5;
// Sine of the least angle between a chord and the sides of its strip.
constexpr double least_sine = 0.7;
// Of a width: stations at corners nearer than this would not tell more.
constexpr double crowded = 0.05;
// Of a width: along the line, corners of both sides that are no farther apart are opposite.
constexpr double opposite = 0.15;
// From one station to the next, half a width on, a strip does not widen more than this.
constexpr double widening = 1.35;

double perimeter(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) sum += length(ring[(i + 1) % ring.size()] - ring[i]);
  return sum;
}

Outline without_small_holes(const Outline& outline) {
  const double most = parting * std::abs(doubled_area(outline.outer)) / 2 / perimeter(outline.outer);
  Outline result{outline.outer, {}};
  for (const Ring& hole : outline.holes)
    if (bounds_of(hole).diagonal() > most) result.holes.push_back(hole);
  return result;
}

Point ahead(const Chord& c) { return unit(right(c.left - c.right)); }
Point direction(Point v) { return length(v) > 0 ? unit(v) : Point{}; }

}  // namespace

// The triangles as a graph, less the branches that have been taken away.
struct Axis::Graph {
  std::vector<int> first;                  // half-edge, by triangle
  std::vector<int> degree;                 // neighbours left
  std::vector<bool> alive;                 // by half-edge: its triangle and the one beyond are both there
  std::vector<std::vector<Point>> beyond;  // by triangle: the farthest corners of branches taken away
  std::vector<int> node;                   // by triangle
};

struct Axis::Walk {
  int triangle, edge;  // where it ends; the boundary's half-edge, arrived or lost
  double distance;
};
constexpr int arrived = -1, lost = -2;  // lost: between triangles that rounding has turned over

Axis::Axis(const Outline& outline, std::span<const Chord> faces)
    : faces_(faces),
      triangulation_(triangulate(without_small_holes(outline))),
      corners_(static_cast<int>(triangulation_.points.size())) {
  add_feet(triangulation_);
  const std::vector<HalfEdge>& edges = triangulation_.edges;
  const std::vector<Point>& points = triangulation_.points;
  const int n = static_cast<int>(edges.size());
  Graph g;
  triangle_.assign(edges.size(), -1);
  for (int e = 0; e < n; ++e) {
    if (triangle_[e] >= 0) continue;
    for (const int own : {e, edges[e].next, edges[e].previous})
      triangle_[own] = static_cast<int>(g.first.size());
    g.first.push_back(e);
  }
  g.degree.assign(g.first.size(), 0);
  g.alive.assign(edges.size(), false);
  g.beyond.resize(g.first.size());
  g.node.assign(g.first.size(), -1);
  for (int e = 0; e < n; ++e)
    if (edges[e].twin >= 0) {
      g.alive[e] = true;
      ++g.degree[triangle_[e]];
    }

  const auto of = [&](int t) {
    return std::array{g.first[t], edges[g.first[t]].next, edges[g.first[t]].previous};
  };
  // The half-edge by which the graph goes on from where e leads; −1 at ends and nodes.
  const auto onward = [&](int e) {
    const int t = triangle_[edges[e].twin];
    if (g.degree[t] == 2)
      for (const int next : of(t))
        if (g.alive[next] && next != edges[e].twin) return next;
    return -1;
  };

  // Takes away all branches that are corners or bumps, then those that have become one by that.
  std::vector<int> ends, branch, gone;
  for (int t = 0; t < std::ssize(g.first); ++t)
    if (g.degree[t] == 1) ends.push_back(t);
  while (!ends.empty()) {
    gone.clear();
    for (const int end : ends) {
      branch.clear();
      for (const int e : of(end))
        if (g.alive[e]) branch.push_back(e);
      if (branch.size() != 1) continue;
      for (int e = onward(branch[0]); e >= 0; e = onward(e)) branch.push_back(e);
      const int gate = branch.back();
      if (g.degree[triangle_[edges[gate].twin]] < 3) continue;
      const Point p = points[edges[gate].from], along = points[edges[edges[gate].next].from] - p;
      double reach = 0;
      for (const int e : branch) {
        for (const int corner : of(triangle_[e]))
          reach = std::max(reach, cross(along, points[edges[corner].from] - p));
        for (const Point& q : g.beyond[triangle_[e]]) reach = std::max(reach, cross(along, q - p));
      }
      if (reach < stub * dot(along, along)) gone.insert(gone.end(), branch.begin(), branch.end());
    }
    ends.clear();
    for (const int e : gone) {
      const int from = triangle_[e], to = triangle_[edges[e].twin];
      g.alive[e] = g.alive[edges[e].twin] = false;
      --g.degree[from];
      if (--g.degree[to] == 1) ends.push_back(to);
      for (const int corner : of(from)) g.beyond[to].push_back(points[edges[corner].from]);
      g.beyond[to].insert(g.beyond[to].end(), g.beyond[from].begin(), g.beyond[from].end());
      g.beyond[from].clear();
    }
    std::erase_if(ends, [&](int t) { return g.degree[t] != 1; });
  }

  first_ = g.first;
  // Triangles of three neighbours that are neighbours themselves, as the two in the middle of a cross, are
  // one node: between them is no strip.
  std::vector<int> node;
  for (int t = 0; t < std::ssize(g.first); ++t) {
    if (g.degree[t] < 3 || g.node[t] >= 0) continue;
    node.assign(1, t);
    g.node[t] = static_cast<int>(nodes.size());
    Point sum{};
    for (std::size_t i = 0; i < node.size(); ++i)
      for (const int e : of(node[i])) {
        sum = sum + points[edges[e].from];
        if (!g.alive[e]) continue;
        const int other = triangle_[edges[e].twin];
        if (g.degree[other] < 3) continue;
        g.alive[e] = g.alive[edges[e].twin] = false;
        if (g.node[other] < 0) node.push_back(other);
        g.node[other] = g.node[t];
      }
    nodes.push_back(1 / (3 * static_cast<double>(node.size())) * sum);
  }
  for (const bool at_ends : {true, false})  // first what ends, then what closes
    for (int t = 0; t < std::ssize(g.first); ++t) {
      if (g.degree[t] == 0 || (g.degree[t] != 2) != at_ends) continue;
      for (const int start : of(t)) {
        if (!g.alive[start]) continue;
        std::vector<int> way;
        for (int e = start; e >= 0;) {
          way.push_back(e);
          const int next = onward(e);
          g.alive[e] = g.alive[edges[e].twin] = false;
          e = next >= 0 && g.alive[next] ? next : -1;
        }
        add_member(way, t, triangle_[edges[way.back()].twin], g);
      }
    }
  measure();
}

// Along half-edges that it crosses, from triangle to triangle.
void Axis::add_member(const std::vector<int>& way, int first, int last, const Graph& g) {
  const std::vector<HalfEdge>& edges = triangulation_.edges;
  const auto middle_of = [&](int e) {
    return middle(triangulation_.points[edges[e].from], triangulation_.points[edges[edges[e].next].from]);
  };
  Member m;
  m.from = g.node[first];
  m.to = g.node[last];
  m.closed = first == last && m.from < 0;
  std::vector<Step> rough;
  rough.reserve(way.size());
  for (const int e : way) rough.push_back({middle_of(e), triangle_[edges[e].twin]});
  if (m.closed) {
    rough.push_back(rough.front());
  } else if (way.size() == 1) {  // two triangles: from the middles of the edges that lie across
    const auto end = [&](int e) {
      const Point along = points_to(e);
      const bool next = std::abs(dot(direction(points_to(edges[e].next)), direction(along))) <
                        std::abs(dot(direction(points_to(edges[e].previous)), direction(along)));
      return middle_of(next ? edges[e].next : edges[e].previous);
    };
    rough = {{end(way[0]), first}, {middle_of(way[0]), last}, {end(edges[way[0]].twin), last}};
  }
  const double apart = find_stations(m, rough);
  if (m.stations.empty()) return;
  drop_wide_ends(m);
  extend(m, apart);
  std::vector<Point> corners;
  const auto add_triangle = [&](int t) {
    for (int k = 0, e = g.first[t]; k < 3; ++k, e = edges[e].next)
      if (edges[e].from < corners_) corners.push_back(triangulation_.points[edges[e].from]);
    corners.insert(corners.end(), g.beyond[t].begin(), g.beyond[t].end());
  };
  add_triangle(first);
  for (const int e : way) add_triangle(triangle_[edges[e].twin]);
  add_corners(m, corners);
  for (const Chord& face : faces_) end_at(m, face);
  members.push_back(std::move(m));
}

Point Axis::points_to(int e) const {
  return triangulation_.points[triangulation_.edges[triangulation_.edges[e].next].from] -
         triangulation_.points[triangulation_.edges[e].from];
}

// Chords across a rough line, half a width apart, then again across the line of their middles. Returns how
// far they are apart.
double Axis::find_stations(Member& m, const std::vector<Step>& rough) const {
  double extent = 0;
  for (std::size_t i = 1; i < rough.size(); ++i) extent += length(rough[i].at - rough[i - 1].at);
  struct Guess {
    Step step;
    Point along;
    std::optional<Member::Station> found;
  };
  const auto guesses = [&](int n) {
    std::vector<Guess> result;
    double passed = 0;
    std::size_t leg = 1;
    for (int i = 0; i < n; ++i) {
      const double s = extent * (i + 0.5) / n;
      while (leg + 1 < rough.size() && passed + length(rough[leg].at - rough[leg - 1].at) < s) {
        passed += length(rough[leg].at - rough[leg - 1].at);
        ++leg;
      }
      const Point along = direction(rough[leg].at - rough[leg - 1].at);
      Guess g{{rough[leg - 1].at + (s - passed) * along, rough[leg - 1].triangle}, along, std::nullopt};
      g.found = chord_at(g.step, along);
      if (g.found && length(middle(g.found->chord) - g.step.at) > 0.75 * width(g.found->chord))
        g.found.reset();
      result.push_back(g);
    }
    return result;
  };
  std::vector<double> widths;
  if (extent > 0)
    for (const Guess& g : guesses(8))
      if (g.found) widths.push_back(width(g.found->chord));
  if (widths.empty()) return 0;
  const auto half = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), half, widths.end());
  const int n = static_cast<int>(std::clamp(std::ceil(2 * extent / *half), 8.0, 256.0));

  const std::vector<Guess> list = guesses(n);
  for (int i = 0; i < n; ++i) {
    const Guess& g = list[i];
    if (!g.found) continue;
    const Guess *last = i > 0      ? &list[i - 1]
                        : m.closed ? &list[n - 1]
                                   : nullptr,
                *next = i + 1 < n  ? &list[i + 1]
                        : m.closed ? &list[0]
                                   : nullptr;
    const Point along = last && next && last->found && next->found
                            ? direction(middle(next->found->chord) - middle(last->found->chord))
                            : ahead(g.found->chord);
    if (dot(along, g.along) <= 0) continue;
    auto found = chord_at({middle(g.found->chord), g.found->triangle}, along);
    if (!found || width(found->chord) > 3 * *half) continue;
    if (!m.stations.empty()) {
      const Member::Station& before = m.stations.back();
      if (!is_after(*found, before)) continue;
      found->follows =
          length(middle(found->chord) - middle(before.chord)) < 2.2 * extent / n && follows(*found, before);
    }
    m.stations.push_back(*found);
  }
  return extent / n;
}

// A node widens and turns what it touches: the last stations before it are those like the ones before.
void Axis::drop_wide_ends(Member& m) const {
  const auto wide = [](auto begin, auto end) {
    auto cut = begin;
    for (auto i = begin; i != end && i + 1 != end && i - begin < 4; ++i)
      if (width(i->chord) > widening * width((i + 1)->chord) ||
          dot(ahead(i->chord), ahead((i + 1)->chord)) < 0.75)
        cut = i + 1;
    return cut - begin;
  };
  std::vector<Member::Station>& all = m.stations;
  if (m.to >= 0) all.resize(all.size() - static_cast<std::size_t>(wide(all.rbegin(), all.rend())));
  if (m.from >= 0) all.erase(all.begin(), all.begin() + wide(all.begin(), all.end()));
}

// Further stations where none follows: before and after corners, nodes and ends, as far as chords go.
void Axis::extend(Member& m, double apart) const {
  std::vector<Member::Station> result;
  const std::size_t n = m.stations.size();
  for (std::size_t i = 0; i < n; ++i) {
    Member::Station station = m.stations[i];
    const bool starts = i == 0 ? !m.closed : !station.follows;
    if (starts) {
      std::vector<Member::Station> before =
          march(station, -1, apart, i > 0 ? &m.stations[i - 1] : nullptr, m.from);
      // What both sides of a gap reach is the side's that came first.
      while (!before.empty() && !result.empty() && !is_after(before.back(), result.back())) before.pop_back();
      if (!before.empty()) {
        station.follows = true;
        std::reverse(before.begin(), before.end());
        for (Member::Station& s : before) s.follows = &s != before.data();
        result.insert(result.end(), before.begin(), before.end());
      }
    }
    result.push_back(station);
    const bool stops = i + 1 < n ? !m.stations[i + 1].follows : !m.closed;
    if (stops)
      for (Member::Station& s : march(station, 1, apart, i + 1 < n ? &m.stations[i + 1] : nullptr, m.to)) {
        s.follows = true;
        result.push_back(s);
      }
  }
  m.stations = std::move(result);
}

// Step by step from a station, sign −1: backwards, up to the next station where there is one, or a node.
std::vector<Member::Station> Axis::march(Member::Station from, double sign, double apart,
                                         const Member::Station* up_to, int node) const {
  std::vector<Member::Station> result;
  for (double step = apart; step > apart / 64;) {
    const Point base = middle(from.chord), along = ahead(from.chord);
    const Walk way = walk(from.triangle, base, sign * along, step);
    auto found =
        way.edge == arrived ? chord_at({base + sign * step * along, way.triangle}, along) : std::nullopt;
    const auto in_order = [&](const Member::Station& a, const Member::Station& b) {
      return sign > 0 ? is_after(a, b) : is_after(b, a);
    };
    if (found && in_order(*found, from) && follows(*found, from, sign) &&
        (!up_to || in_order(*up_to, *found)) &&
        (up_to || node < 0 || sign * dot(nodes[node] - middle(found->chord), ahead(found->chord)) > 0) &&
        result.size() < 64) {
      from = *found;
      result.push_back(from);
      if (step < apart) step /= 2;
    } else {
      step /= 2;
    }
  }
  return result;
}

bool Axis::is_after(const Member::Station& a, const Member::Station& b) {
  const Point step = middle(a.chord) - middle(b.chord);
  return dot(step, ahead(a.chord)) > 0 && dot(step, ahead(b.chord)) > 0;
}

// Is a part of the same strip as b, with both its sides beyond it (sign −1: before it)?
bool Axis::follows(const Member::Station& a, const Member::Station& b, double sign) {
  const double ratio = width(a.chord) / width(b.chord);
  const Point on = sign * ahead(b.chord);
  return ratio < widening && ratio > 1 / widening && dot(a.chord.left - b.chord.left, on) > 0 &&
         dot(a.chord.right - b.chord.right, on) > 0;
}

// Where chords at an end touch a face, they run into one of its corners: chords that turn from the face to
// the first one that is clear of it take their place.
void Axis::end_at(Member& m, const Chord& face) const {
  const auto touches = [&](const Member::Station& s) {
    const Point along = face.right - face.left;
    const auto on = [&](Point p) {
      const double t = dot(p - face.left, along) / dot(along, along);
      return t >= 0 && t <= 1 && std::abs(cross(along, p - face.left)) <= 1e-6 * dot(along, along);
    };
    return on(s.chord.left) || on(s.chord.right);
  };
  for (const bool at_start : {true, false}) {
    if (m.closed || (at_start ? m.from : m.to) >= 0) continue;
    std::vector<Member::Station>& all = m.stations;
    if (!at_start) std::reverse(all.begin(), all.end());
    std::size_t dropped = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (touches(all[i])) dropped = i + 1;
    if (dropped > 0 && dropped < all.size() && 2 * width(face) > width(all[dropped].chord)) {
      const Member::Station& first = all[dropped];
      Member::Station end{.chord = face};
      const Point inwards = middle(first.chord) - middle(face);
      if ((dot(ahead(face), inwards) > 0) != at_start) std::swap(end.chord.left, end.chord.right);
      std::vector<Member::Station> fanned{end};
      const int n = static_cast<int>(std::clamp<std::size_t>(dropped, 3, 16));
      for (int i = n; i > 0; --i)
        if (const auto between = fan(first, end, static_cast<double>(i) / (n + 1)))
          fanned.push_back(*between);
      for (Member::Station& s : fanned) s.follows = s.fans = true;
      all.erase(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(dropped));
      if (at_start) {  // what a station is flagged with tells of the one before it
        fanned.front().follows = fanned.front().fans = false;
        all.front().follows = all.front().fans = true;
        all.front().straight = false;
      }
      all.insert(all.begin(), fanned.begin(), fanned.end());
    }
    if (!at_start) std::reverse(all.begin(), all.end());
  }
}

std::optional<Member::Station> Axis::fan(const Member::Station& a, const Member::Station& b,
                                         double share) const {
  const Point u = direction((1 - share) * ahead(a.chord) + share * ahead(b.chord));
  const auto step = step_to(a.triangle >= 0 ? a : b, (1 - share) * middle(a.chord) + share * middle(b.chord));
  return step ? chord_across(*step, u) : std::nullopt;
}

// Further stations, whose chords end in corners of the sides, so that between two of them the sides are
// straight. The corners come in about their order along the line.
void Axis::add_corners(Member& m, const std::vector<Point>& corners) const {
  const std::vector<Member::Station>& all = m.stations;
  struct Corner {
    std::size_t after;  // the station before it
    double share;       // of the way to the next one
    Point at;
    bool on_left;
  };
  std::vector<Corner> places;
  places.reserve(corners.size());
  std::size_t k = 0;
  for (const Point& corner : corners) {
    const auto beyond = [&](const Chord& c) { return dot(corner - middle(c), ahead(c)) > 0; };
    while (k + 2 < all.size() && beyond(all[k + 1].chord)) ++k;
    while (k > 0 && !beyond(all[k].chord)) --k;
    if (k + 1 >= all.size() || !all[k + 1].follows) continue;
    const Chord &a = all[k].chord, &b = all[k + 1].chord;
    if (!beyond(a) || beyond(b)) continue;
    const bool on_left = cross(middle(b) - middle(a), corner - middle(a)) > 0;
    const Point from = on_left ? a.left : a.right, along = (on_left ? b.left : b.right) - from;
    places.push_back({k, dot(corner - from, along) / dot(along, along), corner, on_left});
  }
  std::sort(places.begin(), places.end(), [](const Corner& x, const Corner& y) {
    return x.after != y.after ? x.after < y.after : x.share < y.share;
  });
  places.erase(std::unique(places.begin(), places.end(),
                           [](const Corner& x, const Corner& y) { return x.at == y.at; }),
               places.end());
  std::vector<Member::Station> result;
  result.reserve(all.size() + places.size());
  auto place = places.begin();
  bool straight = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    result.push_back(all[i]);
    result.back().straight = straight;
    straight = i + 1 < all.size() && all[i + 1].follows;
    const std::size_t first = result.size();
    for (; place != places.end() && place->after == i; ++place) {
      const Member::Station &last = result.back(), &next = all[i + 1];
      const Point u = direction((1 - place->share) * ahead(all[i].chord) + place->share * ahead(next.chord));
      std::optional<Member::Station> found;
      // Corners of both sides that are almost opposite share a chord.
      if (const auto other = place + 1;
          other != places.end() && other->after == i && other->on_left != place->on_left &&
          std::abs(dot(other->at - place->at, u)) < opposite * width(last.chord)) {
        found = place->on_left ? chord_between(place->at, other->at, all[i])
                               : chord_between(other->at, place->at, all[i]);
        ++place;
      } else {
        const double w = (1 - place->share) * width(all[i].chord) + place->share * width(next.chord);
        const Point inwards = place->on_left ? right(u) : left(u);
        if (const auto at = step_to(all[i], place->at + w / 2 * inwards)) found = chord_across(*at, u);
      }
      const auto apart = [&](const Member::Station& x, const Member::Station& y) {
        return length(middle(x.chord) - middle(y.chord)) > crowded * width(y.chord) && follows(x, y);
      };
      if (found && apart(*found, last) && apart(next, *found)) {
        found->follows = true;
        result.push_back(*found);
      } else {
        straight = false;
      }
    }
    for (std::size_t r = first; r < result.size(); ++r) result[r].straight = straight;
  }
  m.stations = std::move(result);
}

std::optional<Member::Station> Axis::chord_between(Point left, Point right,
                                                   const Member::Station& near) const {
  const auto at = step_to(near, middle(left, right));
  if (!at) return std::nullopt;
  return Member::Station{.chord = {left, right}, .triangle = at->triangle};
}

std::optional<Axis::Step> Axis::step_to(const Member::Station& from, Point at) const {
  if (from.triangle < 0) return std::nullopt;  // a face
  const Point start = middle(from.chord);
  const Walk way = walk(from.triangle, start, direction(at - start), length(at - start));
  if (way.edge != arrived) return std::nullopt;
  return Step{at, way.triangle};
}

// Where members begin and end, and how long they are.
void Axis::measure() {
  // A node is in the middle of the faces of its members.
  std::vector<Point> sum(nodes.size());
  std::vector<int> count(nodes.size());
  const auto add = [&](int node, const Member::Station& face) {
    if (node < 0) return;
    sum[node] = sum[node] + middle(face.chord);
    ++count[node];
  };
  for (const Member& m : members) {
    add(m.from, m.stations.front());
    add(m.to, m.stations.back());
  }
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (count[i] > 1) nodes[i] = (1.0 / count[i]) * sum[i];

  const auto beyond = [&](const Member::Station& s, double sign) {
    const Point at = middle(s.chord), on = sign * ahead(s.chord);
    if (s.triangle < 0) return at;  // a face
    return at + walk(s.triangle, at, on, std::numeric_limits<double>::infinity()).distance * on;
  };
  for (Member& m : members) {
    m.start = m.from >= 0 ? nodes[m.from]
              : m.closed  ? middle(m.stations.front().chord)
                          : beyond(m.stations.front(), -1);
    m.end = m.to >= 0 ? nodes[m.to] : m.closed ? m.start : beyond(m.stations.back(), 1);
    Point at = m.start;
    for (Member::Station& s : m.stations) {
      m.length += length(middle(s.chord) - at);
      s.s = m.length;
      at = middle(s.chord);
    }
    m.length += length(m.end - at);
  }
}

Member::Station Axis::at(const Member& m, double s) const {
  const auto after = std::lower_bound(m.stations.begin(), m.stations.end(), s,
                                      [](const Member::Station& x, double value) { return x.s < value; });
  if (after == m.stations.end()) return m.stations.back();
  if (after == m.stations.begin()) return m.stations.front();
  const Member::Station &a = *(after - 1), &b = *after, &nearest = s - a.s < b.s - s ? a : b;
  if (!b.follows) return nearest;
  const double share = (s - a.s) / (b.s - a.s);
  if (b.straight) {
    Member::Station result = nearest;
    result.s = s;
    result.chord = {a.chord.left + share * (b.chord.left - a.chord.left),
                    a.chord.right + share * (b.chord.right - a.chord.right)};
    return result;
  }
  if (b.fans) {
    auto found = fan(a, b, share);
    if (found) found->s = s;
    return found.value_or(nearest);
  }
  const Point from = middle(a.chord), along = middle(b.chord) - from;
  const auto step = step_to(a, from + share * along);
  if (!step) return nearest;
  auto found = chord_at(*step, direction(along));
  const double most = 1.5 * std::max(width(a.chord), width(b.chord));
  if (!found || width(found->chord) > most) return nearest;
  found->s = std::clamp(a.s + dot(middle(found->chord) - from, direction(along)), a.s, b.s);
  return *found;
}

// The chord through a point in a triangle, along being about the strip's direction there.
std::optional<Member::Station> Axis::chord_at(Step start, Point along) const {
  const auto [at, triangle] = start;
  const std::vector<HalfEdge>& edges = triangulation_.edges;
  const auto side = [&](const Walk& w) {
    return direction(triangulation_.points[edges[edges[w.edge].next].from] -
                     triangulation_.points[edges[w.edge].from]);
  };
  constexpr double everything = std::numeric_limits<double>::infinity();
  Point u = along;
  for (int turn = 0;; ++turn) {
    const Walk l = walk(triangle, at, left(u), everything), r = walk(triangle, at, right(u), everything);
    if (l.edge < 0 || r.edge < 0) return std::nullopt;
    // The material lies left of both sides: they run forward on the right and backward on the left.
    const Point both = side(r) - side(l);
    if (length(both) < 1) return std::nullopt;
    const Point better = unit(both);
    if (turn < 3 && dot(better, along) > 0.6 && std::abs(cross(better, u)) > 1e-9) {
      u = better;
      continue;
    }
    if (dot(better, u) < 0.95) return std::nullopt;  // from a corner to another side
    if (std::min(std::abs(dot(side(l), u)), std::abs(dot(side(r), u))) < least_sine) return std::nullopt;
    return station(start, u, l.distance, r.distance);
  }
}

// The chord across a direction.
std::optional<Member::Station> Axis::chord_across(Step start, Point u) const {
  constexpr double everything = std::numeric_limits<double>::infinity();
  const Walk l = walk(start.triangle, start.at, left(u), everything),
             r = walk(start.triangle, start.at, right(u), everything);
  if (l.edge < 0 || r.edge < 0) return std::nullopt;
  return station(start, u, l.distance, r.distance);
}

std::optional<Member::Station> Axis::station(Step start, Point u, double to_left, double to_right) const {
  const auto [at, triangle] = start;
  if (!(to_left + to_right > 0)) return std::nullopt;
  const double off = (to_left - to_right) / 2;
  const Walk to_middle = walk(triangle, at, off > 0 ? left(u) : right(u), std::abs(off));
  if (to_middle.edge != arrived) return std::nullopt;
  Member::Station result;
  result.chord = {at + to_left * left(u), at + to_right * right(u)};
  result.triangle = to_middle.triangle;
  return result;
}

// Straight on through triangles, as far as `most` or to the boundary.
Axis::Walk Axis::walk(int triangle, Point from, Point direction, double most) const {
  const std::vector<HalfEdge>& edges = triangulation_.edges;
  const std::vector<Point>& points = triangulation_.points;
  Walk result{triangle, arrived, most};
  int entered = -1;
  // The half-edge of the triangle by which the line leaves it.
  for (std::size_t budget = edges.size(); budget > 0; --budget) {
    int leaves = -1;
    double distance = -1;
    int e = entered >= 0 ? edges[entered].next : first_[result.triangle];
    Point a = points[edges[e].from] - from;
    double side = cross(direction, a);  // > 0: left of the line
    for (int k = entered >= 0 ? 2 : 3; k > 0; --k) {
      const int next = edges[e].next;
      const Point b = points[edges[next].from] - from;
      const double side_of_b = cross(direction, b);
      if (side <= 0 && side_of_b >= 0 && side_of_b > side)
        if (const double d = cross(a, b) / (side_of_b - side); leaves < 0 || d > distance)
          leaves = e, distance = d;
      a = b;
      side = side_of_b;
      e = next;
    }
    if (leaves < 0) return {result.triangle, lost, 0};
    if (distance >= most) return {result.triangle, arrived, most};
    if (edges[leaves].twin < 0) return {result.triangle, leaves, std::max(distance, 0.0)};
    entered = edges[leaves].twin;
    result.triangle = triangle_[entered];
  }
  return {result.triangle, lost, 0};
}

}  // namespace ductile::calibration
