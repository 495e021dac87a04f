// What may touch the pieces of a structure and is none of them.
#pragma once

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {

inline bool is_joined(const b2Body& body) { return Structure::Impl::structure_of(body) != nullptr; }

inline b2Position pose_of(b2Body& body) {
  const b2Sweep& sweep = of(body, b2Body_m_sweep{});
  return {sweep.c, sweep.a};
}

/// Calls visit(contact, other body) for what may touch a piece.
template <class Visit>
void each_near(const b2Body& piece, const Visit& visit) {
  for (const b2ContactEdge* e = piece.GetContactList(); e != nullptr; e = e->next) {
    const b2Contact& c = *e->contact;
    if (!is_sensor(c) && is_free(e->other)) visit(c, *e->other);
  }
}

/// Calls visit(contact, mirror of the piece, other body) for what may touch the bodies of a component.
template <class Visit>
void each_near(const Component& component, const Visit& visit) {
  for (std::size_t i = 0; i < component.solver.free_bodies(); ++i) {
    const Mirror& m = component.mirrors[i];
    if (m.guest()) continue;
    each_near(*m.body, [&](const b2Contact& c, b2Body& other) { visit(c, m, other); });
  }
}

}  // namespace ductile::dynamics
