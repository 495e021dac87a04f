// Breakable elastic-plastic joints inside unmodified Box2D 2.4.1, and the structure that solves them
// together.
//
// Three rows act in the joint's own frame, whose axis runs from body A to body B and which turns with the
// mean of the two bodies (with the other one where one is static):
//   axial     u along the axis           N > 0 in tension
//   shear     v to the left of the axis  Q > 0 pushes B to the right
//   rotation  θ of B against A           M > 0 when B is bent counter-clockwise against A: the right is in
//   tension
// Each row is a spring (or rigid, or free) in series with a slider at its cap: below the cap it is elastic,
// at the cap it flows and its neutral position moves along. What has flowed adds up, and a joint breaks where
// that exceeds its maximum. SI units. Nothing here throws or, in the steady state, allocates inside
// b2World::Step.
#pragma once

#include <box2d/box2d.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace ductile {

/// A cap or a maximum that is never reached.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// The stiffness of a row that is as stiff as the step can integrate.
inline constexpr double rigid = std::numeric_limits<double>::infinity();

class ElasticPlasticJoint;
class Structure;

enum Row : int { axial, shear, rotation };

/// The law of one row.
struct RowDef {
  double stiffness = rigid;  ///< k, N/m or N m/rad; > 0
  double damping_ratio =
      0;  ///< ζ ≥ 0: c = 2ζ√(k·m_eff), m_eff the row's effective mass; no effect when rigid
  double cap = unlimited;  ///< F⁺ ≥ 0, N or N m: tension, left shear, counter-clockwise moment; 0: free
  double cap_reverse = unlimited;  ///< F⁻ ≥ 0, as a positive number
  double hardening = 0;            ///< stiffness after yield, N/m or N m/rad; ≥ 0, below `stiffness`

  /// A row that carries nothing: a pin is rotation = free(), a roller axial = free().
  static constexpr RowDef free() { return {.cap = 0, .cap_reverse = 0}; }
  /// A row of cap ±k·displacement: "max force given by a maximum elastic displacement or rotation".
  static constexpr RowDef elastic_up_to(double k, double displacement) {
    return {.stiffness = k, .cap = k * displacement, .cap_reverse = k * displacement};
  }
};

/// A point of an N–M interaction curve: N in tension positive, M as the joint's.
struct AxialMoment {
  double N = 0, M = 0;
};

/// Definition of an elastic-plastic joint, as a b2WeldJointDef is of a weld.
struct ElasticPlasticJointDef : b2JointDef {
  /// Anchor in world coordinates; the axis runs from body A's centre of mass to the anchor (the paper's
  /// r_anc), or along body A's x axis where the two coincide.
  void Initialize(b2Body* bodyA, b2Body* bodyB, const b2Vec2& anchor);
  /// The same with the axis given, in world coordinates (any length > 0).
  void Initialize(b2Body* bodyA, b2Body* bodyB, const b2Vec2& anchor, const b2Vec2& axis);

  b2Vec2 localAnchorA{0, 0};  ///< relative to body A's origin, m
  b2Vec2 localAnchorB{0, 0};  ///< relative to body B's origin, m
  float axisAngle = 0;        ///< of the axis in the frame of the two bodies' mean angle at rest, rad
  float referenceAngle = 0;   ///< angle of B minus angle of A at rest, rad

  RowDef rows[3];                      ///< axial, shear, rotation
  double max_rotation = unlimited;     ///< rad: breaks where accumulated plastic rotation exceeds it
  double max_elongation = unlimited;   ///< m: accumulated plastic lengthening
  double max_compression = unlimited;  ///< m: accumulated plastic shortening
  double max_slip = unlimited;         ///< m: accumulated plastic shear
  /// N–M curve that replaces the independent caps of N and M (and with the shear cap, of Q): a convex polygon
  /// with the origin inside, counter-clockwise in the (N, M) plane. Empty: independent caps.
  std::vector<AxialMoment> interaction;
  int break_group = 0;  ///< joints of one group ≠ 0 break together
};

}  // namespace ductile
