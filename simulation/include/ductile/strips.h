// What pieces carry between their joints: the ordinates of axial, shear and moment diagrams.
#pragma once

#include <functional>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/simulation.h"

namespace ductile::diagram {

/// A section through a piece, and what it carries there.
struct Station {
  Point at;                    ///< m, on the line of the piece's anchors
  double N = 0, Q = 0, M = 0;  ///< N, N, N m; of the sign that a joint there with the strip's axis would have
};

/// Along one straight piece, or from a joint to the middle of a piece that branches or turns a corner.
struct Strip {
  int piece = 0;
  Point axis;                     ///< unit
  bool whole = false;             ///< the piece from end to end
  std::vector<Station> stations;  ///< along the axis; two at one place where something acts there
};

/// By equilibrium of each moving piece under its joints' forces, the plan's loads at their full size, and its
/// weight, evenly along a straight piece, as drawn, or along axes that have turned by small motions (by
/// Plan::pieces; empty: none), as joints' do, and supports' and the world's do not. Pieces that are neither
/// cut nor long, as discs and blocks, have none.
std::vector<Strip> strips(const Plan& plan, const std::vector<JointReading>& joints,
                          const std::vector<Motion>& motions = {});

/// What is there to be in equilibrium with.
struct State {
  std::function<JointReading(std::size_t joint)> carries;
  std::function<Motion(int piece)> gone;  ///< null: as drawn
  double factor = 1;                      ///< on loads and weights
};
/// Of one piece.
std::vector<Strip> strips(const Plan& plan, int piece, const State& state);

}  // namespace ductile::diagram
