#include "ductile/ledger.h"

#include <algorithm>
#include <cmath>

namespace ductile {
namespace {

double dot(const b2Vec2& a, const b2Vec2& b) { return double{a.x} * b.x + double{a.y} * b.y; }
double cross(const b2Vec2& a, const b2Vec2& b) { return double{a.x} * b.y - double{a.y} * b.x; }

}  // namespace

EnergyLedger::EnergyLedger(b2World& world) : world_(&world) { world.SetContactListener(this); }

void EnergyLedger::before_step(double dt, const std::vector<AppliedLoad>& loads) {
  dt_ = dt;
  const b2Vec2 g = world_->GetGravity();
  if (started_) {
    // Bodies hang higher or lower in a gravity that changes.
    for (const b2Body* b = world_->GetBodyList(); b; b = b->GetNext()) {
      if (b->GetType() != b2_dynamicBody) continue;
      sum_.external -= double{b->GetMass()} * b->GetGravityScale() * dot(g - gravity_, b->GetWorldCenter());
    }
  }
  gravity_ = g;
  before_.clear();
  for (b2Body* b = world_->GetBodyList(); b; b = b->GetNext()) {
    before_[b] = {b->GetLinearVelocity(), b->GetWorldCenter(), b->GetAngularVelocity(), b->IsAwake()};
  }
  if (!started_) {
    started_ = true;
    measure();
    start_ = sum_.kinetic + sum_.potential;
    potential_at_start_ = sum_.potential;
  }
  contacts_.clear();
  own_.clear();
  for (const AppliedLoad& load : loads) {
    const float h = static_cast<float>(dt);
    own_.push_back(
        {nullptr, load.body, h * load.force, {0, 0}, load.at - load.body->GetWorldCenter(), h * load.moment});
  }
  // Stock joints of the world: their impulses are known after the step, their arms now.
  joints_.clear();
  joint_arms_.clear();
  for (b2Joint* j = world_->GetJointList(); j; j = j->GetNext()) {
    if (ElasticPlasticJoint::cast(j) != nullptr) continue;
    b2Body *a = j->GetBodyA(), *b = j->GetBodyB();
    const b2Vec2 at = j->GetAnchorB();
    joints_.push_back(j);
    joint_arms_.push_back({a, b, {0, 0}, at - a->GetWorldCenter(), at - b->GetWorldCenter(), 0});
  }
}

void EnergyLedger::PreSolve(b2Contact* contact, const b2Manifold*) {
  contact->GetWorldManifold(&manifolds_[contact]);
  auto& m = manifolds_[contact];
  // Kept as arms: the bodies will have moved when the impulses are told.
  const b2Vec2 a = contact->GetFixtureA()->GetBody()->GetWorldCenter();
  const b2Vec2 b = contact->GetFixtureB()->GetBody()->GetWorldCenter();
  arms_[contact] = {m.points[0] - a, m.points[0] - b, m.points[1] - a, m.points[1] - b};
}

void EnergyLedger::PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) {
  const auto found = manifolds_.find(contact);
  if (found == manifolds_.end()) return;
  const b2Vec2 n = found->second.normal, t = b2Cross(n, 1.0f);
  const auto& arms = arms_[contact];
  for (int i = 0; i < impulse->count; ++i) {
    contacts_.push_back({contact->GetFixtureA()->GetBody(), contact->GetFixtureB()->GetBody(),
                         impulse->normalImpulses[i] * n + impulse->tangentImpulses[i] * t,
                         arms[static_cast<std::size_t>(2 * i)], arms[static_cast<std::size_t>(2 * i + 1)],
                         0});
  }
}

double EnergyLedger::work(const Push& p) const {
  const auto on = [&](const b2Body* body, const b2Vec2& arm) {
    if (body == nullptr || body->GetType() != b2_dynamicBody) return 0.0;
    const auto found = before_.find(body);
    const Motion then = found != before_.end() ? found->second : Motion{};
    const b2Vec2 v = 0.5f * (then.v + body->GetLinearVelocity());
    const double w = (double{then.w} + body->GetAngularVelocity()) / 2;
    return dot(p.impulse, v) + (body->IsFixedRotation() ? 0 : w * (cross(arm, p.impulse) + p.twist));
  };
  return on(p.b, p.arm_b) - on(p.a, p.arm_a);
}

double EnergyLedger::kinetic(const b2Body& b) {
  const double v2 = dot(b.GetLinearVelocity(), b.GetLinearVelocity()), w = b.GetAngularVelocity();
  const double inertia = double{b.GetInertia()} - b.GetMass() * dot(b.GetLocalCenter(), b.GetLocalCenter());
  return (b.GetMass() * v2 + (b.IsFixedRotation() ? 0 : inertia) * w * w) / 2;
}

void EnergyLedger::measure() {
  sum_.kinetic = sum_.potential = 0;
  for (const b2Body* b = world_->GetBodyList(); b; b = b->GetNext()) {
    if (b->GetType() != b2_dynamicBody) continue;
    sum_.kinetic += kinetic(*b);
    sum_.potential -= double{b->GetMass()} * b->GetGravityScale() * dot(gravity_, b->GetWorldCenter());
  }
}

void EnergyLedger::after_step(const Structure& structure) {
  const float inv_dt = static_cast<float>(1 / dt_);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    // One that was destroyed meanwhile is not looked at.
    bool there = false;
    for (b2Joint* j = world_->GetJointList(); j && !there; j = j->GetNext()) there = j == joints_[i];
    if (!there) continue;
    Push p = joint_arms_[i];
    p.impulse = static_cast<float>(dt_) * joints_[i]->GetReactionForce(inv_dt);
    p.twist = static_cast<float>(dt_) * joints_[i]->GetReactionTorque(inv_dt);
    own_.push_back(p);
  }
  for (const Push& p : own_) sum_.external += work(p);
  for (const Push& p : contacts_) sum_.contacts += work(p);
  for (const b2Body* b = world_->GetBodyList(); b; b = b->GetNext()) {
    const auto found = before_.find(b);
    if (found == before_.end() || b->GetType() != b2_dynamicBody) continue;
    const Motion& then = found->second;
    if (!then.awake && !b->IsAwake()) continue;
    const b2Vec2 weight = b->GetMass() * b->GetGravityScale() * gravity_;
    const b2Vec2 v = b->GetLinearVelocity(), moved = b->GetWorldCenter() - then.c;
    // Gravity pushes the velocity from before the step and lets the body fall with the one after.
    sum_.numerical += dt_ * dot(weight, v - then.v) / 2;
    // What the body moved besides: contacts' pushes, and what they held it back by.
    sum_.contacts -= dot(weight, moved) - dt_ * dot(weight, v);
  }
  measure();
  joints_energy_ = structure.energy();
  sum_.elastic = joints_energy_.elastic;
  const Energy e = energy();
  turnover_ = std::max(turnover_, e.kinetic + e.elastic + e.dissipated + e.damping + std::abs(e.external) +
                                      std::abs(e.contacts) + std::abs(e.potential - potential_at_start_));
}

Energy EnergyLedger::energy() const {
  Energy e = sum_;
  e.dissipated = joints_energy_.dissipated;
  e.damping = joints_energy_.damping;
  e.numerical += joints_energy_.numerical;
  e.clamped = joints_energy_.clamped;
  e.total_error = e.kinetic + e.potential + e.elastic + e.dissipated + e.damping + e.numerical + e.clamped -
                  e.external - e.contacts - start_;
  return e;
}

}  // namespace ductile
