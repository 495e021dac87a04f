#include "ductile/calibrate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "areas.h"
#include "automatic.h"
#include "caps.h"
#include "ductile/moments.h"
#include "ductile/plane.h"
#include "ductile/strip_line.h"
#include "fundamental.h"
#include "half.h"
#include "lines.h"
#include "split.h"
#include "strip.h"
#include "touching.h"
#include "wrong.h"

namespace ductile {
using namespace calibration;

namespace {

// Of a section, against its coordinates: doubles then know its height within 1e-6.
constexpr double thinnest_section = 3e-10;

Frame frame_of(const BodyDef& body) { return {body.at, body.angle}; }

Ring placed(const Frame& frame, Ring ring) {
  for (Point& p : ring) p = frame.world(p);
  return ring;
}

// The direction in which a body's strip runs, in the world.
Point strip_direction(const BodyDef& body) {
  const auto [from, to] = strip_line(body);
  return frame_of(body).rotation * (to - from);
}

class Planner {
 public:
  explicit Planner(const SceneDef& scene) : scene_(scene) {}

  Plan run() {
    problems_ = wrong_with(scene_);
    refuse_problems();
    plan_.gravity = scene_.gravity;
    plan_.gravity_ramp = scene_.gravity_ramp;
    plan_.sleep = scene_.sleep;
    plan_.interaction = scene_.interaction;
    plan_.bodies = scene_.bodies;
    std::size_t pieces = 0;
    for (const BodyDef& body : plan_.bodies)
      pieces += std::max<std::size_t>(body.pieces, body.cuts.size() + 1);
    plan_.pieces.reserve(pieces);
    plan_.joints.reserve(pieces);
    strips_.reserve(plan_.bodies.size());
    for (std::size_t i = 0; i < plan_.bodies.size(); ++i) {
      add_body(static_cast<int>(i));
      if (scene_.interaction && strips_.back().doubling_rate() < unlimited)
        problems_.push_back({body_place(plan_.bodies[i]),
                             "depends on the rate of strain, and the scene has \"interaction\"",
                             "leave one of both out"});
      const std::size_t own = plan_.pieces.size() - first_piece_[i],
                        given = plan_.bodies[i].velocities.size();
      if (given != 0 && given != own)
        problems_.push_back(
            {body_place(plan_.bodies[i]),
             "has " + std::to_string(given) + " velocities for " + std::to_string(own) + " pieces",
             "give one per piece, in their order"});
    }
    refuse_problems();  // what follows needs all pieces
    first_inside_.push_back(plan_.joints.size());
    for (const JointBetweenDef& joint : scene_.joints) contacts_.push_back(contacts_of(joint));
    for (const JointBetweenDef& joint : scene_.joints) join(joint);
    for (std::size_t i = 0; i < scene_.supports.size(); ++i) support(static_cast<int>(i));
    for (std::size_t i = 0; i < scene_.loads.size(); ++i) load(static_cast<int>(i));
    for (const WheelDef& wheel : scene_.wheels)
      plan_.wheels.push_back({nearest_piece(wheel.chassis, wheel.at), pieces_of(wheel.wheel).first, wheel});
    refuse_problems();
    find_damping_frequencies(plan_);
    return std::move(plan_);
  }

 private:
  void refuse_problems() {
    if (!problems_.empty()) throw InvalidInput(std::move(problems_));
  }

  // --- bodies ---

  void add_body(int index) {
    const BodyDef& body = plan_.bodies[index];
    strips_.emplace_back(body);
    const int first = static_cast<int>(plan_.pieces.size());
    first_piece_.push_back(first);
    first_inside_.push_back(plan_.joints.size());
    if (body.circle > 0) {
      add_disc(index);
      return;
    }
    try {
      if (body.automatic) {
        add_automatic_pieces(index);
      } else {
        const std::vector<Cut> cuts = cuts_of(body);
        add_pieces(index, splitter_.split(body.outline, cuts, body_place(body)), cuts, {});
      }
    } catch (const InvalidInput& e) {
      problems_.insert(problems_.end(), e.problems().begin(), e.problems().end());
    }
  }

  void add_disc(int index) {
    const BodyDef& body = plan_.bodies[index];
    Piece& piece = plan_.pieces.emplace_back();
    piece.name = body.name;
    piece.body = index;
    piece.center = body.at;
    piece.circle = body.circle;
    if (body.type == BodyType::dynamic_body) {
      const double r2 = body.circle * body.circle;
      piece.mass = strips_.back().mass_per_area() * std::numbers::pi * r2;
      piece.inertia = piece.mass * r2 / 2;
    }
  }

  void add_automatic_pieces(int index) {
    const BodyDef& body = plan_.bodies[index];
    const std::vector<Hold> holds = holds_of(body);
    AutomaticSplit split =
        split_automatically(splitter_, body.outline, scene_.target_error, holds, body_place(body));
    const Frame frame = frame_of(body);
    for (AutomaticSplit::End& end : split.ends) {
      end.at = frame.world(end.at);
      end.outward = frame.rotation * end.outward;
    }
    ends_[index] = std::move(split.ends);
    plan_.split_errors.push_back(
        {index, split.error,
         split.error <= scene_.target_error
             ? "target error"
             : "the shape: more pieces would be below 0.02 m, slivers, or too many"});
    add_pieces(index, std::move(split.parts), split.cuts, split.lengths);
  }

  // Where supports and other bodies hold a body, in its outline's coordinates.
  std::vector<Hold> holds_of(const BodyDef& body) const {
    const auto is_it = [&](const std::string& name) { return name == body.name; };
    std::vector<Hold> holds;
    const Frame frame = frame_of(body);
    for (const SupportDef& s : scene_.supports)
      if (is_it(s.body)) holds.push_back({frame.local(s.at), s.fix_angle});
    for (const JointBetweenDef& j : scene_.joints) {
      const std::vector<std::string> all = j.bodies();
      if (std::none_of(all.begin(), all.end(), is_it)) continue;
      if (j.at) {
        holds.push_back({frame.local(*j.at), j.overrides.moment.value_or(j.welded ? unlimited : 0) > 0});
        continue;
      }
      if (j.is_line()) {
        holds.push_back(
            {j.line ? frame.local((*j.line)[is_it(j.a) ? 0 : 1]) : moments(body.outline).centroid, false});
        continue;
      }
      if (j.across) {
        const Point from = frame.local((*j.across)[0]), to = frame.local((*j.across)[1]);
        holds.push_back({middle(from, to), j.overrides.moment != 0.0, {from, to}});
        continue;
      }
      const std::string& other_name = is_it(j.a) ? j.b : j.a;
      const auto other = std::find_if(scene_.bodies.begin(), scene_.bodies.end(),
                                      [&](const BodyDef& b) { return b.name == other_name; });
      if (other->circle > 0) continue;
      const double least = 1e-6 * std::min(bounds_of(body.outline.outer).diagonal(),
                                           bounds_of(other->outline.outer).diagonal());
      const double gap = j.gap > 0 ? j.gap : least;
      std::vector<Contact> contacts = touching(in_world(body), in_world(*other), gap, least);
      keep_shared(contacts, gap, least);
      for (const Contact& c : contacts)
        holds.push_back({frame.local(middle(c.from, c.to)),
                         j.overrides.moment != 0.0,
                         {frame.local(c.from), frame.local(c.to)}});
    }
    return holds;
  }

  // As split() would make it, of one piece.
  static Outline in_world(const BodyDef& body) {
    Outline outline = body.outline;
    const Frame frame = frame_of(body);
    const auto put = [&](Ring& ring, bool clockwise) {
      if (ring.front() == ring.back()) ring.pop_back();
      if ((doubled_area(ring) < 0) != clockwise) std::reverse(ring.begin(), ring.end());
      ring = placed(frame, std::move(ring));
    };
    put(outline.outer, false);
    for (Ring& hole : outline.holes) put(hole, true);
    return outline;
  }

  // The cuts of a body, in its outline's coordinates.
  static std::vector<Cut> cuts_of(const BodyDef& body) {
    std::vector<Cut> cuts;
    for (const auto& [from, to] : body.cuts) cuts.push_back({from, to});
    if (body.pieces > 1) {
      const auto [from, to] = body.along[0] == body.along[1] ? ends_of_long_axis(body.outline) : body.along;
      double reach = 0;
      for (const Point& p : body.outline.outer) reach = std::max(reach, length(p - from));
      const Point across = (2 * reach) * left(unit(to - from));
      for (int k = 1; k < body.pieces; ++k) {
        const Point at = from + (static_cast<double>(k) / body.pieces) * (to - from);
        cuts.push_back({at - across, at + across});
      }
    }
    return cuts;
  }

  // `lengths`: ℓ of the joints by cut, where it is known.
  void add_pieces(int index, Split parts, const std::vector<Cut>& cuts, std::span<const double> lengths) {
    const BodyDef& body = plan_.bodies[index];
    const Frame frame = frame_of(body);
    const Strip& strip = strips_.back();
    const int first = static_cast<int>(plan_.pieces.size()), n = static_cast<int>(parts.pieces.size());
    std::vector<AreaMoments> area;
    for (const Outline& piece : parts.pieces) area.push_back(moments(piece));

    const std::vector<int> order = order_of(body, cuts, area);
    std::vector<int> rank(order.size());
    for (int i = 0; i < n; ++i) rank[order[i]] = i;
    for (int i = 0; i < n; ++i) {
      Outline& outline = parts.pieces[order[i]];
      const AreaMoments& m = area[order[i]];
      Piece& piece = plan_.pieces.emplace_back();
      piece.name = cuts.empty() ? body.name : body.name + '/' + std::to_string(i);
      piece.body = index;
      piece.center = frame.world(m.centroid);
      if (body.type == BodyType::dynamic_body) {
        piece.mass = strip.mass_per_area() * m.area;
        piece.inertia = strip.mass_per_area() * m.polar() + strip.excess_inertia(m.area);
      }
      outline.outer = placed(frame, std::move(outline.outer));
      for (Ring& hole : outline.holes) hole = placed(frame, std::move(hole));
      piece.outline = std::move(outline);
    }
    join_pieces_of(index, parts.intervals, lengths, rank, first, frame);
  }

  // Pieces by their projection on the line of the split, then across it; where the split has no line, by
  // lower x, then lower y in the world. What differs by less than 1e-6 of the body's size is level.
  std::vector<int> order_of(const BodyDef& body, const std::vector<Cut>& cuts,
                            const std::vector<AreaMoments>& area) {
    std::vector<int> order(area.size());
    std::iota(order.begin(), order.end(), 0);
    if (cuts.empty()) return order;
    const auto middle_of = [](const Cut& cut) { return middle(cut.from, cut.to); };
    Point u = body.pieces > 1 ? right(cuts.front().to - cuts.front().from)
                              : middle_of(cuts.back()) - middle_of(cuts.front());
    if (body.automatic || u == Point{}) u = frame_of(body).rotation.inverse({1, 0});  // the world's x
    u = unit(u);
    const double level = 1e-6 * bounds_of(body.outline.outer).diagonal();
    std::vector<std::pair<double, double>> key;
    key.reserve(area.size());
    for (const AreaMoments& m : area)
      key.emplace_back(std::round(dot(m.centroid, u) / level), std::round(dot(m.centroid, left(u)) / level));
    std::sort(order.begin(), order.end(), [&](int i, int j) { return key[i] < key[j]; });
    return order;
  }

  // --- joints ---

  void join_pieces_of(int index, std::vector<Interval>& intervals, std::span<const double> lengths,
                      const std::vector<int>& rank, int first, const Frame& frame) {
    const BodyDef& body = plan_.bodies[index];
    if (body.automatic) {  // where nobody drew the cuts, pieces that meet in a corner are not joined there
      const double corner = 1e-9 * bounds_of(body.outline.outer).diagonal();
      std::erase_if(intervals, [&](const Interval& i) { return length(i.to - i.from) <= corner; });
    }
    for (Interval& i : intervals) {
      i.left = rank[i.left];
      i.right = rank[i.right];
      // From the lower piece on the left to the higher one on the right.
      if (i.left > i.right) {
        std::swap(i.left, i.right);
        std::swap(i.from, i.to);
      }
    }
    std::stable_sort(intervals.begin(), intervals.end(), [](const Interval& i, const Interval& j) {
      return std::pair(i.left, i.right) < std::pair(j.left, j.right);
    });
    for (const Interval& i : intervals)
      add_face(first + i.left, first + i.right, frame.world(i.from), frame.world(i.to));
    const std::array overriding{Overriding{"body", &body.joint}, Overriding{"scene", &scene_.joint}};
    std::vector<Touch> touches;
    for (std::size_t k = 0; k < intervals.size(); ++k) {
      const Interval& i = intervals[k];
      touches.push_back({frame.world(i.from), frame.world(i.to),
                         lengths.empty() ? 0 : lengths[static_cast<std::size_t>(i.cut)]});
      if (k + 1 < intervals.size() && intervals[k + 1].left == i.left && intervals[k + 1].right == i.right)
        continue;
      join_across(first + i.left, first + i.right, touches, overriding);
      touches.clear();
    }
  }

  // Of what lies behind an edge of a piece, the part of one joint: several on that edge share it.
  double share_of(int piece, Point from, Point to) const {
    const double own = length(to - from), apart = 1e-3 * own;
    const Point u = unit(to - from);
    const auto is_on = [&](Point p) { return std::abs(cross(u, p - from)) <= apart; };
    double all = 0;
    if (const auto found = faces_.find(piece); found != faces_.end())
      for (const auto& [start, end] : found->second)
        if (dot(u, end - start) > 0 && is_on(start) && is_on(end)) all += dot(u, end - start);
    return own / std::max(own, all);
  }

  void add_face(int left, int right, Point from, Point to) {
    faces_[left].push_back({from, to});
    faces_[right].push_back({to, from});
  }

  // An interval that has piece a on its left and piece b on its right; `reach` is ℓ where it is known.
  struct Touch {
    Point from, to;
    double reach = 0;
  };

  static bool in_line(const Touch& a, const Touch& b) {
    const Point u = unit(a.to - a.from);
    const double least = 1e-6 * length(b.to - a.from);
    return std::abs(cross(u, b.from - a.from)) <= least && std::abs(cross(u, b.to - a.from)) <= least &&
           dot(u, b.to - b.from) > 0;
  }

  // All intervals of two pieces. Both are rigid, so that plane sections across several in line stay plane: as
  // one joint they are exact. As one each they may break one by one, but each has its own caps, which
  // together bear more moment than the section.
  void join_across(int a, int b, std::span<Touch> touches, std::span<const Overriding> overriding) {
    if (touches.size() == 1) return add_joint(a, b, touches, 0, overriding, {});
    bool profile = false, combine = false;
    for (const int piece : {a, b}) profile |= !plan_.bodies[plan_.pieces[piece].body].profile.empty();
    for (std::size_t i = overriding.size(); i-- > 0;)
      combine = overriding[i].values->combine.value_or(combine);
    std::size_t repeat = 0;
    for (std::size_t first = 0, last; first < touches.size(); first = last) {
      const auto end =
          std::stable_partition(touches.begin() + static_cast<std::ptrdiff_t>(first) + 1, touches.end(),
                                [&](const Touch& t) { return in_line(touches[first], t); });
      last = static_cast<std::size_t>(end - touches.begin());
      const auto own = touches.subspan(first, last - first);
      const int n = static_cast<int>(own.size());
      if (combine && !profile && n > 1) {
        add_joint(a, b, own, repeat++, overriding, {n, " intervals in line make one section: combine"});
        continue;
      }
      for (const Touch& touch : own)
        add_joint(a, b, {&touch, 1}, repeat++, overriding,
                  {n, profile ? " intervals in line, each a profile" : " intervals in line, each a joint"});
    }
  }

  // Across one interval, or several in line.
  void add_joint(int a, int b, std::span<const Touch> touches, std::size_t repeat,
                 std::span<const Overriding> overriding, const Sharing& sharing) {
    PlannedJoint& joint = plan_.joints.emplace_back();
    joint.a = a;
    joint.b = b;
    joint.name.reserve(plan_.pieces[a].name.size() + plan_.pieces[b].name.size() + 1);
    joint.name.append(plan_.pieces[a].name).append(1, '-').append(plan_.pieces[b].name);
    if (repeat > 0) joint.name += '#' + std::to_string(repeat);
    Point from = touches.front().from, to = touches.front().to;
    joint.anchor = middle(from, to);
    const Point u = unit(to - from);
    joint.axis = right(u);
    if (touches.size() > 1) {
      double sum = 0, moment = 0;
      const Point origin = joint.anchor;
      for (const Touch& t : touches) {
        const double own = length(t.to - t.from);
        sum += own;
        moment += own * dot(middle(t.from, t.to) - origin, u);
        if (dot(t.from - from, u) < 0) from = t.from;
        if (dot(t.to - to, u) > 0) to = t.to;
      }
      joint.anchor = origin + (moment / sum) * u;
      for (const Touch& t : touches)
        joint.intervals.push_back({dot(t.from - joint.anchor, u), dot(t.to - joint.anchor, u)});
      std::sort(joint.intervals.begin(), joint.intervals.end());
    }
    const double height = joint.height = length(to - from);
    // A section's moment goes with its height squared, which is the difference of two coordinates.
    const double coordinate = std::max({std::abs(from.x), std::abs(from.y), std::abs(to.x), std::abs(to.y)});
    double thinnest = height;
    for (const auto& [low, high] : joint.intervals) thinnest = std::min(thinnest, high - low);
    if (!(thinnest > thinnest_section * coordinate)) {
      problems_.push_back({"joint '" + joint.name + "' at " + to_string(joint.anchor),
                           "is " + to_string(thinnest) + " m high, less than " + to_string(thinnest_section) +
                               " of its coordinates, which is too thin to compute with",
                           "draw the body thicker there or nearer to the origin, or cut it elsewhere"});
      return;
    }
    const bool inside = plan_.is_inside(joint);
    std::array<Side, 2> sides{side(a, joint, -joint.axis, inside), side(b, joint, joint.axis, inside)};
    const double known = touches.front().reach;  // along an axis that may bend
    if (!(known > 0) && sharing.intervals == 1)
      for (const int i : {0, 1}) {
        Side& s = sides[i];
        if (!(s.reach > 0) || !s.straight || !s.strip || s.strip->profile_height()) continue;
        const int piece = i == 0 ? a : b;
        const Face face{joint.anchor, i == 0 ? -joint.axis : joint.axis, height,
                        i == 0 ? share_of(a, from, to) : share_of(b, to, from)};
        s.longer = half_of(plan_.pieces[piece].outline, face, s.reach);
        joint.mean[i] = {s.reach / (s.reach + s.longer.along), s.reach / (s.reach + s.longer.bending)};
      }
    for (const Side& s : sides) {
      const std::optional<double> profile = s.strip ? s.strip->profile_height() : std::nullopt;
      if (!profile || std::abs(height - *profile) <= 0.01 * *profile) continue;
      problems_.push_back({"joint '" + joint.name + "' at " + to_string(joint.anchor),
                           "is " + to_string(height) + " m high where the profile of '" + *s.body + "' is " +
                               to_string(*profile) + " m",
                           "cut the body where it is as high as its profile, within 1 %"});
      if (inside) break;
    }
    if (inside) {  // one section, and both pieces give
      sides[0].reach = known > 0 ? known : sides[0].reach + sides[1].reach;
      sides[0].longer.along += sides[1].longer.along;
      sides[0].longer.bending += sides[1].longer.bending;
      sides[1].strip = nullptr;
    }
    caps_.fill_in(joint, sides, overriding, sharing);
  }

  Side side(int index, const PlannedJoint& joint, Point outward, bool inside) {
    const Piece& piece = plan_.pieces[index];
    const BodyDef& body = plan_.bodies[piece.body];
    const Strip& strip = strips_[piece.body];
    Side result{.body = &body.name, .inertia = piece.inertia};
    if (strip.has_material()) result.strip = &strip;
    if (body.type == BodyType::dynamic_body)
      for (const Point& p : piece.outline.outer)
        result.reach = std::max(result.reach, dot(p - joint.anchor, outward) / 2);
    if (const auto ends = ends_.find(piece.body); !inside && result.reach > 0 && ends != ends_.end())
      for (const AutomaticSplit::End& end : ends->second)  // a bent piece is longer than it reaches
        if (length(end.at - joint.anchor) < joint.height && dot(end.outward, outward) < -0.7) {
          result.straight = std::abs(end.half - result.reach) < 1e-3 * result.reach;
          result.reach = end.half;
        }
    if (!inside && !body.profile.empty()) result.reversed = dot(joint.axis, strip_direction(body)) < 0;
    return result;
  }

  void number_repeats(PlannedJoint& joint) {
    const auto repeat =
        std::count_if(plan_.joints.begin(), plan_.joints.end(),
                      [&](const PlannedJoint& other) { return other.a == joint.a && other.b == joint.b; });
    if (repeat > 0) joint.name += '#' + std::to_string(repeat);
  }

  void require_near(int piece, Point at, int joint) {
    const BodyDef& body = plan_.bodies[plan_.pieces[piece].body];
    const double size = body.circle > 0 ? 2 * body.circle : bounds_of(body.outline.outer).diagonal();
    if (distance(plan_.pieces[piece], at) > size)
      problems_.push_back({"joint " + std::to_string(joint),
                           "'" + body.name + "' is farther from " + to_string(at) + " than it is large",
                           "put the point on the body, or near it"});
  }

  // Of what is elastic between two pieces and of no section: that of their materials, the larger one.
  double damping_of(int a, int b) const {
    double most = 0;
    for (const int piece : {a, b})
      if (const auto& material = plan_.bodies[plan_.pieces[piece].body].material)
        most = std::max(most, material->damping_ratio);
    return most;
  }

  Point centre_of(const std::string& body) const {
    return mass_centre(plan_, plan_.pieces[pieces_of(body).first].body);
  }

  void join_by_line(const JointBetweenDef& def) {
    const auto ends = def.line.value_or(std::array{centre_of(def.a), centre_of(def.b)});
    const int index = static_cast<int>(&def - scene_.joints.data());
    const int a = nearest_piece(def.a, ends[0]), b = nearest_piece(def.b, ends[1]);
    require_near(a, ends[0], index);
    require_near(b, ends[1], index);
    if (ends[0] == ends[1]) {
      problems_.push_back({"joint " + std::to_string(index), "is a line of no length",
                           "give its ends, `at: [[x, y], [x, y]]`, two different points"});
      return;
    }
    PlannedJoint joint =
        line_between(def, plan_.pieces[a], plan_.pieces[b], ends[0], ends[1], damping_of(a, b));
    joint.a = a;
    joint.b = b;
    number_repeats(joint);
    joint.governed_by = caps_.reason("line; what its overrides do not set: unlimited, Q, M: free");
    plan_.joints.push_back(std::move(joint));
  }

  // The joints that a definition has made, from `first` on: one, where it is to be driven.
  void drive_from(std::size_t first, const JointBetweenDef& def) {
    if (!def.drive || plan_.joints.size() == first) return;
    if (plan_.joints.size() > first + 1) {
      problems_.push_back(
          {"joint " + std::to_string(&def - scene_.joints.data()),
           "drives two bodies that touch in " + std::to_string(plan_.joints.size() - first) + " places",
           "say where: `at` a point, or `across` a section"});
      return;
    }
    PlannedJoint& joint = plan_.joints.back();
    put_drive(joint, *def.drive);
    joint.rate.reset();
    joint.governed_by = caps_.reason(plan_.reasons[static_cast<std::size_t>(joint.governed_by)] +
                                     (def.drive->row == axial ? "; N, Nc: drive" : "; M: drive"));
  }

  // What a welded node's joint has of the bars that end there.
  struct Weld {
    double M = 0, M_reverse = 0, max_rotation = unlimited;
    std::string by;               // the joint next to the node of which they are; empty: none
    std::optional<RateLaw> rate;  // its
  };
  // Of the weaker bar. A hinge turns the piece that is farther along the bar, so that a bar whose joint next
  // to the node counts its pieces the other way round has its two moments exchanged.
  Weld weld_of(int hub, int other, Point at, const std::string& name) {
    Weld weaker{unlimited, unlimited, unlimited, "", {}};
    for (const int piece : {hub, other}) {
      const PlannedJoint* next = next_to_end(piece, at);
      if (next == nullptr) continue;
      const bool same_sense = (piece == hub ? next->b : next->a) == piece;
      const double M = same_sense ? next->M : next->M_reverse;
      const double M_reverse = same_sense ? next->M_reverse : next->M;
      if (weaker.by.empty() || std::min(M, M_reverse) < std::min(weaker.M, weaker.M_reverse)) {
        weaker.by = next->name;
        weaker.rate = next->rate;
      }
      weaker.M = std::min(weaker.M, M);
      weaker.M_reverse = std::min(weaker.M_reverse, M_reverse);
      weaker.max_rotation = std::min(weaker.max_rotation, next->max_rotation);
    }
    if (weaker.by.empty())
      problems_.push_back({"joint '" + name + "' at " + to_string(at),
                           "is welded where neither body ends with a joint of its own",
                           "split one that ends there into pieces, or give the node's `moment`"});
    return weaker;
  }

  // Which way a piece runs from a node, and how well that tells which way its body does.
  enum class Runs { nowhere, somewhere, beyond, ends };
  struct Course {
    Runs runs = Runs::nowhere;
    Point outward;         // towards its middle, of length 1
    double M = unlimited;  // of the joint next to the node in a bar that ends there
  };
  Course course(int piece, Point at) {
    const Piece& p = plan_.pieces[piece];
    const AreaMoments area = moments(p.outline);
    const LongAxis axis = p.circle > 0 ? LongAxis{} : long_axis(p.outline, area);
    const double size = p.circle > 0 ? 2 * p.circle : axis.high - axis.low;
    const Point arm = p.center - at;
    if (!plan_.is_dynamic(piece) || length(arm) < 1e-6 * size) return {};
    Course result{Runs::somewhere, unit(arm)};
    if (const PlannedJoint* next = next_to_end(piece, at)) {
      result.runs = Runs::ends;
      result.M = std::min(next->M, next->M_reverse);
    } else if (const auto body = static_cast<std::size_t>(p.body);
               first_inside_[body] < first_inside_[body + 1]) {
      result.runs = Runs::beyond;
    } else if (p.circle == 0 && 3 * area.area < size * size) {  // slender: a bar of one piece, no block
      result.runs = std::abs(dot(arm, axis.direction)) > size / 4 ? Runs::ends : Runs::beyond;
    }
    return result;
  }

  // From the first piece to the second along the bar that ends at the node, of two such bars along the weaker
  // one, which yields there; where neither is, across the mitre between them. So two bodies have the same
  // axis, but for its sign, whichever is named first. Of several bodies each is joined to the first by all
  // that it carries, the first by a part, so that there a tie is the other's.
  Point axis_at(int a, int b, Point at, bool several) {
    constexpr double alike = 1e-6;
    const Course one = course(a, at), two = course(b, at);
    if (one.runs != two.runs) return one.runs > two.runs ? -one.outward : two.outward;
    if (one.runs == Runs::nowhere) return {1, 0};
    if (several || two.M < one.M * (1 - alike)) return two.outward;
    if (one.M < two.M * (1 - alike)) return -one.outward;
    const Point across = two.outward - one.outward;
    return length(across) > alike ? unit(across) : two.outward;
  }

  // What the hub of a node bends at its end, `gives` rad per N m, all others turn by. No joint of theirs can
  // stand for it, but the hub's own next one can, in line with it: 1/k = 1/k' + gives.
  void soften_next_to_end(int hub, Point at, double gives) {
    double& stiffness = next_to_end(hub, at)->stiffness.M;
    stiffness = 1 / (1 / stiffness + gives);
  }

  // The first body's piece is the hub.
  void join_at(const JointBetweenDef& def) {
    const int index = static_cast<int>(&def - scene_.joints.data());
    std::vector<int> pieces;
    for (const std::string& name : def.bodies()) {
      const int piece = pieces.emplace_back(nearest_piece(name, *def.at));
      require_near(piece, *def.at, index);
    }
    const JointOverrides& own = def.overrides;
    const bool bends =
        own.moment.value_or(def.welded ? unlimited : 0) > 0 && !own.stiffness_moment && !own.elastic;
    std::vector<double> gives(pieces.size());
    if (bends) {
      std::transform(pieces.begin(), pieces.end(), gives.begin(),
                     [&](int piece) { return end_gives(piece, *def.at); });
    }
    if (pieces.size() > 2 && gives[0] > 0) {
      soften_next_to_end(pieces[0], *def.at, gives[0]);
      gives[0] = 0;
    }
    for (std::size_t i = 1; i < pieces.size(); ++i) {
      PlannedJoint joint;
      joint.a = pieces[0];
      joint.b = pieces[i];
      joint.name = plan_.pieces[joint.a].name + '-' + plan_.pieces[joint.b].name;
      number_repeats(joint);
      joint.anchor = *def.at;
      joint.axis = axis_at(joint.a, joint.b, *def.at, pieces.size() > 2);
      joint.N = own.axial.value_or(unlimited);
      joint.Nc = own.axial_compression.value_or(joint.N);
      joint.Q = own.shear.value_or(unlimited);
      const double sprung = own.stiffness_moment.value_or(0) > 0 ? unlimited : 0;
      const Weld weld = def.welded ? weld_of(pieces[0], pieces[i], *def.at, joint.name)
                                   : Weld{sprung, sprung, unlimited, "", {}};
      joint.M = own.moment.value_or(weld.M);
      joint.M_reverse = own.moment_reverse.value_or(own.moment.value_or(weld.M_reverse));
      const double both = gives[0] + gives[i];
      joint.stiffness = {own.stiffness_axial.value_or(unlimited), own.stiffness_shear.value_or(unlimited),
                         own.stiffness_moment.value_or(both > 0 ? 1 / both : unlimited)};
      joint.damping_ratio = own.damping_ratio.value_or(damping_of(joint.a, joint.b));
      joint.max_rotation = own.max_rotation.value_or(weld.max_rotation);
      joint.max_elongation = own.max_elongation.value_or(unlimited);
      joint.max_compression = own.max_compression.value_or(unlimited);
      joint.max_slip = own.max_slip.value_or(unlimited);
      joint.hold = own.hold.value_or(false);
      joint.rate = weld.rate;
      joint.node = index + 1;
      joint.governed_by = caps_.reason("node; what its overrides do not set: unlimited, M: " +
                                       (!weld.by.empty() ? "as " + weld.by
                                        : sprung > 0     ? "unlimited"
                                                         : "free"));
      plan_.joints.push_back(std::move(joint));
    }
  }

  void join(const JointBetweenDef& def) {
    const std::size_t first = plan_.joints.size();
    join_where_it_says(def);
    drive_from(first, def);
  }

  void join_where_it_says(const JointBetweenDef& def) {
    if (def.is_line()) return join_by_line(def);
    if (def.at) return join_at(def);
    const std::array overriding{Overriding{"joint", &def.overrides}, Overriding{"scene", &scene_.joint}};
    const std::vector<Contact>& contacts = contacts_[static_cast<std::size_t>(&def - scene_.joints.data())];
    if (def.across) {
      const Contact& c = contacts.front();
      const auto joined_before =
          std::count_if(plan_.joints.begin(), plan_.joints.end(),
                        [&](const PlannedJoint& j) { return j.a == c.a && j.b == c.b; });
      return add_joint(c.a, c.b, std::array{Touch{c.from, c.to}}, static_cast<std::size_t>(joined_before),
                       overriding, {});
    }
    std::vector<Touch> touches;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const Contact& c = contacts[k];
      touches.push_back({c.from, c.to});
      if (k + 1 < contacts.size() && contacts[k + 1].a == c.a && contacts[k + 1].b == c.b) continue;
      join_across(c.a, c.b, touches, overriding);
      touches.clear();
    }
    if (contacts.empty())
      problems_.push_back({"joint '" + def.a + "'-'" + def.b + "'",
                           "their edges do not overlap anywhere within " + to_string(gap_of(def)) + " m",
                           "let the two outlines share part of an edge, or give a larger gap"});
  }

  // m: what two bodies' edges must have in common at least.
  double least_contact(const JointBetweenDef& def) const {
    double size = unlimited;
    for (const int piece : {pieces_of(def.a).first, pieces_of(def.b).first}) {
      const BodyDef& body = plan_.bodies[plan_.pieces[piece].body];
      size = std::min(size, body.circle > 0 ? 2 * body.circle : bounds_of(body.outline.outer).diagonal());
    }
    return 1e-6 * size;
  }

  double gap_of(const JointBetweenDef& def) const { return def.gap > 0 ? def.gap : least_contact(def); }

  // Where a joint's pieces touch, by pieces; none at points and of lines.
  std::vector<Contact> contacts_of(const JointBetweenDef& def) {
    std::vector<Contact> contacts;
    if (def.is_line() || def.at) return contacts;
    if (def.across) {  // as if the segment were a common edge of the pieces on its sides
      auto [from, to] = *def.across;
      const int a = nearest_piece(def.a, middle(from, to)), b = nearest_piece(def.b, middle(from, to));
      if (dot(right(to - from), plan_.pieces[b].center - plan_.pieces[a].center) < 0) std::swap(from, to);
      contacts.push_back({.from = from, .to = to, .a = a, .b = b});
    } else {
      const auto of_a = pieces_of(def.a), of_b = pieces_of(def.b);  // from, to
      const double least = least_contact(def), gap = gap_of(def);
      for (int i = of_a.first; i < of_a.second; ++i)
        for (int j = of_b.first; j < of_b.second; ++j) {
          const Piece &one = plan_.pieces[i], &two = plan_.pieces[j];
          if (one.circle > 0 || two.circle > 0 || !near(one.outline, two.outline, gap)) continue;
          for (Contact& c : touching(one.outline, two.outline, gap, least)) {
            c.a = i;
            c.b = j;
            contacts.push_back(c);
          }
        }
      keep_shared(contacts, gap, least);
    }
    for (const Contact& c : contacts) add_face(c.a, c.b, c.from, c.to);
    return contacts;
  }

  static bool near(const Outline& a, const Outline& b, double gap) {
    return bounds_of(a.outer).meets(bounds_of(b.outer), gap);
  }

  // --- what holds, loads and rolls ---

  void support(int index) {
    const SupportDef& def = scene_.supports[index];
    const int piece = piece_under(def.body, def.at, "support " + std::to_string(index));
    if (piece < 0) return;
    PlannedJoint& joint = plan_.joints.emplace_back();
    joint.name = "support/" + std::to_string(index);
    joint.b = piece;
    joint.anchor = def.at;
    joint.axis = {1, 0};
    const auto held = [](bool fixed, double spring) { return fixed || spring > 0 ? unlimited : 0; };
    const auto stiff = [](bool fixed, double spring) { return !fixed && spring > 0 ? spring : unlimited; };
    joint.N = joint.Nc = held(def.fix_x, def.stiffness_x);
    joint.Q = held(def.fix_y, def.stiffness_y);
    joint.M = joint.M_reverse = held(def.fix_angle, def.stiffness_angle);
    joint.stiffness = {stiff(def.fix_x, def.stiffness_x), stiff(def.fix_y, def.stiffness_y),
                       stiff(def.fix_angle, def.stiffness_angle)};
    if (const double gives = end_gives(piece, def.at); joint.M > 0 && gives > 0)  // in line with a spring
      joint.stiffness.M = 1 / (gives + 1 / joint.stiffness.M);
    if (joint.stiffness.N < unlimited || joint.stiffness.Q < unlimited || joint.stiffness.M < unlimited)
      joint.damping_ratio = support_damping(plan_.pieces[piece].body);
    joint.displacement = def.displacement;
    joint.ramp = def.ramp;
    joint.governed_by = caps_.reason("support");
    const BodyDef& body = plan_.bodies[plan_.pieces[piece].body];
    const bool by_section = !body.joint.moment && !scene_.joint.moment;
    if (const PlannedJoint* next = next_to_end(piece, def.at); next && def.fix_angle && by_section) {
      // What is clamped yields at its end as beside a wall.
      const bool onward = next->a == piece;
      joint.M = onward ? next->M : next->M_reverse;
      joint.M_reverse = onward ? next->M_reverse : next->M;
      joint.max_rotation = next->max_rotation;
      if (joint.M < unlimited)
        joint.governed_by = caps_.reason("support; M, M_reverse, max_rotation: as joint " + next->name);
    }
  }

  // Of a support's springs: as of the joints of the body on them.
  double support_damping(int body) const {
    const std::optional<double>& own = plan_.bodies[body].joint.damping_ratio;
    return own.value_or(scene_.joint.damping_ratio.value_or(strips_[body].damping_ratio()));
  }

  // The joint inside a body that ends with this piece at a point: none where it goes on beyond, or is one
  // piece.
  PlannedJoint* next_to_end(int piece, Point at) {
    PlannedJoint* only = nullptr;
    const auto body = static_cast<std::size_t>(plan_.pieces[piece].body);
    for (std::size_t i = first_inside_[body]; i < first_inside_[body + 1]; ++i) {
      PlannedJoint& joint = plan_.joints[i];
      if (joint.a != piece && joint.b != piece) continue;
      if (only != nullptr) return nullptr;
      only = &joint;
    }
    const Point middle = plan_.pieces[piece].center;
    return only != nullptr && dot(only->anchor - middle, at - middle) < 0 ? only : nullptr;
  }

  // rad per N m: a bar bends between the middle of its last piece and what clamps its end, be that a wall, a
  // support or a node. It does not where its joints are made rigid, or as soft as somebody likes; what bends
  // less than a thousandth of its next joint, as where a cut marks the place of a hinge, is rigid.
  double end_gives(int piece, Point at) {
    const BodyDef& body = plan_.bodies[plan_.pieces[piece].body];
    const Elasticity way =
        body.joint.elastic.value_or(scene_.joint.elastic.value_or(Elasticity::true_stiffness));
    if (way != Elasticity::true_stiffness || body.joint.stiffness_moment || scene_.joint.stiffness_moment)
      return 0;
    const Strip& strip = strips_[plan_.pieces[piece].body];
    const PlannedJoint* next = next_to_end(piece, at);
    if (next == nullptr || !strip.has_material()) return 0;
    const double EI = strip.at(*next).EI;
    const double gives = EI > 0 ? length(at - plan_.pieces[piece].center) / EI : 0;
    return gives * next->stiffness.M > 1e-3 ? gives : 0;
  }

  void load(int index) {
    const LoadDef& def = scene_.loads[index];
    const int piece = piece_under(def.body, def.at, "load " + std::to_string(index));
    if (piece >= 0) plan_.loads.push_back({piece, def.at, def});
  }

  std::pair<int, int> pieces_of(const std::string& body) const {
    const auto found = std::find_if(plan_.bodies.begin(), plan_.bodies.end(),
                                    [&](const BodyDef& b) { return b.name == body; });
    const auto i = static_cast<std::size_t>(found - plan_.bodies.begin());
    return {first_piece_[i],
            i + 1 < first_piece_.size() ? first_piece_[i + 1] : static_cast<int>(plan_.pieces.size())};
  }

  // The first piece of a body that has a point inside or, but for rounding, on its boundary; levels have it
  // from floats, and people type it.
  int piece_under(const std::string& body, Point at, const std::string& place) {
    constexpr double rounding = 1e-6;
    const int nearest = nearest_piece(body, at);
    const Piece& piece = plan_.pieces[nearest];
    if (distance(piece, at) <=
        rounding * std::max({length(at - piece.center), std::abs(at.x), std::abs(at.y)}))
      return nearest;
    problems_.push_back({place, "there is nothing of '" + body + "' at " + to_string(at),
                         "put it on the body, or on its boundary"});
    return -1;
  }

  int nearest_piece(const std::string& body, Point at) const {
    const auto [first, last] = pieces_of(body);
    int nearest = first;
    for (int i = first; i < last; ++i)
      if (distance(plan_.pieces[i], at) < distance(plan_.pieces[nearest], at)) nearest = i;
    return nearest;
  }

  // From a point to a piece; 0 inside.
  static double distance(const Piece& piece, Point at) {
    if (piece.circle > 0) return std::max(0.0, length(at - piece.center) - piece.circle);
    double least = locate(piece.outline.outer, at) >= 0 ? 0 : to_ring(piece.outline.outer, at);
    for (const Ring& hole : piece.outline.holes)
      if (locate(hole, at) > 0) least = to_ring(hole, at);
    return least;
  }

  static double to_ring(const Ring& ring, Point at) {
    double least = unlimited;
    for (std::size_t i = 0; i < ring.size(); ++i)
      least = std::min(least, ductile::distance(at, ring[i], ring[(i + 1) % ring.size()]));
    return least;
  }

  const SceneDef& scene_;
  Plan plan_;
  std::vector<Strip> strips_;                   // of plan_.bodies
  std::vector<int> first_piece_;                // of plan_.bodies
  std::vector<std::size_t> first_inside_;       // joint of each body, and beyond the last
  std::vector<std::vector<Contact>> contacts_;  // of scene_.joints
  std::unordered_map<int, std::vector<std::array<Point, 2>>>
      faces_;                                                       // joints' edges of pieces, on their left
  std::unordered_map<int, std::vector<AutomaticSplit::End>> ends_;  // of bodies split automatically
  Splitter splitter_;
  std::vector<Problem> problems_;
  Caps caps_{plan_.reasons, problems_};
};

}  // namespace

Plan calibrate(const SceneDef& scene) { return Planner(scene).run(); }

Plan calibrate(const BodyDef& body) {
  SceneDef scene;
  scene.gravity = {};
  scene.bodies.push_back(body);
  return calibrate(scene);
}

std::optional<Section> section_at(const Plan& plan, const PlannedJoint& joint, int piece) {
  if (piece < 0 || joint.height <= 0) return std::nullopt;
  const BodyDef& body = plan.bodies[plan.pieces[piece].body];
  const Strip strip(body);
  if (!strip.has_material()) return std::nullopt;
  return strip.section(joint, !plan.is_inside(joint) && dot(joint.axis, strip_direction(body)) < 0);
}

}  // namespace ductile
