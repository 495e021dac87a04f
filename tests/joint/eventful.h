// Scenes that swing, yield, break, rest, fall asleep and are struck, and a hash of all that they do.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bodies.h"
#include "ductile/joint.h"
#include "ductile/save.h"

namespace ductile::eventful {

struct Scene {
  explicit Scene(const b2Vec2& gravity = {0, -10}) : world(gravity), structure(world, {.keep_ledger = true}) {
    world.SetAllowSleeping(false);
  }

  // A row of boxes with their joints, the first of them joined to `root` where there is one.
  void add_row(b2Body* root, double x, double y, double dx, double dy, int pieces, double moment = unlimited,
               double max_rotation = unlimited, short group = -1) {
    b2Body* last = root;
    for (int i = 0; i < pieces; ++i) {
      b2Body* piece = add_box(world, {.x = x + (i + 0.5) * dx, .y = y + (i + 0.5) * dy, .group = group});
      if (last != nullptr) {
        ElasticPlasticJointDef def;
        def.Initialize(last, piece, vec(x + i * dx, y + i * dy), vec(dx, dy));
        def.rows[rotation] = {.stiffness = 1e8, .cap = moment, .cap_reverse = moment};
        def.max_rotation = max_rotation;
        structure.create_joint(def);
      }
      last = piece;
    }
  }

  std::uint64_t run(int steps) {
    std::uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&](double v) { hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 0x100000001b3; };
    for (int i = 0; i < steps; ++i) {
      if (before_step) before_step(*this, step);
      ++step;
      world.Step(1.0f / 60, 8, 3);
      structure.update();
      for (const b2Body* b = world.GetBodyList(); b != nullptr; b = b->GetNext()) {
        for (const float v : {b->GetPosition().x, b->GetPosition().y, b->GetAngle(), b->GetLinearVelocity().x,
                              b->GetLinearVelocity().y, b->GetAngularVelocity()}) {
          add(v);
        }
        add(b->IsAwake());
      }
      for (const ElasticPlasticJoint* j : structure.joints()) {
        for (const Row row : {axial, shear, rotation}) add(j->force(row)), add(j->plastic(row));
      }
      const JointEnergy e = structure.energy();
      for (const double joules : {e.elastic, e.dissipated, e.damping, e.numerical}) add(joules);
      add(world.GetContactCount());
    }
    return hash;
  }

  b2World world;
  Structure structure;
  std::function<void(Scene&, int)> before_step;
  int step = 0;
};

/// Written in both forms and read, the scene runs on to the bit.
inline void expect_saved(Scene& scene, int steps) {
  Scene of_bytes, of_json;
  load_bytes(of_bytes.structure, save_bytes(scene.structure));
  load_json(of_json.structure, save_json(of_bytes.structure));
  const std::uint64_t ran_on = scene.run(steps);
  ASSERT_EQ(of_bytes.run(steps), ran_on);
  ASSERT_EQ(of_json.run(steps), ran_on);
}

struct Kind {
  std::string name;
  std::function<void(Scene&)> build;
  int until_save = 60;
  bool breaks = false;
};

inline b2Body* add_wall(Scene& s) {
  return add_box(s.world, {.x = -0.5, .y = 0, .type = b2_staticBody, .group = -1});
}
inline void add_floor(Scene& s, double y) {
  add_box(s.world, {.y = y - 0.5, .width = 100, .type = b2_staticBody, .group = 0});
}

inline const std::vector<Kind> kinds{
    {"hanging_chain",
     [](Scene& s) {
       s.add_row(add_wall(s), 0, 0, 0.6, -0.8, 10);
       for (ElasticPlasticJoint* j : s.structure.joints()) j->set_caps(rotation, 0, 0);
     }},
    {"swaying_frame",
     [](Scene& s) {
       s.world.SetGravity({3, -10});
       b2Body* wall = add_wall(s);
       for (const double x : {0.0, 6.0}) s.add_row(wall, x, 0, 0, 1, 5);
       b2Body *left = s.structure.joints()[4]->GetBodyB(), *right = s.structure.joints()[9]->GetBodyB();
       s.add_row(left, 0.5, 4.5, 1, 0, 5);
       ElasticPlasticJointDef def;
       def.Initialize(s.structure.joints().back()->GetBodyB(), right, vec(5.5, 4.5), {1, 0});
       s.structure.create_joint(def);
     }},
    // A lift bridge: hinge with motor, counterweight on a rod, a weight on a rope, a car's axle.
    {"stock_joints",
     [](Scene& s) {
       b2Body* wall = add_wall(s);
       s.add_row(nullptr, 0, 0, 1, 0, 8, unlimited, unlimited, 0);
       b2Body *first = s.structure.joints().front()->GetBodyA(),
              *last = s.structure.joints().back()->GetBodyB();
       b2RevoluteJointDef hinge;
       hinge.Initialize(wall, first, {0, 0});
       hinge.enableMotor = hinge.enableLimit = true;
       hinge.maxMotorTorque = 1e6f;
       hinge.motorSpeed = 0.2f;
       hinge.lowerAngle = -0.2f;
       hinge.upperAngle = 0.3f;
       s.world.CreateJoint(&hinge);
       b2Body* load = add_box(s.world, {.x = 7.5, .y = -4, .mass = 3000, .group = 0});
       b2DistanceJointDef rope;
       rope.Initialize(last, load, vec(7.5, -0.4), vec(7.5, -3.5));
       rope.minLength = 0, rope.maxLength = rope.length;
       s.world.CreateJoint(&rope);
       b2Body *car = add_box(s.world, {.x = 3, .y = 2, .width = 2, .mass = 2000, .group = -2}),
              *wheel = add_box(s.world, {.x = 3, .y = 1, .mass = 100, .group = 0});
       b2WheelJointDef axle;
       axle.Initialize(car, wheel, wheel->GetPosition(), {0, 1});
       axle.stiffness = 4e5f, axle.damping = 2e4f;
       s.world.CreateJoint(&axle);
     }},
    {"yielding_beam", [](Scene& s) { s.add_row(add_wall(s), 0, 0, 1, 0, 8, 2.4e5); }, 20},
    {"break_in_between", [](Scene& s) { s.add_row(add_wall(s), 0, 0, 1, 0, 8, 2e5, 0.3); }, 20, true},
    {"broken_before", [](Scene& s) { s.add_row(add_wall(s), 0, 0, 1, 0, 8, 2e5, 0.3); }, 100},
    {"resting_contacts",
     [](Scene& s) {
       add_floor(s, -2);
       s.add_row(nullptr, -3, 0, 1, 0, 6, unlimited, unlimited, 0);
       for (int i = 0; i < 6; ++i) add_box(s.world, {.x = 0.1 * i, .y = 2 + 1.2 * i, .group = 0});
     },
     300},
    {"falling_asleep",
     [](Scene& s) {
       s.world.SetAllowSleeping(true);
       add_floor(s, -2);
       s.add_row(nullptr, -3, 0, 1, 0, 6, unlimited, unlimited, 0);
     },
     100},
    // Bodies come and go after the moment that is saved, one of them a piece.
    {"struck",
     [](Scene& s) {
       add_floor(s, -6);
       s.add_row(add_wall(s), 0, 0, 1, 0, 8, 8e5, 0.5, 0);
       s.before_step = [](Scene& now, int step) {
         if (step % 40 == 39) {
           b2Body* bomb = add_box(now.world, {.x = 5.0 + step % 3, .y = 4, .mass = 3000, .group = 0});
           bomb->SetBullet(true);
           bomb->SetLinearVelocity({0, -30});
         }
         if (step == 150) now.world.DestroyBody(now.structure.joints().back()->GetBodyB());
       };
     },
     50, true},
};

}  // namespace ductile::eventful
