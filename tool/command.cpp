#include "command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "ductile/files.h"
#include "ductile/level.h"

namespace ductile::tool {

Plan plan_of(const std::string& scene_file, bool kept_elsewhere, std::optional<double> target_error) {
  const std::string text = read_text(scene_file);  // once: it may be a pipe
  if (is_rube(text)) {
    std::vector<Problem> beyond;
    Plan plan = parse_plan(text, scene_file, ".", &beyond);
    if (!beyond.empty() && !kept_elsewhere) throw InvalidInput(std::move(beyond));
    return plan;
  }
  SceneDef scene = parse_scene(text, scene_file, std::filesystem::path(scene_file).parent_path());
  if (target_error) scene.target_error = *target_error;
  return in_file(scene_file, [&] { return calibrate(scene); });
}

std::string piece_name(const Plan& plan, int piece) {
  return piece < 0 ? "ground" : plan.pieces[static_cast<std::size_t>(piece)].name;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

std::string shown(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value + 0.) : "-";
}  // no "-0"

std::string title_of(const std::string& scene_file) {
  std::string name = std::filesystem::path(scene_file).filename().string();
  name = name.substr(0, name.find('.'));
  std::replace(name.begin(), name.end(), '_', ' ');
  if (!name.empty() && name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return name;
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
