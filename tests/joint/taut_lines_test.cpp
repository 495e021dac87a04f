// Lines under tension whose bodies are light: what they swing and turn at is faster than the step
// (joint/turn_inertia.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "bodies.h"
#include "ductile/joint.h"

namespace ductile {
namespace {

/// Bodies and lines between them; what is between two steps is told in the middle of the last.
struct Lines {
  explicit Lines(double gravity, double hz)
      : g(gravity), dt(1 / hz), world(vec(0, -gravity)), structure(world, {.keep_ledger = true}) {
    world.SetAllowSleeping(false);
  }
  b2Body* box(double y, double size, double mass) {
    bodies.push_back(add_box(world, {.y = y, .width = size, .height = size, .mass = mass, .group = -1}));
    return bodies.back();
  }
  ElasticPlasticJoint* line(b2Body* a, double at_a, b2Body* b, double at_b, double EA, double pull = 0) {
    ElasticPlasticJointDef def;
    def.InitializeLine(a, b, vec(0, at_a), vec(0, at_b));
    def.rows[axial] = RowDef::rope(EA / std::abs(at_b - at_a));
    def.length = std::abs(at_b - at_a) * (1 - pull / EA);
    return structure.create_joint(def);
  }
  void step() {
    world.Step(static_cast<float>(dt), 8, 3);
    EXPECT_EQ(structure.report().bounds_hit, 0);
    structure.update();
  }
  double energy() const {
    double sum = structure.energy().elastic + kinetic_energy(bodies);
    for (const b2Body* b : bodies)
      sum += b->GetMass() * g * (b->GetWorldCenter().y - dt / 2 * b->GetLinearVelocity().y);
    return sum;
  }
  double g, dt;
  b2World world;
  Structure structure;
  std::vector<b2Body*> bodies;
};

struct Hook {
  double load, hz;
};
class HookUnderLoad : public testing::TestWithParam<Hook> {};

// A crane's hook of 50 kg, 0.4 m high, hangs on a rope, and a load of up to 20 t on the hook. Both ropes hold
// it upright with T r each, at an (ωh)² = 2 T r h²/I of up to 33.
TEST_P(HookUnderLoad, HangsStillWhileItSwings) {
  const auto [load, hz] = GetParam();
  Lines lines(10, hz);
  b2Body *crane = add_box(lines.world, {.width = 0.1, .height = 0.1, .type = b2_staticBody}),
         *hook = lines.box(-5.2, 0.4, 50), *weight = lines.box(-7.9, 1, load);
  const double stretched = load * 10 * load * 10 * 7 / 3e7 / 2;
  lines.line(crane, 0, hook, -5, 3e7);
  lines.line(hook, -5.4, weight, -7.4, 3e7);
  hook->SetAngularVelocity(0.1f);
  weight->SetLinearVelocity({0.5f, 0});
  const double first = lines.energy(), turnover = load * 0.25 / 2 + stretched;
  for (int i = 0; i < 60 * hz; ++i) {
    lines.step();
    ASSERT_LE(lines.energy(), first + 1e-4 * turnover) << "step " << i;
    ASSERT_LT(std::abs(hook->GetAngle()), 0.5) << "step " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Loads, HookUnderLoad,
                         testing::Values(Hook{2000, 30}, Hook{6000, 30}, Hook{20000, 30}, Hook{6000, 60},
                                         Hook{20000, 60}, Hook{20000, 240}),
                         [](const auto& info) {
                           return std::to_string(std::lround(info.param.load)) + "_at_" +
                                  std::to_string(std::lround(info.param.hz));
                         });

// Steps of 1/120 to 1/30 s in any order. A load that hangs in equilibrium and is pushed aside has no more
// energy than that.
TEST(TautLines, HoldAHookInStepsOfAnyLength) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    Lines lines(10, 60);
    b2Body *crane = add_box(lines.world, {.width = 0.1, .height = 0.1, .type = b2_staticBody}),
           *hook = lines.box(-5.2, 0.4, 50), *weight = lines.box(-7.9, 1, 6000);
    lines.line(crane, 0, hook, -5, 3e7, 60500);
    lines.line(hook, -5.4, weight, -7.4, 3e7, 60000);
    weight->SetLinearVelocity({0.5f, 0});
    const double first = kinetic_energy(lines.bodies);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> power(-1, 1);
    for (int i = 0; i < 1000; ++i) {
      lines.dt = std::exp2(power(random)) / 60;
      lines.step();
      ASSERT_LE(kinetic_energy(lines.bodies), 1.01 * first) << seed << ", step " << i;
    }
  }
}

struct Plate {
  bool line_above;  // a pin below; or the other way round
  double hz;
};
class PlateUnderLoad : public testing::TestWithParam<Plate> {};

// A plate of 50 kg, 0.4 m high, between a line and a pin, and 60 t on it: at the pin the same force turns it.
TEST_P(PlateUnderLoad, HangsStillWhileItSwings) {
  const auto [line_above, hz] = GetParam();
  Lines lines(10, hz);
  b2Body *crane = add_box(lines.world, {.width = 0.1, .height = 0.1, .type = b2_staticBody}),
         *plate = lines.box(-5.2, 0.4, 50), *weight = lines.box(line_above ? -5.9 : -7.9, 1, 60000);
  const auto pin = [&](b2Body* a, b2Body* b, double y) {
    ElasticPlasticJointDef def;
    def.Initialize(a, b, vec(0, y), {0, 1});
    def.rows[rotation] = RowDef::free();
    lines.structure.create_joint(def);
  };
  const double pull = (line_above ? 60050 : 60000) * 10., length = line_above ? 5 : 2;
  if (line_above) {
    lines.line(crane, 0, plate, -5, 3e7, pull);
    pin(plate, weight, -5.4);
  } else {
    pin(crane, plate, -5);
    lines.line(plate, -5.4, weight, -7.4, 3e7, pull);
  }
  weight->SetLinearVelocity({0.3f, 0});
  const double stored = pull * pull * length / 3e7 / 2, first = lines.energy() + stored;
  for (int i = 0; i < 40 * hz; ++i) {
    lines.step();
    ASSERT_LE(lines.energy(), first + 1e-4 * (60000 * 0.045 + stored)) << "step " << i;
    ASSERT_LT(std::abs(plate->GetAngle()), 0.5) << "step " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Places, PlateUnderLoad,
                         testing::Values(Plate{true, 30}, Plate{true, 60}, Plate{false, 30},
                                         Plate{false, 60}),
                         [](const auto& info) {
                           return (info.param.line_above ? "line_above_at_" : "line_below_at_") +
                                  std::to_string(std::lround(info.param.hz));
                         });

// A ball of 15 kg between two lines of 0.05 m under T = 20 kN: ωh = 3.9. Its energy of 0.075 J moves it aside
// by v √(mℓ/2T) where it swings, and by no more where inertia makes it slower.
TEST(TautLines, HoldABallBetweenThem) {
  Lines lines(0, 60);
  b2Body* wall = add_box(lines.world, {.width = 0.01, .height = 0.01, .type = b2_staticBody});
  b2Body* ball = lines.box(0, 0.02, 15);
  for (const double side : {-1, 1}) {
    ElasticPlasticJointDef def;
    def.InitializeLine(wall, ball, vec(side * 0.05, 0), {0, 0});
    def.rows[axial] = RowDef::rope(2e6);
    def.length = 0.04;
    lines.structure.create_joint(def);
  }
  for (int i = 0; i < 120; ++i) lines.step();
  ball->SetLinearVelocity({0, 0.1f});
  const double first = lines.energy(), aside = 0.1 * std::sqrt(15 * 0.05 / 4e4);
  for (int i = 0; i < 600; ++i) {
    lines.step();
    ASSERT_LE(lines.energy(), first + 1e-4 * 0.075) << "step " << i;
    ASSERT_LE(std::abs(ball->GetPosition().y), 1.01 * aside) << "step " << i;
  }
}

// Twelve beads on a string: ω_k = 2 √(T/mℓ) sin(kπ/26). The slowest, of 3 Hz, is slowed by (3s − 1)φ²/24 =
// 1.4 % at most; the fastest, of 25 Hz, turns by 2.6 rad a step, more than the 2 at which it would grow.
TEST(TautLines, SwingAsAStringOfBeads) {
  const int n = 12;
  const double T = 1e4, l = 0.5, f = 3, omega = 2 * std::numbers::pi * f;
  const double mass = T / l / std::pow(omega / (2 * std::sin(std::numbers::pi / (2 * (n + 1)))), 2);
  Lines lines(0, 60);
  b2Body* wall = add_box(lines.world, {.width = 0.01, .height = 0.01, .type = b2_staticBody});
  b2Body* last = wall;
  const double k = 1e7;
  for (int i = 1; i <= n + 1; ++i) {
    b2Body* next = i > n ? wall : lines.box(i * l, 0.02, mass);
    ElasticPlasticJointDef def;
    def.InitializeLine(last, next, vec(0, (i - 1) * l), vec(0, i * l));
    def.rows[axial] = RowDef::rope(k);
    def.length = l - T / k;
    lines.structure.create_joint(def);
    last = next;
  }
  for (int i = 0; i < 120; ++i) lines.step();
  for (int i = 0; i < n; ++i) {
    const double shape = std::sin(std::numbers::pi * (i + 1) / (n + 1));
    lines.bodies[static_cast<std::size_t>(i)]->SetLinearVelocity(vec(0.2 * shape, 0));
  }
  const double first = lines.energy();
  std::vector<double> crossings;
  double before = 0;
  const int steps = 1200;
  for (int i = 0; i < steps; ++i) {
    lines.step();
    double now = 0;
    for (int b = 0; b < n; ++b)
      now += lines.bodies[static_cast<std::size_t>(b)]->GetPosition().x *
             std::sin(std::numbers::pi * (b + 1) / (n + 1));
    if (before > 0 && now <= 0) crossings.push_back((i + before / (before - now)) * lines.dt);
    before = now;
    ASSERT_LE(lines.energy(), first * (1 + 1e-4)) << "step " << i;
  }
  ASSERT_GT(crossings.size(), 50u);
  const double measured = static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
  EXPECT_NEAR(measured, f, 0.014 * f);
}

/// What nothing holds, in a spin: its angular momentum stays what it was, but for what solves leave within
/// their tolerance.
struct Spinning : Lines {
  explicit Spinning(double hz) : Lines(0, hz) {}
  void spin(double rate) {
    for (b2Body* b : bodies) {
      b->SetLinearVelocity(vec(-rate * b->GetPosition().y, rate * b->GetPosition().x));
      b->SetAngularVelocity(static_cast<float>(rate));
    }
    L = angular_momentum(bodies);
    first = energy();
  }
  void expect_kept(double seconds) {
    for (double t = 0; t < seconds - dt / 2; t += dt) {
      step();
      ASSERT_NEAR(angular_momentum(bodies), L, 1e-4 * L) << "after " << t << " s";
    }
    b2Vec2 momentum{0, 0};
    for (const b2Body* b : bodies) momentum += b->GetMass() * b->GetLinearVelocity();
    EXPECT_LE(momentum.Length(), 1e-5 * L);
  }
  /// Joules that no account has.
  double unaccounted() const {
    const auto e = structure.energy();
    return energy() - first + e.dissipated + e.damping + e.numerical - e.driven;
  }
  double L = 0, first = 0;
};

/// Two boxes on a strut, and a winch between them whose rope the strut holds tight.
struct Dumbbell : Spinning {
  Dumbbell(double hz, double mass) : Spinning(hz) {
    b2Body *a = box(-1, 0.4, mass), *b = box(1, 0.4, mass);
    ElasticPlasticJointDef strut;
    strut.InitializeLine(a, b, vec(0, -1), vec(0, 1));
    strut.rows[axial] = {.stiffness = 1e7};
    structure.create_joint(strut);
    winch = line(a, -1, b, 1, 2e7);
    spin(1);
  }
  /// At which both turn about each other; the strut does not turn the boxes themselves.
  double turn_rate() const {
    const b2Vec2 d = way(), v = bodies[1]->GetLinearVelocity() - bodies[0]->GetLinearVelocity();
    return b2Cross(d, v) / d.LengthSquared();
  }
  double turn_rate_by_momentum() const {
    const b2Body& b = *bodies[0];
    return (L - 2 * b.GetInertia()) / (b.GetMass() * way().LengthSquared() / 2);
  }
  b2Vec2 way() const { return bodies[1]->GetPosition() - bodies[0]->GetPosition(); }
  ElasticPlasticJoint* winch = nullptr;
};

class TautSpin : public testing::TestWithParam<double> {};

// The rope takes 500 kN, ten thousand times what the spin asks for, and an inertia of its turning of up
// to 2.7 times that of the boxes. Drawn together they turn faster, and that inertia with them.
TEST_P(TautSpin, IsFasterAsAWinchDrawsItTogether) {
  Dumbbell dumbbell(GetParam(), 50);
  dumbbell.winch->drive(axial, {.target = 1.9, .speed = 0.05});
  dumbbell.expect_kept(3);
  EXPECT_GT(dumbbell.winch->force(axial), 4e5);
  EXPECT_GT(dumbbell.turn_rate(), 1.04);
  EXPECT_NEAR(dumbbell.turn_rate(), dumbbell.turn_rate_by_momentum(), 1e-4);
  EXPECT_LE(std::abs(dumbbell.unaccounted()), 1e-4 * dumbbell.structure.energy().driven);
}

// Inertia comes with each pull, and goes half a second after it.
TEST_P(TautSpin, IsWhatItWasAfterEachPull) {
  Dumbbell dumbbell(GetParam(), 200);
  for (int pull = 0; pull < 4; ++pull) {
    dumbbell.winch->drive(axial, {.target = 1.92, .speed = 0.2});
    dumbbell.expect_kept(1);
    dumbbell.winch->drive(axial, {.target = 2, .speed = 0.2});
    dumbbell.expect_kept(1.5);
    EXPECT_NEAR(dumbbell.turn_rate(), 1, 2e-3);
  }
}

/// A ring of twelve pieces, and a hub in it on four lines under 250 kN.
struct Wheel : Spinning {
  explicit Wheel(double hz, double moment_cap = unlimited) : Spinning(hz) {
    const int n = 12;
    const double r = 2, half = std::numbers::pi / n, l = 2 * r * std::tan(half), A = 0.01;
    for (int i = 0; i < n; ++i) {
      const double angle = (2 * i + 1) * half;
      bodies.push_back(add_box(world, {.x = r * std::cos(angle),
                                       .y = r * std::sin(angle),
                                       .width = 0.1,
                                       .height = l,
                                       .mass = 7850 * A * l,
                                       .angle = angle}));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * (static_cast<double>(i) + 1) * half, corner = r / std::cos(half);
      const double EA = 210e9 * A, EI = EA * A / 12;
      ElasticPlasticJointDef def;
      def.Initialize(bodies[i], bodies[(i + 1) % n], vec(corner * std::cos(angle), corner * std::sin(angle)),
                     vec(-std::sin(angle), std::cos(angle)));
      def.rows[axial] = {.stiffness = EA / l, .damping = 5e-4 * EA / l};
      def.rows[shear] = {.stiffness = EA / l / 3, .damping = 5e-4 * EA / l / 3};
      def.rows[rotation] = {
          .stiffness = EI / l, .cap = moment_cap, .cap_reverse = moment_cap, .damping = 5e-4 * EI / l};
      structure.create_joint(def);
    }
    b2Body* hub = box(0, 0.6, 500);
    for (std::size_t i = 0; i < n; i += 3) {
      ElasticPlasticJointDef def;
      def.InitializeLine(hub, bodies[i], {0, 0}, bodies[i]->GetPosition());
      def.rows[axial] = RowDef::rope(1e7);
      def.length = r - 0.03;
      lines.push_back(structure.create_joint(def));
    }
    spin(3);
  }
  std::vector<ElasticPlasticJoint*> lines;
};

// What it loses is what bodies lose that part along their tangents, (ωh)² at most.
TEST_P(TautSpin, OfAWheelWithTautSpokesGoesOn) {
  Wheel wheel(GetParam());
  const double spinning = kinetic_energy(wheel.bodies), turn = 3 * wheel.dt;
  wheel.expect_kept(10);
  for (const ElasticPlasticJoint* line : wheel.lines) EXPECT_GT(line->force(axial), 2e5);
  EXPECT_NEAR(kinetic_energy(wheel.bodies), spinning, turn * turn * spinning);
  EXPECT_LE(std::abs(wheel.unaccounted()), 1e-4 * spinning);
}

// Steps of half to twice the length, in any order.
TEST_P(TautSpin, GoesOnInStepsOfAnyLength) {
  Wheel wheel(GetParam());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> power(-1, 1);
  for (int i = 0; i < 300; ++i) {
    wheel.dt = std::exp2(power(random)) / GetParam();
    wheel.expect_kept(wheel.dt);
  }
}

// The hub is struck: steps of the blow are solved in parts. Where these end bodies go on with velocities that
// belong to the middle of the step, and with the angular momentum that they have where they are.
TEST_P(TautSpin, GoesOnAfterABlow) {
  Wheel wheel(GetParam(), 6e4);
  wheel.expect_kept(0.1);
  b2Body& hub = *wheel.bodies.back();
  hub.SetLinearVelocity({35, 10});
  wheel.L = angular_momentum(wheel.bodies);
  wheel.first += wheel.unaccounted();
  const double given = kinetic_energy(wheel.bodies);
  int divided = 0, last = 0;
  for (int step = 0; step < GetParam(); ++step) {
    wheel.world.Step(static_cast<float>(wheel.dt), 8, 3);
    divided += last = wheel.structure.report().divided;
    wheel.structure.update();
    ASSERT_NEAR(angular_momentum(wheel.bodies), wheel.L, 2e-5 * wheel.L) << "step " << step;
  }
  EXPECT_GT(divided, 0);
  EXPECT_EQ(last, 0);
  EXPECT_LE(std::abs(wheel.unaccounted()), 1e-4 * given);
}
INSTANTIATE_TEST_SUITE_P(AtHertz, TautSpin, testing::Values(30, 60, 120),
                         [](const auto& info) { return std::to_string(std::lround(info.param)); });

}  // namespace
}  // namespace ductile
