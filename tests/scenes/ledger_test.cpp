// Every joule is somewhere: what the ledger cannot place stays below a thousandth of the energy turned over.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ductile/files.h"
#include "ductile/scene_list.h"
#include "ductile/simulation.h"

namespace {
using namespace ductile;

constexpr double g = 10, density = 1000;

/// A run with a ledger.
struct Booked {
  Simulation simulation;

  explicit Booked(const SceneDef& scene, JointSolver solver = JointSolver::direct,
                  const Stepping& stepping = {})
      : simulation(calibrate(scene), solver, stepping, true) {}
  Energy steps(int n) {
    for (int i = 0; i < n; ++i) simulation.step();
    return simulation.ledger()->energy();
  }
  void expect_balance(double share = 1e-3, double from_nowhere = 1e-4) const {
    const Energy& e = simulation.ledger()->energy();
    const double turnover = simulation.ledger()->turnover();
    // Energies are read off Box2D's floats: what sags less than they resolve cannot be told.
    double resolved = 0;
    for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i) {
      const Point p = simulation.piece(i).position;
      resolved +=
          simulation.plan().pieces[i].mass * g * 1.2e-7 * std::max({std::abs(p.x), std::abs(p.y), 1.});
    }
    const double nowhere = share > 1e-3 ? share : std::min(share, from_nowhere);
    EXPECT_TRUE(e.total_error <= std::max(nowhere * turnover, resolved) &&
                e.total_error >= -std::max(share * turnover, resolved))
        << "turnover " << turnover << ": kinetic " << e.kinetic << ", potential " << e.potential
        << ", elastic " << e.elastic << ", external " << e.external << ", dissipated " << e.dissipated
        << ", damping " << e.damping << ", contacts " << e.contacts << ", numerical " << e.numerical
        << ", clamped " << e.clamped << ", error " << e.total_error;
  }
};

BodyDef box(const char* name, double x, double y, double width, double height, double friction = 0.5,
            double restitution = 0) {
  BodyDef def;
  def.name = name;
  def.outline.outer = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  def.at = {x, y};
  def.material = Material{.yield_stress = 1e8,
                          .youngs_modulus = 1e11,
                          .density = density,
                          .friction = friction,
                          .restitution = restitution};
  return def;
}
BodyDef floor(double friction = 0.5) {
  BodyDef def = box("floor", -100, -1, 200, 1, friction);
  def.type = BodyType::static_body;
  return def;
}

TEST(Ledger, FreeFallLosesWhatTheIntegrationLoses) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {box("stone", 0, 0, 1, 1)}};
  Booked run(scene);
  const Energy e = run.steps(60);
  const double m = density;
  EXPECT_NEAR(e.kinetic, m * 100 / 2, 1e-3 * m * 100);
  // Semi-implicit Euler falls g h t/2 farther than it should.
  EXPECT_NEAR(e.numerical, m * g * (10. / 60 / 2), 1e-3 * m);
  run.expect_balance(1e-5);
}

TEST(Ledger, ADisabledBodyStandsStill) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {box("stone", 0, 0, 1, 1)}};
  Booked run(scene);
  run.steps(30);
  run.simulation.built().bodies[0]->SetEnabled(false);
  run.steps(30);
  run.simulation.built().bodies[0]->SetEnabled(true);
  const Energy e = run.steps(30);
  EXPECT_NEAR(e.kinetic, density * 100 / 2, 1e-3 * density * 100);
  run.expect_balance(1e-5);
}

TEST(Ledger, ASlidingBlockLeavesItsEnergyToTheContacts) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {floor(), box("block", 0, 0, 2, 1)}};
  scene.bodies[1].velocity = {5, 0};
  Booked run(scene);
  const Energy e = run.steps(240);
  EXPECT_NEAR(e.contacts, -density * 2 * 25 / 2, 0.02 * density * 25);
  EXPECT_NEAR(e.kinetic, 0, 1e-3 * density);
  run.expect_balance();
}

TEST(Ledger, DropsAndBounces) {
  for (const double restitution : {0.0, 0.6}) {
    SceneDef scene{.gravity = {0, -g}, .bodies = {floor(), box("block", 0, 3, 1, 1, 0.5, restitution)}};
    scene.bodies[1].angle = 0.3;
    Booked run(scene);
    const Energy e = run.steps(300);
    EXPECT_LT(e.contacts, 0);
    run.expect_balance();
  }
}

TEST(Ledger, FastBodiesAreStoppedByContinuousCollision) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {floor(), box("shot", 0, 5, 0.3, 0.3)}};
  scene.bodies[1].velocity = {20, -60};
  Booked run(scene);
  run.steps(120);
  run.expect_balance();
}

TEST(Ledger, WhatTheSpeedLimitTakesIsSaid) {
  SceneDef scene{.gravity = {0, 0}, .bodies = {box("shot", 0, 0, 1, 1)}};
  scene.bodies[0].velocity = {300, 0};
  Booked run(scene);
  const Energy e = run.steps(10);
  EXPECT_NEAR(e.clamped, density * (300. * 300 - 120. * 120) / 2, 1e-3 * density * 300 * 300);
  run.expect_balance(1e-5);
}

TEST(Ledger, LoadsWorkAlongTheWayThatTheyPush) {
  SceneDef scene{.gravity = {0, 0}, .bodies = {box("sled", 0, 0, 2, 1)}};
  scene.loads = {{.body = "sled", .at = {0.1, 0.2}, .force = {3000, 500}, .moment = 200, .ramp = 1}};
  Booked run(scene);
  const Energy e = run.steps(180);
  EXPECT_NEAR(e.external, e.kinetic, 0.05 * e.kinetic);
  run.expect_balance(1e-4);
}

TEST(Ledger, GravityThatGrowsDoesWork) {
  SceneDef scene{.gravity = {0, -g}, .gravity_ramp = 2, .bodies = {box("stone", 0, 0, 1, 1)}};
  Booked run(scene);
  const Energy e = run.steps(120);
  // v = g t²/2T, y = −g t³/6T: of the weight now and the way gone, two thirds became speed… the rest was
  // outside's.
  EXPECT_NEAR(e.kinetic, density * 100 / 2, 0.02 * density * 50);
  EXPECT_NEAR(e.potential, -density * g * g * 4 / 6, 0.02 * density * 66);
  EXPECT_NEAR(e.external, e.kinetic + e.potential, 0.02 * density * 66);
  run.expect_balance(1e-4);
}

SceneDef cantilever(int pieces, Elasticity elastic) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {box("beam", 0, 0, 10, 0.5)}};
  scene.bodies[0].pieces = pieces;
  scene.bodies[0].along = {{{0, 0.25}, {10, 0.25}}};
  scene.supports = {{.body = "beam", .at = {0, 0.25}, .fix_x = true, .fix_y = true, .fix_angle = true}};
  scene.joint.elastic = elastic;
  return scene;
}

TEST(Ledger, SwingingBendingAndBreakingBeams) {
  for (const Elasticity elastic : {Elasticity::true_stiffness, Elasticity::rigid}) {
    for (const double overload : {0.5, 1.3}) {
      SceneDef scene = cantilever(8, elastic);
      scene.joint.moment =
          density * 0.5 * g * 8.75 * 8.75 / 2 / overload;  // of the joint next to the support
      scene.joint.max_rotation = 0.4;
      Booked run(scene);
      const Energy e = run.steps(240);
      if (overload > 1) {
        EXPECT_GT(e.dissipated, 0);
      }
      run.expect_balance();
    }
  }
}

TEST(Ledger, ABombOnABeam) {
  SceneDef scene = cantilever(8, Elasticity::true_stiffness);
  scene.joint.moment = density * 0.5 * g * 100 / 2 * 2;
  scene.bodies.push_back(box("bomb", 7, 3, 0.8, 0.8));
  scene.bodies[1].velocity = {0, -20};
  Booked run(scene);
  const Energy e = run.steps(240);
  EXPECT_GT(e.dissipated, 0);
  EXPECT_LT(e.contacts, 0);
  run.expect_balance();
}

TEST(Ledger, SoftStockWelds) {
  SceneDef scene = cantilever(1, Elasticity::true_stiffness);
  scene.supports.clear();
  scene.bodies.push_back(box("wall", -1, -1, 1, 3));
  scene.bodies[1].type = BodyType::static_body;
  scene.joints = {
      {.a = "wall", .b = "beam", .overrides = {.elastic = Elasticity::frequency, .frequency = 1}}};
  Booked run(scene, JointSolver::stock);
  const Energy e = run.steps(300);
  EXPECT_GT(e.elastic, 0);
  EXPECT_GT(e.damping, 0);
  run.expect_balance(0.01);  // what Box2D's position correction does is nobody's
}

TEST(Ledger, AMotorDrivesACar) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {floor(0.9), box("chassis", -1.5, 0.5, 3, 0.5)}};
  for (const char* name : {"rear", "front"}) {
    BodyDef wheel;
    wheel.name = name;
    wheel.circle = 0.4;
    wheel.at = {name[0] == 'r' ? -1. : 1., 0.4};
    wheel.material = scene.bodies[1].material;
    wheel.material->friction = 0.9;
    scene.bodies.push_back(wheel);
    scene.wheels.push_back({.chassis = "chassis", .wheel = name, .at = wheel.at});
  }
  scene.wheels[0].motor_speed = -20;
  scene.wheels[0].motor_torque = 1000;
  Booked run(scene);
  const Energy e = run.steps(300);
  EXPECT_GT(e.external, 0.9 * e.kinetic);
  run.expect_balance();
}

TEST(Ledger, AUsersHandIsOutsideWork) {
  SceneDef scene{.gravity = {0, 0}, .bodies = {box("stone", 0, 0, 1, 1)}};
  Booked run(scene);
  run.steps(10);
  run.simulation.built().bodies[0]->SetLinearVelocity({3, 0});
  const Energy e = run.steps(10);
  EXPECT_NEAR(e.external, density * 9 / 2, 1e-3 * density);
  run.expect_balance(1e-6);
}

class LedgerOfScene : public testing::TestWithParam<SceneEntry> {};

TEST_P(LedgerOfScene, Balances) {
  const SceneEntry& entry = GetParam();
  Booked run(read_scene(std::string(DUCTILE_SOURCE_DIR "/scenes/") + std::string(entry.name) + ".scene.json"),
             JointSolver::direct);
  run.steps(static_cast<int>(std::min(entry.seconds, 5.) * 60));
  // Corrections of overlap, see scene_list_test.cpp.
  run.expect_balance(1e-3, std::string_view(entry.name) == "frame_heavy_bomb" ? 2e-4 : 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, LedgerOfScene, testing::ValuesIn(scene_list), [](const auto& info) {
  std::string name(info.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Ledger, KnowsTheStart) {
  SceneDef scene{.gravity = {0, -g}, .bodies = {box("stone", 0, 0, 1, 1)}};
  scene.bodies[0].velocity = {2, 0};
  const Booked run(scene);
  EXPECT_NEAR(run.simulation.ledger()->energy().kinetic, density * 4 / 2, 1e-3);
  EXPECT_EQ(run.simulation.ledger()->energy().total_error, 0);
}
}  // namespace
