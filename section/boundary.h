// The rings of all regions of a section as one array of vertices, and what is known of stretches of it
// beforehand.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "ductile/section.h"

namespace ductile {

/// Coordinates are relative to a local origin: an outline 10⁶ m away loses nothing but what its own
/// coordinates lost.
struct Boundary {
  /// All but strengths, reach and runs.
  explicit Boundary(std::span<const Region> regions);

  Point origin;                 // middle of the bounding box
  std::vector<Point> local;     // coordinate − origin, rounded
  std::vector<Point> residual;  // what the rounding left off, so that local + residual is exact

  struct Loop {
    std::size_t begin = 0, end = 0;  // vertices begin … end; the last repeats the first
    std::size_t region = 0;
    bool hole = false;
    double strength = 0;  // h = (f_t + f_c)/2, Pa; negative where the solid is not on the left of the edges
    double length = 0;    // of its edges, m
    double length2 = 0;   // Σ (length of an edge)², m²
  };
  std::vector<Loop> loops;

  /// A few edges in a row. Most runs lie wholly on one side of a line; then these sums are all that it needs
  /// of them.
  struct Run {
    std::size_t begin = 0, end = 0;  // vertices begin … end
    double strength = 0;             // of its loop
    Point centre, half;              // bounding box
    double dx = 0, dy = 0;           // strength · ∫ dx, ∫ dy
    double x_dx = 0, x_dy = 0, y_dx = 0, y_dy = 0;
    double xx_dx = 0, xx_dy = 0, xy_dx = 0, xy_dy = 0, yy_dx = 0, yy_dy = 0;
  };
  std::vector<Run> runs;

  double radius = 0;     // m: no vertex is farther from the origin
  double magnitude = 0;  // m: no coordinate as given is larger
  double reach = 0;      // N/m: Σ |strength| · length of all edges

  /// What rounding may leave, in double, of a sum that adds up to `total` from edges of Σ (weight · length)²
  /// = `scatter`². Each edge adds up to ε·radius·weight·length of either sign, each run up to ε·total. In
  /// 20000 sections against twice the precision the error was never more than 1.2 times this.
  double rounding(double scatter, double total) const {
    return std::numeric_limits<double>::epsilon() *
           (radius * scatter + (3 + static_cast<double>(runs.size()) / 300) * std::abs(total));
  }

  /// Makes the runs, once the strengths are known.
  void summarise();

 private:
  void add(const Ring& ring, bool hole, std::size_t region);
};

}  // namespace ductile
