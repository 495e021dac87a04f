#include "box2d_joints.h"

#include <algorithm>
#include <limits>

#include "box2d_private.h"
#include "reveal.h"

namespace ductile::dynamics {

#define DUCTILE_REVEAL_MASSES(Class)        \
  DUCTILE_REVEAL(Class, m_invMassA, float); \
  DUCTILE_REVEAL(Class, m_invMassB, float); \
  DUCTILE_REVEAL(Class, m_invIA, float);    \
  DUCTILE_REVEAL(Class, m_invIB, float)
DUCTILE_REVEAL_MASSES(b2RevoluteJoint);
DUCTILE_REVEAL(b2RevoluteJoint, m_K, b2Mat22);
DUCTILE_REVEAL(b2RevoluteJoint, m_axialMass, float);
DUCTILE_REVEAL_MASSES(b2PrismaticJoint);
DUCTILE_REVEAL(b2PrismaticJoint, m_K, b2Mat22);
DUCTILE_REVEAL(b2PrismaticJoint, m_axialMass, float);
DUCTILE_REVEAL_MASSES(b2DistanceJoint);
DUCTILE_REVEAL(b2DistanceJoint, m_mass, float);
DUCTILE_REVEAL(b2DistanceJoint, m_softMass, float);
DUCTILE_REVEAL_MASSES(b2WheelJoint);
DUCTILE_REVEAL(b2WheelJoint, m_mass, float);
DUCTILE_REVEAL(b2WheelJoint, m_motorMass, float);
DUCTILE_REVEAL(b2WheelJoint, m_axialMass, float);
DUCTILE_REVEAL(b2WheelJoint, m_springMass, float);
DUCTILE_REVEAL_MASSES(b2WeldJoint);
DUCTILE_REVEAL(b2WeldJoint, m_mass, b2Mat33);
DUCTILE_REVEAL(b2MouseJoint, m_mass, b2Mat22);
DUCTILE_REVEAL(b2MouseJoint, m_invMassB, float);
DUCTILE_REVEAL(b2MouseJoint, m_invIB, float);
DUCTILE_REVEAL_MASSES(b2PulleyJoint);
DUCTILE_REVEAL(b2PulleyJoint, m_mass, float);
#undef DUCTILE_REVEAL_MASSES

namespace {

// A mass beside which all others are none. Box2D makes an infinite bias of a limit that is as good as none,
// as maxLength is by default, and 0 times that is no number.
constexpr float nothing = std::numeric_limits<float>::min();

float no_mass(float lower, float upper) { return std::max(-lower, upper) < 1e30f ? 0 : nothing; }

// What its iterations of velocities multiply the error with.
void clear(b2RevoluteJoint& j, float&) {
  of(j, b2RevoluteJoint_m_K{}).SetZero();
  of(j, b2RevoluteJoint_m_axialMass{}) = no_mass(j.GetLowerLimit(), j.GetUpperLimit());
}
void clear(b2PrismaticJoint& j, float&) {
  of(j, b2PrismaticJoint_m_K{}).SetZero();
  of(j, b2PrismaticJoint_m_axialMass{}) = no_mass(j.GetLowerLimit(), j.GetUpperLimit());
}
void clear(b2DistanceJoint& j, float& position_mass) {
  float& mass = of(j, b2DistanceJoint_m_mass{});
  if (mass > nothing) position_mass = mass;
  mass = no_mass(j.GetMinLength(), j.GetMaxLength());
  of(j, b2DistanceJoint_m_softMass{}) = 0;
}
void clear(b2WheelJoint& j, float&) {
  of(j, b2WheelJoint_m_mass{}) = of(j, b2WheelJoint_m_springMass{}) = 0;
  of(j, b2WheelJoint_m_motorMass{}) = 0;
  of(j, b2WheelJoint_m_axialMass{}) = no_mass(j.GetLowerLimit(), j.GetUpperLimit());
}
void clear(b2WeldJoint& j, float&) { of(j, b2WeldJoint_m_mass{}).SetZero(); }
void clear(b2MouseJoint& j, float&) { of(j, b2MouseJoint_m_mass{}).SetZero(); }
void clear(b2PulleyJoint& j, float&) { of(j, b2PulleyJoint_m_mass{}) = 0; }

template <class... Tag, class Joint>
void clear_all(Joint& j, Tag... tag) {
  ((of(j, tag) = 0), ...);
}

// NOLINTBEGIN(bugprone-macro-parentheses): names of types
#define DUCTILE_HOLD_STILL(Class)                                                                   \
  void hold_still(Class& j) {                                                                       \
    clear_all(j, Class##_m_invMassA{}, Class##_m_invMassB{}, Class##_m_invIA{}, Class##_m_invIB{}); \
  }
DUCTILE_HOLD_STILL(b2RevoluteJoint)
DUCTILE_HOLD_STILL(b2PrismaticJoint)
DUCTILE_HOLD_STILL(b2DistanceJoint)
DUCTILE_HOLD_STILL(b2WheelJoint)
DUCTILE_HOLD_STILL(b2WeldJoint)
DUCTILE_HOLD_STILL(b2PulleyJoint)
#undef DUCTILE_HOLD_STILL
// NOLINTEND(bugprone-macro-parentheses)
void hold_still(b2MouseJoint& j) { clear_all(j, b2MouseJoint_m_invMassB{}, b2MouseJoint_m_invIB{}); }

}  // namespace

bool is_stock(b2Joint& joint) {
  return of(joint, b2Joint_m_islandFlag{}) && joint.IsEnabled() && as_it_is(joint, [](auto&) {});
}

void hand_back(StockJoint& stock, std::span<const Link> links) {
  const StockRows& rows = stock.rows;
  for (std::size_t k = 0; k < rows.channel_count; ++k) {
    const Channel& c = rows.channels[k];
    const Rows& from = links[c.link].impulse;
    const double impulse = c.sense[0] * from[0] + c.sense[1] * from[1] + c.sense[2] * from[2];
    *c.impulse = static_cast<float>(c.one_sided ? std::max(0.0, impulse) : impulse);
  }
  as_it_is(*stock.joint, [&](auto& j) {
    clear(j, stock.position_mass);
    if (rows.near) hold_still(j);
  });
}

void let_positions(const StockJoint& stock) {
  if (stock.joint->GetType() != e_distanceJoint || stock.rows.near) return;
  of(static_cast<b2DistanceJoint&>(*stock.joint), b2DistanceJoint_m_mass{}) = stock.position_mass;
}

}  // namespace ductile::dynamics
