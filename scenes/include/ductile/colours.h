// How far joints are on their way to breaking, as colours: the same in pictures, replays and the window.
//
// Elastic is a blue that deepens towards yield; yield is a bright yellow, as far from that blue as colours
// go; what is plastic runs from there through orange and red to the dark purple of what is about to break.
// Within both halves lightness falls steadily and between them the hue jumps from blue to yellow, which every
// kind of colour vision tells apart (tests/scenes/colours_test.cpp looks through the eyes of all of them).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "ductile/simulation.h"

namespace ductile {

/// sRGB.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// How far a joint is: 0 unloaded … below 1 the share of its cap that it uses (the largest of its rows); from
/// 1 on it has yielded, and 1 + the share of its limit used up … 2 where it breaks. What has yielded stays at
/// 1 or above when its load goes.
inline double stage(const JointReading& joint) {
  if (joint.broken) return 2;
  if (joint.dissipated > 0) return 1 + std::clamp(joint.capacity_used, 0.0, 1.0);
  double usage = 0;  // NaN, of an unlimited row, loses every comparison
  for (const double row : {joint.usage.N, joint.usage.Q, joint.usage.M}) usage = row > usage ? row : usage;
  return std::min(usage, 1.0);
}

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

/// Radius of the dot that marks a plastic hinge, as a share of the joint's height: it grows with the
/// accumulated plastic rotation, rad, fast at first, towards one half. 0: no hinge.
inline double hinge_dot(double accumulated_rotation) {
  if (!(accumulated_rotation > 1e-6)) return 0;
  return 0.1 + 0.4 * accumulated_rotation / (accumulated_rotation + 0.3);
}

}  // namespace ductile
