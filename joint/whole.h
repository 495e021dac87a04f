// What hangs together, and how it turns as one.
//
// Where nothing else holds bodies that joints, links and contacts hold to each other, no row of theirs knows
// whether all of them turn about their centre of mass as one: J R = 0 for its velocities R. So the turn rate
// of such a whole, spin = RᵀMv / RᵀMR, is that of its angular momentum alone, whatever the rows do.
#pragma once

#include "system.h"

namespace ductile::dynamics {

/// The one that has the sums of what i is part of.
template <class Part>
int root_of(Vector<Part>& parts, int i) {
  while (parts[z(i)].part_of != i) i = parts[z(i)].part_of = parts[z(parts[z(i)].part_of)].part_of;
  return i;
}

/// Finds System::wholes, with their spins by the bodies' v_free. Links and contacts count where they had an
/// impulse in the last solve.
void find_wholes(System& system);

/// Of a free body.
inline Whole& whole_of(System& system, int body) { return system.wholes[z(root_of(system.wholes, body))]; }

/// Velocities of a body in its own frame where all turns by 1 rad/s about a point.
inline Vec3 turning_about(const Place& place, double x, double y) {
  const double rx = place.pose.x - x, ry = place.pose.y - y;
  return {place.turn.s * rx - place.turn.c * ry, place.turn.c * rx + place.turn.s * ry, 1};
}

}  // namespace ductile::dynamics
