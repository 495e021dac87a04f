#include "recent.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <string>
#include <system_error>

#include "ductile/files.h"

namespace ductile::viewer {

namespace fs = std::filesystem;

Recent::Recent(fs::path list) : list_(std::move(list)) {
  std::ifstream in(list_);
  std::error_code none;
  for (std::string line; std::getline(in, line);)
    if (fs::exists(line, none)) files_.emplace_back(line);
}

fs::path Recent::usual_list() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
    return fs::path(state) / "ductile" / "recent";
  const char* home = std::getenv("HOME");
  return home && *home ? fs::path(home) / ".local/state/ductile/recent" : fs::path();
}

void Recent::add(const fs::path& file) {
  constexpr std::size_t most = 12;
  std::error_code none;
  const fs::path whole = fs::absolute(file, none);
  if (!fs::exists(whole, none)) return;  // a new scene, before it is saved
  std::erase(files_, whole);
  files_.insert(files_.begin(), whole);
  if (files_.size() > most) files_.resize(most);
  if (list_.empty()) return;
  std::string text;
  for (const fs::path& each : files_) text += each.string() + '\n';
  fs::create_directories(list_.parent_path(), none);
  try {
    write_text(list_, text);
  } catch (const std::exception&) {  // where nothing can be kept, they are known until the window closes
  }
}

}  // namespace ductile::viewer
