#include "block_ldlt.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>

namespace ductile {

namespace {

inline Block transposed(const Block& block) {
  const double* a = block.a;
  return {{a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]}};
}

// target −= l t. Row by row, and with t nowhere else: so the compiler takes entries in pairs.
inline void subtract_product(double* __restrict target, const double* l, const double* __restrict t) {
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = l[3 * i], y = l[3 * i + 1], w = l[3 * i + 2];
    for (std::size_t j = 0; j < 3; ++j) target[3 * i + j] -= x * t[j] + y * t[3 + j] + w * t[6 + j];
  }
}

constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<int> BlockLdlt::order_for(int n, std::span<const std::pair<int, int>> edges) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(z(n) + 2 * edges.size());
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : edges) {
    entries.emplace_back(i, j, 1.0);
    entries.emplace_back(j, i, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  return {permutation.indices().data(), permutation.indices().data() + n};
}

void BlockLdlt::analyse(int n, std::span<const std::pair<int, int>> edges) {
  // Symbolic elimination: the pattern of column j is its own, and that of all its children in the elimination
  // tree.
  std::vector<std::vector<int>> rows(z(n)), children(z(n));
  for (const auto& [i, j] : edges) rows[z(std::min(i, j))].push_back(std::max(i, j));
  for (int j = 0; j < n; ++j) {
    auto& column = rows[z(j)];
    for (const int child : children[z(j)]) {
      const auto& below = rows[z(child)];
      column.insert(column.end(), below.begin() + 1, below.end());
    }
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    if (!column.empty()) children[z(column.front())].push_back(j);
  }

  column_.assign(z(n) + 1, 0);
  row_.clear();
  for (int j = 0; j < n; ++j) {
    row_.insert(row_.end(), rows[z(j)].begin(), rows[z(j)].end());
    column_[z(j) + 1] = static_cast<int>(row_.size());
  }
  lower_.resize(row_.size());
  diagonal_.resize(z(n));

  targets_.clear();
  std::size_t longest = 0;
  for (int j = 0; j < n; ++j) {
    const auto& column = rows[z(j)];
    longest = std::max(longest, column.size());
    for (std::size_t p = 0; p < column.size(); ++p) {
      for (std::size_t q = 0; q < p; ++q) targets_.push_back(slot(column[p], column[q]));
      targets_.push_back(-1 - column[p]);
    }
  }
  unscaled_.resize(longest);
}

int BlockLdlt::slot(int i, int j) const {
  const auto first = row_.begin() + column_[z(j)], last = row_.begin() + column_[z(j) + 1];
  return static_cast<int>(std::lower_bound(first, last, i) - row_.begin());
}

void BlockLdlt::clear() {
  std::fill(lower_.begin(), lower_.end(), Block{});
  std::fill(diagonal_.begin(), diagonal_.end(), Block{});
}

void BlockLdlt::factor() {
  const int* target = targets_.data();
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    const Block& d = diagonal_[j];
    factor_block(diagonal_[j]);
    Block* const column = lower_.data() + column_[j];
    const int count = column_[j + 1] - column_[j];
    for (int p = 0; p < count; ++p) {
      double* l = column[p].a;
      unscaled_[z(p)] = transposed(column[p]);
      for (std::size_t i = 0; i < 3; ++i) solve_block(d, l[3 * i], l[3 * i + 1], l[3 * i + 2]);
      for (int q = 0; q <= p; ++q) {
        const int place = *target++;
        subtract_product(place < 0 ? diagonal_[z(-1 - place)].a : lower_[z(place)].a, l, unscaled_[z(q)].a);
      }
    }
  }
}

double BlockLdlt::forward(std::span<Vec3> x) const {
  double energy = 0;
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    const Vec3 v{x[j].x, x[j].y, x[j].w};
    if (v.x == 0 && v.y == 0 && v.w == 0) continue;
    for (int k = column_[j]; k < column_[j + 1]; ++k) {
      const double* l = lower_[z(k)].a;
      Vec3& r = x[z(row_[z(k)])];
      r.x -= l[0] * v.x + l[1] * v.y + l[2] * v.w;
      r.y -= l[3] * v.x + l[4] * v.y + l[5] * v.w;
      r.w -= l[6] * v.x + l[7] * v.y + l[8] * v.w;
    }
    solve_block(diagonal_[j], x[j].x, x[j].y, x[j].w);
    energy += dot(v, x[j]);
  }
  return energy;
}

void BlockLdlt::backward(std::span<Vec3> x) const {
  for (std::size_t j = diagonal_.size(); j-- > 0;) {
    Vec3 v = x[j];
    for (int k = column_[j]; k < column_[j + 1]; ++k) {
      const double* l = lower_[z(k)].a;
      const Vec3& r = x[z(row_[z(k)])];
      v.x -= l[0] * r.x + l[3] * r.y + l[6] * r.w;
      v.y -= l[1] * r.x + l[4] * r.y + l[7] * r.w;
      v.w -= l[2] * r.x + l[5] * r.y + l[8] * r.w;
    }
    x[j] = v;
  }
}

std::size_t BlockLdlt::bytes() const {
  return (column_.size() + row_.size() + targets_.size()) * sizeof(int) +
         (lower_.size() + diagonal_.size() + unscaled_.size()) * sizeof(Block);
}

}  // namespace ductile
