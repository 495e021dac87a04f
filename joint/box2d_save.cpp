#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "reveal.h"
#include "structure.h"
#include "world_archive.h"

namespace ductile::dynamics {

DUCTILE_REVEAL(b2World, m_inv_dt0, float);
DUCTILE_REVEAL(b2World, m_destructionListener, b2DestructionListener*);
DUCTILE_REVEAL(b2World, m_newContacts, bool);
DUCTILE_REVEAL(b2World, m_stepComplete, bool);
DUCTILE_REVEAL(b2Body, m_flags, uint16);
DUCTILE_REVEAL(b2Body, m_xf, b2Transform);
DUCTILE_REVEAL(b2Body, m_sweep, b2Sweep);
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
DUCTILE_REVEAL(b2Fixture, m_proxies, b2FixtureProxy*);
DUCTILE_REVEAL(b2Fixture, m_proxyCount, int32);
DUCTILE_REVEAL(b2Contact, m_flags, uint32);
DUCTILE_REVEAL(b2Contact, m_toiCount, int32);
DUCTILE_REVEAL(b2Contact, m_toi, float);
DUCTILE_REVEAL(b2BroadPhase, m_tree, b2DynamicTree);
DUCTILE_REVEAL(b2BroadPhase, m_moveBuffer, int32*);
DUCTILE_REVEAL(b2BroadPhase, m_moveCount, int32);
DUCTILE_REVEAL(b2DynamicTree, m_root, int32);
DUCTILE_REVEAL(b2DynamicTree, m_nodes, b2TreeNode*);
DUCTILE_REVEAL(b2DynamicTree, m_nodeCount, int32);
DUCTILE_REVEAL(b2DynamicTree, m_nodeCapacity, int32);
DUCTILE_REVEAL(b2DynamicTree, m_freeList, int32);
DUCTILE_REVEAL(b2DynamicTree, m_insertionCount, int32);
// Where what a joint carries from step to step ends, and what each step makes anew begins.
DUCTILE_REVEAL(b2RevoluteJoint, m_indexA, int32);
DUCTILE_REVEAL(b2PrismaticJoint, m_indexA, int32);
DUCTILE_REVEAL(b2DistanceJoint, m_indexA, int32);
DUCTILE_REVEAL(b2PulleyJoint, m_indexA, int32);
DUCTILE_REVEAL(b2MouseJoint, m_indexA, int32);
DUCTILE_REVEAL(b2GearJoint, m_localAnchorA, b2Vec2);
DUCTILE_REVEAL(b2GearJoint, m_indexA, int32);
DUCTILE_REVEAL(b2WheelJoint, m_indexA, int32);
DUCTILE_REVEAL(b2WeldJoint, m_indexA, int32);
DUCTILE_REVEAL(b2FrictionJoint, m_indexA, int32);
DUCTILE_REVEAL(b2MotorJoint, m_indexA, int32);

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

// A game's own user data may have no number.
template <class UserData>
void user_data(Archive& a, UserData& data) {
  if constexpr (requires { data.pointer; }) a("user", data.pointer);
}

void vectors(Archive& a, const char* key, b2Vec2* first, int32& count, int32 least, int32 most) {
  std::vector<float> list;
  for (int32 i = 0; i < count && !a.reads(); ++i) list.insert(list.end(), {first[i].x, first[i].y});
  a(key, list);
  if (!a.reads()) return;
  count = static_cast<int32>(list.size() / 2);
  if (list.size() % 2 != 0 || count < least || count > most)
    a.refuse(key,
             "must be the coordinates of " + std::to_string(least) + " points or more, as Box2D has them");
  for (int32 i = 0; i < count; ++i) first[i] = {list[z(2 * i)], list[z(2 * i + 1)]};
}

void shape(Archive& a, b2CircleShape& s) { a("center", s.m_p.x, s.m_p.y); }
void shape(Archive& a, b2EdgeShape& s) {
  a("points", s.m_vertex0.x, s.m_vertex0.y, s.m_vertex1.x, s.m_vertex1.y, s.m_vertex2.x, s.m_vertex2.y,
    s.m_vertex3.x, s.m_vertex3.y);
  a("one_sided", s.m_oneSided);
}
void shape(Archive& a, b2PolygonShape& s) {
  vectors(a, "points", s.m_vertices, s.m_count, 3, b2_maxPolygonVertices);
  vectors(a, "normals", s.m_normals, s.m_count, s.m_count, s.m_count);
  a("centroid", s.m_centroid.x, s.m_centroid.y);
  for (int32 i = 0; i < s.m_count; ++i) {
    const b2Vec2 side = s.m_vertices[(i + 1) % s.m_count] - s.m_vertices[i], &n = s.m_normals[i];
    const float length = side.Length();
    if (!(length > 0 && b2Distance(n, (1 / length) * b2Vec2(side.y, -side.x)) < 1e-3f))
      a.refuse("normals", "must be the unit normals of the polygon's sides, counter-clockwise");
  }
}
void shape(Archive& a, b2ChainShape& s) {
  std::vector<b2Vec2> points(s.m_vertices, s.m_vertices + s.m_count);
  int32 count = s.m_count;
  if (a.reads()) points.resize(1 << 16);
  vectors(a, "points", points.data(), count, 2, 1 << 16);
  b2Vec2 before = s.m_prevVertex, after = s.m_nextVertex;
  a("ends", before.x, before.y, after.x, after.y);
  if (!a.reads()) return;
  for (int32 i = 1; i < count; ++i) {
    if (!(b2DistanceSquared(points[z(i - 1)], points[z(i)]) > b2_linearSlop * b2_linearSlop))
      a.refuse("points", "of a chain must be apart");
  }
  s.CreateChain(points.data(), count, before, after);
}

template <class Shape>
b2Shape* make_shape(Archive& a, b2Shape* there, Shape& made) {
  Shape& s = there != nullptr ? static_cast<Shape&>(*there) : made;
  shape(a, s);
  a("radius", s.m_radius);
  return &s;
}

// What a joint carries from step to step are words of four bytes, without addresses, behind b2Joint's own.
std::span<std::byte> words_of(b2Joint& joint) {
  auto* begin = reinterpret_cast<std::byte*>(&joint) + sizeof(b2Joint);
  const auto up_to = [&](int32& end) { return std::span(begin, reinterpret_cast<std::byte*>(&end)); };
  switch (joint.GetType()) {
    case e_revoluteJoint:
      return up_to(of(static_cast<b2RevoluteJoint&>(joint), b2RevoluteJoint_m_indexA{}));
    case e_prismaticJoint:
      return up_to(of(static_cast<b2PrismaticJoint&>(joint), b2PrismaticJoint_m_indexA{}));
    case e_distanceJoint:
      return up_to(of(static_cast<b2DistanceJoint&>(joint), b2DistanceJoint_m_indexA{}));
    case e_pulleyJoint:
      return up_to(of(static_cast<b2PulleyJoint&>(joint), b2PulleyJoint_m_indexA{}));
    case e_mouseJoint:
      return up_to(of(static_cast<b2MouseJoint&>(joint), b2MouseJoint_m_indexA{}));
    case e_gearJoint:
      begin =
          reinterpret_cast<std::byte*>(&of(static_cast<b2GearJoint&>(joint), b2GearJoint_m_localAnchorA{}));
      return up_to(of(static_cast<b2GearJoint&>(joint), b2GearJoint_m_indexA{}));
    case e_wheelJoint:
      return up_to(of(static_cast<b2WheelJoint&>(joint), b2WheelJoint_m_indexA{}));
    case e_weldJoint:
      return up_to(of(static_cast<b2WeldJoint&>(joint), b2WeldJoint_m_indexA{}));
    case e_frictionJoint:
      return up_to(of(static_cast<b2FrictionJoint&>(joint), b2FrictionJoint_m_indexA{}));
    case e_motorJoint:
      return up_to(of(static_cast<b2MotorJoint&>(joint), b2MotorJoint_m_indexA{}));
    default:
      return {};
  }
}

constexpr std::array<const char*, 12> joint_types{"unknown", "revolute", "prismatic", "distance",
                                                  "pulley",  "mouse",    "gear",      "wheel",
                                                  "weld",    "friction", "rope",      "motor"};

}  // namespace

WorldArchive::WorldArchive(b2World& world)
    : all_bodies(in_order_of_creation(world.GetBodyList())),
      all_joints(in_order_of_creation(world.GetJointList())),
      world_(world),
      contacts_(in_order_of_creation(world.GetContactList())) {
  std::erase_if(all_bodies, [](const b2Body* body) { return Structure::is_watch(*body); });
}

void WorldArchive::clear(b2World& world) {
  b2DestructionListener* const told = std::exchange(of(world, b2World_m_destructionListener{}), nullptr);
  for (b2Body* body : in_order_of_creation(world.GetBodyList())) {
    if (!Structure::is_watch(*body)) world.DestroyBody(body);
  }
  world.SetDestructionListener(told);
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

void WorldArchive::fixture(Archive& a, b2Body& body, b2Fixture* fixture) {
  b2FixtureDef def;
  b2Shape* there = fixture != nullptr ? fixture->GetShape() : nullptr;
  auto type = static_cast<std::uint8_t>(there != nullptr ? there->GetType() : b2Shape::e_circle);
  b2CircleShape circle;
  b2EdgeShape edge;
  b2PolygonShape polygon;
  b2ChainShape chain;
  a("shape", type);
  switch (type) {
    case b2Shape::e_circle:
      def.shape = make_shape(a, there, circle);
      break;
    case b2Shape::e_edge:
      def.shape = make_shape(a, there, edge);
      break;
    case b2Shape::e_polygon:
      def.shape = make_shape(a, there, polygon);
      break;
    case b2Shape::e_chain:
      def.shape = make_shape(a, there, chain);
      break;
    default:
      a.refuse("shape", "must be 0 (circle), 1 (edge), 2 (polygon) or 3 (chain)");
  }
  if (fixture != nullptr) {
    def.density = fixture->GetDensity(), def.friction = fixture->GetFriction();
    def.restitution = fixture->GetRestitution();
    def.restitutionThreshold = fixture->GetRestitutionThreshold();
    def.isSensor = fixture->IsSensor(), def.filter = fixture->GetFilterData();
  }
  a("density", def.density);
  a("friction", def.friction);
  a("restitution", def.restitution, def.restitutionThreshold);
  a("sensor", def.isSensor);
  a("filter", def.filter.categoryBits, def.filter.maskBits, def.filter.groupIndex);
  if (!(def.density >= 0)) a.refuse("density", "must be >= 0");
  if (fixture == nullptr) {
    // The body's mass is told, and not to be made of what may be no shape with an area.
    const float density = std::exchange(def.density, 0);
    fixture = body.CreateFixture(&def);
    fixture->SetDensity(density);
  }
  user_data(a, fixture->GetUserData());
  b2FixtureProxy* const proxies = of(*fixture, b2Fixture_m_proxies{});
  const auto count = z(of(*fixture, b2Fixture_m_proxyCount{}));
  const std::size_t first = proxies_.size();
  for (std::size_t i = 0; i < count; ++i)
    proxies_.push_back({&proxies[i], proxies[i].aabb, proxies[i].proxyId});
  std::size_t there_are = 0;
  a.list("proxies", count, [&](Archive& each, std::size_t i) {
    if (++there_are > count) each.refuse("id", "is of more proxies than the shape has");
    Proxy& proxy = proxies_[first + i];
    each("box", proxy.box.lowerBound.x, proxy.box.lowerBound.y, proxy.box.upperBound.x,
         proxy.box.upperBound.y);
    each("id", proxy.id);
  });
  if (there_are != count) a.refuse("proxies", "must be " + std::to_string(count));
}

void WorldArchive::proxy(Archive& a, const char* key, b2FixtureProxy*& proxy) {
  const auto found =
      std::find_if(proxies_.begin(), proxies_.end(), [&](const Proxy& p) { return p.at == proxy; });
  auto number = static_cast<std::uint32_t>(found - proxies_.begin());
  a(key, number);
  if (number >= proxies_.size()) a.refuse(key, "is the number of no proxy");
  proxy = proxies_[number].at;
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

void WorldArchive::stock_joint(Archive& a, b2Joint* joint) {
  std::string type = joint != nullptr ? joint_types[z(joint->GetType())] : "";
  b2Body *first = joint != nullptr ? joint->GetBodyA() : nullptr,
         *second = joint != nullptr ? joint->GetBodyB() : nullptr;
  bool collide = joint != nullptr && joint->GetCollideConnected();
  a("type", type);
  body(a, "a", first);
  body(a, "b", second);
  a("collide_connected", collide);
  if (first == second) a.refuse("b", "is a");
  std::array<b2Joint*, 2> geared{};
  if (type == "gear") {
    const auto* gear = static_cast<b2GearJoint*>(joint);
    if (gear != nullptr)
      geared = {const_cast<b2GearJoint*>(gear)->GetJoint1(), const_cast<b2GearJoint*>(gear)->GetJoint2()};
    for (const unsigned i : {0u, 1u}) {
      const char* key = i == 0 ? "joint1" : "joint2";
      auto number = static_cast<std::uint32_t>(std::find(all_joints.begin(), all_joints.end(), geared[i]) -
                                               all_joints.begin());
      a(key, number);
      if (number >= all_joints.size() || (all_joints[number]->GetType() != e_revoluteJoint &&
                                          all_joints[number]->GetType() != e_prismaticJoint))
        a.refuse(key, "must be the number of a revolute or prismatic joint before this one");
      geared[i] = all_joints[number];
    }
  }
  if (joint == nullptr) {
    const auto kind = std::find(joint_types.begin(), joint_types.end(), type) - joint_types.begin();
    const auto made = [&](auto def) {
      def.bodyA = first, def.bodyB = second, def.collideConnected = collide;
      return world_.CreateJoint(&def);
    };
    switch (kind) {
      case e_revoluteJoint:
        joint = made(b2RevoluteJointDef());
        break;
      case e_prismaticJoint:
        joint = made(b2PrismaticJointDef());
        break;
      case e_distanceJoint:
        joint = made(b2DistanceJointDef());
        break;
      case e_pulleyJoint:
        joint = made(b2PulleyJointDef());
        break;
      case e_mouseJoint:
        joint = made(b2MouseJointDef());
        break;
      case e_gearJoint: {
        b2GearJointDef def;
        def.joint1 = geared[0], def.joint2 = geared[1];
        joint = made(def);
        break;
      }
      case e_wheelJoint:
        joint = made(b2WheelJointDef());
        break;
      case e_weldJoint:
        joint = made(b2WeldJointDef());
        break;
      case e_frictionJoint:
        joint = made(b2FrictionJointDef());
        break;
      case e_motorJoint:
        joint = made(b2MotorJointDef());
        break;
      default:
        a.refuse("type", "is no type of joint");
    }
    all_joints.push_back(joint);
  }
  user_data(a, joint->GetUserData());
  const std::span<std::byte> bytes = words_of(*joint);
  std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
  if (!a.reads()) std::memcpy(words.data(), bytes.data(), bytes.size());
  a("words", words);
  if (words.size() * sizeof(std::uint32_t) != bytes.size())
    a.refuse("words", "must be " + std::to_string(bytes.size() / sizeof(std::uint32_t)) + " numbers");
  if (a.reads()) std::memcpy(bytes.data(), words.data(), bytes.size());
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
    if (!at.p.IsValid() || !sweep.c.IsValid() || !sweep.c0.IsValid() || !b2IsValid(sweep.a) || !v.IsValid())
      each.refuse("sweep", "and `transform` and `velocity` must be finite");
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

namespace {

// Whether the nodes are a tree whose leaves are these, and a list of free ones.
bool sound(const std::vector<b2TreeNode>& nodes, int32 root, int32 node_count, int32 free,
           std::size_t leaves) {
  const auto inside = [&](int32 i) { return i >= 0 && z(i) < nodes.size(); };
  std::vector<bool> seen(nodes.size());
  std::size_t seen_count = 0, seen_leaves = 0;
  const auto see = [&](int32 i) {
    if (!inside(i) || seen[z(i)]) return false;
    ++seen_count;
    seen[z(i)] = true;
    return true;
  };
  std::vector<int32> to_visit;
  if (root != b2_nullNode) {
    if (!see(root) || nodes[z(root)].parent != b2_nullNode) return false;
    to_visit.push_back(root);
  }
  while (!to_visit.empty()) {
    const int32 i = to_visit.back();
    to_visit.pop_back();
    const b2TreeNode& node = nodes[z(i)];
    if (node.IsLeaf()) {
      ++seen_leaves;
      if (node.userData == nullptr || node.height != 0) return false;
      continue;
    }
    for (const int32 child : {node.child1, node.child2}) {
      if (!see(child) || nodes[z(child)].parent != i) return false;
      to_visit.push_back(child);
    }
    if (node.userData != nullptr ||
        node.height != 1 + std::max(nodes[z(node.child1)].height, nodes[z(node.child2)].height))
      return false;
  }
  if (seen_count != z(node_count) || seen_leaves != leaves) return false;
  for (int32 i = free; i != b2_nullNode; i = nodes[z(i)].next) {
    if (!see(i) || nodes[z(i)].height != -1) return false;
  }
  return seen_count == nodes.size();
}

}  // namespace

void WorldArchive::broad_phase(Archive& a) {
  b2BroadPhase& phase = const_cast<b2ContactManager&>(world_.GetContactManager()).m_broadPhase;
  b2DynamicTree& tree = of(phase, b2BroadPhase_m_tree{});
  b2TreeNode*& there = of(tree, b2DynamicTree_m_nodes{});
  a.object("broad_phase", [&](Archive& each) {
    std::vector<float> boxes;
    std::vector<std::int32_t> links, moved;
    int32 root = of(tree, b2DynamicTree_m_root{}), free = of(tree, b2DynamicTree_m_freeList{});
    int32 node_count = of(tree, b2DynamicTree_m_nodeCount{});
    for (int32 i = 0; i < of(tree, b2DynamicTree_m_nodeCapacity{}) && !each.reads(); ++i) {
      const b2TreeNode& n = there[i];
      const bool used = n.height >= 0;
      const b2AABB box = used ? n.aabb : b2AABB{{0, 0}, {0, 0}};
      boxes.insert(boxes.end(), {box.lowerBound.x, box.lowerBound.y, box.upperBound.x, box.upperBound.y});
      links.insert(links.end(),
                   {n.parent, used ? n.child1 : -1, used ? n.child2 : -1, n.height, used && n.moved ? 1 : 0});
    }
    if (!each.reads()) {
      const int32* buffer = of(phase, b2BroadPhase_m_moveBuffer{});
      moved.assign(buffer, buffer + of(phase, b2BroadPhase_m_moveCount{}));
    }
    each("root", root);
    each("free", free);
    each("nodes", node_count);
    each("boxes", boxes);
    each("links", links);
    each("moved", moved);
    each("insertions", of(tree, b2DynamicTree_m_insertionCount{}));
    if (!each.reads()) return;
    std::vector<b2TreeNode> nodes(boxes.size() / 4);
    if (boxes.size() != 4 * nodes.size() || links.size() != 5 * nodes.size() || nodes.empty())
      each.refuse("links", "must be five for each four of `boxes`");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      b2TreeNode& n = nodes[i];
      const float* box = &boxes[4 * i];
      const std::int32_t* link = &links[5 * i];
      n.aabb = {{box[0], box[1]}, {box[2], box[3]}};
      n.userData = nullptr;
      n.parent = link[0], n.child1 = link[1], n.child2 = link[2], n.height = link[3], n.moved = link[4] != 0;
    }
    for (const Proxy& p : proxies_) {
      if (p.id < 0 || z(p.id) >= nodes.size() || nodes[z(p.id)].userData != nullptr)
        each.refuse("boxes", "have no place for proxy " + std::to_string(p.id));
      nodes[z(p.id)].userData = p.at;
    }
    if (!sound(nodes, root, node_count, free, proxies_.size()))
      each.refuse("links", "are no tree of these proxies");
    for (const std::int32_t id : moved) {
      if (id != b2BroadPhase::e_nullProxy &&
          (id < 0 || z(id) >= nodes.size() || nodes[z(id)].userData == nullptr))
        each.refuse("moved", "names what is no proxy");
    }
    for (const Proxy& p : proxies_) p.at->aabb = p.box, p.at->proxyId = p.id;
    of(tree, b2DynamicTree_m_root{}) = root;
    of(tree, b2DynamicTree_m_freeList{}) = free;
    of(tree, b2DynamicTree_m_nodeCount{}) = node_count;
    const auto capacity = static_cast<int32>(nodes.size());
    if (std::exchange(of(tree, b2DynamicTree_m_nodeCapacity{}), capacity) != capacity) {
      b2Free(there);
      there = static_cast<b2TreeNode*>(b2Alloc(capacity * static_cast<int32>(sizeof(b2TreeNode))));
    }
    std::copy(nodes.begin(), nodes.end(), there);
    of(phase, b2BroadPhase_m_moveCount{}) = 0;
    for (const std::int32_t id : moved) {
      if (id != b2BroadPhase::e_nullProxy) phase.TouchProxy(id);
    }
  });
}

}  // namespace ductile
