#include "quantity.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ductile::viewer {
namespace {

TEST(Typed, ANumberIsOfTheUnitThatIsExpected) {
  EXPECT_EQ(typed("2.5", "kN"), 2.5);
  EXPECT_EQ(typed(" -1e-3 ", "m"), -1e-3);
  EXPECT_EQ(typed("10 000", ""), 10000);
  EXPECT_EQ(typed("1.5 x", "x"), 1.5);
}

TEST(Typed, AnotherUnitOfTheSameIsConverted) {
  struct Case {
    const char *text, *unit;
    double value;
  };
  for (const auto& [text, unit, value] :
       {Case{"2.5 MN", "kN", 2500}, Case{"200mm", "m", 0.2}, Case{"20 cm", "m", 0.2},
        Case{"8 in", "m", 8 * 0.0254}, Case{"1 ft", "m", 12 * 0.0254}, Case{"1 kN m", "N m", 1000},
        Case{"355 N/mm²", "MPa", 355}, Case{"0.21 TPa", "GPa", 210}, Case{"7.85 t/m³", "kg/m³", 7850},
        Case{"2 t", "kg", 2000}, Case{"180°", "rad", std::numbers::pi}, Case{"30 mm/s", "m/s", 0.03},
        Case{"5 N/mm", "kN/m", 5}}) {
    ASSERT_TRUE(typed(text, unit)) << text;
    EXPECT_DOUBLE_EQ(*typed(text, unit), value) << text;
  }
}

TEST(Typed, WhatIsNoSuchNumberIsNone) {
  for (const char* text : {"", " ", "m", "two", "2 kN", "2 mmm", "nan", "inf", "1e999"})
    EXPECT_FALSE(typed(text, "m")) << text;
  EXPECT_FALSE(typed("2 kN", ""));
}

}  // namespace
}  // namespace ductile::viewer
