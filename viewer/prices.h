// What bodies cost by the price of a kg of their material.
#pragma once

#include "ductile/calibrate.h"

namespace ductile::viewer {

/// Of a kg of a material, as a body that is made of it has it; 0: not known.
double price_of(const SceneDef& scene, const Material& material);
/// What moves and is made of a material has that price.
SceneDef with_price(SceneDef scene, const Material& material, double price);
/// Of all that moves and whose price is known.
double cost(const Plan& plan);

}  // namespace ductile::viewer
