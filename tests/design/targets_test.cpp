// Targets come back from the simulation within 1 %.
#include "ductile/targets.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
