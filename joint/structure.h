// What a Structure keeps: its joints, and the components that they form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "component.h"

namespace ductile::dynamics {

/// Marks a body as one of a node: a body that is made later at the same address has no mark.
void mark(b2Body& body);

/// The island that b2World is solving, and what of it is one problem.
struct Island {
  std::vector<Member*> enlisted;
  std::vector<Component*> active;  // of the enlisted joints
  int velocity_calls = 0;
  IslandContacts contacts;
  std::vector<StockJoint> stock;  // that hold its pieces, and what touches these
};

/// Events that wait for update(), and the handlers of the game.
struct Events {
  std::function<void(const JointEvent&)> handler;
  std::function<bool(const ElasticPlasticJoint&)> veto;
  struct Pending {
    std::uint32_t id;  // of the joint
    JointEvent event;
  };
  std::vector<Pending> pending;
  std::size_t told = 0;  // of them
  bool telling = false;  // the handler is at work
};

struct Reports {
  StepReport step;
  StepReport worst;      // since the start: bounds_hit and parted are sums, residual and slowed are maxima
  int stopped = 0;       // velocities since the start that were no finite numbers
  bool stepped = false;  // since the last update()
  std::size_t bodies_in_parts = 0;  // of the components that `step` counts as divided

  void close_step();
};

struct Nodes {
  /// Of what held bodies to nodes and went without breaking since the last update().
  std::vector<ElasticPlasticJointDef> orphans;
  int last = 0;  // of new_node(): negative, so that a game's own are others
};

}  // namespace ductile::dynamics

namespace ductile {

struct Structure::Impl {
  Impl(b2World& w, const StructureDef& d);
  ~Impl();

  /// Makes the weld in a world and takes it.
  ElasticPlasticJoint* join(b2World& in, const ElasticPlasticJointDef& def);
  ElasticPlasticJoint* take(b2WeldJoint* weld, const ElasticPlasticJointDef& joint_def);
  void forget(dynamics::Member& member);
  /// With its world, or with all bodies of it, or alone.
  void watch_is_gone(bool with_world);
  std::vector<std::string> problems(const ElasticPlasticJointDef& def) const;
  /// The structure whose joints a body has, by its first one, as no two structures share a body; null where
  /// there is none.
  static const Impl* structure_of(const b2Body& body);
  /// Whether a structure has joints on the body that is not this one.
  bool is_of_another(const b2Body& body) const;
  /// Joins to each other what hung on bodies of nodes that are no more.
  void join_orphans();

  // The phases of an island in b2World::Step, called by its joints.
  bool enlist(dynamics::Member* member, dynamics::Component* component);  // whether it is the first
  void velocity(const b2SolverData& data);
  void position(const b2SolverData& data);

  /// All that goes from step to step.
  struct State;
  State state() const;
  void restore(const State& state);

  /// The document of save.h, without what Box2D keeps.
  class Save;

  void update();
  void shift_origin(const b2Vec2& new_origin, dynamics::Member& caller);
  std::size_t bytes() const;
  /// Whether update() has delivered all events of the last step and removed what broke.
  bool told_all() const;
  /// All bodies of the world go, unannounced.
  void clear();
  JointEnergy energy() const;
  /// Books plastic work that no joint reports any more, J.
  void count_as_gone(double dissipated) { gone_.dissipated += dissipated; }

  b2World* world;  // nullptr once it is gone, as far as known: that takes a watch
  StructureDef def;
  b2Body* watch;
  Structure* handle = nullptr;
  std::uint32_t next_id = 0;
  std::vector<std::unique_ptr<dynamics::Member>> members;  // by id
  std::vector<ElasticPlasticJoint*> joints;                // as members
  std::vector<std::unique_ptr<dynamics::Component>> components;
  dynamics::Events events;
  dynamics::Reports reports;
  dynamics::Nodes nodes;
  /// Stops a body of the island whose velocity is no finite number: it would spread to all that hangs
  /// together, for good.
  void stop_if_not_finite(b2Body& body, const b2SolverData& data);

  void look_for_breaks(dynamics::Component& component);

 private:
  void form();
  dynamics::Component& form(std::vector<dynamics::Member*> group, std::vector<dynamics::BodyPair> touching);
  // reach.cpp
  void choose_contacts(const b2SolverData& data);
  void choose_stock_joints();
  void follow(b2Body& body);
  bool may_take(const b2Body& body) const;
  bool distribute();
  // first_touch.cpp
  void meet_guests();
  void hold_bullets();
  void let_bullets_go();
  void dissolve(dynamics::Component& component);
  void break_joint(dynamics::Member& member, JointEvent::Mode mode, Row row);
  void say(dynamics::Member& member, JointEvent event);
  void tell();
  decltype(members)::iterator find(std::uint32_t id);

  dynamics::Island island_;
  std::vector<b2Body*> bullets_;  // that are none until update()
  bool broke_ = false;            // some joint, since the last update()
  JointEnergy gone_;              // of components and joints that are no more
};

struct Structure::Impl::State {
  StructureDef def;
  b2Body* watch;
  std::uint32_t next_id;
  std::vector<dynamics::Member> members;
  struct Formed {
    dynamics::Component component;
    std::vector<std::uint32_t> ids;  // of its members
  };
  std::vector<Formed> components;
  std::vector<dynamics::Events::Pending> pending;
  dynamics::Reports reports;
  dynamics::Nodes nodes;
  std::vector<b2Body*> bullets;
  JointEnergy gone;
};

}  // namespace ductile
