#include "box2d_contacts.h"

#include <algorithm>
#include <cmath>

#include "box2d_private.h"

namespace ductile::dynamics {

using StackEntries = b2StackEntry[b2_maxStackEntries];
DUCTILE_REVEAL(b2World, m_stackAllocator, b2StackAllocator);
DUCTILE_REVEAL(b2StackAllocator, m_entries, StackEntries);
DUCTILE_REVEAL(b2StackAllocator, m_entryCount, int32);

namespace {

constexpr float all = 0x1p80f;  // 1/all is nothing beside any impulse

bool is_settled(const VelocityConstraint& c) { return c.K.ex.x == all; }

// b2Island's arrays, the stack of b2World::Solve, and those of b2ContactSolver.
enum Entry { bodies, contacts, joints, velocities, positions, search, at_positions, at_velocities, entries };

bool is_as_assumed(const Touch& t, int32 index, b2Body* const* island, int32 body_count) {
  const VelocityConstraint& v = *t.velocity;
  const PositionConstraint& p = *t.position;
  const auto is_body = [&](int32 i, const b2Body* body) {
    return i >= 0 && i < body_count && (body->GetType() == b2_staticBody || island[i] == body);
  };
  const b2Manifold& manifold = *t.contact->GetManifold();
  return v.index == index && v.count >= 1 && v.count <= manifold.pointCount && is_body(v.a, t.a()) &&
         is_body(v.b, t.b()) && v.friction == t.contact->GetFriction() &&
         v.restitution == t.contact->GetRestitution() && v.conveyor == t.contact->GetTangentSpeed() &&
         std::abs(v.normal.LengthSquared() - 1) < 1e-3f && p.a == v.a && p.b == v.b &&
         p.inverse_mass_a == v.inverse_mass_a && p.inverse_mass_b == v.inverse_mass_b &&
         p.inverse_inertia_a == v.inverse_inertia_a && p.inverse_inertia_b == v.inverse_inertia_b &&
         p.type == manifold.type && p.count == manifold.pointCount &&
         p.radius_b == t.contact->GetFixtureB()->GetShape()->m_radius;
}

}  // namespace

void IslandContacts::read(b2World& world, const b2SolverData& data) {
  clear();
  b2StackAllocator& stack = of(world, b2World_m_stackAllocator{});
  if (of(stack, b2StackAllocator_m_entryCount{}) != entries) return;
  const StackEntries& entry = of(stack, b2StackAllocator_m_entries{});
  const auto size = [&](Entry e) { return static_cast<std::size_t>(entry[e].size); };
  const std::size_t count = size(at_velocities) / sizeof(VelocityConstraint);
  const std::size_t capacity = size(positions) / sizeof(b2Position);
  constexpr std::size_t pointer = sizeof(void*);  // what the arrays of bodies and of contacts hold
  if (entry[velocities].data != reinterpret_cast<const char*>(data.velocities) ||
      entry[positions].data != reinterpret_cast<const char*>(data.positions) ||
      size(velocities) != capacity * sizeof(b2Velocity) || size(bodies) != capacity * pointer ||
      size(at_velocities) != count * sizeof(VelocityConstraint) ||
      size(at_positions) != count * sizeof(PositionConstraint) || size(contacts) < count * pointer)
    return;
  auto** island = reinterpret_cast<b2Body**>(entry[bodies].data);
  auto** contact = reinterpret_cast<b2Contact**>(entry[contacts].data);
  auto* velocity = reinterpret_cast<VelocityConstraint*>(entry[at_velocities].data);
  auto* position = reinterpret_cast<PositionConstraint*>(entry[at_positions].data);
  for (std::size_t k = 0; k < count; ++k) {
    const Touch touch{.contact = contact[k],
                      .manifold = contact[k]->GetManifold(),
                      .velocity = velocity + k,
                      .position = position + k};
    if (is_settled(*touch.velocity)) continue;
    if (!is_as_assumed(touch, static_cast<int32>(k), island, static_cast<int32>(capacity)))
      return touches_.clear();
    touches_.push_back(touch);
  }
}

std::size_t IslandContacts::place_of(const b2Body& body) {
  return static_cast<std::size_t>(of(body, b2Body_m_islandIndex{}));
}

void IslandContacts::begin(const b2World& world) {
  marks_.assign(static_cast<std::size_t>(world.GetBodyCount()), unknown);
  front_.clear();
}

IslandContacts::Mark& IslandContacts::mark(const b2Body& body) { return marks_[place_of(body)]; }

void IslandContacts::reach(b2Body& body) {
  if (body.GetType() != b2_dynamicBody || mark(body) != unknown) return;
  mark(body) = reached;
  front_.push_back(&body);
}

bool IslandContacts::is_followed(const b2Body& body) const {
  return body.GetType() == b2_dynamicBody && marks_[place_of(body)] == followed;
}

// As b2ClipSegmentToLine tells it.
bool is_end_of_face(const b2Manifold& manifold, const b2ManifoldPoint& point) {
  const b2ContactFeature& f = point.id.cf;
  const bool of_a = manifold.type == b2Manifold::e_faceA;
  return manifold.type != b2Manifold::e_circles && (of_a ? f.typeA : f.typeB) == b2ContactFeature::e_vertex &&
         (of_a ? f.typeB : f.typeA) == b2ContactFeature::e_face;
}

std::pair<float, float> extent(const b2PolygonShape& polygon, const b2Vec2& along) {
  float first = b2_maxFloat, last = -b2_maxFloat;
  for (int32 i = 0; i < polygon.m_count; ++i) {
    const float at = b2Dot(along, polygon.m_vertices[i]);
    first = std::min(first, at - polygon.m_radius);
    last = std::max(last, at + polygon.m_radius);
  }
  return {first, last};
}

bool share_a_neighbour(const b2Body& a, const b2Body& b) {
  if (a.GetType() != b2_dynamicBody || b.GetType() != b2_dynamicBody) return false;
  for (const b2JointEdge* to = a.GetJointList(); to != nullptr; to = to->next) {
    if (to->other->GetType() != b2_dynamicBody) continue;
    for (const b2JointEdge* on = b.GetJointList(); on != nullptr; on = on->next)
      if (on->other == to->other) return true;
  }
  return false;
}

// Of one point Box2D adds mass·(what is missing): nothing. Of two it solves K x = K a − (v − bounce) anew,
// with x = a where K⁻¹ K is 1 and K⁻¹ of all else is nothing. A point that does not press is found to part.
void settle(VelocityConstraint& c) {
  constexpr float nothing = 0x1p-80f, parts = -1e3f;
  c.inverse_mass_a = c.inverse_mass_b = c.inverse_inertia_a = c.inverse_inertia_b = 0;
  c.friction = all;
  c.normal_mass.ex = {nothing, 0};
  c.normal_mass.ey = {0, nothing};
  c.K.ex = {all, 0};
  c.K.ey = {0, all};
  for (PointConstraint& p : c.points) {
    p.normal_mass = c.count == 2 ? nothing : 0;
    p.tangent_mass = 0;
    p.bounce = parts;
  }
}

float separation_of(const b2Contact& contact) {
  b2WorldManifold at;
  contact.GetWorldManifold(&at);
  return contact.GetManifold()->pointCount == 2 ? std::min(at.separations[0], at.separations[1])
                                                : at.separations[0];
}

float closing_speed(const Touch& t, const PointConstraint& p) {
  const auto at = [](const b2Body* body, const b2Vec2& arm) {
    return body->GetLinearVelocity() + b2Cross(body->GetAngularVelocity(), arm);
  };
  return b2Dot(at(t.b(), p.rb) - at(t.a(), p.ra), t.velocity->normal);
}

void silence(const Touch& t) {
  for (int32 k = 0; k < t.velocity->count; ++k)
    t.velocity->points[k].normal_impulse = t.velocity->points[k].tangent_impulse = 0;
  settle(*t.velocity);
  hold_a(*t.position);
  hold_b(*t.position);
  t.position->radius_a -= b2_maxTranslation;
}

}  // namespace ductile::dynamics
