// Collapse in the deformed state against closed forms and against slow simulations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ductile/design.h"
#include "ductile/simulation.h"
#include "frames.h"

namespace {
using namespace ductile;

constexpr double L = 20, EI = 210e9 / 12, M = plastic_moment;

// M_p = H h + P δ with the elastic mast's own P–Δ: of a mast that carries P down and H across, the foot
// yields at H h tan φ/φ = M_p, and nothing stands after its only hinge.
TEST(SecondOrderLimit, AMastGoesWithItsFirstHinge) {
  for (const double P : {1e6, 1e7, 2e7, 3e7}) {
    SceneDef scene = cantilever(80, 2e6);
    scene.loads[0].force.x = -P;
    Plan plan = calibrate(scene);
    for (PlannedJoint& joint : plan.joints) joint.stiffness.N = joint.stiffness.Q = unlimited;
    double low = 0, high = std::numbers::pi * std::numbers::pi * EI / (4 * L * L) / P;
    for (int i = 0; i < 100; ++i) {
      const double f = (low + high) / 2, phi = L * std::sqrt(f * P / EI);
      (f * 2e6 * L * std::tan(phi) / phi < M ? low : high) = f;
    }
    const Pushover pushover = second_order_limit(plan);
    EXPECT_NEAR(pushover.load_factor / low, 1, 1e-3) << P;
    ASSERT_EQ(pushover.hinges.size(), 1u);
    EXPECT_EQ(pushover.hinges[0].joint, joint_named(plan, "wall-beam/0"));
    EXPECT_EQ(pushover.hinges[0].factor, pushover.load_factor);
  }
}

// Without axial forces both orders agree, and hinges form where moments are largest.
TEST(SecondOrderLimit, BeamsAreOfFirstOrder) {
  for (const SceneDef& scene : {fixed_fixed(10, 1e6), propped(10, 1e6), simply_supported(10, 1e6)}) {
    const Plan plan = calibrate(scene);
    EXPECT_NEAR(second_order_limit(plan).load_factor / limit_analysis(plan).load_factor, 1, 1e-4);
  }
  const Plan plan = calibrate(propped(10, 1e6));
  const Pushover pushover = second_order_limit(plan);
  ASSERT_EQ(pushover.hinges.size(), 2u);
  EXPECT_EQ(pushover.hinges[0].joint, joint_named(plan, "wall-beam/0"));  // 3 P L/16 before 5 P L/32
  EXPECT_NEAR(pushover.hinges[0].factor * 1e6 / (16 * M / (3 * L)), 1, 2e-2);
  EXPECT_EQ(pushover.hinges[1].joint, joint_named(plan, "beam/4-beam/5"));
  EXPECT_NEAR(pushover.hinges[1].factor * 1e6 / (6 * M / L), 1, 1e-4);
}

TEST(SecondOrderLimit, AColumnWithoutAnythingAcrossBuckles) {
  SceneDef scene = cantilever(40, 0);
  scene.loads[0].force = {-1e6, 0};
  const Plan plan = calibrate(scene);
  const Pushover pushover = second_order_limit(plan);
  EXPECT_NEAR(pushover.load_factor / critical_load(plan).factor, 1, 2e-3);
  EXPECT_TRUE(pushover.hinges.empty());
}

TEST(SecondOrderLimit, OnTheYieldSurface) {
  SceneDef scene = cantilever(20, 1e5);
  scene.joint = {};
  scene.interaction = true;
  const Plan bending = calibrate(scene);
  EXPECT_NEAR(second_order_limit(bending).load_factor / limit_analysis(bending).load_factor, 1, 1e-4);
  scene.loads[0].force.x = -2e7;
  const Plan column = calibrate(scene);
  const double second = second_order_limit(column).load_factor;
  EXPECT_LT(second, 0.8 * limit_analysis(column).load_factor);
  EXPECT_LT(second, critical_load(column).factor);
  EXPECT_NEAR(second / static_check(column, Order::second).reserve, 1, 5e-3) << "one hinge and it goes";
}

TEST(SecondOrderLimit, GravityHeldFixed) {
  SceneDef scene = cantilever(40, 1e6);
  scene.gravity = {-10, 0};
  scene.bodies[1].material->density = 60000;  // 1.2e7 N, at half the height
  const Plan plan = calibrate(scene);
  const double fixed = second_order_limit(plan, true).load_factor,
               first = limit_analysis(plan, true).load_factor;
  EXPECT_LT(fixed, 0.98 * first);
  EXPECT_GT(fixed, second_order_limit(plan).load_factor);
  scene.gravity = {-400, 0};
  EXPECT_THROW(second_order_limit(calibrate(scene), true), InvalidInput) << "buckles of its own weight";
}

// Where the largest moment moves on along a girder as it bends, hinges form in two joints beside each other:
// the one left behind unloads, and the frame does not go by the piece between them. A hinge stands off its
// place by half a part at most, which is q λ (l/n)²/8 of M_p, half a per cent of it here.
TEST(SecondOrderLimit, DoesNotDependOnTheParts) {
  struct Case {
    double q, across;  // N/m, N
  };
  for (const auto& [q, across] : {Case{100e3, 50e3}, Case{200e3, 150e3}}) {
    double most = 0, least = unlimited;
    for (const int n : {16, 20, 24, 30}) {
      Frame frame;
      frame.pieces = n;
      SceneDef scene = frame.scene(true, 1e6);
      const double part = (frame.l - frame.t) / n;
      for (int i = 0; i < n; ++i)
        scene.loads.push_back(
            {.body = "girder", .at = {frame.t / 2 + (i + 0.5) * part, frame.h}, .force = {0, -q * part}});
      scene.loads.push_back({.body = "west", .at = {0, frame.h}, .force = {across, 0}});
      const Plan plan = calibrate(scene);
      const double factor = second_order_limit(plan).load_factor;
      EXPECT_LT(factor, limit_analysis(plan).load_factor);
      most = std::max(most, factor);
      least = std::min(least, factor);
    }
    EXPECT_LT(most / least, 1.005) << q;
  }
}

// --- against simulation: what stands 2 % below it goes 2 % above ---

bool stands(const SceneDef& as_designed, double factor) {
  SceneDef scene = as_designed;
  for (BodyDef& body : scene.bodies)
    if (body.material) body.material->damping_ratio = 1;
  for (LoadDef& load : scene.loads) {
    load.force = {factor * load.force.x, factor * load.force.y};
    load.ramp = 40;
  }
  Simulation simulation(calibrate(scene));
  const std::size_t top = simulation.plan().pieces.size() - 1;
  const Point start = simulation.piece(top).position;
  while (simulation.time() < 70) {
    simulation.step();
    const Point now = simulation.piece(top).position;
    if (std::hypot(now.x - start.x, now.y - start.y) > 3) return false;
  }
  return true;
}

struct Sway {
  bool fixed;
  double across, l, t;
};
class SlowPushover : public testing::TestWithParam<Sway> {};

TEST_P(SlowPushover, GoesAsASimulationDoes) {
  const auto [fixed, across, l, t] = GetParam();
  Frame frame;
  frame.pieces = 8;
  frame.l = l;
  frame.t = t;
  SceneDef scene = frame.scene(fixed, 1e6);
  scene.loads.push_back({.body = "west", .at = {0, frame.h}, .force = {across * 1e6, 0}});
  const Plan plan = calibrate(scene);
  const Pushover pushover = second_order_limit(plan);
  EXPECT_LT(pushover.load_factor, 0.97 * limit_analysis(plan).load_factor) << "P–Δ counts";
  EXPECT_TRUE(stands(scene, 0.98 * pushover.load_factor)) << pushover.load_factor;
  EXPECT_FALSE(stands(scene, 1.02 * pushover.load_factor)) << pushover.load_factor;
}
INSTANTIATE_TEST_SUITE_P(TenFrames, SlowPushover,
                         testing::Values(Sway{true, 0.05, 10, 0.4}, Sway{true, 0.1, 10, 0.4},
                                         Sway{true, 0.2, 10, 0.4}, Sway{true, 0.1, 10, 0.25},
                                         Sway{true, 0.1, 5, 0.3}, Sway{false, 0.02, 10, 0.4},
                                         Sway{false, 0.05, 10, 0.4}, Sway{false, 0.1, 10, 0.4},
                                         Sway{false, 0.05, 10, 0.25}, Sway{false, 0.05, 5, 0.3}));

}  // namespace
