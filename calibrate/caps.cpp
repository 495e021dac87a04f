#include "caps.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "ductile/plane.h"

namespace ductile::calibration {
namespace {

// What set a value: the section or material of side 0 or 1, nothing, or the user at a level.
enum Source : int { side_a, side_b, nothing, user };  // user + i: overriding[i]

enum Quantity : int {
  N,
  Nc,
  Q,
  M,
  M_reverse,
  max_rotation,
  max_elongation,
  max_compression,
  max_slip,
  quantities
};
constexpr std::array<std::string_view, quantities> names{
    "N", "Nc", "Q", "M", "M_reverse", "max_rotation", "max_elongation", "max_compression", "max_slip"};

struct Values {
  std::array<double, quantities> value;
  std::array<int, quantities> source;

  Values() {
    value.fill(unlimited);
    source.fill(nothing);
  }
  void weaken(Quantity q, double to, int by) {
    if (to < value[q]) value[q] = to, source[q] = by;
  }
  void set(Quantity q, const std::optional<double>& to, int by) {
    if (to) value[q] = *to, source[q] = by;
  }
};

// k of a row from the compliances of both sides in series; unlimited where neither gives.
double in_series(double compliance) { return compliance > 0 ? 1 / compliance : unlimited; }

// The rotational inertia that b2AngularStiffness uses.
double effective(double a, double b) { return a > 0 && b > 0 ? a * b / (a + b) : std::max(a, b); }

}  // namespace

void Caps::fill_in(PlannedJoint& joint, const std::array<Side, 2>& sides,
                   std::span<const Overriding> overriding, const Sharing& sharing) {
  // Overrides that apply to several quantities, the innermost level last so that it wins.
  std::optional<double> damping;
  const Overriding* hinge = nullptr;
  std::optional<bool> hold;
  const JointOverrides* elastic = nullptr;
  int elastic_level = 0;
  for (std::size_t i = 0; i < overriding.size(); ++i) {
    const JointOverrides& o = *overriding[i].values;
    if (!hinge && (o.hinge_length || o.shear_span)) hinge = &overriding[i];
    if (!damping) damping = o.damping_ratio;
    if (!hold) hold = o.hold;
    if (!elastic && o.elastic) elastic = &o, elastic_level = static_cast<int>(i);
  }

  // The weaker side governs each cap; compliances add up.
  Values v;
  joint.hold = hold.value_or(false);
  int hardening_side = -1;
  joint.hinge_length = hinge ? hinge->values->hinge_length.value_or(unlimited) : joint.height;
  if (joint.hinge_length == unlimited) {
    for (int i = 0; i < 2; ++i)
      if (const Side& side = sides[i]; side.strip)
        if (const double own = *hinge->values->shear_span * (1 - 1 / side.strip->hardening());
            own < joint.hinge_length)
          joint.hinge_length = own, hardening_side = i;
    if (!(joint.hinge_length > 0 && joint.hinge_length < unlimited)) {
      problems_.push_back({joint.name, "a shear span without a material that hardens",
                           "give the material an fu above its fy, or the joint a `hinge_length`"});
      return;
    }
  }
  double along = 0, across = 0, bending = 0, zeta = unlimited;
  RateLaw rate{{0, 0, 0}};
  const double crushed = sides[0].reach + sides[1].reach > 0 ? sides[0].reach + sides[1].reach : unlimited;
  for (int i = 0; i < 2; ++i) {
    const Side& side = sides[i];
    if (!side.strip) continue;
    const Strength s = side.strip->at(joint, side.reversed);
    v.weaken(N, s.N, i);
    v.weaken(Nc, s.Nc, i);
    v.weaken(Q, s.Q, i);
    v.weaken(M, s.M, i);
    v.weaken(M_reverse, s.M_reverse, i);
    // θ_max = ε_f·L_p/y, y from the plastic neutral axis to the farther fibre; Δ_max = ε_f·L_p.
    const double elongation = side.strip->fracture_strain() * joint.hinge_length;
    v.weaken(max_rotation, elongation / s.farther, i);
    v.weaken(max_elongation, elongation, i);
    // Geometry alone: the zone is crushed to nothing, or its faces have passed each other.
    if (joint.height > 0) {
      v.weaken(max_compression, std::min(joint.hinge_length, crushed), i);
      v.weaken(max_slip, joint.height, i);
    }
    zeta = std::min(zeta, side.strip->damping_ratio());
    // A hinge of length L_p: its strain rate is that of its elongation over L_p, in bending that of the
    // farthest fibre, in shear by von Mises. The side that depends less on it governs.
    if (const double D = side.strip->doubling_rate() * joint.hinge_length; D > rate.doubling[axial])
      rate = {{D, std::numbers::sqrt3 * D, D / s.farther}, side.strip->rate_exponent()};
    if (s.EA > 0) {
      along += (side.reach + side.longer.along) / s.EA;
      across += (side.reach + side.longer.along) / s.GA;
      bending += (side.reach + side.longer.bending) / s.EI;
    }
  }
  for (std::size_t i = overriding.size(); i-- > 0;) {
    const JointOverrides& o = *overriding[i].values;
    const int by = user + static_cast<int>(i);
    v.set(N, o.axial, by);
    v.set(Nc, o.axial_compression ? o.axial_compression : o.axial, by);
    v.set(Q, o.shear, by);
    v.set(M, o.moment, by);
    v.set(M_reverse, o.moment_reverse ? o.moment_reverse : o.moment, by);
    v.set(max_rotation, o.max_rotation, by);
    v.set(max_elongation, o.max_elongation, by);
    v.set(max_compression, o.max_compression, by);
    v.set(max_slip, o.max_slip, by);
  }

  if (rate.doubling[axial] > 0 && rate.doubling[axial] < unlimited) joint.rate = rate;
  joint.stiffness = {in_series(along), in_series(across), in_series(bending)};
  joint.damping_ratio = damping.value_or(zeta == unlimited ? 0 : zeta);
  const char* stiffness = bending > 0 ? "E" : "rigid, E is not known";
  if (elastic) {
    stiffness = overriding[static_cast<std::size_t>(elastic_level)].name;
    const double omega = 2 * std::numbers::pi * elastic->frequency;
    const double by_frequency = omega * omega * effective(sides[0].inertia, sides[1].inertia);
    switch (*elastic->elastic) {
      case Elasticity::true_stiffness:
        break;
      case Elasticity::rigid:
        joint.stiffness = {unlimited, unlimited, unlimited};
        break;
      case Elasticity::frequency:
        joint.damping_frequency = elastic->frequency;
        joint.stiffness.M = by_frequency > 0 ? by_frequency : unlimited;
        break;
      case Elasticity::elastic_rotation:
        if (elastic->frequency > 0 && by_frequency > 0) {
          joint.damping_frequency = elastic->frequency;
          joint.stiffness.M = by_frequency;
          v.value[M] = v.value[M_reverse] = by_frequency * elastic->elastic_rotation;
          v.source[M] = v.source[M_reverse] = user + elastic_level;
        } else if (v.value[M] > 0 && v.value[M] < unlimited) {
          joint.stiffness.M = v.value[M] / elastic->elastic_rotation;
        } else {
          problems_.push_back({joint.name, "an elastic rotation without a moment to reach it at",
                               "give `moment` or `frequency`, or the body a material"});
        }
        break;
    }
  }
  // What `elastic` overrides, it overrides with its stiffnesses.
  for (std::size_t i = elastic ? static_cast<std::size_t>(elastic_level) + 1 : overriding.size(); i-- > 0;) {
    const JointOverrides& o = *overriding[i].values;
    if (o.stiffness_axial || o.stiffness_shear || o.stiffness_moment) stiffness = overriding[i].name;
    joint.stiffness = {o.stiffness_axial.value_or(joint.stiffness.N),
                       o.stiffness_shear.value_or(joint.stiffness.Q),
                       o.stiffness_moment.value_or(joint.stiffness.M)};
  }
  joint.N = v.value[N];
  joint.Nc = v.value[Nc];
  joint.Q = v.value[Q];
  joint.M = v.value[M];
  joint.M_reverse = v.value[M_reverse];
  joint.max_rotation = v.value[max_rotation];
  joint.max_elongation = v.value[max_elongation];
  joint.max_compression = v.value[max_compression];
  joint.max_slip = v.value[max_slip];

  const Governed governed{v.source,
                          stiffness,
                          {sides[0].body, sides[1].body},
                          overriding.front().name,
                          sharing,
                          hinge ? hinge->name : nullptr,
                          hardening_side};
  if (!(governed == last_)) {
    last_ = governed;
    last_reason_ = reason(text(governed, overriding));
  }
  joint.governed_by = last_reason_;
}

int Caps::reason(const std::string& text) {
  const auto [found, is_new] = numbers_.emplace(text, static_cast<int>(reasons_.size()));
  if (is_new) reasons_.push_back(text);
  return found->second;
}

// "N, Nc: section of beam; Q: joint; …": runs of quantities with one source.
std::string Caps::text(const Governed& governed, std::span<const Overriding> overriding) {
  std::string text;
  for (int q = 0; q < quantities; ++q) {
    const int source = governed.sources[q];
    text += names[q];
    if (q + 1 < quantities && governed.sources[q + 1] == source && q != M_reverse && q != max_elongation) {
      text += ", ";
      continue;
    }
    text += ": ";
    if (source == nothing)
      text += "unlimited";
    else if (source >= user)
      text += overriding[static_cast<std::size_t>(source - user)].name;
    else
      text.append(q <= M_reverse        ? "section of "
                  : q <= max_elongation ? "fracture strain of "
                                        : "size of ")
          .append(*governed.bodies[source]);
    text += "; ";
  }
  text.append("stiffness: ").append(governed.stiffness);
  if (governed.hardening_side >= 0)
    text.append("; hinge length: hardening of ")
        .append(*governed.bodies[governed.hardening_side])
        .append(" over the shear span of ")
        .append(governed.hinge);
  else if (governed.hinge)
    text.append("; hinge length: ").append(governed.hinge);
  if (governed.sharing.intervals > 1)
    text.append("; ").append(std::to_string(governed.sharing.intervals)).append(governed.sharing.how);
  return text;
}

}  // namespace ductile::calibration
