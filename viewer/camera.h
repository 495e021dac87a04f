// Which part of the world is seen where in the window.
#pragma once

#include <algorithm>

#include "ductile/plane.h"

namespace ductile::viewer {

struct Camera {
  Bounds screen{{0, 0}, {1, 1}};  ///< px, y down: the part of the window that shows the world
  Point centre;                   ///< m: what is in the middle of it
  double scale = 50;              ///< px per m

  Point to_screen(Point world) const {
    const Point d = scale * (world - centre), m = screen.middle();
    return {m.x + d.x, m.y - d.y};
  }
  Point to_world(Point px) const {
    const Point d = px - screen.middle();
    return centre + 1 / scale * Point{d.x, -d.y};
  }
  /// All of a box, with a margin.
  void show(const Bounds& world) {
    constexpr double share = 0.78;
    centre = world.middle();
    scale = share * std::min(screen.size().x / std::max(world.size().x, 1e-6),
                             screen.size().y / std::max(world.size().y, 1e-6));
  }
  /// What is under `px` stays there.
  void zoom(double factor, Point px) {
    const Point held = to_world(px);
    scale = std::clamp(scale * factor, 1e-4, 1e7);
    centre = centre + held - to_world(px);
  }
  /// By pixels of the screen.
  void pan(Point px) { centre = centre + 1 / scale * Point{-px.x, px.y}; }
};

}  // namespace ductile::viewer
