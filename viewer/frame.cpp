#include "frame.h"

namespace ductile::viewer {

std::size_t Frame::size() const {
  return sizeof *this + pieces.capacity() * sizeof pieces[0] + joints.capacity() * sizeof joints[0] +
         peaks.capacity() * sizeof peaks[0] + thrown.capacity() * sizeof thrown[0];
}

Frame see(Simulation& simulation) {
  const Plan& plan = simulation.plan();
  Frame frame;
  frame.time = simulation.time();
  frame.step_us = simulation.last_step_us();
  frame.pieces.reserve(plan.pieces.size());
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const PieceReading& p = frame.pieces.emplace_back(simulation.piece(i));
    const Piece& piece = plan.pieces[i];
    frame.energy.kinetic += 0.5 * (piece.mass * dot(p.velocity, p.velocity) +
                                   piece.inertia * p.angular_velocity * p.angular_velocity);
    frame.energy.potential -= piece.mass * dot(plan.gravity, p.position - piece.center);
  }
  frame.joints.reserve(plan.joints.size());
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    frame.energy.dissipated += frame.joints.emplace_back(simulation.joint(i)).dissipated;
  }
  if (const Structure* structure = simulation.structure()) {
    for (const ElasticPlasticJoint* joint : structure->joints()) {
      frame.energy.elastic += joint->elastic_energy();
    }
    frame.report = structure->report();
  }
  if (const EnergyLedger* ledger = simulation.ledger()) frame.energy = ledger->energy();
  return frame;
}

Point carried(const Plan& plan, int piece, Point at, const Frame& frame) {
  if (piece < 0) return at;
  const auto i = static_cast<std::size_t>(piece);
  return frame.pieces[i].position + Rotation(frame.pieces[i].angle) * (at - plan.pieces[i].center);
}

Placed place(const Plan& plan, std::size_t joint, const Frame& frame) {
  const PlannedJoint& planned = plan.joints[joint];
  const auto turns = [&](int piece) {
    return piece >= 0 &&
           plan.bodies[static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body)].type ==
               BodyType::dynamic_body;
  };
  const auto angle = [&](int piece) { return frame.pieces[static_cast<std::size_t>(piece)].angle; };
  double turn = 0;
  if (planned.a >= 0) {
    if (turns(planned.a) && turns(planned.b)) {
      turn = (angle(planned.a) + angle(planned.b)) / 2;
    } else {
      turn = angle(turns(planned.a) ? planned.a : planned.b);
    }
  }
  const Point a = carried(plan, planned.a, planned.anchor, frame);
  const Point b = carried(plan, planned.b, planned.far_anchor(), frame);
  const double apart = length(b - a);
  if (planned.end && apart > 0) return {0.5 * (a + b), (1 / apart) * (b - a)};
  return {0.5 * (a + b), Rotation(turn) * planned.axis};
}

}  // namespace ductile::viewer
