#include "mirror.h"

#include <cmath>

#include "frames.h"

namespace ductile::dynamics {

BodyMass::BodyMass(const b2Body& body)
    : mass(body.GetMass()),
      inverse_mass(1.0f / mass),
      inertia(body.GetInertia()),
      gyration(mass > 0 ? std::sqrt(inertia / mass) : 0),
      center(body.GetLocalCenter()) {}

Mirror::Mirror(b2Body& of)
    : body(&of),
      mass(of),
      type(of.GetType()),
      left{of.GetWorldCenter(), of.GetAngle()},
      given(velocity_of(of)),
      exact(in_doubles(given)) {}

void Mirror::gain_joints(int count) {
  joined += count;
  joints = nullptr;
  // The list of the ground may be as long as the structure.
  if (type == b2_dynamicBody && !guest()) joints.reset();
}

void Mirror::find_joints() {
  if (joints) return;
  int held = 0;
  for (const b2JointEdge* e = body->GetJointList(); e != nullptr; e = e->next) ++held;
  joints = held == joined ? body->GetJointList() : nullptr;
}

void Mirror::keep(Tape& tape) {
  tape(left.c.x, left.c.y, left.a, given.v.x, given.v.y, given.w, taken.v.x, taken.v.y, taken.w, exact,
       thrown);
  bool found = joints.has_value(), only_ours = found && *joints != nullptr && *joints == body->GetJointList();
  tape(found, only_ours);
  if (!tape.reads() || type != b2_dynamicBody || guest()) return;
  joints.reset();
  if (found) joints = only_ours ? body->GetJointList() : nullptr;
}

}  // namespace ductile::dynamics
