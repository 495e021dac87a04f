// ductile check: what every joint carries under the scene's loads, and what yields first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
  bool second_order = false, json = false;
  std::vector<std::string> pictures;
};

struct Found {
  StaticCheck check;
  CriticalLoad critical;
  FirstFibre fibre;
  Reached hinge;
  std::vector<MissedMoment> missed;
};

Json json(const Plan& plan, const Reached& reached) {
  return {{"joint", reached.joint < 0 ? Json(nullptr) : Json(joint_name(plan, reached.joint))},
          {"factor", number(reached.factor)}};
}

Json json(const Plan& plan, const FirstFibre& fibre) {
  Json result = json(plan, static_cast<const Reached&>(fibre));
  if (fibre.piece >= 0) result["piece"] = piece_name(plan, fibre.piece);
  return result;
}

Json json(const Plan& plan, const Found& found) {
  const StaticCheck& check = found.check;
  Json joints = Json::array(), first = Json::array();
  for (std::size_t i = 0; i < check.joints.size(); ++i) {
    const StaticJoint& j = check.joints[i];
    joints.push_back(
        {{"name", plan.joints[i].name},
         {"N", number(j.N)},
         {"Q", number(j.Q)},
         {"M", number(j.M)},
         {"usage", {{"N", number(j.usage.N)}, {"Q", number(j.usage.Q)}, {"M", number(j.usage.M)}}},
         {"first_fibre_at", number(found.fibre.joints[i])},
         {"yields_at", number(j.yields_at)}});
  }
  for (const int i : check.first_to_yield) first.push_back(joint_name(plan, i));
  return {{"joints", std::move(joints)},
          {"reserve", number(check.reserve)},
          {"first_to_yield", std::move(first)},
          {"critical_load_factor", number(found.critical.factor)},
          {"first_fibre", json(plan, found.fibre)},
          {"first_hinge", json(plan, found.hinge)},
          {"profiles", profiles_json(plan)},
          {"remarks", remarks(plan, found.critical, found.missed)},
          {"time", check.time},
          {"loose", loose_names(plan)}};
}

std::string table(const Plan& plan, const Found& found, const Options& options) {
  const StaticCheck& check = found.check;
  std::size_t widest = 5;
  for (const PlannedJoint& joint : plan.joints) widest = std::max(widest, joint.name.size());
  std::string text = options.scene.name + ": ";
  if (found.hinge.joint >= 0) {
    text += fmt::format("first hinge at {:.6g} times the loads, in {}", found.hinge.factor,
                        joint_name(plan, found.hinge.joint));
  } else {
    text += "no load of this kind makes a joint yield";
  }
  if (found.fibre.factor < unlimited)
    text += fmt::format(
        "\nfirst fibre at {:.6g} times the loads, in {}", found.fibre.factor,
        found.fibre.joint >= 0 ? joint_name(plan, found.fibre.joint) : piece_name(plan, found.fibre.piece));
  text += '\n' + buckling_line(options.second_order, found.critical.factor);
  if (options.second_order && found.critical.factor <= 1)
    text += ": these loads leave it no state to tell of";
  text += fmt::format("\n\n{:<{}} {:>12} {:>12} {:>12} {:>6} {:>6} {:>6} {:>11} {:>10}\n", "joint", widest,
                      "N [N]", "Q [N]", "M [N m]", "N use", "Q use", "M use", "first fibre", "yields at");
  const auto percent = [](double share) {
    return std::isfinite(share) ? fmt::format("{:.0f} %", 100 * share) : std::string("-");
  };
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const StaticJoint& j = check.joints[i];
    text += fmt::format("{:<{}} {:>12} {:>12} {:>12} {:>6} {:>6} {:>6} {:>11} {:>10}\n",
                        one_line(plan.joints[i].name), widest, shown(j.N), shown(j.Q), shown(j.M),
                        percent(j.usage.N), percent(j.usage.Q), percent(j.usage.M),
                        shown(found.fibre.joints[i]), shown(j.yields_at));
  }
  if (const std::string notes = profile_lines(plan) + lines(remarks(plan, found.critical, found.missed));
      !notes.empty())
    text += '\n' + notes;
  if (check.time > 0) text += fmt::format("\nthe loads are those from {:g} s on\n", check.time);
  const std::string loose = loose_line(plan);
  return loose.empty() ? text : text + '\n' + loose;
}

/// Moments, shear and axial forces, and the deformed shape.
std::string picture(const Plan& plan, const StaticCheck& check, const Options& options) {
  Plan now = plan;  // with the loads that act then
  std::erase_if(now.loads,
                [&](const Plan::Load& l) { return l.def.from > check.time || l.def.to <= check.time; });
  std::vector<JointReading> joints;
  for (const StaticJoint& j : check.joints)
    joints.push_back({.N = j.N, .Q = j.Q, .M = j.M, .usage = j.usage});
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < now.pieces.size(); ++i)
    motions.push_back({check.displacement[i], check.turn[i]});
  const double times = exaggeration(now, motions);
  const std::vector<Motion> gone = options.second_order ? motions : std::vector<Motion>{};
  return picture_svg(
      now,
      {.title = title_of(options.scene.name),
       .subtitle = options.second_order ? "second order" : "first order",
       .panels = {
           {.title = "moment, on the side in tension", .joints = joints, .diagram = rotation, .gone = gone},
           {.title = "shear force", .joints = joints, .diagram = shear, .gone = gone},
           {.title = "axial force", .joints = joints, .diagram = axial, .gone = gone},
           {.title = fmt::format("displacements times {:g}", times),
            .joints = joints,
            .motions = motions,
            .times = times}}});
}

std::string run(const Options& options) {
  const Outputs outputs{{"--picture", options.pictures}};
  keep_apart(outputs);
  keep_inputs({options.scene.name}, outputs);
  const Plan plan = plan_of(options.scene, NotInPlan::left_out, outputs);
  NewFiles files(outputs);
  const Order order = options.second_order ? Order::second : Order::first;
  const Found found = in_file(options.scene, [&] {
    Found all{.check = static_check(plan, order), .critical = critical_load(plan)};
    all.fibre = first_fibre(plan, all.check, order);
    all.missed = missed_moments(plan, all.check, order);
    if (!all.check.first_to_yield.empty()) {
      const int first = all.check.first_to_yield.front();
      all.hinge = {first, all.check.joints[static_cast<std::size_t>(first)].yields_at};
    }
    return all;
  });
  if (!options.pictures.empty()) {
    if (std::any_of(found.check.turn.begin(), found.check.turn.end(), [](double t) { return std::isnan(t); }))
      throw InvalidInput({{"command line:--picture", "has no state to show: the structure buckles before",
                           "draw it without --second-order, or its mode by ductile limit"}});
    files.write_pictures(options.pictures, picture(plan, found.check, options));
  }
  files.keep();
  return options.json ? json(plan, found).dump() + "\n" : table(plan, found, options);
}

}  // namespace

void add_check(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check", "Static utilisation of every joint under the scene's loads");
  add_scene(command, options->scene);
  command->add_flag("--second-order", options->second_order, "equilibrium in the deformed state (P-delta)");
  add_picture(command, options->pictures, "draw moment, shear and axial diagrams and the deformed shape");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
