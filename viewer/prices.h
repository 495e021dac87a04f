// What materials cost, and what a scene costs by that.
#pragma once

#include <utility>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile::viewer {

class Prices {
 public:
  /// Of a kg, in whatever currency; 0: not known.
  double of(const Material& material) const;
  void set(const Material& material, double price);
  /// Of all that moves and whose price is known.
  double cost(const Plan& plan) const;

 private:
  std::vector<std::pair<Material, double>> known_;
};

}  // namespace ductile::viewer
