// Sections drawn by lot: valid, and as awkward as drawings get.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "ductile/section.h"

namespace ductile::generated {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
  return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
}
inline int among(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}
inline double decades(Random& random, double low, double high) {
  return std::pow(10, between(random, low, high));
}

inline Material material(Random& random, bool same_both_ways) {
  const double ft = decades(random, 6, 9);
  return {.yield_stress = ft,
          .yield_stress_compression = same_both_ways ? 0 : ft * decades(random, -1, 1),
          .youngs_modulus = decades(random, 9, 11.5),
          .criterion = among(random, 0, 1) == 0 ? Criterion::tresca : Criterion::von_mises};
}

/// Points all seen from the centre, at radii between `inner` and `outer`.
inline Ring star(Random& random, int n, double inner, double outer, Point centre = {}) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * (i + between(random, 0, 0.9)) / n,
                 r = between(random, inner, outer);
    ring.push_back({centre.x + r * std::cos(a), centre.y + r * std::sin(a)});
  }
  return ring;
}

using Drawing = std::vector<Outline>;  // one outline per region, of the size of 1

/// Deep notches, any number of points.
inline Drawing stars(Random& random) { return {{star(random, among(random, 3, 120), 0.1, 1)}}; }

/// A strip a thousand to ten million times longer than thick, straight or in zigzag.
inline Drawing slivers(Random& random) {
  const double thickness = decades(random, -7, -3);
  const int n = among(random, 1, 6);
  Ring there, back;
  for (int i = 0; i <= n; ++i) {
    const double x = 2.0 * i / n - 1, y = n == 1 ? 0 : between(random, -0.5, 0.5);
    there.push_back({x, y});
    back.push_back({x, y + thickness * between(random, 0.5, 1.5)});
  }
  there.insert(there.end(), back.rbegin(), back.rend());
  return {{there}};
}

/// Thin teeth on a thin back.
inline Drawing combs(Random& random) {
  const int teeth = among(random, 2, 40);
  const double tooth = between(random, 0.02, 0.9), back = decades(random, -3, -1);
  Ring ring{{-1, 1}, {-1, 1 - back}};
  for (int i = 0; i < teeth; ++i) {
    const double x = -1 + 2.0 * i / teeth, width = 2.0 * tooth / teeth, low = between(random, -1, 0.5);
    if (i > 0) ring.push_back({x, 1 - back});
    ring.push_back({x, low});
    ring.push_back({x + width, low});
    ring.push_back({x + width, 1 - back});
  }
  ring.push_back({1, 1 - back});
  ring.push_back({1, 1});
  return {{ring}};
}

/// A plate with a grid of holes that leave thin walls.
inline Drawing perforated(Random& random) {
  const int n = among(random, 1, 6);
  const double wall = decades(random, -3, -0.5) / n;
  Outline plate{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (among(random, 0, 3) > 0)
        plate.holes.push_back(star(random, among(random, 3, 12), 0.3 * (1.0 / n - wall), 1.0 / n - wall,
                                   {-1 + (2 * i + 1.0) / n, -1 + (2 * j + 1.0) / n}));
  return {plate};
}

/// Layers that meet along ragged lines.
inline Drawing layered(Random& random) {
  const int layers = among(random, 2, 5), n = among(random, 1, 12);
  std::vector<Ring> lines;
  for (int l = 0; l <= layers; ++l) {
    Ring line;
    for (int i = 0; i <= n; ++i)
      line.push_back({2.0 * i / n - 1, 2.0 * (l + between(random, 0, 0.8)) / layers - 1});
    lines.push_back(line);
  }
  Drawing drawing;
  for (int l = 0; l < layers; ++l) {
    Ring ring = lines[l];
    ring.insert(ring.end(), lines[l + 1].rbegin(), lines[l + 1].rend());
    drawing.push_back({ring});
  }
  return drawing;
}

/// A core in a sheath in a sheath: every hole filled by the next region.
inline Drawing filled(Random& random) {
  const Ring outer = star(random, among(random, 8, 40), 0.8, 1),
             middle = star(random, among(random, 8, 40), 0.45, 0.5),
             core = star(random, among(random, 3, 20), 0.1, 0.2);
  return {{outer, {middle}}, {middle, {core}}, {core}};
}

/// Plates and flanges with nothing in between.
inline Drawing scattered(Random& random) {
  Drawing drawing;
  const int n = among(random, 2, 8);
  for (int i = 0; i < n; ++i) {
    const double y = -1 + 2.0 * i / n, height = between(random, 0.05, 0.9) * 2 / n,
                 x = between(random, -1, 0.5);
    drawing.push_back({{{x, y}, {x + 0.3, y + 0.01 * height}, {x + 0.5, y + height}, {x, y + height}}});
  }
  return drawing;
}

struct Family {
  const char* name;
  Drawing (*draw)(Random&);
};
constexpr Family families[] = {{"stars", stars},           {"slivers", slivers}, {"combs", combs},
                               {"perforated", perforated}, {"layered", layered}, {"filled", filled},
                               {"scattered", scattered}};

/// Turned, of a size of 1e-6 … 1e3 m, up to 1e6 m away, reversed and started anywhere; of random materials.
inline std::vector<Region> section(const Family& family, Random& random) {
  const Drawing drawing = family.draw(random);
  const double size = decades(random, -6, 3), angle = among(random, 0, 2) == 0 ? 0 : between(random, 0, 6.3);
  const bool same_both_ways = among(random, 0, 1) == 0;
  double away = among(random, 0, 1) == 0 ? 0 : decades(random, -1, 6);
  const double away_angle = between(random, 0, 6.3);
  const auto place = [&](Ring ring) {
    for (Point& p : ring)
      p = {size * (p.x * std::cos(angle) - p.y * std::sin(angle)) + away * std::cos(away_angle),
           size * (p.x * std::sin(angle) + p.y * std::cos(angle)) + away * std::sin(away_angle)};
    if (among(random, 0, 1) == 0) std::reverse(ring.begin(), ring.end());
    std::rotate(ring.begin(), ring.begin() + among(random, 0, static_cast<int>(ring.size()) - 1), ring.end());
    return ring;
  };
  std::vector<Material> materials;
  for (std::size_t r = 0; r < drawing.size(); ++r) materials.push_back(material(random, same_both_ways));
  for (;; away /= 10) {  // so far away rounding leaves no section
    std::vector<Region> regions;
    for (std::size_t r = 0; r < drawing.size(); ++r) {
      Region region{{place(drawing[r].outer), {}}, materials[r]};
      for (const Ring& hole : drawing[r].holes) region.outline.holes.push_back(place(hole));
      regions.push_back(region);
    }
    if (away < 1e-9 * size || validate(regions).empty()) return regions;
  }
}

}  // namespace ductile::generated
