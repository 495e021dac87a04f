// The lowest elastic frequency that damping ratios refer to, against Euler and Bernoulli's beams.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "ductile/box2d.h"
#include "ductile/calibrate.h"

namespace ductile {
namespace {

enum class Hold { cantilever, simply_supported, floating, pinned_once };

struct BeamCase {
  const char* name;
  Hold hold;
  double lambda;  // λL: ω = (λL)² √(EI/ρAL⁴)
};

class Fundamental : public testing::TestWithParam<std::tuple<BeamCase, int>> {};

constexpr double length = 8, height = 0.1, depth = 0.2;

SceneDef beam_scene(Hold hold, int pieces) {
  SceneDef scene;
  BodyDef beam{
      .name = "beam",
      .outline = {{{0, 0}, {length, 0}, {length, height}, {0, height}}, {}},
      .material =
          Material{.yield_stress = 355e6, .youngs_modulus = 210e9, .density = 7850, .damping_ratio = 0.02},
      .depth = depth,
      .pieces = pieces};
  scene.bodies = {beam};
  if (hold == Hold::cantilever) {
    scene.bodies.push_back({.name = "wall",
                            .type = BodyType::static_body,
                            .outline = {{{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {}}});
    scene.joints = {{.a = "wall", .b = "beam"}};
  }
  const Point left{0, height / 2}, right{length, height / 2};
  if (hold == Hold::simply_supported || hold == Hold::pinned_once)
    scene.supports.push_back({.body = "beam", .at = left, .fix_x = true, .fix_y = true});
  if (hold == Hold::simply_supported) scene.supports.push_back({.body = "beam", .at = right, .fix_y = true});
  return scene;
}

// n rigid pieces between springs EI/ℓ miss the beam's frequency by O(1/n²), and Timoshenko's shear and rotary
// inertia take (λL)² h²/(2 L²)·(1 + E/κG)/… < 0.3 % at this slenderness of 80. The spring between pieces of
// 20 mm is 1e11 times their inertia a second².
TEST_P(Fundamental, IsTheBeams) {
  const auto& [beam, pieces] = GetParam();
  const Plan plan = calibrate(beam_scene(beam.hold, pieces));
  const double I = depth * std::pow(height, 3) / 12, mass = 7850 * depth * height;
  const double omega = beam.lambda * beam.lambda * std::sqrt(210e9 * I / mass) / (length * length);
  const double found = plan.joints.front().damping_frequency;
  EXPECT_NEAR(found / (omega / (2 * std::numbers::pi)), 1, 0.003 + 5.0 / (pieces * pieces));
  for (const PlannedJoint& j : plan.joints) EXPECT_EQ(j.damping_frequency, j.damping_ratio > 0 ? found : 0);
}
INSTANTIATE_TEST_SUITE_P(
    Beams, Fundamental,
    testing::Combine(testing::Values(BeamCase{"cantilever", Hold::cantilever, 1.875104},
                                     BeamCase{"simply_supported", Hold::simply_supported, std::numbers::pi},
                                     BeamCase{"floating", Hold::floating, 4.730041},
                                     BeamCase{"pinned_once", Hold::pinned_once, 3.926602}),
                     testing::Values(12, 40, 160, 400)),
    [](const auto& info) {
      return std::string(std::get<0>(info.param).name) + "_" + std::to_string(std::get<1>(info.param));
    });

// A bar on a spring under each end bounces as ω² = 2k/m, and turns faster. Supports that are fixed have no
// damper.
TEST(Fundamental, SpringsOfSupportsAreDampedByIt) {
  SceneDef scene = beam_scene(Hold::floating, 1);
  const double mass = 7850 * length * height * depth, k = 2e4;
  for (const double x : {0.0, length})
    scene.supports.push_back({.body = "beam", .at = {x, 0}, .fix_x = x == 0, .stiffness_y = k});
  scene.supports.push_back({.body = "beam", .at = {0, 0}, .fix_x = true});
  const Plan plan = calibrate(scene);
  const double omega = std::sqrt(2 * k / mass);
  for (const int i : {0, 1}) {
    const PlannedJoint& support = plan.joints[static_cast<std::size_t>(i)];
    EXPECT_NEAR(support.damping_frequency / (omega / (2 * std::numbers::pi)), 1, 1e-4);
    EXPECT_NEAR(elastic_plastic_def(plan, support).rows[shear].damping / (2 * 0.02 * k / omega), 1, 1e-4);
    EXPECT_EQ(elastic_plastic_def(plan, support).rows[axial].damping, 0);
  }
  EXPECT_EQ(plan.joints[2].damping_ratio, 0);
  scene.joint.damping_ratio = 0.1;
  EXPECT_EQ(calibrate(scene).joints[0].damping_ratio, 0.1);
}

TEST(Fundamental, IsNoneWhereNothingIsElastic) {
  SceneDef scene = beam_scene(Hold::cantilever, 10);
  scene.joint.elastic = Elasticity::rigid;
  EXPECT_EQ(calibrate(scene).joints.front().damping_frequency, 0);
}

TEST(Fundamental, IsWhatTheUserGaveAJoint) {
  SceneDef scene = beam_scene(Hold::cantilever, 2);
  scene.joint = {.elastic = Elasticity::frequency, .frequency = 3, .damping_ratio = 0.1};
  EXPECT_EQ(calibrate(scene).joints.front().damping_frequency, 3);
}

}  // namespace
}  // namespace ductile
