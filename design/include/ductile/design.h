// What a designer asks of a plan before it ever runs: how much each joint is used, and what it takes to
// collapse.
//
// Statics of the pieces where they are drawn (first order) or where the loads bring them (second order, P–Δ),
// held by the plan's joints. Contacts and wheels
// carry nothing here: a structure that no joint holds to the ground, a static or a kinematic body is loose,
// and left out. SI units, signs as everywhere: N positive in tension, +M turns the second piece
// counter-clockwise against the first.
//
// For design time: limit analysis uses GLPK, under the GPL-3, and statics SPQR, under the GPL-2 or later; a
// program that links this is under the GPL-3. What a game links (section, joint, calibrate) needs neither.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/simulation.h"

namespace ductile {

/// What a joint carries at rest.
struct StaticJoint {
  double N = 0, Q = 0, M = 0;  ///< N, N, N m; NaN in a loose structure
  JointReading::Usage usage;   ///< |value| / cap of its sign; NaN where unlimited, 0 where the row is free
  /// The factor on all loads and gravity at which the joint yields: 1 / its largest usage, or with
  /// Plan::interaction where the ray from the origin leaves the yield surface; from prestress on, where lines
  /// are not as long as they are drawn. Unlimited where it never does.
  double yields_at = unlimited;
};

/// Elastic forces under the plan's loads, gravity and prescribed displacements of supports (settlement), each
/// at its full value whatever its ramp; factors are on all of them. What lines strain that are not as long as
/// they are drawn is there at the factor 0 and stays, while they go slack and taut as they must. Where loads
/// start and end, those that act at one time are taken together, and the time of least reserve is reported.
struct StaticCheck {
  double time = 0;                  ///< s
  std::vector<StaticJoint> joints;  ///< by Plan::joints
  std::vector<Point> displacement;  ///< m, by Plan::pieces: of the centre of mass, elastic
  std::vector<double> turn;         ///< rad, by Plan::pieces
  double reserve = unlimited;       ///< the least yields_at: the factor on all loads until the first yield;
                                    ///< of second order no more than the critical load factor
  std::vector<int> first_to_yield;  ///< joints that yield at some factor, the first first
  std::vector<int> loose;           ///< loose_pieces()
};

/// Pieces that no joint holds to anything that stands still: what rests on a structure, which statics leaves
/// out with its weight.
std::vector<int> loose_pieces(const Plan& plan);

enum class Order {
  first,   ///< equilibrium of the structure as drawn
  second,  ///< equilibrium in the deformed state, displacements small against the structure
};

/// The forces of least complementary energy among those in equilibrium with the loads (Menabrea): exact
/// where statics alone decides, by the joints' stiffnesses where it does not; rigid rows count as stiffer
/// than the stiffest by 1e6, each in proportion to its effective mass, as in the structure's solver. Throws
/// InvalidInput where the loads move a mechanism, or nothing is held.
///
/// Of second order, joints that stand for bars bend as those do between the middles of pieces (bars.h):
/// beam-columns, not springs between rigid pieces. N and Q are then along axes that have turned as those of a
/// simulation do, with the mean of a joint's two bodies; a support's axis has not. Where the structure
/// buckles at less than the loads, they have no state to tell of, and forces, usage and displacements are
/// NaN. `yields_at` of all but the first is interpolated between states up to the critical load, beyond which
/// it is unlimited.
StaticCheck static_check(const Plan& plan, Order order = Order::first);

/// Elastic buckling.
struct CriticalLoad {
  double factor = unlimited;      ///< on all loads and gravity; unlimited: no factor makes it buckle; 0: the
                                  ///< loads push on a motion without strain, however small they are
  std::vector<Motion> mode;       ///< by Plan::pieces: the largest displacement is 1 m; empty: no mode
  double time = 0;                ///< s, from when on these loads act (as in StaticCheck)
  std::vector<Motion> mechanism;  ///< such a motion, or one that loads neither push on nor hold; empty: none
};

/// The least factor at which the structure, elastic, has a state of equilibrium beside its own: K + α K_g is
/// singular for the first-order forces of the loads. What moves without strain is held by loads alone, as a
/// pendulum is: where these push it on, there is no stable state at any factor. Bars bend as in
/// static_check() of second order: within 1e-4 of Euler's loads with eight pieces to a half wave. Throws
/// InvalidInput as static_check() does.
CriticalLoad critical_load(const Plan& plan);

/// A joint, and the factor on all loads that brings it there.
struct Reached {
  int joint = -1;  ///< −1: none is
  double factor = unlimited;
};

/// Where the first fibre yields first, and the factor for each joint.
struct FirstFibre : Reached {
  int piece = -1;              ///< in whose length it does, where `joint` is −1; −1: in none
  std::vector<double> joints;  ///< by Plan::joints; unlimited: it never does
};

/// Where the first fibre of a section yields, of N and M: N E/EA + M E y/EI = f_y. A section bears more, up
/// to its plastic moment, which is what joints yield at (StaticCheck::first_to_yield). In a straight piece,
/// at its nodes and supports it is looked for between its cuts, whose sections the piece has. Of second order
/// when the check is. What is not cut has no section, and is passed over.
FirstFibre first_fibre(const Plan& plan, const StaticCheck& check, Order order = Order::first);

/// A piece that bears more within its length than where it is cut.
struct MissedMoment {
  int piece = -1;
  double factor =
      1;  ///< the most that it uses of M within, over the most that its joints use; may be infinite
};

/// Joints alone yield: where a load, a support or a node stands within a piece, or its own weight is large,
/// yield and collapse come too late by as much. The straight pieces of which a moment of more than 2 % is
/// missed, the worst first, but for those with less than a third of the largest moment.
std::vector<MissedMoment> missed_moments(const Plan& plan, const StaticCheck& check,
                                         Order order = Order::first);

/// What it takes to collapse.
struct LimitAnalysis {
  double load_factor = unlimited;  ///< on loads and gravity, or on loads alone; unlimited: they never suffice
  std::vector<int> hinges;         ///< joints that dissipate in a collapse mechanism
  double time = 0;                 ///< s, from when on these loads act (as in StaticCheck)
  std::vector<Motion> mechanism;   ///< by Plan::pieces: the largest displacement is 1 m
};

/// The collapse load factor of rigid-plastic joints in the geometry as drawn, by linear programming over all
/// forces in equilibrium (lower bound theorem); with Plan::interaction within each joint's N–M–Q surface, to
/// 1e-7 of it. Where several mechanisms collapse at the same load, the hinges are those of one. Throws
/// InvalidInput where the loads move a mechanism, are zero, or gravity alone, held fixed, cannot be carried.
LimitAnalysis limit_analysis(const Plan& plan, bool fixed_gravity = false);

/// Collapse in the deformed state.
struct Pushover {
  double load_factor = unlimited;  ///< as in LimitAnalysis
  std::vector<Reached> hinges;     ///< joints that yield, in order, each with the factor at which it does
  double time = 0;                 ///< s, as in StaticCheck
  std::vector<Motion> mechanism;   ///< by Plan::pieces: how it goes; the largest displacement is 1 m
  /// By Plan::joints, (N, Q, M), N and N m: at that load, or where it is unlimited, with the last hinge.
  std::vector<std::array<double, 3>> forces;
};

/// The largest factor on the loads that the structure bears as they grow from nothing, in the deformed state
/// (displacements small against the structure), joints yielding one by one and elastic again where they
/// unload: hinge by hinge to the point where no stable equilibrium follows. Joints are the plan's springs
/// between rigid pieces, as a slow simulation has them, perfectly plastic and unbreakable. Where a mechanism
/// forms that tension might yet hold, it counts as collapse. Supports' displacements grow with the loads;
/// where nothing else does (displacement control), the load factor is theirs, and unlimited where what their
/// supports carry no longer grows. Throws InvalidInput as limit_analysis() does.
Pushover second_order_limit(const Plan& plan, bool fixed_gravity = false);

/// How much may be left out.
struct LeaveOut {
  double tolerance = 0.01;  ///< displacement error that may be, over the size of the structure (its diagonal)
  double impact = 0;        ///< J that may hit a structure beside what is loose in the scene
  double seconds = 0;  ///< of the runs that confirm it; 0: 5 s more than until all loads have come and gone
  Stepping stepping = {};
  std::function<void(double share, const std::string& what)> progress = {};  ///< called from time to time
};

/// A plan that does without what its scene does not need, and what to run it with.
struct LeanPlan {
  Plan plan;  ///< with Plan::left_out
  JointSolver solver = JointSolver::direct;
  LeftOut all;  ///< the whole against the plan as it was
  std::vector<LeftOut>
      kept;  ///< tried, and not left out: the run showed more error, or did not surely save time
};

/// Merges pieces whose joints nothing in the scene can bring to yield, makes rows rigid whose elasticity is
/// not seen, drops caps that are not reached, and the structure's solver where each joint is alone.
///
/// What nothing can bring to yield is bounded by elastic theory: static forces of all loads, their swing as
/// they come and go, and the energy of what is loose around. Where a structure as a whole stays below yield,
/// so is the error that is promised; elsewhere it is an estimate. Every item is run with and without, and
/// kept only where the run shows no more than was promised. Joints with PlannedJoint::hold stay as they are.
/// Nothing is left out beside ropes, struts and drives: no bound knows what they do.
/// Throws InvalidInput as static_check() does.
LeanPlan leave_out(const Plan& plan, const LeaveOut& options = {});

}  // namespace ductile
