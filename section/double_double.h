// Numbers of twice the precision of double (106 bits), as the unevaluated sum of two doubles.
//
// For sums that cancel: the area of a thin plate is a difference of products a million times larger.
// Error-free sum (Knuth, The Art of Computer Programming 2, 4.2.2) and product (by fused multiply-add); the
// operations on pairs are those whose relative error Joldes, Muller and Popescu (ACM TOMS 44, 2017) bound by
// a few 2⁻¹⁰⁴. Needs round-to-nearest and no -ffast-math.
#pragma once

#include <cmath>

namespace ductile {

struct DoubleDouble {
  double hi = 0, lo = 0;  // |lo| ≤ ulp(hi)/2

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : hi(value) {}
  constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}
};

/// a + b exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double s = a + b;
  const double b_part = s - a;
  return {s, (a - (s - b_part)) + (b - b_part)};
}

/// a · b exactly.
inline DoubleDouble two_product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

/// a + b exactly, where |a| ≥ |b| or a = 0.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

inline DoubleDouble operator-(DoubleDouble x) { return {-x.hi, -x.lo}; }

inline DoubleDouble operator+(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble high = two_sum(x.hi, y.hi), low = two_sum(x.lo, y.lo);
  const DoubleDouble sum = quick_two_sum(high.hi, high.lo + low.hi);
  return quick_two_sum(sum.hi, sum.lo + low.lo);
}

inline DoubleDouble operator-(DoubleDouble x, DoubleDouble y) { return x + -y; }

inline DoubleDouble operator*(DoubleDouble x, DoubleDouble y) {
  const DoubleDouble p = two_product(x.hi, y.hi);
  return quick_two_sum(p.hi, p.lo + (x.hi * y.lo + x.lo * y.hi));
}

inline DoubleDouble operator/(DoubleDouble x, DoubleDouble y) {
  const double first = x.hi / y.hi;
  const DoubleDouble rest = x - y * first;
  const double second = rest.hi / y.hi;
  const double third = (rest - y * second).hi / y.hi;
  return quick_two_sum(first, second) + third;
}

inline DoubleDouble& operator+=(DoubleDouble& x, DoubleDouble y) { return x = x + y; }
inline DoubleDouble& operator-=(DoubleDouble& x, DoubleDouble y) { return x = x - y; }

inline bool operator<(DoubleDouble x, DoubleDouble y) { return x.hi < y.hi || (x.hi == y.hi && x.lo < y.lo); }

inline DoubleDouble abs(DoubleDouble x) { return x.hi < 0 || (x.hi == 0 && x.lo < 0) ? -x : x; }

inline DoubleDouble sqrt(DoubleDouble x) {
  const double root = std::sqrt(x.hi);
  if (!(root > 0)) return root;
  return quick_two_sum(root, (x - two_product(root, root)).hi / (2 * root));  // one Newton step
}

inline double to_double(DoubleDouble x) { return x.hi; }
inline double to_double(double x) { return x; }

}  // namespace ductile
