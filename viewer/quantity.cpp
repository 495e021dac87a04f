#include "quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace ductile::viewer {
namespace {

struct Unit {
  std::string_view name;
  double factor;  // of a plain one
  std::string_view plain;
};

std::optional<Unit> unit_of(std::string_view name) {
  static constexpr std::array<std::string_view, 10> plain{"m",   "N",    "Nm",  "Pa", "rad",
                                                          "m/s", "m/s²", "N/m", "g",  "g/m³"};
  static constexpr std::array others{Unit{"in", 0.0254, "m"},   Unit{"ft", 0.3048, "m"},
                                     Unit{"N/mm²", 1e6, "Pa"},  Unit{"N/mm2", 1e6, "Pa"},
                                     Unit{"N/mm", 1e3, "N/m"},  Unit{"°", std::numbers::pi / 180, "rad"},
                                     Unit{"t", 1e6, "g"},       Unit{"deg", std::numbers::pi / 180, "rad"},
                                     Unit{"t/m³", 1e6, "g/m³"}, Unit{"t/m3", 1e6, "g/m³"},
                                     Unit{"kg/m3", 1e3, "g/m³"}};
  static constexpr std::array<std::pair<std::string_view, double>, 9> prefixes{{{"", 1},
                                                                                {"n", 1e-9},
                                                                                {"µ", 1e-6},
                                                                                {"m", 1e-3},
                                                                                {"c", 1e-2},
                                                                                {"k", 1e3},
                                                                                {"M", 1e6},
                                                                                {"G", 1e9},
                                                                                {"T", 1e12}}};
  for (const Unit& other : others) {
    if (name == other.name) return other;
  }
  for (const auto& [prefix, factor] : prefixes) {
    if (!name.starts_with(prefix)) continue;
    const auto of = std::find(plain.begin(), plain.end(), name.substr(prefix.size()));
    if (of != plain.end()) return Unit{name, factor, *of};
  }
  return std::nullopt;
}

}  // namespace

std::string si(double value, const char* unit) {
  constexpr std::array prefixes{"n", "µ", "m", "", "k", "M", "G", "T"};
  if (!std::isfinite(value)) return "–";
  if (value == 0) return fmt::format("0 {}", unit);
  // The prefix of the number as it is written: 999.96 is 1 k.
  const double written = std::stod(fmt::format("{:.3e}", std::abs(value)));
  const double k = std::clamp(std::floor(std::log10(written) / 3), -3., 4.);
  return fmt::format("{:.4g} {}{}", value / std::pow(1000., k), prefixes[static_cast<std::size_t>(k + 3.)],
                     unit);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "–";
  return fmt::format("{:.{}f} %", 100 * share, std::abs(share) < 0.1 ? 2 : 1);
}

std::optional<double> typed(std::string_view text, std::string_view unit) {
  const auto dense = [](std::string_view from) {
    std::string to;
    std::copy_if(from.begin(), from.end(), std::back_inserter(to), [](char c) { return c != ' '; });
    return to;
  };
  const std::string all = dense(text), expected = dense(unit);
  std::size_t read = 0;
  double value = 0;
  try {
    value = std::stod(all, &read);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const std::string own = all.substr(read);
  if (!std::isfinite(value)) return std::nullopt;
  if (own.empty() || own == expected) return value;
  const auto from = unit_of(own), to = unit_of(expected);
  if (!from || !to || from->plain != to->plain) return std::nullopt;
  return value * (from->factor / to->factor);
}

}  // namespace ductile::viewer
