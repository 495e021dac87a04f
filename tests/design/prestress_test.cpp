// Lines that are not as long as they are drawn: what they strain is there before the loads, and stays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "ductile/design.h"
#include "ductile/plane.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20, EI = 210e9 / 12, pi = std::numbers::pi;

// A line from the ground's piece to a body's, shorter by `shorter` than it is drawn.
JointBetweenDef line(const std::string& ground, const std::string& body, Point from, Point to, double k,
                     double shorter, Carries carries = Carries::tension, double bears = unlimited) {
  JointBetweenDef result{.a = ground, .b = body, .line = {{from, to}}, .carries = carries};
  result.length = length(to - from) - shorter;
  result.overrides.stiffness_axial = k;
  result.overrides.axial = bears;
  return result;
}

double yields_at(const Plan& plan, const std::string& joint, Order order = Order::first) {
  return static_check(plan, order).joints[static_cast<std::size_t>(joint_named(plan, joint))].yields_at;
}

// A block that moves up and down alone, 2 m below a ceiling and 2 m above a floor, with P down on it. Lines
// of k₁ to the ceiling and k₂ to the floor, both shorter by s: T₁ = T₂ = 2 s/(1/k₁ + 1/k₂) before it is
// loaded.
struct Block {
  double k1 = 3e6, k2 = 1e6, P = 10e3, bears = 80e3;
  SceneDef scene(double s1, double s2, Carries carries = Carries::tension) const {
    SceneDef scene = bending_only();
    scene.bodies = {wall("ceiling", -1, 1), wall("floor", -1, 1), beam(1, 1)};
    scene.bodies[0].at = {0, 5};
    scene.bodies[1].at = {0, -5};
    scene.bodies[2].at = {-0.5, 0};
    scene.joints = {line("ceiling", "beam", {0, 3}, {0, 0}, k1, s1, carries, bears),
                    line("floor", "beam", {0, -3}, {0, 0}, k2, s2, carries, bears)};
    scene.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_angle = true}};
    scene.loads = {{.body = "beam", .at = {0, 0}, .force = {0, -P}}};
    return scene;
  }
};

TEST(Prestress, StaysAsItIsWhileLoadsGrow) {
  const Block b;
  const double T = 0.04 / (1 / b.k1 + 1 / b.k2), up = b.k1 / (b.k1 + b.k2);  // T = 30 kN; the share of P
  const Plan plan = calibrate(b.scene(0.02, 0.02));
  const StaticCheck check = static_check(plan);
  EXPECT_NEAR(check.joints[0].N, T + up * b.P, 1e-9 * T);
  EXPECT_NEAR(check.joints[1].N, T - (1 - up) * b.P, 1e-9 * T);
  for (const Order order : {Order::first, Order::second})
    EXPECT_NEAR(yields_at(plan, plan.joints[0].name, order), (b.bears - T) / (up * b.P), 1e-8);
  EXPECT_NEAR(static_check(plan).reserve, (b.bears - T) / (up * b.P), 1e-9);
}

// The lower one goes slack when (1 − up) λ P = T; from there on the upper one has all of λ P.
TEST(Prestress, ALineGoesSlackAsLoadsGrow) {
  Block b;
  b.bears = 200e3;
  const double T = 0.04 / (1 / b.k1 + 1 / b.k2), slack = T / (b.P * b.k2 / (b.k1 + b.k2));
  ASSERT_LT(slack, b.bears / b.P);
  const Plan plan = calibrate(b.scene(0.02, 0.02));
  for (const Order order : {Order::first, Order::second})
    EXPECT_NEAR(yields_at(plan, plan.joints[0].name, order), b.bears / b.P, 1e-7);
  EXPECT_EQ(yields_at(plan, plan.joints[1].name), unlimited);
  Block heavy = b;  // the check itself is beyond
  heavy.P = 150e3;
  const StaticCheck check = static_check(calibrate(heavy.scene(0.02, 0.02)));
  EXPECT_NEAR(check.joints[0].N, heavy.P, 1e-9 * heavy.P);
  EXPECT_EQ(check.joints[1].N, 0);
}

// Two lines upward, one of them too long by a gap g: u = C/k₁ where the first yields, and the second carries
// k₂ (u − g) by then.
TEST(Prestress, ALineGoesTautAsLoadsGrow) {
  const Block b;
  const double g = 0.01;
  SceneDef scene = b.scene(0, 0);
  scene.joints[1] = line("ceiling", "beam", {0, 3}, {0, 0}, b.k2, -g, Carries::tension, b.bears);
  const Plan plan = calibrate(scene);
  EXPECT_NEAR(static_check(plan).joints[0].N, b.P, 1e-9 * b.P) << "the other is slack yet";
  const double u = b.bears / b.k1;
  for (const Order order : {Order::first, Order::second}) {
    EXPECT_NEAR(yields_at(plan, plan.joints[0].name, order), (b.bears + b.k2 * (u - g)) / b.P, 1e-7);
  }
  EXPECT_NEAR(yields_at(plan, plan.joints[1].name), (b.bears + b.k1 * (b.bears / b.k2 + g)) / b.P, 1e-7);
}

TEST(Prestress, MayBeMoreThanALineBears) {
  const Block b;
  EXPECT_EQ(static_check(calibrate(b.scene(0.1, 0.1))).reserve, 0);
}

// A cantilever that hangs at its tip on a line: R = (λ P f + s)/(f + 1/k), f = L³/3EI, and its root yields at
// |λ P − R| L = M_p, be it that the line pulls too much or the load.
TEST(Prestress, ACantileverOnARope) {
  const double f = L * L * L / (3 * EI), k = 1e6, Mp = plastic_moment, P = 2 * Mp / L;
  for (const double s : {0.0, 0.2 * P / k, 0.4 * P / k, -0.1 * P * f}) {
    SceneDef scene = cantilever(20, P);
    scene.bodies.push_back(wall("crane", L - 1, L + 1));
    scene.bodies.back().at = {0, 12};
    scene.joints.push_back(line("crane", "beam", {L, 10}, {L, 0}, k, s));
    scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
    const Plan plan = calibrate(scene);
    const double g = f + 1 / k;  // λ P (1 − f/g) − s/g = M_p/L, with a taut line
    double expected = (Mp / L + s / g) / (P * (1 - f / g));
    if (expected * P * f + s < 0) expected = Mp / L / P;
    EXPECT_NEAR(yields_at(plan, "wall-beam/0", Order::second) / expected, 1, 2e-5) << s;
  }
}

// A column on pins, drawn together by a line beside it, which keeps its direction: λ P + T = π² EI/L².
TEST(Prestress, ATiedColumnBuckles) {
  const double euler = pi * pi * EI / (L * L), k = 1e9;
  for (const double T : {0.0, 0.3, 0.9}) {
    SceneDef scene = simply_supported(20, 0);
    scene.bodies.push_back(wall("rock", -2, -1));
    scene.joints = {line("rock", "beam", {-1, 0}, {L, 0}, k, T * euler / k)};
    scene.loads[0] = {.body = "beam", .at = {L, 0}, .force = {-euler / 4, 0}};
    scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
    EXPECT_NEAR(critical_load(calibrate(scene)).factor, 4 * (1 - T), 4e-3) << T;
  }
  SceneDef scene = simply_supported(20, 0);
  scene.bodies.push_back(wall("rock", -2, -1));
  scene.joints = {line("rock", "beam", {-1, 0}, {L, 0}, k, 1.1 * euler / k)};
  scene.loads[0] = {.body = "beam", .at = {L, 0}, .force = {-euler / 4, 0}};
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  EXPECT_EQ(critical_load(calibrate(scene)).factor, 0) << "the line alone buckles it";
}

// The block between two bars: the upper one yields at (C − T)/P · (k₁ + k₂)/k₁, both when λ P = 2 C.
TEST(Prestress, IsThereFromTheStartHingeByHinge) {
  const Block b;
  const double T = 0.04 / (1 / b.k1 + 1 / b.k2), up = b.k1 / (b.k1 + b.k2);
  const Plan plan = calibrate(b.scene(0.02, 0.02, Carries::both));
  const Pushover pushed = second_order_limit(plan);
  ASSERT_EQ(pushed.hinges.size(), 2u);
  EXPECT_NEAR(pushed.hinges[0].factor, (b.bears - T) / (up * b.P), 1e-7);
  EXPECT_NEAR(pushed.hinges[1].factor, 2 * b.bears / b.P, 1e-6);
  EXPECT_NEAR(pushed.load_factor, 2 * b.bears / b.P, 1e-6);
}

}  // namespace
