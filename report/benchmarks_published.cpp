// Frames that others have calibrated their programs with, and structures under loads that come and go.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "benchmark.h"
#include "ductile/design.h"
#include "ductile/rolled.h"
#include "ductile/simulation.h"
#include "plastic_zones.h"

namespace ductile::report {
namespace {

/// Bending and axial force: nothing weighs, shears or breaks.
SceneDef frame_scene() {
  SceneDef scene;
  scene.gravity = {};
  scene.joint.shear = scene.joint.stiffness_shear = unlimited;
  scene.joint.max_rotation = scene.joint.max_elongation = scene.joint.max_compression = scene.joint.max_slip =
      unlimited;
  return scene;
}

/// A bar between two nodes in so many parts, and a cut close to each end, where hinges form.
BodyDef bar(std::string name, Point from, Point to, double height, const Material& material, int parts) {
  constexpr double near = 1e-3;  // m
  const double along = std::hypot(to.x - from.x, to.y - from.y), half = height / 2;
  BodyDef body{.name = std::move(name),
               .outline = {{{0, -half}, {along, -half}, {along, half}, {0, half}}, {}},
               .material = material};
  body.at = from;
  body.angle = std::atan2(to.y - from.y, to.x - from.x);
  body.collides = false;
  const auto cut = [&](double x) { body.cuts.push_back({Point{x, -height}, Point{x, height}}); };
  cut(near);
  for (int i = 1; i < parts; ++i) cut(along * i / parts);
  cut(along - near);
  return body;
}

// Vogel's calibration frames: rolled sections of S235 that yield under N and M together, out of plumb by ψ,
// all loads growing in proportion.
class CalibrationFrame {
 public:
  CalibrationFrame(double out_of_plumb, int parts) : psi_(out_of_plumb), parts_(parts) {
    scene_.interaction = true;
  }

  void member(const std::string& profile, Point from, Point to) {
    const Rolled section = rolled(profile);
    BodyDef body = bar(name(scene_.bodies.size()), leaning(from), leaning(to), section.h, s235, parts_);
    body.profile = {Region{draw(section).outline, s235}};
    body.profile_name = section.name;
    scene_.bodies.push_back(std::move(body));
    ends_.push_back({from, to});
  }
  void load(Point node, Point force) {
    scene_.loads.push_back({.body = name(at(node).front()), .at = leaning(node), .force = force});
  }
  /// q in N/m on the member last made, downward.
  void spread(double q) {
    const auto [from, to] = ends_.back();
    for (int i = 0; i < parts_; ++i) {
      const double share = (i + 0.5) / parts_;
      scene_.loads.push_back({.body = name(ends_.size() - 1),
                              .at = leaning({from.x + share * (to.x - from.x), from.y}),
                              .force = {0, -q * (to.x - from.x) / parts_}});
    }
  }
  /// The factor on all loads at which it collapses, deformed.
  double collapse() {
    for (const auto& [from, to] : ends_)
      for (const Point node : {from, to}) join(node);
    return second_order_limit(calibrate(scene_)).load_factor;
  }
  /// The same where residual stresses soften what is pressed: bars have τ_b E, τ_b = 4p (1 − p) from p =
  /// N/N_y = ½ on, at collapse (AISC 360, C2-2b; the tangent of the column curve F = f_y − f_y²/4F_e).
  double collapse_with_residual_stresses() {
    double factor = collapse();
    for (int round = 0; round < 3; ++round) {
      const Plan plan = calibrate(scene_);
      const StaticCheck check = static_check(plan, Order::second);
      for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
        const std::string inside = name(i) + "/";
        double p = 0;
        for (std::size_t k = 0; k < plan.joints.size(); ++k)
          if (plan.joints[k].name.starts_with(inside))
            p = std::max(p, -factor * check.joints[k].N / plan.joints[k].Nc);
        BodyDef& body = scene_.bodies[i];
        body.material->youngs_modulus = body.profile[0].material.youngs_modulus =
            s235.youngs_modulus * (p > 0.5 ? 4 * p * (1 - p) : 1);
      }
      factor = second_order_limit(calibrate(scene_)).load_factor;
    }
    return factor;
  }

 private:
  static std::string name(std::size_t i) { return fmt::format("bar {}", i); }
  Point leaning(Point p) const { return {p.x + psi_ * p.y, p.y}; }
  /// The members that end in a node.
  std::vector<std::size_t> at(Point node) const {
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < ends_.size(); ++i)
      for (const Point end : ends_[i])
        if (end.x == node.x && end.y == node.y) all.push_back(i);
    return all;
  }
  void join(Point node) {
    if (std::find_if(joined_.begin(), joined_.end(),
                     [&](Point p) { return p.x == node.x && p.y == node.y; }) != joined_.end())
      return;
    joined_.push_back(node);
    const auto members = at(node);
    if (node.y == 0) {
      scene_.supports.push_back(
          {.body = name(members[0]), .at = node, .fix_x = true, .fix_y = true, .fix_angle = true});
      return;
    }
    JointBetweenDef corner{.a = name(members[0]), .b = name(members[1]), .at = leaning(node)};
    for (std::size_t i = 2; i < members.size(); ++i) corner.others.push_back(name(members[i]));
    corner.overrides.moment = unlimited;
    scene_.joints.push_back(std::move(corner));
  }

  inline static const Material s235{
      .yield_stress = 235e6, .youngs_modulus = 205e9, .density = 7850, .damping_ratio = 1};
  double psi_;
  int parts_;
  SceneDef scene_ = frame_scene();
  std::vector<std::array<Point, 2>> ends_;
  std::vector<Point> joined_;
};

CalibrationFrame vogels_portal(int parts) {
  CalibrationFrame frame(1. / 400, parts);
  frame.member("HEB 300", {0, 0}, {0, 5});
  frame.member("HEB 300", {4, 0}, {4, 5});
  frame.member("HEA 340", {0, 5}, {4, 5});
  frame.load({0, 5}, {35e3, -2800e3});
  frame.load({4, 5}, {0, -2800e3});
  return frame;
}

/// The same by plastic zones, with residual stresses of a share of the yield stress.
double vogels_portal_in_zones(double residual_share, int parts) {
  constexpr double h = 5, l = 4, lean = h / 400;
  PlasticZones zones(205e9, 235e6);
  const std::size_t column = zones.section(rolled("HEB 300"), residual_share),
                    girder = zones.section(rolled("HEA 340"), residual_share);
  for (const double x : {0., l}) {
    zones.member(column, x, 0, x + lean, h, parts);
    zones.at(x, 0).fixed = true;
    zones.at(x + lean, h).load = {x == 0 ? 35e3 : 0, -2800e3, 0};
  }
  zones.member(girder, lean, h, l + lean, h, parts);
  return zones.collapse(zones.node(lean, h), 5e-4);
}

// Darvall and Mendis: a portal on fixed feet, one load on its girder; of bending alone.
struct LoadedPortal {
  static constexpr double L = 3.048, at = 0.55 * L, A = 0.103, I = 0.001, E = 20.68e9;  // m, m², m⁴, Pa
  static constexpr double column = 158.18e3, girder = 169.48e3;                         // M_p, N m
  /// The factor on 1 N, hinge by hinge, and where each is: its place on the girder over L, −1: elsewhere.
  static std::vector<std::pair<double, double>> hinges() {
    const double h = std::sqrt(12 * I / A);
    const Material concrete{.yield_stress = 30e6, .youngs_modulus = E, .density = 2400};
    SceneDef scene = frame_scene();
    scene.joint.axial = unlimited;
    scene.bodies = {bar("left", {0, 0}, {0, L}, h, concrete, 20),
                    bar("right", {L, 0}, {L, L}, h, concrete, 20),
                    bar("girder", {0, L}, {L, L}, h, concrete, 20)};
    for (BodyDef& body : scene.bodies) {
      body.depth = A / h;
      body.joint.moment = body.name == "girder" ? girder : column;
    }
    for (const double x : {0., L}) {
      const char* foot = x == 0 ? "left" : "right";
      JointBetweenDef corner{.a = foot, .b = "girder", .at = Point{x, L}};
      corner.overrides.moment = unlimited;
      scene.joints.push_back(corner);
      scene.supports.push_back({.body = foot, .at = {x, 0}, .fix_x = true, .fix_y = true, .fix_angle = true});
    }
    scene.loads = {{.body = "girder", .at = {at, L}, .force = {0, -1}}};
    const Plan plan = calibrate(scene);
    const Pushover push = second_order_limit(plan);
    std::vector<std::pair<double, double>> all;
    for (const Reached& hinge : push.hinges) {
      const Point where = plan.joints[static_cast<std::size_t>(hinge.joint)].anchor;
      all.emplace_back(hinge.factor, where.y > 0.9 * L ? where.x / L : -1);
    }
    all.emplace_back(limit_analysis(plan).load_factor, 0);
    return all;
  }
};

constexpr double span = 10, thick = 0.1, E = 210e9,
                 fy = 10e6;  // m, m, Pa; 1 m deep; so weak that it hardly bends
constexpr double EI = E * thick * thick * thick / 12, M_p = fy * thick * thick / 4;
const Material steel{.yield_stress = fy, .youngs_modulus = E, .density = 7800, .damping_ratio = 1};

constexpr double ramp =
    160;  // s: what damping and swinging add to the loads is below half a per cent of them

/// Grows from a time on for so long, and stays; another of the opposite sign takes it away again.
LoadDef onset(const std::string& body, Point at, double P, double from, double over = ramp) {
  return {.body = body, .at = at, .force = {0, P}, .from = from, .ramp = over};
}

// A beam over two spans L under loads P in their middles that come and go: the left one, both, the left one,
// none. Elastic moments under P alone: 13/64 PL under it, −6/64 PL at the middle support; under both 10/64
// and −12/64. Melan: it shakes down up to 2 · 13/64 + 12/64 = 3 M_p/PL; beyond, the hinge in the left span
// grows by 4L/3EI (38/64 PL − 3 M_p) each cycle, for both hinges move the moment between them by that much.
struct TwoSpans {
  static constexpr double limit = 96. / 19;  // PL/M_p
  static double growth(double PL_over_Mp) {
    return 4 * span / (3 * EI) * (38. / 64 * PL_over_Mp * M_p - 3 * M_p);
  }
  /// The same, simulated: the mean growth over the last two of four cycles.
  static double simulated(double PL_over_Mp) {
    constexpr double cycle = 4 * ramp;  // s
    constexpr int cycles = 4;
    const double P = PL_over_Mp * M_p / span;
    SceneDef scene = frame_scene();
    scene.joint.axial = unlimited;
    BodyDef body = bar("beam", {0, 0}, {2 * span, 0}, thick, steel, 40);
    scene.bodies = {std::move(body)};
    scene.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true},
                      {.body = "beam", .at = {span - 1e-6, 0}, .fix_y = true},
                      {.body = "beam", .at = {2 * span, 0}, .fix_y = true}};
    for (int i = 0; i < cycles; ++i) {
      const double t = i * cycle;
      const Point left{span / 2 - 1e-6, 0}, right{1.5 * span - 1e-6, 0};
      scene.loads.push_back(onset("beam", left, -P, t));
      scene.loads.push_back(onset("beam", right, -P, t + ramp));
      scene.loads.push_back(onset("beam", right, P, t + 2 * ramp));
      scene.loads.push_back(onset("beam", left, P, t + 3 * ramp));
    }
    Simulation simulation(calibrate(scene));
    const auto turned = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i)
        if (simulation.plan().joints[i].anchor.x < 0.7 * span)
          sum += std::abs(simulation.joint(i).plastic_rotation);
      return sum;
    };
    double before = 0;
    while (simulation.time() < cycles * cycle) {
      simulation.step();
      if (simulation.time() < 2 * cycle) before = turned();
    }
    return (turned() - before) / (cycles - 2);
  }
};

// A cantilever whose tip a spring k holds, under a load ±P there. Beyond P = R + k w the tip, k₁ = 3EI/L³ and
// R = M_p/L, goes w = (P − R)/k far; a cycle takes 4 R (w − R/k₁).
struct Hysteresis {
  static constexpr double k1 = 3 * EI / (span * span * span), R = M_p / span, k = k1 / 4, P = 2 * R;
  static double exact() { return 4 * R * ((P - R) / k - R / k1); }
  static double simulated(int pieces) {
    constexpr double cycle = 4 * ramp;  // s
    SceneDef scene = frame_scene();
    scene.joint.axial = unlimited;
    BodyDef beam{.name = "beam",
                 .outline = {{{0, -thick / 2}, {span, -thick / 2}, {span, thick / 2}, {0, thick / 2}}, {}},
                 .material = steel,
                 .pieces = pieces,
                 .along = {Point{0, 0}, Point{span, 0}}};
    beam.collides = false;
    scene.bodies = {{.name = "wall",
                     .type = BodyType::static_body,
                     .outline = {{{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {}}},
                    std::move(beam)};
    scene.joints = {{.a = "wall", .b = "beam"}};
    scene.supports = {{.body = "beam", .at = {span, 0}, .stiffness_y = k}};
    for (int i = 0; i < 3; ++i) {
      const double t = i * cycle;
      scene.loads.push_back(onset("beam", {span, 0}, P, t));
      scene.loads.push_back(onset("beam", {span, 0}, -2 * P, t + ramp, 2 * ramp));
      scene.loads.push_back(onset("beam", {span, 0}, P, t + 3 * ramp));
    }
    Simulation simulation(calibrate(scene));
    const auto dissipated = [&] {
      double sum = 0;
      for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i) sum += simulation.joint(i).dissipated;
      return sum;
    };
    double before = 0;
    while (simulation.time() < 3 * cycle) {
      simulation.step();
      if (simulation.time() < 2 * cycle) before = dissipated();
    }
    return dissipated() - before;
  }
};

}  // namespace

namespace {

CalibrationFrame six_storeys(int parts) {
  constexpr double storey = 3.75, bay = 6;  // m
  constexpr const char* outer[] = {"HEB 220", "HEB 220", "HEB 220", "HEB 220", "HEB 160", "HEB 160"};
  constexpr const char* inner[] = {"HEB 260", "HEB 260", "HEB 260", "HEB 240", "HEB 200", "HEB 200"};
  constexpr const char* girder[] = {"IPE 400", "IPE 360", "IPE 330", "IPE 300", "IPE 300", "IPE 240"};
  CalibrationFrame frame(1. / 450, parts);
  for (int i = 0; i < 6; ++i) {
    const double y = storey * i, top = storey * (i + 1);
    for (int c = 0; c < 3; ++c) frame.member(c == 1 ? inner[i] : outer[i], {bay * c, y}, {bay * c, top});
    for (int b = 0; b < 2; ++b) {
      frame.member(girder[i], {bay * b, top}, {bay * (b + 1), top});
      frame.spread(i == 5 ? 31.7e3 : 49.1e3);
    }
    frame.load({0, top}, {i == 5 ? 10.23e3 : 20.44e3, 0});
  }
  return frame;
}

constexpr int zones = 32;  // to a bar

}  // namespace

double vogels_six_storeys(int parts) { return six_storeys(parts).collapse(); }

std::vector<VogelsPortal> vogels_portal_by_model() {
  constexpr int parts = 12;
  return {{"plastic zones, residual stresses of f_y/2 (Vogel, 1985, quoted)", 1.022},
          {"the same, worked out here", vogels_portal_in_zones(0.5, zones)},
          {"plastic zones without residual stresses, worked out here", vogels_portal_in_zones(0, zones)},
          {"ductile, without residual stresses", vogels_portal(parts).collapse()},
          {"ductile, its columns' E times τ_b", vogels_portal(parts).collapse_with_residual_stresses()}};
}

std::vector<Benchmark> calibration_benchmarks() {
  constexpr int parts = 12;
  const std::string vogel = "Vogel, Calibrating Frames, Stahlbau 54, 1985: by plastic zones",
                    read =
                        "value as it is commonly quoted; neither the paper nor a text that has it was read",
                    steel = fmt::format(
                        "S235, E = 205 GPa, N and M on the surface; {} parts to a bar, hinges at points",
                        parts),
                    softened =
                        "; for residual stresses bars have τ_b E, τ_b = 4p (1 − p) where p = N/N_y > ½ (AISC "
                        "360, C2-2b)",
                    portal =
                        "columns HEB 300 of 5 m on fixed feet, girder HEA 340 of 4 m, 2800 kN on each "
                        "column, 35 kN across, out of plumb by 1/400; " +
                        steel,
                    factor = "factor on all loads at collapse";
  return {{"Vogel's portal", vogel,
           read + "; the frame and its loads likewise; plastic zones here give its value (table below)",
           portal + softened, factor, 1.022, vogels_portal(parts).collapse_with_residual_stresses(), 0.02},
          {"Vogel's portal, without residual stresses",
           "plastic zones, fibres and second order: reference/plastic_zones.h",
           "worked out here; with residual stresses it gives Vogel's value", portal, factor,
           vogels_portal_in_zones(0, zones), vogels_portal(parts).collapse(), 0.02},
          {"Vogel's six storeys", vogel,
           read + "; the frame and its loads in a program that has them after Ziemian and Ziemian, 2021",
           "two bays of 6 m, storeys of 3.75 m; outer columns HEB 220, above the fourth 160, inner ones HEB "
           "260, fourth 240, above 200; girders IPE 400, 360, 330, 300, 300, 240; 49.1 kN/m, 31.7 on the "
           "roof, 20.44 kN across at each floor, 10.23 at the roof, out of plumb by 1/450; " +
               steel + softened,
           factor, 1.11, six_storeys(parts).collapse_with_residual_stresses(), 0.02}};
}

std::vector<Benchmark> repeated_benchmarks() {
  std::vector<Benchmark> rows;
  const auto hinges = LoadedPortal::hinges();
  const std::string portal =
                        "portal of 3.048 m × 3.048 m on fixed feet, A = 0.103 m², I = 0.001 m⁴, E = "
                        "20.68 GPa, M_p of its columns 158.18 kN m, of its girder 169.48, one load on "
                        "it at 0.55 of the span; 20 parts to a bar",
                    source = "Darvall and Mendis, Journal of Structural Engineering 111(4), 1985, a = 0",
                    read = "its data and the second hinge in ONSAS' example and test, not itself";
  rows.push_back({"Portal of Darvall and Mendis", source, read, portal,
                  "second hinge, in the corner away from the load: load [kN]", 427, hinges[1].first / 1000,
                  0.01});
  rows.push_back({"Portal of Darvall and Mendis", source, read, portal,
                  "its place over the span (the first is under the load)", 1, hinges[1].second, 0.002});
  rows.push_back({"Portal of Darvall and Mendis",
                  "closed form: a mechanism of the girder, P a b/L = M_p of girder and column", "closed form",
                  portal, "load at collapse [kN]",
                  (LoadedPortal::girder + LoadedPortal::column) / (0.55 * 0.45 * LoadedPortal::L) / 1000,
                  hinges.back().first / 1000, 0.001});
  const std::string beam =
                        "two spans of 10 m, 0.1 m × 1 m, E = 210 GPa, f_y = 10 MPa, loads in the middles, "
                        "160 s each: left, both, left, none; 40 parts",
                    melan = "Melan, 1936; Neal, The Plastic Methods of Structural Analysis: closed form";
  constexpr double low = 1.03, high = 1.06;  // times the limit
  const double at_low = TwoSpans::simulated(low * TwoSpans::limit),
               at_high = TwoSpans::simulated(high * TwoSpans::limit),
               slope = (at_high - at_low) / (high - low);
  rows.push_back(
      {"Shakedown of a beam", melan, "worked out here; not read", beam,
       "largest load that it shakes down to, PL/M_p, where the growth at 1.03 and 1.06 of it is none",
       TwoSpans::limit, TwoSpans::limit * (low - at_low / slope), 0.01});
  rows.push_back({"Ratcheting of a beam", "closed form: 4L/3EI (38/64 PL − 3 M_p)", "worked out here", beam,
                  "growth of the hinge in the span per cycle, at 1.06 of that load less at 1.03 [rad]",
                  TwoSpans::growth(high * TwoSpans::limit) - TwoSpans::growth(low * TwoSpans::limit),
                  at_high - at_low, 0.01});
  rows.push_back({"Hysteresis", "closed form: 4 R ((P − R)/k − R L³/3EI), R = M_p/L", "worked out here",
                  "cantilever of 10 m, 0.1 m × 1 m, E = 210 GPa, f_y = 10 MPa, its tip on a spring k of a "
                  "quarter of its stiffness, under ±2R; 20 pieces",
                  "energy that a cycle takes [J]", Hysteresis::exact(), Hysteresis::simulated(20), 0.01});
  return rows;
}

}  // namespace ductile::report
