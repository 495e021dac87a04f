// A body of a component beside Box2D's own: the pose and velocity that Box2D was given last and those that it
// has now, and whether it is still what the component was formed for.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "box2d_private.h"
#include "frames.h"
#include "pose.h"
#include "tape.h"
#include "vec3.h"

namespace ductile::dynamics {

/// The mass of a body.
struct BodyMass {
  float mass = 0, inverse_mass = 0;  // kg, 1/kg
  float inertia = 0, gyration = 0;   // kg m² about the body's origin; m
  b2Vec2 center{0, 0};

  BodyMass() = default;
  explicit BodyMass(const b2Body& body);
  bool is_of(const b2Body& body) const {
    return body.GetMass() == mass && body.GetInertia() == inertia && body.GetLocalCenter() == center;
  }
};

struct Mirror {
  b2Body* body = nullptr;
  BodyMass mass;
  b2BodyType type = b2_staticBody;
  int joined = 0;  // joints of the component that it has
  /// First of its joints while all are of this component, or null; nothing while that is to be found.
  std::optional<const b2JointEdge*> joints = nullptr;

  // Not {}: b2Vec2's own constructor leaves its numbers as they are.
  b2Position left{{0, 0}, 0};   // pose as it was left: of a guest where it touches (Component::keep_in_touch)
  b2Velocity given{{0, 0}, 0};  // velocity as it was left
  Vec3 exact;                   // what `given` is rounded of, world axes
  b2Velocity taken{{0, 0}, 0};  // velocity that Box2D had at the step's start
  // What gravity, damping and contacts' stored impulses make of `given`, bit by bit.
  b2Velocity expected{{0, 0}, 0};
  Vec3 alone;                    // what gravity and damping alone make of it, not rounded
  b2Velocity pushed{{0, 0}, 0};  // what others have added to it since
  Vec3 jump;                     // of a piece or its support before this step, beyond blow_speed or blow_turn
  bool thrown = false;           // it has a new joint, and comes with a velocity that this does not leave it
  float rounding = 0;            // m/s: of `taken`, by the contacts' stored impulses in it
  int32 island_index = 0;
  bool present = true;  // a guest may be elsewhere, or be no more: then `body` must not be asked
  bool comes = false;   // a kinematic guest that does not touch yet: it is in no island, or in another

  Mirror() = default;
  /// Of a body that has no joint of the component yet.
  explicit Mirror(b2Body& of);

  bool has_its_mass() const { return type != b2_dynamicBody || mass.is_of(*body); }
  bool fits() const { return body->GetType() == type && has_its_mass(); }
  /// Has no joint of the component: it touches the structure, is tied to it, or once was of it.
  bool guest() const { return joined == 0; }
  /// The component gains so many joints of the body, or loses them.
  void gain_joints(int count);
  /// Finds `joints`, once in a step: if each of n joints that come or go had its body's list walked through,
  /// they would cost n².
  void find_joints();
  /// After find_joints(): whether the component's joints are all that it has. Box2D prepends new joints to a
  /// body's list, and of ours that come and go gain_joints() knows.
  bool joins_only_ours() const { return body->GetJointList() == joints; }
  /// Likewise, whether nothing else touches or holds the body.
  bool only_ours() const { return body->GetContactList() == nullptr && joins_only_ours(); }
  /// Its pose and velocity at the start of a step.
  b2Position pose_in(const b2SolverData& data) const {
    if (type == b2_staticBody) return {body->GetWorldCenter(), body->GetAngle()};
    return comes ? start_of_step(*body) : data.positions[island_index];
  }
  b2Velocity velocity_in(const b2SolverData& data) const {
    return comes ? velocity_of(*body) : data.velocities[island_index];
  }
  /// Whether nothing has pushed it from where it was left. Box2D corrects a guest's pose, and turns it by
  /// what its place is rounded by.
  bool stays(const b2Position& at) const {
    if (!guest() || !(mass.gyration > 0)) return same(at, left);
    const float rounding = 2.4e-7f * std::max({1.0f, std::abs(left.c.x), std::abs(left.c.y)});
    return same(at.c.x, left.c.x) && same(at.c.y, left.c.y) &&
           std::abs(at.a - left.a) <= std::max(rounding / mass.gyration, 2.4e-7f * std::abs(left.a));
  }
  void keep(Tape& tape);
};

/// A place in the world that poses are kept relative to, so that doubles resolve strains anywhere, m.
struct Origin {
  double x = 0, y = 0;

  Pose relative(const b2Position& at) const { return {at.c.x - x, at.c.y - y, at.a}; }
  b2Position in_world(const Pose& p) const {
    return {{static_cast<float>(p.x + x), static_cast<float>(p.y + y)}, static_cast<float>(p.angle)};
  }
  b2Vec2 in_floats() const { return {static_cast<float>(x), static_cast<float>(y)}; }
  void keep(Tape& tape) { tape(x, y); }
};

}  // namespace ductile::dynamics
