// A scene as the text of a scene file, in which what has its default is left out.
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "ductile/files.h"
#include "json.h"
#include "scene_text.h"

namespace ductile {
namespace {

using Json = nlohmann::ordered_json;

Json json(const Point& p) { return Json::array({p.x, p.y}); }
Json json(const Ring& ring) {
  Json list = Json::array();
  for (const Point& p : ring) list.push_back(json(p));
  return list;
}
Json json(const std::vector<Ring>& rings) {
  Json list = Json::array();
  for (const Ring& ring : rings) list.push_back(json(ring));
  return list;
}
Json json(const std::array<Point, 2>& segment) { return Json::array({json(segment[0]), json(segment[1])}); }
Json json(double value) { return std::isinf(value) ? Json(nullptr) : Json(value); }
template <class T>
requires(std::is_integral_v<T> || std::is_same_v<T, std::string>) Json json(const T& value) { return value; }
template <class T>
Json json(const std::optional<T>& value) {
  return json(*value);
}

/// Writes the fields whose value is not the default: what the author did not say stays unsaid.
template <class Owner, class... Fields>
void put(Json& object, const std::tuple<Fields...>& table, const Owner& owner) {
  const Owner standard;
  fields::for_each(table, [&](const auto& field) {
    const auto& value = owner.*field.member;
    if (field.required || !(value == standard.*field.member)) object[field.key] = json(value);
  });
}

void put_strength(Json& object, const Material& material) {
  put(object, fields::strength, material);
  if (material.criterion == Criterion::von_mises) object["criterion"] = "von_mises";
}

/// Names the materials of a scene: built-in ones by their own name, others "material 1", "material 2"…
class MaterialNames {
 public:
  std::string name(const Material& material) {
    if (const auto known = built_in_name(material)) return *known;
    for (std::size_t i = 0; i < own_.size(); ++i) {
      if (own_[i] == material) return own_name(i);
    }
    own_.push_back(material);
    return own_name(own_.size() - 1);
  }
  Json list() const {
    Json list = Json::object();
    for (std::size_t i = 0; i < own_.size(); ++i) list[own_name(i)] = material_json(own_[i]);
    return list;
  }

 private:
  static std::string own_name(std::size_t i) { return "material " + std::to_string(i + 1); }
  std::vector<Material> own_;
};

void put_overrides(Json& object, const JointOverrides& overrides) {
  put(object, fields::overrides, overrides);
  if (overrides.elastic == Elasticity::true_stiffness) object["elastic"] = "true";
  if (overrides.elastic == Elasticity::rigid) object["elastic"] = "rigid";
  if (overrides.elastic == Elasticity::frequency || overrides.elastic == Elasticity::elastic_rotation) {
    put(object["elastic"], fields::elastic, overrides);
  }
  if (overrides.hinge_length) object["hinge_length"] = *overrides.hinge_length;
  if (overrides.shear_span && !overrides.hinge_length)
    object["hinge_length"] = {{"shear_span", *overrides.shear_span}};
}

Json json(const BodyDef& body, MaterialNames& names) {
  const BodyDef standard;
  Json object;
  object["name"] = body.name;
  if (body.type == BodyType::static_body) object["type"] = "static";
  if (body.type == BodyType::kinematic_body) object["type"] = "kinematic";
  object["outline"] = body.circle > 0 ? Json{{"circle", body.circle}} : json(body.outline.outer);
  if (!body.outline.holes.empty()) object["holes"] = json(body.outline.holes);
  put(object, fields::body, body);
  if (body.material) object["material"] = names.name(*body.material);
  if (!body.profile.empty()) {
    object.erase("depth");
    object["profile"] = body.profile_name.empty() ? section_json(body.profile) : Json(body.profile_name);
  }
  for (const Point velocity : body.velocities) object["velocities"].push_back(json(velocity));
  if (body.automatic) {
    object["split"] = "auto";
  } else if (!body.cuts.empty()) {
    for (const auto& cut : body.cuts) object["split"]["cuts"].push_back(json(cut));
  } else if (body.pieces != standard.pieces) {
    object["split"]["pieces"] = body.pieces;
    if (body.along != standard.along) object["split"]["along"] = json(body.along);
  }
  Json overrides;
  put_overrides(overrides, body.joint);
  if (!overrides.empty()) object["joint"] = std::move(overrides);
  return object;
}

Json json(const JointBetweenDef& joint) {
  Json object;
  object["between"] = {joint.a, joint.b};
  for (const std::string& name : joint.others) object["between"].push_back(name);
  if (joint.at) object["at"] = json(*joint.at);
  if (joint.across) object["across"] = json(*joint.across);
  if (joint.line) object["at"] = json(*joint.line);
  if (joint.carries == Carries::tension) object["kind"] = "rope";
  if (joint.carries == Carries::compression) object["kind"] = "strut";
  put(object, fields::joint, joint);
  if (joint.drive) {
    object["drive"]["row"] = joint.drive->row == axial ? "axial" : "rotation";
    put(object["drive"], fields::drive, *joint.drive);
  }
  put_overrides(object, joint.overrides);
  return object;
}

Json json(const SupportDef& support) {
  Json object;
  put(object, fields::support, support);
  Json springs;
  put(springs, fields::springs, support);
  if (!springs.empty()) object["stiffness"] = springs;
  if (support.fix_x || support.fix_y || support.fix_angle || springs.empty()) object["fix"] = Json::array();
  if (support.fix_x) object["fix"].push_back("x");
  if (support.fix_y) object["fix"].push_back("y");
  if (support.fix_angle) object["fix"].push_back("angle");
  if (support.displacement != std::array<double, 3>{}) object["displacement"] = support.displacement;
  return object;
}

Json json(const LoadDef& load) { return load_json(load); }

Json json(const WheelDef& wheel) {
  Json object;
  object["between"] = {wheel.chassis, wheel.wheel};
  put(object, fields::wheel, wheel);
  return object;
}

template <class T>
void put_list(Json& scene, const char* key, const std::vector<T>& list) {
  for (const T& element : list) scene[key].push_back(json(element));
}

}  // namespace

std::optional<std::string> built_in_name(const Material& material) {
  for (const NamedMaterial& known : materials::all()) {
    if (known.material == material) return std::string(known.name);
  }
  return std::nullopt;
}

Json material_json(const Material& material) {
  Json object;
  put_strength(object, material);
  put(object, fields::substance, material);
  return object;
}

Json load_json(const LoadDef& load) {
  Json object;
  put(object, fields::load, load);
  return object;
}

Json section_json(const std::vector<Region>& regions) {
  Json list = Json::array();
  for (const Region& region : regions) {
    Json object;
    object["outer"] = json(region.outline.outer);
    if (!region.outline.holes.empty()) object["holes"] = json(region.outline.holes);
    put_strength(object["material"], region.material);
    list.push_back(std::move(object));
  }
  return Json{{"regions", std::move(list)}};
}

Json scene_json(const SceneDef& scene) {
  MaterialNames names;
  Json bodies = Json::array();
  for (const BodyDef& body : scene.bodies) bodies.push_back(json(body, names));

  Json object;
  put(object, fields::scene, scene);
  Json overrides;
  put_overrides(overrides, scene.joint);
  if (!overrides.empty()) object["joint"] = std::move(overrides);
  if (Json own = names.list(); !own.empty()) object["materials"] = std::move(own);
  object["bodies"] = std::move(bodies);
  put_list(object, "joints", scene.joints);
  put_list(object, "supports", scene.supports);
  put_list(object, "loads", scene.loads);
  put_list(object, "wheels", scene.wheels);
  return object;
}

std::string scene_text(const SceneDef& scene) { return printed(scene_json(scene)); }

}  // namespace ductile
