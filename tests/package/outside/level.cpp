// A game that calibrates while its level loads.
#include <ductile/box2d.h>
#include <ductile/files.h>
#include <ductile/picture.h>
#include <ductile/section.h>

#include <cmath>
#include <cstdio>

int main() {
  const ductile::Section section({{{0, 0}, {0.1, 0}, {0.1, 0.2}, {0, 0.2}}, {}}, ductile::materials::S355);
  const double M = section.capacities({0, 1}).M;
  std::printf("M = %g N m\n", M);

  const ductile::SceneDef scene = ductile::parse_scene(R"({
    "bodies": [ { "name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]] },
                { "name": "beam", "outline": [[0,0],[4,0],[4,0.2],[0,0.2]], "depth": 0.1, "material": "S355",
                  "split": { "pieces": 4 } } ],
    "joints": [ { "between": ["wall", "beam"] } ] })");
  const ductile::Plan plan = ductile::calibrate(scene);
  b2World world({0, -9.81f});
  ductile::Structure structure = ductile::build(world, plan);
  world.Step(1 / 60.0f, 8, 3);
  structure.update();

  const std::string picture = ductile::picture_svg(plan, {.title = "level", .panels = {{}}});

  const double exact = 0.1 * 0.2 * 0.2 / 4 * 355e6;  // b h²/4 f_y
  const auto right = [&](double moment) { return std::abs(moment / exact - 1) < 1e-12; };
  return right(M) && right(plan.joints[0].M) && structure.joints().size() == 4 && picture.starts_with("<svg")
             ? 0
             : 1;
}
