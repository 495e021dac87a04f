#include "step_laws.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "contact_rows.h"
#include "drive.h"
#include "kinematics.h"
#include "objective.h"

namespace ductile::dynamics {

namespace {

constexpr double turn_guard = 10;   // δ per rad that a body turns in a step
constexpr double free_turn = 0.01;  // rad a step
constexpr double least_guard = 0.05;
constexpr double rotation_share = 0.25;  // of that δ which rotation rows among contacts have
constexpr double delta_time = 0.5;       // s that δ is kept beyond its need
constexpr double halting = 0.25;         // of what a strain grows by in a step
constexpr double turn_time = 0.25;    // s in which what turned bodies parted by in another step is taken back
constexpr double ease_time = 2.5;     // s in which a row that bears is strained by what it was eased of
constexpr double least_drift = 1e-7;  // m, of it
constexpr double squared_turn = 0.5;  // rad in a step: beyond it that is not as the square of the step
constexpr double wave_step = 1e-3;    // s: shorter ones resolve waves that rows yield to one after the other

// What loads store in rigid rows, of what their impulses in a step are as kinetic energy: 4e-7 of a
// cantilever of 10 pieces, as the fourth power of them in longer ones.
constexpr double strain_of_loads = 1e-4;

// The strain of a row beyond that of its force, m or rad; beside a heavy damper, whose force is no strain,
// beyond its elastic strain.
double beyond_force(const Joint& j, const JointRecord& r, unsigned i) {
  const double e = r.law.delta[i] > 1 ? elastic_strain(j, r, i) : j.impulse[i] / (r.law.h * r.law.spring[i]);
  return r.gap[i] - j.neutral[i] - e;
}

bool is_deferred(const Joint& j, const JointRecord& r, unsigned i) {
  return j.G[i] > 0 && !is_slack(j, r, i);
}

// T of axial and shear rows in the last step, of h seconds, where there is any: what turning bodies parted by
// (StepLaws::follow_turn_drift()).
Rows parted_by_turn(const Joint& j, double h) {
  Rows parted{};
  for (unsigned i = 0; i < 2; ++i) {
    const double T = j.is_overdamped(i) ? h * j.rate[i] : parting(j, i, h);
    if (std::abs(T) > least_drift) parted[i] = T;
  }
  return parted;
}

// Makes T of a row so much more, of p and of −u₋ alike.
void part_by(Joint& j, const RowLaw& law, unsigned i, double more) {
  j.rate[i] += more / law.h;
  j.moved[i] -= more;
  if (j.is_newmark(i)) j.trend[i] = law.trend(i, j.moved[i], j.mean[i], j.mean[i]);
}

// The angle by which the faster of a joint's bodies turns in a step, as the last one left it or as it now is.
double turn_in(const System& system, const Joint& j, double h) {
  double rate = 0;
  for (const int i : {j.a, j.b})
    rate = std::max({rate, std::abs(system.bodies[z(i)].v.w), std::abs(system.bodies[z(i)].v_free.w)});
  return h * rate;
}

// δ for bodies that turn by so many rad in a step, by powers of two.
double delta_for(double turn) {
  const double wanted = turn_guard * std::max(0.0, turn - free_turn);
  return wanted > least_guard ? std::exp2(std::ceil(std::log2(wanted))) : 0;
}

// Whether the force of a row that grew through both last steps is less than its strain e stands for, by a
// good part of what it grew by.
bool halts(const Joint& j, const JointRecord& r, unsigned i, double e) {
  if (!j.is_newmark(i)) return false;
  const double mean = j.mean[i], before = 2 * mean - j.moved[i];
  const double beyond = e - j.impulse[i] / (r.law.h * r.law.spring[i]);
  return j.moved[i] * before > 0 && beyond * mean > halting * mean * mean;
}

// The past may have known what is not finite; this step need not.
void forget_infinite(Joint& j) {
  for (unsigned i = 0; i < 3; ++i)
    if (!std::isfinite(j.rate[i] + j.trend[i])) return j.forget_rates();
}

}  // namespace

void StepLaws::set_law(Joint& j, JointRecord& r) const {
  r.law = make_law(r.material, r.m_eff, h_,
                   {std::min(of_step_ + r.turn_guard.delta, 1.0),
                    std::min(of_step_ + rotation_share * of_contacts_.delta, 1.0), elastic_ratio,
                    stiff_ratio * r.lightness, r.halts});
  take_law(j, r.law);
}

void StepLaws::take_law(Joint& j, const RowLaw& law) {
  j.G = law.G;
  j.relaxation = law.relaxation;
  j.carry = law.carry;
  j.elastic_range = law.elastic_range();
  j.newmark = j.overdamped = 0;
  j.damped = false;
  for (unsigned i = 0; i < 3; ++i) {
    if (!(law.G[i] > 0)) continue;
    j.newmark |= static_cast<std::uint8_t>((law.delta[i] < 1 ? 1u : 0u) << i);
    j.overdamped |= static_cast<std::uint8_t>((law.delta[i] > 1 ? 1u : 0u) << i);
    j.damped |= law.delta[i] > 0 && law.delta[i] < 1;
  }
}

// The share of drift that is not taken back in this step.
double StepLaws::deferred_share(double h) {
  const double share = h < drift_time ? h / drift_time : 1;
  drift_time = std::max(h, drift_time - h);
  return 1 - share;
}

// What a joint has of drift: all that rows are strained beyond their forces, where poses moved by a longer
// step before. A rigid line that bodies drew longer as they turned in that step was slack in it; one of
// Newmark's takes hold without gain (drive.h).
void StepLaws::find_drift(const Joint& j, JointRecord& r) const {
  for (unsigned i = 0; i < 3; ++i) {
    const bool drawn = j.G[i] > 0 && is_slack(j, r, i) && is_implicit(r, i);
    r.drift[i] = is_deferred(j, r, i) ? beyond_force(j, r, i) : drawn ? beyond_slack(j, r, i) : 0;
  }
}

// What vibrates through steps of several lengths takes drift back by itself: a row has none that it is not
// strained by beyond its force, the same way. In the parts of a step that would hide from rows that ring what
// the parts strain them by.
void StepLaws::bound_drift(const Joint& j, JointRecord& r) const {
  for (unsigned i = 0; i < 3; ++i) {
    const double beyond = is_deferred(j, r, i) ? beyond_force(j, r, i) : 0;
    r.drift[i] = std::clamp(r.drift[i], std::min(beyond, 0.0), std::max(beyond, 0.0));
  }
}

// In a longer step the spring of a rigid row is softer by its square, and stores as much more by the same
// force. Of what a load strains that is next to nothing. Rows that press against each other, or fling bodies
// apart, would have so much energy from nowhere: this is how many times as large, at most, their force times
// the step may become for it to stay what it was, or what a load may strain: one that rows bear, and that
// bodies are given in this step.
double StepLaws::most_growth(System& system, double last_h) {
  change_.assign(system.bodies.size(), {});
  double stored = 0;
  for (const Joint& j : system.own_joints()) {
    const JointRecord& r = system.record(j);
    const double longer = r.law.h > 0 ? h_ / r.law.h : 1;
    Rows s = j.impulse;
    for (unsigned i = 0; i < 3; ++i) {
      if (longer > 1 && r.law.spring[i] > 0 && is_rigid(r, i))
        stored += s[i] * s[i] / (2 * r.law.h * r.law.h * r.law.spring[i]);
      s[i] *= longer;
    }
    add_transposed(j, s, change_[z(j.a)], change_[z(j.b)]);
  }
  if (!(stored > 0)) return unlimited;
  const double borne = square(system, change_);
  double given = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    given += square(b, momentum(b, b.v_free - after_turning(b.v, last_h)));
  }
  return std::max(1.0, std::sqrt(strain_of_loads * std::min(borne, given) / stored));
}

// A rigid row's spring goes with the step, and keeps its force, within most_growth(). Where a spring was
// edited, or a rigid one's masses, it keeps its force if it became stiffer, its strain if softer: no energy
// comes of it. Nor does any of a row that was implicit and is Newmark's now. It stored the strain at its
// step's end, where velocities belong to the middle: that of half a step before, which they would ask for,
// may be far more, and so it starts with w = 0. A full step's impulse of a strain that falls would give more
// than it stores: the strain that it will be half a step on gives less. It is eased of the rest, which is
// drift. Where the row's force does not pull against that, drift is taken back as that of turns is;
// where it does, slowly, so that what bears a load comes back to where it hung. But where its force stopped
// growing it was strained too far, and what it moved back by is no rate. A force that falls takes the impulse
// along, of which an implicit row's strain is read.
void StepLaws::follow_law(Joint& j, JointRecord& r, Rows& strain, const Rows& parted,
                          double most_growth) const {
  Rows spring = r.law.spring;
  const double longer = r.law.h > 0 ? h_ / r.law.h : 1;
  const std::array<bool, 3> was_rigid{is_rigid(r, 0), is_rigid(r, 1), is_rigid(r, 2)};
  const std::array<bool, 3> was_implicit{is_implicit(r, 0), is_implicit(r, 1), is_implicit(r, 2)};
  const unsigned overdamped = j.overdamped, halted = std::exchange(r.halts, 0);
  set_law(j, r);
  for (unsigned i = 0; i < 3; ++i) {
    // The same force; where sweeps start from it none larger than the step: what was rough in a short one
    // would be a blow.
    j.impulse[i] *= least_delta == 1 ? std::min(1.0, longer) : longer;
    const auto strain_by = [&](double by) {
      j.neutral[i] += strain[i] * (1 - by);
      strain[i] *= by;
      r.strain[i] *= by;
      r.strain_before[i] *= by;
    };
    const double ahead = h_ / 2 * j.rate[i] - longer * parted[i] / 2;
    j.rate[i] /= longer;
    if (was_implicit[i] && j.is_newmark(i)) {
      j.rate[i] = j.moved[i] = j.mean[i] = 0;
      if ((halted >> i & 1u) == 0 && ahead * strain[i] < 0) {
        r.drift[i] += std::copysign(std::min(std::abs(ahead), std::abs(strain[i])), strain[i]);
        r.eased |= 1u << i;
        r.turn_drifts = true;
      }
    }
    // w and w' (row.h) say nothing of each other
    if (((overdamped ^ j.overdamped) >> i & 1u) != 0) j.rate[i] = j.moved[i] = j.mean[i] = 0;
    j.trend[i] = r.law.trend(i, j.moved[i], j.mean[i], j.mean[i]);
    // What holds nothing any more, as both its bodies are held, forgets its force.
    if (!(r.law.spring[i] > 0)) j.neutral[i] = r.gap[i], strain[i] = 0;
    if (!(spring[i] > 0 && r.law.spring[i] > 0) || is_slack(j, r, i)) continue;
    if (was_rigid[i] && is_rigid(r, i)) {
      const double by = longer * std::min(longer, most_growth);
      strain_by(by);
      spring[i] /= by;
    }
    if (r.law.spring[i] > spring[i]) {
      strain_by(spring[i] / r.law.spring[i]);
    } else {
      j.impulse[i] *= r.law.spring[i] / spring[i];
    }
  }
}

// δ for how far bodies turn in a step of h seconds at so many rad/s, kept for half a second at least, so that
// factors last; whether it is another.
bool StepLaws::follow_turn(TurnGuard& guard, double turn, double h) const {
  const double needed = delta_for(h * turn), last = guard.delta;
  const bool is_kept = h == h_ && needed <= last && last > 0;
  guard.unneeded = is_kept && needed <= last / 3 ? guard.unneeded + h : 0;
  if (!is_kept || guard.unneeded >= delta_time) guard = {needed, 0};
  return guard.delta != last;
}

// δ of a step of h seconds. It grows with what makes the last rate a bad guess: another step, and bodies that
// turn far in a step, in which the rows between them take another direction, but those of rotation.
// Corrections of overlap lift what comes down on an edge, and what vibrates beneath it would throw it again
// and again: so where corners of what turns touch, δ of all rotation rows grows with that as well, to a
// quarter, as all of it would take half of what an elastic beam throws back. A wheel may spin: neither its
// axle nor the ground beneath it turns with it.
bool StepLaws::choose_delta(System& system, double h) {
  if (least_delta == 1) return false;
  const auto turn_of = [&system](int i) {
    if (!system.is_free(i)) return 0.0;
    // What a load would turn a light piece by, were there no joints, is no turn.
    const Body& b = system.bodies[z(i)];
    return std::min(std::abs(b.v_free.w), std::abs(b.v.w));
  };
  const double of_step = least_delta + (h_ > 0 ? std::abs(std::log(h / h_)) : 0);
  bool changed = std::exchange(of_step_, of_step) != of_step;
  double most = 0, of_corners = 0;
  for (int i = 0; z(i) < system.free; ++i) most = std::max(most, turn_of(i));
  if (guarded_ || delta_for(h * most) > 0) {
    guarded_ = false;
    for (Joint& j : system.own_joints()) {
      TurnGuard& of_joint = system.record(j).turn_guard;
      changed |= follow_turn(of_joint, std::max(turn_of(j.a), turn_of(j.b)), h);
      guarded_ |= of_joint.delta > 0;
    }
  }
  for (const Contact& c : system.contacts) {
    if (has_lever(c.ax, c.ay, c.normal_a)) of_corners = std::max(of_corners, turn_of(c.a));
    if (has_lever(c.bx, c.by, c.normal_b)) of_corners = std::max(of_corners, turn_of(c.b));
  }
  return follow_turn(of_contacts_, of_corners, h) || changed;
}

// follow_law() keeps what a row moved by in the last step. Here its velocity is kept.
void StepLaws::rescale(System& system, double by) {
  for (Joint& j : system.own_joints()) {
    for (unsigned i = 0; i < 3; ++i) {
      j.rate[i] *= by;
      j.moved[i] *= by;
      j.mean[i] *= by;
    }
  }
  h_ *= by;
  known_ = false;
}

bool StepLaws::begin_flow(System& system) {
  if (least_delta == 1 || h_ <= wave_step || some_halt_) return false;
  const std::span<Joint> own = system.own_joints();
  if (std::none_of(own.begin(), own.end(), [](const Joint& j) { return j.begins_to_flow(); })) return false;
  for (Joint& j : own) {
    JointRecord& r = system.record(j);
    Rows e;
    r.halts = 0;
    for (unsigned i = 0; i < 3; ++i) {
      e[i] = j.G[i] > 0 ? strain_of_bias(j, i) : 0;
      r.halts |= (halts(j, r, i, e[i]) ? 1u : 0u) << i;
    }
    if (r.halts == 0) continue;
    const Rows G = j.G;
    set_law(j, r);
    for (unsigned i = 0; i < 3; ++i) {
      if (j.G[i] == G[i]) continue;
      some_halt_ = true;
      j.trend[i] = r.law.trend(i, j.moved[i], j.mean[i], j.mean[i]);
      j.bias[i] = bias_of_strain(j, i, e[i]);
    }
  }
  return some_halt_;
}

void StepLaws::divide(System& system, double parts) {
  rescale(system, 1 / parts);
  divided_ = true;
}

// Rates w of what the longer step does not resolve say nothing of the strain half a step ago. With w = 0 the
// law starts from what the rows store and the bodies' velocities: no energy comes of it.
void StepLaws::unite(System& system, double parts) {
  rescale(system, parts);
  divided_ = false;
  for (Joint& j : system.own_joints()) j.forget_rates();
}

// What turning bodies part by in a step, T = (p − u₋)/2, is as the square of its length. An implicit row
// closes by the T of the last step in each, and one of Newmark's is strained by half of it when the step
// begins. In a step of another length that, p and u₋ are to be those of its own T, and what is left of the
// gap is drift. So it is where a row is Newmark's now, or no more.
void StepLaws::follow_turn_drift(Joint& j, JointRecord& r, const Rows& parted, unsigned newmark,
                                 double last_h) const {
  const double by = h_ * h_ / (last_h * last_h);
  for (unsigned i = 0; i < 2; ++i) {
    if (parted[i] == 0 || !is_deferred(j, r, i)) continue;
    if (j.is_overdamped(i)) j.rate[i] *= by;  // which is T/h, and 0 where the row was not
    const double before = (newmark >> i & 1u) != 0 ? 0.5 : 1, now = j.is_newmark(i) ? 0.5 : 1;
    r.drift[i] += (before - now * by) * parted[i];
    if (j.is_newmark(i))
      part_by(j, r.law, i, (newmark >> i & 1u) != 0 ? (by - 1) * parted[i] : by * parted[i]);
  }
}

void StepLaws::hold_parted(Joint& j, JointRecord& r) {
  r.drift = {};
  r.turn_drifts = false;
  if (!(r.law.h > 0)) return;
  const Rows parted = parted_by_turn(j, r.law.h);
  for (unsigned i = 0; i < 2; ++i) {
    if (parted[i] == 0) continue;
    if (j.is_overdamped(i))
      j.rate[i] = 0;
    else
      part_by(j, r.law, i, -parted[i]);
  }
}

// Bodies turn by ω(h₋ + h)/2 from the middle of a step to that of the next, and the impulse that turns their
// velocities so is that of the force in (h₋ + h)/2, not in h: after a longer step it may be beyond hF though
// the force F₀ is not, and a row would yield for ever by what no force asks for. What it is more by is taken
// above the cap. F₀ is known of the last step, in which it was more or less likewise.
void StepLaws::allow_turn(const Joint& j, JointRecord& r, const Rows& parted, double last_h) const {
  for (unsigned i = 0; i < 2; ++i) {
    if (parted[i] == 0) continue;
    const double more = j.impulse[i] / h_ / last_turn_ * (last_h - h_) / 2;
    (more > 0 ? r.law.cap : r.law.cap_reverse)[i] += std::abs(more);
  }
}

bool StepLaws::begin(System& system, double h) {
  const bool other_caps = std::exchange(caps_raised_, false);
  const bool other_laws = std::exchange(some_halt_, false) || other_caps || !known_;
  const bool changed = choose_delta(system, h) || h != h_ || other_laws;
  known_ = true;
  const double last_h = std::exchange(h_, h);
  const bool drifts = h < drift_time, slowed = std::exchange(slowed_, false) && h < moved_by;
  const double deferred = deferred_share(h);
  const bool differs = last_h > 0 && h != last_h && least_delta != 1;
  if (!changed && !drifts && !turn_drifts_ && !slowed) {
    last_turn_ = 1;
    if (std::exchange(system.biases_known, false)) return false;
    for (Joint& j : system.own_joints()) {
      forget_infinite(j);
      set_equal_bias(j, system.record(j).gap);
    }
    return false;
  }
  const bool may_switch = last_h > 0 && changed && least_delta != 1 && !divided_ && !(drifts && h < moved_by);
  turn_drifts_ = false;
  const double growth = changed ? most_growth(system, last_h) : 1;
  for (Joint& j : system.own_joints()) {
    JointRecord& r = system.record(j);
    forget_infinite(j);
    const unsigned newmark = j.newmark;
    if (slowed) hold_parted(j, r);
    const Rows parted =
        (differs || may_switch) && turn_in(system, j, h) < squared_turn ? parted_by_turn(j, last_h) : Rows{};
    const bool parts = parted[0] != 0 || parted[1] != 0, turns = differs && parts;
    if (!r.turn_drifts && turns) r.drift = {};
    if (turns) {
      r.turn_drifts = true;
    } else if (slowed) {
      r.turn_drifts = true;
      find_drift(j, r);
    } else if (drifts && h < moved_by) {
      r.turn_drifts = false;
      find_drift(j, r);
    } else if (drifts && !divided_ && !r.turn_drifts) {
      bound_drift(j, r);
    }
    Rows strain;
    for (unsigned i = 0; i < 3; ++i)
      strain[i] = is_implicit(r, i) ? elastic_strain(j, r, i) : r.gap[i] - j.neutral[i];
    if (changed) follow_law(j, r, strain, parted, growth);
    const bool switches = parts && newmark != j.newmark;
    if (turns || switches) follow_turn_drift(j, r, parted, newmark, last_h);
    r.turn_drifts |= switches;
    double most = 0;
    for (unsigned i = 0; i < 3; ++i) {
      const bool eased = (r.eased >> i & 1u) != 0;
      const double time = eased && j.impulse[i] * r.drift[i] > 0 ? ease_time : turn_time;
      r.drift[i] *= r.turn_drifts && (eased || i < 2) ? std::max(0.0, 1 - h / time) : deferred;
      most = std::max(most, std::abs(r.drift[i]));
    }
    r.turn_drifts = r.turn_drifts && most > least_drift;
    if (!r.turn_drifts) r.eased = 0;
    turn_drifts_ |= r.turn_drifts;
    if (turns && h < last_h && r.law.surface == nullptr) {
      allow_turn(j, r, parted, last_h);
      caps_raised_ = true;
    }
    for (unsigned i = 0; i < 3; ++i) j.bias[i] = bias_of_strain(j, i, r.gap[i] - j.neutral[i] - r.drift[i]);
  }
  last_turn_ = differs ? (1 + last_h / h) / 2 : 1;
  return changed;
}

}  // namespace ductile::dynamics
