// A hash of 600 steps of structures that swing, yield, break and are struck: poses and velocities of all
// bodies, bit by bit. The same on all platforms where mathematical functions round alike.
#include <bit>
#include <cstdint>
#include <cstdio>

#include "../calibrate/scenes.h"
#include "ductile/box2d.h"

namespace {

using namespace ductile;

void hash(const char* name, const SceneDef& scene) {
  b2World world({0, 0});
  Built built;
  Structure structure = build(world, calibrate(scene), {}, &built);
  world.SetGravity({0, -9.81f});
  std::uint32_t sum = 0x811c9dc5;  // FNV-1a
  std::printf("%s", name);
  for (int step = 1; step <= 600; ++step) {
    world.Step(1 / 60.0f, 8, 3);
    structure.update();
    for (const b2Body* body : built.bodies) {
      const b2Vec2 at = body->GetPosition(), v = body->GetLinearVelocity();
      for (const float x : {at.x, at.y, body->GetAngle(), v.x, v.y, body->GetAngularVelocity()})
        sum = (sum ^ std::bit_cast<std::uint32_t>(x)) * 0x01000193;
    }
    if (step == 1 || step == 10 || step == 100 || step == 600) std::printf(" %08x", sum);
  }
  std::printf(" %zu joints left\n", structure.joints().size());
}

}  // namespace

int main() {
  const BodyDef block{.name = "block", .outline = {rectangle(17, 4, 19, 6), {}}, .material = test_steel};
  SceneDef scene = cantilever(20);
  hash("swings", scene);
  scene.bodies.push_back(block);
  hash("struck", scene);
  scene.bodies[1].material->yield_stress = 20e6;
  hash("yields", scene);
  scene.joint.max_rotation = 0.05;
  hash("breaks", scene);
}
