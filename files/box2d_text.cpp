// A plan as JSON: its bodies, and of each joint the stock definition that stands for it, in Box2D 2.4 and 3.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "built_plan.h"
#include "ductile/box2d.h"
#include "ductile/definitions.h"
#include "json.h"

namespace ductile {
namespace {

using Json = nlohmann::ordered_json;

Json json(const b2Vec2& v) { return Json::array({decimal(v.x), decimal(v.y)}); }

Json json(const b2Fixture& fixture) {
  Json object{{"friction", decimal(fixture.GetFriction())},
              {"restitution", decimal(fixture.GetRestitution())},
              {"density", decimal(fixture.GetDensity())},
              {"groupIndex", fixture.GetFilterData().groupIndex}};
  if (fixture.GetType() == b2Shape::e_circle) {
    object["circle"] = decimal(fixture.GetShape()->m_radius);
    object["center"] = json(static_cast<const b2CircleShape&>(*fixture.GetShape()).m_p);
  } else {
    const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
    for (int i = 0; i < polygon.m_count; ++i) object["polygon"].push_back(json(polygon.m_vertices[i]));
  }
  return object;
}

Json json(const b2Body& body, const std::string& name) {
  constexpr const char* types[] = {"static", "kinematic", "dynamic"};
  Json object{{"name", name},
              {"type", types[body.GetType()]},
              {"position", json(body.GetPosition())},
              {"linearVelocity", json(body.GetLinearVelocity())},
              {"angularVelocity", decimal(body.GetAngularVelocity())},
              {"allowSleep", body.IsSleepingAllowed()},
              {"mass", decimal(body.GetMass())},
              {"inertia", decimal(body.GetInertia())},
              {"fixtures", Json::array()}};
  for (const b2Fixture* fixture : fixtures_of(body)) object["fixtures"].push_back(json(*fixture));
  return object;
}

/// The fields of a definition of Box2D 2.4. Angles of all bodies are 0 at first, and so is referenceAngle.
Json fields(const b2WeldJointDef& def) {
  return {{"type", "weld"},
          {"localAnchorA", json(def.localAnchorA)},
          {"localAnchorB", json(def.localAnchorB)},
          {"referenceAngle", decimal(def.referenceAngle)},
          {"stiffness", decimal(def.stiffness)},
          {"damping", decimal(def.damping)}};
}
/// Of a motor that stops at a position; the same in both versions.
void put_limits(Json& object, const b2RevoluteJointDef& def) {
  if (!def.enableLimit) return;
  object["enableLimit"] = true;
  object["lowerAngle"] = decimal(def.lowerAngle);
  object["upperAngle"] = decimal(def.upperAngle);
}

Json fields(const b2RevoluteJointDef& def) {
  Json object{{"type", "revolute"},
              {"localAnchorA", json(def.localAnchorA)},
              {"localAnchorB", json(def.localAnchorB)},
              {"referenceAngle", decimal(def.referenceAngle)},
              {"enableMotor", def.enableMotor},
              {"motorSpeed", decimal(def.motorSpeed)},
              {"maxMotorTorque", decimal(def.maxMotorTorque)}};
  put_limits(object, def);
  return object;
}
Json fields(const b2PrismaticJointDef& def) {
  return {{"type", "prismatic"},
          {"localAnchorA", json(def.localAnchorA)},
          {"localAnchorB", json(def.localAnchorB)},
          {"localAxisA", json(def.localAxisA)},
          {"referenceAngle", decimal(def.referenceAngle)}};
}
Json fields(const b2WheelJointDef& def) {
  return {{"type", "wheel"},
          {"localAnchorA", json(def.localAnchorA)},
          {"localAnchorB", json(def.localAnchorB)},
          {"localAxisA", json(def.localAxisA)},
          {"stiffness", decimal(def.stiffness)},
          {"damping", decimal(def.damping)},
          {"enableMotor", def.enableMotor},
          {"motorSpeed", decimal(def.motorSpeed)},
          {"maxMotorTorque", decimal(def.maxMotorTorque)}};
}
Json fields(const b2DistanceJointDef& def) {
  return {{"type", "distance"},
          {"localAnchorA", json(def.localAnchorA)},
          {"localAnchorB", json(def.localAnchorB)},
          {"length", decimal(def.length)},
          {"minLength", decimal(def.minLength)},
          {"maxLength", decimal(def.maxLength)},
          {"collideConnected", def.collideConnected}};
}
Json fields(const b2MotorJointDef& def) {
  return {{"type", "motor"},
          {"linearOffset", json(def.linearOffset)},
          {"angularOffset", decimal(def.angularOffset)},
          {"maxForce", decimal(def.maxForce)},
          {"maxTorque", decimal(def.maxTorque)},
          {"correctionFactor", decimal(def.correctionFactor)}};
}

/// A frame of Box2D 3, which has these in place of anchors, axis and reference angle: x is the axis.
Json frame(const b2Vec2& anchor, const b2Vec2& axis = {1, 0}) {
  return {{"p", json(anchor)}, {"angle", decimal(std::atan2(axis.y, axis.x))}};
}
template <class Def>
Json frames(const char* type, const Def& def, const b2Vec2& axis = {1, 0}) {
  return {{"type", type},
          {"localFrameA", frame(def.localAnchorA, axis)},
          {"localFrameB", frame(def.localAnchorB, axis)}};
}

/// Box2D 3 asks for frequency and damping ratio where 2.4 has stiffness and damping; both of the reduced
/// inertia I = I_a I_b/(I_a + I_b), as b2AngularStiffness has it.
Json fields_3(const b2WeldJointDef& def, const Plan& plan, const PlannedJoint& j) {
  Json object = frames("weld", def);
  const double I = reduced_inertia(plan, j);
  const bool soft = j.stiffness.M < unlimited && I > 0;
  object["linearHertz"] = 0;
  object["angularHertz"] = soft ? std::sqrt(j.stiffness.M / I) / (2 * std::numbers::pi) : 0;
  object["angularDampingRatio"] = soft ? j.damping_ratio : 0;
  return object;
}
Json fields_3(const b2RevoluteJointDef& def, const Plan&, const PlannedJoint&) {
  Json object = frames("revolute", def);
  object["enableMotor"] = def.enableMotor;
  object["motorSpeed"] = decimal(def.motorSpeed);
  object["maxMotorTorque"] = decimal(def.maxMotorTorque);
  put_limits(object, def);
  return object;
}
Json fields_3(const b2DistanceJointDef& def, const Plan&, const PlannedJoint&) {
  Json object = frames("distance", def);
  object["length"] = decimal(def.length);
  object["enableSpring"] = object["enableLimit"] = def.minLength < def.maxLength;  // a spring of no stiffness
  object["hertz"] = 0;
  object["minLength"] = decimal(def.minLength);
  object["maxLength"] = decimal(def.maxLength);
  object["collideConnected"] = def.collideConnected;
  return object;
}
Json fields_3(const b2PrismaticJointDef& def, const Plan&, const PlannedJoint&) {
  return frames("prismatic", def, def.localAxisA);
}
Json fields_3(const b2WheelJointDef& def, const Plan&, const PlannedJoint&) {
  Json object = frames("wheel", def, def.localAxisA);
  object["enableSpring"] = false;
  return object;
}
Json fields_3(const b2MotorJointDef&, const Plan&, const PlannedJoint&) {
  return nullptr;  // its motor joint drives velocities, and holds no angle
}

Json json(const Plan& plan, const PlannedJoint& j) {
  const auto name = [&](int piece) { return piece < 0 ? "ground" : plan.carrier(piece).name; };
  Json object{{"name", j.name}, {"bodyA", name(j.a)}, {"bodyB", name(j.b)}};
  const auto put = [&](const char* role, const auto& def, const std::vector<std::string>& lost) {
    object[role] = {{"2.4", fields(def)}, {"3", fields_3(def, plan, j)}, {"lost", lost}};
  };
  const auto stock = stock_def(plan, j);
  if (!stock) {
    object["holds"] = nullptr;  // every row is free
    return object;
  }
  std::visit([&](const auto& def) { put("holds", def, lost_in_stock(j)); }, *stock);
  const double moment = std::min(j.M, j.M_reverse);
  if (std::holds_alternative<b2WeldJointDef>(*stock) && moment > 0 && moment < unlimited)
    put("yields", hinge_def(plan, j), lost_in_hinge(j));
  return object;
}

Json wheel(const b2WheelJoint& joint, const Plan& plan, const Plan::Wheel& wheel) {
  const auto name = [&](int piece) { return plan.carrier(piece).name; };
  b2WheelJointDef def;
  def.localAnchorA = joint.GetLocalAnchorA();
  def.localAnchorB = joint.GetLocalAnchorB();
  def.localAxisA = joint.GetLocalAxisA();
  def.stiffness = joint.GetStiffness();
  def.damping = joint.GetDamping();
  def.enableMotor = joint.IsMotorEnabled();
  def.motorSpeed = joint.GetMotorSpeed();
  def.maxMotorTorque = joint.GetMaxMotorTorque();
  Json of_3 = frames("wheel", def, def.localAxisA);
  of_3["enableSpring"] = true;
  of_3["hertz"] = wheel.def.frequency;
  of_3["dampingRatio"] = wheel.def.damping_ratio;
  of_3["enableMotor"] = def.enableMotor;
  of_3["motorSpeed"] = decimal(def.motorSpeed);
  of_3["maxMotorTorque"] = decimal(def.maxMotorTorque);
  return {{"name", name(wheel.chassis) + "-" + name(wheel.wheel)},
          {"bodyA", name(wheel.chassis)},
          {"bodyB", name(wheel.wheel)},
          {"2.4", fields(def)},
          {"3", std::move(of_3)}};
}

}  // namespace

std::string box2d_text(const Plan& plan) {
  const BuiltPlan built(plan);
  Json object{{"gravity", json(to_box2d(plan.gravity))},
              {"bodies", Json::array()},
              {"joints", Json::array()},
              {"wheels", Json::array()},
              {"lost", lost_in_definitions(plan)}};
  for (const int piece : built.carriers) {
    const auto i = static_cast<std::size_t>(piece);
    object["bodies"].push_back(json(*built.built.bodies[i], plan.pieces[i].name));
  }
  if (built.built.ground) object["bodies"].push_back(json(*built.built.ground, "ground"));
  for (const PlannedJoint& j : plan.joints) object["joints"].push_back(json(plan, j));
  for (std::size_t i = 0; i < plan.wheels.size(); ++i)
    object["wheels"].push_back(wheel(*built.built.wheels[i], plan, plan.wheels[i]));
  return printed(object);
}

}  // namespace ductile
