#include "solver.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "rate.h"
#include "turn_inertia.h"

namespace ductile::dynamics {

namespace {

// Each step rounds the gaps anew, and stiff rows ring with that for good. Their impulses lose 8 % of it a
// step (row.h), so that 1/(1 − 0.92²) = 6.5 times the square of one rounding remains in the norm of M⁻¹; this
// is twice that. Implicit rows do not ring.
double rounding_of_gaps(const System& system, double last_bits) {
  double sum = 0;
  for (const Joint& j : system.own_joints()) {
    const JointRecord& r = system.record(j);
    for (const Row row : {axial, shear}) {
      const double s = j.G[row] * j.relaxation[row] * last_bits;
      if (!is_implicit(r, row) && r.m_eff[row] > 0) sum += s * s / r.m_eff[row];
    }
  }
  return 2 * 6.5 * sum;
}

}  // namespace

Solver::Solver(bool swept_in_passes) {
  motion_.swept = swept_in_passes;
  // Iterations that end before they converge would give energy to faster oscillations than ωh = 1.
  if (swept_in_passes) laws_.elastic_ratio = laws_.least_delta = 1;
}

void Solver::form(std::size_t free_bodies, std::size_t first) {
  System::form(free_bodies, first);
  hessian_.analyse(*this);
  newton_.form(*this);
  projection_.form(*this);
  ledger_.form(*this);
  before.assign(bodies.size(), {});
  turned_.assign(bodies.size(), {});
  before_blow_.assign(joints.size(), {});
  const std::span<Vec3> masses = newton_.scratch().first(free);
  for (std::size_t i = 0; i < free; ++i) masses[i] = momentum(bodies[i], {1, 1, 1});
  prediction_.form(masses);
  driven.reserve(joints.size());
  rated.reserve(joints.size());
  slackening.reserve(joints.size());
  predicted_ = false;
  last_ = {};
  if (first == 0) return laws_changed();
  for (std::size_t k = first; k < joints.size(); ++k) laws_.set_law(joints[k], records[k]);
  list_special(*this);
}

void Solver::remove(std::size_t joint) {
  System::remove(joint);
  hessian_.forget();
  newton_.forget();
  prediction_.forget();
  predicted_ = false;
  last_ = {};
}

void Solver::begin(double h) {
  hessian_.begin_step();
  newton_.begin_step();
  motion_.share = 1;
  keeps_friction_ = false;
  friction_rounds_ = most_friction_rounds;
  const double last_h = step();
  if (h != last_h) prediction_.forget();
  const bool other_laws = laws_.begin(*this, h);
  if (other_laws) list_special(*this);
  begin_drives(*this, h);
  if (follow_tension(*this, h, last_h) || other_laws) hessian_.forget();
}

void Solver::divide(double parts) {
  if (std::exchange(struck_, false)) undo_blow();
  laws_.divide(*this, parts);
  prediction_.forget();
  scale_turn_inertia(1 / (parts * parts));
}

void Solver::unite(double parts) {
  laws_.unite(*this, parts);
  prediction_.forget();
  scale_turn_inertia(parts * parts);
}

// What tension needs is as the square of the step: a blow in parts would meet thousands of times as much.
void Solver::scale_turn_inertia(double by) {
  for (TurnInertia& t : turn_inertias) t.inertia *= by, t.highest *= by;
  if (!turn_inertias.empty()) hessian_.forget();
}

void Solver::strike(double closing) {
  for (std::size_t k = 0; k < own(); ++k) before_blow_[k] = joints[k].impulse;
  open_blow(*this);
  struck_ = true;
  closing_ = closing;
}

// Joints have the impulses and regimes that they had before the blow.
void Solver::undo_blow() {
  for (std::size_t k = 0; k < own(); ++k) {
    joints[k].impulse = before_blow_[k];
    joints[k].regime = 0;
    records[k].held = 1;
  }
  newton_.forget();
}

// A slack line whose bias is that of one far from taut takes nothing. The parts' first begin() makes all
// biases anew.
void Solver::foresee(std::span<const Link> links_now, std::span<const Contact> contacts_now) {
  if (!struck_) strike(0);
  undo_blow();
  constexpr double never = 1e3;  // m/s
  for (const int at : slackening) {
    Joint& j = joints[z(at)];
    const JointRecord& r = records[z(at)];
    for (unsigned i = 0; i < 3; ++i)
      if (is_slack(j, r, i)) j.bias[i] -= r.material.cap[i] > 0 ? never : -never;
  }
  touch(links_now, contacts_now);
  go_on();
  SolveReport unreported;
  solve(unreported);
  for (std::size_t k = 0; k < own(); ++k) before_blow_[k] = joints[k].impulse;
}

void Solver::weaken(std::size_t joint, double share) {
  dynamics::weaken(joints[joint], records[joint], share);
  weakened_ = true;
  go_on();
  newton_.forget();
}

void Solver::hold(std::size_t joint, double share) {
  records[joint].held = share;
  weakened_ = true;
}

void Solver::touch(std::span<const Link> links_now, std::span<const Contact> contacts_now) {
  if (links_now.empty() && links.empty() && contacts_now.empty() && contacts.empty()) return;
  const bool same_links = enter_links(*this, links_now, step());
  if (!enter_contacts(*this, contacts_now, step()) || !same_links) {
    hessian_.forget();
    newton_.forget();
  }
  place_others();
}

// The block of H of each link and contact.
void Solver::place_others() {
  for (std::size_t k = own(); k < joints.size(); ++k) {
    Joint& j = joints[k];
    j.block = is_free(j.a) && is_free(j.b) ? hessian_.block(j.a, j.b) : -1;
  }
}

bool Solver::solve(SolveReport& report) {
  const bool predicted = std::exchange(predicted_, false) && !any_flows();
  Solution solution = newton_.solve(*this, hessian_, last_, predicted ? &prediction_ : nullptr, report);
  for (int again = 0; again < 3 && solution.moved && raise_to_tension(*this, step()); ++again) {
    hessian_.forget();
    solve_again(solution, report);
  }
  if (!struck_ && solution.at.flows && laws_.begin_flow(*this)) {
    hessian_.forget();
    solve_again(solution, report);
  }
  settle_friction(solution, report);
  for (int round = 0; round < most_rate_rounds && raise_caps(*this); ++round) {
    hessian_.forget();
    solve_again(solution, report);
    settle_friction(solution, report);
  }
  read_links(*this);
  if (return_moments(*this)) newton_.forget();
  last_ = solution.at;
  return solution.moved;
}

void Solver::solve_again(Solution& solution, SolveReport& report) {
  newton_.forget();
  solution = newton_.solve(*this, hessian_, solution.at, nullptr, report);
  solution.moved = true;
}

// Coulomb's cap is that of the round before. At rest and in even motion the first is right. Answers to pushes
// keep it: what pushes is solved contact by contact anyway, and the next step starts from the last. But what
// does not press any more does not rub either.
void Solver::settle_friction(Solution& solution, SolveReport& report) {
  for (int round = 0; !contacts.empty(); ++round) {
    read_contacts(*this);
    if (round == friction_rounds_) break;
    const Lag lag = lag_friction(*this, round, keeps_friction_);
    if (!lag.again) break;
    if (lag.other_rows) hessian_.forget();
    solve_again(solution, report);
  }
}

void Solver::scale(double share) {
  motion_.share = share;
  for (std::size_t i = 0; i < free; ++i) {
    Body& b = bodies[i];
    b.v_free -= (1 - share) * b.v;
    b.v = share * b.v;
  }
}

void Solver::advance() {
  newton_.forget();
  left_out_ =
      struck_ ? dynamics::left_out(*this, before_blow_, closing_, newton_.scratch().first(free)) : LeftOut{};
  if (keeps_ledger) ledger_.open(*this, before, step());
  predicted_ = !motion_.swept;
  const double h = step();
  laws_.move();
  const std::span<Vec3> newest = predicted_ ? prediction_.newest() : std::span<Vec3>{};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i < newest.size()) newest[i] = bodies[i].v;
    const Vec3& v = bodies[i].v;
    displace(places[i], h * v);
    turned_[i] = after_turning(v, h);
  }
  if (predicted_) prediction_.fit();
  for (Joint& j : own_joints()) {
    const Rows v = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
    const Rows& gap = record(j).gap = dynamics::locate(j, places);
    const Rows turned = relative_velocity(j, turned_[z(j.a)], turned_[z(j.b)]);
    if (keeps_ledger || j.regime != 0 || j.has_free_row() || j.special)
      book(j, gap, {h / 2 * (turned[0] - v[0]), h / 2 * (turned[1] - v[1]), 0});
    carry_over(j, v, turned);
    if (j.special) correct_rates(j, record(j), gap, h);
    StepLaws::set_equal_bias(j, gap);
    j.flowed = static_cast<std::uint8_t>(flowing(j.regime));
  }
  remember_turn_rates(*this, turned_);
  biases_known = true;
  const bool weakened = std::exchange(weakened_, false);
  if (std::exchange(struck_, false) || weakened) close_blow(*this);
  if (lower_caps(*this, laws_)) hessian_.forget();
}

// What the law carries over of a step: J v along the axes at the step's start, and at its end.
void Solver::carry_over(Joint& j, const Rows& v, const Rows& turned) {
  const double h = step();
  const Rows rate = std::exchange(j.rate, turned), mean = j.mean;
  for (unsigned i = 0; i < 3; ++i) {
    j.moved[i] = h * v[i];
    j.mean[i] = h / 2 * (v[i] + rate[i]);
    // Of rows without a damper: δ = 0, ε = γ/2. Others follow.
    j.trend[i] = j.is_newmark(i) ? -third_difference * (2 * j.mean[i] + j.moved[i] / 2) : 0;
  }
  if (!j.damped && j.overdamped == 0 && j.regime == 0) return;
  const RowLaw& law = record(j).law;
  for (unsigned i = 0; i < 3; ++i) {
    if (j.is_overdamped(i)) {
      j.rate[i] = (j.rate[i] - v[i]) / 2;
    } else if (flows(j.regime, i)) {
      // The spring's own rate is none.
      j.rate[i] = (j.rate[i] - v[i]) / 2;
      j.moved[i] = -h * j.rate[i];
      j.mean[i] = 0;
    }
    j.trend[i] = j.is_newmark(i) ? law.trend(i, j.moved[i], j.mean[i], flows(j.regime, i) ? 0 : mean[i]) : 0;
  }
}

// What a joint's rows do in a step beyond being strained.
void Solver::book(Joint& j, const Rows& gap, const Rows& parted) {
  JointRecord& r = record(j);
  follow_gap(j, gap);
  const Rows neutral = j.neutral, dissipated = r.dissipated;
  if (r.material.driven != 0) move_drive(j, r, step());
  if (j.regime != 0) flow(j, r, gap, parted, laws_, motion_);
  if (!keeps_ledger) return;
  Rows slip, work;
  for (unsigned i = 0; i < 3; ++i) {
    slip[i] = j.neutral[i] - neutral[i];
    work[i] = r.dissipated[i] - dissipated[i];
  }
  ledger_.account(j, index(j), r, slip, work);
}

bool Solver::project(std::span<const Pose> goal, bool try_goal) {
  return projection_.project(*this, hessian_, last_, step(), goal, try_goal);
}

// In last_ a contact that is open, or slides, flows as well.
bool Solver::any_flows() const {
  const std::span<const Joint> own = own_joints();
  return last_.flows && std::any_of(own.begin(), own.end(), [](const Joint& j) { return j.regime != 0; });
}

bool Solver::at_rest() {
  const auto stands_still = [this] {
    if (!(last_.speed2 <= 1e-10 * last_.impulse2)) return false;
    if (any_flows()) return false;
    // What poses do not resolve moves nothing, whatever it asks of stiff rows.
    double farthest = 0;
    for (const Place& p : places) farthest = std::max({farthest, std::abs(p.pose.x), std::abs(p.pose.y)});
    const double last_bits = 2 * std::numeric_limits<double>::epsilon() * farthest;
    if (step() * step() * last_.speed2 <= mass * last_bits * last_bits) return true;
    // Moving on by h v changes a row's impulse by so much at most.
    const std::span<Vec3> change = newton_.scratch();
    std::fill(change.begin(), change.end(), Vec3{});
    for (const Joint& j : own_joints()) {
      Rows s = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
      for (unsigned i = 0; i < 3; ++i) s[i] *= j.G[i] * j.relaxation[i] * step();
      add_transposed(j, s, change[z(j.a)], change[z(j.b)]);
    }
    const double changed2 = square(*this, change), trifle2 = rest_tolerance * rest_tolerance;
    return changed2 <= trifle2 * last_.impulse2 ||
           (last_.speed2 <= trifle2 * last_.impulse2 && changed2 <= rounding_of_gaps(*this, last_bits));
  };
  const bool rests = stands_still();
  if (rests) predicted_ = false;
  return rests;
}

}  // namespace ductile::dynamics
