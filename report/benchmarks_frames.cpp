// Benchmarks of frames and arches: least weight, buckling, thrust and collapse.
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "benchmark.h"
#include "ductile/design.h"
#include "ductile/targets.h"

namespace ductile::report {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double thick = 0.1, E = 210e9, fy = 350e6, density = 7800;  // m, Pa, kg/m³; 1 m deep
constexpr double EI = E * thick * thick * thick / 12, M_p = fy * thick * thick / 4;

const Material steel{.yield_stress = fy, .youngs_modulus = E, .density = density};

/// Nothing weighs, and bending alone yields.
SceneDef bending_only() {
  SceneDef scene;
  scene.gravity = {};
  scene.joint.axial = scene.joint.shear = unlimited;
  scene.joint.max_rotation = unlimited;
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  return scene;
}

/// A bar on its centre line, cut so far from its start, m.
BodyDef member(const std::string& name, Point from, Point to, const std::vector<double>& cuts) {
  const double along = std::hypot(to.x - from.x, to.y - from.y), half = thick / 2;
  BodyDef body{.name = name,
               .outline = {{{0, -half}, {along, -half}, {along, half}, {0, half}}, {}},
               .material = steel};
  body.at = from;
  body.angle = std::atan2(to.y - from.y, to.x - from.x);
  for (const double x : cuts) body.cuts.push_back({Point{x, -thick}, Point{x, thick}});
  return body;
}
std::vector<double> even(double along, int pieces) {
  std::vector<double> cuts;
  for (int i = 1; i < pieces; ++i) cuts.push_back(along * i / pieces);
  return cuts;
}

/// Columns "left" and "right" of height h, and a girder of span l, stiffly joined.
SceneDef portal(double h, double l, const std::vector<double>& column, const std::vector<double>& girder) {
  SceneDef scene = bending_only();
  scene.bodies = {member("left", {0, 0}, {0, h}, column), member("right", {l, 0}, {l, h}, column),
                  member("girder", {0, h}, {l, h}, girder)};
  for (const double x : {0., l}) {
    JointBetweenDef corner{.a = x == 0 ? "left" : "right", .b = "girder", .at = Point{x, h}};
    corner.overrides.moment = unlimited;
    scene.joints.push_back(corner);
  }
  return scene;
}

/// Plastic moment times length, summed over the members, of the lightest portal that bears H at its girder
/// and V on it: hinges may form at fixed feet, at the corners and under V.
double least_weight(double h, double l, double H, double V, double along, bool right_fixed,
                    const std::vector<std::vector<std::size_t>>& groups) {
  constexpr double unit = 1e5, end = 1e-6;  // N m, m
  SceneDef scene = portal(h, l, {h - end}, {end, along * l, l - end});
  scene.bodies.push_back({.name = "floor",
                          .type = BodyType::static_body,
                          .outline = {{{-1, -1}, {l + 1, -1}, {l + 1, 0}, {-1, 0}}, {}}});
  JointBetweenDef left{.a = "floor", .b = "left"}, right{.a = "floor", .b = "right"};
  if (!right_fixed) right.overrides.moment = 0;
  scene.joints.push_back(left);
  scene.joints.push_back(right);
  scene.loads = {{.body = "girder", .at = {along * l, h}, .force = {0, -V * unit}},
                 {.body = "girder", .at = {0, h}, .force = {H * unit, 0}}};
  const double mass = least_mass(scene, groups, 1).mass;
  return mass / (density * thick) * M_p / unit;
}

/// P h²/EI under which a portal on pins sways, P on both columns.
double sway_load(double h, double l, int pieces) {
  SceneDef scene = portal(h, l, even(h, pieces), even(l, pieces));
  for (const char* column : {"left", "right"}) {
    const double x = scene.bodies[column == std::string("left") ? 0 : 1].at.x;
    scene.supports.push_back({.body = column, .at = {x, 0}, .fix_x = true, .fix_y = true});
    scene.loads.push_back({.body = column, .at = {x, h}, .force = {0, -1}});
  }
  return critical_load(calibrate(scene)).factor * h * h / EI;
}
/// φ² with φ tan φ = 6 h/l.
double exact_sway_load(double h, double l) {
  double low = 0, high = pi / 2;
  for (int i = 0; i < 100; ++i) {
    const double phi = (low + high) / 2;
    (phi * std::tan(phi) < 6 * h / l ? low : high) = phi;
  }
  return low * low;
}

/// A half circle on two pins, 1 N on its crown.
SceneDef arch(double R, int pieces) {
  const auto at = [&](double r, int i) {
    return Point{r * std::cos(pi * i / pieces), r * std::sin(pi * i / pieces)};
  };
  SceneDef scene = bending_only();
  BodyDef body{.name = "arch", .material = steel};
  for (int i = 0; i <= pieces; ++i) body.outline.outer.push_back(at(R + thick / 2, i));
  for (int i = pieces; i >= 0; --i) body.outline.outer.push_back(at(R - thick / 2, i));
  for (int i = 1; i < pieces; ++i) body.cuts.push_back({at(R - thick, i), at(R + thick, i)});
  scene.bodies = {std::move(body)};
  for (const double x : {R, -R})
    scene.supports.push_back({.body = "arch", .at = {x, 0}, .fix_x = true, .fix_y = true});
  scene.loads = {{.body = "arch", .at = {0, R}, .force = {0, -1}}};
  return scene;
}

}  // namespace

std::vector<Benchmark> frame_benchmarks() {
  std::vector<Benchmark> rows;
  rows.push_back(
      {"Portal of least weight, one foot on a pin",
       "Jirásek and Bažant, Inelastic Analysis of Structures, 2002, example 12.5, table 12.5",
       "its program and solution, on a page of an author's; the frame follows from the program",
       "columns of 2, a span of 3, 1 across at the beam, 3 on it at 2/3 of the span; three plastic moments",
       "least Σ M_p L", 78. / 11, least_weight(2, 3, 1, 3, 2. / 3, false, {{0}, {1}, {2}}), 1e-4});
  rows.push_back({"Portal of least weight, fixed feet",
                  "Rao, Engineering Optimization, 2009, section 3.2, (E1) and (E2)",
                  "a copy of the page; solved here, M_b = 5 and M_c = 7",
                  "columns of 8 alike, a span of 20, 3 across at the beam, 1 in its middle", "least Σ M_p L",
                  212, least_weight(8, 20, 3, 1, 0.5, true, {{0, 1}, {2}}), 1e-4});
  rows.push_back({"Portal that sways",
                  "Timoshenko and Gere, Theory of Elastic Stability, 1961, 2.4: φ tan φ = 6 h/l",
                  "closed form; not read",
                  "on pins, h = 8 m, l = 10 m, members alike, 20 pieces each, P on both columns",
                  "critical Ph²/EI", exact_sway_load(8, 10), sway_load(8, 10, 20), 0.001});
  constexpr double R = 10;
  const Plan plan = calibrate(arch(R, 48));
  const std::string input = "half circle of 10 m, 0.1 m × 1 m, on two pins, P on its crown, 48 pieces";
  rows.push_back({"Arch on two pins", "closed form: ∫ M ∂M/∂H ds = 0, 1/π", "closed form", input,
                  "thrust over P", 1 / pi, std::abs(static_check(plan).joints.back().N), 0.002});
  rows.push_back({"Arch on two pins", "closed form: hinges in the crown and where tan θ = 2H/P, H = 3P/8",
                  "closed form", input, "collapse load PR/M_p", 8, limit_analysis(plan).load_factor * R / M_p,
                  0.002});
  return rows;
}

}  // namespace ductile::report
