// Which joints flow as loads grow, and how stiff they leave the structure.
#pragma once

#include <vector>

#include "equilibrium.h"
#include "yield.h"

namespace ductile {

/// A plane of a joint's yield surface: normal · (N, Q, M) ≤ 1. Shear's round surface has one where it is met.
struct YieldPlane {
  int of = 0;  ///< which: 2·row + reverse of the caps, or 6 + facet
  Eigen::Vector3d normal;
};

/// The planes on which joints flow. Forces stay on them, flow is along their normals (associated).
class Flow {
 public:
  Flow(const Plan& plan, const Equilibrium& statics, const std::vector<Yield>& yields);

  /// The most that any plane is used on which its joint does not flow, and that plane.
  struct Most {
    double usage = 0;
    int joint = -1;
    YieldPlane plane;
  };
  Most most_used(const Eigen::VectorXd& forces, const std::vector<Most>& but = {}) const;

  void add(int joint, const YieldPlane& plane);

  /// √k of all joints without what flows, or with a share of it: P √k, P the projector on what the planes'
  /// √k·normals leave.
  std::vector<Root> roots(double share_of_flow = 0) const;

  /// Lets go of the plane whose flow would go backward the most under elongations that grow at these rates;
  /// false: there is none.
  bool unload(const Eigen::VectorXd& elongation_rates);

 private:
  /// Of the planes of a joint: √k·normals, column by column.
  Eigen::MatrixXd normals(std::size_t joint) const;

  const Equilibrium& statics_;
  const std::vector<Yield>& yields_;
  std::vector<Root> elastic_;
  std::vector<std::vector<YieldPlane>> planes_;
};

}  // namespace ductile
