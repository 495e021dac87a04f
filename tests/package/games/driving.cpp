// Driving and wrecking: wheels over the seams of a deck, a drawbridge on Box2D's own motor, a column that is
// crushed, towers that are struck.
#include <algorithm>
#include <random>

#include "game.h"

using namespace game;

namespace {

constexpr double deck_mass = 314, deck_EI = 28e6;  // kg/m, N m²

// 24 m of deck on both its ends, so many pieces; none: one box that stands still. Its joints are stiff, so
// that what is felt is the seams.
void deck(b2World& world, Structure& structure, int pieces) {
  b2Body* last = box(world, -0.5, 0, 1, 0.2, 0);
  const double l = 24.0 / std::max(pieces, 1);
  if (pieces == 0) box(world, 12, 0, 24, 0.2, 0);
  for (int i = 0; i <= pieces && pieces > 0; ++i) {
    b2Body* body =
        i < pieces ? box(world, (i + 0.5) * l, 0, l, 0.2, deck_mass * l) : box(world, 24.5, 0, 1, 0.2, 0);
    ElasticPlasticJointDef def;
    def.Initialize(last, body, {static_cast<float>(i * l), 0}, {1, 0});
    if (i > 0 && i < pieces) def.rows[rotation] = {.stiffness = 100 * deck_EI / l, .damping_ratio = 1};
    structure.create_joint(def);
    last = body;
  }
}

// The largest vertical acceleration, m/s², of a car of 5 t on two sprung wheels that drives over it at 8 m/s.
double felt(int pieces) {
  b2World world({0, -10});
  world.SetAllowSleeping(false);
  Structure structure(world);
  deck(world, structure, pieces);
  box(world, -11, 0, 20, 0.2, 0);
  box(world, 35, 0, 20, 0.2, 0);
  run(world, structure, 4);
  b2Body* car = box(world, -6, 1.2, 3, 0.5, 4600);
  car->SetLinearVelocity({8, 0});
  for (const float x : {-7.0f, -5.0f}) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = {x, 0.5f};
    def.linearVelocity = {8, 0};
    b2Body* wheel = world.CreateBody(&def);
    b2CircleShape tyre;
    tyre.m_radius = 0.4f;
    wheel->CreateFixture(&tyre, 200 / (b2_pi * 0.16f));
    b2WheelJointDef axle;
    axle.Initialize(car, wheel, wheel->GetPosition(), {0, 1});
    axle.stiffness = 4e5f;  // 2 Hz of half a car
    axle.damping = 4e4f;
    world.CreateJoint(&axle);
  }
  double most = 0;
  for (float before = 0; car->GetPosition().x < 20;) {
    run(world, structure, 1 / 60.0);
    const float now = car->GetLinearVelocity().y;
    if (car->GetPosition().x > 3) most = std::max(most, 60.0 * std::abs(now - before));
    before = now;
  }
  return most;
}

// 12 m of deck on a revolute joint whose motor holds it: 314 · 9.81 · 12²/2 = 221.8 kN m, in any number of
// pieces.
void drawbridge_of_stock(int pieces) {
  b2World world({0, -9.81f});
  world.SetAllowSleeping(false);
  Structure structure(world);
  b2Body *wall = box(world, -0.5, 0, 1, 1, 0), *last = nullptr;
  const double l = 12.0 / pieces;
  b2RevoluteJoint* motor = nullptr;
  for (int i = 0; i < pieces; ++i) {
    b2Body* body = box(world, (i + 0.5) * l, 0, l, 0.2, deck_mass * l);
    if (i == 0) {
      b2RevoluteJointDef def;
      def.Initialize(wall, body, {0, 0});
      def.enableMotor = true;
      def.maxMotorTorque = 2e6f;
      motor = static_cast<b2RevoluteJoint*>(world.CreateJoint(&def));
    } else {
      ElasticPlasticJointDef def;
      def.Initialize(last, body, {static_cast<float>(i * l), 0}, {1, 0});
      def.rows[rotation] = {.stiffness = deck_EI / l, .damping = 0.2 * deck_EI / l};
      structure.create_joint(def);
    }
    last = body;
  }
  run(world, structure, 10);
  constexpr double held = deck_mass * 9.81 * 72;
  check_near(std::abs(motor->GetMotorTorque(60)), held, 0.01 * held, "a stock motor holds a deck");
  check(std::abs(motor->GetJointAngle()) < 1e-3, "  where it is", motor->GetJointAngle());
}

// Five blocks of 1 m under 1.3 times what they bear: they give way, and lie on the ground and on each other.
void crushed() {
  b2World world({0, -10});
  world.SetAllowSleeping(false);
  Structure structure(world);
  b2Body* last = box(world, 0, -1, 400, 2, 0);
  last->GetFixtureList()->SetFilterData({});
  std::vector<b2Body*> pile;
  int broke = 0;
  structure.on_event([&](const JointEvent& event) { broke += event.kind == JointEvent::broke; });
  for (int i = 0; i < 6; ++i) {
    b2Body* body = box(world, 0, i + 0.5, i < 5 ? 0.3 : 2, 1, i < 5 ? 100 : 62'800);
    body->GetFixtureList()->SetFilterData({});
    ElasticPlasticJointDef joint;
    joint.Initialize(last, body, {0, static_cast<float>(i)}, {0, 1});
    joint.rows[axial] = {.stiffness = 1e9, .damping_ratio = 0.05, .cap = 480e3, .cap_reverse = 480e3};
    joint.max_compression = 0.3;
    structure.create_joint(joint);
    pile.push_back(last = body);
  }
  run(world, structure, 10);
  check(broke > 0, "a column that is crushed breaks", broke);
  float lowest = 9;
  for (const b2Body* body : pile) lowest = std::min(lowest, body->GetPosition().y);
  check(lowest > 0.1f, "  and falls into no ground", lowest);
  check(pile.back()->GetPosition().y > 0.5f, "  its load lies on top", pile.back()->GetPosition().y);
}

// Towers struck by what flies at them: never more energy than there was, within 1 % of it, and nothing is
// lost.
void struck() {
  std::mt19937 random(7);
  double worst = 0;
  int broken = 0;
  for (int tower = 0; tower < 10; ++tower) {
    b2World world({0, -10});
    Structure structure(world, {.keep_ledger = true});
    structure.on_event([&](const JointEvent& event) { broken += event.kind == JointEvent::broke; });
    b2Body* last = box(world, 0, -0.5, 60, 1, 0);
    for (int i = 0; i < 8; ++i) {
      b2Body* body = box(world, 0, i + 0.5, 0.5, 1, 500);
      ElasticPlasticJointDef def;
      def.Initialize(last, body, {0, static_cast<float>(i)}, {0, 1});
      def.rows[rotation] = {.stiffness = 1e7, .damping_ratio = 0.05, .cap = 2e5, .cap_reverse = 2e5};
      def.max_rotation = 0.1;
      structure.create_joint(def);
      last = body;
    }
    for (int i = 0; i < 4; ++i) {
      b2Body* stone = box(world, -15, 1 + 2 * i, 1, 1, 200 + random() % 3000);
      stone->SetLinearVelocity({10 + static_cast<float>(random() % 20), 0});
    }
    for (b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext())
      if (body->GetFixtureList() != nullptr) body->GetFixtureList()->SetFilterData({});
    const auto energy = [&] {
      double sum = structure.energy().elastic;
      for (const b2Body* b = world.GetBodyList(); b != nullptr; b = b->GetNext()) {
        const double v = b->GetLinearVelocity().Length(), w = b->GetAngularVelocity();
        sum += b->GetMass() * (v * v / 2 + 10.0 * b->GetWorldCenter().y) +
               (b->GetInertia() - b->GetMass() * b->GetLocalCenter().LengthSquared()) * w * w / 2;
      }
      return sum;
    };
    const double first = energy();
    for (int i = 0; i < 300; ++i) {
      run(world, structure, 1 / 60.0);
      worst = std::max(worst, energy() / first - 1);
    }
  }
  check(broken > 10, "towers that are struck break", broken);
  check(worst < 0.01, "  and gain no energy", worst);
}

}  // namespace

int main() {
  const double smooth = felt(0);
  for (const int pieces : {6, 24})
    check_near(felt(pieces), smooth, 0.1, "wheels roll over the seams of a deck");
  for (const int pieces : {1, 4, 12}) drawbridge_of_stock(pieces);
  crushed();
  struck();
  return failed;
}
