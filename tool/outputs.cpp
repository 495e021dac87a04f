// The files that a command writes: none is one that it reads or writes already, and all appear together.
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "command.h"
#include "ductile/picture.h"

namespace ductile::tool {

namespace {

/// A device or a pipe is no such file: it may be named twice.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;  // what is not there is no file of this name
  if (std::filesystem::is_other(a, none)) return false;
  if (std::filesystem::equivalent(a, b, none)) return true;
  const auto whole = [&](const std::filesystem::path& file) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file, none), none);
  };
  return !whole(a).empty() && whole(a) == whole(b);
}

/// Each option with each file that it names.
std::vector<std::pair<std::string, std::string>> single(const Outputs& outputs) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const auto& [option, files] : outputs)
    for (const std::string& file : files)
      if (!file.empty()) all.emplace_back(option, file);
  return all;
}

}  // namespace

void keep_apart(const Outputs& outputs) {
  const auto all = single(outputs);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (is_same_file(all[i].second, all[j].second))
        throw InvalidInput({{"command line:" + all[i].first,
                             "'" + all[i].second + "' is the file of " + all[j].first + ", too",
                             "give another one: one of them would be lost"}});
}

void keep_inputs(const std::vector<std::string>& inputs, const Outputs& outputs) {
  for (const auto& [option, file] : single(outputs))
    for (const std::string& input : inputs)
      if (is_same_file(input, file))
        throw InvalidInput({{"command line:" + option, "'" + file + "' is the file that is read",
                             "give another one: it would be lost"}});
}

NewFiles::NewFiles(const Outputs& outputs) {
  for (const auto& [option, file] : single(outputs)) files_.try_emplace(file, file);
}

void NewFiles::write(const std::string& file, std::string_view text) { files_.at(file).write(text); }

void NewFiles::write_pictures(const std::vector<std::string>& files, std::string_view svg) {
  for (const std::string& file : files) write(file, picture_bytes(file, svg));
}

void NewFiles::keep() {
  for (auto& [name, file] : files_) file.close();
  for (auto& [name, file] : files_) file.keep();
}

}  // namespace ductile::tool
