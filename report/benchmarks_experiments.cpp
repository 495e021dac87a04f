// Experiments: what was measured on structures that were built, beside what ductile makes of their data.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "benchmark.h"
#include "ductile/design.h"
#include "ductile/simulation.h"

namespace ductile::report {
namespace {

constexpr double pi = std::numbers::pi;

Ring rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

/// A wall for cantilevers that start at x = 0.
BodyDef wall() {
  return {.name = "wall", .type = BodyType::static_body, .outline = {rectangle(-2, -2, 0, 2), {}}};
}

// Technion's Pazy wing, with its skin or without, clamped at its root and bent by masses at its tip. Its
// stiffness is given part by part, its own weight node by node; what was measured is the tip's sag less that
// under its own weight.
class PazyWing {
 public:
  explicit PazyWing(bool skin) : skin_(skin) {}

  /// The tip's sag over the span that is measured, under a mass at the tip.
  double sag(double mass) const { return (tip(mass) - tip(0)) / span; }

  static constexpr double span = 0.55;  // m

 private:
  static constexpr std::array<double, 16> nodes{0,      0.03825, 0.0765,    0.11475,  0.153,  0.19125,
                                                0.2295, 0.26775, 0.306,     0.34425,  0.3825, 0.42075,
                                                0.459,  0.49725, 0.5307187, 0.5498437};  // m
  // N m², from node to node.
  static constexpr std::array<std::array<double, 15>, 2> bending{
      {{4.59193, 4.44736, 4.42762, 4.42435, 4.42456, 4.42464, 4.42465, 4.42464, 4.42464, 4.42460, 4.42442,
        4.42584, 4.43874, 4.49851, 4.71031},
       {5.24744, 4.50448, 4.47823, 4.47438, 4.47481, 4.47493, 4.47493, 4.47493, 4.47493, 4.47489, 4.47472,
        4.47618, 4.48917, 4.54820, 4.77038}}};
  // kg: of all nodes but the ends, of the last but one, of the last without and with skin.
  static constexpr double rib = 0.020683, before_last = 0.025448;
  static constexpr std::array<double, 2> last{0.037056, 0.043156};
  static constexpr double g = 9.81;  // m/s²

  /// How far the tip sinks under its own weight and a mass, m.
  double tip(double mass) const {
    constexpr int pieces = 4;                    // to a part
    constexpr double thick = 0.01, depth = 0.1;  // m: any that have the bending stiffness
    SceneDef scene;
    scene.gravity = {};
    scene.joint = {.moment = unlimited, .axial = unlimited, .shear = unlimited};
    scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
    scene.joint.max_rotation = scene.joint.max_elongation = scene.joint.max_slip = unlimited;
    scene.bodies = {wall()};
    const auto part = [](std::size_t i) { return fmt::format("part {}", i); };
    const auto load = [&](std::size_t i, double weight) {
      scene.loads.push_back({.body = part(i), .at = {nodes[i + 1], 0}, .force = {0, -weight}, .ramp = 10});
    };
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double along = nodes[i + 1] - nodes[i];
      BodyDef body{
          .name = part(i),
          .outline = {rectangle(0, -thick / 2, along, thick / 2), {}},
          .material = Material{.yield_stress = 1e9,
                               .youngs_modulus = bending[skin_][i] * 12 / (depth * thick * thick * thick),
                               .density = 2700,
                               .damping_ratio = 1},
          .depth = depth,
          .pieces = pieces,
          .along = {Point{0, 0}, Point{along, 0}}};
      body.at = {nodes[i], 0};
      body.collides = false;
      scene.bodies.push_back(std::move(body));
      scene.joints.push_back({.a = i == 0 ? "wall" : part(i - 1), .b = part(i)});
      const bool end = i + 2 == nodes.size();
      load(i, g * (end ? last[skin_] + mass : i + 3 == nodes.size() ? before_last : rib));
    }
    Simulation simulation(calibrate(scene));
    while (simulation.time() < 30) simulation.step();
    const PieceReading piece = simulation.piece(simulation.plan().pieces.size() - 1);
    const double half = (nodes[15] - nodes[14]) / pieces / 2;
    return -(piece.position.y + half * std::sin(piece.angle));
  }

  std::size_t skin_;
};

// A rolled beam whose flanges and web were tested by themselves.
struct RolledBeam {
  double h, b, tw, tf, r;  // m; r of its root fillets, which are drawn as triangles of their area
  double flange, web;      // Pa: measured yield stress

  static Material steel(double yield_stress) {
    return {.yield_stress = yield_stress, .youngs_modulus = 200e9, .density = 7850};
  }
  /// With flanges so wide.
  std::vector<Region> regions(double width) const {
    const double root = h / 2 - tf, x = tw / 2, leg = r * std::sqrt(2 - pi / 2), wide = x + leg,
                 y = root - leg;
    const Ring plate = rectangle(-x, -root, x, root),
               rolled{{-wide, -root}, {wide, -root}, {x, -y}, {x, y},
                      {wide, root},   {-wide, root}, {-x, y}, {-x, -y}};
    return {{{rectangle(-width / 2, -h / 2, width / 2, -root), {}}, steel(flange)},
            {{r > 0 ? rolled : plate, {}}, steel(web)},
            {{rectangle(-width / 2, root, width / 2, h / 2), {}}, steel(flange)}};
  }
  double area() const { return 2 * b * tf + (h - 2 * tf) * tw + (4 - pi) * r * r; }
};

// Welded to a column all over its section, its free half bent up and down until it breaks or buckles. Where
// flanges were cut narrower, so that the beam yields away from the weld, they are so wide there.
struct WeldedBeam {
  RolledBeam beam;
  double length;                     // m: from the column's face to where it is pushed
  double narrow = 0, narrow_at = 0;  // m: width of its flanges where they are cut, how far from the face

  BodyDef part(std::string name, double from, double to, double width) const {
    BodyDef body{.name = std::move(name),
                 .outline = {rectangle(from, -beam.h / 2, to, beam.h / 2), {}},
                 .material = RolledBeam::steel(beam.flange)};
    body.profile = beam.regions(width);
    return body;
  }
  /// At the column's face, when it folds, N m.
  double moment() const {
    SceneDef scene;
    scene.gravity = {};
    scene.joint.shear = unlimited;
    scene.bodies = {wall()};
    if (narrow > 0) {
      scene.bodies.push_back(part("root", 0, narrow_at, beam.b));
      scene.bodies.push_back(part("beam", narrow_at, length, narrow));
      scene.joints = {{.a = "wall", .b = "root"}, {.a = "root", .b = "beam"}};
    } else {
      scene.bodies.push_back(part("beam", 0, length, beam.b));
      scene.joints = {{.a = "wall", .b = "beam"}};
    }
    scene.loads = {{.body = "beam", .at = {length, 0}, .force = {0, -1}}};
    return limit_analysis(calibrate(scene)).load_factor * length;
  }
};

// Under a slab of concrete that studs or channels hold to it all along, on two supports, under a load in its
// middle that grows until it fails. Concrete bears 0.85 of its cylinders' strength in compression and nothing
// in tension, and the beam's own weight is there before the load.
struct CompositeBeam {
  RolledBeam beam;
  double width, slab, span;  // m
  double cylinder;           // Pa
  double mass;               // kg/m

  /// The load in its middle under which it folds, N.
  double load() const {
    const Material concrete{.yield_stress = 1e3,
                            .yield_stress_compression = 0.85 * cylinder,
                            .youngs_modulus = 30e9,
                            .density = (mass - 7850 * beam.area()) / (width * slab)};
    SceneDef scene;
    scene.joint.shear = unlimited;
    const double middle = span / 2, tall = beam.h + slab;
    BodyDef body{.name = "beam",
                 .outline = {rectangle(0, -tall / 2, span, tall / 2), {}},
                 .material = RolledBeam::steel(beam.flange)};
    body.profile = beam.regions(beam.b);
    body.profile.push_back({{rectangle(-width / 2, beam.h / 2, width / 2, beam.h / 2 + slab), {}}, concrete});
    body.cuts = {{Point{middle, -tall}, Point{middle, tall}}};
    scene.bodies = {std::move(body)};
    scene.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true},
                      {.body = "beam", .at = {span, 0}, .fix_y = true}};
    scene.loads = {{.body = "beam", .at = {middle, 0}, .force = {0, -1}}};
    return limit_analysis(calibrate(scene), true).load_factor;
  }
};

}  // namespace

std::vector<Benchmark> experiment_benchmarks() {
  std::vector<Benchmark> rows;
  struct Bent {
    bool skin;
    double mass, measured, modelled;  // kg, over the span
  };
  for (const Bent& bent : {Bent{false, 1, 0.220972, 0.206406}, Bent{false, 2, 0.388292, 0.363954},
                           Bent{true, 1, 0.211515, 0.200095}, Bent{true, 2, 0.377337, 0.354441},
                           Bent{true, 3, 0.500870, 0.462444}}) {
    const std::string
        name = fmt::format("Pazy wing {} skin, bent by a mass at its tip", bent.skin ? "with" : "without"),
        input = fmt::format(
            "a span of 0.55 m in 15 parts, EI of {} N m² at the root, 4.4 to 4.8 beyond, each as in the beam "
            "model, its own weight at their nodes, a mass of {:g} kg at its tip; 60 pieces",
            bent.skin ? "5.25" : "4.59", bent.mass),
        quantity = fmt::format("sag of the tip over the span, {:g} kg", bent.mass);
    const double sag = PazyWing(bent.skin).sag(bent.mass);
    rows.push_back(
        {name, "Avin et al., AIAA Journal, 2022: measured",
         "value and data in a secondary source: Riso and Cesnik's files of the Large Deflection Working "
         "Group, 2023",
         input, quantity, bent.measured, sag, 0.1});
    rows.push_back({name, "Riso and Cesnik, Journal of Aircraft, 2023: a strain-based beam",
                    "value and data in their files", input, quantity, bent.modelled, sag, 0.01});
  }
  constexpr double mm = 1e-3, MPa = 1e6;
  const auto described = [](const RolledBeam& beam) {
    return fmt::format(
        "h × b × t_w × t_f = {:.4g} × {:.4g} × {:.4g} × {:.4g} mm{}, measured yield stress {:.4g} MPa of its "
        "flanges, {:.4g} MPa of its web",
        beam.h / mm, beam.b / mm, beam.tw / mm, beam.tf / mm,
        beam.r > 0 ? fmt::format(", root radius {:.4g} mm", beam.r / mm) : "", beam.flange / MPa,
        beam.web / MPa);
  };
  struct Tested {
    const char *name, *source;
    WeldedBeam test;
    double measured;  // kN m: mean of both beams where the column had two
    bool both = true;
  };
  const auto W36x150 = [](double flange, double web) {
    return RolledBeam{911.86 * mm, 304.8 * mm, 15.88 * mm, 23.88 * mm, 20.07 * mm, flange * MPa, web * MPa};
  };
  const RolledBeam H600{600 * mm, 200 * mm, 11 * mm, 17 * mm, 12.95 * mm, 280 * MPa, 308 * MPa};
  const RolledBeam W30x108{756.92 * mm, 266.7 * mm,  13.84 * mm, 19.3 * mm,
                           22.61 * mm,  365.4 * MPa, 406.8 * MPa};
  const WeldedBeam whole{W36x150(390.9, 433.7), 4263.39 * mm},
      cut{W36x150(374.4, 409.5), 3577.59 * mm, 152.4 * mm, 571.5 * mm};
  const char* ricles = "Ricles et al., 2000";
  const char* engelhardt = "Engelhardt et al., 2000";
  const char* tsai = "Tsai and Chen, 2000";
  for (const auto& [name, source, test, measured, both] :
       {Tested{"C1", ricles, whole, (4766 + 4875) / 2.}, Tested{"C2", ricles, whole, (4875 + 4656) / 2.},
        Tested{"UT02", "Shin, 2017", {W30x108, 4087.8 * mm}, (2484 + 2511) / 2.},
        Tested{"DBBW", engelhardt, cut, (2809 + 2784) / 2.},
        Tested{"DBWW", engelhardt, cut, (2889 + 2961) / 2.},
        Tested{"RB1", tsai, {H600, 2350 * mm, 125 * mm, 300 * mm}, 848, false},
        Tested{"RB2", tsai, {H600, 2350 * mm, 100 * mm, 300 * mm}, 752, false}}) {
    std::string input =
        fmt::format("{}, pushed {:.4g} m from the column's face", described(test.beam), test.length);
    if (test.narrow > 0)
      input += fmt::format("; flanges {:g} mm wide {:g} mm from it", test.narrow / mm, test.narrow_at / mm);
    rows.push_back(
        {fmt::format("Steel beam welded to a column, {}", name), source,
         "value and data in a secondary source: Arber's table of panel zone tests, version 6, 2025",
         std::move(input),
         fmt::format("largest moment at the column's face{} [kN m]", both ? ", mean of two beams" : ""),
         measured, test.moment() / 1000, 0.25});
  }
  struct Loaded {
    const char *name, *source, *remark;
    CompositeBeam test;
    double measured;  // kN
  };
  constexpr double inch = 0.0254, ksi = 6.894757e6, lb_ft = 1.488164, kip = 4.448222, ton = 2.24 * kip;
  const char* chapman = "Chapman and Balakrishnan, The Structural Engineer 42(11), 1964";
  const char* taken = "; one yield stress was given, no fillets; concrete of 2400 kg/m³ is taken";
  const auto on_studs = [](double yield, double cylinder) {
    return CompositeBeam{{12 * inch, 6 * inch, 0.42 * inch, 0.66 * inch, 0, yield * ksi, yield * ksi},
                         48 * inch,
                         6 * inch,
                         216 * inch,
                         cylinder * ksi,
                         511};
  };
  const CompositeBeam on_channels{
      {21.13 * inch, 8.27 * inch, 0.43 * inch, 0.685 * inch, 0.47 * inch, 35.1 * ksi, 41.8 * ksi},
      72 * inch,
      6.25 * inch,
      450 * inch,
      6.48 * ksi,
      565 * lb_ft};
  for (const auto& [name, source, remark, test, measured] :
       {Loaded{"B21S",
               "Viest, Siess, Appleton and Newmark, University of Illinois Bulletin 405, 1952, table 24",
               "; its dimensions are AISC's", on_channels, 102 * kip},
        Loaded{"A1", chapman, taken, on_studs(33.76, 3.2), 45 * ton},
        Loaded{"A2", chapman, taken, on_studs(33.82, 3.9), 43 * ton},
        Loaded{"A3", chapman, taken, on_studs(37.39, 2.65), 46 * ton},
        Loaded{"A4", chapman, taken, on_studs(37.25, 2.91), 46 * ton}})
    rows.push_back(
        {fmt::format("Steel beam under a slab, {}", name), source,
         "value and data in a secondary source: Lamsal's data of composite girders, 2026",
         fmt::format(
             "{}; slab of {:.4g} × {:.4g} mm, cylinders of {:.3g} MPa; span of {:.4g} m, {:.3g} kg/m{}",
             described(test.beam), test.width / mm, test.slab / mm, test.cylinder / MPa, test.span, test.mass,
             remark),
         "load in the middle under which it failed [kN]", measured, test.load() / 1000, 0.25});
  return rows;
}

}  // namespace ductile::report
