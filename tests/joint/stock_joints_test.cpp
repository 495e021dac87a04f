// Box2D's own joints that hold a structure, against statics and the closed forms of rigid bodies.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "allocations.h"
#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

constexpr double gravity = 10;

// A deck of boxes in a row from the origin, 12 m and 3768 kg, rigid or of steel.
struct Deck {
  explicit Deck(int count = 12, double youngs_modulus = 0, double damping_time = 0.1)
      : world(vec(0, -gravity)), structure(world) {
    world.SetAllowSleeping(false);
    ground = add_box(world, {.x = -1, .type = b2_staticBody});
    const double l = length / count;
    for (int i = 0; i < count; ++i) {
      b2Body* piece =
          add_box(world, {.x = (i + 0.5) * l, .width = l, .height = height, .mass = mass / count});
      if (i > 0) {
        ElasticPlasticJointDef def;
        def.Initialize(pieces.back(), piece, vec(i * l, 0), {1, 0});
        if (youngs_modulus > 0) {
          const double E = youngs_modulus, A = 0.01, I = A * height * height / 4;  // a flange on each side
          def.rows[axial].stiffness = E * A / l;
          def.rows[shear].stiffness = E / 2.6 * A / l;
          def.rows[rotation].stiffness = E * I / l;
          for (RowDef& row : def.rows) row.damping = damping_time * row.stiffness;
        }
        joints.push_back(structure.create_joint(def));
      }
      pieces.push_back(piece);
    }
  }
  /// Welds the deck's root to the ground, or hinges it.
  ElasticPlasticJoint* fix(bool hinge) {
    ElasticPlasticJointDef def;
    def.Initialize(ground, pieces.front(), {0, 0}, {1, 0});
    if (hinge) def.rows[rotation] = RowDef::free();
    return structure.create_joint(def);
  }
  void run(double seconds, double hz = 60, int iterations = 8) {
    for (int i = 0; i < std::lround(seconds * hz); ++i) {
      world.Step(static_cast<float>(1 / hz), iterations, 3);
      EXPECT_EQ(structure.report().bounds_hit, 0);
      structure.update();
    }
  }
  /// Of the pieces' weights about the origin, where they are.
  double moment() const {
    double sum = 0;
    for (b2Body* piece : pieces) sum += piece->GetMass() * gravity * double{piece->GetWorldCenter().x};
    return sum;
  }
  template <class Def>
  auto* hold(Def def) {
    return world.CreateJoint(&def);
  }
  b2RevoluteJoint* motor(double torque, double speed = 0) {
    b2RevoluteJointDef def;
    def.Initialize(ground, pieces.front(), {0, 0});
    def.enableMotor = true;
    def.maxMotorTorque = static_cast<float>(torque);
    def.motorSpeed = static_cast<float>(speed);
    return static_cast<b2RevoluteJoint*>(hold(def));
  }
  static constexpr double length = 12, height = 0.2, mass = 3768, weight = mass * gravity;
  static constexpr double statics = weight * length / 2;         // moment about the root
  static constexpr double inertia = mass * length * length / 3;  // likewise
  b2World world;
  Structure structure;
  b2Body* ground;
  std::vector<b2Body*> pieces;
  std::vector<ElasticPlasticJoint*> joints;
};

struct Drive {
  int pieces, iterations;
  double hz, youngs_modulus;
};
class Motor : public testing::TestWithParam<Drive> {};

// Just above the static moment it holds, for 10 s, and tells that moment.
TEST_P(Motor, HoldsWhatStaticsAsks) {
  const Drive d = GetParam();
  Deck deck(d.pieces, d.youngs_modulus);
  b2RevoluteJoint* motor = deck.motor(d.youngs_modulus > 0 ? 3 * Deck::statics : 1.01 * Deck::statics);
  deck.run(10, d.hz, d.iterations);
  const auto hz = static_cast<float>(d.hz);
  EXPECT_NEAR(motor->GetJointAngle(), 0, 1e-4);
  EXPECT_NEAR(motor->GetMotorTorque(hz), deck.moment(), 1e-5 * Deck::statics);
  EXPECT_NEAR(motor->GetReactionForce(hz).y, Deck::weight, 1e-5 * Deck::weight);
  EXPECT_NEAR(motor->GetReactionForce(hz).x, 0, 1e-4 * Deck::weight);
  EXPECT_LT((motor->GetAnchorA() - motor->GetAnchorB()).Length(), 1e-5);
}

// Just below it sinks with what is missing: α = (M − T)/I.
TEST_P(Motor, SinksWithWhatIsMissing) {
  const Drive d = GetParam();
  if (d.youngs_modulus > 0) return;
  Deck deck(d.pieces);
  b2RevoluteJoint* motor = deck.motor(0.99 * Deck::statics);
  deck.run(1, d.hz, d.iterations);
  // Of pieces about their own centres: a box, not a rod.
  const double inertia = Deck::inertia + Deck::mass * Deck::height * Deck::height / 12;
  const double speed = -0.01 * Deck::statics / inertia;
  EXPECT_NEAR(motor->GetJointSpeed(), speed, 2e-3 * -speed);
  EXPECT_NEAR(motor->GetMotorTorque(static_cast<float>(d.hz)), 0.99 * Deck::statics, 1e-5 * Deck::statics);
}

TEST_P(Motor, RaisesAtItsSpeed) {
  const Drive d = GetParam();
  Deck deck(d.pieces, d.youngs_modulus);
  b2RevoluteJoint* motor = deck.motor(20 * Deck::statics, 0.2);
  deck.run(4, d.hz, d.iterations);
  EXPECT_NEAR(motor->GetJointAngle(), 0.8, 2e-3);
  EXPECT_LT((motor->GetAnchorA() - motor->GetAnchorB()).Length(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(OfDecks, Motor,
                         testing::Values(Drive{2, 8, 60, 0}, Drive{12, 8, 60, 0}, Drive{12, 1, 60, 0},
                                         Drive{12, 8, 30, 0}, Drive{12, 8, 120, 0}, Drive{48, 8, 60, 0},
                                         Drive{12, 8, 60, 210e9}, Drive{48, 8, 60, 210e9}),
                         [](const auto& info) {
                           const Drive& d = info.param;
                           return std::to_string(d.pieces) + "_pieces_" + std::to_string(std::lround(d.hz)) +
                                  "_Hz_" + std::to_string(d.iterations) +
                                  (d.youngs_modulus > 0 ? "_of_steel" : "_rigid");
                         });

// Gravity that sets in at once makes a deck swing by its own moment; a motor that holds does not damp that.
// What it carries is, in the mean of the swings, what statics asks; and all of the time once they have died
// away.
TEST(StockMotors, CarryADeckThatSwings) {
  const double lowest = 1.875 * 1.875 * std::sqrt(210e9 * 1e-4 * Deck::length / Deck::mass) /
                        (Deck::length * Deck::length);  // rad/s, of a clamped rod
  for (const double ratio : {0.001, 0.1}) {
    for (const int pieces : {4, 12, 24}) {
      Deck deck(pieces, 210e9, 2 * ratio / lowest);
      const b2RevoluteJoint* motor = deck.motor(9 * Deck::statics);
      deck.run(10);
      double sum = 0, farthest = 0;
      for (int i = 0; i < 1800; ++i) {
        deck.run(1.0 / 60);
        const double torque = motor->GetMotorTorque(60);
        sum += torque / 1800;
        farthest = std::max(farthest, std::abs(torque - Deck::statics));
      }
      EXPECT_NEAR(sum, Deck::statics, 0.01 * Deck::statics) << ratio << ", " << pieces;
      if (ratio > 0.01) {
        EXPECT_LT(farthest, 0.01 * Deck::statics) << pieces;
      } else {
        EXPECT_GT(farthest, 0.2 * Deck::statics) << pieces;
      }
      EXPECT_NEAR(motor->GetJointAngle(), 0, 1e-4);
    }
  }
}

// Falls to the limit and rests on it, as it was made or where the limit was moved to, and leaves it again.
TEST(StockLimits, CarryTheDeck) {
  Deck deck;
  b2RevoluteJointDef def;
  def.Initialize(deck.ground, deck.pieces.front(), {0, 0});
  def.enableLimit = true;
  def.lowerAngle = -0.3f;
  def.upperAngle = 0.5f;
  auto* hinge = static_cast<b2RevoluteJoint*>(deck.hold(def));
  deck.run(5);
  EXPECT_NEAR(hinge->GetJointAngle(), -0.3, 1e-5);
  EXPECT_NEAR(hinge->GetReactionTorque(60), deck.moment(), 1e-5 * Deck::statics);
  hinge->SetLimits(-0.6f, -0.4f);
  deck.run(5);
  EXPECT_NEAR(hinge->GetReactionTorque(60), deck.moment(), 1e-4 * Deck::statics);
  EXPECT_NEAR(hinge->GetJointAngle(), -0.6, 1e-4);
  hinge->EnableMotor(true);
  hinge->SetMaxMotorTorque(static_cast<float>(3 * Deck::statics));
  hinge->SetMotorSpeed(0.5f);
  deck.run(2);
  EXPECT_NEAR(hinge->GetJointAngle(), -0.4, 1e-4);
  EXPECT_NEAR(hinge->GetMotorTorque(60), 3 * Deck::statics, 1e-4 * Deck::statics);
  EXPECT_NEAR(hinge->GetReactionTorque(60), deck.moment(), 1e-4 * Deck::statics);
}

enum class Cord { rod, rope, spring };
class Hung : public testing::TestWithParam<std::tuple<Cord, double, double>> {};

b2DistanceJointDef cord(Cord kind, b2Body* a, b2Body* b, b2Vec2 at_a, b2Vec2 at_b) {
  b2DistanceJointDef def;
  def.Initialize(a, b, at_a, at_b);
  if (kind == Cord::rod) def.minLength = def.maxLength = def.length;
  if (kind == Cord::rope) def.minLength = 0, def.maxLength = def.length;
  if (kind == Cord::spring) def.stiffness = 1e6f, def.damping = 1e5f;
  return def;
}

// A hinged deck that hangs at its tip: half its weight in the cord, w l²/8 at midspan, along the deck what
// the cord's slope makes.
TEST_P(Hung, FromTheGround) {
  const auto [kind, slope, hz] = GetParam();
  Deck deck;
  ElasticPlasticJoint* root = deck.fix(true);
  const double rise = 6, back = slope * rise;
  auto* hung = static_cast<b2DistanceJoint*>(deck.hold(
      cord(kind, deck.ground, deck.pieces.back(), vec(Deck::length - back, rise), vec(Deck::length, 0))));
  deck.run(10, hz);
  const b2Vec2 force = hung->GetReactionForce(static_cast<float>(hz));
  const b2Vec2 along = deck.pieces.back()->GetWorldPoint(vec(0.5, 0));
  // Moments about the root, where the deck is.
  const double pull = -(along.x * double{force.y} - along.y * double{force.x});
  EXPECT_NEAR(-pull, deck.moment(), 1e-5 * Deck::statics);
  EXPECT_NEAR(root->force(rotation), 0, 1e-9 * Deck::statics);
  const double midspan = deck.joints[5]->force(rotation), lever = Deck::weight * Deck::length / 8;
  EXPECT_NEAR(std::abs(midspan), lever, (kind == Cord::spring ? 1e-3 : 1e-5) * lever);
  const double half = Deck::weight / 2;
  if (kind != Cord::spring) {
    EXPECT_NEAR(force.y, half, 1e-5 * half);
    EXPECT_NEAR(deck.joints[5]->force(axial), -slope * half, 1e-5 * half);
    EXPECT_NEAR(hung->GetCurrentLength(), hung->GetLength(), 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(ByCords, Hung,
                         testing::Combine(testing::Values(Cord::rod, Cord::rope, Cord::spring),
                                          testing::Values(0.0, 1.0), testing::Values(30.0, 60.0, 120.0)));

class Weights : public testing::TestWithParam<double> {};

// A weight of so many pieces on a rope from the tip of a cantilever, and another one below it.
TEST_P(Weights, HangFromTheTip) {
  Deck deck;
  ElasticPlasticJoint* root = deck.fix(false);
  const double piece = Deck::mass / 12, load = GetParam() * piece;
  b2Body *upper = add_box(deck.world, {.x = Deck::length - 0.5, .y = -3, .mass = load}),
         *lower = add_box(deck.world, {.x = Deck::length - 0.5, .y = -6, .mass = load / 3});
  auto* rope = static_cast<b2DistanceJoint*>(
      deck.hold(cord(Cord::rope, deck.pieces.back(), upper, vec(11.5, 0), vec(11.5, -2.5))));
  deck.hold(cord(Cord::rod, upper, lower, vec(11.5, -3.5), vec(11.5, -5.5)));
  deck.run(10);
  const double hung = gravity * load * 4 / 3;
  const double moment = deck.moment() + hung * upper->GetWorldCenter().x;
  EXPECT_NEAR(std::abs(root->force(rotation)), moment, 1e-5 * moment);
  EXPECT_NEAR(rope->GetReactionForce(60).y, hung, 1e-5 * hung);
  EXPECT_NEAR(rope->GetCurrentLength(), 2.5, 1e-5);
  EXPECT_LT(upper->GetLinearVelocity().Length(), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(OfPieces, Weights, testing::Values(1.0, 10.0, 100.0, 1000.0));

// A deck on two supports, hinge and roller of its own, and a car of stock wheel joints on it.
TEST(StockWheels, CarryACarOverADeck) {
  Deck deck;
  ElasticPlasticJoint* root = deck.fix(true);
  ElasticPlasticJointDef roller;
  roller.Initialize(deck.ground, deck.pieces.back(), vec(Deck::length, 0), {1, 0});
  roller.rows[axial] = roller.rows[rotation] = RowDef::free();
  ElasticPlasticJoint* end = deck.structure.create_joint(roller);
  const double chassis_mass = 20000, wheel_mass = 200, radius = 0.4;
  b2Body* chassis = add_box(deck.world, {.x = 4, .y = 1.1, .width = 4, .mass = chassis_mass});
  std::vector<b2WheelJoint*> axles;
  for (const double x : {2.5, 5.5}) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = vec(x, 0.1 + radius);
    b2Body* wheel = deck.world.CreateBody(&def);
    b2CircleShape circle;
    circle.m_radius = static_cast<float>(radius);
    b2FixtureDef fixture;
    fixture.shape = &circle;
    fixture.friction = 0.9f;
    fixture.density = static_cast<float>(wheel_mass / (b2_pi * radius * radius));
    wheel->CreateFixture(&fixture);
    b2WheelJointDef axle;
    axle.Initialize(chassis, wheel, wheel->GetPosition(), {0, 1});
    b2LinearStiffness(axle.stiffness, axle.damping, 4, 0.7f, chassis, wheel);
    axle.stiffness *= 50, axle.damping *= 50;  // for the chassis, not for the wheel
    axle.enableMotor = true;
    axle.maxMotorTorque = 1000;
    axles.push_back(static_cast<b2WheelJoint*>(deck.hold(axle)));
  }
  const double all = (chassis_mass + 2 * wheel_mass) * gravity;
  const auto expect_carried = [&] {
    // Moments about the root, and the sum.
    double moment = deck.moment() + chassis->GetMass() * gravity * chassis->GetWorldCenter().x;
    for (b2WheelJoint* axle : axles)
      moment += axle->GetBodyB()->GetMass() * gravity * axle->GetBodyB()->GetWorldCenter().x;
    EXPECT_NEAR(std::abs(end->force(shear)) * Deck::length, moment, 1e-4 * moment);
    EXPECT_NEAR(std::abs(root->force(shear)) + std::abs(end->force(shear)), all + Deck::weight,
                1e-4 * (all + Deck::weight));
    double on_axles = 0;
    for (b2WheelJoint* axle : axles) on_axles += std::abs(axle->GetReactionForce(60).y);
    EXPECT_NEAR(on_axles, chassis_mass * gravity, 1e-4 * all);
  };
  deck.run(6);
  expect_carried();
  // With all that its motors have: discs roll with half their mass more.
  for (b2WheelJoint* axle : axles) axle->SetMotorSpeed(-20);
  deck.run(1);
  const double thrust = 2 * 1000 / radius, speed = thrust / (chassis_mass + 3 * wheel_mass);
  EXPECT_NEAR(chassis->GetLinearVelocity().x, speed, 0.01 * speed);
  for (b2WheelJoint* axle : axles) axle->SetMotorSpeed(0);
  deck.run(6);
  EXPECT_GT(chassis->GetPosition().x, 4.1);
  expect_carried();
}

// Free in the air, the deck follows the mouse like one body; hinged, it hangs at the mouse's force.
TEST(StockMice, LiftWithNoMoreThanTheirForce) {
  for (const double share : {0.49, 0.51, 2.0}) {
    Deck deck;
    ElasticPlasticJoint* root = deck.fix(true);
    b2MouseJointDef def;
    def.bodyA = deck.ground;
    def.bodyB = deck.pieces.back();
    def.target = vec(Deck::length, 0);
    def.maxForce = static_cast<float>(share * Deck::weight);
    b2LinearStiffness(def.stiffness, def.damping, 5, 0.7f, def.bodyA, def.bodyB);
    def.stiffness *= 20, def.damping *= 20;  // for the deck
    auto* mouse = static_cast<b2MouseJoint*>(deck.hold(def));
    deck.run(share < 0.5 ? 0.5 : 5);
    const b2Vec2 force = mouse->GetReactionForce(60);
    EXPECT_LE(force.Length(), 1.0001 * share * Deck::weight);
    if (share < 0.5) {
      EXPECT_NEAR(force.y, share * Deck::weight, 1e-3 * Deck::weight);
      EXPECT_LT(deck.pieces.back()->GetLinearVelocity().y, -0.05);
    } else {
      const b2Vec2 at = deck.pieces.back()->GetWorldPoint(vec(0.5, 0));
      const double pull = double{at.x} * force.y - double{at.y} * force.x;
      EXPECT_NEAR(pull, deck.moment(), 1e-4 * Deck::statics);
      EXPECT_NEAR(root->force(rotation), 0, 1e-9 * Deck::statics);
    }
  }
}

// In all directions: momentum is force times time.
TEST(StockMice, PullAlike) {
  for (const double angle : {0.0, 0.3, 0.785, 1.2, 2.5, -2.0}) {
    Deck deck;
    deck.world.SetGravity({0, 0});
    const double most = 1000;
    b2MouseJointDef def;
    def.bodyA = deck.ground;
    def.bodyB = deck.pieces[6];
    def.target = vec(Deck::length / 2, 0);
    def.maxForce = static_cast<float>(most);
    b2LinearStiffness(def.stiffness, def.damping, 5, 0.7f, def.bodyA, def.bodyB);
    auto* mouse = static_cast<b2MouseJoint*>(deck.hold(def));
    mouse->SetTarget(vec(Deck::length / 2 + 90 * std::cos(angle), 90 * std::sin(angle)));
    deck.run(1);
    double x = 0, y = 0;
    for (const b2Body* piece : deck.pieces) {
      x += piece->GetMass() * double{piece->GetLinearVelocity().x};
      y += piece->GetMass() * double{piece->GetLinearVelocity().y};
    }
    EXPECT_NEAR(x, most * std::cos(angle), 0.01 * most) << angle;
    EXPECT_NEAR(y, most * std::sin(angle), 0.01 * most) << angle;
    EXPECT_NEAR(mouse->GetReactionForce(60).Length(), most, 1e-3 * most);
  }
}

// A table that a stock slider with a motor lifts: held at its own end.
TEST(StockSliders, LiftADeck) {
  Deck deck;
  b2PrismaticJointDef def;
  def.Initialize(deck.ground, deck.pieces.front(), {0, 0}, {0, 1});
  def.enableMotor = true;
  def.maxMotorForce = static_cast<float>(1.01 * Deck::weight);
  def.enableLimit = true;
  def.lowerTranslation = -0.5f;
  def.upperTranslation = 2;
  auto* slider = static_cast<b2PrismaticJoint*>(deck.hold(def));
  deck.run(5);
  EXPECT_NEAR(slider->GetJointTranslation(), 0, 1e-5);
  EXPECT_NEAR(slider->GetMotorForce(60), Deck::weight, 1e-5 * Deck::weight);
  EXPECT_NEAR(slider->GetReactionTorque(60), deck.moment(), 1e-5 * Deck::statics);
  slider->SetMotorSpeed(1);
  deck.run(1);  // with 1 % of its weight in hand: a = g/100
  EXPECT_NEAR(slider->GetJointTranslation(), 0.01 * gravity / 2, 3e-3);
  slider->SetMaxMotorForce(static_cast<float>(2 * Deck::weight));
  deck.run(4);
  EXPECT_NEAR(slider->GetJointTranslation(), 2, 1e-5);
  EXPECT_NEAR(slider->GetMotorForce(60), 2 * Deck::weight, 1e-4 * Deck::weight);
  EXPECT_NEAR(slider->GetReactionForce(60).y, Deck::weight, 1e-4 * Deck::weight);
  slider->EnableMotor(false);
  deck.run(3);
  EXPECT_NEAR(slider->GetJointTranslation(), -0.5, 1e-5);
  EXPECT_NEAR(slider->GetReactionForce(60).y, Deck::weight, 1e-4 * Deck::weight);
}

// A counterweight over a pulley of ratio 2 holds the tip of a hinged deck.
TEST(StockPulleys, HoldWithACounterweight) {
  for (const double share : {1.0, 1.02}) {
    Deck deck;
    deck.fix(true);
    // Tension T on the counterweight, ratio · T on the deck.
    b2Body* weight = add_box(deck.world, {.x = 15, .y = 0, .mass = share * Deck::mass / 4});
    b2PulleyJointDef def;
    def.Initialize(weight, deck.pieces.back(), vec(15, 6), vec(Deck::length, 6), vec(15, 0.5),
                   vec(Deck::length, 0), 2);
    auto* pulley = static_cast<b2PulleyJoint*>(deck.hold(def));
    deck.run(0.25);
    const double made = 0.25 * (1 - 1 / share) * weight->GetMass() * gravity;
    // At rest, or with what is in excess: the tip moves by ½ of the weight.
    const double inert = weight->GetMass() + Deck::inertia / (4 * Deck::length * Deck::length);
    EXPECT_NEAR(-weight->GetLinearVelocity().y, made / inert, 5e-3 * made / inert + 1e-5);
    EXPECT_NEAR(pulley->GetCurrentLengthA() + 2 * pulley->GetCurrentLengthB(),
                pulley->GetLengthA() + 2 * pulley->GetLengthB(), 1e-4);
  }
}

// A stock weld at the root is the root of a cantilever.
TEST(StockWelds, HoldADeck) {
  Deck deck;
  b2WeldJointDef def;
  def.Initialize(deck.ground, deck.pieces.front(), {0, 0});
  auto* weld = static_cast<b2WeldJoint*>(deck.hold(def));
  deck.run(5);
  EXPECT_NEAR(weld->GetReactionTorque(60), deck.moment(), 1e-6 * Deck::statics);
  EXPECT_NEAR(weld->GetReactionForce(60).y, Deck::weight, 1e-6 * Deck::weight);
}

// What a structure leaves when it goes is such a weld.
TEST(StockWelds, ThatAStructureLeftHoldADeck) {
  b2World world(vec(0, -gravity));
  world.SetAllowSleeping(false);
  std::vector<b2Body*> bodies{add_box(world, {.x = -0.5, .type = b2_staticBody})};
  const auto join = [&bodies](Structure& structure, float x) {
    ElasticPlasticJointDef def;
    def.Initialize(bodies.rbegin()[1], bodies.back(), vec(x, 0), {1, 0});
    return structure.create_joint(def);
  };
  constexpr int n = 4;
  bodies.push_back(add_box(world, {.x = 0.5}));
  b2Joint* root = nullptr;
  {
    Structure gone(world);
    root = join(gone, 0);
  }
  Structure structure(world);
  for (int i = 1; i < n; ++i) {
    bodies.push_back(add_box(world, {.x = 0.5 + i}));
    join(structure, static_cast<float>(i));
  }
  for (int i = 0; i < 300; ++i) world.Step(1 / 60.0f, 8, 3);
  const double weight = n * bodies.back()->GetMass() * gravity;
  EXPECT_NEAR(root->GetReactionForce(60).y, weight, 1e-6 * weight);
  EXPECT_NEAR(root->GetReactionTorque(60), weight * n / 2, 1e-6 * weight * n / 2);
}

// A hanger of 5 kg bears the far end of a deck on a pin: on a ground of its own, or on that which holds the
// deck, as most games have but one.
TEST(StockJoints, MayHangOnTheBodyThatHoldsTheStructure) {
  for (const bool same : {true, false}) {
    Beam beam({.pieces = 9, .length = 9, .height = 0.3, .density = 100 / 0.3});
    beam.joints[0]->set_caps(rotation, 0, 0);
    b2BodyDef ground;
    b2Body* above = same ? beam.wall : beam.world.CreateBody(&ground);
    b2Body* hanger =
        add_box(beam.world, {.x = 8.5, .y = 1, .width = 0.2, .height = 2, .mass = 5, .group = 0});
    b2RevoluteJointDef pin;
    pin.Initialize(beam.pieces.back(), hanger, vec(8.5, 0));
    beam.world.CreateJoint(&pin);
    pin.Initialize(above, hanger, vec(8.5, 2));
    b2Joint* held = beam.world.CreateJoint(&pin);
    beam.run(5);
    const double statics = gravity * (9 * 100 * 4.5 / 8.5 + 5);
    EXPECT_NEAR(held->GetReactionForce(60).y, statics, 1e-5 * statics) << same;
    EXPECT_NEAR(hanger->GetPosition().y, 1, 1e-5) << same;
  }
}

// Whichever came first: the order of joints in an island is that of their making, turned round.
TEST(StockJoints, MayBeMadeBeforeTheStructure) {
  for (const bool before : {false, true}) {
    b2World world(vec(0, -gravity));
    world.SetAllowSleeping(false);
    Structure structure(world);
    b2Body* ground = add_box(world, {.x = -1, .type = b2_staticBody});
    b2Body *a = add_box(world, {.x = 0.5}), *b = add_box(world, {.x = 1.5});
    b2RevoluteJoint* motor = nullptr;
    const auto make = [&] {
      b2RevoluteJointDef def;
      def.Initialize(ground, a, {0, 0});
      def.enableMotor = true;
      def.maxMotorTorque = 1e6f;
      motor = static_cast<b2RevoluteJoint*>(world.CreateJoint(&def));
    };
    if (before) make();
    ElasticPlasticJointDef def;
    def.Initialize(a, b, {1, 0}, {1, 0});
    structure.create_joint(def);
    if (!before) make();
    for (int i = 0; i < 300; ++i) {
      world.Step(1.0f / 60, 8, 3);
      structure.update();
    }
    EXPECT_NEAR(motor->GetMotorTorque(60), 2000 * gravity * 1, 0.1);
    EXPECT_NEAR(motor->GetJointAngle(), 0, 1e-5);
  }
}

// A winch, made of a rope whose length is set in each step: the load follows, and is not jerked.
// Box2D makes an infinite bias of a limit that is none, as a spring's maxLength is by default.
TEST(StockSprings, WithoutLimitsHoldADeck) {
  Deck deck(8);
  deck.fix(true);
  b2DistanceJointDef spring;
  spring.Initialize(deck.ground, deck.pieces.back(), {Deck::length, 3}, {Deck::length, 0});
  spring.minLength = 0;
  spring.maxLength = b2_maxFloat;
  b2LinearStiffness(spring.stiffness, spring.damping, 4, 1, deck.pieces.back(), deck.ground);
  auto* held = static_cast<b2DistanceJoint*>(deck.hold(spring));
  deck.run(20, 60, 8);
  EXPECT_NEAR(held->GetReactionForce(60).Length(), Deck::weight / 2, 1e-4 * Deck::weight);
}

TEST(StockRopes, AreWoundUp) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    Deck deck;
    ElasticPlasticJoint* root = deck.fix(false);
    b2Body* load = add_box(deck.world, {.x = 11.5, .y = -6, .mass = 3000});
    auto* rope = static_cast<b2DistanceJoint*>(
        deck.hold(cord(Cord::rope, deck.pieces.back(), load, vec(11.5, 0), vec(11.5, -5.5))));
    deck.run(2, hz);
    const double hung = 3000 * gravity;
    for (int i = 0; i < 4 * hz; ++i) {
      rope->SetMaxLength(rope->GetMaxLength() - static_cast<float>(0.5 / hz));
      deck.run(1 / hz, hz);
      // Half of the speed comes in one step.
      EXPECT_LT(rope->GetReactionForce(static_cast<float>(hz)).Length(),
                1.01 * hung * (1 + 0.25 * hz / gravity));
    }
    EXPECT_NEAR(load->GetLinearVelocity().y, 0.5, 0.005);
    EXPECT_NEAR(std::abs(root->force(rotation)), deck.moment() + hung * 11.5, 1e-3 * Deck::statics);
    deck.run(3, hz);
    EXPECT_NEAR(rope->GetCurrentLength(), 3.5, 1e-4);
    EXPECT_NEAR(std::abs(root->force(rotation)), deck.moment() + hung * 11.5, 1e-4 * Deck::statics);
  }
}

// A brake on a limit that carries the load: neither grows against the other.
TEST(StockSliders, RestOnTheirLimit) {
  Deck deck;
  b2PrismaticJointDef def;
  def.Initialize(deck.ground, deck.pieces.front(), {0, 0}, {0, 1});
  def.enableMotor = def.enableLimit = true;
  def.maxMotorForce = static_cast<float>(5 * Deck::weight);
  def.lowerTranslation = 0;
  def.upperTranslation = 1;
  auto* slider = static_cast<b2PrismaticJoint*>(deck.hold(def));
  deck.run(20);
  EXPECT_NEAR(slider->GetReactionForce(60).y, Deck::weight, 1e-5 * Deck::weight);
  EXPECT_GE(slider->GetMotorForce(60), -1e-3 * Deck::weight);
  EXPECT_LE(slider->GetMotorForce(60), 1.001 * Deck::weight);
}

// A lift with a block on its deck that its motor, 250 times as strong as all of it is heavy, lifts to the
// upper limit and holds there: the limit's answer to the motor is no jam, for which gaps would be left open.
TEST(StockSliders, OfALiftRestAtTheUpperLimit) {
  for (const double hz : {30.0, 60.0}) {
    Deck deck(6);
    add_box(deck.world, {.x = 3, .y = 0.4, .width = 0.6, .height = 0.6, .mass = 720, .group = 0});
    for (b2Body* piece : deck.pieces) {
      b2Filter filter = piece->GetFixtureList()->GetFilterData();
      filter.groupIndex = 0;
      piece->GetFixtureList()->SetFilterData(filter);
    }
    b2PrismaticJointDef def;
    def.Initialize(deck.ground, deck.pieces.front(), {0, 0}, {0, 1});
    def.enableMotor = def.enableLimit = true;
    def.motorSpeed = 0.5f;
    def.maxMotorForce = 1e7f;
    def.upperTranslation = 2;
    auto* slider = static_cast<b2PrismaticJoint*>(deck.hold(def));
    deck.run(8, hz);
    for (int i = 0; i < hz; ++i) {
      deck.run(1 / hz, hz);
      ASSERT_NEAR(slider->GetJointTranslation(), 2, 1e-4) << hz;
      const double weight = (Deck::mass + 720) * gravity;
      ASSERT_NEAR(slider->GetReactionForce(static_cast<float>(hz)).y, weight, 1e-3 * weight) << hz;
    }
  }
}

// As Box2D has it: gear joints, and all where nothing starts warm.
TEST(StockJoints, WithoutWarmStartsAreBox2Ds) {
  Deck deck;
  deck.world.SetWarmStarting(false);
  b2RevoluteJoint* motor = deck.motor(3 * Deck::statics);
  deck.run(1);
  EXPECT_TRUE(finite(deck.pieces));
  EXPECT_LT(motor->GetMotorTorque(60), 0.99 * Deck::statics);
}

// Made apart, they come together without a blow.
TEST(StockJoints, CloseWhatWasMadeApart) {
  for (const double apart : {0.003, 0.1, 0.5}) {
    Deck deck;
    b2RevoluteJointDef def;
    def.bodyA = deck.ground;
    def.bodyB = deck.pieces.front();
    def.localAnchorA = vec(1, apart);
    def.localAnchorB = vec(-0.5, 0);
    deck.hold(cord(Cord::rod, deck.ground, deck.pieces.back(), vec(12, 6), vec(12, 0)));
    auto* hinge = static_cast<b2RevoluteJoint*>(deck.hold(def));
    double fastest = 0;
    for (int i = 0; i < 600; ++i) {
      deck.run(1.0 / 60);
      for (const b2Body* piece : deck.pieces)
        fastest = std::max(fastest, double{piece->GetLinearVelocity().Length()});
    }
    EXPECT_LT((hinge->GetAnchorA() - hinge->GetAnchorB()).Length(), 1e-5);
    EXPECT_LT(fastest, 3) << apart;
  }
}

TEST(StockJoints, AllocateNothingInTheSteadyState) {
  Deck deck(12, 210e9);
  b2RevoluteJoint* motor = deck.motor(3 * Deck::statics);
  b2Body* load = add_box(deck.world, {.x = 11.5, .y = -3});
  deck.hold(cord(Cord::rope, deck.pieces.back(), load, vec(11.5, 0), vec(11.5, -2.5)));
  deck.run(0.5);
  const long before = allocations();
  for (int i = 0; i < 120; ++i) {
    motor->SetMotorSpeed(0.01f * static_cast<float>(i % 7 - 3));
    deck.world.Step(1.0f / 60, 8, 3);
    deck.structure.update();
  }
  EXPECT_EQ(allocations(), before);
}

// A car of 5 t on springs comes down on a deck at 20 m/s. Where its wheels are put back to where they
// touched, the rest of it goes back with them: springs that were strained by that gave it a third of its
// energy.
TEST(StockJoints, OfWhatIsPutBackToItsFirstTouch) {
  for (int phase = 0; phase < 5; ++phase) {
    Deck deck;
    deck.fix(false)->set_caps(rotation, 1e5, 1e5);
    constexpr double m = 5000, k = 1000 * m, speed = 20;
    const double y = Deck::height / 2 + 0.3 + 0.07 * phase;
    std::vector<b2Body*> car{add_box(
        deck.world, {.x = 10, .y = y + 0.6, .width = 1.6, .height = 0.3, .mass = 0.8 * m, .group = 0})};
    std::vector<b2WheelJoint*> axles;
    for (const double at : {-0.6, 0.6}) {
      b2Body* wheel =
          add_box(deck.world,
                  {.x = 10 + at, .y = y + 0.25, .width = 0.4, .height = 0.4, .mass = 0.1 * m, .group = 0});
      b2WheelJointDef axle;
      axle.Initialize(car[0], wheel, wheel->GetPosition(), {0, 1});
      axle.stiffness = static_cast<float>(k);
      axle.damping = static_cast<float>(10 * m);
      axles.push_back(static_cast<b2WheelJoint*>(deck.world.CreateJoint(&axle)));
      car.push_back(wheel);
    }
    for (b2Body* b : car) b->SetLinearVelocity(vec(0, -speed));
    const auto energy = [&] {
      double sum = kinetic_energy(car) + potential_energy(car, gravity);
      for (const b2Body* b : car) sum -= b->GetMass() * gravity * b->GetLinearVelocity().y / 120;
      for (b2WheelJoint* axle : axles)
        sum += k * axle->GetJointTranslation() * axle->GetJointTranslation() / 2;
      return sum;
    };
    const double start = energy();
    for (int i = 0; i < 8; ++i) {
      deck.run(1 / 60.);
      EXPECT_LT(energy(), start + 1e-3 * m * speed * speed) << phase << ", " << i;
    }
  }
}

// Two welded boxes come down on a portal frame of steel at 40 m/s, and its pieces jam between them. Box2D
// starts a step with the weld's impulses of the last at its two anchors, which are apart by then: taken back
// at one, they would set a box spinning.
TEST(StockJoints, ThatHoldWhatJamsInAFrame) {
  const struct {
    double speed, times, x, gap, hz;
  } blows[]{{40, 75, 2.3, 0.3, 60}, {35, 100, 2.3, 0.3, 30}, {40, 100, 2, 0.3, 60}, {40, 100, 2.6, 0.9, 60}};
  for (const auto& [speed, times, x, gap, hz] : blows) {
    b2World world(vec(0, -gravity));
    Structure structure(world);
    world.SetAllowSleeping(false);
    b2Body* ground = add_box(world, {.x = -20, .type = b2_staticBody});
    std::vector<b2Body*> pieces;
    constexpr double h = 0.2, E = 210e9, M = 0.4 * 355e6 * h * h / 4;
    const auto join = [&](b2Body* a, b2Body* b, const b2Vec2& at, const b2Vec2& axis, double span) {
      ElasticPlasticJointDef def;
      def.Initialize(a, b, at, axis);
      def.rows[axial].stiffness = E * h / span;
      def.rows[shear].stiffness = E / 3.12 * h / span;
      def.rows[rotation] = {.stiffness = E * h * h * h / 12 / span, .cap = M, .cap_reverse = M};
      for (RowDef& row : def.rows) row.damping = row.stiffness * 0.04 / 30;
      structure.create_joint(def);
    };
    const auto member = [&](b2Body* from, const b2Vec2& start, const b2Vec2& axis, int count, double length) {
      const float l = static_cast<float>(length / count);
      for (int i = 0; i < count; ++i) {
        const b2Vec2 end = start + static_cast<float>(i) * l * axis, middle = end + 0.5f * l * axis;
        const bool upright = axis.y != 0;
        b2Body* piece = add_box(world, {.x = middle.x,
                                        .y = middle.y,
                                        .width = upright ? h : l,
                                        .height = upright ? l : h,
                                        .mass = 7800 * h * l});
        join(from, piece, end, axis, i == 0 ? l / 2 : l);
        pieces.push_back(from = piece);
      }
      return from;
    };
    b2Body *left = member(ground, {0, 0}, {0, 1}, 6, 4), *right = member(ground, {6, 0}, {0, 1}, 6, 4);
    join(member(left, {0, 4}, {1, 0}, 8, 6), right, {6, 4}, {1, 0}, 0.375);
    const double m = times * 7800 * h * 0.75, y = 4 + h / 2 + gap + 0.25;
    for (const double at : {-0.3, 0.3}) {
      pieces.push_back(
          add_box(world, {.x = x + at, .y = y, .width = 0.5, .height = 0.5, .mass = m / 2, .group = 0}));
      pieces.back()->SetLinearVelocity(vec(0, -speed));
    }
    b2WeldJointDef weld;
    weld.Initialize(pieces.rbegin()[1], pieces.back(), vec(x, y));
    world.CreateJoint(&weld);
    const auto energy = [&] { return kinetic_energy(pieces) + potential_energy(pieces, gravity); };
    const double start = energy();
    double most = 0;
    for (int i = 0; i < hz / 2; ++i) {
      world.Step(static_cast<float>(1 / hz), 8, 3);
      structure.update();
      most = std::max(most, energy());
    }
    EXPECT_LT(most, start + 0.01 * m * speed * speed) << speed << ", " << times << ", " << x << ", " << hz;
  }
}

// A box welded to one piece reaches into the next, from below: neither gap can close. The root carries the
// weights, as if there were no contact; the rows pressed harder in each step, until the root yielded.
TEST(StockJoints, PressNoHarderThanTheyMustOnWhatIsInTheirWay) {
  for (const double hz : {60.0, 240.0}) {
    for (const double overlap : {0.004, 0.02}) {
      Beam beam({.pieces = 3, .length = 3, .height = 0.2, .density = 250, .moment_cap = 1e6});
      b2Body* box = add_box(
          beam.world, {.x = 1.5, .y = -0.35 + overlap, .width = 1.9, .height = 0.5, .mass = 100, .group = 0});
      b2WeldJointDef weld;
      weld.Initialize(beam.pieces[0], box, vec(0.7, -0.2));
      beam.world.CreateJoint(&weld);
      beam.run(10, 1 / hz);
      const double moment = gravity * (3 * 50 * 1.5 + 100 * 1.5);
      EXPECT_NEAR(std::abs(beam.joints[0]->force(rotation)), moment, 5e-3 * moment) << hz << ", " << overlap;
    }
  }
}

// Two boxes on hinges at one place, one in the other's way: each hinge carries its box.
TEST(StockJoints, OfWhatCannotPartCarryItsWeight) {
  for (const double hz : {60.0, 240.0}) {
    for (const double overlap : {-0.005, 0.003, 0.024}) {
      Beam beam({.pieces = 1, .length = 1, .height = 0.2, .density = 250});
      std::vector<b2Joint*> hinges;
      for (const double y : {-1.0, -1.5 + overlap}) {
        b2Body* box =
            add_box(beam.world, {.x = 0.5, .y = y, .width = 0.5, .height = 0.5, .mass = 100, .group = 0});
        b2RevoluteJointDef hinge;
        hinge.Initialize(beam.pieces[0], box, vec(0.5, 0));
        hinges.push_back(beam.world.CreateJoint(&hinge));
      }
      beam.run(5, 1 / hz);
      double carried = 0;
      for (b2Joint* hinge : hinges) carried += hinge->GetReactionForce(static_cast<float>(hz)).y;
      EXPECT_NEAR(std::abs(carried), 200 * gravity, 0.01 * 200 * gravity) << hz << ", " << overlap;
      for (b2Joint* hinge : hinges)
        EXPECT_LT(hinge->GetReactionForce(static_cast<float>(hz)).Length(), 1.1 * 100 * gravity);
    }
  }
}

// A deck of 600 kg on two hinges of Box2D's, so many metres from a wall that is beyond its end, or a pier
// below its middle. Box2D's skins overlap there by up to 15 mm, which its iterations would take back by
// moving a piece: the hinge and the contact then asked for opposite velocities in each step, with 1e10 N.
TEST(StockHinges, OfADeckThatIsFlushWithWhatStands) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    for (const bool below : {false, true}) {
      for (const double gap : {0.0, 0.005, 0.012, 0.1}) {
        b2World world({0, -static_cast<float>(gravity)});
        Structure structure(world);
        const b2BodyDef at_origin;
        b2Body* ground = world.CreateBody(&at_origin);
        if (below) {
          add_box(world, {.x = 3, .y = -1.15 - gap, .height = 2, .type = b2_staticBody, .group = 0});
        } else {
          add_box(world, {.x = -1 - gap, .width = 2, .height = 0.6, .type = b2_staticBody, .group = 0});
        }
        std::vector<b2Body*> pieces;
        std::vector<ElasticPlasticJoint*> joints;
        for (int i = 0; i < 6; ++i) {
          pieces.push_back(add_box(world, {.x = i + 0.5, .height = 0.3, .mass = 100}));
          if (i == 0) continue;
          ElasticPlasticJointDef def;
          def.Initialize(pieces[pieces.size() - 2], pieces.back(), vec(i, 0), {1, 0});
          joints.push_back(structure.create_joint(def));
        }
        std::vector<b2Joint*> hinges;
        for (const int end : {0, 6}) {
          b2RevoluteJointDef def;
          def.Initialize(ground, end == 0 ? pieces.front() : pieces.back(), vec(end, 0));
          hinges.push_back(world.CreateJoint(&def));
        }
        for (int i = 0; i < 3 * hz; ++i) {
          world.Step(static_cast<float>(1 / hz), 8, 3);
          structure.update();
        }
        double borne = 0;
        for (b2Joint* hinge : hinges) {
          const b2Vec2 force = hinge->GetReactionForce(static_cast<float>(hz));
          borne += std::abs(force.y);
          // Between hinge and wall the deck may be wedged by what the first step gave it, for good.
          EXPECT_LT(std::abs(force.x), 6000 / 4) << hz << ", " << below << ", " << gap;
        }
        // What rubs or lies there takes its part.
        if (gap > 0.02) {
          EXPECT_NEAR(borne, 6000, 0.01 * 6000) << hz << ", " << gap;
        }
        EXPECT_LE(borne, 1.01 * 6000) << hz << ", " << below << ", " << gap;
        for (const ElasticPlasticJoint* joint : joints)
          EXPECT_LE(std::abs(joint->force(rotation)), 1.01 * 6000 * 6 / 8)
              << hz << ", " << below << ", " << gap;
      }
    }
  }
}

}  // namespace
}  // namespace ductile
