// Contacts as rows of the one problem: non-penetration and Coulomb friction at a point of two bodies.
//
// A contact is two rows at its point, along the normal n from A to B and along n's left:
//   λ = max(0, G (b − n·v) + λ₋)      t = clamp(G (τ + l·v) + t₋, −c, c), c = μ λ of the round before
// with v the velocity of B against A, b what restitution asks for, τ the speed of a conveyor, λ₋ and t₋ the
// impulses of the step before: an even load moves nothing. For given c that is a row with one cap 0 and the
// other infinite and one of caps ±c: f stays convex (objective.h). Friction whose cap depends on λ at once
// would not be; the rounds are the lagged fixed point of A. Castro, F. Permenter, X. Han, IEEE Trans.
// Robotics 39 (2023), and of M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999).
//
// Contact rows are the last in System::joints. They have no gap, no law in time and no
// material: what integrates, books or projects joints leaves them out (System::own).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "system.h"

namespace ductile::dynamics {

/// G of contacts as a multiple of the effective mass: a load that comes within a step sinks by g
/// h²/contact_ratio.
inline constexpr double contact_ratio = 1e8;

/// λ₋ and t₋ are no more than G times this, m/s. A weight of 10⁴ pieces asks for 3.3e-5 at 30 Hz. Bodies that
/// are jammed may press on two sides of each other with a thousand times what there is to bear, as the arms
/// of the two nearly cancel; as these change with the next step, λ₋²/2G would be what the two are thrown by.
inline constexpr double most_carried = 4e-5;

/// Whether rows of contacts or links are of the same things between the same bodies as those before.
template <class Of>
bool same_rows(std::span<const Of> now, std::span<const Of> before) {
  return std::equal(now.begin(), now.end(), before.begin(), before.end(),
                    [](const Of& x, const Of& y) { return x.id == y.id && x.a == y.a && x.b == y.b; });
}

/// Makes rows of the contacts of a step of h seconds, in place of those before; false where the factor of H
/// is not theirs. Their blocks of H are the caller's to set.
bool enter_contacts(System& system, std::span<const Contact> contacts, double h);

/// Takes the impulses of the last solve.
void read_contacts(System& system);

/// The reverse: rows have the impulses of the contacts.
void write_contacts(System& system);

/// After a solve: caps of friction from its normal impulses, averaged with those before where three rounds
/// were not enough; or of those contacts alone that rub and do not press. Whether the solve is to be done
/// again, and whether H has other rows.
struct Lag {
  bool again = false, other_rows = false;
};
Lag lag_friction(System& system, int round, bool of_open);

/// Whether a body that turns moves its point of contact along the normal: a circle about its centre does not.
inline bool has_lever(double x, double y, const Turn& normal) {
  return std::abs(x * normal.s - y * normal.c) > 0.1 * std::hypot(x, y);
}

/// The cap of friction of a contact's row, N s; 0: no row.
void set_friction(Joint& joint, JointRecord& record, double cap);

}  // namespace ductile::dynamics
