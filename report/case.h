// What a case of the report is, and what it hands back.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace ductile::report {

using Json = nlohmann::ordered_json;

struct Axis {
  std::string title;  // with its unit
  bool log = false;
};

/// One line or cloud of points of a figure.
struct Series {
  std::string name;
  std::string look;          // colour and symbol: series of one look are of one kind
  std::vector<double> x, y;  // a value ≤ 0 on a log axis is drawn at the axis' floor, and told as it is
  std::vector<double> low, high;  // of x: what a repeated measurement may give; empty: exact
  std::vector<std::string> told;  // shown on hover beside x and y
  std::vector<bool> marked;       // points drawn large: the default
  bool line = true;
};

struct Figure {
  std::string name;
  std::string group, tab;  // figures of one group share a place, and a row of tabs
  bool first = false;      // the tab that is open at first
  std::string title, caption;
  Axis x, y;
  std::vector<Series> series;
  double floor = 0;  // what a log axis of y shows a zero as
};

/// Cells that say "stands", "drifts" or "diverges", with a number each.
struct Matrix {
  std::string name, title, caption;
  std::vector<std::string> levels, columns;  // a column is "a|b|c", one head per level
  struct Cell {
    std::string verdict, told;
  };
  struct Row {
    std::string name;
    bool promised = false;  // in the domain that was fixed beforehand
    std::vector<Cell> cells;
  };
  std::vector<Row> rows;
};

struct Column {
  std::string name;       // with its unit: "time per step [us]"
  bool measured = false;  // by the clock: differs from run to run
};

struct Table {
  std::string name, title;
  std::vector<Column> columns;
  std::vector<std::vector<Json>> rows;
  bool open = false;  // shown at once
};

/// What the case must show, and whether it does.
struct Claim {
  std::string what, measured;
  bool holds = false;
  bool by_clock = false;
};

struct Result {
  std::string summary;            // one sentence with the numbers that matter, for the head of the page
  std::vector<std::string> text;  // paragraphs
  std::vector<Claim> claims;
  std::vector<Figure> figures;
  std::vector<Matrix> matrices;
  std::vector<Table> tables;
};

/// What a repeated measurement gave.
struct Spread {
  double median, low, high;
};

/// The spread of the repetitions within a run, but a share of them at either end, and by a quarter more:
/// whole runs, minutes apart, have been seen to differ by a fifth (memory, caches and clock of a shared
/// machine).
inline Spread spread(std::vector<double> ratios, double outside) {
  constexpr double between_runs = 1.25;
  std::sort(ratios.begin(), ratios.end());
  const auto n = ratios.size(), out = static_cast<std::size_t>(outside * static_cast<double>(n));
  return {ratios[n / 2], ratios[out] / between_runs, ratios[n - 1 - out] * between_runs};
}

/// What a case is told, and how it tells how far it is.
struct Context {
  bool quick = false;
  std::function<void(double share)> progress;
};

struct Case {
  const char* name;
  const char* title;
  Result (*run)(const Context&);
};

/// A new case is one of these, and its name in the list of report.cpp.
extern const Case benchmarks, sections, joints, discretisation, stability, interaction, leaving_out, growth,
    peers, extremes;

}  // namespace ductile::report
