#include <fmt/format.h>

#include <limits>
#include <numbers>

#include "command.h"
#include "ductile/files.h"
#include "ductile/picture.h"

namespace ductile::tool {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> pictures;
  double angle = 90;
  bool json = false;
};

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

std::string run(const Options& options) {
  const auto regions = read_section(options.file);
  const Section section = in_file(options.file, [&] { return Section(regions); });
  const Point d = direction(options.angle);
  const Point centroid = section.centroid();
  const Capacities c = section.capacities(d);
  const Elastic e = section.elastic(d);
  const bool elastic = e.EA > 0;
  const auto where_known = [&](double value) {
    return elastic ? value : std::numeric_limits<double>::quiet_NaN();
  };
  const auto curve = section.interaction(d, centroid.x * d.x + centroid.y * d.y);

  if (!options.pictures.empty()) {
    const std::string svg = section_svg(section, d, title_of(options.file));
    for (const std::string& file : options.pictures) write_picture(file, svg);
  }
  if (options.json) {
    Json interaction = Json::array();
    for (const Interaction& point : curve) interaction.push_back({{"N", point.N}, {"M", point.M}});
    const Json result{{"area", section.area()},
                      {"centroid", {centroid.x, centroid.y}},
                      {"N", number(c.N)},
                      {"Nc", number(c.Nc)},
                      {"Q", number(c.Q)},
                      {"M", number(c.M)},
                      {"M_reverse", number(c.M_reverse)},
                      {"pna", number(c.pna)},
                      {"EA", number(where_known(e.EA))},
                      {"EI", number(where_known(e.EI))},
                      {"elastic_centroid", {e.centroid.x, e.centroid.y}},
                      {"I", number(e.I)},
                      {"W_elastic", number(e.W_elastic)},
                      {"W_plastic", number(e.W_plastic)},
                      {"shape_factor", number(e.shape_factor)},
                      {"yield_moment", number(e.yield_moment)},
                      {"interaction", interaction}};
    return result.dump() + "\n";
  }

  std::string table = fmt::format("{}, bending direction {:g} degrees\n", options.file, options.angle);
  const auto row = [&](const char* name, double value, const char* unit, const char* meaning = "") {
    table += fmt::format("{:<13} {:>14}", name, shown(value));
    if (*unit || *meaning) table += fmt::format(" {:<{}} {}", unit, *meaning ? 5 : 0, meaning);
    while (table.back() == ' ') table.pop_back();
    table += '\n';
  };
  row("area", section.area(), "m2");
  row("centroid x", centroid.x, "m");
  row("centroid y", centroid.y, "m");
  row("N", c.N, "N", "full tension");
  row("Nc", c.Nc, "N", "full compression");
  row("Q", c.Q, "N", "full shear");
  row("M", c.M, "N m", "fully plastic, the side toward the direction in tension");
  row("M_reverse", c.M_reverse, "N m", "fully plastic, the other side in tension");
  row("pna", c.pna, "m", "plastic neutral axis of M, along the direction");
  row("EA", where_known(e.EA), "N");
  row("EI", where_known(e.EI), "N m2");
  row("I", e.I, "m4");
  row("W_elastic", e.W_elastic, "m3");
  row("W_plastic", e.W_plastic, "m3");
  row("shape_factor", e.shape_factor, "", "M / yield moment");
  row("yield_moment", e.yield_moment, "N m", "first fibre yields");
  return table;
}

}  // namespace

void add_section(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("section", "What a cross-section can carry: its capacities about one direction");
  command->add_option("FILE", options->file, "section file")->required();
  command->add_option("--angle", options->angle, "bending direction in degrees from the x axis")
      ->check(finite(-std::numeric_limits<double>::infinity()))
      ->capture_default_str();
  add_picture(command, options->pictures, "draw the section at its plastic moment, and its N-M curve");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
