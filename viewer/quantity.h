// Numbers as an engineer writes them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace ductile::viewer {

/// Four digits with an SI prefix: "-3.215 MN m"; "–" where there is none.
std::string si(double value, const char* unit);
/// "85.0 %", "0.25 %"; "–" where there is none.
std::string percent(double share);

/// What is typed where a number of `unit` is expected: "2.5" is of that unit, "2.5 MN" is 2500 kN, "1 ft" is
/// 0.3048 m; nothing where it is no number, or of something else.
std::optional<double> typed(std::string_view text, std::string_view unit);

}  // namespace ductile::viewer
