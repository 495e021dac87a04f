// Bullets: Box2D stops them where they meet something in the step, and lets the two meet alone, the piece
// without its structure. So a bullet that is near a piece is none while the world steps. One that came near
// in the step, as it was made or set off within a step's way, has met its piece alone: that impact is undone,
// and the next step finds the two where they met, as fast as they were (first_touch.cpp). Sub-stepping, Box2D
// is at it between two calls of Step, and is left alone. Written against Box2D 2.4.1.
#pragma once

#include <span>
#include <vector>

#include "component.h"

namespace ductile::dynamics {

/// A bullet that met pieces alone.
struct Alone {
  b2Body* guest;
  std::vector<const Mirror*> pieces;
  float share;  // of its motion until Box2D let it meet the last of them
};

/// Undoes the impacts of all bullets that met pieces alone, and says which: they are to be put back to where
/// they met them.
std::vector<Alone> undo_impacts_alone(std::span<const Pool::Owned<Component>> components, const b2World& in);

}  // namespace ductile::dynamics
