// Where a body is cut whose split is "auto": across its axis, in as many pieces as a displacement error asks.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "axis.h"
#include "ductile/section.h"
#include "split.h"

namespace ductile::calibration {

/// Where a body is held, and whether it cannot turn there.
struct Hold {
  Point at;
  bool clamps = true;
  Chord face{};  ///< the edge along which another body holds it; without length: at a point
};

struct AutomaticSplit {
  Split parts;
  std::vector<Cut> cuts;
  std::vector<double> lengths;  ///< m, by cut: ℓ of its joints, half of the way along the axis to the next
                                ///< cuts (or ends), all of the way to a node
  struct End {
    Point at, outward;
    double half = 0;  ///< m, ℓ of the last piece's half at a joint there
  };
  std::vector<End> ends;  ///< free ends of the axis
  double error = 0;       ///< estimated relative displacement error under the body's own weight
};

/// A chain of rigid pieces with springs k = EI/ℓ between them bends like the beam, but for what the
/// trapezoidal rule errs in ∫ M m/EI ds: 1/n² for the tip of a cantilever of n pieces, 8/n² for the middle of
/// a beam clamped at both ends. This error is computed for the body as it is (its width along the axis less
/// holes, its bends), clamped at either end or held by `holds`, and pieces are added until it is below
/// `target`. Cuts that would leave a piece thinner than Box2D takes, or several from one corner, are left
/// out.
AutomaticSplit split_automatically(Splitter& splitter, const Outline& outline, double target,
                                   std::span<const Hold> holds, const std::string& place);

}  // namespace ductile::calibration
