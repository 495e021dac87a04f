// The paper's way: joint by joint, in Box2D's own iterations. Each joint's three rows are solved as one block
// with its full effective mass; rows that would exceed their caps are put at them and the rest of the block
// is solved again (clamping alone creates energy); impulses are accumulated and carried over to the next
// step. Rigid rows are kept together by position correction, as in b2WeldJoint.
#pragma once

#include <span>

#include "objective.h"

namespace ductile::dynamics::sweep {

/// The impulses of the last step once more, before the iterations of a step of h seconds.
void warm_start(System& system, double h, Evaluation& at);
/// One pass over the joints' velocities.
void velocities(System& system, double h, Evaluation& at);
/// One pass over their positions, from where the bodies are.
void positions(System& system, std::span<const Pose> at);

}  // namespace ductile::dynamics::sweep
