// The units in which a linear programme of a plan's forces is well scaled.
#pragma once

#include <cmath>
#include <vector>

#include "yield.h"

namespace ductile {

/// Forces and lengths near 1: the logarithmic mean of all caps that act, and of moments to forces.
struct Units {
  double force = 1, length = 1;
  explicit Units(const std::vector<Yield>& yields) {
    double sum[2] = {}, count[2] = {};
    for (const Yield& yield : yields)
      for (const Row row : {axial, shear, rotation})
        for (const bool reverse : {false, true})
          if (const double cap = yield.cap(row, reverse); cap > 0 && cap < unlimited) {
            sum[row == rotation] += std::log(cap);
            count[row == rotation] += 1;
          }
    const double moment = count[1] > 0 ? std::exp(sum[1] / count[1]) : 1;
    force = count[0] > 0 ? std::exp(sum[0] / count[0]) : moment;
    length = count[1] > 0 ? moment / force : 1;
  }
  double of(int row) const { return row == rotation ? force * length : force; }
};

}  // namespace ductile
