// ductile section: what a cross-section can carry about one direction.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "command.h"
#include "ductile/files.h"
#include "ductile/picture.h"
#include "ductile/rolled.h"
#include "ductile/shear.h"

namespace ductile::tool {
namespace {

struct Options {
  std::string file;
  std::optional<std::string> material;
  std::vector<std::string> pictures;
  double angle = 90;
  std::optional<double> N, Q, M;  // acting
  bool json = false;
};

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Unit vector of the bending direction; exact along the axes.
Point direction(double degrees) {
  const double turn = std::remainder(degrees, 360);
  if (std::remainder(turn, 90) == 0) {
    const int quarter = static_cast<int>(turn / 90);
    return {quarter == 0 ? 1. : quarter % 2 == 0 ? -1. : 0., quarter % 2 == 0 ? 0. : quarter > 0 ? 1. : -1.};
  }
  const double radians = turn * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians)};
}

/// What is asked about: a section of a file, or a profile by its name.
struct Subject {
  std::vector<Region> regions;
  std::optional<Rolled> profile;
  std::string name;
};

Subject read(const Options& options) {
  check_profile(options.file, "FILE");
  if (!names_a_profile(options.file) || std::filesystem::exists(options.file)) {
    if (options.material)
      throw InvalidInput(
          {{"command line:--material", "is for a profile, and '" + options.file + "' is a section file",
            "leave it out: the file's regions have their own"}});
    return {read_section(options.file), std::nullopt, options.file};
  }
  const std::string of = options.material.value_or("S235");
  const Material* material = materials::find(of);
  if (!material)
    throw InvalidInput({{"command line:--material", "'" + of + "' is no built-in material",
                         "ductile materials lists them; a section file takes any"}});
  Rolled profile = in_file("command line", [&] { return rolled(options.file); });
  const std::string name = profile.name + " of " + of;
  return {{{draw(profile).outline, *material}}, std::move(profile), name};
}

/// A_v, and where it is from. NaN where τ_y differs between regions.
struct ShearArea {
  double Q, A_v;
  const char* source;
};

ShearArea shear_area(const Subject& subject, const Section& section, Point d) {
  const double tau = subject.regions.front().material.shear();
  if (subject.profile && d.x == 0) {
    if (const double A_v = ductile::shear_area(*subject.profile); A_v > 0)
      return {A_v * tau, A_v, "EN 1993-1-1 6.2.6 (3)"};
  }
  const double Q = shear_capacity(section, d);
  for (const Region& region : subject.regions)
    if (region.material.shear() != tau) return {Q, unknown, "shear flow along the outline"};
  return {Q, Q / tau, "shear flow along the outline"};
}

/// Second moments about the centroid; NaN where E or f_y differ between regions.
struct Principal {
  double angle, I_max, I_min, I_yz;  // degrees from the x axis; m⁴
  double product(Point d) const {    // of the axes along and across d
    return (I_max - I_min) / 2 * std::sin(2 * (angle * std::numbers::pi / 180 - std::atan2(d.y, d.x)));
  }
};

Principal principal(const Section& section) {
  const PrincipalAxes axes = section.principal_axes();
  double angle = std::atan2(axes.strong.y, axes.strong.x) * 180 / std::numbers::pi;
  if (angle <= -90) angle += 180;
  if (angle > 90) angle -= 180;
  Principal p{angle, section.elastic(axes.strong).I, section.elastic(axes.weak).I, 0};
  p.I_yz = p.product({1, 0});
  if (std::abs(p.I_yz) < 1e-12 * p.I_max) p.I_yz = 0;  // rounding
  return p;
}

/// How much of the section the acting forces use: of each capacity, of all together, and of what it bears
/// before its first fibre yields.
struct Utilisation {
  double N, Q, M, together, elastic;
};

Utilisation utilisation(const Options& options, const Section& section, Point d, const Capacities& c,
                        const Elastic& e, double Q_max) {
  const double N = options.N.value_or(0), Q = options.Q.value_or(0), M = options.M.value_or(0);
  const Point centroid = section.centroid();
  const double middle = centroid.x * d.x + centroid.y * d.y;
  // Shear leaves √(1 − q²) of every stress, so all together is √(g² + q²), with g that of N and M: how far
  // they are beyond the edge of the N–M curve that they meet.
  const auto curve = section.interaction(d, middle, 1e-6);
  double g = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Interaction a = curve[i], b = curve[(i + 1) % curve.size()];
    g = std::max(g, (N * (b.M - a.M) - M * (b.N - a.N)) / (a.N * b.M - a.M * b.N));
  }
  const double q = std::abs(Q) / Q_max;
  double fibre = unknown;
  const bool known = e.EA > 0;
  if (known || std::isfinite(e.I)) {
    const double elastic_middle = e.centroid.x * d.x + e.centroid.y * d.y;
    const double bent = M + N * (middle - elastic_middle);  // about the elastic centroid
    fibre = 0;
    for (const Region& region : section.regions()) {
      const Material& material = region.material;
      const double per_N = known ? material.youngs_modulus / e.EA : 1 / section.area();
      const double per_M = known ? material.youngs_modulus / e.EI : 1 / e.I;
      for (const Point& p : region.outline.outer) {
        const double stress = per_N * N + per_M * bent * (p.x * d.x + p.y * d.y - elastic_middle);
        fibre = std::max({fibre, stress / material.yield_stress, -stress / material.compression()});
      }
    }
  }
  return {N >= 0 ? N / c.N : -N / c.Nc, q, M >= 0 ? M / c.M : -M / c.M_reverse, std::hypot(g, q), fibre};
}

/// What a reader of the numbers has to know.
std::vector<std::string> remarks(const Subject& subject, const Section& section, Point d,
                                 const Principal& axes, std::optional<int> bending_class, double A_eff,
                                 double N) {
  std::vector<std::string> result;
  const double extent = std::max(section.extent({1, 0}).second - section.extent({1, 0}).first,
                                 section.extent({0, 1}).second - section.extent({0, 1}).first);
  if (extent > too_high)
    result.push_back(
        fmt::format("it is {:g} m across: sections are in metres; drawn in millimetres, it needs 0.001 of "
                    "every coordinate",
                    extent));
  if (std::abs(axes.product(d)) > 1e-6 * axes.I_max)
    result.push_back(
        fmt::format("the direction is no principal one ({:.4g} degrees is): M, EI, I and W hold with the "
                    "section kept from "
                    "bending sideways",
                    axes.angle));
  if (bending_class && *bending_class > 2)
    result.push_back(fmt::format("class {} in bending: {}", *bending_class,
                                 *bending_class == 3 ? "it buckles locally before M; design with yield_moment"
                                                     : "it buckles locally before its first fibre yields"));
  if (A_eff < section.area() * (1 - 1e-9) && N < 0)
    result.push_back(fmt::format("class 4 in compression: it buckles locally at N = {:.6g} N, A_eff f_y",
                                 -A_eff * subject.regions.front().material.compression()));
  for (const Region& region : subject.regions) {
    if (const double strain = ductility(region.material); strain < least_ductility) {
      result.push_back(
          fmt::format("a material breaks at {:.2g} times its yield strain: M is not reached; design with "
                      "yield_moment",
                      strain));
      break;
    }
  }
  return result;
}

/// All that is told of a section about one direction.
struct Results {
  Point d;
  Capacities c;
  Elastic e;
  std::vector<Interaction> curve;
  ShearArea shear;
  Principal axes;
  std::array<double, 2> radii;       // m, of gyration, of I_max and I_min
  std::optional<Classes> classes;    // of a profile in steel
  std::optional<int> bending_class;  // about d, where it is one of the profile's axes
  double A_eff = unknown;            // m²
  std::optional<Utilisation> used;
  std::vector<std::string> remarks;

  double where_known(double value) const { return e.EA > 0 ? value : unknown; }
};

Results results(const Options& options, const Subject& subject, const Section& section) {
  const Point d = direction(options.angle), centroid = section.centroid();
  const Principal axes = principal(section);
  Results r{.d = d,
            .c = section.capacities(d),
            .e = section.elastic(d),
            .curve = section.interaction(d, centroid.x * d.x + centroid.y * d.y),
            .shear = shear_area(subject, section, d),
            .axes = axes,
            .radii = {std::sqrt(axes.I_max / section.area()), std::sqrt(axes.I_min / section.area())}};
  if (const Material& material = subject.regions[0].material; subject.profile && is_steel(material)) {
    r.classes = section_class(*subject.profile, material.yield_stress);
    if (d.x == 0) r.bending_class = r.classes->bending_y;
    if (d.y == 0) r.bending_class = r.classes->bending_z;
    r.A_eff = effective_area(*subject.profile, material.yield_stress);
  }
  if (options.N || options.Q || options.M) r.used = utilisation(options, section, d, r.c, r.e, r.shear.Q);
  r.remarks = remarks(subject, section, d, axes, r.bending_class, r.A_eff, options.N.value_or(0));
  return r;
}

Json json(const Section& section, const Results& r) {
  Json interaction = Json::array();
  for (const Interaction& point : r.curve) interaction.push_back({{"N", point.N}, {"M", point.M}});
  Json result{{"area", section.area()},
              {"centroid", {section.centroid().x, section.centroid().y}},
              {"N", number(r.c.N)},
              {"Nc", number(r.c.Nc)},
              {"Q", number(r.shear.Q)},
              {"M", number(r.c.M)},
              {"M_reverse", number(r.c.M_reverse)},
              {"pna", number(r.c.pna)},
              {"EA", number(r.where_known(r.e.EA))},
              {"EI", number(r.where_known(r.e.EI))},
              {"elastic_centroid", {r.e.centroid.x, r.e.centroid.y}},
              {"I", number(r.e.I)},
              {"W_elastic", number(r.e.W_elastic)},
              {"W_plastic", number(r.e.W_plastic)},
              {"shape_factor", number(r.e.shape_factor)},
              {"yield_moment", number(r.e.yield_moment)},
              {"interaction", interaction},
              {"principal",
               {{"angle", r.axes.angle}, {"I_max", number(r.axes.I_max)}, {"I_min", number(r.axes.I_min)}}},
              {"I_yz", number(r.axes.I_yz)},
              {"radii_of_gyration", {number(r.radii[0]), number(r.radii[1])}},
              {"A_v", number(r.shear.A_v)},
              {"A_v_by", r.shear.source},
              {"remarks", r.remarks}};
  if (r.classes)
    result["class"] = {{"compression", r.classes->compression},
                       {"bending", r.bending_class ? Json(*r.bending_class) : Json(nullptr)}};
  if (r.classes) result["A_eff"] = number(r.A_eff);
  if (r.used)
    result["utilisation"] = {{"N", number(r.used->N)},
                             {"Q", number(r.used->Q)},
                             {"M", number(r.used->M)},
                             {"together", number(r.used->together)},
                             {"first_fibre", number(r.used->elastic)}};
  return result;
}

std::string table(const Options& options, const Subject& subject, const Section& section, const Results& r) {
  std::string table = fmt::format("{}, bending direction {:g} degrees\n", subject.name, options.angle);
  const auto row = [&](const char* name, double value, const char* unit, const char* meaning = "") {
    table += fmt::format("{:<13} {:>14}", name, shown(value));
    if (*unit || *meaning) table += fmt::format(" {:<{}} {}", unit, *meaning ? 5 : 0, meaning);
    while (table.back() == ' ') table.pop_back();
    table += '\n';
  };
  const auto [low, high] = section.extent(r.d);
  const auto place = [size = high - low](double x) {
    return std::abs(x) < 1e-12 * size ? 0 : x;
  };  // rounding
  row("area", section.area(), "m2");
  row("centroid x", place(section.centroid().x), "m");
  row("centroid y", place(section.centroid().y), "m");
  row("N", r.c.N, "N", "full tension");
  row("Nc", r.c.Nc, "N", "full compression");
  row("Q", r.shear.Q, "N", "full shear, A_v tau_y");
  row("A_v", r.shear.A_v, "m2", r.shear.source);
  row("M", r.c.M, "N m", "fully plastic, the side toward the direction in tension");
  row("M_reverse", r.c.M_reverse, "N m", "fully plastic, the other side in tension");
  row("pna", place(r.c.pna), "m", "plastic neutral axis of M, along the direction");
  row("EA", r.where_known(r.e.EA), "N");
  row("EI", r.where_known(r.e.EI), "N m2");
  row("I", r.e.I, "m4");
  row("W_elastic", r.e.W_elastic, "m3");
  row("W_plastic", r.e.W_plastic, "m3");
  row("shape_factor", r.e.shape_factor, "", "M / yield moment");
  row("yield_moment", r.e.yield_moment, "N m", "first fibre yields");
  row("principal", r.axes.angle, "deg", "direction of I_max");
  row("I_max", r.axes.I_max, "m4");
  row("I_min", r.axes.I_min, "m4");
  row("I_yz", r.axes.I_yz, "m4", "of the drawn axes through the centroid");
  row("i_max", r.radii[0], "m", "radius of gyration of I_max");
  row("i_min", r.radii[1], "m");
  if (r.classes) {
    row("class", r.classes->compression, "", "in compression, EN 1993-1-1 Table 5.2");
    if (r.bending_class) row("", *r.bending_class, "", "in bending");
    if (r.classes->compression == 4) row("A_eff", r.A_eff, "m2", "in compression, EN 1993-1-5 4.4");
  }
  if (r.used) {
    row("N used", r.used->N, "");
    row("Q used", r.used->Q, "");
    row("M used", r.used->M, "");
    row("all used", r.used->together, "", "N, Q and M together, plastic");
    row("first fibre", r.used->elastic, "", "N and M together, elastic");
  }
  for (const std::string& note : r.remarks) table += note + "\n";
  return table;
}

std::string run(const Options& options) {
  const Outputs outputs{{"--picture", options.pictures}};
  keep_apart(outputs);
  keep_inputs({options.file}, outputs);
  const Subject subject = read(options);
  const Section section = in_file(options.file, [&] { return Section(subject.regions); });
  const Results r = results(options, subject, section);
  if (!options.pictures.empty()) {
    NewFiles files(outputs);
    files.write_pictures(options.pictures, section_svg(section, r.d, title_of(options.file)));
    files.keep();
  }
  return options.json ? json(section, r).dump() + "\n" : table(options, subject, section, r);
}

}  // namespace

void add_section(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("section", "What a cross-section can carry: its capacities about one direction");
  command->add_option("FILE", options->file, "section file, or a profile's name: IPE300")->required();
  command->add_option("--material", options->material, "of a profile: a built-in material (S235)");
  for (const auto& [name, value, what] :
       {std::tuple{"--N", &options->N, "acting axial force, N, tension positive"},
        std::tuple{"--Q", &options->Q, "acting shear force, N"},
        std::tuple{"--M", &options->M,
                   "acting moment, N m, positive with the side toward the direction in tension"}})
    command->add_option(name, *value, what)->check(finite(-std::numeric_limits<double>::infinity()));
  command->add_option("--angle", options->angle, "bending direction in degrees from the x axis")
      ->check(finite(-std::numeric_limits<double>::infinity()))
      ->capture_default_str();
  add_picture(command, options->pictures, "draw the section at its plastic moment, and its N-M curve");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
