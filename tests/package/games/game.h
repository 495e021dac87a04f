// What these games share.
#pragma once

#include <ductile/joint.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace game {

using namespace ductile;  // NOLINT: each is one file

inline int failed = 0;

/// Says what it is, and counts it where it is not so.
inline void check(bool good, const char* what, double value = 0) {
  std::printf("%s %s: %.9g\n", good ? "  " : "NO", what, value);
  if (!good) ++failed;
}
inline void check_near(double value, double expected, double within, const char* what) {
  check(std::abs(value - expected) <= within, what, value);
}

inline b2Body* box(b2World& world, double x, double y, double width, double height, double mass) {
  b2BodyDef def;
  def.type = mass > 0 ? b2_dynamicBody : b2_staticBody;
  def.position = {static_cast<float>(x), static_cast<float>(y)};
  b2Body* body = world.CreateBody(&def);
  b2PolygonShape shape;
  shape.SetAsBox(static_cast<float>(width / 2), static_cast<float>(height / 2));
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.density = static_cast<float>(mass / (width * height));
  fixture.filter.groupIndex = -1;
  body->CreateFixture(&fixture);
  return body;
}

inline void run(b2World& world, Structure& structure, double seconds, double hz = 60) {
  for (int i = 0; i < std::lround(seconds * hz); ++i) {
    world.Step(static_cast<float>(1 / hz), 8, 3);
    structure.update();
  }
}

/// A cantilever of `pieces` of 1 m, 0.5 m high, 250 kg each, clamped to a wall; rigid unless `root` says
/// otherwise.
struct Beam {
  explicit Beam(b2World& world, Structure& structure, int pieces, const RowDef& root = {}) {
    b2Body* last = box(world, -0.5, 0, 1, 1, 0);
    for (int i = 0; i < pieces; ++i) {
      bodies.push_back(box(world, i + 0.5, 0, 1, 0.5, 250));
      ElasticPlasticJointDef def;
      def.Initialize(last, bodies.back(), {static_cast<float>(i), 0}, {1, 0});
      if (i == 0) def.rows[rotation] = root;
      joints.push_back(structure.create_joint(def));
      last = bodies.back();
    }
  }
  std::vector<b2Body*> bodies;
  std::vector<ElasticPlasticJoint*> joints;
};

}  // namespace game
