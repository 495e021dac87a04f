// What is left out, the error that it promises, and the error that a run shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "around.h"
#include "ductile/design.h"
#include "ductile/files.h"
#include "ductile/plane.h"
#include "ductile/scene_list.h"
#include "response.h"
#include "structures.h"

namespace ductile {
void PrintTo(const SceneEntry& scene, std::ostream* out) { *out << scene.name; }
}  // namespace ductile

namespace {
using namespace ductile;

constexpr double L = 20, P = 1e6;

SceneDef scene_of(const std::string& name) {
  return read_scene(DUCTILE_SOURCE_DIR "/scenes/" + name + ".scene.json");
}

void expect_promises_kept(const LeanPlan& lean, double tolerance) {
  double sum = 0;
  for (const LeftOut& item : lean.plan.left_out) {
    EXPECT_LE(item.measured, item.error) << item.what;
    sum += item.error;
  }
  for (const LeftOut& item : lean.kept) EXPECT_LE(item.measured, item.error) << item.what;
  EXPECT_LE(sum, tolerance);
  if (!lean.plan.left_out.empty()) {
    EXPECT_LE(lean.all.measured, sum);
  }
}

// What a run of its own shows, as a share of the size of all that joints hold: the farthest that a piece of
// it is from its twin, until something breaks.
double seen(const Plan& plan, const LeanPlan& lean, double seconds) {
  std::vector<bool> looked_at(plan.pieces.size(), true);
  for (const int i : static_check(plan).loose) looked_at[static_cast<std::size_t>(i)] = false;
  Point low{unlimited, unlimited}, high{-unlimited, -unlimited};
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    looked_at[i] = looked_at[i] && plan.is_dynamic(static_cast<int>(i));
    if (!looked_at[i]) continue;
    for (const Point& p : plan.pieces[i].outline.outer) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  Simulation full(plan), less(lean.plan, lean.solver);
  double farthest = 0;
  const auto broke = [](const SceneEvent& event) { return event.kind == JointEvent::broke; };
  while (full.time() < seconds) {
    full.step();
    less.step();
    if (std::any_of(full.events().begin(), full.events().end(), broke)) break;
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      if (!looked_at[i]) continue;
      const PieceReading p = full.piece(i), q = less.piece(i);
      // A piece that others are merged with has their centre.
      const Point arm = plan.pieces[i].center - lean.plan.pieces[i].center;
      const Point centre = q.position + std::cos(q.angle) * arm + std::sin(q.angle) * left(arm);
      farthest = std::max(farthest, length(centre - p.position));
    }
  }
  return farthest / std::hypot(high.x - low.x, high.y - low.y);
}

class LeaveOutOf : public testing::TestWithParam<SceneEntry> {};

TEST_P(LeaveOutOf, ErrorIsNoMoreThanPromised) {
  const SceneEntry& scene = GetParam();
  const double seconds = std::min(scene.seconds, 3.);
  const Plan plan = calibrate(scene_of(std::string(scene.name)));
  const LeanPlan lean = leave_out(plan, {.seconds = seconds});
  double promised = 0;
  for (const LeftOut& item : lean.plan.left_out) {
    EXPECT_GT(item.time_saved, 0) << item.what;
    promised += item.error;
  }
  EXPECT_LE(promised, 0.01);
  EXPECT_LE(seen(plan, lean, seconds), promised);
}

INSTANTIATE_TEST_SUITE_P(LeaveOut, LeaveOutOf, testing::ValuesIn(scene_list), [](const auto& info) {
  std::string name(info.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// A load that comes at once swings the beam to about twice its static forces; the bound holds for each joint
// in every step, and is no more than three times what happens at the root.
TEST(Response, ForcesStayWithinTheirBound) {
  for (const double ramp : {0., 0.3, 3.}) {
    SceneDef scene = cantilever(10, P);
    scene.loads[0].ramp = ramp;
    scene.joint.damping_ratio = 0;
    const Plan plan = calibrate(scene);
    const Response bound(plan, 0);
    Simulation simulation(plan, JointSolver::direct, {.dt = 1. / 240});
    std::vector<std::array<double, 3>> largest(plan.joints.size());
    while (simulation.time() < 4) {
      simulation.step();
      for (std::size_t i = 0; i < largest.size(); ++i) {
        const JointReading now = simulation.joint(i);
        largest[i][shear] = std::max(largest[i][shear], std::abs(now.Q));
        largest[i][rotation] = std::max(largest[i][rotation], std::abs(now.M));
      }
    }
    for (std::size_t i = 0; i < largest.size(); ++i)
      for (const Row row : {shear, rotation})
        EXPECT_LE(largest[i][row], bound.force(3 * static_cast<int>(i) + row)) << plan.joints[i].name << ramp;
    const int root = joint_named(plan, "wall-beam/0");
    EXPECT_LT(bound.force(3 * root + rotation), 3 * largest[static_cast<std::size_t>(root)][rotation]);
    EXPECT_NEAR(bound.rest(3 * root + rotation) / (P * L), 1, 1e-9);
  }
}

TEST(EnergyAround, OfABallThatFlies) {
  SceneDef scene = cantilever(2, 0);
  scene.gravity = {0, -10};
  scene.bodies.push_back({.name = "ball",
                          .circle = 0.5,
                          .material = test_steel,
                          .at = {5, 8},
                          .velocity = {3, 4},
                          .angular_velocity = 2});
  const Plan plan = calibrate(scene);
  const double m = 7800 * std::numbers::pi / 4;
  const std::vector<int> loose = static_check(plan).loose;
  EXPECT_NEAR(energy_around(plan, loose) / (m * 25 / 2 + m * 0.25 / 2 * 4 / 2 + m * 10 * (8 + 2)), 1, 1e-12)
      << "down to the wall's foot at −2";
  EXPECT_EQ(energy_around(plan, {}), 0);
  scene.loads.push_back({.body = "ball", .at = {5, 8}, .force = {1, 0}});
  EXPECT_EQ(energy_around(calibrate(scene), loose), unlimited);
}

// The promise bounds what the run shows, for whatever tolerance; the less may be, the more joints stay.
TEST(LeaveOut, KeepsWithinTheTolerance) {
  SceneDef scene = cantilever(20, 0.5e6);
  scene.gravity = {0, -9.81};
  scene.gravity_ramp = scene.loads[0].ramp = 1;
  const Plan plan = calibrate(scene);
  std::size_t before = 0;
  for (const double tolerance : {0.03, 1e-3, 1e-4, 1e-7}) {
    const LeanPlan lean = leave_out(plan, {.tolerance = tolerance, .seconds = 3});
    expect_promises_kept(lean, tolerance);
    EXPECT_GE(lean.plan.joints.size(), before) << tolerance;
    before = lean.plan.joints.size();
    if (tolerance == 0.03) {
      EXPECT_EQ(before, 0u);
    }
  }
  EXPECT_EQ(before, plan.joints.size());
}

// Pushed sideways at every storey.
TEST(LeaveOut, AFrameUnderHalfItsCollapseLoadStandsAsOnePiece) {
  const Plan plan = calibrate(scene_of("frame_pushed"));
  ASSERT_NEAR(limit_analysis(plan, true).load_factor, 2.05, 0.05);
  ASSERT_EQ(plan.joints.size(), 160u);
  const LeanPlan lean = leave_out(plan, {.seconds = 4});
  expect_promises_kept(lean, 0.01);
  EXPECT_EQ(lean.plan.joints.size(), 0u) << "twice as fast at least: nothing of it is left to solve";
}

TEST(LeaveOut, HeldJointsStay) {
  SceneDef scene = cantilever(10, P);
  scene.joints[0].overrides.hold = true;
  const LeanPlan root = leave_out(calibrate(scene), {.tolerance = 0.1});
  ASSERT_EQ(root.plan.joints.size(), 1u);
  EXPECT_EQ(root.plan.joints[0].name, "wall-beam/0");
  EXPECT_LT(root.plan.joints[0].M, unlimited);
  scene.joint.hold = true;
  EXPECT_TRUE(leave_out(calibrate(scene), {.tolerance = 0.1}).plan.left_out.empty());
}

TEST(LeaveOut, WhatMayBeHitStays) {
  const Plan plan = calibrate(cantilever(10, P));
  EXPECT_TRUE(leave_out(plan, {.tolerance = 0.1}).plan.joints.empty());
  // ½ M_p²/k of the stiffest joint, ℓ = 2 m, would bring it to yield.
  const double k = 210e9 / 12 / 2, enough = plastic_moment * plastic_moment / k / 2;
  EXPECT_EQ(leave_out(plan, {.tolerance = 0.1, .impact = enough}).plan.joints.size(), plan.joints.size());
  EXPECT_EQ(leave_out(calibrate(scene_of("frame_bomb")), {.seconds = 1}).plan.joints.size(), 160u);
}

// All of the beam stands still then, and what is left of the joints holds nothing.
TEST(LeaveOut, WhatIsLooseBesideIsNoStructure) {
  const SceneDef scene = with_a_loose_stone(cantilever(4, P));
  const LeanPlan lean = leave_out(calibrate(scene), {.tolerance = 0.1, .seconds = 1});
  ASSERT_EQ(lean.plan.joints.size(), 1u);
  EXPECT_EQ(lean.plan.joints[0].name, "stone/0-stone/1");
}

TEST(LeaveOut, WhereSomethingBreaksTheRunDecides) {
  const Plan plan = calibrate(scene_of("harbour_crane"));
  const LeanPlan lean = leave_out(plan, {.seconds = 6});
  expect_promises_kept(lean, 0.01);
  EXPECT_LT(lean.plan.joints.size(), plan.joints.size());
  EXPECT_GE(joint_named(lean.plan, "jib/6-jib/7"), 0) << "which breaks";
}

TEST(LeaveOut, ACarMayHitItsBridgeAnyHow) {
  const Plan plan = calibrate(scene_of("car"));
  const LeanPlan lean = leave_out(plan, {.seconds = 6});
  expect_promises_kept(lean, 0.01);
  EXPECT_EQ(lean.plan.joints.size(), 1u);
  EXPECT_LT(lean.plan.joints[0].M, unlimited);
}

// A drawing of 500 joints; what is pinned to the ground or rolls on it stays.
TEST(LeaveOut, AViaductStandsOnItsSupportsInOnePiece) {
  const Plan plan = calibrate(scene_of("viaduct"));
  ASSERT_EQ(plan.joints.size(), 500u);
  const LeanPlan lean = leave_out(plan, {.seconds = 4});
  expect_promises_kept(lean, 0.01);
  EXPECT_EQ(lean.plan.joints.size(), 6u);
}

}  // namespace
