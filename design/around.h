// The energy that may come down on a plan's structures from what is loose around them.
#pragma once

#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

/// J: of the loose pieces, what they move with and what they may fall, down to the lowest point of anything
/// else. Unlimited where loads, motors or moving kinematic bodies feed it.
double energy_around(const Plan& plan, const std::vector<int>& loose);

}  // namespace ductile
