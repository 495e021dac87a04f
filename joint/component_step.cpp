// A step of a component: how it reads and writes the island that it is in. Written against Box2D 2.4.1.
#include "component.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "box2d_private.h"
#include "frames.h"
#include "structure.h"

namespace ductile::dynamics {

bool Component::look(const b2SolverData& data, const IslandContacts& contacts,
                     std::span<const StockJoint> stock) {
  touches.clear();
  ties.clear();
  for (Mirror& m : mirrors) m.present = !m.guest;
  const auto see = [this](const auto& all) {
    for (const auto& t : all) {
      for (const b2Body* body : {t.a(), t.b()}) {
        if (const int i = index_of(body); i >= 0) mirrors[z(i)].present = true;
      }
    }
  };
  see(contacts.touches());
  see(stock);
  bool masses = true;
  alone_ = kind == SolverKind::direct;
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    Mirror& m = mirrors[i];
    if (!m.present) continue;
    if (m.body->GetType() != m.type) return false;
    if (m.type == b2_staticBody) continue;
    m.island_index = of(*m.body, b2Body_m_islandIndex{});
    alone_ &= i >= solver.free_bodies() || only_ours(m);
    if (!at_rest_) take(m, data);  // while the body is at hand
    masses &= m.has_its_mass();
  }
  return masses;
}

// Box2D prepends new joints to a body's list, and one of ours that goes dissolves the component.
bool Component::only_ours(const Mirror& m) {
  return m.body->GetContactList() == nullptr && m.body->GetJointList() == m.joints;
}

// Whether all that touches or holds its bodies is solved with it: then nothing changes their velocities after
// the solve.
bool Component::is_whole() const {
  if (kind != SolverKind::direct || !ties.empty()) return false;
  std::size_t sides = 0;  // of contacts, less those of the touches
  for (const Mirror& m : mirrors) {
    if (!m.present || m.type != b2_dynamicBody) continue;
    if (m.body->GetJointList() != m.joints) return false;
    for (const b2ContactEdge* e = m.body->GetContactList(); e != nullptr; e = e->next)
      sides += e->contact->IsTouching() ? 1 : 0;
  }
  for (const Touch& t : touches) {
    for (const int body : {t.in_a, t.in_b}) sides -= mirrors[z(body)].type == b2_dynamicBody ? 1 : 0;
  }
  return sides == 0;
}

void Component::disturb() {
  at_rest_ = resting = false;
  solver.laws_changed();
}

// What velocities of a structure at rest may differ by, m/s.
float Component::slack() const { return static_cast<float>(Solver::rest_tolerance * solver.impulse_speed()); }

// A structure at rest is brought the same poses and velocities step after step, and answers them with the
// same.
bool Component::as_before(const b2SolverData& data) const {
  if (!at_rest_ || double{data.step.dt} != solver.step()) return false;
  const float slack = this->slack();
  for (const Mirror& m : mirrors) {
    if (!m.present) continue;
    if (m.type == b2_staticBody) {
      if (!same({m.body->GetWorldCenter(), m.body->GetAngle()}, m.left)) return false;
      continue;
    }
    const b2Velocity& v = data.velocities[m.island_index];
    const float change = std::max({std::abs(v.v.x - m.taken.v.x), std::abs(v.v.y - m.taken.v.y),
                                   m.gyration * std::abs(v.w - m.taken.w)});
    if (!(change <= slack + m.rounding) || !same(data.positions[m.island_index], m.left)) return false;
  }
  return true;
}

// The velocity that Box2D brings. Where its floats, bit by bit, are what gravity and damping make of those
// that we gave, so are the doubles: rounded anew in each step, they would shake what swings, and spoil the
// forecast.
void Component::take(Mirror& m, const b2SolverData& data) {
  m.taken = data.velocities[m.island_index];
  m.pushed = {{0, 0}, 0};
  if (m.type != b2_dynamicBody || kind != SolverKind::direct) {
    m.exact = in_doubles(m.given = m.taken);
    return;
  }
  // As b2Island::Solve does it, without forces.
  const b2Vec2& gravity = m.body->GetWorld()->GetGravity();
  const float h = data.step.dt, scale = m.body->GetGravityScale();
  const float damping = m.body->GetLinearDamping(), turn_damping = m.body->GetAngularDamping();
  b2Velocity v = m.given;
  v.v += h * m.inverse_mass * (scale * m.mass * gravity);
  v.v *= 1.0f / (1.0f + h * damping);
  v.w *= 1.0f / (1.0f + h * turn_damping);
  if (v.v == m.taken.v && v.w == m.taken.w) {
    const double weight = double{h} * scale, slower = 1 / (1 + double{h} * damping);
    m.exact = {slower * (m.exact.x + weight * gravity.x), slower * (m.exact.y + weight * gravity.y),
               m.exact.w / (1 + double{h} * turn_damping)};
  } else {
    m.exact = in_doubles(m.taken);
    const b2Vec2 jump = m.body->GetLinearVelocity() - m.given.v;
    const float turn = m.gyration * std::abs(m.body->GetAngularVelocity() - m.given.w);
    struck_ |= !m.guest && std::max(jump.Length(), turn) > blow_speed;
  }
  m.given = m.taken;
}

void Component::first_velocity(const b2SolverData& data) {
  whole_ = alone_ || is_whole();
  resting = ties.empty() && touched_as_before() && as_before(data);
  if (resting) {
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      if (mirrors[i].present) data.velocities[mirrors[i].island_index] = mirrors[i].given;
    }
    return_contacts();
    open = solver.keeps_ledger;  // something may strike it before the step is over
    ++report->resting;
    return;
  }
  if (at_rest_) {
    for (Mirror& m : mirrors) {
      if (m.present && m.type != b2_staticBody) take(m, data);
    }
  }
  set_warm_starts_aside();
  set_ties_aside(data);
  bool moved = std::exchange(parted_, false);
  const auto start_from = [this](std::size_t i) {
    Body& b = solver.bodies[i];
    const Vec3& v = mirrors[i].exact;
    (i < solver.free_bodies() ? b.v_free : b.v) = into_own_frame(solver.places[i].turn, v.x, v.y, v.w);
  };
  for (std::size_t i = 0; i < mirrors.size(); ++i) {
    Mirror& m = mirrors[i];
    if (!m.present) {
      solver.bodies[i].v = solver.bodies[i].v_free = {};
      continue;
    }
    const b2Position at = m.type == b2_staticBody ? b2Position{m.body->GetWorldCenter(), m.body->GetAngle()}
                                                  : data.positions[m.island_index];
    if (m.type == b2_staticBody) m.exact = {};
    if (m.guest && !same(at, m.left)) {
      put(solver.places[i], relative(m.left = at));
    } else {
      moved |= !same(at, m.left);
    }
    start_from(i);
  }
  solver.begin(data.step.dt);
  if (moved) {
    // Continuous collision, SetTransform, a re-enabled body: the structure follows without being strained by
    // it. Joint by joint, the sweeps do that.
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
      Mirror& m = mirrors[i];
      goal[i] = solver.places[i].pose;
      if (m.guest) continue;
      const b2Position at = m.type == b2_staticBody ? b2Position{m.body->GetWorldCenter(), m.body->GetAngle()}
                                                    : data.positions[m.island_index];
      goal[i] = same(at, m.left) ? solver.places[i].pose : relative(at);
      if (m.type == b2_staticBody) m.left = at;
    }
    if (kind == SolverKind::direct) {
      project(true);
    } else {
      solver.sweep_positions(goal);
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
      const b2Velocity v =
          accounts[i].began = {mirrors[i].body->GetLinearVelocity(), mirrors[i].body->GetAngularVelocity()};
      solver.before[i] = into_own_frame(solver.places[i].turn, v.v.x, v.v.y, v.w);
      accounts[i].lost = {{0, 0}, 0};  // b2Vec2 does not make itself 0
    }
    open = true;
  }
  if (kind == SolverKind::iterative) solver.warm_start();
  enter_ties();
  enter_contacts();
  if (kind == SolverKind::direct && is_blow()) solver.strike();
  struck_ = false;
  solve(data);
}

void Component::next_velocity(const b2SolverData& data) {
  if (whole_) {
    ++report->skipped;
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
    const Vec3 change = into_own_frame(solver.places[i].turn, double{now.v.x} - given.v.x,
                                       double{now.v.y} - given.v.y, double{now.w} - given.w);
    solver.push(i, change);
    if (kind == SolverKind::iterative) b.v += change;
    given = now;
  }
  if (touched) resting = false;
  if (touched || kind == SolverKind::iterative) {
    solve(data);
  } else {
    ++report->skipped;
  }
}

// Joints that break in this step hold until they do. A joint whose break somebody may veto holds through it.
bool Component::weaken_what_breaks() {
  if (!solver.struck() || !solver.any_flows() || structure->veto) return false;
  bool any = false;
  for (const Member* m : members) {
    const Joint& j = solver.joints[m->index];
    if (j.regime == 0 || m->broken) continue;
    JointRecord& r = solver.records[m->index];
    double share = 1;
    for (unsigned i = 0; i < 3; ++i) {
      if (!flows(j.regime, i) || !(j.G[i] > 0)) continue;
      const double slip = slip_of(j, r, i), left = m->left(i, slip);
      if (std::abs(slip) > left) share = std::min(share, std::max(left, 0.0) / std::abs(slip));
    }
    if (share < 0.95 * r.held) {
      solver.weaken(m->index, share);
      any = true;
    } else if (r.held < 1) {
      r.held = share;
    }
  }
  return any;
}

void Component::solve(const b2SolverData& data) {
  SolveReport solved;
  if (kind == SolverKind::direct) {
    solver.solve(solved);
    for (int pass = 0; pass < 3 && weaken_what_breaks(); ++pass) solver.solve(solved);
  } else {
    solver.sweep();
  }
  give(data);
  return_contacts();
  return_ties();
  ++report->solves;
  report->rounds += solved.rounds;
  report->factorisations += solved.factorisations;
  report->bounds_hit += solved.unsolved ? 1 : 0;
  report->residual = std::max(report->residual, solved.residual);
}

void Component::project(bool try_goal) {
  const bool kept = solver.project(goal, try_goal);
  report->bounds_hit += kept ? 0 : 1;
  report->parted += kept ? 0 : 1;
  ++report->projections;
}

void Component::give(const b2SolverData& data) {
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    Mirror& m = mirrors[i];
    m.exact = into_world(solver.places[i].turn, solver.bodies[i].v);
    m.given = in_floats(m.exact);
    if (m.present) data.velocities[m.island_index] = m.given;
  }
}

void Component::position(const b2SolverData& data) {
  if (alone_ && !resting) return write_poses(data);
  if (alone_) {
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      if (mirrors[i].present) data.positions[mirrors[i].island_index] = mirrors[i].left;
    }
    return;
  }
  for (const StockJoint& t : ties) let_positions(t);
  bool pushed = false;
  for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
    goal[i] = solver.places[i].pose;
    if (!mirrors[i].present) continue;
    b2Position& at = data.positions[mirrors[i].island_index];
    const bool kept = same(at, mirrors[i].left);
    if (mirrors[i].guest && !kept) {
      put(solver.places[i], goal[i] = relative(mirrors[i].left = at));
      continue;
    }
    goal[i] = kept ? solver.places[i].pose : relative(at);
    pushed |= !kept;
    at = mirrors[i].left;
  }
  if (kind == SolverKind::direct && !pushed) return;
  if (kind == SolverKind::iterative) {
    solver.sweep_positions(goal);
  } else {
    for (std::size_t i = solver.free_bodies(); i < goal.size(); ++i) goal[i] = solver.places[i].pose;
    project(false);
  }
  at_rest_ = false;
  write_poses(data);
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
  bool alone = true;
  if (!alone_) {
    const float slack = this->slack();
    for (std::size_t i = 0; i < solver.free_bodies(); ++i) {
      const Mirror& m = mirrors[i];
      if (!m.present) continue;
      alone &= std::max({std::abs(m.pushed.v.x), std::abs(m.pushed.v.y),
                         m.gyration * std::abs(m.pushed.w)}) <= slack;
    }
  }
  solver.advance();
  bool kinematic = false;
  // Where nothing else moves them, position() tells it, if it is called at all.
  const bool later = alone_ && data.step.positionIterations > 0;
  for (std::size_t i = later ? solver.free_bodies() : 0; i < mirrors.size(); ++i) {
    if (mirrors[i].type != b2_staticBody && mirrors[i].present) mirrors[i].left = box2d_pose(i);
    kinematic |= !mirrors[i].guest && mirrors[i].type != b2_staticBody && i >= solver.free_bodies();
  }
  at_rest_ = kind == SolverKind::direct && ties.empty() && alone && !kinematic && solver.at_rest();
}

}  // namespace ductile::dynamics
