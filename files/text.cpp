// Whole files: read at once, unpacked where gzip packed them, and written so that none is ever half there.
#include <signal.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
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
  errno = 0;
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> in(gzopen(file.c_str(), "rb"), gzclose);
  if (!in)
    refuse("cannot be opened (" + std::generic_category().message(errno) + ")", "name a readable file");
  std::string text;
  std::string block(std::size_t{1} << 16, '\0');
  int got = 0;
  while ((got = gzread(in.get(), block.data(), static_cast<unsigned>(block.size()))) > 0) {
    text.append(block, 0, static_cast<std::size_t>(got));
    if (text.size() > most) refuse("is larger than 256 MiB", "split it into smaller files");
  }
  int error = Z_OK;
  const std::string said = gzerror(in.get(), &error);
  if (error == Z_ERRNO) refuse("cannot be read", "name a readable file");
  if (error != Z_OK) refuse("cannot be unpacked (" + said + ")", "pack it anew with gzip");
  return text;
}

namespace {
[[noreturn]] void cannot_write(const fs::path& file) {
  throw std::system_error(errno ? errno : EIO, std::generic_category(), "cannot write " + file.string());
}

/// The names of files that are not kept yet, of which a signal that ends the program removes the first 64.
std::array<std::atomic<const char*>, 64> unfinished;
static_assert(std::atomic<const char*>::is_always_lock_free);  // so that a signal may look at them

extern "C" void remove_unfinished(int signal) {
  for (const auto& file : unfinished) {
    if (const char* name = file.load()) ::unlink(name);
  }
  ::raise(signal);  // which ends the program now
}

/// Signals that the program ignores or takes itself stay its own.
void remove_at_signals() {
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    struct sigaction action = {};
    if (::sigaction(signal, nullptr, &action) != 0 || (action.sa_flags & SA_SIGINFO) ||
        action.sa_handler != SIG_DFL)
      continue;
    action.sa_handler = remove_unfinished;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(signal, &action, nullptr);
  }
}

/// Of two threads that finish files, each finds its own.
void exchange(const char* from, const char* to) {
  for (auto& file : unfinished) {
    const char* expected = from;
    if (file.compare_exchange_strong(expected, to)) return;
  }
}
}  // namespace

NewFile::NewFile(const fs::path& file) : target_(file), fresh_(file) {
  if (fs::is_regular_file(file)) target_ = fs::canonical(file);  // a link stays, what it shows is replaced
  if (!fs::exists(file) || fs::is_regular_file(file)) {
    fresh_ = target_;
    fresh_ += ".new" + std::to_string(::getpid());
    remove_at_signals();
    exchange(nullptr, fresh_.c_str());
  }
  errno = 0;
  out_.open(fresh_, std::ios::binary);
  if (!out_) {
    exchange(fresh_.c_str(), nullptr);
    cannot_write(target_);
  }
}

NewFile::~NewFile() {
  std::error_code ignored;
  if (fresh_ != target_) fs::remove(fresh_, ignored);
  exchange(fresh_.c_str(), nullptr);
}

void NewFile::write(std::string_view text) {
  if (!out_.write(text.data(), static_cast<std::streamsize>(text.size()))) cannot_write(target_);
}

void NewFile::close() {
  out_.close();
  if (!out_) cannot_write(target_);
}

void NewFile::keep() {
  if (out_.is_open()) close();
  if (fresh_ != target_) fs::rename(fresh_, target_);
}

void write_text(const fs::path& file, std::string_view text) {
  NewFile fresh(file);
  fresh.write(text);
  fresh.keep();
}

}  // namespace ductile
