// How far the one problem of a step reaches beyond the structure's own joints: contacts of its pieces,
// Box2D's own joints that hold them, and what hangs together with the bodies that these find.

#include <algorithm>
#include <cstddef>
#include <typeinfo>

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {
DUCTILE_REVEAL(b2Joint, m_edgeA, b2JointEdge);
DUCTILE_REVEAL(b2Joint, m_edgeB, b2JointEdge);
}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

namespace {

/// Joints between bodies that are no pieces, at most: what is longer is Box2D's from there on.
constexpr std::size_t far_joints = 64;

bool is_ours(const b2Joint& joint) { return typeid(joint) == typeid(ElasticPlasticJoint); }

/// Calls visit() for the joints that are none of ours and stand in the body's list beside this edge, of one
/// of ours. So a list is gone through once, however many of ours it has.
template <class Visit>
void each_beside(const b2JointEdge& edge, const Visit& visit) {
  const b2JointEdge* e = edge.next;
  for (; e != nullptr && !is_ours(*e->joint); e = e->next) visit(*e->joint);
  for (e = edge.prev; e != nullptr && !is_ours(*e->joint); e = e->prev) {
    if (e->prev != nullptr) continue;
    for (; e != &edge; e = e->next) visit(*e->joint);
    break;
  }
}

}  // namespace

bool Structure::Impl::may_take(const b2Body& body) const {
  return body.GetType() != b2_dynamicBody || (dynamics::is_free(&body) && !is_of_another(body));
}

// Those that are rows of this step's problem. A body that a structure has joints on is a piece.
void Structure::Impl::choose_contacts(const b2SolverData& data) {
  island_.contacts.clear();
  island_.contacts.read(*world, data);
  island_.stock.clear();
  for (const Touch& t : island_.contacts.touches()) {
    for (b2Body* body : {t.a(), t.b()}) stop_if_not_finite(*body, data);
    for (int32 k = 0; k < t.velocity->count; ++k)  // Box2D made it of the velocities: 0 · ∞ is no number
      if (float& bounce = t.velocity->points[k].bounce; !b2IsValid(bounce)) bounce = 0;
  }
  if (def.solver != SolverKind::direct) return island_.contacts.clear();
  island_.contacts.begin(*world);
  const bool ours_alone = world->GetJointCount() == static_cast<int32>(members.size());
  const bool stock_known = !ours_alone && data.step.warmStarting;
  if (stock_known) choose_stock_joints();
  island_.contacts.choose([this](const b2Body* body) { return structure_of(*body) == this; },
                          [this](const b2Body* body) { return may_take(*body); },
                          [&](b2Body& body) {
                            if (stock_known) follow(body);
                          });
  for (const StockJoint& t : island_.stock) {
    for (b2Body* body : {t.a(), t.b()}) {
      if (body->GetType() == b2_dynamicBody) stop_if_not_finite(*body, data);
    }
  }
}

// Of pieces. Contacts change the order of joints in the island; rows must not depend on it.
void Structure::Impl::choose_stock_joints() {
  for (Member* m : island_.enlisted) {
    const auto look = [&](b2Body& piece, const b2JointEdge& edge) {
      if (piece.GetType() != b2_dynamicBody) return;
      each_beside(edge, [&](b2Joint& joint) {
        b2Body &a = *joint.GetBodyA(), &b = *joint.GetBodyB();
        const bool seen_from_a = &piece != &a && a.GetType() == b2_dynamicBody && structure_of(a) == this;
        if (seen_from_a || !is_stock(joint) || !may_take(a) || !may_take(b)) return;
        island_.stock.push_back(
            {.joint = &joint, .member = m->id, .place = static_cast<std::uint32_t>(island_.stock.size())});
      });
    };
    look(*m->joint->GetBodyA(), dynamics::of(*m->joint, b2Joint_m_edgeA{}));
    look(*m->joint->GetBodyB(), dynamics::of(*m->joint, b2Joint_m_edgeB{}));
  }
  std::sort(island_.stock.begin(), island_.stock.end(), [](const StockJoint& s, const StockJoint& t) {
    return s.member != t.member ? s.member < t.member : s.place < t.place;
  });
  for (const StockJoint& t : island_.stock) {
    for (b2Body* body : {t.a(), t.b()})
      if (structure_of(*body) != this) island_.contacts.reach(*body);
  }
}

// Joints of a body that is no piece, to such as it is. Those to pieces are known by now.
void Structure::Impl::follow(b2Body& body) {
  for (b2JointEdge* e = body.GetJointList();
       e != nullptr && island_.stock.size() < members.size() + far_joints; e = e->next) {
    b2Body& other = *e->other;
    if (!is_stock(*e->joint) || !may_take(other) || structure_of(other) == this ||
        island_.contacts.is_followed(other))
      continue;
    island_.stock.push_back({.joint = e->joint});
    island_.contacts.reach(other);
  }
}

bool Structure::Impl::distribute() {
  const auto taken = [this](const auto& all, const auto& take) {
    return std::all_of(all.begin(), all.end(), [&](const auto& t) {
      return std::any_of(island_.active.begin(), island_.active.end(),
                         [&](Component* c) { return take(*c, t); });
    });
  };
  return taken(island_.contacts.touches(), [](Component& c, const Touch& t) { return c.touch(t); }) &&
         taken(island_.stock, [](Component& c, const StockJoint& t) { return c.tie(t); });
}

}  // namespace ductile
