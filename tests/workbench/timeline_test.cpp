#include "timeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "ductile/colours.h"
#include "scenes.h"

namespace ductile::viewer {
namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Everything but what it cost.
void expect_same(const Frame& a, const Frame& b) {
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  ASSERT_EQ(a.thrown.size(), b.thrown.size());
  EXPECT_TRUE(same_bits(a.time, b.time));
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    EXPECT_TRUE(same_bits(a.pieces[i].position.x, b.pieces[i].position.x)) << "piece " << i;
    EXPECT_TRUE(same_bits(a.pieces[i].position.y, b.pieces[i].position.y)) << "piece " << i;
    EXPECT_TRUE(same_bits(a.pieces[i].angle, b.pieces[i].angle)) << "piece " << i;
    EXPECT_TRUE(same_bits(a.pieces[i].angular_velocity, b.pieces[i].angular_velocity)) << "piece " << i;
  }
  for (std::size_t i = 0; i < a.thrown.size(); ++i) {
    EXPECT_TRUE(same_bits(a.thrown[i].position.x, b.thrown[i].position.x)) << "thrown " << i;
  }
  for (std::size_t i = 0; i < a.joints.size(); ++i) {
    EXPECT_TRUE(same_bits(a.joints[i].M, b.joints[i].M)) << "joint " << i;
    EXPECT_TRUE(same_bits(a.joints[i].dissipated, b.joints[i].dissipated)) << "joint " << i;
    EXPECT_EQ(a.joints[i].broken, b.joints[i].broken) << "joint " << i;
  }
}

/// A plan with a root that yields at once and breaks on the way down, and what a user does meanwhile.
Plan bending() { return calibrate(cantilever(4, 3e6, 0.9)); }
void play_with(Timeline& run) {
  run.go_to(5);
  run.act(act::Throw{.at = {4, 3}, .velocity = {0, -8}, .mass = 5e4});
  run.go_to(12);
  run.act(act::Grab{.piece = 4, .at = run.frame().pieces[4].position});
  run.act(act::Pull{{9, 4}});
  run.go_to(25);
  run.act(act::Release{});
  run.act(act::Set{{.dt = 1. / 120, .velocity_iterations = 12}});
}

TEST(Timeline, StartsWithTheFirstFrame) {
  const Timeline run(bending());
  EXPECT_EQ(run.cursor(), 0);
  EXPECT_EQ(run.last(), 0);
  EXPECT_EQ(run.frame().time, 0);
  EXPECT_EQ(run.frame().pieces.size(), 5u);
  EXPECT_FALSE(run.busy());
}

// Of every step the largest stage up to it; what is forgotten is not remembered.
TEST(Timeline, KeepsThePeaksOfTheRun) {
  Timeline run(bending());
  play_with(run);
  run.go_to(60);
  const auto are_kept = [&run] {
    std::vector<float> most(run.plan().joints.size(), 0);
    for (long step = 0; step <= run.last(); ++step) {
      const Frame& frame = *run.kept(step);
      for (std::size_t i = 0; i < most.size(); ++i) {
        most[i] = std::max(most[i], static_cast<float>(stage(frame.joints[i])));
      }
      ASSERT_EQ(frame.peaks, most) << step;
    }
  };
  are_kept();
  EXPECT_GT(run.frame().peaks[0], static_cast<float>(stage(run.kept(0)->joints[0])));
  run.go_to(10);
  run.act(act::Set{{.dt = 1. / 240}});
  run.go_to(30);
  are_kept();
}

TEST(Timeline, LooksBackWithoutSimulatingAgain) {
  Timeline run(bending());
  run.go_to(40);
  const Frame early = *run.kept(10);
  run.seek(10);
  EXPECT_FALSE(run.busy());
  EXPECT_EQ(run.cursor(), 10);
  EXPECT_EQ(run.last(), 40);
  expect_same(run.frame(), early);
}

TEST(Timeline, WhatWasForgottenComesBackBitForBit) {
  Timeline whole(bending());
  play_with(whole);
  whole.go_to(120);
  // Room for a few frames only: whatever is not kept has to be simulated again.
  Timeline small(bending(), JointSolver::direct, whole.acts(), 8 * whole.frame().size());
  small.go_to(120);
  ASSERT_GT(small.first_kept(), 100);
  for (const long step : {3L, 80L, 12L, 26L, 5L, 120L}) {
    small.go_to(step);
    SCOPED_TRACE(step);
    EXPECT_EQ(small.cursor(), step);
    expect_same(small.frame(), *whole.kept(step));
  }
  EXPECT_EQ(small.events().size(), whole.events().size());
  EXPECT_EQ(small.last(), 120);
}

TEST(Timeline, ActingInThePastForgetsTheFutureAndGoesOnFromThere) {
  Timeline run(bending());
  play_with(run);
  run.go_to(100);
  ASSERT_FALSE(run.events().empty());
  run.seek(8);
  run.act(act::Throw{.at = {8, 4}, .velocity = {0, -20}, .mass = 1e5});
  EXPECT_EQ(run.last(), 8);
  EXPECT_EQ(run.kept(9), nullptr);
  EXPECT_TRUE(run.busy()) << "the world has to come back to step 8";
  for (const TimelineEvent& event : run.events()) EXPECT_LE(event.step, 8);
  while (!run.work(0)) {
  }
  EXPECT_EQ(run.cursor(), 8);
  EXPECT_EQ(run.frame().thrown.size(), 2u) << "seen at once, beside the one of step 5";
  run.go_to(60);

  // The same as if it had been done so from the beginning.
  Timeline straight(bending());
  straight.go_to(5);
  straight.act(act::Throw{.at = {4, 3}, .velocity = {0, -8}, .mass = 5e4});
  straight.go_to(8);
  straight.act(act::Throw{.at = {8, 4}, .velocity = {0, -20}, .mass = 1e5});
  straight.go_to(60);
  expect_same(run.frame(), straight.frame());
  ASSERT_EQ(run.events().size(), straight.events().size());
  for (std::size_t i = 0; i < run.events().size(); ++i) {
    EXPECT_EQ(run.events()[i].step, straight.events()[i].step);
    EXPECT_EQ(run.events()[i].event.joint, straight.events()[i].event.joint);
  }
}

TEST(Timeline, WorkComesInSlices) {
  Timeline run(bending());
  run.seek(50);
  int slices = 0;
  double last = -1;
  while (!run.work(0)) {
    EXPECT_GT(run.progress(), last);
    last = run.progress();
    ++slices;
  }
  EXPECT_EQ(slices, 49);
  EXPECT_EQ(run.cursor(), 50);
  EXPECT_EQ(run.progress(), 1);
}

TEST(Timeline, AGrabbedBodyFollowsTheHand) {
  SceneDef scene = cantilever(1, unlimited);
  scene.gravity = {0, 0};
  scene.joints.clear();  // the bar floats
  Timeline run(calibrate(scene));
  const Point from = run.frame().pieces[1].position;
  run.act(act::Grab{.piece = 1, .at = from});
  run.act(act::Pull{from + Point{1, 2}});
  run.go_to(300);
  EXPECT_NEAR(run.frame().pieces[1].position.x, from.x + 1, 1e-3);
  EXPECT_NEAR(run.frame().pieces[1].position.y, from.y + 2, 1e-3);
  run.act(act::Grab{.piece = 0, .at = {-0.5, 0}});  // the wall stays where it is
  run.act(act::Pull{{5, 5}});
  run.go_to(310);
  EXPECT_EQ(run.frame().pieces[0].position, run.plan().pieces[0].center);
}

TEST(Timeline, ThrownMassAndSpeedAreAsAsked) {
  SceneDef scene = cantilever(1, unlimited);
  scene.gravity = {0, 0};
  scene.joints.clear();
  scene.bodies.erase(scene.bodies.begin());  // no wall
  for (const bool square : {false, true}) {
    // It hits the end of the floating bar head-on and inelastically: momentum stays.
    Timeline run(calibrate(scene));
    run.act(act::Throw{.at = {13, 0.5}, .velocity = {-20, 0}, .mass = 4e4, .size = 1, .square = square});
    EXPECT_EQ(run.frame().thrown.size(), 1u) << "seen before the next step";
    run.go_to(120);
    const double bar = run.plan().pieces[0].mass, v = run.frame().pieces[0].velocity.x;
    EXPECT_NEAR(bar, 8e4, 1e-6 * bar);
    EXPECT_NEAR(v, -20 * 4e4 / (4e4 + 8e4), 1e-3 * 20);
  }
}

TEST(Timeline, SteppingChangesWhereItWasChanged) {
  Timeline run(bending());
  run.go_to(10);
  run.act(act::Set{{.dt = 0.001}});
  EXPECT_EQ(run.stepping().dt, 0.001);
  run.go_to(11);
  EXPECT_NEAR(run.frame().time, 10. / 60 + 0.001, 1e-12);
  run.seek(9);
  EXPECT_EQ(run.stepping().dt, 1. / 60);
}

TEST(Timeline, WhatIsThrownInIsNoErrorOfTheLedger) {
  SceneDef scene = cantilever(4, 3e6);
  scene.gravity_ramp = 0.5;
  Timeline run(calibrate(scene));
  const act::Throw thrown{.at = {20, 30}, .velocity = {6, -8}, .mass = 5e4};  // falls past the bar
  run.go_to(10);
  run.act(thrown);
  for (const long step : {10L, 11L, 60L}) {
    run.go_to(step);
    const Energy& energy = run.frame().energy;
    EXPECT_LT(std::abs(energy.total_error), 1e-4 * 5e4 * 50) << "step " << step;
    EXPECT_TRUE(step == 10 || energy.kinetic > 5e4 * 50);
  }
}

}  // namespace
}  // namespace ductile::viewer
