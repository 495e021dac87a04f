// The joints that hang together in one Box2D island, and the bodies that they join.
#pragma once

#include <box2d/box2d.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "box2d_contacts.h"
#include "box2d_joints.h"
#include "ductile/joint.h"
#include "solver.h"

namespace ductile {

/// What is wrong with a def by itself, one message each.
std::vector<std::string> wrong_in(const ElasticPlasticJointDef& def);
std::vector<std::string> wrong_in(const JointState& state);
b2Body* watch_world(b2World& world, Structure::Impl& structure);
/// The structures of a world, in an order that only their coming and going changes.
std::vector<Structure::Impl*> structures_in(b2World& world);

}  // namespace ductile

namespace ductile::dynamics {

struct Component;

/// A body as a component that is no more left it: poses in double survive the re-forming of components.
struct KnownPose {
  Pose pose;  // of the centre of mass, in the world
  b2Vec2 local_center{0, 0};
  int freedom = 0;  // of motion: 2, 3 where it turned, too; 0: held

  void keep(Tape& tape) { tape(pose, local_center.x, local_center.y, freedom); }
};

/// One joint of a structure.
struct Member {
  ElasticPlasticJoint* joint = nullptr;
  Structure::Impl* structure = nullptr;
  std::uint32_t id = 0;
  Component* component = nullptr;  // where it is solved, or nullptr while it is in no island
  std::size_t index = 0;           // in component->solver.joints
  Joint own;                       // configuration and state while it is in no component
  JointRecord own_record;          // likewise
  double drift_time = 0;           // likewise, of its solver
  std::array<KnownPose, 2> known;  // likewise, of the joint's bodies
  bool fresh = true;               // never solved: own.neutral is from where it is first seen
  bool broken = false;
  bool yielded = false;
  double told = 0;         // capacity_used() of the last flow event
  double told_energy = 0;  // J dissipated by the last event
  double max_rotation = unlimited, max_elongation = unlimited, max_compression = unlimited,
         max_slip = unlimited;
  double length = -1;  // of a line without force, before it was first solved
  int break_group = 0;
  int node = 0;
  std::shared_ptr<const YieldSurface> surface;

  void set_state(const JointState& state);
  /// By what a row may flow in the sense of `slip` before the joint breaks, m or rad.
  double left(unsigned row, double slip) const;
  void belong_to(Component* to) { joint->component_ = component = to; }
  Joint& data();
  JointRecord& record();
  const Joint& data() const { return const_cast<Member*>(this)->data(); }
  const JointRecord& record() const { return const_cast<Member*>(this)->record(); }
};

/// Whether its velocity is the solver's to find; all others hold or move as they are told, a dynamic body
/// without mass among them.
inline bool is_free(const b2Body* body) { return body->GetType() == b2_dynamicBody && body->GetMass() > 0; }

/// Two bodies that touch, or that a stock joint holds.
struct BodyPair {
  b2Body *a, *b;
};

struct Component {
  /// What Box2D knows of a body of the solver.
  struct Mirror {
    b2Body* body = nullptr;
    b2Position left{};             // pose as we left it
    b2Velocity given{};            // velocity as we left it
    b2Velocity taken{};            // velocity as Box2D brought it at the step's start
    b2Velocity pushed{{0, 0}, 0};  // what others have added to it since
    Vec3 exact;                    // what `given` is rounded of, world axes
    float mass = 0, inverse_mass = 0, inertia = 0, gyration = 0;
    b2Vec2 local_center{0, 0};
    const b2JointEdge* joints = nullptr;  // first of its joints while all are of this component
    b2BodyType type = b2_staticBody;
    int32 island_index = 0;
    float rounding = 0;   // m/s: what its velocity is brought with for the contacts' stored impulses in it
    bool guest = false;   // touches the structure or is tied to it, but no joint of it
    bool present = true;  // a guest may be elsewhere, or be no more: then `body` must not be asked

    bool has_its_mass() const {
      return type != b2_dynamicBody || (body->GetMass() == mass && body->GetInertia() == inertia &&
                                        body->GetLocalCenter() == local_center);
    }
    bool fits() const { return body->GetType() == type && has_its_mass(); }
    void keep(Tape& tape);
  };
  /// Of a body, when a ledger is kept.
  struct Account {
    b2Velocity began{};  // velocity before gravity
    b2Velocity lost{};   // velocity that limit_speed() took since
  };

  /// Of these joints, and of what touches their bodies.
  Component(std::vector<Member*> enlisted, SolverKind kind, std::vector<BodyPair> touching);

  /// Before a step: where the island has the bodies, and whether they are still what the component was formed
  /// for. Takes their velocities, but where the step may be the last one again.
  bool look(const b2SolverData& data, const IslandContacts& contacts, std::span<const StockJoint> stock);
  /// The contact is a row of this step; false where the component was not formed for its bodies.
  bool touch(Touch touch);
  /// Likewise, of a stock joint.
  bool tie(StockJoint stock);
  /// Takes poses and velocities from Box2D, solves, gives velocities back.
  void first_velocity(const b2SolverData& data);
  void next_velocity(const b2SolverData& data);
  /// Whether nothing else can change its bodies' velocities in this step.
  bool whole() const { return whole_; }
  /// Something about its joints was changed: the next step is not this one.
  void disturb();
  /// After the step, when a ledger is kept: joules that Box2D's speed limits took.
  double close_ledger();
  /// After the last velocity call, before poses move.
  void limit_speed(const b2SolverData& data);
  /// After the last velocity call: poses move, what has flowed is booked.
  void advance(const b2SolverData& data);
  void position(const b2SolverData& data);

  KnownPose known(int body) const;
  /// What the member has to keep when the component is no more.
  void hand_back(Member& member) const;
  /// Whether the bodies of its joints are still what the component was formed for.
  bool fits_bodies() const;
  void keep(Tape& tape);
  Pose relative(const b2Position& at) const;  // to the origin
  b2Position box2d_pose(std::size_t body) const;

  Solver solver;
  std::vector<Member*> members;       // as solver.joints
  std::vector<BodyPair> met;          // what touched when the component was formed: guests may be no more
  std::vector<Mirror> mirrors;        // as solver.bodies
  std::vector<Account> accounts;      // likewise
  std::vector<Touch> touches;         // contacts that are rows of this step
  std::vector<StockJoint> ties;       // likewise
  double origin_x = 0, origin_y = 0;  // m: poses are kept relative to it
  SolverKind kind;
  Structure::Impl* structure = nullptr;
  StepReport* report = nullptr;
  std::uint64_t batch = 0;   // island at hand
  std::size_t enlisted = 0;  // joints of it that this island has
  bool resting = false;      // this step is the last one again
  bool open = false;         // the ledger of the last step is to be closed

 private:
  bool as_before(const b2SolverData& data) const;
  bool touched_as_before();
  float slack() const;
  static bool only_ours(const Mirror& mirror);
  bool is_whole() const;
  void read_mass(std::size_t body);
  int freedom(std::size_t body, std::size_t free_bodies) const;
  int index_of(const b2Body* body) const;
  bool knows(int a, int b) const;
  void take(Mirror& mirror, const b2SolverData& data);
  bool is_blow() const;
  bool parts(const Joint& joint) const;
  /// By what velocities must change at once for a blow, m/s.
  static constexpr float blow_speed = 0.1f;
  void set_warm_starts_aside();
  void set_ties_aside(const b2SolverData& data);
  void read_touches();
  void enter_contacts();
  void enter_ties();
  void return_contacts();
  void return_ties();
  bool is_anchored() const;
  void solve(const b2SolverData& data);
  bool weaken_what_breaks();
  void project(bool try_goal);
  void give(const b2SolverData& data);
  void write_poses(const b2SolverData& data);

  std::vector<Pose> goal;
  std::vector<Contact> rows_;  // of the touches' points
  std::vector<Link> links_;    // of the ties
  std::vector<std::pair<const b2Body*, int>> by_address_;
  bool anchored_ = false;  // some joint holds to what does not give
  bool parted_ = false;    // bodies were moved apart while their joint was in no island
  bool alone_ = false;     // no body has a contact or another joint
  bool whole_ = false;     // what touches or holds one is all solved with it
  bool struck_ = false;    // velocities were changed between the steps
  bool at_rest_ = false;   // the next step will be this one if nothing else touches the bodies
};

inline Joint& Member::data() { return component != nullptr ? component->solver.joints[index] : own; }
inline JointRecord& Member::record() {
  return component != nullptr ? component->solver.records[index] : own_record;
}

}  // namespace ductile::dynamics
