// What a section does while a level loads or runs: no allocation in a repeated call, the same bits every
// time, and from several threads at once.
#include <gtest/gtest.h>

#include <thread>

#include "allocations.h"
#include "generated.h"
#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;

TEST(Steady, RepeatedCallsDoNotAllocate) {
  for (const auto& family : generated::families) {
    generated::Random random(3);
    const Section section(generated::section(family, random));
    const std::size_t before = allocations;
    double sum = 0;
    for (int i = 0; i < 20; ++i) {
      const Point d = direction(0.3 * i);
      const Capacities c = section.capacities(d);
      sum += c.M + section.moment_at(d, 0.3 * c.N, c.pna) + section.elastic(d).yield_moment +
             section.extent(d).first + section.area() + section.centroid().x +
             section.principal_axes().strong.x;
    }
    EXPECT_EQ(allocations, before) << family.name;
    EXPECT_TRUE(std::isfinite(sum));
  }
}

TEST(Steady, ThreadsMayShareASectionAndGetTheSameBits) {
  generated::Random random(5);
  const Section section(generated::section(generated::families[0], random));
  const auto run = [&] {
    std::vector<double> values;
    for (int i = 0; i < 100; ++i) {
      const Capacities c = section.capacities(direction(0.07 * i));
      values.insert(values.end(), {c.M, c.M_reverse, c.pna});
    }
    return values;
  };
  const std::vector<double> alone = run();
  std::vector<double> there, here;
  std::thread other([&] { there = run(); });
  here = run();
  other.join();
  EXPECT_EQ(there, alone);
  EXPECT_EQ(here, alone);
}
}  // namespace
