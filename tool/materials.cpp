// ductile materials: the built-in materials, and where their numbers are from.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "command.h"

namespace ductile::tool {
namespace {

std::string run(bool json) {
  if (json) {
    Json list = Json::array();
    for (const auto& [name, m, source] : materials::all())
      list.push_back({{"name", name},
                      {"fy", m.yield_stress},
                      {"fyc", m.compression()},
                      {"tau", m.shear()},
                      {"fu", std::max(m.ultimate_stress, m.yield_stress)},
                      {"E", m.youngs_modulus},
                      {"density", m.density},
                      {"fracture_strain", m.fracture_strain},
                      {"ductility", number(ductility(m))},
                      {"damping_ratio", m.damping_ratio},
                      {"source", source}});
    return Json{{"materials", list}}.dump() + "\n";
  }
  std::string table =
      fmt::format("{:<10} {:>6} {:>6} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8} {:>5}  {}\n", "", "fy", "fyc",
                  "tau", "fu", "E", "density", "eps_f", "eps_f", "zeta", "source");
  table += fmt::format("{:<10} {:>6} {:>6} {:>6} {:>6} {:>6} {:>8} {:>8} {:>8}\n", "", "MPa", "MPa", "MPa",
                       "MPa", "GPa", "kg/m3", "", "/ eps_y");
  for (const auto& [name, m, source] : materials::all())
    table += fmt::format(
        "{:<10} {:>6.4g} {:>6.4g} {:>6.4g} {:>6.4g} {:>6.4g} {:>8.4g} {:>8.2g} {:>8.3g} {:>5.2g}  {}\n", name,
        m.yield_stress / 1e6, m.compression() / 1e6, m.shear() / 1e6,
        std::max(m.ultimate_stress, m.yield_stress) / 1e6, m.youngs_modulus / 1e9, m.density,
        m.fracture_strain, ductility(m), m.damping_ratio, source);
  return table;
}

}  // namespace

void add_materials(CLI::App& app, std::string& output) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("materials", "The materials that files name, and where their numbers are from");
  command->add_flag("--json", *json, "one JSON object");
  command->callback([json, &output] { output = run(*json); });
}

}  // namespace ductile::tool
