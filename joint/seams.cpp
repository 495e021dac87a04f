#include "seams.h"

#include <algorithm>

#include "ductile/joint.h"

namespace ductile::dynamics {

namespace {

constexpr float skin = 4 * b2_linearSlop;  // by which pieces may be apart, or one higher than the next

/// Whether `neighbour` covers a face of the polygon where it is nearest to a point, which is in the polygon's
/// frame: beside the face, a little towards its middle, there is more of it.
bool covers(const b2Fixture& neighbour, const b2Fixture& piece, int32 face, const b2Vec2& point) {
  const auto& shape = static_cast<const b2PolygonShape&>(*piece.GetShape());
  const b2Vec2 from = shape.m_vertices[face], along = shape.m_vertices[(face + 1) % shape.m_count] - from;
  const float edge = std::min(0.5f, skin / along.Length());
  const float at = b2Clamp(b2Dot(point - from, along) / along.LengthSquared(), edge, 1 - edge);
  return neighbour.TestPoint(
      b2Mul(piece.GetBody()->GetTransform(), from + at * along + skin * shape.m_normals[face]));
}

/// The face of a polygon that looks the most in a direction of the world.
int32 face_toward(const b2Fixture& piece, const b2Vec2& direction) {
  const auto& shape = static_cast<const b2PolygonShape&>(*piece.GetShape());
  const b2Vec2 out = b2MulT(piece.GetBody()->GetTransform().q, direction);
  const auto* normal =
      std::max_element(shape.m_normals, shape.m_normals + shape.m_count,
                       [&out](const b2Vec2& m, const b2Vec2& n) { return b2Dot(m, out) < b2Dot(n, out); });
  return static_cast<int32>(normal - shape.m_normals);
}

/// Whether the contact is at a face of `piece`, one of its fixtures, that `neighbour` covers there, or at a
/// corner of such a face.
bool meets_cover(const b2Contact& contact, const b2Fixture& piece, const b2Fixture& neighbour) {
  if (piece.GetType() != b2Shape::e_polygon) return false;
  const auto& shape = static_cast<const b2PolygonShape&>(*piece.GetShape());
  const b2Manifold& manifold = *contact.GetManifold();
  const bool is_a = contact.GetFixtureA() == &piece;
  const b2Fixture& other = is_a ? *contact.GetFixtureB() : *contact.GetFixtureA();
  const auto* end = shape.m_vertices + shape.m_count;
  const auto* corner = std::find(shape.m_vertices, end, manifold.localPoint);
  if (other.GetType() == b2Shape::e_circle && corner != end) {  // where that meets it
    const auto at = static_cast<int32>(corner - shape.m_vertices);
    return covers(neighbour, piece, at, *corner) ||
           covers(neighbour, piece, (at + shape.m_count - 1) % shape.m_count, *corner);
  }
  b2WorldManifold world;
  contact.GetWorldManifold(&world);
  const b2Transform& frame = piece.GetBody()->GetTransform();
  const int32 face = face_toward(piece, is_a ? world.normal : -world.normal);
  return std::all_of(world.points, world.points + manifold.pointCount, [&](const b2Vec2& point) {
    return covers(neighbour, piece, face, b2MulT(frame, point));
  });
}

/// Whether a fixture of `beside`, a joined piece or that of `piece` itself, covers it there and carries
/// `other`.
bool is_carried_by(const b2Body& beside, const b2Contact& contact, const b2Fixture& piece,
                   const b2Body& other) {
  // What stands still may have very many contacts.
  const bool from_beside = beside.GetType() == b2_dynamicBody;
  const b2Body &from = from_beside ? beside : other, &to = from_beside ? other : beside;
  for (const b2ContactEdge* e = from.GetContactList(); e != nullptr; e = e->next) {
    const b2Contact& c = *e->contact;
    if (e->other != &to || !c.IsTouching() || !c.IsEnabled() || is_sensor(c)) continue;
    const b2Fixture& neighbour = c.GetFixtureA()->GetBody() == &beside ? *c.GetFixtureA() : *c.GetFixtureB();
    if (&neighbour != &piece && meets_cover(contact, piece, neighbour) && !meets_cover(c, neighbour, piece))
      return true;
  }
  return false;
}

bool is_carried_beside(const b2Contact& contact, const b2Fixture& piece, const b2Body& other) {
  if (piece.GetType() != b2Shape::e_polygon) return false;
  const b2Body& body = *piece.GetBody();
  bool is_joined = false;
  for (const b2JointEdge* j = body.GetJointList(); j != nullptr; j = j->next) {
    if (ElasticPlasticJoint::cast(j->joint) == nullptr) continue;
    if (is_carried_by(*j->other, contact, piece, other)) return true;
    is_joined = true;
  }
  const bool has_more = body.GetFixtureList()->GetNext() != nullptr;
  return is_joined && has_more && is_carried_by(body, contact, piece, other);
}

}  // namespace

bool is_covered(const b2Fixture& piece, const b2Vec2& direction, const b2Vec2& point) {
  if (piece.GetType() != b2Shape::e_polygon) return false;
  const b2Body& body = *piece.GetBody();
  const int32 face = face_toward(piece, direction);
  const b2Vec2 at = b2MulT(body.GetTransform(), point);
  for (const b2JointEdge* j = body.GetJointList(); j != nullptr; j = j->next) {
    if (ElasticPlasticJoint::cast(j->joint) == nullptr) continue;
    for (const b2Fixture* f = j->other->GetFixtureList(); f != nullptr; f = f->GetNext())
      if (covers(*f, piece, face, at)) return true;
  }
  return false;
}

bool is_at_seam(const b2Contact& contact) {
  const b2Fixture &a = *contact.GetFixtureA(), &b = *contact.GetFixtureB();
  return is_carried_beside(contact, a, *b.GetBody()) || is_carried_beside(contact, b, *a.GetBody());
}

}  // namespace ductile::dynamics
