#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "ductile/files.h"
#include "ductile/picture.h"

extern char** environ;

namespace ductile {
namespace fs = std::filesystem;

namespace {

/// A name of its own in the folder for such things; the file goes with this.
struct Scratch {
  explicit Scratch(const char* ending)
      : file(fs::temp_directory_path() / ("ductile" + std::to_string(::getpid()) + ending)) {}
  ~Scratch() {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const fs::path file;
};

#ifdef __EMSCRIPTEN__
int run(const std::vector<std::string>&) { return 127; }  // in a browser there is none
#else
/// Runs a program without a shell in between; its exit code, 127 where there is no such program.
int run(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0) return 127;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}
#endif

}  // namespace

std::string picture_bytes(const fs::path& file, std::string_view svg) {
  if (file.extension() == ".svg") return std::string(svg);
  if (file.extension() != ".png") {
    throw InvalidInput({{file.string() + ":name", "is neither .svg nor .png", "name a picture so"}});
  }
  const Scratch drawing(".svg"), pixels(".png");
  write_text(drawing.file, svg);
  const int code =
      run({"rsvg-convert", "--zoom", "2", "--output", pixels.file.string(), drawing.file.string()});
  if (code == 127) {
    throw InvalidInput({{file.string() + ":name", "needs rsvg-convert, which is not here",
                         "install it (Debian: librsvg2-bin), or name an .svg"}});
  }
  if (code != 0) throw std::runtime_error("rsvg-convert failed for " + file.string());
  return read_text(pixels.file);
}

void write_picture(const fs::path& file, std::string_view svg) { write_text(file, picture_bytes(file, svg)); }

}  // namespace ductile
