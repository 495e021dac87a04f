// Bounds of what a plan's structures may ever have to carry, as long as nothing yields.
//
// With K = Bᵀ k B and unknowns scaled so that M = 1 (equilibrium.h), a structure at rest to which a load f is
// applied swings about its static answer x_s = K⁻¹ f, and energy bounds the swing y = x − x_s, whatever its
// modes: ½ yᵀKy + ½ ẏᵀẏ never grows. Applied at once it starts with a² = x_sᵀ K x_s; over a ramp T with two
// jumps of the velocity by x_s/T, so with a ≤ 2‖x_s‖/T, whichever is less. Taken off at once: the first
// again. Impacts add the kinetic energy of what is around: a² = 2E. All add up, and by Cauchy and Schwarz a
// linear functional c of the motion is within c·x_s ± a √(cᵀ K⁻¹ c).
//
// What leans under its load leans more (P–Δ): with the geometric stiffness K_g of all loads together and
// μ = max −xᵀK_g x / xᵀK x, the inverse of the buckling load factor, K + K_g ≥ (1 − μ) K. Then the static
// answer is within μ/(1 − μ) ‖x_s‖_K of the first-order one, in the same norm, and swings grow by
// (1 − μ)^−3/2 at most. Nothing is bounded where μ ≥ 1.
#pragma once

#include <vector>

#include "equilibrium.h"

namespace ductile {

class Response {
 public:
  /// `impact`: J that contacts may bring into each structure beside what is loose around (around.h). Throws
  /// InvalidInput as Equilibrium does.
  Response(const Plan& plan, double impact);

  /// Of a row, 3·joint + row: the largest |force| that statics and swing give.
  double force(int row) const;
  /// Static part of it alone.
  double rest(int row) const;

  /// Structures hang together by joints between moving pieces; −1: stands still or is loose.
  const std::vector<int>& structure() const { return structure_; }
  int structures() const { return static_cast<int>(swing_.size()); }

  /// How far apart a point may be in this plan and in a leaner one of the same pieces (null: where
  /// none of them moves), m.
  double apart(const Response* lean, int piece, Point at) const;

  /// J that may hit each structure, all in all.
  double impact() const { return impact_; }
  const Equilibrium& statics() const { return statics_; }

 private:
  struct Answer {  // to one load at its full value
    Eigen::VectorXd motion, forces;
  };
  void find_structures();
  void add(const Eigen::VectorXd& f, double ramp, bool ends);
  void lean();
  /// The displacement of a point along x or y, as a functional of the motion.
  Eigen::SparseVector<double> functional(int piece, Point at, bool along_y) const;
  double swing(const Eigen::SparseVector<double>& functional, int piece) const;

  const Plan& plan_;
  Equilibrium statics_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> rows_;  // of its B
  double impact_;
  std::vector<int> structure_;        // of pieces
  std::vector<int> of_column_;        // structure of each column of B
  std::vector<Answer> answers_;       // gravity, then the loads
  std::vector<double> swing_;         // a of each structure, √J
  std::vector<double> strain_;        // Σ ‖x_s‖_K of each, √J
  mutable Eigen::VectorXd leverage_;  // of rows: k B K⁻¹ Bᵀ, between 0 and 1; negative: not yet known
};

}  // namespace ductile
