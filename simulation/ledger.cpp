#include "ductile/ledger.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace ductile {
namespace {

// The pose from which a body was last moved, in a step or in what is left of it after an impact, is that in
// which its contacts were solved. It is private to b2Body; explicit instantiation may name private members
// ([temp.spec.general]/6).
template <b2Sweep b2Body::*member>
struct Reveal {
  friend const b2Sweep& sweep(const b2Body& body) { return body.*member; }
};
const b2Sweep& sweep(const b2Body& body);
template struct Reveal<&b2Body::m_sweep>;

b2Transform start_of(const b2Sweep& sweep) {
  const b2Rot turn(sweep.a0);
  return {sweep.c0 - b2Mul(turn, sweep.localCenter), turn};
}

double operator*(const Wrench& w, const Speed& v) { return w.x * v.x + w.y * v.y + w.moment * v.turn; }
Wrench operator*(double s, const Wrench& w) { return {s * w.x, s * w.y, s * w.moment}; }
Wrench& operator+=(Wrench& a, const Wrench& b) {
  a.x += b.x;
  a.y += b.y;
  a.moment += b.moment;
  return a;
}
Speed mean(const Speed& a, const Speed& b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2, (a.turn + b.turn) / 2};
}

Speed speed_of(const b2Body& body) {
  const b2Vec2 v = body.GetLinearVelocity();
  return {v.x, v.y, body.GetAngularVelocity()};
}

/// A force or impulse with a lever to the centre of mass.
Wrench acting(const b2Vec2& arm, double x, double y, double moment = 0) {
  return {x, y, arm.x * y - arm.y * x + moment};
}

double inertia(const b2Body& body) {
  return body.GetInertia() - double{body.GetMass()} * body.GetLocalCenter().LengthSquared();
}

double kinetic(const b2Body& body, const Speed& v) {
  return (body.GetMass() * (v.x * v.x + v.y * v.y) + inertia(body) * v.turn * v.turn) / 2;
}

Wrench weight(const b2Body& body, const b2Vec2& gravity) {
  const double m = double{body.GetMass()} * body.GetGravityScale();
  return {m * gravity.x, m * gravity.y};
}

bool is_dynamic(const b2Body& body) { return body.GetType() == b2_dynamicBody; }

template <class List, class Do>
void each(List* list, Do todo) {
  for (; list; list = list->GetNext()) todo(*list);
}

}  // namespace

EnergyLedger::EnergyLedger(b2World& world, std::span<b2Joint* const> judged)
    : world_(world), judged_(judged.begin(), judged.end()) {
  world.SetContactListener(this);
  each(world_.GetBodyList(), [&](b2Body& body) { origins_.emplace(&body, body.GetWorldCenter()); });
  last_ = mechanical();
  start_ = last_ + stored_in_springs();
  after_update(nullptr);
}

double EnergyLedger::mechanical() const {
  double sum = 0;
  for (const b2Body* body = std::as_const(world_).GetBodyList(); body; body = body->GetNext()) {
    if (!is_dynamic(*body)) continue;
    sum += kinetic(*body, speed_of(*body));
    if (const auto origin = origins_.find(body); origin != origins_.end()) {
      const b2Vec2 moved = body->GetWorldCenter() - origin->second;
      sum -= weight(*body, world_.GetGravity()) * Speed{moved.x, moved.y};
    }
  }
  return sum;
}

double EnergyLedger::stored_in_springs() const {
  double sum = 0;
  each(world_.GetJointList(), [&](b2Joint& joint) {
    if (const auto spring = spring_of(joint)) sum += spring->stiffness * spring->strain * spring->strain / 2;
  });
  return sum;
}

void EnergyLedger::before_step(double dt, const std::vector<AppliedLoad>& loads) {
  dt_ = dt;
  motions_.clear();
  holds_.clear();
  each(world_.GetBodyList(), [&](b2Body& body) {
    origins_.emplace(&body, body.GetWorldCenter());
    motions_[&body] = {.place = body.GetWorldCenter(), .before = speed_of(body)};
  });
  each(world_.GetJointList(), [&](b2Joint& joint) {
    const b2Vec2 at = joint.GetAnchorB();  // where prismatic and wheel joints act on both bodies
    holds_[&joint] = {at - joint.GetBodyA()->GetWorldCenter(), at - joint.GetBodyB()->GetWorldCenter(),
                      spring_of(joint)};
  });
  for (const AppliedLoad& load : loads) {
    motions_[load.body].loads +=
        acting(load.at - load.body->GetWorldCenter(), load.force.x, load.force.y, load.moment);
  }
  sums_.external += mechanical() - last_;
}

void EnergyLedger::after_step(const Structure* structure) {
  // A step that was solved in parts moves bodies otherwise than by its last velocities.
  if (structure != nullptr && structure->report().divided > 0) {
    for (auto& [body, motion] : motions_) motion.sub_stepped |= motion.touched;
  }
  each(world_.GetBodyList(), [&](b2Body& body) {
    if (const auto motion = motions_.find(&body); motion != motions_.end()) account(body, motion->second);
  });
  each(world_.GetJointList(), [&](b2Joint& joint) { account(joint); });
  last_ = mechanical();
}

void EnergyLedger::after_update(const Structure* structure) {
  now_ = sums_;
  each(world_.GetBodyList(), [&](b2Body& body) {
    if (is_dynamic(body)) now_.kinetic += kinetic(body, speed_of(body));
  });
  now_.potential = last_ - now_.kinetic;
  now_.elastic = stored_in_springs();
  if (structure) {
    const JointEnergy joints = structure->energy();
    now_.elastic += joints.elastic;
    now_.dissipated = joints.dissipated;
    now_.damping += joints.damping;
    now_.numerical += joints.numerical;
    now_.clamped += joints.clamped;
    now_.external += joints.driven;
    now_.contacts += joints.contacts;
  }
  const double stored = now_.kinetic + now_.potential + now_.elastic;
  const double taken = now_.dissipated + now_.damping + now_.numerical + now_.clamped;
  now_.total_error = stored + taken - now_.external - now_.contacts - start_;
  turnover_ = std::max(turnover_, now_.kinetic + std::abs(now_.potential) + now_.elastic + now_.dissipated +
                                      now_.damping + std::abs(now_.external) + std::abs(now_.contacts));
}

/// Marks what a contact may have moved: the body, and with it its structure.
void EnergyLedger::touch(b2Body& body) {
  std::vector<b2Body*> open{&body};
  while (!open.empty()) {
    b2Body* const next = open.back();
    open.pop_back();
    const auto motion = motions_.find(next);
    if (motion == motions_.end() || std::exchange(motion->second.touched, true) || !is_dynamic(*next))
      continue;
    for (b2JointEdge* edge = next->GetJointList(); edge; edge = edge->next) {
      if (ElasticPlasticJoint::cast(edge->joint)) open.push_back(edge->other);
    }
  }
}

void EnergyLedger::account(b2Body& body, const Motion& motion) {
  if (body.GetType() == b2_kinematicBody) {
    // What a moving body is made to do against contacts, it does to the others.
    const double taken = motion.contacts * speed_of(body);
    sums_.contacts += taken;
    sums_.external -= taken;
  }
  if (!is_dynamic(body) || !body.IsEnabled()) return;
  Speed after = speed_of(body);
  const Speed moving = after;  // what the pose was integrated with
  sums_.clamped += clamped(body, motion, after);
  const Speed middle = mean(motion.before, after);
  sums_.contacts += motion.contacts * middle;

  // Weight and loads work along the way that the body went.
  const Wrench weight_now = weight(body, world_.GetGravity());
  const b2Vec2 way = body.GetWorldCenter() - motion.place;
  const Speed went = motion.sub_stepped ? Speed{way.x / dt_, way.y / dt_, moving.turn} : moving;
  const double by_loads = dt_ * (motion.loads * went);
  sums_.external += by_loads;
  sums_.numerical += by_loads - dt_ * (motion.loads * middle);
  sums_.numerical += dt_ * (weight_now * went) - dt_ * (weight_now * middle);
  if (motion.sub_stepped || is_judged(body)) return;
  // What it moved besides: bodies that overlap are pushed apart, and on to their structure, without any
  // velocity; poses are rounded to floats.
  const double lifted = -(weight_now * Speed{way.x - dt_ * moving.x, way.y - dt_ * moving.y});
  if (motion.touched) {
    sums_.contacts += lifted;
  } else {
    sums_.numerical -= lifted;
  }
}

bool EnergyLedger::is_judged(const b2Body& body) const {
  for (const b2JointEdge* edge = body.GetJointList(); edge; edge = edge->next) {
    if (judged_.contains(edge->joint)) return true;
  }
  return false;
}

/// What a joint exerted on its bodies in the last step, N.
std::pair<Wrench, Wrench> EnergyLedger::reaction(b2Joint& joint, const Hold& hold) const {
  const float inv_dt = static_cast<float>(1 / dt_);
  const b2Vec2 force = joint.GetReactionForce(inv_dt);
  const double moment = joint.GetReactionTorque(inv_dt);
  return {acting(hold.arm_a, -force.x, -force.y, -moment), acting(hold.arm_b, force.x, force.y, moment)};
}

/// Box2D moves a body at most 2 m and π/2 a step, and slows it down to that. `after` becomes what it would
/// have been. A structure sees to its own bodies.
double EnergyLedger::clamped(b2Body& body, const Motion& motion, Speed& after) const {
  const bool fast = std::hypot(after.x, after.y) * dt_ > b2_maxTranslation * (1 - 1e-5);
  const bool turns_fast = std::abs(after.turn) * dt_ > b2_maxRotation * (1 - 1e-5);
  if (!fast && !turns_fast) return 0;
  Wrench impulse = motion.contacts;
  impulse += dt_ * weight(body, world_.GetGravity());
  impulse += dt_ * motion.loads;
  for (b2JointEdge* edge = body.GetJointList(); edge; edge = edge->next) {
    if (ElasticPlasticJoint::cast(edge->joint)) return 0;
    const auto hold = holds_.find(edge->joint);
    if (hold == holds_.end()) continue;
    const auto [on_a, on_b] = reaction(*edge->joint, hold->second);
    impulse += dt_ * (edge->joint->GetBodyA() == &body ? on_a : on_b);
  }
  const Speed slowed = after;
  if (fast) {
    after.x = motion.before.x + impulse.x / body.GetMass();
    after.y = motion.before.y + impulse.y / body.GetMass();
  }
  if (turns_fast && inertia(body) > 0) after.turn = motion.before.turn + impulse.moment / inertia(body);
  return kinetic(body, after) - kinetic(body, slowed);
}

std::optional<EnergyLedger::Spring> EnergyLedger::spring_of(b2Joint& joint) const {
  if (joint.GetType() != e_weldJoint || !judged_.contains(&joint)) return std::nullopt;
  const auto& weld = static_cast<b2WeldJoint&>(joint);
  const b2Body &a = *joint.GetBodyA(), &b = *joint.GetBodyB();
  return Spring{weld.GetStiffness(), weld.GetDamping(),
                double{b.GetAngle()} - a.GetAngle() - weld.GetReferenceAngle(),
                double{b.GetAngularVelocity()} - a.GetAngularVelocity()};
}

void EnergyLedger::account(b2Joint& joint) {
  const auto found = holds_.find(&joint);
  if (found == holds_.end() || ElasticPlasticJoint::cast(&joint)) return;
  const Hold& hold = found->second;
  const bool judged = judged_.contains(&joint);
  const auto work_on = [&](const b2Body& body, const Wrench& force) {
    if (body.GetType() == b2_staticBody) return 0.;
    const Motion& motion = motions_[&body];
    const double work = dt_ * (force * mean(motion.before, speed_of(body)));
    // A joint that is accounted for on its own takes what it takes; what a kinematic body gives it is
    // outside's.
    if (judged) return is_dynamic(body) ? 0. : -work;
    return is_dynamic(body) ? work : 0.;
  };
  const auto [on_a, on_b] = reaction(joint, hold);
  sums_.external += work_on(*joint.GetBodyA(), on_a) + work_on(*joint.GetBodyB(), on_b);
  if (!hold.spring) return;
  // Implicit Euler, as in the ductile joint: R = k e' + c ė', of which R h v̄ is taken from the bodies.
  const auto& [k, c, strain, before] = *hold.spring;
  const double speed = spring_of(joint)->speed, change = dt_ * speed;
  const double R = k * (strain + change) + c * speed;
  sums_.damping += c * speed * change;
  sums_.numerical += k * change * change / 2 + R * dt_ * (before - speed) / 2;
}

void EnergyLedger::PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) {
  b2Fixture &a = *contact->GetFixtureA(), &b = *contact->GetFixtureB();
  const b2Sweep &from_a = sweep(*a.GetBody()), &from_b = sweep(*b.GetBody());
  b2WorldManifold manifold;
  manifold.Initialize(contact->GetManifold(), start_of(from_a), a.GetShape()->m_radius, start_of(from_b),
                      b.GetShape()->m_radius);
  const b2Vec2 normal = manifold.normal, tangent = b2Cross(normal, 1.0f);
  Motion &motion_a = motions_[a.GetBody()], &motion_b = motions_[b.GetBody()];
  touch(*a.GetBody());
  touch(*b.GetBody());
  // One of the two has come to the impact, and both go on from there.
  const bool sub_stepped = from_a.c0 != motion_a.place || from_b.c0 != motion_b.place;
  motion_a.sub_stepped |= sub_stepped;
  motion_b.sub_stepped |= sub_stepped;
  for (int i = 0; i < impulse->count; ++i) {
    const b2Vec2 point = manifold.points[i];
    const double n = impulse->normalImpulses[i], t = impulse->tangentImpulses[i];
    const double x = n * normal.x + t * tangent.x, y = n * normal.y + t * tangent.y;
    motion_a.contacts += acting(point - from_a.c0, -x, -y);
    motion_b.contacts += acting(point - from_b.c0, x, y);
  }
}

}  // namespace ductile
