// The solver without an engine.
#include "../../joint/solver.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "../../joint/turn_inertia.h"

namespace ductile::dynamics {
namespace {

// Masses on a line, joined by elastic-plastic axial rows: in one dimension no rotation bends the energy's
// books.
struct Line {
  explicit Line(int n) {
    for (int i = 0; i < n; ++i) {
      Body body;
      body.mass = 100 + 37 * (i % 5);
      body.inertia = 10;
      solver.bodies.push_back(body);
      put(solver.places.emplace_back(), {2.0 * i, 0, 0});
    }
    for (int i = 1; i < n; ++i) {
      Joint joint;
      joint.a = i - 1, joint.b = i;
      joint.frame.ax = 1, joint.frame.bx = -1;
      solver.joints.push_back(joint);
      JointRecord record;
      record.material.stiffness = {1e6, unlimited, unlimited};
      record.material.cap = {2e3 + 500 * (i % 3), unlimited, unlimited};
      record.material.cap_reverse = {3e3, unlimited, unlimited};
      solver.records.push_back(record);
    }
    solver.keeps_ledger = true;
    solver.form(solver.bodies.size());
    solver.locate();
    for (Joint& j : solver.joints) j.neutral = solver.record(j).gap;
    before.assign(solver.joints.size(), 0);
    last_u.assign(solver.joints.size(), 0);
  }
  double strain(const Joint& j) const { return solver.record(j).gap[axial] - j.neutral[axial]; }
  // Velocities are those of the middle of a step, and so are strains: with e before and e + u after it,
  // the law keeps k (½ (e + u/2)² + γm² + ½ εu²), where m is the mean of u and what it was in the step
  // before.
  double stored(const Joint& j) {
    const double u = strain(j) - before[solver.index(j)], middle = strain(j) - u / 2;
    const double m = (u + last_u[solver.index(j)]) / 2;
    const RowLaw& law = solver.record(j).law;
    return 1e6 * (middle * middle / 2 + law.third[axial] * m * m + law.detuning[axial] * u * u / 2);
  }
  double energy() {
    double sum = 0;
    for (const Body& b : solver.bodies) sum += b.mass * b.v.x * b.v.x / 2;
    for (const Joint& j : solver.joints) sum += stored(j);
    return sum;
  }
  // The same, with what is gone, by the solver's books.
  double booked() const {
    double sum = solver.energies().damping + solver.energies().numerical;
    for (const Body& b : solver.bodies) sum += b.mass * b.v.x * b.v.x / 2;
    for (const JointRecord& r : solver.records) sum += r.stored[axial] + r.dissipated[axial];
    return sum;
  }
  void expect_stored() {
    for (const Joint& j : solver.joints) EXPECT_NEAR(solver.record(j).stored[axial], stored(j), 1e-9);
  }
  // Bounds the rounds of the interior point method, and leaves all of the work to it.
  void cut_off(int rounds) {
    solver.tunables().flow_rounds = rounds < 100 ? 0 : 5;
    solver.tunables().round_bound = rounds < 100 ? 1 : 100;
    solver.interior_point_tunables().round_bound = rounds;
    solver.interior_point_tunables().settle_gap = rounds < 100 ? 0 : 1e-3;  // which ends before the bound
  }
  SolveReport step(double h) {
    SolveReport report;
    for (std::size_t i = 0; i < solver.bodies.size(); ++i) {
      solver.bodies[i].v_free = solver.before[i] = solver.bodies[i].v;
    }
    for (const Joint& j : solver.joints) {
      const std::size_t k = solver.index(j);
      last_u[k] = j.regime == 0 ? strain(j) - before[k] : 0;
      before[k] = strain(j);
    }
    solver.begin(h);
    solver.solve(report);
    solver.advance();
    return report;
  }
  Solver solver;
  std::vector<double> before;  // strains, m
  std::vector<double> last_u;  // what the step before added to them: nothing to one that had flowed
};

// A solve that is cut off may lose energy, never add any; the books go on as if it had not been. A solve may
// end where |∇f| is what the last bits of velocities make of a rigid row, 2 κ ε |v| in the norm of M: books
// and momenta are off by no more than that times |v| and √(Σ m).
TEST(Solver, ACutOffSolveAddsNoEnergyAndIsCounted) {
  Line line(12);
  for (std::size_t i = 0; i < 12; ++i) line.solver.bodies[i].v.x = i % 2 == 0 ? 3 : -1;
  std::mt19937 random(1);
  double energy = line.energy(), hits = 0, momentum = 0;
  const double start = energy;
  constexpr double floor = 2 * rigid_ratio * std::numeric_limits<double>::epsilon();
  double mass = 0;
  for (const Body& b : line.solver.bodies) momentum += b.mass * b.v.x, mass += b.mass;
  for (int i = 0; i < 2000; ++i) {
    const bool cut = random() % 3 == 0;
    line.cut_off(cut ? static_cast<int>(random() % 8) : 100);
    const SolveReport report = line.step(1.0 / 240);
    EXPECT_TRUE(cut || !report.unsolved);
    hits += report.unsolved;
    const double now = line.energy();
    EXPECT_LE(now, energy * (1 + 1e-12)) << i;
    EXPECT_NEAR(line.booked(), start, floor * 2 * start) << i;
    line.expect_stored();
    energy = now;
  }
  EXPECT_GT(hits, 10);
  for (const Body& b : line.solver.bodies) momentum -= b.mass * b.v.x;
  EXPECT_NEAR(momentum, 0, floor * std::sqrt(2 * start * mass));
}

// Blocks that have just come down on a floor slide on it: v − μ g h, whatever they weigh. The interior point
// method finds normal impulses and the caps of friction that follow from them together, from contacts that
// knew none.
TEST(Solver, FrictionIsFoundWithWhatPresses) {
  constexpr int blocks = 4;
  constexpr double h = 1.0 / 60, g = 10, mu = 0.3, speed = 3;
  Line line(blocks);
  line.solver.bodies.emplace_back();
  put(line.solver.places.emplace_back(), {0, 0, 0});
  line.solver.form(blocks);
  line.solver.locate();
  line.solver.tunables().contact_rounds = line.solver.tunables().round_bound = 0;
  std::vector<Contact> contacts(blocks);
  for (int i = 0; i < blocks; ++i) {
    contacts[z(i)].a = blocks;
    contacts[z(i)].b = i;
    contacts[z(i)].normal_a = contacts[z(i)].normal_b = {0, 1};
    contacts[z(i)].friction = mu;
    line.solver.bodies[z(i)].v_free = line.solver.bodies[z(i)].v = {speed, -g * h, 0};
  }
  line.solver.begin(h);
  line.solver.touch({}, contacts);
  SolveReport report;
  line.solver.solve(report);
  EXPECT_FALSE(report.unsolved);
  EXPECT_LE(report.factorisations, 12);  // of one solve, not of one after the other
  for (int i = 0; i < blocks; ++i) {
    const Body& b = line.solver.bodies[z(i)];
    EXPECT_NEAR(line.solver.contacts[z(i)].normal, b.mass * g * h, 1e-6 * b.mass * g * h);
    EXPECT_NEAR(b.v.x, speed - mu * g * h, 1e-6 * mu * g * h);
    EXPECT_NEAR(b.v.y, 0, 1e-6 * g * h);
  }
}

// A part of a step whose contact opens keeps the caps of friction that it came with, and yet what does not
// press does not rub: its block goes on as it was, beside one that stays and slides.
TEST(Solver, WhatPressesNoMoreDoesNotRub) {
  constexpr double h = 1.0 / 1920, g = 10, mu = 0.3, speed = 3, up = 0.01;
  Line line(2);
  line.solver.bodies.emplace_back();
  put(line.solver.places.emplace_back(), {0, 0, 0});
  line.solver.form(2);
  line.solver.locate();
  for (Joint& j : line.solver.own_joints()) line.solver.record(j).material.stiffness = {};
  line.solver.laws_changed();
  std::vector<Contact> contacts(2);
  for (int i = 0; i < 2; ++i) {
    const double weight = line.solver.bodies[z(i)].mass * g * h;
    contacts[z(i)].a = 2;
    contacts[z(i)].b = i;
    contacts[z(i)].normal_a = contacts[z(i)].normal_b = {0, 1};
    contacts[z(i)].friction = mu;
    contacts[z(i)].normal = weight;
    contacts[z(i)].tangent = mu * weight;
    line.solver.bodies[z(i)].v_free = line.solver.bodies[z(i)].v = {speed, i == 0 ? up : -g * h, 0};
  }
  line.solver.begin(h);
  line.solver.touch({}, contacts);
  line.solver.push(0, {});
  SolveReport report;
  line.solver.solve(report);
  EXPECT_EQ(line.solver.contacts[0].normal, 0);
  EXPECT_EQ(line.solver.contacts[0].tangent, 0);
  EXPECT_DOUBLE_EQ(line.solver.bodies[0].v.x, speed);
  EXPECT_DOUBLE_EQ(line.solver.bodies[0].v.y, up);
  EXPECT_NEAR(line.solver.bodies[1].v.x, speed - mu * g * h, 1e-6 * mu * g * h);
}

// The solution does not depend on how many times the step is solved.
TEST(Solver, ASolveThatEndsAfterOneThatDidNotIsBookedAsUsual) {
  Line line(6), other(6);
  for (Line* l : {&line, &other}) {
    for (std::size_t i = 0; i < 6; ++i) l->solver.bodies[i].v_free.x = i % 2 == 0 ? 3 : -1;
    l->solver.begin(1.0 / 240);
    SolveReport report;
    if (l == &line) {
      l->cut_off(3);
      l->solver.solve(report);
      EXPECT_TRUE(report.unsolved);
      l->cut_off(100);
    }
    l->solver.solve(report);
    l->solver.advance();
  }
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GT(std::abs(other.solver.records[i].plastic.net[0]), 1e-3);
    EXPECT_NEAR(line.solver.records[i].plastic.net[0], other.solver.records[i].plastic.net[0], 1e-12);
    EXPECT_NEAR(line.solver.joints[i].neutral[0], other.solver.joints[i].neutral[0], 1e-12);
  }
}

// A rope that turning bodies have drawn longer by 2 cm, in a step of 1/30 s in which it was slack: parts of
// the next step close that at 0.02 m · 30/s, not within the first of them.
TEST(StepLaws, CloseADrawnLineInTheTimeThatItTook) {
  System system;
  for (int i = 0; i < 2; ++i) {
    Body body;
    body.mass = 100, body.inertia = 10;
    system.bodies.push_back(body);
    put(system.places.emplace_back(), {2.0 * i, 0, 0});
  }
  Joint rope;
  rope.a = 0, rope.b = 1;
  rope.frame.ax = 1, rope.frame.bx = -1;
  system.joints.push_back(rope);
  JointRecord record;
  record.material.stiffness = {rigid, 0, 0};
  record.material.cap = {unlimited, 0, 0};
  record.material.slackens = 1;
  system.records.push_back(record);
  system.form(2);
  locate_all(system);
  Joint& joint = system.joints[0];
  joint.neutral = system.record(joint).gap;
  StepLaws laws;
  laws.begin(system, 1.0 / 30);
  laws.move();
  joint.regime = 8;
  joint.impulse = {};
  put(system.places[1], {2.02, 0, 0});
  locate_all(system);
  laws.begin(system, 1.0 / 3840);
  EXPECT_NEAR(joint.bias[axial], 0.02 * 30, 1e-9);
}

// Of what tension asks for, no more than is as good as rigid (docs/theory/turn_inertia.md): 1e9 times the
// inertia that turns, which is the lesser of two, and that of the other where one does not turn.
TEST(TurnInertia, IsAtMostAsGoodAsRigid) {
  for (const auto [inertia_a, inertia_b, turns] :
       {std::array{8.0, 4.0, 4.0}, {8.0, 0.0, 8.0}, {0.0, 4.0, 4.0}}) {
    System s;
    s.bodies = {{.mass = 50, .inertia = inertia_a}, {.mass = 50, .inertia = inertia_b}};
    s.places.resize(2);
    put(s.places[0], {0, 0, 0});
    put(s.places[1], {1, 0, 0});
    s.joints = {{.a = 0, .b = 1, .impulse = {1e20, 0, 0}, .block = 0, .frame = {.ax = 0.5, .bx = -0.5}}};
    s.records.resize(1);
    s.form(2);
    locate_all(s);
    EXPECT_TRUE(follow_tension(s, 1 / 60., 1 / 60.));
    ASSERT_EQ(s.turn_inertias.size(), 1U);
    EXPECT_DOUBLE_EQ(s.turn_inertias[0].inertia, 1e9 * turns);
  }
}

// Turn inertia resists a change of the rate that the step before left (turn_inertia.h), as often as the step
// is solved.
TEST(Solver, TurnInertiaKeepsItsRateWhereASolveDidNotEnd) {
  Line line(6), other(6);
  for (Line* l : {&line, &other}) {
    Solver& s = l->solver;
    for (std::size_t k = 0; k < s.joints.size(); ++k) {
      JointRecord& r = s.records[k];
      r.material.stiffness[rotation] = 1e3;
      r.turn_inertia = static_cast<int>(k);
      const Joint& j = s.joints[k];
      s.turn_inertias.push_back({.a = j.a, .b = j.b, .block = j.block, .inertia = 50, .rate = 0.2});
    }
    s.laws_changed();
    for (std::size_t i = 0; i < 6; ++i)
      s.bodies[i].v_free = {i % 2 == 0 ? 3.0 : -1.0, 0, i % 2 == 0 ? 1.0 : 0};
    s.begin(1.0 / 240);
    SolveReport report;
    if (l == &line) {
      l->cut_off(1);
      s.solve(report);
      EXPECT_TRUE(report.unsolved);
      l->cut_off(100);
    }
    s.solve(report);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(line.solver.bodies[i].v.w, other.solver.bodies[i].v.w, 1e-8);
    const double moving = other.solver.bodies[i].v.w - other.solver.bodies[i].v_free.w;
    EXPECT_GT(std::abs(moving), 0.01);
  }
}

// A solution that was not finite is forecast for as long as it is known; the solves end all the same.
TEST(Solver, StartsAnewWhereTheForecastIsNotFinite) {
  Line line(3);
  line.solver.keeps_ledger = false;
  for (int i = 0; i < 12; ++i) {
    line.solver.begin(1.0 / 60);
    for (Body& b : line.solver.bodies) b.v_free = {1, 0, 0};
    SolveReport report;
    line.solver.solve(report);
    EXPECT_FALSE(report.unsolved) << i;
    for (const Body& b : line.solver.bodies) EXPECT_NEAR(b.v.x, 1, 1e-9) << i;
    if (i == 2) line.solver.bodies[1].v = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    line.solver.advance();
    if (i != 2) continue;
    for (int k = 0; k < 3; ++k) put(line.solver.places[static_cast<std::size_t>(k)], {2.0 * k, 0, 0});
    line.solver.locate();
    line.solver.bodies[1].v = {};
  }
}

}  // namespace
}  // namespace ductile::dynamics
