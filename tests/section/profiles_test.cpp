// Profiles against closed forms, and curves against their chord tolerance.
#include "ductile/profiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "ductile/curves.h"
#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;
using std::numbers::pi;

Section section(const Profile& profile) { return Section(profile.outline, {.yield_stress = 1}); }

// ---- curves ----

double distance(Point p, Point a, Point b) {
  const double x = b.x - a.x, y = b.y - a.y;
  const double t = std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y), 0.0, 1.0);
  return std::hypot(p.x - a.x - t * x, p.y - a.y - t * y);
}

/// The farthest that 10000 points of the curve are from the polyline.
double farthest(const Ring& polyline, const std::function<Point(double)>& curve) {
  double worst = 0;
  for (int i = 0; i <= 10000; ++i) {
    const Point p = curve(i / 10000.0);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
      nearest = std::min(nearest, distance(p, polyline[k], polyline[k + 1]));
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(Curves, ArcsKeepWithinTheToleranceWithoutWaste) {
  struct Arc {
    Point centre, a, b;
    double from, sweep;
  };
  for (const Arc& arc : {Arc{{0, 0}, {1, 0}, {0, 1}, 0, 2 * pi}, Arc{{5, -3}, {0.02, 0}, {0, 0.02}, 1, -1.5},
                         Arc{{0, 0}, {3, 1}, {-0.1, 0.3}, -2, 3}, Arc{{1, 1}, {1, 0}, {0.7, 0.8}, 0.3, 6}}) {
    const auto curve = [&](double t) -> Point {
      const auto& [c, a, b, from, sweep] = arc;
      const double phi = from + sweep * t;
      return {c.x + a.x * std::cos(phi) + b.x * std::sin(phi),
              c.y + a.y * std::cos(phi) + b.y * std::sin(phi)};
    };
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      Ring ring{curve(0)};
      flatten_arc(ring, arc.centre, arc.a, arc.b, arc.from, arc.sweep, tolerance);
      EXPECT_LE(farthest(ring, curve), tolerance * (1 + 1e-9));
      EXPECT_NEAR(ring.back().x, curve(1).x, 1e-14);
      if (ring.size() > 20) {  // one chord less would not do
        Ring fewer{curve(0)};
        const double n = static_cast<double>(ring.size() - 2);
        for (int i = 1; i <= n; ++i) fewer.push_back(curve(i / n));
        EXPECT_GT(farthest(fewer, curve), 0.99 * tolerance);
      }
    }
  }
}

TEST(Curves, BeziersKeepWithinTheTolerance) {
  struct Cubic {
    Point p0, p1, p2, p3;
  };
  for (const Cubic& cubic :
       {Cubic{{0, 0}, {1, 2}, {3, -1}, {4, 1}}, Cubic{{0, 0}, {1, 1}, {0, 1}, {1, 0}},  // loop-like
        Cubic{{0, 0}, {0, 0}, {1, 1}, {1, 1}}, Cubic{{0, 0}, {10, 0}, {-9, 0}, {1, 0}}}) {
    const auto curve = [&](double t) -> Point {
      const auto mix = [t](double a, double b) { return a + (b - a) * t; };  // de Casteljau
      const auto on = [&](Point a, Point b) -> Point { return {mix(a.x, b.x), mix(a.y, b.y)}; };
      const auto& [p0, p1, p2, p3] = cubic;
      const Point a = on(p0, p1), b = on(p1, p2), c = on(p2, p3);
      return on(on(a, b), on(b, c));
    };
    for (const double tolerance : {1e-1, 1e-3, 1e-5}) {
      Ring ring{cubic.p0};
      flatten_cubic(ring, cubic.p0, cubic.p1, cubic.p2, cubic.p3, tolerance);
      EXPECT_LE(farthest(ring, curve), tolerance);
      EXPECT_EQ(ring.back(), cubic.p3);
    }
  }
  Ring ring{{0, 0}};
  flatten_cubic(ring, {0, 0}, {1, 1}, {2, 2}, {3, 3}, 1e-6);
  EXPECT_EQ(ring.size(), 2u);  // a straight line is one chord
  Ring parabola{{0, 0}};
  flatten_quadratic(parabola, {0, 0}, {1, 2}, {2, 0}, 1e-4);
  EXPECT_LE(farthest(parabola, [](double t) -> Point { return {2 * t, 4 * t * (1 - t)}; }), 1e-4);
}

TEST(Curves, RefuseWhatCannotBeDrawn) {
  Ring ring;
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(flatten_arc(ring, {0, 0}, {1, 0}, {0, 1}, 0, 1, 0), InvalidInput);
  EXPECT_THROW(flatten_arc(ring, {0, 0}, {1, 0}, {0, 1}, 0, 1, -1), InvalidInput);
  EXPECT_THROW(flatten_arc(ring, {0, 0}, {1, 0}, {0, 1}, 0, 1, nan), InvalidInput);
  EXPECT_THROW(flatten_arc(ring, {0, 0}, {1, 0}, {0, 1}, 0, infinity, 1e-3), InvalidInput);
  EXPECT_THROW(flatten_arc(ring, {nan, 0}, {1, 0}, {0, 1}, 0, 1, 1e-3), InvalidInput);
  EXPECT_THROW(flatten_arc(ring, {0, 0}, {1e200, 0}, {0, 1}, 0, 1, 1e-3), InvalidInput);
  EXPECT_THROW(flatten_cubic(ring, {0, 0}, {1e30, 0}, {0, 1}, {1, 1}, 1e-6), InvalidInput);
  EXPECT_THROW(flatten_cubic(ring, {0, 0}, {nan, 0}, {0, 1}, {1, 1}, 1e-6), InvalidInput);
  EXPECT_THROW(flatten_cubic(ring, {infinity, 0}, {1, 0}, {0, 1}, {1, 1}, 1e-6), InvalidInput);
  EXPECT_TRUE(ring.empty());
}

// ---- shapes with closed forms ----

TEST(Profiles, DiscAndTubeHaveTheirAreaAndModuliWithinTheBoundThatTheyReturn) {
  for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7}) {
    const double D = 0.3, t = 0.02, d = D - 2 * t;
    const Profile disc = profiles::disc(D, tolerance), tube = profiles::tube(D, t, tolerance);
    EXPECT_NEAR(section(disc).area() / (pi * D * D / 4), 1, 1e-13);
    EXPECT_NEAR(section(tube).area() / (pi * (D * D - d * d) / 4), 1, 1e-13);
    const double Wpl = D * D * D / 6, Wel = pi * D * D * D / 32, tube_Wpl = (D * D * D - d * d * d) / 6,
                 tube_Wel = pi * (std::pow(D, 4) - std::pow(d, 4)) / (32 * D);
    for (const Point direction : {along_x, along_y}) {
      EXPECT_LE(std::abs(section(disc).elastic(direction).W_plastic - Wpl), disc.modulus_error);
      EXPECT_LE(std::abs(section(disc).elastic(direction).W_elastic - Wel), disc.modulus_error);
      EXPECT_LE(std::abs(section(tube).elastic(direction).W_plastic - tube_Wpl), tube.modulus_error);
      EXPECT_LE(std::abs(section(tube).elastic(direction).W_elastic - tube_Wel), tube.modulus_error);
    }
    EXPECT_LT(disc.modulus_error / Wpl, 100 * tolerance / D);
  }
}

TEST(Profiles, ATubeThinnerThanTheToleranceIsStillATube) {
  const Profile tube = profiles::tube(1, 1e-3, 0.1);
  EXPECT_GT(section(tube).area(), 0);
}

TEST(Profiles, RectangleAndBox) {
  EXPECT_DOUBLE_EQ(section(profiles::rectangle(0.1, 0.2)).area(), 0.02);
  const Section box = section(profiles::box(0.2, 0.3, 0.01, 0.02));
  EXPECT_DOUBLE_EQ(box.area(), 0.2 * 0.3 - 0.18 * 0.26);
  EXPECT_DOUBLE_EQ(box.elastic(along_y).W_plastic, (0.2 * 0.3 * 0.3 - 0.18 * 0.26 * 0.26) / 4);
}

TEST(Profiles, FilletsAndRoundCornersHaveTheirArea) {
  const double h = 0.3, b = 0.15, tw = 0.0071, tf = 0.0107, r = 0.015, toe = 0.006;
  EXPECT_NEAR(section(profiles::i_section(h, b, tw, tf, 0, 1e-5)).area(), 2 * b * tf + (h - 2 * tf) * tw,
              1e-17);
  EXPECT_EQ(profiles::i_section(h, b, tw, tf, 0, 1e-5).modulus_error, 0);
  const double flanged = 2 * b * tf + (h - 2 * tf) * tw, fillet = (1 - pi / 4) * r * r;
  for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7}) {
    EXPECT_NEAR(section(profiles::i_section(h, b, tw, tf, r, tolerance)).area() / (flanged + 4 * fillet), 1,
                1e-13);
    EXPECT_NEAR(section(profiles::channel(h, b, tw, tf, r, tolerance)).area() / (flanged + 2 * fillet), 1,
                1e-13);
    const double legs = (h + b - tw) * tw, toes = 2 * (1 - pi / 4) * toe * toe;
    EXPECT_NEAR(section(profiles::angle(h, b, tw, r, toe, tolerance)).area() / (legs + fillet - toes), 1,
                1e-13);
    const double walls = 2 * tf * (h + b - 2 * tf), corners = (4 - pi) * (r * r - toe * toe);
    EXPECT_NEAR(section(profiles::hollow(b, h, tf, r, toe, tolerance)).area() / (walls - corners), 1, 1e-13);
  }
  // Fillets that meet at mid height and fill the flange's width; corners that meet.
  EXPECT_TRUE(validate(profiles::i_section(0.1, 0.1, 0.02, 0.01, 0.04, 1e-4).outline).empty());
  EXPECT_TRUE(validate(profiles::hollow(0.1, 0.1, 0.01, 0.05, 0.04, 1e-4).outline).empty());
}

TEST(Profiles, RefuseDimensionsThatMakeNone) {
  using namespace profiles;
  const double nan = std::nan("");
  EXPECT_THROW(profiles::rectangle(0, 1), InvalidInput);
  EXPECT_THROW(profiles::rectangle(1, nan), InvalidInput);
  EXPECT_THROW(box(1, 1, 0.5, 0.1), InvalidInput);
  EXPECT_THROW(box(1, 1, 0.1, 0.6), InvalidInput);
  EXPECT_THROW(disc(-1, 1e-3), InvalidInput);
  EXPECT_THROW(disc(1, 0), InvalidInput);
  EXPECT_THROW(disc(1, 1e-15), InvalidInput);
  EXPECT_THROW(tube(1, 0.5, 1e-3), InvalidInput);
  EXPECT_THROW(i_section(0.3, 0.15, 0.16, 0.01, 0, 1e-5), InvalidInput);
  EXPECT_THROW(i_section(0.3, 0.15, 0.01, 0.15, 0, 1e-5), InvalidInput);
  EXPECT_THROW(i_section(0.3, 0.15, 0.01, 0.01, 0.08, 1e-5), InvalidInput);
  EXPECT_THROW(i_section(0.3, 0.15, 0.01, 0.01, -1, 1e-5), InvalidInput);
  EXPECT_THROW(channel(0.3, 0.1, 0.01, 0.01, 0.095, 1e-5), InvalidInput);
  EXPECT_THROW(angle(0.1, 0.1, 0.01, 0.09, 0.005, 1e-5), InvalidInput);
  EXPECT_THROW(angle(0.1, 0.1, 0.01, 0.01, 0.02, 1e-5), InvalidInput);
  EXPECT_THROW(hollow(0.1, 0.2, 0.05, 0, 0, 1e-5), InvalidInput);
  EXPECT_THROW(hollow(0.1, 0.2, 0.01, 0.06, 0, 1e-5), InvalidInput);
}
}  // namespace
