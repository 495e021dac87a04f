// Axial force, shear and moment together: closed forms, the oracle, and the shape of the curve.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "generated.h"
#include "oracle.h"
#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;

double cross(Interaction a, Interaction b, Interaction c) {
  return (b.N - a.N) * (c.M - b.M) - (b.M - a.M) * (c.N - b.N);
}

void expect_convex(const std::vector<Interaction>& curve) {
  ASSERT_GE(curve.size(), 3u);
  for (std::size_t i = 0; i < curve.size(); ++i)
    EXPECT_GT(cross(curve[i], curve[(i + 1) % curve.size()], curve[(i + 2) % curve.size()]), 0) << i;
}

TEST(Interaction, RectangleIsOneMinusNSquared) {
  const double b = 0.12, h = 0.3, fy = 355e6, Np = b * h * fy, Mp = b * h * h / 4 * fy;
  for (const Point corner : {Point{0, 0}, Point{-b / 2, -h / 2}}) {
    const Section section({rectangle(b, h, corner)}, {.yield_stress = fy});
    const double middle = corner.y + h / 2;
    for (int k = -20; k <= 20; ++k) {
      const double n = k / 20.0;
      EXPECT_NEAR(section.moment_at(along_y, n * Np, middle) / Mp, 1 - n * n, 1e-13) << n;
      EXPECT_NEAR(section.moment_at(along_y, n * Np, middle, true) / Mp, 1 - n * n, 1e-13) << n;
    }
    EXPECT_NEAR(section.moment_at(along_y, 3 * Np, middle) / Mp, 0, 1e-13);  // clamped
    const auto curve = section.interaction(along_y, middle, 1e-6);
    expect_convex(curve);
    for (const auto [N, M] : curve) EXPECT_NEAR(std::abs(M) / Mp, 1 - N / Np * N / Np, 1e-13);
    EXPECT_DOUBLE_EQ(curve.front().N, Np);  // from full tension …
    EXPECT_GT(curve[1].M, 0);               // … counter-clockwise
  }
}

TEST(Interaction, FullTensionAboutALineOtherThanThePlasticCentroidCarriesAMoment) {
  const double b = 0.12, h = 0.3, fy = 355e6, Np = b * h * fy;
  const Section section({rectangle(b, h)}, {.yield_stress = fy});
  EXPECT_NEAR(section.moment_at(along_y, Np, 0), Np * h / 2, 1e-13 * Np * h);
  EXPECT_NEAR(section.moment_at(along_y, Np, 0, true), -Np * h / 2, 1e-13 * Np * h);
}

TEST(Interaction, ShearReducesEveryStress) {  // f √(1 − q²): N_p and M_p of the rectangle shrink alike
  const double b = 0.12, h = 0.3, fy = 355e6, Np = b * h * fy, Mp = b * h * h / 4 * fy;
  const Section section({rectangle(b, h)}, {.yield_stress = fy, .criterion = Criterion::von_mises});
  const double Q = section.capacities(along_y).Q;
  for (const double q : {0.0, 0.3, -0.6, 0.99}) {
    const double r = std::sqrt(1 - q * q);
    for (const double n : {0.0, 0.5 * r, -0.9 * r})
      EXPECT_NEAR(section.moment_at(along_y, n * Np, h / 2, false, q * Q) / Mp, r * (1 - n / r * n / r),
                  1e-13);
    const auto curve = section.interaction(along_y, h / 2, 1e-3, q * Q);
    EXPECT_NEAR(curve.front().N, r * Np, 1e-13 * Np);
  }
  EXPECT_EQ(section.moment_at(along_y, 0, h / 2, false, Q), 0);
  EXPECT_EQ(section.moment_at(along_y, 0.5 * Np, h / 2, false, 2 * Q), 0);
}

TEST(Interaction, ISectionWithItsAxisInTheWeb) {  // M_p less N²/(4 t_w f), the web's middle given to N
  const double h = 0.3, b = 0.15, tw = 0.0071, tf = 0.0107, fy = 355e6;
  const Section section({i_section(h, b, tw, tf)}, {.yield_stress = fy});
  const double Mp = section.capacities(along_y).M, N = 0.5 * tw * (h - 2 * tf) * fy;
  EXPECT_NEAR(section.moment_at(along_y, N, h / 2), Mp - N * N / (4 * tw * fy), 1e-13 * Mp);
}

// Points of the curve lie on the exact one, and the exact one lies within the tolerance of its edges.
void expect_curve(const std::vector<Region>& regions, Point d, double tolerance) {
  const Section section(regions);
  const oracle::Section exact(regions, d);
  const Capacities c = section.capacities(d);
  const Point centroid = section.centroid();
  const double reference = (centroid.x * d.x + centroid.y * d.y) / std::hypot(d.x, d.y);
  const auto curve = section.interaction(d, reference, tolerance);
  expect_convex(curve);
  double highest = 0, lowest = 0;
  for (const Interaction& point : curve) {
    highest = std::max(highest, point.M);
    lowest = std::min(lowest, point.M);
  }
  const double N_extent = c.N + c.Nc, M_extent = highest - lowest;
  int sense = 1;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Interaction a = curve[i], b = curve[(i + 1) % curve.size()];
    if (i % 7 == 0 && a.N < c.N && a.N > -c.Nc) {
      const auto [N, M] = exact.forces(exact.neutral_axis(a.N, sense), reference, sense);
      EXPECT_LE(std::abs(static_cast<double>(a.M - M)), 1e-13 * M_extent) << "at N " << a.N;
      const double direct = section.moment_at(d, a.N, reference, sense < 0);
      EXPECT_LE(std::abs(static_cast<double>(sense * direct - M)), 1e-13 * M_extent) << "at N " << a.N;
    }
    if (i % 5 == 0) {
      const oracle::Real middle = (oracle::Real(a.N) + b.N) / 2;
      const int own = b.N < a.N ? 1 : -1;
      const auto [N, M] = exact.forces(exact.neutral_axis(middle, own), reference, own);
      const double n = static_cast<double>(N - a.N) / N_extent, m = static_cast<double>(M - a.M) / M_extent;
      const double bn = (b.N - a.N) / N_extent, bm = (b.M - a.M) / M_extent;
      EXPECT_LE(std::abs(n * bm - m * bn) / std::hypot(bn, bm), tolerance);
    }
    if (a.N == -c.Nc) sense = -1;
  }
}

TEST(Interaction, OfUnsymmetricSectionsAgainstTheOracle) {
  const Material steel{.yield_stress = 355e6}, iron{.yield_stress = 150e6, .yield_stress_compression = 600e6};
  const std::vector<std::vector<Region>> table{
      {{{i_section(0.3, 0.15, 0.0071, 0.0107)}, steel}},
      {{{t_section(0.2, 0.02, 0.01, 0.15)}, steel}},
      {{{t_section(0.2, 0.02, 0.01, 0.15)}, iron}},
      {{{rectangle(0.1, 0.01)}, steel}, {{{{0, 0.01}, {0.1, 0.01}, {0.07, 0.2}}}, iron}},
      {{{rectangle(0.1, 0.01)}, steel}, {{rectangle(0.1, 0.01, {0, 0.2})}, steel}}};
  for (std::size_t i = 0; i < table.size(); ++i)
    for (const double angle : {0.0, 0.4, 1.5707963267948966, 2.5, 4.0}) {
      SCOPED_TRACE("row " + std::to_string(i) + " angle " + std::to_string(angle));
      expect_curve(table[i], direction(angle), 1e-3);
    }
}

class GeneratedInteraction : public testing::TestWithParam<generated::Family> {};

TEST_P(GeneratedInteraction, AgainstTheOracle) {
  for (unsigned seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    generated::Random random(seed);
    const auto regions = generated::section(GetParam(), random);
    expect_curve(regions, direction(generated::between(random, 0, 6.3)), generated::decades(random, -3, -2));
  }
}

TEST_P(GeneratedInteraction, IsConvexAtEveryTolerance) {
  for (unsigned seed = 100; seed < 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    generated::Random random(seed);
    const Section section(generated::section(GetParam(), random));
    const Point d = direction(generated::between(random, 0, 6.3)), centroid = section.centroid();
    const double reference = centroid.x * d.x + centroid.y * d.y;
    expect_convex(section.interaction(d, reference, generated::decades(random, -5, -1)));
  }
}

INSTANTIATE_TEST_SUITE_P(Interaction, GeneratedInteraction, testing::ValuesIn(generated::families),
                         [](const auto& info) { return std::string(info.param.name); });
}  // namespace
