// Where a structure's energy went besides its joints' plastic work: an observer beside the step, which reads
// and changes nothing but its own accounts and the records' `stored`.
//
// A row takes s·J v̄ from the bodies, v̄ the mean of their velocities before and after the step. With p = h w
// and u the elastic parts of its motion in the last step and in this one, what R (u + p)/2 changes of what is
// stored half a step on, and what δ damps, stands in row.h. The slider takes R times its slip. What is left
// is numerical, row by row: δ beyond the damper's, γ, implicit Euler of rigid rows and heavy dampers, the
// turning of J.
//
// The gap of an implicit row holds what turning bodies part by, too, a thousand times what it is strained by.
// Its force alone tells its strain x, whatever turns: R = k (x + (δ − 1)(x − x₋)). With x − x₋ in the place
// of u, and δ = 1, a damper of c = kh takes all that a released spring held, at any step, with (u + p)/2;
// with u it would take twice as much where the step does not resolve the vibration.
#pragma once

#include <span>

#include "flow.h"
#include "pool.h"

namespace ductile::dynamics {

/// J since the start.
struct Energies {
  double damping = 0;    // c ė² h of the rows
  double numerical = 0;  // what implicit Euler, the motion of J within a step, and pushes by contacts take
  double driven = 0;     // what driven rows give, and bodies whose velocities are prescribed
  double contacts = 0;   // of divided steps: work of contacts beyond their impulses' with mean velocities
  void keep(Tape& tape) { tape(damping, numerical, driven, contacts); }
};

class Ledger {
 public:
  Energies energies;

  void form(const System& system);
  /// Before poses move, while J is the step's own: the part of the rows' loss that needs it. `before` are the
  /// velocities at the step's very start, in own frames.
  void open(const System& system, std::span<const Vec3> before, double h);
  /// In a step that is the last one again: what close() needs of it.
  void see(const System& system);
  /// After a joint's flow was booked: by what its neutral position moved, and the plastic work of that, J.
  void account(const Joint& joint, std::size_t index, JointRecord& record, const Rows& slip,
               const Rows& work);
  /// After the step: by what contacts and limits changed velocities after the last solve, world axes.
  void close(std::span<const Vec3> change);

 private:
  Vector<Joint> joints_;  // of the step that is open: J and impulses
  Vector<Turn> turns_;    // of its bodies' frames
  Vector<Rows> taken_;    // s·J v̄, J
  Vector<Rows> moved_;    // h J v, m or rad
  Vector<TurnInertia> turn_inertias_;
  Vector<Vec3> returned_;  // as System::returned
};

}  // namespace ductile::dynamics
