// Sine, cosine and arc tangent, against those of the C library in long double.
#include "ductile/turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace ductile {
namespace {

void expect_turn(double angle, double tolerance) {
  const Turn turn = turn_of(angle);
  EXPECT_NEAR(turn.c, static_cast<double>(std::cos(static_cast<long double>(angle))), tolerance) << angle;
  EXPECT_NEAR(turn.s, static_cast<double>(std::sin(static_cast<long double>(angle))), tolerance) << angle;
}

constexpr double ulp = 0x1p-53;  // of what lies between 1/2 and 1

TEST(Turn, TurnsAreWithinAnUlpOfOne) {
  std::mt19937_64 random(1);
  for (const double reach : {0.01, 0.1, 1., 4., 100., 1e5}) {
    std::uniform_real_distribution<double> angle(-reach, reach);
    for (int i = 0; i < 10'000; ++i) expect_turn(angle(random), 2 * ulp);
  }
  for (int quarter = -1000; quarter <= 1000; ++quarter)
    expect_turn(quarter * (std::numbers::pi / 2), 2 * ulp);
}

TEST(Turn, TurnsBeyondAnyAngleAreStillTurns) {
  for (const double angle : {1e6, -3e9, 1e300}) expect_turn(angle, 2 * ulp);
}

TEST(Turn, AnglesAreWithinFourUlpOfPi) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto expect_angle = [](double x, double y) {
    EXPECT_NEAR(angle_of(x, y),
                static_cast<double>(std::atan2(static_cast<long double>(y), static_cast<long double>(x))),
                4 * 0x1p-51)
        << x << ' ' << y;
  };
  for (int i = 0; i < 10'000; ++i) {
    const double x = coordinate(random), y = coordinate(random);
    expect_angle(x, y);
    expect_angle(1e-9 * x, y);
    expect_angle(x, 1e-9 * y);
  }
  for (const double x : {-1., 0., 1.})
    for (const double y : {-1., 1.}) expect_angle(x, y);
  EXPECT_EQ(angle_of(1, 0), 0);
  EXPECT_EQ(angle_of(-1, 0), std::numbers::pi);
  EXPECT_EQ(angle_of(0, 0), 0);
}

}  // namespace
}  // namespace ductile
