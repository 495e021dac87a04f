#include "automatic.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "axis.h"
#include "beam.h"
#include "convex.h"
#include "ductile/box2d.h"
#include "ductile/moments.h"
#include "ductile/plane.h"
#include "holes.h"

namespace ductile::calibration {
namespace {

// m; Box2D collides nothing below 4 b2_linearSlop = 0.02 m.
constexpr double thinnest = 0.02;
// m, between two cuts and across them: a piece with corners this far apart is thick enough.
constexpr double least_side = 1.25 * thinnest;
// Of the longest way through a body (an error of 1e-6 in a cantilever); of all members, twice as many.
constexpr double most_parts = 1000;
// Of a piece's length: two cuts are this far apart on both sides.
constexpr double least_share = 0.2;
// The estimate is for the axis as a beam; what it leaves out (shear, the chord for the arc) is small.
constexpr double margin = 0.95;

struct PlacedCut {
  int member;  // of the axis
  double s;
  Chord chord;
  double length = 0;  // ℓ
};

class Automatic {
 public:
  // `straight`: as a body that is no strip, whatever its axis.
  Automatic(const Outline& outline, double target, std::span<const Hold> holds, bool straight)
      : outline_(outline), holes_(outline), target_(target), faces_(faces_of(holds)), axis_(outline, faces_) {
    if (straight || !is_strip()) make_straight();
    for (int member = 0; member < std::ssize(axis_.members); ++member) lines_.push_back(line_of(member));
    find_longest_path();
    find_holds(holds);
    find_stretches();
  }

  static std::vector<Chord> faces_of(std::span<const Hold> holds) {
    std::vector<Chord> faces;
    for (const Hold& hold : holds)
      if (width(hold.face) > 0) faces.push_back(hold.face);
    return faces;
  }

  struct Try {
    std::vector<PlacedCut> cuts;
    double error;
  };

  // The fewest cuts within the target error, as far as the shape allows.
  Try search() {
    const double extent = line_.back().s;
    std::vector<Try> tries;
    // The error falls as 1/n² as long as the shape allows more cuts; where there are holes, again once pieces
    // are so short that cuts meet them, and along a spiral, once there are several to a turn.
    const int patience = outline_.holes.empty() && !is_slender() ? 1 : 3;
    double last = std::numeric_limits<double>::infinity(), last_n = 0;
    int round = 0, stalled = 0;
    for (double n = std::min(std::ceil(std::sqrt((clamped_both_ ? 8 : 1) / target_)), most_parts);;) {
      double h = std::max(extent / n, least_side);
      std::vector<PlacedCut> cuts = place_cuts(h);
      for (; static_cast<double>(cuts.size()) > 2 * most_parts; h *= 2) cuts = place_cuts(2 * h);
      const double own = error_of(cuts), expected = last * (last_n / n) * (last_n / n);
      tries.push_back({std::move(cuts), own});
      const bool stalls = own > 1.5 * expected && own > 0.7 * last;
      if (own <= margin * target_ || (stalls && ++stalled == patience) || h > extent / n || n >= most_parts)
        break;
      last = own;
      last_n = n;
      const double wanted =
          std::ceil(n * (stalls ? 2.0 : std::min(std::sqrt(own / (margin * target_)), 2.0)));
      n = std::min(std::max(wanted, n + 1 + std::floor(0.05 * round++ * n)), most_parts);
    }
    // The least error, where pieces may not be shorter. Cuts that hardly help, as in a shape too stout to
    // bend like a beam, are not worth their joints: the first that come within twice that.
    double least = margin * target_;
    if (tries.back().error > least) {
      least = std::numeric_limits<double>::infinity();
      for (const Try& t : tries) least = std::min(least, (stalled == patience ? 2 : 1) * t.error);
    }
    std::erase_if(tries, [&](const Try& t) { return !(t.error <= least); });
    return std::move(*std::min_element(tries.begin(), tries.end(), [](const Try& a, const Try& b) {
      return a.cuts.size() < b.cuts.size();
    }));
  }

  bool follows_one_strip() const { return reach_ == 0 && lines_.size() == 1 && !axis_.members[0].closed; }

  // Cuts until every piece is one that Box2D takes, leaving out cuts that prevent it.
  AutomaticSplit divide(Splitter& splitter, std::vector<PlacedCut> cuts, double error,
                        const std::string& place);

 private:
  // Is the body a strip at all? One member that is hardly longer than wide is none.
  bool is_strip() const {
    if (axis_.members.size() != 1) return !axis_.members.empty();
    const Member& m = axis_.members[0];
    double sum = 0;
    for (const Member::Station& station : m.stations) sum += width(station.chord);
    return m.stations.size() > 2 && m.length > 1.5 * sum / static_cast<double>(m.stations.size());
  }

  // One strip that is so long that nothing but its bends can keep more cuts from making it more exact.
  bool is_slender() const {
    if (lines_.size() != 1) return false;
    double area = 0;
    for (std::size_t i = 1; i < line_.size(); ++i)
      area += (line_[i].s - line_[i - 1].s) * (line_[i].width + line_[i - 1].width) / 2;
    return line_.back().s * line_.back().s > 20 * area;
  }

  // Across the axis about which the body is most slender.
  void make_straight() {
    const AreaMoments m = moments(outline_);
    const auto [u, low, high] = long_axis(outline_, m);
    for (const Point& p : outline_.outer) reach_ = std::max(reach_, 1.01 * length(p - m.centroid));
    axis_.nodes.clear();
    axis_.members = {
        Member{.start = m.centroid + low * u, .end = m.centroid + high * u, .length = high - low}};
    for (const double s : {0.0, high - low}) axis_.members[0].stations.push_back(at(0, s));
  }

  Member::Station at(int member, double s) const {
    const Member& m = axis_.members[member];
    if (reach_ == 0) return axis_.at(m, s);
    const Point u = unit(m.end - m.start), p = m.start + s * u;
    return {s, {p + reach_ * left(u), p - reach_ * left(u)}};
  }

  // A member's line from end to end; where there are holes, with four places to a station.
  std::vector<Place> line_of(int member) const {
    const Member& m = axis_.members[member];
    std::vector<Place> line;
    line.reserve(m.stations.size() + 2);
    const auto add = [&](const Member::Station& station) {
      line.push_back(place_at(station.s, station.chord, holes_));
    };
    add(m.stations.front());
    line.back().s = 0;
    line.back().at = m.start;
    for (std::size_t i = 0; i < m.stations.size(); ++i) {
      if (i > 0 && m.stations[i].follows && !outline_.holes.empty())
        for (const double share : {0.25, 0.5, 0.75})
          if (const Member::Station found =
                  at(member, std::lerp(m.stations[i - 1].s, m.stations[i].s, share));
              found.s > line.back().s)
            add(found);
      add(m.stations[i]);
    }
    add(m.stations.back());
    line.back().s = m.length;
    line.back().at = m.end;
    return line;
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
    std::vector<int> path;  // members, from the end back
    for (int v = end; from[v] >= 0;) {
      path.push_back(from[v]);
      const auto [a, b] = ends(from[v]);
      v = a == v ? b : a;
    }
    int v = end;
    node_[0] = end < std::ssize(axis_.nodes);
    node_[1] = far < std::ssize(axis_.nodes);
    for (const int member : path) {
      const auto [a, b] = ends(member);
      const bool backwards = b == v && a != v;
      v = backwards ? a : b;
      const double offset = line_.empty() ? 0 : line_.back().s, extent = axis_.members[member].length;
      steps_.push_back({member, backwards, offset});
      std::vector<Place> line = lines_[member];
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

  // The graph's vertices: nodes, then two for every member's free ends.
  std::pair<int, int> ends(int member) const {
    const Member& m = axis_.members[member];
    const int own = static_cast<int>(axis_.nodes.size()) + 2 * member;
    return {m.from >= 0 ? m.from : own, m.to >= 0 ? m.to : own + 1};
  }

  // Dijkstra's; the vertex farthest away, and every vertex's way back.
  std::pair<int, std::vector<int>> farthest(int start) const {
    const std::size_t n = axis_.nodes.size() + 2 * lines_.size();
    std::vector<std::vector<int>> leaving(n);
    for (int member = 0; member < std::ssize(lines_); ++member) {
      leaving[ends(member).first].push_back(member);
      leaving[ends(member).second].push_back(member);
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
      for (const int member : leaving[v]) {
        const int other = ends(member).first == v ? ends(member).second : ends(member).first;
        if (const double there = -d + axis_.members[member].length; there < distance[other]) {
          distance[other] = there;
          from[other] = member;
          queue.emplace(-there, other);
        }
      }
    }
    return {far, std::move(from)};
  }

  void find_holds(std::span<const Hold> holds) {
    const double extent = line_.back().s;
    std::vector<Held> found;
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
      found.push_back({s < 0.02 * extent ? 0 : s > 0.98 * extent ? extent : s, h.at, h.clamps});
    }
    std::stable_sort(found.begin(), found.end(), [](const Held& a, const Held& b) { return a.s < b.s; });
    for (const Held& held : found) {
      // Two that lie as near as a tenth of the length clamp like one, but at one point, where they turn
      // freely.
      if (!holds_.empty() && held.s - holds_.back().s < 0.1 * extent)
        holds_.back().clamps |= held.clamps || length(held.at - holds_.back().at) > 1e-6 * extent;
      else
        holds_.push_back(held);
    }
    if (lines_.size() == 1 && axis_.members[0].closed) holds_ = {{0, {}, true}, {extent, {}, true}};
    clamped_both_ = holds_.size() > 2;
    for (const Held& held : holds_) clamped_both_ |= holds_.size() > 1 && held.clamps;
  }

  // --- cuts ---

  std::vector<PlacedCut> place_cuts(double h) const {
    std::vector<PlacedCut> cuts;
    for (int member = 0; member < std::ssize(lines_); ++member) {
      if (static_cast<double>(cuts.size()) > 2 * most_parts) return cuts;
      const Member& m = axis_.members[member];
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
        add(cuts, member, begin + extent / 2, h);
      } else {
        for (int k = node_from || m.closed ? 0 : 1; k < n + (node_to ? 1 : 0); ++k)
          add(cuts, member, begin + extent * k / n, h);
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

  void add(std::vector<PlacedCut>& cuts, int member, double s, double h) const {
    const Member& m = axis_.members[member];
    Member::Station station = at(member, s);
    if (!outline_.holes.empty() && !clear_of_holes(station.chord, h))
      for (const double shift : {0.1, -0.1, 0.2, -0.2, 0.3, -0.3, 0.4, -0.4})
        if (const Member::Station other = at(member, s + shift * h); clear_of_holes(other.chord, h)) {
          station = other;
          break;
        }
    const Chord& chord = station.chord;
    const double apart = (1 - 1e-9) * std::max(least_side, least_share * h);  // cuts may be just that far
    if (width(chord) < least_side) return;
    if (m.to < 0 && !m.closed && m.length - station.s < apart) return;
    if (m.from < 0 && !m.closed && station.s < apart) return;
    if (!cuts.empty() && cuts.back().member == member) {
      const PlacedCut& last = cuts.back();
      if (station.s <= last.s || length(chord.left - last.chord.left) < apart ||
          length(chord.right - last.chord.right) < apart)
        return;
    }
    for (const PlacedCut& other : cuts)
      if (cross_each_other(other.chord, chord)) return;
    cuts.push_back({member, station.s, chord});
  }

  // Pieces between cuts that cross are no chain. Cuts that start from one corner do not cross.
  static bool cross_each_other(const Chord& a, const Chord& b) {
    const auto parts = [](const Chord& line, const Chord& other) {
      const Point along = line.right - line.left;
      const double l = cross(along, other.left - line.left), r = cross(along, other.right - line.left);
      const double least = 1e-6 * dot(along, along);
      return std::min(l, r) < -least && std::max(l, r) > least;
    };
    return parts(a, b) && parts(b, a);
  }

  // ℓ of the cuts of one member.
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

  // Those of one member; they lie together.
  template <class Cuts>
  static auto cuts_of(Cuts& cuts, int member) {
    const auto first =
        std::partition_point(cuts.begin(), cuts.end(), [&](auto& c) { return c.member < member; });
    const auto last = std::partition_point(first, cuts.end(), [&](auto& c) { return c.member == member; });
    return std::span(cuts).subspan(static_cast<std::size_t>(first - cuts.begin()),
                                   static_cast<std::size_t>(last - first));
  }

  // --- error ---

  double error_of(const std::vector<PlacedCut>& cuts) {
    std::vector<Hinge> joints;
    joints.reserve(cuts.size());
    for (const auto& [member, backwards, offset] : steps_)
      for (const PlacedCut& c : cuts_of(cuts, member)) {
        const double s = offset + (backwards ? axis_.members[member].length - c.s : c.s);
        joints.push_back({place_at(s, c.chord, holes_), c.length});
      }
    std::sort(joints.begin(), joints.end(),
              [](const Hinge& a, const Hinge& b) { return a.place.s < b.place.s; });
    if (joints.empty()) return 1;
    Deviation worst;
    for (Stretch& stretch : stretches_) {
      const Deviation d = deviation(stretch, joints);
      worst = {std::max(worst.most, d.most), std::max(worst.error, d.error)};
    }
    return worst.most > 0 ? worst.error / worst.most : 1;
  }

  // Part of the longest way that bends on its own.
  struct Stretch {
    double from, to;                  // m along it, `from` is held
    bool held_at_end = false;         // so is `to`
    std::optional<Beam> beam;         // as fine as the last chain asked
    std::vector<Displacement> exact;  // the beam's
  };

  void find_stretches() {
    const double extent = line_.back().s;
    if (holds_.empty()) {
      // Free: clamped at its wider end, or at either where both are wide.
      const double first = line_.front().width, last = line_.back().width;
      if (first >= last / 2) stretches_.push_back({0, extent});
      if (last >= first / 2) stretches_.push_back({extent, 0});
      return;
    }
    const double start = holds_.front().s, end = holds_.back().s;
    if (start > 0) stretches_.push_back({start, 0});
    if (end < extent) stretches_.push_back({end, extent});
    for (std::size_t i = 1; i < holds_.size(); ++i)
      stretches_.push_back({holds_[i - 1].s, holds_[i].s, true});
  }

  Deviation deviation(Stretch& stretch, const std::vector<Hinge>& joints) const {
    const auto bent = [&](const std::vector<Hinge>& hinges) {
      return stretch.held_at_end ? held_at_both_ends(*stretch.beam, hinges, clamped_both_)
                                 : cantilever(*stretch.beam, hinges);
    };
    // Three parts to a piece and more: the beam's own error is an eighteenth of the chain's, and adds to it.
    const std::size_t parts = std::bit_ceil(std::max<std::size_t>(64, 3 * joints.size()));
    if (!stretch.beam || stretch.beam->parts.size() != parts) {
      stretch.beam.emplace(line_, stretch.from, stretch.to, parts, stretch.held_at_end);
      stretch.exact = bent(stretch.beam->parts);
    }
    return compare(stretch.exact, bent(chain(stretch, joints)));
  }

  // The joints of a stretch and, where the line ends, to what holds it.
  std::vector<Hinge> chain(const Stretch& stretch, const std::vector<Hinge>& joints) const {
    const double extent = std::abs(stretch.to - stretch.from), sign = stretch.to > stretch.from ? 1 : -1;
    std::vector<Hinge> result;
    result.reserve(joints.size() + 2);
    for (const Hinge& j : joints)
      if (const double s = sign * (j.place.s - stretch.from); s > 0 && s < extent) {
        result.push_back(j);
        result.back().place.s = s;
      }
    if (sign < 0) std::reverse(result.begin(), result.end());
    if (result.empty()) return result;
    const auto add_end = [&](auto where, double at, double s, double length) {
      if ((at > 0 || node_[0]) && (at < line_.back().s || node_[1])) return;
      Place p = place_on(line_, at);
      p.s = s;
      result.insert(where, {p, length});
    };
    add_end(result.begin(), stretch.from, 0, result.front().place.s / 2);
    add_end(result.end(), stretch.to, extent, (extent - result.back().place.s) / 2);
    if (stretch.held_at_end)  // seen straight, as its beam
      for (Hinge& h : result) h.place.at = {h.place.s, 0};
    return result;
  }

  // --- pieces ---

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
    // Area is at most width times diameter, of the piece and of the largest of its triangles alike: most
    // pieces are so fat that this decides.
    double area = doubled_area(piece.outer) / 2;
    std::size_t triangles = piece.outer.size();  // or fewer
    for (const Ring& hole : piece.holes) {
      area -= std::abs(doubled_area(hole)) / 2;
      triangles += hole.size() + 2;
    }
    const double diameter = bounds_of(piece.outer).diagonal();
    const double least = std::max(1.01 * thinnest, 1e-3 * diameter);
    if (area > static_cast<double>(triangles) * diameter * least) return true;

    if (least_width(hull(piece.outer)) < 1.01 * thinnest) return false;
    const Point centre = moments(piece).centroid;
    for (std::vector<Point>& part : convex_parts(piece, 8)) {
      for (Point& p : part) p = p - centre;
      if (polygon_shape(part)) return true;
    }
    return false;
  }

  void add_ends(std::vector<AutomaticSplit::End>& ends, int member,
                const std::vector<PlacedCut>& cuts) const {
    const Member& m = axis_.members[member];
    if (m.closed) return;
    const std::span own = cuts_of(cuts, member);
    const auto ahead = [](const Chord& c) { return unit(right(c.left - c.right)); };
    if (m.from < 0)
      ends.push_back(
          {m.start, -ahead(m.stations.front().chord), (own.empty() ? m.length : own.front().s) / 2});
    if (m.to < 0)
      ends.push_back(
          {m.end, ahead(m.stations.back().chord), (m.length - (own.empty() ? 0 : own.back().s)) / 2});
  }

  const Outline& outline_;
  const Holes holes_;
  double target_;
  std::vector<Chord> faces_;
  Axis axis_;
  double reach_ = 0;                       // m: how far cuts reach across a body that is no strip
  std::vector<std::vector<Place>> lines_;  // of the members
  std::vector<Place> line_;                // the longest way through the body
  std::array<bool, 2> node_{};             // does it end in a node?
  struct Step {
    int member;
    bool backwards;
    double offset;
  };
  std::vector<Step> steps_;
  // What holds the body along line_.
  struct Held {
    double s;  // m along it
    Point at;
    bool clamps;
  };
  std::vector<Held> holds_;
  bool clamped_both_ = false;
  std::vector<Stretch> stretches_;
};

AutomaticSplit Automatic::divide(Splitter& splitter, std::vector<PlacedCut> cuts, double error,
                                 const std::string& place) {
  AutomaticSplit result;
  const std::size_t before = cuts.size();
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
    for (int member = 0; member < std::ssize(lines_); ++member)
      set_lengths(cuts_of(cuts, member), axis_.members[member]);
  }
  for (const PlacedCut& c : cuts) result.lengths.push_back(c.length);
  for (int member = 0; member < std::ssize(lines_); ++member) add_ends(result.ends, member, cuts);
  result.error = cuts.size() == before ? error : error_of(cuts);
  return result;
}

}  // namespace

AutomaticSplit split_automatically(Splitter& splitter, const Outline& outline, double target,
                                   std::span<const Hold> holds, const std::string& place) {
  // Where a strip widens so much that its axis turns into one of its corners, straight cuts may do better.
  constexpr double poor = 0.3;  // relative error
  Automatic along(outline, target, holds, false);
  Automatic::Try best = along.search();
  if (best.error > poor && along.follows_one_strip()) {
    Automatic across(outline, target, holds, true);
    Automatic::Try straight = across.search();
    if (straight.error < best.error / 2)
      return across.divide(splitter, std::move(straight.cuts), straight.error, place);
  }
  return along.divide(splitter, std::move(best.cuts), best.error, place);
}

}  // namespace ductile::calibration
