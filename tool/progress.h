// How far a long run is, on one line of a terminal.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace ductile::tool {

class Progress {
 public:
  void show(double share, const std::string& what = "") {
    const auto now = std::chrono::steady_clock::now();
    if (!terminal_ || now - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = now;
    started_ = true;
    const auto width = static_cast<int>(40 * share);
    fmt::print(stderr, "\r\33[K[{:#<{}}{:.<{}}] {:.0f} % {}", "", width, "", 40 - width, 100 * share, what);
    std::fflush(stderr);
  }
  ~Progress() {
    if (started_) std::fputs("\r\33[K", stderr);
  }

 private:
  const bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  bool started_ = false;
  std::chrono::steady_clock::time_point shown_ = std::chrono::steady_clock::now();
};

}  // namespace ductile::tool
