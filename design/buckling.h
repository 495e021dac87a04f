// How near a structure is to buckling.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "equilibrium.h"

namespace ductile {

/// What the bars that a joint stands for add to the energy of rigid pieces under axial force, ½ qᵀ form q
/// with q = Σ column · x + ground.
struct BentBars {
  std::size_t joint = 0;
  Eigen::Matrix3d form = Eigen::Matrix3d::Zero();
  std::vector<std::pair<int, Eigen::Vector3d>> columns;  ///< of x
  Eigen::Vector3d ground = Eigen::Vector3d::Zero();      ///< of a support's displacement
  Eigen::Matrix3d carries = Eigen::Matrix3d::Zero();     ///< (N, Q, M) of the joint beyond k e: carries · q
};

/// Of all joints that stand for bars, under these forces of the joints. None where pieces are rigid.
std::vector<BentBars> bent_bars(const Plan& plan, const Equilibrium& statics, const Eigen::VectorXd& forces,
                                const std::function<double(const Plan::Load&)>& dead);

/// K_g beside the motions Z that strain nothing. Those that the loads hold in place, as they hold a pendulum,
/// follow all others at once: K_g − K_g Z (Zᵀ K_g Z)⁻¹ Zᵀ K_g.
class GeometricStiffness {
 public:
  GeometricStiffness(Eigen::SparseMatrix<double> K_g) : K_g_(std::move(K_g)) {}  // every motion strains
  GeometricStiffness(Eigen::SparseMatrix<double> K_g, const Eigen::MatrixXd& Z);

  /// x with the motions in it to which the loads bring what is free to follow.
  Eigen::VectorXd settled(const Eigen::VectorXd& x) const;
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const { return K_g_ * settled(x); }

  /// A motion without strain that the loads push on, however small they are; empty: none.
  Eigen::VectorXd pushed;
  /// One that they neither push on nor hold, with a part in all such motions; empty: none.
  Eigen::VectorXd adrift;

 private:
  Eigen::SparseMatrix<double> K_g_;
  Eigen::MatrixXd held_, pulled_;  // of Z what the loads hold, to Zᵀ K_g Z = 1; and K_g times it
};

/// K_g, as B's columns: the second derivatives of the joints' elongations times their forces, and of the
/// places where loads act times the loads, all of the plan's together with `dead` times as much. With the
/// bars' own where they give.
GeometricStiffness geometric_stiffness(const Plan& plan, const Equilibrium& statics,
                                       const Eigen::VectorXd& forces,
                                       const std::function<double(const Plan::Load&)>& dead);

struct Buckle {
  /// μ = max −xᵀK_g x / xᵀK x, 0 where that is negative: 1 / the buckling load. Unlimited where the loads
  /// push on a motion without strain.
  double inverse_factor = 0;
  Eigen::VectorXd mode;  ///< x; empty where there is none
};

/// Over the structures that have a part in `start`, which is best a little of every mode. By Lanczos' method
/// in the metric of K.
Buckle buckling(const Equilibrium& statics, const GeometricStiffness& K_g, const Eigen::VectorXd& start);

/// A start that has some of every mode.
Eigen::VectorXd any_motion(const Equilibrium& statics);

}  // namespace ductile
