// What there was to see after a step: enough to draw the scene and to read every number of it.
#pragma once

#include <optional>
#include <vector>

#include "ductile/ledger.h"
#include "ductile/plane.h"
#include "ductile/simulation.h"

namespace ductile::viewer {

struct Pose {
  Point position;  ///< m, of the centre of mass
  double angle = 0;
};

/// How far the first vehicle that was sent across has come.
struct Crossing {
  double share = 0;  ///< of the way, from 0 to 1
  enum class State {
    on_its_way,
    across,
    down  ///< on its roof, or its middle deeper below the lowest point of its road as drawn than half its
          ///< length
  } state = State::on_its_way;
};

struct Frame {
  double time = 0;  ///< s
  std::vector<PieceReading> pieces;
  std::vector<JointReading> joints;
  std::optional<Crossing> crossing;  ///< once across or down, it stays so
  std::vector<float> peaks;          ///< of each joint, the farthest stage (colours.h) so far
  std::vector<Pose> thrown;          ///< bodies that a user added while it ran
  Energy energy;                     ///< with the direct solver all of it, else what is stored and dissipated
  StepReport report;                 ///< zero with stock joints
  double step_us = 0;                ///< µs: b2World::Step alone

  /// Bytes of memory.
  std::size_t size() const;
};

/// The present state of a simulation (without what a user added).
Frame see(Simulation& simulation);

/// A joint where it is in a frame: its axis turns with the bodies, the anchor is in the middle of both sides.
struct Placed {
  Point anchor;
  Point axis;  ///< unit
};
Placed place(const Plan& plan, std::size_t joint, const Frame& frame);

/// A point that was at `at` at t = 0, on piece `piece` as it is in a frame; −1: the ground.
Point carried(const Plan& plan, int piece, Point at, const Frame& frame);

}  // namespace ductile::viewer
