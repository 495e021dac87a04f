// Joints, pieces and guests that come join what is there: nothing else is formed anew, and what is solved is
// the same.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "allocations.h"
#include "beam.h"
#include "bodies.h"
#include "eventful.h"

namespace ductile {
namespace {

/// A cantilever of 40 pieces that gets second joints beside those that it has.
struct Growing : Beam {
  Growing() : Beam({.pieces = 40, .youngs_modulus = 210e9, .damping_time = 0.03}) {}
  void add(int at, bool holds) {
    ElasticPlasticJointDef def;
    def.Initialize(at == 0 ? wall : piece(at - 1), piece(at), point(0.5 * at), {1, 0});
    if (holds) {
      set_rows(def, 0.5);
    } else {
      for (RowDef& row : def.rows) row = RowDef::free();
    }
    structure.create_joint(def);
  }
  b2Body* piece(int i) { return pieces[static_cast<std::size_t>(i)]; }
};

// More joints than a component outlasts come to the second beam: it is formed anew, and moves alike, as these
// hold nothing. What differs is the order of elimination.
TEST(Addition, LeavesWhatAComponentFormedAnewWouldSolve) {
  Growing in_place, anew;
  for (Growing* beam : {&in_place, &anew}) beam->run(0.25);
  for (int i = 1; i < 40; i += 4) anew.add(i, false);
  for (Growing* beam : {&in_place, &anew}) {
    beam->add(0, true);
    beam->add(20, true);
    beam->run(0.25);
    beam->add(31, true);
    beam->run(1);
  }
  expect_alike(in_place, anew);
}

// Two pieces are hung on the tip of a cantilever, one after the other, and a block is laid on the first: the
// support bears all of it, at its lever.
TEST(Addition, OfPiecesAndOfWhatTouchesThemIsBorne) {
  eventful::Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 12, unlimited, unlimited, 0);
  for (ElasticPlasticJoint* j : s.structure.joints()) j->set_stiffness(rotation, 1e9, 20);
  s.run(60);
  for (const double x : {12.5, 13.5}) {
    b2Body* piece = add_box(s.world, {.x = x, .group = 0});
    ElasticPlasticJointDef def;
    def.Initialize(s.structure.joints().back()->GetBodyB(), piece, vec(x - 0.5, 0), {1, 0});
    def.rows[rotation] = {.stiffness = 1e9, .damping_ratio = 20};
    s.structure.create_joint(def);
    s.run(60);
  }
  add_box(s.world, {.x = 12.5, .y = 1.01, .group = 0});
  s.run(1200);
  ElasticPlasticJoint& root = *s.structure.joints().front();
  const double one = root.GetBodyB()->GetMass() * 10.0;
  EXPECT_NEAR(std::abs(root.force(shear)), 15 * one, 1e-5 * 15 * one);
  EXPECT_NEAR(std::abs(root.force(rotation)), (14 * 7 + 12.5) * one, 1e-4 * 110 * one);
  EXPECT_EQ(s.structure.report().bounds_hit, 0);
}

// Two boxes spin about the joint between them, in steps of one length and then of another, which parts them
// by r(ωh)²/2 along their tangents. What is joined a second time then stays so: nothing is to be taken back.
TEST(Addition, ToWhatSpinsStrainsNothing) {
  constexpr double arm = 10, spin = 6, mass = 100;
  for (const double before : {1 / 240.0, 1 / 30.0}) {
    b2World world({0, 0});
    Structure structure(world);
    b2Body *a = add_box(world, {.x = -arm, .mass = mass, .group = 0}),
           *b = add_box(world, {.x = arm, .mass = mass, .group = 0});
    const auto join = [&](const b2Vec2& at) {
      ElasticPlasticJointDef def;
      def.Initialize(a, b, at, a->GetWorldVector({1, 0}));
      structure.create_joint(def);
    };
    join({0, 0});
    for (b2Body* body : {a, b}) {
      body->SetAngularVelocity(spin);
      body->SetLinearVelocity(vec(0, spin * body->GetPosition().x));
    }
    const std::vector<b2Body*> bodies{a, b};
    const double start = kinetic_energy(bodies);
    const auto run = [&](double h, int steps) {
      for (int i = 0; i < steps; ++i) {
        world.Step(static_cast<float>(h), 8, 3);
        EXPECT_LT(kinetic_energy(bodies), 1.02 * start) << before;  // of unequal steps
        double stored = 0;
        for (const ElasticPlasticJoint* j : structure.joints()) stored += j->elastic_energy();
        EXPECT_LT(stored, 1e-3 * start) << before;
      }
    };
    run(before, 60);
    run(1 / 60.0, 1);
    join(b->GetPosition());
    run(before, 60);
  }
}

// Saved after each that came, worlds run on to the bit.
TEST(Addition, IsSaved) {
  eventful::Scene s;
  s.add_row(eventful::add_wall(s), 0, 0, 1, 0, 64, unlimited, unlimited, 0);
  eventful::add_floor(s, -30);
  s.run(30);
  std::mt19937 random(1);
  for (int round = 0; round < 18; ++round) {
    const auto joints = s.structure.joints();
    b2Body* piece = joints[random() % joints.size()]->GetBodyB();
    const b2Vec2 at = piece->GetPosition();
    ElasticPlasticJointDef def;
    switch (round % 3) {
      case 0:
        def.Initialize(joints[random() % joints.size()]->GetBodyA(), piece, at, {1, 0});
        if (def.bodyA != piece) s.structure.create_joint(def);
        break;
      case 1:
        def.Initialize(piece, add_box(s.world, {.x = at.x, .y = at.y - 1.1, .group = 0}),
                       vec(at.x, at.y - 0.55), {0, 1});
        s.structure.create_joint(def);
        break;
      default:
        add_box(s.world, {.x = at.x, .y = at.y + 1.1, .mass = 50, .group = 0});
    }
    if (round % 4 == 3) s.world.DestroyJoint(s.structure.joints().back());
    s.run(1 + round % 5);
    SCOPED_TRACE(round);
    ASSERT_NO_FATAL_FAILURE(eventful::expect_saved(s, 20));
  }
}

}  // namespace
}  // namespace ductile
