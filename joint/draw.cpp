// What joints carry and have suffered, through the debug drawing that every Box2D game has.

#include <cmath>

#include "ductile/stage.h"
#include "structure.h"

namespace ductile {

using namespace dynamics;

namespace {

// Every kind of colour vision tells these apart (Okabe and Ito, jfly.uni-koeln.de/color).
const b2Color force_colour{0.34f, 0.71f, 0.91f}, opening_colour{0.84f, 0.37f, 0},
    closing_colour{0, 0.45f, 0.7f}, neutral_colour{0.8f, 0.47f, 0.65f}, selection_colour{1, 1, 1};

b2Vec2 turned(double angle) {
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
}

}  // namespace

b2Color stage_color(double stage) {
  const Colour colour = stage_colour(stage);
  return {static_cast<float>(colour.red) / 255, static_cast<float>(colour.green) / 255,
          static_cast<float>(colour.blue) / 255};
}

double ElasticPlasticJoint::stage() const {
  return stage_of(broken(), yielded() || capacity_used() > 0, capacity_used(),
                  {usage(axial), usage(shear), usage(rotation)});
}

void Structure::draw(b2Draw& canvas, const JointDrawing& how) const {
  for (const ElasticPlasticJoint* joint : impl_->joints) {
    const Joint& j = joint->row_state();
    const Rows& plastic = joint->record().plastic.net;
    const b2Vec2 at = 0.5f * (joint->GetAnchorA() + joint->GetAnchorB()), t = joint->axis(), n{-t.y, t.x};
    if (how.neutral > 0) {
      // Where anchor B, and a piece of it along the axis, would be without stress: from A, and turned.
      const double relative =
          double{joint->m_bodyB->GetAngle()} - double{joint->m_bodyA->GetAngle()} - j.frame.reference;
      const double axis_of_a = std::atan2(t.y, t.x) - j.frame.follow * relative;
      const b2Vec2 rest = joint->GetAnchorA() + static_cast<float>(plastic[axial]) * t +
                          static_cast<float>(plastic[shear]) * n;
      canvas.DrawSegment(rest, rest + how.neutral * turned(axis_of_a + plastic[rotation]), neutral_colour);
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
    if (!(how.dot > 0)) continue;
    canvas.DrawPoint(at, how.dot, stage_color(joint->stage()));
    if (joint == how.selected) canvas.DrawPoint(at, 0.4f * how.dot, selection_colour);
  }
}

}  // namespace ductile
