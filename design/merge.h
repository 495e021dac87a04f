// Pieces that a plan does not need to tell apart become one rigid body.
#pragma once

#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

/// The plan with the two sides of each joint in `fused` (indices into Plan::joints, the first first) made one
/// rigid body, and the joints inside a body gone. A joint is passed over where a joint that is not in `fused`
/// would be inside. What is fused with a static body or held by the ground in all rows stands still.
Plan merged(const Plan& plan, const std::vector<int>& fused);

}  // namespace ductile
