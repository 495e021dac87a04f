#include "open.h"

#include <algorithm>
#include <iterator>
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
      "Shapes became bodies of S355 in pieces, not joined to one another; what reaches the floor is held "
      "there.";
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

JointBetweenDef joint_of(const PlannedJoint& planned, const std::string& a, const std::string& b) {
  JointBetweenDef joint;
  joint.a = a;
  joint.b = b;
  if (planned.end)
    joint.line = {planned.anchor, *planned.end};
  else
    joint.at = planned.anchor;
  if (planned.end) joint.length = planned.length;
  joint.carries = planned.carries;
  joint.drive = planned.drive;
  joint.overrides = {.axial = planned.N,
                     .axial_compression = planned.Nc,
                     .stiffness_axial = planned.stiffness.N,
                     .max_elongation = planned.max_elongation,
                     .max_compression = planned.max_compression};
  if (planned.end) return joint;
  joint.overrides.moment = planned.M;
  joint.overrides.moment_reverse = planned.M_reverse;
  joint.overrides.shear = planned.Q;
  joint.overrides.stiffness_shear = planned.stiffness.Q;
  joint.overrides.stiffness_moment = planned.stiffness.M;
  joint.overrides.max_rotation = planned.max_rotation;
  joint.overrides.max_slip = planned.max_slip;
  return joint;
}

SceneDef scene_of(const Plan& level) {
  SceneDef scene;
  const auto body_of = [&](int piece) -> const BodyDef& {
    return level.bodies[static_cast<std::size_t>(level.pieces[static_cast<std::size_t>(piece)].body)];
  };
  const auto is_taken = [](const BodyDef& body) {
    return body.type != BodyType::dynamic_body || body.material;
  };
  std::copy_if(level.bodies.begin(), level.bodies.end(), std::back_inserter(scene.bodies), is_taken);
  for (const PlannedJoint& joint : level.joints) {
    if (joint.a < 0 || !is_taken(body_of(joint.a)) || !is_taken(body_of(joint.b))) continue;
    const std::string &a = body_of(joint.a).name, &b = body_of(joint.b).name;
    if (a != b) scene.joints.push_back(joint_of(joint, a, b));
  }
  for (const Plan::Load& load : level.loads) {
    if (!is_taken(body_of(load.piece))) continue;
    scene.loads.push_back(load.def);
    scene.loads.back().body = body_of(load.piece).name;
    scene.loads.back().at = load.at;
  }
  return scene;
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

SceneDef part_of_file(const std::filesystem::path& file) {
  Opened opened = open_file(file);
  if (opened.level) return scene_of(*opened.level);
  if (opened.text.empty()) {  // a drawing: its first body is the floor, on which it is held
    opened.scene.bodies.erase(opened.scene.bodies.begin());
    opened.scene.supports.clear();
  }
  return std::move(opened.scene);
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
