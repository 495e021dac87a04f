// What EN 1993 says of a scene's profiles: their classes, and what is left of those that buckle locally.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "command.h"
#include "ductile/rolled.h"

namespace ductile::tool {

namespace {

struct ProfileClass {
  const BodyDef* body;
  Classes classes;
  double A_eff, N_eff;  // m², N; NaN where no rule gives them
};

std::vector<ProfileClass> profile_classes(const Plan& plan) {
  std::vector<ProfileClass> all;
  for (const BodyDef& body : plan.bodies) {
    if (body.profile_name.empty() || !is_steel(body.profile.front().material)) continue;
    const Rolled profile = rolled(body.profile_name);
    const Material& material = body.profile.front().material;
    const double A_eff = effective_area(profile, material.yield_stress);
    all.push_back(
        {&body, section_class(profile, material.yield_stress), A_eff, A_eff * material.compression()});
  }
  return all;
}

}  // namespace

bool is_steel(const Material& material) { return std::abs(material.youngs_modulus / 210e9 - 1) < 0.1; }

std::string profile_lines(const Plan& plan) {
  std::string text;
  for (const auto& [body, classes, A_eff, N_eff] : profile_classes(plan)) {
    text += fmt::format("{}: {}, class {} in compression, {} in bending (EN 1993-1-1 Table 5.2)\n",
                        body->name, body->profile_name, classes.compression, classes.bending_y);
    if (classes.compression == 4)
      text += std::isfinite(A_eff)
                  ? fmt::format(
                        "  it buckles locally at N = {:.6g} N, A_eff f_y (EN 1993-1-5 4.4), which Nc leaves "
                        "out\n",
                        -N_eff)
                  : "  it buckles locally before Nc; a shell of class 4 is for EN 1993-1-6\n";
    if (classes.bending_y > 2)
      text += fmt::format("  it buckles locally before M; its first fibre is {}\n",
                          classes.bending_y == 3 ? "what to design with" : "not reached either");
  }
  return text;
}

Json profiles_json(const Plan& plan) {
  Json list = Json::array();
  for (const auto& [body, classes, A_eff, N_eff] : profile_classes(plan))
    list.push_back({{"body", body->name},
                    {"profile", body->profile_name},
                    {"class", {{"compression", classes.compression}, {"bending", classes.bending_y}}},
                    {"A_eff", number(A_eff)}});
  return list;
}

}  // namespace ductile::tool
