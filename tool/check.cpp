#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "command.h"
#include "ductile/design.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  bool json = false;
};

Json json(const Plan& plan, const StaticCheck& check) {
  Json joints = Json::array(), first = Json::array(), loose = Json::array();
  for (std::size_t i = 0; i < check.joints.size(); ++i) {
    const StaticJoint& j = check.joints[i];
    joints.push_back(
        {{"name", plan.joints[i].name},
         {"N", number(j.N)},
         {"Q", number(j.Q)},
         {"M", number(j.M)},
         {"usage", {{"N", number(j.usage.N)}, {"Q", number(j.usage.Q)}, {"M", number(j.usage.M)}}},
         {"yields_at", number(j.yields_at)}});
  }
  for (const int i : check.first_to_yield) first.push_back(plan.joints[static_cast<std::size_t>(i)].name);
  for (const int i : check.loose) loose.push_back(piece_name(plan, i));
  return {{"joints", std::move(joints)},
          {"reserve", number(check.reserve)},
          {"first_to_yield", std::move(first)},
          {"time", check.time},
          {"loose", std::move(loose)}};
}

std::string table(const Plan& plan, const StaticCheck& check, const std::string& scene) {
  std::size_t widest = 5;
  for (const PlannedJoint& joint : plan.joints) widest = std::max(widest, joint.name.size());
  std::string text = scene + ": ";
  if (check.reserve < unlimited) {
    text += fmt::format("first yield at {:.6g} times the loads, in {}", check.reserve,
                        plan.joints[static_cast<std::size_t>(check.first_to_yield.front())].name);
  } else {
    text += "no load of this kind makes a joint yield";
  }
  text += fmt::format("\n\n{:<{}} {:>12} {:>12} {:>12} {:>6} {:>6} {:>6} {:>10}\n", "joint", widest, "N [N]",
                      "Q [N]", "M [N m]", "N use", "Q use", "M use", "yields at");
  const auto percent = [](double share) {
    return std::isfinite(share) ? fmt::format("{:.0f} %", 100 * share) : std::string("-");
  };
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const StaticJoint& j = check.joints[i];
    text += fmt::format("{:<{}} {:>12} {:>12} {:>12} {:>6} {:>6} {:>6} {:>10}\n", plan.joints[i].name, widest,
                        shown(j.N), shown(j.Q), shown(j.M), percent(j.usage.N), percent(j.usage.Q),
                        percent(j.usage.M), shown(j.yields_at));
  }
  if (check.time > 0) text += fmt::format("\nthe loads are those from {:g} s on\n", check.time);
  for (std::size_t i = 0; i < check.loose.size(); ++i)
    text += (i == 0 ? "\nloose, and not looked at: " : ", ") + piece_name(plan, check.loose[i]);
  return check.loose.empty() ? text : text + '\n';
}

std::string run(const Options& options) {
  const Plan plan = plan_of(options.scene);
  const StaticCheck check = in_file(options.scene, [&] { return static_check(plan); });
  return options.json ? json(plan, check).dump() + "\n" : table(plan, check, options.scene);
}

}  // namespace

void add_check(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check", "Static utilisation of every joint under the scene's loads");
  add_scene(command, options->scene);
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
