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

#include <array>
#include <vector>

#include "hessian.h"
#include "objective.h"
#include "weighted_rows.h"

namespace ductile::dynamics {

/// What is chosen, with its reason.
struct InteriorPointTunables {
  /// Of |v − v*|²_M + |v|²_M: the gap that rounds go on to. Velocities are good to its root.
  double goal = 1e-18;
  /// Likewise with contacts: their caps of friction are not known as well.
  double contact_goal = 1e-15;
  /// Likewise: the gap that will do, where rounding does not let it become less.
  double tolerance = 1e-12;
  /// Likewise with contacts: velocities good to 1e-4.
  double contact_tolerance = 1e-8;
  /// Rounds in which caps of friction follow the normal impulses. They settle with these; if not, the solve
  /// after it does the rest (lag_friction()).
  int friction_rounds = 18;
  /// Share of the bounds that the impulses of the last step are drawn within: further out, the first rounds
  /// go but small steps.
  double inside = 0.9;
  /// Mean of z p at the start as a share of the work that is asked for.
  double start = 1;
  /// Likewise with contacts: with less, those that open let the first rounds go but small steps, one after
  /// the other.
  double contact_start = 5;
  /// A solve takes 9 to 25 rounds; 3 of 1e5 random structures do not end within so many.
  int round_bound = 100;
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

  /// Allocates; solve() does not.
  void form(const System& system);

  /// Solves from the impulses that the joints held at the last start_from(), or hold. Afterwards they hold
  /// the solution's impulses and regimes, records x = J v + b, and bodies v. Where the tolerance was not
  /// reached, these are the best impulses found times the largest share at which they add no energy.
  Outcome solve(System& system, Hessian& hessian, Evaluation& at);

  /// The joints' impulses are where the next solve() starts, whatever other methods make of them till then.
  void start_from(const System& system);
  /// They are not.
  void start_anew() { start_known_ = false; }

  std::size_t bytes() const;

 private:
  /// An inequality p ≥ 0 of a joint, its multiplier z ≥ 0, and what a round changes them by.
  struct Bound {
    Row4 a{};              // −∂p/∂(s, t)
    double hardening = 0;  // η = ∂p/∂z
    double p = 0, z = 0, dp = 0, dz = 0;
    double missing = 0;  // what p is short of the function that it stands for: that of a cone is curved
    double weight = 0;   // √(z / (p + ηz))
    double aim = 0;      // √(…) times what p is to fall by, for z p to become μ
    Row4 q{};            // its row of Q: see eliminate()
  };

  /// The unknowns of one joint.
  struct Local {
    Row4 x{}, dx{};                   // (s, t)
    Row4 lack{};                      // J v + b − s/G − Σ z a, which is to vanish; and −Σ z a on t
    Row4 root{};                      // roots of the curvature without bounds: 1/√G
    std::array<Row4, 4> q{};          // its rows of Q
    double shear = 0;                 // h Q_max; 0: no cone
    bool on_surface = false;          // bounds are facets, not caps
    std::size_t first = 0, last = 0;  // of its bounds; a cone is the last

    Rows impulse() const { return {x[0], x[1], x[2]}; }
  };

  /// How far an iterate is from the minimum, J.
  struct Distance {
    double products = 0;  // Σ z p
    double lack = 0;      // what all that is to vanish adds to the gap
    double scale = 0;     // |v − v*|²_M + |v|²_M
    double rounding = 0;  // what the last bits of s make of the gap
    double gap() const { return products + lack; }
  };

  void start(const System& system);
  void open_friction(System& system);
  bool follow_friction(System& system, double energy, double mu);
  void enter_caps(const Joint& joint, const JointRecord& record, double energy, Local& local);
  void enter_surface(const Joint& joint, const RowLaw& law, Local& local);
  template <class Impulse>
  double balance(System& system, const Impulse& impulse);
  Distance measure(const System& system);
  double cone_lack(const Joint& joint, const Rows& m_eff, const Local& local) const;
  void factor(System& system, Hessian& hessian);
  void eliminate(const Joint& joint, Local& local);
  void eliminate_caps(Local& local);
  Row4 project(const Local& local, const Row4& y) const;
  void find_direction(const System& system, const Hessian& hessian, double mu, double second_order);
  double step_within(double reach) const;
  void move(double step);
  double share_without_gain(System& system);
  void finish(System& system, bool reached, Evaluation& at);

  std::vector<Local> locals_;
  std::vector<Bound> bounds_;
  std::vector<Rows> best_;  // from start_from() on where to start, from then on the best so far
  bool start_known_ = false;
  std::vector<Vec3> d_;
  std::vector<Row4> rows_;
  std::vector<std::size_t> order_;
};

}  // namespace ductile::dynamics
