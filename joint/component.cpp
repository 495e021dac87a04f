// How joints that hang together become a component: elimination order, poses in doubles, what is known of
// them from before.
#include "component.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

// Where a body stands, or would stand, in a list by address.
template <class List>
auto place_of(List& by_address, const b2Body* body) {
  return std::lower_bound(by_address.begin(), by_address.end(), std::pair{body, 0});
}

}  // namespace

Component::Component(std::span<Member* const> enlisted_members, SolverKind solver_kind,
                     std::span<const BodyPair> touching, std::span<b2Body* const> order)
    : solver(solver_kind == SolverKind::iterative),
      members(enlisted_members.begin(), enlisted_members.end()),
      met(touching.begin(), touching.end()),
      formed_of_(members.size()) {
  constexpr int unnumbered = std::numeric_limits<int>::max();
  by_address_.reserve(2 * (members.size() + met.size()));
  for (const Member* m : members) {
    by_address_.emplace_back(m->joint->GetBodyA(), unnumbered);
    by_address_.emplace_back(m->joint->GetBodyB(), unnumbered);
  }
  for (const BodyPair& pair : met) {
    by_address_.emplace_back(pair.a, unnumbered);
    by_address_.emplace_back(pair.b, unnumbered);
  }
  std::sort(by_address_.begin(), by_address_.end());
  by_address_.erase(std::unique(by_address_.begin(), by_address_.end()), by_address_.end());
  const auto number = [this](const b2Body* body) -> int& { return place_of(by_address_, body)->second; };

  // Free bodies first, in the order of their first joint: elimination order is found from that numbering.
  Vector<b2Body*> bodies, others;
  bodies.reserve(by_address_.size());
  const auto count_in = [&](b2Body* body) {
    if (number(body) != unnumbered) return;
    Vector<b2Body*>& where = is_free(body) ? bodies : others;
    number(body) = static_cast<int>(where.size());
    where.push_back(body);
  };
  for (const Member* m : members) count_in(m->joint->GetBodyA()), count_in(m->joint->GetBodyB());
  for (const BodyPair& pair : met) count_in(pair.a), count_in(pair.b);
  const std::size_t free_bodies = bodies.size();
  Vector<b2Body*> ordered(order.begin(), order.end());
  if (ordered.empty()) {
    Vector<std::pair<int, int>> edges;
    edges.reserve(members.size() + met.size());
    for (const Member* m : members) {
      b2Body *a = m->joint->GetBodyA(), *b = m->joint->GetBodyB();
      if (is_free(a) && is_free(b)) edges.emplace_back(number(a), number(b));
    }
    for (const BodyPair& pair : met) {
      if (is_free(pair.a) && is_free(pair.b)) edges.emplace_back(number(pair.a), number(pair.b));
    }
    ordered.reserve(free_bodies + others.size());
    for (const int i : BlockLdlt::order_for(static_cast<int>(free_bodies), edges))
      ordered.push_back(bodies[z(i)]);
    ordered.insert(ordered.end(), others.begin(), others.end());
  }

  const b2Vec2 near = ordered.front()->GetWorldCenter();
  origin = {std::round(near.x), std::round(near.y)};
  make_room(free_bodies, ordered.size() - free_bodies);
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    number(ordered[i]) = static_cast<int>(i);
    enter(i, *ordered[i]);
  }
  // A contact has two points at most, and some joints may come.
  const std::size_t rows = members.size() + 2 * met.size() + most_changes(16);
  solver.joints.reserve(rows);
  solver.records.reserve(rows);
  for (const BodyPair& pair : met) add_pair(pair, free_bodies);
  admit(0, free_bodies);
}

int Component::index_of(const b2Body* body) const {
  const auto at = place_of(by_address_, body);
  return at != by_address_.end() && at->first == body ? at->second : -1;
}

// Room for so many free bodies before all others, and for so many that are not free after them.
void Component::make_room(std::size_t first, std::size_t last) {
  solver.insert_bodies(first, last);
  const auto insert = [&](auto& of_bodies, const auto& nothing) {
    of_bodies.insert(of_bodies.begin(), first, nothing);
    of_bodies.resize(solver.bodies.size(), nothing);
  };
  insert(mirrors, Mirror{});
  insert(goal_, Pose{});
  insert(account.began, b2Velocity{{0, 0}, 0});  // b2Vec2 does not make itself 0
  insert(account.lost, Vec3{});
  parts_.bodies.insert(parts_.bodies.begin(), first, {});
}

// A body as Box2D has it, without a joint of the component.
void Component::enter(std::size_t i, b2Body& body) {
  const Mirror& mirror = mirrors[i] = Mirror(body);
  const BodyMass& m = mirror.mass;
  const double offset = m.center.LengthSquared();
  solver.bodies[i] = {};
  solver.bodies[i].mass = m.mass;
  solver.bodies[i].inertia = body.IsFixedRotation() ? 0 : m.inertia - m.mass * offset;
  put(solver.places[i], origin.relative(mirror.left));
  solver.bodies[i].v = into_own_frame(solver.places[i].turn, mirror.exact);
}

// What its joints knew of a body: its velocity, and its place if that is still where they left it.
void Component::remember(std::size_t i, const KnownPose& known) {
  mirrors[i].given = known.given;
  Pose at = known.pose;
  // Fixtures came or went.
  const double x = double{mirrors[i].mass.center.x} - known.local_center.x;
  const double y = double{mirrors[i].mass.center.y} - known.local_center.y;
  const Turn turn = turn_of(at.angle);
  at.x += turn.c * x - turn.s * y;
  at.y += turn.s * x + turn.c * y;
  const b2Position left{{static_cast<float>(at.x), static_cast<float>(at.y)}, static_cast<float>(at.angle)};
  if (!same(left, mirrors[i].left)) return;
  put(solver.places[i], {at.x - origin.x, at.y - origin.y, at.angle});
}

void Component::add_pair(const BodyPair& pair, std::size_t free_bodies) {
  const std::pair<int, int> in_order = std::minmax(index_of(pair.a), index_of(pair.b));
  if (z(in_order.second) < free_bodies) solver.pairs.push_back(in_order);
}

// Members from this one on join the others; those bodies that had no joint before are where Box2D has them,
// or where the joints knew them.
void Component::admit(std::size_t first, std::size_t free_bodies) {
  bool held_anew = false;
  for (std::size_t i = first; i < members.size(); ++i) {
    Member& m = *members[i];
    Joint& j = solver.joints.emplace_back(m.own.joint);
    solver.records.push_back(m.own.record);
    solver.drift_time() = std::max(solver.drift_time(), m.own.drift_time);
    solver.moved_by() = std::max(solver.moved_by(), m.own.record.law.h);
    m.belong_to(this);
    m.index = i;
    j.a = index_of(m.joint->GetBodyA());
    j.b = index_of(m.joint->GetBodyB());
    for (unsigned side = 0; side < 2 && !m.own.fresh; ++side) {
      const std::size_t body = z(side == 0 ? j.a : j.b);
      const KnownPose& known = m.own.known[side];
      held_anew |= freedom(body, free_bodies) < known.freedom;
      if (mirrors[body].guest()) remember(body, known);
    }
    // In doubles: what floats round of it changes when the centre of mass does, and would strain rigid rows.
    const b2Vec2 a = m.joint->GetLocalAnchorA(), from_a = m.joint->GetBodyA()->GetLocalCenter();
    const b2Vec2 b = m.joint->GetLocalAnchorB(), from_b = m.joint->GetBodyB()->GetLocalCenter();
    j.frame.ax = double{a.x} - from_a.x, j.frame.ay = double{a.y} - from_a.y;
    j.frame.bx = double{b.x} - from_b.x, j.frame.by = double{b.y} - from_b.y;
  }
  for (std::size_t i = first; i < members.size(); ++i) {
    for (const int body : {solver.joints[i].a, solver.joints[i].b}) mirrors[z(body)].gain_joints(1);
  }
  std::sort(solver.pairs.begin(), solver.pairs.end());
  solver.pairs.erase(std::unique(solver.pairs.begin(), solver.pairs.end()), solver.pairs.end());
  groups_.clear();
  const auto was_solved = [](const Member* m) { return !m->own.fresh; };
  const auto joining = members.begin() + static_cast<std::ptrdiff_t>(first);
  const bool adapts = std::any_of(joining, members.end(), was_solved);  // its impulses, to the step
  solver.form(free_bodies, adapts ? 0 : first);
  solver.locate();
  // A new joint, or a body that may not move any more, holds bodies where they are. If beside it an old joint
  // closed the gaps that turning has opened, they would strain each other.
  const bool hold = held_anew || !std::all_of(joining, members.end(), was_solved);
  for (std::size_t i = hold ? 0 : first; i < members.size(); ++i) {
    Joint& j = solver.joints[i];
    Rows& gap = solver.records[i].gap;
    if (i >= first && std::exchange(members[i]->own.fresh, false)) {
      if (parts(j)) struck_ = mirrors[z(j.a)].thrown = mirrors[z(j.b)].thrown = true;
      for (unsigned row = 0; row < 3; ++row) j.neutral[row] += gap[row];
      if (members[i]->length >= 0) j.neutral[axial] = members[i]->length;
      continue;
    }
    // Bodies that were moved meanwhile return to the gap that the joint last saw. What rounding to
    // floats has moved stays, and strains nothing: rigid rows that are parallel would make much of it.
    const Rows& seen = i >= first ? members[i]->own.record.gap : gap;
    bool moved = false;
    for (unsigned row = 0; row < 3; ++row) moved |= std::abs(gap[row] - seen[row]) > 1e-9;
    for (unsigned row = 0; row < 3 && !moved; ++row) j.neutral[row] += gap[row] - seen[row];
    if (moved) gap = seen;
    displaced_ |= moved;
    if (!hold) continue;
    for (unsigned row = 0; row < 3; ++row) {
      if (j.G[row] > 0 && !is_slack(j, solver.records[i], row))
        j.neutral[row] = gap[row] - elastic_strain(j, solver.records[i], row);
    }
    StepLaws::hold_parted(j, solver.records[i]);
  }
}

// Bodies that it does not know come before all others in the order of elimination, the last of them first: so
// they fill what they hang on, and nothing else.
void Component::join(std::span<Member* const> joining, std::span<const BodyPair> touching) {
  const std::size_t known = mirrors.size();
  Vector<b2Body*> entering;
  const auto see = [&](b2Body* body) {
    const auto at = place_of(by_address_, body);
    if (at != by_address_.end() && at->first == body) return;
    by_address_.insert(at, {body, static_cast<int>(known + entering.size())});
    entering.push_back(body);
  };
  for (const Member* m : joining) see(m->joint->GetBodyA()), see(m->joint->GetBodyB());
  for (const BodyPair& pair : touching) see(pair.a), see(pair.b);

  const auto first = static_cast<std::size_t>(std::count_if(entering.begin(), entering.end(), is_free));
  make_room(first, entering.size() - first);
  std::size_t next_free = first, next_other = known + first;
  Vector<std::size_t> places(entering.size());
  for (std::size_t i = 0; i < entering.size(); ++i) {
    places[i] = is_free(entering[i]) ? --next_free : next_other++;
    enter(places[i], *entering[i]);
  }
  for (auto& [body, number] : by_address_)
    number = static_cast<int>(z(number) < known ? z(number) + first : places[z(number) - known]);

  // What was a guest was elsewhere, maybe.
  for (Member* m : joining) {
    for (b2Body* body : {m->joint->GetBodyA(), m->joint->GetBodyB()}) {
      const std::size_t i = z(index_of(body));
      if (mirrors[i].guest()) enter(i, *body);
    }
    members.push_back(m);
    if (!is_of(*m->structure)) take_in(*m->structure);
  }
  const std::size_t free_bodies = solver.free_bodies() + first, before = members.size() - joining.size();
  for (const BodyPair& pair : touching) {
    met.push_back(pair);
    add_pair(pair, free_bodies);
  }
  admit(before, free_bodies);
  changed_ += joining.size();
  touched_ += touching.size();
  rest_ = Rest::none;
}

void Component::take_in(Structure::Impl& structure) {
  structures.push_back(&structure);
  solver.keeps_ledger |= structure.def.keep_ledger && direct();
}

bool Component::broke_off(std::span<Member* const> leaving) const {
  Vector<int> joints(solver.free_bodies());
  for (const Member* m : leaving) {
    const Joint& j = solver.joints[m->index];
    for (const int body : {j.a, j.b})
      if (solver.is_free(body)) ++joints[z(body)];
  }
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (joints[i] != 0 && joints[i] != mirrors[i].joined) return false;
  return true;
}

void Component::remove(Member& m) {
  Joint& j = solver.joints[m.index];
  hand_back(m);
  m.belong_to(nullptr);
  met.push_back({m.joint->GetBodyA(), m.joint->GetBodyB()});
  ++changed_;
  for (const int body : {j.a, j.b}) mirrors[z(body)].gain_joints(-1);
  solver.remove(m.index);
  members[m.index] = members.back();
  members[m.index]->index = m.index;
  members.pop_back();
  groups_.clear();
  rest_ = Rest::none;
}

// A body's velocity before this step's gravity, in its own frame.
Vec3 Component::came_at(int i) const {
  return into_own_frame(solver.places[z(i)].turn, in_doubles(velocity_of(*mirrors[z(i)].body)));
}

// Whether a new joint's bodies come with velocities that it does not leave them.
bool Component::parts(const Joint& j) const {
  const Rows v = relative_velocity(j, came_at(j.a), came_at(j.b));
  return std::max(std::abs(v[0]), std::abs(v[1])) > double{blow_speed} || std::abs(v[2]) > double{blow_turn};
}

int Component::freedom(std::size_t body, std::size_t free_bodies) const {
  return body >= free_bodies ? 0 : solver.bodies[body].inertia > 0 ? 3 : 2;
}

KnownPose Component::known(int body) const {
  const Pose& p = solver.places[z(body)].pose;
  return {{p.x + origin.x, p.y + origin.y, p.angle},
          mirrors[z(body)].mass.center,
          freedom(z(body), solver.free_bodies()),
          mirrors[z(body)].given};
}

void Component::hand_back(Member& m) const {
  const Joint& j = solver.joints[m.index];
  m.own = {j, solver.records[m.index], solver.drift_time(), {known(j.a), known(j.b)}, m.own.fresh};
  if (m.broken) m.own.joint.impulse = {};
}

bool Component::fits_bodies() const {
  return std::all_of(mirrors.begin(), mirrors.end(), [](const Mirror& m) { return m.guest() || m.fits(); });
}

bool Component::is_of(const Structure::Impl& structure) const {
  return std::find(structures.begin(), structures.end(), &structure) != structures.end();
}

void Component::keep(Tape& tape) {
  bool rests = rest_ != Rest::none;
  tape(origin, formed_of_, changed_, touched_, displaced_, struck_, jam_time_, pieces_jam_, rests, mirrors,
       parts_, solver);
  rest_ = rests ? Rest::expected : Rest::none;
  if (tape.reads()) groups_.clear();
}

}  // namespace ductile::dynamics
