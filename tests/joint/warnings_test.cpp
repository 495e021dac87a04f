// A structure says in words what is not as it should be, and only then.
#include <gtest/gtest.h>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

/// The one warning there is.
std::string only(const Structure& structure) {
  const auto all = structure.warnings();
  std::string text;
  for (const std::string& one : all) text += one + "\n";
  EXPECT_EQ(all.size(), 1u) << text;
  return text;
}
#define EXPECT_SAYS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(Warnings, AreNoneWhereAllIsWell) {
  for (const double cap : {unlimited, 7800 * 10 * 200 / 1.3}) {
    Beam beam({.pieces = 10, .youngs_modulus = 210e9, .moment_cap = cap});
    EXPECT_TRUE(beam.structure.warnings().empty());
    beam.run(2);
    EXPECT_TRUE(beam.structure.warnings().empty());
  }
}

TEST(Warnings, OfTheSpeedLimit) {
  Beam beam({.pieces = 3, .gravity = 0});
  beam.world.DestroyJoint(beam.joints[0]);
  for (b2Body* b : beam.pieces) b->SetLinearVelocity({240, 0});
  beam.run(0.1);
  // 120 of 240 m/s remain.
  EXPECT_SAYS(only(beam.structure), "the speed limit took 75 %");
}

TEST(Warnings, OfStiffnessThatTheStepCannotIntegrate) {
  Beam beam({.pieces = 3, .youngs_modulus = 210e9});
  beam.joints[1]->set_stiffness(rotation, 1e25, 0);
  beam.run(0.1);
  EXPECT_SAYS(only(beam.structure), "1 rows (the first in joint 1) are stiffer");
}

TEST(Warnings, OfMassesThatDifferTooMuch) {
  Beam beam({.pieces = 2, .gravity = 0});
  const b2MassData heavy{1e12f, {0, 0}, 1e13f};
  beam.pieces[1]->SetMassData(&heavy);
  EXPECT_SAYS(only(beam.structure), "joint 1 ties masses of 1.3e+07 to 1");
  const b2MassData usual{78000, {0, 0}, 1e6f};
  beam.pieces[1]->SetMassData(&usual);
  EXPECT_TRUE(beam.structure.warnings().empty());
  b2Body* block = add_box(beam.world, {.x = 15, .y = 1, .mass = 1e9, .group = 0});
  beam.world.SetGravity({0, -1});
  beam.run(0.1);
  EXPECT_SAYS(only(beam.structure), "a piece touches a body with a mass of 1.3e+04 to 1");
  beam.world.DestroyBody(block);
  EXPECT_TRUE(beam.structure.warnings().empty());
}

TEST(Warnings, OfFixturesThatAreTooSmall) {
  b2World world({0, 0});
  Structure structure(world);
  b2Body *a = add_box(world, {.width = 0.05, .height = 0.015}),
         *b = add_box(world, {.x = 0.05, .width = 0.05});
  ElasticPlasticJointDef def;
  def.Initialize(a, b, {0.025f, 0});
  structure.create_joint(def);
  EXPECT_SAYS(only(structure), "a fixture of 0.0150 m");
}

/// A free beam of two pieces that spins by an angle a step.
Beam spinning(double turn) {
  Beam beam({.pieces = 2, .gravity = 0});
  beam.world.DestroyJoint(beam.joints[0]);
  const float rate = static_cast<float>(60 * turn);
  for (b2Body* b : beam.pieces) {
    b->SetAngularVelocity(rate);
    b->SetLinearVelocity(b2Cross(rate, b->GetWorldCenter() - beam.point(10)));
  }
  return beam;
}

TEST(Warnings, OfBodiesThatTurnTooFarInAStep) {
  Beam slow = spinning(0.099), fast = spinning(0.15);
  slow.run(1);
  EXPECT_TRUE(slow.structure.warnings().empty());
  fast.run(1);
  EXPECT_SAYS(only(fast.structure), "joint 1 turns by 0.15 rad a step, where 0.1 is promised");
  for (b2Body* b : fast.pieces) b->SetAngularVelocity(0), b->SetLinearVelocity({0, 0});
  fast.run(1);
  EXPECT_TRUE(fast.structure.warnings().empty());
}

// Its centre of mass stays where it is.
TEST(Warnings, AreNoneOfAWheelOnItsAxle) {
  b2World world({0, 0});
  Structure structure(world);
  b2Body *axle = add_box(world, {.type = b2_staticBody}), *wheel = add_box(world, {.width = 2, .height = 2});
  ElasticPlasticJointDef def;
  def.Initialize(axle, wheel, {0, 0});
  def.rows[rotation].cap = def.rows[rotation].cap_reverse = 0;
  structure.create_joint(def);
  wheel->SetAngularVelocity(30);
  for (int i = 0; i < 60; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }
  EXPECT_GT(wheel->GetAngularVelocity(), 29);
  EXPECT_TRUE(structure.warnings().empty());
}

/// A rigid bar of 20 m on a wall that swings as one until its root stops it, in so many steps, which stay
/// whole where Box2D takes them up to the next impact.
Beam stopping(double rate, double steps, double youngs_modulus = 0, bool whole = true) {
  constexpr double inertia = 7800 * 20 * (20 * 20 / 3. + 1 / 12.);  // about the root, kg m²
  Beam beam({.pieces = 1,
             .youngs_modulus = youngs_modulus,
             .damping_time = 0,
             .moment_cap = inertia * rate * 60 / steps,
             .gravity = 0});
  beam.world.SetSubStepping(whole);
  beam.pieces[0]->SetAngularVelocity(static_cast<float>(rate));
  beam.pieces[0]->SetLinearVelocity({0, static_cast<float>(10 * rate)});
  beam.run(0.5);
  return beam;
}

// What stops within T steps should turn by ½ ω T h. The first step of a blow has half of the cap, so that
// after k of them ω (1 − (k − ½)/T) is left, and in K of them, the whole number next to T, it turns by ω h (K
// − K²/2T): (T − K)²/T² of ½ ω T h is missing, 1/9 at most from ¾ of a step on. A
// spin of 1/60 rad a step loses ¾ of its square besides.
TEST(Warnings, OfBlowsThatAreOverWithinAStep) {
  EXPECT_SAYS(only(stopping(1, 0.2).structure), "left out up to 0.0017 of plastic flow");
  EXPECT_SAYS(only(stopping(1, 0.4).structure), "left out up to 0.0033 of plastic flow");
  for (const double steps : {0.75, 1., 1.5, 5.}) {
    const Beam beam = stopping(1, steps);
    EXPECT_TRUE(beam.structure.warnings().empty()) << steps;
    const double missing = steps - std::round(steps), all = steps / 120;
    EXPECT_NEAR(beam.joints[0]->plastic(rotation), all * (1 - missing * missing / steps / steps),
                0.75 / 3600 * all)
        << steps;
  }
  EXPECT_TRUE(stopping(0.5, 0.2).structure.warnings().empty());  // 0.0008 rad
  // √(I/k) = 0.1 s: the spring stores it.
  const Beam spring = stopping(1, 0.2, 210e9);
  EXPECT_TRUE(spring.structure.warnings().empty());
  EXPECT_EQ(spring.joints[0]->plastic(rotation), 0);
}

// The same in 64 parts of a step, which is divided where it takes a quarter of what it may.
TEST(Warnings, AreNoneOfBlowsThatAreSolvedInParts) {
  for (const double steps : {0.3, 0.4, 0.75, 5.}) {
    const Beam beam = stopping(1, steps, 0, false);
    EXPECT_TRUE(beam.structure.warnings().empty()) << steps;
    const double missing = 1 - std::round(64 * steps) / (64 * steps), all = steps / 120;
    EXPECT_NEAR(beam.joints[0]->plastic(rotation), all * (1 - missing * missing), 0.75 / 3600 * all) << steps;
  }
}

// Without iterations of positions no step is solved in parts. Bar and box go on at ω = m v a/(I + m a²),
// which the root stops within m v a/M.
TEST(Warnings, OfContactsThatAreOverWithinAStep) {
  for (const double steps : {0.3, 3.}) {
    constexpr double mass = 30e3, arm = 19, speed = 18;
    Beam beam({.pieces = 1, .moment_cap = mass * speed * arm * 60 / steps, .gravity = 0});
    add_box(beam.world, {.x = arm, .y = 1.1, .mass = mass, .group = 0})->SetLinearVelocity({0, -speed});
    for (int i = 0; i < 30; ++i) {
      beam.world.Step(1 / 60.0f, 8, 0);
      beam.structure.update();
    }
    if (steps < 1) {
      EXPECT_EQ(beam.joints[0]->plastic(rotation), 0);
      EXPECT_SAYS(only(beam.structure), "blows that were over within a step left out");
    } else {
      EXPECT_GT(std::abs(beam.joints[0]->plastic(rotation)), 0.005);
      EXPECT_TRUE(beam.structure.warnings().empty());
    }
  }
}

// Supports that are moved apart leave no pose that keeps the gaps: the joints take what is missing as
// plastic, 1 m in all, and store none of it.
TEST(Pushes, ThatNoPoseCanFollowStrainNothing) {
  Beam beam({.pieces = 1, .gravity = 0});
  b2Body* support = add_box(beam.world, {.x = 21, .type = b2_staticBody});
  ElasticPlasticJointDef def;
  def.Initialize(beam.pieces[0], support, beam.point(20), {1, 0});
  ElasticPlasticJoint* last = beam.structure.create_joint(def);
  beam.run(0.1);
  support->SetTransform(support->GetPosition() + b2Vec2{1, 0}, 0);
  beam.run(0.1);
  EXPECT_NEAR(beam.joints[0]->plastic(axial) + last->plastic(axial), 1, 1e-6);
  EXPECT_NEAR(beam.pieces[0]->GetPosition().x, 10.5, 1e-5);  // rows of one stiffness meet in the middle
  EXPECT_LT(beam.structure.energy().elastic, 1e-9);
  EXPECT_LT(kinetic_energy(beam.pieces), 1e-9);
}

TEST(Events, TellOfFlowNowAndThen) {
  const double cap = 7800 * 10 * 200 / 1.5;
  for (const double share : {0.1, 0.5}) {
    Beam beam({.pieces = 1, .moment_cap = cap});
    beam.structure = Structure(beam.world, {.flow_share = share});
    beam.world.DestroyJoint(beam.world.GetJointList());
    ElasticPlasticJointDef def;
    def.Initialize(beam.wall, beam.pieces[0], beam.point(0), {1, 0});
    def.rows[rotation].cap = def.rows[rotation].cap_reverse = cap;
    def.max_rotation = 10;  // it comes to rest at 1.4958 of them
    beam.structure.create_joint(def);
    std::vector<JointEvent> events;
    beam.structure.on_event([&](const JointEvent& e) { events.push_back(e); });
    beam.run(14);
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events.front().kind, JointEvent::yield);
    EXPECT_EQ(std::count_if(events.begin(), events.end(), [](auto& e) { return e.kind == JointEvent::flow; }),
              share < 0.2 ? 1 : 0);
    EXPECT_EQ(events.size(), share < 0.2 ? 2u : 1u);
  }
}

// Each event finds at least twice the work of the last, and none is left out.
TEST(Events, TellOfFlowWithoutALimitAsItsWorkDoubles) {
  const double cap = 7800 * 10 * 200 / 1.5;
  Beam beam({.pieces = 1, .moment_cap = cap});
  std::vector<JointEvent> events;
  beam.structure.on_event([&](const JointEvent& e) { events.push_back(e); });
  beam.run(14);
  ASSERT_GE(events.size(), 4u);
  EXPECT_EQ(events.front().kind, JointEvent::yield);
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_EQ(events[i].kind, JointEvent::flow);
    EXPECT_NEAR(events[i].worked, events[i].energy - events[i - 1].energy, 1e-9 * events[i].energy);
    EXPECT_GE(events[i].energy, 2 * events[i - 1].energy);
  }
  EXPECT_LT(beam.joints[0]->dissipated(), 2 * events.back().energy);
}

}  // namespace
}  // namespace ductile
