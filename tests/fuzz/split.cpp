// Bytes as an outline with holes on a coarse grid, so that much is collinear or touches: cut, automatically
// or where the bytes say, into convex parts. Two bytes are a vertex; 0xff starts a hole.
#include <cmath>

#include "ductile/box2d.h"
#include "fuzz.h"

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
    const double whole = calibrate(scene).pieces[0].mass;
    double mass = 0, parts = 0;
    for (const Piece& piece : plan.pieces) {
      mass += piece.mass;
      for (const Convex& part : convex_parts(piece)) {
        require(part.size() >= 3 && part.size() <= 8, "a part has 3 to 8 vertices");
        for (std::size_t i = 0; i < part.size(); ++i) {
          const Point a = part[i], b = part[(i + 1) % part.size()];
          parts += (a.x * b.y - a.y * b.x) / 2;
        }
        if (const auto shape = polygon_shape(part)) require(shape->Validate(), "Box2D takes it");
      }
    }
    require(std::abs(mass - whole) <= 1e-12 * whole, "pieces weigh what the outline weighs");
    require(std::abs(parts * body.material->density - whole) <= 1e-9 * whole, "parts cover the pieces");
  } catch (const InvalidInput& error) {
    require(!error.problems().empty(), "an error says what is wrong");
  }
  return 0;
}
