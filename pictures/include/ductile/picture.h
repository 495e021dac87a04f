// Pictures of sections, of plans and of their runs, as SVG.
//
// A picture of a plan shows one plan in panels of one view and scale: pieces, the cuts between them, joints,
// loads, with a legend and a scale bar. As drawn, joints are coloured by their plastic moment; in a run, by
// how far they are on their way to breaking (colours.h). What is under the pointer tells its name and
// numbers. Discs, outlines and poses that reach far beyond what moves at the start are clipped at the panel's
// edge.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/simulation.h"

namespace ductile {

/// One state of the plan.
struct Panel {
  std::string title;
  std::optional<double> time;        ///< s: loads as they are then; none: at their full size
  std::vector<PieceReading> pieces;  ///< by Plan::pieces; empty: as drawn
  std::vector<JointReading> joints;  ///< by Plan::joints; empty: coloured by plastic moment
  /// By Plan::pieces: small displacements, instead of `pieces`, drawn so many times as large.
  std::vector<Motion> motions;
  double times = 1;
  std::vector<int> hinges;  ///< joints that flow in a mechanism
  bool numbered = false;    ///< hinges, in their order
  /// What the pieces carry instead, of the joints' forces and the plan's loads at their full size: axial and
  /// shear forces, positive as the joints' above the line, or left of one that stands; moments on the side in
  /// tension.
  std::optional<Row> diagram;
  std::vector<Motion> gone;  ///< by Plan::pieces: the diagram's equilibrium is in that state; empty: as drawn
};

/// The round number (1, 2 or 5 times a power of ten) by which displacements are seen best: the largest is
/// then about a tenth of the structure.
double exaggeration(const Plan& plan, const std::vector<Motion>& motions);

/// The simulation as it is now.
Panel panel_of(const Simulation& simulation, std::string title);

struct PictureDef {
  std::string title;
  std::string subtitle;
  std::vector<Panel> panels;  ///< up to three beside each other, then the next row; at least one
  double width = 1000;        ///< px
};

/// The SVG document. Each piece is a `<g class="piece">`, each joint a `<g class="joint">`, whose `<title>`
/// begins with its name.
std::string picture_svg(const Plan& plan, const PictureDef& picture);

/// A section at its plastic moment about `direction` (any length > 0), the side toward it in tension, and its
/// N–M curve about the centroid.
std::string section_svg(const Section& section, Point direction, const std::string& title);

/// What a file of that name holds of an SVG document: the document as it is, or, by a name that ends in .png,
/// in two pixels per px by the program rsvg-convert. A problem where the name ends otherwise, or that program
/// is not installed.
std::string picture_bytes(const std::filesystem::path& file, std::string_view svg);
/// The same written to that file.
void write_picture(const std::filesystem::path& file, std::string_view svg);

}  // namespace ductile
