#include "pose.h"

#include <cmath>

namespace ductile::dynamics {

Turn turn_of_large(double angle) {
  const double t = angle * angle;
  if (!(t < 4e-3)) return {std::cos(angle), std::sin(angle)};
  return {1 - t * over(2) * (1 - t * over(12) * (1 - t * over(30) * (1 - t * over(56) * (1 - t * over(90))))),
          angle * (1 - t * over(6) * (1 - t * over(20) * (1 - t * over(42) * (1 - t * over(72)))))};
}

}  // namespace ductile::dynamics
