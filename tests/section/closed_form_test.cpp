// Capacities against what can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;

constexpr Material steel{.yield_stress = 235e6, .youngs_modulus = 210e9};

void expect_ulps(double value, double exact, double ulps) {
  const double ulp =
      std::nextafter(std::abs(exact), std::numeric_limits<double>::infinity()) - std::abs(exact);
  EXPECT_NEAR(value, exact, ulps * ulp);
}

void expect_close(double value, double exact, double relative = 1e-14) {
  EXPECT_NEAR(value, exact, relative * std::abs(exact));
}

// Table 1 of the paper: a rectangle b × h, bent along h.
struct Table1 {
  double b, h, fy;
};

class Table1Row : public testing::TestWithParam<Table1> {};

TEST_P(Table1Row, RectangleWithinEightUlps) {
  const auto [b, h, fy] = GetParam();
  for (const Point corner : {Point{0, 0}, Point{-b / 2, -h / 2}}) {
    for (const Criterion criterion : {Criterion::tresca, Criterion::von_mises}) {
      const Section section({{rectangle(b, h, corner)}}, {.yield_stress = fy, .criterion = criterion});
      const Capacities c = section.capacities(along_y);
      expect_ulps(c.N, b * h * fy, 8);
      expect_ulps(c.Nc, b * h * fy, 8);
      expect_ulps(c.Q, criterion == Criterion::tresca ? 0.5 * b * h * fy : b * h * fy / std::sqrt(3.0), 8);
      expect_ulps(c.M, 0.25 * b * h * h * fy, 8);
      expect_ulps(c.M_reverse, 0.25 * b * h * h * fy, 8);
      EXPECT_NEAR(c.pna, corner.y + h / 2, 1e-15 * h);
      expect_ulps(section.capacities(along_x).M, 0.25 * h * b * b * fy, 8);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table1, Table1Row,
                         testing::Values(Table1{1, 1, 350e6}, Table1{0.1, 0.2, 355e6},
                                         Table1{0.3, 0.01, 235e6}, Table1{2e-6, 7e-6, 1.0},
                                         Table1{123.4, 987.6, 1e9}, Table1{1, 20, 350e6},
                                         Table1{1.0 / 3, 1.0 / 7, 275e6}));

TEST(ClosedForm,
     Diamond) {  // half diagonal r
  const double r = 0.4;
  const Section section({{{r, 0}, {0, r}, {-r, 0}, {0, -r}}}, steel);
  expect_close(section.capacities(along_y).M, steel.yield_stress * 2 * r * r * r / 3);
  const Elastic elastic = section.elastic(along_y);
  expect_close(elastic.W_elastic, r * r * r / 3);
  expect_close(elastic.shape_factor, 2);
}

TEST(ClosedForm, TriangleAboutItsBase) {
  const double b = 0.3, h = 0.5;
  const Capacities c = Section({{{0, 0}, {b, 0}, {0.1, h}}}, steel).capacities(along_y);
  expect_close(c.M, steel.yield_stress * b * h * h * (2 - std::numbers::sqrt2) / 6);
  expect_close(c.pna, h * (1 - 1 / std::numbers::sqrt2));
}

TEST(ClosedForm, RegularPolygonNearsTheDisc) {
  // Even n, bent toward a corner: Z = 2 A_half·y̅, from the triangles of the fan. W and I of the exact
  // polygon.
  for (const int n : {4, 16, 64, 4096, 100000}) {
    const double R = 0.7, t = 2 * std::numbers::pi / n;
    const Section section({regular(n, R)}, steel);
    expect_close(section.area(), 0.5 * n * R * R * std::sin(t), 2e-14);
    const Elastic elastic = section.elastic(along_x);
    expect_close(elastic.I, n * std::pow(R, 4) * std::sin(t) * (2 + std::cos(t)) / 24, 2e-14);
    // n/2 triangles of the fan on each side: Z = 2 Σ ½R² sin t · ⅔R cos(t/2) sin((k + ½)t)
    const double Z = 2.0 / 3 * R * R * R * std::sin(t) / std::tan(t / 2);
    expect_close(section.capacities(along_x).M, steel.yield_stress * Z, 2e-14);
    if (n == 100000) {
      expect_close(elastic.shape_factor, 16 / (3 * std::numbers::pi), 1e-8);
      expect_close(section.area(), std::numbers::pi * R * R, 1e-8);
    }
  }
}

TEST(ClosedForm, HollowRectangle) {
  const double B = 0.2, H = 0.3, b = 0.17, h = 0.28;
  const Section section({rectangle(B, H, {-B / 2, -H / 2}), {rectangle(b, h, {-b / 2, -h / 2})}}, steel);
  expect_close(section.area(), B * H - b * h);
  expect_close(section.capacities(along_y).M, steel.yield_stress * (B * H * H - b * h * h) / 4);
  expect_close(section.elastic(along_y).I, (B * H * H * H - b * h * h * h) / 12);
}

TEST(ClosedForm, ISection) {
  const double h = 0.3, b = 0.15, tw = 0.0071, tf = 0.0107, web = h - 2 * tf;
  const Section section({i_section(h, b, tw, tf)}, steel);
  expect_close(section.area(), 2 * b * tf + tw * web);
  expect_close(section.capacities(along_y).M, steel.yield_stress * (b * tf * (h - tf) + tw * web * web / 4));
  expect_close(section.capacities(along_x).M, steel.yield_stress * (2 * tf * b * b + web * tw * tw) / 4);
  expect_close(section.elastic(along_y).I, (b * h * h * h - (b - tw) * web * web * web) / 12);
}

TEST(ClosedForm, TSectionWithItsAxisInTheFlange) {
  const double b = 0.2, tf = 0.02, tw = 0.01, hs = 0.15, A = b * tf + tw * hs, top = hs + tf;
  const double pna = top - A / (2 * b), up = top - pna,
               down = pna - hs;  // half the area above it, in the flange
  const Capacities c = Section({t_section(b, tf, tw, hs)}, steel).capacities(along_y);
  expect_close(c.pna, pna);
  expect_close(c.M, steel.yield_stress * (b * up * up / 2 + b * down * down / 2 + tw * hs * (down + hs / 2)));
}

TEST(ClosedForm, RectangleWeakerInTensionThanInCompression) {
  const double b = 0.2, h = 0.5, ft = 3e6, fc = 30e6;
  const Capacities c =
      Section({rectangle(b, h)}, {.yield_stress = ft, .yield_stress_compression = fc}).capacities(along_y);
  expect_close(c.N, ft * b * h);
  expect_close(c.Nc, fc * b * h);
  expect_close(c.Q, ft / 2 * b * h);
  expect_close(c.pna, h * ft / (ft + fc));  // the upper part in tension is the larger one
  expect_close(c.pna_reverse, h * fc / (ft + fc));
  expect_close(c.M, b * h * h / 2 * ft * fc / (ft + fc));
  expect_close(c.M_reverse, c.M);
}

TEST(ClosedForm, TwoFlangesApartReportTheMiddleOfTheGap) {
  for (const double away : {0.0, 1e6}) {
    const std::vector<Region> flanges{{{rectangle(0.1, 0.01, {0, away})}, steel},
                                      {{rectangle(0.1, 0.01, {0, away + 0.19})}, steel}};
    const Capacities c = Section(flanges).capacities(along_y);
    EXPECT_NEAR(c.pna, away + 0.1, away == 0 ? 1e-15 : 2e-10);
    expect_close(c.M, steel.yield_stress * 0.1 * 0.01 * 0.19, away == 0 ? 1e-14 : 1e-7);
  }
}

TEST(ClosedForm, CompositeOfTwoLayers) {  // steel sheet under timber, full bond
  const double b = 0.1, ts = 0.01, tw = 0.2, fs = 235e6, fw = 24e6, Es = 210e9, Ew = 11e9;
  const std::vector<Region> layers{{{rectangle(b, ts)}, {.yield_stress = fs, .youngs_modulus = Es}},
                                   {{rectangle(b, tw, {0, ts})}, {.yield_stress = fw, .youngs_modulus = Ew}}};
  const Section section(layers);
  const Capacities c = section.capacities(along_y);
  const double pna = ts + (tw - fs / fw * ts) / 2;  // in the timber: f_s t_s + f_w x = f_w (t_w − x)
  const double x = pna - ts;
  expect_close(c.pna, pna);
  expect_close(c.M, b * (fs * ts * (x + ts / 2) + fw * x * x / 2 + fw * (tw - x) * (tw - x) / 2));
  expect_close(c.N, b * (fs * ts + fw * tw));
  const Elastic e = section.elastic(along_y);
  const double EA = b * (Es * ts + Ew * tw), y = b * (Es * ts * ts / 2 + Ew * tw * (ts + tw / 2)) / EA;
  const double EI = b * (Es * (ts * ts * ts / 12 + ts * (y - ts / 2) * (y - ts / 2)) +
                         Ew * (tw * tw * tw / 12 + tw * (ts + tw / 2 - y) * (ts + tw / 2 - y)));
  expect_close(e.EA, EA);
  expect_close(e.EI, EI);
  expect_close(e.centroid.y, y);
  expect_close(e.yield_moment, EI * std::min(fs / (Es * y), fw / (Ew * (ts + tw - y))));
  EXPECT_TRUE(std::isnan(e.I) && std::isnan(e.W_elastic) && std::isnan(e.W_plastic));
}

TEST(ClosedForm, EqualAngleHasItsPrincipalAxesAt45Degrees) {
  const double a = 0.1, t = 0.01;
  const Section section({{{0, 0}, {a, 0}, {a, t}, {t, t}, {t, a}, {0, a}}}, steel);
  const PrincipalAxes axes = section.principal_axes();
  EXPECT_NEAR(std::abs(axes.strong.x), std::sqrt(0.5),
              1e-14);  // strong: the legs' ends far apart, along (1, −1)
  EXPECT_NEAR(axes.strong.x, -axes.strong.y, 1e-14);
  EXPECT_NEAR(axes.weak.x, axes.weak.y, 1e-14);
  const double I = section.elastic(along_x).I;
  expect_close(section.elastic(axes.strong).I + section.elastic(axes.weak).I, 2 * I, 1e-14);
  const double A = t * (2 * a - t), S = (a * t * a / 2 + (a - t) * t * t / 2), c = S / A;
  const double product =
      t * t * a * a / 4 + t * t * (a * a - t * t) / 4 - A * c * c;  // ∫ xy dA about the centroid
  expect_close(section.elastic(axes.strong).I, I - product, 1e-13);
}

TEST(ClosedForm, DirectionMayHaveAnyLengthButZero) {
  const Section section({t_section(0.2, 0.02, 0.01, 0.15)}, steel);
  const Capacities one = section.capacities({0.6, 0.8}), many = section.capacities({6e150, 8e150}),
                   few = section.capacities({6e-200, 8e-200});
  expect_close(one.M, many.M);
  expect_close(one.M, few.M);
  EXPECT_THROW(section.capacities({0, 0}), std::invalid_argument);
  EXPECT_THROW(section.capacities({std::nan(""), 1}), std::invalid_argument);
}
}  // namespace
