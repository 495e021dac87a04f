// The right side of the desk, to change: a body's material and shape, the limits of the joint in focus.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "desk.h"
#include "prices.h"
#include "quantity.h"
#include "rows.h"
#include "sizing.h"

namespace ductile::viewer {

void Desk::commit(bool changed, SceneDef scene) {
  if (!changed) return;
  try {
    bench_.edit(std::move(scene), edited_ && ImGui::IsItemActive());
    edited_ = true;
  } catch (const InvalidInput& error) {
    bench_.message = "This cannot be.\n" + std::string(error.what());
  }
}

void Desk::edit() {
  if (!bench_.editable()) return ImGui::TextWrapped("A level is edited in the editor that it comes from.");
  SceneDef scene = bench_.scene();
  const Plan& plan = bench_.plan();
  // The body that was clicked on, or else the one of the joint in focus.
  std::size_t at = bench_.body.value_or(0);
  if (!bench_.body && bench_.focus) {
    at = static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(plan.joints[*bench_.focus].b)].body);
  }
  at = std::min(at, scene.bodies.size() - 1);
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.52f);
  if (ImGui::BeginCombo("body", scene.bodies[at].name.c_str())) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (ImGui::Selectable(scene.bodies[i].name.c_str(), i == at)) bench_.body = at = i;
    }
    ImGui::EndCombo();
  }
  tip("body", "Which body is edited; a click on one in the scene chooses it too.");
  BodyDef& body = scene.bodies[at];
  body_type(scene, body);
  material(scene, body);
  if (axis_of(body)) {
    beam_section(scene, body);
  } else if (body.profile.empty()) {
    const bool changed = slide("depth", body.depth, 1e-4, 100, "%.4g m");
    tip("depth", "Of the body, out of the plane.");
    commit(changed, scene);
  }
  if (body.cuts.empty() && !body.automatic && body.circle == 0) {
    const bool changed = ImGui::SliderInt("pieces", &body.pieces, 1, 60, "%d", ImGuiSliderFlags_AlwaysClamp);
    tip("pieces", "Into how many equal pieces the body is split.");
    commit(changed, scene);
  } else if (!body.cuts.empty()) {
    const bool whole = button("No cuts", "no cuts", "Takes its cuts away.");
    ImGui::SameLine();
    ImGui::Text("%zu cuts", body.cuts.size());
    if (whole) body.cuts.clear();
    commit(whole, scene);
  }
  size_for_reserve(scene.bodies[at]);
  ImGui::Separator();
  limits(scene);
  ImGui::PopItemWidth();
}

void Desk::body_type(SceneDef& scene, BodyDef& body) {
  int type = static_cast<int>(body.type);
  if (!choose("type", "Whether it stands still, moves, or goes its way whatever hits it.", type,
              {"stands still", "moves", "goes its way"}))
    return;
  body.type = static_cast<BodyType>(type);
  if (!body.material) body.material = materials::S355;
  commit(true, scene);
}

// What carries the loads with something to spare.
void Desk::size_for_reserve(const BodyDef& body) {
  if (body.type != BodyType::dynamic_body) return;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.3f);
  slide("##reserve", reserve_, 0.1, 100, "%.3g times");
  tip("reserve", "The factor on all loads that is to bring the first joint to yield.");
  ImGui::SameLine();
  if (!button("Size for it", "size for reserve",
              "Gives the body the depth with which that factor on all loads is the first to make anything "
              "yield; one with a rolled profile, the lightest of its series that bears it."))
    return;
  attempt(bench_, [&] {
    Sized sized = with_reserve(bench_.scene(), body.name, reserve_);
    bench_.edit(std::move(sized.scene));
    tell(sized.what);
  });
}

void Desk::beam_section(const SceneDef& scene, const BodyDef& beam) {
  BeamStyle style = style_of(beam);
  if (section_style(style)) attempt(bench_, [&] { commit(true, with_style(scene, beam.name, style)); });
}

void Desk::material(SceneDef& scene, BodyDef& body) {
  if (!body.material) return;
  const auto is_now = [&](bool changed) {
    if (changed && !body.profile_name.empty()) body.profile.front().material = *body.material;
    commit(changed, scene);
  };
  Material& material = *body.material;
  const bool other = choose_material(material);
  if (other) body.price = price_of(bench_.scene(), material);
  tip("material", "A built-in material, or its own by the values below.");
  is_now(other);
  struct Value {
    const char *label, *name, *text, *format;
    double Material::*of;
    double low, high, unit;
  };
  static constexpr std::array values{
      Value{"yield stress", "yield stress", "f_y: at which stress it flows.", "%.4g MPa",
            &Material::yield_stress, 0.1, 5000, 1e6},
      Value{"E", "E", "Young's modulus; 0: not known, joints are rigid.", "%.4g GPa",
            &Material::youngs_modulus, 0, 1000, 1e9},
      Value{"density", "density", "Mass over volume.", "%.4g kg/m³", &Material::density, 1, 30000, 1},
      Value{"fracture strain", "fracture strain",
            "Engineering strain at rupture: how far hinges turn before they break.", "%.4g",
            &Material::fracture_strain, 0, 2, 1}};
  for (const Value& value : values) {
    double shown = material.*value.of / value.unit;
    const bool changed = slide(value.label, shown, value.low, value.high, value.format);
    tip(value.name, value.text);
    if (changed) material.*value.of = shown * value.unit;
    is_now(changed);
  }
}

// The overrides of the joint in focus, and what its capacities have become.
void Desk::limits(SceneDef& scene) {
  if (!bench_.focus) {
    ImGui::TextWrapped("Select a joint to change its limits.");
    return;
  }
  const std::size_t i = *bench_.focus;
  const PlannedJoint planned = bench_.plan().joints[i];
  const auto governing = limits_of(scene, bench_.plan(), i);
  if (!governing) {
    ImGui::TextWrapped("A support holds whatever comes.");
    return;
  }
  JointOverrides& overrides = *governing->overrides;
  ImGui::Text("Limits of %s", governing->of.c_str());
  struct Limit {
    const char *label, *name, *text, *format;
    std::optional<double> JointOverrides::*of;
    double now, low, high;
  };
  const std::array limits{
      Limit{"moment", "limit moment", "Plastic moment in both senses, instead of the section's.", "%.4g N m",
            &JointOverrides::moment, planned.M, 1, 1e10},
      Limit{"axial", "limit axial", "Greatest axial force in both senses.", "%.4g N", &JointOverrides::axial,
            planned.N, 1, 1e11},
      Limit{"shear", "limit shear", "Greatest shear force.", "%.4g N", &JointOverrides::shear, planned.Q, 1,
            1e11},
      Limit{"max. rotation", "limit rotation", "Accumulated plastic rotation at which it breaks.", "%.4g rad",
            &JointOverrides::max_rotation, planned.max_rotation, 1e-4, 100},
      Limit{"max. elongation", "limit elongation", "Accumulated plastic lengthening at which it breaks.",
            "%.4g m", &JointOverrides::max_elongation, planned.max_elongation, 1e-5, 100},
      Limit{"max. compression", "limit compression", "Accumulated plastic shortening at which it breaks.",
            "%.4g m", &JointOverrides::max_compression, planned.max_compression, 1e-5, 100},
      Limit{"max. slip", "limit slip", "Accumulated plastic shear at which it breaks.", "%.4g m",
            &JointOverrides::max_slip, planned.max_slip, 1e-5, 100}};
  for (const Limit& limit : limits) {
    std::optional<double>& value = overrides.*limit.of;
    bool own = value.has_value();
    ImGui::PushID(limit.label);
    bool changed = ImGui::Checkbox("##own", &own);
    tip((std::string("own ") + limit.name).c_str(), "Its own value instead of that of section and material.");
    if (changed)
      value = own ? std::optional(std::isfinite(limit.now) && limit.now > 0 ? limit.now : limit.high)
                  : std::nullopt;
    commit(changed, scene);
    ImGui::SameLine();
    ImGui::BeginDisabled(!own);
    double shown = value.value_or(limit.now);
    changed = slide(limit.label, shown, limit.low, limit.high, limit.format);
    tip(limit.name, limit.text);
    if (changed) value = shown;
    commit(changed && own, scene);
    ImGui::EndDisabled();
    ImGui::PopID();
  }
  ImGui::Separator();
  // Before the edits: found by name, since pieces may be others.
  const auto& before = bench_.plan_before().joints;
  const auto old = std::find_if(before.begin(), before.end(),
                                [&](const PlannedJoint& j) { return j.name == planned.name; });
  ImGui::Text("%s", planned.name.c_str());
  if (!ImGui::BeginTable("capacities", 3, table_flags)) return;
  ImGui::TableSetupColumn("capacity");
  ImGui::TableSetupColumn("saved");
  ImGui::TableSetupColumn("now");
  ImGui::TableHeadersRow();
  const auto compare = [&](const char* name, double PlannedJoint::*of, const char* unit) {
    row(name, {old != before.end() ? si((*old).*of, unit) : "–", si(planned.*of, unit)});
  };
  compare("N", &PlannedJoint::N, "N");
  compare("N compression", &PlannedJoint::Nc, "N");
  compare("Q", &PlannedJoint::Q, "N");
  compare("M", &PlannedJoint::M, "N m");
  compare("M reverse", &PlannedJoint::M_reverse, "N m");
  compare("max. rotation", &PlannedJoint::max_rotation, "rad");
  compare("max. elongation", &PlannedJoint::max_elongation, "m");
  compare("max. compression", &PlannedJoint::max_compression, "m");
  compare("max. slip", &PlannedJoint::max_slip, "m");
  ImGui::EndTable();
}

}  // namespace ductile::viewer
