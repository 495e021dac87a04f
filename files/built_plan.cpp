#include "built_plan.h"

#include <algorithm>
#include <charconv>

namespace ductile {

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
  return lost;
}

}  // namespace ductile
