// Two doubles that are added or multiplied at once. Compilers find few of them in products of 3×3 blocks, and
// shuffle more than they add in short loops. Without GNU's vectors they are two doubles for the compiler,
// too, with the same results.
#pragma once

#include <cstring>

namespace ductile::dynamics {

#if defined(__GNUC__) && !defined(DUCTILE_STANDARD_CPP)
using Pair [[gnu::vector_size(16)]] = double;
#else
struct Pair {
  double values[2];
  constexpr double& operator[](int i) { return values[i]; }
  constexpr double operator[](int i) const { return values[i]; }
};
inline Pair operator+(const Pair& a, const Pair& b) { return {{a[0] + b[0], a[1] + b[1]}}; }
inline Pair operator-(const Pair& a, const Pair& b) { return {{a[0] - b[0], a[1] - b[1]}}; }
inline Pair operator*(const Pair& a, const Pair& b) { return {{a[0] * b[0], a[1] * b[1]}}; }
inline Pair operator/(const Pair& a, const Pair& b) { return {{a[0] / b[0], a[1] / b[1]}}; }
inline Pair operator*(double a, const Pair& b) { return {{a * b[0], a * b[1]}}; }
inline void operator-=(Pair& a, const Pair& b) { a = a - b; }
inline void operator*=(Pair& a, double b) { a = b * a; }
#endif

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
