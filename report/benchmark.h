// A row of the benchmarks: what the literature or a closed form has, and what ductile makes of it.
#pragma once

#include <string>
#include <vector>

#include "case.h"

namespace ductile::report {

struct Benchmark {
  std::string problem;
  std::string source;  // author, year, equation or table
  std::string read;    // the source itself, a secondary one, or a closed form worked out here
  std::string input;   // all that it takes to repeat it
  std::string quantity;
  double reference, ours;
  double allowed;  // relative deviation
  double deviation() const { return ours / reference - 1; }
};

/// In equilibrium.
std::vector<Benchmark> static_benchmarks(const Context& context);
/// The same, of frames and arches.
std::vector<Benchmark> frame_benchmarks();
/// Frames that programs are calibrated with: by plastic zones, which hinges at points stand for.
std::vector<Benchmark> calibration_benchmarks();
/// Vogel's portal, model by model: the factor on all loads at collapse.
struct VogelsPortal {
  std::string model;
  double factor;
};
std::vector<VogelsPortal> vogels_portal_by_model();
/// The factor on all loads at which his frame collapses, each bar in so many parts.
double vogels_six_storeys(int parts);
/// Hinges in their order, and loads that come and go.
std::vector<Benchmark> repeated_benchmarks();
/// In motion, at small steps and at 60 Hz.
std::vector<Benchmark> motion_benchmarks(const Context& context);
/// Blows, and bodies that fly.
std::vector<Benchmark> blow_benchmarks(const Context& context);
/// Blows that are over in two steps at 60 Hz, and one that an estimate stands beside.
std::vector<Benchmark> strong_blow_benchmarks(const Context& context);
/// What was measured on structures that were built; allowed is the deviation that its reason explains.
std::vector<Benchmark> experiment_benchmarks();

}  // namespace ductile::report
