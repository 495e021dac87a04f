#include "ductile/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

namespace ductile {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr long first_timed_step = 10;  // what came before warms the caches up

double usage(double value, double cap) {
  if (cap == unlimited) return nan;
  return cap > 0 ? std::abs(value) / cap : 0;
}

}  // namespace

Simulation::Simulation(Plan plan, JointSolver solver, const Stepping& with, bool ledger)
    : stepping(with),
      plan_(std::move(plan)),
      solver_(solver),
      world_(to_box2d(plan_.gravity)),
      goodbye_(*this) {
  world_.SetAllowSleeping(plan_.sleep);
  world_.SetDestructionListener(&goodbye_);
  if (solver == JointSolver::stock) {
    built_ = build_stock(world_, plan_);
  } else {
    const auto kind = solver == JointSolver::direct ? SolverKind::direct : SolverKind::iterative;
    structure_ = build(world_, plan_, {.solver = kind, .keep_ledger = ledger}, &built_);
    structure_->on_event([this](const JointEvent& event) { record(event); });
  }
  for (std::size_t i = 0; i < built_.joints.size(); ++i) {
    if (built_.joints[i]) index_.emplace(built_.joints[i], i);
  }
  if (ledger && solver != JointSolver::iterative) {
    ledger_.emplace(world_, solver == JointSolver::stock ? std::span<b2Joint* const>(built_.joints)
                                                         : std::span<b2Joint* const>());
  }
}

void Simulation::step() {
  const double dt = stepping.dt;
  const std::vector<AppliedLoad> loads = apply_loads(world_, plan_, built_, time_, dt);
  apply_drives(plan_, built_, time_ + dt / 2);
  if (ledger_) ledger_->before_step(static_cast<float>(dt), loads);
  const auto start = std::chrono::steady_clock::now();
  world_.Step(static_cast<float>(dt), stepping.velocity_iterations, stepping.position_iterations);
  const std::chrono::duration<float, std::micro> took = std::chrono::steady_clock::now() - start;
  time_ += dt;
  last_step_us_ = took.count();
  if (++steps_ >= first_timed_step) step_us_.push_back(last_step_us_);
  if (ledger_) ledger_->after_step(structure());
  if (structure_) structure_->update();
  if (ledger_) ledger_->after_update(structure());
}

void Simulation::record(const JointEvent& event) {
  const auto found = index_.find(event.joint);
  if (found == index_.end()) return;
  const std::size_t index = found->second;
  if (event.kind != JointEvent::flow) {
    events_.push_back({time_, static_cast<int>(index), event.kind, event.mode, event.force, event.energy});
  }
  if (event.kind == JointEvent::broke) {
    JointReading last = joint(index);
    last.N = last.Q = last.M = 0;
    last.usage = {};
    last.broken = true;
    last.broken_at = time_;
    last_readings_.emplace(index, last);
    built_.joints[index] = nullptr;
    index_.erase(found);
  }
}

void Simulation::Goodbye::SayGoodbye(b2Joint* joint) {
  const auto found = simulation_.index_.find(joint);
  if (found == simulation_.index_.end()) return;
  simulation_.built_.joints[found->second] = nullptr;
  simulation_.index_.erase(found);
}

JointReading Simulation::joint(std::size_t index) const {
  if (const auto last = last_readings_.find(index); last != last_readings_.end()) return last->second;
  if (!built_.joints[index]) return {};
  if (solver_ == JointSolver::stock) return read_stock(index);
  const auto& joint = static_cast<const ElasticPlasticJoint&>(*built_.joints[index]);
  const std::optional<DriveDef>& drive = plan_.joints[index].drive;
  return {.N = joint.force(axial),
          .Q = joint.force(shear),
          .M = joint.force(rotation),
          .usage = {joint.usage(axial), joint.usage(shear), joint.usage(rotation)},
          .plastic_rotation = joint.plastic(rotation),
          .accumulated_rotation = joint.accumulated_rotation(),
          .plastic_axial = joint.plastic(axial),
          .plastic_shear = joint.plastic(shear),
          .capacity_used = joint.capacity_used(),
          .dissipated = joint.dissipated(),
          .length = length_of(index),
          .drive = drive ? joint.neutral(drive->row) : nan};
}

double Simulation::length_of(std::size_t index) const {
  if (!plan_.joints[index].end) return nan;
  return (built_.joints[index]->GetAnchorB() - built_.joints[index]->GetAnchorA()).Length();
}

// Box2D tells the force and torque on the second body, in world axes; the internal force is opposite to it.
JointReading Simulation::read_stock(std::size_t index) const {
  if (steps_ == 0) return {};
  const PlannedJoint& planned = plan_.joints[index];
  b2Joint* joint = built_.joints[index];
  const float inv_dt = static_cast<float>(1 / stepping.dt);
  const b2Vec2 force = joint->GetReactionForce(inv_dt);
  // The axis turns with the mean of the two pieces; that of a support stays with the ground.
  const double turn = planned.a < 0 ? 0 : (turn_of(planned.a) + turn_of(planned.b)) / 2;
  const double c = std::cos(turn), s = std::sin(turn);
  Point axis{c * planned.axis.x - s * planned.axis.y, s * planned.axis.x + c * planned.axis.y};
  if (b2Vec2 along = joint->GetAnchorB() - joint->GetAnchorA(); planned.end && along.Normalize() > 0)
    axis = {along.x, along.y};
  JointReading reading;
  reading.length = length_of(index);
  reading.N = -(force.x * axis.x + force.y * axis.y);
  reading.Q = -(-force.x * axis.y + force.y * axis.x);
  reading.M = -joint->GetReactionTorque(inv_dt);
  reading.usage = {usage(reading.N, reading.N >= 0 ? planned.N : planned.Nc), usage(reading.Q, planned.Q),
                   usage(reading.M, reading.M >= 0 ? planned.M : planned.M_reverse)};
  return reading;
}

double Simulation::turn_of(int piece) const {
  const auto i = static_cast<std::size_t>(piece);
  return built_.bodies[i]->GetAngle() - built_.places[i].angle;
}

PieceReading Simulation::piece(std::size_t index) const {
  const b2Body& body = *built_.bodies[index];
  const int piece = static_cast<int>(index);
  const b2Vec2 p = body.GetWorldPoint(local_point(built_, piece, plan_.pieces[index].center));
  const b2Vec2 v = body.GetLinearVelocityFromWorldPoint(p);
  return {{p.x, p.y}, turn_of(piece), {v.x, v.y}, body.GetAngularVelocity()};
}

double Simulation::time_per_step_us() const {
  if (step_us_.empty()) return nan;
  std::vector<float> sorted = step_us_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace ductile
