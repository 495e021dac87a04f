#include "flow.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace ductile {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Flow::Flow(const Plan& plan, const Equilibrium& statics, const std::vector<Yield>& yields)
    : statics_(statics), yields_(yields), elastic_(statics.roots()), planes_(plan.joints.size()) {}

Flow::Most Flow::most_used(const VectorXd& forces, const std::vector<Most>& but) const {
  Most most;
  const auto look = [&](std::size_t i, double usage, int of, const auto& normal) {
    if (!(usage > most.usage)) return;
    for (const YieldPlane& plane : planes_[i])
      if (plane.of == of) return;
    for (const Most& other : but)
      if (other.joint == static_cast<int>(i) && other.plane.of == of) return;
    most = {usage, static_cast<int>(i), {of, normal()}};
  };
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!statics_.held[i]) continue;
    const Yield& yield = yields_[i];
    const Vector3d R = forces.segment<3>(3 * static_cast<Index>(i));
    for (const Row row : {axial, shear, rotation}) {
      if (yield.is_free(row) || (!yield.facets.empty() && row != shear)) continue;
      const bool reverse = R[row] < 0;
      look(i, yield.usage(row, R[row]), 2 * static_cast<int>(row) + reverse,
           [&] { return Vector3d((reverse ? -1 : 1) / yield.cap(row, reverse) * Vector3d::Unit(row)); });
    }
    const double q = std::fmax(0, yield.usage(shear, R[1]));
    for (std::size_t f = 0; f < yield.facets.size(); ++f) {
      const Yield::Facet& facet = yield.facets[f];
      const double p = facet.n * R[0] + facet.m * R[2], used = std::hypot(p, q);
      if (p <= 0) continue;
      look(i, used, 6 + static_cast<int>(f), [&] {  // tangent to p² + q² = 1 at (p, q)/used
        const double per_Q = q > 0 ? q / used * q / R[1] : 0;
        return Vector3d(p / used * facet.n, per_Q, p / used * facet.m);
      });
    }
  }
  return most;
}

void Flow::add(int joint, const YieldPlane& plane) {
  planes_[static_cast<std::size_t>(joint)].push_back(plane);
}

MatrixXd Flow::normals(std::size_t joint) const {
  const std::vector<YieldPlane>& planes = planes_[joint];
  MatrixXd result(3, static_cast<Index>(planes.size()));
  for (std::size_t i = 0; i < planes.size(); ++i)
    result.col(static_cast<Index>(i)) = elastic_[joint] * planes[i].normal;
  return result;
}

std::vector<Root> Flow::roots(double share_of_flow) const {
  std::vector<Root> roots = elastic_;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (planes_[i].empty()) continue;
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(normals(i).colwise().normalized());
    const MatrixXd basis = MatrixXd(qr.householderQ()).leftCols(qr.rank());
    Root keeps = Root::Identity() - (1 - share_of_flow) * basis * basis.transpose();
    keeps = (keeps.array().abs() < 1e-12).select(0, keeps);
    roots[i] = keeps * elastic_[i];
  }
  return roots;
}

// ζ̇ ≥ 0 of least |√k ė − √k normals ζ̇|.
bool Flow::unload(const VectorXd& rates) {
  double worst = 0;
  std::size_t joint = 0;
  Index plane = 0;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (planes_[i].empty()) continue;
    const MatrixXd own = normals(i);
    const Vector3d rate = elastic_[i] * rates.segment<3>(3 * static_cast<Index>(i));
    const VectorXd flow = own.colPivHouseholderQr().solve(rate);
    for (Index p = 0; p < flow.size(); ++p) {
      const double backward = -flow[p] * own.col(p).norm() / std::max(rate.norm(), 1e-300);
      if (backward > std::max(worst, 1e-9)) worst = backward, joint = i, plane = p;
    }
  }
  if (worst > 0) planes_[joint].erase(planes_[joint].begin() + plane);
  return worst > 0;
}

}  // namespace ductile
