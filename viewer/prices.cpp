#include "prices.h"

namespace ductile::viewer {

double price_of(const SceneDef& scene, const Material& material) {
  for (const BodyDef& body : scene.bodies) {
    if (body.material == material && body.price > 0) return body.price;
  }
  return 0;
}

SceneDef with_price(SceneDef scene, const Material& material, double price) {
  for (BodyDef& body : scene.bodies) {
    if (body.type == BodyType::dynamic_body && body.material == material) body.price = price;
  }
  return scene;
}

double cost(const Plan& plan) {
  double cost = 0;
  for (const Piece& piece : plan.pieces)
    cost += piece.mass * plan.bodies[static_cast<std::size_t>(piece.body)].price;
  return cost;
}

}  // namespace ductile::viewer
