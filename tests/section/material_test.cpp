#include "ductile/material.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {
using namespace ductile;

TEST(Material, ShearYieldFollowsTheCriterion) {
  EXPECT_DOUBLE_EQ((Material{.yield_stress = 350e6}.shear()), 175e6);
  EXPECT_DOUBLE_EQ((Material{.yield_stress = 300e6, .criterion = Criterion::von_mises}.shear()),
                   300e6 / std::sqrt(3.0));
  EXPECT_DOUBLE_EQ((Material{.yield_stress = 300e6, .yield_stress_compression = 100e6}.shear()), 50e6);
  EXPECT_DOUBLE_EQ((Material{.yield_stress = 300e6, .shear_yield_stress = 1e6}.shear()), 1e6);
}

TEST(Material, BuiltInMaterialsAreFoundByName) {
  ASSERT_NE(materials::find("S355"), nullptr);
  EXPECT_EQ(*materials::find("S355"), materials::S355);
  EXPECT_EQ(materials::find("unobtainium"), nullptr);
}
}  // namespace
