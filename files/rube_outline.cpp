#include "rube_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "overlay.h"
#include "svg_stroke.h"

namespace ductile::rube {
namespace {

constexpr double strip = 0.025;  // m

}  // namespace

Ring disc(Point center, double radius) {
  constexpr int corners = 72;  // 1 − cos(π/72) = 0.00095
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    ring.push_back({center.x + radius * std::cos(angle), center.y + radius * std::sin(angle)});
  }
  return ring;
}

std::vector<Outline> covered(const Body& body) {
  svg::Layer solid;
  for (const Fixture& fixture : body.fixtures) {
    if (fixture.sensor) continue;
    switch (fixture.kind) {
      case Fixture::polygon: {
        Ring ring = fixture.points;
        if (doubled_area(ring) < 0) std::reverse(ring.begin(), ring.end());  // else opposite ones cancel out
        solid.rings.push_back(std::move(ring));
        break;
      }
      case Fixture::circle:
        solid.rings.push_back(disc(fixture.points[0], fixture.radius));
        break;
      default: {
        svg::Polyline line{fixture.points,
                           fixture.kind == Fixture::chain && fixture.value.json().contains("loop")};
        const svg::Pen pen{.join = svg::Pen::bevel, .width = strip};
        for (Ring& ring : svg::stroke({line}, pen, strip / 10)) solid.rings.push_back(std::move(ring));
      }
    }
  }
  if (solid.rings.empty()) return {};
  try {
    return svg::outlines(svg::overlay({solid}, svg::Overlay::unite));
  } catch (const svg::ShapeError&) {  // they cross millions of times
    return {};
  }
}

}  // namespace ductile::rube
