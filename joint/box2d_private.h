// Private members of Box2D that more than one file reads. Written against Box2D 2.4.1.
#pragma once

#include <box2d/box2d.h>

#include "reveal.h"

namespace ductile::dynamics {

DUCTILE_REVEAL(b2World, m_bodyList, b2Body*);
DUCTILE_REVEAL(b2World, m_inv_dt0, float);
DUCTILE_REVEAL(b2World, m_newContacts, bool);
DUCTILE_REVEAL(b2World, m_destructionListener, b2DestructionListener*);
DUCTILE_REVEAL(b2Body, m_flags, uint16);
inline constexpr uint16 in_island = 0x0001;  // Box2D's own: of one that this step has come to
// Bits of it that are ours. Box2D 2.4.1 uses the seven lowest, leaves the others as they are, and makes
// bodies without them.
inline constexpr uint16 broke_off = 0x1000, held_bullet = 0x2000, in_node = 0x4000;
DUCTILE_REVEAL(b2Body, m_sweep, b2Sweep);
/// Where a body is at the start of the step, also one of an island that was solved before.
inline b2Position start_of_step(const b2Body& body) {
  const b2Sweep& sweep = of(body, b2Body_m_sweep{});
  const bool solved = (of(body, b2Body_m_flags{}) & in_island) != 0;
  return solved ? b2Position{sweep.c0, sweep.a0} : b2Position{sweep.c, sweep.a};
}
// The index of a body in the island that is being solved. b2WeldJoint::InitVelocityConstraints would fetch it
// at the cost of a sine, a cosine and a matrix inverse per joint; so it is a load per body.
DUCTILE_REVEAL(b2Body, m_islandIndex, int32);
DUCTILE_REVEAL(b2Contact, m_flags, uint32);
DUCTILE_REVEAL(b2Contact, m_toiCount, int32);
DUCTILE_REVEAL(b2Joint, m_islandFlag, bool);
DUCTILE_REVEAL(b2Fixture, m_proxies, b2FixtureProxy*);
DUCTILE_REVEAL(b2BroadPhase, m_tree, b2DynamicTree);
DUCTILE_REVEAL(b2BroadPhase, m_moveBuffer, int32*);
DUCTILE_REVEAL(b2BroadPhase, m_moveCount, int32);
DUCTILE_REVEAL(b2DynamicTree, m_root, int32);
DUCTILE_REVEAL(b2DynamicTree, m_nodes, b2TreeNode*);
DUCTILE_REVEAL(b2DynamicTree, m_nodeCount, int32);
DUCTILE_REVEAL(b2DynamicTree, m_nodeCapacity, int32);
DUCTILE_REVEAL(b2DynamicTree, m_freeList, int32);
DUCTILE_REVEAL(b2DynamicTree, m_insertionCount, int32);

}  // namespace ductile::dynamics
