// Ropes, struts and drives: what is wrong with one as a scene has it, and what it is in a plan.
#pragma once

#include <string>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile::calibration {

/// All but the numbers' ranges, which fields.h tells.
void check_line(const JointBetweenDef& def, const std::string& place, std::vector<Problem>& problems);

/// A line between two pieces, without names and reasons; `damping_ratio` where its overrides have none.
PlannedJoint line_between(const JointBetweenDef& def, const Piece& a, const Piece& b, Point from, Point to,
                          double damping_ratio);

/// Gives the joint a drive, and its row the drive's cap.
void put_drive(PlannedJoint& joint, const DriveDef& drive);

}  // namespace ductile::calibration
