// What a Structure keeps: its joints, and the components that they form.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "island.h"

namespace ductile::dynamics {

/// Marks a body as one of a node: a body that is made later at the same address has no mark.
void mark(b2Body& body);

/// A function of the game, shared with whoever calls it: at work it may set another.
template <class Signature>
using Handler = std::shared_ptr<const std::function<Signature>>;

/// Null for an empty function.
template <class Signature>
Handler<Signature> shared(std::function<Signature> function) {
  return function ? std::make_shared<const std::function<Signature>>(std::move(function)) : nullptr;
}

/// Events that wait for update(), and the handlers of the game.
struct Events {
  Handler<void(const JointEvent&)> handler;
  Handler<bool(const ElasticPlasticJoint&)> veto;
  struct Pending {
    std::uint32_t id;  // of the joint
    JointEvent event;
  };
  std::vector<Pending> pending;
  std::size_t delivered = 0;  // of them
  bool delivering = false;    // the handler is at work
};

struct Reports {
  StepReport step;
  StepReport worst;      // since the start: bounds_hit and parted are sums, residual and slowed are maxima
  int stopped = 0;       // velocities since the start that were no finite numbers
  LeftOut left_out;      // since the start, by blows: flow is a maximum, work a sum
  bool stepped = false;  // since the last update()
  double in_parts = 0;   // cost of the components that `step` counts as divided

  void open_step();
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
  /// The first joint of a structure that a body has; null where there is none.
  static const dynamics::Member* member_of(const b2Body& body);
  /// The structure whose joints a body has, by its first one, as no two structures share a body; null where
  /// there is none.
  static const Impl* structure_of(const b2Body& body);
  /// Whether a structure has joints on the body that is not this one.
  bool is_of_another(const b2Body& body) const;
  /// Joins to each other what hung on bodies of nodes that are no more.
  void join_orphans();

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
  bool delivered_all() const;
  /// All bodies of the world go, unannounced.
  void clear();
  JointEnergy energy() const;
  /// Of joints and components that are no more.
  JointEnergy gone;

  b2World* world;  // nullptr once it is gone, as far as known: that takes a watch
  StructureDef def;
  b2Body* watch;
  Structure* handle = nullptr;
  std::shared_ptr<dynamics::Island> island;
  std::vector<std::unique_ptr<dynamics::Member>> members;  // by id
  std::vector<ElasticPlasticJoint*> joints;                // as members
  dynamics::Events events;
  dynamics::Reports reports;
  dynamics::Nodes nodes;
  /// Of one that flows.
  void look_for_break(dynamics::Member& member);
  dynamics::Member* find(std::uint32_t id) const;
  /// Takes part in its world, from the making on, or anew after all of the world's bodies were destroyed.
  void enter_world();

 private:
  void break_joint(dynamics::Member& member, JointEvent::Mode mode, Row row);
  /// False where it finds no room.
  bool say(dynamics::Member& member, JointEvent event);
  void deliver();
  void destroy_broken();
  /// Where the member of this id is among `members`, or would be.
  std::size_t place_of(std::uint32_t id) const;

  bool broke_ = false;  // some joint, since the last update()
};

struct Structure::Impl::State {
  StructureDef def;
  b2Body* watch;
  std::shared_ptr<dynamics::Island> island;
  std::vector<dynamics::Member> members;
  std::vector<dynamics::Events::Pending> pending;
  dynamics::Reports reports;
  dynamics::Nodes nodes;
  JointEnergy gone;
};

namespace dynamics {

/// Of a component that joints of several structures form, each reports what its steps cost.
template <class Count>
void Component::report(const Count& count) const {
  for (Structure::Impl* s : structures) count(s->reports);
}

/// Adds what a solver has booked.
void add(JointEnergy& sum, const Energies& booked);

/// After a step, of the joints that flow.
void look_for_breaks(Component& component);

}  // namespace dynamics

}  // namespace ductile
