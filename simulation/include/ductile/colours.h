// What pictures, replays and the window show of a joint's reading.
#pragma once

#include "ductile/simulation.h"
#include "ductile/stage.h"

namespace ductile {

/// How far the joint is on its way to breaking (stage.h).
inline double stage(const JointReading& joint) {
  return stage_of(joint.broken, joint.dissipated > 0, joint.capacity_used,
                  {joint.usage.N, joint.usage.Q, joint.usage.M});
}

/// Radius of the dot that marks a plastic hinge, as a share of the joint's height: it grows with the
/// accumulated plastic rotation, rad, fast at first, towards one half. 0: no hinge.
inline double hinge_dot(double accumulated_rotation) {
  if (!(accumulated_rotation > 1e-6)) return 0;
  return 0.1 + 0.4 * accumulated_rotation / (accumulated_rotation + 0.3);
}

}  // namespace ductile
