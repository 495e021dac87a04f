#include "ductile/strips.h"

#include <algorithm>
#include <cmath>

#include "ductile/moments.h"
#include "ductile/plane.h"

namespace ductile::diagram {
namespace {

constexpr int intervals = 4;     // between two places where something acts
constexpr double aligned = 0.9;  // |cos| between axes of one straight strip
constexpr double slender = 2.5;  // length over width from which on an uncut body is a bar

// A force with a moment about its point, on a piece.
struct Action {
  Point at, force;
  double moment;
  const PlannedJoint* cut = nullptr;  // that it comes from
};

// What a joint's axis has turned by: that of a support stays, that of a line goes with its ends.
double turned(const Plan& plan, const PlannedJoint& joint, const std::function<Motion(int)>& gone) {
  if (!gone || joint.a < 0) return 0;
  const Motion a = gone(joint.a), b = gone(joint.b);
  if (!joint.end) return (a.turn + b.turn) / 2;
  const auto end = [&](int piece, const Motion& motion, Point at) {
    return motion.along + motion.turn * left(at - plan.pieces[static_cast<std::size_t>(piece)].center);
  };
  return dot(end(joint.b, b, *joint.end) - end(joint.a, a, joint.anchor), left(joint.axis)) /
         length(*joint.end - joint.anchor);
}

Action of_joint(const PlannedJoint& joint, const JointReading& carries, double sign, double turn) {
  const Point force = carries.N * joint.axis + carries.Q * left(joint.axis);
  return {sign > 0 ? joint.anchor : joint.far_anchor(), sign * (Rotation(turn) * force), sign * carries.M,
          joint.height > 0 ? &joint : nullptr};
}

class PieceStrips {
 public:
  PieceStrips(const Plan& plan, int index, const State& state)
      : piece_(plan.pieces[static_cast<std::size_t>(index)]), index_(index) {
    const double turn = state.gone ? state.gone(index).turn : 0;
    const Rotation turn_of_piece(turn);
    for (std::size_t i = 0; i < plan.joints.size(); ++i) {
      const PlannedJoint& joint = plan.joints[i];
      if (joint.a != index && joint.b != index) continue;
      actions_.push_back(of_joint(joint, state.carries(i), joint.a == index ? 1 : -1,
                                  turned(plan, joint, state.gone) - turn));
      if (joint.height > 0) cuts_.push_back(&joint);
    }
    for (const Plan::Load& load : plan.loads)
      if (load.piece == index)
        actions_.push_back(
            {load.at, state.factor * turn_of_piece.inverse(load.def.force), state.factor * load.def.moment});
    weight_ = state.factor * turn_of_piece.inverse(piece_.mass * plan.gravity);
  }

  void add_to(std::vector<Strip>& strips) const {
    for (const Action& action : actions_)
      if (!std::isfinite(action.force.x + action.force.y + action.moment)) return;
    if (piece_.circle > 0 || actions_.empty()) return;
    if (cuts_.empty()) {
      const LongAxis axis = long_axis(piece_.outline, moments(piece_.outline));
      const auto [low, high] = extent(axis.direction);
      const auto [right, left_] = extent(left(axis.direction));
      if (high - low > slender * (left_ - right)) strips.push_back(whole(axis.direction));
      return;
    }
    const Point axis = cuts_.front()->axis;
    const bool straight = std::all_of(cuts_.begin(), cuts_.end(), [&](const PlannedJoint* cut) {
      return std::abs(dot(cut->axis, axis)) > aligned;
    });
    if (straight) {
      strips.push_back(whole(axis));
    } else {
      for (const PlannedJoint* cut : cuts_) strips.push_back(stub(*cut));
    }
  }

 private:
  std::pair<double, double> extent(Point axis) const {
    double low = unlimited, high = -unlimited;
    for (const Point& p : piece_.outline.outer) {
      low = std::min(low, dot(p - piece_.center, axis));
      high = std::max(high, dot(p - piece_.center, axis));
    }
    return {low, high};
  }

  /// From end to end. Ends at cuts are their anchors; where there is none, the line goes on as it is.
  Strip whole(Point axis) const {
    auto [low, high] = extent(axis);
    const PlannedJoint *first = nullptr, *last = nullptr;
    for (const PlannedJoint* cut : cuts_) (dot(cut->anchor - piece_.center, axis) < 0 ? first : last) = cut;
    Point from = piece_.center + low * axis, to = piece_.center + high * axis;
    if (first) from = first->anchor;
    if (last) to = last->anchor;
    if (first && !last) to = from + dot(to - from, axis) * axis;
    if (last && !first) from = to + dot(from - to, axis) * axis;
    const double length_ = length(to - from);
    if (!(length_ > 0)) return {index_, axis};
    Strip strip = along(from, to, (1 / length_) * weight_);
    strip.whole = true;
    return strip;
  }

  /// From a cut as far as the piece's middle is from it; the piece's weight is left to the rest of it.
  Strip stub(const PlannedJoint& cut) const {
    const Point inward = cut.a == index_ ? -cut.axis : cut.axis;
    const double depth = std::max(0., dot(piece_.center - cut.anchor, inward));
    return along(cut.anchor + depth * inward, cut.anchor, {}, &cut);
  }

  /// Stations between two points, from what acts ahead of each: all of the piece's, or what acts on the part
  /// behind one of its cuts.
  Strip along(Point from, Point to, Point weight_per_metre, const PlannedJoint* only = nullptr) const {
    const double span = length(to - from);
    Strip strip{index_, span > 0 ? (1 / span) * (to - from) : Point{1, 0}};
    if (!(span > 0)) return strip;
    struct Placed {
      double s;
      const Action* action;
    };
    std::vector<Placed> placed;
    std::vector<double> breaks{0, span};
    for (const Action& action : actions_) {
      double s = dot(action.at - from, strip.axis);
      if (only && (action.cut ? action.cut != only : s < 1e-9 * span)) continue;
      s = std::clamp(s, 0., span);
      if (s < 1e-9 * span) s = 0;
      if (s > (1 - 1e-9) * span) s = span;
      placed.push_back({s, &action});
      breaks.push_back(s);
    }
    std::sort(breaks.begin(), breaks.end());
    breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
    double most_force = span * length(weight_per_metre), most_moment = most_force * span;
    for (const Placed& each : placed) {
      most_force += length(each.action->force);
      most_moment += std::abs(each.action->moment) + span * length(each.action->force);
    }
    const auto sure = [](double value, double most) {  // not what the joints' own rounding leaves
      return std::abs(value) > 1e-9 * most ? value : 0;
    };
    const auto station = [&](double s, bool before) {
      const Point at = from + s * strip.axis;
      Point force = (span - s) * weight_per_metre;
      double moment = (span - s) / 2 * cross(strip.axis, force);
      for (const Placed& each : placed) {
        if (before ? each.s < s : each.s <= s) continue;
        force = force + each.action->force;
        moment += each.action->moment + cross(each.action->at - at, each.action->force);
      }
      strip.stations.push_back({at, sure(dot(force, strip.axis), most_force),
                                sure(dot(force, left(strip.axis)), most_force), sure(moment, most_moment)});
    };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      for (int k = 0; k <= intervals; ++k)
        station(breaks[i] + (breaks[i + 1] - breaks[i]) * k / intervals, k > 0);
    return strip;
  }

  const Piece& piece_;
  int index_;
  std::vector<Action> actions_;
  std::vector<const PlannedJoint*> cuts_;
  Point weight_;
};

}  // namespace

std::vector<Strip> strips(const Plan& plan, int piece, const State& state) {
  std::vector<Strip> result;
  if (plan.is_dynamic(piece) && plan.pieces[static_cast<std::size_t>(piece)].part_of < 0)
    PieceStrips(plan, piece, state).add_to(result);
  return result;
}

std::vector<Strip> strips(const Plan& plan, const std::vector<JointReading>& joints,
                          const std::vector<Motion>& motions) {
  State state{[&](std::size_t i) { return joints[i]; }};
  if (!motions.empty()) state.gone = [&](int piece) { return motions[static_cast<std::size_t>(piece)]; };
  std::vector<Strip> result;
  for (int i = 0; i < static_cast<int>(plan.pieces.size()); ++i)
    for (Strip& strip : strips(plan, i, state)) result.push_back(std::move(strip));
  return result;
}

}  // namespace ductile::diagram
