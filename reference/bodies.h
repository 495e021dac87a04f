// Boxes, and what is measured of bodies: in double, from what Box2D tells.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "ductile/joint.h"

namespace ductile {

inline b2Vec2 vec(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

struct Box {
  double x = 0, y = 0, width = 1, height = 1;
  double mass = 1000;  // kg; inertia of the box
  double angle = 0;
  b2BodyType type = b2_dynamicBody;
  short group = -1;  // boxes of one negative group do not collide
  double friction = 0.6;
};

inline b2Body* add_box(b2World& world, const Box& box) {
  b2BodyDef def;
  def.type = box.type;
  def.position = vec(box.x, box.y);
  def.angle = static_cast<float>(box.angle);
  b2Body* body = world.CreateBody(&def);
  b2PolygonShape shape;
  shape.SetAsBox(static_cast<float>(box.width / 2), static_cast<float>(box.height / 2));
  b2FixtureDef fixture;
  fixture.shape = &shape;
  fixture.density = 1;
  fixture.friction = static_cast<float>(box.friction);
  fixture.filter.groupIndex = box.group;
  body->CreateFixture(&fixture);
  const double inertia = box.mass * (box.width * box.width + box.height * box.height) / 12;
  const b2MassData data{static_cast<float>(box.mass), {0, 0}, static_cast<float>(inertia)};
  body->SetMassData(&data);
  return body;
}

inline double central_inertia(const b2Body* body) {
  return double{body->GetInertia()} - double{body->GetMass()} * body->GetLocalCenter().LengthSquared();
}

inline double kinetic_energy(std::span<b2Body* const> bodies) {
  double sum = 0;
  for (const b2Body* b : bodies) {
    const double x = b->GetLinearVelocity().x, y = b->GetLinearVelocity().y, w = b->GetAngularVelocity();
    sum += (b->GetMass() * (x * x + y * y) + central_inertia(b) * w * w) / 2;
  }
  return sum;
}

inline double angular_momentum(std::span<b2Body* const> bodies, b2Vec2 about = {0, 0}) {
  double sum = 0;
  for (const b2Body* b : bodies) {
    const double x = double{b->GetWorldCenter().x} - about.x, y = double{b->GetWorldCenter().y} - about.y;
    sum += b->GetMass() * (x * b->GetLinearVelocity().y - y * b->GetLinearVelocity().x) +
           central_inertia(b) * b->GetAngularVelocity();
  }
  return sum;
}

inline double potential_energy(std::span<b2Body* const> bodies, double gravity) {
  double sum = 0;
  for (const b2Body* b : bodies) sum += b->GetMass() * gravity * b->GetWorldCenter().y;
  return sum;
}

inline bool finite(std::span<b2Body* const> bodies) {
  for (const b2Body* b : bodies) {
    if (!b->GetPosition().IsValid() || !b->GetLinearVelocity().IsValid() || !std::isfinite(b->GetAngle()) ||
        !std::isfinite(b->GetAngularVelocity())) {
      return false;
    }
  }
  return true;
}

}  // namespace ductile
