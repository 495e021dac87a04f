// Bytes as an outline with holes on a coarse grid, so that much is collinear or touches: cut, automatically
// or where the bytes say, into convex parts. Two bytes are a vertex; 0xff starts a hole.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/box2d.h"
#include "ductile/plane.h"
#include "fuzz.h"

namespace ductile {

// m²: how far an outline's area may be off by rounding alone, with ε = 2⁻⁵². The point a + s(b − a) of a cut
// on an edge is off it by 2.5 ε R in each coordinate, as |b − a| ≤ 2R for coordinates up to R; points that
// are off change the area by half of the perimeter P times their distance at most: 1.8 ε R P. Green's theorem
// about a vertex, whose differences are up to D, the diameter, rounds each of its n products by ε D²/2 and
// their sum by less. Where the area is far less than R P, as of a spike, 1e-12 of the area is more than
// doubles can tell.
double rounding(const Outline& outline) {
  double reach = 0, perimeter = 0, n = 0;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      reach = std::max(reach, length(ring[i]));
      perimeter += length(ring[(i + 1) % ring.size()] - ring[i]);
      ++n;
    }
  };
  add(outline.outer);
  for (const Ring& hole : outline.holes) add(hole);
  const double diameter = bounds_of(outline.outer).diagonal();
  return std::numeric_limits<double>::epsilon() * (2 * reach * perimeter + n * diameter * diameter);
}

}  // namespace ductile

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace ductile;
  if (size < 4 || size > 2000) return 0;
  BodyDef body{.material = materials::S355};
  SceneDef scene;
  scene.target_error = std::pow(10, -0.5 - data[0] / 100.0);
  const double scale = std::pow(10, data[1] / 64.0 - 2);
  body.automatic = data[2] < 128;
  const int cuts = body.automatic ? 0 : data[2] % 8;
  std::size_t at = 3;
  const auto point = [&] {
    const Point p{scale * static_cast<std::int8_t>(data[at]), scale * static_cast<std::int8_t>(data[at + 1])};
    at += 2;
    return p;
  };
  for (int i = 0; i < cuts && at + 4 <= size; ++i) {
    const Point p = point(), q = point();
    body.cuts.push_back({p, q});
  }
  Ring* ring = &body.outline.outer;
  while (at + 2 <= size) {
    if (data[at] == 0xff) {
      ring = &body.outline.holes.emplace_back();
      ++at;
    } else {
      ring->push_back(point());
    }
  }
  scene.bodies = {body};
  try {
    const Plan plan = calibrate(scene);
    scene.bodies[0].automatic = false;
    scene.bodies[0].cuts.clear();
    const Piece one = calibrate(scene).pieces[0];
    const double whole = one.mass;
    double mass = 0, parts = 0, error = rounding(one.outline);
    for (const Piece& piece : plan.pieces) {
      mass += piece.mass;
      error += rounding(piece.outline);
      for (const Convex& part : convex_parts(piece)) {
        require(part.size() >= 3 && part.size() <= 8, "a part has 3 to 8 vertices");
        for (std::size_t i = 0; i < part.size(); ++i) {
          const Point a = part[i], b = part[(i + 1) % part.size()];
          parts += (a.x * b.y - a.y * b.x) / 2;
        }
        if (const auto shape = polygon_shape(part)) require(shape->Validate(), "Box2D takes it");
      }
    }
    require(std::abs(mass - whole) <= error * body.material->density, "pieces weigh what the outline weighs");
    require(std::abs(parts * body.material->density - whole) <= 1e-9 * whole, "parts cover the pieces");
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
