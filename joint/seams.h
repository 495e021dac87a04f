// Seams: where pieces are joined, the side face of one is covered by the other, and what slides over both
// meets a corner that is none of the whole. Box2D, which sees each piece alone, catches or lifts it there. So
// it is between the fixtures of a piece that is not convex.
#pragma once

#include "box2d_contacts.h"

namespace ductile::dynamics {

/// Whether a contact is at a face, or at the corner of a face, that a joined piece covers, or another fixture
/// of the same piece, which carries the same body at a face of its own: such a contact is none of the
/// structure as a whole.
bool is_at_seam(const b2Contact& contact);

/// Whether a joined piece covers the face of `piece` that looks in a direction, near a point of the world.
bool is_covered(const b2Fixture& piece, const b2Vec2& direction, const b2Vec2& point);

}  // namespace ductile::dynamics
