// The files that were opened last, by this user, in any window.
#pragma once

#include <filesystem>
#include <vector>

namespace ductile::viewer {

class Recent {
 public:
  /// Kept in `list`, a name a line; empty: nowhere.
  explicit Recent(std::filesystem::path list = {});
  /// In $XDG_STATE_HOME, or else ~/.local/state.
  static std::filesystem::path usual_list();

  /// Those that are still there, the last one first.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  void add(const std::filesystem::path& file);

 private:
  std::filesystem::path list_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace ductile::viewer
