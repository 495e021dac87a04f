// Worlds compared to the bit.
#pragma once

#include <box2d/box2d.h>

#include <vector>

namespace ductile {

/// Every number that a step changes, of all bodies.
inline std::vector<float> world_state(const b2World& world) {
  std::vector<float> list;
  for (const b2Body* body = world.GetBodyList(); body; body = body->GetNext()) {
    const b2Vec2 p = body->GetWorldCenter(), v = body->GetLinearVelocity();
    for (const float value : {p.x, p.y, body->GetAngle(), v.x, v.y, body->GetAngularVelocity()})
      list.push_back(value);
  }
  return list;
}

}  // namespace ductile
