// Breakable elastic-plastic joints inside unmodified Box2D 2.4.1, and the structure that solves them
// together.
//
// Three rows act in the joint's own frame, whose axis runs from body A to body B and which turns with the
// mean of the two bodies (other shares by def: axisFollow):
//   axial     u along the axis           N > 0 in tension
//   shear     v to the left of the axis  Q > 0 pushes B to the right
//   rotation  θ of B against A           M > 0 when B is bent counter-clockwise against A: the right is in
//   tension
// Each row is a spring (or rigid, or free) in series with a slider at its cap: below the cap it is elastic,
// at the cap it flows and its neutral position moves along. What has flowed adds up, and a joint breaks where
// that exceeds its maximum. SI units. Nothing here throws inside
// b2World::Step but std::bad_alloc (memory.h); in the steady state nothing is allocated there.
#pragma once

#include <box2d/box2d.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "ductile/joint_law.h"
#include "ductile/memory.h"

namespace ductile {

class ElasticPlasticJoint;
class Structure;
namespace dynamics {  // what is private to the room
struct Component;
struct Joint;
struct JointRecord;
struct Member;
}  // namespace dynamics

/// The state of a joint: to store it with a level, to begin with a bent bridge, to damage and to repair. By
/// row: m, m, rad.
struct JointState {
  double elastic[3] = {};  ///< strain that its force stands for
  double plastic[3] = {};  ///< net offset of B against A
  double forward[3] = {};  ///< accumulated ≥ 0: lengthening, slip to the left, counter-clockwise rotation
  double back[3] = {};     ///< the other way
  double dissipated[3] = {};  ///< J
  bool yielded = false;       ///< whether it ever flowed
};

/// Definition of an elastic-plastic joint, as a b2WeldJointDef is of a weld.
struct ElasticPlasticJointDef : b2JointDef {
  /// Anchor in world coordinates; the axis runs from body A's centre of mass to the anchor (the paper's
  /// r_anc), or along body A's x axis where the two coincide.
  void Initialize(b2Body* bodyA, b2Body* bodyB, const b2Vec2& anchor);
  /// The same with the axis given, in world coordinates (any length > 0).
  void Initialize(b2Body* bodyA, b2Body* bodyB, const b2Vec2& anchor, const b2Vec2& axis);
  /// A line between two anchors, which turns freely at both: a rope, strut, winch or jack. Its axial row,
  /// `rows[axial]`, is yours to set; the others are free.
  void InitializeLine(b2Body* bodyA, b2Body* bodyB, const b2Vec2& anchorA, const b2Vec2& anchorB);

  b2Vec2 localAnchorA{0, 0};  ///< relative to body A's origin, m
  b2Vec2 localAnchorB{0, 0};  ///< relative to body B's origin, m
  float axisAngle = 0;        ///< of the axis in body A's frame, rad
  float axisFollow =
      0.5f;  ///< share of B's turn against A that the axis follows: ½: mean of both; 0: fixed to A
  float referenceAngle = 0;  ///< angle of B minus angle of A at rest, rad
  /// The axis runs from anchor to anchor wherever they are, and u is their distance. Needs a free shear and
  /// rotation row.
  bool line = false;
  double length = -1;  ///< m: of a line without force; below 0: the anchors' distance when it is first solved

  RowDef rows[3];                      ///< axial, shear, rotation
  double max_rotation = unlimited;     ///< rad: breaks where accumulated plastic rotation exceeds it
  double max_elongation = unlimited;   ///< m: accumulated plastic lengthening
  double max_compression = unlimited;  ///< m: accumulated plastic shortening
  double max_slip = unlimited;         ///< m: accumulated plastic shear
  /// N–M curve that replaces the independent caps of N and M (and with the shear cap, of Q): a convex polygon
  /// with the origin inside, counter-clockwise in the (N, M) plane. Empty: independent caps.
  std::vector<AxialMoment> interaction;
  /// Caps that grow with the rate of plastic flow. Not with an interaction curve, hardening, drives or rows
  /// that slacken, nor with SolverKind::iterative.
  std::optional<RateLaw> rate;
  int break_group = 0;  ///< joints of one group ≠ 0 break together, in the mode of the first
  /// Joints of one node ≠ 0 hold several bodies at one point to body A, which they share. Where that body is
  /// destroyed, Structure::update() joins the others to each other, each by its own rows and maxima.
  int node = 0;
  /// What the joint begins with. It finds its bodies where they are and is strained by state.elastic there;
  /// state.plastic moves nothing.
  JointState state;
};

/// A joint of a Structure. The world owns it as it owns every joint: b2World::DestroyJoint and DestroyBody
/// just work, and so do its base class's calls; GetType() says e_weldJoint (use ElasticPlasticJoint::cast).
class ElasticPlasticJoint : public b2WeldJoint {
 public:
  /// The joint as an elastic-plastic one, be its structure gone; nullptr where it is another.
  static ElasticPlasticJoint* cast(b2Joint* joint);

  std::uint32_t id()
      const;            ///< unique among the joints of its world that have the same solver, never used again
  b2Vec2 axis() const;  ///< unit, world

  // Forces of the last step, tension positive.
  double force(Row row) const;  ///< N, N, N m
  /// |force| / cap of its direction; 0 for a free row, NaN for an unlimited one.
  double usage(Row row) const;
  double cap(Row row, bool reverse = false) const;  ///< N, N, N m; grows with hardening

  // Deformation.
  double elastic(Row row) const;  ///< m, m, rad: the elastic part now
  /// m, m, rad: the row's coordinate (u, v, θ) where it is without force: the length of a rope, the
  /// position of a drive.
  double neutral(Row row) const;
  double plastic(Row row) const;        ///< m, m, rad: net plastic offset, b against a
  double accumulated_rotation() const;  ///< rad: Σ|plastic rotation|
  double elongation() const;            ///< m: Σ plastic lengthening
  double compression() const;           ///< m: Σ plastic shortening
  double slip() const;                  ///< m: Σ|plastic shear|
  /// The largest accumulated value over its maximum: the joint breaks at 1. 0 where nothing can break: there
  /// ductility() tells how much it went through.
  double capacity_used() const;
  /// The cumulative ductility: Σ|plastic| of a row in multiples of what it gives elastically before it
  /// yields, cap/stiffness, the largest of the rows; with an interaction curve, the cap of the row alone. 0
  /// before yield, infinite where a rigid row has flowed: there dissipated() tells.
  double ductility() const;
  /// 0 unloaded … 1 yields … 2 broken: stage_of() in stage.h.
  double stage() const;
  bool yielded() const;  ///< whether it ever flowed, limit or none
  bool broken() const;   ///< carries nothing any more; gone after Structure::update()

  // Energy.
  double dissipated() const;      ///< J: plastic work so far
  double elastic_energy() const;  ///< J: ½ k e² of its rows now, no more than ½ R²/k

  /// Whether the stiffness asked for is more than the step can integrate, so that the row is softer than that
  /// (docs/theory/rows.md: κ).
  bool stiffness_limited(Row row) const;

  /// Changes a row while the world is not stepping; wakes the bodies. Throws std::invalid_argument where a
  /// def may not have the row so, and caps of a joint with an interaction curve, which are the curve's.
  void set_caps(Row row, double cap, double cap_reverse);
  /// RowDef::damping of the row becomes 0.
  void set_stiffness(Row row, double stiffness, double damping_ratio);
  /// Drives a row from where its neutral position is. A row that carries nothing (caps of 0) lets go, and
  /// takes hold where it is when it is given caps again.
  void drive(Row row, const Drive& drive);
  void set_limits(double max_rotation, double max_elongation, double max_compression, double max_slip);

  /// The def that makes this joint again where its bodies are: caps as far as they have hardened, and state.
  ElasticPlasticJointDef def() const;
  /// def().state
  JointState state() const;
  /// Sets what was used up and how far it is strained, between steps; no body is moved by it. {}: as new,
  /// without force where it is, and as bent as it is; a rope that is slack becomes as short as it hangs (keep
  /// `elastic`, its slack below 0, where it is to stay as long). What has hardened stays: see set_caps().
  /// Throws std::invalid_argument where a number is not finite, or forward or back is negative.
  void set_state(const JointState& state);

  b2Vec2 GetReactionForce(float inv_dt) const override;
  float GetReactionTorque(float inv_dt) const override;
  void ShiftOrigin(const b2Vec2& newOrigin) override;

 protected:
  void InitVelocityConstraints(const b2SolverData& data) override;
  void SolveVelocityConstraints(const b2SolverData& data) override;
  bool SolvePositionConstraints(const b2SolverData& data) override;

 private:
  friend class Structure;
  static ElasticPlasticJoint* put_in_place(b2WeldJoint* weld, dynamics::Member* member);
  ElasticPlasticJoint(const b2WeldJoint& weld, dynamics::Member* member);
  ~ElasticPlasticJoint() override;

  const dynamics::Joint& row_state() const;
  const dynamics::JointRecord& record() const;
  RowDef row(Row row) const;
  void require(Row row, const RowDef& to) const;
  void wake();

  friend struct dynamics::Member;
  dynamics::Member* member_;
  dynamics::Component* component_ = nullptr;  // member_'s, as each step looks at it
  bool leads_ = false;                        // first joint of its island: does the work of all
};

/// How Structure::draw() shows joints. A scale of 0 leaves its mark out.
struct JointDrawing {
  float force = 0;    ///< m per N: a line from the joint along N t + Q n, the axis t and its left n
  float moment = 0;   ///< m per N m: radius of a circle, orange for M > 0 and blue below
  float neutral = 0;  ///< m: length of a line from where the joint is without stress, along the turned axis
  float dot = 8;      ///< pixels: a point in the colour of the joint's stage()
  const ElasticPlasticJoint* selected = nullptr;  ///< has a white point on its own
};

/// stage_colour() of stage.h, as Box2D has it.
b2Color stage_color(double stage);

/// How a structure finds its joints' impulses.
enum class SolverKind {
  direct,     ///< all joints of a structure together, exactly
  iterative,  ///< joint by joint in Box2D's iterations, as in the paper: for lone joints, or to compare. Rows
              ///< of a natural frequency above 1/(2π·step) are rigid
};

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // modes and rows have the same names
#endif
/// What a structure reports after a step.
struct JointEvent {
  enum Kind { yield, flow, broke } kind = yield;
  enum Mode { tension, compression, shear, rotation } mode = rotation;
  ElasticPlasticJoint* joint = nullptr;  ///< valid during the call; a broken one is destroyed right after it
  double force = 0;                      ///< N or N m, of the row that gave the event
  double energy = 0;                     ///< J dissipated by the joint so far
  double worked = 0;                     ///< J of plastic work of the joint since its last event
  double released = 0;  ///< J: elastic energy of the joint that its breaking has set free; else 0
  b2Vec2 at{0, 0};      ///< m, world: the joint's anchor when the event is delivered
};
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

struct StructureDef {
  SolverKind solver = SolverKind::direct;
  /// JointEvent::flow comes each time a joint has used up so much more of its limit; of a joint without one,
  /// each time its plastic work has doubled. > 0.
  double flow_share = 0.1;
  bool keep_ledger = false;  ///< energy(): costs a pass over the joints per step; direct solver only
  /// Structures of a world that have the same solver share the memory of the first.
  MemorySource memory{};
};

/// The energy of a structure's joints, J. Each term is integrated on its own, row by row. What they take from
/// the bodies since the start is elastic + dissipated + damping + numerical, of which `driven` came from
/// drives and from bodies of prescribed velocity. Where structures touch, the first reports `damping` and on.
struct JointEnergy {
  double elastic = 0;  ///< stored now: ½ Σ k e²
  double dissipated =
      0;  ///< plastic work since the start, of joints that are gone too; what broke sets free counts in
  double damping = 0;    ///< of the rows' dampers, since the start
  double numerical = 0;  ///< what implicit integration took since the start (negative: gave)
  double driven = 0;     ///< work of driven rows, kinematic bodies and turning ones with fixed rotation
  double contacts = 0;  ///< work of contacts in steps that were solved in parts (StepReport::divided), beyond
                        ///< that of their impulses with the mean of the velocities before and after
  double clamped = 0;   ///< kinetic energy that Box2D's speed limits took from the pieces since the start
};

/// What the steps between two calls of Structure::update() cost, over all islands: counts are sums,
/// `residual` and `slowed` maxima. Structures that touch report their one problem each.
struct StepReport {
  int solves = 0;   ///< solutions of the structure's problem
  int resting = 0;  ///< components for which the step was the last one again
  int skipped = 0;  ///< Box2D iterations before which nothing had touched the structure
  int rounds = 0;   ///< of preconditioned conjugate gradients, over all solves
  int factorisations = 0;
  /// Components whose step was solved in parts, for a blow: between two update() of 120 bodies in all, each
  /// pair that touches counted as 8 more, a block of a wall as up to 5, or of 240, 480 or 960 in parts that
  /// are 2, 4 or 8 times as long.
  int divided = 0;
  int projections = 0;  ///< pushes by contacts that were spread through the structure
  int bounds_hit = 0;   ///< solves and projections that ended at their bound of iterations; 0 in every scene
  int parted = 0;       ///< of these the projections: their gaps became the joints' neutral positions
  double residual = 0;  ///< largest relative residual of a solve
  double slowed = 0;    ///< share of a component's kinetic energy that Box2D's speed limits took, at most
};

/// The joints of one world, solved together. The structure finds which bodies hang together, and does so
/// again when joints break, come or go and when bodies change. Make one per world, before its joints; destroy
/// it before the world or after it. A world may have several: one problem, but a dynamic body joints of one.
///
/// In the world it keeps one disabled static body without user data, the last in the list of bodies, by which
/// it learns that the world is gone. It counts in GetBodyCount(), and no query, ray or contact finds it.
/// Destroying all bodies of the world empties a structure, and it goes on with the next joint; destroying
/// that body alone makes stock welds of the joints that are left.
class Structure {
 public:
  /// Throws std::logic_error while the world is stepping.
  explicit Structure(b2World& world, const StructureDef& def = {});
  ~Structure();
  Structure(Structure&&) noexcept;
  Structure& operator=(Structure&&) noexcept;

  /// The structure that was made for the world, the first of several; nullptr where there is none. Goes
  /// through the world's bodies.
  static Structure* of(b2World& world);
  /// Whether a structure made the body to learn of the end of its world.
  static bool is_watch(const b2Body& body);
  /// nullptr once it is gone, or all its bodies.
  b2World* world() const;

  /// A new joint in the world. Throws std::invalid_argument with all problems() of the def, one a line.
  ElasticPlasticJoint* create_joint(const ElasticPlasticJointDef& def);
  /// Why create_joint() would refuse the def: wrong fields, bodies of another world or of another structure,
  /// a world that is stepping. Empty where it would not. Changes and throws nothing.
  std::vector<std::string> problems(const ElasticPlasticJointDef& def) const;
  /// A node: holds bodies together at a point in world coordinates, each by a joint from the first body to
  /// it, whose axis runs from the point to the body's centre of mass and turns with it. Where one breaks the
  /// others hold; where the first body is destroyed the others are joined to each other
  /// (ElasticPlasticJointDef::node). Turns freely and never yields; with `like`, its rows, maxima and
  /// interaction. Throws as create_joint(), and then has made nothing.
  std::vector<ElasticPlasticJoint*> pin(const b2Vec2& at, const std::vector<b2Body*>& bodies);
  std::vector<ElasticPlasticJoint*> pin(const b2Vec2& at, const std::vector<b2Body*>& bodies,
                                        const ElasticPlasticJointDef& like);
  /// A number that no node of the structure has yet.
  int new_node();
  /// Makes an existing weld, which keeps its address, anchors and user data, one of this structure's. The
  /// def's bodies and anchors are ignored. A joint whose structure is gone is such a weld. Throws
  /// std::invalid_argument where the def is wrong, the weld is a joint of a structure already, or the world
  /// is stepping.
  ElasticPlasticJoint* adopt(b2WeldJoint* weld, const ElasticPlasticJointDef& def);

  /// Call after b2World::Step: delivers events, destroys broken joints and joins nodes anew. Within a handler
  /// it does nothing. Throws std::logic_error while the world is stepping, and what a handler throws: then
  /// the next call delivers the remaining events and destroys broken joints.
  void update();

  /// Called by update() for every event. It may destroy any joint or body.
  void on_event(std::function<void(const JointEvent&)> handler);
  /// Asked inside the step whether a joint whose maximum is exceeded may break; must not change the world.
  void may_break(std::function<bool(const ElasticPlasticJoint&)> veto);

  /// All joints, in the order of creation.
  std::span<ElasticPlasticJoint* const> joints() const;

  const StepReport& report() const;  ///< of the steps since the last update()
  /// What is not as it should be, in plain words and with what to do about it: what went wrong in any step
  /// since the start (speed limit, bounds, residuals, short blows), and what is now beyond what is promised
  /// (stiffness, mass ratios, turns, fixtures too small for Box2D). Empty when all is well.
  std::vector<std::string> warnings() const;
  /// As of the last update(), which is to follow every step. Needs StructureDef::keep_ledger.
  JointEnergy energy() const;
  std::size_t bytes() const;  ///< memory held; of what structures of a world form together its joints' share
  /// Draws all joints. Any time outside b2World::Step.
  void draw(b2Draw& canvas, const JointDrawing& how = {}) const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// A world at one moment with all that is in it, its structures too: for rollback netcode, rewinding and
/// undo. After restore() the world runs on as it did after save(), to the bit, whatever happened in between:
/// what was made since is gone, what went is back at its address (bodies, fixtures, contacts, broken joints).
/// No listener is called, and the game restores what it keeps beside the world itself.
///
/// Costs a copy of the world's memory. Chain shapes and structures must be the same at both moments.
class Snapshot {
 public:
  Snapshot();
  ~Snapshot();
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(Snapshot&&) noexcept;

  /// Forgets what was saved before, but keeps its memory. Changes nothing in the world. Throws
  /// std::logic_error while the world is stepping.
  void save(b2World& world);
  /// As often as you like, to older and newer moments. Throws std::logic_error, and changes nothing, while
  /// the world is stepping, or where it is another world or a chain shape or a structure has come or gone
  /// since.
  void restore(b2World& world) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ductile
