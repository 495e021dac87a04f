// One time step of a whole structure as one convex problem: pieces joined by elastic-plastic rows. Knows no
// engine.
//
//   f(v) = ½ (v − v*)ᵀ M (v − v*) + Σ φ(J v + b)
//
// v* are the velocities without the structure's impulses, φ the potentials of row.h. f is strictly convex, so
// the solution exists and is unique whatever the mass ratio, loop or yield pattern. Each piece's unknowns are
// in its own frame: H = M + Jᵀ G J then depends on relative rotations only, and its factor survives tumbling
// and rest.
//
// Poses are kept here in double, beside the engine's floats: one float ulp at 20 m times the stiffness of
// steel is 10⁸ N. A step is: write v* and call solve() (as often as something else changed velocities), then
// advance().
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "block_ldlt.h"
#include "forecast.h"
#include "row.h"
#include "vec3.h"

namespace ductile {

/// Of a centre of mass: m from the structure's origin, rad.
struct Pose {
  double x = 0, y = 0, angle = 0;
};

struct Place {
  Pose pose;
  Turn turn;  // of the angle
};

struct SolverBody {
  double mass = 1, inertia = 1;  // kg, kg m² about the centre of mass; inertia 0: does not rotate
  double inverse_mass = 1, inverse_inertia = 1;  // of them; 0 where it does not rotate
  Vec3 v_free;                                   // v*: m/s and rad/s in the body's own frame
  Vec3 v;                                        // the solution; also where the next solve starts
};

/// A joint as the solver sees it: two bodies and three rows. Here is what every step reads and writes; what
/// it needs only where something flows, is factored or changes, is in the joint's record: large structures do
/// not fit the cache, and each pass over them costs what it drags along.
struct SolverJoint {
  // What steps write, together: what is only read need not go back to memory.
  int a = 0, b = 0;                       // bodies
  Turn axis_a, axis_b;                    // the axis in A's and B's own frames
  double au = 0, av = 0, bu = 0, bv = 0;  // rotational entries of the axial and shear rows of J
  Rows bias{};                            // b, m/s or rad/s
  Rows impulse{};                         // s, N s
  std::uint8_t piece = 0;                 // of the law: which rows flow, and which way (row.h)
  std::uint8_t factored = 0;              // rows that were flowing in the factor at hand
  bool free = false;                      // some row holds nothing
  int block = -1;                         // of H, when both bodies are free

  // What they read.
  Rows G{}, elastic_range{};  // of the law (row.h)
  Rows neutral{};             // gap (u, v, θ) at which the row is stress-free: grows by plastic flow
  double ax = 0, ay = 0, bx = 0, by = 0;  // anchors from the centres of mass, own frames, m
  Turn axis;                              // in A's frame at rest
  double follow = 0.5;   // share of B's rotation against A that the frame follows: ½, or 0: fixed to A
  double reference = 0;  // angle of B against A at rest
};

/// The rest of a joint, at the same index.
struct JointRecord {
  // What a step need not keep unless it is asked for.
  Rows gap{};  // u, v, θ: after find_gaps()
  Rows x{};    // J v + b of the last evaluation: of what flows, and of all after find_x()

  // Where steps change their length, rows are damped or flow on a yield surface.
  Rows relaxation{};  // hk/G: bias per strain, 1/s
  Rows strain{};      // elastic, at the step's start
  double late = 0;    // Σ m_eff d² of what a longer step parted and is not taken back yet

  RowLaw law;

  // Factorisation.
  Rows slope{};                                     // ds/dx that is in H
  double slope_nq = 0, slope_nm = 0, slope_qm = 0;  // and what couples the rows on a yield surface

  // What has flowed.
  Rows plastic{};                        // net plastic offset
  Rows flowed_forward{}, flowed_back{};  // accumulated plastic offset by sign, ≥ 0
  Rows dissipated{};                     // J
  Rows stored{};                         // J: ½ k e² of the last step, when a ledger is kept

  // Configuration, and what the step makes of it.
  Rows stiffness{};  // N/m, N/m, N m/rad; infinite: rigid; 0: free
  Rows damping_ratio{};
  Rows cap{}, cap_reverse{};  // N, N, N m
  Rows hardening{};           // N/m, N/m, N m/rad
  const YieldSurface* surface = nullptr;
  Rows m_eff{};    // effective masses of the rows at rest
  Rows spring{};   // the stiffness that the step can integrate (≤ stiffness)
  Rows damping{};  // c, N s/m or N m s
};

struct SolveReport {
  int rounds = 0;  // directions computed
  int factorisations = 0;
  double residual = 0;  // |∇f| in the norm of M⁻¹ as a share of its target, times `tolerance`
  bool bound_hit = false;
};

/// Where the energy of a structure went besides its joints' plastic work, J since the start. Each term is a
/// sum of closed forms over rows and steps, none a difference of totals.
struct Ledger {
  double damping = 0;    // c ė² h of the rows
  double numerical = 0;  // what implicit Euler, the motion of J within a step, and pushes by contacts take
  double driven = 0;     // what bodies give whose motion is not the solver's to find
};

class Solver {
 public:
  /// Rigid rows are G = κ m_eff; true stiffness is capped there too, which bounds the condition of H for any
  /// size, any E and any dt. Below 1e8 a rigid cantilever of 80 pieces is soft enough to overshoot and flow
  /// at 0.999 of its cap when gravity sets in at once; at 1e10 nothing is lost yet in double precision.
  static constexpr double rigid_ratio = 1e9;
  /// The facet of a yield surface that a joint flows on is a needle of width 1/κ among the directions of
  /// flow. Where so many rounds have not found it, those that follow look for one that is wide enough.
  static constexpr int soften_round = 20;
  static constexpr double soft_ratio = 1e5;
  /// Relative residual at which a solve ends: root moments good to 1e-8.
  static constexpr double tolerance = 1e-8;
  /// Rows that are stiffer than so many m_eff/h² are taken as rigid.
  double elastic_ratio = rigid_ratio;
  int round_bound = 100;
  /// s in which what turning bodies parted in a longer step is still to be taken back.
  double drift_time = 0;
  static constexpr int newton_rounds = 5;

  /// Free bodies come first, numbered in elimination order (see BlockLdlt::order_for); the rest is moved by
  /// others (static and kinematic bodies): their v is known.
  std::vector<SolverBody> bodies;
  std::vector<Place> places;  // where they are
  std::vector<SolverJoint> joints;
  std::vector<JointRecord> records;  // of the joints
  const JointRecord& record(const SolverJoint& joint) const {
    return records[static_cast<std::size_t>(&joint - joints.data())];
  }
  JointRecord& record(const SolverJoint& joint) {
    return records[static_cast<std::size_t>(&joint - joints.data())];
  }

  /// After bodies and joints were filled in or their masses changed. Allocates.
  void form(std::size_t free_bodies);
  std::size_t free_bodies() const { return free_; }

  /// Prepares a step of h seconds from the current poses.
  void begin(double h);
  /// Something else changed a body's velocity since the last solve: v_free, in the body's own frame. All that
  /// happens between two solves of a step is told so, or none of it.
  void push(std::size_t body, const Vec3& change);
  /// Velocities from v_free; false when nothing had to be done.
  bool solve(SolveReport& report);
  /// After solve(): all velocities, to a share of them.
  void slow_down(double share);
  /// Moves poses by h v, books plastic flow. The next solve starts where the last solutions point to.
  void advance();
  /// Moves the bodies toward poses that something else pushed them to, in such a way that no joint is
  /// strained by it: least ½|x − goal|²_M with the gaps of all rows that hold kept. With `try_goal` the goal
  /// itself is tried first: right where all of it may have been moved alike. False where gaps could not be
  /// kept: then the bodies stay where they were pushed to.
  bool project(std::span<const Pose> goal, bool try_goal);

  /// Whether nothing flows and what the last solution still moves changes no force by more than
  /// rest_tolerance: the next step is this one if nothing else touches the bodies.
  bool at_rest();
  static constexpr double rest_tolerance = 1e-7;
  /// Whether any row was beyond its cap in the last solve.
  bool any_flows() const { return flows_; }
  /// Of the bodies in the last solve, m/s and rad/s.
  double fastest() const { return std::sqrt(fastest_); }
  double fastest_turn() const { return std::sqrt(fastest_turn_); }
  /// Root mean square of the velocity that the structure's impulses made in the last solve, m/s.
  double impulse_speed() const { return mass_ > 0 ? std::sqrt(scale_ / mass_) : 0; }

  /// Instead of solve() and project(), joint by joint (sweep.cpp): the impulses of the last step again, one
  /// pass over the joints' velocities, and one over their positions from where the bodies are.
  void warm_start();
  void sweep();
  void sweep_positions(std::span<const Pose> at);

  /// Asks for a ledger: then `before` are the velocities at the step's very start, in own frames.
  bool keeps_ledger = false;
  Ledger ledger;
  std::vector<Vec3> before;
  /// After the step: by what contacts and limits changed velocities after the last solve, world axes.
  void close_ledger(std::span<const Vec3> change);
  /// Caps or stiffness were edited.
  void laws_changed() { laws_set_ = false; }
  /// Puts a body somewhere; then locate(): gaps and Jacobian anew.
  static void put(Place& place, const Pose& at);
  void locate();
  /// Writes gaps where the bodies are into the records.
  void find_gaps();
  /// Of the last solve, N, N, N m.
  static Rows force(const SolverJoint& joint, const JointRecord& record);
  /// The elastic strain that the last solve ended with, m or rad. The gap itself may be more: turning bodies
  /// part along their tangents for a step, by r(ωh)²/2, before the next one brings them back.
  static double elastic(const SolverJoint& joint, const JointRecord& record, unsigned row);
  double step() const { return h_; }
  std::size_t bytes() const;

 private:
  Rows locate(SolverJoint& joint) const;
  void set_law(SolverJoint& joint);
  static void set_bias(SolverJoint& joint, const Rows& gap, double rate);
  void soften();
  void factor_tangents();
  void factor_holding();
  void factor();
  int interior_point();
  static Rows relative(const SolverJoint& joint, const Vec3& a, const Vec3& b);
  bool stands_still();
  template <class Change>
  double evaluate(const Change& change);
  double evaluate();
  Vec3 own_part(const SolverBody& body);
  void see_speed(const Vec3& v);
  void add_impulses();
  void find_x(double faster = 1);
  double pull(std::span<const Pose> goal);
  double strain();
  bool push_far(std::span<const Pose> goal, double enough);
  double largest_turn() const;
  double correction(std::span<Vec3> d, double enough = 0);
  void scatter(const SolverJoint& joint, const Rows& s);
  double norm_of_gradient();
  static double square(const SolverBody& b, const Vec3& g);
  static bool is_rigid(const JointRecord& record, unsigned row) {
    return record.spring[row] != record.stiffness[row];
  }
  bool line_search(double slope0, double slope1);
  double objective();
  double rounding_of_impulses() const;
  void coast();
  void drop_impulses();
  void drop_if_beyond(double times);
  void book(SolverJoint& joint, const Rows& gap);
  void flow(SolverJoint& joint, const Rows& gap);
  void slow_down(SolverJoint& joint);
  Vec3 told_velocity(std::size_t body) const;
  void open_ledger();
  void account(SolverJoint& joint, const Rows& strain_before, const Rows& booked);
  static void displace(Place& place, const Vec3& by);

  std::size_t free_ = 0;
  double mass_ = 0;  // of all free bodies
  double h_ = 0;
  BlockLdlt ldlt_;
  Forecast forecast_;
  bool predicted_ = false;  // the next solve starts where forecast_ says
  bool factored_ = false;
  bool holding_ = false;     // the factor at hand is project()'s
  bool held_ = false;        // and of what holds now
  bool laws_set_ = false;    // joints' laws are those of this step's length, caps and stiffness
  bool damped_ = false;      // any row is
  bool peculiar_ = true;     // any row is damped or on a yield surface
  bool gaps_found_ = false;  // no pose was moved since
  bool biased_ = false;      // joints' biases are those of a step like the last from where the bodies are
  bool softened_ = false;    // rigid rows with a yield surface are at soft_ratio
  bool newton_ = false;      // and it is of this step's geometry, of tangents, not secants
  double shrinks_ = 1e6;     // a round with a factor of an earlier step: |∇f|² by so many times
  bool short_step_ = false;  // the last line search ended early: secants for flowing rows help the next round
  bool coasting_ = false;
  bool swept_ = false;  // the last velocities are sweep()'s: x of rows that flow is but their direction
  std::vector<std::size_t> touched_;  // by push(), which has kept g_ what it is at v since the last solve:
  std::size_t touches_ = 0;           // so many
  bool gradient_known_ = false;       // no pose was moved since the last solve
  double left_ = 0;                   // |∇f|² that the last solve ended with
  double pushed_ = 0;                 // and by how much it has grown by them
  double slowed_ = 1;                 // share of the solution that the bodies move with
  // Of the last evaluation:
  double scale_ = 0;                       // |v − v*|²_M
  double speed_ = 0;                       // |v|²_M
  double fastest_ = 0, fastest_turn_ = 0;  // squares
  int changed_ = 0;                        // rows whose state is not the factor's
  bool crossed_ = false;                   // rows changed their state since the evaluation before
  bool curved_ = false;                    // any joint flows on its yield surface
  bool flows_ = false;                     // any row is beyond its cap
  std::vector<Vec3> g_, d_, z_;
  // One row in interior_point(): see there. Sides: the cap and the reverse cap.
  struct Barrier {
    double s, ds, r, hardening;
    double p[2], z[2], dp[2], dz[2], second[2];
    bool bounded[2];
  };
  std::vector<std::array<Barrier, 3>> barrier_;
  std::vector<Pose> poses_, start_;
  std::vector<Rows> gaps_;
  std::vector<SolverJoint> opened_;  // J of the step whose ledger is open, and the frames it is in
  std::vector<Turn> turns_;
};

}  // namespace ductile
