// Fixtures and their shapes in a document (world_archive.h). Written against Box2D 2.4.1.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "box2d_private.h"
#include "vec3.h"
#include "world_archive.h"

namespace ductile::dynamics {

DUCTILE_REVEAL(b2Fixture, m_proxyCount, int32);

}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

namespace {

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

}  // namespace

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
    // The body's mass is stored, since it cannot be computed of a shape that may have no area.
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

}  // namespace ductile
