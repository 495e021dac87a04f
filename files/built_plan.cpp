#include "built_plan.h"

#include <algorithm>
#include <charconv>
#include <string>

namespace ductile {

BuiltPlan::BuiltPlan(const Plan& plan) : world(b2Vec2_zero), built(build_bodies(world, plan)) {
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const int whole = plan.pieces[i].part_of;
    body_.push_back(whole < 0 ? static_cast<int>(carriers.size()) : body_[static_cast<std::size_t>(whole)]);
    if (whole < 0) carriers.push_back(static_cast<int>(i));
  }
}

double reduced_inertia(const Plan& plan, const PlannedJoint& j) {
  const double a = j.a < 0 ? 0 : plan.carrier(j.a).inertia, b = j.b < 0 ? 0 : plan.carrier(j.b).inertia;
  return a > 0 && b > 0 ? a * b / (a + b) : std::max(a, b);
}

double decimal(float value) {
  char digits[32];
  const char* end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  double result = 0;
  std::from_chars(digits, end, result);
  return result;
}

std::vector<const b2Fixture*> fixtures_of(const b2Body& body) {
  std::vector<const b2Fixture*> list;
  for (const b2Fixture* fixture = body.GetFixtureList(); fixture; fixture = fixture->GetNext())
    list.push_back(fixture);
  std::reverse(list.begin(), list.end());  // Box2D puts new ones in front
  return list;
}

std::vector<std::string> lost_in_definitions(const Plan& plan) {
  std::vector<std::string> lost;
  if (plan.gravity_ramp > 0) lost.emplace_back("gravity acts at once instead of growing");
  for (const Plan::Load& load : plan.loads) {
    lost.push_back("the load on " + plan.pieces[static_cast<std::size_t>(load.piece)].name +
                   " is not there: apply it before each step");
  }
  for (const PlannedJoint& joint : plan.joints)
    if (joint.ground_moves())
      lost.push_back("the ground of " + joint.name + " does not move: drive its rows");
  for (const PlannedJoint& joint : plan.joints)
    if (joint.drive && (joint.drive->from > 0 || joint.drive->ramp > 0))
      lost.push_back("the drive of " + joint.name +
                     " is at full speed at once: drive the joint when it is time");
  return lost;
}

}  // namespace ductile
