#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "command.h"
#include "ductile/design.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  bool fixed_gravity = false, second_order = false, json = false;
};

struct Found {
  LimitAnalysis limit;
  CriticalLoad critical;
  Pushover pushover;  // of second order
};

Json json(const Plan& plan, const Found& found, const Options& options) {
  Json hinges = Json::array();
  if (options.second_order) {
    for (const Reached& hinge : found.pushover.hinges) hinges.push_back(joint_name(plan, hinge.joint));
  } else {
    for (const int i : found.limit.hinges) hinges.push_back(joint_name(plan, i));
  }
  Json result{{"load_factor", number(found.limit.load_factor)},
              {"hinges", std::move(hinges)},
              {"time", found.limit.time},
              {"critical_load_factor", number(found.critical.factor)}};
  if (options.second_order) {
    result["second_order_load_factor"] = number(found.pushover.load_factor);
    result["hinges_at"] = Json::array();
    for (const Reached& hinge : found.pushover.hinges) result["hinges_at"].push_back(number(hinge.factor));
  }
  return result;
}

std::string text(const Plan& plan, const Found& found, const Options& options) {
  const char* what = options.fixed_gravity ? "the loads, gravity as it is" : "the loads and gravity";
  std::string text;
  if (found.limit.load_factor == unlimited) {
    text = fmt::format("{}: no multiple of {} collapses it\n", options.scene.name, what);
  } else {
    text = fmt::format("{}: collapses at {:.6g} times {}, in\n", options.scene.name, found.limit.load_factor,
                       what);
    for (const int i : found.limit.hinges) text += fmt::format("  {}\n", joint_name(plan, i));
  }
  if (!options.second_order) {
    text += buckling_line(false, found.critical.factor) + '\n';
  } else {
    const Pushover& pushover = found.pushover;
    text += buckling_line(true, found.critical.factor);
    text += pushover.load_factor < unlimited
                ? fmt::format(", collapses at {:.6g} times, after\n", pushover.load_factor)
                : ", does not collapse\n";
    for (const Reached& hinge : pushover.hinges)
      text += fmt::format("  {} at {:.6g}\n", joint_name(plan, hinge.joint), hinge.factor);
  }
  if (found.limit.time > 0) text += fmt::format("the loads are those from {:g} s on\n", found.limit.time);
  return text;
}

std::string run(const Options& options) {
  const Plan plan = plan_of(options.scene, NotInPlan::left_out);
  const Found found = in_file(options.scene, [&] {
    Found all{.limit = limit_analysis(plan, options.fixed_gravity), .critical = critical_load(plan)};
    if (options.second_order) all.pushover = second_order_limit(plan, options.fixed_gravity);
    return all;
  });
  return options.json ? json(plan, found, options).dump() + "\n" : text(plan, found, options);
}

}  // namespace

void add_limit(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("limit", "Collapse load factor and hinges by limit analysis");
  add_scene(command, options->scene);
  command->add_flag("--fixed-gravity", options->fixed_gravity, "multiply the loads only");
  command->add_flag("--second-order", options->second_order,
                    "hinge by hinge in the deformed state (P-delta), too");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
