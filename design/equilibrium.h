// Statics of a plan's pieces and joints: Bᵀ R = f.
//
// The unknowns of motion are those of the pieces that can move and are held: (x, y, θ) of each about its
// centre of mass, scaled by √m and √I, so that columns of bodies of any size compare. B maps them to the
// joints' elongations (u, v, θ), and by its transpose forces R = (N, Q, M) to loads on the pieces. A joint's
// rows stand at 3·joint; a free row and those of loose structures are empty.
#pragma once

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
};

class Equilibrium {
 public:
  /// Throws InvalidInput where no joint holds anything that could move.
  explicit Equilibrium(const Plan& plan);
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

  bool is_mechanism() const;

  /// Stiffness of every row (0: free), rigid ones replaced.
  const Eigen::VectorXd& stiffness() const { return k_; }

  /// Forces R in equilibrium with f, those of least Σ R²/k.
  Eigen::VectorXd forces(const Eigen::VectorXd& f) const;
  /// Motions x with Bᵀ k B x = f; 0 in the directions of a mechanism.
  Eigen::VectorXd motions(const Eigen::VectorXd& f) const;
  /// cᵀ x of those motions for f = c: what a functional c of the motion gives way to a unit load on it.
  double flexibility(const Eigen::SparseVector<double>& c) const;
  /// f without what would drive a mechanism. Throws InvalidInput, naming the piece, where that is more than
  /// rounding: 1e-6 of the load on it.
  Eigen::VectorXd balanced(const Eigen::VectorXd& f) const;

 private:
  void find_loose();
  void fill();
  void set_stiffness();
  Eigen::VectorXd least_energy(const Eigen::VectorXd& f) const;

  const Plan& plan_;
  Eigen::VectorXd k_;
  struct Factors;
  std::unique_ptr<const Factors> factors_;
};

}  // namespace ductile
