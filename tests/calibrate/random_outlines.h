// Outlines with holes as no one would draw them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <random>

#include "ductile/plane.h"
#include "split.h"

namespace ductile {

using Random = std::mt19937_64;
inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// A ring around a point, star-shaped from it.
inline Ring star(Random& random, Point centre, double inner, double outer, int n) {
  std::vector<double> angles;
  for (int i = 0; i < n; ++i) angles.push_back((i + uniform(random, 0.05, 0.95)) * 2 * std::numbers::pi / n);
  Ring ring;
  for (const double a : angles) {
    const double r = uniform(random, inner, outer);
    ring.push_back({centre.x + r * std::cos(a), centre.y + r * std::sin(a)});
  }
  if (random() % 2) std::reverse(ring.begin(), ring.end());
  return ring;
}

// A comb with teeth on one side or both, some touching the next.
inline Ring comb(Random& random) {
  Ring below, above;
  const int n = 1 + static_cast<int>(random() % 8);
  const bool both = random() % 2;
  double x = 0;
  below.push_back({0, 0});
  for (int i = 0; i < n; ++i) {
    const double tooth = uniform(random, 0.02, 0.3), gap = uniform(random, 0.01, 0.3),
                 deep = uniform(random, 0.05, 2);
    below.insert(below.end(),
                 {{x + gap, 0}, {x + gap, -deep}, {x + gap + tooth, -deep}, {x + gap + tooth, 0}});
    if (both) above.insert(above.end(), {{x, 0.2}, {x + gap / 2, 0.2 + deep}, {x + gap, 0.2}});
    x += gap + tooth;
  }
  below.push_back({x + 0.1, 0});
  above.push_back({x + 0.1, 0.2});
  if (!both) above.insert(above.begin(), {0, 0.2});
  std::sort(above.begin(), above.end(), [](Point a, Point b) { return a.x > b.x; });
  below.insert(below.end(), above.begin(), above.end());
  return below;
}

// A long strip along a random walk, that may be so thin that it is a sliver.
inline Ring strip(Random& random) {
  const int n = 2 + static_cast<int>(random() % 30);
  const double width = std::pow(10, uniform(random, -4, -0.3));
  Ring ring, back;
  double angle = 0;
  Point at{};
  for (int i = 0; i < n; ++i) {
    const Point u{std::cos(angle), std::sin(angle)};
    ring.push_back(at + width * uniform(random, 0.2, 1) * right(u));
    back.push_back(at + width * uniform(random, 0.2, 1) * left(u));
    angle += uniform(random, -0.25, 0.25);
    at = at + uniform(random, 1, 2) * u;
  }
  ring.insert(ring.end(), back.rbegin(), back.rend());
  return ring;
}

// Stars with star-shaped holes, combs and strips, some stretched to slivers, on coarse grids (so that much is
// collinear, touches or has no area: such are not valid), far from the origin, 1e-3 … 1e3 m large.
inline Outline random_outline(Random& random) {
  Outline outline;
  switch (random() % 4) {
    case 0:
      outline.outer = comb(random);
      break;
    case 1:
      outline.outer = strip(random);
      break;
    default: {
      const int n = 3 + static_cast<int>(random() % 40);
      outline.outer = star(random, {}, 0.5, random() % 2 ? 0.6 : 3, std::max(n, 12));
      const int holes = static_cast<int>(random() % 5);
      for (int i = 0; i < holes; ++i) {
        const Point c{-0.3 + 0.15 * i, uniform(random, -0.1, 0.1)};
        outline.holes.push_back(star(random, c, 0.02, 0.07, 3 + static_cast<int>(random() % 12)));
      }
      if (holes == 0 && random() % 2) outline.holes.push_back(star(random, {}, 0.05, 0.45, n));
    }
  }
  const double stretch = random() % 3 ? 1 : std::pow(10, uniform(random, -3, 0)),
               angle = random() % 2 ? uniform(random, 0, 7) : 0;
  const double grid = random() % 4 ? 0 : std::pow(2, -static_cast<double>(random() % 8));
  const double size = std::pow(10, uniform(random, -3, 3));
  const Point at =
      random() % 3 ? Point{} : Point{uniform(random, -1e3, 1e3) * size, uniform(random, -1e3, 1e3) * size};
  const auto place = [&](Ring& ring) {
    for (Point& p : ring) {
      if (grid > 0) p = {grid * std::round(p.x / grid), grid * std::round(p.y / grid)};
      const Point q{size * p.x, size * stretch * p.y};
      p = at + std::cos(angle) * q + std::sin(angle) * left(q);
    }
  };
  place(outline.outer);
  for (Ring& hole : outline.holes) place(hole);
  return outline;
}

inline std::vector<calibration::Cut> random_cuts(Random& random, const Outline& outline) {
  // Through pairs of points of the outline (vertices, so that cuts meet them exactly, or middles),
  // lengthened.
  std::vector<Point> points = outline.outer;
  for (const Ring& hole : outline.holes) points.insert(points.end(), hole.begin(), hole.end());
  std::vector<calibration::Cut> cuts;
  const int n = static_cast<int>(random() % 6);
  const Point along = points[random() % points.size()] - points[random() % points.size()];
  for (int i = 0; i < n; ++i) {
    const Point p = middle(points[random() % points.size()], points[random() % points.size()]);
    Point d =
        random() % 2 ? left(along) : points[random() % points.size()] - points[random() % points.size()];
    if (!(length(d) > 0)) continue;
    Point low = points[0], high = low;
    for (const Point& q : points)
      low = {std::min(low.x, q.x), std::min(low.y, q.y)},
      high = {std::max(high.x, q.x), std::max(high.y, q.y)};
    d = 2 * length(high - low) * unit(d);
    cuts.push_back({p - d, p + d});
  }
  return cuts;
}

// The environment may ask for more than what a test does in a second.
inline int rounds(int few) {
  const char* text = std::getenv("DUCTILE_ROUNDS");
  return text ? std::atoi(text) : few;
}

}  // namespace ductile
