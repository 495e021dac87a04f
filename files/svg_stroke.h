// The area that a stroke covers.
#pragma once

#include <vector>

#include "svg_path.h"

namespace ductile::svg {

/// How a line is drawn, as SVG 1.1 §11.4 has it; lengths in the line's own units.
struct Pen {
  enum Cap { butt, round_cap, square } cap = butt;
  enum Join { miter, round_join, bevel } join = miter;
  double width = 1;
  double miter_limit = 4;
  std::vector<double> dashes;  ///< lengths of dash, gap, dash, …; empty: a whole line
  double dash_offset = 0;
};

/// Rings that together, by the non-zero rule, cover what the pen draws; round joins and caps within the
/// tolerance. Throws ShapeError where there are more than 10,000 dashes.
std::vector<Ring> stroke(const std::vector<Polyline>& lines, const Pen& pen, double tolerance);

}  // namespace ductile::svg
