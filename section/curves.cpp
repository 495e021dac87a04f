#include "ductile/curves.h"

#include <algorithm>
#include <cmath>

namespace ductile {
namespace {

/// The number of chords as an integer; `count` may be anything that arithmetic on a user's numbers gives, and
/// so may `probe`, a sum of the numbers that have no part in it.
int chords(double count, double probe) {
  if (!(count <= 1e5) || !std::isfinite(probe))
    throw InvalidInput(
        {{"curve", "cannot be drawn within the chord tolerance by at most 100000 points",
          "coordinates must be finite, and the tolerance above zero and not so small beside the curve"}});
  return std::max(1, static_cast<int>(std::ceil(count)));
}

}  // namespace

void flatten_arc(Ring& ring, Point centre, Point a, Point b, double from, double sweep, double tolerance) {
  // The sagitta of a chord over Δφ is 1 − cos(Δφ/2) on the unit circle, and grows by at most the greater half
  // axis, the larger singular value of [a b].
  const double sum = a.x * a.x + a.y * a.y + b.x * b.x + b.y * b.y;
  const double area = a.x * b.y - a.y * b.x;
  const double axis = std::sqrt((sum + std::sqrt(std::max(0.0, sum * sum - 4 * area * area))) / 2);
  const double half = 2 * std::asin(std::sqrt(std::min(tolerance / (2 * axis), 0.5)));
  const double step =
      std::min(2 * half, std::acos(0.0));  // a quarter at most, so that a full turn encloses an area
  const int n = chords(std::abs(sweep) / step, centre.x + centre.y + from);
  for (int i = 1; i <= n; ++i) {
    const double phi = from + sweep * i / n, c = std::cos(phi), s = std::sin(phi);
    ring.push_back({centre.x + a.x * c + b.x * s, centre.y + a.y * c + b.y * s});
  }
}

void flatten_cubic(Ring& ring, Point p0, Point p1, Point p2, Point p3, double tolerance) {
  // A chord over a parameter step 1/n is within |p''|/(8n²) of the curve (Wang, Shen, Wang and Liu 1984), and
  // |p''| ≤ 6 max |second differences|.
  const double bend = std::max(std::hypot(p0.x - 2 * p1.x + p2.x, p0.y - 2 * p1.y + p2.y),
                               std::hypot(p1.x - 2 * p2.x + p3.x, p1.y - 2 * p2.y + p3.y));
  const int n = chords(std::sqrt(6 * bend / (8 * tolerance)), p0.x + p0.y + p3.x + p3.y);
  for (int i = 1; i < n; ++i) {
    const double t = static_cast<double>(i) / n, r = 1 - t;
    const double w0 = r * r * r, w1 = 3 * r * r * t, w2 = 3 * r * t * t, w3 = t * t * t;
    ring.push_back(
        {w0 * p0.x + w1 * p1.x + w2 * p2.x + w3 * p3.x, w0 * p0.y + w1 * p1.y + w2 * p2.y + w3 * p3.y});
  }
  ring.push_back(p3);
}

void flatten_quadratic(Ring& ring, Point p0, Point p1, Point p2, double tolerance) {
  const auto third = [](Point end, Point control) -> Point {
    return {end.x + (control.x - end.x) * 2 / 3, end.y + (control.y - end.y) * 2 / 3};
  };
  flatten_cubic(ring, p0, third(p0, p1), third(p2, p1), p2, tolerance);
}

}  // namespace ductile
