#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <string>

#include "ductile/files.h"

namespace {
using namespace ductile;
namespace fs = std::filesystem;

/// An empty folder of its own.
class NewFiles : public testing::Test {
 protected:
  NewFiles() { fs::create_directory(folder); }
  ~NewFiles() override { fs::remove_all(folder); }

  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder))
      files[entry.path().filename().string()] = read_text(entry.path());
    return files;
  }

  /// How a process ends that writes two files, one of them over another, and then gets a signal.
  int writing_ended_by(int signal, void (*disposition)(int) = SIG_DFL) const {
    const pid_t child = ::fork();
    if (child == 0) {
      ::signal(signal, disposition);
      write_text(folder / "kept", "kept");
      NewFile old(folder / "old"), fresh(folder / "fresh");
      for (NewFile* file : {&old, &fresh}) {
        file->write("new");
        file->close();
      }
      ::raise(signal);
      old.keep();
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
  }

  const fs::path folder = fs::path(testing::TempDir()) / ("new_files" + std::to_string(::getpid()));
  using Files = std::map<std::string, std::string>;
};

TEST_F(NewFiles, LeaveNothingWhereASignalEndsTheProgram) {
  write_text(folder / "old", "old");
  for (const int signal : {SIGHUP, SIGINT, SIGTERM}) {
    const int status = writing_ended_by(signal);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_EQ(files(), (Files{{"kept", "kept"}, {"old", "old"}})) << signal;
  }
}

TEST_F(NewFiles, AreWrittenOnWhereASignalIsIgnored) {
  write_text(folder / "old", "old");
  EXPECT_EQ(writing_ended_by(SIGHUP, SIG_IGN), 0);
  EXPECT_EQ(files().at("old"), "new");
}

}  // namespace
