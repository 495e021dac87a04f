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
