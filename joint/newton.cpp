#include "newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "line_search.h"
#include "turn_inertia.h"

namespace ductile::dynamics {

namespace {

// What is left of more than a millionth of the impulses is no rounding.
bool may_be_rounding(const Evaluation& at) { return at.gradient2 <= 1e-12 * at.impulse2 + 1e-10 * at.speed2; }

}  // namespace

/// What one round hands to the next.
struct Newton::Round {
  int number = 0;
  int used = 0;              // rounds with the present factor
  double first2 = 0;         // |∇f|² where it began
  bool conjugate = false;    // d_ continues the last direction
  bool crossed = false;      // rows changed their regime in the last round: its tangent is not this one's
  bool short_step = false;   // the last line search ended early: secants of flowing rows help the next round
  bool pushed_only = false;  // the gradient is what the pushes since the last solve made of it
  double zg = 0, beta = 0;
};

void Newton::form(const System& system) {
  for (auto* v : {&g_, &d_, &z_}) v->assign(system.bodies.size(), {});
  interior_point.form(system);
  pushed_.assign(system.free, 0);
  regimes_.reserve(system.joints.capacity());  // contacts will come
  flows_.reserve(system.joints.size());
  kinks_.reserve(system.joints.capacity());
  forget();
}

// ∇f = M (v − v*) + …, and v is where the last evaluation was.
void Newton::push(System& system, std::size_t body, const Vec3& change) {
  Body& b = system.bodies[body];
  b.v_free += change;
  Vec3& g = g_[body];
  pushed2_ -= square(b, g);
  g -= momentum(b, change);
  pushed2_ += square(b, g);
  if (pushes_ < pushed_.size()) pushed_[pushes_++] = body;
}

void Newton::forget() {
  gradient_known_ = false;
  pushed2_ = 0;
  pushes_ = 0;
}

double Newton::tolerance_of(const System& system) const {
  if (stands_) return tunables.standing_tolerance;
  return system.contacts.empty() ? tunables.tolerance : tunables.contact_tolerance;
}

// The structure's impulses to `tolerance` of themselves, or to what rounding leaves: in a rigid row the
// velocity's last bits are multiplied by κ.
double Newton::target(const System& system, const Evaluation& at) const {
  constexpr double floor = 2 * rigid_ratio * std::numeric_limits<double>::epsilon();
  const double tolerance = tolerance_of(system);
  return tolerance * tolerance * at.impulse2 + floor * floor * at.speed2;
}

// An old factor is kept while the rounds that it still needs cost less than a new one (Hairer & Wanner,
// Solving ODEs II, IV.8, decide so about Jacobians).
// 1. Nothing is gained where it is of the present tangents.
// 2. A row that changed its regime costs a round of conjugate gradients; otherwise the contraction predicts
//    how many are left. It does so in each step from then on, and no step by itself would pay for a factor:
//    what was lost so in the steps before counts as well.
// 3. What rows that changed their regime ask for is but a guess, as rounding may deny conjugate directions:
//    one round more than that is enough.
bool Newton::worth_refactoring(const System& system, const Hessian& hessian, const Evaluation& at,
                               const Round& round) const {
  if (hessian.factored() == Factored::tangents && at.changed == 0 && !round.short_step) return false;
  if (at.changed > 0 && round.used > at.changed + 1) return true;
  const double left2 = target(system, at), contraction = std::log(contraction_);
  const double by_rate =
      at.gradient2 <= contraction_ * left2 ? 1 : std::ceil(std::log(at.gradient2 / left2) / contraction);
  const double expected = at.changed > 0 ? at.changed + 1.0 + (round.used == 0 ? lost_ : 0) : by_rate;
  return (expected - 1) * hessian.iteration_work(system.joints.size()) >
         hessian.factor_work(system.joints.size());
}

// What changed its regime in the last round asks for a round of its own: where there are more such rows than
// rounds left, these would be lost. The first two rounds predict little: they start from the last step's
// regimes.
bool Newton::hands_over(const System& system, const Evaluation& at, const Round& round) const {
  const int bound = system.contacts.empty() ? tunables.flow_rounds : tunables.contact_rounds;
  return round.number >= bound || (round.number >= 2 && at.changed > bound - round.number);
}

// d_ ← −H⁻¹∇f, made conjugate to the last direction: Polak and Ribière's β, not below 0.
void Newton::preconditioned_gradient(const System& system, const Hessian& hessian, const Evaluation& at,
                                     Round& round) {
  const std::size_t free = system.free;
  double turned = 0;  // gᵀ H⁻¹ of the last g
  if (round.conjugate) {
    const Vector<Vec3>& last = round.beta == 0 ? d_ : z_;
    for (std::size_t i = 0; i < free; ++i) turned -= dot(g_[i], last[i]);
  }
  if (round.number == 0 && round.pushed_only && at.gradient2 > 1e4 * left2_) {
    // The pushes are all that there is to answer to: a few right-hand sides, and half a solve.
    std::fill_n(z_.begin(), free, Vec3{});
    for (std::size_t k = 0; k < pushes_; ++k) z_[pushed_[k]] = -1.0 * g_[pushed_[k]];
  } else {
    for (std::size_t i = 0; i < free; ++i) z_[i] = -1.0 * g_[i];
  }
  const double last_zg = round.zg;
  round.zg = hessian.forward({z_.data(), free});  // gᵀ H⁻¹ g
  hessian.backward({z_.data(), free});
  round.beta = round.conjugate ? std::max(0.0, (round.zg - turned) / last_zg) : 0;
  if (round.beta == 0) {
    std::swap(d_, z_);
  } else {
    for (std::size_t i = 0; i < free; ++i) d_[i] = z_[i] + round.beta * d_[i];
  }
}

// The zero of f'(t) = ∇f(v0 + t d)·d, which rises monotonically and is piecewise linear, after an evaluation
// at t = 1 and with f' at 0 and 1. Leaves the bodies' v there; false when they were there already.
bool Newton::search(System& system, const Evaluation& at_one, double slope0, double slope1,
                    bool& short_step) {
  const auto move_to = [&](double t) {
    for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v += (t - 1) * d_[i];
  };
  const double secant = slope0 / (slope0 - slope1);
  short_step = false;
  if (!at_one.crossed && std::abs(secant - 1) < 0.01) return false;
  if (!at_one.crossed && secant > 0 && secant < 1) {
    move_to(secant);
    return true;
  }
  find_x(system);
  double at_rest = 0, curvature = 0;  // f' = at_rest + t·curvature + Σ y s(x0 + t y), the sum over kinks_
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    const Vec3 md = momentum(b, d_[i]);
    at_rest += dot(md, b.v - d_[i] - b.v_free);
    curvature += dot(md, d_[i]);
  }
  for (const TurnInertia& t : system.turn_inertias) {
    const double y = t.rate_of(d_[z(t.a)], d_[z(t.b)]);
    const double now = t.rate_of(system.bodies[z(t.a)].v, system.bodies[z(t.b)].v);
    at_rest += t.inertia * y * (now - y - t.rate);
    curvature += t.inertia * y * y;
  }
  // Joints that are elastic at 0 and at 1 are so between them.
  const bool between = slope1 > 0;
  kinks_.clear();
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const Rows &x = system.records[k].x, y = relative_velocity(j, d_[z(j.a)], d_[z(j.b)]);
    Rows s;
    for (unsigned i = 0; i < 3; ++i) s[i] = j.G[i] * (x[i] - y[i]);
    if (!between || j.regime != 0 || !is_elastic(j, s)) {
      kinks_.push_back({k, y});
      continue;
    }
    for (unsigned i = 0; i < 3; ++i) {
      at_rest += y[i] * s[i];
      curvature += y[i] * y[i] * j.G[i];
    }
  }
  const auto slope = [&](double t) {
    Slope at{at_rest + t * curvature, curvature};
    for (const auto& [k, y] : kinks_) {
      const JointRecord& r = system.records[k];
      Rows x = r.x;
      for (unsigned i = 0; i < 3; ++i) x[i] += (t - 1) * y[i];
      const auto [s, regime] = respond(r.law, x);
      for (unsigned i = 0; i < 3; ++i) {
        at.value += y[i] * s[i];
        at.rise += y[i] * y[i] * tangent(r.law, regime, i);  // which leaves yield surfaces out
      }
    }
    return at;
  };
  const double t = line_search(slope, secant, slope1 > 0, 1e-6 * std::abs(slope0));
  short_step = t < 0.1;
  move_to(t);
  return true;
}

// Joints go back to the regimes of the last solution, and those on yield surfaces to where they were on them.
void Newton::take_regimes(System& system) {
  for (std::size_t k = 0; k < regimes_.size(); ++k) system.joints[k].regime = regimes_[k];
  for (Flow& flow : flows_) {
    JointRecord& r = system.records[flow.joint];
    const auto [s, regime] = respond(r.law, r.x = flow.x);
    flow.s = s;
    system.joints[flow.joint].regime = static_cast<std::uint8_t>(regime);
  }
}

// z_ ← the gradient at v of what f would be if each row stayed in its regime, and s on a yield surface went
// on as it did there, along its tangent.
void Newton::gradient_in_regimes(System& system) {
  const auto x_of = [&system](const Joint& j) {
    return biased_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
  };
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    z_[i] = momentum(b, b.v - b.v_free);
  }
  for (const Joint& j : system.joints) {
    if (j.regime == on_surface) continue;
    const RowLaw& law = system.record(j).law;
    Rows s = x_of(j);
    for (unsigned i = 0; i < 3; ++i) s[i] = impulse_in(law, j.regime, i, s[i]);
    add_transposed(j, s, z_[z(j.a)], z_[z(j.b)]);
  }
  for (const Flow& flow : flows_) {
    const Joint& j = system.joints[flow.joint];
    if (j.regime != on_surface) continue;
    Rows x = x_of(j);
    for (unsigned i = 0; i < 3; ++i) x[i] -= flow.x[i];
    const Rows change = system.record(j).tangent * x;
    add_transposed(j, flow.s, z_[z(j.a)], z_[z(j.b)]);
    add_transposed(j, change, z_[z(j.a)], z_[z(j.b)]);
  }
  add_turn_impulses(system, z_);
  std::fill(z_.begin() + static_cast<std::ptrdiff_t>(system.free), z_.end(), Vec3{});
}

// From the minimum of what f would be if each row stayed in the regime of the last solution, or of where that
// leads, if that is lower: it is that of a linear system. Of the parts of a step most have no row that
// changes its regime, though many seem to where they are evaluated with the velocities of the part before.
// Whether v is another now.
bool Newton::start_from_regimes(System& system, Hessian& hessian, Evaluation& at, SolveReport& report) {
  const double f = objective(system, at);
  for (std::size_t i = 0; i < system.free; ++i) d_[i] = system.bodies[i].v;
  const auto factor = [&] {
    hessian.factor_tangents(system, false);
    ++report.factorisations;
  };
  const auto go = [&](std::span<const Vec3> g) {
    for (std::size_t i = 0; i < system.free; ++i) {
      z_[i] = -1.0 * g[i];
      if (system.bodies[i].inverse_inertia == 0) z_[i].w = 0;
    }
    hessian.solve({z_.data(), system.free});
    at = evaluate(system, g_, [this](std::size_t i, Body& b) { b.v += z_[i]; });
  };
  const auto is_solved = [&] { return at.gradient2 <= target(system, at); };
  // Contacts come and go from part to part. One that is thought to pull takes joints far beyond their
  // surfaces, which tells nothing of where they flow next: so contacts are found first.
  for (std::size_t least = regimes_.size();;) {
    take_regimes(system);
    factor();
    for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v = d_[i];
    gradient_in_regimes(system);
    go(z_);
    std::size_t others = 0;
    for (std::size_t k = system.first_contact(); k < regimes_.size(); ++k) {
      const std::uint8_t now = system.joints[k].regime;
      others += std::exchange(regimes_[k], now) != now ? 1 : 0;
    }
    if (flows_.empty() || others == 0 || others >= least) break;
    least = others;
  }
  if (!flows_.empty()) {
    // On surfaces s turns as it goes along, and no count of rows tells when that ends: f does.
    for (double lowest = objective(system, at); !is_solved();) {
      factor();
      go(g_);
      const double now = objective(system, at);
      if (!(now < lowest) && !is_solved()) {
        at = evaluate(system, g_, [this](std::size_t i, Body& b) { b.v -= z_[i]; });
        break;
      }
      lowest = now;
    }
    if (is_solved()) return true;
  } else {
    // As in InteriorPoint::settle(): the system is solved again with what that shows of regimes, for as long
    // as there is less and less of it.
    for (int least = std::numeric_limits<int>::max(); at.crossed && at.changed > 0 && at.changed < least;) {
      least = at.changed / 2 + 1;
      factor();
      go(g_);
    }
  }
  // Where it is the solution, a second step mends what rounding leaves of a row that was far from it.
  if (!at.crossed && !is_solved()) go(g_);
  if (!at.crossed || (!is_solved() && objective(system, at) < f)) return true;
  at = evaluate(system, g_, [this](std::size_t i, Body& b) { b.v = d_[i]; });
  return false;
}

// From the lower of the bodies' v and v*.
void Newton::start_from_lower(System& system, Evaluation& at) {
  const double f = objective(system, at);
  for (std::size_t i = 0; i < system.free; ++i) {
    Body& b = system.bodies[i];
    d_[i] = b.v, b.v = b.v_free;
  }
  at = evaluate(system, g_);
  if (!(objective(system, at) > f)) return;
  for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v = d_[i];
  at = evaluate(system, g_);
}

// Its result is taken as it is: evaluating f there would only find what a rigid row makes of rounding.
Evaluation Newton::solve_by_interior_point(System& system, Hessian& hessian, SolveReport& report) {
  Evaluation at;
  const InteriorPoint::Outcome outcome = interior_point.solve(system, hessian, at);
  report.factorisations += outcome.factorisations;
  report.unsolved |= !outcome.reached;
  if (!outcome.reached) hessian.forget();
  gradient_known_ = outcome.reached;
  std::fill_n(g_.begin(), system.free, Vec3{});  // M (v − v*) + Jᵀ s is 0 for any s
  return at;
}

Solution Newton::solve(System& system, Hessian& hessian, const Evaluation& last,
                       const LinearPrediction* prediction, SolveReport& report) {
  stands_ = !system.contacts.empty() && last.speed2 <= 1e-10 * last.impulse2;
  const bool first = std::exchange(first_, false);
  Round round;
  round.pushed_only = std::exchange(gradient_known_, true) && pushes_ > 0;
  // Rounds that do not end in a solution leave impulses that are far from any.
  interior_point.start_anew();
  if (last.flows || !system.contacts.empty()) interior_point.start_from(system);
  if (prediction != nullptr) prediction->next({z_.data(), system.free});
  bool had_regimes = last.flows && !round.pushed_only;
  if (had_regimes) {
    regimes_.resize(system.joints.size());
    flows_.clear();
    for (std::size_t k = 0; k < regimes_.size(); ++k) {
      regimes_[k] = system.joints[k].regime;
      if (regimes_[k] != on_surface) continue;
      const JointRecord& r = system.records[k];
      if (r.law.surface != nullptr) {
        flows_.push_back({k, r.x, {}});
      } else {
        had_regimes = false;  // that solve did not end
      }
    }
  }
  Evaluation at = last;
  if (round.pushed_only) {
    at.gradient2 = std::max(0.0, left2_ + pushed2_);
  } else {
    at = evaluate(system, g_, [&](std::size_t i, Body& b) {
      if (prediction != nullptr) b.v = z_[i];
      if (b.inverse_inertia == 0) b.v.w = b.v_free.w;  // no joint changes it
    });
  }
  if (!std::isfinite(at.gradient2)) {
    // The past, too, knew what is not finite; this step need not.
    for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v = system.bodies[i].v_free;
    at = evaluate(system, g_);
  }
  bool moved = false;
  if (at.gradient2 > target(system, at) && had_regimes && at.crossed)
    moved = start_from_regimes(system, hessian, at, report);
  // A later solve of a step starts from the solution of the one before, which v* is not lower than.
  if (at.gradient2 > target(system, at) && at.flows && first) start_from_lower(system, at);

  double best2 = at.gradient2;
  round.first2 = at.gradient2;
  int idle = 0;          // rounds that gained nothing
  bool settled = false;  // rounding leaves no more to gain
  // A predicted start always takes one round, even within tolerance: that removes the prediction's bias.
  for (; (at.gradient2 > target(system, at) || (prediction != nullptr && round.number == 0)) &&
         round.number < tunables.round_bound;
       ++round.number) {
    if ((at.flows || round.crossed) && hands_over(system, at, round)) break;
    bool refactor = worth_refactoring(system, hessian, at, round);
    refactor |= hessian.factored() == Factored::nothing || hessian.factored() == Factored::holding ||
                round.crossed || at.curved;
    if (refactor) {
      hessian.factor_tangents(system, round.short_step);
      ++report.factorisations;
      lost_ = 0;
      at.changed = 0;
      round.used = 0;
      round.first2 = at.gradient2;
      round.conjugate = false;
      contraction_ = std::pow(contraction_, 1.1);  // in the hope that the next step's motion calls for less
    }
    ++round.used;
    preconditioned_gradient(system, hessian, at, round);
    const bool tangents = hessian.factored() == Factored::tangents;
    const bool exact = tangents && round.beta == 0 && at.changed == 0 && !at.curved;
    const double before2 = at.gradient2;
    double slope0 = 0;
    at = evaluate(system, g_, [&](std::size_t i, Body& b) {
      slope0 += dot(g_[i], d_[i]);
      b.v += d_[i];
    });
    round.conjugate = true;
    round.crossed = at.crossed;
    // A Newton step within one regime: this is the solution, as far as rounding allows; and that is not far
    // where the step came from much faster velocities.
    const bool may_gain =
        at.gradient2 > target(system, at) && (at.gradient2 <= 1e-4 * before2 || !may_be_rounding(at));
    if (exact && !at.crossed && !may_gain) {
      ++round.number;
      settled = true;
      break;
    }
    if (at.gradient2 > target(system, at)) {
      double slope1 = 0;
      for (std::size_t i = 0; i < system.free; ++i) slope1 += dot(g_[i], d_[i]);
      if (search(system, at, slope0, slope1, round.short_step)) at = evaluate(system, g_);
    }
    // Rounding may be worse than target() says (prescribed velocities are not in speed2, long arms): where
    // round after round gains nothing, this is the minimum. So it is where what is left of joints that press
    // against each other is the last bits of their impulses.
    const bool gains = at.gradient2 <= 0.999 * best2;
    best2 = std::min(best2, at.gradient2);
    idle = !gains && at.gradient2 <= 1e-10 * at.impulse2 + 1e-8 * at.speed2 ? idle + 1 : 0;
    settled = (!gains && at.gradient2 <= rounding_of_impulses(system)) || idle == 5;
    if (settled) break;
    if (!tangents && !round.crossed && round.first2 > target(system, at)) {
      const double by = round.first2 / at.gradient2;
      contraction_ = std::clamp(round.used == 1 ? by : std::pow(by, 1.0 / round.used), 1.2, 1e17);
    }
  }
  lost_ = at.changed > 0 && round.used == round.number ? lost_ + std::max(0, round.number - 1) : 0;
  if (!(at.gradient2 <= target(system, at) || settled)) at = solve_by_interior_point(system, hessian, report);
  report.rounds += round.number;
  // Where impulses cancel, the last bits of them may be all that is left: they are no lack of balance.
  const double goal2 = target(system, at);
  const bool rounding = settled && at.gradient2 > goal2 && at.gradient2 <= rounding_of_impulses(system);
  report.residual =
      at.gradient2 > 0 && !rounding ? tolerance_of(system) * std::sqrt(at.gradient2 / goal2) : 0;
  left2_ = at.gradient2;
  pushed2_ = 0;
  pushes_ = 0;
  return {at, moved || round.number > 0};
}

}  // namespace ductile::dynamics
