// What kinematic bodies do to a structure that they strike: rams, presses, arms that turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "beam.h"
#include "bodies.h"

namespace ductile {
namespace {

constexpr BeamDef cantilever{.pieces = 10,
                             .length = 10,
                             .height = 0.5,
                             .youngs_modulus = 2e11,
                             .damping_time = 0,
                             .moment_cap = 3e6,
                             .gravity = 0};

double flow_of(const Beam& beam) {
  double sum = 0;
  for (const ElasticPlasticJoint* j : beam.joints) sum += j->accumulated_rotation();
  return sum;
}

// By which the two anchors of a joint are apart, at most, m.
double most_apart(const Beam& beam) {
  double most = 0;
  for (const ElasticPlasticJoint* j : beam.joints)
    most = std::max(most, double{(j->GetAnchorA() - j->GetAnchorB()).Length()});
  return most;
}

// A box below the beam that comes up for a third of a second, and stays.
struct Ram {
  Ram(const BeamDef& def, double x, double below, double speed, double hz) : beam(def), step(1 / hz) {
    body = add_box(
        beam.world,
        {.x = x, .y = -def.height / 2 - 0.5 - below, .width = 0.1, .type = b2_kinematicBody, .group = 0});
    beam.run(step, step);
    for (int i = 0; i < std::lround(hz * (1 + 1.0 / 3)); ++i) {
      body->SetLinearVelocity(vec(0, i < std::lround(hz / 3) ? speed : 0));
      beam.run(step, step);
      apart = std::max(apart, most_apart(beam));
    }
  }
  double top() const { return body->GetPosition().y + 0.5; }

  Beam beam;
  double step;
  b2Body* body;
  double apart = 0;
};

class Rams : public testing::TestWithParam<std::tuple<double, double>> {};

// Continuous collision would put the piece that is struck on the ram alone, centimetres off its joints; the
// rest of the structure would come after it, without the blow.
TEST_P(Rams, BendABeamAlikeAtAnyStep) {
  const auto [speed, share] = GetParam();  // of a third of a second, that the ram is under way before
  const auto below = share * speed / 3;
  const Ram fine(cantilever, 8.5, below, speed, 3840);
  for (const double hz : {30., 60., 240.}) {
    const Ram ram(cantilever, 8.5, below, speed, hz);
    EXPECT_NEAR(ram.top(), fine.top(), 1e-4);
    EXPECT_NEAR(flow_of(ram.beam), flow_of(fine.beam), 0.08 * flow_of(fine.beam)) << hz;
    EXPECT_LT(ram.apart, 2e-3) << hz;
    EXPECT_LT(std::abs(ram.beam.structure.energy().numerical), 0.05 * ram.beam.structure.energy().dissipated)
        << hz;
  }
}
INSTANTIATE_TEST_SUITE_P(Kinematic, Rams,
                         testing::Combine(testing::Values(3., 6., 10.), testing::Values(0.15, 0.25, 0.33)));

// What does not yield stands on the ram when that has stopped, and bears the moment of its deflection there:
// y = F Σ (a − x)²/k + F Σ 1/k_s of a force at a, over the joints at x.
TEST(Kinematic, ARamHoldsWhatItLifts) {
  BeamDef elastic = cantilever;
  elastic.moment_cap = unlimited;
  elastic.damping_time = 0.01;
  for (const double hz : {30., 60.}) {
    for (const double below : {0.1, 0.15, 0.21, 0.33}) {
      const Ram ram(elastic, 8.5, below, 1.5, hz);
      double gives = 0;
      for (int i = 0; i < elastic.pieces; ++i) {
        const ElasticPlasticJoint& j = *ram.beam.joints[static_cast<std::size_t>(i)];
        const double arm = 8.5 - i;
        if (arm > 0)
          gives += arm * arm / j.def().rows[rotation].stiffness + 1 / j.def().rows[shear].stiffness;
      }
      const double skins = 2 * b2_polygonRadius, lifted = ram.top() + elastic.height / 2 + skins,
                   moment = 8.5 * lifted / gives;
      const double share = b2_linearSlop / lifted + 2 * 0.05 / 8.5;
      EXPECT_NEAR(ram.beam.joints[0]->force(rotation), moment, share * moment) << hz << ", " << below;
      EXPECT_LT(ram.apart, 2e-3) << hz << ", " << below;
    }
  }
}

// The corner of an arm that sweeps along below the beam passes from piece to piece, and meets no corner of
// those: that left 30 times as much. In a step of 1/30 s it goes on by 0.22 m, along faces that do not turn.
TEST(Kinematic, ASweepingArmMeetsNoCornersOfJoinedPieces) {
  const auto flow = [](double hz) {
    Beam beam(cantilever);
    b2Body* arm = add_box(beam.world, {.x = 6,
                                       .y = -3.5,
                                       .width = 6.8,
                                       .height = 0.4,
                                       .angle = -0.8,
                                       .type = b2_kinematicBody,
                                       .group = 0,
                                       .friction = 0.2});
    for (int i = 0; i < std::lround(2 * hz); ++i) {
      arm->SetAngularVelocity(i < std::lround(hz) ? 2.1f : 0);
      beam.run(1 / hz, 1 / hz);
    }
    return flow_of(beam);
  };
  const double fine = flow(3840);
  ASSERT_GT(fine, 0.01);
  EXPECT_NEAR(flow(30), fine, 0.3 * fine);
  EXPECT_NEAR(flow(60), fine, 0.1 * fine);
}

}  // namespace
}  // namespace ductile
