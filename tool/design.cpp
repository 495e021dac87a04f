// ductile design: the number or the member of a list with which a scene reaches a target.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>

#include "command.h"
#include "ductile/files.h"
#include "ductile/level.h"
#include "ductile/rolled.h"
#include "ductile/targets.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  std::string target, by, out;
  std::vector<std::string> among, bodies;
  std::vector<std::string> together;
  bool each = false, second_order = false, json = false;
  Order order() const { return second_order ? Order::second : Order::first; }
};

struct Target {
  std::string name;
  Measure measure;
  double value;
  const char* unit;
};

struct Number {
  const char* name;
  Property property;
  const char* unit;
};
constexpr Number numbers[] = {{"depth", Property::depth, " m"},
                              {"fy", Property::yield_stress, " Pa"},
                              {"E", Property::youngs_modulus, " Pa"},
                              {"damping_ratio", Property::damping_ratio, ""}};

[[noreturn]] void refuse(const std::string& option, const std::string& what, const std::string& remedy) {
  throw InvalidInput({{"command line:" + option, what, remedy}});
}

Target target_of(const std::string& text) {
  static const Target targets[] = {{"reserve", Measure::reserve, 0, " times the loads"},
                                   {"collapse", Measure::collapse, 0, " times the loads"},
                                   {"displacement", Measure::displacement, 0, " m"},
                                   {"rotation", Measure::rotation, 0, " rad"},
                                   {"frequency", Measure::frequency, 0, " Hz"},
                                   {"damping", Measure::damping, 0, " of critical"},
                                   {"mass", Measure::mass, 0, " kg"}};
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  for (Target target : targets) {
    if (target.name != name) continue;
    if (equals == std::string::npos || !CLI::detail::lexical_cast(text.substr(equals + 1), target.value) ||
        !(target.value > 0 && target.value < unlimited))
      refuse("--for", "'" + text + "' has no number above 0", "write " + name + "=1.5");
    return target;
  }
  refuse("--for", "'" + name + "' is no target",
         "give reserve, collapse, displacement, rotation, frequency, damping or mass");
}

// The bodies that are named, or all that move and have what is to change.
std::vector<std::size_t> bodies_of(const SceneDef& scene, const Options& options) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (options.bodies.empty() && scene.bodies[i].type == BodyType::dynamic_body &&
        (options.by != "depth" || scene.bodies[i].profile.empty()))
      result.push_back(i);
  for (const std::string& name : options.bodies) {
    const auto found = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                    [&](const BodyDef& body) { return body.name == name; });
    if (found == scene.bodies.end())
      refuse("--body", "there is no body '" + name + "'", "name one of the scene's");
    result.push_back(static_cast<std::size_t>(found - scene.bodies.begin()));
  }
  if (result.empty()) refuse("--by", "no body has a " + options.by + " to change", "name one with --body");
  return result;
}

// "IPE 300", "IPE300" or a file as they are; "IPE" as all of the series.
std::vector<std::string> profiles_among(const std::vector<std::string>& among) {
  std::vector<std::string> result;
  for (const std::string& name : among) {
    const std::size_t before = result.size();
    for (const Rolled& profile : rolled_profiles())
      if (profile.name.substr(0, profile.name.find(' ')) == name) result.push_back(profile.name);
    if (result.size() > before) continue;
    check_profile(name, "--among");
    result.push_back(name);
  }
  return result;
}

std::vector<std::string> list_of(const Options& options) {
  if (options.by == "profile") {
    if (options.among.empty())
      refuse("--among", "is missing", "list profiles or section files: --among IPE,HEA200,box.section.json");
    return profiles_among(options.among);
  }
  if (options.by == "pieces") {
    std::vector<std::string> all = options.among;
    for (int n = 1; n <= most_pieces_tried && options.among.empty(); ++n) all.push_back(std::to_string(n));
    return all;
  }
  std::vector<std::string> all = options.among;
  if (all.empty())
    for (const NamedMaterial& named : materials::all()) all.emplace_back(named.name);
  return all;
}

void change(SceneDef& scene, std::size_t index, const std::string& by, const std::string& to) {
  BodyDef& body = scene.bodies[index];
  if (by == "profile") {
    if (!names_a_profile(to) || std::filesystem::exists(to))
      return set_profile(scene, index, read_section(to));
    if (!body.material)
      refuse("--by", "'" + body.name + "' has no material to make a profile of", "give it one");
    const Rolled profile = in_file("command line", [&] { return rolled(to); });
    return set_profile(scene, index, {{draw(profile).outline, *body.material}}, profile.name);
  }
  if (by == "material") {
    const Material* material = materials::find(to);
    if (!material) refuse("--among", "'" + to + "' is no built-in material", "ductile materials lists them");
    body.material = *material;
    for (Region& region : body.profile) region.material = *material;
    return;
  }
  int n = 0;
  if (!CLI::detail::lexical_cast(to, n) || n < 1)
    refuse("--among", "'" + to + "' is no number of pieces", "give whole numbers: --among 5,10,20");
  body.pieces = n;
  body.cuts.clear();
  body.automatic = false;
}

struct Found {
  Json value;
  std::string shown;
  Reach reach;
};

Found from_list(const SceneDef& scene, const std::vector<std::size_t>& bodies, const Target& target,
                const Options& options) {
  const std::vector<std::string> names = list_of(options);
  std::vector<SceneDef> candidates;
  for (const std::string& name : names) {
    candidates.push_back(scene);
    for (const std::size_t i : bodies) change(candidates.back(), i, options.by, name);
  }
  const bool pieces = options.by == "pieces";
  Reach reach = in_file(options.scene, [&] {
    return (pieces ? first_to_reach : lightest)(candidates, target.measure, target.value, options.order());
  });
  const std::string& name = names[static_cast<std::size_t>(reach.value)];
  if (pieces) return {std::stoi(name), name, std::move(reach)};
  return {name, name, std::move(reach)};
}

Found found(const SceneDef& scene, const std::vector<std::size_t>& bodies, const Target& target,
            const Options& options) {
  const auto number = std::find_if(std::begin(numbers), std::end(numbers),
                                   [&](const Number& each) { return options.by == each.name; });
  if (number == std::end(numbers)) return from_list(scene, bodies, target, options);
  if (!options.among.empty())
    refuse("--among", "does not go with --by " + options.by, "leave it out: any number may be the answer");
  Reach reached = in_file(options.scene, [&] {
    return reach(scene, bodies, number->property, target.measure, target.value, options.order());
  });
  return {reached.value, fmt::format("{:.6g}{}", reached.value, number->unit), std::move(reached)};
}

// Bodies one by one, but for those that are named together.
std::vector<std::vector<std::size_t>> groups_of(const SceneDef& scene, const std::vector<std::size_t>& bodies,
                                                const Options& options) {
  std::vector<std::vector<std::size_t>> groups;
  std::vector<std::size_t> alone = bodies;
  for (const std::string& list : options.together) {
    groups.emplace_back();
    for (const std::string& name : CLI::detail::split(list, ',')) {
      const auto found = std::find_if(bodies.begin(), bodies.end(),
                                      [&](std::size_t i) { return scene.bodies[i].name == name; });
      if (found == bodies.end())
        refuse("--together", "'" + name + "' is none of the bodies that change", "name bodies with a depth");
      groups.back().push_back(*found);
      alone.erase(std::remove(alone.begin(), alone.end(), *found), alone.end());
    }
  }
  for (const std::size_t i : alone) groups.push_back({i});
  return groups;
}

Found of_least_mass(const SceneDef& scene, const std::vector<std::size_t>& bodies, const Target& target,
                    const Options& options) {
  if (options.by != "depth" || target.measure != Measure::collapse || !options.among.empty())
    refuse("--each", "goes with --by depth and --for collapse alone",
           "write --for collapse=1.5 --by depth --each");
  const auto groups = groups_of(scene, bodies, options);
  LeastMass least = in_file(options.scene, [&] { return least_mass(scene, groups, target.value); });
  Found found{Json::object(), "", {0, least.collapse, std::move(least.scene)}};
  for (const std::size_t i : bodies) {
    const BodyDef& body = found.reach.scene.bodies[i];
    found.value[body.name] = body.depth;
    found.shown += fmt::format("{}{:.6g} m of {}", found.shown.empty() ? "" : ", ", body.depth, body.name);
  }
  return found;
}

std::string run(const Options& options) {
  const Target target = target_of(options.target);
  const bool has_order = ductile::has_order(target.measure);
  if (options.second_order && !has_order)
    refuse("--second-order", "does not go with --for " + target.name,
           "leave it out, or give reserve, collapse, displacement or rotation");
  const std::string text = read_text(options.scene.name);
  if (is_rube(text))
    throw InvalidInput(
        {{options.scene.name + ":file", "is a level of R.U.B.E.",
          "design works on scene files and drawings; give the scene that the level was made of"}});
  const Outputs outputs{{"--out", {options.out}}};
  keep_inputs({options.scene.name}, outputs);
  if (options.by == "profile") keep_inputs(options.among, outputs);
  const SceneDef scene = scene_of(options.scene, text, outputs);
  const std::vector<std::size_t> bodies = bodies_of(scene, options);
  NewFiles files(outputs);
  const Found answer =
      options.each ? of_least_mass(scene, bodies, target, options) : found(scene, bodies, target, options);
  const Plan plan = calibrate(answer.reach.scene);
  warn_of_splits(plan, options.scene);
  const double mass = measured(plan, Measure::mass);
  const bool all_counts = target.measure == Measure::mass;  // what is loose weighs, and does nothing else
  const CriticalLoad critical = has_order ? critical_load(plan) : CriticalLoad{};
  const bool yields = target.measure == Measure::reserve || target.measure == Measure::collapse;
  const std::vector<std::string> notes = remarks(
      plan, critical, yields ? missed_moments(plan, static_check(plan)) : std::vector<MissedMoment>{});
  if (!options.out.empty()) {
    const std::filesystem::path folder = std::filesystem::path(options.out).parent_path();
    files.write(options.out, edited_scene(text, answer.reach.scene, folder));
  }
  files.keep();
  if (options.json) {
    Json result{{"value", answer.value}, {"reached", answer.reach.reached}, {"mass", mass}};
    if (has_order) result["critical_load_factor"] = number(critical.factor);
    result["remarks"] = notes;
    result["loose"] = all_counts ? std::vector<std::string>{} : loose_names(plan);
    return result.dump() + "\n";
  }
  std::string of;
  for (const std::size_t i : bodies)
    if (!options.each) of += (of.empty() ? " of " : ", ") + scene.bodies[i].name;
  return fmt::format("{}: {} {}{}\n{} of {:.6g}{}{}\n{}{}", options.scene.name, options.by, answer.shown, of,
                     target.name, answer.reach.reached, target.unit,
                     target.measure == Measure::mass ? "" : fmt::format(", mass {:.6g} kg", mass),
                     has_order ? buckling_line(options.second_order, critical.factor) + '\n' : "",
                     lines(notes) + (all_counts ? "" : loose_line(plan)));
}

}  // namespace

void add_design(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("design", "What a scene needs to reach a target");
  add_scene(command, options->scene, "scene file or SVG drawing");
  command
      ->add_option(
          "--for", options->target,
          "NAME=VALUE: reserve, collapse (factors), displacement (m), rotation (rad), frequency (Hz), "
          "damping (of critical), mass (kg)")
      ->required();
  command->add_option("--by", options->by, "what may change")
      ->required()
      ->check(CLI::IsMember({"depth", "profile", "material", "pieces", "fy", "E", "damping_ratio"}));
  command
      ->add_option("--body", options->bodies,
                   "whose; may be repeated (default: all that move; numbers keep their proportions)")
      ->allow_extra_args(false);
  command
      ->add_option("--among", options->among,
                   "the lightest of these: profiles, their series or section files; materials; numbers of "
                   "pieces; separated by commas")
      ->delimiter(',');
  auto* each = command->add_flag("--each", options->each,
                                 "each body's depth by itself, for the least mass: --for collapse only");
  command
      ->add_option("--together", options->together,
                   "A,B,...: bodies whose depths keep their proportion; may be repeated")
      ->needs(each)
      ->allow_extra_args(false);
  command
      ->add_flag("--second-order", options->second_order,
                 "of the deformed state: reserve, collapse, displacement and rotation")
      ->excludes(each);
  command->add_option("--out", options->out, "the scene that reaches it, to this file")->check(file_name());
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
