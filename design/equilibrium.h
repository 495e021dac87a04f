// Statics of a plan's pieces and joints: Bᵀ R = f.
//
// The unknowns of motion are those of the pieces that can move and are held: (x, y, θ) of each about its
// centre of mass, scaled by √m and √I, so that columns of bodies of any size compare. B maps them to the
// joints' elongations (u, v, θ), and by its transpose forces R = (N, Q, M) to loads on the pieces. A joint's
// rows stand at 3·joint; a free row and those of loose structures are empty.
#pragma once

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <memory>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

/// Loads that act at one time, as B's columns.
struct LoadCase {
  double time = 0;  // s, from when on
  Eigen::VectorXd gravity, loads;
  Eigen::VectorXd elongation;  // by joints' rows, beyond what the pieces' motions make of it: of bars that
                               // loads bend between pieces (bars.h) and of supports whose ground moves
  Eigen::VectorXd prestress;  // the same of lines that are not as long as they are drawn: with the structure,
                              // not with the loads
};

/// Motions, and the joints' forces.
struct ElasticState {
  Eigen::VectorXd x, forces;
};

/// What gives between the joints: nothing, as in a simulation, or the bars that joints stand for (bars.h).
enum class Between { rigid_pieces, elastic_bars };

/// A bar from the middle of a piece to a joint (bars.h).
struct Arm {
  double length = 0;  ///< m; 0: none
  double EI = 0;      ///< N m²
  Point along;        ///< unit, toward the joint
  double GA = 0;      ///< N, with the shear coefficient; 0: not known
};

/// √k of one joint: (N, Q, M) = √kᵀ √k (u, v, θ).
using Root = Eigen::Matrix3d;

class Equilibrium {
 public:
  /// Throws InvalidInput where no joint holds anything that could move.
  explicit Equilibrium(const Plan& plan, Between between = Between::rigid_pieces);
  ~Equilibrium();

  Eigen::SparseMatrix<double> B;
  std::vector<int> column;  // of pieces: 3 columns from here on; −1: stands still or is loose
  std::vector<int> loose;   // pieces
  std::vector<bool> held;   // joints of structures that are held
  std::array<double, 3> scale(int piece) const;  // of (x, y, θ): motion = scale · unknown

  /// A force with its moment about the piece's centre, added to loads by columns.
  void add(Eigen::VectorXd& f, int piece, Point force, double moment) const;
  Eigen::VectorXd gravity() const;
  Eigen::VectorXd load(const Plan::Load& load) const;
  std::vector<LoadCase> cases() const;
  /// Takes ropes and struts that are slack under so many times these loads, of first order, out of the
  /// structure. Returns the factor up to which the same ones are. Throws as balanced() does.
  double let_slack(const LoadCase& load_case, double factor = 1);
  /// Of first order, of the loads alone and of prestress alone. Throws as balanced() does.
  ElasticState elastic(const LoadCase& load_case) const;
  ElasticState prestressed(const LoadCase& load_case) const { return imposed(load_case.prestress); }

  /// Motions that no joint resists.
  Eigen::Index freedoms() const;
  bool is_mechanism() const { return freedoms() > 0; }
  /// A basis of them, orthonormal in B's columns.
  Eigen::MatrixXd free_motions() const;

  /// By joints, of a and b; empty where pieces are rigid.
  const std::vector<std::array<Arm, 2>>& arms() const { return arms_; }
  /// Stiffness of every row (0: free), rigid ones replaced.
  const Eigen::VectorXd& stiffness() const { return k_; }
  /// Whether a row's stiffness is the plan's or that of bars: false where it stands for a rigid or a free
  /// one.
  bool gives(Eigen::Index row) const;
  /// stiffness() joint by joint, with the bars where they give.
  std::vector<Root> roots() const;
  /// Gives every joint another stiffness, as where it flows; stiffness() and roots() stay what they are.
  void stiffen(const std::vector<Root>& roots);

  /// Forces R in equilibrium with f, those of least energy.
  Eigen::VectorXd forces(const Eigen::VectorXd& f) const;
  /// The forces that go with motions.
  Eigen::VectorXd resist(const Eigen::VectorXd& x) const { return root_.transpose() * (root_ * (B * x)); }
  /// Motions x with K x = f, K = Bᵀ k B; 0 in the directions of a mechanism.
  Eigen::VectorXd motions(const Eigen::VectorXd& f) const;
  /// To elongations e without loads: R = k (B x + e), Bᵀ R = 0.
  ElasticState imposed(const Eigen::VectorXd& elongation) const;
  /// cᵀ x of those motions for f = c: what a functional c of the motion gives way to a unit load on it.
  double flexibility(const Eigen::SparseVector<double>& c) const;
  /// Whether it does not move a mechanism, but for rounding.
  bool bears(const Eigen::VectorXd& f) const;
  /// f without what would drive a mechanism. Throws InvalidInput, naming the piece, where that is more than
  /// rounding: 1e-6 of the load on it.
  Eigen::VectorXd balanced(const Eigen::VectorXd& f) const;

 private:
  void bend(const Plan::Load& load, Eigen::VectorXd& elongation) const;
  void number_columns();
  void fill();
  void set_stiffness();
  Eigen::VectorXd least_energy(const Eigen::VectorXd& f) const;

  const Plan& plan_;
  Eigen::VectorXd k_;
  std::vector<std::array<Arm, 2>> arms_;
  Eigen::SparseMatrix<double> root_;  // of all joints on the diagonal
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

}  // namespace ductile
