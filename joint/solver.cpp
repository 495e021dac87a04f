#include "solver.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace ductile::dynamics {

Solver::Solver(bool swept_in_passes) {
  motion_.swept = swept_in_passes;
  // Iterations that end before they converge would give energy to faster oscillations than ωh = 1.
  if (swept_in_passes) laws_.elastic_ratio = 1;
}

void Solver::form(std::size_t free_bodies) {
  System::form(free_bodies);
  hessian_.analyse(*this);
  newton_.form(*this);
  projection_.form(*this);
  ledger_.form(*this);
  before.assign(bodies.size(), {});
  const std::span<Vec3> masses = newton_.scratch().first(free);
  for (std::size_t i = 0; i < free; ++i) masses[i] = momentum(bodies[i], {1, 1, 1});
  prediction_.form(masses);
  laws_.invalidate();
}

void Solver::begin(double h) {
  hessian_.begin_step();
  motion_.share = 1;
  if (h != step()) prediction_.forget();
  if (laws_.begin(*this, h)) hessian_.forget();
}

bool Solver::solve(SolveReport& report) {
  const bool predicted = std::exchange(predicted_, false) && !last_.flows;
  const Solution solution = newton_.solve(*this, hessian_, last_, predicted ? &prediction_ : nullptr, report);
  last_ = solution.at;
  return solution.moved;
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
  if (keeps_ledger) ledger_.open(*this, before, motion_);
  // The next begin() asks for the gaps of what is peculiar.
  gaps_known = laws_.peculiar();
  predicted_ = !motion_.swept;
  const double h = step(), rate = 1 / h;
  const std::span<Vec3> newest = predicted_ ? prediction_.newest() : std::span<Vec3>{};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i < newest.size()) newest[i] = bodies[i].v;
    displace(places[i], h * bodies[i].v);
  }
  if (predicted_) prediction_.fit();
  const bool books = keeps_ledger || gaps_known || motion_.share < 1;
  for (Joint& j : joints) {
    const Rows gap = dynamics::locate(j, places);
    if (books || j.regime != 0 || j.free) book(j, gap);
    StepLaws::set_equal_bias(j, gap, rate);
  }
  biases_known = true;
}

// What a joint's rows do in a step beyond being strained.
void Solver::book(Joint& j, const Rows& gap) {
  JointRecord& r = record(j);
  follow_gap(j, gap);
  if (gaps_known) r.gap = gap;
  const Rows booked = r.dissipated;
  if (j.regime != 0) flow(j, r, gap, laws_, motion_);
  if (keeps_ledger) ledger_.account(j, index(j), r, booked);
  if (motion_.share < 1) {
    scale_strain(j, r, motion_.share);
    if (keeps_ledger) ledger_.account_scaled(j, r);
  }
}

bool Solver::project(std::span<const Pose> goal, bool try_goal) {
  return projection_.project(*this, hessian_, last_, step(), goal, try_goal);
}

bool Solver::at_rest() {
  const auto stands_still = [this] {
    if (last_.flows || !(last_.speed2 <= 1e-10 * last_.impulse2)) return false;
    // What poses do not resolve moves nothing, whatever it asks of stiff rows.
    double farthest = 0;
    for (const Place& p : places) farthest = std::max({farthest, std::abs(p.pose.x), std::abs(p.pose.y)});
    const double last_bits = 2 * std::numeric_limits<double>::epsilon() * farthest;
    if (step() * step() * last_.speed2 <= mass * last_bits * last_bits) return true;
    // Moving on by h v changes a row's impulse by G J v at most.
    const std::span<Vec3> change = newton_.scratch();
    std::fill(change.begin(), change.end(), Vec3{});
    for (const Joint& j : joints) {
      Rows s = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
      for (unsigned i = 0; i < 3; ++i) s[i] *= j.G[i];
      add_transposed(j, s, change[z(j.a)], change[z(j.b)]);
    }
    return square(*this, change) <= rest_tolerance * rest_tolerance * last_.impulse2;
  };
  const bool rests = stands_still();
  if (rests) predicted_ = false;
  return rests;
}

std::size_t Solver::bytes() const {
  return bodies.capacity() * sizeof(Body) + places.capacity() * sizeof(Place) +
         joints.capacity() * sizeof(Joint) + records.capacity() * sizeof(JointRecord) + hessian_.bytes() +
         newton_.bytes() + prediction_.bytes() + projection_.bytes();
}

}  // namespace ductile::dynamics
