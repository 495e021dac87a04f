// Runs the built command as a user does, and keeps what it printed.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

namespace ductile {

inline std::string slurp(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// A folder of its own for one test, gone afterwards.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "ductile.XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  /// Writes a file; returns its path as an argument of the command.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return (path_ / name).string();
  }

 private:
  std::filesystem::path path_;
};

struct Ran {
  int exit;
  std::string out, err;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
  auto error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

/// `arguments` as a shell would read them.
inline Ran run(const std::string& arguments) {
  const Folder folder;
  const auto out = folder / "out", err = folder / "err";
  const int status = std::system((std::string(DUCTILE_COMMAND) + " " + arguments + " >" + out.string() +
                                  " 2>" + err.string() + " </dev/null")
                                     .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, slurp(out), slurp(err)};
}

/// Exit 2, nothing on stdout, from one to twenty lines on stderr, each `file:place: what; remedy`.
inline void expect_bad_input(const Ran& ran, const std::string& saying = "") {
  EXPECT_EQ(ran.exit, 2) << ran.err;
  EXPECT_EQ(ran.out, "");
  EXPECT_GE(ran.error_lines(), 1);
  EXPECT_LE(ran.error_lines(), 20);
  EXPECT_NE(ran.err.find(saying), std::string::npos) << ran.err;
  static const std::regex problem("[^:]+:[^:].*: .+; .+");
  std::istringstream lines(ran.err);
  for (std::string line; std::getline(lines, line);) EXPECT_TRUE(std::regex_match(line, problem)) << line;
}

}  // namespace ductile
