#include "open.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "ductile/files.h"
#include "ductile/level.h"
#include "geometry.h"

namespace ductile::viewer {
namespace {

constexpr double width_without_size = 10;  // m, of a drawing that does not say how large it is

// Ids that a scene takes as names, each once.
std::string body_name(std::string id, std::set<std::string>& taken) {
  std::replace_if(
      id.begin(), id.end(), [](char c) { return c == '/' || c == '#' || c == '-'; }, '_');
  if (id == "ground" || id == "floor") id += "_";
  std::string name = id;
  for (int i = 2; !taken.insert(name).second; ++i) name = id + "_" + std::to_string(i);
  return name;
}

std::vector<Outline> outlines(const Drawing& drawing, const DrawingScale& scale) {
  std::vector<Outline> list;
  for (const std::string& id : drawing.ids()) list.push_back(drawing.outline(id, scale));
  return list;
}

Box extent(const std::vector<Outline>& list) {
  Box box;
  for (const Outline& outline : list) {
    for (const Point& p : outline.outer) box.add(p);
  }
  return box;
}

// Split where it can be: a body that cannot is still a body.
BodyDef split(BodyDef body) {
  BodyDef parts = body;
  parts.pieces = 8;
  try {
    calibrate(parts);
    return parts;
  } catch (const InvalidInput&) {
    return body;
  }
}

Opened scene_of(const Drawing& drawing, const std::filesystem::path& file) {
  Opened opened;
  std::vector<Outline> shapes;
  try {
    shapes = outlines(drawing, {});
  } catch (const InvalidInput&) {  // no physical size, unless it fails again
    const Box units = extent(outlines(drawing, {.metres_per_unit = 1}));
    if (units.empty()) throw;
    const double scale = width_without_size / std::max(units.size().x, units.size().y);
    shapes = outlines(drawing, {.metres_per_unit = scale});
    opened.note = "The drawing does not say how large it is: it is shown 10 m long. ";
  }
  if (shapes.empty()) {
    throw InvalidInput({{file.string(), "has no shape with an id", "give shapes ids"}});
  }
  const Box box = extent(shapes);
  const double size = std::max(box.size().x, box.size().y);
  const double depth = 0.05 * size;
  std::set<std::string> taken;
  BodyDef floor;
  floor.name = "floor";
  floor.type = BodyType::static_body;
  floor.outline.outer = {{box.low.x - size, box.low.y - 0.1 * size},
                         {box.high.x + size, box.low.y - 0.1 * size},
                         {box.high.x + size, box.low.y},
                         {box.low.x - size, box.low.y}};
  opened.scene.bodies.push_back(floor);
  const auto ids = drawing.ids();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    BodyDef body;
    body.name = body_name(ids[i], taken);
    body.outline = shapes[i];
    body.material = materials::S355;
    body.depth = depth;
    opened.scene.bodies.push_back(split(std::move(body)));
  }
  opened.note += "Shapes became bodies of S355 in up to 8 pieces, not joined to one another.";
  opened.file = file;
  opened.file.replace_extension(".scene.json");
  return opened;
}

bool is_drawing(std::string_view text) {
  const auto first = std::find_if(text.begin(), text.end(), [](unsigned char c) {
    return !std::isspace(c) && c != 0xEF && c != 0xBB && c != 0xBF;  // a byte order mark
  });
  return first != text.end() && *first == '<';
}

Opened level_of(std::string_view text, const std::filesystem::path& file) {
  std::vector<Problem> beyond;
  Plan plan = parse_plan(text, file.string(), file.parent_path(), &beyond);
  std::string note = "A level is run and looked into here; what it is made of is edited where it comes from.";
  if (!beyond.empty()) note += " Not shown: " + std::to_string(beyond.size()) + " of its parts.";
  return {{}, file, std::move(note), std::move(plan)};
}

}  // namespace

Opened open_file(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  if (is_drawing(text)) return scene_of(Drawing(text, file.string()), file);
  if (is_rube(text)) return level_of(text, file);
  return {parse_scene(text, file.string(), file.parent_path()), file, "", {}};
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
