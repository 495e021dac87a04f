// Box2D's own joints that hold a structure: which joints of the island they are, what rows they are of the
// structure's problem, and how their impulses are handed back. Written against Box2D 2.4.1.
//
// Solved by Box2D, such a joint would see the mass of the piece that it holds, not of the structure: a motor
// would hold a deck with a fraction of the moment that it takes. So its rows are solved with the structure.
// What Box2D is left with has impulses and infinite masses: its own iterations then change neither, and
// GetReactionForce, GetMotorTorque and the next warm start find the impulse that the structure's problem has.
// Positions are its own to correct where they are far off.
//
// Revolute, prismatic, distance, wheel, weld, mouse and pulley joints are rows. Gear, friction and motor
// joints are not, nor any joint of a world without warm starting: they see the piece.
#pragma once

#include <box2d/box2d.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <typeinfo>

#include "ductile/joint.h"
#include "system.h"

namespace ductile::dynamics {

/// An impulse that Box2D keeps of a joint: the sum of `sense` times the impulses of a link's rows.
struct Channel {
  float* impulse = nullptr;
  unsigned link = 0;
  Rows sense{};
  bool one_sided = false;  // Box2D's is ≥ 0
};

/// The rows of one joint.
struct StockRows {
  std::array<Link, 3> links;
  std::size_t count = 0;  // of links; 0: Box2D solves the joint
  std::array<Channel, 6> channels;
  std::size_t channel_count = 0;
  /// m, of a joint that Box2D lets press on body A at its own anchor, not at B's as its rows do: from there
  /// to B's, along the rows.
  Rows apart{};
  bool near = true;  // its rows close its gaps; otherwise Box2D's iterations of positions do
};

/// A stock joint of the island that is being solved.
struct StockJoint {
  b2Joint* joint = nullptr;
  std::uint32_t member = 0, place = 0;  // beside which of the structure's joints it was found, and when
  int in_a = -1, in_b = -1;             // its bodies in a component
  StockRows rows;
  float position_mass = 0;  // what its iterations of positions read and those of velocities must not

  b2Body* a() const { return joint->GetBodyA(); }
  b2Body* b() const { return joint->GetBodyB(); }
};

/// Whether a structure has the joint. What one left when it went is a weld of Box2D's.
inline bool is_ours(const b2Joint& joint) {
  return typeid(joint) == typeid(ElasticPlasticJoint) &&
         static_cast<const ElasticPlasticJoint&>(joint).id() != UINT32_MAX;
}

/// Calls visit() with the joint as what it is; false where its rows are not known.
template <class Visit>
bool as_it_is(b2Joint& joint, const Visit& visit) {
  switch (joint.GetType()) {
    case e_revoluteJoint:
      return visit(static_cast<b2RevoluteJoint&>(joint)), true;
    case e_prismaticJoint:
      return visit(static_cast<b2PrismaticJoint&>(joint)), true;
    case e_distanceJoint:
      return visit(static_cast<b2DistanceJoint&>(joint)), true;
    case e_wheelJoint:
      return visit(static_cast<b2WheelJoint&>(joint)), true;
    case e_mouseJoint:
      return visit(static_cast<b2MouseJoint&>(joint)), true;
    case e_pulleyJoint:
      return visit(static_cast<b2PulleyJoint&>(joint)), true;
    case e_weldJoint:
      if (is_ours(joint)) return false;
      return visit(static_cast<b2WeldJoint&>(joint)), true;
    default:
      return false;
  }
}

/// Whether a joint is one whose rows are known, and in the island that is being solved.
bool is_stock(b2Joint& joint);

/// Rows of a joint whose bodies are at these places, relative to an origin, in a step of h seconds, or in a
/// part of it; with the impulses that Box2D has given to it by now. They close its gaps, or leave them to
/// Box2D's iterations of positions.
StockRows rows_of(b2Joint& joint, const Place& a, const Place& b, const b2Vec2& origin, double h, double part,
                  bool closes = true);

/// Gives the impulses of the links back, and leaves Box2D's iterations nothing to do but to correct positions
/// where the rows do not.
void hand_back(StockJoint& stock, std::span<const Link> links);

/// Before Box2D's iterations of positions.
void let_positions(const StockJoint& stock);

}  // namespace ductile::dynamics
