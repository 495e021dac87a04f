// Pieces that became one rigid body: its mass, its fixtures, and what is read of its parts.
#include "merge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ductile/box2d.h"
#include "ductile/design.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20, h = 1, P = 1e6;

std::vector<int> all_but(const Plan& plan, const std::string& kept) {
  std::vector<int> joints;
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (plan.joints[i].name != kept) joints.push_back(static_cast<int>(i));
  return joints;
}

TEST(Merge, OneBodyHasMassInertiaAndOutlineOfItsParts) {
  const Plan full = calibrate(cantilever(10, P)), lean = merged(full, all_but(full, "wall-beam/0"));
  ASSERT_EQ(lean.joints.size(), 1u);
  const Piece& body = lean.carrier(7);
  const double mass = 7800 * L * h;
  EXPECT_NEAR(body.mass / mass, 1, 1e-12);
  EXPECT_NEAR(body.inertia / (mass * (L * L + h * h) / 12), 1, 1e-12);
  EXPECT_NEAR(body.center.x, L / 2, 1e-12);

  b2World world({0, 0});
  const Built built = build_bodies(world, lean);
  b2Body* beam = built.bodies[1];
  EXPECT_EQ(world.GetBodyCount(), 2);
  EXPECT_NEAR(beam->GetMass() / mass, 1, 1e-6);
  int fixtures = 0;
  for (b2Fixture* f = beam->GetFixtureList(); f; f = f->GetNext()) ++fixtures;
  EXPECT_EQ(fixtures, 10);
  for (double x = 0.05; x < L; x += 0.1) {
    const b2Vec2 inside{static_cast<float>(x), 0.49f}, above{static_cast<float>(x), 0.52f};
    const auto covers = [&](b2Vec2 p) {
      bool any = false;
      for (b2Fixture* f = beam->GetFixtureList(); f; f = f->GetNext()) any = any || f->TestPoint(p);
      return any;
    };
    EXPECT_TRUE(covers(inside)) << x;
    EXPECT_FALSE(covers(above)) << x;
  }
}

TEST(Merge, LoadsAndReadingsStayWhereTheyWere) {
  const Plan full = calibrate(cantilever(10, P)), lean = merged(full, all_but(full, "wall-beam/0"));
  EXPECT_NEAR(static_check(lean).joints[0].M / (-P * L), 1, 1e-12);
  Simulation simulation(lean);
  for (int i = 0; i < 10; ++i) simulation.step();
  const double turn = simulation.piece(1).angle;
  EXPECT_LT(turn, -1e-5);
  const PieceReading second = simulation.piece(2), last = simulation.piece(10);  // the first stands for all
  const double apart = 0.8 * L;
  EXPECT_EQ(last.angle, turn);
  EXPECT_NEAR(last.position.y - second.position.y, apart * std::sin(turn), 1e-5);
  EXPECT_NEAR(last.velocity.y - second.velocity.y, apart * last.angular_velocity, 1e-5);
}

TEST(Merge, WhatIsFusedWithAWallStandsStill) {
  const Plan full = calibrate(cantilever(4, P)), lean = merged(full, all_but(full, "beam/1-beam/2"));
  ASSERT_EQ(lean.joints.size(), 1u);
  EXPECT_FALSE(lean.is_dynamic(1));
  EXPECT_FALSE(lean.is_dynamic(2));
  EXPECT_TRUE(lean.is_dynamic(3));
  EXPECT_NEAR(static_check(lean).joints[0].M / (-P * L / 2), 1, 1e-12);
  Simulation simulation(lean);
  simulation.step();
  EXPECT_EQ(simulation.built().bodies[1]->GetType(), b2_staticBody);
  EXPECT_EQ(simulation.built().bodies[3]->GetType(), b2_dynamicBody);
}

TEST(Merge, AKeptJointIsNeverInside) {
  const Plan full = calibrate(fixed_fixed(4, P));  // a ring, through the ground
  const Plan lean = merged(full, all_but(full, "beam/1-beam/2"));
  const int kept = joint_named(lean, "beam/1-beam/2");
  ASSERT_GE(kept, 0);
  EXPECT_EQ(lean.joints.size(), 2u) << "its ring opens in one more joint";
  EXPECT_TRUE(merged(full, all_but(full, "")).joints.empty());
}

}  // namespace
