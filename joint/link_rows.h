// Joints that are not the structure's own as rows of the one problem: what they ask for is asked of the mass
// that the whole structure has there, not of the piece that they happen to hold.
//
// A link is linear in the velocities of one step:
//   s = clamp(G (J v + b), −c⁻, c)
// A pin is two rows without caps, b what closes its gap in this step; a motor a row with b the speed and c
// the torque that it has in a step; a limit or a slack rope a row with one cap 0, b the way that is left to
// it in a step; a spring a row with a G of its own. A motor goes on from the impulse s₋ of the step before,
// b = s₋/G − speed: under an even load it does not creep by s/G.
//
// Rows of links follow the structure's joints in System::joints. They have no law in time and no material:
// what integrates, books or projects joints leaves them out (System::own).
#pragma once

#include <span>

#include "system.h"

namespace ductile::dynamics {

/// Makes rows of the links of a step of h seconds, in place of those before, and of the contacts with them
/// where the links are others; false where the factor of H is not theirs. Their blocks of H are the caller's
/// to set.
bool enter_links(System& system, std::span<const Link> links, double h);

/// Takes the impulses of the last solve.
void read_links(System& system);

}  // namespace ductile::dynamics
