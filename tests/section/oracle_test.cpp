// 504 generated sections in four directions each against the oracle: within 1e-13 of the exact values for the
// coordinates as given.
#include "oracle.h"

#include <gtest/gtest.h>

#include "generated.h"

namespace {
using namespace ductile;

constexpr double bound = 1e-13;

class Generated : public testing::TestWithParam<generated::Family> {};

Point direction(generated::Random& random, int k) {
  if (k == 0) return {0, 1};
  const double angle = generated::between(random, 0, 6.3), length = generated::decades(random, -3, 3);
  return {length * std::cos(angle), length * std::sin(angle)};
}

void expect_close(double value, oracle::Real exact, oracle::Real scale, const char* what) {
  EXPECT_LE(static_cast<double>(oracle::magnitude(value - exact) / scale), bound)
      << what << " is " << value << ", should be " << static_cast<double>(exact);
}

TEST_P(Generated, CapacitiesAndElasticValues) {
  for (unsigned seed = 0; seed < 72; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    generated::Random random(seed);
    const auto regions = generated::section(GetParam(), random);
    const Section section(regions);
    double away = 0;
    for (const Region& region : regions)
      for (const Point p : region.outline.outer) away = std::max({away, std::abs(p.x), std::abs(p.y)});
    for (int k = 0; k < 4; ++k) {
      const Point d = direction(random, k);
      const Capacities c = section.capacities(d);
      const oracle::Section exact(regions, d);
      const oracle::Real height = exact.high() - exact.low();
      expect_close(c.N, exact.forces(exact.low(), 0, 1).first, c.N, "N");
      expect_close(c.Nc, -exact.forces(exact.high(), 0, 1).first, c.Nc, "Nc");
      for (const int sense : {1, -1}) {
        const oracle::Real pna = exact.neutral_axis(0, sense),
                           M = sense * exact.forces(pna, pna, sense).second;
        expect_close(sense > 0 ? c.M : c.M_reverse, M, M, sense > 0 ? "M" : "M_reverse");
        // The coordinate itself can be told no finer than a coordinate so far away.
        expect_close(sense > 0 ? c.pna : c.pna_reverse, pna, height + 4e-3 * away, "pna");
      }
      const Elastic e = section.elastic(d);
      const oracle::Integrals weighted = exact.elastic(exact.low(), true);
      const oracle::Real axis = exact.low() + weighted.S / weighted.A, EI = exact.elastic(axis, true).I;
      expect_close(e.EA, weighted.A, weighted.A, "EA");
      expect_close(e.EI, EI, EI, "EI");
      const oracle::Integrals plain = exact.elastic(exact.low(), false);
      expect_close(section.area(), plain.A, plain.A, "area");
      if (regions.size() == 1) {
        const oracle::Real I = exact.elastic(axis, false).I;
        expect_close(e.I, I, I, "I");
        const oracle::Real farther = std::max(exact.high() - axis, axis - exact.low());
        expect_close(e.W_elastic, I / farther, I / farther, "W_elastic");
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Oracle, Generated, testing::ValuesIn(generated::families),
                         [](const auto& info) { return std::string(info.param.name); });
}  // namespace
