// How far joints are on their way to breaking, as a number and as colours: the same in pictures, replays, the
// window and Box2D's debug drawing.
//
// Elastic is a blue that deepens towards yield; yield is a bright yellow, as far from that blue as colours
// go; what is plastic runs from there through orange and red to the dark purple of what is about to break.
// Within both halves lightness falls steadily and between them the hue jumps from blue to yellow, which every
// kind of colour vision tells apart (tests/scenes/colours_test.cpp looks through the eyes of all of them).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ductile {

/// 0 unloaded … below 1 the share of its cap that a joint uses (the largest of its rows); from 1 on it has
/// yielded, and 1 + the share of its limit used up … 2 where it breaks. What has yielded stays at 1 or above
/// when its load goes.
/// `usage` of its rows, NaN where a row is unlimited; `capacity_used` of its limit.
inline double stage_of(bool broken, bool yielded, double capacity_used, const std::array<double, 3>& usage) {
  if (broken) return 2;
  if (yielded) return 1 + std::clamp(capacity_used, 0.0, 1.0);
  double most = 0;  // NaN loses every comparison
  for (const double row : usage) most = row > most ? row : most;
  return std::min(most, 1.0);
}

/// sRGB.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// The scale between its stops is linear in sRGB. Two stops at 1: just below yield, and from yield on.
struct ColourStop {
  double stage;
  Colour colour;
};
inline constexpr std::array<ColourStop, 7> stage_colours{{{0, {0xd3, 0xdc, 0xe6}},
                                                          {0.5, {0x7f, 0xae, 0xd8}},
                                                          {1, {0x14, 0x5f, 0xa8}},
                                                          {1, {0xff, 0xdf, 0x33}},
                                                          {1.5, {0xed, 0x7d, 0x14}},
                                                          {1.9, {0xc9, 0x26, 0x1c}},
                                                          {2, {0x66, 0x0d, 0x4a}}}};

/// Of a stage from 0 to 2; clamped outside.
inline Colour stage_colour(double stage) {
  std::size_t above = 1;
  while (above + 1 < stage_colours.size() && stage >= stage_colours[above].stage) ++above;
  const ColourStop &a = stage_colours[above - 1], &b = stage_colours[above];
  const double span = b.stage - a.stage;
  const double t = span > 0 ? std::clamp((stage - a.stage) / span, 0.0, 1.0) : 1.0;
  const auto mix = [t](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + t * (to - from)));
  };
  return {mix(a.colour.red, b.colour.red), mix(a.colour.green, b.colour.green),
          mix(a.colour.blue, b.colour.blue)};
}

}  // namespace ductile
