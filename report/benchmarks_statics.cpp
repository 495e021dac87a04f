// Benchmarks in equilibrium: slow simulations for what moves far, static_check() of second order for the
// rest.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "benchmark.h"
#include "ductile/design.h"
#include "ductile/simulation.h"
#include "elastica.h"

namespace ductile::report {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double length = 20, thick = 0.1, E = 210e9;              // m, Pa; 1 m deep
constexpr double EI = E * thick * thick * thick / 12;              // N m²
constexpr const char* bar = "steel bar 0.1 m × 1 m, E = 210 GPa";  // of the elastica

const Material steel{.yield_stress = 350e6, .youngs_modulus = E, .density = 7800, .damping_ratio = 1};

Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// A bar from (0, 0) along x that bends, does not stretch or shear, and that nothing touches.
BodyDef bending_bar(const std::string& name, double along, int pieces) {
  BodyDef body{.name = name,
               .outline = {rectangle(0, -thick / 2, along, thick / 2), {}},
               .material = steel,
               .pieces = pieces,
               .along = {Point{0, 0}, Point{along, 0}}};
  body.collides = false;
  return body;
}

/// Nothing weighs, nothing yields.
SceneDef elastic_scene() {
  SceneDef scene;
  scene.gravity = {};
  scene.joint = {.moment = unlimited, .axial = unlimited, .shear = unlimited};
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.joint.max_rotation = scene.joint.max_elongation = scene.joint.max_slip = unlimited;
  return scene;
}

std::size_t joint_named(const Plan& plan, const std::string& name) {
  std::size_t i = 0;
  while (plan.joints[i].name != name) ++i;
  return i;
}

/// The tip at rest, as a share of the length, under a force or a moment that grows slowly.
Point tip_at_rest(const LoadDef& load, int pieces) {
  SceneDef scene = elastic_scene();
  scene.bodies = {{.name = "wall", .type = BodyType::static_body, .outline = {rectangle(-1, -1, 0, 1), {}}},
                  bending_bar("bar", length, pieces)};
  scene.joints = {{.a = "wall", .b = "bar"}};
  scene.loads = {load};
  scene.loads[0].ramp = 30;
  Simulation simulation(calibrate(scene));
  while (simulation.time() < 90) simulation.step();
  const PieceReading last = simulation.piece(simulation.plan().pieces.size() - 1);
  const double half = length / pieces / 2;
  return {(last.position.x + half * std::cos(last.angle)) / length,
          (last.position.y + half * std::sin(last.angle)) / length};
}

void add_elastica(std::vector<Benchmark>& rows, int pieces) {
  const std::string cut = fmt::format("{}, {} m, {} pieces", bar, length, pieces);
  const Point half_circle =
      tip_at_rest({.body = "bar", .at = {length, 0}, .moment = pi * EI / length}, pieces);
  rows.push_back({"Elastica, moment at its tip", "Euler, 1744: an arc of radius EI/M", "closed form",
                  cut + "; ML/EI = π", "height of the tip over L, 2/π", 2 / pi, half_circle.y, 0.01});
  for (const double load : {1., 5., 10.}) {
    const Elastica exact = loaded_tip(load);
    const Point tip =
        tip_at_rest({.body = "bar", .at = {length, 0}, .force = {0, -load * EI / (length * length)}}, pieces);
    const std::string source = "Bisshopp and Drucker, 1945; Mattiasson, 1981, table of elliptic integrals",
                      read = "integrated here; all digits of Mattiasson's as quoted by others",
                      input = fmt::format("{}; dead load, PL²/EI = {:g}", cut, load);
    rows.push_back({"Elastica, dead load at its tip", source, read, input,
                    fmt::format("sag over L, PL²/EI = {:g}", load), -exact.y, -tip.y, 0.01});
    rows.push_back({"Elastica, dead load at its tip", source, read, input,
                    fmt::format("shortening over L, PL²/EI = {:g}", load), 1 - exact.x, 1 - tip.x, 0.01});
  }
}

/// The load that Lee's frame takes before it snaps, times L²/EI: its point under load is pushed down slowly.
double lees_limit(int pieces) {
  constexpr double L = 12;
  SceneDef scene = elastic_scene();
  BodyDef column = bending_bar("column", L, pieces), beam = bending_bar("beam", L, pieces);
  column.angle = pi / 2;
  beam.at = {0, L};
  scene.bodies = {std::move(column), std::move(beam)};
  JointBetweenDef corner{.a = "column", .b = "beam"};
  corner.across = {Point{-thick / 2, L}, Point{thick / 2, L}};
  corner.overrides.stiffness_moment = EI / (L / pieces);
  scene.joints = {corner};
  scene.supports = {
      {.body = "column", .at = {0, 0}, .fix_x = true, .fix_y = true},
      {.body = "beam", .at = {L, L}, .fix_x = true, .fix_y = true},
      {.body = "beam", .at = {0.2 * L, L}, .fix_y = true, .displacement = {0, -0.6 * L, 0}, .ramp = 240}};
  Simulation simulation(calibrate(scene));
  const std::size_t pusher = joint_named(simulation.plan(), "support/2");
  double most = 0;
  while (simulation.time() < 240) {
    simulation.step();
    most = std::max(most, std::abs(simulation.joint(pusher).Q));
  }
  return most * L * L / EI;
}

/// Haythornthwaite's beam: rigid-plastic, built in at both ends, pushed down in its middle by w times its
/// height; the force over the collapse load of bending, 8 M_p/L.
std::vector<double> membrane_action(const std::vector<double>& displacements) {
  constexpr double L = 40, H = 1, fy = 350e6;
  SceneDef scene;
  scene.gravity = {};
  scene.interaction = true;
  scene.joint.shear = unlimited;
  scene.joint.max_rotation = scene.joint.max_elongation = scene.joint.max_slip = unlimited;
  BodyDef beam{.name = "beam",
               .outline = {rectangle(0, -H / 2, L, H / 2), {}},
               .material = Material{.yield_stress = fy, .density = 7800},
               .pieces = 2,
               .along = {Point{0, 0}, Point{L, 0}}};
  scene.bodies = {
      {.name = "left", .type = BodyType::static_body, .outline = {rectangle(-1, -2, 0, 2), {}}},
      {.name = "right", .type = BodyType::static_body, .outline = {rectangle(L, -2, L + 1, 2), {}}},
      std::move(beam)};
  scene.joints = {{.a = "left", .b = "beam"}, {.a = "beam", .b = "right"}};
  const double most = displacements.back(), seconds = 60;
  scene.supports = {
      {.body = "beam", .at = {L / 2, 0}, .fix_y = true, .displacement = {0, -most * H, 0}, .ramp = seconds}};
  Simulation simulation(calibrate(scene));
  const std::size_t pusher = joint_named(simulation.plan(), "support/0");
  std::vector<double> forces;
  for (const double w : displacements) {
    while (simulation.time() < seconds * w / most) simulation.step();
    forces.push_back(std::abs(simulation.joint(pusher).Q) / (8 * fy * H * H / 4 / L));
  }
  return forces;
}

// --- the two benchmark problems of AISC 360, commentary to C2 ---

constexpr double inch = 0.0254, kip = 4448.2216;  // m, N

struct BeamColumn {
  static constexpr double L = 336 * inch, h = 13.8 * inch, I = 484 * inch * inch * inch * inch,
                          ksi = kip / (inch * inch);
  static constexpr int pieces = 40;
  bool cantilever;  // case 2, with 1 kip at its tip; else case 1, on two pins, with 0.2 kip/ft
  double axial;     // N

  struct Answer {
    double moment, deflection;  // N m, m: in the middle of case 1, at foot and tip of case 2
  };
  Answer run() const {
    SceneDef scene = elastic_scene();
    const double l = L / pieces;
    BodyDef column{
        .name = "column",
        .outline = {rectangle(0, -h / 2, L, h / 2), {}},
        .material = Material{.yield_stress = 50 * ksi, .youngs_modulus = 29000 * ksi, .density = 7850},
        .depth = 12 * I / (h * h * h),
        .pieces = pieces,
        .along = {Point{0, 0}, Point{L, 0}}};
    column.collides = false;
    scene.bodies = {std::move(column)};
    scene.supports = {
        {.body = "column", .at = {0, 0}, .fix_x = true, .fix_y = true, .fix_angle = cantilever}};
    if (!cantilever) scene.supports.push_back({.body = "column", .at = {L, 0}, .fix_y = true});
    scene.loads = {{.body = "column", .at = {L, 0}, .force = {-axial, cantilever ? -kip : 0}}};
    for (int i = 0; i < pieces && !cantilever; ++i)
      scene.loads.push_back(
          {.body = "column", .at = {(i + 0.5) * l, 0}, .force = {0, -0.2 * kip / (12 * inch) * l}});
    const Plan plan = calibrate(scene);
    const StaticCheck check = static_check(plan, Order::second);
    // From the middle of the piece left of the place, and its turn.
    const std::size_t left = cantilever ? pieces - 1 : pieces / 2 - 1;
    const double down = -(check.displacement[left].y + check.turn[left] * l / 2);
    const auto at = joint_named(plan, cantilever ? "support/0" : "column/19-column/20");
    return {std::abs(check.joints[at].M), down};
  }
};

void add_beam_columns(std::vector<Benchmark>& rows) {
  struct Row {
    bool cantilever;
    double axial, moment, deflection;  // kip, kip in, in: without shear, the bracketed values
  };
  for (const Row& row :
       {Row{false, 150, 269, 0.224}, Row{false, 300, 313, 0.261}, Row{false, 450, 375, 0.311},
        Row{true, 100, 469, 1.33}, Row{true, 150, 598, 1.75}, Row{true, 200, 848, 2.56}}) {
    const auto [moment, deflection] = BeamColumn{row.cantilever, row.axial * kip}.run();
    const std::string name = fmt::format("AISC 360 benchmark, case {}", row.cantilever ? 2 : 1),
                      source =
                          fmt::format("AISC 360-16, commentary C2, fig. C-C2.{}", row.cantilever ? 3 : 2),
                      read = "quoted by others; three digits, without shear",
                      input = fmt::format(
                          "W14x48 (I = 484 in⁴), E = 29 000 ksi, 28 ft, {}; P = {:g} kip; 40 pieces",
                          row.cantilever ? "cantilever, 1 kip across its tip"
                                         : "on two pins, 0.2 kip/ft across",
                          row.axial);
    rows.push_back({name, source, read, input, fmt::format("moment at P = {:g} kip [kip in]", row.axial),
                    row.moment, moment / (kip * inch), 0.01});
    rows.push_back({name, source, read, input, fmt::format("deflection at P = {:g} kip [in]", row.axial),
                    row.deflection, deflection / inch, 0.01});
  }
}

}  // namespace

std::vector<Benchmark> static_benchmarks(const Context& context) {
  std::vector<Benchmark> rows;
  const int pieces = context.quick ? 20 : 40;
  add_elastica(rows, pieces);
  context.progress(0.2);
  rows.push_back({"Lee's frame", "Lee, Manuel and Rossow, 1968 (18.55)", "integrated here; not read",
                  fmt::format("two bars of L = 12 m, {}, pins at their far ends, pushed down at 0.2 L from "
                              "the corner; {} pieces each",
                              bar, pieces),
                  "limit load, PL²/EI", lees_limit_load(), lees_limit(pieces), 0.01});
  context.progress(0.4);
  const std::vector<double> pushed{0.5, 1, 1.5};
  const std::vector<double> forces = membrane_action(pushed);
  for (std::size_t i = 0; i < pushed.size(); ++i) {
    const double w = pushed[i];
    rows.push_back(
        {"Built-in beam that hangs as a rope",
         "Haythornthwaite, 1957; Jones, Structural Impact: 1 + (w/h)², then 2 w/h", "closed form; not read",
         "rigid-plastic, 40 m × 1 m, f_y = 350 MPa, N and M on the surface; 2 pieces",
         fmt::format("P over 8 M_p/L at w = {:g} h", w), w <= 1 ? 1 + w * w : 2 * w, forces[i], 0.01});
  }
  add_beam_columns(rows);
  return rows;
}

}  // namespace ductile::report
