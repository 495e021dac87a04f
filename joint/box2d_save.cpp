// Bodies, contacts and what moves in a document (world_archive.h). Written against Box2D 2.4.1.

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "box2d_private.h"
#include "reveal.h"
#include "structure.h"
#include "world_archive.h"

namespace ductile::dynamics {

DUCTILE_REVEAL(b2World, m_stepComplete, bool);
DUCTILE_REVEAL(b2Body, m_xf, b2Transform);
DUCTILE_REVEAL(b2Body, m_linearVelocity, b2Vec2);
DUCTILE_REVEAL(b2Body, m_angularVelocity, float);
DUCTILE_REVEAL(b2Body, m_force, b2Vec2);
DUCTILE_REVEAL(b2Body, m_torque, float);
DUCTILE_REVEAL(b2Body, m_mass, float);
DUCTILE_REVEAL(b2Body, m_invMass, float);
DUCTILE_REVEAL(b2Body, m_I, float);
DUCTILE_REVEAL(b2Body, m_invI, float);
DUCTILE_REVEAL(b2Body, m_linearDamping, float);
DUCTILE_REVEAL(b2Body, m_angularDamping, float);
DUCTILE_REVEAL(b2Body, m_gravityScale, float);
DUCTILE_REVEAL(b2Body, m_sleepTime, float);
DUCTILE_REVEAL(b2Contact, m_toi, float);
}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

namespace {

template <class T>
std::vector<T*> in_order_of_creation(T* newest) {
  std::vector<T*> all;
  for (T* each = newest; each != nullptr; each = each->GetNext()) all.push_back(each);
  std::reverse(all.begin(), all.end());
  return all;
}

}  // namespace

WorldArchive::WorldArchive(b2World& world)
    : all_bodies(in_order_of_creation(world.GetBodyList())),
      all_joints(in_order_of_creation(world.GetJointList())),
      world_(world),
      contacts_(in_order_of_creation(world.GetContactList())) {
  std::erase_if(all_bodies, [](const b2Body* body) { return Structure::is_watch(*body); });
}

void WorldArchive::clear(b2World& world) {
  b2DestructionListener* const listener = std::exchange(of(world, b2World_m_destructionListener{}), nullptr);
  for (b2Body* body : in_order_of_creation(world.GetBodyList())) {
    if (!Structure::is_watch(*body)) world.DestroyBody(body);
  }
  world.SetDestructionListener(listener);
}

void WorldArchive::body(Archive& a, const char* key, b2Body*& body) {
  const auto found = std::find(all_bodies.begin(), all_bodies.end(), body);
  auto number = static_cast<std::uint32_t>(found - all_bodies.begin());
  a(key, number);
  if (number >= all_bodies.size()) a.refuse(key, "is the number of no body");
  body = all_bodies[number];
}

void WorldArchive::settings(Archive& a) {
  a.object("world", [&](Archive& w) {
    b2Vec2 gravity = world_.GetGravity();
    bool sleep = world_.GetAllowSleeping(), warm = world_.GetWarmStarting(),
         clear = world_.GetAutoClearForces();
    bool continuous = world_.GetContinuousPhysics(), sub = world_.GetSubStepping();
    w("gravity", gravity.x, gravity.y);
    w("allow_sleeping", sleep);
    w("warm_starting", warm);
    w("auto_clear_forces", clear);
    w("continuous_physics", continuous);
    w("sub_stepping", sub);
    w("inverse_step", of(world_, b2World_m_inv_dt0{}));
    if (!w.reads()) return;
    world_.SetGravity(gravity);
    world_.SetAllowSleeping(sleep);
    world_.SetWarmStarting(warm);
    world_.SetAutoClearForces(clear);
    world_.SetContinuousPhysics(continuous);
    world_.SetSubStepping(sub);
  });
}

void WorldArchive::bodies(Archive& a) {
  a.list("bodies", all_bodies.size(), [&](Archive& each, std::size_t i) {
    b2Body* body = each.reads() ? nullptr : all_bodies[i];
    b2BodyDef def;
    if (body != nullptr) def.type = body->GetType(), def.enabled = body->IsEnabled();
    auto type = static_cast<std::uint8_t>(def.type);
    each("type", type);
    each("enabled", def.enabled);
    if (type > b2_dynamicBody) each.refuse("type", "must be 0 (static), 1 (kinematic) or 2 (dynamic)");
    def.type = static_cast<b2BodyType>(type);
    if (body == nullptr) all_bodies.push_back(body = world_.CreateBody(&def));
    user_data(each, body->GetUserData());
    const auto fixtures = in_order_of_creation(body->GetFixtureList());
    each.list("fixtures", fixtures.size(),
              [&](Archive& f, std::size_t k) { fixture(f, *body, f.reads() ? nullptr : fixtures[k]); });
  });
}

void WorldArchive::contacts(Archive& a) {
  b2ContactManager& manager = const_cast<b2ContactManager&>(world_.GetContactManager());
  b2ContactFilter* const filter = std::exchange(manager.m_contactFilter, nullptr);  // that has had its say
  const auto restore = std::unique_ptr<b2ContactManager, std::function<void(b2ContactManager*)>>(
      &manager, [filter](b2ContactManager* m) { m->m_contactFilter = filter; });
  a.list("contacts", contacts_.size(), [&](Archive& each, std::size_t i) {
    b2FixtureProxy *first = nullptr, *second = nullptr;
    if (!each.reads()) {
      b2Contact* c = contacts_[i];
      first = &of(*c->GetFixtureA(), b2Fixture_m_proxies{})[c->GetChildIndexA()];
      second = &of(*c->GetFixtureB(), b2Fixture_m_proxies{})[c->GetChildIndexB()];
    }
    proxy(each, "a", first);
    proxy(each, "b", second);
    if (!each.reads()) return;
    const int32 before = world_.GetContactCount();
    manager.AddPair(first, second);
    if (world_.GetContactCount() == before) each.refuse("b", "does not collide with a, or does so already");
    contacts_.push_back(world_.GetContactList());
  });
}

void WorldArchive::motion(Archive& a) {
  a.list("bodies", all_bodies.size(), [&](Archive& each, std::size_t i) {
    b2Body& b = *all_bodies[i];
    b2Transform& at = of(b, b2Body_m_xf{});
    b2Sweep& sweep = of(b, b2Body_m_sweep{});
    b2Vec2 &v = of(b, b2Body_m_linearVelocity{}), &force = of(b, b2Body_m_force{});
    each("transform", at.p.x, at.p.y, at.q.s, at.q.c);
    each("sweep", sweep.localCenter.x, sweep.localCenter.y, sweep.c0.x, sweep.c0.y, sweep.c.x, sweep.c.y,
         sweep.a0, sweep.a, sweep.alpha0);
    each("velocity", v.x, v.y, of(b, b2Body_m_angularVelocity{}));
    each("force", force.x, force.y, of(b, b2Body_m_torque{}));
    each("mass", of(b, b2Body_m_mass{}), of(b, b2Body_m_invMass{}), of(b, b2Body_m_I{}),
         of(b, b2Body_m_invI{}));
    each("damping", of(b, b2Body_m_linearDamping{}), of(b, b2Body_m_angularDamping{}));
    each("gravity_scale", of(b, b2Body_m_gravityScale{}));
    each("sleep_time", of(b, b2Body_m_sleepTime{}));
    const bool enabled = b.IsEnabled();
    each("flags", of(b, b2Body_m_flags{}));
    if (b.IsEnabled() != enabled) each.refuse("flags", "say another thing than `enabled`");
    if (!at.p.IsValid() || !sweep.localCenter.IsValid() || !sweep.c.IsValid() || !sweep.c0.IsValid() ||
        !b2IsValid(sweep.a0) || !b2IsValid(sweep.a))
      each.refuse("sweep", "and `transform` must be finite");
    if (!v.IsValid() || !b2IsValid(b.GetAngularVelocity())) each.refuse("velocity", "must be finite");
    if (!(std::abs(at.q.s * at.q.s + at.q.c * at.q.c - 1) < 1e-3f))
      each.refuse("transform", "must end with the sine and cosine of an angle");
    if (!(sweep.alpha0 >= 0 && sweep.alpha0 <= 1)) each.refuse("sweep", "must end with a share of the step");
    for (const float mass :
         {of(b, b2Body_m_mass{}), of(b, b2Body_m_invMass{}), of(b, b2Body_m_I{}), of(b, b2Body_m_invI{})})
      if (!(mass >= 0)) each.refuse("mass", "must be >= 0, as the moment of inertia and what is 1 over both");
  });
  a.list("contacts", contacts_.size(), [&](Archive& each, std::size_t i) { contact(each, *contacts_[i]); });
  broad_phase(a);
  a.object("world", [&](Archive& w) {
    w("new_contacts", of(world_, b2World_m_newContacts{}));
    w("step_complete", of(world_, b2World_m_stepComplete{}));
  });
}

void WorldArchive::contact(Archive& a, b2Contact& c) {
  constexpr uint32 knows_impact = 0x20;  // e_toiFlag; without it the time is that of no step
  a("flags", of(c, b2Contact_m_flags{}));
  float time = (of(c, b2Contact_m_flags{}) & knows_impact) != 0 ? of(c, b2Contact_m_toi{}) : 1;
  a("impacts", of(c, b2Contact_m_toiCount{}));
  a("impact", time);
  of(c, b2Contact_m_toi{}) = time;
  float friction = c.GetFriction(), restitution = c.GetRestitution(), threshold = c.GetRestitutionThreshold(),
        speed = c.GetTangentSpeed();
  a("material", friction, restitution, threshold, speed);
  c.SetFriction(friction), c.SetRestitution(restitution), c.SetRestitutionThreshold(threshold),
      c.SetTangentSpeed(speed);
  b2Manifold& m = *c.GetManifold();
  std::size_t points = 0;
  a.list("points", z(m.pointCount), [&](Archive& each, std::size_t i) {
    if (++points > b2_maxManifoldPoints) each.refuse("at", "is of more points than two bodies touch in");
    b2ManifoldPoint& p = m.points[i];
    each("at", p.localPoint.x, p.localPoint.y);
    each("impulse", p.normalImpulse, p.tangentImpulse);
    each("id", p.id.key);
  });
  m.pointCount = static_cast<int32>(points);
  if (points == 0) return;  // and Box2D leaves the rest unset
  // Where a new manifold is read, Box2D has not yet set its type: any bits, no enumerator.
  std::underlying_type_t<b2Manifold::Type> bits{};
  static_assert(sizeof bits == sizeof m.type);
  std::memcpy(&bits, &m.type, sizeof bits);
  auto type = static_cast<std::uint8_t>(bits);
  a("manifold", type);
  if (type > b2Manifold::e_faceB) a.refuse("manifold", "must be 0, 1 or 2");
  m.type = static_cast<b2Manifold::Type>(type);
  a("normal", m.localNormal.x, m.localNormal.y, m.localPoint.x, m.localPoint.y);
}

}  // namespace ductile
