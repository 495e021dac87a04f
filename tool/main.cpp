// The ductile command: its subcommands, what becomes of their output, and exit codes.
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "command.h"

namespace {
using namespace ductile;

enum Exit { done = 0, failed = 1, bad_input = 2 };

void print(const std::vector<Problem>& problems) {
  constexpr std::size_t most = 20;
  const std::size_t shown = problems.size() > most ? most - 1 : problems.size();
  for (std::size_t i = 0; i < shown; ++i) std::cerr << tool::one_line(to_string(problems[i])) << '\n';
  if (shown < problems.size()) {
    const std::string file = problems[shown].place.substr(0, problems[shown].place.find(':'));
    std::cerr << tool::one_line(file) << ":further: " << problems.size() - shown
              << " more problems; mend these first\n";
  }
}

int run(int argc, char** argv) {
  CLI::App app("Joints that bend, tear and absorb energy the way steel does, for Box2D bodies.", "ductile");
  app.set_version_flag("--version", DUCTILE_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Every command but report, which makes a page, prints a table, or with --json one JSON object. "
      "Exit 0: done, 1: our failure, 2: bad input.");
  std::string output;
  for (const auto add : {tool::add_section, tool::add_materials, tool::add_calibrate, tool::add_simulate,
                         tool::add_check, tool::add_limit, tool::add_design}) {
    add(app, output);
  }
#ifndef __EMSCRIPTEN__  // where the report has no programs to call, and the window is a page of its own
  tool::add_report(app, output);
  tool::add_view(app, output);
#endif
  try {
    Exit exit = done;
    try {
      app.parse(argc, argv);
    } catch (const tool::Unsolved& what) {
      std::cerr << "ductile: " << what.what() << '\n';
      exit = failed;
    }
    if (std::fwrite(output.data(), 1, output.size(), stdout) != output.size() || std::fflush(stdout) != 0) {
      throw std::runtime_error("stdout cannot be written");
    }
    return exit;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    const bool misnamed = argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty();
    const std::string what =
        tool::one_line(misnamed ? std::string("there is no command '") + argv[1] + "'" : error.what());
    const bool placed = what.find(": ") < what.find(' ');  // "--scale: -1 is not > 0"
    std::cerr << "command line:" << (placed ? "" : "arguments: ") << what
              << "; ductile --help lists commands and options\n";
    return bad_input;
  } catch (const InvalidInput& error) {
    print(error.problems());
    return bad_input;
  } catch (const std::exception& error) {
    std::cerr << "ductile: " << tool::one_line(error.what()) << '\n';
    return failed;
  }
}
}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (...) {
    return failed;  // not even the message found room
  }
}
