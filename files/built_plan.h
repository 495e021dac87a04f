// What Box2D makes of a plan, for those who write it down.
#pragma once

#include <string>
#include <vector>

#include "ductile/box2d.h"

namespace ductile {

/// A plan's bodies in a world of their own.
struct BuiltPlan {
  explicit BuiltPlan(const Plan& plan);
  /// Index of the rigid body that a piece is, or is part of; the ground (−1) comes last.
  int body(int piece) const {
    return piece < 0 ? static_cast<int>(carriers.size()) : body_[static_cast<std::size_t>(piece)];
  }

  b2World world;
  Built built;
  std::vector<int> carriers;  ///< the piece that stands for each rigid body

 private:
  std::vector<int> body_;  // by pieces
};

/// kg m², of the two rigid bodies of a joint, as b2AngularStiffness has it.
double reduced_inertia(const Plan& plan, const PlannedJoint& joint);

/// The shortest decimal that reads back as this float.
double decimal(float value);

/// A body's fixtures in the order in which they were made.
std::vector<const b2Fixture*> fixtures_of(const b2Body& body);

/// What of the plan is in no definition of a body or a joint: loads and what grows over time.
std::vector<std::string> lost_in_definitions(const Plan& plan);

}  // namespace ductile
