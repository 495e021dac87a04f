#include "boundary.h"

#include <algorithm>

#include "double_double.h"

namespace ductile {
namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t run_length = 8;  // edges: four to thirty-two are about as fast
}  // namespace

Boundary::Boundary(std::span<const Region> regions) {
  Point low{infinity, infinity}, high{-infinity, -infinity};
  std::size_t vertices = 0, rings = 0;
  for (const Region& region : regions) {
    for (const Point p : region.outline.outer) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    vertices += region.outline.outer.size() + 1;
    for (const Ring& hole : region.outline.holes) vertices += hole.size() + 1;
    rings += 1 + region.outline.holes.size();
  }
  origin = {low.x + (high.x - low.x) / 2, low.y + (high.y - low.y) / 2};
  magnitude = std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
  local.reserve(vertices);
  residual.reserve(vertices);
  loops.reserve(rings);
  for (std::size_t r = 0; r < regions.size(); ++r) {
    add(regions[r].outline.outer, false, r);
    for (const Ring& hole : regions[r].outline.holes) add(hole, true, r);
  }
  radius = std::sqrt(radius) * (1 + 4 * std::numeric_limits<double>::epsilon());
}

void Boundary::add(const Ring& ring, bool hole, std::size_t region) {
  Loop loop{.begin = local.size(), .region = region, .hole = hole};
  const std::size_t size = ring.size() - (ring.front() == ring.back() ? 1 : 0);
  for (std::size_t i = 0; i <= size; ++i) {
    const Point p = ring[i < size ? i : 0];
    const DoubleDouble x = two_sum(p.x, -origin.x), y = two_sum(p.y, -origin.y);
    if (i > 0) {
      const double dx = x.hi - local.back().x, dy = y.hi - local.back().y, length2 = dx * dx + dy * dy;
      loop.length += std::sqrt(length2);
      loop.length2 += length2;
    }
    local.push_back({x.hi, y.hi});
    residual.push_back({x.lo, y.lo});
    radius = std::max(radius, x.hi * x.hi + y.hi * y.hi);
  }
  loop.end = local.size() - 1;
  loops.push_back(loop);
}

void Boundary::summarise() {
  runs.clear();
  runs.reserve(local.size() / run_length + loops.size());
  for (const Loop& loop : loops)
    for (std::size_t begin = loop.begin; begin < loop.end; begin += run_length)
      runs.push_back(
          {.begin = begin, .end = std::min(begin + run_length, loop.end), .strength = loop.strength});
  if (runs.size() == 1) {  // crossed by every line that matters
    runs.front().half = {infinity, infinity};
    return;
  }
  const double slack =
      4 * std::numeric_limits<double>::epsilon() * radius;  // for the rounding of a projection
  for (Run& run : runs) {
    Point low = local[run.begin], high = low;
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const Point p = local[i], q = local[i + 1];
      low = {std::min(low.x, q.x), std::min(low.y, q.y)};
      high = {std::max(high.x, q.x), std::max(high.y, q.y)};
      const double dx = run.strength * (q.x - p.x), dy = run.strength * (q.y - p.y);
      const double x = (p.x + q.x) / 2, y = (p.y + q.y) / 2;  // means over the edge
      const double xx = (p.x * p.x + p.x * q.x + q.x * q.x) / 3, yy = (p.y * p.y + p.y * q.y + q.y * q.y) / 3,
                   xy = ((2 * p.x + q.x) * p.y + (p.x + 2 * q.x) * q.y) / 6;
      run.dx += dx, run.dy += dy;
      run.x_dx += x * dx, run.x_dy += x * dy, run.y_dx += y * dx, run.y_dy += y * dy;
      run.xx_dx += xx * dx, run.xx_dy += xx * dy, run.xy_dx += xy * dx;
      run.xy_dy += xy * dy, run.yy_dx += yy * dx, run.yy_dy += yy * dy;
    }
    run.centre = {(low.x + high.x) / 2, (low.y + high.y) / 2};
    run.half = {(high.x - low.x) / 2 + slack, (high.y - low.y) / 2 + slack};
  }
}

}  // namespace ductile
