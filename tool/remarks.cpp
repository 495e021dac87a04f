// What one has to know of a plan under its loads.
#include <cmath>
#include <string>
#include <vector>

#include "command.h"

namespace ductile::tool {
namespace {

/// The bodies that a motion moves.
std::vector<std::string> moved(const Plan& plan, const std::vector<Motion>& motion) {
  double most = 0;
  const auto size = [](const Motion& m) { return std::hypot(m.along.x, m.along.y) + std::abs(m.turn); };
  for (const Motion& each : motion) most = std::max(most, size(each));
  std::vector<std::string> names;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const std::string& name = plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)].name;
    if (size(motion[i]) > 1e-6 * most && (names.empty() || names.back() != name)) names.push_back(name);
  }
  return names;
}

}  // namespace

std::vector<std::string> remarks(const Plan& plan, const CriticalLoad& critical) {
  std::vector<std::string> all = remarks(plan);
  if (!critical.mechanism.empty())
    all.push_back(
        list_of(moved(plan, critical.mechanism)) + ": can move without strain, a mechanism that " +
        (critical.factor == 0 ? "these loads push over, however small they are" : "nothing holds in place") +
        "; brace it, support it, or weld a joint that turns freely");
  return all;
}

}  // namespace ductile::tool
