#include "prices.h"

#include <algorithm>

namespace ductile::viewer {

double Prices::of(const Material& material) const {
  const auto found =
      std::find_if(known_.begin(), known_.end(), [&](const auto& known) { return known.first == material; });
  return found == known_.end() ? 0 : found->second;
}

void Prices::set(const Material& material, double price) {
  std::erase_if(known_, [&](const auto& known) { return known.first == material; });
  if (price > 0) known_.emplace_back(material, price);
}

double Prices::cost(const Plan& plan) const {
  double cost = 0;
  for (const Piece& piece : plan.pieces) {
    const auto& material = plan.bodies[static_cast<std::size_t>(piece.body)].material;
    if (material) cost += piece.mass * of(*material);
  }
  return cost;
}

}  // namespace ductile::viewer
