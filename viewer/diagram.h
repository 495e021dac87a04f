// What a joint can carry, to be drawn: its N–M diagram, and its section with the neutral axis.
#pragma once

#include <optional>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/plane.h"

namespace ductile::viewer {

/// Of one joint of a plan.
struct Diagram {
  /// Where the joint yields: the box of its caps, or with Plan::interaction its N–M curve; counter-clockwise
  /// in the (N, M) plane, without the last point again. Empty where a cap is unlimited or 0.
  std::vector<AxialMoment> limit;
  std::vector<AxialMoment> curve;  ///< the section's own N–M curve; empty where none is known
  std::optional<Section> section;  ///< as section_at(): the weaker side's, by its plastic moment
  /// What covers the section, part by part, in its own coordinates.
  std::vector<Convex> parts;
};
Diagram diagram(const Plan& plan, std::size_t joint);

/// The plastic neutral axis of a section_at() that carries the axial force N, coordinate y (to the left of
/// the joint's axis), m; `positive`: with M > 0, the right in tension.
double neutral_axis(const Section& section, double N, bool positive);

}  // namespace ductile::viewer
