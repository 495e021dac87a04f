// Numbers as an engineer writes them.
#pragma once

#include <string>

namespace ductile::viewer {

/// Four digits with an SI prefix: "-3.215 MN m"; "–" where there is none.
std::string si(double value, const char* unit);
/// "85.0 %", "0.25 %"; "–" where there is none.
std::string percent(double share);

}  // namespace ductile::viewer
