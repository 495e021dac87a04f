#include "automatic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>

#include "axis.h"
#include "convex.h"
#include "ductile/box2d.h"
#include "moments.h"
#include "plane.h"

namespace ductile {
namespace {

// m; Box2D collides nothing below 4 b2_linearSlop = 0.02 m.
constexpr double thinnest = 0.02;
// m, between two cuts and across them: a piece with corners this far apart is thick enough.
constexpr double least_side = 1.25 * thinnest;
// Of the longest way through a body (an error of 1e-6 in a cantilever); of all ways, twice as many.
constexpr double most_parts = 1000;
// Of a piece's length: two cuts are this far apart on both sides.
constexpr double least_share = 0.2;
// The estimate is for the axis as a beam; what it leaves out (shear, the chord for the arc) is small.
constexpr double margin = 0.95;

// A place on the centreline.
struct Place {
  double s = 0;  // m along it
  Point at;
  double width = 0;  // m
};

Place between(const Place& a, const Place& b, double s) {
  const double share = b.s > a.s ? (s - a.s) / (b.s - a.s) : 0;
  return {s, a.at + share * (b.at - a.at), a.width + share * (b.width - a.width)};
}

Place on(const std::vector<Place>& line, double s) {
  const auto after = std::lower_bound(line.begin() + 1, line.end() - 1, s,
                                      [](const Place& p, double value) { return p.s < value; });
  return between(*(after - 1), *after, s);
}

Point middle(const Chord& c) { return middle(c.left, c.right); }
double width(const Chord& c) { return length(c.left - c.right); }

// A member's line from end to end.
std::vector<Place> line_of(const Member& m) {
  std::vector<Place> line{{0, m.start, width(m.stations.front().chord)}};
  for (const Member::Station& station : m.stations)
    line.push_back({station.s, middle(station.chord), width(station.chord)});
  line.push_back({m.length, m.end, width(m.stations.back().chord)});
  return line;
}

struct PlacedCut {
  int way;
  double s;
  Chord chord;
  double length = 0;  // ℓ
};

// --- the error of a chain of rigid pieces ---

// Rotations at places along a line, which the chain has at its joints and the beam everywhere.
struct Hinge {
  Place place;
  double length;  // ℓ: rotation = length · curvature
};

// The line in equal parts, from a to b; backwards where b < a.
std::vector<Hinge> parts_of(const std::vector<Place>& line, double a, double b, int n) {
  std::vector<Hinge> result;
  const double ds = std::abs(b - a) / n;
  result.reserve(static_cast<std::size_t>(n));
  std::size_t after = 1;  // of the line's places
  for (int i = 0; i < n; ++i) {
    const double s = std::min(a, b) + (i + 0.5) * ds;
    while (after + 1 < line.size() && line[after].s < s) ++after;
    Place p = between(line[after - 1], line[after], s);
    p.s = std::abs(s - a);
    result.push_back({p, ds});
  }
  if (b < a) std::reverse(result.begin(), result.end());
  return result;
}

struct Span {
  std::vector<Hinge> beam, chain;  // s from 0 at the span's start
};

// u at the beam's parts, of the rotations θ of hinges: u(s) = Σ_{s_i < s} θ_i · left(r(s) − r_i).
std::vector<Point> displacements(const std::vector<Hinge>& at, const std::vector<Hinge>& hinges,
                                 const std::vector<double>& rotations) {
  std::vector<Point> result;
  result.reserve(at.size());
  double turn = 0;
  Point moment{};
  std::size_t k = 0;
  for (const Hinge& h : at) {
    for (; k < hinges.size() && hinges[k].place.s <= h.place.s; ++k) {
      turn += rotations[k];
      moment = moment + rotations[k] * hinges[k].place.at;
    }
    result.push_back(left(turn * h.place.at - moment));
  }
  return result;
}

double rotation(const Hinge& h, double moment) {
  const double w = h.place.width;
  return w > 0 ? moment * h.length / (w * w * w) : 0;  // EI ~ w³
}

struct Deviation {
  double most = 0, error = 0;  // displacement, and how far the chain's is from it
};

Deviation compare(const std::vector<Point>& beam, const std::vector<Point>& chain) {
  Deviation d;
  for (std::size_t i = 0; i < beam.size(); ++i) {
    d.most = std::max(d.most, dot(beam[i], beam[i]));
    d.error = std::max(d.error, dot(beam[i] - chain[i], beam[i] - chain[i]));
  }
  return {std::sqrt(d.most), std::sqrt(d.error)};
}

// What is beyond s weighs and where: weight and first moment, per part of the beam.
struct Beyond {
  std::vector<double> weight;
  std::vector<Point> first;
  explicit Beyond(const std::vector<Hinge>& beam) : weight(beam.size() + 1), first(beam.size() + 1) {
    for (std::size_t i = beam.size(); i-- > 0;) {
      const double w = beam[i].place.width * beam[i].length;
      weight[i] = weight[i + 1] + w;
      first[i] = first[i + 1] + w * beam[i].place.at;
    }
  }
  // The moment about a place of what weighs beyond it along d.
  double moment(const Place& p, Point d, double ds) const {
    const double x = std::clamp(p.s / ds, 0.0, static_cast<double>(weight.size() - 1));
    const std::size_t i = std::min(static_cast<std::size_t>(x), weight.size() - 2);
    const double share = x - static_cast<double>(i);
    const double w = weight[i] + share * (weight[i + 1] - weight[i]);
    const Point f = first[i] + share * (first[i + 1] - first[i]);
    return cross(f - w * p.at, d);
  }
};

// Clamped at the span's start, free at its end; weight along x or y, whichever is worse, unless that hardly
// bends it.
Deviation cantilever(const Span& span) {
  Deviation worst;
  const Beyond beyond(span.beam);
  for (const Point d : {Point{1, 0}, Point{0, 1}}) {
    const auto rotations = [&](const std::vector<Hinge>& hinges) {
      std::vector<double> result;
      for (const Hinge& h : hinges)
        result.push_back(rotation(h, beyond.moment(h.place, d, span.beam.front().length)));
      return result;
    };
    const Deviation own = compare(displacements(span.beam, span.beam, rotations(span.beam)),
                                  displacements(span.beam, span.chain, rotations(span.chain)));
    if (own.most > 5 * worst.most ||
        (own.most > worst.most / 5 && own.error * worst.most > worst.error * own.most))
      worst = own;
  }
  return worst;
}

// Held at both ends, as a straight beam under its own weight across it.
Deviation held_at_both_ends(Span span, bool clamped) {
  for (auto* hinges : {&span.beam, &span.chain})
    for (Hinge& h : *hinges) h.place.at = {h.place.s, 0};
  const Beyond beyond(span.beam);
  const double extent = static_cast<double>(span.beam.size()) * span.beam.front().length;
  const auto shape = [&](const std::vector<Hinge>& hinges) {
    // M = M_cantilever + X1 + X2 (extent − s), with ∫ κ ds = 0 and ∫ κ s ds = 0, or with no moment at the
    // ends.
    double a = 0, b = 0, c = 0, p = 0, q = 0;
    std::vector<double> moments, compliances;
    for (const Hinge& h : hinges) {
      const double k = rotation(h, 1), x = extent - h.place.s;
      moments.push_back(beyond.moment(h.place, {0, 1}, span.beam.front().length));
      compliances.push_back(k);
      a += k, b += k * x, c += k * x * x;
      p -= k * moments.back(), q -= k * x * moments.back();
    }
    double x1 = 0, x2 = -beyond.moment({}, {0, 1}, span.beam.front().length) / extent;
    if (const double det = a * c - b * b; clamped && det > 0) {
      x1 = (p * c - q * b) / det;
      x2 = (a * q - b * p) / det;
    }
    std::vector<double> rotations;
    for (std::size_t i = 0; i < hinges.size(); ++i)
      rotations.push_back(compliances[i] * (moments[i] + x1 + x2 * (extent - hinges[i].place.s)));
    std::vector<Point> u = displacements(span.beam, hinges, rotations);
    if (!clamped) {  // turn it so that the far end stays
      double end = 0;
      for (std::size_t i = 0; i < hinges.size(); ++i) end += rotations[i] * (extent - hinges[i].place.s);
      for (std::size_t i = 0; i < u.size(); ++i) u[i].y -= end * span.beam[i].place.s / extent;
    }
    return u;
  };
  return compare(shape(span.beam), shape(span.chain));
}

// --- the whole body ---

class Automatic {
 public:
  Automatic(const Outline& outline, double target, std::span<const Hold> holds)
      : outline_(outline), target_(target), axis_(outline) {
    if (!is_strip()) make_straight();
    for (const Member& m : axis_.members) lines_.push_back(line_of(m));
    find_longest_path();
    find_holds(holds);
  }

  AutomaticSplit run(Splitter& splitter, const std::string& place) {
    const double extent = line_.back().s;
    std::vector<PlacedCut> best;
    double error = std::numeric_limits<double>::infinity();
    // The error falls as 1/n² as long as the shape allows more cuts.
    for (double n = std::min(std::ceil(std::sqrt((clamped_both_ ? 8 : 1) / target_)), most_parts), last_n = 0,
                round = 0;
         ;) {
      double h = std::max(extent / n, least_side);
      std::vector<PlacedCut> cuts = place_cuts(h);
      for (; static_cast<double>(cuts.size()) > 2 * most_parts; h *= 2) cuts = place_cuts(2 * h);
      const double own = error_of(cuts), expected = error * (last_n / n) * (last_n / n);
      const bool stalls = own > 1.5 * expected && own > 0.7 * error;
      if (!stalls || best.empty()) best = std::move(cuts), error = own;
      if (own <= margin * target_ || stalls || h > extent / n || n >= most_parts) break;
      last_n = n;
      const double wanted = std::ceil(n * std::min(std::sqrt(own / (margin * target_)), 2.0));
      n = std::min(std::max(wanted, n + 1 + std::floor(0.05 * round++ * n)), most_parts);
    }
    return divide(splitter, std::move(best), place);
  }

 private:
  // Is the body a strip at all? One member that is hardly longer than wide is none.
  bool is_strip() const {
    if (axis_.members.size() != 1) return !axis_.members.empty();
    const Member& m = axis_.members[0];
    double sum = 0;
    for (const Member::Station& station : m.stations) sum += width(station.chord);
    return m.stations.size() > 2 && m.length > 1.5 * sum / static_cast<double>(m.stations.size());
  }

  // Across the axis about which the body is most slender.
  void make_straight() {
    const AreaMoments m = moments(outline_);
    const double angle = std::atan2(2 * m.xy, m.xx - m.yy) / 2;
    const Point u{std::cos(angle), std::sin(angle)};
    double low = 0, high = 0;
    for (const Point& p : outline_.outer) {
      low = std::min(low, dot(p - m.centroid, u));
      high = std::max(high, dot(p - m.centroid, u));
      reach_ = std::max(reach_, 1.01 * length(p - m.centroid));
    }
    axis_.nodes.clear();
    axis_.members = {
        Member{.start = m.centroid + low * u, .end = m.centroid + high * u, .length = high - low}};
    for (const double s : {0.0, high - low}) axis_.members[0].stations.push_back(at(0, s));
  }

  Member::Station at(int way, double s) const {
    const Member& m = axis_.members[way];
    if (reach_ == 0) return axis_.at(m, s);
    const Point u = unit(m.end - m.start), p = m.start + s * u;
    return {s, {p + reach_ * left(u), p - reach_ * left(u)}};
  }

  // --- the longest way through the body ---

  void find_longest_path() {
    // From any end to the farthest one, and from there to the farthest again: exact where nothing closes.
    if (lines_.size() == 1) {
      line_ = lines_[0];
      steps_ = {{0, false, 0}};
      node_[0] = node_[1] = axis_.members[0].from >= 0;
      return;
    }
    // From the longest member on: what lost all its chords may have come apart.
    const auto longest =
        std::max_element(axis_.members.begin(), axis_.members.end(),
                         [](const Member& a, const Member& b) { return a.length < b.length; });
    const int far = farthest(ends(static_cast<int>(longest - axis_.members.begin())).first).first;
    const auto [end, from] = farthest(far);
    std::vector<int> path;  // ways, from the end back
    for (int v = end; from[v] >= 0;) {
      path.push_back(from[v]);
      const auto [a, b] = ends(from[v]);
      v = a == v ? b : a;
    }
    int v = end;
    node_[0] = end < std::ssize(axis_.nodes);
    node_[1] = far < std::ssize(axis_.nodes);
    for (const int way : path) {
      const auto [a, b] = ends(way);
      const bool backwards = b == v && a != v;
      v = backwards ? a : b;
      const double offset = line_.empty() ? 0 : line_.back().s, extent = axis_.members[way].length;
      steps_.push_back({way, backwards, offset});
      std::vector<Place> line = lines_[way];
      if (backwards) {
        std::reverse(line.begin(), line.end());
        for (Place& p : line) p.s = extent - p.s;
      }
      for (Place& p : line) {
        p.s += offset;
        line_.push_back(p);
      }
    }
  }

  // The graph's vertices: nodes, then two for every way's free ends.
  std::pair<int, int> ends(int way) const {
    const Member& m = axis_.members[way];
    const int own = static_cast<int>(axis_.nodes.size()) + 2 * way;
    return {m.from >= 0 ? m.from : own, m.to >= 0 ? m.to : own + 1};
  }

  // Dijkstra's; the vertex farthest away, and every vertex's way back.
  std::pair<int, std::vector<int>> farthest(int start) const {
    const std::size_t n = axis_.nodes.size() + 2 * lines_.size();
    std::vector<std::vector<int>> leaving(n);
    for (int w = 0; w < std::ssize(lines_); ++w) {
      leaving[ends(w).first].push_back(w);
      leaving[ends(w).second].push_back(w);
    }
    std::vector<double> distance(n, std::numeric_limits<double>::infinity());
    std::vector<int> from(n, -1);
    std::priority_queue<std::pair<double, int>> queue;  // −distance
    distance[start] = 0;
    queue.emplace(0, start);
    int far = start;
    while (!queue.empty()) {
      const auto [d, v] = queue.top();
      queue.pop();
      if (-d > distance[v]) continue;
      far = v;
      for (const int w : leaving[v]) {
        const int other = ends(w).first == v ? ends(w).second : ends(w).first;
        if (const double there = -d + axis_.members[w].length; there < distance[other]) {
          distance[other] = there;
          from[other] = w;
          queue.emplace(-there, other);
        }
      }
    }
    return {far, std::move(from)};
  }

  void find_holds(std::span<const Hold> holds) {
    const double extent = line_.back().s;
    std::vector<std::pair<double, bool>> found;
    for (const Hold& h : holds) {
      const auto nearest = std::min_element(line_.begin(), line_.end(), [&](const Place& a, const Place& b) {
        return length(a.at - h.at) < length(b.at - h.at);
      });
      double s = nearest->s, least = length(nearest->at - h.at);
      for (std::size_t i = 1; i < line_.size(); ++i) {
        const Point a = line_[i - 1].at, along = line_[i].at - a;
        const double ll = dot(along, along);
        if (!(ll > 0)) continue;
        const double share = std::clamp(dot(h.at - a, along) / ll, 0.0, 1.0);
        if (const double d = length(h.at - a - share * along); d < least) {
          least = d;
          s = line_[i - 1].s + share * (line_[i].s - line_[i - 1].s);
        }
      }
      found.emplace_back(s < 0.02 * extent ? 0 : s > 0.98 * extent ? extent : s, h.clamps);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [s, clamps] : found) {
      // Two that lie as near as a tenth of the length clamp like one.
      if (!holds_.empty() && s - holds_.back().first < 0.1 * extent)
        holds_.back().second = true;
      else
        holds_.emplace_back(s, clamps);
    }
    if (lines_.size() == 1 && axis_.members[0].closed) holds_ = {{0, true}, {extent, true}};
    clamped_both_ = holds_.size() > 2;
    for (const auto& [s, clamps] : holds_) clamped_both_ |= holds_.size() > 1 && clamps;
  }

  // --- cuts ---

  std::vector<PlacedCut> place_cuts(double h) const {
    std::vector<PlacedCut> cuts;
    for (int w = 0; w < std::ssize(lines_); ++w) {
      if (static_cast<double>(cuts.size()) > 2 * most_parts) return cuts;
      const Member& m = axis_.members[w];
      const bool node_from = m.from >= 0, node_to = m.to >= 0;
      const double begin = node_from ? m.stations.front().s : 0,
                   end = node_to ? m.stations.back().s : m.length;
      const double extent = end - begin;
      int n = std::max(1, static_cast<int>(std::ceil(extent / h - 1e-9)));
      if (m.closed) n = std::max(n, 2);
      const std::size_t before = cuts.size();
      if (extent < h / 2 && node_from != node_to) {
        continue;  // a short arm of a node
      } else if (extent < h / 2 && node_from) {
        add(cuts, w, begin + extent / 2, h);
      } else {
        for (int k = node_from || m.closed ? 0 : 1; k < n + (node_to ? 1 : 0); ++k)
          add(cuts, w, begin + extent * k / n, h);
      }
      set_lengths(std::span(cuts).subspan(before), m);
    }
    return cuts;
  }

  // Is a cut there clear of the holes that the strip passes by? 0.1 of a piece's length is.
  bool clear_of_holes(const Chord& c, double h) const {
    const Point along = c.right - c.left;
    const double extent = length(along);
    for (const Ring& hole : outline_.holes) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Point& p : hole)
        if (const double t = dot(p - c.left, along); t > 0 && t < extent * extent) {
          low = std::min(low, cross(along, p - c.left) / extent);
          high = std::max(high, cross(along, p - c.left) / extent);
        }
      if (low < 0.1 * h && high > -0.1 * h) return false;
    }
    return true;
  }

  void add(std::vector<PlacedCut>& cuts, int w, double s, double h) const {
    const Member& m = axis_.members[w];
    Member::Station station = at(w, s);
    if (!outline_.holes.empty() && !clear_of_holes(station.chord, h))
      for (const double shift : {0.1, -0.1, 0.2, -0.2, 0.3, -0.3, 0.4, -0.4})
        if (const Member::Station other = at(w, s + shift * h); clear_of_holes(other.chord, h)) {
          station = other;
          break;
        }
    const Chord& chord = station.chord;
    const double apart = std::max(least_side, least_share * h);
    if (width(chord) < least_side) return;
    if (m.to < 0 && !m.closed && m.length - station.s < apart) return;
    if (m.from < 0 && !m.closed && station.s < apart) return;
    if (!cuts.empty() && cuts.back().way == w) {
      const PlacedCut& last = cuts.back();
      if (station.s <= last.s || length(chord.left - last.chord.left) < apart ||
          length(chord.right - last.chord.right) < apart)
        return;
    }
    cuts.push_back({w, station.s, chord});
  }

  // ℓ of the cuts of one way.
  void set_lengths(std::span<PlacedCut> cuts, const Member& m) const {
    for (std::size_t k = 0; k < cuts.size(); ++k) {
      const double s = cuts[k].s, extent = m.length;
      double back = k > 0 ? (s - cuts[k - 1].s) / 2 : m.from >= 0 ? s : s / 2;
      double on = k + 1 < cuts.size() ? (cuts[k + 1].s - s) / 2 : m.to >= 0 ? extent - s : (extent - s) / 2;
      if (m.closed) {
        if (k == 0) back = (s + extent - cuts.back().s) / 2;
        if (k + 1 == cuts.size()) on = (extent - s + cuts.front().s) / 2;
      }
      cuts[k].length = back + on;
    }
  }

  // Those of one way; they lie together.
  template <class Cuts>
  static auto cuts_of(Cuts& cuts, int way) {
    const auto first = std::partition_point(cuts.begin(), cuts.end(), [&](auto& c) { return c.way < way; });
    return std::span(first, std::partition_point(first, cuts.end(), [&](auto& c) { return c.way == way; }));
  }

  // --- error ---

  double error_of(const std::vector<PlacedCut>& cuts) const {
    std::vector<Hinge> joints;
    for (const auto& [way, backwards, offset] : steps_)
      for (const PlacedCut& c : cuts_of(cuts, way)) {
        const double s = offset + (backwards ? axis_.members[way].length - c.s : c.s);
        joints.push_back({{s, middle(c.chord), width(c.chord)}, c.length});
      }
    std::sort(joints.begin(), joints.end(),
              [](const Hinge& a, const Hinge& b) { return a.place.s < b.place.s; });
    const double extent = line_.back().s;
    if (joints.empty()) return 1;
    std::vector<Deviation> all;
    if (holds_.empty()) {
      // Free: clamped at its wider end, or at either where both are wide.
      const double first = line_.front().width, last = line_.back().width;
      if (first >= last / 2) all.push_back(cantilever(span(joints, 0, extent)));
      if (last >= first / 2) all.push_back(cantilever(span(joints, extent, 0)));
    } else {
      const double start = holds_.front().first, end = holds_.back().first;
      if (start > 0) all.push_back(cantilever(span(joints, start, 0)));
      if (end < extent) all.push_back(cantilever(span(joints, end, extent)));
      for (std::size_t i = 1; i < holds_.size(); ++i)
        all.push_back(held_at_both_ends(span(joints, holds_[i - 1].first, holds_[i].first), clamped_both_));
    }
    Deviation worst;
    for (const Deviation& d : all) worst = {std::max(worst.most, d.most), std::max(worst.error, d.error)};
    return worst.most > 0 ? worst.error / worst.most : 1;
  }

  // From a to b along the longest line; where it ends there, with joints to what holds it.
  Span span(const std::vector<Hinge>& joints, double a, double b) const {
    Span result;
    result.beam = parts_of(line_, a, b, std::max<int>(64, 4 * static_cast<int>(joints.size())));
    for (const Hinge& j : joints) {
      Hinge own = j;
      own.place.s = (b > a ? 1 : -1) * (j.place.s - a);
      if (own.place.s > 0 && own.place.s < std::abs(b - a)) result.chain.push_back(own);
    }
    if (b < a) std::reverse(result.chain.begin(), result.chain.end());
    if (result.chain.empty()) return result;
    const auto add_end = [&](double s, double to, bool at_front) {
      Place p = on(line_, s);
      p.s = at_front ? 0 : std::abs(b - a);
      result.chain.insert(at_front ? result.chain.begin() : result.chain.end(), {p, to / 2});
    };
    const auto ends = [&](double s) { return (s == 0 && !node_[0]) || (s == line_.back().s && !node_[1]); };
    if (ends(a)) add_end(a, result.chain.front().place.s, true);
    if (ends(b)) add_end(b, std::abs(b - a) - result.chain.back().place.s, false);
    return result;
  }

  // --- pieces ---

  // Cuts until every piece is one that Box2D takes, leaving out cuts that prevent it.
  AutomaticSplit divide(Splitter& splitter, std::vector<PlacedCut> cuts, const std::string& place) const {
    AutomaticSplit result;
    for (int round = 0;; ++round) {
      result.cuts.clear();
      for (const PlacedCut& c : cuts) result.cuts.push_back({c.chord.left, c.chord.right});
      std::vector<int> useless;
      result.parts = splitter.split(outline_, result.cuts, place, &useless);
      if (useless.empty()) useless = around_thin_pieces(result.parts, cuts, round > 3);
      if (useless.empty()) break;
      std::vector<PlacedCut> kept;
      for (int i = 0; i < std::ssize(cuts); ++i)
        if (std::find(useless.begin(), useless.end(), i) == useless.end()) kept.push_back(cuts[i]);
      cuts = std::move(kept);
      for (int w = 0; w < std::ssize(lines_); ++w) set_lengths(cuts_of(cuts, w), axis_.members[w]);
    }
    for (const PlacedCut& c : cuts) result.lengths.push_back(c.length);
    for (int w = 0; w < std::ssize(lines_); ++w) add_ends(result.ends, w, cuts);
    result.error = cuts.empty() ? 1 : error_of(cuts);
    return result;
  }

  // For every piece that is too thin, the cut beside it that has the shortest pieces, or all cuts beside it.
  static std::vector<int> around_thin_pieces(const Split& parts, const std::vector<PlacedCut>& cuts,
                                             bool all) {
    std::vector<int> result(parts.pieces.size(), -1);
    for (const Interval& i : parts.intervals)
      for (const int piece : {i.left, i.right})
        if (int& cut = result[piece]; cut < 0 || cuts[i.cut].length < cuts[cut].length) cut = i.cut;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (result[i] >= 0 && collides(parts.pieces[i])) result[i] = -1;
    if (all) {
      const std::vector<int> thin = result;
      for (const Interval& i : parts.intervals)
        if (thin[i.left] >= 0 || thin[i.right] >= 0) result.push_back(i.cut);
    }
    std::erase(result, -1);
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  // As shapes() asks of a piece, with a little to spare.
  static bool collides(const Outline& piece) {
    if (least_width(hull(piece.outer)) < 1.01 * thinnest) return false;
    const Point centre = moments(piece).centroid;
    for (std::vector<Point>& part : convex_parts(piece, 8)) {
      for (Point& p : part) p = p - centre;
      if (polygon_shape(part)) return true;
    }
    return false;
  }

  void add_ends(std::vector<AutomaticSplit::End>& ends, int w, const std::vector<PlacedCut>& cuts) const {
    const Member& m = axis_.members[w];
    if (m.closed) return;
    const std::span own = cuts_of(cuts, w);
    const auto ahead = [](const Chord& c) { return unit(right(c.left - c.right)); };
    if (m.from < 0)
      ends.push_back(
          {m.start, -ahead(m.stations.front().chord), (own.empty() ? m.length : own.front().s) / 2});
    if (m.to < 0)
      ends.push_back(
          {m.end, ahead(m.stations.back().chord), (m.length - (own.empty() ? 0 : own.back().s)) / 2});
  }

  const Outline& outline_;
  double target_;
  Axis axis_;
  double reach_ = 0;                       // m: how far cuts reach across a body that is no strip
  std::vector<std::vector<Place>> lines_;  // of the members
  std::vector<Place> line_;                // the longest way through the body
  std::array<bool, 2> node_{};             // does it end in a node?
  struct Step {
    int way;
    bool backwards;
    double offset;
  };
  std::vector<Step> steps_;
  std::vector<std::pair<double, bool>> holds_;  // along line_, and whether they clamp
  bool clamped_both_ = false;
};

}  // namespace

AutomaticSplit split_automatically(Splitter& splitter, const Outline& outline, double target,
                                   std::span<const Hold> holds, const std::string& place) {
  return Automatic(outline, target, holds).run(splitter, place);
}

}  // namespace ductile
