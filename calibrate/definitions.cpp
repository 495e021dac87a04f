// Joints and fixtures of a plan as Box2D's definitions.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "convex.h"
#include "ductile/box2d.h"
#include "ductile/plane.h"
#include "ductile/turn.h"

namespace ductile {
using namespace calibration;

namespace {

// A number as Box2D stores it. Subnormal floats count as vanished: Box2D divides by some of them.
float checked(double value, const std::string& place, const char* name) {
  const float result = static_cast<float>(value);
  if (std::isfinite(result) && (value == 0 || std::abs(result) >= std::numeric_limits<float>::min()))
    return result;
  throw InvalidInput({{place, std::string(name) + " is " + to_string(value) + ", which no float holds",
                       "keep it between 1e-37 and 1e38, or leave it unlimited"}});
}

Point center(const Plan& plan, int piece) { return piece < 0 ? Point{} : plan.carrier(piece).center; }

template <class Def>
void place_anchors(Def& def, const Plan& plan, const PlannedJoint& joint) {
  def.localAnchorA = to_box2d(joint.anchor - center(plan, joint.a));
  def.localAnchorB = to_box2d(joint.far_anchor() - center(plan, joint.b));
}

bool axial_free(const PlannedJoint& j) { return std::max(j.N, j.Nc) == 0; }
bool shear_free(const PlannedJoint& j) { return j.Q == 0; }
bool turns_freely(const PlannedJoint& j) { return std::max(j.M, j.M_reverse) == 0; }

void list_what_no_stock_joint_does(std::vector<std::string>& lost, const PlannedJoint& j) {
  if ((j.stiffness.N < unlimited && !axial_free(j)) || (j.stiffness.Q < unlimited && !shear_free(j)))
    lost.push_back("it does not stretch or shear elastically");
  if (std::min(j.N, j.Nc) < unlimited && !axial_free(j))
    lost.push_back("it carries any axial force without yielding");
  if (j.Q < unlimited && !shear_free(j)) lost.push_back("it carries any shear force without yielding");
  if (std::min({j.max_rotation, j.max_elongation, j.max_compression, j.max_slip}) < unlimited)
    lost.push_back("it never breaks");
  if (j.rate) lost.push_back("it carries no more where it yields fast");
  if (j.ground_moves()) lost.push_back("its ground does not move");
  if (j.drive && (j.end || j.drive->row == axial)) lost.push_back("it is not driven");
}

// --- polygons ---

// What b2PolygonShape::Set does well with: no vertices that it would weld (b2_linearSlop/2), and none so
// nearly in line with their neighbours that its hull could stumble over the rounding of floats.
Ring without_detail(Ring ring) {
  double size = 0;
  for (const Point& p : ring) size = std::max({size, std::abs(p.x), std::abs(p.y)});
  const double straight = std::max(double{b2_linearSlop} / 10, 4e-6 * size);
  for (std::size_t i = 0; i < ring.size() && ring.size() > 2;) {
    const Point before = ring[(i + ring.size() - 1) % ring.size()], p = ring[i],
                after = ring[(i + 1) % ring.size()];
    const double base = length(after - before);
    if (length(p - before) < 0.6 * b2_linearSlop || cross(p - before, after - p) < straight * base) {
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    } else {
      ++i;
    }
  }
  return ring;
}

// The part of a convex polygon in which dot(point, normal) ≤ most.
std::vector<AxialMoment> clipped(const std::vector<AxialMoment>& polygon, AxialMoment normal, double most) {
  std::vector<AxialMoment> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const AxialMoment a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double over_a = a.N * normal.N + a.M * normal.M - most,
                 over_b = b.N * normal.N + b.M * normal.M - most;
    if (over_a <= 0) result.push_back(a);
    if ((over_a < 0 && over_b > 0) || (over_a > 0 && over_b < 0)) {
      const double s = over_a / (over_a - over_b);
      result.push_back({a.N + s * (b.N - a.N), a.M + s * (b.M - a.M)});
    }
  }
  return result;
}

// The speed of what moves in one step of any length, m/s and rad/s.
constexpr double at_once = 1e30;

// A rope is no longer than this, a strut no shorter.
b2DistanceJointDef distance_def(const Plan& plan, const PlannedJoint& j) {
  b2DistanceJointDef def;
  place_anchors(def, plan, j);
  def.collideConnected = true;
  def.length = checked(j.length, "joint '" + j.name + "'", "its length");
  def.minLength = j.carries == Carries::tension ? 0 : def.length;
  def.maxLength = j.carries == Carries::compression ? std::numeric_limits<float>::max() : def.length;
  return def;
}

}  // namespace

double PlannedJoint::damping(Row row) const {
  if (stiffness[row] == unlimited || !(damping_frequency > 0)) return 0;
  return damping_ratio * stiffness[row] / (std::numbers::pi * damping_frequency);
}

Drive drive_at(const PlannedJoint& j, double time) {
  const DriveDef& d = *j.drive;
  const double speed = d.speed.value_or(0), since = time - d.from;
  Drive drive{d.position.value_or(speed < 0 ? -unlimited : unlimited), 0};
  if (since < 0) return drive;
  if (d.speed) {
    drive.speed = std::abs(speed) * (d.ramp > 0 ? std::min(1.0, since / d.ramp) : 1);
  } else {
    const double way = std::abs(*d.position - (j.end ? j.length : 0));
    drive.speed = d.ramp > 0 ? way / d.ramp : at_once;
  }
  return drive;
}

// --- joints ---

ElasticPlasticJointDef elastic_plastic_def(const Plan& plan, const PlannedJoint& j) {
  ElasticPlasticJointDef def;
  place_anchors(def, plan, j);
  def.axisAngle = static_cast<float>(angle_of(j.axis.x, j.axis.y));
  if (j.a < 0) def.axisFollow = 0;  // a support's axis stays with the ground
  const auto row = [&](Row which, double cap, double reverse) {
    return RowDef{.stiffness = j.stiffness[which],
                  .damping_ratio = j.damping_frequency > 0 ? 0 : j.damping_ratio,
                  .cap = cap,
                  .cap_reverse = reverse,
                  .damping = j.damping(which)};
  };
  def.rows[axial] = row(axial, j.N, j.Nc);
  def.rows[shear] = row(shear, j.Q, j.Q);
  def.rows[rotation] = row(rotation, j.M, j.M_reverse);
  for (const Row r : {axial, shear, rotation})
    if (const double by = j.displacement[r]; by != 0)
      def.rows[r].drive = Drive{by, j.ramp > 0 ? std::abs(by) / j.ramp : at_once};
  def.rows[axial].slackens = j.carries != Carries::both;
  if (j.drive) def.rows[j.drive->row].drive = drive_at(j, unlimited);
  if (j.end) {
    def.line = def.collideConnected = true;
    def.length = j.length;
  }
  def.max_rotation = j.max_rotation;
  def.max_elongation = j.max_elongation;
  def.max_compression = j.max_compression;
  def.max_slip = j.max_slip;
  def.node = j.node;
  def.rate = j.rate;
  if (plan.interaction) def.interaction = interaction_of(plan, j);
  return def;
}

b2WeldJointDef weld_def(const Plan& plan, const PlannedJoint& j) {
  b2WeldJointDef def;
  place_anchors(def, plan, j);
  if (j.stiffness.M == unlimited) return def;
  def.stiffness = checked(j.stiffness.M, "joint '" + j.name + "'", "its stiffness");
  def.damping = checked(j.damping(rotation), "joint '" + j.name + "'", "its damping");
  return def;
}

b2RevoluteJointDef hinge_def(const Plan& plan, const PlannedJoint& j) {
  b2RevoluteJointDef def;
  place_anchors(def, plan, j);
  def.enableMotor = true;
  if (j.drive && j.drive->row == rotation) {
    const Drive drive = drive_at(j, unlimited);
    def.motorSpeed = static_cast<float>(drive.target < 0 ? -drive.speed : drive.speed);
    if (std::isfinite(drive.target)) {
      def.enableLimit = true;
      def.lowerAngle = static_cast<float>(std::min(0.0, drive.target));
      def.upperAngle = static_cast<float>(std::max(0.0, drive.target));
    }
  }
  const double moment = std::min(j.M, j.M_reverse);
  def.maxMotorTorque = moment == unlimited ? std::numeric_limits<float>::max()
                                           : checked(moment, "joint '" + j.name + "'", "its moment");
  return def;
}

std::optional<StockJointDef> stock_def(const Plan& plan, const PlannedJoint& j) {
  const auto anchored = [&](auto def) {
    place_anchors(def, plan, j);
    return def;
  };
  const auto along = [&](auto def, Point axis) {
    def.localAxisA = to_box2d(axis);
    return anchored(def);
  };
  if (j.end && !axial_free(j)) return distance_def(plan, j);
  if (axial_free(j) && shear_free(j)) {
    if (turns_freely(j)) return std::nullopt;
    b2MotorJointDef def;  // holds the angle only
    def.maxForce = 0;
    def.maxTorque = std::numeric_limits<float>::max();
    def.correctionFactor = 1;
    return def;
  }
  if (axial_free(j) || shear_free(j)) {
    const Point free_axis = axial_free(j) ? j.axis : left(j.axis);
    if (turns_freely(j)) return along(b2WheelJointDef{}, free_axis);  // without a spring: a point on a line
    return along(b2PrismaticJointDef{}, free_axis);
  }
  if (turns_freely(j)) return anchored(b2RevoluteJointDef{});
  if (j.drive && j.drive->row == rotation) return hinge_def(plan, j);
  return weld_def(plan, j);
}

std::vector<std::string> lost_in_stock(const PlannedJoint& j) {
  std::vector<std::string> lost;
  const bool driven = j.drive && j.drive->row == rotation;  // a motor, whose torque is the cap
  if (std::min(j.M, j.M_reverse) < unlimited && !turns_freely(j) && !driven)
    lost.push_back("it carries any moment without yielding");
  if (j.stiffness.M < unlimited && !turns_freely(j) && (axial_free(j) || shear_free(j)))
    lost.push_back("it does not bend elastically");
  list_what_no_stock_joint_does(lost, j);
  return lost;
}

std::vector<std::string> lost_in_hinge(const PlannedJoint& j) {
  std::vector<std::string> lost;
  if (j.stiffness.M < unlimited) lost.push_back("it does not bend elastically before it yields");
  if (j.M != j.M_reverse) lost.push_back("it yields at the smaller moment in both senses");
  if (std::min(j.M, j.M_reverse) == unlimited) lost.push_back("its moment is limited by what a float holds");
  list_what_no_stock_joint_does(lost, j);
  return lost;
}

namespace {

// Where the first fibre of a brittle section cracks or is crushed: σ = σ_c + k (s − c) within [−f_c, f_t] at
// both extreme fibres, N = A σ_c, M = k I + N c, with s the coordinate along d and c the centroid's. Empty
// where some region flows or the regions differ.
std::vector<Interaction> cracking_curve(const Section& section, Point d) {
  const Elastic e = section.elastic(d);
  const auto brittle = [](const Region& region) { return region.material.brittle; };
  if (!std::all_of(section.regions().begin(), section.regions().end(), brittle) || !(e.I > 0)) return {};
  const Material& m = section.regions().front().material;
  const double c = dot(e.centroid, d), ft = m.yield_stress, fc = m.compression();
  const auto [low, high] = section.extent(d);
  std::vector<Interaction> curve;
  const double corners[][2] = {{ft, ft}, {-fc, ft}, {-fc, -fc}, {ft, -fc}};
  for (const auto& [at_low, at_high] : corners) {
    const double k = (at_high - at_low) / (high - low), N = section.area() * (at_low + k * (c - low));
    curve.push_back({N, k * e.I + N * c});
  }
  return curve;
}

}  // namespace

std::vector<AxialMoment> interaction_of(const Plan& plan, const PlannedJoint& j, double tolerance) {
  std::vector<AxialMoment> result;
  if (j.drive) return result;
  for (const double cap : {j.N, j.Nc, j.M, j.M_reverse})
    if (cap == 0 || cap == unlimited) return result;
  constexpr Point d{0, -1};
  Capacities caps{.N = unlimited, .Nc = unlimited, .M = unlimited, .M_reverse = unlimited};
  for (const int piece : {j.b, plan.is_inside(j) ? -1 : j.a}) {
    const std::optional<Section> section = section_at(plan, j, piece);
    if (!section) continue;
    Capacities own = section->capacities(d);
    std::vector<Interaction> curve = section->interaction(d, 0, tolerance);
    if (const auto cracks = cracking_curve(*section, d); !cracks.empty()) {
      own.M = section->elastic(d).yield_moment;
      own.M_reverse = section->elastic(-d).yield_moment;
      curve = cracks;
    }
    caps.N = std::min(caps.N, own.N);
    caps.Nc = std::min(caps.Nc, own.Nc);
    caps.M = std::min(caps.M, own.M);
    caps.M_reverse = std::min(caps.M_reverse, own.M_reverse);
    if (result.empty()) {
      for (const Interaction& p : curve) result.push_back({p.N, p.M});
      continue;
    }
    for (std::size_t i = 0; i < curve.size(); ++i) {  // what lies within every edge of the other side's
      const Interaction a = curve[i], b = curve[(i + 1) % curve.size()];
      const AxialMoment outward{b.M - a.M, a.N - b.N};
      result = clipped(result, outward, outward.N * a.N + outward.M * a.M);
    }
  }
  if (result.empty()) return result;

  // Overridden caps stretch each axis, by the larger of both senses' factors so that the polygon stays
  // convex; the other sense is cut where its own factor puts its extreme.
  AxialMoment most{}, least{};
  for (const AxialMoment& p : result) {
    most = {std::max(most.N, p.N), std::max(most.M, p.M)};
    least = {std::min(least.N, p.N), std::min(least.M, p.M)};
  }
  const double n = j.N / caps.N, nc = j.Nc / caps.Nc, m = j.M / caps.M, mr = j.M_reverse / caps.M_reverse;
  for (AxialMoment& p : result) p = {std::max(n, nc) * p.N, std::max(m, mr) * p.M};
  if (n < nc) result = clipped(result, {1, 0}, n * most.N);
  if (nc < n) result = clipped(result, {-1, 0}, nc * -least.N);
  if (m < mr) result = clipped(result, {0, 1}, m * most.M);
  if (mr < m) result = clipped(result, {0, -1}, mr * -least.M);
  return result;
}

// --- fixtures ---

std::optional<b2PolygonShape> polygon_shape(const std::vector<Point>& points) {
  if (points.size() < 3) return std::nullopt;
  const Ring ring = without_detail(hull(points));
  if (ring.size() < 3 || ring.size() > b2_maxPolygonVertices || least_width(ring) < b2_linearSlop)
    return std::nullopt;
  b2Vec2 vertices[b2_maxPolygonVertices];
  std::transform(ring.begin(), ring.end(), vertices, to_box2d);
  b2PolygonShape shape;
  shape.Set(vertices, static_cast<int32>(ring.size()));
  return shape;
}

std::vector<b2PolygonShape> shapes(const Piece& piece) {
  const double w = piece.outline.outer.empty() ? 0 : least_width(hull(piece.outline.outer));
  std::vector<b2PolygonShape> result;
  for (const Convex& part : convex_parts(piece))
    if (const auto shape = polygon_shape(part)) result.push_back(*shape);
  if (w < 4 * b2_linearSlop || result.empty())
    throw InvalidInput({{"piece '" + piece.name + "'",
                         "is " + to_string(w) + " m wide, and Box2D collides nothing below 0.02 m",
                         "make it in fewer pieces, draw it larger, or let it collide with nothing "
                         "(\"collides\": false)"}});
  return result;
}

}  // namespace ductile
