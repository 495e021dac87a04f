// The colours of high contrast, by the luminance that WCAG 2.1 defines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bands.h"

namespace ductile::viewer {
namespace {

double luminance(Colour c) {
  const auto linear = [](double v) {
    v /= 255;
    return v <= 0.03928 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}

double ratio(Colour a, Colour b) {
  const auto [low, high] = std::minmax({luminance(a), luminance(b)});
  return (high + 0.05) / (low + 0.05);
}

TEST(Contrast, NeighboursAreThreeTimesAsBright) {
  EXPECT_NEAR(ratio({0, 0, 0}, {255, 255, 255}), 21, 1e-12);
  for (std::size_t i = 1; i < contrast_bands.size(); ++i)
    EXPECT_GE(ratio(contrast_bands[i - 1].colour, contrast_bands[i].colour), 3) << i;
}

TEST(Contrast, YieldAndBreakAreSeen) {
  EXPECT_EQ(contrast_colour(0), contrast_bands[0].colour);
  EXPECT_EQ(contrast_colour(std::nextafter(1, 0)), contrast_bands[1].colour);
  EXPECT_EQ(contrast_colour(1), contrast_bands[2].colour);
  EXPECT_EQ(contrast_colour(1.99), contrast_bands[3].colour);
  EXPECT_EQ(contrast_colour(2), contrast_bands[4].colour);
}

}  // namespace
}  // namespace ductile::viewer
