// The names of custom properties. What begins with "ductile." and is none of them is a slip of the pen: to
// leave it alone, as all that is not understood, would leave the designer with a joint that has other values.
#include <initializer_list>
#include <iterator>
#include <set>
#include <string>
#include <tuple>

#include "ductile/fields.h"
#include "rube_reader.h"

namespace ductile::rube {
namespace {

using Names = std::set<std::string>;

template <class... Fields>
void add(Names& names, const std::tuple<Fields...>& table, const std::string& prefix = "") {
  fields::for_each(table, [&](const auto& field) { names.insert(prefix + field.key); });
}

Names of_bodies() {
  Names names{"material", "criterion", "depth", "profile", "pieces", "outline", "loads", "ground"};
  add(names, fields::strength);
  add(names, fields::substance);
  for (const char* of_fixtures : {"friction", "restitution"}) names.erase(of_fixtures);
  return names;
}

Names of_joints() {
  Names names{"calibrate", "axis", "governed_by", "shear_span", rate_exponent};
  names.insert(std::begin(doubling_rates), std::end(doubling_rates));
  add(names, fields::joint);
  add(names, fields::overrides);
  add(names, fields::calibrated);
  add(names, fields::stiffness, "stiffness_");
  return names;
}

void refuse_all_but(const Names& known, const Item& item, const char* whose) {
  constexpr std::string_view prefix = "ductile.";
  Names given;
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  for (const Value& property : item.list("customProperties")) {
    if (!property.json().is_object()) continue;
    const std::string name = property.json().value("name", Json()).dump();  // in quotes
    if (!std::string_view(name).substr(1).starts_with(prefix)) continue;
    if (!given.insert(name).second) property.wrong("is " + name + " once more", "keep one of them");
    if (known.contains(name.substr(1 + prefix.size(), name.size() - prefix.size() - 2))) continue;
    property.wrong("is " + name + ", which no " + whose + " has",
                   known.empty() ? "give it to the body" : "write \"ductile.\" and one of: " + list);
  }
}

}  // namespace

void refuse_unknown_properties(const Item& scene) {
  refuse_all_but({"gravity_ramp", "interaction", "target_error"}, scene, "world");
  const Names bodies = of_bodies(), joints = of_joints();
  for (const Value& body : scene.list("body")) {
    refuse_all_but(bodies, Item(body), "body");
    for (const Value& fixture : Item(body).list("fixture")) refuse_all_but({}, Item(fixture), "fixture");
  }
  for (const Value& joint : scene.list("joint")) refuse_all_but(joints, Item(joint), "joint");
}

}  // namespace ductile::rube
