// How far the one problem of a step reaches beyond the structure's own joints: contacts of its pieces,
// Box2D's own joints that hold them, and what hangs together with the bodies that these find.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {
DUCTILE_REVEAL(b2Joint, m_edgeA, b2JointEdge);
DUCTILE_REVEAL(b2Joint, m_edgeB, b2JointEdge);

namespace {

/// Joints between bodies that are no pieces, at most: what is longer is Box2D's from there on.
constexpr std::size_t far_joints = 64;

bool is_fast(const b2Body& body) {
  return body.GetLinearVelocity().LengthSquared() > blow_speed * blow_speed ||
         std::abs(body.GetAngularVelocity()) > blow_turn;
}

bool is_ram(const b2Body& body) { return body.GetType() == b2_kinematicBody && is_fast(body); }

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

bool Island::is_piece(const b2Body& body) const {
  const Structure::Impl* owner = Structure::Impl::structure_of(body);
  return owner != nullptr && owner->island.get() == this;
}

// Not what structures that are solved otherwise have joints on.
bool Island::may_take(const b2Body& body) const {
  if (body.GetType() != b2_dynamicBody) return true;
  if (!is_free(&body)) return false;
  const Structure::Impl* owner = Structure::Impl::structure_of(body);
  return owner == nullptr || owner->island.get() == this;
}

// Those that are rows of this step's problem. A body that a structure has joints on is a piece.
void Island::choose_contacts(const b2SolverData& data) {
  contacts_.read(world(), data);
  stock_.clear();
  int& stopped = enlisted_.front()->structure->reports.stopped;
  for (const Touch& t : contacts_.touches()) {
    for (b2Body* body : {t.a(), t.b()}) stopped += stop_if_not_finite(*body, data) ? 1 : 0;
    for (int32 k = 0; k < t.velocity->count; ++k)  // Box2D made it of the velocities: 0 · ∞ is no number
      if (float& bounce = t.velocity->points[k].bounce; !b2IsValid(bounce)) bounce = 0;
  }
  if (!direct()) return contacts_.clear();
  contacts_.begin(world());
  const bool ours_alone = world().GetJointCount() == static_cast<int32>(joints());
  const bool stock_known = !ours_alone && data.step.warmStarting;
  if (stock_known) choose_stock_joints();
  contacts_.choose([this](const b2Body* body) { return is_piece(*body); },
                   [this](const b2Body* body) { return may_take(*body); },
                   [&](b2Body& body) {
                     if (stock_known) follow(body);
                   });
  find_near(data.step.dt);
  for (const StockJoint& t : stock_) {
    for (b2Body* body : {t.a(), t.b()}) {
      if (body->GetType() == b2_dynamicBody) stopped += stop_if_not_finite(*body, data) ? 1 : 0;
    }
  }
}

// What strikes a piece meets it at more points than the first, or more pieces, before the step is over: a
// block that comes down a little tilted. So do pieces that fall on what stands, or on those of another
// structure; Box2D would stop each of them alone. A rebound is left to the step after it, which knows how
// fast they met.
void Island::find_near(float h) {
  if (world().GetSubStepping()) return;
  const auto may_be_met = [](const b2Contact& c) {
    return c.IsEnabled() && !is_sensor(c) && !(c.GetRestitution() > 0);
  };
  // What will be formed anew is no more, as where a world was saved and loaded; and of what has broken up
  // some is in other islands.
  const auto lasts = [](const Component* c) {
    return c != nullptr && c->enlisted == c->members.size() && c->fits_bodies();
  };
  const auto goes_on = [&](const Component* c) { return c->in_parts() && lasts(c); };
  // Two pieces that no joints hold to each other: of one component, or of two of which some others touch.
  const auto meet = [&](Component& c, const b2Body& piece, const b2Body& other) {
    if (c.is_piece_apart(other, piece)) return true;
    const Component* of_other = is_piece(other) ? component_of(other) : nullptr;
    if (of_other == &c || !lasts(of_other)) return false;
    const std::span<const Touch> all = contacts_.touches();
    return std::any_of(all.begin(), all.end(), [&](const Touch& t) {
      const Component *a = component_of(*t.a()), *b = component_of(*t.b());
      return Component::closes(t) > blow_speed && ((a == &c && b == of_other) || (a == of_other && b == &c));
    });
  };
  const std::size_t touching = contacts_.touches().size();
  for (Component* component : active_) {
    const auto fastest = static_cast<float>(component->solver.fastest());
    float driven = goes_on(component) ? fastest : 0;
    for (std::size_t k = 0; k < touching; ++k) {
      const Touch& t = contacts_.touches()[k];
      const float closes = Component::closes(t);
      if (closes > std::max(driven, blow_speed) &&
          (component_of(*t.a()) == component || component_of(*t.b()) == component))
        driven = closes;
    }
    const auto is_met = [](const Mirror& m) {
      const b2ContactEdge* e = m.body->GetContactList();
      while (e != nullptr && !is_ram(*e->other)) e = e->next;
      return e != nullptr;
    };
    const auto may_meet = [&](const Mirror& m) {
      return !m.guest() && (driven > 0 || is_fast(*m.body) || is_met(m));
    };
    const std::span<const Mirror> free{component->mirrors.data(), component->solver.free_bodies()};
    if (std::none_of(free.begin(), free.end(), may_meet) || !lasts(component)) continue;
    const std::size_t first = contacts_.touches().size();
    for (const Mirror& m : free) {
      if (!may_meet(m)) continue;
      for (b2ContactEdge* e = m.body->GetContactList(); e != nullptr; e = e->next) {
        const bool stands = e->other->GetType() != b2_dynamicBody, comes = is_ram(*e->other);
        if (may_be_met(*e->contact) && (stands || meet(*component, *m.body, *e->other)) &&
            !share_a_neighbour(*m.body, *e->other))
          contacts_.add_near(*e->contact, nullptr, h, comes ? fastest : stands ? driven : 0);
      }
    }
    contacts_.keep_first_ways(first, h);
  }
  const bool any_goes_on = std::any_of(active_.begin(), active_.end(), goes_on);
  for (std::size_t k = 0; k < touching; ++k) {
    const Touch t = contacts_.touches()[k];
    const bool strikes = Component::closes(t) > blow_speed;
    if (!(strikes || any_goes_on)) continue;
    const b2Vec2 way = slide(t, h);
    for (b2Body* guest : {t.a(), t.b()}) {
      if (guest->GetType() != b2_dynamicBody || is_piece(*guest)) continue;
      const Component* of_piece = component_of(guest == t.a() ? *t.b() : *t.a());
      if (!lasts(of_piece) || !(strikes || of_piece->in_parts())) continue;
      for (b2ContactEdge* e = guest->GetContactList(); e != nullptr; e = e->next) {
        b2Contact& c = *e->contact;
        if (may_be_met(c) && is_piece(*e->other) && lasts(component_of(*e->other)) &&
            !share_a_neighbour(*guest, *e->other))
          contacts_.add_near(c, &t, h, 0,
                             (guest == t.b()) == (c.GetFixtureB()->GetBody() == guest) ? way : -way);
      }
    }
  }
}

// Of pieces. Contacts change the order of joints in the island; rows must not depend on it.
void Island::choose_stock_joints() {
  for (Member* m : enlisted_) {
    const auto look = [&](b2Body& piece, const b2JointEdge& edge) {
      if (piece.GetType() != b2_dynamicBody) return;
      each_beside(edge, [&](b2Joint& joint) {
        b2Body &a = *joint.GetBodyA(), &b = *joint.GetBodyB();
        const bool seen_from_a = &piece != &a && a.GetType() == b2_dynamicBody && is_piece(a);
        if (seen_from_a || !is_stock(joint) || !may_take(a) || !may_take(b)) return;
        stock_.push_back(
            {.joint = &joint, .member = m->id, .place = static_cast<std::uint32_t>(stock_.size())});
      });
    };
    look(*m->joint->GetBodyA(), of(*m->joint, b2Joint_m_edgeA{}));
    look(*m->joint->GetBodyB(), of(*m->joint, b2Joint_m_edgeB{}));
  }
  std::sort(stock_.begin(), stock_.end(), [](const StockJoint& s, const StockJoint& t) {
    return s.member != t.member ? s.member < t.member : s.place < t.place;
  });
  for (const StockJoint& t : stock_) {
    for (b2Body* body : {t.a(), t.b()})
      if (!is_piece(*body)) contacts_.reach(*body);
  }
}

// Joints of a body that is no piece, to such as it is. Those to pieces are known by now.
void Island::follow(b2Body& body) {
  for (b2JointEdge* e = body.GetJointList(); e != nullptr && stock_.size() < joints() + far_joints;
       e = e->next) {
    b2Body& other = *e->other;
    const bool is_known = other.GetType() == b2_dynamicBody && is_piece(other);
    if (!is_stock(*e->joint) || !may_take(other) || is_known || contacts_.is_followed(other)) continue;
    stock_.push_back({.joint = e->joint});
    contacts_.reach(other);
  }
}

// Whether each is in one component, and no guest in two: one that went to another island and came back may be
// known to both.
bool Island::distribute() {
  const auto taken = [this](const auto& all, const auto& take) {
    return std::all_of(all.begin(), all.end(), [&](const auto& t) {
      return std::any_of(active_.begin(), active_.end(), [&](Component* c) { return take(*c, t); });
    });
  };
  for (Component* c : active_) c->clear_outside();
  if (!taken(contacts_.touches(), [](Component& c, const Touch& t) { return c.touch(t); }) ||
      !taken(stock_, [](Component& c, const StockJoint& t) { return c.tie(t); }))
    return false;
  for (const Touch& t : contacts_.corners())
    for (Component* c : active_) c->meet_at_corner(t);
  guests_.clear();
  for (Component* c : active_) {
    c->each_guest([&](int body) {
      if (c->solver.is_free(body)) guests_.emplace_back(c->mirrors[z(body)].body, c);
    });
  }
  std::sort(guests_.begin(), guests_.end());
  return std::adjacent_find(guests_.begin(), guests_.end(), [](const auto& g, const auto& h) {
           return g.first == h.first && g.second != h.second;
         }) == guests_.end();
}

}  // namespace ductile::dynamics
