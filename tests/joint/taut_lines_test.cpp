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

}  // namespace
}  // namespace ductile
