// Where a structure's energy went besides its joints' plastic work: an observer beside the step, which reads
// and changes nothing but its own accounts and the records' `stored`.
//
// Each term is a sum of closed forms over rows and steps, none a difference of totals. With R = s/h a row
// takes s·J v̄ from the bodies, v̄ the mean of their velocities before and after the step, while implicit Euler
// counts with those after it; spring and damper side by side take k e' Δe + c Δe²/h, with e' = e + Δe the
// strain that the force stands for and that ½ k e'² is stored of; the slider takes R (h J v − Δe).
#pragma once

#include <span>
#include <vector>

#include "flow.h"

namespace ductile::dynamics {

/// J since the start.
struct Energies {
  double damping = 0;    // c ė² h of the rows
  double numerical = 0;  // what implicit Euler, the motion of J within a step, and pushes by contacts take
  double driven = 0;     // what bodies give whose velocities are prescribed
};

class Ledger {
 public:
  Energies energies;

  void form(const System& system);
  /// Before poses move, while J is the step's own: the part of the rows' loss that needs it. `before` are the
  /// velocities at the step's very start, in own frames.
  void open(System& system, std::span<const Vec3> before, const Motion& motion);
  /// After a joint's flow was booked, which had dissipated `booked` before.
  void account(const Joint& joint, std::size_t index, JointRecord& record, const Rows& booked);
  /// Around scale_strain(): of rows with a damper, less is stored.
  void account_scaled(const Joint& joint, JointRecord& record);
  /// After the step: by what contacts and limits changed velocities after the last solve, world axes.
  void close(std::span<const Vec3> change);

 private:
  std::vector<Joint> joints_;  // of the step that is open: J and impulses
  std::vector<Turn> turns_;    // of its bodies' frames
  std::vector<Rows> strains_;  // at its start
};

}  // namespace ductile::dynamics
