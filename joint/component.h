// The joints that hang together in one Box2D island, and the bodies that they join.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "box2d_contacts.h"
#include "box2d_joints.h"
#include "ductile/joint.h"
#include "member.h"
#include "mirror.h"
#include "pool.h"
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

/// Whether the velocity of a body is an unknown of the solver; those of all others are prescribed, a dynamic
/// body without mass among them.
inline bool is_free(const b2Body* body) { return body->GetType() == b2_dynamicBody && body->GetMass() > 0; }

/// Two bodies that touch, or that a stock joint holds.
struct BodyPair {
  b2Body *a, *b;
};

struct Component {
  /// What else touches or holds the bodies in this step: as Box2D has it, and as rows.
  struct Outside {
    Vector<Touch> touches;
    Vector<Touch> near;        // points that may touch within the step: rows of its parts alone
    Vector<Contact> contacts;  // rows of the touches' points
    Vector<Touch> corners;     // which push, but in parts of a step
    Vector<int> at_corners;    // guests that something pushes where both are joined to a third body
    Vector<StockJoint> ties;
    Vector<Link> links;  // rows of the ties
  };
  /// How much of what changes the bodies' velocities the solver solves with them.
  enum class Coupling : char {
    none,    // nothing touches or holds them but the joints
    whole,   // all of it
    nearly,  // all but contacts of bodies that share a neighbour; or all, and Box2D iterates over stock
             // joints
    partly   // Box2D solves some of it
  };
  enum class Rest : char {
    none,
    expected,  // the next step will be this one if nothing else touches the bodies
    kept       // this step is the last one again
  };
  /// The steps of a blow are solved in parts.
  struct Parts {
    int count = 1;           // of the step that the solver's laws are for
    double since_blow = 0;   // s, a hard one
    bool goes_on = false;    // the next step has parts, too
    bool advanced = false;   // this step was solved so: poses have moved
    bool withholds = false;  // bodies have `withheld`: see go_on_with_means() and foresee()
    struct OfBody {          // velocities in world axes
      Pose start;
      double gap = unlimited;  // m, to what it struck in this step
      b2Vec2 to_it{0, 0};      // direction of the gap
      Vec3 before;             // at the step's start
      Vec3 restored;           // of that, what was withheld
      Vec3 given;              // by gravity and loads in a part
      Vec3 sum;                // of the means of all parts
      Vec3 mean;               // of the step: by which it comes where it is
      Vec3 late;          // what blows gave it, times the share of the step that was over: no mean has it
      Vec3 withheld;      // what it has at the step's end, beyond what it goes on with in whole steps
      Vec3 push, more;    // momentum of all that hangs together, at its root: by contacts, and not told yet
      bool tied = false;  // by a stock joint, to what is not part of that
      double energy = 0;  // that a blow gives it, J
      bool rebounds = false;  // restitution throws it, or what strikes it, back
    };
    Vector<OfBody> bodies;
    struct OfContact {
      double normal = 0, tangent = 0;            // N s
      double work = 0;                           // on the bodies, J
      double last_normal = 0, last_tangent = 0;  // of the last part; 0 where that is a blow
      double gap = 0;                            // m, since the step's start
      bool beside = false;                       // the point is beyond the end of the face that it touches
      b2Vec2 ra{0, 0}, rb{0, 0};                 // at the step's start
    };
    Vector<OfContact> sums;
    struct OfLink {
      Jacobian J;       // at the step's start
      Rows impulse{};   // N s, N m s
      double work = 0;  // on the bodies, J
    };
    Vector<OfLink> links;

    void keep(Tape& tape) {
      tape(count, since_blow, goes_on, withholds);
      if (count < 1) tape.refuse(), count = 1;
      if (!withholds) return;
      for (OfBody& body : bodies) tape(body.withheld);
    }
  };
  /// What the ledger needs of a step, when one is kept. Velocities are those of the bodies.
  struct Account {
    bool open = false;         // until close_ledger()
    Vector<b2Velocity> began;  // before gravity
    Vector<Vec3> lost;         // what limit_speed() took since: may be far more than what is left
    double lost_in_parts = 0;  // J, by limit_speed_in_part()
  };

  /// Of these joints, and of what touches their bodies. Where the order of elimination is given, it has all
  /// of their bodies.
  Component(std::span<Member* const> enlisted, SolverKind kind, std::span<const BodyPair> touching,
            std::span<b2Body* const> order = {});
  /// Whether it may go on when so many joints leave it, or join it, and so many pairs of bodies touch that it
  /// does not know. It drags along what was left, bodies that it has no more, and an order of elimination for
  /// what held together once. One that is swept has its rows in the order in which they were made.
  bool outlasts(std::size_t leaving, std::size_t joining = 0, std::size_t touching = 0) const {
    return direct() && leaving < members.size() && changed_ + leaving + joining <= most_changes(16) &&
           touched_ + touching <= most_changes(4);
  }
  /// Whether these joints broke off, so that no moving body has some of them and some that stay: a body that
  /// is disabled takes its joints out of the island, and yet they go on with it.
  bool broke_off(std::span<Member* const> leaving) const;
  /// Between steps, or before the first call of one: the joint leaves, and nothing else is formed anew. Its
  /// bodies keep their places, in the order of elimination and in the pattern of H, as guests do.
  void remove(Member& member);
  /// Between steps, or before the first call of one: joints of no component become its own, and pairs of
  /// bodies part of the pattern of H. Bodies that it knows are what they were, free or not.
  void join(std::span<Member* const> joining, std::span<const BodyPair> touching);
  /// Reports to this structure, too.
  void take_in(Structure::Impl& structure);
  /// Whether it has changed since it was formed.
  bool is_worn() const { return changed_ + touched_ > 0; }

  /// Before a step, after touch() and tie(): which bodies are there, and whether these are still what the
  /// component was formed for.
  bool find_present();
  /// After that: where the island has them. Takes their velocities, but where the step may be the last one
  /// again.
  void look(const b2SolverData& data);
  /// Before a step's first touch() and tie().
  void clear_outside();
  /// Calls visit(body) for the guests that touch it or are tied to it in this step, once for each row.
  template <class Visit>
  void each_guest(const Visit& visit) const {
    const auto see = [&](const auto& all) {
      for (const auto& t : all)
        for (const int body : {t.in_a, t.in_b})
          if (mirrors[z(body)].guest()) visit(body);
    };
    see(outside_.touches);
    see(outside_.ties);
  }
  /// The contact is a row of this step; false where the component was not formed for its bodies.
  bool touch(Touch touch);
  /// Likewise, of bodies that share a neighbour: no row, if it is the component's at all.
  void meet_at_corner(Touch touch);
  /// Likewise, of a stock joint.
  bool tie(StockJoint stock);
  /// Takes poses and velocities from Box2D, solves, gives velocities back.
  void first_velocity(const b2SolverData& data);
  void next_velocity(const b2SolverData& data);
  /// Whether nothing else can change its bodies' velocities in this step.
  bool whole() const { return coupling_ == Coupling::none || coupling_ == Coupling::whole; }
  bool rests() const { return rest_ == Rest::kept; }
  /// Whether it was solved in parts since leave_step(), and poses have moved.
  bool advanced() const { return stepped_ && parts_.advanced; }
  /// Whether it was solved since leave_step(): else its mirrors are of an earlier step.
  bool stepped() const { return stepped_; }
  void leave_step() { stepped_ = false; }
  /// Calls visit() for each contact of a piece with what does not move, if the structure is anchored and the
  /// piece moves by less than Box2D's slop in h seconds.
  template <class Visit>
  void each_standing_touch(float h, const Visit& visit) const {
    const auto stands = [&](int i) {
      const Mirror& m = mirrors[z(i)];
      const float speed = m.given.v.Length() + 2 * m.mass.gyration * std::abs(m.given.w);
      return !m.guest() && is_anchored(i) && h * speed < b2_linearSlop;
    };
    const auto is_fixed = [this](int i) { return mirrors[z(i)].type == b2_staticBody; };
    for (const Touch& t : outside_.touches) {
      const bool touches = !t.at_seam && !t.is_near();
      if (touches && ((stands(t.in_a) && is_fixed(t.in_b)) || (stands(t.in_b) && is_fixed(t.in_a))))
        visit(*t.contact);
    }
  }
  /// Contacts whose impulses of this step are those of a blow; some may be no more.
  std::span<const Struck> struck() const { return {struck_contacts_.data(), struck_contacts_.size()}; }
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
  bool is_of(const Structure::Impl& structure) const;
  /// Where a body is in the solver, -1 where it does not know it.
  int index_of(const b2Body* body) const;
  /// Whether a guest is a piece of another component: one that was of this one, and broke off.
  bool is_of_another(int body) const;
  /// Whether joints of its own hold it to something that does not move freely.
  bool is_held() const;
  /// Between steps one of its pieces was moved with all that hangs on it (first_touch.cpp).
  void shift(const b2Body& piece, const b2Vec2& way);
  /// After all of these: J of where they are, as a save finds it anew, with gaps and strains as they were.
  void end_shift();
  /// Whether the last step was solved in parts, and others are to follow.
  bool in_parts() const { return parts_.count > 1 && parts_.goes_on; }
  /// By how much a contact closes at its fastest point, of the velocities at the step's start, m/s.
  static float closes(const Touch& touch);
  /// Whether a body is one of its pieces, and no joints hold it to another of these, `from`.
  bool is_piece_apart(const b2Body& body, const b2Body& from);
  /// Whether these bodies are its own or guests, and something between them may be a row.
  bool knows(int a, int b) const;
  template <class Count>
  void report(const Count& count) const;
  void keep(Tape& tape);
  b2Position box2d_pose(std::size_t body) const { return origin.in_world(solver.places[body].pose); }

  Solver solver;
  Vector<Member*> members;  // as solver.joints
  /// What touched when the component was formed, or was joined since: guests may be no more.
  Vector<BodyPair> met;
  Vector<Mirror> mirrors;  // as solver.bodies
  Origin origin;           // of the solver's poses
  Account account;
  Vector<Structure::Impl*> structures;  // of its members; the first reports its energies
  std::size_t enlisted = 0;             // joints of it that the island has, while these are enlisted

 private:
  bool direct() const { return !solver.swept(); }
  std::size_t most_changes(std::size_t share) const { return std::max<std::size_t>(4, formed_of_ / share); }
  bool alone() const { return coupling_ == Coupling::none; }
  bool as_before(const b2SolverData& data) const;
  bool touched_as_before();
  float slack() const;
  bool is_whole() const;
  void make_room(std::size_t first, std::size_t last);
  void enter(std::size_t i, b2Body& body);
  void remember(std::size_t i, const KnownPose& known);
  void add_pair(const BodyPair& pair, std::size_t free_bodies);
  void admit(std::size_t first, std::size_t free_bodies);
  int freedom(std::size_t body, std::size_t free_bodies) const;
  void take(Mirror& mirror, const b2SolverData& data);
  bool is_blow() const;
  double closing() const;
  static double opening(const Touch& touch, int32 point, double h);
  Vec3 came_at(int body) const;
  bool parts(const Joint& joint) const;
  void set_warm_start_aside(const Touch& touch);
  void set_warm_starts_aside();
  void silence_corners();
  void set_ties_aside(const b2SolverData& data);
  void read_touches();
  void steady(Contact& contact) const;
  void enter_contacts();
  void enter_ties(int parts = 1);
  void return_contacts();
  void remember_blow();
  void return_ties();
  bool is_jammed() const;
  void find_groups(std::span<const StockJoint> ties);
  /// Whether both are free, and of one group.
  bool hang_together(int a, int b) const {
    return solver.is_free(a) && solver.is_free(b) && groups_[z(a)].part_of == groups_[z(b)].part_of;
  }
  bool is_anchored(int body) const {
    return !solver.is_free(body) || groups_[z(groups_[z(body)].part_of)].anchored;
  }
  double share_within_limits(double h) const;
  void limit_speed_in_part();
  void solve(const b2SolverData& data);
  void solve_direct();
  void move();
  // component_parts.cpp
  std::size_t cost_of_parts() const;  // in bodies
  int parts_of(double h) const;
  bool may_divide(const b2SolverData& data) const;
  bool goes_on_in_parts(const b2SolverData& data) const;
  bool is_strained() const;
  Vec3 pushed(std::size_t body) const;
  bool flies(int body) const;
  bool throws() const;
  bool normals_held() const;
  bool snaps_hard();
  void forget_blows() {
    for (Parts::OfBody& body : parts_.bodies) body.energy = 0, body.rebounds = false;
  }
  void strike(int a, int b, double speed);
  bool strains_joints() const;
  bool strikes_hard();
  bool strains_much() const;
  void solve_in_parts(const b2SolverData& data, bool blow);
  void foresee(int count);
  void begin_parts();
  float goes_with_b(const Touch& touch, const PointConstraint& point) const;
  bool is_beside(const Touch& touch, const PointConstraint& point) const;
  void carry_arms();
  void solve_part(double h, int number, bool blow);
  void end_parts(const b2SolverData& data);
  void keep_in_touch(double h);
  double go_on_with_means();
  Vec3 lasting(std::size_t body) const;
  Vec3 told(std::size_t body) const;
  void tell_of_means();
  /// Calls visit(row, touch, point) for each contact that is a row.
  template <class Visit>
  void each_point(const Visit& visit) const {
    std::size_t row = 0;
    for (const Touch& t : outside_.touches) {
      if (t.at_seam) continue;
      for (int32 k = 0; k < t.velocity->count; ++k) visit(row++, t, t.velocity->points[k]);
    }
  }
  void book_parts();
  bool weaken_what_breaks(bool may_weaken);
  void project(bool try_goal);
  void look_for_jam();
  void give(const b2SolverData& data);
  void write_poses(const b2SolverData& data);

  Vector<std::pair<const b2Body*, int>> by_address_;  // bodies, and where they are in the solver
  Outside outside_;
  Vector<Struck> struck_contacts_;
  // Free bodies that joints hold together, each of them a part of one, which knows whether what does not give
  // holds all of them.
  struct Group {
    int part_of = 0;
    bool anchored = false;
  };
  Vector<Group> groups_;                   // of the free bodies; none: they are to be found
  bool ties_in_groups_ = false;            // stock joints, which come and go
  Vector<Pose> goal_;                      // of a projection
  std::size_t formed_of_;                  // so many joints
  std::size_t changed_ = 0, touched_ = 0;  // since then: joints that left or came; pairs of bodies that came
  bool displaced_ = false;                 // bodies were moved apart while their joint was in no island
  double jam_time_ = 0;                    // s in which stock joints still leave their gaps to Box2D
  bool struck_ = false;                    // velocities were changed between the steps
  bool stepped_ = false;                   // since leave_step()
  bool pieces_jam_ = false;                // joints took back what overlapping pieces were pushed by
  bool blow_ = false;                      // something struck in this step
  bool snapped_ = false;                   // in this step a rope goes taut in a jerk
  Parts parts_;
  Coupling coupling_ = Coupling::partly;
  Rest rest_ = Rest::none;
};

inline Component* Member::component_of(const b2Body& body) {
  for (const b2JointEdge* e = body.GetJointList(); e != nullptr; e = e->next) {
    const ElasticPlasticJoint* joint = ElasticPlasticJoint::cast(e->joint);
    if (joint != nullptr && joint->component_ != nullptr) return joint->component_;
  }
  return nullptr;
}
inline Joint& Member::data() { return component != nullptr ? component->solver.joints[index] : own.joint; }
inline JointRecord& Member::record() {
  return component != nullptr ? component->solver.records[index] : own.record;
}

}  // namespace ductile::dynamics
