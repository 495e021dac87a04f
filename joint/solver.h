// One time step of a whole structure as one convex problem (objective.h), without an engine. This is the
// façade: it holds the parts and states the order in which they may be called.
//
//   call             may follow                         does
//   form(n)          filling in bodies, joints,         inverse masses, effective masses, pattern of H;
//                    records; changed masses            allocates, what follows at its first use
//   locate()         put() of any body                  gaps and J anew
//   begin(h)         form, locate, advance              laws and biases of a step of h seconds
//   divide(n)        begin, solve, advance              the next n steps are parts of one; unite(n) ends that
//   touch(links,     begin                              their rows
//     contacts)
//   strike(v)        begin                              velocities jumped at the start of this step
//   foresee(...)     begin, strike and solve            the solve, if nothing were struck; divide() follows
//   go_on()          begin, solve                       what presses has just been found
//   push(i, Δv*)     solve, in the same step            another velocity changed
//   solve(report)    begin with all v_free written,     v and impulses at the minimum
//                    push or weaken
//   weaken(j, share) solve                              joint j breaks within the step
//   hold(j, share)   solve                              so it does, or did, with the caps that it has
//   scale(share)     solve                              all velocities to a share of them
//   advance()        solve, scale                       poses move by h v, plastic flow is booked
//   project(goal)    begin or advance                   the bodies follow a push, strained by none
//   at_rest()        advance                            whether the next step will be this one
//   close_ledger(Δv) advance                            the account of the step
//
// A structure that is solved in the paper's way (`swept`) calls warm_start() and sweep() where others call
// solve(), and sweep_positions() instead of project().
#pragma once

#include <cmath>
#include <span>

#include "blow.h"
#include "contact_rows.h"
#include "drive.h"
#include "ledger.h"
#include "link_rows.h"
#include "newton.h"
#include "pool.h"
#include "projection.h"
#include "sweep.h"
#include "system.h"

namespace ductile::dynamics {

class Solver : public System {
 public:
  /// Velocities of a structure at rest may differ from step to step by this share of those that its impulses
  /// make.
  static constexpr double rest_tolerance = 1e-7;

  explicit Solver(bool swept_in_passes = false);

  /// Joints before `first` were formed already and keep their laws; new bodies may stand before theirs.
  void form(std::size_t free_bodies, std::size_t first = 0);
  /// See System::remove(). Nothing is predicted of the step that follows.
  void remove(std::size_t joint);
  std::size_t free_bodies() const { return free; }
  /// In the paper's way.
  bool swept() const { return motion_.swept; }
  void locate() { locate_all(*this); }

  void begin(double h);
  /// The next steps are parts of one; unite() ends that. After begin() and the solve of a struck step, these
  /// are undone.
  void divide(double parts);
  void unite(double parts);
  /// The bodies' velocities jumped at the start of this step (blow.h); `closing` is the speed of the fastest
  /// contact that closes, m/s. After begin(), before the first solve.
  void strike(double closing);
  /// The next solve is much like the one before it, that of the part of a step before or that in which a
  /// joint did not break yet: friction is settled by one round. The caps of that solve alone would let what
  /// rubs do too little work.
  void go_on() { friction_rounds_ = 1; }
  /// Solves the step as it would be if no line snapped taut, before divide(): joints have the impulses of
  /// that when the parts begin. Contacts that are not to be struck have a bounce that says so.
  void foresee(std::span<const Link> links, std::span<const Contact> contacts);
  /// Whether the last step is known to have been as long as this one, and of the same joints.
  bool knows_last_step() const { return prediction_.known(); }
  /// In the body's own frame. All that happens between two solves of a step is said so, or none of it. Solves
  /// until the next begin() do not settle the contacts' friction anew.
  void push(std::size_t body, const Vec3& change) {
    newton_.push(*this, body, change);
    keeps_friction_ = true;
  }
  /// See blow.h.
  double strained_by_blow() const { return dynamics::strained_by_blow(*this, before_blow_); }
  /// Of the step that advance() ended: see blow.h.
  const LeftOut& left_out() const { return left_out_; }
  /// A joint breaks after this share of what the last solve lets it flow by (blow.h); solve() again.
  void weaken(std::size_t joint, double share);
  /// So much of what it flows by is booked; the last solve stands.
  void hold(std::size_t joint, double share);
  /// What else holds or touches bodies in this step, after begin() and before its first solve. `pairs` has
  /// them.
  void touch(std::span<const Link> links, std::span<const Contact> contacts);
  /// Velocities from v_free; false when nothing had to be done.
  bool solve(SolveReport& report);
  void scale(double share);
  /// See StepLaws::slow().
  void slow() { laws_.slow(); }
  void advance();
  /// See Projection::project.
  bool project(std::span<const Pose> goal, bool try_goal);

  void warm_start() { sweep::warm_start(*this, step(), last_); }
  void sweep() { sweep::velocities(*this, step(), last_); }
  void sweep_positions(std::span<const Pose> at) { sweep::positions(*this, at); }

  /// Whether nothing flows and what the last solution still moves changes no force by more than
  /// rest_tolerance, or than rounding of poses does where it is that slow: the next step is this one if
  /// nothing else touches the bodies. It then starts from this solution, not from a prediction.
  bool at_rest();
  /// Whether any row of the structure's own joints was beyond its cap in the last solve.
  bool any_flows() const;
  /// Of the bodies in the last solve, m/s and rad/s.
  double fastest() const { return std::sqrt(last_.fastest2); }
  double fastest_turn() const { return std::sqrt(last_.fastest_turn2); }
  /// Root mean square of the velocity that the structure's impulses made in the last solve, m/s.
  double impulse_speed() const { return mass > 0 ? std::sqrt(last_.impulse2 / mass) : 0; }
  double step() const { return laws_.step(); }

  /// Caps or stiffness were edited.
  void laws_changed() { laws_.invalidate(); }
  /// See StepLaws.
  double& drift_time() { return laws_.drift_time; }
  double drift_time() const { return laws_.drift_time; }
  double& moved_by() { return laws_.moved_by; }
  /// Block products of a factorisation: what a solve costs.
  double factor_work() const { return hessian_.factor_work(joints.size()); }
  NewtonTunables& tunables() { return newton_.tunables; }
  InteriorPointTunables& interior_point_tunables() { return newton_.interior_point.tunables; }

  /// Asks for a ledger: then `before` are the velocities at the step's very start, in own frames.
  bool keeps_ledger = false;
  Vector<Vec3> before;
  const Energies& energies() const { return ledger_.energies; }
  /// Work of contacts and of weight in the parts of a step, beyond what the whole step's impulses do with the
  /// mean of its velocities, J.
  void book_parts(double contacts, double weight) {
    ledger_.energies.contacts += contacts;
    ledger_.energies.numerical -= weight;
  }
  /// Of a step that is the last one again.
  void open_ledger() { ledger_.see(*this); }
  /// After the step: by what contacts and limits changed velocities after the last solve, world axes.
  void close_ledger(std::span<const Vec3> change) { ledger_.close(change); }

  void keep(Tape& tape) {
    System::keep(tape);
    if (tape.reads()) place_others();
    tape(laws_, hessian_, newton_, prediction_, ledger_.energies, last_, motion_.share, predicted_);
  }

 private:
  void undo_blow();
  void scale_turn_inertia(double by);
  void place_others();
  void solve_again(Solution& solution, SolveReport& report);
  void settle_friction(Solution& solution, SolveReport& report);
  void carry_over(Joint& joint, const Rows& rate, const Rows& turned);
  void book(Joint& joint, const Rows& gap, const Rows& parted);

  StepLaws laws_;
  Hessian hessian_;
  Newton newton_;
  LinearPrediction prediction_;
  Projection projection_;
  Ledger ledger_;
  Vector<Rows> before_blow_;     // impulses of the joints before the step that is struck
  Vector<Vec3> turned_;          // the last velocities, in the frames where poses have turned to
  Evaluation last_;              // of the last solve
  Motion motion_;                // of the present step
  bool predicted_ = false;       // the next solve starts where prediction_ says
  bool struck_ = false;          // the present step is that of a blow
  bool weakened_ = false;        // a joint breaks within the present step
  double closing_ = 0;           // whose fastest contact closes so fast, m/s
  LeftOut left_out_;             // of the last step
  bool keeps_friction_ = false;  // in the present step
  static constexpr int most_friction_rounds = 8;
  int friction_rounds_ = most_friction_rounds;  // likewise
};

}  // namespace ductile::dynamics
