// First touch: bodies that are fast reach far into a piece, or through it, before there is a contact,
// and the manifold of so deep a touch has a normal of its own. So after each step a guest that met a piece on
// its way is put back to where it did, and the next step finds a contact as it should be.
//
// Box2D does so for bullets, but then lets the two meet alone, the piece without its structure. So a bullet
// that is near a piece is none while the world steps. One that came near in the step, as it was made or set
// off within a step's way, has met its piece alone: that impact is undone, and the next step finds the two
// where they met, as fast as they were. Sub-stepping, Box2D is at it between two calls of Step, and is left
// alone. Written against Box2D 2.4.1.

#include <box2d/b2_time_of_impact.h>

#include <algorithm>
#include <cmath>

#include "box2d_private.h"
#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

b2Position pose_of(b2Body& body) {
  const b2Sweep& sweep = of(body, b2Body_m_sweep{});
  return {sweep.c, sweep.a};
}

float central_inertia(const b2Body& body) {
  return body.GetInertia() - body.GetMass() * body.GetLocalCenter().LengthSquared();
}

bool is_piece(const b2Body* body) {
  for (const b2JointEdge* e = body->GetJointList(); e != nullptr; e = e->next) {
    if (ElasticPlasticJoint::cast(e->joint) != nullptr) return true;
  }
  return false;
}

/// Calls visit(contact, mirror of the piece, guest) for what may touch the bodies of a component.
template <class Visit>
void each_near(const Component& component, const Visit& visit) {
  for (std::size_t i = 0; i < component.solver.free_bodies(); ++i) {
    const Mirror& m = component.mirrors[i];
    if (m.guest()) continue;
    for (const b2ContactEdge* e = m.body->GetContactList(); e != nullptr; e = e->next) {
      const b2Contact& c = *e->contact;
      if (c.GetFixtureA()->IsSensor() || c.GetFixtureB()->IsSensor()) continue;
      if (is_free(e->other) && !is_piece(e->other)) visit(c, m, *e->other);
    }
  }
}

/// A motion in the last step as it looked from the piece where that is now. What sleeps has not moved.
b2Sweep seen_from(b2Body& piece, b2Sweep moving) {
  if (!piece.IsAwake()) return moving;
  const b2Sweep& carrier = of(piece, b2Body_m_sweep{});
  const float turn = carrier.a - carrier.a0;
  moving.c0 = carrier.c + b2Mul(b2Rot(turn), moving.c0 - carrier.c0);
  moving.a0 += turn;
  return moving;
}

/// m, without skins.
float distance(const b2DistanceProxy& a, const b2Transform& at_a, const b2DistanceProxy& b,
               const b2Transform& at_b) {
  b2DistanceInput input;
  input.proxyA = a;
  input.proxyB = b;
  input.transformA = at_a;
  input.transformB = at_b;
  input.useRadii = false;
  b2SimplexCache cache;
  cache.count = 0;
  b2DistanceOutput found;
  b2Distance(&found, &cache, &input);
  return found.distance;
}

/// The share of this motion until the guest touched the piece; 1 where it did not. Time of impact is found 3
/// slops deep; positions are corrected to 1, which would raise the guest.
float way_to(const b2Contact& contact, b2Body& piece, b2Body& guest, const b2Sweep& moving) {
  const bool a_is_guest = contact.GetFixtureA()->GetBody() == &guest;
  b2TOIInput input;
  input.proxyA.Set(contact.GetFixtureA()->GetShape(), contact.GetChildIndexA());
  input.proxyB.Set(contact.GetFixtureB()->GetShape(), contact.GetChildIndexB());
  b2Sweep still = of(piece, b2Body_m_sweep{});
  still.c0 = still.c;
  still.a0 = still.a;
  still.alpha0 = 0;
  input.sweepA = a_is_guest ? moving : still;
  input.sweepB = a_is_guest ? still : moving;
  input.tMax = 1;
  b2TOIOutput output;
  b2TimeOfImpact(&output, &input);
  if (output.state != b2TOIOutput::e_touching) return 1;
  const float one_deep = input.proxyA.m_radius + input.proxyB.m_radius - b2_linearSlop;
  float apart = 0, touching = output.t;
  for (int halving = 0; halving < 16; ++halving) {
    const float middle = (apart + touching) / 2;
    b2Transform a, b;
    input.sweepA.GetTransform(&a, middle);
    input.sweepB.GetTransform(&b, middle);
    (distance(input.proxyA, a, input.proxyB, b) > one_deep ? apart : touching) = middle;
  }
  return touching;
}

b2DistanceProxy proxy(const b2Fixture& fixture, int32 child) {
  b2DistanceProxy made;
  made.Set(fixture.GetShape(), child);
  return made;
}

/// Whether a body would overlap nothing there by more than its skin, but pieces and what it so overlaps where
/// it is.
bool has_room(const b2World& world, b2Body& body, const b2Transform& there) {
  struct Overlap : b2QueryCallback {
    Overlap(const b2Fixture& of, const b2Transform& at) : fixture(of), there(at) {}
    bool ReportFixture(b2Fixture* other) override {
      b2Body* const on = other->GetBody();
      if (on == fixture.GetBody() || other->IsSensor() || is_piece(on)) return true;
      const b2Shape& shape = *fixture.GetShape();
      const auto overlaps = [&](const b2Transform& at) {
        for (int32 i = 0; i < shape.GetChildCount(); ++i) {
          b2AABB around;
          shape.ComputeAABB(&around, at, i);
          for (int32 k = 0; k < other->GetShape()->GetChildCount(); ++k)
            if (b2TestOverlap(around, other->GetAABB(k)) &&
                distance(proxy(fixture, i), at, proxy(*other, k), on->GetTransform()) == 0)
              return true;
        }
        return false;
      };
      return room = !overlaps(there) || overlaps(fixture.GetBody()->GetTransform());
    }
    const b2Fixture& fixture;
    const b2Transform& there;
    bool room = true;
  };
  for (b2Fixture* f = body.GetFixtureList(); f != nullptr; f = f->GetNext()) {
    if (f->IsSensor()) continue;
    for (int32 i = 0; i < f->GetShape()->GetChildCount(); ++i) {
      b2AABB box;
      f->GetShape()->ComputeAABB(&box, there, i);
      Overlap overlap(*f, there);
      world.QueryAABB(&overlap, box);
      if (!overlap.room) return false;
    }
  }
  return true;
}

// What it is raised by it pays for.
void put_back(b2Body& guest, const b2Sweep& moving, float share, const b2Vec2& gravity) {
  b2Transform at;
  moving.GetTransform(&at, share);
  const b2Vec2 from = guest.GetWorldCenter();
  guest.SetTransform(at.p,
                     (1 - share) * moving.a0 + share * moving.a);  // b2Rot::GetAngle() forgets whole turns
  const b2Vec2 v = guest.GetLinearVelocity();
  const float gain = -guest.GetGravityScale() * b2Dot(gravity, guest.GetWorldCenter() - from);
  const float speed2 = v.LengthSquared();
  if (speed2 > 0 && speed2 > 2 * gain) guest.SetLinearVelocity(std::sqrt(1 - 2 * gain / speed2) * v);
}

/// Whether Box2D let the piece meet a bullet alone in the last step.
bool met_alone(const b2Contact& contact, const Mirror& piece) {
  return of(contact, b2Contact_m_toiCount{}) > 0 && !same(piece.left, pose_of(*piece.body));
}

// The guest's share of an impact: what the piece has of it, the other way. Their sweeps begin where they met.
void undo_impact(const Mirror& piece, b2Body& guest) {
  const b2Vec2 P = piece.body->GetMass() * (piece.body->GetLinearVelocity() - piece.given.v);
  const float moment = central_inertia(*piece.body) * (piece.body->GetAngularVelocity() - piece.given.w) +
                       b2Cross(of(*piece.body, b2Body_m_sweep{}).c0 - of(guest, b2Body_m_sweep{}).c0, P);
  guest.SetLinearVelocity(guest.GetLinearVelocity() + 1 / guest.GetMass() * P);
  if (const float inertia = central_inertia(guest); inertia > 0)
    guest.SetAngularVelocity(guest.GetAngularVelocity() + moment / inertia);
}

void put_back(const Mirror& piece) {
  b2Sweep& sweep = of(*piece.body, b2Body_m_sweep{});
  piece.body->SetTransform(piece.left.c - b2Mul(b2Rot(piece.left.a), sweep.localCenter), piece.left.a);
  sweep.c = sweep.c0 = piece.left.c;
  piece.body->SetLinearVelocity(piece.given.v);
  piece.body->SetAngularVelocity(piece.given.w);
}

}  // namespace

void Island::meet_guests(b2World& in) {
  struct Meeting {
    b2Body* guest;
    float share;
    b2Sweep motion;
  };
  std::vector<Meeting> meetings;
  std::vector<const Mirror*> met;  // pieces that a bullet met alone
  for (const auto& c : components) {
    each_near(*c, [&](const b2Contact& contact, const Mirror& mirror, b2Body& guest) {
      b2Body& piece = *mirror.body;
      if (met_alone(contact, mirror)) {
        meetings.push_back({&guest, 0, of(guest, b2Body_m_sweep{})});
        if (std::find(met.begin(), met.end(), &mirror) != met.end())
          return;  // at another point, or by another
        undo_impact(mirror, guest);
        met.push_back(&mirror);
        return;
      }
      if (contact.IsTouching() || !guest.IsAwake()) return;
      const b2Sweep& s = of(guest, b2Body_m_sweep{});
      if ((s.c - s.c0).LengthSquared() < b2_linearSlop * b2_linearSlop &&
          std::abs(s.a - s.a0) < b2_angularSlop)
        return;
      // Where both went the same way, the piece is now on the guest's way, and they never met; where they
      // met, they did so in the motion that the piece saw. What overtook the guest takes it along where there
      // is room.
      b2Sweep own = s;
      own.alpha0 = 0;
      const b2Sweep seen = seen_from(piece, own);
      if (guest.IsBullet()) piece.SetAwake(true);
      const float share = way_to(contact, piece, guest, seen);
      if (!(share < 1)) return;
      b2Transform there;
      seen.GetTransform(&there, share);
      if (has_room(in, guest, there)) {
        meetings.push_back({&guest, share, seen});
      } else if (const float own_share = way_to(contact, piece, guest, own); own_share < 1) {
        meetings.push_back({&guest, own_share, own});
      }
    });
  }
  for (const Mirror* m : met) put_back(*m);
  // The first of what it met.
  for (const Meeting& m : meetings) {
    const auto earlier = [&m](const Meeting& o) {
      return o.guest == m.guest && (o.share < m.share || (o.share == m.share && &o < &m));
    };
    if (std::none_of(meetings.begin(), meetings.end(), earlier))
      put_back(*m.guest, m.motion, m.share, in.GetGravity());
  }
}

void Island::hold_bullets() {
  if (!direct() || world().GetSubStepping()) return;
  for (const Component* c : active_) {
    each_near(*c, [this](const b2Contact&, const Mirror&, b2Body& guest) {
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
