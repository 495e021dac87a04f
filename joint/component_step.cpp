// A step of a component: how it reads and writes the island that it is in. Written against Box2D 2.4.1.
#include "component.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "box2d_private.h"
#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

// For so long stock joints leave their gaps to Box2D where they were in something's way, s.
constexpr double jam_time = 0.5;

// A sensor, or what PreSolve has disabled, is not in Box2D's island.
bool pushes(const b2Contact& c) { return c.IsTouching() && c.IsEnabled() && !is_sensor(c); }

// Nor are joints whose other body is disabled.
int joints_in_island(const b2Body& body) {
  int count = 0;
  for (const b2JointEdge* e = body.GetJointList(); e != nullptr; e = e->next)
    count += of(*e->joint, b2Joint_m_islandFlag{}) ? 1 : 0;
  return count;
}

}  // namespace

void Component::clear_outside() {
  outside_.touches.clear();
  outside_.near.clear();
  outside_.corners.clear();
  outside_.at_corners.clear();
  outside_.ties.clear();
}

bool Component::find_present() {
  for (Mirror& m : mirrors) m.present = !m.guest(), m.comes = false;
  each_guest([this](int body) { mirrors[z(body)].present = true; });
  for (const Touch& t : outside_.near) {
    for (const int body : {t.in_a, t.in_b}) {
      Mirror& m = mirrors[z(body)];
      if (!m.present && m.type == b2_kinematicBody) m.present = m.comes = true;
    }
  }
  return std::all_of(mirrors.begin(), mirrors.end(), [](const Mirror& m) { return !m.present || m.fits(); });
}

void Component::look(const b2SolverData& data) {
  bool alone = direct();
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    Mirror& m = mirrors[i];
    if (!m.present) continue;
    if (m.type == b2_staticBody) continue;
    m.island_index = of(*m.body, b2Body_m_islandIndex{});
    m.find_joints();
    alone &= i >= solver.free_bodies() || m.only_ours();
    if (parts_.withholds && i < solver.free_bodies() && !same_bits(velocity_of(*m.body), m.given))
      parts_.bodies[i].withheld = {};
    if (rest_ == Rest::none) take(m, data);  // while the body is in the cache
  }
  coupling_ = alone ? Coupling::none : Coupling::partly;
}

// Whether all that touches or holds its bodies is solved with it, but for corners: then nothing else changes
// their velocities after the solve. Bodies count contacts and joints from both sides.
bool Component::is_whole() const {
  if (!direct()) return false;
  int contacts = 0, joints = 0;
  for (const Mirror& m : mirrors) {
    if (!m.present || m.type != b2_dynamicBody) continue;
    if (!m.joins_only_ours()) joints += joints_in_island(*m.body) - m.joined;
    for (const b2ContactEdge* e = m.body->GetContactList(); e != nullptr; e = e->next)
      contacts += pushes(*e->contact) ? 1 : 0;
  }
  const auto sides_of = [this](const auto& all) {
    int sides = 0;
    for (const auto& t : all)
      for (const int body : {t.in_a, t.in_b}) sides += mirrors[z(body)].type == b2_dynamicBody ? 1 : 0;
    return sides;
  };
  return contacts == sides_of(outside_.touches) + sides_of(outside_.corners) &&
         joints == sides_of(outside_.ties);
}

void Component::disturb() {
  rest_ = Rest::none;
  solver.laws_changed();
}

// What velocities of a structure at rest may differ by, m/s.
float Component::slack() const { return static_cast<float>(Solver::rest_tolerance * solver.impulse_speed()); }

// A structure at rest is brought the same poses and velocities step after step, and answers them with the
// same.
bool Component::as_before(const b2SolverData& data) const {
  if (double{data.step.dt} != solver.step()) return false;
  const float slack = this->slack();
  for (const Mirror& m : mirrors) {
    if (!m.present) continue;
    if (!m.stays(m.pose_in(data))) return false;
    if (m.type == b2_staticBody) continue;
    const b2Velocity v = m.velocity_in(data);
    const float change = std::max({std::abs(v.v.x - m.taken.v.x), std::abs(v.v.y - m.taken.v.y),
                                   m.mass.gyration * std::abs(v.w - m.taken.w)});
    if (!(change <= slack + m.rounding)) return false;
  }
  return true;
}

// The velocity that Box2D brings. Where its floats, bit by bit, are what gravity and damping make of those
// that we gave, and what contacts' stored impulses add to that (set_warm_starts_aside()), so are the doubles:
// rounded anew in each step, they would shake what swings or rests, and spoil the forecast.
void Component::take(Mirror& m, const b2SolverData& data) {
  m.taken = m.velocity_in(data);
  m.pushed = {{0, 0}, 0};
  m.jump = std::exchange(m.thrown, false) ? in_doubles(velocity_of(*m.body)) : Vec3{};
  const auto look_for_jump = [&](const b2Velocity& now) {
    const b2Velocity jump{now.v - m.given.v, now.w - m.given.w};
    if (m.guest() || !(jump.v.Length() > blow_speed || std::abs(jump.w) > blow_turn)) return;
    m.jump = in_doubles(jump);
    struck_ = true;
  };
  if (m.type != b2_dynamicBody || !direct()) {
    look_for_jump(m.taken);
    m.exact = in_doubles(m.given = m.taken);
    return;
  }
  // As b2Island::Solve does it, without forces.
  const b2Vec2& gravity = m.body->GetWorld()->GetGravity();
  const float h = data.step.dt, scale = m.body->GetGravityScale();
  const float damping = m.body->GetLinearDamping(), turn_damping = m.body->GetAngularDamping();
  b2Velocity& v = m.expected = m.given;
  v.v += h * m.mass.inverse_mass * (scale * m.mass.mass * gravity);
  v.v *= 1.0f / (1.0f + h * damping);
  v.w *= 1.0f / (1.0f + h * turn_damping);
  const double weight = double{h} * scale, slower = 1 / (1 + double{h} * damping);
  m.alone = {slower * (m.exact.x + weight * gravity.x), slower * (m.exact.y + weight * gravity.y),
             m.exact.w / (1 + double{h} * turn_damping)};
  if (same_bits(v, m.taken)) {
    m.exact = m.alone;
  } else {
    m.exact = in_doubles(m.taken);
    look_for_jump(velocity_of(*m.body));
  }
  m.given = m.taken;
}

void Component::first_velocity(const b2SolverData& data) {
  stepped_ = true;
  blow_ = false;
  struck_contacts_.clear();
  parts_.advanced = false;
  if (!alone() && is_whole())
    coupling_ = outside_.corners.empty() && outside_.ties.empty() ? Coupling::whole : Coupling::nearly;
  const bool expected = std::exchange(rest_, Rest::none) != Rest::none;
  if (expected && outside_.ties.empty() && outside_.near.empty() && touched_as_before() && as_before(data)) {
    rest_ = Rest::kept;
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      if (mirrors[i].present) data.velocities[mirrors[i].island_index] = mirrors[i].given;
    }
    return_contacts();
    account.open = solver.keeps_ledger;  // something may strike it before the step is over
    if (account.open) solver.open_ledger();
    report([](Reports& r) { ++r.step.resting; });
    return;
  }
  if (expected) {
    for (Mirror& m : mirrors) {
      if (m.present && m.type != b2_staticBody) take(m, data);
    }
  }
  set_warm_starts_aside();
  set_ties_aside(data);
  bool moved = std::exchange(displaced_, false);
  const auto start_from = [this](std::size_t i) {
    Body& b = solver.bodies[i];
    (i < solver.free_bodies() ? b.v_free : b.v) = into_own_frame(solver.places[i].turn, mirrors[i].exact);
  };
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    Mirror& m = mirrors[i];
    if (!m.present) {
      solver.bodies[i].v = solver.bodies[i].v_free = m.exact = {};
      continue;
    }
    const b2Position at = m.pose_in(data);
    if (m.type == b2_staticBody) m.exact = {};
    if (m.guest() && !m.stays(at)) {
      put(solver.places[i], origin.relative(m.left = at));
    } else {
      moved |= !m.stays(at);
    }
    start_from(i);
  }
  const bool in_parts = goes_on_in_parts(data);
  if (!in_parts) {
    if (parts_.count > 1) solver.unite(std::exchange(parts_.count, 1));
    parts_.since_blow = 0;
    solver.begin(data.step.dt);
  }
  if (moved) {
    // Continuous collision, SetTransform, a re-enabled body: the structure follows without being strained by
    // it. Joint by joint, the sweeps do that.
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      Mirror& m = mirrors[i];
      goal_[i] = solver.places[i].pose;
      if (m.guest()) continue;
      const b2Position at = m.pose_in(data);
      goal_[i] = m.stays(at) ? solver.places[i].pose : origin.relative(at);
      if (m.type == b2_staticBody) m.left = at;
    }
    if (direct()) {
      project(true);
    } else {
      solver.sweep_positions(goal_);
      solver.begin(data.step.dt);
    }
    write_poses(data);
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      if (mirrors[i].present) start_from(i);
    }
  }
  if (solver.keeps_ledger) {
    // b2Body still has the velocities from before gravity.
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      solver.before[i] = {};
      if (!mirrors[i].present) continue;
      const b2Velocity v = account.began[i] = velocity_of(*mirrors[i].body);
      solver.before[i] = into_own_frame(solver.places[i].turn, in_doubles(v));
      account.lost[i] = {};
    }
    account.open = true;
  }
  if (!direct()) solver.warm_start();
  jam_time_ = std::max(0.0, jam_time_ - double{data.step.dt});
  enter_ties();
  enter_contacts();
  snapped_ = direct() && snaps_hard();
  const bool blow = blow_ = direct() && (snapped_ || is_blow());
  struck_ = false;
  if (in_parts) return solve_in_parts(data, blow);
  const bool meets = direct() && !blow && !outside_.near.empty();
  if (meets && may_divide(data) && strikes_hard()) return solve_in_parts(data, false);
  if (!blow) return solve(data);
  solver.strike(closing());
  solve_direct();
  if (may_divide(data) && (strikes_hard() || strains_much())) return solve_in_parts(data, true);
  remember_blow();
  give(data);
}

void Component::next_velocity(const b2SolverData& data) {
  if (whole()) {
    report([](Reports& r) { ++r.step.skipped; });
    return;
  }
  bool touched = false;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    if (!mirrors[i].present) continue;
    const b2Velocity& now = data.velocities[mirrors[i].island_index];
    b2Velocity& given = mirrors[i].given;
    if (now.v == given.v && now.w == given.w) continue;
    touched = true;
    Body& b = solver.bodies[i];
    mirrors[i].pushed.v += now.v - given.v;
    mirrors[i].pushed.w += now.w - given.w;
    const Vec3 change = into_own_frame(solver.places[i].turn, in_doubles(now) - in_doubles(given));
    solver.push(i, change);
    if (!direct()) b.v += change;
    given = now;
  }
  if (touched) rest_ = Rest::none;
  if (touched || !direct()) {
    solve(data);
  } else {
    report([](Reports& r) { ++r.step.skipped; });
  }
}

// Joints that break in this step hold until they do, and flow no farther. A joint whose break somebody may
// veto holds through it.
bool Component::weaken_what_breaks(bool may_weaken) {
  constexpr double beyond = 1e-6;  // the limit, of the flow, which no rounding loses
  if (!solver.any_flows()) return false;
  bool any = false;
  for (const Member* m : members) {
    const Joint& j = solver.joints[m->index];
    if (j.regime == 0 || m->broken || m->structure->events.veto) continue;
    const JointRecord& r = solver.records[m->index];
    double share = 1;
    for (unsigned i = 0; i < 3; ++i) {
      if (!flows(j.regime, i) || !(j.G[i] > 0)) continue;
      const double slip = slip_of(j, r, i), left = m->limits.left(r.plastic, i, slip);
      if (std::abs(slip) > left) share = std::min(share, std::max(left, 0.0) / std::abs(slip) + beyond);
    }
    if (may_weaken && share < 0.95 * r.held) {
      solver.weaken(m->index, share);
      any = true;
    } else if (share < 1 || r.held < 1) {
      solver.hold(m->index, share);
    }
  }
  return any;
}

void Component::solve(const b2SolverData& data) {
  if (direct()) {
    solve_direct();
  } else {
    solver.sweep();
    report([](Reports& r) { ++r.step.solves; });
  }
  give(data);
}

void Component::solve_direct() {
  SolveReport solved;
  solver.solve(solved);
  if (is_jammed()) {
    jam_time_ = jam_time;
    enter_ties(parts_.count);
    solver.touch(outside_.links, outside_.contacts);
    solver.solve(solved);
  }
  for (int pass = 0; weaken_what_breaks(pass < 3); ++pass) solver.solve(solved);
  report([&solved](Reports& r) {
    StepReport& step = r.step;
    ++step.solves;
    step.rounds += solved.rounds;
    step.factorisations += solved.factorisations;
    step.bounds_hit += solved.unsolved ? 1 : 0;
    step.residual = std::max(step.residual, solved.residual);
  });
}

// Poses move, what flowed is booked, and what a blow left out of it is told.
void Component::move() {
  solver.advance();
  if (const LeftOut& now = solver.left_out(); now.work > 0)
    report([&now](Reports& r) {
      r.left_out.flow = std::max(r.left_out.flow, now.flow);
      r.left_out.work += now.work;
    });
}

void Component::project(bool try_goal) {
  const bool kept = solver.project(goal_, try_goal);
  report([kept](Reports& r) {
    r.step.bounds_hit += kept ? 0 : 1;
    r.step.parted += kept ? 0 : 1;
    ++r.step.projections;
  });
}

void Component::give(const b2SolverData& data) {
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    Mirror& m = mirrors[i];
    m.exact = into_world(solver.places[i].turn, solver.bodies[i].v);
    m.given = in_floats(m.exact);
    if (m.present) data.velocities[m.island_index] = m.given;
  }
  return_contacts();
  return_ties();
}

void Component::position(const b2SolverData& data) {
  if (parts_.advanced) {
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      if (mirrors[i].present) data.velocities[mirrors[i].island_index] = mirrors[i].given;
    }
  }
  if (alone() && !rests()) return write_poses(data);
  if (alone()) {
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      if (mirrors[i].present) data.positions[mirrors[i].island_index] = mirrors[i].left;
    }
    return;
  }
  for (const StockJoint& t : outside_.ties) let_positions(t);
  bool pushed = false;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    goal_[i] = solver.places[i].pose;
    if (!mirrors[i].present) continue;
    b2Position& at = data.positions[mirrors[i].island_index];
    const bool kept = mirrors[i].stays(at);
    if (mirrors[i].guest() && !kept) {
      put(solver.places[i], goal_[i] = origin.relative(mirrors[i].left = at));
      continue;
    }
    goal_[i] = kept ? solver.places[i].pose : origin.relative(at);
    pushed |= !kept;
    at = mirrors[i].left;
  }
  if (direct() && !pushed) return;
  if (!direct()) {
    solver.sweep_positions(goal_);
  } else {
    for (std::size_t i = solver.free_bodies(); i < goal_.size(); ++i) goal_[i] = solver.places[i].pose;
    project(false);
    look_for_jam();
  }
  rest_ = Rest::none;
  write_poses(data);
}

// Whether joints took a push back that overlapping pieces had from Box2D: it would push them in each step,
// for good, and never let them sleep. What has room turns or flows, and stays out.
void Component::look_for_jam() {
  constexpr double taken_back = 0.1;  // of it, what is left at most
  double pushed = 0, went = 0;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    if (!mirrors[i].present || mirrors[i].guest()) continue;
    const Pose from = origin.relative(mirrors[i].left), &to = solver.places[i].pose, &wanted = goal_[i];
    const auto way = [&](const Pose& p) {
      const Body& b = solver.bodies[i];
      const double x = p.x - from.x, y = p.y - from.y, w = p.angle - from.angle;
      return b.mass * (x * x + y * y) + b.inertia * w * w;
    };
    pushed += way(wanted);
    went += way(to);
  }
  pieces_jam_ = went < taken_back * taken_back * pushed;
}

void Component::write_poses(const b2SolverData& data) {
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    if (mirrors[i].present) data.positions[mirrors[i].island_index] = mirrors[i].left = box2d_pose(i);
  }
}

// After the last velocity iteration: poses move, what has flowed is booked. Kinematic bodies are moved by
// Box2D.
void Component::advance(const b2SolverData& data) {
  // Stock joints that come before ours in the list see velocities without our impulses, and take back what
  // they do about it in the iterations that follow: they need those iterations.
  bool unmoved = true;
  if (!alone()) {
    const float slack = this->slack();
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      const Mirror& m = mirrors[i];
      if (!m.present) continue;
      unmoved &= std::max({std::abs(m.pushed.v.x), std::abs(m.pushed.v.y),
                           m.mass.gyration * std::abs(m.pushed.w)}) <= slack;
    }
  }
  move();
  parts_.withholds = false;
  bool kinematic = false;
  // Where nothing else moves them, position() writes their poses, if it is called at all.
  const bool later = alone() && data.step.positionIterations > 0;
  for (std::size_t i = later ? solver.free_bodies() : 0; i < mirrors.size(); ++i) {
    if (mirrors[i].type != b2_staticBody && mirrors[i].present) mirrors[i].left = box2d_pose(i);
    kinematic |= !mirrors[i].guest() && mirrors[i].type != b2_staticBody && i >= solver.free_bodies();
  }
  const bool rests = direct() && outside_.ties.empty() && unmoved && !kinematic && solver.at_rest();
  rest_ = rests ? Rest::expected : Rest::none;
}

}  // namespace ductile::dynamics
