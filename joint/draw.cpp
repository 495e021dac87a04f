// What joints carry and have suffered, through the debug drawing that every Box2D game has.

#include <algorithm>
#include <cmath>

#include "structure.h"

namespace ductile {

namespace {

// Every kind of colour vision tells these apart (Okabe and Ito, jfly.uni-koeln.de/color).
const b2Color force_colour{0.34f, 0.71f, 0.91f}, opening_colour{0.84f, 0.37f, 0},
    closing_colour{0, 0.45f, 0.7f}, neutral_colour{0.8f, 0.47f, 0.65f}, selection_colour{1, 1, 1};

struct Stop {
  double stage;
  float red, green, blue;
};
// sRGB, linear in between. Two stops at 1: just below yield, and from yield on.
constexpr Stop stops[] = {{0, 211, 220, 230},  {0.5, 127, 174, 216}, {1, 20, 95, 168}, {1, 255, 223, 51},
                          {1.5, 237, 125, 20}, {1.9, 201, 38, 28},   {2, 102, 13, 74}};

b2Vec2 turned(double angle) {
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

}  // namespace

b2Color stage_color(double stage) {
  std::size_t above = 1;
  while (above + 1 < std::size(stops) && stage >= stops[above].stage) ++above;
  const Stop &a = stops[above - 1], &b = stops[above];
  const double span = b.stage - a.stage;
  const auto t = static_cast<float>(span > 0 ? std::clamp((stage - a.stage) / span, 0.0, 1.0) : 1.0);
  const auto mix = [t](float from, float to) { return (from + t * (to - from)) / 255; };
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
}

double ElasticPlasticJoint::stage() const {
  if (broken()) return 2;
  if (dissipated() > 0) return 1 + std::clamp(capacity_used(), 0.0, 1.0);
  double most = 0;  // NaN, of an unlimited row, loses every comparison
  for (const Row row : {axial, shear, rotation}) most = usage(row) > most ? usage(row) : most;
  return std::min(most, 1.0);
}

void Structure::draw(b2Draw& canvas, const JointDrawing& how) const {
  for (const ElasticPlasticJoint* joint : impl_->joints) {
    const SolverJoint& j = joint->state();
    const b2Vec2 at = 0.5f * (joint->GetAnchorA() + joint->GetAnchorB()), t = joint->axis(), n{-t.y, t.x};
    if (how.neutral > 0) {
      // Where anchor B, and a piece of it along the axis, would be without stress: from A, and turned.
      const double relative =
          double{joint->m_bodyB->GetAngle()} - double{joint->m_bodyA->GetAngle()} - j.reference;
      const double axis_of_a = std::atan2(t.y, t.x) - j.follow * relative;
      const b2Vec2 rest = joint->GetAnchorA() + static_cast<float>(j.plastic[axial]) * t +
                          static_cast<float>(j.plastic[shear]) * n;
      canvas.DrawSegment(rest, rest + how.neutral * turned(axis_of_a + j.plastic[rotation]), neutral_colour);
    }
    if (how.force > 0) {
      const b2Vec2 force =
          static_cast<float>(joint->force(axial)) * t + static_cast<float>(joint->force(shear)) * n;
      canvas.DrawSegment(at, at + how.force * force, force_colour);
    }
    if (how.moment > 0) {
      const auto moment = static_cast<float>(joint->force(rotation));
      canvas.DrawCircle(at, how.moment * std::abs(moment), moment > 0 ? opening_colour : closing_colour);
    }
    canvas.DrawPoint(at, how.dot, stage_color(joint->stage()));
    if (joint == how.selected) canvas.DrawPoint(at, 0.4f * how.dot, selection_colour);
  }
}

}  // namespace ductile
