#include "block_ldlt.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "pair.h"

namespace ductile::dynamics {

namespace {

constexpr int few = 2048;  // bodies

// Minimum degree: the body with the fewest neighbours is eliminated first, which makes these neighbours of
// each other. It has its memory from the pool, where Eigen's approximate ordering asks for some a dozen
// times; of many bodies that one takes less time, and fills less.
Vector<int> order_of_few(int n, std::span<const std::pair<int, int>> edges) {
  Vector<Vector<int>> neighbours(z(n));
  for (const auto& [i, j] : edges) {
    neighbours[z(i)].push_back(j);
    neighbours[z(j)].push_back(i);
  }
  constexpr std::size_t eliminated = std::numeric_limits<std::size_t>::max();
  Vector<std::size_t> degree(z(n)), seen(z(n));
  std::size_t look = 0;
  using Candidate = std::pair<std::size_t, int>;  // degree when it was pushed, body
  constexpr std::greater<> fewest_first;
  Vector<Candidate> heap;
  heap.reserve(2 * z(n));
  for (int i = 0; i < n; ++i) {
    ++look;
    std::erase_if(neighbours[z(i)], [&](int j) { return std::exchange(seen[z(j)], look) == look; });
    degree[z(i)] = neighbours[z(i)].size();
    heap.emplace_back(degree[z(i)], i);
  }
  std::make_heap(heap.begin(), heap.end(), fewest_first);

  Vector<int> order, clique;
  order.reserve(z(n));
  while (!heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), fewest_first);
    const auto [pushed, next] = heap.back();
    heap.pop_back();
    if (degree[z(next)] != pushed) continue;
    degree[z(next)] = eliminated;
    order.push_back(next);
    clique.swap(neighbours[z(next)]);
    for (const int i : clique) {
      Vector<int>& mine = neighbours[z(i)];
      std::erase(mine, next);
      seen[z(i)] = ++look;
      for (const int j : mine) seen[z(j)] = look;
      std::copy_if(clique.begin(), clique.end(), std::back_inserter(mine),
                   [&](int j) { return seen[z(j)] != look; });
      if (std::exchange(degree[z(i)], mine.size()) == mine.size()) continue;
      heap.emplace_back(mine.size(), i);
      std::push_heap(heap.begin(), heap.end(), fewest_first);
    }
  }
  return order;
}

}  // namespace

Vector<int> BlockLdlt::order_for(int n, std::span<const std::pair<int, int>> edges) {
  if (n <= few) return order_of_few(n, edges);
  Vector<Eigen::Triplet<double>> entries;
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
  // Edges by their lower end, one list after the other.
  Vector<int> first(z(n) + 1), above(edges.size());
  for (const auto& [i, j] : edges) ++first[z(std::min(i, j)) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<int> next(first.begin(), first.end() - 1);
  for (const auto& [i, j] : edges) above[z(next[z(std::min(i, j))]++)] = std::max(i, j);

  // Symbolic elimination: the pattern of column j is its own, and that of all its children in the elimination
  // tree, which are lists, too: the youngest child, and the next older sibling of each column.
  constexpr int none = -1;
  Vector<int> youngest(z(n), none), older(z(n), none), seen(z(n), none);
  column_.assign(z(n) + 1, 0);
  row_.clear();
  row_.reserve(4 * edges.size());
  for (int j = 0; j < n; ++j) {
    const auto take = [&](int row) {
      if (std::exchange(seen[z(row)], j) != j) row_.push_back(row);
    };
    for (int k = first[z(j)]; k < first[z(j) + 1]; ++k) take(above[z(k)]);
    for (int child = youngest[z(j)]; child != none; child = older[z(child)]) {
      for (int k = column_[z(child)] + 1; k < column_[z(child) + 1]; ++k) take(row_[z(k)]);
    }
    const auto begin = row_.begin() + column_[z(j)];
    std::sort(begin, row_.end());
    column_[z(j) + 1] = static_cast<int>(row_.size());
    if (begin != row_.end()) older[z(j)] = std::exchange(youngest[z(*begin)], j);
  }
  lower_.resize(row_.size());
  diagonal_.resize(z(n));

  std::size_t longest = 0, products = 0;
  for (int j = 0; j < n; ++j) {
    const std::size_t length = z(column_[z(j) + 1] - column_[z(j)]);
    longest = std::max(longest, length);
    products += (length * length - length) / 2;
  }
  unscaled_.resize(longest);
  targets_.resize(products);
  // The rows of a column beyond its q-th are all in the column of that one, in the same order.
  int* target = targets_.data();  // of the column's pair p, q: at p (p − 1)/2 + q
  for (int j = 0; j < n; ++j) {
    const std::span<const int> rows{row_.data() + column_[z(j)], row_.data() + column_[z(j) + 1]};
    for (std::size_t q = 0; q < rows.size(); ++q) {
      int k = column_[z(rows[q])];
      for (std::size_t p = q + 1; p < rows.size(); ++p) {
        while (row_[z(k)] != rows[p]) ++k;
        target[p * (p - 1) / 2 + q] = k;
      }
    }
    target += rows.size() * (rows.size() - 1) / 2;
  }
}

int BlockLdlt::slot(int i, int j) const {
  const auto first = row_.begin() + column_[z(j)], last = row_.begin() + column_[z(j) + 1];
  return static_cast<int>(std::lower_bound(first, last, i) - row_.begin());
}

bool BlockLdlt::has(int i, int j) const {
  const int k = slot(i, j);
  return k < column_[z(j + 1)] && row_[z(k)] == i;
}

void BlockLdlt::clear() {
  std::fill(lower_.begin(), lower_.end(), Block{});
  std::fill(diagonal_.begin(), diagonal_.end(), Block{});
}

void BlockLdlt::factor() {
  const int* target = targets_.data();
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    const int first = column_[j], last = column_[j + 1];
    target = eliminate(diagonal_[j], {lower_.data() + first, lower_.data() + last}, unscaled_, target, lower_,
                       diagonal_, row_.data() + first);
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

}  // namespace ductile::dynamics
