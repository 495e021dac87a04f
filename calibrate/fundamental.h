// The lowest elastic frequency of each structure of a plan, which is what its joints' damping ratios refer
// to.
#pragma once

#include "ductile/calibrate.h"

namespace ductile::calibration {

/// Fills in PlannedJoint::damping_frequency of every joint that has a damping ratio and none yet: the lowest
/// natural frequency above zero, Hz, of the structure that the joint belongs to, undamped, unloaded, and as
/// designed (supports and static bodies hold still, loads have no mass). 0 where nothing in it is elastic.
void find_damping_frequencies(Plan& plan);

}  // namespace ductile::calibration
