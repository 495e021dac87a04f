// A steel beam of n pieces, welded by elastic-plastic joints to a static block at its left end.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "ductile/joint.h"

namespace ductile {

struct BeamDef {
  int pieces = 10;
  double length = 20, height = 1;
  double density = 7800;      // kg/m², depth 1
  double youngs_modulus = 0;  // 0: rigid
  double damping_time =
      0.3;  // s: c/k of elastic rows; near critical for 20 m of steel, so that statics are reached
  double moment_cap = unlimited;  // of every joint
  double gravity = 10;
  double angle = 0;     // of the beam's axis
  double x = 0, y = 0;  // of its root
  bool fixtures = true;
  SolverKind solver = SolverKind::direct;
};

struct Beam {
  explicit Beam(const BeamDef& d)
      : def(d),
        world({0, -static_cast<float>(d.gravity)}),
        structure(world, {.solver = d.solver, .keep_ledger = true}) {
    world.SetAllowSleeping(false);
    const b2Vec2 axis{static_cast<float>(std::cos(d.angle)), static_cast<float>(std::sin(d.angle))};
    b2BodyDef ground;
    ground.position.Set(static_cast<float>(d.x), static_cast<float>(d.y));
    wall = world.CreateBody(&ground);
    const double l = d.length / d.pieces;
    b2Body* previous = wall;
    for (int i = 0; i < d.pieces; ++i) {
      b2BodyDef body;
      body.type = b2_dynamicBody;
      body.angle = static_cast<float>(d.angle);
      body.position = point((i + 0.5) * l);
      b2Body* piece = world.CreateBody(&body);
      b2PolygonShape box;
      box.SetAsBox(static_cast<float>(l / 2), static_cast<float>(d.height / 2));
      b2FixtureDef fixture;
      fixture.shape = &box;
      fixture.density = static_cast<float>(d.density);
      fixture.filter.groupIndex = -1;
      if (d.fixtures) piece->CreateFixture(&fixture);
      const double mass = d.density * l * d.height;
      b2MassData data{
          static_cast<float>(mass), {0, 0}, static_cast<float>(mass * (l * l + d.height * d.height) / 12)};
      piece->SetMassData(&data);
      ElasticPlasticJointDef joint;
      joint.Initialize(previous, piece, point(i * l), axis);
      set_rows(joint, i == 0 ? l / 2 : l);
      joints.push_back(structure.create_joint(joint));
      pieces.push_back(piece);
      previous = piece;
    }
  }

  // Rows of a joint that stands for so much of the beam.
  void set_rows(ElasticPlasticJointDef& joint, double span) const {
    if (def.youngs_modulus > 0) {
      const double A = def.height, I = std::pow(def.height, 3) / 12, G = def.youngs_modulus / 2.6;
      joint.rows[axial].stiffness = def.youngs_modulus * A / span;
      joint.rows[shear].stiffness = 5.0 / 6 * G * A / span;
      joint.rows[rotation].stiffness = def.youngs_modulus * I / span;
    }
    for (RowDef& row : joint.rows)
      if (row.stiffness < rigid) row.damping = def.damping_time * row.stiffness;
    joint.rows[rotation].cap = joint.rows[rotation].cap_reverse = def.moment_cap;
  }
  b2Vec2 point(double s) const {
    return {static_cast<float>(def.x + s * std::cos(def.angle)),
            static_cast<float>(def.y + s * std::sin(def.angle))};
  }
  void run(double seconds, double dt = 1.0 / 60) {
    const int steps = static_cast<int>(std::lround(seconds / dt));
    for (int i = 0; i < steps; ++i) {
      world.Step(static_cast<float>(dt), 8, 3);
      rounds += structure.report().rounds;
      factorisations += structure.report().factorisations;
      bounds_hit += structure.report().bounds_hit;
      divided += structure.report().divided;
      structure.update();
    }
  }
  double mass() const { return def.density * def.length * def.height; }
  // Moment of the pieces' weights about the root, where they are now.
  double root_moment() const {
    double sum = 0;
    for (b2Body* piece : pieces) sum += piece->GetMass() * def.gravity * (piece->GetWorldCenter().x - def.x);
    return -sum;
  }

  BeamDef def;
  b2World world;
  Structure structure;
  b2Body* wall;
  std::vector<b2Body*> pieces;
  std::vector<ElasticPlasticJoint*> joints;
  int rounds = 0, factorisations = 0, bounds_hit = 0, divided = 0;
};

/// Both have moved alike, and bear the same: to what another order of elimination rounds.
inline void expect_alike(const Beam& a, const Beam& b) {
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    EXPECT_NEAR(a.pieces[i]->GetPosition().y, b.pieces[i]->GetPosition().y, 1e-6) << i;
    EXPECT_NEAR(a.joints[i]->force(rotation), b.joints[i]->force(rotation), 1e-9 * std::abs(a.root_moment()))
        << i;
  }
  const double balance = a.structure.energy().numerical - b.structure.energy().numerical;
  EXPECT_NEAR(balance, 0, 1e-6 * a.mass() * a.def.gravity * a.def.length);
}

}  // namespace ductile
