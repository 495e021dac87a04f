// The shear force that sections pass on, against closed forms and against what must not change it.
#include "ductile/shear.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ductile/rolled.h"
#include "generated.h"
#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;
using std::numbers::pi;

constexpr Material unit{.yield_stress = 2};  // Tresca: τ_y = 1, so that Q is A_v

double A_v(const Outline& outline, Point d) { return shear_capacity(Section(outline, unit), d); }
double A_v(const Profile& profile, Point d) { return A_v(profile.outline, d); }

TEST(Shear, OfARectangleAlongItsSidesIsItsArea) {  // Table 1 of the paper
  const double b = 0.1, h = 0.3;
  EXPECT_NEAR(A_v(profiles::rectangle(b, h), along_y) / (b * h), 1, 1e-14);
  EXPECT_NEAR(A_v(profiles::rectangle(b, h), along_x) / (b * h), 1, 1e-14);
  const Section steel(profiles::rectangle(b, h).outline,
                      {.yield_stress = 355e6, .criterion = Criterion::von_mises});
  EXPECT_NEAR(shear_capacity(steel, along_y) / (b * h * 355e6 / std::sqrt(3.0)), 1, 1e-14);
}

TEST(Shear, OfAnISectionIsItsWebOrItsFlanges) {
  const double h = 0.3, b = 0.15, tw = 0.0071, tf = 0.0107;
  for (const double r : {0.0, 0.015}) {
    const Profile I = profiles::i_section(h, b, tw, tf, r, 1e-4);
    EXPECT_NEAR(A_v(I, along_y) / (h * tw), 1, 1e-12) << r;
  }
  EXPECT_NEAR(A_v(profiles::i_section(h, b, tw, tf, 0, 1e-4), along_x) / (2 * tf * b), 1, 1e-12);
  EXPECT_NEAR(A_v(profiles::channel(h, b, tw, tf, 0.01, 1e-4), along_y) / (h * tw), 1, 1e-12);
  EXPECT_NEAR(A_v(profiles::box(b, h, tw, tf), along_y) / (2 * h * tw), 1, 1e-12);
  EXPECT_NEAR(A_v(profiles::box(b, h, tw, tf), along_x) / (2 * b * tf), 1, 1e-12);
  EXPECT_NEAR(A_v(Outline{t_section(0.2, 0.02, 0.01, 0.18)}, along_y) / (0.2 * 0.01), 1, 1e-12);
}

TEST(Shear, OfThinWallsRunsAlongThem) {
  // A round tube: EN 1993-1-1 6.2.6 (3) g gives 2 A/π = 4 R t for a thin one.
  const double R = 0.1;
  for (const double t : {0.01, 0.001}) {
    const double exact = 4 * (R - t / 2) * t;
    EXPECT_NEAR(A_v(profiles::tube(2 * R, t, t / 100), along_y) / exact, 1, 1.1 * t / R) << t;
  }
  // Legs that lean by 45°: t ℓ cos 45° each.
  const Profile L = profiles::angle(0.1, 0.1, 0.002, 0, 0, 1e-5);
  EXPECT_NEAR(A_v(L, {1, 1}) / (2 * 0.1 * 0.002 * std::cos(pi / 4)), 1, 0.03);
}

TEST(Shear, OfLeaningSidesFollowsTheMeanDirectionBetweenThem) {
  // A square on its corner: sin(π/4)/(π/4) of its area.
  const double a = 0.1;
  EXPECT_NEAR(A_v(Outline{{{a, 0}, {0, a}, {-a, 0}, {0, -a}}}, along_y) / (2 * a * a),
              std::sin(pi / 4) / (pi / 4), 1e-12);
  // A disc: 4 R² ∫ cos² φ sin φ/φ dφ over a quarter, by Simpson's rule.
  double integral = 0;
  constexpr int n = 1000;
  for (int i = 0; i <= n; ++i) {
    const double phi = pi / 2 * i / n, f = std::cos(phi) * std::cos(phi) * (i ? std::sin(phi) / phi : 1);
    integral += f * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * pi / 2 / n / 3;
  }
  EXPECT_NEAR(A_v(profiles::disc(2 * a, 1e-5), along_y) / (4 * a * a * integral), 1, 1e-3);
}

TEST(Shear, OfPartsWithAGapBetweenThemIsTheirSum) {
  const auto plate = [](double y, const Material& material) {
    return Region{{{{0, y}, {0.1, y}, {0.1, y + 0.02}, {0, y + 0.02}}}, material};
  };
  const Material strong{.yield_stress = 6};
  const Section two(std::vector<Region>{plate(0, unit), plate(0.3, strong)});
  EXPECT_NEAR(shear_capacity(two, along_y) / (0.002 * (1 + 3)), 1, 1e-13);
  EXPECT_NEAR(shear_capacity(two, along_x) / (0.002 * (1 + 3)), 1, 1e-13);
}

TEST(Shear, OfATubeFilledWithSomethingElseIsTheSumOfBoth) {
  const Outline tube = profiles::box(0.2, 0.2, 0.008, 0.008).outline;
  const Material core{.yield_stress = 0.02};
  const Section filled(std::vector<Region>{{tube, unit}, {{tube.holes[0]}, core}});
  const double exact = 0.2 * (2 * 0.008 + 0.01 * 0.184);
  EXPECT_NEAR(shear_capacity(filled, along_y) / exact, 1, 1e-12);
}

TEST(Shear, HardlyMindsASmallFin) {  // which a flow of one size from end to end would
  Ring ring{{0, 0},          {0.1, 0},        {0.1, 0.2},    {0.0505, 0.2},
            {0.0505, 0.202}, {0.0495, 0.202}, {0.0495, 0.2}, {0, 0.2}};
  EXPECT_GT(A_v(Outline{ring}, along_y), 0.98 * 0.02);
  EXPECT_LE(A_v(Outline{ring}, along_y), 0.020002 * (1 + 1e-12));
}

TEST(Shear, IsNeverMoreThanTheAreaAndTurnsWithTheSection) {
  for (const auto& family : generated::families) {
    generated::Random random(11);
    for (int i = 0; i < 10; ++i) {
      const auto regions = generated::section(family, random);
      const Section section(regions);
      for (const double angle : {0.0, 0.7, 2.0}) {
        const Point d = direction(angle);
        const double Q = shear_capacity(section, d);
        EXPECT_GT(Q, 0) << family.name;
        EXPECT_LE(Q, section.capacities(d).Q * (1 + 1e-9)) << family.name;
        EXPECT_NEAR(shear_capacity(section, {-d.x, -d.y}) / Q, 1, 2e-3) << family.name;
        std::vector<Region> turned = regions;
        const auto turn = [](Ring& ring) {
          for (Point& p : ring) p = {-p.y, p.x};
        };
        for (Region& region : turned) {
          turn(region.outline.outer);
          for (Ring& hole : region.outline.holes) turn(hole);
        }
        EXPECT_NEAR(shear_capacity(Section(turned), {-d.y, d.x}) / Q, 1, 1e-9) << family.name;
      }
    }
  }
}
}  // namespace
