// Two plans of the same pieces, run side by side.
#pragma once

#include <functional>
#include <vector>

#include "ductile/simulation.h"

namespace ductile {

struct Comparison {
  double error = 0;  ///< largest distance of a piece of a structure from its twin, over the structure's size
  double time_saved = 0;      ///< 1 − the median ratio of the time of a step, lean to full
  double saved_at_least = 0;  ///< the same of the ratio that the median is below with 98 % confidence
};

/// `structure` and `size` (m): of each piece, and of each structure; −1: not looked at. Both plans are run
/// for so many seconds, in turn, on this thread's own clock. Positions are compared up to the first break:
/// what comes down after it comes down elsewhere each time. `progress` is told the share that is done.
Comparison compare(const Plan& full, JointSolver full_solver, const Plan& lean, JointSolver lean_solver,
                   double seconds, const Stepping& stepping, const std::vector<int>& structure,
                   const std::vector<double>& size, const std::function<void(double)>& progress);

}  // namespace ductile
