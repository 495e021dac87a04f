// A saved world, loaded into another one, runs on as the one that was saved: to the bit.
#include "ductile/save.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "eventful.h"

namespace ductile {
namespace {

using eventful::Kind;
using eventful::kinds;
using eventful::Scene;

class Saves : public testing::TestWithParam<std::size_t> {};

TEST_P(Saves, RunOnAsTheWorldDid) {
  const Kind& kind = kinds[GetParam()];
  Scene scene;
  kind.build(scene);
  scene.run(kind.until_save);
  const std::vector<std::uint8_t> bytes = save_bytes(scene.structure);
  const std::string json = save_json(scene.structure);
  Scene of_bytes, of_json;
  of_bytes.before_step = scene.before_step;
  load_bytes(of_bytes.structure, bytes);
  load_json(of_json.structure, json);
  // What was loaded is what was saved, and saving changed nothing.
  EXPECT_TRUE(save_bytes(of_bytes.structure) == bytes);
  EXPECT_TRUE(save_json(of_json.structure) == json);
  of_bytes.step = kind.until_save;
  const std::uint64_t loaded = of_bytes.run(300);
  const std::size_t joints = scene.structure.joints().size();
  const std::uint64_t undisturbed = scene.run(300);
  EXPECT_EQ(loaded, undisturbed);
  EXPECT_EQ(scene.structure.joints().size() < joints, kind.breaks);
}

INSTANTIATE_TEST_SUITE_P(All, Saves, testing::Range(std::size_t{0}, kinds.size()),
                         [](const auto& info) { return kinds[info.param].name; });

// Both run on together, and are compared step by step.
void expect_same_future(Scene& scene, int steps) {
  Scene loaded({1, 2});
  load_json(loaded.structure, save_json(scene.structure));
  for (int i = 0; i < steps; ++i) ASSERT_EQ(loaded.run(1), scene.run(1)) << i;
}

template <class Def>
Def between(Scene& s, int i, Def def = {}) {
  def.bodyA = add_box(s.world, {.x = 3.0 * i, .y = 3, .type = i % 3 == 0 ? b2_staticBody : b2_dynamicBody});
  def.bodyB = add_box(s.world, {.x = 3.0 * i + 1.2, .y = 3, .group = 0});
  def.collideConnected = i % 2 == 0;
  return def;
}

TEST(Save, HoldsStockJointsAndShapesOfAllKinds) {
  Scene s;
  b2World& w = s.world;
  auto revolute = between<b2RevoluteJointDef>(s, 0);
  revolute.enableMotor = true, revolute.motorSpeed = 1, revolute.maxMotorTorque = 9e3;
  b2Joint* first = w.CreateJoint(&revolute);
  auto prismatic = between<b2PrismaticJointDef>(s, 3);
  prismatic.localAxisA = {0.6f, 0.8f}, prismatic.enableLimit = true, prismatic.upperTranslation = 1;
  b2Joint* second = w.CreateJoint(&prismatic);
  b2GearJointDef gear;
  gear.bodyA = revolute.bodyB, gear.bodyB = prismatic.bodyB, gear.joint1 = first, gear.joint2 = second;
  gear.ratio = 0.3f;
  w.CreateJoint(&gear);
  auto distance = between<b2DistanceJointDef>(s, 2);
  distance.minLength = 1, distance.maxLength = 2, distance.stiffness = 1e4f;
  w.CreateJoint(&distance);
  auto pulley = between<b2PulleyJointDef>(s, 4);
  pulley.groundAnchorA = {12, 9}, pulley.groundAnchorB = {13, 9}, pulley.lengthA = pulley.lengthB = 6;
  w.CreateJoint(&pulley);
  auto mouse = between<b2MouseJointDef>(s, 5);
  mouse.target = {16, 3}, mouse.maxForce = 1e5f, mouse.stiffness = 1e4f;
  w.CreateJoint(&mouse);
  auto wheel = between<b2WheelJointDef>(s, 7);
  wheel.stiffness = 1e5f, wheel.damping = 1e3f;
  w.CreateJoint(&wheel);
  auto weld = between<b2WeldJointDef>(s, 6);
  weld.stiffness = 1e5f, weld.userData.pointer = 77;
  w.CreateJoint(&weld);
  auto friction = between<b2FrictionJointDef>(s, 8);
  friction.maxForce = 4e3f;
  w.CreateJoint(&friction);
  auto motor = between<b2MotorJointDef>(s, 10);
  motor.maxForce = 1e4f, motor.maxTorque = 1e4f, motor.linearOffset = {1, 0};
  w.CreateJoint(&motor);

  b2Body* ground = add_box(w, {.y = -9, .type = b2_staticBody, .group = 0});
  b2ChainShape chain;
  const b2Vec2 points[] = {{40, 5}, {20, 4.5f}, {-10, 5}};
  chain.CreateChain(points, 3, {50, 5}, {-20, 5});
  ground->CreateFixture(&chain, 0);
  b2EdgeShape edge;
  edge.SetTwoSided({-10, 2}, {-3, 5});
  ground->CreateFixture(&edge, 0);
  b2CircleShape circle;
  circle.m_radius = 0.4f;
  b2Body* ball = add_box(w, {.x = -5, .y = 2});
  ball->CreateFixture(&circle, 3)->SetSensor(true);
  ball->GetUserData().pointer = 42;
  add_box(w, {.x = -2, .y = 8, .type = b2_kinematicBody})->SetAngularVelocity(0.3f);
  add_box(w, {.x = 30, .y = 8})->SetEnabled(false);
  s.run(45);
  EXPECT_GT(w.GetContactCount(), 4);
  expect_same_future(s, 200);

  Scene loaded;
  load_bytes(loaded.structure, save_bytes(s.structure));
  int found = 0;
  for (const b2Joint* j = loaded.world.GetJointList(); j != nullptr; j = j->GetNext())
    found += const_cast<b2Joint*>(j)->GetUserData().pointer == 77;
  for (b2Body* b = loaded.world.GetBodyList(); b != nullptr; b = b->GetNext())
    found += b->GetUserData().pointer == 42;
  EXPECT_EQ(found, 2);
}

// Where a joint lies in memory that another one had, the same world is saved by the same bytes.
TEST(Save, OfTheSameWorldIsTheSame) {
  const auto saved = [](bool after_another, auto def) {
    Scene s({0, 0});
    def.bodyA = add_box(s.world, {.type = b2_staticBody}), def.bodyB = add_box(s.world, {.x = 2});
    b2DistanceJointDef another;  // slack
    another.Initialize(def.bodyA, def.bodyB, {1.3f, 1.3f}, {1.7f, 1.7f});
    another.minLength = 0.1f, another.maxLength = 9;
    b2Joint* joint = after_another ? s.world.CreateJoint(&another) : nullptr;
    s.run(1);
    if (joint != nullptr) s.world.DestroyJoint(joint);
    s.world.CreateJoint(&def);
    return save_bytes(s.structure);
  };
  const auto are_same = [&](const auto& def) { return saved(true, def) == saved(false, def); };
  EXPECT_TRUE(are_same(b2RevoluteJointDef()));
  EXPECT_TRUE(are_same(b2PrismaticJointDef()));
  EXPECT_TRUE(are_same(b2WheelJointDef()));
  EXPECT_TRUE(are_same(b2WeldJointDef()));
}

// What was edited since the last step, and what is in no island.
TEST(Save, BetweenEditsAndTheirStep) {
  Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 8, 2.4e5);
  s.run(25);
  s.structure.joints()[2]->set_caps(rotation, 3e5, 1e5);
  s.structure.joints()[5]->set_stiffness(rotation, 1e7, 0.1);
  {
    SCOPED_TRACE("edited");
    expect_same_future(s, 40);
  }
  const b2MassData heavy{3000, {0.1f, 0}, 2000};
  s.structure.joints()[3]->GetBodyB()->SetMassData(&heavy);
  {
    SCOPED_TRACE("another mass");
    expect_same_future(s, 40);
  }
  s.structure.joints()[6]->GetBodyB()->SetType(b2_staticBody);
  {
    SCOPED_TRACE("held");
    expect_same_future(s, 40);
  }
  s.world.DestroyBody(s.structure.joints()[4]->GetBodyB());
  {
    SCOPED_TRACE("a body less");
    expect_same_future(s, 40);
  }
}

// A guest that went keeps its place among the component's bodies until another one comes; so does one that is
// elsewhere. What lies on the beam yields it all the while.
TEST(Save, OfGuestsThatCameAndWent) {
  Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 8, 7e5, unlimited, 0);
  eventful::add_floor(s, -8);
  std::vector<b2Body*> guests;
  for (int i = 0; i < 4; ++i) guests.push_back(add_box(s.world, {.x = 2.0 + 1.5 * i, .y = 1.01, .group = 0}));
  guests[1]->GetFixtureList()->SetFriction(0);
  s.run(30);
  EXPECT_GT(s.structure.joints()[0]->dissipated(), 0);
  guests[2]->SetTransform({30, 0}, 0);
  s.run(2);
  s.world.DestroyBody(guests[0]);
  expect_same_future(s, 1);
  expect_same_future(s, 200);
  s.world.DestroyBody(guests[3]);
  add_box(s.world, {.x = 3, .y = 1.5, .mass = 500, .group = 0});
  expect_same_future(s, 200);
}

// Joints compare how their bodies come with how they were left, which a loaded world made anew knows as well.
TEST(Save, OfWhatTheGameHasJustStruck) {
  for (const double push : {0.3, 1.0, 2.0, 3.0, 5.0}) {
    SCOPED_TRACE(push);
    Scene s;
    s.add_row(eventful::add_wall(s), 0, 0, 0.75, 0, 8, 2e4);
    for (ElasticPlasticJoint* j : s.structure.joints()) {
      j->set_stiffness(axial, 1.2e7, 0.002);
      j->set_stiffness(rotation, 9e4, 0.002);
      j->set_caps(axial, 2.7e5, 2.7e5);
    }
    s.run(20);
    b2Body* piece = s.structure.joints()[4]->GetBodyB();
    piece->SetLinearVelocity(piece->GetLinearVelocity() + vec(push / 2, push));
    expect_same_future(s, 60);
  }
}

// A piece whose only joint leads to a disabled body meets what is fast, with another mass than when it was
// last solved or without having been solved, where it is loaded as where it is saved.
TEST(Save, OfPiecesWhoseJointsAreInNoStep) {
  for (const int solved : {0, 1}) {
    Scene s({0, 0});
    s.add_row(nullptr, 0, 0, 1, 0, 2);
    b2Body *piece = s.structure.joints()[0]->GetBodyA(), *other = s.structure.joints()[0]->GetBodyB();
    s.run(3 * solved);
    other->SetEnabled(false);
    b2MassData mass;
    piece->GetMassData(&mass);
    mass.mass *= 2, mass.I *= 2;
    piece->SetMassData(&mass);
    b2Body* ball = add_box(s.world, {.x = 0.3, .y = 2, .width = 0.1, .height = 0.1, .mass = 10, .group = 0});
    ball->SetLinearVelocity({0, -70});
    expect_saved(s, 3);
    expect_same_future(s, 3);
    EXPECT_GT(ball->GetPosition().y, 0.4f) << solved;
    EXPECT_GT(ball->GetLinearVelocity().y, -10) << solved;
  }
}

// A beam fell asleep as its last step was solved in parts. What slides down a ramp and comes upon it long
// after is no guest of that step.
TEST(Save, OfWhatSleepsAfterABlow) {
  Scene s({0, 0});
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 4, 3e5);
  b2Body* striker = add_box(s.world, {.x = 3, .y = 1.5, .group = 0});
  striker->SetLinearVelocity({0, -30});
  for (int i = 0; i < 10 && s.structure.report().divided == 0; ++i) s.run(1);
  ASSERT_GT(s.structure.report().divided, 0);
  s.world.DestroyBody(striker);
  for (ElasticPlasticJoint* j : s.structure.joints()) j->GetBodyB()->SetAwake(false);

  const double slope = -0.8;
  const auto on_ramp = [&](double along, double above) {
    return Box{.x = 1.5 + along * std::cos(slope) - above * std::sin(slope),
               .y = 1 + along * std::sin(slope) + above * std::cos(slope),
               .width = 2,
               .height = 0.5,
               .angle = slope,
               .group = 0,
               .friction = 0};
  };
  Box ramp = on_ramp(-4, -0.25);
  ramp.width = 8, ramp.type = b2_staticBody;
  add_box(s.world, ramp);
  b2Body* slides = add_box(s.world, on_ramp(-3, 0.25));
  slides->SetLinearVelocity(vec(30 * std::cos(slope), 30 * std::sin(slope)));
  expect_same_future(s, 20);
  EXPECT_TRUE(s.structure.joints()[1]->GetBodyB()->IsAwake());
}

// A free beam that something fast has just met went back with it, by so much that its pieces' places are
// rounded anew. In one of some fifty of these that changes a last bit of what its joints turn by.
TEST(Save, OfWhatWentBackWithAGuest) {
  int went = 0;
  for (int i = 41; i < 121; i += 2) {
    SCOPED_TRACE(i);
    Scene s;
    const double x = -3.1 + 0.07 * i, rise = 0.6 + 0.03 * i, length = std::hypot(5.3, rise);
    const b2Vec2 along = vec(5.3 / length, rise / length);
    b2Body* last = nullptr;
    for (int k = 0; k < 6; ++k) {
      const double l = length / 6, at = k * l, middle = at + l / 2;
      b2Body* piece = add_box(s.world, {.x = x + middle * along.x,
                                        .y = 2.3 + middle * along.y,
                                        .width = l,
                                        .height = 0.2,
                                        .mass = 800.0 / 6,
                                        .angle = std::atan2(rise, 5.3)});
      piece->SetLinearVelocity({1.3f, 0.7f});
      if (last != nullptr) {
        ElasticPlasticJointDef def;
        def.Initialize(last, piece, vec(x + at * along.x, 2.3 + at * along.y), along);
        for (const Row row : {axial, shear, rotation}) {
          def.rows[row].stiffness = (row == axial ? 3e8 : row == shear ? 1e8 : 1e6) / l;
          def.rows[row].damping = 0.05 * def.rows[row].stiffness;
        }
        def.rows[rotation].cap = def.rows[rotation].cap_reverse = 3e4;
        s.structure.create_joint(def);
      }
      last = piece;
    }
    b2Body* guest =
        add_box(s.world, {.x = x + 2.2, .y = 5.1, .width = 0.3, .height = 0.3, .mass = 3000, .group = 0});
    guest->SetLinearVelocity(vec(30, -50 - i));
    for (int k = 0; k < 10; ++k) {
      s.world.Step(1.0f / 60, 8, 3);
      const b2Vec2 before = last->GetPosition();
      s.structure.update();
      if (last->GetPosition() == before) continue;
      ++went;
      expect_same_future(s, 1);
    }
  }
  EXPECT_GT(went, 20);
}

// Its bodies are no contact yet, and become one in the next step.
TEST(Save, OfWhatHasJustBroken) {
  Scene s;
  eventful::add_floor(s, -6);
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 4, 4e4, 0.05, 0);
  const std::size_t joints = s.structure.joints().size();
  for (int i = 0; i < 100 && s.structure.joints().size() == joints; ++i) s.run(1);
  ASSERT_LT(s.structure.joints().size(), joints);
  const int contacts = s.world.GetContactCount();
  Snapshot now;
  now.save(s.world);
  const std::uint64_t ran_on = s.run(100);
  now.restore(s.world);
  EXPECT_EQ(s.run(100), ran_on);
  now.restore(s.world);
  expect_same_future(s, 100);
  now.restore(s.world);
  s.run(1);
  EXPECT_GT(s.world.GetContactCount(), contacts);
}

TEST(Save, HardenedAndOnAYieldSurfaceAndAdopted) {
  Scene s;
  b2Body* wall = eventful::add_wall(s);
  b2Body* beam = add_box(s.world, {.x = 2, .width = 4, .height = 0.5});
  b2WeldJointDef weld;
  weld.Initialize(wall, beam, {0, 0});
  auto* stock = static_cast<b2WeldJoint*>(s.world.CreateJoint(&weld));
  b2Body* tip = add_box(s.world, {.x = 6, .width = 4, .height = 0.5});
  ElasticPlasticJointDef def;
  def.Initialize(beam, tip, {4, 0});
  def.interaction = {{4e4, 0}, {0, 1.5e4}, {-4e4, 0}, {0, -1.5e4}};
  def.rows[shear].cap = def.rows[shear].cap_reverse = 1e5;
  s.structure.create_joint(def);
  ElasticPlasticJointDef hardens;
  hardens.Initialize(wall, beam, {0, 0});
  hardens.rows[rotation] = {
      .stiffness = 1e6, .damping_ratio = 0.1, .cap = 5e4, .cap_reverse = 5e4, .hardening = 2e5};
  s.structure.adopt(stock, hardens);
  s.run(60);
  ASSERT_GT(s.structure.joints()[1]->cap(rotation, true), 5.5e4);
  ASSERT_TRUE(s.structure.joints()[0]->yielded());
  expect_same_future(s, 200);
}

TEST(Save, OfRopesAndWinches) {
  Scene s;
  b2Body* wall = eventful::add_wall(s);
  b2Body* load = add_box(s.world, {.x = 3, .y = -1});
  ElasticPlasticJointDef rope;
  rope.bodyA = wall, rope.bodyB = load;
  rope.line = true, rope.length = 4;
  rope.rows[axial] = RowDef::rope(1e6, 9e4);
  rope.rows[shear] = rope.rows[rotation] = RowDef::free();
  ElasticPlasticJoint* joint = s.structure.create_joint(rope);
  s.run(20);
  {
    SCOPED_TRACE("slack");
    expect_same_future(s, 60);
  }
  EXPECT_THROW(joint->set_caps(rotation, 1, 1), std::invalid_argument);  // of a line
  joint->set_caps(axial, 0, 0);
  {
    SCOPED_TRACE("let go");
    expect_same_future(s, 5);
  }
  joint->set_caps(axial, 9e4, 0);
  joint->drive(axial, {.target = 2, .speed = 0.5});
  s.run(20);
  {
    SCOPED_TRACE("wound up");
    expect_same_future(s, 60);
  }
}

// A weight that whirls on a winch, the faster the shorter that is, is looked at after each step, and runs on
// as one that is not.
TEST(Save, AndLookingChangeNothing) {
  Scene looked_at, left_alone;
  for (Scene* s : {&looked_at, &left_alone}) {
    ElasticPlasticJointDef rope;
    b2Body* weight = add_box(s->world, {.x = 3});
    weight->SetLinearVelocity({0, -9});
    rope.InitializeLine(eventful::add_wall(*s), weight, {0, 0}, {3, 0});
    rope.rows[axial] = RowDef::rope();
    s->structure.create_joint(rope)->drive(axial, {.target = 0.5, .speed = 2});
  }
  for (int i = 0; i < 200; ++i) {
    ElasticPlasticJoint* joint = looked_at.structure.joints()[0];
    if (i % 3 == 0) joint->state();
    if (i % 3 == 1) joint->def();
    if (i % 3 == 2) save_bytes(looked_at.structure);
    ASSERT_EQ(looked_at.run(1), left_alone.run(1)) << i;
  }
}

// A motor carries on with a beam of boxes that collapses over it while a rope holds its end.
TEST(Save, OfMotorAndRopeInACollapse) {
  Scene s;
  eventful::add_floor(s, -3);
  b2Body* wall = eventful::add_wall(s);
  s.add_row(wall, 0, 0, 1, 0, 8, 2e5, 0.3, 0);
  ElasticPlasticJointDef rope;
  rope.bodyA = wall, rope.bodyB = s.structure.joints().back()->GetBodyB();
  rope.line = true;
  rope.rows[axial] = RowDef::rope(1e7, 9e4);
  rope.rows[shear] = rope.rows[rotation] = RowDef::free();
  rope.max_elongation = 0.5;
  s.structure.create_joint(rope);
  b2Body* hub = add_box(s.world, {.x = 12, .y = 0, .type = b2_staticBody});
  b2Body* wheel = add_box(s.world, {.x = 12, .y = 0, .width = 6, .height = 0.5, .group = 0});
  ElasticPlasticJointDef axle;
  axle.Initialize(hub, wheel, {12, 0}, {1, 0});
  axle.rows[rotation] = {.cap = 2e5, .cap_reverse = 2e5};
  axle.rows[rotation].drive = Drive{unlimited, 2};
  s.structure.create_joint(axle);
  const std::size_t joints = s.structure.joints().size();
  for (int i = 0; i < 6; ++i) {
    s.run(20);
    SCOPED_TRACE(i);
    expect_same_future(s, 10);
  }
  EXPECT_LT(s.structure.joints().size(), joints);
  expect_same_future(s, 300);
}

// Without the solver's past, the structure stands as it stood.
TEST(Save, OfAnotherVersionOfTheSolver) {
  Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 4);
  for (ElasticPlasticJoint* j : s.structure.joints()) j->set_stiffness(rotation, 1e7, 0.5);
  s.run(600);
  nlohmann::json document = nlohmann::json::parse(save_json(s.structure));
  document["past"] = 0;
  Scene loaded;
  load_json(loaded.structure, document.dump());
  loaded.run(1);
  for (std::size_t i = 0; i < 4; ++i) {
    const double m = s.structure.joints()[i]->force(rotation);
    EXPECT_NEAR(loaded.structure.joints()[i]->force(rotation), m, 1e-3 * std::abs(m));
  }
}

TEST(Save, IsRefusedWhereItCannotBe) {
  Scene s, full;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 3);
  s.run(3);
  const std::vector<std::uint8_t> bytes = save_bytes(s.structure);
  full.add_row(nullptr, 0, 0, 1, 0, 2);
  EXPECT_THROW(load_bytes(full.structure, bytes), std::logic_error);
  EXPECT_EQ(full.world.GetBodyCount(), 3);
  {
    Structure second(s.world);
    EXPECT_THROW(save_bytes(s.structure), std::logic_error);
  }
  s.world.Step(1 / 60.0f, 8, 3);
  EXPECT_THROW(save_bytes(s.structure), std::logic_error);  // the ledger is open
  s.structure.update();
  EXPECT_NO_THROW(save_bytes(s.structure));
  Scene empty;
  EXPECT_THROW(load_json(empty.structure, "{"), std::invalid_argument);
  const std::uint8_t too_many[] = {0xbb, 0x4c, 0, 0, 0,
                                   0,    0,    0, 0};  // CBOR: a map of 2^62 entries and more follows
  EXPECT_THROW(load_bytes(empty.structure, too_many), std::invalid_argument);
  try {
    load_json(empty.structure, R"({"ductile": 1, "past": 1})");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "save: structure: is not there");
  }
}

// What is refused names what cannot be, and the world goes on with the settings that it had.
TEST(Save, OfNumbersThatCannotBeIsRefused) {
  Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 3);
  s.run(3);
  const nlohmann::json good = nlohmann::json::parse(save_json(s.structure));
  struct Wrong {
    const char *list, *key;
    std::size_t number;
    nlohmann::json value;
  };
  for (const Wrong& w : {Wrong{"joints", "axis", 0, 5},
                         {"joints", "axis", 1, "inf"},
                         {"bodies", "transform", 2, 3},
                         {"bodies", "sweep", 0, "nan"},
                         {"bodies", "sweep", 6, "inf"},
                         {"bodies", "sweep", 8, 2},
                         {"bodies", "velocity", 2, "nan"},
                         {"bodies", "mass", 0, -1},
                         {"bodies", "mass", 3, "nan"}}) {
    nlohmann::json document = good;
    document[w.list][1][w.key][w.number] = w.value;
    document["world"]["gravity"] = {3, 4};
    document["world"]["warm_starting"] = false;
    Scene into;
    const b2Vec2 gravity = into.world.GetGravity();
    try {
      load_json(into.structure, document.dump());
      FAIL() << w.key << w.number;
    } catch (const std::invalid_argument& error) {
      const std::string place = "save: " + std::string(w.list) + "[1]." + w.key + ": ";
      EXPECT_EQ(std::string(error.what()).substr(0, place.size()), place);
    }
    EXPECT_EQ(into.world.GetGravity(), gravity);
    EXPECT_TRUE(into.world.GetWarmStarting());
  }
}

// A document of any content is loaded and can be stepped, or it is refused, and nothing is left of it.
// Returns whether it was refused.
bool is_refused_whole(const std::function<void(Scene&)>& load) {
  Scene loaded;
  bool refused = false;
  try {
    load(loaded);
  } catch (const std::invalid_argument&) {
    refused = true;
    EXPECT_EQ(loaded.world.GetBodyCount(), 1);
    EXPECT_EQ(loaded.world.GetJointCount(), 0);
    EXPECT_TRUE(loaded.structure.joints().empty());
    loaded.add_row(nullptr, 0, 0, 1, 0, 3);
  }
  loaded.run(2);
  return refused;
}

TEST(Save, OfNonsenseIsRefusedWhole) {
  Scene s;
  kinds.back().build(s);
  s.run(kinds.back().until_save);
  const std::string json = save_json(s.structure);
  const std::vector<std::uint8_t> bytes = save_bytes(s.structure);
  std::mt19937 random(7);
  int refused = 0;
  const auto attempt = [&refused](const auto& load) { refused += is_refused_whole(load); };
  for (int i = 0; i < 120; ++i) {
    std::string text = json;
    const std::size_t at = random() % text.size();
    switch (i % 4) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = "0123456789,[]{}\"-e."[random() % 19];
        break;
      default: {  // another number
        const std::size_t from = text.find_first_of("0123456789", at),
                          to = text.find_first_not_of("0123456789", from);
        if (to != std::string::npos)
          text.replace(from, to - from, std::to_string(static_cast<int>(random() % 40) - 3));
      }
    }
    attempt([&](Scene& into) { load_json(into.structure, text); });
    std::vector<std::uint8_t> mutated = bytes;
    mutated[random() % mutated.size()] = static_cast<std::uint8_t>(random());
    attempt([&](Scene& into) { load_bytes(into.structure, mutated); });
  }
  EXPECT_GT(refused, 60);
}

// A component's past holds the solver's own numbers. Where it ends early, or two joints claim the same
// inertia of tension, the component's lists do not fit each other.
TEST(Save, OfAPastThatIsCutOrChangedIsRefusedWhole) {
  Scene s;
  kinds.back().build(s);
  s.run(kinds.back().until_save);
  const auto document = nlohmann::json::parse(save_json(s.structure));
  const auto refuses = [](const nlohmann::json& other) {
    return is_refused_whole([&](Scene& into) { load_json(into.structure, other.dump()); });
  };
  int refused = 0, tried = 0;
  for (std::size_t c = 0; c < document["components"].size(); ++c) {
    const std::size_t numbers = document["components"][c]["past"].size();
    ASSERT_GT(numbers, 100u);
    for (std::size_t at = 0; at < numbers; ++at) {
      auto other = document;
      other["components"][c]["past"][at] = static_cast<int>(at % 5) - 1;
      refused += refuses(other);
      ++tried;
    }
    for (std::size_t at = 0; at < numbers; ++at) {  // counts
      auto other = document;
      auto& number = other["components"][c]["past"][at];
      const double value = number.is_number() ? number.get<double>() : 0;  // "inf" is text
      if (value < 1 || value > 1000 || value != std::floor(value)) continue;
      for (const double most : {0x1p31 - 1, 0x1p64}) {
        number = most;
        refused += refuses(other);
        ++tried;
      }
    }
    for (std::size_t at = 0; at < numbers; at += 20) {
      auto other = document;
      auto& past = other["components"][c]["past"];
      past.erase(past.begin() + static_cast<std::ptrdiff_t>(at), past.end());
      EXPECT_TRUE(refuses(other));
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, tried);
}

// A joint's own state: what a game keeps of a bent bar, and what it sets to repair it.
TEST(JointStates, AreTakenAlongAndRepaired) {
  Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 3, 4.5e4, 0.1);
  s.run(30);
  for (ElasticPlasticJoint* j : s.structure.joints()) {
    j->set_caps(rotation, 1e5, 1e5);
    j->set_stiffness(rotation, 1e8, 0.5);  // so that it comes to rest
  }
  s.run(600);
  ElasticPlasticJoint* root = s.structure.joints()[0];
  ASSERT_GT(root->capacity_used(), 0.05);
  const ElasticPlasticJointDef def = root->def();
  const double used = root->capacity_used(), moment = root->force(rotation);
  s.world.DestroyJoint(root);
  ElasticPlasticJoint* again = s.structure.create_joint(def);
  EXPECT_EQ(again->capacity_used(), used);
  EXPECT_EQ(again->plastic(rotation), def.state.plastic[rotation]);
  EXPECT_TRUE(again->yielded());
  s.run(1);
  EXPECT_NEAR(again->force(rotation), moment, 1e-3 * std::abs(moment));
  s.run(300);
  EXPECT_EQ(again->capacity_used(), used);  // nothing fell

  const float angle = again->GetBodyB()->GetAngle();
  JointState repaired = again->state();
  std::fill_n(repaired.back, 3, 0.0), std::fill_n(repaired.forward, 3, 0.0);
  again->set_state(repaired);
  EXPECT_EQ(again->capacity_used(), 0);
  s.run(60);
  EXPECT_NEAR(again->force(rotation), moment, 1e-3 * std::abs(moment));
  EXPECT_NEAR(again->GetBodyB()->GetAngle(), angle, 1e-5);
  repaired.forward[rotation] = -1;
  EXPECT_THROW(again->set_state(repaired), std::invalid_argument);
  ElasticPlasticJointDef wrong = def;
  wrong.state.elastic[axial] = unlimited;
  EXPECT_FALSE(s.structure.problems(wrong).empty());
}

}  // namespace
}  // namespace ductile
