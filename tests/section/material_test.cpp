#include "ductile/section.h"

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

TEST(Material, BuiltInMaterialsAreCompleteAndValid) {
  for (const auto& [name, material, source] : materials::all()) {
    EXPECT_TRUE(validate(material).empty()) << name;
    EXPECT_EQ(materials::find(name)->yield_stress, material.yield_stress);
    EXPECT_FALSE(source.empty()) << name;
    // What a scene file requires of a material, and magnitudes that no slip of a power of ten survives.
    EXPECT_TRUE(material.density > 400 && material.density < 8000) << name;
    EXPECT_TRUE(material.youngs_modulus > 1e10 && material.youngs_modulus < 2.2e11) << name;
    EXPECT_TRUE(material.yield_stress > 1e6 && material.yield_stress < 1e9) << name;
    EXPECT_TRUE(material.fracture_strain > 0 && material.fracture_strain < 0.3) << name;
    EXPECT_TRUE(material.ultimate_stress == 0 || material.ultimate_stress > material.yield_stress) << name;
  }
  static_assert(materials::S355.yield_stress == 355e6);
}
}  // namespace
