// Bodies and joints of one structure as the solver sees them: plain arrays that all its parts share.
//
// Each body's unknowns (vx, vy, ω) are in its own frame: H = M + Jᵀ G J then depends on relative rotations
// only, and its factor survives tumbling and rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "pool.h"
#include "pose.h"
#include "row.h"

namespace ductile::dynamics {

struct Body {
  double mass = 1, inertia = 1;  // kg, kg m² about the centre of mass; inertia 0: does not rotate
  double inverse_mass = 1, inverse_inertia = 1;  // of them; 0 where it does not rotate
  Vec3 v_free;  // v*, m/s and rad/s: velocity without the structure's impulses
  Vec3 v;       // the solution; also where the next solve starts

  void keep(Tape& tape) { tape(v_free, v); }
};

/// The rows of J that a joint has for its two bodies, and nothing that is 0 or ±1 in them.
struct Jacobian {
  Turn axis_a, axis_b;                    // the joint's axis in A's and B's own frames
  double au = 0, av = 0, bu = 0, bv = 0;  // rotational entries of the axial and the shear row, m
};

template <>
inline constexpr bool all_doubles<Jacobian> = true;

/// Where a joint sits on its bodies.
struct Frame {
  double ax = 0, ay = 0, bx = 0, by = 0;  // anchors from the centres of mass, own frames, m
  Turn axis;                              // in A's frame at rest
  double follow = 0.5;   // share of B's rotation against A that the frame follows; 0: it is fixed to A
  double reference = 0;  // angle of B against A at rest, rad
  bool line = false;     // the axis runs from anchor to anchor
};

/// What every step reads and writes of a joint. What it needs only where something flows, is factored or
/// changes, is in the joint's record: large structures do not fit the cache, and each pass over them costs
/// what it drags along.
struct Joint {
  int a = 0, b = 0;  // bodies
  Jacobian J;
  Rows bias{};                               // b, m/s or rad/s
  Rows impulse{};                            // s, N s or N m s
  std::uint8_t regime = 0;                   // of the law (row.h)
  std::uint8_t factored_flow = 0;            // rows that were flowing in the current factorisation
  bool special = false;                      // some row is driven or goes slack (drive.h)
  std::uint8_t newmark = 0, overdamped = 0;  // rows with δ < 1 and with δ > 1, one bit each
  std::uint8_t flowed = 0;                   // rows that flowed in the last step, one bit each
  bool damped = false;                       // some row has 0 < δ < 1
  int block = -1;                            // of H, when both bodies are free

  Rows G{}, elastic_range{};   // of the law
  Rows relaxation{}, carry{};  // of the law: b of the next step
  Rows rate{};           // w: what the law carries over of the last step's rates, m/s or rad/s; times h₋/h
  Rows trend{};          // t, m or rad: what it carries over of u₋, m₋ and m₌
  Rows moved{}, mean{};  // u₋ and m₋, m or rad
  Rows neutral{};        // gap (u, v, θ) at which the row is stress-free: moves with plastic flow
  Frame frame;

  /// Whether some row holds nothing.
  bool has_free_row() const { return G[0] == 0 || G[1] == 0 || G[2] == 0; }
  bool is_newmark(unsigned row) const { return (newmark >> row & 1u) != 0; }
  bool is_overdamped(unsigned row) const { return (overdamped >> row & 1u) != 0; }
  /// Whether a row flows that did not in the last step.
  bool begins_to_flow() const { return (flowing(regime) & ~unsigned{flowed}) != 0; }
  /// Knows nothing of what its rows did.
  void forget_rates() { rate = trend = moved = mean = {}; }
  void keep(Tape& tape) {
    tape(bias, impulse, regime, factored_flow, flowed, rate, trend, moved, mean, neutral);
  }
};

/// Plastic offsets, m, m, rad.
struct PlasticFlow {
  Rows net{};
  Rows forward{}, back{};  // accumulated by sign, ≥ 0
};

/// Inertia against a change of the rate at which two bodies turn, or turn what pulls at them:
/// turn_inertia.h.
struct TurnInertia {
  int a = 0, b = 0;                      // bodies
  int block = -1;                        // of H, when both are free
  Vec3 row_a{0, 0, -1}, row_b{0, 0, 1};  // of the rate, for their velocities in their own frames
  double inertia = 0;                    // C, kg m²; kg where the rate is a velocity
  double rate = 0;                       // w, rad/s or m/s
  double impulse = 0;                    // N m s or N s: along row_b on B, row_a on A, of the last solve
  double highest = 0, unneeded = 0;      // what was needed at most, in so many s

  double rate_of(const Vec3& va, const Vec3& vb) const { return dot(row_a, va) + dot(row_b, vb); }
  void add(double s, Vec3& to_a, Vec3& to_b) const {
    to_a += s * row_a;
    to_b += s * row_b;
  }
  void keep(Tape& tape) { tape(row_a, row_b, inertia, rate, highest, unneeded); }
};

/// Free bodies that turn as one: each is part of another, up to the one that has the mass of all.
struct Clump {
  int part_of = 0;
  double mass = 0;  // kg
};

/// Free bodies that hang together: each is part of another, up to the one that has the sums of all (whole.h).
struct Whole {
  int part_of = 0;
  bool held = false;    // by what is not free, or does not turn
  double mass = 0;      // kg
  double x = 0, y = 0;  // of the centre of mass, m
  double inertia = 0;   // about it, kg m²; 0 of what is held
  double spin = 0;      // rad/s; 0 of what is held
  double moment = 0;    // N m s: that it is owed
};

template <>
inline constexpr bool all_doubles<PlasticFlow> = true;

/// δ of axial and shear rows for how far bodies turn in a step (step_laws.h).
struct TurnGuard {
  double delta = 0;
  double unneeded = 0;  // s that this was more than three times what was needed
};

template <>
inline constexpr bool all_doubles<TurnGuard> = true;

/// The rest of a joint, at the same index.
struct JointRecord {
  Rows gap{};  // u, v, θ: of the present poses
  Rows x{};    // J v + b of the last evaluation: of what flows, and of all after find_x()
  RowLaw law;
  Coupling tangent;       // ds/dx that is in H
  int turn_inertia = -1;  // index into System::turn_inertias, of the first
  Rows drift{};           // m or rad: constraint drift of a longer step that is still to be taken back
  TurnGuard turn_guard;
  bool turn_drifts = false;  // `drift` is of turning in a step of another length (step_laws.h)
  unsigned eased = 0;        // rows, one bit each, whose `drift` no force stands for (StepLaws::follow_law())
  unsigned halts = 0;        // rows, one bit each, whose forces stopped growing in the last step
  PlasticFlow plastic;
  Rows drive_rate{};  // of driven rows in this step, m/s or rad/s
  Rows dissipated{};  // J
  Rows stored{};      // J: elastic, half a step before the last step's end, when a ledger is kept
  Rows strain{}, strain_before{};  // m or rad: that this is the energy of, and that of a step before
  Material material;
  Rows m_eff{};  // effective masses of the rows at rest, kg or kg m²
  // How many times as heavy its bodies would be, were each of them the heaviest that is joined to it.
  double lightness = 1;
  double held = 1;  // share of this step's flow after which the joint breaks

  void keep(Tape& tape) {
    tape(gap, x, law, tangent, turn_inertia, drift, turn_guard, turn_drifts, eased, halts, plastic,
         dissipated, stored, strain, strain_before, drive_rate, lightness);
  }
};

/// A point of contact. Arms and normal are in the bodies' own frames.
struct Contact {
  int a = 0, b = 0;                       // bodies
  double ax = 0, ay = 0, bx = 0, by = 0;  // the point from the centres of mass, m
  Turn normal_a, normal_b;
  double bounce = 0;               // b: normal velocity that restitution asks for, m/s
  double conveyor = 0;             // τ, m/s
  double friction = 0;             // μ
  double normal = 0, tangent = 0;  // impulses, N s: where to start, and of the last solve; normal ≥ 0 presses
  std::uint64_t id = 0;            // of the same point in the next step; below 2³²

  void keep(Tape& tape) {
    tape(a, b, ax, ay, bx, by, normal_a, normal_b, bounce, conveyor, friction, normal, tangent, id);
  }
};

/// A joint that is not the structure's own, as rows of a step: s = clamp(G (J v + b), −c⁻, c).
struct Link {
  int a = 0, b = 0;  // bodies
  Jacobian J;
  Rows G{};  // kg or kg m²: of springs; infinite: as stiff as contacts; 0: no row
  Rows bias{};
  Rows cap{}, cap_reverse{};  // N s or N m s, ≥ 0
  Rows impulse{};             // where to start, and of the last solve
  unsigned goes_on = 0;       // rows, one bit each, whose compliance 1/G counts from that start, not from 0
  std::uint64_t id = 0;       // of the same kind of rows in the next step; below 2³²

  void keep(Tape& tape) { tape(a, b, J, G, bias, cap, cap_reverse, impulse, goes_on, id); }
};

/// Free bodies come first, numbered in elimination order (BlockLdlt::order_for); the velocities of the others
/// (static and kinematic bodies) are prescribed.
struct System {
  Vector<Body> bodies;
  Vector<Place> places;               // of the bodies
  Vector<Joint> joints;               // the structure's own, then rows of links, then those of contacts
  Vector<JointRecord> records;        // of the joints
  Vector<TurnInertia> turn_inertias;  // of some of them: one each, or three
  Vector<Clump> clumps;               // of the free bodies, for turn_inertia.cpp
  Vector<Whole> wholes;               // of the free bodies, after find_wholes()
  Vector<Vec3> returned;              // of the free bodies or of none, N s and N m s: return_moments()
  Vector<int> driven, rated;          // joints: of them some row is driven, or has a rate law
  Vector<int> slackening;             // joints: of them some row goes slack
  Vector<Link> links;                 // whose rows follow the structure's own joints
  Vector<Contact> contacts;           // whose rows follow those
  Vector<std::pair<int, int>> pairs;  // bodies that these may join: part of the pattern of H
  std::size_t free = 0;               // bodies
  double mass = 0;                    // of all free bodies, kg
  bool biases_known = false;          // the joints' are those of an equal step from the present poses

  const JointRecord& record(const Joint& joint) const { return records[index(joint)]; }
  JointRecord& record(const Joint& joint) { return records[index(joint)]; }
  std::size_t index(const Joint& joint) const { return static_cast<std::size_t>(&joint - joints.data()); }
  /// How many joints are the structure's own; they.
  std::size_t own() const { return joints.size() - contacts.size() - links.size(); }
  std::span<Joint> own_joints() { return {joints.data(), own()}; }
  std::span<const Joint> own_joints() const { return {joints.data(), own()}; }
  std::size_t first_contact() const { return joints.size() - contacts.size(); }
  bool is_free(int body) const { return z(body) < free; }
  /// Of a free body without the structure's impulses; of another the prescribed one.
  const Vec3& free_velocity(int body) const {
    return is_free(body) ? bodies[z(body)].v_free : bodies[z(body)].v;
  }
  /// Whether tension between two bodies turns each by itself: turn_inertia.h.
  bool turns_each(const Joint& joint) const;

  /// After form(), of the same bodies and joints.
  void keep(Tape& tape);
  /// Inverse masses and the total mass, of so many free bodies, and m_eff of the joints from `first` on.
  void form(std::size_t free_bodies, std::size_t first = 0);
  /// A joint of the structure goes, and the last of these takes its index. In the pattern of H its bodies
  /// stay a pair.
  void remove(std::size_t joint);
  /// Before form(): so many free bodies come before all others, and so many that are not free after them.
  /// What else holds or touches the bodies goes.
  void insert_bodies(std::size_t first, std::size_t last);

 private:
  bool keep_others(Tape& tape);
};

/// After keep() has read a joint and its record: what follows from them.
void restore(Joint& joint, JointRecord& record);

/// Of the last solve, N, N, N m.
Rows force(const Joint& joint, const JointRecord& record);

/// Whether a row is stiffer than the step can integrate.
inline bool is_rigid(const JointRecord& r, unsigned i) { return r.law.spring[i] != r.material.stiffness[i]; }

/// Whether a row is integrated by implicit Euler, as rigid and very stiff ones are.
inline bool is_implicit(const JointRecord& r, unsigned i) { return r.law.delta[i] == 1; }

/// Whether a row that takes one sign took nothing in the last step (drive.h).
inline bool is_slack(const Joint& j, const JointRecord& r, unsigned i) {
  return r.material.may_slacken(i) && j.impulse[i] == 0;
}

/// A strain that no more than |limit| is left of.
inline double within(double strain, double limit) {
  return std::clamp(strain, -std::abs(limit), std::abs(limit));
}

/// The elastic strain e that a row's bias was made of, m or rad.
inline double strain_of_bias(const Joint& j, unsigned i) {
  return (j.bias[i] + j.carry[i] * j.rate[i]) / j.relaxation[i] - j.trend[i];
}

/// The reverse: the bias of a row that is strained by e.
inline double bias_of_strain(const Joint& j, unsigned i, double e) {
  return j.relaxation[i] * (e + j.trend[i]) - j.carry[i] * j.rate[i];
}

/// T of a row of Newmark's: what turning bodies parted by in the last step, of h seconds (row.h), m.
inline double parting(const Joint& j, unsigned i, double h) { return (h * j.rate[i] - j.moved[i]) / 2; }

/// The elastic strain at the end of the last step, m or rad: that of the biases; in implicit rows R/k, beside
/// heavy dampers no more than R/k. The gap itself may be more there: turning bodies part along their tangents
/// in a step, by r(ωh)²/2, before the next step closes them.
inline double elastic_strain(const Joint& j, const JointRecord& r, unsigned i) {
  if (!(j.relaxation[i] > 0) || is_slack(j, r, i)) return 0;
  if (r.law.delta[i] < 1) return strain_of_bias(j, i);
  const double by_force = j.impulse[i] / (r.law.h * r.law.spring[i]);
  return is_implicit(r, i) ? by_force : within(strain_of_bias(j, i), by_force);
}

}  // namespace ductile::dynamics
