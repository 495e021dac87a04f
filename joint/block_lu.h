// H = L U for a matrix of 3×3 blocks whose pattern is symmetric, and whose values are not: friction follows
// the normal impulse, which does not follow friction.
//
// The pattern is that of a BlockLdlt, and so is the order of elimination; there is no pivoting but within the
// blocks on the diagonal.
#pragma once

#include <array>
#include <span>

#include "block_ldlt.h"

namespace ductile::dynamics {

class BlockLu {
 public:
  /// Takes over what was assembled there, before it is factored: symmetric so far. Allocates where no pattern
  /// before was as large.
  void take(const BlockLdlt& symmetric);
  /// Of body i: to add to its block on the diagonal, no longer symmetric.
  Block& diagonal(int i) {
    skew_[static_cast<std::size_t>(i)] = 1;
    return diagonal_[static_cast<std::size_t>(i)];
  }
  /// Of two such bodies i > j: the block of row i and column j, and what the one of row j and column i,
  /// transposed, is more than that.
  Block& lower(int slot) { return lower_[static_cast<std::size_t>(slot)]; }
  Block& excess(int slot) { return upper_[static_cast<std::size_t>(slot)]; }

  /// Factors it in place.
  void factor(const BlockLdlt& pattern);
  /// x ← H⁻¹ x with the last factor.
  void solve(const BlockLdlt& pattern, std::span<Vec3> x) const;

 private:
  // Columns in which L and U differ: of such bodies, and of those that these are eliminated into.
  Vector<char> skew_;
  // After factor() as BlockLdlt's; of skew columns the block's own P D = L U, with the pivots' reciprocals.
  Vector<Block> diagonal_;
  Vector<std::array<unsigned char, 3>> rows_;  // P
  // L; in skew columns A U⁻¹ and (L⁻¹ P A)ᵀ with that L and U. Until its turn comes, an upper block is what
  // its transpose is more than the lower one.
  Vector<Block> lower_, upper_;
  struct Factors {
    Left left, upper_left;
    Right right, upper_right;
  };
  Vector<Factors> column_;  // the current one, of L and of Uᵀ
  Vector<Right> unscaled_;
};

}  // namespace ductile::dynamics
