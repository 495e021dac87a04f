#include "strip.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "ductile/moments.h"
#include "ductile/plane.h"
#include "ductile/rolled.h"
#include "ductile/shear.h"
#include "ductile/strip_line.h"

namespace ductile::calibration {
namespace {

constexpr double poisson = 0.3;                // ν
constexpr double shear_coefficient = 5.0 / 6;  // κ of a rectangle (Timoshenko)
constexpr double shear_stiffness(double EA) { return shear_coefficient * EA / (2 * (1 + poisson)); }

// The right of a joint's axis, which positive M puts in tension, in a section whose y is the left of the
// axis.
constexpr Point tension_side{0, -1};

// Table 1 for a rectangle b × h of unequal yield stresses: the neutral axis divides h as f_c : f_t.
Strength rectangle(double b, double h, const Material& m) {
  const double ft = m.yield_stress, fc = m.compression();
  const double plastic = b * h * h / 2 * (ft / (ft + fc) * fc), cracking = b * h * h / 6 * std::min(ft, fc);
  const double moment = m.brittle ? cracking : plastic;
  const double EA = m.youngs_modulus * b * h;
  return {.N = b * h * ft,
          .Nc = b * h * fc,
          .Q = b * h * m.shear(),
          .M = moment,
          .M_reverse = moment,
          .EA = EA,
          .GA = shear_stiffness(EA),
          .EI = EA * h * h / 12,
          .farther = m.brittle ? h / 2 : h * std::max(ft, fc) / (ft + fc),
          .height = h};
}

// The same of any section.
Strength of(const Section& section) {
  const Capacities c = section.capacities(tension_side);
  const Elastic e = section.elastic(tension_side);
  const auto [low, high] = section.extent(tension_side);
  const auto is_brittle = [](const Region& region) { return region.material.brittle; };
  const bool brittle = std::all_of(section.regions().begin(), section.regions().end(), is_brittle);
  const double middle = dot(e.centroid, tension_side);
  return {.N = c.N,
          .Nc = c.Nc,
          .Q = shear_capacity(section, tension_side),
          .M = brittle ? e.yield_moment : c.M,
          .M_reverse = brittle ? section.elastic(-tension_side).yield_moment : c.M_reverse,
          .EA = e.EA,
          .GA = shear_stiffness(e.EA),
          .EI = e.EI,
          .farther = brittle
                         ? std::max(middle - low, high - middle)
                         : std::max({c.pna - low, high - c.pna, c.pna_reverse - low, high - c.pna_reverse}),
          .height = high - low};
}

Ring moved(const Ring& ring, Point by, bool mirrored) {
  Ring result;
  result.reserve(ring.size());
  for (const Point& p : ring) result.push_back({p.x + by.x, mirrored ? -(p.y + by.y) : p.y + by.y});
  return result;
}

std::vector<Region> moved(std::span<const Region> regions, Point by, bool mirrored = false) {
  std::vector<Region> result;
  for (const Region& region : regions) {
    result.push_back({{moved(region.outline.outer, by, mirrored), {}}, region.material});
    for (const Ring& hole : region.outline.holes)
      result.back().outline.holes.push_back(moved(hole, by, mirrored));
  }
  return result;
}

double doubling_rate(const Material& m) { return m.rate_D > 0 ? m.rate_D : unlimited; }

double hardening(const Material& m) { return std::max(1.0, m.ultimate_stress / m.yield_stress); }

}  // namespace

std::array<Point, 2> ends_of_long_axis(const Outline& outline) {
  const AreaMoments m = moments(outline);
  const LongAxis axis = long_axis(outline, m);
  return {m.centroid + axis.low * axis.direction, m.centroid + axis.high * axis.direction};
}

Strip::Strip(const BodyDef& body) : body_(&body) {
  if (body.material) {
    fracture_strain_ = body.material->fracture_strain;
    damping_ratio_ = body.material->damping_ratio;
    hardening_ = calibration::hardening(*body.material);
    doubling_rate_ = calibration::doubling_rate(*body.material);
    rate_exponent_ = body.material->rate_q;
    mass_per_area_ = body.material->density * body.depth;
  }
  if (body.profile.empty()) return;

  const Section as_given(body.profile);
  profile_.emplace(moved(body.profile, -as_given.centroid()));
  of_profile_ = of(*profile_);
  if (!body.profile_name.empty()) {
    if (const double A_v = shear_area(rolled(body.profile_name)); A_v > 0)
      of_profile_.Q = A_v * body.profile.front().material.shear();
  }

  double mass = 0, inertia = 0;  // per metre of the strip, about the centroid, in the plane of the scene
  fracture_strain_ = unlimited;
  damping_ratio_ = unlimited;
  hardening_ = unlimited;
  doubling_rate_ = 0;
  for (const Region& region : profile_->regions()) {
    const Material& m = region.material;
    const double density = m.density > 0 ? m.density : body.material ? body.material->density : 0;
    const AreaMoments area = moments(region.outline);
    mass += density * area.area;
    inertia += density * (area.yy + area.area * area.centroid.y * area.centroid.y);
    fracture_strain_ = std::min(fracture_strain_, m.fracture_strain);
    damping_ratio_ = std::min(damping_ratio_, m.damping_ratio);
    hardening_ = std::min(hardening_, calibration::hardening(m));
    if (const double D = calibration::doubling_rate(m); D > doubling_rate_)
      doubling_rate_ = D, rate_exponent_ = m.rate_q;
  }
  const double h = of_profile_.height;
  mass_per_area_ = mass / h;
  excess_inertia_per_area_ = (inertia - mass * h * h / 12) / h;
}

Strength Strip::at(const PlannedJoint& joint, bool reversed) const {
  if (!joint.intervals.empty()) return of(section(joint));
  if (!profile_) return rectangle(body_->depth, joint.height, *body_->material);
  Strength result = of_profile_;
  if (reversed) std::swap(result.M, result.M_reverse);
  return result;
}

Section Strip::section(const PlannedJoint& joint, bool reversed) const {
  if (profile_) return reversed ? Section(moved(profile_->regions(), {}, true)) : *profile_;
  const double x = body_->depth / 2;
  const auto stretch = [&](double from, double to) {
    return Region{{{{-x, from}, {x, from}, {x, to}, {-x, to}}, {}}, *body_->material};
  };
  if (joint.intervals.empty()) return Section(std::array{stretch(-joint.height / 2, joint.height / 2)});
  std::vector<Region> regions;
  for (const auto& [from, to] : joint.intervals) regions.push_back(stretch(from, to));
  return Section(regions);
}

std::optional<double> Strip::profile_height() const {
  if (!profile_) return std::nullopt;
  return of_profile_.height;
}

double Strip::excess_inertia(double area) const { return excess_inertia_per_area_ * area; }

}  // namespace ductile::calibration

namespace ductile {

std::array<Point, 2> strip_line(const BodyDef& body) {
  std::array<Point, 2> line = body.along;
  if (body.cuts.size() > 1)
    line = {middle(body.cuts.front()[0], body.cuts.front()[1]),
            middle(body.cuts.back()[0], body.cuts.back()[1])};
  return line[0] == line[1] ? calibration::ends_of_long_axis(body.outline) : line;
}

}  // namespace ductile
