// What a step leaves in a joint: the phases of breaking 1–3. A row at its cap flows; its new neutral position
// is the present one less the elastic part, in velocities as solved; the plastic offset is incremented. Of
// hardening rows the cap grows.
//
// The increment is taken from velocities: what turning bodies part along their tangents must not count as
// flow, which would strain what is parallel, and be work.
#pragma once

#include "step_laws.h"

namespace ductile::dynamics {

/// How a step's velocities came about, and what became of them.
struct Motion {
  double share = 1;    // of the solution that the bodies move with
  bool swept = false;  // by Sweep: of rows that flow, x is but the direction
};

/// Books the plastic flow of a joint whose gap is now `gap`.
void flow(Joint& joint, JointRecord& record, const Rows& gap, const StepLaws& laws, const Motion& motion);

/// Rows that hold nothing have their neutral position where they are.
void follow_gap(Joint& joint, const Rows& gap);

/// The bodies went less far than was solved for, and so did a spring that has a damper beside it. What other
/// rows are strained by, StepLaws::begin() reads from their gaps.
void scale_strain(Joint& joint, const JointRecord& record, double share);

}  // namespace ductile::dynamics
