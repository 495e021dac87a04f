// Box2D's own joints in a document (world_archive.h). Written against Box2D 2.4.1.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "reveal.h"
#include "vec3.h"
#include "world_archive.h"

namespace ductile::dynamics {

// Where what a joint carries from step to step ends, and what each step makes anew begins.
DUCTILE_REVEAL(b2RevoluteJoint, m_indexA, int32);
DUCTILE_REVEAL(b2PrismaticJoint, m_indexA, int32);
DUCTILE_REVEAL(b2DistanceJoint, m_indexA, int32);
DUCTILE_REVEAL(b2PulleyJoint, m_indexA, int32);
DUCTILE_REVEAL(b2MouseJoint, m_indexA, int32);
DUCTILE_REVEAL(b2GearJoint, m_localAnchorA, b2Vec2);
DUCTILE_REVEAL(b2GearJoint, m_indexA, int32);
DUCTILE_REVEAL(b2WheelJoint, m_indexA, int32);
DUCTILE_REVEAL(b2WeldJoint, m_indexA, int32);
DUCTILE_REVEAL(b2FrictionJoint, m_indexA, int32);
DUCTILE_REVEAL(b2MotorJoint, m_indexA, int32);
// What of it is not set, or not all of it (clear_unset()).
DUCTILE_REVEAL(b2RevoluteJoint, m_enableMotor, bool);
DUCTILE_REVEAL(b2RevoluteJoint, m_enableLimit, bool);
DUCTILE_REVEAL(b2PrismaticJoint, m_enableLimit, bool);
DUCTILE_REVEAL(b2PrismaticJoint, m_enableMotor, bool);
DUCTILE_REVEAL(b2WheelJoint, m_translation, float);
DUCTILE_REVEAL(b2WheelJoint, m_enableLimit, bool);
DUCTILE_REVEAL(b2WheelJoint, m_enableMotor, bool);
DUCTILE_REVEAL(b2WeldJoint, m_bias, float);
DUCTILE_REVEAL(b2WeldJoint, m_gamma, float);

}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

namespace {

// What a joint carries from step to step are words of four bytes, without addresses, behind b2Joint's own.
std::span<std::byte> words_of(b2Joint& joint) {
  auto* begin = reinterpret_cast<std::byte*>(&joint) + sizeof(b2Joint);
  const auto up_to = [&](int32& end) { return std::span(begin, reinterpret_cast<std::byte*>(&end)); };
  switch (joint.GetType()) {
    case e_revoluteJoint:
      return up_to(of(static_cast<b2RevoluteJoint&>(joint), b2RevoluteJoint_m_indexA{}));
    case e_prismaticJoint:
      return up_to(of(static_cast<b2PrismaticJoint&>(joint), b2PrismaticJoint_m_indexA{}));
    case e_distanceJoint:
      return up_to(of(static_cast<b2DistanceJoint&>(joint), b2DistanceJoint_m_indexA{}));
    case e_pulleyJoint:
      return up_to(of(static_cast<b2PulleyJoint&>(joint), b2PulleyJoint_m_indexA{}));
    case e_mouseJoint:
      return up_to(of(static_cast<b2MouseJoint&>(joint), b2MouseJoint_m_indexA{}));
    case e_gearJoint:
      begin =
          reinterpret_cast<std::byte*>(&of(static_cast<b2GearJoint&>(joint), b2GearJoint_m_localAnchorA{}));
      return up_to(of(static_cast<b2GearJoint&>(joint), b2GearJoint_m_indexA{}));
    case e_wheelJoint:
      return up_to(of(static_cast<b2WheelJoint&>(joint), b2WheelJoint_m_indexA{}));
    case e_weldJoint:
      return up_to(of(static_cast<b2WeldJoint&>(joint), b2WeldJoint_m_indexA{}));
    case e_frictionJoint:
      return up_to(of(static_cast<b2FrictionJoint&>(joint), b2FrictionJoint_m_indexA{}));
    case e_motorJoint:
      return up_to(of(static_cast<b2MotorJoint&>(joint), b2MotorJoint_m_indexA{}));
    default:
      return {};
  }
}

// Some bytes of these words are what memory held, and would make saves of the same world differ: those behind
// flags, and what a joint makes anew in each step, before its first.
void clear_unset(b2Joint& joint, std::span<std::uint32_t> words) {
  const auto* begin = words_of(joint).data();
  const auto place_of = [begin](const auto& member) {
    return static_cast<std::size_t>(reinterpret_cast<const std::byte*>(&member) - begin);
  };
  const auto clear = [&](const auto& member) { words[place_of(member) / sizeof(std::uint32_t)] = 0; };
  const auto clear_behind = [&](const auto&... flags) {
    (clear(flags), ...);
    std::byte* const bytes = std::as_writable_bytes(words).data();
    ((bytes[place_of(flags)] = std::byte{flags}), ...);
  };
  switch (joint.GetType()) {
    case e_revoluteJoint: {
      auto& j = static_cast<b2RevoluteJoint&>(joint);
      return clear_behind(of(j, b2RevoluteJoint_m_enableMotor{}), of(j, b2RevoluteJoint_m_enableLimit{}));
    }
    case e_prismaticJoint: {
      auto& j = static_cast<b2PrismaticJoint&>(joint);
      return clear_behind(of(j, b2PrismaticJoint_m_enableLimit{}), of(j, b2PrismaticJoint_m_enableMotor{}));
    }
    case e_wheelJoint: {
      auto& j = static_cast<b2WheelJoint&>(joint);
      clear(of(j, b2WheelJoint_m_translation{}));
      return clear_behind(of(j, b2WheelJoint_m_enableLimit{}), of(j, b2WheelJoint_m_enableMotor{}));
    }
    case e_weldJoint: {
      auto& j = static_cast<b2WeldJoint&>(joint);
      return clear(of(j, b2WeldJoint_m_bias{})), clear(of(j, b2WeldJoint_m_gamma{}));
    }
    default:
      return;
  }
}

constexpr std::array<const char*, 12> joint_types{"unknown", "revolute", "prismatic", "distance",
                                                  "pulley",  "mouse",    "gear",      "wheel",
                                                  "weld",    "friction", "rope",      "motor"};

}  // namespace

void WorldArchive::stock_joint(Archive& a, b2Joint* joint) {
  std::string type = joint != nullptr ? joint_types[z(joint->GetType())] : "";
  b2Body *first = joint != nullptr ? joint->GetBodyA() : nullptr,
         *second = joint != nullptr ? joint->GetBodyB() : nullptr;
  bool collide = joint != nullptr && joint->GetCollideConnected();
  a("type", type);
  body(a, "a", first);
  body(a, "b", second);
  a("collide_connected", collide);
  if (first == second) a.refuse("b", "is a");
  std::array<b2Joint*, 2> geared{};
  if (type == "gear") {
    const auto* gear = static_cast<b2GearJoint*>(joint);
    if (gear != nullptr)
      geared = {const_cast<b2GearJoint*>(gear)->GetJoint1(), const_cast<b2GearJoint*>(gear)->GetJoint2()};
    for (const unsigned i : {0u, 1u}) {
      const char* key = i == 0 ? "joint1" : "joint2";
      auto number = static_cast<std::uint32_t>(std::find(all_joints.begin(), all_joints.end(), geared[i]) -
                                               all_joints.begin());
      a(key, number);
      if (number >= all_joints.size() || (all_joints[number]->GetType() != e_revoluteJoint &&
                                          all_joints[number]->GetType() != e_prismaticJoint))
        a.refuse(key, "must be the number of a revolute or prismatic joint before this one");
      geared[i] = all_joints[number];
    }
  }
  if (joint == nullptr) {
    const auto kind = std::find(joint_types.begin(), joint_types.end(), type) - joint_types.begin();
    const auto made = [&](auto def) {
      def.bodyA = first, def.bodyB = second, def.collideConnected = collide;
      return world_.CreateJoint(&def);
    };
    switch (kind) {
      case e_revoluteJoint:
        joint = made(b2RevoluteJointDef());
        break;
      case e_prismaticJoint:
        joint = made(b2PrismaticJointDef());
        break;
      case e_distanceJoint:
        joint = made(b2DistanceJointDef());
        break;
      case e_pulleyJoint:
        joint = made(b2PulleyJointDef());
        break;
      case e_mouseJoint:
        joint = made(b2MouseJointDef());
        break;
      case e_gearJoint: {
        b2GearJointDef def;
        def.joint1 = geared[0], def.joint2 = geared[1];
        joint = made(def);
        break;
      }
      case e_wheelJoint:
        joint = made(b2WheelJointDef());
        break;
      case e_weldJoint:
        joint = made(b2WeldJointDef());
        break;
      case e_frictionJoint:
        joint = made(b2FrictionJointDef());
        break;
      case e_motorJoint:
        joint = made(b2MotorJointDef());
        break;
      default:
        a.refuse("type", "is no type of joint");
    }
    all_joints.push_back(joint);
  }
  user_data(a, joint->GetUserData());
  const std::span<std::byte> bytes = words_of(*joint);
  std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
  if (!a.reads()) {
    std::memcpy(words.data(), bytes.data(), bytes.size());
    clear_unset(*joint, words);
  }
  a("words", words);
  if (words.size() * sizeof(std::uint32_t) != bytes.size())
    a.refuse("words", "must be " + std::to_string(bytes.size() / sizeof(std::uint32_t)) + " numbers");
  if (a.reads()) std::memcpy(bytes.data(), words.data(), bytes.size());
}

}  // namespace ductile
