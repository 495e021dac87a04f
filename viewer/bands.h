// The colours of high contrast.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "ductile/stage.h"

namespace ductile::viewer {

/// Stages (stage.h) in five colours, each of which has at least three times the luminance of the next or a
/// third of it, as WCAG 2.1, 1.4.11 asks of what is seen side by side.
struct ContrastBand {
  double below;  ///< stage
  Colour colour;
};
inline constexpr std::array<ContrastBand, 5> contrast_bands{
    {{0.5, {0xff, 0xff, 0xff}},
     {1, {0x00, 0x33, 0xa0}},
     {1.5, {0xff, 0xe0, 0x00}},
     {2, {0xd0, 0x00, 0x00}},
     {std::numeric_limits<double>::infinity(), {0x00, 0x00, 0x00}}}};
inline Colour contrast_colour(double stage) {
  std::size_t band = 0;
  while (band + 1 < contrast_bands.size() && stage >= contrast_bands[band].below) ++band;
  return contrast_bands[band].colour;
}

}  // namespace ductile::viewer
