// First touch: bodies that are fast reach far into a piece, or through it, before there is a contact,
// and the manifold of so deep a touch has a normal of its own. So after each step a guest that met a piece on
// its way is put back to where it did, and the next step finds a contact as it should be. What has not gone
// straight on, as it was struck in a part of the step or hangs on other bodies, goes out of the piece along
// the normal with which they met. Where both are free to move, their centre of mass stays: a way that only
// one has would change angular momentum by its cross product with that one's momentum.
// Written against Box2D 2.4.1.

#include <box2d/b2_time_of_impact.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <unordered_set>
#include <utility>
#include <vector>

#include "box2d_private.h"
#include "bullets.h"
#include "frames.h"
#include "guests.h"
#include "kinematics.h"
#include "nearest.h"

namespace ductile::dynamics {

namespace {

/// A motion in the last step as it looked from the piece where that is now. What sleeps has not moved.
b2Sweep seen_from(b2Body& piece, b2Sweep moving) {
  if (!piece.IsAwake()) return moving;
  const b2Sweep& carrier = of(piece, b2Body_m_sweep{});
  const float turn = carrier.a - carrier.a0;
  moving.c0 = carrier.c + b2Mul(b2Rot(turn), moving.c0 - carrier.c0);
  moving.a0 += turn;
  return moving;
}

/// All of the last step's motion of a body, wherever Box2D has let it begin.
b2Sweep motion_of(const b2Body& body) {
  b2Sweep motion = of(body, b2Body_m_sweep{});
  motion.alpha0 = 0;
  return motion;
}

/// Whether a motion is more than rounding.
bool moves(const b2Sweep& s) {
  return (s.c - s.c0).LengthSquared() >= b2_linearSlop * b2_linearSlop ||
         std::abs(s.a - s.a0) >= b2_angularSlop;
}

/// Where a body first touched a piece.
struct Way {
  float share = 1;      // of its motion until then; 1 where it did not
  b2Vec2 normal{0, 0};  // from the piece
};

/// A body first touches a piece where its skin is one slop deep. b2TimeOfImpact ends three deep, and the
/// correction to one would raise the body; so the time is found by halving.
Way way_to(const b2Contact& contact, b2Body& piece, const b2Body& body, const b2Sweep& moving) {
  const bool body_is_a = contact.GetFixtureA()->GetBody() == &body;
  b2TOIInput input;
  input.proxyA = proxy(*contact.GetFixtureA(), contact.GetChildIndexA());
  input.proxyB = proxy(*contact.GetFixtureB(), contact.GetChildIndexB());
  b2Sweep still = motion_of(piece);
  still.c0 = still.c;
  still.a0 = still.a;
  input.sweepA = body_is_a ? moving : still;
  input.sweepB = body_is_a ? still : moving;
  input.tMax = 1;
  b2TOIOutput output;
  b2TimeOfImpact(&output, &input);
  if (output.state != b2TOIOutput::e_touching) return {};
  const float one_deep = input.proxyA.m_radius + input.proxyB.m_radius - b2_linearSlop;
  float apart = 0, touching = output.t;
  b2Vec2 normal(0, 0);
  for (int halving = 0; halving < 16; ++halving) {
    const float middle = (apart + touching) / 2;
    b2Transform a, b;
    input.sweepA.GetTransform(&a, middle);
    input.sweepB.GetTransform(&b, middle);
    const Nearest found = nearest(input.proxyA, a, input.proxyB, b);
    (found.distance > one_deep ? apart : touching) = middle;
    if (found.distance > 0) normal = found.normal;
  }
  return {touching, body_is_a ? -normal : normal};
}

/// The way by which a body goes out of a piece in a direction, as it is turned, until it only touches it; of
/// no more than so many metres.
b2Vec2 way_out(const b2Contact& contact, b2Body& piece, const b2Body& body, float most,
               const b2Vec2& direction) {
  b2Sweep in = motion_of(body);
  in.c0 = in.c + most * direction;
  in.a0 = in.a;
  return (1 - way_to(contact, piece, body, in).share) * most * direction;
}

/// Half of the thinner of two fixtures, m.
float half_thickness(const b2Contact& contact) {
  const auto half_of = [](const b2Shape& shape) {
    float least = shape.m_radius;
    if (shape.GetType() != b2Shape::e_polygon) return least;
    const auto& polygon = static_cast<const b2PolygonShape&>(shape);
    least = b2_maxFloat;
    for (int32 i = 0; i < polygon.m_count; ++i) {
      const auto [first, last] = extent(polygon, polygon.m_normals[i]);
      least = std::min(least, (last - first) / 2);
    }
    return least;
  };
  return std::min(half_of(*contact.GetFixtureA()->GetShape()), half_of(*contact.GetFixtureB()->GetShape()));
}

/// How deep a body goes into a piece by its motion after the first touch, m.
float depth(const b2Sweep& moving, const Way& way) {
  return -(1 - way.share) * b2Dot(moving.c - moving.c0, way.normal);
}

using Bodies = std::unordered_set<const b2Body*>;

/// Whether a body would overlap nothing there by more than its skin, but pieces, what it so overlaps where it
/// is, and what goes there with it.
bool has_room(const b2World& world, b2Body& body, const b2Transform& there, const Bodies& together = {}) {
  struct Overlap : b2QueryCallback {
    Overlap(const b2Fixture& of, const b2Transform& at, const Bodies& with)
        : fixture(of), there(at), together(with) {}
    bool ReportFixture(b2Fixture* other) override {
      b2Body* const on = other->GetBody();
      if (on == fixture.GetBody() || other->IsSensor() || is_joined(*on) || together.count(on) > 0)
        return true;
      const b2Shape& shape = *fixture.GetShape();
      const auto overlaps = [&](const b2Transform& at) {
        for (int32 i = 0; i < shape.GetChildCount(); ++i) {
          b2AABB around;
          shape.ComputeAABB(&around, at, i);
          for (int32 k = 0; k < other->GetShape()->GetChildCount(); ++k)
            if (b2TestOverlap(around, other->GetAABB(k)) &&
                nearest(proxy(fixture, i), at, proxy(*other, k), on->GetTransform()).distance == 0)
              return true;
        }
        return false;
      };
      return room = !overlaps(there) || overlaps(fixture.GetBody()->GetTransform());
    }
    const b2Fixture& fixture;
    const b2Transform& there;
    const Bodies& together;
    bool room = true;
  };
  for (b2Fixture* f = body.GetFixtureList(); f != nullptr; f = f->GetNext()) {
    if (f->IsSensor()) continue;
    for (int32 i = 0; i < f->GetShape()->GetChildCount(); ++i) {
      b2AABB box;
      f->GetShape()->ComputeAABB(&box, there, i);
      Overlap overlap(*f, there, together);
      world.QueryAABB(&overlap, box);
      if (!overlap.room) return false;
    }
  }
  return true;
}

/// By how much what is at this velocity is to be slowed for so many J/kg that it gains by being moved, or is
/// to be faster for what it loses; where that is more than it has, it goes nowhere in particular.
b2Vec2 price(const b2Vec2& v, float gain) {
  const float speed2 = v.LengthSquared();
  return speed2 > 2 * std::abs(gain) ? (std::sqrt(1 - 2 * gain / speed2) - 1) * v : b2Vec2(0, 0);
}

void pay(b2Body& body, const b2Vec2& way, const b2Vec2& gravity) {
  const b2Vec2 v = body.GetLinearVelocity();
  body.SetLinearVelocity(v + price(v, -body.GetGravityScale() * b2Dot(gravity, way)));
}

void put_back(b2Body& guest, const b2Sweep& moving, float share, const b2Vec2& gravity) {
  b2Transform at;
  moving.GetTransform(&at, share);
  const b2Vec2 from = guest.GetWorldCenter();
  guest.SetTransform(at.p,
                     (1 - share) * moving.a0 + share * moving.a);  // b2Rot::GetAngle() forgets whole turns
  pay(guest, guest.GetWorldCenter() - from, gravity);
}

/// The bodies that hang together by joints.
struct Group {
  std::vector<b2Body*> bodies;
  Bodies known;            // these
  bool is_held = false;    // by something that does not move freely
  b2Vec2 gone_back{0, 0};  // to where one of these first touched

  explicit Group(b2Body& body) : bodies{&body}, known{&body} {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      for (const b2JointEdge* e = bodies[k]->GetJointList(); e != nullptr; e = e->next) {
        is_held |= !is_free(e->other);
        if (is_free(e->other) && known.insert(e->other).second) bodies.push_back(e->other);
      }
    }
  }
  bool has(const b2Body* body) const { return known.count(body) > 0; }
  float mass() const {
    float sum = 0;
    for (const b2Body* b : bodies) sum += b->GetMass();
    return sum;
  }
  /// Whether it touches anything but the other group.
  bool touches_more_than(const Group& other) const {
    for (const b2Body* b : bodies) {
      for (const b2ContactEdge* e = b->GetContactList(); e != nullptr; e = e->next)
        if (e->contact->IsTouching() && !has(e->other) && !other.has(e->other)) return true;
    }
    return false;
  }
  bool has_room(const b2World& world, const b2Vec2& way) const {
    return std::all_of(bodies.begin(), bodies.end(), [&](b2Body* b) {
      b2Transform there = b->GetTransform();
      there.p += way;
      return dynamics::has_room(world, *b, there, known);
    });
  }
  /// It goes elsewhere as it is, its strains with it.
  void move(const b2Vec2& way, const b2Vec2& gravity) const;
  /// It is slowed by so many J.
  void pay(float energy) const;
};

/// The share that one group has of the way by which it and another go apart. What is held, or would be moved
/// into something, does not move; where nothing else is in the way, their centre of mass stays.
float share_of_way(const Group& one, const Group& other) {
  if (other.is_held) return 1;
  if (one.is_held) return 0;
  const bool one_lies = one.touches_more_than(other), other_lies = other.touches_more_than(one);
  if (one_lies != other_lies) return one_lies ? 0.0f : 1.0f;
  const float mine = one.mass(), others = other.mass();
  if (one_lies) return mine <= others ? 1.0f : 0.0f;
  return others / (mine + others);
}

bool is_touching(const b2Body& body) {
  for (const b2ContactEdge* e = body.GetContactList(); e != nullptr; e = e->next)
    if (e->contact->IsTouching()) return true;
  return false;
}

void Group::move(const b2Vec2& way, const b2Vec2& gravity) const {
  float weight = 0;
  for (b2Body* b : bodies) {
    weight += b->GetMass() * b->GetGravityScale();
    b->SetTransform(b->GetPosition() + way, of(*b, b2Body_m_sweep{}).a);
    if (Component* c = Member::component_of(*b)) c->shift(*b, way);
  }
  Component* last = nullptr;
  for (const b2Body* b : bodies) {
    Component* const c = Member::component_of(*b);
    if (c != std::exchange(last, c) && c != nullptr) c->end_shift();
  }
  pay(-weight * b2Dot(gravity, way));
}

void Group::pay(float energy) const {
  b2Vec2 momentum(0, 0);
  for (const b2Body* b : bodies) momentum += b->GetMass() * b->GetLinearVelocity();
  const b2Vec2 slower = price(1 / mass() * momentum, energy / mass());
  for (b2Body* b : bodies) b->SetLinearVelocity(b->GetLinearVelocity() + slower);
}

using Groups = std::vector<std::unique_ptr<Group>>;

// Each of a step is looked for once.
Group& group_of(b2Body& body, Groups& groups) {
  for (const auto& g : groups)
    if (g->has(&body)) return *g;
  return *groups.emplace_back(std::make_unique<Group>(body));
}

// Two groups that overlap where a body met a piece go apart along the normal there. False where neither may.
bool move_apart(const b2World& world, Groups& groups, b2Body& body, b2Body& piece, const b2Contact& contact,
                const b2Sweep& motion, const b2Vec2& normal) {
  const float size = contact.GetFixtureA()->GetAABB(contact.GetChildIndexA()).GetExtents().Length() +
                     contact.GetFixtureB()->GetAABB(contact.GetChildIndexB()).GetExtents().Length();
  const float from = 2 * ((motion.c - motion.c0).Length() + size * std::abs(motion.a - motion.a0));
  const b2Vec2 way = way_out(contact, piece, body, from, normal);
  if (way.LengthSquared() == 0) return true;
  const Group& one = group_of(body, groups);
  if (one.has(&piece)) return false;
  const Group& other = group_of(piece, groups);
  if (one.is_held && other.is_held) return false;
  float share = share_of_way(one, other);
  const auto has_room = [&] {
    return (share == 0 || one.has_room(world, share * way)) &&
           (share == 1 || other.has_room(world, (share - 1) * way));
  };
  if (!has_room()) {
    share = share > 0.5f ? 0.0f : 1.0f;
    if ((share == 1 ? one : other).is_held || !has_room()) return false;
  }
  if (share > 0) one.move(share * way, world.GetGravity());
  if (share < 1) other.move((share - 1) * way, world.GetGravity());
  return true;
}

// A wheel on a spring that rolls on to a piece is stopped there along its axis, and what it carries is not:
// it goes out of the piece along the axis, alone, and all pay for what that strains the spring by. If all
// went back, to where the first of several wheels touched, the others would hang in the air, and come down on
// the road in each step again. False where it does not roll, has no room, or would go beyond the joint's
// limits.
bool raise_wheel(const b2World& world, Groups& groups, b2Body& wheel, b2Body& piece, const b2Contact& contact,
                 const b2Sweep& motion, const b2Vec2& normal) {
  const b2Vec2 gone = motion.c - motion.c0;
  if (!(2 * std::abs(b2Dot(gone, normal)) < std::abs(b2Cross(gone, normal)))) return false;
  const b2JointEdge* edge = wheel.GetJointList();
  if (edge == nullptr || edge->next != nullptr || edge->joint->GetType() != e_wheelJoint) return false;
  auto& joint = static_cast<b2WheelJoint&>(*edge->joint);
  const b2Vec2 axis = joint.GetBodyA()->GetWorldVector(joint.GetLocalAxisA());
  const float along = b2Dot(axis, normal);
  if (!(joint.GetStiffness() > 0) || !(2 * along * along > 1)) return false;
  const b2Vec2 out = along > 0 ? axis : -axis;
  const b2Vec2 way = way_out(contact, piece, wheel, 2 * gone.Length(), out);
  const float moved = joint.GetBodyB() == &wheel ? b2Dot(axis, way) : -b2Dot(axis, way);
  const float was = joint.GetJointTranslation(), now = was + moved;
  if (joint.IsLimitEnabled() && (now < joint.GetLowerLimit() || now > joint.GetUpperLimit())) return false;
  b2Transform there = wheel.GetTransform();
  there.p += way;
  if (!has_room(world, wheel, there)) return false;
  wheel.SetTransform(there.p, motion.a);
  const float rise = -wheel.GetGravityScale() * b2Dot(world.GetGravity(), way);
  group_of(wheel, groups).pay(joint.GetStiffness() * (now * now - was * was) / 2 + wheel.GetMass() * rise);
  return true;
}

// What hangs on a guest goes back with it, as far as it has not for another one: a car with its wheel. Else
// it would strain the joints between them, or their springs, by what was never pushed.
bool put_group_back(const b2World& world, Groups& groups, b2Body& guest, const b2Body& piece,
                    const b2Sweep& moving, float share) {
  Group& group = group_of(guest, groups);
  if (group.is_held || group.bodies.size() == 1 || group.has(&piece)) return false;
  const b2Vec2 whole = (1 - share) * (moving.c0 - moving.c), way = whole - group.gone_back;
  if (!(b2Dot(way, whole) > 0)) return true;
  if (!group.has_room(world, way)) return false;
  group.move(way, world.GetGravity());
  group.gone_back += way;
  return true;
}

// What hangs on something that does not move freely goes back on its own way alone, which its joints let it
// go. Where a piece came to it, what that belongs to goes out. False where neither may.
bool put_held_back(const b2World& world, Groups& groups, b2Body& guest, b2Body& piece,
                   const b2Contact& contact, const b2Sweep& seen, const Way& met) {
  if (!group_of(guest, groups).is_held) return false;
  const b2Sweep own = motion_of(guest);
  const Way way = way_to(contact, piece, guest, own);
  if (!(way.share < 1)) return move_apart(world, groups, guest, piece, contact, seen, met.normal);
  put_back(guest, own, way.share, world.GetGravity());
  return true;
}

// Of two pieces that are both held, the one that has gone farther goes back on its own way, if it went so
// deep that it might come out on the other side. In the next step its structure follows, as far as joints let
// it, like one that the game has moved: a ball on a rope does, and a beam stays where it is.
void put_piece_back(b2World& world, b2Body& one, b2Body& other, const b2Contact& contact) {
  b2Sweep way_of_one = motion_of(one), way_of_other = motion_of(other);
  const bool first =
      (way_of_one.c - way_of_one.c0).LengthSquared() >= (way_of_other.c - way_of_other.c0).LengthSquared();
  b2Body &body = first ? one : other, &piece = first ? other : one;
  const b2Sweep& own = first ? way_of_one : way_of_other;
  const Way way = way_to(contact, piece, body, own);
  if (!(way.share < 1)) return;
  if (depth(own, way) > half_thickness(contact) / 2) put_back(body, own, way.share, world.GetGravity());
}

// A guest went this way back from a piece of what may be free as well: both go on until their centre of mass
// is where it was.
void share_way(const b2World& world, Groups& groups, b2Body& guest, b2Body& piece, const b2Vec2& way) {
  const Component* component = Member::component_of(piece);
  if (component != nullptr && component->is_held()) return;
  const Group &one = group_of(guest, groups), &other = group_of(piece, groups);
  const b2Vec2 on = (share_of_way(one, other) - 1) * way;
  if (on.LengthSquared() == 0 || one.is_held || one.bodies.size() > 1 || !one.has_room(world, on) ||
      !other.has_room(world, on))
    return;
  one.move(on, world.GetGravity());
  other.move(on, world.GetGravity());
}

}  // namespace

// In doubles, as Box2D's floats would strain stiff rows.
void Component::shift(const b2Body& body, const b2Vec2& way) {
  const std::size_t i = z(index_of(&body));
  mirrors[i].left = pose_of(*mirrors[i].body);
  solver.places[i].pose.x += way.x;
  solver.places[i].pose.y += way.y;
  rest_ = Rest::none;
}

void Component::end_shift() {
  for (Joint& j : solver.own_joints()) locate(j, solver.places);
}

// Box2D starts a step from the impulses of the last one. Those of a blow were found together; where a
// structure has broken up, or a guest has left it, Box2D's iterations would have to take them back alone, and
// find no way through a light piece under a heavy guest: it would be thrown as it was stopped.
void Island::forget_blows(b2World& in) {
  struck_.clear();
  for (const auto& c : components)
    if (c->stepped()) struck_.insert(struck_.end(), c->struck().begin(), c->struck().end());
  if (struck_.empty()) return;
  const auto earlier = [](const Struck& s, const Struck& t) { return std::less<>()(s.contact, t.contact); };
  std::sort(struck_.begin(), struck_.end(), earlier);
  for (b2Contact* c = in.GetContactList(); c != nullptr; c = c->GetNext()) {
    const auto found = std::lower_bound(struck_.begin(), struck_.end(), Struck{c}, earlier);
    if (found == struck_.end() || found->contact != c) continue;
    for (std::size_t k = 0; k < found->normal.size(); ++k) {
      b2ManifoldPoint& p = c->GetManifold()->points[k];
      p.normalImpulse = found->normal[k];
      p.tangentImpulse = found->tangent[k];
    }
  }
}

// A component whose bodies have changed, and that no step forms anew, as its joints lead to what is disabled,
// ends: where it is saved and loaded it has ended, too.
void Island::end_stale() {
  const auto is_stale = [](const auto& c) { return !c->stepped() && !c->account.open && !c->fits_bodies(); };
  if (std::none_of(components.begin(), components.end(), is_stale)) return;
  forget_last();
  std::erase_if(components, [&](const auto& c) {
    const bool ends = is_stale(c);
    if (ends) hand_back(*c);
    return ends;
  });
}

// Pieces whose joints are in no component: these lead to what is disabled.
template <class Visit>
void Island::each_lone_piece(const Visit& visit) const {
  std::size_t solved = 0;
  for (const auto& c : components) solved += c->members.size();
  if (solved == joints()) return;
  for (const Structure::Impl* s : structures_) {
    for (const auto& m : s->members) {
      if (m->component != nullptr) continue;
      for (b2Body* body : {m->joint->GetBodyA(), m->joint->GetBodyB()}) {
        // Of several joints, by the one that it finds first.
        if (is_free(body) && Structure::Impl::member_of(*body) == m.get() &&
            Member::component_of(*body) == nullptr)
          visit(*body);
      }
    }
  }
}

void Island::meet_guests(b2World& in) {
  struct Meeting {
    b2Body *body, *piece;
    const b2Contact* contact;
    b2Sweep motion;
    Way way;
    bool straight;  // back along the motion; or out along the normal
  };
  std::vector<Meeting> meetings;
  const std::vector<Alone> all_alone = undo_impacts_alone(components, in);
  forget_blows(in);
  end_stale();
  const auto look = [&](b2Body& piece, const b2Contact& contact, b2Body& body, bool advanced) {
    const bool guest = !is_joined(body);
    const bool alone =
        std::any_of(all_alone.begin(), all_alone.end(), [&body](const Alone& a) { return a.guest == &body; });
    const b2Sweep& s = of(body, b2Body_m_sweep{});
    if ((contact.IsTouching() && !alone) || !body.IsAwake() || (guest && !moves(s))) return;
    if (!guest && piece.IsAwake() && contact.GetFixtureA()->GetBody() == &piece)
      return;  // of two pieces, once
    // Where both went the same way, the piece is now on the body's way, and they never met; where they
    // met, they did so in the motion that the piece saw. What overtook a guest takes it along where there
    // is room.
    const b2Sweep own = motion_of(body);
    const b2Sweep seen = seen_from(piece, own);
    if (!moves(seen)) return;
    if (body.IsBullet()) piece.SetAwake(true);
    const Way way = way_to(contact, piece, body, seen);
    if (!(way.share < 1)) return;
    // What hangs together turns as it swings, and what touched something in parts of a step has not gone
    // straight on.
    const bool touches = is_touching(body), straight = alone || (guest && !(advanced && touches));
    // What touches one piece and meets the next is in the way of both from now on. If it went back or out, it
    // would leave the first, and meet each of them in turn, without coming any farther.
    if (guest && touches && !alone && depth(seen, way) < half_thickness(contact)) return;
    b2Transform there;
    seen.GetTransform(&there, way.share);
    if (!straight || has_room(in, body, there)) {
      meetings.push_back({&body, &piece, &contact, seen, way, straight});
    } else if (const Way own_way = way_to(contact, piece, body, own); own_way.share < 1) {
      meetings.push_back({&body, &piece, &contact, own, own_way, true});
    }
  };
  for (const auto& c : components) {
    each_near(*c, [&](const b2Contact& contact, const Mirror& piece, b2Body& body) {
      look(*piece.body, contact, body, c->advanced());
    });
    c->leave_step();
  }
  each_lone_piece([&](b2Body& piece) {
    each_near(piece, [&](const b2Contact& contact, b2Body& body) { look(piece, contact, body, false); });
  });
  for (const Alone& a : all_alone) {
    // Where its way grazes them by less than rounding, it is where Box2D let them meet.
    const auto meets = [&a](const Meeting& m) { return m.body == a.guest; };
    if (std::none_of(meetings.begin(), meetings.end(), meets))
      put_back(*a.guest, of(*a.guest, b2Body_m_sweep{}), a.share, in.GetGravity());
  }
  Groups groups;
  // The first of what it met.
  for (const Meeting& m : meetings) {
    const auto earlier = [&m](const Meeting& o) {
      return o.straight && o.body == m.body &&
             (o.way.share < m.way.share || (o.way.share == m.way.share && &o < &m));
    };
    if (!m.straight) {
      if (!move_apart(in, groups, *m.body, *m.piece, *m.contact, m.motion, m.way.normal) &&
          is_joined(*m.body))
        put_piece_back(in, *m.body, *m.piece, *m.contact);
    } else if (std::none_of(meetings.begin(), meetings.end(), earlier)) {
      if (raise_wheel(in, groups, *m.body, *m.piece, *m.contact, m.motion, m.way.normal)) continue;
      if (put_held_back(in, groups, *m.body, *m.piece, *m.contact, m.motion, m.way)) continue;
      const b2Vec2 from = m.body->GetWorldCenter();
      if (put_group_back(in, groups, *m.body, *m.piece, m.motion, m.way.share)) continue;
      put_back(*m.body, m.motion, m.way.share, in.GetGravity());
      share_way(in, groups, *m.body, *m.piece, m.body->GetWorldCenter() - from);
    }
  }
}

}  // namespace ductile::dynamics
