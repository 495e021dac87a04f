// Where the page's plots come from.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "ductile/files.h"
#include "ductile/report.h"
#include "report_page.h"

namespace ductile {

std::string plotly_text() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  const std::filesystem::path folder =
      cache != nullptr && *cache != 0 ? std::filesystem::path(cache) / "ductile"
      : home != nullptr && *home != 0 ? std::filesystem::path(home) / ".cache/ductile"
                                      : std::filesystem::temp_directory_path() / "ductile";
  ::setenv("DUCTILE_PLOTLY_SCRIPT", plotly_script, 1);
  ::setenv("DUCTILE_PLOTLY_FOLDER", folder.c_str(), 1);
  std::FILE* pipe = ::popen("sh -c \"$DUCTILE_PLOTLY_SCRIPT\" plotly \"$DUCTILE_PLOTLY_FOLDER\"", "r");
  if (pipe == nullptr) throw std::runtime_error("sh cannot be run, which gets plotly.js for the page");
  std::string file;
  for (std::array<char, 256> part; std::fgets(part.data(), part.size(), pipe) != nullptr;)
    file += part.data();
  if (::pclose(pipe) != 0) throw std::runtime_error("no report without its plots (the reason stands above)");
  while (!file.empty() && file.back() == '\n') file.pop_back();
  return read_text(file);
}

}  // namespace ductile
