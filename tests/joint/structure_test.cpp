// What the joints must hold, bend and dissipate, against closed forms.
#include <gtest/gtest.h>

#include <numbers>

#include "beam.h"

namespace ductile {
namespace {

struct Placement {
  const char* name;
  double angle, x, y;
};
const Placement placements[] = {{"level", 0, 0, 0},
                                {"tilted", std::numbers::pi / 6, 0, 0},
                                {"far", 0, 200, 100},
                                {"tilted_and_far", std::numbers::pi / 6, -200, 300},
                                {"on_end", std::numbers::pi / 2, 0, 0}};

class Cantilever : public testing::TestWithParam<std::tuple<int, Placement>> {};

TEST_P(Cantilever, RootCarriesWhatStaticsSays) {
  const auto& [pieces, at] = GetParam();
  Beam beam({.pieces = pieces, .angle = at.angle, .x = at.x, .y = at.y});
  beam.run(4);
  const double weight = beam.mass() * 10;
  EXPECT_NEAR(beam.joints[0]->force(rotation), beam.root_moment(), 1e-6 * weight * 10);
  EXPECT_NEAR(beam.joints[0]->force(axial), -weight * std::sin(at.angle), 1e-6 * weight);
  // Gravity pulls the second body to the right of the axis: the joint pushes it back to the left.
  EXPECT_NEAR(beam.joints[0]->force(shear), -weight * std::cos(at.angle), 1e-6 * weight);
  EXPECT_EQ(beam.bounds_hit, 0);
}

INSTANTIATE_TEST_SUITE_P(Pieces, Cantilever,
                         testing::Combine(testing::Values(1, 2, 5, 10, 20, 40, 100),
                                          testing::ValuesIn(placements)),
                         [](const auto& info) {
                           return std::string(std::get<1>(info.param).name) + "_" +
                                  std::to_string(std::get<0>(info.param));
                         });

// Elastic tip sag of n pieces with k = EI/ℓ: qL⁴/8EI (1 + 1/n²) from bending, and qL²/2κGA (1 + 1/n² …) from
// shear: each joint stands for its piece, so the discrete sag is summed here joint by joint.
double discrete_sag(const BeamDef& d) {
  const double q = d.density * d.height * d.gravity, l = d.length / d.pieces;
  const double EI = d.youngs_modulus * std::pow(d.height, 3) / 12;
  const double kGA = 5.0 / 6 * d.youngs_modulus / 2.6 * d.height;
  double sag = 0;
  for (int i = 0; i < d.pieces; ++i) {
    const double beyond = d.length - i * l, span = i == 0 ? l / 2 : l;
    const double moment = q * beyond * beyond / 2, force = q * beyond;
    sag += moment * span / EI * beyond + force * span / kGA;
  }
  return sag;
}

class ElasticCantilever : public testing::TestWithParam<int> {};

TEST_P(ElasticCantilever, SagIsTheDiscreteBeamsAndConvergesQuadratically) {
  // A thousandth of gravity, so that the beam's rotation does not shorten the lever arm.
  const BeamDef def{.pieces = GetParam(), .youngs_modulus = 210e9, .gravity = 0.01};
  Beam beam(def);
  beam.run(20);
  const double l = def.length / def.pieces;
  const auto* tip = beam.pieces.back();
  const double sag = -(tip->GetPosition().y + l / 2 * std::sin(tip->GetAngle()));
  const double exact = discrete_sag(def);
  EXPECT_NEAR(sag, exact, 2e-4 * exact);
  const double bending = 0.01 * 7800 * std::pow(20.0, 4) / (8 * 210e9 / 12);
  EXPECT_NEAR(exact / bending - 1, 1.0 / (def.pieces * def.pieces), 0.01);  // the rest is shear: 0.003
}
INSTANTIATE_TEST_SUITE_P(Pieces, ElasticCantilever, testing::Values(2, 5, 10, 20, 40));

// Rotation at which a rigid-plastic cantilever that gravity is let loose on comes to rest: M0 sinθ = M_p θ.
double resting_rotation(double ratio) {
  double low = 1e-9, high = std::numbers::pi;
  for (int i = 0; i < 200; ++i) {
    const double mid = (low + high) / 2;
    (std::sin(mid) / mid > 1 / ratio ? low : high) = mid;
  }
  return low;
}

class PlasticCantilever : public testing::TestWithParam<std::tuple<int, double, double>> {};

TEST_P(PlasticCantilever, RootRotatesUntilThePlasticWorkIsTheFall) {
  const auto [pieces, length, ratio] = GetParam();
  const double moment = 7800 * 10 * length * length / 2;
  Beam beam({.pieces = pieces, .length = length, .moment_cap = moment / ratio});
  beam.run(length > 10 ? 14 : 7);
  const double theta = ratio > 1 ? resting_rotation(ratio) : 0;
  EXPECT_NEAR(beam.joints[0]->accumulated_rotation(), theta, 1e-3 * theta);
  EXPECT_NEAR(beam.joints[0]->dissipated(), moment / ratio * theta, 2e-3 * moment / ratio * theta);
  for (std::size_t i = 1; i < beam.joints.size(); ++i)
    EXPECT_EQ(beam.joints[i]->accumulated_rotation(), 0) << i;
  EXPECT_EQ(beam.bounds_hit, 0);
}
INSTANTIATE_TEST_SUITE_P(Ratios, PlasticCantilever,
                         testing::Combine(testing::Values(1, 2, 5, 10, 20, 40), testing::Values(5.0, 20.0),
                                          testing::Values(0.9, 0.99, 0.999, 1.05, 1.3, 1.5, 1.6)));

}  // namespace
}  // namespace ductile
