// Joints that go leave the rest as it is: nothing else is formed anew, and what is solved is the same.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "allocations.h"
#include "beam.h"
#include "bodies.h"
#include "eventful.h"

namespace ductile {
namespace {

/// A cantilever of 40 pieces with a second joint beside each: every other one holds nothing, and the rest are
/// as stiff as the beam.
struct Doubled : Beam {
  Doubled() : Beam({.pieces = 40, .youngs_modulus = 210e9, .damping_time = 0.03}) {
    for (int i = 0; i < 40; ++i) {
      ElasticPlasticJointDef def;
      def.Initialize(i == 0 ? wall : pieces[static_cast<std::size_t>(i) - 1],
                     pieces[static_cast<std::size_t>(i)], point(0.5 * i), {1, 0});
      if (i % 2 == 0) {
        for (RowDef& row : def.rows) row = RowDef::free();
      } else {
        set_rows(def, 0.5);
      }
      spare.push_back(structure.create_joint(def));
    }
  }
  void drop(std::size_t joint) { world.DestroyJoint(spare[joint]); }
  std::vector<ElasticPlasticJoint*> spare;
};

// What grows is the list of pairs of bodies that the pattern of H has, and of those that were joined.
TEST(Removal, AllocatesNoComponent) {
  Doubled beam;
  beam.run(0.5);
  for (const std::size_t joint : {7U, 15U}) {
    const long before = allocations();
    beam.drop(joint);
    beam.world.Step(1 / 60.0f, 8, 3);
    beam.structure.update();
    EXPECT_LE(allocations() - before, 2);
  }
}

// More joints than a component outlasts go from the second beam: it is formed anew, and moves alike, as these
// held nothing. What differs is the order of elimination.
TEST(Removal, LeavesWhatAComponentFormedAnewWouldSolve) {
  Doubled worn, anew;
  for (Doubled* beam : {&worn, &anew}) beam->run(0.25);
  for (std::size_t i = 0; i < 40; i += 4) anew.drop(i);
  for (Doubled* beam : {&worn, &anew}) {
    beam->drop(3);
    beam->drop(21);
    beam->run(1);
  }
  expect_alike(worn, anew);
}

// A post of three pieces loses its foot: it comes to rest on the bridge that it stood on, as another
// component and by contacts alone. The bridge's supports bear all of it.
TEST(Removal, WhatBrokeOffMayComeBack) {
  eventful::Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 20, unlimited, unlimited, 0);
  ElasticPlasticJoint *left = s.structure.joints().front(), *last = s.structure.joints().back();
  b2Body* middle = s.structure.joints()[9]->GetBodyB();
  ElasticPlasticJointDef def;
  def.Initialize(last->GetBodyB(), add_box(s.world, {.x = 20.5, .type = b2_staticBody}), {20, 0}, {1, 0});
  ElasticPlasticJoint* right = s.structure.create_joint(def);
  s.add_row(middle, 9.5, 0.5, 0, 1, 3, unlimited, unlimited, 0);
  for (ElasticPlasticJoint* j : s.structure.joints()) j->set_stiffness(rotation, 1e8, 0.5);
  ElasticPlasticJoint* foot = s.structure.joints()[21];
  ASSERT_EQ(foot->GetBodyA(), middle);
  s.run(60);
  const auto borne = [&] {
    return std::abs(left->GetReactionForce(60).y) + std::abs(right->GetReactionForce(60).y);
  };
  const double weight = 23 * 1000 * 10;
  s.world.DestroyJoint(foot);
  s.run(1200);
  EXPECT_NEAR(borne(), weight, 1e-5 * weight);
  EXPECT_EQ(s.structure.report().bounds_hit, 0);
}

// Saved after each joint that went, in the order in which they went, worlds run on to the bit.
TEST(Removal, IsSaved) {
  eventful::Scene s;
  b2Body* wall = eventful::add_wall(s);
  s.add_row(wall, 0, 0, 1, 0, 12);
  s.add_row(wall, 0, 1, 1, 0, 12);
  std::vector<b2Body*> pieces;
  for (ElasticPlasticJoint* j : s.structure.joints()) pieces.push_back(j->GetBodyB());
  for (std::size_t i = 0; i < 12; ++i) {
    ElasticPlasticJointDef def;
    def.Initialize(pieces[i], pieces[12 + i], vec(static_cast<double>(i) + 0.5, 0.5), {0, 1});
    s.structure.create_joint(def);
  }
  s.run(30);
  std::mt19937 random(1);
  for (int round = 0; round < 12; ++round) {
    const auto joints = s.structure.joints();
    if (round % 4 == 3) {
      s.world.DestroyBody(joints[random() % joints.size()]->GetBodyB());
    } else {
      s.world.DestroyJoint(joints[random() % joints.size()]);
    }
    s.run(1 + round % 3);
    SCOPED_TRACE(round);
    ASSERT_NO_FATAL_FAILURE(eventful::expect_saved(s, 20));
  }
}

}  // namespace
}  // namespace ductile
