#include "ductile/joint.h"

namespace ductile {

void ElasticPlasticJointDef::Initialize(b2Body* a, b2Body* b, const b2Vec2& anchor) {
  const b2Vec2 to_anchor = anchor - a->GetWorldCenter();
  Initialize(a, b, anchor, to_anchor.LengthSquared() > 0 ? to_anchor : a->GetWorldVector({1, 0}));
}

void ElasticPlasticJointDef::Initialize(b2Body* a, b2Body* b, const b2Vec2& anchor, const b2Vec2& axis) {
  bodyA = a;
  bodyB = b;
  localAnchorA = a->GetLocalPoint(anchor);
  localAnchorB = b->GetLocalPoint(anchor);
  referenceAngle = b->GetAngle() - a->GetAngle();
  axisAngle = b2Atan2(axis.y, axis.x) - 0.5f * (a->GetAngle() + b->GetAngle());
}

}  // namespace ductile
