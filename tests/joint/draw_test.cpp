// What is drawn of a joint says what the joint says.
#include <gtest/gtest.h>

#include "beam.h"

namespace ductile {
namespace {

struct Recorder : b2Draw {
  struct Mark {
    char kind;  // segment, circle, point
    b2Vec2 a, b;
    float size;
    b2Color color;
  };
  std::vector<Mark> marks;
  void DrawPolygon(const b2Vec2*, int32, const b2Color&) override { FAIL(); }
  void DrawSolidPolygon(const b2Vec2*, int32, const b2Color&) override { FAIL(); }
  void DrawSolidCircle(const b2Vec2&, float, const b2Vec2&, const b2Color&) override { FAIL(); }
  void DrawTransform(const b2Transform&) override { FAIL(); }
  void DrawCircle(const b2Vec2& c, float r, const b2Color& k) override { marks.push_back({'c', c, c, r, k}); }
  void DrawSegment(const b2Vec2& p, const b2Vec2& q, const b2Color& k) override {
    marks.push_back({'s', p, q, 0, k});
  }
  void DrawPoint(const b2Vec2& p, float s, const b2Color& k) override { marks.push_back({'p', p, p, s, k}); }
};

bool same(const b2Color& a, const b2Color& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

TEST(Draw, ForcesMomentsAndStages) {
  Beam beam({.pieces = 4, .moment_cap = 7800 * 10 * 200 * 2});
  beam.run(1);
  Recorder seen;
  beam.structure.draw(seen, {.force = 1e-6f, .moment = 1e-7f, .selected = beam.joints[2]});
  ASSERT_EQ(seen.marks.size(), 4u * 3 + 1);
  // The root holds the beam up: its shear points to the right of the axis, down, by the weight.
  const double weight = beam.mass() * 10;
  EXPECT_EQ(seen.marks[0].kind, 's');
  EXPECT_NEAR(seen.marks[0].b.x - seen.marks[0].a.x, 0, 1e-4);
  EXPECT_NEAR(seen.marks[0].b.y - seen.marks[0].a.y, -1e-6 * weight, 1e-6 * 1e-6 * weight);
  EXPECT_EQ(seen.marks[1].kind, 'c');
  EXPECT_NEAR(seen.marks[1].size, 1e-7 * weight * 10, 1e-5);
  EXPECT_NEAR(seen.marks[1].a.x, 0, 1e-4);
  EXPECT_GT(seen.marks[1].color.b, seen.marks[1].color.r);  // M < 0: blue
  EXPECT_EQ(seen.marks[2].kind, 'p');
  EXPECT_TRUE(same(seen.marks[2].color, stage_color(0.5)));
  EXPECT_NEAR(beam.joints[0]->stage(), 0.5, 1e-5);
  // The selected one has a point more.
  EXPECT_EQ(seen.marks[9].kind, 'p');
  EXPECT_LT(seen.marks[9].size, seen.marks[8].size);
  EXPECT_EQ(seen.marks[9].a, seen.marks[8].a);
  EXPECT_TRUE(same(seen.marks[9].color, {1, 1, 1}));
}

TEST(Draw, NoMarkOfScaleZero) {
  Beam beam({.pieces = 4});
  Recorder seen;
  beam.structure.draw(seen, {.dot = 0, .selected = beam.joints[2]});
  EXPECT_TRUE(seen.marks.empty());
}

TEST(Draw, NeutralPositionsStayWhereTheJointFlowedTo) {
  Beam beam({.pieces = 4, .moment_cap = 7800 * 10 * 200 / 1.3});
  beam.joints[0]->set_limits(10, unlimited, unlimited, unlimited);
  beam.run(6);
  Recorder seen;
  beam.structure.draw(seen, {.neutral = 2});
  ASSERT_EQ(seen.marks.size(), 8u);
  const b2Vec2 along = seen.marks[0].b - seen.marks[0].a;
  EXPECT_NEAR(along.Length(), 2, 1e-5);
  EXPECT_NEAR(b2Atan2(along.y, along.x), beam.joints[0]->plastic(rotation), 1e-5);
  EXPECT_LT(beam.joints[0]->plastic(rotation), -1);
  EXPECT_TRUE(same(seen.marks[1].color, stage_color(1 + beam.joints[0]->accumulated_rotation() / 10)));
  // Those that did not flow lie along the beam.
  const b2Vec2 straight = seen.marks[2].b - seen.marks[2].a;
  EXPECT_NEAR(b2Atan2(straight.y, straight.x), beam.pieces[1]->GetAngle(), 1e-4);
}

TEST(Draw, ABrokenJointIsDark) {
  Beam beam({.pieces = 2, .moment_cap = 1e5});
  for (ElasticPlasticJoint* j : beam.joints) j->set_limits(0.01, unlimited, unlimited, unlimited);
  while (!beam.joints[0]->broken()) beam.world.Step(1.0f / 60, 8, 3);
  Recorder seen;
  beam.structure.draw(seen);
  EXPECT_TRUE(same(seen.marks[0].color, stage_color(2)));
}

}  // namespace
}  // namespace ductile
