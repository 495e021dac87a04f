// The law of rows in closed form.
#include "../../joint/row.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ductile/joint_law.h"

namespace ductile::dynamics {
namespace {

constexpr double h = 1.0 / 60;
const Rows m_eff{10, 20, 30};

Material material() {
  Material m;
  m.stiffness = {1e3, 2e3, 3e3};
  m.damping_ratio = {0, 0.1, 0.3};
  m.cap = {50, 60, 70};
  m.cap_reverse = {40, 30, 20};
  m.hardening = {100, 0, 300};
  return m;
}

// Spring and damper side by side under implicit Euler: R = k e' + c (e' − e)/h, e' = e + h v.
TEST(RowLaw, IsSpringAndDamperUnderImplicitEuler) {
  const RowLaw law = make_law(material(), m_eff, h);
  const Rows e{1e-3, -2e-3, 5e-4}, v{0.3, -0.2, -0.05};
  Rows x;
  for (unsigned i = 0; i < 3; ++i) x[i] = v[i] + law.relaxation[i] * e[i];
  const auto [s, regime] = respond(law, x);
  EXPECT_EQ(regime, 0u);
  for (unsigned i = 0; i < 3; ++i) {
    const double k = material().stiffness[i], c = 2 * material().damping_ratio[i] * std::sqrt(k * m_eff[i]);
    EXPECT_NEAR(s[i] / h, k * (e[i] + h * v[i]) + c * v[i], 1e-12) << i;
  }
}

// Beyond the cap the spring is in series with a slider of modulus H, 1/hardening = 1/k + 1/H:
// x = s/G + (s − hF)/(h²H), in both directions.
TEST(RowLaw, HardensInSeriesBeyondTheCap) {
  Material m = material();
  m.damping_ratio = {};
  const RowLaw law = make_law(m, m_eff, h);
  for (const double sign : {1.0, -1.0}) {
    const auto [s, regime] = respond(law, {sign * 10, sign * 10, sign * 10});
    EXPECT_EQ(regime, sign > 0 ? 7u : 56u);
    for (unsigned i = 0; i < 3; ++i) {
      const double k = m.stiffness[i], F = sign > 0 ? m.cap[i] : -m.cap_reverse[i];
      const double H = m.hardening[i] * k / (k - m.hardening[i]);
      if (H > 0) {
        EXPECT_NEAR(s[i] / (h * h * k) + (s[i] - h * F) / (h * h * H), sign * 10, 1e-12) << i;
      } else {
        EXPECT_DOUBLE_EQ(s[i], h * F);
      }
    }
  }
}

TEST(RowLaw, TangentIsTheDerivativeInEveryRegime) {
  const RowLaw law = make_law(material(), m_eff, h);
  for (const double x0 : {-5.0, 0.1, 5.0}) {
    for (const double x1 : {-5.0, 0.1, 5.0}) {
      for (const double x2 : {-5.0, 0.1, 5.0}) {
        const Rows x{x0, x1, x2};
        const auto [s, regime] = respond(law, x);
        for (unsigned i = 0; i < 3; ++i) {
          EXPECT_EQ(flows(regime, i), std::abs(x[i]) > 1);
          Rows ahead = x;
          ahead[i] += 1e-3;
          EXPECT_NEAR((respond(law, ahead).s[i] - s[i]) / 1e-3, tangent(law, regime, i), 1e-9);
        }
      }
    }
  }
}

TEST(RowLaw, OfWhatHoldsNothingIsNothing) {
  Material m = material();
  m.cap[1] = m.cap_reverse[1] = 0;  // free
  const RowLaw law = make_law(m, {10, 20, 0}, h);
  const auto [s, regime] = respond(law, {0.1, 1e9, -1e9});
  EXPECT_NE(s[0], 0);
  EXPECT_EQ(s[1], 0);
  EXPECT_EQ(s[2], 0);  // no mass to hold
  EXPECT_EQ(regime, 0u);
}

// A rigid row has G = κ m_eff, whatever the step; one that is stiffer than that is taken as rigid.
TEST(RowLaw, StiffnessIsBoundedByWhatTheStepIntegrates) {
  Material m = material();
  m.stiffness = {rigid, 1e30, 1e3};
  for (const double step : {1.0 / 60, 1e-5}) {
    const RowLaw law = make_law(m, m_eff, step);
    for (unsigned i = 0; i < 2; ++i) EXPECT_NEAR(law.G[i] / (rigid_ratio * m_eff[i]), 1, 1e-14);
    EXPECT_EQ(law.spring[2], 1e3);
  }
}

}  // namespace
}  // namespace ductile::dynamics
