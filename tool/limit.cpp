// ductile limit: the factor on the loads at which a scene collapses, and the hinges of its mechanism.
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "ductile/design.h"
#include "ductile/picture.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  bool fixed_gravity = false, second_order = false, json = false;
  std::vector<std::string> pictures;
};

struct Found {
  LimitAnalysis limit;
  CriticalLoad critical;
  Pushover pushover;  // of second order
  std::vector<MissedMoment> missed;
};

/// Whether supports that are displaced are all that grows.
bool is_displaced_only(const Plan& plan, const Options& options) {
  return plan.settles() && plan.loads.empty() && (options.fixed_gravity || plan.gravity == Point{});
}

std::vector<std::size_t> moved_supports(const Plan& plan) {
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (plan.joints[i].ground_moves()) moved.push_back(i);
  return moved;
}

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
              {"critical_load_factor", number(found.critical.factor)},
              {"remarks", remarks(plan, found.critical, found.missed)},
              {"loose", loose_names(plan)}};
  if (options.second_order) {
    result["second_order_load_factor"] = number(found.pushover.load_factor);
    result["hinges_at"] = Json::array();
    for (const Reached& hinge : found.pushover.hinges) result["hinges_at"].push_back(number(hinge.factor));
    result["supports"] = Json::array();
    for (const std::size_t i : moved_supports(plan)) {
      const auto [N, Q, M] = found.pushover.forces[i];
      result["supports"].push_back({{"name", plan.joints[i].name}, {"N", N}, {"Q", Q}, {"M", M}});
    }
  }
  return result;
}

std::string text(const Plan& plan, const Found& found, const Options& options) {
  const char* what = options.fixed_gravity ? "the loads, gravity as it is" : "the loads and gravity";
  std::string text;
  if (is_displaced_only(plan, options)) {
    text = options.scene.name + ": nothing but supports moves\n";
  } else if (found.limit.load_factor == unlimited) {
    text = fmt::format("{}: no multiple of {} collapses it\n", options.scene.name, what);
  } else {
    text = fmt::format("{}: collapses at {:.6g} times {}, in\n", options.scene.name, found.limit.load_factor,
                       what);
    for (const int i : found.limit.hinges) text += fmt::format("  {}\n", one_line(joint_name(plan, i)));
  }
  if (!options.second_order) {
    text += buckling_line(false, found.critical.factor) + '\n';
  } else {
    const Pushover& pushover = found.pushover;
    text += buckling_line(true, found.critical.factor);
    const bool collapses = pushover.load_factor < unlimited;
    text += collapses ? fmt::format(", collapses at {:.6g} times", pushover.load_factor)
                      : std::string(", does not collapse");
    text += !pushover.hinges.empty() ? ", after\n" : collapses ? ", before any hinge\n" : "\n";
    for (const Reached& hinge : pushover.hinges)
      text += fmt::format("  {} at {:.6g}\n", one_line(joint_name(plan, hinge.joint)), hinge.factor);
    for (const std::size_t i : moved_supports(plan)) {
      const auto [N, Q, M] = pushover.forces[i];
      text += fmt::format("{} then carries N {} N, Q {} N, M {} N m\n", one_line(plan.joints[i].name),
                          shown(N), shown(Q), shown(M));
    }
  }
  text += lines(remarks(plan, found.critical, found.missed)) + loose_line(plan);
  if (found.limit.time > 0) text += fmt::format("the loads are those from {:g} s on\n", found.limit.time);
  return text;
}

/// The mechanism of limit analysis, that in the deformed state, and the buckling mode, as far as there are.
std::string picture(const Plan& plan, const Found& found, const Options& options) {
  PictureDef picture{.title = title_of(options.scene.name),
                     .subtitle = options.fixed_gravity ? "multiples of the loads" : "multiples of all loads"};
  const auto add = [&](std::string title, const std::vector<Motion>& motions, std::vector<int> hinges,
                       bool numbered) {
    if (!motions.empty())
      picture.panels.push_back({.title = std::move(title),
                                .motions = motions,
                                .times = exaggeration(plan, motions),
                                .hinges = std::move(hinges),
                                .numbered = numbered});
  };
  add(fmt::format("collapses at {:.4g} times", found.limit.load_factor), found.limit.mechanism,
      found.limit.hinges, false);
  std::vector<int> order;
  for (const Reached& hinge : found.pushover.hinges) order.push_back(hinge.joint);
  add(fmt::format("second order: goes at {:.4g} times", found.pushover.load_factor), found.pushover.mechanism,
      order, true);
  add(fmt::format("buckles at {:.4g} times", found.critical.factor), found.critical.mode, {}, false);
  if (picture.panels.empty()) picture.panels.emplace_back();
  return picture_svg(plan, picture);
}

std::string run(const Options& options) {
  const Outputs outputs{{"--picture", options.pictures}};
  keep_apart(outputs);
  keep_inputs({options.scene.name}, outputs);
  const Plan plan = plan_of(options.scene, NotInPlan::left_out, outputs);
  NewFiles files(outputs);
  const Found found = in_file(options.scene, [&] {
    Found all{.critical = critical_load(plan), .missed = missed_moments(plan, static_check(plan))};
    if (!options.second_order || !is_displaced_only(plan, options))
      all.limit = limit_analysis(plan, options.fixed_gravity);
    if (options.second_order) all.pushover = second_order_limit(plan, options.fixed_gravity);
    return all;
  });
  if (!options.pictures.empty()) files.write_pictures(options.pictures, picture(plan, found, options));
  files.keep();
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
  add_picture(command, options->pictures, "draw the collapse mechanism and the buckling mode");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
