// The numbers of one joint: from its sections, materials and what the user says instead.
#pragma once

#include <array>

#include "ductile/calibrate.h"
#include "strip.h"

namespace ductile {

/// What a joint connects, seen from the joint.
struct Side {
  const std::string* body = nullptr;  ///< its name
  const Strip* strip = nullptr;       ///< null: no material, does not govern
  bool reversed = false;              ///< the joint's axis runs against the strip
  double reach = 0;  ///< m: ℓ of this side, half of the piece's extent along the axis; 0: it does not give
  double inertia = 0;  ///< kg m² of the piece about its centre
};

/// A user's word, and whose it is: "joint", "body", "scene".
struct Overriding {
  const char* name;
  const JointOverrides* values;
};

/// Fills in caps, stiffness, damping, limits and `governed_by`. `height` is the length of the interval; the
/// first of `overriding` that sets a value wins. Appends to `problems` what cannot be.
void set_values(PlannedJoint& joint, double height, const std::array<Side, 2>& sides,
                std::span<const Overriding> overriding, std::vector<Problem>& problems);

}  // namespace ductile
