// Buckling loads of bars in many pieces against Euler's.
#include "buckling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20;

// Of rigid pieces and springs, as a simulation has them.
double factor(const SceneDef& scene) {
  Plan plan = calibrate(scene);
  for (PlannedJoint& joint : plan.joints) joint.stiffness.Q = unlimited;  // Euler's bar does not shear
  const Equilibrium statics(plan);
  const LoadCase loads = statics.cases().front();
  const Eigen::VectorXd f = statics.balanced(loads.loads + loads.gravity);
  const auto K_g =
      geometric_stiffness(plan, statics, statics.forces(f), [](const Plan::Load&) { return 1.; });
  return 1 / buckling(statics, K_g, any_motion(statics)).inverse_factor;
}

constexpr double EI = 210e9 / 12, euler = std::numbers::pi * std::numbers::pi * EI / (L * L);

// Joints that lump the bending of ℓ buckle at (2/ℓ)² EI sin²(πℓ/4L)·… of the bar's: within 1/n².
TEST(Buckling, ACantileverAndABarOnTwoPins) {
  constexpr int n = 40;
  for (const double P : {1e6, 1e8}) {
    SceneDef column = cantilever(n, 0);
    column.loads[0].force = {-P, 0};
    EXPECT_NEAR(factor(column) * P / (euler / 4), 1, 2e-3);
    SceneDef bar = simply_supported(n, 0);
    bar.loads[0] = {.body = "beam", .at = {L, 0}, .force = {-P, 0}};
    EXPECT_NEAR(factor(bar) * P / euler, 1, 3e-3);
  }
}

// q L³ = 7.837 EI for a column under its own weight (Timoshenko, Theory of Elastic Stability, 2.12).
TEST(Buckling, AColumnUnderItsOwnWeight) {
  SceneDef column = cantilever(40, 0);
  column.gravity = {-10, 0};
  column.loads.clear();
  EXPECT_NEAR(factor(column) * 78000 * L * L * L / (7.837 * EI), 1, 3e-3);
}

TEST(Buckling, NotInTension) {
  SceneDef bar = cantilever(10, 0);
  bar.loads[0].force = {1e6, 0};
  EXPECT_GT(factor(bar), 1e6);
}

}  // namespace
