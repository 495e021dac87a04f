// What b2World solves at a time, and what of it is one problem. All structures of a world that are solved
// alike share one Island, so that what touches is solved together, whichever structure it is of.
#pragma once

#include <box2d/box2d.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "component.h"

namespace ductile::dynamics {

class Island {
  Pool pool_;  // of its components

 public:
  explicit Island(const MemorySource& memory) : pool_(memory) {}

  // The phases of an island in b2World::Step, called by its joints.
  bool enlist(Member* member, Component* component);  // whether it is the first
  void velocity(const b2SolverData& data);
  void position(const b2SolverData& data);

  // From the making of a structure to its end, or that of its world.
  void enter(Structure::Impl& structure);
  void leave(Structure::Impl& structure);
  /// As many joints may be enlisted as the structures have, and about as many contacts be rows; allocates.
  void make_room();
  /// The joint is no more. Its component goes on without it; where it does not outlast that, its joints carry
  /// on with what they were, and the next step finds them in no component and forms anew.
  void remove(Member& member);
  /// Ends all components. Their joints are in none, and carry on with what they were when these were formed.
  void discard();
  Component& form(std::span<Member* const> group, std::span<const BodyPair> touching,
                  std::span<b2Body* const> order = {});

  // After a step (first_touch.cpp, bullets.cpp, flush.cpp).
  void meet_guests(b2World& in);
  /// What was held back from continuous collision: bullets, and contacts of what is flush.
  void let_go(b2World& in) {
    let_bullets_go(in);
    let_contacts_go(in);
  }
  bool holds_any() const { return holds_bullets_ || holds_contacts_; }

  /// Bytes of its components: of what several structures form together, a share as of the joints.
  std::size_t held_by(const Structure::Impl& structure) const;

  /// All that goes from step to step.
  struct State {
    std::uint32_t next_id;
    struct Formed {
      Component component;
      std::vector<std::pair<Structure::Impl*, std::uint32_t>> members;  // by id
    };
    std::vector<Formed> components;
    bool holds_bullets, holds_contacts;
  };
  State state() const;
  /// After that of its structures.
  void restore(const State& state);

  /// Of the next joint: structures count together, so that the order of unknowns and rows is that of making.
  std::uint32_t next_id = 0;
  std::vector<Pool::Owned<Component>> components;

 private:
  b2World& world() const;
  bool direct() const;
  std::size_t joints() const;  // of all structures
  /// The component is no more.
  void hand_back(Component& component);
  void forget_last();
  void separate(Component& component);
  bool is_known() const;
  Component* component_of(const b2Body& body) const;
  bool misses_guests() const;
  bool grow();
  void form();
  // reach.cpp
  void choose_contacts(const b2SolverData& data);
  void choose_stock_joints();
  void find_near(float h);
  void follow(b2Body& body);
  bool is_piece(const b2Body& body) const;
  bool may_take(const b2Body& body) const;
  bool distribute();
  // bullets.cpp
  void hold_bullets();
  void let_bullets_go(b2World& in);
  // flush.cpp
  void hold_apart(float h);
  void let_contacts_go(b2World& in);
  // first_touch.cpp
  void forget_blows(b2World& in);
  void end_stale();
  template <class Visit>
  void each_lone_piece(const Visit& visit) const;

  std::vector<Structure::Impl*> structures_;
  std::vector<Member*> enlisted_;
  std::vector<Component*> active_;                                  // of the enlisted joints
  std::vector<std::pair<const b2Body*, const Component*>> guests_;  // free ones
  int velocity_calls_ = 0;
  IslandContacts contacts_;
  std::vector<StockJoint> stock_;  // that hold its pieces, and what touches these
  std::vector<Struck> struck_;     // in this step
  bool holds_bullets_ = false;     // bodies that are marked: bullets that are none until update()
  bool holds_contacts_ = false;    // contacts that are marked: disabled until update()
};

/// Stops a body of the island whose velocity is no finite number: it would spread to all that hangs
/// together, for good. Whether it was one.
bool stop_if_not_finite(b2Body& body, const b2SolverData& data);

}  // namespace ductile::dynamics
