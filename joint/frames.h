// Between Box2D's floats in the world and the solver's doubles in bodies' own frames.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>

#include "vec3.h"

namespace ductile::dynamics {

// Floats that differ by no more than their own rounding say the same: nothing pushed the body.
inline bool same(float a, float b) {
  return a == b || std::abs(a - b) <= 2.4e-7f * std::max(1.0f, std::abs(b));
}

inline bool same(const b2Position& a, const b2Position& b) {
  return same(a.c.x, b.c.x) && same(a.c.y, b.c.y) && same(a.a, b.a);
}

inline bool same_bits(const b2Velocity& a, const b2Velocity& b) { return a.v == b.v && a.w == b.w; }

inline b2Velocity velocity_of(const b2Body& body) {
  return {body.GetLinearVelocity(), body.GetAngularVelocity()};
}

/// Of a body whose centre of mass is there.
inline b2Transform transform_of(const b2Body& body, const b2Position& at) {
  const b2Rot turn(at.a);
  return {at.c - b2Mul(turn, body.GetLocalCenter()), turn};
}

inline b2Velocity in_floats(const Vec3& v) {
  return {{static_cast<float>(v.x), static_cast<float>(v.y)}, static_cast<float>(v.w)};
}

inline Vec3 in_doubles(const b2Velocity& v) { return {v.v.x, v.v.y, v.w}; }

}  // namespace ductile::dynamics
