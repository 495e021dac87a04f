#include "command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "ductile/level.h"
#include "ductile/rolled.h"

namespace ductile::tool {

namespace {

/// What a drawing does not say, and what of it was not taken, on stderr.
SceneDef scene_of_drawing(std::string_view text, const SceneFile& file) {
  DrawnScene drawn = drawing_scene(Drawing(text, file.name), file.metres_per_unit);
  if (drawn.scale > 0)
    fmt::print(stderr, "warning: {}: has no physical size; a unit is taken as {:.4g} m: give --scale\n",
               file.name, drawn.scale);
  if (drawn.too_thin > 0)
    fmt::print(stderr,
               "warning: {}: {} of {} bodies are thinner than the 0.02 m that Box2D collides, and touch "
               "nothing: give a "
               "larger --scale\n",
               file.name, drawn.too_thin, drawn.scene.bodies.size() - 1);
  if (drawn.heaped > 0)
    fmt::print(stderr,
               "warning: {}: {} of {} shapes lie over one another, and do not collide with each other: draw "
               "what shall carry what side by side\n",
               file.name, drawn.heaped, drawn.scene.bodies.size() - 1);
  constexpr std::size_t most = 20;
  for (std::size_t i = 0; i < std::min(drawn.left_out.size(), most); ++i) {
    const Problem& problem = drawn.left_out[i];
    fmt::print(stderr, "warning: {}: {} (left out); {}\n", problem.place, problem.what, problem.remedy);
  }
  if (drawn.left_out.size() > most)
    fmt::print(stderr, "warning: {}: {} more left out\n", file.name, drawn.left_out.size() - most);
  return std::move(drawn.scene);
}

}  // namespace

void add_scale(CLI::App* command, double& metres_per_unit) {
  command
      ->add_option("--scale", metres_per_unit,
                   "metres per unit of a drawing (default: its physical size, else it is 10 m large)")
      ->check(finite(0, true));
}

void add_scene(CLI::App* command, SceneFile& scene, const char* what) {
  command->add_option("SCENE", scene.name, what)->required();
  add_scale(command, scene.metres_per_unit);
}

void check_profile(const std::string& name, const std::string& option) {
  if (!names_a_profile(name) && !std::filesystem::exists(name))
    throw InvalidInput(
        {{"command line:" + option, "'" + name + "' is no profile, series of profiles or file",
          "write a profile as in IPE 300, a tube with its size as in CHS 168.3x5, or a section file"}});
}

namespace {

void tell_of_scale(const SceneFile& file) {
  if (file.metres_per_unit > 0)
    fmt::print(stderr,
               "warning: {}: is no drawing: --scale changes nothing, all its numbers are in SI units\n",
               file.name);
}

}  // namespace

SceneDef scene_of(const SceneFile& file, const std::string& text, const Outputs& outputs) {
  if (is_drawing(text)) return scene_of_drawing(text, file);
  tell_of_scale(file);
  std::vector<std::filesystem::path> named;
  SceneDef scene = parse_scene(text, file.name, std::filesystem::path(file.name).parent_path(), &named);
  keep_inputs({named.begin(), named.end()}, outputs);
  return scene;
}

void warn_of_splits(const Plan& plan, const SceneFile& file) {
  constexpr std::size_t most = 20;  // drawings have bodies by the hundred
  std::size_t above = 0;
  for (const SplitError& split : plan.split_errors)
    if (split.governed_by != "target error" && ++above <= most)
      fmt::print(
          stderr,
          "warning: {}: '{}' is split with a displacement error of {:.2g} %, above the target error: it "
          "is governed by {}\n",
          file.name, plan.bodies[static_cast<std::size_t>(split.body)].name, 100 * split.error,
          split.governed_by);
  if (above > most)
    fmt::print(stderr, "warning: {}: {} more are split with an error above the target error\n", file.name,
               above - most);
}

Plan plan_of(const SceneFile& file, NotInPlan rest, const Outputs& outputs,
             std::optional<double> target_error) {
  const std::string& scene_file = file.name;
  const std::string text = read_text(scene_file);  // once: it may be a pipe
  if (is_rube(text)) {
    tell_of_scale(file);
    std::vector<Problem> beyond;
    Plan plan = parse_plan(text, scene_file, ".", &beyond);
    if (rest == NotInPlan::made) return plan;
    plan.make = nullptr;
    if (!beyond.empty() && rest == NotInPlan::refused) throw InvalidInput(std::move(beyond));
    for (const Problem& problem : beyond)
      fmt::print(stderr, "warning: {}: {}: statics leaves it out\n", problem.place, problem.what);
    return plan;
  }
  SceneDef scene = scene_of(file, text, outputs);
  if (target_error) scene.target_error = *target_error;
  Plan plan = in_file(scene_file, [&] { return calibrate(scene); });
  warn_of_splits(plan, file);
  return plan;
}

std::string piece_name(const Plan& plan, int piece) {
  return piece < 0 ? "ground" : plan.pieces[static_cast<std::size_t>(piece)].name;
}

std::string joint_name(const Plan& plan, int joint) {
  return plan.joints[static_cast<std::size_t>(joint)].name;
}

std::string buckling_line(bool second_order, double critical_load_factor) {
  return std::string(second_order ? "second order" : "first order") +
         (critical_load_factor == 0 ? "; unstable under any multiple of the loads"
          : critical_load_factor < unlimited
              ? fmt::format("; buckles at {:.6g} times the loads", critical_load_factor)
              : "; does not buckle");
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value + 0.) : "-";  // + 0: no "-0"
}

std::string title_of(const std::string& scene_file) {
  // A file's name may be any bytes, a picture's title is UTF-8.
  const std::string valid = Json(scene_name(scene_file)).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string name = Json::parse(valid).get<std::string>();
  std::replace(name.begin(), name.end(), '_', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

CLI::Validator file_name() {
  return CLI::Validator(
      [](const std::string& file) -> std::string { return file.empty() ? "'' names no file" : ""; }, "");
}

CLI::Option* add_picture(CLI::App* command, std::vector<std::string>& files, const std::string& what) {
  const CLI::Validator name(
      [](const std::string& file) -> std::string {
        return file.ends_with(".svg") || file.ends_with(".png") ? "" : "'" + file + "' is no .svg or .png";
      },
      "");
  return command->add_option("--picture", files, what + " to this SVG or PNG file; may be repeated")
      ->check(name)
      ->allow_extra_args(false);
}

CLI::Validator finite(double low, bool open) {
  return CLI::Validator(
      [=](const std::string& text) -> std::string {
        double value = 0;
        if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) {
          return "'" + text + "' is no finite number";
        }
        return value < low || (open && value == low)
                   ? fmt::format("{} is not {} {:g}", text, open ? ">" : ">=", low)
                   : "";
      },
      "");
}

}  // namespace ductile::tool
