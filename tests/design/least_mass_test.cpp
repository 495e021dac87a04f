// Plastic design for least mass against published optima and against closed forms, derived by hand from the
// mechanisms that are active.
//
// Foulkes' condition makes each of the latter certain: positive multiples of the mechanisms' hinge rotations,
// group by group, add up to the groups' lengths (J. Foulkes, Minimum weight design and the theory of plastic
// collapse, Q. Appl. Math. 10 (1953) 347; The minimum-weight design of structural frames, Proc. R. Soc. A 223
// (1954) 482; J. Heyman, Plastic design of beams and plane frames for minimum material consumption, Q. Appl.
// Math. 8 (1951) 373).
#include <gtest/gtest.h>

#include <limits>

#include "ductile/targets.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double t = 0.1, end = 1e-6;  // m: of members, and how far from nodes hinges may form
constexpr double moment_per_depth = 350e6 / 4 * t * t, mass_per_volume = 7800;

// A member along its centre line, with places for hinges at its end, perhaps at its start, and at a part of
// its length unless that is 0.
BodyDef member(const std::string& name, Point from, Point to, bool hinge_at_start, double hinge_along = 0) {
  BodyDef body = beam(1);
  body.name = name;
  const double L = std::hypot(to.x - from.x, to.y - from.y);
  body.outline = {rectangle(0, -t / 2, L, t / 2), {}};
  body.at = from;
  body.angle = std::atan2(to.y - from.y, to.x - from.x);
  const auto cut = [&](double x) { body.cuts.push_back({Point{x, -t}, Point{x, t}}); };
  if (hinge_at_start) cut(end);
  if (hinge_along > 0) cut(hinge_along * L);
  cut(L - end);
  return body;
}
JointBetweenDef node(std::vector<std::string> bodies, Point at) {
  JointBetweenDef joint{.a = bodies[0], .b = bodies[1], .at = at};
  joint.others.assign(bodies.begin() + 2, bodies.end());
  joint.overrides.moment = unlimited;
  return joint;
}
BodyDef floor_to(double l) {
  return {.name = "floor", .type = BodyType::static_body, .outline = {rectangle(-2, -1, l + 2, 0), {}}};
}

double bears(const SceneDef& scene, std::size_t body) { return scene.bodies[body].depth * moment_per_depth; }
double mass(double length, double moment) { return mass_per_volume * t * length * moment / moment_per_depth; }

// A portal of columns of height h and a girder of span l: H at its height, V at a part of its span.
SceneDef portal(double h, double l, double H, double V, double along, bool right_foot_fixed) {
  SceneDef scene = bending_only();
  scene.bodies = {floor_to(l), member("left", {0, 0}, {0, h}, false), member("right", {l, 0}, {l, h}, false),
                  member("girder", {0, h}, {l, h}, true, along)};
  JointBetweenDef right_foot{.a = "floor", .b = "right"};
  if (!right_foot_fixed) right_foot.overrides.moment = 0;
  scene.joints = {{.a = "floor", .b = "left"},
                  right_foot,
                  node({"left", "girder"}, {0, h}),
                  node({"right", "girder"}, {l, h})};
  scene.loads = {{.body = "girder", .at = {along * l, h}, .force = {0, -V}},
                 {.body = "girder", .at = {0, h}, .force = {H, 0}}};
  return scene;
}

// M. Jirásek, Z. P. Bažant, Inelastic Analysis of Structures (Wiley 2002), example 12.5, pp. 163–168:
// "optimum limit design of a frame". Its program and its solution (table 12.5) were read on a page of the
// book's author, not in the book: minimum 2 M_1 + 3 M_2 + 2 M_3 = 78/11 with M_1 = 4/11, M_2 = M_3 = 14/11.
// The frame follows from the program's equations of equilibrium, (M_a + M_b + M_d)/2 = 1 and −M_b/2 + 3/2 M_c
// + M_d = 3: columns of 2, the right one on a pin, a span of 3, 1 across and 3 down at two thirds of the
// span.
TEST(LeastMass, JirasekAndBazantsFrame) {
  const double unit = 1e6;
  const LeastMass least = least_mass(portal(2, 3, unit, 3 * unit, 2. / 3, false), {{1}, {2}, {3}}, 1);
  EXPECT_NEAR(bears(least.scene, 1) / unit, 4. / 11, 1e-5);
  EXPECT_NEAR(bears(least.scene, 3) / unit, 14. / 11, 1e-5);
  EXPECT_NEAR(bears(least.scene, 2) / unit, 14. / 11, 1e-5);
  EXPECT_NEAR(least.mass / mass(1, unit) / (78. / 11), 1, 1e-5);
}

// S. S. Rao, Engineering Optimization (4th ed., Wiley 2009), section 3.2, p. 122, read in a copy: a portal's
// four mechanisms ask for M_c ≥ 6, M_b ≥ 2.5, 2 M_b + M_c ≥ 17 and M_b + M_c ≥ 12 (E2), its weight is 20 M_b
// + 16 M_c (E1). The least is 212, where the last two meet: M_b = 5, M_c = 7. Their right sides are those of
// columns of 8 with fixed feet, a beam of 20, 3 across and 1 in its middle.
TEST(LeastMass, RaosPortal) {
  const double unit = 1e5;
  const LeastMass least = least_mass(portal(8, 20, 3 * unit, unit, 0.5, true), {{1, 2}, {3}}, 1);
  EXPECT_NEAR(bears(least.scene, 1) / unit, 7, 7e-5);
  EXPECT_NEAR(bears(least.scene, 3) / unit, 5, 5e-5);
  EXPECT_NEAR(least.mass / mass(1, unit) / 212, 1, 1e-5);
}

// A. G. M. Michell, The limits of economy of material in frame-structures, Phil. Mag. 8 (1904) 589: of all
// frames on one side of a line that carry a force F in the middle between two supports 2a apart on it, the
// lightest is half a wheel of volume (π/2) F a (1/P + 1/Q), P and Q what bars bear in tension and compression
// (the formula as later papers quote it; of his only the first page was read). Of all bars between the ends
// of n spokes and the hub, the rim and the spokes are lightest: tan(π/2n) F in each spoke and the same over
// 2 sin(π/2n) in the rim make 2n tan(π/2n) F a, and a displacement that stretches spokes by 1 and shortens
// the rim by 1 strains a bar over m sectors by 1 − 2m tan(π/2n)/tan(mπ/2n), which is between −1 and 1. It
// falls to Michell's π F a as n grows.
TEST(LeastMass, MichellsHalfWheel) {
  const double a = 10, F = 1e6, drawn = 1e-5, pi = std::acos(-1.0);
  double last = std::numeric_limits<double>::infinity();
  for (const int n : {2, 4, 6}) {
    SceneDef scene;
    scene.gravity = {};
    std::vector<Point> nodes{{0, 0}};
    for (int i = 0; i <= n; ++i) nodes.push_back({-a * std::cos(pi * i / n), a * std::sin(pi * i / n)});
    std::vector<std::vector<std::string>> at(nodes.size());
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t j = i + 1; j < nodes.size(); ++j) {
        if (i == 1 && j + 1 == nodes.size()) continue;  // along two spokes
        BodyDef bar =
            member("bar" + std::to_string(i) + "." + std::to_string(j), nodes[i], nodes[j], false, 0.5);
        bar.cuts.pop_back();
        bar.depth = drawn;
        groups.push_back({scene.bodies.size()});
        for (const std::size_t end : {i, j}) at[end].push_back(bar.name);
        scene.bodies.push_back(bar);
      }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      scene.joints.push_back(node(at[i], nodes[i]));
      scene.joints.back().overrides = {.moment = 0, .axial = unlimited, .shear = unlimited};
    }
    scene.supports = {{.body = at[1][0], .at = nodes[1], .fix_x = true, .fix_y = true},
                      {.body = at.back()[0], .at = nodes.back(), .fix_y = true}};
    scene.loads = {{.body = at[0][0], .at = nodes[0], .force = {0, -F}}};
    const double volume = least_mass(scene, groups, 1).mass / mass_per_volume, unit = F * a / 350e6;
    EXPECT_NEAR(volume / unit / (2 * n * std::tan(pi / (2 * n))), 1, 1e-5) << n;
    EXPECT_GT(volume, pi * unit);
    EXPECT_LT(volume, last);
    last = volume;
  }
}

// Fixed feet, V in the middle of the beam and H at its height, span 1.2 h. Active are the beam's mechanism
// with hinges in the columns' heads, V l/2 = 2 M_b + 2 M_c, and the combined one, V l/2 + H h = 2 M_b + 4
// M_c: 0.2 h times the first's (2, 2) and 0.4 h times the second's (2, 4) are the lengths (1.2 h, 2 h).
TEST(LeastMass, APortalWithFixedFeet) {
  const double h = 10, l = 12, V = 2e6 / (l / 2), H = 0.2e6 / h;
  const SceneDef scene = portal(h, l, H, V, 0.5, true);
  const double column = H * h / 2, girder = V * l / 4 - H * h / 2;
  for (const double factor : {1., 1.7}) {
    const LeastMass least = least_mass(scene, {{1, 2}, {3}}, factor);
    EXPECT_NEAR(bears(least.scene, 1) / (factor * column), 1, 1e-5);
    EXPECT_EQ(least.scene.bodies[1].depth, least.scene.bodies[2].depth);
    EXPECT_NEAR(bears(least.scene, 3) / (factor * girder), 1, 1e-5);
    EXPECT_NEAR(least.mass / factor / (mass(2 * h, column) + mass(l, girder)), 1, 1e-5);
    EXPECT_NEAR(least.collapse / factor, 1, 1e-6);
    // As Foulkes' theorem has it, whatever is lighter in one member and heavier in the other goes or weighs
    // more.
    for (const double change : {-0.01, 0.01}) {
      SceneDef other = least.scene;
      for (const std::size_t column_body : {1u, 2u}) other.bodies[column_body].depth *= 1 + change;
      const double saved = mass(2 * h, factor * column) * change / mass(l, factor * girder);
      other.bodies[3].depth *= 1 - saved;
      EXPECT_LT(limit_analysis(calibrate(other)).load_factor, factor * (1 - 1e-5));
    }
  }
}

// The same with welded corners, where the hinges of the weaker member form in the node itself.
TEST(LeastMass, WeldedCornersAreAsStrongAsTheWeakerMember) {
  const double h = 10, l = 12, V = 2e6 / (l / 2), H = 0.2e6 / h;
  SceneDef scene = portal(h, l, H, V, 0.5, true);
  for (std::size_t i = 1; i < 4; ++i) {
    BodyDef& body = scene.bodies[i];
    const double middle = (i == 3 ? l : h) / 2;
    body.cuts = {{Point{middle, -t}, Point{middle, t}}};
    if (i == 3) continue;
    JointBetweenDef& corner = scene.joints[i + 1];
    corner.overrides = {};
    corner.welded = true;
  }
  const double column = H * h / 2, girder = V * l / 4 - H * h / 2;
  const LeastMass least = least_mass(scene, {{1, 2}, {3}}, 1);
  EXPECT_NEAR(bears(least.scene, 1) / column, 1, 1e-8);
  EXPECT_NEAR(bears(least.scene, 3) / girder, 1, 1e-8);
  EXPECT_NEAR(least.mass / (mass(2 * h, column) + mass(l, girder)), 1, 1e-8);
  EXPECT_NEAR(least.collapse, 1, 1e-7);
}

// Two equal spans on three supports, one loaded three times as much as the other: each span's mechanism,
// W l/2 = 2 M + the lesser of both at the middle support. M_2 = a_2/3, M_1 = (a_1 − a_2/3)/2 with a = W l/2:
// 1/2 of the first's (2, 1) and 1/6 of the second's (0, 3) are (1, 1).
TEST(LeastMass, ABeamOfTwoSpans) {
  const double l = 10, a1 = 3e6, a2 = 1e6;
  SceneDef scene = bending_only();
  scene.bodies = {member("one", {0, 0}, {l, 0}, false, 0.5), member("two", {l, 0}, {2 * l, 0}, false, 0.5)};
  for (BodyDef& body : scene.bodies) body.cuts.pop_back();
  scene.joints = {{.a = "one", .b = "two"}};
  scene.supports = {{.body = "one", .at = {0, 0}, .fix_x = true, .fix_y = true},
                    {.body = "one", .at = {l, 0}, .fix_y = true},
                    {.body = "two", .at = {2 * l, 0}, .fix_y = true}};
  scene.loads = {{.body = "one", .at = {l / 2, 0}, .force = {0, -a1 / (l / 2)}},
                 {.body = "two", .at = {1.5 * l, 0}, .force = {0, -a2 / (l / 2)}}};
  const LeastMass least = least_mass(scene, {{0}, {1}}, 1);
  const double M1 = (a1 - a2 / 3) / 2, M2 = a2 / 3;
  EXPECT_NEAR(bears(least.scene, 0) / M1, 1, 1e-8);
  EXPECT_NEAR(bears(least.scene, 1) / M2, 1, 1e-8);
  EXPECT_NEAR(least.mass / (mass(l, M1) + mass(l, M2)), 1, 1e-8);
  EXPECT_NEAR(least.collapse, 1, 1e-7);
}

// Two storeys with fixed feet under wind, span less than 2 h. With S the storey's shear times h/2, equal
// column ends are lightest, and beams carry what columns bring: columns S_1/2 and S_2/2, roof S_2/2, floor
// (S_1 + S_2)/2.
TEST(LeastMass, ATwoStoreyFrameUnderWind) {
  const double h = 5, l = 8, H1 = 60e3, H2 = 40e3;
  SceneDef scene = bending_only();
  scene.bodies = {floor_to(l),
                  member("left1", {0, 0}, {0, h}, false),
                  member("right1", {l, 0}, {l, h}, false),
                  member("left2", {0, h}, {0, 2 * h}, true),
                  member("right2", {l, h}, {l, 2 * h}, true),
                  member("floor1", {0, h}, {l, h}, true),
                  member("roof", {0, 2 * h}, {l, 2 * h}, true)};
  scene.joints = {{.a = "floor", .b = "left1"},
                  {.a = "floor", .b = "right1"},
                  node({"left1", "left2", "floor1"}, {0, h}),
                  node({"right1", "right2", "floor1"}, {l, h}),
                  node({"left2", "roof"}, {0, 2 * h}),
                  node({"right2", "roof"}, {l, 2 * h})};
  scene.loads = {{.body = "floor1", .at = {0, h}, .force = {H1, 0}},
                 {.body = "roof", .at = {0, 2 * h}, .force = {H2, 0}}};
  const LeastMass least = least_mass(scene, {{1, 2}, {3, 4}, {5}, {6}}, 1);
  const double S1 = (H1 + H2) * h / 2, S2 = H2 * h / 2;
  EXPECT_NEAR(bears(least.scene, 1) / (S1 / 2), 1, 1e-5);
  EXPECT_NEAR(bears(least.scene, 3) / (S2 / 2), 1, 1e-5);
  EXPECT_NEAR(bears(least.scene, 5) / ((S1 + S2) / 2), 1, 1e-5);
  EXPECT_NEAR(bears(least.scene, 6) / (S2 / 2), 1, 1e-5);
  EXPECT_NEAR(
      least.mass / (mass(2 * h, S1 / 2) + mass(2 * h, S2 / 2) + mass(l, (S1 + S2) / 2) + mass(l, S2 / 2)), 1,
      1e-5);
  EXPECT_NEAR(least.collapse, 1, 1e-6);
}

// A cantilever of two parts under its own weight and a load at its tip, whose weight grows with the depths:
// depths are M/m, of moments at the roots, m d = λ (P x + ½ w d x² …).
TEST(LeastMass, WeightGrowsWithTheDepths) {
  const double l = 10, P = 1e3, factor = 1.5, w = mass_per_volume * t * 9.81, m = moment_per_depth;
  SceneDef scene = bending_only();
  scene.gravity = {0, -9.81};
  scene.bodies = {wall("wall", -1, 0), member("inner", {0, 0}, {l, 0}, false),
                  member("outer", {l, 0}, {2 * l, 0}, false)};
  for (std::size_t i = 1; i < 3; ++i) scene.bodies[i].cuts.clear();
  scene.joints = {{.a = "wall", .b = "inner"}, {.a = "inner", .b = "outer"}};
  scene.loads = {{.body = "outer", .at = {2 * l, 0}, .force = {0, -P}}};
  const double outer = factor * P * l / (m - factor * w * l * l / 2);
  const double inner = factor * (2 * P * l + 1.5 * w * outer * l * l) / (m - factor * w * l * l / 2);
  const LeastMass least = least_mass(scene, {{1}, {2}}, factor);
  EXPECT_NEAR(least.scene.bodies[1].depth / inner, 1, 1e-8);
  EXPECT_NEAR(least.scene.bodies[2].depth / outer, 1, 1e-8);
  EXPECT_NEAR(least.collapse / factor, 1, 1e-7);
}

TEST(LeastMass, WhatNoDepthBearsIsTold) {
  SceneDef scene = cantilever(4, 1e5);
  scene.joints[0].overrides.moment = 1e5;  // given, at 1e5 · 20
  EXPECT_THROW(least_mass(scene, {{1}}, 1), InvalidInput);
  scene.joints[0].overrides.moment = 3e6;
  EXPECT_NEAR(least_mass(scene, {{1}}, 1).scene.bodies[1].depth * plastic_moment / (1e5 * 15), 1, 1e-8);
  EXPECT_THROW(least_mass(scene, {{0}}, 1), InvalidInput);
  EXPECT_THROW(least_mass(scene, {{1}, {1}}, 1), InvalidInput);
  EXPECT_THROW(least_mass(scene, {{1}}, -1), InvalidInput);
  scene.interaction = true;
  EXPECT_THROW(least_mass(scene, {{1}}, 1), InvalidInput);
}

}  // namespace
