// Cutting an outline with holes into pieces along straight lines.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ductile/section.h"

namespace ductile::calibration {

/// A straight cut from one side of an outline to the other. Its ends lie outside or on the outline.
struct Cut {
  Point from, to;
};

/// A stretch of a cut along which two pieces touch.
struct Interval {
  int cut = 0;              ///< index of the cut
  int left = 0, right = 0;  ///< pieces on either side of from→to
  Point from, to;           ///< in the direction of the cut
};

struct Split {
  std::vector<Outline> pieces;      ///< outer rings counter-clockwise, holes clockwise
  std::vector<Interval> intervals;  ///< by cut, then along it; each as long as its two pieces stay the same
};

/// Cuts outlines into pieces; keeps its memory from one to the next.
class Splitter {
 public:
  Splitter();
  ~Splitter();

  /// Cuts `outline` (one that validate() accepts) along all `cuts` at once; cuts may cross each other.
  /// Vertices within 1e-9 of the outline's size of a cut lie on it. Two neighbours share the very coordinates
  /// of their interval, so that the areas of the pieces add up to the outline's but for the rounding of the
  /// new points: that puts each off its edge by ε times the outline's coordinates, and all of them change the
  /// area by that times half of the outline's perimeter at most. What has no more area than that is no piece.
  /// Throws InvalidInput, whose problems begin with `place`, where a cut misses the outline, ends
  /// inside it, or does not separate anything; with `useless`, such cuts are listed there instead, and the
  /// result is empty.
  Split split(const Outline& outline, std::span<const Cut> cuts, const std::string& place,
              std::vector<int>* useless = nullptr);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// −1 outside, 0 on the boundary, 1 inside; exact.
int locate(const Ring& ring, Point point);

}  // namespace ductile::calibration
