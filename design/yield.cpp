#include "yield.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ductile/box2d.h"

namespace ductile {

double cap(const PlannedJoint& joint, Row row, bool reverse) {
  return row == axial      ? (reverse ? joint.Nc : joint.N)
         : row == rotation ? (reverse ? joint.M_reverse : joint.M)
                           : joint.Q;
}

bool is_free(const PlannedJoint& joint, Row row) {
  return cap(joint, row, false) == 0 && cap(joint, row, true) == 0;
}

Yield::Yield(const Plan& plan, const PlannedJoint& joint) : joint_(joint) {
  if (!plan.interaction) return;
  const std::vector<AxialMoment> polygon = interaction_of(plan, joint);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const AxialMoment &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double twice_area = p.N * q.M - p.M * q.N;
    facets.push_back({(q.M - p.M) / twice_area, (p.N - q.N) / twice_area});
    most_ = {std::max(most_.N, p.N), std::max(most_.M, p.M)};
    least_ = {std::min(least_.N, p.N), std::min(least_.M, p.M)};
  }
}

double Yield::reach(Row row, bool reverse) const {
  if (facets.empty() || row == shear) return cap(row, reverse);
  if (row == axial) return reverse ? -least_.N : most_.N;
  return reverse ? -least_.M : most_.M;
}

double Yield::usage(Row row, double value) const {
  const double limit = cap(row, value < 0);
  if (limit == unlimited) return std::numeric_limits<double>::quiet_NaN();
  if (is_free(row) || value == 0) return 0;
  return std::abs(value) / limit;
}

const Yield::Facet& Yield::steepest(double N, double M) const {
  return *std::max_element(facets.begin(), facets.end(), [&](const Facet& a, const Facet& b) {
    return a.n * N + a.m * M < b.n * N + b.m * M;
  });
}

double Yield::usage(const std::array<double, 3>& force) const {
  const double q = std::fmax(0, usage(shear, force[1]));  // 0 for NaN
  if (facets.empty()) return std::fmax(q, std::fmax(usage(axial, force[0]), usage(rotation, force[2])));
  const Facet& f = steepest(force[0], force[2]);
  return std::hypot(f.n * force[0] + f.m * force[2], q);
}

}  // namespace ductile
