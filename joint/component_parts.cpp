// The steps of a blow in parts: what strikes a structure sends waves through it that are over in a few
// milliseconds, and their plastic work depends on them. So a step in which a blow strains joints by a good
// share of their capacity, be it more than they carried before, and those of the next 50 ms in which some are
// strained that much, of 100 ms in which they throw what struck them, are solved as shorter ones, with
// contacts as rows of each. What strikes less hard is part of what goes on. Box2D sees one step: it moves
// bodies with their mean velocities, before its iterations of positions they get those at the end, and
// contacts have the sums of their impulses.
//
// Two things must hold. Nothing but the solver changes the bodies' velocities in the step. And supports rest,
// or move alike: the springs of rigid rows grow with the inverse square of the step, so that between supports
// that move apart a step of 1/60 s in parts would find their forces a thousand times as large.
#include <algorithm>
#include <cmath>
#include <utility>

#include "component.h"
#include "contact_rows.h"
#include "frames.h"
#include "nearest.h"
#include "structure.h"
#include "whole.h"

namespace ductile::dynamics {

namespace {

constexpr double part = 1 / 3840.0;           // s
constexpr double blow_time = 0.05;            // s that waves are followed for
constexpr double strained = 0.25;             // of a capacity
constexpr double most_turn_of_normals = 0.5;  // rad in a step
constexpr double most_turn_of_whole = 0.05;   // rad in a step, by what is given back where parts end

// What is as light as a piece is braked within a millisecond. With parts of 1/1920 s, a plate that strikes
// the middle of a clamped beam leaves 0.87 of the rotation that it should.
//
// A step of 1/60 s in parts costs as much as 64 whole ones. A block of a large wall costs as much as
// five bodies of a frame: a factor has 50 block products for each, 10 in a frame, and 6 in a chain. Where
// bodies jam, a pair that touches costs as much as eight bodies do. The sum over all that a structure solves
// in parts in one step is bounded: what is more than that is divided by 2, 4 or 8 times as long parts, and
// the rest has whole steps.
constexpr std::size_t bodies_per_touch = 8;
constexpr double work_of_body = 10;  // block products that a factor has for each body of a frame
constexpr double most_in_parts = 120;
constexpr int longest_part = 8;  // in shortest ones

// A push as weak as what its body goes on without, or weaker, is told as so many times what it is, at most.
constexpr double most_told = 4;

// The gap of what touches no more, which no step closes, m.
constexpr double no_step_closes = 4 * b2_maxTranslation;

// Whether a point, from the centre of mass of a body that is turned so far, is beyond the end of a polygon's
// face with this normal.
bool is_beyond(const b2Fixture& fixture, const b2Vec2& normal, const b2Vec2& arm, double angle) {
  if (fixture.GetType() != b2Shape::e_polygon) return false;
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  const b2Vec2 along = b2Cross(normal, 1.0f);
  const auto [first, last] = extent(polygon, along);
  const b2Vec2 point = b2MulT(b2Rot(static_cast<float>(angle)), arm) + fixture.GetBody()->GetLocalCenter();
  const float at = b2Dot(along, point);
  return at < first || at > last;
}

// Of impulses at a point of bodies that move at a and b, J; of 1 N s, how fast it opens.
double work(const Touch& t, const PointConstraint& p, double normal, double tangent, const Vec3& a,
            const Vec3& b) {
  const b2Vec2& n = t.velocity->normal;
  const double x = b.x - b.w * p.rb.y - (a.x - a.w * p.ra.y), y = b.y + b.w * p.rb.x - (a.y + a.w * p.ra.x);
  return (normal * n.x + tangent * n.y) * x + (normal * n.y - tangent * n.x) * y;
}

// The lesser of a row's caps, N or N m; of a rope or a strut, the one that it has.
double capacity(const Material& m, unsigned i) {
  return m.may_slacken(i) ? std::max(m.cap[i], m.cap_reverse[i]) : std::min(m.cap[i], m.cap_reverse[i]);
}

// N/m or N m/rad: of a rigid row, what a part resolves.
double resolved_stiffness(const JointRecord& r, unsigned i) {
  return is_rigid(r, i) ? r.m_eff[i] / (part * part) : r.law.spring[i];
}

}  // namespace

std::size_t Component::cost_of_parts() const {
  const auto bodies = static_cast<std::size_t>(solver.factor_work() / work_of_body);
  return std::max(solver.bodies.size(), bodies) + bodies_per_touch * outside_.touches.size();
}

// Into how many parts a step may be divided; 1 where that would cost too much.
int Component::parts_of(double h) const {
  double left = most_in_parts;
  for (const Structure::Impl* s : structures) left = std::min(left, most_in_parts - s->reports.in_parts);
  const auto cost = static_cast<double>(cost_of_parts());
  const int most = static_cast<int>(std::lround(h / part));
  for (int longer = 1; longer <= longest_part && most >= 2 * longer; longer *= 2)
    if (cost <= longer * left) return most / longer;
  return 1;
}

bool Component::may_divide(const b2SolverData& data) const {
  const double h = data.step.dt;
  // Of supports that are there; one alone may turn. What only touches has no springs.
  const Mirror* first = nullptr;
  const auto moves_alike = [&first](const Mirror& m) {
    if (!m.present || m.guest()) return true;
    if (first == nullptr) first = &m;
    const Vec3 apart = m.exact - first->exact;
    return &m == first || (dot(apart, apart) == 0 && m.exact.w == 0);
  };
  // What strikes may be spun by more than π/2 a step, which Box2D takes of it in the end; parts resolve that.
  const auto within_limits = [&] {
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      const Vec3& v = solver.bodies[i].v;
      if (!mirrors[i].guest() &&
          !(h * std::hypot(v.x, v.y) < b2_maxTranslation && h * std::abs(v.w) < b2_maxRotation))
        return false;
    }
    return true;
  };
  // A distance joint has no rows where its two anchors are one.
  const auto has_rows = [](const StockJoint& t) { return t.rows.count > 0; };
  return coupling_ != Coupling::partly && std::all_of(outside_.ties.begin(), outside_.ties.end(), has_rows) &&
         std::all_of(mirrors.begin() + static_cast<std::ptrdiff_t>(solver.free_bodies()), mirrors.end(),
                     moves_alike) &&
         !structures.front()->world->GetSubStepping() && data.step.positionIterations > 0 &&
         parts_of(h) > 1 && within_limits();
}

bool Component::goes_on_in_parts(const b2SolverData& data) const {
  return parts_.count > 1 && parts_.goes_on && may_divide(data);
}

// What a blow gives two bodies whose velocities jump against each other at a point, λ²/2m of λ = m_eff v.
void Component::strike(int a, int b, double speed) {
  const auto inverse_mass = [this](int i) {
    return solver.is_free(i) ? solver.bodies[z(i)].inverse_mass : 0;
  };
  const double both = inverse_mass(a) + inverse_mass(b);
  if (!(speed > blow_speed) || !(both > 0)) return;
  for (const int i : {a, b}) {
    if (!solver.is_free(i)) continue;
    double& energy = parts_.bodies[z(i)].energy;
    energy = std::max(energy, speed * speed / (both * both) * inverse_mass(i) / 2);
  }
}

// Whether such an energy is more than what the joints of its body store until they are `strained`, F²/2k. Of
// a long beam F is v √(ρA EI), and v √(ρA EA) along it, however short its pieces; of rigid rows k is what a
// part resolves.
bool Component::strains_joints() const {
  return std::any_of(members.begin(), members.end(), [this](const Member* m) {
    const Joint& j = solver.joints[m->index];
    const JointRecord& r = solver.records[m->index];
    double energy = 0;
    for (const int i : {j.a, j.b})
      if (solver.is_free(i)) energy = std::max(energy, parts_.bodies[z(i)].energy);
    if (energy == 0) return false;
    Rows force;
    for (unsigned i = 0; i < 3; ++i) force[i] = std::sqrt(2 * energy * resolved_stiffness(r, i));
    if (r.law.surface != nullptr) return r.law.surface->usage(force) > strained;
    for (unsigned i = 0; i < 3; ++i)
      if (j.G[i] > 0 && force[i] > strained * capacity(r.material, i)) return true;
    return false;
  });
}

// Whether a rope goes taut in this step, or a strut closes, with what hangs on it still moving, by F = v √(k
// m_eff) of itself or by what it strikes. At the start of the next it would be strained by a good part of a
// step's way. What a winch draws in strains it by little before.
bool Component::snaps_hard() {
  bool snaps = false;
  for (const int at : solver.slackening) {
    const Joint& j = solver.joints[z(at)];
    const JointRecord& r = solver.records[z(at)];
    const Rows v = relative_velocity(j, solver.free_velocity(j.a), solver.free_velocity(j.b));
    for (unsigned i = 0; i < 3; ++i) {
      if (!is_slack(j, r, i) || !(j.relaxation[i] > 0)) continue;
      const double h = r.law.h, e = strain_of_bias(j, i), k = resolved_stiffness(r, i);
      const double cap = v[i] > 0 ? r.material.cap[i] : r.material.cap_reverse[i], blow = strained * cap;
      const bool is_strained = v[i] * e > 0 && k * std::abs(e) > blow;
      if (!(cap > 0) || is_strained || !(v[i] * (e + h * v[i]) > 0)) continue;
      if (v[i] * v[i] * k * r.m_eff[i] > blow * blow) return true;
      if (!(h * h * k > r.m_eff[i])) continue;  // steps resolve it
      if (!std::exchange(snaps, true)) forget_blows();
      strike(j.a, j.b, std::copysign(1, v[i]) * relative_velocity(j, came_at(j.a), came_at(j.b))[i]);
    }
  }
  return snaps && strains_joints();
}

// Whether a blow needs parts. The solution of the whole step does not know the peak of what joints bear. Nor
// does it know where a piece is that restitution throws away and springs bring back within the step: it would
// meet what threw it again and again, from step to step, until nothing is left of the rebound. Nor what a
// kinematic body runs down: continuous collision would move the piece alone, and its structure stay behind.
bool Component::strikes_hard() {
  if (snapped_) return true;
  forget_blows();
  each_point([this](std::size_t, const Touch& t, const PointConstraint& p) {
    const double speed = -closing_speed(t, p);
    strike(t.in_a, t.in_b, speed);
    for (const int i : {t.in_a, t.in_b})
      if (solver.is_free(i) && speed > blow_speed) parts_.bodies[z(i)].rebounds |= p.bounce > 0;
  });
  bool runs_down = false;
  for (const Touch& t : outside_.near) {
    for (int32 k = 0; k < t.velocity->count; ++k)
      strike(t.in_a, t.in_b, -closing_speed(t, t.velocity->points[k]));
    for (const int i : {t.in_a, t.in_b}) runs_down |= mirrors[z(i)].type == b2_kinematicBody;
  }
  const auto jump = [this](int i) { return into_own_frame(solver.places[z(i)].turn, mirrors[z(i)].jump); };
  for (const Member* m : members) {
    const Joint& j = solver.joints[m->index];
    Rows v = relative_velocity(j, jump(j.a), jump(j.b));
    for (unsigned i = 0; i < 2; ++i)
      if (!(j.G[i] > 0) || is_slack(j, solver.records[m->index], i)) v[i] = 0;
    strike(j.a, j.b, std::hypot(v[0], v[1]));
  }
  const auto rebounds = [this](int i) { return solver.is_free(i) && parts_.bodies[z(i)].rebounds; };
  const bool rings = std::any_of(members.begin(), members.end(), [&](const Member* m) {
    const Joint& j = solver.joints[m->index];
    const JointRecord& r = solver.records[m->index];
    for (unsigned i = 0; i < 3 && (rebounds(j.a) || rebounds(j.b)); ++i)
      if (!is_rigid(r, i) && r.law.h * r.law.h * r.law.spring[i] > r.m_eff[i]) return true;
    return false;
  });
  return runs_down || rings || strains_joints();
}

// What is heavy strains much by its weight or its way in a step, though it may strike slowly; so may the hand
// of the game. The solution of the whole step knows that.
bool Component::strains_much() const { return solver.strained_by_blow() > strained; }

// The usage of a row without a cap is NaN, which exceeds no number: such a row is not strained.
bool Component::is_strained() const {
  return std::any_of(members.begin(), members.end(), [this](const Member* m) {
    const JointRecord& r = solver.records[m->index];
    if (r.law.surface != nullptr)
      return r.law.surface->usage(solver.joints[m->index].impulse, r.law.h) > strained;
    const auto is_strained = [m](Row row) { return m->joint->usage(row) > strained; };
    return is_strained(axial) || is_strained(shear) || is_strained(rotation);
  });
}

// What contacts and joints have changed a body's velocity by in the parts of this step.
Vec3 Component::pushed(std::size_t body) const {
  const Parts::OfBody& b = parts_.bodies[body];
  return mirrors[body].exact - b.before - parts_.count * b.given;
}

// Whether nothing but lines holds a body.
bool Component::flies(int body) const {
  return mirrors[z(body)].guest() || std::none_of(members.begin(), members.end(), [&](const Member* m) {
           const Joint& j = solver.joints[m->index];
           return !j.frame.line && (j.a == body || j.b == body);
         });
}

// Whether the structure gave what strikes it more than twice what bears its weight: moments may pass through
// 0 while it is thrown, or braked.
bool Component::throws() const {
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Vec3 weight = parts_.count * parts_.bodies[i].given, push = pushed(i);
    if (std::hypot(push.x, push.y) > std::max(double{blow_speed}, 2 * std::hypot(weight.x, weight.y)) &&
        flies(static_cast<int>(i)))
      return true;
  }
  return false;
}

// Contacts kept their normals in this step. What turned far on them would spin on in the next; a wheel may.
bool Component::normals_held() const {
  const auto turned = [this](int i) {
    return solver.is_free(i) &&
           std::abs(solver.places[z(i)].pose.angle - parts_.bodies[z(i)].start.angle) > most_turn_of_normals;
  };
  return std::none_of(solver.contacts.begin(), solver.contacts.end(), [&](const Contact& c) {
    return (turned(c.a) && has_lever(c.ax, c.ay, c.normal_a)) ||
           (turned(c.b) && has_lever(c.bx, c.by, c.normal_b));
  });
}

void Component::solve_in_parts(const b2SolverData& data, bool blow) {
  const bool hard = parts_.count == 1 || (blow && strikes_hard());
  const int count = parts_of(data.step.dt);
  const std::size_t cost = cost_of_parts();
  const double h = double{data.step.dt} / count;
  if (parts_.count != count) {
    if (parts_.count > 1)
      solver.unite(parts_.count);
    else if (count > 1)
      foresee(count);
    solver.divide(parts_.count = count);
  }
  silence_corners();
  coupling_ = Coupling::whole;
  begin_parts();
  for (int k = 0; k < count; ++k) {
    solve_part(h, k, blow);
    move();
    look_for_breaks(*this);
  }
  parts_.since_blow = hard ? 0 : parts_.since_blow + data.step.dt;
  end_parts(data);
  parts_.advanced = true;
  if (blow_) remember_blow();
  const double share = part / h;
  report([cost, share](Reports& r) {
    ++r.step.divided;
    r.in_parts += share * static_cast<double>(cost);
  });
}

// Velocities belong to the middle of the last step, h/2 before the poses, and a part's to h/2n before them:
// where whole steps end, forces have acted for (h − h/n)/2 less than they are to. Without what they give
// bodies then, a rope that snaps taut again and again would draw energy from what rings in between. They are
// those of the step in which nothing would be struck. What comes with velocities from elsewhere, as they are
// at its start, is not known to have been a step before.
void Component::foresee(int count) {
  if (parts_.withholds || !solver.knows_last_step()) return;
  each_point([&](std::size_t k, const Touch& t, const PointConstraint& p) {
    if (-closing_speed(t, p) > blow_speed) outside_.contacts[k].bounce = -no_step_closes / solver.step();
  });
  const auto own = [this](std::size_t i, const Vec3& v) { return into_own_frame(solver.places[i].turn, v); };
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    const Mirror& m = mirrors[i];
    if (!m.present) continue;
    Body& b = solver.bodies[i];
    (i < solver.free_bodies() ? b.v_free : b.v) = own(i, m.exact - m.jump);
  }
  solver.foresee(outside_.links, outside_.contacts);
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Mirror& m = mirrors[i];
    Vec3& withheld = parts_.bodies[i].withheld = {};
    if (!m.present) continue;
    const Vec3 last = in_doubles(velocity_of(*m.body)) - m.jump;
    withheld = (0.5 - 0.5 / count) * (into_world(solver.places[i].turn, solver.bodies[i].v) - last);
  }
  parts_.withholds = true;
}

// What gravity and loads give a body in the step they give it evenly. Where the last step ended in parts,
// too, bodies begin with the velocities at its end, not with the means, and else with those that foresee()
// found; but where one of them has left, it goes on with its mean, and so must they all, or momentum would be
// lost.
void Component::begin_parts() {
  bool restores = std::exchange(parts_.withholds, false);
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Vec3& withheld = parts_.bodies[i].withheld;
    restores &= mirrors[i].present || dot(withheld, withheld) == 0;
  }
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    Mirror& m = mirrors[i];
    Parts::OfBody& body = parts_.bodies[i];
    const Vec3 restored = restores ? body.withheld : Vec3{};
    body = {.start = solver.places[i].pose, .restored = restored};
    if (!m.present) continue;
    const Vec3 told = in_doubles(velocity_of(*m.body));
    body.given = 1.0 / parts_.count * (m.exact - told);
    m.exact = body.before = told + restored;
  }
  outside_.touches.insert(outside_.touches.end(), outside_.near.begin(), outside_.near.end());
  read_touches();
  parts_.sums.assign(outside_.contacts.size(), {});
  // From where Box2D was told that a body is (keep_in_touch()) to where it is.
  const auto beyond = [this](int i) {
    const Pose &at = solver.places[z(i)].pose, told = origin.relative(mirrors[z(i)].left);
    return Vec3{at.x - told.x, at.y - told.y, 0};
  };
  each_point([&](std::size_t k, const Touch& t, const PointConstraint& p) {
    parts_.sums[k].ra = p.ra;
    parts_.sums[k].rb = p.rb;
    const b2Vec2& n = t.velocity->normal;
    const Vec3 way = beyond(t.in_b) - beyond(t.in_a);
    const double apart = n.x * way.x + n.y * way.y;
    double& gap = parts_.sums[k].gap;
    if (apart > b2_linearSlop) gap = apart;
    if (!t.is_near()) return;
    gap = -p.bounce * (parts_.count * solver.step());
    parts_.sums[k].beside = is_beside(t, p);
  });
  parts_.links.clear();
  for (Contact& c : outside_.contacts) {
    c.normal /= parts_.count;
    c.tangent /= parts_.count;
  }
}

// How far a point goes with body b, as against body a: it is a corner or a circle of one of them; of two
// circles it is half way.
float Component::goes_with_b(const Touch& t, const PointConstraint& p) const {
  const b2Manifold& m = *t.manifold;
  if (m.type == b2Manifold::e_circles) return 0.5f;
  return (m.type == b2Manifold::e_faceA) != is_end_of_face(m, m.points[&p - t.velocity->points]) ? 1.0f
                                                                                                 : 0.0f;
}

// Whether a point is beyond the end of the face that it touches: it has slid off that, or is not there yet.
bool Component::is_beside(const Touch& t, const PointConstraint& p) const {
  const bool on_a = goes_with_b(t, p) == 1;  // two circles have no face, and no end of one
  const b2Manifold& m = *t.manifold;
  const double angle = solver.places[z(on_a ? t.in_a : t.in_b)].pose.angle;
  const b2Vec2 normal = on_a == (m.type == b2Manifold::e_faceA)
                            ? m.localNormal
                            : b2MulT(b2Rot(static_cast<float>(angle)), t.velocity->normal);
  return is_beyond(on_a ? *t.contact->GetFixtureA() : *t.contact->GetFixtureB(), normal, on_a ? p.ra : p.rb,
                   angle);
}

// A contact's two impulses act at one point, or friction would take angular momentum as bodies slide: it goes
// with the corner or the circle that touches the other's face.
void Component::carry_arms() {
  each_point([&](std::size_t k, const Touch& t, PointConstraint& p) {
    const Pose &a = solver.places[z(t.in_a)].pose, &b = solver.places[z(t.in_b)].pose;
    const b2Vec2 apart = b2Vec2(static_cast<float>(b.x - a.x), static_cast<float>(b.y - a.y)) + p.rb - p.ra;
    const float share = goes_with_b(t, p);
    p.ra += share * apart;
    p.rb -= (1 - share) * apart;
    parts_.sums[k].beside = is_beside(t, p);
  });
}

// Contacts keep their directions in the world, and close no further than their gap since the step's start.
void Component::solve_part(double h, int number, bool blow) {
  const bool first = number == 0;
  const auto enter = [this](std::size_t i) {
    const Vec3& v = mirrors[i].exact;
    solver.before[i] = into_own_frame(solver.places[i].turn, v);
  };
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    enter(i);
    const Vec3 v = mirrors[i].exact + parts_.bodies[i].given;
    solver.bodies[i].v_free = into_own_frame(solver.places[i].turn, v);
  }
  for (std::size_t i = solver.free_bodies(); i < mirrors.size(); ++i) {
    enter(i);
    solver.bodies[i].v = solver.before[i];
  }
  solver.begin(h);
  if (!first) {
    carry_arms();
    read_touches();
    for (std::size_t k = 0; k < outside_.contacts.size(); ++k) {
      Contact& c = outside_.contacts[k];
      c.normal = solver.contacts[k].normal;
      c.tangent = solver.contacts[k].tangent;
      c.bounce = 0;
    }
  }
  const auto work_now = [this](const Touch& t, const PointConstraint& p, double normal, double tangent) {
    return work(t, p, normal, tangent, mirrors[z(t.in_a)].exact, mirrors[z(t.in_b)].exact);
  };
  double fastest = first && blow ? closing() : 0;  // of what closes in this part, m/s
  each_point([&](std::size_t k, const Touch& t, const PointConstraint& p) {
    const double gap = parts_.sums[k].beside ? no_step_closes : parts_.sums[k].gap,
                 closes = -work_now(t, p, 1, 0);
    if (gap > 0) outside_.contacts[k].bounce = -gap / h;
    if (h * closes > gap) fastest = std::max(fastest, closes);
  });
  enter_ties(parts_.count);
  if (!first && outside_.links.size() == solver.links.size()) {
    for (std::size_t k = 0; k < solver.links.size(); ++k) outside_.links[k].impulse = solver.links[k].impulse;
  }
  solver.touch(outside_.links, outside_.contacts);
  const bool strikes = (first && blow) || fastest > blow_speed;
  const double over = static_cast<double>(number) / parts_.count;
  if (strikes) {
    solver.strike(fastest);
    blow_ = true;
  } else {
    solver.go_on();
  }
  solve_direct();
  limit_speed_in_part();

  each_point([&](std::size_t k, const Touch& t, const PointConstraint& p) {
    Parts::OfContact& sum = parts_.sums[k];
    const Contact& c = solver.contacts[k];
    sum.normal += c.normal;
    sum.tangent += c.tangent;
    sum.last_normal = strikes ? 0 : c.normal;
    sum.last_tangent = strikes ? 0 : c.tangent;
    sum.work += work_now(t, p, c.normal, c.tangent) / 2;
  });
  parts_.links.resize(solver.links.size());
  for (std::size_t k = 0; k < solver.links.size(); ++k) {
    const Joint& j = solver.joints[solver.own() + k];
    const Rows v0 = relative_velocity(j, solver.before[z(j.a)], solver.before[z(j.b)]);
    const Rows v = relative_velocity(j, solver.bodies[z(j.a)].v, solver.bodies[z(j.b)].v);
    Parts::OfLink& sum = parts_.links[k];
    if (first) sum.J = j.J;
    for (unsigned i = 0; i < 3; ++i) {
      sum.impulse[i] += j.impulse[i];
      sum.work -= j.impulse[i] * (v0[i] + v[i]) / 2;
    }
  }
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Vec3 v = into_world(solver.places[i].turn, solver.bodies[i].v);
    Parts::OfBody& body = parts_.bodies[i];
    body.sum += 0.5 * (mirrors[i].exact + v);
    if (strikes) body.late += over * (v - mirrors[i].exact - body.given);
    mirrors[i].exact = v;
  }
  each_point([&](std::size_t k, const Touch& t, const PointConstraint& p) {
    Parts::OfContact& sum = parts_.sums[k];
    sum.work += work_now(t, p, solver.contacts[k].normal, solver.contacts[k].tangent) / 2;
    sum.gap = std::max(0.0, sum.gap + h * work_now(t, p, 1, 0));
  });
}

// Box2D moves the bodies by what it finds here, and has a step of position iterations to get their
// velocities. Those belong to the middle of a part.
void Component::end_parts(const b2SolverData& data) {
  for (std::size_t k = 0; k < outside_.contacts.size(); ++k) {
    solver.contacts[k].normal = parts_.sums[k].normal;
    solver.contacts[k].tangent = parts_.sums[k].tangent;
  }
  for (std::size_t k = 0; k < solver.links.size(); ++k) solver.links[k].impulse = parts_.links[k].impulse;
  const double rate = 1 / double{data.step.dt};
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Pose &from = parts_.bodies[i].start, &to = solver.places[i].pose;
    parts_.bodies[i].mean = {rate * (to.x - from.x), rate * (to.y - from.y), rate * (to.angle - from.angle)};
  }
  const bool thrown = throws();
  parts_.goes_on = parts_.since_blow < (thrown ? 2 : 1) * blow_time && normals_held() &&
                   (snapped_ || is_strained() || thrown);
  tell_of_means();
  const double lost = parts_.goes_on ? 0 : go_on_with_means();
  return_contacts();
  return_ties();
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) mirrors[i].left = box2d_pose(i);
  if (parts_.goes_on && is_held()) keep_in_touch(data.step.dt);
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    Mirror& m = mirrors[i];
    m.given = in_floats(m.exact);
    if (m.present) data.velocities[m.island_index] = in_floats(parts_.bodies[i].mean);
  }
  if (solver.keeps_ledger) {
    book_parts();
    solver.book_parts(0, -lost);
  }
  for (std::size_t i = solver.free_bodies(); i < mirrors.size(); ++i) {
    if (mirrors[i].type != b2_staticBody && mirrors[i].present) mirrors[i].left = box2d_pose(i);
  }
}

// What struck a piece may be off it where the step ends, and on it again before the next one does. Box2D
// solves with the structure what touches it as a step starts; so it is told the place at which that still
// touches, on a kink both pieces, and the gap is one of the parts. Faces have turned since the step's start,
// and what slides has come to others: the gap is measured.
void Component::keep_in_touch(double h) {
  const auto look = [this](int i, double gap, const b2Vec2& to_it) {
    Parts::OfBody& body = parts_.bodies[z(i)];
    if (gap < body.gap) body.gap = gap, body.to_it = to_it;
  };
  const auto at_end = [this](int i) { return transform_of(*mirrors[z(i)].body, box2d_pose(z(i))); };
  for (const Touch& t : outside_.touches) {
    if (!(mirrors[z(t.in_a)].guest() || mirrors[z(t.in_b)].guest())) continue;
    const b2Contact& c = *t.contact;
    const b2DistanceProxy a = proxy(*c.GetFixtureA(), c.GetChildIndexA()),
                          b = proxy(*c.GetFixtureB(), c.GetChildIndexB());
    const Nearest found = nearest(a, at_end(t.in_a), b, at_end(t.in_b));
    const double two_deep = a.m_radius + b.m_radius - 2 * b2_linearSlop;
    const double gap = c.GetRestitution() > 0 ? 0 : found.distance - two_deep;
    if (solver.is_free(t.in_a)) look(t.in_a, gap, found.normal);
    if (solver.is_free(t.in_b)) look(t.in_b, gap, -found.normal);
  }
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    Parts::OfBody& body = parts_.bodies[i];
    if (!mirrors[i].guest() || !(body.gap > b2_linearSlop) || !(body.gap < b2_aabbExtension)) continue;
    const b2Vec2 way = static_cast<float>(body.gap) * body.to_it;
    mirrors[i].left.c += way;
    body.mean += {way.x / h, way.y / h, 0};
  }
}

// Where whole steps follow, bodies go on with their mean velocities, which belong to the middle of this one:
// else all forces would act half a step too early from then on, and a flow that is braked by a cap would be
// v h/2 short. But what struck in the step has struck, and does not do so again in the next: the means are
// those of a step at whose start it did. What rings within the step is lost then. But the angular momentum of
// what hung together in the step, and nothing held, is that of the parts' last velocities where bodies are
// now; the means belong to other places. So all of it turns as one about its centre of mass by what they
// miss: its momentum stays, and no other motion that gives it back takes less energy. What turns far is left
// with the means: their chords are so much shorter than its way that what they miss would be a spin of
// another kind. Returns what is lost, J.
double Component::go_on_with_means() {
  write_contacts(solver);  // which pressed in some part
  find_wholes(solver);
  double lost = 0;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Body& b = solver.bodies[i];
    const Pose& at = solver.places[i].pose;
    const Vec3 mean = lasting(i), less = mirrors[i].exact - mean;
    Whole& whole = whole_of(solver, static_cast<int>(i));
    whole.moment += b.mass * ((at.x - whole.x) * less.y - (at.y - whole.y) * less.x) + b.inertia * less.w;
    lost += twice_kinetic(b, mirrors[i].exact) / 2;
    parts_.bodies[i].withheld = std::exchange(mirrors[i].exact, mean);
  }
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Pose& at = solver.places[i].pose;
    const Whole& whole = whole_of(solver, static_cast<int>(i));
    Vec3& v = mirrors[i].exact;
    const double turn = whole.held ? 0 : whole.moment / whole.inertia;
    if (std::abs(turn) * parts_.count * solver.step() < most_turn_of_whole)
      v += turn * Vec3{whole.y - at.y, at.x - whole.x, 1};
    lost -= twice_kinetic(solver.bodies[i], v) / 2;
    parts_.bodies[i].withheld -= v;
  }
  parts_.withholds = true;
  return lost;
}

// What it goes on with where whole steps follow.
Vec3 Component::lasting(std::size_t body) const {
  return parts_.bodies[body].mean + parts_.bodies[body].late;
}

// The velocity that Box2D, and who observes it, knows of the step's start.
Vec3 Component::told(std::size_t body) const {
  return parts_.bodies[body].before - parts_.bodies[body].restored;
}

// What pushes bodies is told as what those that hang together go on with: what is more, where whole steps
// follow, is given again, and told again, by the next step. If that has parts after all, it restores that
// much, and tells it besides what it gives. What is held has other impulses, too.
void Component::tell_of_means() {
  if (groups_.empty()) find_groups(outside_.ties);
  const auto all_of = [this](int i) -> Parts::OfBody& { return parts_.bodies[z(groups_[z(i)].part_of)]; };
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Parts::OfBody& body = parts_.bodies[i];
    Vec3 more = parts_.goes_on ? Vec3{} : mirrors[i].exact - lasting(i);
    more -= body.restored;
    Parts::OfBody& all = all_of(static_cast<int>(i));
    all.push += solver.bodies[i].mass * pushed(i);
    all.more += solver.bodies[i].mass * more;
  }
  for (const StockJoint& t : outside_.ties) {
    if (hang_together(t.in_a, t.in_b)) continue;
    for (const int i : {t.in_a, t.in_b})
      if (solver.is_free(i)) all_of(i).tied = true;
  }
  each_point([&](std::size_t k, const Touch& t, const PointConstraint&) {
    double share = 0;
    int told = 0;
    for (const int i : {t.in_a, t.in_b}) {
      if (is_anchored(i)) continue;
      const Parts::OfBody& all = all_of(i);
      const double square = all.push.x * all.push.x + all.push.y * all.push.y;
      if (all.tied) continue;
      const double along = all.push.x * all.more.x + all.push.y * all.more.y;
      share += square > 0 ? std::clamp(1 - along / square, 0.0, most_told) : 1;
      ++told;
    }
    if (told == 0) return;
    Parts::OfContact& sum = parts_.sums[k];
    solver.contacts[k].normal = sum.normal *= share / told;
    solver.contacts[k].tangent = sum.tangent *= share / told;
  });
}

// An observer of the whole step counts impulses, where they acted when it began, times the mean of the
// velocities before and after it. What the step restored of its velocities is told by no impulse.
void Component::book_parts() {
  double contacts = 0, weight = 0;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    const Parts::OfBody& body = parts_.bodies[i];
    const Body& b = solver.bodies[i];
    const Vec3 beyond = body.sum - 0.5 * parts_.count * (told(i) + mirrors[i].exact);
    weight += (twice_kinetic(b, body.before) - twice_kinetic(b, told(i))) / 2;
    weight +=
        b.mass * (body.given.x * beyond.x + body.given.y * beyond.y) + b.inertia * body.given.w * beyond.w;
  }
  const auto twice_mean = [this](int i) {
    return (solver.is_free(i) ? told(z(i)) : mirrors[z(i)].exact) + mirrors[z(i)].exact;
  };
  each_point([&](std::size_t k, const Touch& t, PointConstraint& p) {
    const Parts::OfContact& sum = parts_.sums[k];
    p.ra = sum.ra, p.rb = sum.rb;
    contacts += sum.work - work(t, p, sum.normal, sum.tangent, twice_mean(t.in_a), twice_mean(t.in_b)) / 2;
  });
  for (std::size_t k = 0; k < parts_.links.size(); ++k) {
    const Parts::OfLink& sum = parts_.links[k];
    Joint j;
    j.J = sum.J;
    const auto own = [&](int i) {
      const double angle =
          solver.is_free(i) ? parts_.bodies[z(i)].start.angle : solver.places[z(i)].pose.angle;
      return into_own_frame(turn_of(angle), twice_mean(i));
    };
    const Joint& row = solver.joints[solver.own() + k];
    const Rows v = relative_velocity(j, own(row.a), own(row.b));
    contacts += sum.work;
    for (unsigned i = 0; i < 3; ++i) contacts += sum.impulse[i] * v[i] / 2;
  }
  solver.book_parts(contacts, weight);
}

}  // namespace ductile::dynamics
