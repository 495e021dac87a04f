// H = L D Lᵀ for a sparse symmetric positive definite matrix of 3×3 blocks whose pattern is "which bodies
// touch".
//
// The pattern is analysed once per topology; afterwards factor() and solve() neither allocate nor search.
// Rows and columns are numbered in the order of elimination, which order_for() finds (approximate minimum
// degree: a chain or a tree eliminates without fill).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "vec3.h"

namespace ductile::dynamics {

/// A 3×3 block, row by row.
struct Block {
  double a[9];
};

template <>
inline constexpr bool all_doubles<Block> = true;

/// Scalar L D Lᵀ of one block, in place: below the diagonal L, on it 1/D. Reads the lower triangle only.
inline void factor_block(Block& block) {
  double* a = block.a;
  const double d0 = 1 / a[0];
  const double l10 = a[3] * d0, l20 = a[6] * d0;
  const double d1 = 1 / (a[4] - l10 * a[3]);
  const double t21 = a[7] - l20 * a[3];
  const double l21 = t21 * d1;
  const double d2 = 1 / (a[8] - l20 * a[6] - l21 * t21);
  a[0] = d0, a[3] = l10, a[4] = d1, a[6] = l20, a[7] = l21, a[8] = d2;
}

/// (x0, x1, x2) ← block⁻¹ (x0, x1, x2) of a factored block; of several at once where a Number is several.
template <class Number>
void solve_block(const Block& block, Number& x0, Number& x1, Number& x2) {
  const double* a = block.a;
  x1 -= a[3] * x0;
  x2 -= a[6] * x0 + a[7] * x1;
  x2 *= a[8];
  x1 = a[4] * x1 - a[7] * x2;
  x0 = a[0] * x0 - a[3] * x1 - a[6] * x2;
}

class BlockLdlt {
 public:
  /// Elimination order of n bodies joined by `edges`: result[k] is the body to eliminate as number k.
  static std::vector<int> order_for(int n, std::span<const std::pair<int, int>> edges);

  /// Prepares for n bodies in elimination order; edges (i, j), i ≠ j, may repeat. Allocates.
  void analyse(int n, std::span<const std::pair<int, int>> edges);

  /// Where the block of row i and column j (i > j) is stored; it must be in the pattern.
  int slot(int i, int j) const;

  /// Assembly: everything zero, then add to diagonal(i) (its lower triangle counts) and to block(slot).
  void clear();
  Block& diagonal(int i) { return diagonal_[static_cast<std::size_t>(i)]; }
  Block& block(int slot) { return lower_[static_cast<std::size_t>(slot)]; }

  /// Factors what was assembled, in place.
  void factor();

  /// x ← H⁻¹ x with the last factor.
  void solve(std::span<Vec3> x) const {
    forward(x);
    backward(x);
  }
  /// Its halves: x ← D⁻¹ L⁻¹ x, which costs as much as x has entries and what they reach, and gives xᵀ H⁻¹ x
  /// of the x it was given; then x ← L⁻ᵀ x.
  double forward(std::span<Vec3> x) const;
  void backward(std::span<Vec3> x) const;

  int size() const { return static_cast<int>(diagonal_.size()); }
  /// Block products of one factorisation and of one solve: what each costs.
  std::size_t factor_work() const { return targets_.size() + 2 * lower_.size() + diagonal_.size(); }
  std::size_t solve_work() const { return (2 * lower_.size() + diagonal_.size()) / 3; }
  std::size_t bytes() const;
  void keep(Tape& tape) { tape(lower_, diagonal_); }

 private:
  // Column j holds the blocks lower_[column_[j]] … lower_[column_[j + 1]) in rows row_[…], ascending.
  std::vector<int> column_, row_;
  std::vector<Block> lower_;
  std::vector<Block> diagonal_;  // after factor(): L₃ and 1/D₃ of the block's own scalar L D Lᵀ
  // For each column and each pair p > q of its blocks, where in lower_ L_p D L_qᵀ is subtracted.
  std::vector<int> targets_;
  // A block transposed, the first entry of each row once more at its end: any two entries that follow each
  // other in a product are made of two that follow each other here.
  struct RightFactor {
    double row[3][4];
  };
  std::vector<RightFactor> unscaled_;  // the current column before its division by D
};

}  // namespace ductile::dynamics
