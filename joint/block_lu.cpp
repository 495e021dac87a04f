#include "block_lu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace ductile::dynamics {

namespace {

// P D = L U of one block, with pivots by columns; the pivots' reciprocals.
std::array<unsigned char, 3> factor_with_pivots(Block& block) {
  double* m = block.a;
  std::array<unsigned char, 3> rows{0, 1, 2};
  for (std::size_t j = 0; j < 3; ++j) {
    std::size_t pivot = j;
    for (std::size_t i = j + 1; i < 3; ++i)
      if (std::abs(m[3 * i + j]) > std::abs(m[3 * pivot + j])) pivot = i;
    if (pivot != j) {
      std::swap_ranges(m + 3 * j, m + 3 * j + 3, m + 3 * pivot);
      std::swap(rows[j], rows[pivot]);
    }
    m[4 * j] = 1 / m[4 * j];
    for (std::size_t i = j + 1; i < 3; ++i) {
      m[3 * i + j] *= m[4 * j];
      for (std::size_t k = j + 1; k < 3; ++k) m[3 * i + k] -= m[3 * i + j] * m[3 * j + k];
    }
  }
  return rows;
}

// Row by row x ← x U⁻¹.
void divide_by_upper(Block& block, const Block& of) {
  const double* u = of.a;
  for (double* x = block.a; x != block.a + 9; x += 3) {
    x[0] *= u[0];
    x[1] = (x[1] - x[0] * u[1]) * u[4];
    x[2] = (x[2] - x[0] * u[2] - x[1] * u[5]) * u[8];
  }
}

// x ← L⁻¹ P x
void divide_by_lower(double* x, const Block& of, const std::array<unsigned char, 3>& rows) {
  const double* l = of.a;
  const double y0 = x[rows[0]], y1 = x[rows[1]] - l[3] * y0, y2 = x[rows[2]] - l[6] * y0 - l[7] * y1;
  x[0] = y0, x[1] = y1, x[2] = y2;
}

void add(Block& to, const Block& what) {
  for (int i = 0; i < 9; ++i) to.a[i] += what.a[i];
}

Vec3 transposed_times(const Block& b, const Vec3& x) {
  const double* a = b.a;
  return {a[0] * x.x + a[3] * x.y + a[6] * x.w, a[1] * x.x + a[4] * x.y + a[7] * x.w,
          a[2] * x.x + a[5] * x.y + a[8] * x.w};
}

Vec3 times(const Block& b, const Vec3& x) {
  const double* a = b.a;
  return {a[0] * x.x + a[1] * x.y + a[2] * x.w, a[3] * x.x + a[4] * x.y + a[5] * x.w,
          a[6] * x.x + a[7] * x.y + a[8] * x.w};
}

}  // namespace

void BlockLu::take(const BlockLdlt& symmetric) {
  diagonal_ = symmetric.diagonal_;
  lower_ = symmetric.lower_;
  skew_.assign(diagonal_.size(), 0);
  rows_.resize(diagonal_.size());
  upper_.assign(lower_.size(), {});
  unscaled_.resize(symmetric.unscaled_.size());
  column_.resize(unscaled_.size());
}

void BlockLu::factor(const BlockLdlt& pattern) {
  const int* target = pattern.targets_.data();
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    const int first = pattern.column_[j], last = pattern.column_[j + 1];
    if (skew_[j] == 0) {
      target = eliminate(diagonal_[j], {lower_.data() + first, lower_.data() + last}, unscaled_, target,
                         lower_, diagonal_, pattern.row_.data() + first);
      continue;
    }
    if (first < last) skew_[z(pattern.row_[z(first)])] = 1;
    rows_[j] = factor_with_pivots(diagonal_[j]);
    for (int k = first; k < last; ++k) {
      Factors& own = column_[z(k - first)];
      add(upper_[z(k)], lower_[z(k)]);
      divide_by_upper(lower_[z(k)], diagonal_[j]);
      for (double* row = upper_[z(k)].a; row != upper_[z(k)].a + 9; row += 3)
        divide_by_lower(row, diagonal_[j], rows_[j]);
      own = {left_of(lower_[z(k)]), left_of(upper_[z(k)]), right_of_transposed(lower_[z(k)]),
             right_of_transposed(upper_[z(k)])};
      for (int q = 0; q < k - first; ++q, ++target) {
        const Factors& other = column_[z(q)];
        Block change{};
        subtract_product(change, own.left, other.upper_right);
        add(lower_[z(*target)], change);
        for (int i = 0; i < 9; ++i) change.a[i] = -change.a[i];
        subtract_product(change, own.upper_left, other.right);
        add(upper_[z(*target)], change);
      }
      subtract_product(diagonal_[z(pattern.row_[z(k)])], own.left, own.upper_right);
    }
  }
}

void BlockLu::solve(const BlockLdlt& pattern, std::span<Vec3> x) const {
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    if (skew_[j] != 0) {
      double v[3] = {x[j].x, x[j].y, x[j].w};
      divide_by_lower(v, diagonal_[j], rows_[j]);
      x[j] = {v[0], v[1], v[2]};
    }
    const Vec3 v = x[j];
    for (int k = pattern.column_[j]; k < pattern.column_[j + 1]; ++k)
      x[z(pattern.row_[z(k)])] -= times(lower_[z(k)], v);
    if (skew_[j] == 0) solve_block(diagonal_[j], x[j].x, x[j].y, x[j].w);
  }
  for (std::size_t j = diagonal_.size(); j-- > 0;) {
    Vec3 v = x[j];
    for (int k = pattern.column_[j]; k < pattern.column_[j + 1]; ++k) {
      const Vec3& r = x[z(pattern.row_[z(k)])];
      v -= transposed_times(skew_[j] == 0 ? lower_[z(k)] : upper_[z(k)], r);
    }
    if (skew_[j] != 0) {
      const double* u = diagonal_[j].a;
      v.w *= u[8];
      v.y = (v.y - u[5] * v.w) * u[4];
      v.x = (v.x - u[1] * v.y - u[2] * v.w) * u[0];
    }
    x[j] = v;
  }
}

}  // namespace ductile::dynamics
