#include "ductile/turn.h"

#include <cmath>
#include <numbers>

namespace ductile {
namespace {

constexpr double over(double n) { return 1 / n; }

// Taylor series about the nearest quarter turn.
Turn about_quarter_turn(double angle) {
  if (!(std::abs(angle) < 1e6)) return {std::cos(angle), std::sin(angle)};
  const double quarters = std::nearbyint(angle * (2 / std::numbers::pi));
  // π/2 in two parts of 33 bits, whose multiples are exact, and the rest.
  const double r =
      angle - quarters * 0x1.921fb544p0 - quarters * 0x1.0b4611a6p-34 - quarters * 0x1.3198a2e037073p-69;
  const double t = r * r;
  double c = 1, s = 1;
  for (int n = 16; n > 0; n -= 2) {
    c = 1 - t / ((n - 1) * n) * c;
    s = 1 - t / (n * (n + 1)) * s;
  }
  s *= r;
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {c, s};
    case 1:
      return {-s, c};
    case 2:
      return {-c, -s};
    default:
      return {s, -c};
  }
}

}  // namespace

Turn turn_of_large(double angle) {
  const double t = angle * angle;
  if (!(t < 4e-3)) return about_quarter_turn(angle);
  return {1 - t * over(2) * (1 - t * over(12) * (1 - t * over(30) * (1 - t * over(56) * (1 - t * over(90))))),
          angle * (1 - t * over(6) * (1 - t * over(20) * (1 - t * over(42) * (1 - t * over(72)))))};
}

// Halved three times by tan φ/2 = tan φ/(1 + √(1 + tan² φ)), from the nearer end of the x axis; then
// Gregory's series.
double angle_of(double x, double y) {
  const double r = std::sqrt(x * x + y * y);
  if (!(r > 0)) return 0;
  double tangent = std::abs(y) / (r + std::abs(x));
  for (int i = 0; i < 2; ++i) tangent /= 1 + std::sqrt(1 + tangent * tangent);
  const double t = tangent * tangent;  // < 0.04
  double sum = 0;
  for (int n = 25; n > 0; n -= 2) sum = over(n) - t * sum;
  const double angle = 8 * tangent * sum;
  return std::copysign(x < 0 ? std::numbers::pi - angle : angle, y);
}

}  // namespace ductile
