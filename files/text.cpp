#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "ductile/files.h"

namespace ductile {
namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  constexpr std::size_t most = std::size_t{256} << 20;
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw InvalidInput({{file.string() + ":file", what, remedy}});
  };
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) refuse("is a folder", "name a file");
  std::ifstream in(file, std::ios::binary);
  if (!in)
    refuse("cannot be opened (" + std::generic_category().message(errno) + ")", "name a readable file");
  std::string text;
  std::string block(std::size_t{1} << 16, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    text.append(block, 0, static_cast<std::size_t>(in.gcount()));
    if (text.size() > most) refuse("is larger than 256 MiB", "split it into smaller files");
  }
  if (in.bad()) refuse("cannot be read", "name a readable file");
  return text;
}

void write_text(const fs::path& file, std::string_view text) {
  const auto fail = [&] {
    throw std::system_error(errno ? errno : EIO, std::generic_category(), "cannot write " + file.string());
  };
  const auto write = [&](const fs::path& path) {
    errno = 0;
    std::ofstream out(path, std::ios::binary);
    if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush()) fail();
  };
  // A device or a pipe is written to, not replaced; a link stays a link to what is replaced.
  if (fs::exists(file) && !fs::is_regular_file(file)) return write(file);
  const fs::path target = fs::exists(file) ? fs::canonical(file) : file;
  fs::path fresh = target;
  fresh += ".new" + std::to_string(::getpid());
  std::error_code ignored;
  try {
    write(fresh);
    fs::rename(fresh, target);
  } catch (...) {
    fs::remove(fresh, ignored);
    throw;
  }
}

}  // namespace ductile
