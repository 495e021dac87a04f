// What npm brings, and what is run with it.
#pragma once

#include <optional>
#include <string>

namespace ductile::report {

/// What a script of sh prints that is told a folder of the user's cache to keep things in, and one argument
/// more; nothing where it fails, having said why on stderr.
std::optional<std::string> run_with_cache(const std::string& script, const std::string& argument = "");

}  // namespace ductile::report
