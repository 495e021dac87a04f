// The first fibre to yield, and moments that no joint sees.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "ductile/design.h"
#include "ductile/plane.h"
#include "ductile/strips.h"
#include "elastic_path.h"
#include "yield.h"

namespace ductile {
namespace {

// Of a joint's section on one side: how much of the yield stress a unit of N and of M bring to each corner.
class Fibres {
 public:
  Fibres(const Plan& plan, const PlannedJoint& joint, int piece) {
    if (piece < 0) return;
    if (const std::optional<Section> section = section_at(plan, joint, piece)) add(*section);
  }
  /// Of N and M along the joint's axis.
  double usage(double N, double M) const {
    double most = 0;
    for (const Corner& c : corners_) {
      const double share = c.N * N + c.M * M;
      most = std::max(most, share > 0 ? share : -share * c.reverse);
    }
    return most;
  }

 private:
  struct Corner {
    double N, M, reverse;  // per f_y; f_y / f_yc
  };
  // M > 0 puts the right of the axis, −y of the section, in tension; N acts at the anchor, y = 0, and bends
  // about the elastic centroid by N y_c.
  void add(const Section& section) {
    const Elastic e = section.elastic({0, -1});
    for (const Region& region : section.regions()) {
      const Material& m = region.material;
      const double f = m.yield_stress, fc = m.yield_stress_compression > 0 ? m.yield_stress_compression : f;
      const bool known = e.EA > 0;
      const double per_N = known ? m.youngs_modulus / e.EA : 1 / section.area();
      const double per_M = known ? m.youngs_modulus / e.EI : 1 / e.I;
      for (const Point& p : region.outline.outer) {
        const double bent = per_M * (e.centroid.y - p.y);
        corners_.push_back({(per_N + bent * e.centroid.y) / f, bent / f, f / fc});
      }
    }
  }
  std::vector<Corner> corners_;
};

// Straight pieces between their cuts, where a load, a support or a node may put the most into them. One that
// is cut through a hole has several cuts at an end, and no section of its own: it is left out.
class Inside {
 public:
  Inside(const Plan& plan, double time) : plan_(plan), cuts_(plan.pieces.size()) {
    std::erase_if(plan_.loads, [&](const Plan::Load& l) { return l.def.from > time || l.def.to <= time; });
    for (const PlannedJoint& joint : plan.joints)
      for (const int piece : {joint.a, joint.b})
        if (piece >= 0 && joint.height > 0) cuts_[static_cast<std::size_t>(piece)].push_back(&joint);
  }

  /// What a piece uses at a place in it, by what it would use with the section of each of its cuts,
  /// of_cut(joint, N, M): between two of them in proportion to what they bear. each(station, axis, uses), but
  /// for the cuts themselves.
  template <typename OfCut, typename Visit>
  void visit(int piece, const diagram::State& state, const OfCut& of_cut, const Visit& each) const {
    const auto& cuts = cuts_[static_cast<std::size_t>(piece)];
    if (cuts.empty() || cuts.size() > 2) return;
    for (const diagram::Strip& strip : diagram::strips(plan_, piece, state)) {
      if (!strip.whole || strip.stations.empty()) continue;
      const auto along = [&](const PlannedJoint* cut) { return dot(cut->anchor, strip.axis); };
      const auto [first, last] = std::minmax_element(
          cuts.begin(), cuts.end(),
          [&](const PlannedJoint* a, const PlannedJoint* b) { return along(a) < along(b); });
      const double low = along(*first), high = along(*last),
                   middle = dot(plan_.pieces[static_cast<std::size_t>(piece)].center, strip.axis);
      if (cuts.size() == 2 && !(low < middle && middle < high)) continue;
      const double same = 1e-9 * length(strip.stations.back().at - strip.stations.front().at);
      for (const diagram::Station& station : strip.stations) {
        const double s = dot(station.at, strip.axis);
        if (std::abs(s - low) < same || std::abs(s - high) < same) continue;
        const auto uses = [&](const PlannedJoint& cut) {
          return of_cut(cut, station.N, dot(cut.axis, strip.axis) > 0 ? station.M : -station.M);
        };
        const double share = high > low ? std::clamp((s - low) / (high - low), 0., 1.) : 0;
        const double from = uses(**first), to = uses(**last);
        each(station, strip.axis,
             from > 0 && to > 0 ? 1 / ((1 - share) / from + share / to) : std::max(from, to));
      }
    }
  }

 private:
  Plan plan_;  // with the loads of that time
  std::vector<std::vector<const PlannedJoint*>> cuts_;
};

JointReading reading(const Deformed& state, std::size_t joint) {
  const auto R = state.forces.segment<3>(3 * static_cast<Eigen::Index>(joint));
  return {.N = R[0], .Q = R[1], .M = R[2]};
}

// Joints, and after them pieces: what they use of their first fibre.
class FibresOf {
 public:
  FibresOf(const Plan& plan, const Equilibrium& statics, const Inside& inside, Order order)
      : plan_(plan), statics_(statics), inside_(inside), order_(order) {
    for (const PlannedJoint& joint : plan.joints)
      sides_.push_back({Fibres(plan, joint, joint.a), Fibres(plan, joint, joint.b)});
  }
  std::size_t size() const { return plan_.joints.size() + plan_.pieces.size(); }

  double usage(std::size_t item, const Deformed& state) const {
    if (item >= plan_.joints.size())
      return of_piece(static_cast<int>(item - plan_.joints.size()), state, nullptr);
    if (!statics_.held[item]) return 0;
    const PlannedJoint& joint = plan_.joints[item];
    if (joint.height > 0) {
      const JointReading R = reading(state, item);
      return std::max(sides_[item][0].usage(R.N, R.M), sides_[item][1].usage(R.N, R.M));
    }
    double most = 0;  // a node or a support: of what it holds
    for (const int piece : {joint.a, joint.b})
      if (piece >= 0 && !joint.end) most = std::max(most, of_piece(piece, state, &joint));
    return most;
  }

 private:
  // Beside a joint, or anywhere.
  double of_piece(int piece, const Deformed& state, const PlannedJoint* beside) const {
    if (statics_.column[static_cast<std::size_t>(piece)] < 0) return 0;
    diagram::State now{[&](std::size_t joint) { return reading(state, joint); }};
    now.factor = state.factor;
    if (order_ == Order::second)
      now.gone = [&](int i) {
        const int c = statics_.column[static_cast<std::size_t>(i)];
        if (c < 0) return Motion{};
        const auto s = statics_.scale(i);
        return Motion{{s[0] * state.x[c], s[1] * state.x[c + 1]}, s[2] * state.x[c + 2]};
      };
    const Piece& whole = plan_.pieces[static_cast<std::size_t>(piece)];
    const double same = 1e-6 * std::sqrt(whole.inertia / whole.mass);  // m
    double most = 0;
    inside_.visit(
        piece, now,
        [&](const PlannedJoint& cut, double N, double M) {
          return sides_[static_cast<std::size_t>(&cut - plan_.joints.data())][cut.b == piece].usage(N, M);
        },
        [&](const diagram::Station& station, Point axis, double used) {
          if (!beside || std::abs(dot(station.at - beside->anchor, axis)) < same) most = std::max(most, used);
        });
    return most;
  }

  const Plan& plan_;
  const Equilibrium& statics_;
  const Inside& inside_;
  Order order_;
  std::vector<std::array<Fibres, 2>> sides_;
};

}  // namespace

FirstFibre first_fibre(const Plan& plan, const StaticCheck& check, Order order) {
  const Between between = order == Order::first ? Between::rigid_pieces : Between::elastic_bars;
  Equilibrium statics(plan, between);
  const Inside inside(plan, check.time);
  const FibresOf fibres(plan, statics, inside, order);
  const Usage usage = [&](std::size_t item, const Deformed& state) { return fibres.usage(item, state); };
  const std::size_t joints = plan.joints.size();
  FirstFibre least{{}, -1, std::vector(joints, unlimited)};
  for (const LoadCase& load_case : statics.cases()) {
    if (load_case.time != check.time) continue;
    const std::vector<double> at = order == Order::second
                                       ? ElasticPath(plan, statics, load_case).reached(fibres.size(), usage)
                                       : reached(stretches(plan, statics, load_case), fibres.size(), usage);
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (i < joints) least.joints[i] = std::min(least.joints[i], at[i]);
      // Along a piece without loads it may be the same as at its joints, but for rounding.
      if (!(at[i] < (i < joints ? 1 : 1 - 1e-6) * least.factor)) continue;
      least.factor = at[i];
      least.joint = i < joints ? static_cast<int>(i) : -1;
      least.piece = i < joints ? -1 : static_cast<int>(i - joints);
    }
  }
  return least;
}

std::vector<MissedMoment> missed_moments(const Plan& plan, const StaticCheck& check, Order order) {
  constexpr double share = 0.02;      // that may be missed
  constexpr double matters = 1. / 3;  // of the largest: less is far from a hinge
  const Inside inside(plan, check.time);
  diagram::State state{[&](std::size_t i) {
    return JointReading{.N = check.joints[i].N, .Q = check.joints[i].Q, .M = check.joints[i].M};
  }};
  if (order == Order::second)
    state.gone = [&](int piece) {
      const auto i = static_cast<std::size_t>(piece);
      return Motion{check.displacement[i], check.turn[i]};
    };
  std::vector<double> seen(plan.pieces.size()), most(plan.pieces.size());
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    for (const int piece : {plan.joints[i].a, plan.joints[i].b})
      if (piece >= 0) {
        double& largest = seen[static_cast<std::size_t>(piece)];
        largest = std::fmax(largest, check.joints[i].usage.M);  // not NaN
      }
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    inside.visit(
        static_cast<int>(i), state,
        [](const PlannedJoint& cut, double, double M) {
          const double bears = cap(cut, rotation, M < 0);
          return bears > 0 ? std::abs(M) / bears : 0;
        },
        [&](const diagram::Station&, Point, double used) { most[i] = std::max(most[i], used); });
  const double largest = most.empty() ? 0 : *std::max_element(most.begin(), most.end());
  std::vector<MissedMoment> missed;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (most[i] > (1 + share) * seen[i] && most[i] > matters * largest)
      missed.push_back({static_cast<int>(i), most[i] / seen[i]});
  std::stable_sort(missed.begin(), missed.end(),
                   [](const MissedMoment& a, const MissedMoment& b) { return a.factor > b.factor; });
  return missed;
}

}  // namespace ductile
