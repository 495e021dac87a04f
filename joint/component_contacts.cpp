// Contacts of a step as rows of a component: read from the island's contact solver, and given back to it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "component.h"
#include "frames.h"
#include "seams.h"
#include "structure.h"

namespace ductile::dynamics {

bool Component::touch(Touch t) {
  t.in_a = index_of(t.a());
  t.in_b = index_of(t.b());
  if (!knows(t.in_a, t.in_b)) return false;
  t.at_seam = !t.is_near() && is_at_seam(*t.contact);
  (t.is_near() ? outside_.near : outside_.touches).push_back(t);
  return true;
}

void Component::meet_at_corner(Touch t) {
  t.in_a = index_of(t.a());
  t.in_b = index_of(t.b());
  const auto is_own = [this](int body) { return body >= 0 && !mirrors[z(body)].guest(); };
  if (is_own(t.in_a) && is_own(t.in_b)) outside_.corners.push_back(t);
  for (const int body : {t.in_a, t.in_b})
    if (body >= 0 && !is_own(body)) outside_.at_corners.push_back(body);
}

bool Component::knows(int a, int b) const {
  if (a < 0 || b < 0 || is_of_another(a) || is_of_another(b)) return false;
  const std::pair<int, int> pair = std::minmax(a, b);
  return !solver.is_free(pair.second) || std::binary_search(solver.pairs.begin(), solver.pairs.end(), pair);
}

bool Component::is_of_another(int body) const {
  const Mirror& m = mirrors[z(body)];
  return m.guest() && solver.is_free(body) && Structure::Impl::structure_of(*m.body) != nullptr;
}

// Velocities as they were before the contacts' stored impulses went into them. The floats are those of
// b2ContactSolver::WarmStart(), in its order: where they give Box2D's velocities, no rounding is in those.
void Component::set_warm_start_aside(const Touch& t) {
  const auto warm = [](Mirror& m, const b2Vec2& arm, float by_mass, float by_inertia, const b2Vec2& P) {
    m.expected.w += by_inertia * b2Cross(arm, P);
    m.expected.v += by_mass * P;
    m.exact -= {double{by_mass} * P.x, double{by_mass} * P.y, double{by_inertia} * b2Cross(arm, P)};
  };
  const VelocityConstraint& v = *t.velocity;
  const b2Vec2 tangent = b2Cross(v.normal, 1.0f);
  for (int32 k = 0; k < v.count; ++k) {
    const PointConstraint& p = v.points[k];
    const b2Vec2 P = p.normal_impulse * v.normal + p.tangent_impulse * tangent;
    warm(mirrors[z(t.in_a)], p.ra, -v.inverse_mass_a, -v.inverse_inertia_a, P);
    warm(mirrors[z(t.in_b)], p.rb, v.inverse_mass_b, v.inverse_inertia_b, P);
  }
}

void Component::set_warm_starts_aside() {
  for (const Touch& t : outside_.touches) set_warm_start_aside(t);
  for (const Touch& t : outside_.touches) {
    for (const int body : {t.in_a, t.in_b}) {
      Mirror& m = mirrors[z(body)];
      if (solver.is_free(body) && same_bits(m.expected, m.taken)) m.exact = m.alone;
    }
  }
}

// Corners of joined pieces that touch as they turn do not press while a blow is solved in parts.
void Component::silence_corners() {
  for (const Touch& t : outside_.corners) {
    set_warm_start_aside(t);
    silence(t);
  }
}

void Component::enter_contacts() {
  read_touches();
  each_point([this](std::size_t k, const Touch& t, const PointConstraint& p) {
    if (p.normal_impulse > 0 && p.bounce == 0)
      outside_.contacts[k].bounce = -opening(t, static_cast<int32>(&p - t.velocity->points), solver.step());
  });
  solver.touch(outside_.links, outside_.contacts);
}

// The speed at which a contact that goes on opens in a step of h s beyond n·v, h/2 of the gap's second
// derivative at the velocities of the step's start: a face turns under what slides along it, and corners turn
// about their bodies. Without it a wheel that rolls at v along a piece that turns at ω rises from it by v ω
// h² in each step, until there is no contact. What closes is left to Box2D's corrections: pushed apart, a jam
// would have no solution. What turns far in a step, or opens by more than Box2D's slop, will not go on as it
// did, and is left alone. What poses hardly resolve is none, or nothing would rest.
double Component::opening(const Touch& t, int32 point, double h) {
  const PositionConstraint& position = *t.position;
  if (position.type == b2Manifold::e_circles) return 0;
  const bool on_a = position.type == b2Manifold::e_faceA;
  const b2Body &face = on_a ? *t.a() : *t.b(), &corner = on_a ? *t.b() : *t.a();
  const b2Vec2 n = on_a ? t.velocity->normal : -t.velocity->normal;
  const b2Vec2 arm =
      b2Mul(corner.GetTransform().q, position.points[point] - (on_a ? position.center_b : position.center_a));
  const float turn = face.GetAngularVelocity(), own_turn = corner.GetAngularVelocity();
  constexpr double most_turn = 0.1, most = b2_linearSlop, trifle = 1e-7;  // rad in a step, m
  const bool is_wheel = arm.LengthSquared() < b2_linearSlop * b2_linearSlop;
  if (h * std::abs(turn) > most_turn || (h * std::abs(own_turn) > most_turn && !is_wheel)) return 0;
  const b2Vec2 apart = corner.GetWorldCenter() + arm - face.GetWorldCenter();
  const b2Vec2 slide = corner.GetLinearVelocity() + b2Cross(own_turn, arm) - face.GetLinearVelocity();
  const double second = 2 * b2Dot(b2Cross(turn, n), slide) - turn * turn * b2Dot(n, apart) -
                        own_turn * own_turn * b2Dot(n, arm);
  const double way = h * h / 2 * second;
  return way > trifle && way < most ? way / h : 0;
}

// Whether the contacts are those that the last step was solved with, and hold the impulses that it found.
// Box2D added these to the velocities, in floats.
bool Component::touched_as_before() {
  for (Mirror& m : mirrors) m.rounding = 0;
  if (outside_.touches.empty() && solver.contacts.empty()) return true;
  read_touches();
  for (const Touch& t : outside_.touches) {
    const VelocityConstraint& v = *t.velocity;
    const auto add = [](Mirror& m, const PointConstraint& p, const b2Vec2& arm, float by_mass,
                        float by_inertia) {
      constexpr float last_bits = 4 * std::numeric_limits<float>::epsilon();
      m.rounding += last_bits * (p.normal_impulse + std::abs(p.tangent_impulse)) *
                    (by_mass + by_inertia * arm.Length() * m.mass.gyration);
    };
    for (int32 k = 0; k < v.count; ++k) {
      const PointConstraint& p = v.points[k];
      add(mirrors[z(t.in_a)], p, p.ra, v.inverse_mass_a, v.inverse_inertia_a);
      add(mirrors[z(t.in_b)], p, p.rb, v.inverse_mass_b, v.inverse_inertia_b);
    }
  }
  const auto is_same = [](const Contact& now, const Contact& before) {
    const auto near = [](double x, double y) {
      return std::abs(x - y) <= 1e-6;
    };  // in poses of the same floats
    const auto along = [&](const Turn& m, const Turn& n) { return near(m.c, n.c) && near(m.s, n.s); };
    return now.a == before.a && now.b == before.b && now.id == before.id && near(now.ax, before.ax) &&
           near(now.ay, before.ay) && near(now.bx, before.bx) && near(now.by, before.by) &&
           along(now.normal_a, before.normal_a) && along(now.normal_b, before.normal_b) &&
           now.bounce == before.bounce && now.conveyor == before.conveyor &&
           now.friction == before.friction && now.normal == static_cast<float>(before.normal) &&
           now.tangent == static_cast<float>(before.tangent);
  };
  const Vector<Contact>& rows = outside_.contacts;
  return std::equal(rows.begin(), rows.end(), solver.contacts.begin(), solver.contacts.end(), is_same);
}

// A point stays where it is on its bodies while all that moves it is rounding of Box2D's floats: its rows are
// so stiff that they would ask for a new factor in each step.
void Component::steady(Contact& c) const {
  const std::size_t k = outside_.contacts.size() - 1;
  if (k >= solver.contacts.size()) return;
  const Contact& last = solver.contacts[k];
  if (last.id != c.id || last.a != c.a || last.b != c.b) return;
  const b2Vec2 at = mirrors[z(c.a)].left.c;
  constexpr double last_bits = 4 * std::numeric_limits<float>::epsilon();
  const double near = last_bits * (1 + std::abs(at.x) + std::abs(at.y));
  const auto moved = [](double x, double y) { return std::max(std::abs(x), std::abs(y)); };
  if (std::max(moved(c.ax - last.ax, c.ay - last.ay), moved(c.bx - last.bx, c.by - last.by)) > near) return;
  // What turns a body moves its point by so much.
  const auto turns = [&](const Turn& now, const Turn& then, double x, double y) {
    return moved(now.c - then.c, now.s - then.s) > std::max(last_bits, near / moved(x, y));
  };
  if (turns(c.normal_a, last.normal_a, c.ax, c.ay) || turns(c.normal_b, last.normal_b, c.bx, c.by)) return;
  c.ax = last.ax, c.ay = last.ay, c.bx = last.bx, c.by = last.by;
  c.normal_a = last.normal_a, c.normal_b = last.normal_b;
}

void Component::read_touches() {
  outside_.contacts.clear();
  for (const Touch& t : outside_.touches) {
    if (t.at_seam) continue;
    const VelocityConstraint& v = *t.velocity;
    Contact c;
    c.a = t.in_a;
    c.b = t.in_b;
    const Turn to_a = inverse(solver.places[z(c.a)].turn), to_b = inverse(solver.places[z(c.b)].turn);
    const Turn normal{v.normal.x, v.normal.y};
    c.normal_a = to_a * normal;
    c.normal_b = to_b * normal;
    c.friction = v.friction;
    c.conveyor = v.conveyor;
    for (int32 k = 0; k < v.count; ++k) {
      const PointConstraint& p = v.points[k];
      const Turn ra = to_a * Turn{p.ra.x, p.ra.y}, rb = to_b * Turn{p.rb.x, p.rb.y};
      c.ax = ra.c, c.ay = ra.s, c.bx = rb.c, c.by = rb.s;
      c.bounce = p.bounce;
      c.normal = p.normal_impulse;
      c.tangent = p.tangent_impulse;
      c.id = t.manifold->points[k].id.key;
      outside_.contacts.push_back(c);
      steady(outside_.contacts.back());
    }
  }
}

// Box2D corrects the overlap of a guest and an anchored structure by moving the guest alone: the piece would
// be brought back. So it would be from what does not move: skins may overlap there, as they do where a
// structure was made flush with a wall. So are pieces of one structure that overlap, and what is wedged
// between them, where their joints take back what they are pushed by: while they stand, all that touches
// stays as deep as it is.
void Component::return_contacts() {
  const bool stand_jammed = pieces_jam_ && solver.fastest() < b2_linearSleepTolerance &&
                            solver.fastest_turn() < b2_angularSleepTolerance;
  if (groups_.empty() && !outside_.touches.empty()) find_groups(outside_.ties);
  auto row = solver.contacts.begin();
  for (const Touch& t : outside_.touches) {
    if (t.at_seam) {
      silence(t);
      continue;
    }
    for (int32 k = 0; k < t.velocity->count; ++k) {
      const Contact& c = *row++;
      t.velocity->points[k].normal_impulse = static_cast<float>(c.normal);
      t.velocity->points[k].tangent_impulse = static_cast<float>(c.tangent);
    }
    if (t.is_near()) {
      tell_of_near(t);
      continue;
    }
    settle(*t.velocity);
    const Mirror &a = mirrors[z(t.in_a)], &b = mirrors[z(t.in_b)];
    const auto yields = [](const Mirror& m) { return m.guest() && m.type == b2_dynamicBody; };
    const bool anchored_a = !a.guest() && is_anchored(t.in_a), anchored_b = !b.guest() && is_anchored(t.in_b);
    if (anchored_a && yields(b)) hold_a(*t.position);
    if (anchored_b && yields(a)) hold_b(*t.position);
    const auto stands = [](const Mirror& m) { return m.type != b2_dynamicBody; };
    if ((anchored_a && stands(b)) || (anchored_b && stands(a))) let_skins_overlap(*t.position);
    if (stand_jammed) let_stay(t);
  }
  if (!stand_jammed) return;
  for (const Touch& t : outside_.corners) let_stay(t);
}

void Component::remember_blow() {
  each_point([this](std::size_t k, const Touch& t, const PointConstraint& p) {
    if (t.is_near()) return;
    const auto point = static_cast<std::size_t>(&p - t.velocity->points);
    if (point == 0) struck_contacts_.push_back({t.contact});
    if (!parts_.advanced) return;
    struck_contacts_.back().normal[point] = static_cast<float>(parts_.sums[k].last_normal);
    struck_contacts_.back().tangent[point] = static_cast<float>(parts_.sums[k].last_tangent);
  });
}

float Component::closes(const Touch& t) {
  float most = 0;
  for (int32 k = 0; k < t.velocity->count; ++k)
    most = std::max(most, -closing_speed(t, t.velocity->points[k]));
  return most;
}

// Of what closes fastest, m/s.
double Component::closing() const {
  float most = 0;
  for (const Touch& t : outside_.touches)
    if (!t.at_seam) most = std::max(most, closes(t));
  return most;
}

// Whether velocities jump at the start of this step: of pieces, or as something closes with them.
bool Component::is_blow() const { return struck_ || closing() > double{blow_speed}; }

}  // namespace ductile::dynamics
