// Benchmarks in equilibrium: slow simulations for what moves far, static_check() of second order for the
// rest.
#include <fmt/format.h>

#include <algorithm>
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
    const std::string
        source = "Bisshopp and Drucker, 1945; Mattiasson, 1981, table of elliptic integrals",
        read = "integrated here; Mattiasson's 0.81061 and 0.55500 at PL²/EI = 10 as quoted by others",
        input = fmt::format("{}; dead load, PL²/EI = {:g}", cut, load);
    rows.push_back({"Elastica, dead load at its tip", source, read, input,
                    fmt::format("sag over L, PL²/EI = {:g}", load), -exact.y, -tip.y, 0.01});
    rows.push_back({"Elastica, dead load at its tip", source, read, input,
                    fmt::format("shortening over L, PL²/EI = {:g}", load), 1 - exact.x, 1 - tip.x, 0.01});
  }
}

/// The most that a support that moves resists with, up to a time.
double largest_push(const SceneDef& scene, const char* support, double until) {
  Simulation simulation(calibrate(scene));
  const std::size_t pusher = joint_named(simulation.plan(), support);
  double most = 0;
  while (simulation.time() < until) {
    simulation.step();
    most = std::max(most, std::abs(simulation.joint(pusher).Q));
  }
  return most;
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
      {.body = "beam", .at = {0.2 * L, L}, .fix_y = true, .displacement = {0, -0.48 * L, 0}, .ramp = 240}};
  return largest_push(scene, "support/2", 240) * L * L / EI;
}

// Williams' toggle, an inch being a metre and 1 psi 1 kPa, so that loads are those of aluminium in lb times
// 1000.
struct Toggle {
  static constexpr double span = 12.943, rise = 0.386, b = 0.753, h = 0.243, E = 10.3e9;
  static constexpr double bending = E * b * h * h * h / 12, stretching = E * b * h;

  static double exact() {
    return williams_limit_load(rise / span, stretching * span * span / bending) * bending / (span * span);
  }
  /// The largest force on the crown as it is pushed down slowly.
  static double limit(int pieces) {
    SceneDef scene = elastic_scene();
    scene.joint.stiffness_axial.reset();
    const double slope = std::atan(rise / span), along = std::hypot(span, rise), l = along / pieces;
    const auto half = [&](const char* name, Point at, double angle) {
      BodyDef body = bending_bar(name, along, pieces);
      body.outline = {rectangle(0, -h / 2, along, h / 2), {}};
      body.depth = b;
      body.material->youngs_modulus = E;
      body.at = at;
      body.angle = angle;
      return body;
    };
    const auto wall = [](const char* name, double from) {
      return BodyDef{
          .name = name, .type = BodyType::static_body, .outline = {rectangle(from, -1, from + 1, 1), {}}};
    };
    scene.bodies = {wall("foot", -1), half("left", {0, 0}, slope), half("right", {span, rise}, -slope),
                    wall("other foot", 2 * span)};
    const auto join = [&](const char* a, const char* b, double x, double y, double over) {
      JointBetweenDef joint{.a = a, .b = b};
      joint.across = {Point{x, y - h / 2}, Point{x, y + h / 2}};
      joint.overrides.stiffness_moment = bending / over;
      joint.overrides.stiffness_axial = stretching / over;
      return joint;
    };
    scene.joints = {join("foot", "left", 0, 0, l / 2), join("left", "right", span, rise, l),
                    join("right", "other foot", 2 * span, 0, l / 2)};
    scene.supports = {{.body = "left",
                       .at = {span, rise},
                       .fix_y = true,
                       .displacement = {0, -0.8 * rise, 0},
                       .ramp = 120}};
    return largest_push(scene, "support/0", 120);
  }
};

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

/// A bar of 20 m held at x = 0, and at its far end where it is propped, under one load at its tip or spread
/// evenly.
SceneDef column(bool clamped, bool propped, int pieces, Point at_tip, double spread) {
  SceneDef scene = elastic_scene();
  scene.joint.moment.reset();
  scene.bodies = {bending_bar("bar", length, pieces)};
  scene.supports = {{.body = "bar", .at = {0, 0}, .fix_x = true, .fix_y = true, .fix_angle = clamped}};
  if (propped) scene.supports.push_back({.body = "bar", .at = {length, 0}, .fix_y = true});
  if (at_tip.x != 0) scene.loads.push_back({.body = "bar", .at = {length, 0}, .force = at_tip});
  for (int i = 0; i < pieces && spread > 0; ++i)
    scene.loads.push_back(
        {.body = "bar", .at = {(i + 0.5) * length / pieces, 0}, .force = {0, -spread * length / pieces}});
  return scene;
}

void add_columns(std::vector<Benchmark>& rows) {
  struct End {
    const char* name;
    bool clamped, propped;
    double exact;  // P L²/EI
  };
  const double tangent = 4.493409457909064;  // tan x = x
  for (const End& end :
       {End{"free", true, false, pi * pi / 4}, End{"pinned at both ends", false, true, pi * pi},
        End{"clamped and propped", true, true, tangent * tangent}})
    rows.push_back({"Column that buckles", "Euler, 1744", "closed form",
                    fmt::format("{}, 20 m, 20 pieces", bar), fmt::format("critical PL²/EI, {}", end.name),
                    end.exact,
                    critical_load(calibrate(column(end.clamped, end.propped, 20, {-1, 0}, 0))).factor *
                        length * length / EI,
                    0.001});
  // The hinge in the span is where the shear vanishes, (√2 − 1) L from the prop.
  SceneDef propped = column(true, true, 40, {}, 1);
  propped.supports[0].fix_angle = false;
  propped.supports.erase(propped.supports.begin());
  propped.bodies.push_back(
      {.name = "wall", .type = BodyType::static_body, .outline = {rectangle(-1, -1, 0, 1), {}}});
  propped.joints = {{.a = "wall", .b = "bar"}};
  const double M = steel.yield_stress * thick * thick / 4;
  rows.push_back({"Propped cantilever, load spread evenly",
                  "Neal, The Plastic Methods of Structural Analysis: 6 + 4 √2", "closed form; not read",
                  "rigid-plastic, 20 m × 0.1 m × 1 m, f_y = 350 MPa, 40 pieces", "collapse load qL²/M_p",
                  6 + 4 * std::numbers::sqrt2,
                  limit_analysis(calibrate(propped)).load_factor * length * length / M, 0.005});
}

}  // namespace

std::vector<Benchmark> static_benchmarks(const Context& context) {
  std::vector<Benchmark> rows;
  const int pieces = context.quick ? 20 : 40;
  add_elastica(rows, pieces);
  context.progress(0.2);
  rows.push_back({"Lee's frame", "Lee, Manuel and Rossow, 1968", "integrated here; not read",
                  fmt::format("two bars of L = 12 m, {}, pins at their far ends, pushed down at 0.2 L from "
                              "the corner; {} pieces each",
                              bar, pieces),
                  "limit load, PL²/EI", lees_limit_load(), lees_limit(pieces), 0.01});
  rows.push_back(
      {"Williams' toggle", "Williams, 1964", "integrated here; not read",
       fmt::format(
           "aluminium, 2 × 12.943 in, rise 0.386 in, 0.753 in × 0.243 in, E = 10.3e6 psi; {} pieces each",
           pieces),
       "limit load [lb]", Toggle::exact() / 1000, Toggle::limit(pieces) / 1000, 0.01});
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
  add_columns(rows);
  add_beam_columns(rows);
  return rows;
}

}  // namespace ductile::report
