// ductile calibrate: a scene's pieces and calibrated joints as a table, JSON, C++, level or scene file.
#include "ductile/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "ductile/definitions.h"
#include "ductile/design.h"
#include "ductile/fields.h"
#include "ductile/files.h"
#include "ductile/level.h"
#include "ductile/picture.h"
#include "progress.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  std::string to, as, out;
  std::vector<std::string> pictures;
  std::optional<double> target_error;
  std::optional<double> leave_out;
  LeaveOut leaving;
  bool json = false;
};

Json json(const Point& p) { return {p.x, p.y}; }
Json json(const Ring& ring) {
  Json list = Json::array();
  for (const Point& p : ring) list.push_back(json(p));
  return list;
}

const char* name(BodyType type) {
  switch (type) {
    case BodyType::static_body:
      return "static";
    case BodyType::kinematic_body:
      return "kinematic";
    default:
      return "dynamic";
  }
}

Json json(const Piece& piece, const Plan& plan) {
  Json object{{"name", piece.name},
              {"mass", piece.mass},
              {"inertia", piece.inertia},
              {"center", json(piece.center)},
              {"vertices", json(piece.outline.outer)}};
  for (const Ring& hole : piece.outline.holes) object["holes"].push_back(json(hole));
  if (piece.circle > 0) object["circle"] = piece.circle;
  for (const Convex& part : convex_parts(piece)) object["fixtures"].push_back(json(part));
  if (piece.part_of >= 0) object["part_of"] = piece_name(plan, piece.part_of);
  if (piece.stands_still) object["stands_still"] = true;
  return object;
}

/// θ = M/k, rad: how far it turns before it yields; infinite where nothing limits it, 0 where it is rigid.
double elastic_rotation(const PlannedJoint& joint) {
  return joint.M == unlimited ? unlimited : joint.M == 0 ? 0 : joint.M / joint.stiffness.M;
}

Json json(const PlannedJoint& joint, const Plan& plan) {
  Json object{{"name", joint.name},
              {"between", {piece_name(plan, joint.a), piece_name(plan, joint.b)}},
              {"anchor", json(joint.anchor)},
              {"axis", json(joint.axis)}};
  fields::for_each(fields::calibrated,
                   [&](const auto& field) { object[field.key] = number(joint.*field.member); });
  fields::for_each(fields::stiffness, [&](const auto& field) {
    object["stiffness"][field.key] = number(joint.stiffness.*field.member);
  });
  object["elastic_rotation"] = number(elastic_rotation(joint));
  if (joint.rate) {
    const auto& D = joint.rate->doubling;
    object["rate"] = {{"N", number(D[axial])},
                      {"Q", number(D[shear])},
                      {"M", number(D[rotation])},
                      {"exponent", joint.rate->exponent}};
  }
  if (joint.end) {
    object["end"] = json(*joint.end);
    object["length"] = joint.length;
    object["carries"] = joint.carries == Carries::tension       ? "tension"
                        : joint.carries == Carries::compression ? "compression"
                                                                : "both";
  }
  if (joint.drive) {
    const DriveDef& d = *joint.drive;
    const auto given = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    object["drive"] = {{"row", d.row == axial ? "axial" : "rotation"},
                       {"position", given(d.position)},
                       {"speed", given(d.speed)},
                       {"cap", number(d.cap)},
                       {"from", d.from},
                       {"ramp", d.ramp}};
  }
  object["governed_by"] = plan.reasons[static_cast<std::size_t>(joint.governed_by)];
  return object;
}

Json json(const Plan& plan) {
  Json bodies = Json::array(), joints = Json::array(), left_out = Json::array();
  for (const BodyDef& body : plan.bodies) {
    bodies.push_back({{"name", body.name}, {"type", name(body.type)}, {"pieces", Json::array()}});
  }
  for (const Piece& piece : plan.pieces) {
    bodies[static_cast<std::size_t>(piece.body)]["pieces"].push_back(json(piece, plan));
  }
  for (const PlannedJoint& joint : plan.joints) joints.push_back(json(joint, plan));
  for (const LeftOut& item : plan.left_out) {
    left_out.push_back({{"what", item.what},
                        {"error", item.error},
                        {"time_saved", item.time_saved},
                        {"measured", item.measured}});
  }
  return {{"bodies", std::move(bodies)},
          {"joints", std::move(joints)},
          {"profiles", profiles_json(plan)},
          {"remarks", remarks(plan)},
          {"left_out", std::move(left_out)}};
}

std::string table(const Plan& plan, const std::string& scene) {
  double mass = 0;
  std::size_t widest = 5;
  for (const Piece& piece : plan.pieces) mass += piece.mass;
  for (const PlannedJoint& joint : plan.joints) widest = std::max(widest, joint.name.size());
  std::string text = fmt::format("{}: {} bodies, {} pieces of {:.6g} kg in all, {} joints\n\n", scene,
                                 plan.bodies.size(), plan.pieces.size(), mass, plan.joints.size());
  text += fmt::format("{:<{}} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>14}  governed by\n",
                      "joint", widest, "N [N]", "Nc [N]", "Q [N]", "M [N m]", "M_reverse", "k [N m/rad]",
                      "M/k [rad]", "max_rot. [rad]");
  for (const PlannedJoint& joint : plan.joints) {
    text += fmt::format("{:<{}} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>14}  [{}]\n",
                        one_line(joint.name), widest, shown(joint.N), shown(joint.Nc), shown(joint.Q),
                        shown(joint.M), shown(joint.M_reverse), shown(joint.stiffness.M),
                        shown(elastic_rotation(joint)), shown(joint.max_rotation), joint.governed_by + 1);
  }
  text += '\n';
  for (const SplitError& split : plan.split_errors) {
    const auto pieces = std::count_if(plan.pieces.begin(), plan.pieces.end(),
                                      [&](const Piece& piece) { return piece.body == split.body; });
    text += fmt::format("{}: {} pieces, displacement error {:.2g} %, governed by {}\n",
                        one_line(plan.bodies[static_cast<std::size_t>(split.body)].name), pieces,
                        100 * split.error, split.governed_by);
  }
  for (std::size_t i = 0; i < plan.reasons.size(); ++i)
    text += fmt::format("[{}] {}\n", i + 1, one_line(plan.reasons[i]));
  if (const std::string notes = profile_lines(plan) + lines(remarks(plan)); !notes.empty())
    text += '\n' + notes;
  return text;
}

std::string definitions_of(const Plan& plan, const Options& options) {
  if (options.to == "box2d") return in_file(options.scene, [&] { return box2d_text(plan); });
  if (options.to == "cpp")
    return in_file(options.scene,
                   [&] { return cpp_text(plan, function_name(scene_name(options.scene.name))); });
  if (options.to == "rube") {  // a scene of its own keeps what no plan holds
    const std::string text = read_text(options.scene.name);
    const StockJoint as = options.as == "weld" ? StockJoint::weld : StockJoint::hinge;
    if (is_rube(text)) return calibrated_rube(text, options.scene, as);
    keep_inputs({options.scene.name}, {{"--out", {options.out}}});
    for (const PlannedJoint& joint : plan.joints)
      if (joint.end || joint.drive || joint.ground_moves())
        fmt::print(stderr, "warning: {}: joint '{}' is written as R.U.B.E. has it: {}\n", options.scene.name,
                   joint.name,
                   joint.ground_moves() ? "its ground does not move"
                   : joint.end && joint.carries == Carries::tension
                       ? "a rope that is not driven and never yields"
                   : joint.end ? "a bar of that length, which pulls and pushes, and is not driven"
                   : joint.drive->row == rotation ? "a motor that runs from the start"
                                                  : "without its drive");
    if (!plan.loads.empty())
      fmt::print(stderr,
                 "warning: {}: loads are written as properties of bodies, which only ductile knows: a game "
                 "applies them before each step\n",
                 options.scene.name);
    return in_file(options.scene, [&] { return rube_text(plan, as); });
  }
  return json(plan).dump(options.json || options.to.empty() ? -1 : 1) + "\n";
}

std::string left_out_table(const LeanPlan& lean, const Plan& full) {
  std::string text =
      fmt::format("\nleft out: {} of {} joints; error: displacement over the structure's size\n",
                  full.joints.size() - lean.plan.joints.size(), full.joints.size());
  const auto row = [&](const LeftOut& item, const std::string& note = "") {
    text += fmt::format("{:>10.2g} {:>10.2g} {:>9.0f} %  {}{}\n", item.error, item.measured,
                        100 * item.time_saved, item.what, note);
  };
  if (lean.plan.left_out.size() + lean.kept.size() > 0)
    text += fmt::format("{:>10} {:>10} {:>11}\n", "promised", "measured", "time saved");
  for (const LeftOut& item : lean.plan.left_out) row(item);
  if (lean.plan.left_out.size() > 1) row(lean.all);
  for (const LeftOut& item : lean.kept) row(item, " (kept)");
  return text;
}

/// Refuses options that have no effect beside this --to.
void check_to(const Options& options) {
  const auto refuse = [&](bool given, const std::string& option, const std::string& remedy) {
    const std::string to = options.to.empty() ? "json" : options.to;
    if (given) throw InvalidInput({{"command line:" + option, "does not go with --to " + to, remedy}});
  };
  const bool is_scene = options.to == "scene", is_json = options.to.empty() || options.to == "json";
  const std::string one = "leave one of them out";
  refuse(options.leave_out && !is_json, "--leave-out", one + ", or use --to json");
  refuse(options.json && (is_scene || options.to == "cpp"), "--json", one + ": what --to prints is no JSON");
  refuse(!options.as.empty() && options.to != "rube", "--as", one + ", or use --to rube");
  refuse(options.target_error && is_scene, "--target-error", one + ": a scene file keeps its splits");
  refuse(!options.pictures.empty() && is_scene, "--picture", one + ": nothing is calibrated");
}

std::string run(const Options& options) {
  check_to(options);
  const Outputs outputs{{"--out", {options.out}}, {"--picture", options.pictures}};
  keep_apart(outputs);
  keep_inputs({options.scene.name}, {outputs.back()});
  if (options.to == "scene") {
    const std::string given = read_text(options.scene.name);
    if (is_rube(given))
      throw InvalidInput(
          {{"command line:--to",
            "'" + options.scene.name + "' is a level of R.U.B.E., which no scene file holds all of",
            "write the level with its joints calibrated: --to rube"}});
    if (is_drawing(given)) keep_inputs({options.scene.name}, outputs);
    const std::filesystem::path beside = options.out.empty() ? options.scene.name : options.out;
    std::string text = edited_scene(given, scene_of(options.scene, given, outputs), beside.parent_path());
    if (options.out.empty()) return text;
    write_text(options.out, text);
    return "";
  }
  if (options.to != "rube") keep_inputs({options.scene.name}, outputs);
  const bool whole = !options.leave_out && (options.to.empty() || options.to == "rube");
  Plan plan =
      plan_of(options.scene, whole ? NotInPlan::made : NotInPlan::refused, outputs, options.target_error);
  NewFiles files(outputs);
  std::string left_out;
  if (options.leave_out) {
    LeaveOut leaving = options.leaving;
    leaving.tolerance = *options.leave_out;
    Progress progress;
    leaving.progress = [&](double share, const std::string& what) { progress.show(share, what); };
    LeanPlan lean = in_file(options.scene, [&] { return leave_out(plan, leaving); });
    left_out = left_out_table(lean, plan);
    plan = std::move(lean.plan);
  }
  const std::string definitions = definitions_of(plan, options);
  if (!options.pictures.empty()) {
    const std::string what = fmt::format("{} pieces, {} joints", plan.pieces.size(), plan.joints.size());
    files.write_pictures(
        options.pictures,
        picture_svg(plan, {.title = title_of(options.scene.name), .subtitle = what, .panels = {Panel{}}}));
  }
  if (!options.out.empty()) files.write(options.out, definitions);
  files.keep();
  const bool print_definitions = options.json || (!options.to.empty() && options.out.empty());
  return print_definitions ? definitions : table(plan, options.scene) + left_out;
}

}  // namespace

void add_calibrate(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("calibrate", "Split a scene's bodies and calibrate their joints");
  add_scene(command, options->scene);
  auto* to = command
                 ->add_option("--to", options->to,
                              "print definitions: json, box2d, cpp or rube; or the scene file itself")
                 ->check(CLI::IsMember({"json", "box2d", "cpp", "rube", "scene"}));
  command
      ->add_option("--as", options->as,
                   "what a joint that may yield is in players without ductile (hinge): a revolute joint with "
                   "a brake, or a weld that never gives way; goes with --to rube")
      ->needs(to)
      ->check(CLI::IsMember({"hinge", "weld"}));
  command
      ->add_option("--target-error", options->target_error,
                   "relative displacement error of automatic splits (0.01)")
      ->check(finite(0, true))
      ->check(CLI::Range(0.0, 1.0));
  auto* leaves =
      command
          ->add_option("--leave-out", options->leave_out,
                       "leave out what the scene does not need, within this relative displacement error")
          ->check(finite(0, true))
          ->check(CLI::Range(0.0, 1.0));
  command->add_option("--impact", options->leaving.impact, "J that may hit a structure besides (default 0)")
      ->needs(leaves)
      ->check(finite(0));
  command
      ->add_option("--time", options->leaving.seconds,
                   "of the runs that confirm what is left out, s (default: 5 more than until all loads have "
                   "come and gone)")
      ->needs(leaves)
      ->check(finite(0, true));
  command->add_option("--out", options->out, "write the definitions to this file (json if --to is not given)")
      ->check(file_name());
  add_picture(command, options->pictures, "draw pieces, cuts and joints by plastic moment");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
