#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
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
  if (text.starts_with("\x1F\x8B"))
    refuse("is compressed by gzip", "unpack it: gunzip -c FILE.svgz >FILE.svg");
  return text;
}

namespace {
[[noreturn]] void cannot_write(const fs::path& file) {
  throw std::system_error(errno ? errno : EIO, std::generic_category(), "cannot write " + file.string());
}
}  // namespace

NewFile::NewFile(const fs::path& file) : target_(file), fresh_(file) {
  if (fs::is_regular_file(file)) target_ = fs::canonical(file);  // a link stays, what it shows is replaced
  if (!fs::exists(file) || fs::is_regular_file(file)) {
    fresh_ = target_;
    fresh_ += ".new" + std::to_string(::getpid());
  }
  errno = 0;
  out_.open(fresh_, std::ios::binary);
  if (!out_) cannot_write(target_);
}

NewFile::~NewFile() {
  std::error_code ignored;
  if (fresh_ != target_) fs::remove(fresh_, ignored);
}

void NewFile::write(std::string_view text) {
  if (!out_.write(text.data(), static_cast<std::streamsize>(text.size()))) cannot_write(target_);
}

void NewFile::keep() {
  out_.close();
  if (!out_) cannot_write(target_);
  if (fresh_ != target_) fs::rename(fresh_, target_);
}

void write_text(const fs::path& file, std::string_view text) {
  NewFile fresh(file);
  fresh.write(text);
  fresh.keep();
}

}  // namespace ductile
