// What one has to know of a plan under its loads.
#include <fmt/format.h>

#include <cmath>
#include <set>
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

/// Bodies that stand still, with a load or a support on them.
std::set<std::string> idle_bodies(const Plan& plan) {
  std::set<std::string> names;
  const auto look = [&](int piece) {
    if (piece >= 0 && !plan.is_dynamic(piece))
      names.insert(
          plan.bodies[static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body)].name);
  };
  for (const Plan::Load& load : plan.loads) look(load.piece);
  for (const PlannedJoint& joint : plan.joints)
    if (joint.a < 0) look(joint.b);
  return names;
}

}  // namespace

std::vector<std::string> remarks(const Plan& plan, const CriticalLoad& critical,
                                 const std::vector<MissedMoment>& missed) {
  std::vector<std::string> all = remarks(plan);
  const std::set<std::string> idle = idle_bodies(plan);
  if (!idle.empty())
    all.push_back(list_of({idle.begin(), idle.end()}) +
                  ": does not move, so a load or a support on it does nothing; give it to a body that does");
  if (!missed.empty()) {
    std::vector<std::string> names;
    for (const MissedMoment& each : missed) names.push_back(piece_name(plan, each.piece));
    const double most = missed.front().factor;
    all.push_back(fmt::format(
        "{}: the moment inside is {}{} times what {} see, so it yields at less than is told; split into more "
        "pieces, or cut where the load, support or node is",
        list_of(names), missed.size() > 1 ? "up to " : "",
        most < 1000 ? fmt::format("{:.3g}", most) : "> 1000",
        missed.size() > 1 ? "their joints" : "its joints"));
  }
  if (!critical.mechanism.empty())
    all.push_back(
        list_of(moved(plan, critical.mechanism)) + ": can move without strain, a mechanism that " +
        (critical.factor == 0 ? "these loads push over, however small they are" : "nothing holds in place") +
        "; brace it, support it, or weld a joint that turns freely");
  return all;
}

}  // namespace ductile::tool
