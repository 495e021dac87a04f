// Targets come back from the simulation within 1 %.
#include "ductile/targets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "ductile/simulation.h"

namespace {
using namespace ductile;

// 6 m long, 0.3 m high, 0.1 m deep, out of a wall, with 2 t in its middle.
SceneDef bracket(int pieces) {
  SceneDef scene;
  scene.bodies = {
      {.name = "wall", .type = BodyType::static_body, .outline = {{{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {}}},
      {.name = "beam",
       .outline = {{{0, 0}, {6, 0}, {6, 0.3}, {0, 0.3}}, {}},
       .material =
           Material{.yield_stress = 300e6, .youngs_modulus = 210e9, .density = 7800, .damping_ratio = 1},
       .depth = 0.1,
       .pieces = pieces}};
  scene.joints = {{.a = "wall", .b = "beam"}};
  scene.loads = {{.body = "beam", .at = {3, 0.15}, .force = {0, -2000 * 9.81}}};
  return scene;
}

SceneDef times(SceneDef scene, double factor) {
  scene.gravity = {factor * scene.gravity.x, factor * scene.gravity.y};
  for (LoadDef& load : scene.loads) load.force = {factor * load.force.x, factor * load.force.y};
  scene.gravity_ramp = 4;
  for (LoadDef& load : scene.loads) load.ramp = 4;
  return scene;
}

bool yields(const SceneDef& scene) {
  Simulation simulation(calibrate(scene));
  for (int i = 0; i < 360; ++i) simulation.step();
  return !simulation.events().empty();
}

// "Carries 2 t in the middle with reserve 1.5": at 0.99 of 1.5 times all loads nothing yields, at 1.01 it
// does.
TEST(Targets, AReserveByYieldStress) {
  SceneDef scene = bracket(6);
  const Answer answer = yield_stress_for(scene, "beam", 1.5);
  // M_root = q L²/2 + F L/2 against f_y b h²/4.
  const double moment = 7800 * 0.1 * 0.3 * 9.81 * 18 + 2000 * 9.81 * 3;
  EXPECT_NEAR(answer.value / (1.5 * moment / (0.1 * 0.3 * 0.3 / 4)), 1, 1e-6);
  EXPECT_EQ(answer.governed_by, "M of wall-beam/0");
  scene.bodies[1].material->yield_stress = answer.value;
  EXPECT_FALSE(yields(times(scene, 1.5 * 0.99)));
  EXPECT_TRUE(yields(times(scene, 1.5 * 1.01)));
}

TEST(Targets, AReserveByDepth) {
  SceneDef scene = bracket(6);
  const Answer answer = depth_for(scene, "beam", 1.5);
  // The beam's own weight grows with it: 1.5 (w b + P) = f_y h²/4 b.
  const double weight = 7800 * 0.3 * 9.81 * 18, load = 2000 * 9.81 * 3, strength = 300e6 * 0.3 * 0.3 / 4;
  EXPECT_NEAR(answer.value / (1.5 * load / (strength - 1.5 * weight)), 1, 1e-6);
  scene.bodies[1].depth = answer.value;
  EXPECT_FALSE(yields(times(scene, 1.5 * 0.99)));
  EXPECT_TRUE(yields(times(scene, 1.5 * 1.01)));
}

// No depth carries more than what its own weight leaves.
TEST(Targets, WhatNoDepthReachesSaysWhatGoverns) {
  SceneDef scene = bracket(6);
  scene.loads.clear();
  try {
    depth_for(scene, "beam", 1e6);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("governed by M of wall-beam/0"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(yield_stress_for(scene, "nobody", 1.5), InvalidInput);
  EXPECT_THROW(yield_stress_for(scene, "beam", -1), InvalidInput);
}

TEST(Targets, ADisplacementByStiffness) {
  for (const int pieces : {1, 6}) {
    SceneDef scene = bracket(pieces);
    const Answer answer = youngs_modulus_for(scene, "beam", {6, 0.15}, 0.02);
    scene.bodies[1].material->youngs_modulus = answer.value;
    Simulation simulation(calibrate(scene));
    const auto last = simulation.plan().pieces.size() - 1;
    for (int i = 0; i < 1200; ++i) simulation.step();
    const auto at = simulation.piece(last).position;
    const Point from = simulation.plan().pieces[last].center;
    EXPECT_NEAR(std::hypot(at.x - from.x, at.y - from.y) / 0.02, 1, 0.01);
  }
}

// How far the point of the last piece that was at its free end has moved.
double sag(const Simulation& simulation) {
  const auto last = simulation.plan().pieces.size() - 1;
  const Piece& piece = simulation.plan().pieces[last];
  const auto now = simulation.piece(last);
  return now.position.y - piece.center.y + (6 - piece.center.x) * std::sin(now.angle);
}

// Under its loads the root has turned as far as the first piece.
TEST(Targets, ARotationUnderLoad) {
  SceneDef scene = bracket(6);
  const Answer answer = youngs_modulus_for_rotation(scene, "beam", "wall-beam/0", 0.004);
  EXPECT_EQ(answer.governed_by, "rotation of wall-beam/0 under the loads");
  scene.bodies[1].material->youngs_modulus = answer.value;
  Simulation simulation(calibrate(scene));
  for (int i = 0; i < 1200; ++i) simulation.step();
  EXPECT_NEAR(std::abs(simulation.piece(1).angle) / 0.004, 1, 0.01);  // piece 0 is the wall
}

// Under 0.98 of the loads at which the root yields, it has turned by 0.98 of the angle, and nothing has
// yielded; E is M_p ℓ/(I θ) with ℓ half of the first piece.
TEST(Targets, ARotationAtYield) {
  SceneDef scene = bracket(6);
  const Answer answer = youngs_modulus_for_rotation_at_yield(scene, "beam", "wall-beam/0", 0.01);
  EXPECT_NEAR(answer.value / (300e6 * 0.3 * 0.3 / 4 * 0.5 / (0.3 * 0.3 * 0.3 / 12 * 0.01)), 1, 1e-9);
  scene.bodies[1].material->youngs_modulus = answer.value;
  const double reserve = static_check(calibrate(scene)).reserve;
  Simulation simulation(calibrate(times(scene, 0.98 * reserve)));
  for (int i = 0; i < 1200; ++i) simulation.step();
  EXPECT_TRUE(simulation.events().empty());
  EXPECT_NEAR(std::abs(simulation.piece(1).angle) / 0.98 / 0.01, 1, 0.01);
}

// Let go from its static sag, the tip swings back and forth: what it does in ten turns, at a step that is too
// short for implicit Euler to change it.
TEST(Targets, AFrequency) {
  SceneDef scene = bracket(6);
  scene.gravity = {};
  scene.loads[0].to = 0.5;
  scene.loads[0].ramp = 0.5;
  scene.bodies[1].material->damping_ratio = 0;
  const Answer answer = youngs_modulus_for_frequency(scene, "beam", 2);
  scene.bodies[1].material->youngs_modulus = answer.value;
  EXPECT_NEAR(slowest_mode(calibrate(scene), "beam").frequency, 2, 1e-9);
  // A uniform cantilever's is 1.8751² √(EI/μL⁴)/2π (Euler and Bernoulli); six pieces and shear make it
  // slower.
  const double beam =
      3.5160 * std::sqrt(answer.value * 0.3 * 0.3 / 12 / (7800 * std::pow(6.0, 4))) / 2 / std::numbers::pi;
  EXPECT_NEAR(beam, 2, 0.05);

  const double dt = 1e-3;
  Simulation simulation(calibrate(scene), JointSolver::direct, {.dt = dt});
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int i = 0; crossings < 11 && i < 10'000; ++i) {
    simulation.step();
    const double now = sag(simulation), t = i * dt;
    if (t > 0.6 && before < 0 && now >= 0) {
      last = t - dt * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  ASSERT_EQ(crossings, 11);
  EXPECT_NEAR(10 / (last - first) / 2, 1, 0.01);
}

// The same, damped: each peak is exp(−2πζ/√(1 − ζ²)) of the one before.
TEST(Targets, ADamping) {
  constexpr double zeta = 0.1;
  SceneDef scene = bracket(6);
  scene.gravity = {};
  scene.loads[0].to = 0.5;
  scene.loads[0].ramp = 0.5;
  scene.bodies[1].material->youngs_modulus = youngs_modulus_for_frequency(scene, "beam", 1).value;
  scene.bodies[1].material->damping_ratio = damping_ratio_for(scene, "beam", zeta).value;
  EXPECT_NEAR(slowest_mode(calibrate(scene), "beam").damping_ratio, zeta, 1e-9);

  const double dt = 1e-4;  // implicit Euler adds ω dt/2 = 3e-4
  Simulation simulation(calibrate(scene), JointSolver::direct, {.dt = dt});
  std::vector<double> peaks;
  double before = 0, rise = 0;
  for (int i = 0; i < 40'000; ++i) {
    simulation.step();
    const double now = sag(simulation);
    if (i * dt > 0.6 && rise > 0 && now < before) peaks.push_back(before);
    rise = now - before;
    before = now;
  }
  ASSERT_GE(peaks.size(), 3u);
  const double decrement = std::log(peaks[0] / peaks[2]) / 2;
  const double measured = decrement / std::hypot(2 * std::numbers::pi, decrement);
  EXPECT_NEAR(measured / zeta, 1, 0.01);
}

// q L⁴/8EI + F (5 L³/48)/EI with what shear adds, and the simulation with so many pieces, but not with one
// less.
TEST(Targets, PiecesForAnError) {
  SceneDef scene = bracket(1);
  constexpr double L = 6, E = 210e9, I = 0.1 * 0.3 * 0.3 * 0.3 / 12, A = 0.1 * 0.3, error = 0.02;
  const double q = 7800 * A * 9.81, F = 2000 * 9.81, kGA = 5.0 / 6 * E / 2.6 * A;
  const double exact =
      q * L * L * L * L / 8 / E / I + 5 * F * L * L * L / 48 / E / I + (q * L * L / 2 + F * L / 2) / kGA;
  const Answer answer = pieces_for(scene, "beam", {6, 0.15}, error);
  for (const int off : {0, -1}) {
    scene.bodies[1].pieces = static_cast<int>(answer.value) + off;
    Simulation simulation(calibrate(scene));
    for (int i = 0; i < 1200; ++i) simulation.step();
    const double own = std::abs(-sag(simulation) / exact - 1);
    if (off == 0)
      EXPECT_LE(own, error * 1.01);
    else
      EXPECT_GT(own, error * 0.99);
  }
  EXPECT_EQ(answer.governed_by, "displacement of beam at (6, 0.15)");
  EXPECT_THROW(pieces_for(scene, "beam", {6, 0.15}, 0), InvalidInput);
}

// The far end of a weightless bracket goes down by δ with its ground: P = δ/(L³/3EI + L/κGA) bends it, and at
// a = L/2 it goes down by P (3 L a² − a³)/6EI + P a/κGA.
TEST(Targets, PiecesWhereTheGroundMoves) {
  constexpr double L = 6, a = 3, E = 210e9, EI = E * 0.1 * 0.3 * 0.3 * 0.3 / 12, settled = 0.01, error = 0.02;
  constexpr double kGA = 5.0 / 6 * E / 2.6 * 0.1 * 0.3;
  constexpr double P = settled / (L * L * L / 3 / EI + L / kGA),
                   exact = P * (3 * L * a * a - a * a * a) / 6 / EI + P * a / kGA;
  SceneDef scene = bracket(1);
  scene.gravity = {};
  scene.loads.clear();
  scene.supports = {{.body = "beam", .at = {L, 0.15}, .fix_y = true, .displacement = {0, -settled, 0}}};
  const Answer answer = pieces_for(scene, "beam", {a, 0.15}, error);
  for (const int off : {0, -1}) {
    scene.bodies[1].pieces = static_cast<int>(answer.value) + off;
    SceneDef marked = scene;
    marked.loads = {{.body = "beam", .at = {a, 0.15}}};  // finds the piece
    const Plan plan = calibrate(marked);
    const auto piece = static_cast<std::size_t>(plan.loads[0].piece);
    const StaticCheck check = static_check(plan);
    const double down = -check.displacement[piece].y - check.turn[piece] * (a - plan.pieces[piece].center.x);
    if (off == 0)
      EXPECT_LE(std::abs(down / exact - 1), error * 1.01);
    else
      EXPECT_GT(std::abs(down / exact - 1), error * 0.99);
  }
}

// A rope below the tip is slack while the bracket sags.
TEST(Targets, PiecesBesideASlackRope) {
  SceneDef scene = bracket(1);
  const double without = pieces_for(scene, "beam", {6, 0.15}, 0.02).value;
  scene.bodies.push_back({.name = "floor",
                          .type = BodyType::static_body,
                          .outline = {{{0, -6}, {7, -6}, {7, -5}, {0, -5}}, {}}});
  scene.joints.push_back(
      {.a = "floor", .b = "beam", .line = {{Point{6, -5}, Point{6, 0.15}}}, .carries = Carries::tension});
  EXPECT_EQ(pieces_for(scene, "beam", {6, 0.15}, 0.02).value, without);
}

TEST(Targets, WhatHasNoAnswerSaysSo) {
  SceneDef scene = bracket(6);
  EXPECT_THROW(youngs_modulus_for_rotation(scene, "beam", "wall-nobody", 0.01), InvalidInput);
  EXPECT_THROW(youngs_modulus_for_frequency(scene, "beam", -1), InvalidInput);
  scene.joints.clear();
  EXPECT_THROW(youngs_modulus_for_frequency(scene, "beam", 1), InvalidInput);
  scene = bracket(6);
  scene.joint.elastic = Elasticity::rigid;  // E decides nothing
  EXPECT_THROW(youngs_modulus_for_rotation(scene, "beam", "wall-beam/0", 0.01), InvalidInput);
}

}  // namespace
