#include "quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ductile::viewer {

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

}  // namespace ductile::viewer
