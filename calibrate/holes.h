// Sections along the centreline of a strip, less the holes that a cut across it would pass through.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "axis.h"
#include "ductile/section.h"

namespace ductile::calibration {

/// A place on the centreline, and the section there: per metre of depth and of what holes leave.
struct Place {
  double s = 0;  // m along it
  Point at;
  double width = 0;  // m, with the holes
  double area = 0;   // m
  double depth = 0;  // m, of a rectangle of the same moment of inertia: I = depth³/12
};

/// The place between two others, linear in s.
Place between(const Place& a, const Place& b, double s);
/// The place at s on a line of at least two.
Place place_on(const std::vector<Place>& line, double s);

/// An outline's holes by what is around them: a tree of boxes, in which a chord finds those that it may
/// cross.
class Holes {
 public:
  explicit Holes(const Outline& outline);

  /// Indices in the order of the outline, so that sums over them are the same whatever the tree.
  std::vector<std::size_t> crossed_by(const Chord& chord) const;
  bool empty() const { return holes_.empty(); }
  const Ring& operator[](std::size_t hole) const { return holes_[hole]; }

 private:
  struct Box {
    Bounds around;
    std::span<std::size_t> holes;
  };

  void build(const std::vector<Bounds>& around, std::size_t at, std::span<std::size_t> holes);

  const std::vector<Ring>& holes_;
  std::vector<std::size_t> order_;
  std::vector<Box> boxes_;  // 1: all; 2i and 2i + 1: halves of i
};

/// The place where a chord crosses the strip, s along the centreline.
Place place_at(double s, const Chord& chord, const Holes& holes);

}  // namespace ductile::calibration
