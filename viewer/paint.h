// Colours and small strokes that the drawing layer shares.
#pragma once

#include <cstdint>

#include <imgui.h>

#include "bands.h"
#include "ductile/colours.h"
#include "ductile/plane.h"

namespace ductile::viewer {

inline float f(double value) { return static_cast<float>(value); }
inline ImVec2 px(Point p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }
inline Point point(ImVec2 p) { return {p.x, p.y}; }
constexpr ImU32 rgb(Colour c, std::uint8_t alpha = 255) { return IM_COL32(c.red, c.green, c.blue, alpha); }

namespace ink {
inline constexpr ImU32 edge = IM_COL32(0x1b, 0x20, 0x27, 255);
inline constexpr ImU32 faint = IM_COL32(0x5c, 0x66, 0x72, 255);
inline constexpr ImU32 line = IM_COL32(0xcc, 0xd2, 0xda, 255);
inline constexpr ImU32 fixed = IM_COL32(0xb9, 0xc0, 0xc9, 255);
inline constexpr ImU32 ground = IM_COL32(0xff, 0xff, 0xff, 255);
inline constexpr ImU32 accent = IM_COL32(0x14, 0x5f, 0xa8, 255);
inline constexpr ImU32 force = IM_COL32(0x00, 0x90, 0x6e, 255);
inline constexpr ImU32 moment = IM_COL32(0xb5, 0x48, 0x9a, 255);
inline constexpr ImU32 load = IM_COL32(0xa0, 0x52, 0x00, 255);
}  // namespace ink

/// A line that ends in an arrowhead; without one where it is shorter than its head.
inline void arrow(ImDrawList& to, Point from, Point tip, ImU32 colour, double width) {
  to.AddLine(px(from), px(tip), colour, static_cast<float>(width));
  const double span = length(tip - from), head = 3.5 * width;
  if (span < head) return;
  const Point along = 1 / span * (tip - from), back = tip - head * along, side = 0.45 * head * left(along);
  to.AddTriangleFilled(px(tip), px(back + side), px(back - side), colour);
}

}  // namespace ductile::viewer
