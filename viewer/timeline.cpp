#include "timeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "ductile/colours.h"

namespace ductile::viewer {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // which Clang 14 does not find by itself

std::optional<Crossing> crossing(const std::vector<Timeline::Entry>& acts, const Frame& frame) {
  std::size_t box = 0;  // of Frame::thrown
  for (const Timeline::Entry& entry : acts) {
    if (std::holds_alternative<act::Throw>(entry.act)) ++box;
    const auto* vehicle = std::get_if<act::Vehicle>(&entry.act);
    if (!vehicle) continue;
    if (box >= frame.thrown.size()) return std::nullopt;  // it has not come yet
    const Pose& pose = frame.thrown[box];
    const double way = vehicle->to - vehicle->at.x, depth = vehicle->lowest - pose.position.y;
    Crossing found{.share = std::clamp((pose.position.x - vehicle->at.x) / way, 0., 1.)};
    if (std::cos(pose.angle) < 0 || depth > vehicle->size / 2) {
      found.state = Crossing::State::down;
    } else if (found.share == 1) {
      found.state = Crossing::State::across;
    }
    return found;
  }
  return std::nullopt;
}

}  // namespace

Timeline::Timeline(Plan plan, JointSolver solver, std::vector<Entry> acts, std::size_t memory)
    : simulation_(std::make_unique<Simulation>(std::move(plan), solver, Stepping{}, true)),
      acts_(std::move(acts)),
      memory_(memory) {
  arrive();
}

Stepping Timeline::stepping() const {
  Stepping stepping;
  for (const Entry& entry : acts_) {
    if (entry.step > cursor_) break;
    if (const auto* set = std::get_if<act::Set>(&entry.act)) stepping = set->stepping;
  }
  return stepping;
}

const Frame* Timeline::kept(long step) const {
  return step >= first_kept_ && step <= last_kept() ? &frames_[static_cast<std::size_t>(step - first_kept_)]
                                                    : nullptr;
}

std::vector<act::Throw> Timeline::thrown() const {
  std::vector<act::Throw> list;
  for (const Entry& entry : acts_) {
    if (const auto* thrown = std::get_if<act::Throw>(&entry.act)) list.push_back(*thrown);
    if (const auto* vehicle = std::get_if<act::Vehicle>(&entry.act)) {
      for (const act::Throw& part : act::parts(*vehicle)) list.push_back(part);
    }
  }
  return list;
}

void Timeline::seek(long step) {
  goal_ = std::max(0L, step);
  if (kept(goal_)) cursor_ = goal_;
}

bool Timeline::work(double seconds) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(std::min(seconds, 1e6));
  while (busy()) {
    if (goal_ < first_kept_) {
      frames_.clear();
      used_ = 0;
      first_kept_ = cursor_ = 0;
      start_again();
    } else {
      const bool seen_before = behind();
      simulation_->step();
      arrive();
      if (!seen_before) cursor_ = last_kept();
    }
    seek(goal_);
    if (Clock::now() >= end) break;
  }
  return !busy();
}

double Timeline::progress() const {
  const double aim = static_cast<double>(std::max(goal_, last_kept()));
  return busy() && aim > 0 ? static_cast<double>(simulation_->steps()) / aim : 1;
}

void Timeline::go_to(long step) {
  seek(step);
  work(std::numeric_limits<double>::infinity());
}

void Timeline::act(const Act& what) {
  const auto later = [this](const auto& entry) { return entry.step > cursor_; };
  std::erase_if(acts_, later);
  std::erase_if(events_, later);
  acts_.push_back({cursor_, what});
  goal_ = last_known_ = cursor_;
  while (last_kept() > cursor_) {
    used_ -= frames_.back().size();
    frames_.pop_back();
  }
  if (simulation_->steps() > cursor_) {
    start_again();  // work() brings it back to the cursor
  } else if (simulation_->steps() == cursor_) {
    apply(what);
    keep();
  }
}

void Timeline::start_again() {
  thrown_.clear();
  hand_ = nullptr;
  grip_ = nullptr;
  events_told_ = 0;
  simulation_ = std::make_unique<Simulation>(plan(), solver(), Stepping{}, true);
  arrive();
}

// The world has come to a step: what belongs to it is done, and what there is to see is kept.
void Timeline::arrive() {
  for (const Entry& entry : acts_) {
    if (entry.step == simulation_->steps()) apply(entry.act);
  }
  keep();
}

void Timeline::keep() {
  const long step = simulation_->steps();
  for (; events_told_ < simulation_->events().size(); ++events_told_) {
    if (step > last_known_) events_.push_back({step, simulation_->events()[events_told_]});
  }
  last_known_ = std::max(last_known_, step);
  if (step < last_kept()) return;

  Frame frame = see(*simulation_);
  for (const b2Body* body : thrown_) {
    frame.thrown.push_back({{body->GetWorldCenter().x, body->GetWorldCenter().y}, body->GetAngle()});
  }
  for (std::size_t i = 0; i < frame.joints.size(); ++i) {
    const auto now = static_cast<float>(stage(frame.joints[i]));
    frame.peaks.push_back(frames_.empty() ? now : std::max(now, frames_.back().peaks[i]));
  }
  frame.crossing = frames_.empty() ? std::nullopt : frames_.back().crossing;
  if (!frame.crossing || frame.crossing->state == Crossing::State::on_its_way)
    frame.crossing = crossing(acts_, frame);
  if (step == last_kept()) {
    used_ -= frames_.back().size();
    frames_.pop_back();
  }
  used_ += frame.size();
  frames_.push_back(std::move(frame));
  while (used_ > memory_ && frames_.size() > 1) {
    used_ -= frames_.front().size();
    frames_.pop_front();
    ++first_kept_;
  }
}

std::array<act::Throw, 3> act::parts(const Vehicle& vehicle) {
  const double wheel = vehicle.size / 2, half = vehicle.size / 2;
  const Point axle = vehicle.at + Point{0, wheel / 2};
  const double share = 0.1;
  Throw box{.at = axle + Point{0, 0.2 * vehicle.size},
            .mass = (1 - 2 * share) * vehicle.mass,
            .size = 1.2 * vehicle.size,
            .square = true,
            .flat = 1. / 3};
  const Throw left{.at = axle - Point{half, 0}, .mass = share * vehicle.mass, .size = wheel};
  Throw right = left;
  right.at = axle + Point{half, 0};
  return {box, left, right};
}

b2Body& Timeline::add(const act::Throw& thrown) {
  b2BodyDef def;
  def.type = b2_dynamicBody;
  def.position = to_box2d(thrown.at);
  def.linearVelocity = to_box2d(thrown.velocity);
  def.bullet = true;
  def.allowSleep = plan().sleep;
  const auto half = static_cast<float>(thrown.size / 2);
  b2PolygonShape square;
  square.SetAsBox(half, static_cast<float>(thrown.flat) * half);
  b2CircleShape disc;
  disc.m_radius = half;
  b2FixtureDef fixture;
  fixture.shape = thrown.square ? static_cast<const b2Shape*>(&square) : &disc;
  b2MassData unit;
  fixture.shape->ComputeMass(&unit, 1);
  fixture.density = static_cast<float>(thrown.mass) / unit.mass;
  fixture.friction = 0.3f;
  thrown_.push_back(simulation_->world().CreateBody(&def));
  thrown_.back()->CreateFixture(&fixture);
  return *thrown_.back();
}

void Timeline::apply(const Act& what) {
  b2World& world = simulation_->world();
  const auto release = [&] {
    if (grip_) world.DestroyJoint(grip_);
    grip_ = nullptr;
  };
  std::visit(
      Overloaded{
          [&](const act::Grab& grab) {
            release();
            b2Body* body = grab.piece >= 0 ? simulation_->built().bodies[static_cast<std::size_t>(grab.piece)]
                                           : thrown_[static_cast<std::size_t>(grab.thrown)];
            if (body->GetType() != b2_dynamicBody) return;
            if (!hand_) {
              const b2BodyDef def;
              hand_ = world.CreateBody(&def);
            }
            b2MouseJointDef def;
            def.bodyA = hand_;
            def.bodyB = body;
            def.target = to_box2d(grab.at);
            def.maxForce = static_cast<float>(grab.strength) * body->GetMass();
            b2LinearStiffness(def.stiffness, def.damping, 5, 0.7f, hand_, body);  // as Box2D's testbed
            grip_ = world.CreateJoint(&def);
            body->SetAwake(true);
          },
          [&](const act::Pull& pull) {
            if (grip_) static_cast<b2MouseJoint*>(grip_)->SetTarget(to_box2d(pull.to));
          },
          [&](const act::Release&) { release(); },
          [&](const act::Throw& thrown) { add(thrown); },
          [&](const act::Vehicle& vehicle) {
            const std::array parts = act::parts(vehicle);
            b2Body& box = add(parts[0]);
            for (const std::size_t i : {1, 2}) {
              b2Body& wheel = add(parts[i]);
              wheel.GetFixtureList()->SetFriction(1);
              b2WheelJointDef def;
              def.Initialize(&box, &wheel, wheel.GetPosition(), {0, 1});
              b2LinearStiffness(def.stiffness, def.damping, 4, 0.7f, &box, &wheel);  // as Box2D's testbed
              // Both wheels together push with at most 0.4 of its weight on earth: less than what tips it
              // back.
              const double radius = parts[i].size / 2;
              def.enableMotor = true;
              def.motorSpeed = static_cast<float>(-vehicle.speed / radius);
              def.maxMotorTorque = static_cast<float>(0.2 * 9.81 * vehicle.mass * radius);
              world.CreateJoint(&def);
            }
          },
          [&](const act::Drive& drive) {
            float brake = 0;
            for (const Plan::Wheel& wheel : plan().wheels) {
              brake = std::max(brake, static_cast<float>(wheel.def.motor_torque));
            }
            for (std::size_t i = 0; i < plan().wheels.size(); ++i) {
              const WheelDef& def = plan().wheels[i].def;
              b2WheelJoint& wheel = *simulation_->built().wheels[i];
              wheel.SetMotorSpeed(static_cast<float>(drive.direction * def.motor_speed));
              wheel.SetMaxMotorTorque(drive.direction == 0 ? brake : static_cast<float>(def.motor_torque));
            }
          },
          [&](const act::Set& set) { simulation_->stepping = set.stepping; },
      },
      what);
}

}  // namespace ductile::viewer
