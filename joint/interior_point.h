// The minimum of f (objective.h) by a primal–dual interior point method, for steps in which many rows change
// their regime against each other (a struck chain, a collapse), or flow on a yield surface. It looks for the
// impulses s, of which the velocities follow:
//
//   minimise over s in K   ½ |v|²_M + ½ sᵀ G⁻¹ s − bᵀ s      v = v* − M⁻¹ Jᵀ s
//
// K is given by inequalities of each joint: p = c − a·s + ηz ≥ 0 of its caps, η from hardening; or of its
// yield surface p = t − a·s ≥ 0, its facets, and p = ½ (1 − t² − q²) ≥ 0, where t is the share of the surface
// that N and M may take, and q = s_Q / hQ_max. docs/theory/interior_point.md derives the rounds.
#pragma once

#include "hessian.h"
#include "interior_caps.h"
#include "interior_surface.h"
#include "objective.h"
#include "pool.h"

namespace ductile::dynamics {

/// What is chosen, with its reason.
struct InteriorPointTunables {
  /// Of |v − v*|²_M + |v|²_M: the gap that rounds go on to. Velocities are good to its root.
  double goal = 1e-18;
  /// Likewise: the gap from which caps of friction stay what they are. They are known well by then, and what
  /// is left is symmetric, and so more accurate.
  double friction_goal = 1e-15;
  /// Likewise: the gap that will do where friction that follows gains no more.
  double followed_goal = 1e-13;
  /// Likewise, Σ z p, where following leads nowhere: until then what slides parts less its slip of the same
  /// round. Velocities are known to a thousandth of themselves by then, and what parts does so by no more.
  double slip_goal = 1e-6;
  /// As long as that takes no more rounds than these.
  int slip_rounds = 30;
  /// Of |v − v*|²_M + |v|²_M: the gap that will do, where rounding does not let it become less.
  double tolerance = 1e-12;
  /// Share of the bounds that the impulses of the last step are drawn within: further out, the first rounds
  /// go but small steps.
  double inside = 0.7;
  /// Mean of z p at the start as a share of the work that is asked for.
  double start = 1;
  /// Likewise with contacts: with less, those that open let the first rounds go but small steps, one after
  /// the other.
  double contact_start = 2;
  /// Likewise: the gap from which settle() is tried. From further out it finds as many joints to be wrong as
  /// rounds would have told apart.
  double settle_gap = 1e-3;
  /// As long as the last round changed its mind about no more than this share of the joints.
  double settle_share = 0.03;
  /// Rounds until it is tried again.
  int settle_pause = 2;
  /// Rounds without gain, where all that is left is lack, after which rounding is asked for what it may make
  /// of all impulses together.
  int idle_rounds = 8;
  /// The bound leaves room for bodies that overlap and jam between rigid joints.
  int round_bound = 200;
};

class InteriorPoint {
 public:
  struct Outcome {
    int factorisations = 0;
    double gap = 0;        // J: f(v) − min f is no more
    double tolerance = 0;  // J: what it was to fall below, rounding of the impulses included
    bool reached = false;
  };

  InteriorPointTunables tunables;

  /// Allocates; solve() does in the first in which friction follows, and where there are more contacts.
  void form(const System& system);

  /// Solves from the impulses that the joints held at the last start_from(), or hold. Afterwards they hold
  /// the solution's impulses and regimes, records x = J v + b, and bodies v. Where the tolerance was not
  /// reached, these are the best impulses found times the largest share at which they add no energy.
  Outcome solve(System& system, Hessian& hessian, Evaluation& at);

  /// The joints' impulses are where the next solve() starts, whatever other methods make of them till then.
  void start_from(const System& system);
  /// They are not.
  void start_anew() { start_known_ = false; }

  /// In another step friction may follow normal impulses again, which led nowhere in the last solve.
  void begin_step() { follows_friction_ = true; }

 private:
  bool go(System& system, Hessian& hessian, bool follows, Outcome& outcome);
  void moderate_start(const System& system);
  bool start(const System& system);
  void open_friction(System& system);
  /// Calls act(k, μ) for each contact's row k that has friction.
  template <class Act>
  void each_friction(const System& system, const Act& act) {
    for (std::size_t k = system.first_contact(); k < system.joints.size(); ++k)
      if (system.joints[k].G[1] > 0) act(k, system.contacts[k - system.first_contact()].friction);
  }
  /// The records' tangents, and ds₁/dx₀ of the contacts where friction follows.
  template <class Follows>
  void factor_tangents(const System& system, Hessian& hessian, bool follows, const Follows& of) {
    if (!follows) return hessian.factor_given(system);
    follows_.assign(system.contacts.size(), 0);
    each_friction(system,
                  [&](std::size_t k, double) { follows_[k - system.first_contact()] = of(caps_[k]); });
    hessian.factor_following(system, follows_);
  }
  double balance(System& system);
  Distance measure(const System& system);
  double rounding_of_best(const System& system);
  void factor(System& system, Hessian& hessian, bool follows);
  Direction find_direction(const System& system, const Hessian& hessian, double mu, double second_order,
                           bool follows);
  void answer(const System& system, const Hessian& hessian, bool follows);
  void move(double step);
  bool settle(System& system, Hessian& hessian, bool follows, int& factorisations);
  int step_to_active(System& system, const Hessian& hessian, bool follows);
  double share_without_gain(System& system);
  void finish(System& system, bool reached, Evaluation& at);

  template <class Do>
  void each(const Do& act) {
    for (std::size_t k = 0; k < caps_.size(); ++k) {
      if (surface_of_[k] < 0) {
        act(k, caps_[k]);
      } else {
        act(k, surfaces_[z(surface_of_[k])]);
      }
    }
  }

  Vector<CappedRows> caps_;  // of all joints
  Vector<int> surface_of_;   // a joint's, instead of its caps; or -1
  Vector<SurfaceRows> surfaces_;
  Vector<SurfaceRows::Bound> bounds_;  // of the surfaces
  Vector<Rows> impulses_;              // of the joints
  Vector<Rows> best_;                  // from start_from() on where to start, from then on the best so far
  /// Of an inertia against changes of relative turn: a row without caps, of G = C, that is rigidly at rest at
  /// the rate w.
  struct TurnRow {
    double s = 0, ds = 0, lack = 0;  // N m s, N m s, rad/s
    double best = 0, kept = 0;       // the best so far, and as kept_
  };
  Vector<TurnRow> turns_;  // of the system's turn inertias
  bool start_known_ = false, follows_friction_ = true;
  Vector<double> follows_;          // of the contacts: CappedRows::follows()
  Vector<CappedRows::State> kept_;  // of the rows of all joints, should settle() lead nowhere
  int others_ = 0;  // bounds that the last round found to be active, or not, unlike the one before
  Vector<Vec3> d_;
  Vector<Row4> rows_;
  Vector<std::size_t> order_;
};

}  // namespace ductile::dynamics
