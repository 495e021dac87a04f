// Where a body is, in doubles: one float ulp at 20 m times the stiffness of steel is 10⁸ N.
#pragma once

#include "vec3.h"

namespace ductile::dynamics {

/// Pose of a centre of mass: m from the structure's origin, rad.
struct Pose {
  double x = 0, y = 0, angle = 0;
};

/// A pose with the cosine and sine of its angle.
struct Place {
  Pose pose;
  Turn turn;
};

template <>
inline constexpr bool all_doubles<Place> = true;
template <>
inline constexpr bool all_doubles<Pose> = true;

/// Puts a body at a pose.
inline void put(Place& place, const Pose& at) {
  if (at.angle != place.pose.angle) place.turn = turn_of(at.angle);
  place.pose = at;
}

/// Moves a body by a displacement in its own frame.
inline void displace(Place& place, const Vec3& by) {
  place.pose.x += place.turn.c * by.x - place.turn.s * by.y;
  place.pose.y += place.turn.s * by.x + place.turn.c * by.y;
  const double before = place.pose.angle;
  place.pose.angle += by.w;
  if (place.pose.angle == before) return;
  // The turn follows the angle as rounded, so that the two do not drift apart, and is scaled to length 1.
  const Turn t = place.turn * turn_of(place.pose.angle - before);
  const double length = (3 - t.c * t.c - t.s * t.s) / 2;
  place.turn = {length * t.c, length * t.s};
}

/// The velocity of a body in its own frame as that is after it has turned with it for h seconds.
inline Vec3 after_turning(const Vec3& v, double h) { return into_world(turn_of(-h * v.w), v); }

}  // namespace ductile::dynamics
