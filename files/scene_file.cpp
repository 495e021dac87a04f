// Scene files, read strictly: every key is known, every number in its range, every name of something.
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "ductile/rolled.h"
#include "section_file.h"

namespace ductile {
namespace {
namespace fs = std::filesystem;

/// Reads one scene; keeps what several bodies may name.
class SceneReader {
 public:
  SceneReader(Problems& problems, fs::path folder) : problems_(problems), folder_(std::move(folder)) {}

  SceneDef scene(const Value& value);
  const std::vector<fs::path>& named() const { return named_; }

 private:
  void materials(const Value& value);
  std::optional<Material> material(const Value& name) const;
  /// The scene's damping ratio is that of each material that does not state its own.
  Material damped(Material material) const;
  BodyDef body(const Value& value);
  void outline(Object& body, const Value& value, BodyDef& def);
  Outline drawn(const Value& value, const std::string& reference, const DrawingScale& scale);
  void profile(const Value& value, BodyDef& def);
  /// The text of a file that the scene names; nothing after complaining at the place that names it.
  std::optional<std::string> named_file(const Value& value, const std::string& file);

  Problems& problems_;
  fs::path folder_;
  std::vector<fs::path> named_;
  std::optional<double> damping_ratio_;
  std::map<std::string, Material, std::less<>> materials_;
  std::map<std::string, std::optional<Drawing>, std::less<>> drawings_;  // empty: could not be read
};

std::optional<std::array<Point, 2>> read_segment(const Value& value) {
  if (!value.json().is_array() || value.json().size() != 2) {
    return value.wrong("is " + value.shown(), "write two points, [[x, y], [x, y]]"), std::nullopt;
  }
  const auto ends = value.elements();
  const auto p = ends[0].point(), q = ends[1].point();
  if (!p || !q) return std::nullopt;
  return std::array{*p, *q};
}

void read_elastic(const Value& value, JointOverrides& overrides) {
  if (value.json().is_object()) {
    Object object(value);
    object.read(fields::elastic, overrides);
    const bool rotation = value.json().contains("elastic_rotation");
    overrides.elastic = rotation ? Elasticity::elastic_rotation : Elasticity::frequency;
    if (!rotation && !value.json().contains("frequency")) {
      value.wrong("has neither \"frequency\" nor \"elastic_rotation\"", "give one of them, or both");
    }
  } else if (value.json() == true || value.json() == "true") {
    overrides.elastic = Elasticity::true_stiffness;
  } else if (value.json() == "rigid") {
    overrides.elastic = Elasticity::rigid;
  } else {
    value.wrong("is " + value.shown(),
                R"(write "rigid", "true", {"frequency", "damping_ratio"} or {"elastic_rotation"})");
  }
}

JointOverrides read_overrides(Object& object) {
  JointOverrides overrides;
  object.read(fields::overrides, overrides);
  if (const auto elastic = object.find("elastic")) read_elastic(*elastic, overrides);
  if (const auto length = object.find("hinge_length")) {
    if (length->json().is_object()) {
      Object from(*length);
      if (const auto span = from.require("shear_span")) overrides.shear_span = span->number(positive);
    } else {
      overrides.hinge_length = length->number(positive);
    }
  }
  return overrides;
}

void read_split(const Value& value, BodyDef& def) {
  if (value.json() == "auto") {
    def.automatic = true;
    return;
  }
  if (!value.json().is_object()) {
    return value.wrong("is " + value.shown(), R"(write "auto", {"pieces", "along"} or {"cuts"})");
  }
  Object object(value);
  if (const auto cuts = object.find("cuts")) {
    for (const Value& cut : cuts->elements()) {
      if (const auto segment = read_segment(cut)) def.cuts.push_back(*segment);
    }
    if (value.json().size() > 1) value.wrong("has more than \"cuts\"", R"(give either "cuts" or "pieces")");
  } else if (const auto pieces = object.require("pieces")) {
    def.pieces = pieces->integer(1, BodyDef::most_pieces).value_or(1);
  }
  if (const auto along = object.find("along")) {
    def.along = read_segment(*along).value_or(def.along);
    if (def.along[0] == def.along[1]) along->wrong("has no length", "give two points along the body");
  }
}

DriveDef read_drive(const Value& value) {
  DriveDef def;
  Object object(value);
  object.require("row");
  object.choice("row", def.row, {{"axial", axial}, {"rotation", rotation}});
  object.read(fields::drive, def);
  return def;
}

// A node is at a point, a line between two.
void read_place(const Value& value, JointBetweenDef& def) {
  const nlohmann::json& json = value.json();
  if (json.is_array() && !json.empty() && json[0].is_array())
    def.line = read_segment(value);
  else
    def.at = value.point();
}

JointBetweenDef read_joint(const Value& value) {
  JointBetweenDef def;
  Object object(value);
  object.choice("kind", def.carries, {{"rope", Carries::tension}, {"strut", Carries::compression}});
  if (const auto drive = object.find("drive")) def.drive = read_drive(*drive);
  const auto at = object.find("at");
  if (at) read_place(*at, def);
  if (const auto between = object.require("between")) {
    const auto names = between->elements();
    if (between->json().is_array() && (names.size() < 2 || (names.size() > 2 && !at))) {
      between->wrong("names " + std::to_string(names.size()) + " bodies",
                     names.size() < 2 ? "name two" : "name two, or give the point of a node, \"at\"");
    } else if (names.size() >= 2) {
      def.a = names[0].text().value_or("");
      def.b = names[1].text().value_or("");
      for (std::size_t i = 2; i < names.size(); ++i) def.others.push_back(names[i].text().value_or(""));
    }
  }
  if (const auto across = object.find("across")) def.across = read_segment(*across);
  object.read(fields::joint, def);
  def.overrides = read_overrides(object);
  return def;
}

SupportDef read_support(const Value& value) {
  SupportDef def;
  Object object(value);
  object.read(fields::support, def);
  if (const auto stiffness = object.find("stiffness")) {
    Object rows(*stiffness);
    rows.read(fields::springs, def);
    if (stiffness->json().is_object() && stiffness->json().empty())
      stiffness->wrong("is empty", R"(give any of "x", "y", "angle")");
  }
  const bool sprung = value.json().contains("stiffness");
  if (const auto fix = sprung ? object.find("fix") : object.require("fix")) {
    std::set<std::string> fixed;
    for (const Value& row : fix->elements()) {
      if (row.json().is_string() && !fixed.insert(row.json().get<std::string>()).second)
        row.wrong("stands twice", "fix each row once");
      if (row.json() == "x") {
        def.fix_x = true;
      } else if (row.json() == "y") {
        def.fix_y = true;
      } else if (row.json() == "angle") {
        def.fix_angle = true;
      } else {
        wrong_choice(row, {"x", "y", "angle"});
      }
    }
    if (fix->json().is_array() && fix->json().empty()) {
      fix->wrong("is empty", R"(fix any of "x", "y", "angle")");
    }
  }
  if (const auto displacement = object.find("displacement")) {
    const auto rows = displacement->elements();
    if (displacement->json().is_array() && rows.size() != 3)
      displacement->wrong("has " + std::to_string(rows.size()) + " numbers",
                          "write [x, y, angle], m and rad");
    for (std::size_t row = 0; row < std::min<std::size_t>(3, rows.size()); ++row)
      rows[row].read(any_number, def.displacement[row]);
  }
  return def;
}

LoadDef read_load(const Value& value) {
  LoadDef def;
  Object object(value);
  object.read(fields::load, def);
  return def;
}

WheelDef read_wheel(const Value& value) {
  WheelDef def;
  Object object(value);
  if (const auto between = object.require("between")) {
    const auto names = between->elements();
    if (names.size() == 2) {
      def.chassis = names[0].text().value_or("");
      def.wheel = names[1].text().value_or("");
    } else if (between->json().is_array()) {
      between->wrong("names " + std::to_string(names.size()) + " bodies", "name the chassis and the wheel");
    }
  }
  object.read(fields::wheel, def);
  if (def.axis == Point{}) {
    object.find("axis")->wrong("has no length", "give the direction in which the wheel springs");
  }
  return def;
}

void SceneReader::materials(const Value& value) {
  if (!value.json().is_object()) return value.wrong("is " + value.shown(), "write {\"name\": material...}");
  for (const auto& [name, json] : value.json().items()) {
    const Value entry(json, value.place() + "." + name, problems_);
    Material& material = materials_[name];
    if (entry.json().is_string()) {
      material = damped(built_in_material(entry).value_or(Material{}));
      continue;
    }
    material = damped({});
    Object object(entry);
    for (const char* key : {"density", "E"}) object.require(key);
    read_strength(object, material);
    object.read(fields::substance, material);
  }
}

Material SceneReader::damped(Material material) const {
  material.damping_ratio = damping_ratio_.value_or(material.damping_ratio);
  return material;
}

std::optional<Material> SceneReader::material(const Value& name) const {
  if (name.json().is_string()) {
    const auto found = materials_.find(name.json().get_ref<const std::string&>());
    if (found != materials_.end()) return found->second;
  }
  std::vector<std::string_view> names;
  for (const auto& [known, ignored] : materials_) names.emplace_back(known);
  const auto found = built_in_material(name, names);
  return found ? std::optional(damped(*found)) : std::nullopt;
}

std::optional<std::string> SceneReader::named_file(const Value& value, const std::string& file) {
  named_.push_back(folder_ / file);
  try {
    return read_text(named_.back());
  } catch (const InvalidInput& error) {
    for (const Problem& problem : error.problems())
      value.wrong("'" + file + "' " + problem.what, problem.remedy);
    return std::nullopt;
  }
}

Outline SceneReader::drawn(const Value& value, const std::string& reference, const DrawingScale& scale) {
  const auto hash = reference.rfind('#');
  if (hash == std::string::npos || hash == 0 || hash + 1 == reference.size()) {
    value.wrong("is " + value.shown(), R"(write a ring, "drawing.svg#id" or {"circle": radius})");
    return {};
  }
  const std::string file = reference.substr(0, hash);
  auto known = drawings_.find(file);
  try {
    if (known == drawings_.end()) {
      known = drawings_.emplace(file, std::nullopt).first;
      if (const auto text = named_file(value, file)) known->second.emplace(*text, (folder_ / file).string());
    }
    if (known->second) return known->second->outline(reference.substr(hash + 1), scale);
  } catch (const InvalidInput& error) {
    problems_.add(error.problems());
  }
  return {};
}

void SceneReader::outline(Object& body, const Value& value, BodyDef& def) {
  DrawingScale scale;
  const auto metres_per_unit = body.find("scale"), tolerance = body.find("tolerance"),
             holes = body.find("holes");
  if (metres_per_unit) scale.metres_per_unit = metres_per_unit->number(positive).value_or(1);
  if (tolerance) scale.tolerance = tolerance->number(positive).value_or(0);
  if (value.json().is_array()) {
    def.outline.outer = value.ring().value_or(Ring{});
    if (holes) def.outline.holes = holes->rings().value_or(std::vector<Ring>{});
  } else if (holes) {
    holes->wrong("goes with a ring only", "leave it out: the holes of a drawing come with it");
  }
  if (value.json().is_string()) {
    def.outline = drawn(value, value.json().get<std::string>(), scale);
  } else {
    if (metres_per_unit) metres_per_unit->wrong("goes with a drawing only", "leave it out");
    if (tolerance) tolerance->wrong("goes with a drawing only", "leave it out");
  }
  if (value.json().is_object()) {
    Object object(value);
    if (const auto radius = object.require("circle")) def.circle = radius->number(positive).value_or(1);
  } else if (!value.json().is_array() && !value.json().is_string()) {
    value.wrong("is " + value.shown(), R"(write a ring, "drawing.svg#id" or {"circle": radius})");
  }
}

void SceneReader::profile(const Value& value, BodyDef& def) {
  if (value.json().is_object()) {
    def.profile = read_regions(value);
  } else if (const auto file = value.text()) {
    if (names_a_profile(*file) && !fs::exists(folder_ / *file)) {
      if (!def.material)
        return value.wrong("is a profile of a body without \"material\"",
                           "give the body the profile's material");
      try {
        const Rolled profile = rolled(*file);
        def.profile = {{draw(profile).outline, *def.material}};
        def.profile_name = profile.name;
      } catch (const InvalidInput& error) {
        value.wrong(error.problems()[0].what, error.problems()[0].remedy);
      }
      return;
    }
    if (const auto text = named_file(value, *file)) {
      try {
        def.profile = parse_section(*text, (folder_ / *file).string());
      } catch (const InvalidInput& error) {
        problems_.add(error.problems());
      }
    }
  }
  for (Region& region : def.profile) region.material = damped(region.material);
}

BodyDef SceneReader::body(const Value& value) {
  BodyDef def;
  Object object(value);
  object.read(fields::body, def);
  object.choice("type", def.type,
                {{"static", BodyType::static_body},
                 {"dynamic", BodyType::dynamic_body},
                 {"kinematic", BodyType::kinematic_body}});
  if (const auto shape = object.require("outline")) outline(object, *shape, def);
  if (const auto velocities = object.find("velocities")) {
    for (const Value& velocity : velocities->elements())
      def.velocities.push_back(velocity.point().value_or(Point{}));
  }
  if (const auto name = object.find("material")) def.material = material(*name);
  if (const auto section = object.find("profile")) {
    profile(*section, def);
    if (value.json().contains("depth")) {
      section->wrong("stands beside \"depth\"", "give one of the two: the profile has its own depth");
    }
  }
  if (const auto split = object.find("split")) read_split(*split, def);
  if (const auto joint = object.find("joint")) {
    Object overrides(*joint);
    def.joint = read_overrides(overrides);
  }
  return def;
}

template <class T, class Read>
void read_list(const std::optional<Value>& list, std::vector<T>& target, Read read) {
  if (!list) return;
  for (const Value& element : list->elements()) target.push_back(read(element));
}

SceneDef SceneReader::scene(const Value& value) {
  SceneDef scene;
  const auto has = [&](const char* key) { return value.json().is_object() && value.json().contains(key); };
  if (has("regions")) {
    value.wrong("has \"regions\": this is a section",
                "a scene has \"bodies\"; a section goes to ductile section");
    return scene;
  }
  if (has("layers") && !has("bodies")) {
    value.wrong("has \"layers\": this is a map of Tiled, whose polygons are no bodies yet",
                "make a scene of them, as docs/files/starting.md shows");
    return scene;
  }
  Object object(value);
  object.read(fields::scene, scene);
  if (const auto joint = object.find("joint")) {
    Object overrides(*joint);
    scene.joint = read_overrides(overrides);
  }
  if (const auto ratio = object.find("damping_ratio")) damping_ratio_ = ratio->number(not_negative);
  if (const auto list = object.find("materials")) materials(*list);
  read_list(object.require("bodies"), scene.bodies, [&](const Value& element) { return body(element); });
  read_list(object.find("joints"), scene.joints, read_joint);
  read_list(object.find("supports"), scene.supports, read_support);
  read_list(object.find("loads"), scene.loads, read_load);
  read_list(object.find("wheels"), scene.wheels, read_wheel);
  return scene;
}

}  // namespace

SceneDef parse_scene(std::string_view text, const std::string& name, const fs::path& folder,
                     std::vector<fs::path>* named) {
  const nlohmann::json json = parse_json(text, name);
  Problems problems(name);
  SceneReader reader(problems, folder);
  auto scene = reader.scene(Value(json, "top level", problems));
  problems.check();
  if (named) *named = reader.named();
  return scene;
}

std::string scene_name(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.substr(0, name.find('.'));
}

SceneDef read_scene(const fs::path& file) {
  return parse_scene(read_text(file), file.string(), file.parent_path());
}

}  // namespace ductile
