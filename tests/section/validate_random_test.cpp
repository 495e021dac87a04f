// The sweep against a plain check of all pairs, on drawings with small integer coordinates, where almost
// everything that can coincide does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "ductile/section.h"

namespace {
using namespace ductile;
using Random = std::mt19937_64;

int among(Random& random, int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }

long turn(Point a, Point b, Point c) {
  const double cross = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);  // exact for small integers
  return static_cast<long>(cross);
}

bool on_segment(Point p, Point a, Point b) {
  return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool meet(Point a, Point b, Point c, Point d) {
  const auto sign = [](long x) { return x > 0 ? 1 : x < 0 ? -1 : 0; };
  if (sign(turn(a, b, c)) * sign(turn(a, b, d)) < 0 && sign(turn(c, d, a)) * sign(turn(c, d, b)) < 0)
    return true;
  return on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d);
}

bool simple(const Ring& ring) {
  const std::size_t n = ring.size();
  const auto at = [&](std::size_t i) { return ring[i % n]; };
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (at(i) == at(i + 1)) return false;
    if (on_segment(at(i + 2), at(i), at(i + 1)) || on_segment(at(i), at(i + 1), at(i + 2)))
      return false;  // runs back
    for (std::size_t j = i + 2; j < n; ++j)
      if (!(i == 0 && j == n - 1) && meet(at(i), at(i + 1), at(j), at(j + 1))) return false;
  }
  return true;
}

bool inside(const Ring& ring, double x, double y) {
  bool in = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point a = ring[i], b = ring[(i + 1) % ring.size()];
    if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

/// A point within every face that touches an edge: both sides of the middle of every stretch between
/// intersections. With coordinates up to 8 no face is as thin as 1e-6.
template <class Visit>
void in_every_face(const std::vector<Ring>& rings, const Visit& visit) {
  std::vector<std::pair<Point, Point>> edges;
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) edges.push_back({ring[i], ring[(i + 1) % ring.size()]});
  for (const auto& [a, b] : edges) {
    const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
    std::vector<double> stops{0, 1};
    for (const auto& [c, d] : edges) {
      for (const Point p : {c, d}) stops.push_back(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2);
      const double across = dx * (d.y - c.y) - dy * (d.x - c.x);
      if (across != 0) stops.push_back(((c.x - a.x) * (d.y - c.y) - (c.y - a.y) * (d.x - c.x)) / across);
    }
    std::sort(stops.begin(), stops.end());
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
      if (stops[i] < 0 || stops[i + 1] > 1 || stops[i + 1] - stops[i] < 1e-9) continue;
      const double t = (stops[i] + stops[i + 1]) / 2, off = 1e-7;
      for (const double side : {off, -off}) visit(a.x + t * dx - side * dy, a.y + t * dy + side * dx);
    }
  }
}

Ring any_ring(Random& random, int corners, int size) {
  Ring ring;
  for (int i = 0; i < corners; ++i)
    ring.push_back(
        {static_cast<double>(among(random, 0, size)), static_cast<double>(among(random, 0, size))});
  return ring;
}

Ring simple_ring(Random& random, int size) {
  for (;;) {
    const Ring ring = any_ring(random, among(random, 3, 6), size);
    if (simple(ring)) return ring;
  }
}

std::string text(const std::vector<Ring>& rings) {
  std::string all;
  for (const Ring& ring : rings) {
    for (const Point p : ring) all += "(" + std::to_string(int(p.x)) + "," + std::to_string(int(p.y)) + ") ";
    all += "\n";
  }
  return all;
}

TEST(RandomDrawings, RingsAreSimpleOrRefused) {
  Random random(1);
  int accepted = 0;
  for (int i = 0; i < 60000; ++i) {
    Ring ring = any_ring(random, among(random, 3, 9), among(random, 2, 8));
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    const bool valid = validate(Outline{ring, {}}).empty();
    accepted += valid;
    ASSERT_EQ(valid, simple(ring)) << text({ring});
  }
  EXPECT_GT(accepted, 5000);
}

TEST(RandomDrawings, LongRingsTakeTheSweep) {  // more corners than are checked pair by pair
  Random random(2);
  int accepted = 0;
  for (int i = 0; i < 300; ++i) {
    // A staircase there and back, with one vertex moved.
    Ring ring;
    for (int k = 0; k < 40; ++k) {
      ring.push_back({2.0 * k, 2.0 * (k % 3)});
      ring.push_back({2.0 * k + 1, 2.0 * (k % 3)});
    }
    for (int k = 39; k >= 0; --k) {
      ring.push_back({2.0 * k + 1, 2.0 * (k % 3) + 3});
      ring.push_back({2.0 * k, 2.0 * (k % 3) + 3});
    }
    Point& p = ring[static_cast<std::size_t>(among(random, 0, 159))];
    p = {p.x + among(random, -2, 2), p.y + among(random, -4, 4)};
    const bool valid = validate(Outline{ring, {}}).empty();
    accepted += valid;
    ASSERT_EQ(valid, simple(ring)) << text({ring});
  }
  EXPECT_GT(accepted, 50);
  EXPECT_LT(accepted, 250);
}

TEST(RandomDrawings, HolesLieInsideAndApartOrAreRefused) {
  Random random(3);
  int accepted = 0;
  for (int i = 0; i < 30000; ++i) {
    const Ring outer = i % 2 == 0 ? Ring{{0, 0}, {8, 0}, {8, 8}, {0, 8}} : simple_ring(random, 8);
    std::vector<Ring> holes;
    for (int h = among(random, 1, 3); h > 0; --h) holes.push_back(simple_ring(random, among(random, 3, 8)));
    if (among(random, 0, 9) == 0) holes.back() = outer;
    std::vector<Ring> rings = holes;
    rings.push_back(outer);
    bool expected = true, solid = false;
    in_every_face(rings, [&](double x, double y) {
      int in_holes = 0;
      for (const Ring& hole : holes) in_holes += inside(hole, x, y);
      const bool in_outer = inside(outer, x, y);
      expected &= in_holes == 0 || (in_holes == 1 && in_outer);
      solid |= in_outer && in_holes == 0;
    });
    const bool valid = validate(Outline{outer, holes}).empty();
    accepted += valid;
    ASSERT_EQ(valid, expected && solid) << text(rings);
  }
  EXPECT_GT(accepted, 2000);
}

TEST(RandomDrawings, RegionsOverlapOrAreAccepted) {
  Random random(4);
  int accepted = 0;
  for (int i = 0; i < 30000; ++i) {
    std::vector<Ring> rings;
    std::vector<Region> regions;
    for (int r = among(random, 2, 4); r > 0; --r) {
      rings.push_back(simple_ring(random, among(random, 2, 8)));
      const int dx = among(random, 0, 4), dy = among(random, 0, 4);
      for (Point& p : rings.back()) p = {p.x + dx, p.y + dy};
      regions.push_back({{rings.back(), {}}, materials::S235});
    }
    bool expected = true;
    in_every_face(rings, [&](double x, double y) {
      int covered = 0;
      for (const Ring& ring : rings) covered += inside(ring, x, y);
      expected &= covered <= 1;
    });
    const bool valid = validate(regions).empty();
    accepted += valid;
    ASSERT_EQ(valid, expected) << text(rings);
  }
  EXPECT_GT(accepted, 1000);
}
}  // namespace
