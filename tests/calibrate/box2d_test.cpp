// Plans in Box2D: definitions, fixtures, worlds.
#include "ductile/box2d.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "ductile/plane.h"
#include "scenes.h"

namespace {
using namespace ductile;

std::string problems_of(const Plan& plan) {
  try {
    b2World world({0, 0});
    build_stock(world, plan);
    return "";
  } catch (const InvalidInput& e) {
    return e.what();
  }
}

// The paper's calibration: a rotation that the joint shall have under a load, given as moment and rotation,
// becomes k = M/θ; the world then shows that rotation under that load.
TEST(TargetRotation, ComesBackFromTheWorld) {
  for (const double target : {0.002, 0.01, 0.03}) {
    SceneDef scene = cantilever(1);
    const double weight = 7800 * 20 * 9.81;
    // The beam's weight once it has turned by θ: m g (L/2 cos θ + h/2 sin θ) about the anchor at mid-height.
    const double moment = weight * 10 * std::cos(target);
    scene.joints[0].overrides = {.moment = moment,
                                 .elastic = Elasticity::elastic_rotation,
                                 .damping_ratio = 1,
                                 .elastic_rotation = target};
    const Plan plan = calibrate(scene);
    EXPECT_DOUBLE_EQ(plan.joints[0].stiffness.M, moment / target);
    b2World world({0, 0});
    const Built built = build_stock(world, plan);
    for (int i = 0; i < 600; ++i) {
      apply_loads(world, plan, built, i / 60.0);
      world.Step(1 / 60.0f, 8, 3);
    }
    EXPECT_NEAR(-built.bodies[1]->GetAngle() / target, 1, 1e-3);
  }
}

// A stock revolute joint with its motor at M_p: gravity applied at once to a rigid-plastic cantilever stops
// at sin θ/θ = M_p/M (mechanics of a rigid bar, energy balance).
TEST(Hinge, GivesWayAtThePlasticMoment) {
  const Plan plan = calibrate(cantilever(1));
  const double rest = 7800 * 20 * 9.81 * 10;
  for (const auto& [ratio, expected] : {std::pair(0.95, 0.0), std::pair(1.05, 0.5384)}) {
    PlannedJoint joint = plan.joints[0];
    joint.M = joint.M_reverse = rest / ratio;
    b2World world({0, -9.81f});
    const Built built = build_bodies(world, plan);
    b2RevoluteJointDef def = hinge_def(plan, joint);
    def.bodyA = built.bodies[0];
    def.bodyB = built.bodies[1];
    world.CreateJoint(&def);
    for (int i = 0; i < 1200; ++i) world.Step(1 / 60.0f, 8, 3);
    EXPECT_NEAR(-built.bodies[1]->GetAngle(), expected, 0.005);
  }
}

TEST(Definitions, CarryWhatThePlanSays) {
  Plan plan = calibrate(cantilever(2));
  const PlannedJoint& j = plan.joints[0];
  const ElasticPlasticJointDef def = elastic_plastic_def(plan, j);
  EXPECT_EQ(def.rows[axial].cap, j.N);
  EXPECT_EQ(def.rows[shear].cap_reverse, j.Q);
  EXPECT_EQ(def.rows[rotation].stiffness, j.stiffness.M);
  // c = 2ζk/ω, of the structure's lowest mode.
  EXPECT_DOUBLE_EQ(def.rows[rotation].damping,
                   0.05 * j.stiffness.M / (std::numbers::pi * j.damping_frequency));
  EXPECT_EQ(def.rows[rotation].damping_ratio, 0);
  EXPECT_EQ(def.max_rotation, j.max_rotation);
  EXPECT_EQ(def.localAnchorA, b2Vec2(5, 0));
  EXPECT_EQ(def.localAnchorB, b2Vec2(-5, 0));
  EXPECT_TRUE(def.interaction.empty());
  EXPECT_FALSE(lost_in_stock(j).empty());
  PlannedJoint weld;
  weld.N = weld.Nc = weld.Q = weld.M = weld.M_reverse = unlimited;
  weld.stiffness = {unlimited, unlimited, 1e6};
  EXPECT_TRUE(lost_in_stock(weld).empty());
}

TEST(Definitions, NumbersThatNoFloatHoldsAreRefused) {
  Plan plan = calibrate(cantilever(2));
  PlannedJoint j = plan.joints[0];
  j.M = j.M_reverse = 1e39;
  EXPECT_THROW(hinge_def(plan, j), InvalidInput);
  j.M = j.M_reverse = 1e-40;
  EXPECT_THROW(hinge_def(plan, j), InvalidInput);
  j.stiffness.M = 1e39;
  EXPECT_THROW(weld_def(plan, j), InvalidInput);
  j.M = j.M_reverse = unlimited;
  EXPECT_EQ(hinge_def(plan, j).maxMotorTorque, std::numeric_limits<float>::max());
}

// Rectangle: m = 1 − n² (mechanics §1).
TEST(Interaction, OfARectangularCut) {
  SceneDef scene = cantilever(2);
  scene.interaction = true;
  Plan plan = calibrate(scene);
  for (const double stretch : {1.0, 0.5}) {
    PlannedJoint j = plan.joints[0];
    j.N *= stretch;
    j.Nc *= stretch;
    const std::vector<AxialMoment> polygon = interaction_of(plan, j, 1e-4);
    ASSERT_GT(polygon.size(), 8u);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const double n = polygon[i].N / j.N, m = polygon[i].M / j.M;
      EXPECT_NEAR(std::abs(m), 1 - n * n, 1e-12);
      const AxialMoment a = polygon[(i + 1) % polygon.size()], b = polygon[(i + 2) % polygon.size()];
      EXPECT_GT((a.N - polygon[i].N) * (b.M - a.M) - (a.M - polygon[i].M) * (b.N - a.N), 0);
    }
  }
}

TEST(Interaction, OfTwoBodiesIsInsideBoth) {
  SceneDef scene = cantilever(1);
  scene.bodies[0].material = test_steel;
  scene.bodies[0].material->yield_stress = 100e6;
  scene.bodies[0].material->yield_stress_compression = 700e6;
  const Plan plan = calibrate(scene);
  const PlannedJoint& j = plan.joints[0];
  EXPECT_EQ(j.N, 100e6);
  EXPECT_EQ(j.Nc, 350e6);
  const std::vector<AxialMoment> polygon = interaction_of(plan, j);
  ASSERT_FALSE(polygon.empty());
  const Section wall = *section_at(plan, j, j.a), beam = *section_at(plan, j, j.b);
  double most = 0;
  for (const AxialMoment& p : polygon) {
    most = std::max(most, p.N);
    for (const Section* s : {&wall, &beam}) {
      EXPECT_LE(p.M, s->moment_at({0, -1}, p.N, 0) * (1 + 1e-9) + 1);
      EXPECT_LE(-p.M, s->moment_at({0, -1}, p.N, 0, true) * (1 + 1e-9) + 1);
    }
  }
  EXPECT_LE(most, 100e6 * (1 + 1e-12));
}

TEST(World, BodiesHaveTheOutlinesMass) {
  const Plan plan = calibrate(cantilever(10));
  b2World world({0, -9.81f});
  const Built built = build_stock(world, plan);
  EXPECT_EQ(world.GetJointCount(), 10);
  for (std::size_t i = 1; i < built.bodies.size(); ++i) {
    EXPECT_FLOAT_EQ(built.bodies[i]->GetMass(), 15600);
    EXPECT_FLOAT_EQ(built.bodies[i]->GetInertia(), 6500);
    EXPECT_EQ(built.bodies[i]->GetLocalCenter(), b2Vec2(0, 0));
  }
  EXPECT_EQ(built.bodies[0]->GetType(), b2_staticBody);
}

// The level-load call with ductile joints: the root carries the beam's weight, ½ q L², at rest.
TEST(World, DuctileCantileverStandsAndCarriesItsWeight) {
  const Plan plan = calibrate(cantilever(10));
  b2World world({0, -9.81f});
  Built built;
  Structure structure = build(world, plan, {}, &built);
  for (int i = 0; i < 900; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }
  const ElasticPlasticJoint* root = structure.joints().back();
  EXPECT_EQ(root, built.joints.back());
  EXPECT_NEAR(-root->force(rotation) / (7800 * 9.81 * 20 * 20 / 2), 1, 1e-3);
}

TEST(World, PiecesOfOneBodyDoNotCollideButThoseOfTwoDo) {
  SceneDef scene = cantilever(4);
  BodyDef other = scene.bodies[1];
  other.name = "other";
  scene.bodies.push_back(other);
  const Plan plan = calibrate(scene);
  b2World world({0, 0});
  const Built first = build_bodies(world, plan), second = build_bodies(world, plan);
  const auto collide = [](b2Body* a, b2Body* b) {
    b2ContactFilter filter;
    return filter.ShouldCollide(a->GetFixtureList(), b->GetFixtureList());
  };
  EXPECT_FALSE(collide(first.bodies[1], first.bodies[4]));
  EXPECT_TRUE(collide(first.bodies[1], first.bodies[5]));
  EXPECT_TRUE(collide(first.bodies[1], second.bodies[1]));  // another of the same plan
  EXPECT_TRUE(collide(first.bodies[0], first.bodies[1]));
}

TEST(World, ASpinningBodyTurnsAboutItsCentre) {
  SceneDef scene;
  scene.bodies = {{.name = "bar",
                   .outline = {rectangle(0, 0, 4, 1), {}},
                   .material = test_steel,
                   .pieces = 2,
                   .velocity = {1, 2},
                   .angular_velocity = 3}};
  b2World world({0, 0});
  const Built built = build_bodies(world, calibrate(scene));
  EXPECT_EQ(built.bodies[0]->GetLinearVelocity(), b2Vec2(1, -1));
  EXPECT_EQ(built.bodies[1]->GetLinearVelocity(), b2Vec2(1, 5));
  EXPECT_EQ(built.bodies[1]->GetAngularVelocity(), 3);
}

// 4 kg, that nothing holds.
SceneDef falling_box() {
  SceneDef scene;
  scene.bodies = {{.name = "box",
                   .outline = {rectangle(-1, -1, 1, 1), {}},
                   .material = Material{.yield_stress = 1, .density = 1}}};
  scene.gravity = {0, -10};
  return scene;
}

TEST(World, LoadsRideRampAndEnd) {
  SceneDef scene = falling_box();
  scene.gravity_ramp = 4;
  scene.loads = {{.body = "box", .at = {0, 0}, .force = {8, 0}, .from = 1, .ramp = 2, .to = 5}};
  const Plan plan = calibrate(scene);
  const auto acceleration = [&](double time) {
    b2World world({0, 0});
    const Built built = build_bodies(world, plan);
    apply_loads(world, plan, built, time);
    world.Step(1 / 128.0f, 8, 3);
    return Point{128 * built.bodies[0]->GetLinearVelocity().x, 128 * built.bodies[0]->GetLinearVelocity().y};
  };
  EXPECT_EQ(acceleration(0), (Point{0, 0}));
  EXPECT_EQ(acceleration(2), (Point{1, -5}));
  EXPECT_EQ(acceleration(4), (Point{2, -10}));
  EXPECT_EQ(acceleration(5), (Point{0, -10}));
}

// Whatever the steps, the impulse is that of the load: F (t − r/2) of what grows over r and lasts t in all.
TEST(World, LoadsGiveTheirImpulseInStepsOfAnyLength) {
  SceneDef scene = falling_box();
  scene.gravity_ramp = 0.033;
  for (const auto& [from, ramp, to] :
       {std::array{0.0, 0.0, 0.01}, std::array{0.105, 0.0, 0.26}, std::array{0.013, 0.1, 0.2}}) {
    scene.loads = {{.body = "box", .at = {0, 0}, .force = {8, 0}, .from = from, .ramp = ramp, .to = to}};
    const Plan plan = calibrate(scene);
    for (const double hz : {30., 50., 60., 100., 144., 240.}) {
      b2World world({0, 0});
      const Built built = build_bodies(world, plan);
      for (int i = 0; i < hz / 2; ++i) {
        apply_loads(world, plan, built, i / hz, 1 / hz);
        world.Step(static_cast<float>(1 / hz), 8, 3);
      }
      const double exact = 8 * (to - from - ramp / 2) / 4;
      EXPECT_NEAR(built.bodies[0]->GetLinearVelocity().x, exact, 1e-6) << from << ", " << hz;
      EXPECT_NEAR(built.bodies[0]->GetLinearVelocity().y, -10 * (0.5 - 0.033 / 2), 1e-5)
          << from << ", " << hz;
    }
  }
}

TEST(World, StockJointsLeaveFreeRowsFree) {
  // A simply supported beam: pin and roller carry half the weight each, and the beam stays where it is.
  SceneDef scene;
  scene.bodies = {{.name = "beam", .outline = {rectangle(0, 0, 10, 1), {}}, .material = test_steel}};
  scene.supports = {{.body = "beam", .at = {0, 0.5}, .fix_x = true, .fix_y = true},
                    {.body = "beam", .at = {10, 0.5}, .fix_y = true}};
  const Plan plan = calibrate(scene);
  b2World world({0, -9.81f});
  const Built built = build_stock(world, plan);
  ASSERT_EQ(built.joints[0]->GetType(), e_revoluteJoint);
  ASSERT_EQ(built.joints[1]->GetType(), e_wheelJoint);
  for (int i = 0; i < 120; ++i) world.Step(1 / 60.0f, 8, 3);
  EXPECT_NEAR(built.joints[1]->GetReactionForce(60).y / (7800 * 10 * 9.81 / 2), 1, 1e-3);
  EXPECT_NEAR(built.bodies[0]->GetAngle(), 0, 1e-3);
}

TEST(World, ThinPiecesAreRefusedByNameAndSmallScenesAreNotCalibratedAway) {
  SceneDef scene;
  scene.bodies = {
      {.name = "strip", .outline = {rectangle(0, 0, 0.05, 0.04), {}}, .material = test_steel, .pieces = 5}};
  const Plan plan = calibrate(scene);
  EXPECT_EQ(plan.joints.size(), 4u);
  EXPECT_NE(problems_of(plan).find("piece 'strip/0': is 0.01 m wide"), std::string::npos)
      << problems_of(plan);
  scene.bodies[0].pieces = 2;
  EXPECT_EQ(problems_of(calibrate(scene)), "");
}

TEST(Shapes, LeaveOutSliversAndDetail) {
  // A 1 m plate with a tooth 1 mm high and a corner rounded in steps of 1 mm.
  Ring ring{{0, 0}, {0.5, 0}, {0.5, -0.001}, {0.6, -0.001}, {0.6, 0}, {1, 0}, {1, 0.99}};
  for (int i = 1; i < 16; ++i) {
    const double a = i * std::numbers::pi / 32;
    ring.push_back({0.99 + 0.01 * std::cos(a), 0.99 + 0.01 * std::sin(a)});
  }
  ring.push_back({0.99, 1});
  ring.push_back({0, 1});
  const Plan plan = calibrate(BodyDef{.outline = {ring, {}}, .material = test_steel});
  double area = 0;
  for (const b2PolygonShape& shape : shapes(plan.pieces[0])) {
    b2MassData mass;
    shape.ComputeMass(&mass, 1);
    area += mass.mass;
  }
  EXPECT_NEAR(area, 1, 0.005);
}

}  // namespace
