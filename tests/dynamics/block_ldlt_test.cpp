// In which order bodies are eliminated, and how much that fills.
#include "../../joint/block_ldlt.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

namespace ductile::dynamics {
namespace {

using Edges = std::vector<std::pair<int, int>>;

std::vector<int> any_numbering(int n, unsigned seed) {
  std::vector<int> number(z(n));
  std::iota(number.begin(), number.end(), 0);
  std::shuffle(number.begin(), number.end(), std::mt19937(seed));
  return number;
}

Edges tree(int n, unsigned seed) {
  std::mt19937 random(seed);
  const std::vector<int> number = any_numbering(n, seed);
  Edges edges;
  for (int i = 1; i < n; ++i) edges.emplace_back(number[z(i)], number[random() % z(i)]);
  return edges;
}

Edges ring(int n, unsigned seed) {
  const std::vector<int> number = any_numbering(n, seed);
  Edges edges;
  for (int i = 0; i < n; ++i) edges.emplace_back(number[z(i)], number[z((i + 1) % n)]);
  return edges;
}

// Blocks of L below the diagonal.
std::size_t blocks_below(int n, const Edges& edges) {
  const Vector<int> order = BlockLdlt::order_for(n, edges);
  EXPECT_TRUE(std::is_permutation(order.begin(), order.end(), any_numbering(n, 0).begin()));
  std::vector<int> number(z(n));
  for (int k = 0; k < n; ++k) number[z(order[z(k)])] = k;
  Edges numbered;
  for (const auto& [i, j] : edges) numbered.emplace_back(number[z(i)], number[z(j)]);
  BlockLdlt factor;
  factor.analyse(n, numbered);
  std::size_t count = 0;
  for (int j = 0; j < n; ++j)
    for (int i = j + 1; i < n; ++i) count += factor.has(i, j) ? 1 : 0;
  return count;
}

class Elimination : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Bodies, Elimination, testing::Values(3, 4, 64, 65, 700, 2048, 2049, 5000));

// Leaf by leaf. Of many bodies the ordering is approximate, and fills some.
TEST_P(Elimination, OfATreeFillsNothing) {
  const std::size_t least = z(GetParam() - 1), filled = blocks_below(GetParam(), tree(GetParam(), 1));
  EXPECT_GE(filled, least);
  EXPECT_LE(filled, GetParam() > 2048 ? least + least / 4 : least);
}

// Each body of a ring leaves a ring behind, with one edge that was none, but the last three.
TEST_P(Elimination, OfARingFillsOneBlockForEachBodyButThree) {
  EXPECT_EQ(blocks_below(GetParam(), ring(GetParam(), 2)), z(2 * GetParam() - 3));
}

// By the definition, with sets of neighbours. Edges repeat, and some bodies have none.
TEST(EliminationOfFew, TakesABodyWithTheFewestNeighbours) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const int n = 10 + static_cast<int>(random() % 200);
    Edges edges;
    for (int k = 0; k < 2 * n; ++k) {
      const int i = static_cast<int>(random() % z(n)), j = static_cast<int>(random() % z(n));
      if (i != j) edges.emplace_back(i, j);
    }
    std::vector<std::set<int>> neighbours(z(n));
    for (const auto& [i, j] : edges) neighbours[z(i)].insert(j), neighbours[z(j)].insert(i);
    std::set<int> left;
    for (int i = 0; i < n; ++i) left.insert(i);
    for (const int next : BlockLdlt::order_for(n, edges)) {
      ASSERT_EQ(left.erase(next), 1U);
      for (const int i : left) EXPECT_GE(neighbours[z(i)].size(), neighbours[z(next)].size());
      for (const int i : neighbours[z(next)]) {
        neighbours[z(i)].insert(neighbours[z(next)].begin(), neighbours[z(next)].end());
        neighbours[z(i)].erase(i);
        neighbours[z(i)].erase(next);
      }
    }
    EXPECT_TRUE(left.empty());
  }
}

}  // namespace
}  // namespace ductile::dynamics
