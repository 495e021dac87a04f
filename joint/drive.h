// Rows that do not just hold or flow: driven ones, whose neutral position moves at a prescribed rate, and
// ropes and struts, which go slack.
//
// A neutral position that moves at n turns J v and the rate w of the row's law into J v − n and w − n, both
// of the elastic part alone: what moves evenly without force stays without it. Where a cap does not hold it,
// a driven row slips, and its drive continues from there.
//
// A slack row keeps its neutral position. Its strain e is then beyond it, which no spring was strained by:
// with w = 2e/h, e half a step ago is 0, so what was stored is 0 (see ledger.h), and the row takes hold in
// the step at whose middle it is taut, without gain.
#pragma once

#include <algorithm>

#include "system.h"

namespace ductile::dynamics {

inline bool is_driven(const JointRecord& r, unsigned i) { return r.material.is_driven(i); }

/// What a slack line is longer by than at rest, or a slack strut shorter (then < 0): by no strain. m
inline double beyond_slack(const Joint& j, const JointRecord& r, unsigned i) {
  const double longer = r.gap[i] - j.neutral[i];
  return r.material.cap[i] > 0 ? std::max(longer, 0.0) : std::min(longer, 0.0);
}

/// Lists the driven joints, those of a rate law and those that go slack, and marks those that are or may be
/// slack. Never allocates after the system's form().
void list_special(System& system);

/// After laws and biases of a step of h seconds are made: sets the drives' rates.
void begin_drives(System& system, double h);

/// After the step was solved, before its flow is booked: neutral positions move, biases are those of rows at
/// rest again.
void move_drive(Joint& joint, const JointRecord& record, double h);

/// Sets the rates that the law carries over, of driven and of slack rows, after they were set as those of the
/// gap.
void correct_rates(Joint& joint, const JointRecord& record, const Rows& gap, double h);

}  // namespace ductile::dynamics
