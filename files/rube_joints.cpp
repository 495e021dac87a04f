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
  const auto connect = [&](auto& def) {
    def.bodyA = made[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    def.collideConnected = item.boolean("collideConnected");
  };
  const auto anchor = [&](auto& def) {
    connect(def);
    def.localAnchorA = single(item.vector("anchorA"));
    def.localAnchorB = single(item.vector("anchorB"));
  };
  const auto axis = [&] { return single(item.vector(item.has("localAxisA") ? "localAxisA" : "localAxis1")); };
  if (type == "revolute") {
    b2RevoluteJointDef def;
    anchor(def);
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerAngle = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperAngle = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    return world.CreateJoint(&def);
  }
  if (type == "prismatic") {
    b2PrismaticJointDef def;
    anchor(def);
    def.localAxisA = axis();
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerTranslation = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperTranslation = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorForce = number("maxMotorForce");
    return world.CreateJoint(&def);
  }
  if (type == "wheel") {
    b2WheelJointDef def;
    anchor(def);
    def.localAxisA = axis();
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    b2LinearStiffness(def.stiffness, def.damping, number("springFrequency"), number("springDampingRatio"),
                      def.bodyA, def.bodyB);
    return world.CreateJoint(&def);
  }
  if (type == "distance") {
    b2DistanceJointDef def;
    anchor(def);
    def.length = def.minLength = def.maxLength = number("length");
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    if (def.stiffness > 0) {
      def.minLength = 0;
      def.maxLength = std::numeric_limits<float>::max();
    }
    return world.CreateJoint(&def);
  }
  if (type == "rope") {  // in 2.4 a distance joint that is only ever too long
    b2DistanceJointDef def;
    anchor(def);
    def.minLength = 0;
    def.length = def.maxLength = number("maxLength");
    def.stiffness = def.damping = 0;
    return world.CreateJoint(&def);
  }
  if (type == "weld") {
    b2WeldJointDef def;
    anchor(def);
    def.referenceAngle = number("refAngle");
    if (number("frequency") > 0)
      b2AngularStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                         def.bodyB);
    return world.CreateJoint(&def);
  }
  if (type == "friction") {
    b2FrictionJointDef def;
    anchor(def);
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    return world.CreateJoint(&def);
  }
  if (type == "motor") {
    b2MotorJointDef def;
    connect(def);
    def.linearOffset = single(item.vector(item.has("linearOffset") ? "linearOffset" : "anchorA"));
    def.angularOffset = number("refAngle");
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    def.correctionFactor = number("correctionFactor");
    return world.CreateJoint(&def);
  }
  if (type == "mouse") {
    b2MouseJointDef def;
    connect(def);
    def.target = single(item.vector("target"));
    def.maxForce = number("maxForce");
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    return world.CreateJoint(&def);
  }
  if (type == "pulley") {
    b2PulleyJointDef def;
    anchor(def);
    def.groundAnchorA = single(item.vector("groundAnchorA"));
    def.groundAnchorB = single(item.vector("groundAnchorB"));
    def.lengthA = number("lengthA");
    def.lengthB = number("lengthB");
    def.ratio = number("ratio");
    return world.CreateJoint(&def);
  }
  b2GearJointDef def;
  connect(def);
  def.joint1 = others[static_cast<std::size_t>(item.integer("joint1", 0, 1 << 30))];
  def.joint2 = others[static_cast<std::size_t>(item.integer("joint2", 0, 1 << 30))];
  def.ratio = number("ratio");
  return world.CreateJoint(&def);
}

}  // namespace ductile::rube
