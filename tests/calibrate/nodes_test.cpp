// Bodies held together at a point, and plans built into a structure that is there.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "ductile/box2d.h"
#include "ductile/plane.h"
#include "scenes.h"

namespace ductile {
namespace {

/// Two bars of 2.5 m from the ceiling, 1.5 m to either side, down to a weight that they overlap at (0, 0).
SceneDef hanger() {
  SceneDef scene;
  scene.gravity = {0, -10};
  const auto bar = [](const char* name, double side) {
    const double along = std::atan2(2, side), c = std::cos(along), s = std::sin(along);
    BodyDef def{.name = name,
                .outline = {rectangle(-0.05, -0.05, 2.55, 0.05), {}},
                .material = test_steel,
                .depth = 0.01};
    def.angle = std::atan2(s, c);
    return def;
  };
  scene.bodies = {{.name = "ceiling", .type = BodyType::static_body, .outline = {rectangle(-3, 2, 3, 3), {}}},
                  {.name = "weight",
                   .outline = {rectangle(-0.5, -0.5, 0.5, 0.5), {}},
                   .material = test_steel,
                   .depth = 0.1},
                  bar("left", -1.5),
                  bar("right", 1.5)};
  scene.joints = {{.a = "weight", .b = "left", .at = Point{0, 0}, .others = {"right"}},
                  {.a = "ceiling", .b = "left", .at = Point{-1.5, 2}},
                  {.a = "ceiling", .b = "right", .at = Point{1.5, 2}}};
  return scene;
}

TEST(Node, JoinsEachBodyToTheFirst) {
  const Plan plan = calibrate(hanger());
  ASSERT_EQ(plan.joints.size(), 4u);
  EXPECT_EQ(plan.joints[0].name, "weight-left");
  EXPECT_EQ(plan.joints[1].name, "weight-right");
  EXPECT_EQ(plan.joints[0].node, plan.joints[1].node);
  EXPECT_NE(plan.joints[1].node, plan.joints[2].node);
  for (const PlannedJoint& j : plan.joints) {
    EXPECT_EQ(j.N, unlimited);
    EXPECT_EQ(j.Q, unlimited);
    EXPECT_EQ(j.M, 0);
    EXPECT_EQ(j.M_reverse, 0);
  }
}

TEST(Node, ThatIsGivenAStiffnessAgainstTurningIsNoPin) {
  SceneDef scene = hanger();
  scene.joints[1].overrides.stiffness_moment = 3e5;
  scene.joints[2].overrides.stiffness_moment = unlimited;
  scene.joints[2].overrides.moment = 2e4;
  const Plan plan = calibrate(scene);
  ASSERT_EQ(plan.joints.size(), 4u);
  EXPECT_EQ(plan.joints[0].M, 0);
  EXPECT_EQ(plan.joints[2].M, unlimited);
  EXPECT_EQ(plan.joints[2].M_reverse, unlimited);
  EXPECT_EQ(plan.joints[2].stiffness.M, 3e5);
  EXPECT_EQ(plan.joints[3].M, 2e4);
  EXPECT_EQ(plan.joints[3].M_reverse, 2e4);
  EXPECT_EQ(plan.joints[3].stiffness.M, unlimited);
}

TEST(Node, CarriesWhatStaticsSays) {
  b2World world({0, 0});
  const Plan plan = calibrate(hanger());
  Built built;
  Structure structure = build(world, plan, {}, &built);
  world.SetAllowSleeping(false);
  for (int i = 0; i < 300; ++i) {
    apply_loads(world, plan, built, i / 60.0);
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
  }
  // As in tests/joint/game_test.cpp; the bars' centres are in their middles.
  const double weight = 0.1 * 7800 * 10, bar = 2.6 * 0.1 * 0.01 * 7800 * 10;
  const double V = weight / 2, H = (1.5 * V + 0.75 * bar) / 2, tension = 0.8 * V + 0.6 * H;
  for (int i : {0, 1}) {
    const auto* joint = static_cast<const ElasticPlasticJoint*>(built.joints[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(joint->force(axial), tension, 1e-4 * tension) << i;
  }
  // They overlap there, and do not push each other away.
  for (const b2Contact* c = world.GetContactList(); c != nullptr; c = c->GetNext())
    EXPECT_FALSE(c->IsTouching());
  world.DestroyBody(built.bodies[1]);
  structure.update();
  EXPECT_EQ(structure.joints().size(), 3u);  // left to right, and both to the ceiling
}

TEST(Node, RefusesWhatItCannotBe) {
  const auto expect = [](const char* what, auto&& spoil) {
    SceneDef scene = hanger();
    spoil(scene.joints[0]);
    try {
      calibrate(scene);
      ADD_FAILURE() << what;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  expect("there is no body 'middle'", [](JointBetweenDef& j) { j.others = {"middle"}; });
  expect("joins 'left' to itself", [](JointBetweenDef& j) { j.others = {"left"}; });
  expect("joins 3 bodies where edges overlap", [](JointBetweenDef& j) { j.at.reset(); });
  expect("farther", [](JointBetweenDef& j) { j.at = Point{50, 0}; });
  expect("not finite", [](JointBetweenDef& j) { j.at = Point{unlimited, 0}; });
  expect("`gap`", [](JointBetweenDef& j) { j.gap = 1; });
}

// M_p = f_y b h²/4 of bars 0.2 m high: 70 kN m of one, half as much of the other; the third goes on beyond.
TEST(Node, WeldedIsAsStrongAsTheWeakerBarThatEndsThere) {
  const auto bar = [](const char* name, Point from, Point to, double depth) {
    const double L = length(to - from);
    return BodyDef{.name = name,
                   .outline = {rectangle(0, -0.1, L, 0.1), {}},
                   .material = test_steel,
                   .depth = depth,
                   .pieces = 4,
                   .at = from,
                   .angle = std::atan2(to.y - from.y, to.x - from.x)};
  };
  SceneDef scene;
  scene.bodies = {bar("strong", {-4, 0}, {0, 0}, 0.02), bar("weak", {0, 0}, {0, 4}, 0.01),
                  bar("long", {0, -4}, {0, 4.5}, 0.001)};
  scene.joints = {{.a = "strong", .b = "weak", .at = Point{0, 0}, .welded = true},
                  {.a = "strong", .b = "long", .at = Point{0, 0}, .welded = true}};
  const auto nodes = [&] {
    std::vector<PlannedJoint> joints;
    for (const PlannedJoint& j : calibrate(scene).joints)
      if (j.node != 0) joints.push_back(j);
    return joints;
  };
  const std::vector<PlannedJoint> joints = nodes();
  ASSERT_EQ(joints.size(), 2u);
  for (const double M : {joints[0].M, joints[0].M_reverse}) EXPECT_NEAR(M, 35e3, 35e3 * 1e-9);
  for (const double M : {joints[1].M, joints[1].M_reverse}) EXPECT_NEAR(M, 70e3, 70e3 * 1e-9);
  EXPECT_NEAR(joints[0].max_rotation, 0.2 * 0.2 / 0.1, 1e-9);  // ε_f L_p/y
  EXPECT_EQ(joints[0].N, unlimited);

  scene.joints[0].overrides.moment = 50e3;
  EXPECT_EQ(nodes()[0].M, 50e3);
  EXPECT_EQ(nodes()[0].M_reverse, 50e3);
  scene.joints[0] = {.a = "weak", .b = "long", .at = Point{0, 0}, .welded = true};
  EXPECT_NEAR(nodes()[0].M, 35e3, 35e3 * 1e-9);

  const auto expect = [&](const char* what, const SceneDef& refused) {
    try {
      calibrate(refused);
      ADD_FAILURE() << what;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  SceneDef whole = scene;
  whole.bodies[1].pieces = 1;
  expect("is welded where neither body ends", whole);
  SceneDef touching = scene;
  touching.joints[0].at.reset();
  expect("is `welded` and no node", touching);
  SceneDef driven = scene;
  driven.joints[0].drive = DriveDef{.row = rotation, .speed = 0};
  expect("cap beside that of its drive", driven);
}

/// A bar 0.2 m high of four pieces, or of one.
BodyDef bar_between(const char* name, Point from, Point to, double depth, int pieces = 4) {
  return {.name = name,
          .outline = {rectangle(0, -0.1, length(to - from), 0.1), {}},
          .material = test_steel,
          .depth = depth,
          .pieces = pieces,
          .at = from,
          .angle = std::atan2(to.y - from.y, to.x - from.x)};
}

/// Of a node that joins the first body to the second with a cap of 10 kN along its axis.
PlannedJoint node_of(const BodyDef& first, const BodyDef& second) {
  SceneDef scene;
  scene.bodies = {first, second};
  const bool pinned = first.name == "whole" || second.name == "whole";  // no joint to be as strong as
  scene.joints = {{.a = first.name, .b = second.name, .at = Point{0, 0}, .welded = !pinned}};
  scene.joints[0].overrides.axial = 10e3;
  return calibrate(scene).joints.back();
}

// N is force along the axis, Q across it. So they mean the same of a node whichever of its two bodies is
// named first: along the bar that ends there, of two such bars along the weaker one, else across their mitre.
TEST(Node, ItsAxisDoesNotDependOnWhichBodyIsNamedFirst) {
  const double diagonal = std::sqrt(0.5);
  const BodyDef weak = bar_between("weak", {0, 0}, {0, 4}, 0.01),
                girder = bar_between("girder", {-4.5, 0}, {4, 0}, 0.02),
                strong = bar_between("strong", {-4, 0}, {0, 0}, 0.02),
                alike = bar_between("alike", {-4, 0}, {0, 0}, 0.01),
                whole = bar_between("whole", {0, 0}, {0, 4}, 0.01, 1),
                beam = bar_between("beam", {-4.5, 0}, {4, 0}, 0.02, 1);
  BodyDef slab{.name = "slab", .type = BodyType::static_body, .outline = {rectangle(-9, -1, 1, 0), {}}};
  BodyDef block{.name = "block", .outline = {rectangle(-2, -2, 0, 0), {}}, .material = test_steel};
  BodyDef wheel{.name = "wheel", .material = test_steel};
  wheel.circle = 0.5;
  wheel.at = {0.3, 0};
  struct Case {
    const char* what;
    BodyDef one, two;
    Point axis;  // from one to two
  };
  for (const Case& c :
       {Case{"a post on a girder", girder, weak, {0, 1}}, Case{"a corner", strong, weak, {0, 1}},
        Case{"a mitre of equals", alike, weak, {diagonal, diagonal}}, Case{"on a slab", slab, weak, {0, 1}},
        Case{"of one piece", girder, whole, {0, 1}}, Case{"two of one piece", beam, whole, {0, 1}},
        Case{"on a block", block, whole, {0, 1}}, Case{"on a wheel", wheel, weak, {0, 1}}}) {
    const PlannedJoint there = node_of(c.one, c.two), back = node_of(c.two, c.one);
    EXPECT_NEAR(there.axis.x, c.axis.x, 1e-12) << c.what;
    EXPECT_NEAR(there.axis.y, c.axis.y, 1e-12) << c.what;
    EXPECT_NEAR(back.axis.x, -c.axis.x, 1e-12) << c.what;
    EXPECT_NEAR(back.axis.y, -c.axis.y, 1e-12) << c.what;
    EXPECT_EQ(there.N, back.N) << c.what;
    EXPECT_EQ(there.Q, back.Q) << c.what;
    EXPECT_EQ(there.M, back.M_reverse) << c.what;
    EXPECT_EQ(there.M_reverse, back.M) << c.what;
    EXPECT_EQ(there.stiffness.M, back.stiffness.M) << c.what;
    EXPECT_EQ(there.max_rotation, back.max_rotation) << c.what;
  }
}

TEST(Build, IntoAStructureThatIsThere) {
  b2World world({0, -10});
  Structure structure(world);
  const Plan plan = calibrate(cantilever(4));
  const Built first = build(structure, world, plan), second = build(*Structure::of(world), world, plan);
  EXPECT_EQ(structure.joints().size(), 8u);
  EXPECT_EQ(first.joints.size(), 4u);
  EXPECT_NE(first.bodies[1], second.bodies[1]);
  // Bars between the two, as a game adds them: no structure refuses the other's.
  EXPECT_EQ(structure.pin({20, 0.5f}, {first.bodies.back(), second.bodies.back()}).size(), 1u);
  b2World other({0, -10});
  EXPECT_THROW(build(structure, other, plan), std::invalid_argument);
  EXPECT_EQ(other.GetBodyCount(), 0);
}

TEST(Build, KeepsTheNodesOfTwoPlansApart) {
  b2World world({0, -10});
  Structure structure(world);
  const Plan plan = calibrate(hanger());
  const Built first = build(structure, world, plan), second = build(structure, world, plan);
  world.DestroyBody(first.bodies[1]);
  world.DestroyBody(second.bodies[1]);
  structure.update();
  ASSERT_EQ(structure.joints().size(), 6u);
  for (ElasticPlasticJoint* joint : structure.joints()) {
    const auto in = [&](const Built& built, b2Body* body) {
      return std::find(built.bodies.begin(), built.bodies.end(), body) != built.bodies.end();
    };
    EXPECT_EQ(in(first, joint->GetBodyA()), in(first, joint->GetBodyB()));
  }
}

}  // namespace
}  // namespace ductile
