// How far two convex shapes of fixtures are apart, by Box2D's GJK.
#pragma once

#include <box2d/b2_distance.h>
#include <box2d/box2d.h>

namespace ductile::dynamics {

/// Two convex shapes, skins aside.
struct Nearest {
  float distance;  // m
  b2Vec2 normal;   // from a to b; 0 where they overlap
};

inline Nearest nearest(const b2DistanceProxy& a, const b2Transform& at_a, const b2DistanceProxy& b,
                       const b2Transform& at_b) {
  b2DistanceInput input;
  input.proxyA = a;
  input.proxyB = b;
  input.transformA = at_a;
  input.transformB = at_b;
  input.useRadii = false;
  b2SimplexCache cache;
  cache.count = 0;
  b2DistanceOutput found;
  b2Distance(&found, &cache, &input);
  b2Vec2 normal = found.pointB - found.pointA;
  if (normal.Normalize() == 0) normal.SetZero();
  return {found.distance, normal};
}

inline b2DistanceProxy proxy(const b2Fixture& fixture, int32 child) {
  b2DistanceProxy made;
  made.Set(fixture.GetShape(), child);
  return made;
}

}  // namespace ductile::dynamics
