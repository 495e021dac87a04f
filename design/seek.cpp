#include "seek.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace ductile {

std::string governing(const Plan& plan, const StaticCheck& check) {
  if (check.first_to_yield.empty()) return "nothing: no load makes a joint yield";
  const auto first = static_cast<std::size_t>(check.first_to_yield.front());
  const auto& usage = check.joints[first].usage;
  const std::array rows{std::pair(usage.N, "N"), std::pair(usage.Q, "Q"), std::pair(usage.M, "M")};
  const auto most = std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return !(a.first >= b.first);  // NaN, of an unlimited row, is least
  });
  return std::string(most->second) + " of " + plan.joints[first].name;
}

namespace {

// Newton in logarithms, with the power from the last two; a step to where there is no result is halved.
std::optional<double> factor_along(double power, double target, const std::function<double(double)>& result) {
  double x = 1, f = result(x);
  const auto is_there = [](double value) { return value > 0 && value < unlimited; };
  for (int i = 0; i < 60 && is_there(f); ++i) {
    const double missing = target / f;
    if (std::abs(missing - 1) < 1e-10) return x;
    double step = std::clamp(std::pow(missing, 1 / power), 1.0 / 16, 16.0), next = x * step, value = 0;
    if (!(next > 1e-12 && next < 1e12)) break;
    for (int halved = 0; !is_there(value = result(next)) && halved < 40; ++halved)
      step = std::sqrt(step), next = x * step;
    if (!is_there(value)) break;
    const double seen = std::log(value / f) / std::log(step);
    if (!(std::abs(seen) > 1e-6)) break;  // something else governs
    power = std::copysign(std::clamp(std::abs(seen), 0.05, 10.0), power);
    x = next;
    f = value;
  }
  return std::nullopt;
}

}  // namespace

double factor_for(double target, const std::function<double(double)>& result,
                  const std::function<std::string()>& why_not, double power) {
  if (const auto x = factor_along(power, target, result)) return *x;
  const std::string why = why_not();
  if (const auto x = factor_along(-power, target, result)) return *x;
  const double now = result(1);
  const bool changes = std::abs(result(2) - now) > 1e-9 * std::abs(now);
  throw InvalidInput(
      {{"target", "no number reaches it: " + why + (changes ? "" : ", and the same whatever that number is"),
        "change what governs, or the target"}});
}

}  // namespace ductile
