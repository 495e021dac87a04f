// One panel of a plan's picture: pieces, joints and loads, or what the pieces carry.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ductile/picture.h"
#include "svg.h"

namespace ductile::picture {

/// Where a point of a piece, as drawn, is in a panel.
class Pose {
 public:
  Pose(const Plan& plan, const Panel& panel, int piece) {
    if (piece < 0) return;
    const auto i = static_cast<std::size_t>(piece);
    if (!panel.motions.empty()) {
      const Motion& motion = panel.motions[i];
      from_ = plan.pieces[i].center;
      to_ = {from_.x + panel.times * motion.along.x, from_.y + panel.times * motion.along.y};
      sin_ = panel.times * motion.turn;  // small displacements are linear, so that pieces meet at any scale
      return;
    }
    if (panel.pieces.empty()) return;
    from_ = plan.pieces[i].center;
    const PieceReading& now = panel.pieces[i];
    to_ = now.position;
    cos_ = std::cos(now.angle);
    sin_ = std::sin(now.angle);
  }
  Point operator()(Point p) const {
    const double x = p.x - from_.x, y = p.y - from_.y;
    return {to_.x + cos_ * x - sin_ * y, to_.y + sin_ * x + cos_ * y};
  }

 private:
  Point from_, to_;
  double cos_ = 1, sin_ = 0;
};

inline bool moves(const Plan& plan, const Piece& piece) {
  return plan.bodies[static_cast<std::size_t>(piece.body)].type != BodyType::static_body;
}

inline Box box_of(const Piece& piece, const Pose& pose) {
  Box box;
  if (piece.circle > 0) {
    box.add(pose(piece.center));
    return box.grown(piece.circle);
  }
  for (const Point& p : piece.outline.outer) box.add(pose(p));
  return box;
}

// Small is light and large is dark: the colours of a flame, whose lightness falls steadily for every kind of
// colour vision.
inline constexpr std::array<Colour, 5> moment_colours{
    {{0xfc, 0xe3, 0x8a}, {0xf6, 0xa0, 0x4d}, {0xd9, 0x53, 0x4f}, {0x93, 0x2b, 0x72}, {0x2f, 0x10, 0x5c}}};

/// Plastic moments on a logarithmic scale. Moments that read alike, within 1e-3, are one: what rounding makes
/// of equal sections does not fill the scale.
struct MomentScale {
  double low = unlimited, high = 0;

  explicit MomentScale(const Plan& plan) {
    for (const PlannedJoint& joint : plan.joints) {
      if (!(joint.M > 0) || joint.M == unlimited) continue;
      low = std::min(low, joint.M);
      high = std::max(high, joint.M);
    }
    if (high <= low * (1 + 1e-3)) low = high;
  }
  bool empty() const { return high == 0; }
  double share(double moment) const { return high > low ? std::log(moment / low) / std::log(high / low) : 1; }
  /// Both ends, and the powers of ten that are clear of them.
  std::vector<double> ticks() const {
    if (!(high > low)) return {high};
    std::vector<double> ticks{low, high};
    // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): powers of ten
    for (double power = std::pow(10, std::ceil(std::log10(low))); power < high; power *= 10)
      if (share(power) > 0.22 && share(power) < 0.78) ticks.push_back(power);
    return ticks;
  }
};

/// Where a panel is drawn, and how large.
struct Frame {
  Box view;          ///< m, what it shows
  double scale = 1;  ///< px per m
  Box place;         ///< px
  double mark = 1;   ///< how large marks are, 1 where the panel is as wide as the picture

  /// Where a point is: y up in metres, down in px, in the middle of the place.
  Point px(Point p) const {
    return {(place.x0 + place.x1 - scale * view.width()) / 2 + (p.x - view.x0) * scale,
            (place.y0 + place.y1 - scale * view.height()) / 2 + (view.y1 - p.y) * scale};
  }
};

/// Draws the panel.
void draw_panel(Node to, const Plan& plan, const Panel& panel, const MomentScale& moments,
                const Frame& frame);

/// How high the largest ordinate of a diagram is drawn, of the size of what is shown.
inline constexpr double ordinate_share = 0.12;

}  // namespace ductile::picture
