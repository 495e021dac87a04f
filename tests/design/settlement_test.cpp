// Supports whose ground moves, against closed forms and slow simulations.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "ductile/design.h"
#include "ductile/simulation.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20, EI = 210e9 / 12;

// Clamped at the wall, and at its end by a support that may move.
SceneDef clamped(int pieces, std::array<double, 3> displacement) {
  SceneDef scene = cantilever(pieces, 0);
  scene.loads.clear();
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.supports = {{.body = "beam",
                     .at = {L, 0},
                     .fix_x = true,
                     .fix_y = true,
                     .fix_angle = true,
                     .displacement = displacement}};
  return scene;
}
const StaticJoint& at(const Plan& plan, const StaticCheck& check, const std::string& name) {
  return check.joints.at(static_cast<std::size_t>(joint_named(plan, name)));
}

// 6 EI δ/L² at both ends, 12 EI δ/L³ along it; bars between the pieces' middles make it exact but for rigid
// rows, which are stiffer by 1e6.
TEST(Settlement, OfAClampedBeam) {
  const double d = -1e-3;
  for (const int pieces : {4, 10, 40}) {
    const Plan plan = calibrate(clamped(pieces, {0, d, 0}));
    const StaticCheck check = static_check(plan, Order::second);
    EXPECT_NEAR(at(plan, check, "wall-beam/0").M / (6 * EI * d / L / L), 1, 1e-5) << pieces;
    EXPECT_NEAR(std::abs(at(plan, check, "support/0").M) / (6 * EI * -d / L / L), 1, 1e-5);
    EXPECT_NEAR(std::abs(at(plan, check, "support/0").Q) / (12 * EI * -d / L / L / L), 1, 1e-5);
    const StaticCheck lumped = static_check(plan);  // the support holds half a piece, which does not bend
    EXPECT_NEAR(at(plan, lumped, "wall-beam/0").M / (6 * EI * d / L / L), 1, 1.1 / pieces);
  }
}

// 4 EI θ/L where it is turned, half of that at the other end.
TEST(Settlement, OfASupportThatTurns) {
  const double turn = 1e-3;
  const Plan plan = calibrate(clamped(20, {0, 0, turn}));
  const StaticCheck check = static_check(plan, Order::second);
  EXPECT_NEAR(std::abs(at(plan, check, "support/0").M) / (4 * EI * turn / L), 1, 1e-6);
  EXPECT_NEAR(std::abs(at(plan, check, "wall-beam/0").M) / (2 * EI * turn / L), 1, 1e-6);
  EXPECT_NEAR(check.turn.back() / turn, 1, 0.1);  // of the last piece, half a piece from the end
  EXPECT_GT(check.turn.back(), 0);
}

// N = EA u/(L − L/2n) of a bar that is pulled: half of its last piece is rigid. A support's axis is [1, 0],
// so what holds the bar back at its right end is negative.
TEST(Settlement, PullsABar) {
  SceneDef scene = clamped(10, {1e-3, 0, 0});
  scene.joint.stiffness_axial.reset();
  const Plan plan = calibrate(scene);
  for (const Order order : {Order::first, Order::second}) {
    const StaticCheck check = static_check(plan, order);
    EXPECT_NEAR(at(plan, check, "support/0").N / (-210e9 * 1e-3 / (L - L / 20)), 1, 1e-5);
    EXPECT_NEAR(at(plan, check, "wall-beam/0").N / at(plan, check, "support/0").N, -1, 1e-9);
  }
}

TEST(Settlement, LeavesAStaticallyDeterminateBeamWithoutForces) {
  SceneDef scene = simply_supported(10, 0);
  scene.loads.clear();
  scene.supports[1].displacement = {0, -0.1, 0};
  const Plan plan = calibrate(scene);
  const StaticCheck check = static_check(plan);
  for (const StaticJoint& joint : check.joints) EXPECT_NEAR(joint.M, 0, 1e-3);  // of 6 EI δ/L² = 2.6e7
  for (const double turn : check.turn) EXPECT_NEAR(turn / (-0.1 / L), 1, 1e-6);
  EXPECT_EQ(check.reserve, unlimited);
}

// δ is shared by the spring and the beam: R = δ/(1/k + L³/3EI).
TEST(Settlement, OfASpring) {
  SceneDef scene = clamped(40, {0, -0.01, 0});
  scene.supports = {
      {.body = "beam", .at = {L, 0}, .stiffness_y = 3 * EI / L / L / L, .displacement = {0, -0.01, 0}}};
  const Plan plan = calibrate(scene);
  const double R = 0.01 * 3 * EI / L / L / L / 2;
  EXPECT_NEAR(std::abs(at(plan, static_check(plan, Order::second), "support/0").Q) / R, 1, 1e-6);
}

// --- grounds that move under a column: k² = P/EI, φ = kL ---

// Holds the column at s from its foot, and moves `by` to its left and by `turn`.
struct Held {
  double s;
  bool along = false, across = false, angle = false;
  double by = 0, turn = 0;
  double spring_across = 0, spring_angle = 0;
};
// What it carries across the column, to the left, and its moment.
struct Reaction {
  double Q, M;
};

// From (0, 0) to the right, or up, under P at its end.
SceneDef column(const std::vector<Held>& held, double P, bool upright) {
  const auto turned = [&](Point p) { return upright ? Point{-p.y, p.x} : p; };
  SceneDef scene = bending_only();
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.bodies = {beam(20)};
  if (upright) scene.bodies[0].outline = {rectangle(-0.5, 0, 0.5, L), {}};
  scene.bodies[0].along = {Point{}, turned({L, 0})};
  for (const Held& h : held) {
    SupportDef support{.body = "beam", .at = turned({h.s, 0}), .fix_angle = h.angle};
    (upright ? support.fix_y : support.fix_x) = h.along;
    (upright ? support.fix_x : support.fix_y) = h.across;
    (upright ? support.stiffness_x : support.stiffness_y) = h.spring_across;
    support.stiffness_angle = h.spring_angle;
    const Point by = turned({0, h.by});
    support.displacement = {by.x, by.y, h.turn};
    scene.supports.push_back(support);
  }
  scene.loads = {{.body = "beam", .at = turned({L, 0}), .force = turned({-P, 0})}};
  return scene;
}

// Forces act where the grounds have gone: a column that goes with them carries nothing across, one that leans
// P δ/L, and one that is bent by them what the equation of beam-columns says, (y'' + k² y)'' = 0.
TEST(Settlement, UnderAColumn) {
  const double d = 0.02, turn = 1e-3, k = 0.3 * EI / L / L / L, c = 6 * EI / L;
  const Held pin{.s = 0, .along = true, .across = true},
      clamp{.s = 0, .along = true, .across = true, .angle = true}, top{.s = L, .across = true};
  const auto moved = [](Held held, double by, double turn = 0) {
    held.by = by;
    held.turn = turn;
    return held;
  };
  Held foot = pin;
  foot.spring_angle = c;
  foot.turn = turn;
  for (const double phi : {0.3, 0.5, 1.2}) {
    const double P = phi * phi * EI / L / L, lean = P * d / L, t = L * std::tan(phi) / phi;
    const double H = lean / (std::tan(phi) / phi - 1), sprung = k * d * P / (k * L - P);
    struct Case {
      std::string what;
      std::vector<Held> held;
      std::vector<Reaction> reactions;
    };
    std::vector<Case> cases = {
        {"pins that both move", {moved(pin, d), moved(top, d)}, {{0, 0}, {0, 0}}},
        {"a clamped foot that moves", {moved(clamp, d)}, {{0, 0}}},
        {"a head that moves, on a pin", {pin, moved(top, d)}, {{-lean, 0}, {lean, 0}}},
        {"a foot that moves, a pin", {moved(pin, d), top}, {{lean, 0}, {-lean, 0}}},
        {"a head that is pushed", {clamp, moved(top, d)}, {{H, H * L + P * d}, {-H, 0}}},
        {"a clamped foot that is pushed", {moved(clamp, d), top}, {{-H, -H * L - P * d}, {H, 0}}},
        {"a foot that turns", {moved(clamp, 0, turn)}, {{0, P * turn * t}}},
        {"a foot that turns on a spring", {foot}, {{0, P * turn * t * c / (c - P * t)}}}};
    if (P < k * L)  // on which it leans
      cases.push_back({"a spring whose ground moves",
                       {pin, {.s = L, .by = d, .spring_across = k}},
                       {{-sprung, 0}, {sprung, 0}}});
    for (const Case& each : cases)
      for (const bool upright : {false, true}) {
        const StaticCheck check = static_check(calibrate(column(each.held, P, upright)), Order::second);
        for (std::size_t i = 0; i < each.held.size(); ++i) {
          const StaticJoint& support = check.joints.at(check.joints.size() - each.held.size() + i);
          const Reaction& exact = each.reactions[i];
          EXPECT_NEAR(upright ? -support.N : support.Q, exact.Q, 1e-3 * std::max(std::abs(exact.Q), lean))
              << each.what << i << upright << phi;
          EXPECT_NEAR(support.M, exact.M, 1e-3 * std::max(std::abs(exact.M), P * d))
              << each.what << i << upright << phi;
        }
      }
  }
}

// Its head pushed as far as it buckles on one hinge, a column leans on what pushes it: λ P λ δ + M_p = H L,
// with the hinge at its foot. Of second order check() has it yield where the hinges begin to form.
TEST(Settlement, PushesAColumnUntilItGoes) {
  const double P = EI / L / L / 2;
  SceneDef scene =
      column({{.s = 0, .along = true, .across = true, .angle = true}, {.s = L, .across = true, .by = 0.3}}, P,
             false);
  const Plan plan = calibrate(scene);
  const Pushover pushed = second_order_limit(plan);
  ASSERT_FALSE(pushed.hinges.empty());
  EXPECT_NEAR(static_check(plan, Order::second).reserve / pushed.hinges.front().factor, 1, 5e-3);
  const std::array<double, 3> foot =
                                  pushed.forces.at(static_cast<std::size_t>(joint_named(plan, "support/0"))),
                              head =
                                  pushed.forces.at(static_cast<std::size_t>(joint_named(plan, "support/1")));
  const double by = 0.3 * pushed.load_factor;
  EXPECT_NEAR(foot[1] + head[1], 0, 1e-6 * std::abs(head[1]));
  EXPECT_NEAR((foot[2] + head[1] * L) / (pushed.load_factor * P * by), 1, 1e-2) << "half a piece is rigid";
}

// A support that moves in 4 s, as it is at rest afterwards.
TEST(Settlement, IsThatOfASlowSimulation) {
  for (const std::array<double, 3> by : {std::array{0., -5e-3, 0.}, std::array{0., 0., 2e-3}}) {
    SceneDef scene = clamped(8, by);
    scene.supports[0].ramp = 4;
    scene.supports[0].fix_x = false;  // or it would hang as a rope
    for (BodyDef& body : scene.bodies)
      if (body.material) body.material->damping_ratio = 1;
    const Plan plan = calibrate(scene);
    const StaticCheck check = static_check(plan);
    Simulation simulation(plan, JointSolver::direct, {}, true);
    while (simulation.time() < 2) simulation.step();
    const auto support = static_cast<std::size_t>(joint_named(plan, "support/0"));
    EXPECT_NEAR(simulation.joint(support).M / check.joints[support].M, 0.5, 0.01);
    while (simulation.time() < 10) simulation.step();
    for (std::size_t i = 0; i < plan.joints.size(); ++i) {
      EXPECT_NEAR(simulation.joint(i).M, check.joints[i].M, 2e-3 * std::abs(check.joints[support].M));
      EXPECT_EQ(simulation.joint(i).accumulated_rotation, 0);
      EXPECT_EQ(simulation.joint(i).dissipated, 0);
    }
    const double work = simulation.ledger()->energy().external;  // ½ M θ, ½ Q δ
    const double stored = std::abs(by[1] * check.joints[support].Q + by[2] * check.joints[support].M) / 2;
    EXPECT_NEAR(work / stored, 1, 0.02);
    EXPECT_NEAR(simulation.ledger()->energy().total_error, 0, 1e-3 * work);
  }
}

// Displacement control: the tip of a cantilever pushed down goes plastic at the root at δ = M_p L²/3EI, and
// then resists with M_p/L, however far it is pushed.
TEST(Settlement, PushesUntilHingesForm) {
  SceneDef scene = clamped(20, {0, -0.1, 0});
  scene.supports[0].fix_x = scene.supports[0].fix_angle = false;
  const Plan plan = calibrate(scene);
  const Pushover pushed = second_order_limit(plan);
  ASSERT_EQ(pushed.hinges.size(), 1u);
  EXPECT_EQ(pushed.hinges[0].joint, joint_named(plan, "wall-beam/0"));
  const double yields = plastic_moment * L * L / 3 / EI;
  EXPECT_NEAR(pushed.hinges[0].factor * 0.1 / yields, 1, 5e-3);  // lumped: 1/2n² + …
  EXPECT_EQ(pushed.load_factor, unlimited);
  const auto support = static_cast<std::size_t>(joint_named(plan, "support/0"));
  EXPECT_NEAR(std::abs(pushed.forces[support][1]) / (plastic_moment / L), 1, 1e-3);
  EXPECT_NEAR(static_check(plan).reserve / pushed.hinges[0].factor, 1, 1e-3);
}

// What supports settle by does not change a rigid-plastic collapse load: 6 M_p/L in the middle of a propped
// cantilever.
TEST(Settlement, DoesNotChangeTheCollapseLoad) {
  SceneDef scene = propped(20, 1);
  scene.loads[0].force.y = -6 * plastic_moment / L;
  const Plan plain = calibrate(scene);
  scene.supports[0].displacement = {0, -0.05, 0};
  const Plan settled = calibrate(scene);
  EXPECT_EQ(limit_analysis(settled).load_factor, limit_analysis(plain).load_factor);
  const Pushover without = second_order_limit(plain), with = second_order_limit(settled);
  EXPECT_NEAR(with.load_factor / without.load_factor, 1, 1e-3);
  ASSERT_EQ(with.hinges.size(), 2u);
  EXPECT_GT(std::abs(with.hinges[0].factor / without.hinges[0].factor - 1), 0.01);  // but when hinges form
}

// What collides with nothing has no fixtures, and may be as thin as a leaf spring: it bends as statics say.
TEST(Settlement, BendsAThinStripThatNothingTouches) {
  SceneDef scene = cantilever(8, 0);
  scene.bodies[1] = beam(8, 0.5, 0.004);
  scene.bodies[1].material->damping_ratio = 1;
  scene.loads = {{.body = "beam", .at = {0.5, 0}, .force = {0, -100}, .ramp = 2}};
  EXPECT_THROW(Simulation{calibrate(scene)}, InvalidInput);
  scene.bodies[1].collides = false;
  const Plan plan = calibrate(scene);
  Simulation simulation(plan);
  while (simulation.time() < 6) simulation.step();
  EXPECT_EQ(simulation.built().bodies.back()->GetFixtureList(), nullptr);
  const auto root = static_cast<std::size_t>(joint_named(plan, "wall-beam/0"));
  EXPECT_NEAR(simulation.joint(root).M / (-100 * 0.5), 1, 1e-3);
  EXPECT_NEAR(static_check(plan).joints[root].M / (-100 * 0.5), 1, 1e-9);
}

TEST(Settlement, OfFreeRowsOrWithoutAnEndIsRefused) {
  SceneDef scene = clamped(4, {0, 0, 1e-3});
  scene.supports[0].fix_angle = false;
  EXPECT_THROW(calibrate(scene), InvalidInput);
  scene = clamped(4, {0, std::nan(""), 0});
  EXPECT_THROW(calibrate(scene), InvalidInput);
  scene = clamped(4, {0, 0, 0});
  scene.supports[0].ramp = 2;
  EXPECT_THROW(calibrate(scene), InvalidInput);
  scene = clamped(4, {0, -0.1, 0});
  EXPECT_THROW(leave_out(calibrate(scene)), InvalidInput);
  EXPECT_THROW(limit_analysis(calibrate(scene)), InvalidInput);  // nothing to multiply
}

}  // namespace
