#include "ductile/colours.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace ductile {
namespace {

using Vec3 = std::array<double, 3>;
using Mat3 = std::array<Vec3, 3>;

Vec3 operator*(const Mat3& m, const Vec3& v) {
  Vec3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) out[i] += m[i][k] * v[k];
  return out;
}

// What each kind of colour vision makes of linear sRGB: Machado, Oliveira, Fernandes, "A
// Physiologically-based Model for Simulation of Color Vision Deficiency", IEEE TVCG 15(6), 2009, table of
// severity 1.0.
struct Vision {
  const char* name;
  Mat3 sees;
};
const std::vector<Vision> visions{
    {"normal", {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}},
    {"protanopia",
     {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}},
    {"deuteranopia",
     {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}}},
    {"tritanopia",
     {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}},
};

// CIELAB (D65) of a colour as a kind of vision sees it: IEC 61966-2-1, CIE 15.
Vec3 lab(Colour colour, const Vision& vision) {
  const auto linear = [](std::uint8_t byte) {
    const double c = byte / 255.;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  Vec3 rgb = vision.sees * Vec3{linear(colour.red), linear(colour.green), linear(colour.blue)};
  for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
  const Mat3 to_xyz{{{0.4124564, 0.3575761, 0.1804375},
                     {0.2126729, 0.7151522, 0.0721750},
                     {0.0193339, 0.1191920, 0.9503041}}};
  const Vec3 xyz = to_xyz * rgb, white = to_xyz * Vec3{1, 1, 1};
  const auto f = [&](std::size_t i) {
    const double t = xyz[i] / white[i], d = 6. / 29;
    return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4. / 29;
  };
  return {116 * f(1) - 16, 500 * (f(0) - f(1)), 200 * (f(1) - f(2))};
}

double distance(const Vec3& a, const Vec3& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// A difference of 2.3 is just noticeable (Mahy et al. 1994); ten times that is told apart across a picture.
TEST(Colours, EveryKindOfColourVisionTellsTheStagesApart) {
  const double elastic = 0.3, near_yield = 0.99, yielded = 1, plastic = 1.5, about_to_break = 2;
  const std::vector<std::pair<double, double>> pairs{
      {elastic, near_yield}, {near_yield, yielded}, {elastic, plastic},        {elastic, about_to_break},
      {near_yield, plastic}, {yielded, plastic},    {yielded, about_to_break}, {plastic, about_to_break}};
  for (const Vision& vision : visions) {
    for (const auto& [a, b] : pairs) {
      EXPECT_GT(distance(lab(stage_colour(a), vision), lab(stage_colour(b), vision)), 23)
          << vision.name << ": stages " << a << " and " << b;
    }
    for (double a = 0; a < 1; a += 0.05) {
      for (double b = 1; b <= 2; b += 0.05) {
        EXPECT_GT(distance(lab(stage_colour(a), vision), lab(stage_colour(b), vision)), 15)
            << vision.name << ": elastic " << a << " and plastic " << b;
      }
    }
  }
}

TEST(Colours, LightnessFallsTowardsYieldAndTowardsBreaking) {
  for (const Vision& vision : visions)
    for (const double from : {0., 1.})
      for (double s = from; s + 0.02 < from + 1; s += 0.02)
        EXPECT_GT(lab(stage_colour(s), vision)[0], lab(stage_colour(s + 0.02), vision)[0])
            << vision.name << " at " << s;
}

TEST(Colours, StopsAreHitAndOutsideIsClamped) {
  EXPECT_EQ(stage_colour(0), stage_colours.front().colour);
  EXPECT_EQ(stage_colour(1), stage_colours[3].colour) << "from yield on it is yellow";
  EXPECT_EQ(stage_colour(std::nextafter(1, 0)), stage_colours[2].colour);
  EXPECT_EQ(stage_colour(2), stage_colours.back().colour);
  EXPECT_EQ(stage_colour(-1), stage_colours.front().colour);
  EXPECT_EQ(stage_colour(7), stage_colours.back().colour);
}

TEST(Colours, OfTheDebugDrawingAreTheSame) {
  for (const double stage : {-1.0, 0.0, 0.3, 0.9999, 1.0, 1.7, 2.0}) {
    const Colour here = stage_colour(stage);
    const b2Color there = stage_color(stage);
    EXPECT_FLOAT_EQ(there.r * 255, here.red) << stage;
    EXPECT_FLOAT_EQ(there.g * 255, here.green) << stage;
    EXPECT_FLOAT_EQ(there.b * 255, here.blue) << stage;
  }
}

TEST(Stage, RunsFromUnloadedOverYieldToBroken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(stage({}), 0);
  EXPECT_EQ(stage({.usage = {0.2, 0.7, 0.4}}), 0.7);
  EXPECT_EQ(stage({.usage = {nan, 0.3, nan}}), 0.3) << "unlimited rows have no say";
  EXPECT_EQ(stage({.usage = {0, 0, 1.7}}), 1) << "a stock joint beyond its cap";
  EXPECT_EQ(stage({.capacity_used = 0.25, .dissipated = 1}), 1.25) << "unloaded, but bent for good";
  EXPECT_EQ(stage({.broken = true}), 2);
}

TEST(HingeDot, GrowsWithRotationAndStaysInsideTheJoint) {
  EXPECT_EQ(hinge_dot(0), 0);
  double last = 0;
  for (double rotation = 0.001; rotation < 100; rotation *= 2) {
    EXPECT_GT(hinge_dot(rotation), last);
    last = hinge_dot(rotation);
  }
  EXPECT_LT(last, 0.5);
}

}  // namespace
}  // namespace ductile
