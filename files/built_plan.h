// What Box2D makes of a plan, for those who write it down.
#pragma once

#include <vector>

#include "ductile/box2d.h"

namespace ductile {

/// A plan's bodies in a world of their own.
struct BuiltPlan {
  explicit BuiltPlan(const Plan& plan) : world(b2Vec2_zero), built(build_bodies(world, plan)) {}
  b2World world;
  Built built;
};

/// The shortest decimal that reads back as this float.
double decimal(float value);

/// A body's fixtures in the order in which they were made.
std::vector<const b2Fixture*> fixtures_of(const b2Body& body);

/// What of the plan is in no definition of a body or a joint: loads and what grows over time.
std::vector<std::string> lost_in_definitions(const Plan& plan);

}  // namespace ductile
