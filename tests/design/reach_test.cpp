// What a scene reaches, verified by running it: within 1 %.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ductile/plane.h"
#include "ductile/rolled.h"
#include "ductile/simulation.h"
#include "ductile/targets.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20;

// A cantilever of two bodies, 1 m high, the outer one half as deep; overdamped, loads at their full size
// after 4 s.
SceneDef stepped() {
  SceneDef scene = cantilever(8, 0);
  scene.bodies[1] = beam(4, L / 2);
  BodyDef outer = beam(4, L / 2);
  outer.name = "outer";
  outer.at = {L / 2, 0};
  outer.depth = 0.5;
  scene.bodies.push_back(outer);
  for (BodyDef& body : scene.bodies)
    if (body.material) body.material->damping_ratio = 1;
  scene.joints.push_back({.a = "beam", .b = "outer"});
  scene.loads = {{.body = "outer", .at = {L, 0}, .force = {0, -2e6}, .ramp = 4}};
  return scene;
}
const std::vector<std::size_t> both{1, 2};

Simulation at_rest(const SceneDef& scene) {
  Simulation simulation(calibrate(scene));
  while (simulation.time() < 12) simulation.step();
  return simulation;
}

// The largest displacement of any corner.
double moved(const Simulation& simulation) {
  double most = 0;
  for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i) {
    const Piece& piece = simulation.plan().pieces[i];
    const auto now = simulation.piece(i);
    const double c = std::cos(now.angle), s = std::sin(now.angle);
    for (const Point& p : piece.outline.outer) {
      const Point arm = p - piece.center;
      most = std::max(most, length(now.position + Point{c * arm.x - s * arm.y, s * arm.x + c * arm.y} - p));
    }
  }
  return most;
}

TEST(Reach, ADisplacementByDepth) {
  const Reach found = reach(stepped(), both, Property::depth, Measure::displacement, 0.05);
  EXPECT_NEAR(found.reached / 0.05, 1, 1e-9);
  EXPECT_EQ(found.value, found.scene.bodies[1].depth);
  EXPECT_NEAR(found.scene.bodies[2].depth / found.value, 0.5, 1e-12) << "in proportion";
  EXPECT_NEAR(moved(at_rest(found.scene)) / 0.05, 1, 0.01);
}

TEST(Reach, ARotationByStiffness) {
  const Reach found = reach(stepped(), both, Property::youngs_modulus, Measure::rotation, 0.001);
  EXPECT_NEAR(found.reached / 0.001, 1, 1e-9);
  const Simulation simulation = at_rest(found.scene);
  double most = 0, before = 0;  // in a row: piece 0 is the wall
  for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i) {
    most = std::max(most, std::abs(simulation.piece(i).angle - before));
    before = simulation.piece(i).angle;
  }
  EXPECT_NEAR(most / 0.001, 1, 0.01);
}

bool yields(SceneDef scene, double factor) {
  for (LoadDef& load : scene.loads) load.force = factor * load.force;
  return !at_rest(scene).events().empty();
}

// M_p of the root: f_y b h²/4 = 1.5 P L.
TEST(Reach, AReserveByYieldStress) {
  const Reach found = reach(stepped(), both, Property::yield_stress, Measure::reserve, 1.5);
  EXPECT_NEAR(found.value / (1.5 * 2e6 * L * 4), 1, 1e-9);
  EXPECT_FALSE(yields(found.scene, 1.5 * 0.99));
  EXPECT_TRUE(yields(found.scene, 1.5 * 1.01));
}

// 8 M_p/L, M_p = 350e6 b/4.
TEST(Reach, ACollapseLoadByDepth) {
  SceneDef scene = fixed_fixed(4, 1e7);
  scene.bodies[2].material->damping_ratio = 1;
  scene.loads[0].ramp = 8;
  const Reach found = reach(scene, {2}, Property::depth, Measure::collapse, 2);
  EXPECT_NEAR(found.value / (2 * 1e7 * L / 8 / (350e6 / 4)), 1, 1e-6);
  for (const double factor : {0.99, 1.01}) {
    SceneDef pushed = found.scene;
    pushed.loads[0].force.y *= 2 * factor;
    Simulation simulation(calibrate(pushed));
    while (simulation.time() < 12) simulation.step();
    EXPECT_EQ(moved(simulation) > 1, factor > 1) << factor;
  }
}

TEST(Reach, AMassByDepth) {
  const Reach found = reach(stepped(), both, Property::depth, Measure::mass, 1e5);
  EXPECT_NEAR(found.value, 1e5 / (7800 * L / 2 * 1.5), 1e-9);
}

// Plucked and let go.
double swings_per_second(SceneDef scene, double expected) {
  for (BodyDef& body : scene.bodies)
    if (body.material) body.material->damping_ratio = 0;
  scene.loads[0].ramp = scene.loads[0].to = 2 / expected;
  const double dt = 0.005 / expected;
  Simulation simulation(calibrate(scene), JointSolver::direct, {.dt = dt});
  const std::size_t last = simulation.plan().pieces.size() - 1;
  const double rest = simulation.piece(last).position.y;
  double before = 0, first = 0, end = 0;
  int crossings = 0;
  for (int i = 0; crossings < 6 && i < 4000; ++i) {
    simulation.step();
    const double now = simulation.piece(last).position.y - rest;
    if (simulation.time() > 2.2 / expected && before < 0 && now >= 0) {
      end = simulation.time() - dt * now / (now - before);
      if (crossings++ == 0) first = end;
    }
    before = now;
  }
  EXPECT_EQ(crossings, 6);
  return 5 / (end - first);
}

// The lightest IPE with 20 Hz as a cantilever of 4 m, and that the next lighter one has less.
TEST(Reach, AFrequencyByProfile) {
  SceneDef scene = cantilever(8, 1e3);
  scene.bodies[1] = beam(8, 4, 0.2);
  scene.loads[0].at = {4, 0.1};
  std::vector<SceneDef> candidates;
  for (const char* name : {"IPE 360", "IPE 200", "IPE 240", "IPE 300", "IPE 270"}) {
    candidates.push_back(scene);
    set_profile(candidates.back(), 1, {{draw(rolled(name)).outline, test_steel}}, name);
  }
  const Reach found = lightest(candidates, Measure::frequency, 19);
  EXPECT_EQ(found.value, 4) << "IPE 270";
  EXPECT_GE(found.reached, 19);
  // 1.8751² √(EI/μL⁴)/2π (Euler and Bernoulli); shear and pieces make it slower by a few per cent.
  const double beam =
      3.5160 * std::sqrt(210e9 * 5790e-8 / (7800 * 45.9e-4 * std::pow(4.0, 4))) / 2 / std::numbers::pi;
  EXPECT_NEAR(found.reached / beam, 1, 0.05);
  EXPECT_NEAR(swings_per_second(found.scene, found.reached) / found.reached, 1, 0.01);
  EXPECT_LT(measured(calibrate(candidates[2]), Measure::frequency), 19);
  // The load rode on the upper edge: it still does.
  EXPECT_NEAR(found.scene.loads[0].at.y, 0.135, 1e-12);
}

TEST(Reach, PiecesInTheirOrder) {
  std::vector<SceneDef> candidates;
  for (int n = 1; n <= 12; ++n) {
    candidates.push_back(cantilever(n, 1e6));
    candidates.back().joint.stiffness_shear = unlimited;
  }
  // P L³/3EI (1 + 1/2n²) of n pieces with the load at the tip, whose corners turn besides: below 1.02 from 5
  // on.
  const double exact = 1e6 * L * L * L / 3 / (210e9 / 12);
  const Reach found = first_to_reach(candidates, Measure::displacement, 1.0201 * exact);
  EXPECT_LT(found.value, 12);
  for (int n = 0; n < static_cast<int>(found.value); ++n)
    EXPECT_GT(measured(calibrate(candidates[static_cast<std::size_t>(n)]), Measure::displacement),
              1.0201 * exact);
  EXPECT_NEAR(moved(at_rest(found.scene)) / found.reached, 1, 0.01);
}

// Of two structures, the slower one counts.
TEST(Reach, TheSlowestOfAllStructures) {
  SceneDef scene = cantilever(4, 0);
  BodyDef other = beam(4, L, 0.5);
  other.name = "other";
  other.at = {0, 1.25};
  scene.bodies.push_back(other);
  scene.joints.push_back({.a = "wall", .b = "other"});
  const Plan plan = calibrate(scene);
  const double slow = slowest_mode(plan, "other").frequency;
  EXPECT_GT(slowest_mode(plan, "beam").frequency, 1.5 * slow);
  EXPECT_NEAR(slowest_mode(plan).frequency / slow, 1, 1e-8);
}

// A mast that carries P along and H across its tip: with φ = L √(P/EI) the tip moves by H L³/3EI · 3 (tan φ −
// φ)/φ³ and turns by H L²/2EI · 2 (1 − cos φ)/φ² cos φ (Timoshenko and Gere, Theory of Elastic Stability,
// 1.11), its corners by half a metre of that besides.
SceneDef mast(double P, double H) {
  SceneDef scene = cantilever(20, 0);
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.bodies[1].material->damping_ratio = 1;
  scene.loads[0].force = {-P, -H};
  scene.loads[0].ramp = 8;
  return scene;
}
constexpr double P = 40e6, H = 1e6;

TEST(Reach, ADisplacementOfSecondOrder) {
  const Reach found =
      reach(mast(P, H), {1}, Property::youngs_modulus, Measure::displacement, 0.4, Order::second);
  const double EI = found.value / 12, phi = L * std::sqrt(P / EI);
  const double moves = H * L * L * L / EI * (std::tan(phi) - phi) / (phi * phi * phi);
  const double turns = H * L * L / EI * (1 - std::cos(phi)) / (phi * phi * std::cos(phi));
  EXPECT_NEAR(std::hypot(moves, turns / 2) / 0.4, 1, 2e-3);
  EXPECT_LT(measured(calibrate(found.scene), Measure::displacement), 0.25) << "of first order";
  EXPECT_NEAR(moved(at_rest(found.scene)) / 0.4, 1, 0.01);
}

// The foot's moment, H L tan φ/φ, is M_p = 350e6 b/4.
TEST(Reach, ACollapseOfSecondOrder) {
  const Reach found = reach(mast(P, H), {1}, Property::depth, Measure::collapse, 1.5, Order::second);
  const double phi = L * std::sqrt(1.5 * P / (210e9 / 12 * found.value));
  EXPECT_NEAR(1.5 * H * L * std::tan(phi) / phi / (350e6 / 4 * found.value), 1, 5e-3);
  EXPECT_GT(measured(calibrate(found.scene), Measure::collapse), 2) << "of first order";
  for (const double factor : {0.98, 1.02}) {
    SceneDef pushed = found.scene;
    pushed.loads[0].force = 1.5 * factor * pushed.loads[0].force;
    EXPECT_EQ(moved(at_rest(pushed)) > 2, factor > 1) << factor;
  }
}

TEST(Reach, WhatCannotBeSaysSo) {
  EXPECT_THROW(reach(stepped(), both, Property::youngs_modulus, Measure::reserve, 2), InvalidInput);
  EXPECT_THROW(reach(stepped(), both, Property::depth, Measure::reserve, -1), InvalidInput);
  EXPECT_THROW(reach(stepped(), {0}, Property::yield_stress, Measure::reserve, 2), InvalidInput)
      << "the wall";
  EXPECT_THROW(lightest({stepped()}, Measure::mass, 1), InvalidInput);
}

}  // namespace
