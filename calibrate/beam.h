// A strip under its own weight as a beam, and how far a chain of rigid pieces with hinges between them is
// from it.
#pragma once

#include <cstddef>
#include <vector>

#include "ductile/section.h"
#include "holes.h"

namespace ductile::calibration {

/// A place at which a line bends: rotation = length · curvature.
struct Hinge {
  Place place;
  double length;  // ℓ
};

/// A stretch of the line, s from 0 where it is held on, as a beam: hinges so close that they are one. What it
/// weighs beyond its parts, and where: weight and first moment.
struct Beam {
  std::vector<Hinge> parts;
  std::vector<double> weight;
  std::vector<Point> first;

  /// In n equal parts from a to b, backwards where b < a; `straight`: as if it ran along x.
  Beam(const std::vector<Place>& line, double a, double b, std::size_t n, bool straight);

  double extent() const { return static_cast<double>(parts.size()) * parts.front().length; }

  /// The moments about a place of what weighs beyond it along x and along y.
  Point moments(const Place& p) const;
};

/// How far a beam's part goes, but for a quarter turn, E and the depth, under weight along x and along y.
struct Displacement {
  Point x, y;
};

/// A beam clamped at its start, free at its end, bending at `hinges`: u(s) = Σ_{s_i < s} θ_i · (r(s) − r_i).
std::vector<Displacement> cantilever(const Beam& beam, const std::vector<Hinge>& hinges);

/// A straight beam held at both ends, clamped or not, under weight across it.
std::vector<Displacement> held_at_both_ends(const Beam& beam, const std::vector<Hinge>& hinges, bool clamped);

struct Deviation {
  double most = 0, error = 0;  // displacement, and how far the chain's is from it
};

/// How far a chain is from its beam, under weight along x or y, whichever is worse, unless that hardly bends
/// it.
Deviation compare(const std::vector<Displacement>& beam, const std::vector<Displacement>& chain);

}  // namespace ductile::calibration
