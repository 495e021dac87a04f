// What a game does with a structure: levels that come and go, nodes of several bars, handlers that misbehave,
// events to hear and to see.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

constexpr float dt = 1.0f / 60;

void run(b2World& world, Structure& structure, double seconds) {
  for (int i = 0; i < std::lround(seconds / dt); ++i) {
    world.Step(dt, 8, 3);
    structure.update();
  }
}

ElasticPlasticJoint* weld(Structure& structure, b2Body* a, b2Body* b, b2Vec2 at) {
  ElasticPlasticJointDef def;
  def.Initialize(a, b, at, {1, 0});
  return structure.create_joint(def);
}

// ---- Velocities that are no numbers

// A beam of four pieces of 1000 kg with a stone on its tip, and a box hung on it by a stock joint. What a
// game spoils stands still for a moment; all else goes on, and the beam comes back to rest with what statics
// say.
TEST(NoNumber, SetAsAVelocityStopsThatBodyAlone) {
  const float nan = std::nanf(""), inf = INFINITY;
  const std::function<void(std::vector<b2Body*>&)> spoilers[] = {
      [&](auto& b) {
        b[2]->SetLinearVelocity({nan, 0});
      },
      [&](auto& b) {
        b[2]->SetLinearVelocity({0, inf});
      },
      [&](auto& b) { b[4]->SetAngularVelocity(nan); },
      [&](auto& b) {
        b[5]->SetLinearVelocity({0, nan});
      },
      [&](auto& b) {
        b[3]->ApplyForceToCenter({nan, nan}, true);
      },
      [&](auto& b) {
        b[4]->ApplyLinearImpulseToCenter({inf, 0}, true);
      }};
  for (const SolverKind kind : {SolverKind::direct, SolverKind::iterative})
    for (const auto& spoil : spoilers) {
      b2World world({0, -10});
      world.SetAllowSleeping(false);
      Structure structure(world, {.solver = kind, .keep_ledger = kind == SolverKind::direct});
      std::vector<b2Body*> bodies{add_box(world, {.type = b2_staticBody})};
      for (int i = 1; i <= 4; ++i) {
        bodies.push_back(add_box(world, {.x = static_cast<double>(i)}));
        weld(structure, bodies[bodies.size() - 2], bodies.back(), {static_cast<float>(i) - 0.5f, 0});
      }
      bodies.push_back(add_box(world, {.x = 4, .y = 1, .mass = 500, .group = 0}));
      bodies.push_back(add_box(world, {.x = 2, .y = -2, .mass = 300, .group = 0}));
      b2RevoluteJointDef hung;
      hung.Initialize(bodies[2], bodies[6], {2, -1});
      world.CreateJoint(&hung);
      run(world, structure, 1);
      EXPECT_TRUE(structure.warnings().empty());
      spoil(bodies);
      for (int i = 0; i < 300; ++i) {
        world.Step(dt, 8, 3);
        for (const b2Body* body : bodies) {
          ASSERT_TRUE(body->GetPosition().IsValid() && body->GetLinearVelocity().IsValid());
          ASSERT_TRUE(b2IsValid(body->GetAngle()) && b2IsValid(body->GetAngularVelocity()));
        }
        structure.update();
      }
      ASSERT_EQ(structure.warnings().size(), 1u);
      EXPECT_NE(structure.warnings()[0].find("1 times the velocity of a body was not a finite number"),
                std::string::npos)
          << structure.warnings()[0];
      if (kind == SolverKind::iterative) continue;
      const double moment = -10 * (1000 * (0.5 + 1.5 + 2.5 + 3.5) + 500 * 3.5 + 300 * 1.5);
      EXPECT_NEAR(structure.joints()[0]->force(rotation), moment, 1e-3 * -moment);
      EXPECT_TRUE(std::isfinite(structure.energy().elastic + structure.energy().numerical));
    }
}

// ---- Levels

TEST(Level, IsClearedByDestroyingAllBodies) {
  b2World world({0, -10});
  Structure structure(world);
  for (int round = 0; round < 20; ++round) {
    b2Body* wall = add_box(world, {.type = b2_staticBody});
    b2Body* box = add_box(world, {.x = 1});
    const ElasticPlasticJoint* joint = weld(structure, wall, box, {0.5f, 0});
    run(world, structure, 0.5);
    EXPECT_NEAR(joint->force(rotation), -10 * 1000 * 0.5, 0.01) << round;
    EXPECT_EQ(Structure::of(world), &structure);
    if (round % 2 == 0) {
      while (world.GetBodyCount() > 0) world.DestroyBody(world.GetBodyList());
    } else {
      for (b2Body *b = world.GetBodyList(), *next; b != nullptr; b = next) {
        next = b->GetNext();
        world.DestroyBody(b);
      }
    }
    EXPECT_EQ(world.GetBodyCount(), 0);
    EXPECT_EQ(world.GetJointCount(), 0);
    EXPECT_TRUE(structure.joints().empty());
    EXPECT_EQ(structure.world(), nullptr);
    structure.update();
  }
}

TEST(Level, MayGoWithItsWorldAfterItWasCleared) {
  auto world = std::make_unique<b2World>(b2Vec2{0, -10});
  Structure structure(*world);
  weld(structure, add_box(*world, {.type = b2_staticBody}), add_box(*world, {.x = 1}), {0.5f, 0});
  while (world->GetBodyCount() > 0) world->DestroyBody(world->GetBodyList());
  world.reset();
  structure.update();
  b2World next({0, -10});
  ElasticPlasticJointDef def;
  def.Initialize(add_box(next, {.type = b2_staticBody}), add_box(next, {.x = 1}), {0.5f, 0});
  structure = Structure(next);
  EXPECT_NE(structure.create_joint(def), nullptr);
}

TEST(Watch, IsTheLastBodyAndKnown) {
  b2World world({0, -10});
  b2Body* before = add_box(world, {});
  Structure structure(world);
  b2Body* after = add_box(world, {.x = 3});
  const b2Body* last = world.GetBodyList();
  while (last->GetNext() != nullptr) last = last->GetNext();
  EXPECT_TRUE(Structure::is_watch(*last));
  EXPECT_FALSE(Structure::is_watch(*before));
  EXPECT_FALSE(Structure::is_watch(*after));
  EXPECT_EQ(last->GetType(), b2_staticBody);
  EXPECT_FALSE(last->IsEnabled());
  EXPECT_EQ(world.GetBodyCount(), 3);
}

// ---- Several structures, several worlds

TEST(Structures, OfOneWorldDoNotShareABody) {
  b2World world({0, -10});
  EXPECT_EQ(Structure::of(world), nullptr);
  Structure first(world), second(world);
  EXPECT_EQ(Structure::of(world), &first);
  b2Body *wall = add_box(world, {.type = b2_staticBody}), *a = add_box(world, {.x = 1}),
         *b = add_box(world, {.x = 2});
  weld(first, wall, a, {0.5f, 0});
  weld(second, wall, b, {0.5f, 0});  // a wall may carry both
  ElasticPlasticJointDef def;
  def.Initialize(a, b, {1.5f, 0});
  const auto problems = second.problems(def);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].find("bodyA has joints of another structure"), std::string::npos);
  EXPECT_THROW(second.create_joint(def), std::invalid_argument);
  EXPECT_EQ(first.problems(def).size(), 1u);  // b is the second's
  Structure moved = std::move(first);
  EXPECT_EQ(Structure::of(world), &moved);
}

TEST(Structures, RefuseBodiesOfOtherWorlds) {
  b2World here({0, -10}), there({0, -10});
  Structure structure(here);
  ElasticPlasticJointDef def;
  def.Initialize(add_box(here, {}), add_box(there, {.x = 1}), {0.5f, 0});
  ASSERT_EQ(structure.problems(def).size(), 1u);
  EXPECT_NE(structure.problems(def)[0].find("another world"), std::string::npos);
  EXPECT_THROW(structure.create_joint(def), std::invalid_argument);
  EXPECT_EQ(there.GetJointCount() + here.GetJointCount(), 0);
}

TEST(Structures, TellWhatIsWrongWithoutThrowing) {
  b2World world({0, -10});
  Structure structure(world);
  ElasticPlasticJointDef def;
  def.Initialize(add_box(world, {}), add_box(world, {.x = 1}), {0.5f, 0});
  EXPECT_TRUE(structure.problems(def).empty());
  def.max_slip = -1;
  def.rows[axial].cap = -1;
  EXPECT_EQ(structure.problems(def).size(), 2u);
  EXPECT_EQ(world.GetJointCount(), 0);
}

// ---- While the world is stepping

class InTheStep : public b2ContactListener {
 public:
  explicit InTheStep(std::function<void()> what) : what_(std::move(what)) {}
  void BeginContact(b2Contact*) override { what_(); }

 private:
  std::function<void()> what_;
};

TEST(InAContact, NothingIsMadeAndNothingTold) {
  b2World world({0, -10});
  Structure structure(world);
  b2Body* floor = add_box(world, {.width = 10, .type = b2_staticBody});
  b2Body* box = add_box(world, {.y = 1.01, .group = 0});
  ElasticPlasticJointDef def;
  def.Initialize(floor, box, {0, 0.5f});
  auto* stock = [&] {
    b2WeldJointDef stock_def;
    stock_def.Initialize(floor, add_box(world, {.x = 20}), {10, 0});
    return static_cast<b2WeldJoint*>(world.CreateJoint(&stock_def));
  }();
  int contacts = 0;
  InTheStep listener([&] {
    ++contacts;
    EXPECT_THROW(structure.create_joint(def), std::invalid_argument);
    EXPECT_THROW(structure.adopt(stock, {}), std::invalid_argument);
    EXPECT_THROW(structure.pin({0, 0.5f}, {floor, box}), std::invalid_argument);
    EXPECT_THROW(structure.update(), std::logic_error);
    EXPECT_THROW(Structure second(world), std::logic_error);
  });
  world.SetContactListener(&listener);
  run(world, structure, 0.5);
  EXPECT_EQ(contacts, 1);
  EXPECT_EQ(world.GetJointCount(), 1);
}

// ---- Handlers

struct Hanging {
  // A box on a wall whose joint yields at once and breaks after a while.
  Hanging() {
    ElasticPlasticJointDef def;
    def.Initialize(add_box(world, {.type = b2_staticBody}), add_box(world, {.x = 1}), {0.5f, 0}, {1, 0});
    def.rows[rotation].cap = def.rows[rotation].cap_reverse = 2e3;
    def.max_rotation = 0.3;
    structure.create_joint(def);
  }
  b2World world{{0, -10}};
  Structure structure{world};
};

TEST(Handlers, MayCallUpdateToNoEffect) {
  Hanging h;
  std::vector<JointEvent::Kind> kinds;
  h.structure.on_event([&](const JointEvent& e) {
    h.structure.update();
    kinds.push_back(e.kind);
    EXPECT_FALSE(h.structure.joints().empty());
  });
  run(h.world, h.structure, 2);
  EXPECT_EQ(kinds.front(), JointEvent::yield);
  EXPECT_EQ(kinds.back(), JointEvent::broke);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), JointEvent::broke), 1);
  EXPECT_TRUE(h.structure.joints().empty());
}

TEST(Handlers, MayThrowAndNoEventIsToldTwice) {
  Hanging quiet, loud;
  int told = 0, thrown = 0, caught = 0;
  quiet.structure.on_event([&](const JointEvent&) { ++told; });
  loud.structure.on_event([&](const JointEvent&) {
    ++thrown;
    throw std::runtime_error("the game's");
  });
  run(quiet.world, quiet.structure, 2);
  for (int i = 0; i < 120; ++i) {
    loud.world.Step(dt, 8, 3);
    try {
      loud.structure.update();
    } catch (const std::runtime_error&) {
      ++caught;
    }
  }
  EXPECT_GE(told, 3);
  EXPECT_EQ(thrown, told);
  EXPECT_EQ(caught, told);
  EXPECT_TRUE(loud.structure.joints().empty());
}

// ---- Events

TEST(Events, TellWhatIsSetFreeAndWhere) {
  // A bar of stiffness k is drawn out to its cap F and on until it breaks: F²/2k comes free.
  b2World world({0, 0});
  Structure structure(world);
  ElasticPlasticJointDef def;
  b2Body* box = add_box(world, {.x = 1});
  def.Initialize(add_box(world, {.type = b2_staticBody}), box, {0.5f, 0}, {1, 0});
  const double k = 1e6, F = 5e4;
  def.rows[axial] = {.stiffness = k, .cap = F, .cap_reverse = F};
  def.max_elongation = 0.1;
  structure.create_joint(def);
  std::vector<JointEvent> events;
  structure.on_event([&](const JointEvent& e) { events.push_back(e); });
  for (int i = 0; i < 300 && !structure.joints().empty(); ++i) {
    box->ApplyForceToCenter(vec(F * std::min(1.02, i / 60.0), 0), true);
    world.Step(dt, 8, 3);
    structure.update();
  }
  ASSERT_GE(events.size(), 3u);
  double worked = 0;
  for (const JointEvent& e : events) {
    EXPECT_EQ(e.mode, JointEvent::tension);
    EXPECT_NEAR(e.at.x, 0.5, 1e-6);
    EXPECT_NEAR(e.at.y, 0, 1e-6);
    EXPECT_EQ(e.released > 0, e.kind == JointEvent::broke);
    worked += e.worked;
    EXPECT_NEAR(worked, e.energy, 1e-9 * F);
  }
  EXPECT_EQ(events.back().kind, JointEvent::broke);
  EXPECT_NEAR(events.back().released, F * F / (2 * k), 1e-6 * F * F / k);
  EXPECT_GE(events.back().energy, F * 0.1);
}

// However fast a joint goes from yield to break, be it within one step in parts, the game hears of it before
// the joint is gone.
TEST(Events, TellOfABreakThatComesWithManyFlows) {
  for (double speed = 5.25; speed < 18; speed += 0.25) {
    b2World world({0, 0});
    Structure structure(world);
    b2Body* arm = add_box(world, {.x = 1, .width = 2, .height = 0.1, .mass = 157});
    ElasticPlasticJointDef def;
    def.Initialize(add_box(world, {.x = -0.5, .type = b2_staticBody}), arm, {0, 0}, {1, 0});
    def.rows[rotation].cap = def.rows[rotation].cap_reverse = 6250;
    def.max_rotation = 0.4;
    const ElasticPlasticJoint* joint = structure.create_joint(def);
    arm->SetLinearVelocity(vec(0, speed));
    arm->SetAngularVelocity(static_cast<float>(speed));
    int broke = 0;
    structure.on_event(
        [&](const JointEvent& e) { broke += e.kind == JointEvent::broke && e.joint == joint; });
    for (int i = 0; i < 30; ++i) {
      world.Step(1 / 30.0f, 8, 3);
      structure.update();
      ASSERT_EQ(structure.joints().size(), broke == 0 ? 1u : 0u) << speed;
    }
    EXPECT_EQ(broke, 1) << speed;
  }
}

TEST(Joint, ThatYieldedWithoutALimitSaysSo) {
  Hanging h;
  h.structure.joints()[0]->set_limits(unlimited, unlimited, unlimited, unlimited);
  EXPECT_FALSE(h.structure.joints()[0]->yielded());
  run(h.world, h.structure, 1);
  EXPECT_TRUE(h.structure.joints()[0]->yielded());
  EXPECT_EQ(h.structure.joints()[0]->capacity_used(), 0);
  EXPECT_GE(h.structure.joints()[0]->stage(), 1);
}

// A level that begins with a bent bar: its state is what the game says, and no joule need be said with it.
TEST(Joint, OfAStateThatYieldedIsPastYieldInItsStage) {
  for (const double used : {0.0, 0.4}) {
    Hanging h;
    ElasticPlasticJointDef def = h.structure.joints()[0]->def();
    h.world.DestroyJoint(h.structure.joints()[0]);
    def.max_rotation = 0.5;
    def.state.back[rotation] = 0.5 * used;
    def.state.yielded = used == 0;
    EXPECT_EQ(h.structure.create_joint(def)->stage(), 1 + used);
  }
}

// A bar turned by a drive to 0.3 rad and back to -0.1 about a hinge that yields at 0.05 rad: it flows by 0.25
// rad, and by 0.4 rad less twice the 0.05 that it springs. Poses are floats: 1e-7 rad of 0.05 in each of
// three turns.
TEST(Ductility, IsTheSumOfPlasticTurnsInTurnsAtYield) {
  constexpr double k = 1e5, turn = 0.05, cap = k * turn;
  const std::vector<AxialMoment> hexagon{{2 * cap, 0},  {cap, cap},   {-cap, cap},
                                         {-2 * cap, 0}, {-cap, -cap}, {cap, -cap}};
  for (const auto& interaction : {std::vector<AxialMoment>{}, hexagon}) {
    b2World world({0, 0});
    Structure structure(world);
    b2Body *wall = add_box(world, {.type = b2_staticBody}), *bar = add_box(world, {.mass = 10});
    ElasticPlasticJointDef def;
    def.Initialize(wall, bar, {0, 0}, {1, 0});
    for (const Row row : {axial, shear}) def.rows[row] = RowDef::free();
    def.rows[rotation] = {.drive = Drive{}};
    ElasticPlasticJoint* motor = structure.create_joint(def);
    def.rows[axial] = def.rows[shear] = {};
    def.rows[rotation] = {.stiffness = k};
    def.interaction = interaction;
    if (interaction.empty()) def.rows[rotation].cap = def.rows[rotation].cap_reverse = cap;
    const ElasticPlasticJoint* hinge = structure.create_joint(def);
    const auto turn_to = [&](double angle) {
      motor->drive(rotation, {.target = angle, .speed = 1});
      run(world, structure, 1);
      ASSERT_NEAR(bar->GetAngle(), angle, 1e-7);
    };
    turn_to(0.99 * turn);
    EXPECT_EQ(hinge->ductility(), 0);
    turn_to(0.3);
    EXPECT_NEAR(hinge->ductility(), 0.25 / turn, 1e-5);
    turn_to(-0.1);
    EXPECT_NEAR(hinge->ductility(), (0.25 + 0.4 - 2 * turn) / turn, 1e-5);
    EXPECT_EQ(hinge->capacity_used(), 0);
  }
}

// ---- Nodes

/// A weight on two bars of no weight to speak of, 3 m apart on the ceiling and 2 m above it; all pinned.
struct Node {
  Node() {
    ceiling = add_box(world, {.y = 3, .width = 8, .type = b2_staticBody});
    for (const double side : {-1.5, 1.5}) {
      const double angle = std::atan2(-2, -side);
      bars.push_back(
          add_box(world, {.x = side / 2, .y = 1, .width = 2.5, .height = 0.1, .mass = 1, .angle = angle}));
      structure.pin(vec(side, 2), {ceiling, bars.back()});
    }
    weight = add_box(world, {.mass = 1000});
    world.SetAllowSleeping(false);
  }
  b2World world{{0, -10}};
  Structure structure{world};
  b2Body *ceiling, *weight;
  std::vector<b2Body*> bars;
};

TEST(Nodes, CarryWhatStaticsSays) {
  Node n;
  const auto joints = n.structure.pin({0, 0}, {n.weight, n.bars[0], n.bars[1]});
  ASSERT_EQ(joints.size(), 2u);
  run(n.world, n.structure, 5);
  // Moments about the ceiling's pin, 1.5 m aside and 2 m up: 2 H = 1.5 V + 0.75 w with V = W/2 and w the
  // bar's weight; along the bar 0.8 V + 0.6 H.
  const double V = 10000 / 2.0, H = (1.5 * V + 0.75 * 10) / 2, tension = 0.8 * V + 0.6 * H;
  for (const ElasticPlasticJoint* j : joints) {
    EXPECT_NEAR(j->force(axial), tension, 1e-5 * tension);
    EXPECT_EQ(j->force(rotation), 0);
  }
}

double distance(const b2Body* a, b2Vec2 local_a, const b2Body* b, b2Vec2 local_b) {
  return (a->GetWorldPoint(local_a) - b->GetWorldPoint(local_b)).Length();
}

TEST(Nodes, AreMadeAnewWhereTheHubGoes) {
  for (const bool replaced : {false, true}) {
    Node n;
    n.structure.pin({0, 0}, {n.weight, n.bars[0], n.bars[1]});
    const b2Vec2 end_0 = n.bars[0]->GetLocalPoint({0, 0}), end_1 = n.bars[1]->GetLocalPoint({0, 0});
    run(n.world, n.structure, 1);
    n.world.DestroyBody(n.weight);
    // Another body at the address of the one that went is no hub.
    if (replaced) {
      EXPECT_EQ(add_box(n.world, {.y = -10}), n.weight);
    }
    n.structure.update();
    EXPECT_EQ(n.structure.joints().size(), 3u);
    run(n.world, n.structure, 2);
    EXPECT_LT(distance(n.bars[0], end_0, n.bars[1], end_1), 1e-4) << replaced;
  }
}

TEST(Nodes, LoseABarThatGoes) {
  Node n;
  n.structure.pin({0, 0}, {n.weight, n.bars[0], n.bars[1]});
  run(n.world, n.structure, 1);
  n.world.DestroyBody(n.bars[0]);
  run(n.world, n.structure, 1);
  EXPECT_EQ(n.structure.joints().size(), 2u);  // the ceiling's and the weight's with the other bar
}

// Nor is a body joined with itself that hung on the hub by two joints of the node.
TEST(Nodes, LeaveNoBodyJoinedWithItself) {
  Node n;
  ElasticPlasticJointDef def;
  def.node = 7;
  for (b2Body* bar : {n.bars[1], n.bars[0], n.bars[0]}) {
    def.Initialize(n.weight, bar, {0, 0}, {1, 0});
    n.structure.create_joint(def);
  }
  n.world.DestroyBody(n.weight);
  run(n.world, n.structure, 1);
  ASSERT_EQ(n.structure.joints().size(), 3u);  // the ceiling's two, and that of the bars
  EXPECT_NE(n.structure.joints().back()->GetBodyA(), n.structure.joints().back()->GetBodyB());
}

TEST(Nodes, KeepWhatDoesNotBreak) {
  Node n;
  ElasticPlasticJointDef like;
  like.rows[rotation] = RowDef::free();
  like.rows[axial].cap = like.rows[axial].cap_reverse = 3000;
  like.max_compression = like.max_elongation = 0.01;
  n.structure.pin({0, 0}, {n.weight, n.bars[0]}, like);
  const auto strong = n.structure.pin({0, 0}, {n.weight, n.bars[1]});
  run(n.world, n.structure, 3);
  ASSERT_EQ(n.structure.joints().size(), 3u);
  EXPECT_EQ(n.structure.joints().back(), strong[0]);
}

TEST(Nodes, ComeBackWithASnapshot) {
  Node n;
  n.structure.pin({0, 0}, {n.weight, n.bars[0], n.bars[1]});
  run(n.world, n.structure, 1);
  Snapshot before;
  before.save(n.world);
  n.world.DestroyBody(n.weight);
  n.structure.update();
  before.restore(n.world);
  EXPECT_EQ(n.structure.joints().size(), 4u);
  n.world.DestroyBody(n.weight);
  n.structure.update();
  EXPECT_EQ(n.structure.joints().size(), 3u);
}

TEST(Nodes, RefuseWhatMakesNone) {
  Node n;
  EXPECT_THROW(n.structure.pin({0, 0}, {n.weight}), std::invalid_argument);
  EXPECT_THROW(n.structure.pin({0, 0}, {n.weight, nullptr}), std::invalid_argument);
  EXPECT_THROW(n.structure.pin({0, 0}, {n.weight, n.bars[0], n.bars[0]}), std::invalid_argument);
  EXPECT_EQ(n.structure.joints().size(), 2u);
}

}  // namespace
}  // namespace ductile
