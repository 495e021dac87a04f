// H = L D Lᵀ for a sparse symmetric positive definite matrix of 3×3 blocks whose pattern is "which bodies
// touch".
//
// The pattern is analysed once per topology; afterwards factor() and solve() neither allocate nor search.
// Rows and columns are numbered in the order of elimination, which order_for() finds (minimum degree: a chain
// or a tree eliminates without fill; of many bodies approximate minimum degree).
#pragma once

#include <cstring>
#include <span>
#include <utility>

#include "block_product.h"
#include "pool.h"
#include "vec3.h"

namespace ductile::dynamics {

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

/// Factors a diagonal block, divides the column below it by that, and subtracts what it is eliminated into: L
/// D Lᵀ of any two of its blocks, in `lower` at the next targets, and of each with itself on the diagonal of
/// its row. Returns the target after the last one.
inline const int* eliminate(Block& diagonal, std::span<Block> column, std::span<Right> unscaled,
                            const int* target, std::span<Block> lower, std::span<Block> diagonals,
                            const int* rows) {
  factor_block(diagonal);
  const Block d = diagonal;
  for (std::size_t p = 0; p < column.size(); ++p) {
    double* l = column[p].a;
    Right& own = unscaled[p];
    Left left;
    for (int i = 0; i < 3; ++i) {
      left.upper[i] = Pair{l[i], l[3 + i]};
      left.bottom[i] = l[6 + i];
      const Pair rest{l[6 + i], l[i]};
      std::memcpy(own.row[i], &left.upper[i], sizeof(Pair));
      std::memcpy(own.row[i] + 2, &rest, sizeof(Pair));
    }
    solve_block(d, left.upper[0], left.upper[1], left.upper[2]);
    solve_block(d, left.bottom[0], left.bottom[1], left.bottom[2]);
    for (int i = 0; i < 3; ++i) {
      l[i] = left.upper[i][0], l[3 + i] = left.upper[i][1], l[6 + i] = left.bottom[i];
      left.row_0[i] = Pair{l[i], l[i]};
      left.row_1[i] = Pair{l[3 + i], l[3 + i]};
      left.row_2[i] = Pair{l[6 + i], l[6 + i]};
    }
    for (std::size_t q = 0; q < p; ++q)
      subtract_product(lower[static_cast<std::size_t>(*target++)], left, unscaled[q]);
    subtract_product(diagonals[static_cast<std::size_t>(rows[p])], left, own);
  }
  return target;
}

class BlockLdlt {
 public:
  /// Elimination order of n bodies joined by `edges`: result[k] is the body to eliminate as number k.
  static Vector<int> order_for(int n, std::span<const std::pair<int, int>> edges);

  /// Prepares for n bodies in elimination order; edges (i, j), i ≠ j, may repeat. Allocates.
  void analyse(int n, std::span<const std::pair<int, int>> edges);

  /// Where the block of row i and column j (i > j) is stored; it must be in the pattern.
  int slot(int i, int j) const;
  /// Whether it is in the pattern.
  bool has(int i, int j) const;

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
  void keep(Tape& tape) { tape(lower_, diagonal_); }

 private:
  friend class BlockLu;  // of the same pattern

  // Column j holds the blocks lower_[column_[j]] … lower_[column_[j + 1]) in rows row_[…], ascending.
  Vector<int> column_, row_;
  Vector<Block> lower_;
  Vector<Block> diagonal_;  // after factor(): L₃ and 1/D₃ of the block's own scalar L D Lᵀ
  // For each column and each pair p > q of its blocks, where in lower_ L_p D L_qᵀ is subtracted.
  Vector<int> targets_;
  Vector<Right> unscaled_;  // the current column before its division by D, transposed
};

}  // namespace ductile::dynamics
