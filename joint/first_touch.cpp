// First touch: bodies that are fast reach far into a piece, or through it, before there is a contact,
// and the manifold of so deep a touch has a normal of its own. So after each step a guest that met a piece on
// its way is put back to where it did, and the next step finds a contact as it should be.
//
// Box2D does so for bullets, but then lets the two meet alone, the piece without its structure. So a bullet
// that is near a piece is none while the world steps. Sub-stepping, Box2D is at it between two calls of Step,
// and is left alone. Written against Box2D 2.4.1.

#include <box2d/b2_time_of_impact.h>

#include <algorithm>
#include <cmath>

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

bool is_piece(const b2Body* body) {
  for (const b2JointEdge* e = body->GetJointList(); e != nullptr; e = e->next) {
    if (ElasticPlasticJoint::cast(e->joint) != nullptr) return true;
  }
  return false;
}

/// Calls visit(contact, piece, guest) for what may touch the bodies of a component.
template <class Visit>
void each_near(const Component& component, const Visit& visit) {
  for (std::size_t i = 0; i < component.solver.free_bodies(); ++i) {
    const Mirror& m = component.mirrors[i];
    if (m.guest) continue;
    for (const b2ContactEdge* e = m.body->GetContactList(); e != nullptr; e = e->next) {
      const b2Contact& c = *e->contact;
      if (c.GetFixtureA()->IsSensor() || c.GetFixtureB()->IsSensor()) continue;
      if (is_free(e->other) && !is_piece(e->other)) visit(c, *m.body, *e->other);
    }
  }
}

/// The share of the guest's last motion until it touched the piece where that is now; 1 where it did not.
float way_to(const b2Contact& contact, b2Body& piece, b2Body& guest) {
  const bool a_is_guest = contact.GetFixtureA()->GetBody() == &guest;
  b2TOIInput input;
  input.proxyA.Set(contact.GetFixtureA()->GetShape(), contact.GetChildIndexA());
  input.proxyB.Set(contact.GetFixtureB()->GetShape(), contact.GetChildIndexB());
  b2Sweep still = of(piece, b2Body_m_sweep{}), moving = of(guest, b2Body_m_sweep{});
  still.c0 = still.c;
  still.a0 = still.a;
  still.alpha0 = moving.alpha0 = 0;
  input.sweepA = a_is_guest ? moving : still;
  input.sweepB = a_is_guest ? still : moving;
  input.tMax = 1;
  b2TOIOutput output;
  b2TimeOfImpact(&output, &input);
  if (output.state != b2TOIOutput::e_touching) return 1;
  // Time of impact is found 3 slops deep; positions are corrected to 1, which would raise the guest.
  return std::max(0.0f, output.t - 2 * b2_linearSlop / (moving.c - moving.c0).Length());
}

// What it is raised by it pays for.
void put_back(b2Body& guest, float share, const b2Vec2& gravity) {
  b2Sweep sweep = of(guest, b2Body_m_sweep{});
  sweep.alpha0 = 0;
  const b2Vec2 from = sweep.c;
  b2Transform at;
  sweep.GetTransform(&at, share);
  guest.SetTransform(at.p,
                     (1 - share) * sweep.a0 + share * sweep.a);  // b2Rot::GetAngle() forgets whole turns
  const b2Vec2 v = guest.GetLinearVelocity();
  const float gain = -guest.GetGravityScale() * b2Dot(gravity, guest.GetWorldCenter() - from);
  const float speed2 = v.LengthSquared();
  if (speed2 > 2 * gain) guest.SetLinearVelocity(std::sqrt(1 - 2 * gain / speed2) * v);
}

}  // namespace

void Island::meet_guests(b2World& in) {
  struct Meeting {
    b2Body* guest;
    float share;
  };
  std::vector<Meeting> meetings;
  for (const auto& c : components) {
    each_near(*c, [&](const b2Contact& contact, b2Body& piece, b2Body& guest) {
      if (contact.IsTouching() || !guest.IsAwake()) return;
      const b2Sweep& s = of(guest, b2Body_m_sweep{});
      if ((s.c - s.c0).LengthSquared() < b2_linearSlop * b2_linearSlop &&
          std::abs(s.a - s.a0) < b2_angularSlop)
        return;
      if (guest.IsBullet()) piece.SetAwake(true);
      const float share = way_to(contact, piece, guest);
      if (share < 1) meetings.push_back({&guest, share});
    });
  }
  // The first of what it met.
  for (const Meeting& m : meetings) {
    const auto earlier = [&m](const Meeting& o) {
      return o.guest == m.guest && (o.share < m.share || (o.share == m.share && &o < &m));
    };
    if (std::none_of(meetings.begin(), meetings.end(), earlier)) put_back(*m.guest, m.share, in.GetGravity());
  }
}

void Island::hold_bullets() {
  if (!direct() || world().GetSubStepping()) return;
  for (const Component* c : active_) {
    each_near(*c, [this](const b2Contact&, b2Body&, b2Body& guest) {
      if (!guest.IsBullet()) return;
      guest.SetBullet(false);
      bullets_.push_back(&guest);
    });
  }
}

void Island::let_bullets_go(b2World& in) {
  if (bullets_.empty()) return;
  for (b2Body* b = in.GetBodyList(); b != nullptr; b = b->GetNext()) {
    if (std::find(bullets_.begin(), bullets_.end(), b) != bullets_.end()) b->SetBullet(true);
  }
  bullets_.clear();
}

}  // namespace ductile::dynamics
