// Orthogonal factors of small tall matrices whose rows weigh very differently.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace ductile::dynamics {

using Row4 = std::array<double, 4>;

inline double dot(const Row4& a, const Row4& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

/// rows ← Q of rows = Q R, by Householder reflections I − β u uᵀ; columns come as they were pivoted, which
/// leaves Q Qᵀ what it is. There are at least four rows and no column is zero. `order` is scratch, as long.
///
/// With rows and columns pivoted the factors are accurate row by row, whatever the rows weigh (Cox and
/// Higham, Numerical Analysis 1997): normal equations would lose what weighs 1e-8 of the heaviest.
inline void orthogonalise(std::span<Row4> rows, std::span<std::size_t> order) {
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n; ++i) order[i] = i;
  std::array<std::size_t, 4> column{0, 1, 2, 3};
  const auto at = [&](std::size_t i, std::size_t j) -> double& { return rows[order[i]][column[j]]; };
  double beta[4];
  for (std::size_t j = 0; j < 4; ++j) {
    double longest = -1;
    std::size_t pivot = j;
    for (std::size_t k = j; k < 4; ++k) {
      double length = 0;
      for (std::size_t i = j; i < n; ++i) length += at(i, k) * at(i, k);
      if (length > longest) longest = length, pivot = k;
    }
    std::swap(column[j], column[pivot]);
    std::size_t top = j;
    for (std::size_t i = j + 1; i < n; ++i) {
      if (std::abs(at(i, j)) > std::abs(at(top, j))) top = i;
    }
    std::swap(order[j], order[top]);
    // u takes the place of the column.
    const double norm = std::copysign(std::sqrt(longest), at(j, j));
    at(j, j) += norm;
    beta[j] = 1 / (norm * at(j, j));
    for (std::size_t k = j + 1; k < 4; ++k) {
      double sum = 0;
      for (std::size_t i = j; i < n; ++i) sum += at(i, j) * at(i, k);
      for (std::size_t i = j; i < n; ++i) at(i, k) -= beta[j] * sum * at(i, j);
    }
  }
  // Column j of Q is H₀ … H_j e_j. Above row j + 1 columns k > j hold R, which is not needed.
  for (std::size_t j = 4; j-- > 0;) {
    for (std::size_t k = j + 1; k < 4; ++k) {
      at(j, k) = 0;
      double sum = 0;
      for (std::size_t i = j + 1; i < n; ++i) sum += at(i, j) * at(i, k);
      for (std::size_t i = j; i < n; ++i) at(i, k) -= beta[j] * sum * at(i, j);
    }
    const double head = beta[j] * at(j, j);
    for (std::size_t i = j; i < n; ++i) at(i, j) *= -head;
    at(j, j) += 1;
  }
}

}  // namespace ductile::dynamics
