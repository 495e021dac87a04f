// The laws of a step's rows and their biases b, from materials, gaps and what went before.
//
// In a rigid row b = gap/h. The gap is more than the strain where turning bodies parted along their tangents
// in the step before, by r(ωh)²/2: that constraint drift is taken back in as much time as it took to arise,
// be it in several shorter steps; at once it would be a blow. What the shorter steps themselves add is taken
// back at once: it would pile up. Elastic rows that ring in longer steps than resolve them are strained far
// beyond their forces, too. Where steps differ, what turns is to close by what this step will part it by, and
// pulls by more or less than its force.
#pragma once

#include "pool.h"
#include "system.h"

namespace ductile::dynamics {

class StepLaws {
 public:
  /// Springs stiffer than so many m_eff/h² are taken as rigid.
  double elastic_ratio = rigid_ratio;
  /// s in which the constraint drift of a longer step is still to be taken back.
  double drift_time = 0;
  /// s, of the step that poses last moved by.
  double moved_by = 0;

  /// Caps, stiffness, masses or joints were changed: the next begin() makes all laws anew.
  void invalidate() { known_ = false; }
  /// Laws and biases of a step of h seconds; whether laws are others than those of the last step.
  bool begin(System& system, double h);
  double step() const { return h_; }
  /// Poses move by the step.
  void move() { moved_by = h_; }
  /// The step's velocities were not those that close its gaps: what it leaves of them is drift in a shorter
  /// one.
  void slow() { slowed_ = true; }
  /// Where some row begins to flow in the step as it was solved: whether other rows' forces stop growing by
  /// that and have other laws, so that it is to be solved anew. In steps that resolve waves they do not.
  bool begin_flow(System& system);
  /// Says that the last step was one of h/parts seconds at the same velocities: the next begin() goes on from
  /// it as from one that was as long, with the same δ.
  void divide(System& system, double parts);
  /// The reverse, after the last of so many steps.
  void unite(System& system, double parts);

  /// δ of rows without a damper, in equal steps of bodies that hardly turn. 1: implicit Euler.
  double least_delta = 0;

  /// Biases of the next step if it is as long.
  static void set_equal_bias(Joint& j, const Rows& gap) {
    for (unsigned i = 0; i < 3; ++i) j.bias[i] = bias_of_strain(j, i, gap[i] - j.neutral[i]);
  }
  /// Copies what every step reads of a joint's law into the joint.
  static void take_law(Joint& joint, const RowLaw& law);
  void keep(Tape& tape) {
    tape(h_, moved_by, known_, divided_, last_turn_, turn_drifts_, slowed_, caps_raised_, some_halt_,
         of_step_, guarded_, of_contacts_, drift_time);
  }
  /// The joint's rows hold its bodies where turning has parted them: they take nothing of that back.
  static void hold_parted(Joint& joint, JointRecord& record);
  /// A joint's law anew, of this step, as its material was changed.
  void set_law(Joint& joint, JointRecord& record) const;

 private:
  double deferred_share(double h);
  void find_drift(const Joint& joint, JointRecord& record) const;
  void bound_drift(const Joint& joint, JointRecord& record) const;
  void rescale(System& system, double by);
  double most_growth(System& system, double last_h);
  void follow_law(Joint& joint, JointRecord& record, Rows& strain, const Rows& parted,
                  double most_growth) const;
  void follow_turn_drift(Joint& joint, JointRecord& record, const Rows& parted, unsigned newmark,
                         double last_h) const;
  void allow_turn(const Joint& joint, JointRecord& record, const Rows& parted, double last_h) const;
  bool choose_delta(System& system, double h);  // whether it is another of some row
  bool follow_turn(TurnGuard& guard, double turn, double h) const;

  Vector<Vec3> change_;  // of the bodies
  double h_ = 0;
  bool known_ = false;        // the laws are those of h_, caps and stiffness
  bool divided_ = false;      // steps are parts of longer ones
  double last_turn_ = 1;      // (h₋ + h)/2h of the last step
  bool turn_drifts_ = false;  // some row has drift of a turn in a step of another length
  bool slowed_ = false;       // the last step, by limits of speed (slow())
  bool caps_raised_ = false;  // in this step alone, of some row (allow_turn())
  bool some_halt_ = false;    // some joint has laws for rows whose force stops growing in this step
  double of_step_ = 1;        // δ of all rows for steps that differ
  bool guarded_ = false;      // some joint has δ for how far its bodies turn
  TurnGuard of_contacts_;     // of rotation rows
};

}  // namespace ductile::dynamics
