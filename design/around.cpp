#include "around.h"

#include <algorithm>
#include <cmath>

#include "ductile/plane.h"

namespace ductile {
namespace {

bool is_fed(const Plan& plan, const std::vector<bool>& is_loose) {
  const auto pushes = [&](const Plan::Load& load) {
    return is_loose[static_cast<std::size_t>(load.piece)] &&
           (load.def.force != Point{} || load.def.moment != 0);
  };
  const auto turns = [](const Plan::Wheel& w) { return w.def.motor_torque > 0 && w.def.motor_speed != 0; };
  const auto moves = [](const BodyDef& b) {
    return b.type == BodyType::kinematic_body && (b.velocity != Point{} || b.angular_velocity != 0);
  };
  return std::any_of(plan.loads.begin(), plan.loads.end(), pushes) ||
         std::any_of(plan.wheels.begin(), plan.wheels.end(), turns) ||
         std::any_of(plan.bodies.begin(), plan.bodies.end(), moves);
}

// The greatest speed of a piece's centre: bodies turn about a point inside them.
double fastest(const Plan& plan, const Piece& piece) {
  const BodyDef& body = plan.bodies[static_cast<std::size_t>(piece.body)];
  double reach = 0;
  if (body.angular_velocity != 0)
    for (const Piece& other : plan.pieces)
      if (other.body == piece.body) reach = std::max(reach, length(other.center - piece.center));
  return length(body.velocity) + std::abs(body.angular_velocity) * reach;
}

}  // namespace

double energy_around(const Plan& plan, const std::vector<int>& loose) {
  std::vector<bool> is_loose(plan.pieces.size());
  for (const int i : loose) is_loose[static_cast<std::size_t>(i)] = true;
  if (loose.empty()) return 0;
  if (is_fed(plan, is_loose)) return unlimited;

  // Gravity does work −g·p.
  double lowest = unlimited;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (!is_loose[i])
      for (const Point& p : plan.pieces[i].outline.outer) lowest = std::min(lowest, -dot(plan.gravity, p));
  double energy = 0;
  for (const int i : loose) {
    const Piece& piece = plan.pieces[static_cast<std::size_t>(i)];
    if (piece.part_of >= 0) continue;
    const double v = fastest(plan, piece),
                 w = plan.bodies[static_cast<std::size_t>(piece.body)].angular_velocity;
    energy += piece.mass * (v * v / 2 + std::max(0., -dot(plan.gravity, piece.center) - lowest)) +
              piece.inertia * w * w / 2;
  }
  return energy;
}

}  // namespace ductile
