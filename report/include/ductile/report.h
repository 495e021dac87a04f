// The report: error against run time, stability on stiff and extreme cases, what was left out. One page with
// plots, and the data behind it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ductile {

struct ReportOptions {
  std::filesystem::path out;  ///< a folder; made where it is not there
  bool quick = false;         ///< fewer sizes and shorter runs: at most a minute
  std::string only;           ///< the name of one case; empty: all
  std::string plotly;         ///< the text of plotly.js, which goes into the page
  std::function<void(const std::string& what, double share)> progress;  ///< called now and then; or empty
};

/// The text of plotly.js, basic bundle: from the user's cache, where npm brings it the first time. Throws
/// std::runtime_error after saying on stderr what is missing.
std::string plotly_text();

/// What there is to run, by name, in the order of the page.
std::vector<std::string> report_cases();

/// Runs the cases and writes out/index.html, out/data/CASE.json and out/data/CASE-TABLE.csv. A case whose
/// data are there already, complete, of this very program and as quick, is not run again. Returns what the
/// cases say of themselves, one line per claim. Throws std::system_error where a file cannot be written.
std::string make_report(const ReportOptions& options);

}  // namespace ductile
