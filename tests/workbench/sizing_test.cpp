// What a body is to be for a reserve, against closed forms and the tables of sections.
#include "sizing.h"

#include <gtest/gtest.h>

#include "ductile/design.h"
#include "making.h"

namespace ductile::viewer {
namespace {

/// A clamped beam of length L with a force at its tip, whose own weight is nothing: the support carries
/// M = F L.
constexpr double L = 3, f_y = 355e6;
SceneDef bracket(double force, const std::string& profile) {
  BeamStyle style;
  style.material.density = 1e-6;
  style.profile = profile;
  SceneDef scene = with_beam(empty_scene(), {{0, 1}, {L, 1}}, style);
  for (int i = 0; i < 3; ++i) scene = with_next_support(scene, {0, 1}, 0);  // clamped
  return with_load(scene, {L, 1}, {0, -force});
}

// M_pl = b h²/4 f_y.
TEST(Sizing, ARectangleGetsTheDepthOfItsPlasticMoment) {
  const double force = 100e3, height = BeamStyle{}.height;
  for (const double reserve : {1., 1.5, 4.}) {
    const Sized sized = with_reserve(bracket(force, ""), "beam1", reserve);
    const double moment = reserve * force * L;
    EXPECT_NEAR(sized.scene.bodies.at(1).depth / (4 * moment / (height * height * f_y)), 1, 1e-6);
    EXPECT_NEAR(static_check(calibrate(sized.scene)).reserve, reserve, 1e-6 * reserve);
  }
}

// W_pl,y of IPE 200 and 220: 220.6 and 285.4 cm³ (EN 10365).
TEST(Sizing, AProfileBecomesTheLightestOfItsSeriesThatBears) {
  const auto force_for = [](double W) { return W * f_y / (1.5 * L); };
  EXPECT_EQ(with_reserve(bracket(force_for(219e-6), "IPE 600"), "beam1", 1.5).scene.bodies.at(1).profile_name,
            "IPE 200");
  EXPECT_EQ(with_reserve(bracket(force_for(223e-6), "IPE 80"), "beam1", 1.5).scene.bodies.at(1).profile_name,
            "IPE 220");
  EXPECT_THROW(with_reserve(bracket(force_for(1), "IPE 80"), "beam1", 1.5), InvalidInput);
}

}  // namespace
}  // namespace ductile::viewer
