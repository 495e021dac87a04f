// Box2D's joints as rows, each as its own source has them.
#include <algorithm>
#include <cmath>

#include "box2d_joints.h"
#include "kinematics.h"
#include "reveal.h"

namespace ductile::dynamics {

DUCTILE_REVEAL(b2RevoluteJoint, m_impulse, b2Vec2);
DUCTILE_REVEAL(b2RevoluteJoint, m_motorImpulse, float);
DUCTILE_REVEAL(b2RevoluteJoint, m_lowerImpulse, float);
DUCTILE_REVEAL(b2RevoluteJoint, m_upperImpulse, float);
DUCTILE_REVEAL(b2PrismaticJoint, m_impulse, b2Vec2);
DUCTILE_REVEAL(b2PrismaticJoint, m_motorImpulse, float);
DUCTILE_REVEAL(b2PrismaticJoint, m_lowerImpulse, float);
DUCTILE_REVEAL(b2PrismaticJoint, m_upperImpulse, float);
DUCTILE_REVEAL(b2DistanceJoint, m_impulse, float);
DUCTILE_REVEAL(b2DistanceJoint, m_lowerImpulse, float);
DUCTILE_REVEAL(b2DistanceJoint, m_upperImpulse, float);
DUCTILE_REVEAL(b2WheelJoint, m_impulse, float);
DUCTILE_REVEAL(b2WheelJoint, m_motorImpulse, float);
DUCTILE_REVEAL(b2WheelJoint, m_springImpulse, float);
DUCTILE_REVEAL(b2WheelJoint, m_lowerImpulse, float);
DUCTILE_REVEAL(b2WheelJoint, m_upperImpulse, float);
DUCTILE_REVEAL(b2WeldJoint, m_impulse, b2Vec3);
DUCTILE_REVEAL(b2MouseJoint, m_impulse, b2Vec2);
DUCTILE_REVEAL(b2MouseJoint, m_localAnchorB, b2Vec2);
DUCTILE_REVEAL(b2PulleyJoint, m_impulse, float);
DUCTILE_REVEAL(b2PulleyJoint, m_localAnchorA, b2Vec2);
DUCTILE_REVEAL(b2PulleyJoint, m_localAnchorB, b2Vec2);

namespace {

/// Gaps up to this, m and rad, are closed by the rows; wider ones by Box2D's iterations of positions. In long
/// steps a rope that is wound up lags behind by more.
double closable(unsigned row, double h) {
  return row == rotation ? b2_angularSlop : 4 * b2_linearSlop * std::max(1.0, 60 * h);
}
/// So much of a gap is closed in a step, or this share of it where that is more: what was drawn apart shall
/// not be a blow, and a rope that is wound up at 0.5 m/s shall follow.
constexpr double at_once[] = {0.2 * b2_linearSlop, 0.2 * b2_linearSlop, 0.2 * b2_angularSlop};
constexpr double share[] = {0.5, 0.5, 0.2};
constexpr double slop[] = {b2_linearSlop, b2_linearSlop, b2_angularSlop};
/// Limits farther away than this, m and rad, are no rows: Box2D moves no body by more in a step.
constexpr double out_of_reach[] = {2 * b2_maxTranslation, 2 * b2_maxTranslation, 2 * b2_maxRotation};

struct Arm {
  double x, y;  // from the centre of mass, own frame
};

Arm arm(b2Body* body, const b2Vec2& anchor) {
  return {double{anchor.x} - body->GetLocalCenter().x, double{anchor.y} - body->GetLocalCenter().y};
}

/// Rows under construction. The rate of a gap C is J v, so b = C/h closes it by the end of the step, of which
/// this may be a part: what was open before is closed no faster then.
class Draft {
 public:
  Draft(b2Joint& joint, double h, double part) : joint_(joint), h_(part), closing_time_(h) {}

  /// Rows along and across an axis that is fixed to A, or that runs from anchor to anchor, and of rotation.
  void locate(const Place& a, const Place& b, const Arm& ra, const Arm& rb, const Turn& axis,
              double reference = 0, bool line = false) {
    Joint j;
    j.frame = {.ax = ra.x,
               .ay = ra.y,
               .bx = rb.x,
               .by = rb.y,
               .axis = axis,
               .follow = 0,
               .reference = reference,
               .line = line};
    gap = dynamics::locate(j, a, b);
    open(j.J);
  }
  void open(const Jacobian& J) {
    Link& link = rows.links[rows.count];
    link = {};
    link.J = J;
    link.id = 4 * static_cast<std::uint64_t>(joint_.GetType()) + rows.count++;
  }

  /// Keeps a gap C at 0.
  void hold(unsigned row, double C) {
    rows.near = rows.near && std::abs(C) <= closable(row, closing_time_);
    set(row, unlimited, closing(row, C) / closing_time_, unlimited, unlimited);
  }
  /// With no more than so much force or moment.
  void drive(unsigned row, double speed, double most) {
    set(row, unlimited, -speed, h_ * most, h_ * most);
    rows.links[0].goes_on |= 1u << row;
  }
  /// Box2D's soft constraint: spring and damper at the end of the step.
  void spring(unsigned row, double C, double stiffness, double damping, double most = unlimited) {
    const double G = h_ * (damping + h_ * stiffness);
    set(row, G, G > 0 ? C * h_ * stiffness / G : 0, h_ * most, h_ * most);
  }
  /// Keeps a gap within limits, each by a link of its own, or by one where they are equal.
  void limit(unsigned row, double lower, double upper, float& lower_impulse, float& upper_impulse) {
    const Jacobian J = rows.links[0].J;
    // A motor that presses against a limit would be answered by it, more and more.
    if (lower_impulse > 0 || upper_impulse > 0) rows.links[0].goes_on &= ~(1u << row);
    const double over = gap[row] - lower, under = upper - gap[row];
    open(J);
    channel(lower_impulse, row, -1, true);
    if (upper - lower < 2 * slop[row]) {
      hold(row, (over - under) / 2);
    } else {
      if (over < out_of_reach[row]) set(row, unlimited, way(row, over), 0, unlimited);
      open(J);
      if (under < out_of_reach[row]) set(row, unlimited, -way(row, under), unlimited, 0);
    }
    channel(upper_impulse, row, 1, true);
  }
  /// The impulse that Box2D keeps of the last link's row, or of some of them.
  void channel(float& impulse, unsigned row, int sense, bool one_sided = false) {
    Rows of_row{};
    of_row[row] = sense;
    channel(impulse, of_row, one_sided);
  }
  void channel(float& impulse, const Rows& sense, bool one_sided = false) {
    const auto link = static_cast<unsigned>(rows.count - 1);
    rows.channels[rows.channel_count++] = {&impulse, link, sense, one_sided};
    for (unsigned i = 0; i < 3; ++i) rows.links[link].impulse[i] += sense[i] * double{impulse};
  }

  double h() const { return h_; }

  StockRows rows;
  Rows gap{};

 private:
  double closing(unsigned row, double C) {
    const double most = std::max(at_once[row], share[row] * std::abs(C));
    return std::clamp(C, -most, most);
  }
  // The rate at which the way C that is left to a limit may close, or has to open again.
  double way(unsigned row, double C) {
    rows.near = rows.near && C >= -closable(row, closing_time_);
    return C > 0 ? C / h_ : closing(row, C) / closing_time_;
  }
  void set(unsigned row, double G, double bias, double cap, double cap_reverse) {
    Link& link = rows.links[rows.count - 1];
    link.G[row] = G;
    link.bias[row] = bias;
    link.cap[row] = cap;
    link.cap_reverse[row] = cap_reverse;
  }

  b2Joint& joint_;
  double h_, closing_time_;
};

struct Places {
  const Place &a, &b;
  b2Vec2 origin;
};

template <class Stock>
void locate(Draft& d, Stock& j, const Places& at, const Turn& axis, double reference = 0, bool line = false) {
  d.locate(at.a, at.b, arm(j.GetBodyA(), j.GetLocalAnchorA()), arm(j.GetBodyB(), j.GetLocalAnchorB()), axis,
           reference, line);
}
template <class Stock>
Turn axis_of(const Stock& j) {
  return {j.GetLocalAxisA().x, j.GetLocalAxisA().y};
}
template <class Stock, class Lower, class Upper>
void limit(Draft& d, Stock& j, unsigned row, Lower lower, Upper upper) {
  if (j.IsLimitEnabled()) d.limit(row, j.GetLowerLimit(), j.GetUpperLimit(), of(j, lower), of(j, upper));
}

// World axes.
void draft(b2RevoluteJoint& j, const Places& at, Draft& d) {
  locate(d, j, at, inverse(at.a.turn), j.GetReferenceAngle());
  d.rows.apart = {d.gap[axial], d.gap[shear], 0};
  d.hold(axial, d.gap[axial]);
  d.hold(shear, d.gap[shear]);
  d.channel(of(j, b2RevoluteJoint_m_impulse{}).x, axial, -1);
  d.channel(of(j, b2RevoluteJoint_m_impulse{}).y, shear, -1);
  if (j.IsMotorEnabled()) d.drive(rotation, j.GetMotorSpeed(), j.GetMaxMotorTorque());
  d.channel(of(j, b2RevoluteJoint_m_motorImpulse{}), rotation, -1);
  limit(d, j, rotation, b2RevoluteJoint_m_lowerImpulse{}, b2RevoluteJoint_m_upperImpulse{});
}

void draft(b2PrismaticJoint& j, const Places& at, Draft& d) {
  locate(d, j, at, axis_of(j), j.GetReferenceAngle());
  d.hold(shear, d.gap[shear]);
  d.hold(rotation, d.gap[rotation]);
  d.channel(of(j, b2PrismaticJoint_m_impulse{}).x, shear, -1);
  d.channel(of(j, b2PrismaticJoint_m_impulse{}).y, rotation, -1);
  if (j.IsMotorEnabled()) d.drive(axial, j.GetMotorSpeed(), j.GetMaxMotorForce());
  d.channel(of(j, b2PrismaticJoint_m_motorImpulse{}), axial, -1);
  limit(d, j, axial, b2PrismaticJoint_m_lowerImpulse{}, b2PrismaticJoint_m_upperImpulse{});
}

// A rod where its limits are equal; otherwise a spring, if any, within them: a rope.
void draft(b2DistanceJoint& j, const Places& at, Draft& d) {
  locate(d, j, at, {}, 0, true);
  if (!(d.gap[axial] > 2 * b2_linearSlop)) {  // it has no direction
    d.rows.count = 0;
    return;
  }
  float& impulse = of(j, b2DistanceJoint_m_impulse{});
  d.channel(impulse, axial, -1);
  if (j.GetMinLength() == j.GetMaxLength()) return d.hold(axial, d.gap[axial] - j.GetMinLength());
  if (j.GetStiffness() > 0) d.spring(axial, d.gap[axial] - j.GetLength(), j.GetStiffness(), j.GetDamping());
  d.limit(axial, j.GetMinLength(), j.GetMaxLength(), of(j, b2DistanceJoint_m_lowerImpulse{}),
          of(j, b2DistanceJoint_m_upperImpulse{}));
}

void draft(b2WheelJoint& j, const Places& at, Draft& d) {
  locate(d, j, at, axis_of(j));
  if (j.GetStiffness() > 0) d.spring(axial, d.gap[axial], j.GetStiffness(), j.GetDamping());
  d.channel(of(j, b2WheelJoint_m_springImpulse{}), axial, -1);
  d.hold(shear, d.gap[shear]);
  d.channel(of(j, b2WheelJoint_m_impulse{}), shear, -1);
  if (j.IsMotorEnabled()) d.drive(rotation, j.GetMotorSpeed(), j.GetMaxMotorTorque());
  d.channel(of(j, b2WheelJoint_m_motorImpulse{}), rotation, -1);
  limit(d, j, axial, b2WheelJoint_m_lowerImpulse{}, b2WheelJoint_m_upperImpulse{});
}

void draft(b2WeldJoint& j, const Places& at, Draft& d) {
  locate(d, j, at, inverse(at.a.turn), j.GetReferenceAngle());
  d.rows.apart = {d.gap[axial], d.gap[shear], 0};
  b2Vec3& impulse = of(j, b2WeldJoint_m_impulse{});
  d.hold(axial, d.gap[axial]);
  d.hold(shear, d.gap[shear]);
  d.channel(impulse.x, axial, -1);
  d.channel(impulse.y, shear, -1);
  if (j.GetStiffness() > 0) {
    d.spring(rotation, d.gap[rotation], j.GetStiffness(), j.GetDamping());
  } else {
    d.hold(rotation, d.gap[rotation]);
  }
  d.channel(impulse.z, rotation, -1);
}

// Along and across what the spring asks for, in which direction the force is that Box2D limits. A is not
// pulled.
void draft(b2MouseJoint& j, const Places& at, Draft& d) {
  Place target;
  put(target, {double{j.GetTarget().x} - at.origin.x, double{j.GetTarget().y} - at.origin.y, 0});
  const Arm held = arm(j.GetBodyB(), of(j, b2MouseJoint_m_localAnchorB{}));
  d.locate(target, at.b, {}, held, {});
  const b2Vec2 moves = j.GetBodyB()->GetLinearVelocityFromWorldPoint(j.GetAnchorB());
  const double k = j.GetStiffness(), c = j.GetDamping();
  const double x = k * d.gap[axial] + c * moves.x, y = k * d.gap[shear] + c * moves.y;
  const double length = std::sqrt(x * x + y * y);
  const Turn pull = length > 0 ? Turn{x / length, y / length} : Turn{};
  d.rows.count = 0;
  d.locate(target, at.b, {}, held, pull);
  Jacobian& J = d.rows.links[0].J;
  J.axis_a = {0, 0};
  J.au = J.av = 0;
  // The caps of both rows together are the force's. Where that may be all that is allowed, it is along the
  // pull but for what the step changes in that.
  b2Vec2& impulse = of(j, b2MouseJoint_m_impulse{});
  const double most = j.GetMaxForce(), half = std::sqrt(0.5);
  const bool at_most = std::max(length, impulse.Length() / d.h()) > half * most;
  const double across = at_most ? 0.04 : half;
  d.spring(axial, d.gap[axial], k, c, std::sqrt(1 - across * across) * most);
  d.spring(shear, d.gap[shear], k, c, across * most);
  d.channel(impulse.x, Rows{-pull.c, pull.s, 0});
  d.channel(impulse.y, Rows{-pull.s, -pull.c, 0});
}

// The way from the ground's anchors over both bodies, length A + ratio · length B, is one row.
void draft(b2PulleyJoint& j, const Places& at, Draft& d) {
  const auto rope = [&](const Place& place, b2Body* body, const b2Vec2& local, const b2Vec2& ground,
                        Turn& along, double& moment) {
    const Arm r = arm(body, local);
    const Turn own = inverse(place.turn);
    const Turn to_centre =
        own * Turn{place.pose.x + at.origin.x - ground.x, place.pose.y + at.origin.y - ground.y};
    const double x = to_centre.c + r.x, y = to_centre.s + r.y, length = std::sqrt(x * x + y * y);
    along = {x / length, y / length};
    moment = r.x * along.s - r.y * along.c;
    return length;
  };
  Jacobian J;
  const double a =
      rope(at.a, j.GetBodyA(), of(j, b2PulleyJoint_m_localAnchorA{}), j.GetGroundAnchorA(), J.axis_a, J.au);
  const double b =
      rope(at.b, j.GetBodyB(), of(j, b2PulleyJoint_m_localAnchorB{}), j.GetGroundAnchorB(), J.axis_b, J.bu);
  if (!(std::min(a, b) > 10 * b2_linearSlop)) return;  // Box2D knows no direction, either
  const double ratio = j.GetRatio();
  J.axis_a = {-J.axis_a.c, -J.axis_a.s};
  J.axis_b = {ratio * J.axis_b.c, ratio * J.axis_b.s};
  J.bu *= ratio;
  d.open(J);
  d.hold(axial, a + ratio * b - (double{j.GetLengthA()} + ratio * j.GetLengthB()));
  d.channel(of(j, b2PulleyJoint_m_impulse{}), axial, 1);
}

}  // namespace

StockRows rows_of(b2Joint& joint, const Place& a, const Place& b, const b2Vec2& origin, double h, double part,
                  bool closes) {
  Draft d(joint, h, part);
  as_it_is(joint, [&](auto& j) { draft(j, {a, b, origin}, d); });
  d.rows.near = d.rows.near && closes;
  // What is far apart, or may be kept apart, is not closed by velocities.
  for (std::size_t k = 0; k < d.rows.count && !d.rows.near; ++k) {
    Link& link = d.rows.links[k];
    for (unsigned i = 0; i < 3; ++i) {
      if (link.G[i] != unlimited) continue;
      const bool pulls = link.cap[i] == unlimited, pushes = link.cap_reverse[i] == unlimited;
      if (pulls && pushes) link.bias[i] = 0;
      if (pulls != pushes) link.bias[i] = pulls ? std::min(link.bias[i], 0.0) : std::max(link.bias[i], 0.0);
    }
  }
  return d.rows;
}

}  // namespace ductile::dynamics
