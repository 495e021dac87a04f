#include <gtest/gtest.h>

#include "ductile/joint.h"

namespace {
using namespace ductile;

TEST(ElasticPlasticJointDef, AxisDefaultsToTheLineFromTheFirstBodysCentreToTheAnchor) {
  b2World world({0, 0});
  b2BodyDef def;
  def.angle = 0.5f;
  b2Body* a = world.CreateBody(&def);
  def.position.Set(2, 0);
  b2Body* b = world.CreateBody(&def);
  ElasticPlasticJointDef joint;
  joint.Initialize(a, b, {1, 1});
  EXPECT_NEAR(joint.axisAngle, b2_pi / 4 - 0.5f, 1e-6);
  EXPECT_NEAR(joint.referenceAngle, 0, 1e-6);
}
}  // namespace
