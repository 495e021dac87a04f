// Points of contact that a blow's bodies have not reached yet. Box2D's manifolds end 2 cm from a face; within
// a step of 1/60 s what strikes at 3 m/s goes 5 cm. They are those of shapes with a wider skin, as wide as
// the bodies may come nearer, and close by their gap and Box2D's slop, so that its next manifold has them.
// Its listener is asked by PreSolve before, and told by PostSolve after, though the contact begins in the
// next step.
//
// A tilted polygon would be met by its own face, which is nearer to the next piece than that piece's; so the
// two are looked at from as far away as they may come nearer, along the normal of the touch that there is.
//
// What slides along pieces would be caught by the next one's corner, as manifolds keep their normals in a
// step: its points are those of where it slides to, on faces that go on as the one that it touches does.
#include <algorithm>
#include <cmath>

#include "blow.h"
#include "box2d_contacts.h"
#include "box2d_private.h"
#include "frames.h"
#include "seams.h"

namespace ductile::dynamics {

namespace {

constexpr float same_way = 0.99f;  // cosine of two normals
constexpr float goes_on = 0.95f;   // likewise: of faces that what slides may pass between, as beams bend

float size(const b2Fixture& fixture, int32 child) { return fixture.GetAABB(child).GetPerimeter() / 4; }

// The way by which two bodies' points may come nearer in h seconds.
float way_of(const b2Contact& c, float h) {
  const b2Body &a = *c.GetFixtureA()->GetBody(), &b = *c.GetFixtureB()->GetBody();
  const float turn = std::abs(a.GetAngularVelocity()) * size(*c.GetFixtureA(), c.GetChildIndexA()) +
                     std::abs(b.GetAngularVelocity()) * size(*c.GetFixtureB(), c.GetChildIndexB());
  return std::min(h * ((b.GetLinearVelocity() - a.GetLinearVelocity()).Length() + turn), b2_maxTranslation);
}

// The wider skin leaves the edge that meets a polygon's face too long: it ends where the face does. False
// where nothing of it is left.
bool cut_to(const b2Fixture& face, const b2Transform& to_face, b2Manifold& m) {
  if (face.GetType() != b2Shape::e_polygon || m.pointCount != 2) return true;
  const b2Vec2 along = b2Cross(m.localNormal, 1.0f);
  const auto& polygon = static_cast<const b2PolygonShape&>(*face.GetShape());
  auto [first, last] = extent(polygon, along);
  first += polygon.m_radius, last -= polygon.m_radius;
  const b2Vec2 ends[]{m.points[0].localPoint, m.points[1].localPoint};
  const float at[]{b2Dot(along, b2Mul(to_face, ends[0])), b2Dot(along, b2Mul(to_face, ends[1]))};
  if (std::max(at[0], at[1]) < first || std::min(at[0], at[1]) > last) return false;
  for (int k = 0; k < 2; ++k) {
    const float missing = b2Clamp(at[k], first, last) - at[k];
    if (missing == 0) continue;
    m.points[k].localPoint += missing / (at[1 - k] - at[k]) * (ends[1 - k] - ends[k]);
    b2ContactFeature& f = m.points[k].id.cf;
    f.typeA = m.type == b2Manifold::e_faceA ? b2ContactFeature::e_vertex : b2ContactFeature::e_face;
    f.typeB = m.type == b2Manifold::e_faceA ? b2ContactFeature::e_face : b2ContactFeature::e_vertex;
  }
  return true;
}

bool are_polygons(const b2Fixture& a, const b2Fixture& b) {
  return a.GetType() == b2Shape::e_polygon && b.GetType() == b2Shape::e_polygon;
}

// The normal of a touch of one of the two bodies, as if it were between them.
b2Vec2 normal_of(const Touch& touch, const b2Body& a, const b2Body& b) {
  const b2Vec2& n = touch.velocity->normal;
  return touch.a() == &a || touch.b() == &b ? n : -n;
}

// Whether one of so many points strikes within h seconds, and does not slide along what it meets; or is
// driven there.
bool strikes_within(const b2Body& a, const b2Vec2& center_a, const b2Body& b, const b2Vec2& center_b,
                    const b2WorldManifold& points, int32 count, float h, float driven) {
  const auto velocity = [](const b2Body& body, const b2Vec2& arm) {
    return body.GetLinearVelocity() + b2Cross(body.GetAngularVelocity(), arm);
  };
  const bool is_driven = a.GetType() == b2_kinematicBody || b.GetType() == b2_kinematicBody;
  for (int32 k = 0; k < count; ++k) {
    const b2Vec2& point = points.points[k];
    const b2Vec2 v = velocity(b, point - center_b) - velocity(a, point - center_a);
    const float closing = -b2Dot(v, points.normal);
    if (h * driven > points.separations[k]) return true;
    const bool slides = std::abs(b2Cross(v, points.normal)) > 2 * closing;
    if (closing > blow_speed && h * closing > points.separations[k] && (is_driven || !slides)) return true;
  }
  return false;
}

// Calls tell(listener, before) while the contact has these points.
template <class Tell>
void tell_with(b2Contact& contact, const b2Manifold& points, const Tell& tell) {
  b2ContactListener* listener =
      contact.GetFixtureA()->GetBody()->GetWorld()->GetContactManager().m_contactListener;
  if (listener == nullptr) return;
  b2Manifold& own = *contact.GetManifold();
  const b2Manifold before = own;
  own = points;
  tell(*listener, before);
  own = before;
}

// Whether PreSolve leaves the contact enabled, as it would be asked in the next step.
bool is_wanted(b2Contact& contact, const b2Manifold& near) {
  tell_with(contact, near, [&contact](b2ContactListener& listener, const b2Manifold& before) {
    listener.PreSolve(&contact, &before);
  });
  const bool wanted = contact.IsEnabled();
  contact.SetEnabled(true);
  return wanted;
}

}  // namespace

b2Vec2 slide(const Touch& touch, float h) {
  const b2Vec2 v = touch.b()->GetLinearVelocity() - touch.a()->GetLinearVelocity(),
               n = touch.velocity->normal, along = v - b2Dot(v, n) * n;
  const bool slides = h * along.Length() > b2_linearSlop && along.Length() > std::abs(b2Dot(v, n)) / 2;
  return slides ? h * along : b2Vec2_zero;
}

void tell_of_near(const Touch& touch) {
  b2ContactImpulse impulse;
  impulse.count = touch.velocity->count;
  bool presses = false;
  for (int32 k = 0; k < impulse.count; ++k) {
    impulse.normalImpulses[k] = touch.velocity->points[k].normal_impulse;
    impulse.tangentImpulses[k] = touch.velocity->points[k].tangent_impulse;
    presses |= impulse.normalImpulses[k] > 0;
  }
  if (!presses) return;
  tell_with(*touch.contact, *touch.manifold, [&](b2ContactListener& listener, const b2Manifold&) {
    listener.PostSolve(touch.contact, &impulse);
  });
}

// What it strikes first tells the way: the corner beside that, of a piece that is joined to it, is none of
// the whole.
void IslandContacts::keep_first_ways(std::size_t first, float h) {
  const auto ram_of = [](const Touch& t) -> const b2Body* {
    for (const b2Body* body : {t.a(), t.b()})
      if (body->GetType() == b2_kinematicBody) return body;
    return nullptr;
  };
  const auto strikes_after = [h](const Touch& t) {  // s
    if (!t.is_near()) return 0.0f;
    float least = b2_maxFloat;
    for (int32 k = 0; k < t.velocity->count; ++k) {
      const PointConstraint& p = t.velocity->points[k];
      const float gap = -h * p.bounce - b2_linearSlop, closes = -closing_speed(t, p);
      if (closes > 0) least = std::min(least, gap / closes);
    }
    return least;
  };
  for (std::size_t i = first; i < touches_.size(); ++i) {
    const b2Body* ram = ram_of(touches_[i]);
    if (ram == nullptr) continue;
    const Touch* struck = &touches_[i];
    float least = strikes_after(*struck);
    for (const Touch& t : touches_) {
      if (ram_of(t) != ram) continue;
      if (const float time = strikes_after(t); time < least) least = time, struck = &t;
    }
    const b2Vec2 &n = touches_[i].velocity->normal, &way = struck->velocity->normal;
    const float cosine = (touches_[i].a() == ram) == (struck->a() == ram) ? b2Dot(n, way) : -b2Dot(n, way);
    touches_[i].at_seam = cosine < same_way;
  }
  std::erase_if(touches_, [](const Touch& t) { return t.at_seam; });
}

void IslandContacts::add_near(b2Contact& contact, const Touch* touch, float h, float driven,
                              const b2Vec2& slide) {
  b2Fixture &fa = *contact.GetFixtureA(), &fb = *contact.GetFixtureB();
  const b2Body &a = *fa.GetBody(), &b = *fb.GetBody();
  const b2Manifold& known = *contact.GetManifold();
  const bool is_known = std::any_of(touches_.begin(), touches_.end(), [&contact](const Touch& t) {
    return t.contact == &contact && t.is_near();
  });
  // At a seam, the corner of the piece that a body comes to is left out.
  const bool touches = contact.IsTouching() && (slide == b2Vec2_zero || !is_at_seam(contact));
  const int32 touching = touches ? known.pointCount : 0;
  if (touching == b2_maxManifoldPoints || is_known || near_count_ == near_.size()) return;
  Near& near = near_[near_count_];
  const float radius = fb.GetShape()->m_radius;
  const float way = std::min(way_of(contact, h) + h * driven, b2_maxTranslation);
  const b2Vec2 lift = touch != nullptr && are_polygons(fa, fb) ? way * normal_of(*touch, a, b) : b2Vec2_zero;
  fb.GetShape()->m_radius = radius + way + lift.Length();
  const b2Position start_a = start_of_step(a), start_b = start_of_step(b);
  const b2Transform at_a = transform_of(a, start_a);
  b2Transform at_b = transform_of(b, start_b);
  at_b.p += slide + lift;
  contact.Evaluate(&near.manifold, at_a, at_b);
  fb.GetShape()->m_radius = radius;
  if (near.manifold.pointCount == 0) return;
  if (near.manifold.type == b2Manifold::e_faceA && !cut_to(fa, b2MulT(at_a, at_b), near.manifold)) return;
  if (near.manifold.type == b2Manifold::e_faceB && !cut_to(fb, b2MulT(at_b, at_a), near.manifold)) return;

  b2WorldManifold world;
  world.Initialize(&near.manifold, at_a, fa.GetShape()->m_radius, at_b, radius);
  const auto at_seam = [&](const b2Vec2& point) {
    return is_covered(fa, world.normal, point) || is_covered(fb, -world.normal, point);
  };
  if (touch == nullptr && std::all_of(world.points, world.points + near.manifold.pointCount, at_seam)) return;
  if (touch == nullptr
          ? !strikes_within(a, start_a.c, b, start_b.c, world, near.manifold.pointCount, h, driven)
          : b2Dot(world.normal, normal_of(*touch, a, b)) < (slide == b2Vec2_zero ? same_way : goes_on))
    return;
  VelocityConstraint& v = near.velocity = {};
  PositionConstraint& p = near.position = {};
  for (int32 k = 0; k < near.manifold.pointCount; ++k) {
    const auto* end = known.points + touching;
    const b2ManifoldPoint point = near.manifold.points[k];
    if (std::any_of(known.points, end, [&](const b2ManifoldPoint& q) { return q.id.key == point.id.key; }))
      continue;
    // Where the corner or circle is now that comes there on the other's face: half way between the two.
    const b2Vec2 there = world.points[k] - 0.5f * lift;
    const b2Vec2 now = near.manifold.type == b2Manifold::e_faceA ? there - slide : there;
    v.points[v.count].ra = now - start_a.c;
    v.points[v.count].rb = now - start_b.c;
    const float gap = world.separations[k] - b2Dot(slide + lift, world.normal);
    v.points[v.count].bounce = -(std::max(gap, 0.0f) + b2_linearSlop) / h;
    p.points[v.count] = point.localPoint;
    near.manifold.points[v.count++] = point;
  }
  if (v.count == 0) return;
  near.manifold.pointCount = p.count = v.count;
  if (!contact.IsTouching() && !is_wanted(contact, near.manifold)) return;
  v.normal = world.normal;
  v.friction = contact.GetFriction();
  v.conveyor = contact.GetTangentSpeed();
  p.normal = near.manifold.localNormal;
  p.point = near.manifold.localPoint;
  p.type = near.manifold.type;
  touches_.push_back({.contact = &contact,
                      .manifold = &near.manifold,
                      .velocity = &near.velocity,
                      .position = &near.position});
  ++near_count_;
}

}  // namespace ductile::dynamics
