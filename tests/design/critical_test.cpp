// Critical loads and beam-columns of 20 pieces a member against closed forms, to 1e-3.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "ductile/design.h"
#include "frames.h"

namespace {
using namespace ductile;

constexpr double L = 20, EI = 210e9 / 12, pi = std::numbers::pi;
constexpr int n = 20;
constexpr double within = 1e-3;

// Euler's bars neither shear nor shorten.
Plan slender(const SceneDef& scene) {
  Plan plan = calibrate(scene);
  for (PlannedJoint& joint : plan.joints)
    if (joint.a >= 0) joint.stiffness.N = joint.stiffness.Q = unlimited;  // supports are as they are
  return plan;
}
double critical(const SceneDef& scene) { return critical_load(slender(scene)).factor; }

// The lowest root of f between a and b.
double root(double a, double b, const std::function<double(double)>& f) {
  for (int i = 0; i < 200; ++i) {
    const double m = (a + b) / 2;
    ((f(m) > 0) == (f(a) > 0) ? a : b) = m;
  }
  return a;
}

SceneDef fixed_pinned() {
  SceneDef scene = cantilever(n, 0);
  scene.supports = {{.body = "beam", .at = {L, 0}, .fix_y = true}};
  scene.loads[0].force = {-1, 0};
  return scene;
}
SceneDef on_two_pins() {
  SceneDef scene = simply_supported(n, 0);
  scene.loads[0] = {.body = "beam", .at = {L, 0}, .force = {-1, 0}};
  return scene;
}

TEST(CriticalLoad, EulersFourColumns) {
  SceneDef free = cantilever(n, 0);
  free.loads[0].force = {-1, 0};
  EXPECT_NEAR(critical(free) / (pi * pi * EI / (4 * L * L)), 1, within);
  EXPECT_NEAR(critical(on_two_pins()) / (pi * pi * EI / (L * L)), 1, within);
  const double kl = root(4, 4.6, [](double x) { return std::sin(x) - x * std::cos(x); });  // tan x = x
  EXPECT_NEAR(critical(fixed_pinned()) / (kl * kl * EI / (L * L)), 1, within);
  SceneDef clamped = fixed_fixed(n, 0);
  clamped.loads[0] = {.body = "beam", .at = {L, 0}, .force = {-1, 0}};
  EXPECT_NEAR(critical(clamped) / (4 * pi * pi * EI / (L * L)), 1, within);
}

// A support clamps as a wall does.
TEST(CriticalLoad, AColumnClampedByItsSupport) {
  SceneDef free = cantilever(n, 0);
  free.bodies.erase(free.bodies.begin());
  free.joints.clear();
  free.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true, .fix_angle = true}};
  free.loads[0].force = {-1, 0};
  EXPECT_NEAR(critical(free) / (pi * pi * EI / (4 * L * L)), 1, within);
}

// A column on a foot that turns: φ tan φ = k L/EI.
TEST(CriticalLoad, AColumnOnASpring) {
  for (const double k : {0.1, 1., 10., 1000.}) {
    SceneDef sprung = cantilever(n, 0);
    sprung.bodies.erase(sprung.bodies.begin());
    sprung.joints.clear();
    sprung.supports = {
        {.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true, .stiffness_angle = k * EI / L}};
    sprung.loads[0].force = {-1, 0};
    const double phi = root(0.01, pi / 2 - 1e-6, [&](double x) { return x * std::tan(x) - k; });
    EXPECT_NEAR(critical(sprung) / (phi * phi * EI / (L * L)), 1, within) << k;
  }
}

// A column that is welded to a girder within one of its pieces, whichever is named first: the girder, clamped
// at distances a and b, is the spring it stands on, and gives downwards. Where off is half a metre the
// girder's arm to the node is as long as the column's.
TEST(CriticalLoad, AColumnOnAGirder) {
  for (const double off : {0., 0.5}) {
    std::array<double, 2> found{};
    for (const bool column_first : {true, false}) {
      const double half = 27 * 1.5 / 2, a = half + off, b = half - off;
      SceneDef scene = bending_only();
      BodyDef girder = beam(27, 2 * half), column = beam(n);
      girder.name = "girder";
      girder.at = {-a, 0};
      column.angle = pi / 2;
      scene.bodies = {girder, column};
      for (const double x : {-a, b})
        scene.supports.push_back(
            {.body = "girder", .at = {x, 0}, .fix_x = true, .fix_y = true, .fix_angle = true});
      scene.joints = {{.a = column_first ? "beam" : "girder",
                       .b = column_first ? "girder" : "beam",
                       .at = Point{0, 0},
                       .welded = true}};
      scene.loads = {{.body = "beam", .at = {0, L}, .force = {0, -1}}};
      const double turns = 4 / a + 4 / b, sinks = 12 * (1 / (a * a * a) + 1 / (b * b * b)),
                   both = 6 * (1 / (a * a) - 1 / (b * b)), k = L * (turns - both * both / sinks);
      const double phi = root(0.01, pi / 2 - 1e-6, [&](double x) { return x * std::tan(x) - k; });
      found[column_first] = critical(scene);
      EXPECT_NEAR(found[column_first] / (phi * phi * EI / (L * L)), 1, within) << off << column_first;
    }
    EXPECT_NEAR(found[0] / found[1], 1, 1e-9) << off;
  }
}

// On pins, one of which gives across: the bar turns as a whole at k L, or bends at Euler's load.
TEST(CriticalLoad, AColumnThatASpringHoldsAcross) {
  for (const double share : {0.003, 0.3, 0.9, 1.5, 100.}) {
    SceneDef sprung = on_two_pins();
    sprung.supports[1].fix_y = false;
    sprung.supports[1].stiffness_y = share * pi * pi * EI / (L * L * L);
    EXPECT_NEAR(critical(sprung) / (std::min(share, 1.) * pi * pi * EI / (L * L)), 1, within) << share;
  }
}

// Clamped against turning at one end and free to turn at the other, held across by a spring at either:
// tan φ = φ − φ³ EI/kL³, between the free column's π/2 and 4.4934.
TEST(CriticalLoad, AClampedColumnThatASpringHoldsAcross) {
  for (const double k : {0.1, 10., 1000.})
    for (const bool at_clamp : {true, false}) {
      SceneDef sprung = on_two_pins();
      SupportDef &clamp = sprung.supports[0], &end = sprung.supports[1];
      clamp.fix_angle = true;
      SupportDef& gives = at_clamp ? clamp : end;
      gives.fix_y = false;
      gives.stiffness_y = k * EI / (L * L * L);
      const auto f = [&](double x) { return std::sin(x) - std::cos(x) * (x - x * x * x / k); };
      const double phi = root(pi / 2, 4.4934, f);
      EXPECT_NEAR(critical(sprung) / (phi * phi * EI / (L * L)), 1, within) << k << at_clamp;
    }
}

// The same on a bearing that gives across, between the column and its foundation.
TEST(CriticalLoad, AColumnOnABearing) {
  for (const double k : {0.1, 10., 1000.}) {
    SceneDef scene = cantilever(n, 0);
    scene.joints[0].overrides.stiffness_shear = k * EI / (L * L * L);
    scene.joint.stiffness_shear = scene.joint.stiffness_axial = unlimited;
    scene.supports = {{.body = "beam", .at = {L, 0}, .fix_y = true}};
    scene.loads[0].force = {-1, 0};
    const auto f = [&](double x) { return std::sin(x) - std::cos(x) * (x - x * x * x / k); };
    const double phi = root(pi / 2, 4.4934, f);
    EXPECT_NEAR(critical_load(calibrate(scene)).factor / (phi * phi * EI / (L * L)), 1, within) << k;
  }
}

// A stepped column, fixed at its foot: stiff over the lower half. k₁ tan(k₁ L/2) = k₂ cot(k₂ L/2).
TEST(CriticalLoad, ASteppedColumn) {
  SceneDef scene = cantilever(n / 2, 0);
  scene.bodies[1] = beam(n / 2, L / 2);
  BodyDef upper = beam(n / 2, L / 2, 0.7);
  upper.name = "upper";
  upper.at = {L / 2, 0};
  scene.bodies.push_back(upper);
  scene.joints.push_back({.a = "beam", .b = "upper"});
  scene.loads = {{.body = "upper", .at = {L, 0}, .force = {-1, 0}}};
  const double EI2 = EI * 0.7 * 0.7 * 0.7;
  const double P = root(0.01 * EI / (L * L), pi * pi * EI2 / (L * L), [&](double P) {
    const double k1 = std::sqrt(P / EI), k2 = std::sqrt(P / EI2);
    return std::tan(k1 * L / 2) * std::tan(k2 * L / 2) - k2 / k1;
  });
  EXPECT_NEAR(critical(scene) / P, 1, within);
}

// Columns of kh = φ with the girder's end stiffness: sway 6 EI/l, symmetric 2 EI/l. (Timoshenko and Gere,
// Theory of Elastic Stability, 2.4; slope-deflection with stability functions.)
TEST(CriticalLoad, SwayAndBracedPortals) {
  const Frame f;
  const double r = f.h / f.l, unit = f.stiffness() / (f.h * f.h);
  // Pinned feet, sway: φ tan φ = 6 r.
  double phi = root(0.1, pi / 2 - 1e-9, [&](double x) { return x * std::tan(x) - 6 * r; });
  EXPECT_NEAR(critical(f.scene(false, 1)) / (phi * phi * unit), 1, within);
  // Fixed feet, sway: φ / tan φ = −6 r.
  phi = root(pi / 2 + 1e-9, pi - 1e-9, [&](double x) { return x / std::tan(x) + 6 * r; });
  EXPECT_NEAR(critical(f.scene(true, 1)) / (phi * phi * unit), 1, within);
  // Pinned feet, braced, symmetric: M = 2 r EI/h at θ: φ² tan φ/(tan φ − φ) = −2 r.
  phi = root(pi + 1e-9, 4.4934 - 1e-9,
             [&](double x) { return x * x * std::tan(x) / (std::tan(x) - x) + 2 * r; });
  EXPECT_NEAR(critical(f.braced(f.scene(false, 1))) / (phi * phi * unit), 1, within);
  // Fixed feet, braced, symmetric: stability function s = φ (sin φ − φ cos φ)/(2 − 2 cos φ − φ sin φ) = −2 r.
  phi = root(4.4934, 2 * pi - 1e-6, [&](double x) {
    return x * (std::sin(x) - x * std::cos(x)) / (2 - 2 * std::cos(x) - x * std::sin(x)) + 2 * r;
  });
  EXPECT_NEAR(critical(f.braced(f.scene(true, 1))) / (phi * phi * unit), 1, within);
}

// The same on centre lines that meet in nodes, of members that are split evenly.
TEST(CriticalLoad, PortalsOnNodes) {
  const Frame f;
  const double r = f.h / f.l, unit = f.stiffness() / (f.h * f.h), t = f.t / 2;
  const auto portal = [&](bool fixed_feet, bool braced) {
    SceneDef s = bending_only();
    s.bodies = {f.member("left", rectangle(-t, 0, t, f.h), {0, 0}, {0, f.h}),
                f.member("right", rectangle(f.l - t, 0, f.l + t, f.h), {f.l, 0}, {f.l, f.h}),
                f.member("girder", rectangle(0, f.h - t, f.l, f.h + t), {0, f.h}, {f.l, f.h})};
    for (const double x : {0., f.l}) {
      const std::string column = x == 0 ? "left" : "right";
      JointBetweenDef corner{.a = column, .b = "girder", .at = Point{x, f.h}};
      corner.overrides.moment = unlimited;
      s.joints.push_back(corner);
      s.supports.push_back(
          {.body = column, .at = {x, 0}, .fix_x = true, .fix_y = true, .fix_angle = fixed_feet});
      s.loads.push_back({.body = column, .at = {x, f.h}, .force = {0, -1}});
    }
    if (braced) s.supports.push_back({.body = "girder", .at = {f.l, f.h}, .fix_x = true});
    return s;
  };
  double phi = root(0.1, pi / 2 - 1e-9, [&](double x) { return x * std::tan(x) - 6 * r; });
  EXPECT_NEAR(critical(portal(false, false)) / (phi * phi * unit), 1, within);
  phi = root(pi / 2 + 1e-9, pi - 1e-9, [&](double x) { return x / std::tan(x) + 6 * r; });
  EXPECT_NEAR(critical(portal(true, false)) / (phi * phi * unit), 1, within);
  phi = root(pi + 1e-9, 4.4934 - 1e-9,
             [&](double x) { return x * x * std::tan(x) / (std::tan(x) - x) + 2 * r; });
  EXPECT_NEAR(critical(portal(false, true)) / (phi * phi * unit), 1, within);
}

// A column on a pin, held across at its head by two clamped beams of its section, each of which resists its
// turn by 4 EI/l: φ² = (φ cot φ − 1) 8 h/l. Whichever body is the node's first.
TEST(CriticalLoad, ThreeBarsInANode) {
  const double h = 8, l = 6, t = 0.4;
  const Frame f;
  SceneDef s = bending_only();
  s.bodies = {f.member("column", rectangle(-t / 2, 0, t / 2, h), {0, 0}, {0, h}),
              f.member("left", rectangle(-l, h - t / 2, 0, h + t / 2), {-l, h}, {0, h}),
              f.member("right", rectangle(0, h - t / 2, l, h + t / 2), {0, h}, {l, h})};
  s.supports = {{.body = "column", .at = {0, 0}, .fix_x = true, .fix_y = true},
                {.body = "left", .at = {-l, h}, .fix_x = true, .fix_y = true, .fix_angle = true},
                {.body = "right", .at = {l, h}, .fix_y = true, .fix_angle = true}};
  s.loads = {{.body = "column", .at = {0, h}, .force = {0, -1}}};
  const double phi =
      root(pi + 1e-9, 4.4934, [&](double x) { return x * x - (x / std::tan(x) - 1) * 8 * h / l; });
  struct Order {
    std::array<const char*, 3> bodies;
    double within;
  };
  for (const auto& [bodies, off] :
       {Order{{"left", "right", "column"}, within}, Order{{"column", "left", "right"}, 3. / (n * n)}}) {
    JointBetweenDef node{.a = bodies[0], .b = bodies[1], .at = Point{0, h}, .others = {bodies[2]}};
    node.overrides.moment = unlimited;
    s.joints = {node};
    EXPECT_NEAR(critical(s) / (phi * phi * f.stiffness() / (h * h)), 1, off) << bodies[0];
  }
}

// A column on pins that carries a P leans on a mast that carries P: with k² = P/EI and φ = k h,
// y'' + k² y = k² δ + a k² δ (h − x)/h, so tan φ = φ (1 + 1/a).
TEST(CriticalLoad, ALeaningColumn) {
  const Frame f;
  const double top = f.h - f.t / 2, t = f.t, l = f.l;
  for (const double a : {1.0, 3.0}) {
    SceneDef s = bending_only();
    s.bodies = {
        {.name = "floor", .type = BodyType::static_body, .outline = {rectangle(-2, -1, l + 2, 0), {}}},
        f.member("mast", rectangle(-t / 2, 0, t / 2, f.h), {0, 0}, {0, f.h}),
        f.member("prop", rectangle(l - t / 2, 0, l + t / 2, f.h), {l, 0}, {l, f.h}),
        f.member("tie", rectangle(t / 2, f.h - t, l - t / 2, f.h), {t / 2, top}, {l - t / 2, top})};
    const JointOverrides pin{.moment = 0};
    s.joints = {{.a = "floor", .b = "mast"},
                {.a = "floor", .b = "prop", .overrides = pin},
                {.a = "mast", .b = "tie", .overrides = pin},
                {.a = "tie", .b = "prop", .overrides = pin}};
    s.loads = {{.body = "mast", .at = {0, top}, .force = {0, -1}},
               {.body = "prop", .at = {l, top}, .force = {0, -a}}};
    const double phi = root(0.1, pi / 2 - 1e-9, [&](double x) { return std::tan(x) - x * (1 + 1 / a); });
    EXPECT_NEAR(critical(s) / (phi * phi * f.stiffness() / (top * top)), 1, within) << a;
  }
}

// A prop on two pins that leans on nothing: it turns without strain, and any load on it pushes it over.
// The same with a hinge in the middle, and of a portal with pins at its corners.
TEST(CriticalLoad, WhatMovesWithoutStrainFallsUnderAnyLoad) {
  const Frame f;
  SceneDef prop = on_two_pins();
  prop.supports.pop_back();
  SceneDef hinged = on_two_pins();
  BodyDef half = beam(n / 2, L / 2);
  hinged.bodies = {half, half};
  hinged.bodies[1].name = "upper";
  hinged.bodies[1].at = {L / 2, 0};
  hinged.joints = {{.a = "beam", .b = "upper", .at = Point{L / 2, 0}}};
  hinged.supports[1].body = hinged.loads[0].body = "upper";
  SceneDef portal = bending_only();
  portal.bodies = {f.member("left", rectangle(-f.t / 2, 0, f.t / 2, f.h), {0, 0}, {0, f.h}),
                   f.member("right", rectangle(f.l - f.t / 2, 0, f.l + f.t / 2, f.h), {f.l, 0}, {f.l, f.h}),
                   f.member("girder", rectangle(0, f.h - f.t / 2, f.l, f.h + f.t / 2), {0, f.h}, {f.l, f.h})};
  for (const double x : {0., f.l}) {
    const std::string column = x == 0 ? "left" : "right";
    portal.joints.push_back({.a = column, .b = "girder", .at = Point{x, f.h}});
    portal.supports.push_back({.body = column, .at = {x, 0}, .fix_x = true, .fix_y = true});
  }
  portal.loads = {{.body = "girder", .at = {f.l / 2, f.h}, .force = {0, -1e-3}}};
  for (const SceneDef& scene : {prop, hinged, portal}) {
    const Plan plan = calibrate(scene);
    const CriticalLoad load = critical_load(plan);
    EXPECT_EQ(load.factor, 0);
    ASSERT_EQ(load.mechanism.size(), plan.pieces.size());
    EXPECT_EQ(static_check(plan, Order::second).reserve, 0);
    const Pushover pushed = second_order_limit(plan);
    EXPECT_EQ(pushed.load_factor, 0);
    EXPECT_EQ(pushed.mechanism.size(), plan.pieces.size());
    SceneDef pulled = scene;
    Point& force = pulled.loads[0].force;
    force = {-force.x, -force.y};
    const CriticalLoad held = critical_load(calibrate(pulled));
    EXPECT_TRUE(held.mechanism.empty()) << "the loads hold it, as they hold a pendulum";
    EXPECT_GT(held.factor, 1);
  }
  // The girder moves on a level, and the columns turn about their feet.
  const Plan plan = calibrate(portal);
  const CriticalLoad load = critical_load(plan);
  const double way = load.mechanism.back().along.x;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const double share = plan.pieces[i].body == 2 ? 1 : plan.pieces[i].center.y / f.h;
    EXPECT_NEAR(load.mechanism[i].along.x / way, share, 1e-9);
    EXPECT_NEAR(load.mechanism[i].turn * f.h / way, plan.pieces[i].body == 2 ? 0 : -1, 1e-9);
  }
}

// A weight that hangs from a column's top on a bar with a pin follows it wherever it goes: Euler's column
// with the load on its top. What stands there on such a pin falls at once.
TEST(CriticalLoad, AWeightThatHangsFromAColumn) {
  SceneDef scene = cantilever(n, 0);
  BodyDef bob = beam(1, 3);
  bob.name = "bob";
  bob.at = {L - 3, 0};
  scene.bodies.push_back(bob);
  scene.joints.push_back({.a = "beam", .b = "bob", .at = Point{L, 0}});
  scene.loads = {{.body = "bob", .at = {L - 3, 0}, .force = {-1, 0}}};
  EXPECT_NEAR(critical(scene) / (pi * pi * EI / (4 * L * L)), 1, within);
  EXPECT_TRUE(critical_load(slender(scene)).mechanism.empty());
  scene.bodies.back().at.x = L;
  scene.loads[0].at.x = L + 3;
  EXPECT_EQ(critical(scene), 0);
}

// A bar on rollers alone, pressed from both ends, buckles at Euler's load, and nothing keeps it in its place.
TEST(CriticalLoad, WhatIsAdriftBucklesAllTheSame) {
  SceneDef scene = on_two_pins();
  scene.supports[0].fix_x = false;
  scene.loads.push_back({.body = "beam", .at = {0, 0}, .force = {1, 0}});
  const Plan plan = slender(scene);
  const CriticalLoad load = critical_load(plan);
  EXPECT_NEAR(load.factor / (pi * pi * EI / (L * L)), 1, within);
  ASSERT_EQ(load.mechanism.size(), plan.pieces.size());
  for (const Motion& m : load.mechanism) {
    EXPECT_NEAR(std::abs(m.along.x), 1, 1e-9);
    EXPECT_NEAR(m.along.y, 0, 1e-9);
  }
}

TEST(CriticalLoad, TheModeIsTheDisplacementOfThePieces) {
  const CriticalLoad load = critical_load(slender(on_two_pins()));
  for (int i = 0; i < n; ++i) {
    const double x = (i + 0.5) / n, sine = std::sin(pi * x);
    const Motion &m = load.mode[static_cast<std::size_t>(i)], &middle = load.mode[n / 2];
    EXPECT_NEAR(m.along.y / middle.along.y, sine / std::sin(pi * (0.5 + 0.5 / n)), 2e-3);
    EXPECT_NEAR(m.along.x, 0, 1e-6);
  }
}

TEST(CriticalLoad, NoneInTension) {
  SceneDef bar = cantilever(10, 0);
  bar.loads[0].force = {1e6, 0};
  EXPECT_GT(critical(bar), 1e6);
}

// The loads that act at one time belong together, and the worst time counts.
TEST(CriticalLoad, NoneOfWhatIsRigid) {
  SceneDef scene = on_two_pins();
  scene.joint.elastic = Elasticity::rigid;
  EXPECT_EQ(critical_load(calibrate(scene)).factor, unlimited);
  scene.joint.moment = unlimited;
  EXPECT_EQ(second_order_limit(calibrate(scene)).load_factor, unlimited);
}

TEST(CriticalLoad, LoadsThatEnd) {
  SceneDef scene = on_two_pins();
  scene.loads[0].to = 1;
  scene.loads.push_back(scene.loads[0]);
  scene.loads[1].force.x *= 2;
  scene.loads[1].from = 2;
  scene.loads[1].to = 3;
  const CriticalLoad load = critical_load(slender(scene));
  EXPECT_EQ(load.time, 2);
  EXPECT_NEAR(load.factor * 2 / (pi * pi * EI / (L * L)), 1, within);
}

// --- beam-columns: P = u² · 4 EI/L², the moment in the middle ---

StaticCheck second(const SceneDef& scene) { return static_check(slender(scene), Order::second); }
double at(const SceneDef& scene, const std::string& joint) {
  return second(scene).joints[static_cast<std::size_t>(joint_named(slender(scene), joint))].M;
}

// The end's moment bends the half piece beyond the last middle, too.
TEST(SecondOrder, AnEccentricLoadGrowsByTheSecant) {
  for (const double u : {0.25, 0.5, 1.0, 1.3}) {
    const double P = 4 * u * u * EI / (L * L), moment = 1e4;
    SceneDef scene = on_two_pins();
    scene.loads = {{.body = "beam", .at = {L, 0}, .force = {-P, 0}, .moment = moment},
                   {.body = "beam", .at = {0, 0}, .moment = -moment}};
    EXPECT_NEAR(std::abs(at(scene, "beam/9-beam/10")) / (moment / std::cos(u)), 1, within) << u;
  }
}

TEST(SecondOrder, ALoadInTheMiddleGrowsByTheTangent) {
  for (const double u : {0.25, 0.5, 1.0, 1.25}) {
    const double P = 4 * u * u * EI / (L * L), W = 1e4;
    SceneDef scene = on_two_pins();
    scene.loads[0].force = {-P, 0};
    scene.loads.push_back({.body = "beam", .at = {L / 2, 0}, .force = {0, -W}});
    EXPECT_NEAR(std::abs(at(scene, "beam/9-beam/10")) / (W * L / 4 * std::tan(u) / u), 1, within) << u;
  }
}

// A mast with a load across its top: W h tan φ/φ at its foot, and the deflection W h³/3EI · 3 (tan φ − φ)/φ³.
TEST(SecondOrder, AMast) {
  for (const double phi : {0.4, 0.8, 1.2, 1.45}) {
    const double P = phi * phi * EI / (L * L), W = 1e4;
    SceneDef scene = cantilever(n, W);
    scene.loads[0].force.x = -P;
    const StaticCheck check = second(scene);
    const Plan plan = slender(scene);
    EXPECT_NEAR(check.joints[static_cast<std::size_t>(joint_named(plan, "wall-beam/0"))].M /
                    (-W * L * std::tan(phi) / phi),
                1, within)
        << phi;
    // of the top: half a piece above the last one's centre
    const double top = check.displacement.back().y + check.turn.back() * L / n / 2;
    EXPECT_NEAR(top / (-W * L / P * (std::tan(phi) / phi - 1)), 1, within) << phi;
  }
}

// Across y and x, what supports and walls carry is what acts on the structure, as a support's axis does not
// turn and that of a joint to a wall turns half as far as the piece there: it holds in the state that
// has moved, and of each support where statics alone has it.
TEST(SecondOrder, ReactionsAreWhatActs) {
  const double W = 1e4, u = 1, P = 4 * u * u * EI / (L * L);
  SceneDef pins = on_two_pins();
  pins.loads[0].force = {-P, 0};
  pins.loads.push_back({.body = "beam", .at = {L / 2, 0}, .force = {0, -W}});
  SceneDef sprung = on_two_pins();  // it leans: k d − P d/L = W
  sprung.supports[1].fix_y = false;
  sprung.supports[1].stiffness_y = 2 * P / L;
  sprung.loads[0].force = {-P, W};
  SceneDef wall = cantilever(n, W);
  wall.loads[0].force.x = -P / 4;
  SceneDef pinned_wall = fixed_pinned();
  pinned_wall.joints[0].overrides.moment = 0;
  pinned_wall.loads = pins.loads;
  SceneDef clamp = pins;
  clamp.supports[0].fix_angle = true;
  clamp.supports.pop_back();
  clamp.loads = wall.loads;
  SceneDef turning = clamp;
  turning.supports[0].fix_angle = false;
  turning.supports[0].stiffness_angle = 20 * EI / L;

  const Frame f;  // a gable, of members that slope by 1 to 2
  const double t = f.t / 2, c = t / std::sqrt(5), l = f.l, ridge = f.h + l / 4;
  SceneDef gable = bending_only();
  gable.bodies = {
      f.member("left", rectangle(-t, 0, t, f.h), {0, 0}, {0, f.h}),
      f.member("rise",
               {{c, f.h - 2 * c}, {l / 2 + c, ridge - 2 * c}, {l / 2 - c, ridge + 2 * c}, {-c, f.h + 2 * c}},
               {0, f.h}, {l / 2, ridge}),
      f.member("fall",
               {{l / 2 - c, ridge - 2 * c},
                {l - c, f.h - 2 * c},
                {l + c, f.h + 2 * c},
                {l / 2 + c, ridge + 2 * c}},
               {l / 2, ridge}, {l, f.h}),
      f.member("right", rectangle(l - t, 0, l + t, f.h), {l, 0}, {l, f.h})};
  for (const auto& [a, b, at] : {std::tuple("left", "rise", Point{0, f.h}),
                                 {"rise", "fall", Point{l / 2, ridge}},
                                 {"fall", "right", Point{l, f.h}}}) {
    gable.joints.push_back({.a = a, .b = b, .at = at});
    gable.joints.back().overrides.moment = unlimited;
  }
  gable.supports = {{.body = "left", .at = {0, 0}, .fix_x = true, .fix_y = true, .fix_angle = true},
                    {.body = "right", .at = {l, 0}, .fix_x = true, .fix_y = true}};
  const double heavy = 0.3 * f.stiffness() / (f.h * f.h);
  gable.loads = {{.body = "rise", .at = {l / 2, ridge}, .force = {0, -heavy}},
                 {.body = "left", .at = {0, f.h}, .force = {heavy / 10, -2 * heavy}}};

  struct Case {
    const char* what;
    SceneDef scene;
    std::vector<double> Q;  // of each support, where it is known
  };
  for (const auto& [what, scene, Q] :
       {Case{"pins", pins, {-W / 2, -W / 2}}, Case{"a spring across", sprung, {-W, 2 * W}},
        Case{"a clamp", clamp, {-W}}, Case{"a spring that turns", turning, {-W}}, Case{"a wall", wall, {}},
        Case{"a pin on a wall", pinned_wall, {-W / 2}}, Case{"a gable", gable, {}}}) {
    const Plan plan = slender(scene);
    const StaticCheck check = static_check(plan, Order::second);
    Point carried, loads;
    double largest = 0;
    std::vector<double> across;
    for (std::size_t i = 0; i < plan.joints.size(); ++i) {
      const PlannedJoint& joint = plan.joints[i];
      if (joint.a >= 0 && plan.is_dynamic(joint.a)) continue;
      const StaticJoint& has = check.joints[i];
      const double turn = joint.a < 0 ? 0 : check.turn[static_cast<std::size_t>(joint.b)] / 2;
      const Point axis{joint.axis.x - turn * joint.axis.y, joint.axis.y + turn * joint.axis.x};
      carried.x += has.N * axis.x - has.Q * axis.y;
      carried.y += has.N * axis.y + has.Q * axis.x;
      if (joint.a < 0) across.push_back(has.Q);
    }
    for (const LoadDef& load : scene.loads) {
      loads.x += load.force.x;
      loads.y += load.force.y;
      largest = std::max(largest, std::hypot(load.force.x, load.force.y));
    }
    EXPECT_NEAR(carried.x, loads.x, 1e-5 * largest) << what;
    EXPECT_NEAR(carried.y, loads.y, 1e-5 * largest) << what;
    for (std::size_t i = 0; i < Q.size(); ++i) EXPECT_NEAR(across[i], Q[i], 1e-3 * W) << what << i;
  }
}

// What the bar bears at all: N/N_p does not count in bending_only(), so M_p = moment · sec u at the reserve.
TEST(SecondOrder, TheReserveOfAnEccentricLoad) {
  const double P = 4 * EI / (L * L), moment = 1e7;  // u = 1 at factor 1
  SceneDef scene = on_two_pins();
  scene.loads = {{.body = "beam", .at = {L, 0}, .force = {-P, 0}, .moment = moment},
                 {.body = "beam", .at = {0, 0}, .moment = -moment}};
  const double factor = root(0.01, pi * pi / 4 - 1e-9,
                             [&](double f) { return plastic_moment - f * moment / std::cos(std::sqrt(f)); });
  const StaticCheck check = second(scene);
  EXPECT_NEAR(check.reserve / factor, 1, within);
  EXPECT_GT(static_check(slender(scene)).reserve, 3 * factor) << "of first order";
}

// Tension straightens: tanh φ/φ.
TEST(SecondOrder, TensionRelieves) {
  const double phi = 1.2, T = phi * phi * EI / (L * L), W = 1e6;
  SceneDef scene = cantilever(n, W);
  scene.loads[0].force.x = T;
  const double root_moment = at(scene, "wall-beam/0");
  EXPECT_NEAR(root_moment / (-W * L * std::tanh(phi) / phi), 1, within);
  EXPECT_GT(second(scene).reserve, static_check(slender(scene)).reserve);
}

TEST(SecondOrder, BeyondTheCriticalLoadThereIsNoState) {
  SceneDef scene = on_two_pins();
  scene.loads[0].force = {-2 * pi * pi * EI / (L * L), 0};
  const StaticCheck check = second(scene);
  EXPECT_NEAR(check.reserve, 0.5, within);
  EXPECT_TRUE(std::isnan(check.joints[0].M));
  EXPECT_TRUE(std::isnan(check.displacement[3].y));
}

// --- the first fibre ---

TEST(FirstFibre, OfABeamAndOfAColumn) {
  const SceneDef beam = cantilever(n, 1e6);
  const Plan plan = calibrate(beam);
  const Reached bent = first_fibre(plan, static_check(plan));
  EXPECT_EQ(plan.joints[static_cast<std::size_t>(bent.joint)].name, "wall-beam/0");
  EXPECT_NEAR(bent.factor / (plastic_moment / 1.5 / (1e6 * L)), 1, 1e-9);

  SceneDef column = cantilever(n, 1e5);
  column.loads[0].force.x = -50e6;
  const Plan both = calibrate(column);
  const Reached pressed = first_fibre(both, static_check(both));
  EXPECT_NEAR(pressed.factor * (50e6 / 350e6 + 1e5 * L * 6 / 350e6), 1, 1e-9);
}

}  // namespace
