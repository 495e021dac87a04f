#include "ductile/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ductile/files.h"

namespace {
using namespace ductile;

constexpr double g = 10, density = 8000, E = 200e9, fy = 400e6;

BodyDef bar(double length, double height, int pieces) {
  BodyDef def;
  def.name = "bar";
  def.outline.outer = {{0, 0}, {length, 0}, {length, height}, {0, height}};
  def.material = Material{.yield_stress = fy, .youngs_modulus = E, .density = density};
  def.pieces = pieces;
  def.along = {{{0, height / 2}, {length, height / 2}}};
  return def;
}

/// Clamped at its left end by a support.
SceneDef cantilever(double length, double height, int pieces) {
  SceneDef scene;
  scene.gravity = {0, -g};
  scene.bodies = {bar(length, height, pieces)};
  scene.supports = {{.body = "bar", .at = {0, height / 2}, .fix_x = true, .fix_y = true, .fix_angle = true}};
  scene.joint.elastic = Elasticity::rigid;
  return scene;
}

TEST(Simulation, RootOfACantileverCarriesItsWeight) {
  const double L = 10, h = 1, weight = density * L * h * g;
  for (const JointSolver solver : {JointSolver::direct, JointSolver::iterative, JointSolver::stock}) {
    Simulation run(calibrate(cantilever(L, h, 1)), solver);
    for (int i = 0; i < 300; ++i) run.step();
    const JointReading root = run.joint(0);
    // Tension along the ground's x; Q > 0 would push the bar to the right of it, down; M > 0 would turn it
    // up.
    EXPECT_NEAR(root.N, 0, 1e-4 * weight);
    EXPECT_NEAR(root.Q, -weight, 1e-4 * weight);
    EXPECT_NEAR(root.M, -weight * L / 2, 1e-4 * weight * L / 2);
    EXPECT_TRUE(std::isnan(root.usage.M));  // what a support fixes is unlimited
    EXPECT_FALSE(root.broken);
  }
}

TEST(Simulation, StockAndDuctileJointsAgreeOnSigns) {
  SceneDef scene = cantilever(10, 1, 2);
  scene.gravity = {0, 0};
  scene.loads = {{.body = "bar", .at = {10, 0.5}, .force = {3e5, -2e5}, .moment = 5e5}};
  Simulation direct(calibrate(scene)),
      stock(calibrate(scene), JointSolver::stock, {.velocity_iterations = 200});
  for (int i = 0; i < 300; ++i) {
    direct.step();
    stock.step();
  }
  ASSERT_EQ(direct.plan().joints.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const bool inner = direct.plan().joints[i].a >= 0;
    const JointReading d = direct.joint(i), s = stock.joint(i);
    EXPECT_NEAR(d.N, 3e5, 30);
    EXPECT_NEAR(d.Q, -2e5, 30);
    EXPECT_NEAR(d.M, 5e5 - 2e5 * (inner ? 5 : 10), 100);
    EXPECT_NEAR(s.N, d.N, 0.02 * 3e5);
    EXPECT_NEAR(s.Q, d.Q, 0.02 * 2e5);
    EXPECT_NEAR(s.M, d.M, 0.02 * 1.5e6);
    EXPECT_EQ(std::isnan(d.usage.N), std::isnan(s.usage.N));
    if (inner) {
      EXPECT_NEAR(d.usage.N, 3e5 / (1 * fy), 1e-6);
      EXPECT_NEAR(d.usage.M, std::abs(d.M) / (0.25 * fy), 1e-9);
    }
  }
}

TEST(Simulation, LoadsAndGravityGrowAsTheyShould) {
  SceneDef scene;
  scene.gravity = {0, -g};
  scene.gravity_ramp = 1;
  scene.bodies = {bar(2, 1, 1)};
  scene.loads = {{.body = "bar", .at = {1, 0.5}, .force = {4000, 0}, .from = 0.5, .ramp = 1, .to = 2.5},
                 {.body = "bar", .at = {1, 0.5}, .moment = 600, .ramp = 0.5}};
  Simulation run(calibrate(scene));
  for (int i = 0; i < 180; ++i) run.step();
  const double mass = density * 2, inertia = mass * (4 + 1) / 12.;
  const PieceReading bar = run.piece(0);
  EXPECT_NEAR(bar.velocity.y, -g * 2.5, 1e-4);                 // ∫ over 3 s with a ramp of 1 s
  EXPECT_NEAR(bar.velocity.x, 4000 / mass * (0.5 + 1), 1e-4);  // ramp from 0.5 to 1.5, gone at 2.5
  EXPECT_NEAR(bar.angular_velocity, 600 / inertia * 2.75, 1e-4);
  EXPECT_NEAR(run.time(), 3, 1e-9);
}

TEST(Simulation, AnOverloadedJointYieldsAndBreaks) {
  SceneDef scene = cantilever(10, 1, 2);
  scene.joint.moment = density * 5 * g * 2.5 / 1.2;  // of the inner joint: 1.2 times overloaded
  scene.joint.max_rotation = 0.1;
  Simulation run(calibrate(scene));
  std::size_t inner = run.plan().joints[0].a >= 0 ? 0 : 1;
  while (!run.joint(inner).broken && run.steps() < 600) run.step();
  const JointReading broken = run.joint(inner);
  ASSERT_TRUE(broken.broken);
  EXPECT_NEAR(broken.broken_at, run.time(), 1e-9);
  EXPECT_GE(broken.accumulated_rotation, 0.1);
  EXPECT_LT(broken.accumulated_rotation, 0.12);
  EXPECT_GE(broken.capacity_used, 1);
  EXPECT_NEAR(broken.plastic_rotation, -broken.accumulated_rotation, 1e-9);
  EXPECT_NEAR(broken.dissipated, *scene.joint.moment * broken.accumulated_rotation, 1e-6 * broken.dissipated);
  EXPECT_EQ(broken.M, 0);
  EXPECT_EQ(run.built().joints[inner], nullptr);
  ASSERT_EQ(run.events().size(), 2u);
  EXPECT_EQ(run.events()[0].kind, JointEvent::yield);
  EXPECT_EQ(run.events()[1].kind, JointEvent::broke);
  EXPECT_EQ(run.events()[1].joint, static_cast<int>(inner));
  for (int i = 0; i < 60; ++i) run.step();  // the rest goes on
  EXPECT_LT(run.piece(1).position.y, -1);
}

TEST(Simulation, JointsThatGoWithABodyAreForgotten) {
  for (const JointSolver solver : {JointSolver::direct, JointSolver::iterative, JointSolver::stock}) {
    Simulation run(calibrate(cantilever(10, 1, 3)), solver);
    for (int i = 0; i < 20; ++i) run.step();
    run.world().DestroyBody(run.built().ground);
    for (int i = 0; i < 60; ++i) run.step();
    for (std::size_t i = 0; i < 3; ++i) {
      const bool support = run.plan().joints[i].a < 0;
      EXPECT_EQ(run.built().joints[i] == nullptr, support);
      if (support) {
        EXPECT_EQ(run.joint(i).M, 0);
      }
    }
    EXPECT_NEAR(run.piece(0).velocity.y, -g, 0.01 * g);
  }
}

TEST(Simulation, WhatHoldsIsReadInTheStepInWhichAnotherBreaks) {
  // A growing pull on the tag is carried by tag, bar and support, up to the cap of the tag's joint.
  constexpr double cap = 2e5;
  SceneDef scene = cantilever(10, 1, 2);
  scene.gravity = {0, 0};
  BodyDef tag = bar(1, 1, 1);
  tag.name = "tag";
  tag.at = {10, 0};
  scene.bodies.push_back(tag);
  scene.joints = {{.a = "bar", .b = "tag", .overrides = {.axial = cap, .max_elongation = 1e-3}}};
  scene.loads = {{.body = "tag", .at = {10.5, 0.5}, .force = {2 * cap, 0}, .ramp = 2}};
  Simulation run(calibrate(scene));
  ASSERT_EQ(run.plan().joints[1].name, "bar/1-tag");
  const auto piece = static_cast<std::size_t>(run.plan().joints[1].b);
  double before = 0, speed = 0;
  while (!run.joint(1).broken && run.steps() < 600) {
    before = run.joint(0).N;
    speed = run.piece(piece).velocity.x;
    run.step();
  }
  ASSERT_TRUE(run.joint(1).broken);
  EXPECT_EQ(run.joint(1).N, 0);
  EXPECT_NEAR(before, cap, 1e-6 * cap);
  // In the step of the break they carry what the tag took of the pull until it broke, by its momentum.
  const double pull = cap * (run.time() - 0.5 / 60), mass = density;
  const double held = pull - mass * (run.piece(piece).velocity.x - speed) * 60;
  EXPECT_GT(held, 0);
  EXPECT_LT(held, cap);
  EXPECT_NEAR(run.joint(0).N, held, 1e-3 * cap);
  EXPECT_NEAR(run.joint(2).N, held, 1e-3 * cap) << "the support";
}

TEST(Simulation, WheelsCarryAndDrive) {
  const SceneDef scene = parse_scene(R"({"gravity": [0, -10],
    "materials": {"m": {"density": 100, "E": 1e9, "fy": 1e7, "friction": 0.9}},
    "bodies": [
      {"name": "road", "type": "static", "outline": [[-50,-1],[50,-1],[50,0],[-50,0]], "material": "m"},
      {"name": "chassis", "outline": [[-1.5,0.5],[1.5,0.5],[1.5,1],[-1.5,1]], "material": "m"},
      {"name": "rear", "outline": {"circle": 0.4}, "at": [-1,0.4], "material": "m"},
      {"name": "front", "outline": {"circle": 0.4}, "at": [1,0.4], "material": "m"}],
    "wheels": [{"between": ["chassis","rear"], "at": [-1,0.4], "motor_speed": -10, "motor_torque": 200},
               {"between": ["chassis","front"], "at": [1,0.4]}]})");
  Simulation run(calibrate(scene));
  for (int i = 0; i < 300; ++i) run.step();
  const PieceReading chassis = run.piece(1);
  EXPECT_NEAR(chassis.velocity.x, 10 * 0.4, 0.05);
  EXPECT_NEAR(chassis.velocity.y, 0, 0.05);
  // A spring of 4 Hz with the effective mass of chassis and wheel m gives W / (2 (2π·4)² m) under half the
  // chassis.
  const double W = 100 * 3 * 0.5 * 10, wheel = 100 * 0.16 * std::numbers::pi, body = W / 10;
  const double k = std::pow(2 * std::numbers::pi * 4, 2) * wheel * body / (wheel + body);
  EXPECT_NEAR(chassis.position.y, 0.75 - W / 2 / k, 0.02);
  EXPECT_NEAR(chassis.angle, 0, 0.02);
}

TEST(Simulation, TellsTheMedianTimeOfAStepFromTheTenthOn) {
  Simulation run(calibrate(cantilever(10, 1, 2)));
  for (int i = 0; i < 9; ++i) run.step();
  EXPECT_TRUE(std::isnan(run.time_per_step_us()));
  for (int i = 0; i < 9; ++i) run.step();
  EXPECT_GT(run.time_per_step_us(), 0);
  EXPECT_LT(run.time_per_step_us(), 1e5);
}

// A block of 2.8 t falls on a clamped beam of twelve pieces: what slides under it sticks at last, and no
// solve is left unsolved on the way.
TEST(Simulation, SolvesWhatABlockDoesThatFallsOnABeam) {
  for (const double height : {18.0, 20.0, 22.0}) {
    const auto at = [height](double up) { return std::to_string(height + up); };
    Simulation run(calibrate(parse_scene(R"({"interaction": false, "bodies": [
        {"name": "L", "type": "static", "outline": [[-2, -1], [0, -1], [0, 1], [-2, 1]]},
        {"name": "R", "type": "static", "outline": [[6, -1], [8, -1], [8, 1], [6, 1]]},
        {"name": "beam", "outline": [[0, -0.1], [6, -0.1], [6, 0.1], [0, 0.1]], "depth": 0.1, "material": "S355",
         "split": {"pieces": 12}},
        {"name": "block", "outline": [[2.7, )" +
                                         at(0.1) + "], [3.3, " + at(0.1) + "], [3.3, " + at(0.7) +
                                         "], [2.7, " + at(0.7) + R"(]], "depth": 1, "material": "S355"}],
      "joints": [{"between": ["L", "beam"]}, {"between": ["beam", "R"]}]})")),
                   JointSolver::direct, {.dt = 1.0 / 30});
    while (run.time() < 4) {
      run.step();
      const StepReport& report = run.structure()->report();
      ASSERT_EQ(report.bounds_hit, report.parted) << height << " m, " << run.time() << " s";
    }
  }
}

}  // namespace
