// Two doubles that are added or multiplied at once. Compilers find few of them in products of 3×3 blocks, and
// shuffle more than they add in short loops.
#pragma once

#include <cstring>

namespace ductile::dynamics {

using Pair [[gnu::vector_size(16)]] = double;

inline Pair load(const double* from) {
  Pair pair;
  std::memcpy(&pair, from, sizeof pair);
  return pair;
}

inline void add(double* to, const Pair& what) {
  const Pair sum = load(to) + what;
  std::memcpy(to, &sum, sizeof sum);
}

inline void subtract(double* from, const Pair& what) {
  const Pair left = load(from) - what;
  std::memcpy(from, &left, sizeof left);
}

inline Pair swapped(const Pair& p) { return Pair{p[1], p[0]}; }

}  // namespace ductile::dynamics
