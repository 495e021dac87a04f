// Outlines kept as text, and what must not change, or must change as the mathematics says, when they are
// drawn otherwise.
//
// tests/section/corpus/*.txt: `# why it is here`, then for each region `material f_t f_c E`, `outer x y …`,
// and `hole x y …` as often as needed; m and Pa.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "oracle.h"

namespace {
using namespace ductile;

struct Item {
  std::string name;
  std::vector<Region> regions;
};

Item read(const std::filesystem::path& path) {
  Item item{path.stem().string(), {}};
  std::ifstream file(path);
  Material material;
  Ring* ring = nullptr;
  for (std::string word; file >> word;) {
    if (word == "#") {
      std::getline(file, word);
    } else if (word == "material") {
      file >> material.yield_stress >> material.yield_stress_compression >> material.youngs_modulus;
    } else if (word == "outer") {
      item.regions.push_back({{}, material});
      ring = &item.regions.back().outline.outer;
    } else if (word == "hole") {
      ring = &item.regions.back().outline.holes.emplace_back();
    } else {
      double x = std::stod(word), y = 0;
      file >> y;
      ring->push_back({x, y});
    }
  }
  return item;
}

std::vector<Item> corpus() {
  std::vector<Item> items;
  for (const auto& entry : std::filesystem::directory_iterator(DUCTILE_SOURCE_DIR "/tests/section/corpus"))
    if (entry.path().extension() == ".txt") items.push_back(read(entry.path()));
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.name < b.name; });
  return items;
}

TEST(Corpus, IsThere) { EXPECT_GE(corpus().size(), 20u); }

class Corpus : public testing::TestWithParam<Item> {
 protected:
  const std::vector<Region>& regions() const { return GetParam().regions; }
};

template <class Map>
std::vector<Region> each_ring(std::vector<Region> regions, const Map& map) {
  for (Region& region : regions) {
    region.outline.outer = map(region.outline.outer);
    for (Ring& hole : region.outline.holes) hole = map(hole);
  }
  return regions;
}
template <class Map>
std::vector<Region> each_point(const std::vector<Region>& regions, const Map& map) {
  return each_ring(regions, [&](Ring ring) {
    std::transform(ring.begin(), ring.end(), ring.begin(), map);
    return ring;
  });
}

constexpr Point directions[] = {{0, 1}, {1, 0}, {3, 4}, {-1, 2}, {-5, -12}};

/// `other` is `regions` drawn `scale` times as large, so that d there is to_direction(d) here; `exactly`:
/// without rounding of any coordinate.
template <class ToDirection>
void expect_alike(const std::vector<Region>& regions, const std::vector<Region>& other, double scale,
                  bool exactly, const ToDirection& to_direction) {
  const Section a(regions), b(other);
  double length = 0, largest = 0, strongest = 0;
  for (const Region& region : other) {
    strongest = std::max({strongest, region.material.yield_stress, region.material.compression()});
    const auto measure = [&](const Ring& ring) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point p = ring[i], q = ring[(i + 1) % ring.size()];
        length += std::hypot(q.x - p.x, q.y - p.y);
        largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
      }
    };
    measure(region.outline.outer);
    for (const Ring& hole : region.outline.holes) measure(hole);
  }
  // An edge that rounding moves by δ changes an integral of f by at most f δ for every metre of it.
  const double moved = exactly ? 0 : 4 * std::numeric_limits<double>::epsilon() * largest;
  const double N_slack = strongest * length * moved;
  for (const Point d : directions) {
    const Point e = to_direction(d);
    const Capacities before = a.capacities(d), after = b.capacities(e);
    const auto [low, high] = b.extent(e);
    const double scale2 = scale * scale, scale3 = scale2 * scale;
    const auto near = [](double x, double y, double slack) {
      EXPECT_NEAR(x, y, 2e-13 * std::abs(y) + slack);
    };
    near(after.N, scale2 * before.N, N_slack);
    near(after.Nc, scale2 * before.Nc, N_slack);
    near(after.Q, scale2 * before.Q, N_slack);
    near(after.M, scale3 * before.M, N_slack * (high - low));
    near(after.M_reverse, scale3 * before.M_reverse, N_slack * (high - low));
    // The neutral axis: what force is left at it?
    const oracle::Section exact(other, e);
    for (const auto& [axis, sense] : {std::pair{after.pna, 1}, std::pair{after.pna_reverse, -1}}) {
      const double left = static_cast<double>(exact.forces(axis, axis, sense).first);
      EXPECT_LE(std::abs(left),
                1e-13 * after.N + strongest * length * 4e-16 * (largest + high - low) + N_slack);
    }
    near(b.area(), scale2 * a.area(), N_slack / strongest);
    const double EA = b.elastic(e).EA;
    near(EA, scale2 * a.elastic(d).EA, N_slack / strongest * 210e9);
  }
}

const auto same = [](Point d) { return d; };

TEST_P(Corpus, AgreesWithTheOracle) {
  for (const Point d : directions) {
    const Capacities c = Section(regions()).capacities(d);
    const oracle::Section exact(regions(), d);
    for (const int sense : {1, -1}) {
      const oracle::Real pna = exact.neutral_axis(0, sense), M = sense * exact.forces(pna, pna, sense).second;
      const double error = static_cast<double>(((sense > 0 ? c.M : c.M_reverse) - M) / M);
      EXPECT_LE(std::abs(error), 1e-13);
    }
  }
}

TEST_P(Corpus, Reversed) {
  expect_alike(regions(),
               each_ring(regions(),
                         [](Ring ring) {
                           return Ring{ring.rbegin(), ring.rend()};
                         }),
               1, true, same);
}

TEST_P(Corpus, StartedElsewhere) {
  for (const std::size_t shift : {1u, 2u, 5u})
    expect_alike(regions(),
                 each_ring(regions(),
                           [&](Ring ring) {
                             if (ring.front() == ring.back()) ring.pop_back();
                             std::rotate(ring.begin(),
                                         ring.begin() + static_cast<std::ptrdiff_t>(shift % ring.size()),
                                         ring.end());
                             return ring;
                           }),
                 1, true, same);
}

TEST_P(Corpus, Closed) {
  expect_alike(regions(),
               each_ring(regions(),
                         [](Ring ring) {
                           if (ring.front() != ring.back()) ring.push_back(ring.front());
                           return ring;
                         }),
               1, true, same);
}

TEST_P(Corpus, RegionsInAnotherOrder) {
  std::vector<Region> other(regions().rbegin(), regions().rend());
  for (Region& region : other) std::reverse(region.outline.holes.begin(), region.outline.holes.end());
  expect_alike(regions(), other, 1, true, same);
}

TEST_P(Corpus, Mirrored) {
  const auto mirror = [](Point p) -> Point { return {-p.x, p.y}; };
  expect_alike(regions(), each_point(regions(), mirror), 1, true, mirror);
}

TEST_P(Corpus, BentTheOtherWay) {
  for (const Point d : directions) {
    const Section section(regions());
    const Capacities there = section.capacities(d), back = section.capacities({-d.x, -d.y});
    EXPECT_NEAR(there.M, back.M_reverse, 2e-13 * there.M);
    EXPECT_NEAR(there.M_reverse, back.M, 2e-13 * there.M);
    EXPECT_NEAR(there.pna, -back.pna_reverse, 1e-14);
  }
}

TEST_P(Corpus, Turned) {
  for (const double angle : {0.1, 1.0, 1.5707963267948966, 2.7, 4.5}) {
    const auto turn = [&](Point p) -> Point {
      return {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle)};
    };
    expect_alike(regions(), each_point(regions(), turn), 1, false, turn);
  }
}

TEST_P(Corpus, Scaled) {
  for (const double scale : {1e-3, 1e-2, 0.1, 3.0, 10.0, 100.0, 1e3})
    expect_alike(regions(),
                 each_point(regions(),
                            [&](Point p) -> Point {
                              return {scale * p.x, scale * p.y};
                            }),
                 scale, false, same);
  const double exact = std::ldexp(1, 30);
  expect_alike(regions(),
               each_point(regions(),
                          [&](Point p) -> Point {
                            return {exact * p.x, exact * p.y};
                          }),
               exact, true, same);
}

TEST_P(Corpus, FarAway) {
  for (const Point away : {Point{1e6, 0}, Point{-1e6, 1e6}, Point{1e3, -1e6}})
    expect_alike(regions(),
                 each_point(regions(),
                            [&](Point p) -> Point {
                              return {p.x + away.x, p.y + away.y};
                            }),
                 1, false, same);
}

INSTANTIATE_TEST_SUITE_P(Files, Corpus, testing::ValuesIn(corpus()),
                         [](const auto& info) { return info.param.name; });
}  // namespace
