// The joint whose section's first fibre yields first.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ductile/design.h"
#include "ductile/plane.h"
#include "elastic_path.h"

namespace ductile {
namespace {

// The joint inside the body that a support clamps at its end: they have one section.
const PlannedJoint* beside_clamp(const Plan& plan, const PlannedJoint& support) {
  const bool clamps = support.a < 0 && support.b >= 0 && support.height == 0 && support.M < unlimited;
  if (!clamps || !(support.M > 0)) return nullptr;
  const auto body_of = [&](int piece) {
    return piece < 0 ? -1 : plan.pieces[static_cast<std::size_t>(piece)].body;
  };
  for (const PlannedJoint& j : plan.joints)
    if ((j.a == support.b || j.b == support.b) && body_of(j.a) == body_of(j.b)) return &j;
  return nullptr;
}

// Of one side of a joint: how much of the yield stress a unit of N and of M bring to each corner.
class Fibres {
 public:
  Fibres(const Plan& plan, const PlannedJoint& joint) {
    if (const PlannedJoint* next = beside_clamp(plan, joint)) {
      const double sense = next->a == joint.b ? 1 : -1;
      axis_ = sense * next->axis;
      sense_ = sense;
      if (const std::optional<Section> section = section_at(plan, *next, joint.b)) add(*section);
      return;
    }
    for (const int piece : {joint.a, joint.b}) {
      if (piece < 0) continue;
      if (const std::optional<Section> section = section_at(plan, joint, piece)) add(*section);
    }
  }
  /// Of N, Q and M along the joint's axis, which is [1, 0] of a support.
  double usage(const Eigen::Vector3d& R) const {
    const double N = R[0] * axis_.x + R[1] * axis_.y, M = sense_ * R[2];
    double most = 0;
    for (const Corner& c : corners_) {
      const double share = c.N * N + c.M * M;
      most = std::max(most, share > 0 ? share : -share * c.reverse);
    }
    return most;
  }

 private:
  struct Corner {
    double N, M, reverse;  // per f_y; f_y / f_yc
  };
  // M > 0 puts the right of the axis, −y of the section, in tension; N acts at the anchor, y = 0, and bends
  // about the elastic centroid by N y_c.
  void add(const Section& section) {
    const Elastic e = section.elastic({0, -1});
    for (const Region& region : section.regions()) {
      const Material& m = region.material;
      const double f = m.yield_stress, fc = m.yield_stress_compression > 0 ? m.yield_stress_compression : f;
      const bool known = e.EA > 0;
      const double per_N = known ? m.youngs_modulus / e.EA : 1 / section.area();
      const double per_M = known ? m.youngs_modulus / e.EI : 1 / e.I;
      for (const Point& p : region.outline.outer) {
        const double bent = per_M * (e.centroid.y - p.y);
        corners_.push_back({(per_N + bent * e.centroid.y) / f, bent / f, f / fc});
      }
    }
  }
  std::vector<Corner> corners_;
  Point axis_{1, 0};  // of the section, in the axes of the forces
  double sense_ = 1;  // of M
};

}  // namespace

FirstFibre first_fibre(const Plan& plan, const StaticCheck& check, Order order) {
  std::vector<Fibres> fibres;
  for (const PlannedJoint& joint : plan.joints) fibres.emplace_back(plan, joint);
  const Between between = order == Order::first ? Between::rigid_pieces : Between::elastic_bars;
  Equilibrium statics(plan, between);
  FirstFibre least{{}, std::vector(fibres.size(), unlimited)};
  for (const LoadCase& load_case : statics.cases()) {
    if (load_case.time != check.time) continue;
    const Usage usage = [&](std::size_t i, const Deformed& state) {
      return statics.held[i] ? fibres[i].usage(state.forces.segment<3>(3 * static_cast<Eigen::Index>(i))) : 0;
    };
    const std::vector<double> reached =
        order == Order::second ? ElasticPath(plan, statics, load_case).reached(fibres.size(), usage)
                               : ductile::reached(stretches(plan, statics, load_case), fibres.size(), usage);
    for (std::size_t i = 0; i < reached.size(); ++i) {
      least.joints[i] = std::min(least.joints[i], reached[i]);
      if (reached[i] < least.factor) {
        least.joint = static_cast<int>(i);
        least.factor = reached[i];
      }
    }
  }
  return least;
}

}  // namespace ductile
