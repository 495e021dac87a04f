// The joints of a R.U.B.E. scene in Box2D 2.4.1, which has some of them under other names.
#include <box2d/box2d.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "rube_world.h"

namespace ductile::rube {

b2Joint* make_joint(b2World& world, const Item& item, const std::vector<b2Body*>& made,
                    const std::vector<b2Joint*>& others) {
  const std::string type = item.text("type");
  const auto number = [&](const char* key) { return single(item.number(key)); };
  const auto create = [&](auto& def) {
    def.bodyA = made[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    def.collideConnected = item.boolean("collideConnected");
    return world.CreateJoint(&def);
  };
  const auto bodies = [&](auto& def) {
    def.bodyA = made[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    def.localAnchorA = single(item.vector("anchorA"));
    def.localAnchorB = single(item.vector("anchorB"));
  };
  const auto axis = [&] { return single(item.vector(item.has("localAxisA") ? "localAxisA" : "localAxis1")); };
  if (type == "revolute") {
    b2RevoluteJointDef def;
    bodies(def);
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerAngle = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperAngle = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    return create(def);
  }
  if (type == "prismatic") {
    b2PrismaticJointDef def;
    bodies(def);
    def.localAxisA = axis();
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerTranslation = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperTranslation = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorForce = number("maxMotorForce");
    return create(def);
  }
  if (type == "wheel") {
    b2WheelJointDef def;
    bodies(def);
    def.localAxisA = axis();
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    b2LinearStiffness(def.stiffness, def.damping, number("springFrequency"), number("springDampingRatio"),
                      def.bodyA, def.bodyB);
    return create(def);
  }
  if (type == "distance") {
    b2DistanceJointDef def;
    bodies(def);
    def.length = def.minLength = def.maxLength = number("length");
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    if (def.stiffness > 0) {
      def.minLength = 0;
      def.maxLength = std::numeric_limits<float>::max();
    }
    return create(def);
  }
  if (type == "rope") {  // in 2.4 a distance joint that is only ever too long
    b2DistanceJointDef def;
    bodies(def);
    def.minLength = 0;
    def.length = def.maxLength = number("maxLength");
    def.stiffness = def.damping = 0;
    return create(def);
  }
  if (type == "weld") {
    b2WeldJointDef def;
    bodies(def);
    def.referenceAngle = number("refAngle");
    if (number("frequency") > 0)
      b2AngularStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                         def.bodyB);
    return create(def);
  }
  if (type == "friction") {
    b2FrictionJointDef def;
    bodies(def);
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    return create(def);
  }
  if (type == "motor") {
    b2MotorJointDef def;
    def.linearOffset = single(item.vector(item.has("linearOffset") ? "linearOffset" : "anchorA"));
    def.angularOffset = number("refAngle");
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    def.correctionFactor = number("correctionFactor");
    return create(def);
  }
  if (type == "mouse") {
    b2MouseJointDef def;
    def.target = single(item.vector("target"));
    def.maxForce = number("maxForce");
    def.bodyA = made[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    return create(def);
  }
  if (type == "pulley") {
    b2PulleyJointDef def;
    bodies(def);
    def.groundAnchorA = single(item.vector("groundAnchorA"));
    def.groundAnchorB = single(item.vector("groundAnchorB"));
    def.lengthA = number("lengthA");
    def.lengthB = number("lengthB");
    def.ratio = number("ratio");
    return create(def);
  }
  b2GearJointDef def;
  def.joint1 = others[static_cast<std::size_t>(item.integer("joint1", 0, 1 << 30))];
  def.joint2 = others[static_cast<std::size_t>(item.integer("joint2", 0, 1 << 30))];
  def.ratio = number("ratio");
  return create(def);
}

}  // namespace ductile::rube
