#include <cmath>
#include <nlohmann/json.hpp>

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
/// A cap or a maximum: null is unlimited.
Json limit(double value) { return std::isinf(value) ? Json(nullptr) : Json(value); }

/// Writes a key only where its value is not the default: what the author did not say stays unsaid.
template <class T>
void put(Json& object, const char* key, const T& value, const T& standard) {
  if (!(value == standard)) object[key] = value;
}
void put(Json& object, const char* key, const Point& value, const Point& standard) {
  if (!(value == standard)) object[key] = json(value);
}
void put_limit(Json& object, const char* key, const std::optional<double>& value) {
  if (value) object[key] = limit(*value);
}

void put_strength(Json& object, const Material& material) {
  const Material standard;
  object["fy"] = material.yield_stress;
  put(object, "fyc", material.yield_stress_compression, standard.yield_stress_compression);
  put(object, "tau", material.shear_yield_stress, standard.shear_yield_stress);
  put(object, "E", material.youngs_modulus, standard.youngs_modulus);
  if (material.criterion == Criterion::von_mises) object["criterion"] = "von_mises";
}

/// Names the materials of a scene: built-in ones by their own name, others "material 1", "material 2"…
class MaterialNames {
 public:
  std::string name(const Material& material) {
    for (const NamedMaterial& known : materials::all()) {
      if (known.material == material) return std::string(known.name);
    }
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
  put_limit(object, "moment", overrides.moment);
  put_limit(object, "moment_reverse", overrides.moment_reverse);
  put_limit(object, "axial", overrides.axial);
  put_limit(object, "axial_compression", overrides.axial_compression);
  put_limit(object, "shear", overrides.shear);
  if (overrides.elastic == Elasticity::true_stiffness) object["elastic"] = "true";
  if (overrides.elastic == Elasticity::rigid) object["elastic"] = "rigid";
  if (overrides.elastic == Elasticity::frequency || overrides.elastic == Elasticity::elastic_rotation) {
    Json& elastic = object["elastic"];
    put(elastic, "frequency", overrides.frequency, 0.0);
    put_limit(elastic, "damping_ratio", overrides.damping_ratio);
    put(elastic, "elastic_rotation", overrides.elastic_rotation, 0.0);
  }
  put_limit(object, "max_rotation", overrides.max_rotation);
  put_limit(object, "max_elongation", overrides.max_elongation);
  put_limit(object, "max_compression", overrides.max_compression);
  put_limit(object, "max_slip", overrides.max_slip);
  put_limit(object, "hinge_length", overrides.hinge_length);
  if (overrides.shear_span && !overrides.hinge_length)
    object["hinge_length"] = {{"shear_span", *overrides.shear_span}};
  if (overrides.combine) object["combine"] = *overrides.combine;
  if (overrides.hold) object["hold"] = *overrides.hold;
}

Json json(const BodyDef& body, MaterialNames& names) {
  const BodyDef standard;
  Json object;
  object["name"] = body.name;
  if (body.type == BodyType::static_body) object["type"] = "static";
  if (body.type == BodyType::kinematic_body) object["type"] = "kinematic";
  object["outline"] = body.circle > 0 ? Json{{"circle", body.circle}} : json(body.outline.outer);
  if (!body.outline.holes.empty()) object["holes"] = json(body.outline.holes);
  put(object, "at", body.at, standard.at);
  put(object, "angle", body.angle, standard.angle);
  put(object, "velocity", body.velocity, standard.velocity);
  put(object, "angular_velocity", body.angular_velocity, standard.angular_velocity);
  if (body.material) object["material"] = names.name(*body.material);
  if (body.profile.empty()) {
    put(object, "depth", body.depth, standard.depth);
  } else {
    object["profile"] = section_json(body.profile);
  }
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
  put(object, "group", body.group, standard.group);
  return object;
}

Json json(const JointBetweenDef& joint) {
  Json object;
  object["between"] = {joint.a, joint.b};
  put(object, "gap", joint.gap, 0.0);
  put_overrides(object, joint.overrides);
  return object;
}

Json json(const SupportDef& support) {
  Json object;
  object["body"] = support.body;
  object["at"] = json(support.at);
  object["fix"] = Json::array();
  if (support.fix_x) object["fix"].push_back("x");
  if (support.fix_y) object["fix"].push_back("y");
  if (support.fix_angle) object["fix"].push_back("angle");
  return object;
}

Json json(const LoadDef& load) {
  const LoadDef standard;
  Json object;
  object["body"] = load.body;
  object["at"] = json(load.at);
  put(object, "force", load.force, standard.force);
  put(object, "moment", load.moment, standard.moment);
  put(object, "from", load.from, standard.from);
  put(object, "ramp", load.ramp, standard.ramp);
  put(object, "to", load.to, standard.to);
  return object;
}

Json json(const WheelDef& wheel) {
  const WheelDef standard;
  Json object;
  object["between"] = {wheel.chassis, wheel.wheel};
  object["at"] = json(wheel.at);
  put(object, "axis", wheel.axis, standard.axis);
  put(object, "frequency", wheel.frequency, standard.frequency);
  put(object, "damping_ratio", wheel.damping_ratio, standard.damping_ratio);
  put(object, "motor_speed", wheel.motor_speed, standard.motor_speed);
  put(object, "motor_torque", wheel.motor_torque, standard.motor_torque);
  return object;
}

template <class T>
void put_list(Json& scene, const char* key, const std::vector<T>& list) {
  for (const T& element : list) scene[key].push_back(json(element));
}

}  // namespace

Json material_json(const Material& material) {
  const Material standard;
  Json object;
  object["density"] = material.density;
  put_strength(object, material);
  put(object, "fu", material.ultimate_stress, standard.ultimate_stress);
  put(object, "fracture_strain", material.fracture_strain, standard.fracture_strain);
  put(object, "damping_ratio", material.damping_ratio, standard.damping_ratio);
  put(object, "friction", material.friction, standard.friction);
  put(object, "restitution", material.restitution, standard.restitution);
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

std::string scene_text(const SceneDef& scene) {
  const SceneDef standard;
  MaterialNames names;
  Json bodies = Json::array();
  for (const BodyDef& body : scene.bodies) bodies.push_back(json(body, names));

  Json object;
  put(object, "gravity", scene.gravity, standard.gravity);
  put(object, "gravity_ramp", scene.gravity_ramp, standard.gravity_ramp);
  put(object, "sleep", scene.sleep, standard.sleep);
  put(object, "interaction", scene.interaction, standard.interaction);
  Json overrides;
  put_overrides(overrides, scene.joint);
  if (!overrides.empty()) object["joint"] = std::move(overrides);
  if (Json own = names.list(); !own.empty()) object["materials"] = std::move(own);
  object["bodies"] = std::move(bodies);
  put_list(object, "joints", scene.joints);
  put_list(object, "supports", scene.supports);
  put_list(object, "loads", scene.loads);
  put_list(object, "wheels", scene.wheels);
  return printed(object);
}

}  // namespace ductile
