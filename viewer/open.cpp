#include "open.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "ductile/level.h"

namespace ductile::viewer {
namespace {

Opened scene_of(const Drawing& drawing, const std::filesystem::path& file, double metres_per_unit) {
  DrawnScene drawn = drawing_scene(drawing, metres_per_unit);
  Opened opened;
  if (drawn.scale > 0) opened.note = "The drawing does not say how large it is: it is shown 10 m large. ";
  opened.note +=
      "Shapes became bodies of S355 in up to 8 pieces, not joined to one another; what reaches the floor is "
      "held there.";
  if (drawn.too_thin > 0)
    opened.note +=
        " What is thinner than the 0.02 m that Box2D collides touches nothing: a larger scale helps.";
  if (drawn.heaped > 0) opened.note += " Shapes that lie over one another do not collide with each other.";
  if (!drawn.left_out.empty()) {
    opened.note += " Left out: " + drawn.left_out.front().place + " " + drawn.left_out.front().what;
    if (drawn.left_out.size() > 1)
      opened.note += ", and " + std::to_string(drawn.left_out.size() - 1) + " more";
    opened.note += '.';
  }
  opened.scene = std::move(drawn.scene);
  opened.file = file;
  opened.file.replace_extension(".scene.json");
  return opened;
}

Opened level_of(std::string_view text, const std::filesystem::path& file) {
  return {{},
          file,
          "A level is run and looked into here; what it is made of is edited where it comes from.",
          parse_plan(text, file.string(), file.parent_path()),
          {},
          {}};
}

/// Files that a scene's strings name, with or without a shape of them: "crane.svg#jib".
std::vector<std::filesystem::path> named_in(std::string_view text, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (std::size_t open = text.find('"'); open != text.npos;) {
    const std::size_t close = text.find('"', open + 1);
    if (close == text.npos) break;
    const std::string_view word = text.substr(open + 1, close - open - 1),
                           name = word.substr(0, word.find('#'));
    std::error_code none;
    if ((name.ends_with(".svg") || name.ends_with(".json")) && std::filesystem::exists(folder / name, none) &&
        std::find(files.begin(), files.end(), folder / name) == files.end())
      files.push_back(folder / name);
    open = text.find('"', close + 1);
  }
  return files;
}

}  // namespace

Opened open_file(const std::filesystem::path& file, double metres_per_unit) {
  const std::string text = read_text(file);
  Opened opened;
  if (is_drawing(text)) {
    opened = scene_of(Drawing(text, file.string()), file, metres_per_unit);
  } else if (is_rube(text)) {
    opened = level_of(text, file);
  } else {
    opened.scene = parse_scene(text, file.string(), file.parent_path());
    opened.file = file;
    opened.text = text;
    opened.sources = named_in(text, file.parent_path());
  }
  opened.sources.push_back(file);
  return opened;
}

std::vector<std::filesystem::path> scenes_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> list;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (entry.path().filename().string().ends_with(".scene.json")) list.push_back(entry.path());
  }
  std::sort(list.begin(), list.end());
  return list;
}

}  // namespace ductile::viewer
