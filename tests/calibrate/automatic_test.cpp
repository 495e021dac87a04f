// "split": "auto": where cuts are put, and that the error that was asked for is kept.
#include <Eigen/Dense>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include "axis.h"
#include "convex.h"
#include "ductile/box2d.h"
#include "ductile/moments.h"
#include "ductile/plane.h"
#include "scenes.h"
#include "split.h"

namespace {
using namespace ductile;
using namespace ductile::calibration;

constexpr double E = 210e9, density = 7800, g = 9.81, kappa_G = 5.0 / 6 * E / 2.6;

// Small displacements at rest under the pieces' weight: one linear system over all pieces, from the joints'
// stiffnesses alone.
class Statics {
 public:
  explicit Statics(const Plan& plan) : plan_(plan) {
    const auto n = static_cast<Eigen::Index>(3 * plan.pieces.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
    double stiffest = 0;
    for (const PlannedJoint& j : plan.joints)
      for (const double k : {j.stiffness.N, j.stiffness.Q})
        if (k < unlimited) stiffest = std::max(stiffest, k);
    for (const PlannedJoint& j : plan.joints) {
      const double k[3] = {j.stiffness.N, j.stiffness.Q, j.stiffness.M}, cap[3] = {j.N, j.Q, j.M};
      for (int row = 0; row < 3; ++row) {
        if (cap[row] == 0) continue;
        Eigen::VectorXd J = Eigen::VectorXd::Zero(n);
        for (const auto& [piece, sign] : {std::pair(j.a, -1.0), std::pair(j.b, 1.0)}) {
          if (piece < 0) continue;
          const Point r = j.anchor - plan.pieces[static_cast<std::size_t>(piece)].center;
          const Point d = row == 0 ? j.axis : left(j.axis);
          if (row < 2)
            J.segment<3>(3 * piece) += sign * Eigen::Vector3d(d.x, d.y, cross(r, d));
          else
            J(3 * piece + 2) += sign;
        }
        K += std::min(k[row], 1e4 * stiffest) * J * J.transpose();
      }
    }
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(3 * i);
      if (plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)].type == BodyType::static_body) {
        K.middleRows(at, 3).setZero();
        K.middleCols(at, 3).setZero();
        K.diagonal().segment(at, 3).setOnes();
      } else {
        f(at + 1) = -plan.pieces[i].mass * g;
      }
    }
    u_ = K.ldlt().solve(f);
  }

  // Of the point of a body that is at `at`, inside or on a vertex.
  Point displacement(int body, Point at) const {
    std::size_t under = 0;
    for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
      if (plan_.pieces[i].body == body && locate(plan_.pieces[i].outline.outer, at) >= 0) under = i;
    const Eigen::Vector3d u = u_.segment<3>(static_cast<Eigen::Index>(3 * under));
    const Point r = at - plan_.pieces[under].center;
    return {u(0) - u(2) * r.y, u(1) + u(2) * r.x};
  }

 private:
  const Plan& plan_;
  Eigen::VectorXd u_;
};

// A strip around a centreline, which starts at the origin towards +x.
Outline ribbon(int n, const std::function<Point(double)>& centre,
               const std::function<double(double)>& width) {
  Ring ring, back;
  for (int i = 0; i <= n; ++i) {
    const double t = static_cast<double>(i) / n, d = 1e-6;
    const Point u = unit(centre(std::min(1.0, t + d)) - centre(std::max(0.0, t - d)));
    ring.push_back(centre(t) + width(t) / 2 * right(u));
    back.push_back(centre(t) + width(t) / 2 * left(u));
  }
  ring.insert(ring.end(), back.rbegin(), back.rend());
  ring.front().x = ring.back().x = 0;
  return {ring, {}};
}

SceneDef clamped(const Outline& outline, double target) {
  SceneDef scene;
  scene.target_error = target;
  double low = 0, high = 0;
  for (const Point& p : outline.outer) {
    if (std::abs(p.x) > 1e-12) continue;
    low = std::min(low, p.y);
    high = std::max(high, p.y);
  }
  scene.bodies = {
      {.name = "wall", .type = BodyType::static_body, .outline = {rectangle(-1, low - 1, 0, high + 1), {}}},
      {.name = "beam", .outline = outline, .material = test_steel, .automatic = true}};
  scene.joints = {{.a = "wall", .b = "beam"}};
  return scene;
}

struct Shape {
  const char* name;
  Outline outline;
  Point tip;
};

std::vector<Shape> shapes_to_split() {
  constexpr double pi = std::numbers::pi;
  const auto one = [](double) { return 1.0; };
  return {
      {"straight", {rectangle(0, -0.5, 20, 0.5), {}}, {20, 0.5}},
      {"tapered", {{{0, -0.5}, {10, -0.1}, {10, 0.1}, {0, 0.5}}, {}}, {10, 0.1}},
      {"widening", {{{0, -0.2}, {10, -0.5}, {10, 0.5}, {0, 0.2}}, {}}, {10, 0.5}},
      {"ring sector",
       ribbon(
           60,
           [](double t) {
             return Point{5 * std::sin(2 * t), 5 * std::cos(2 * t) - 5};
           },
           one),
       {4.51 * std::sin(1.999), 4.51 * std::cos(1.999) - 5}},
      {"S",
       ribbon(
           80,
           [](double t) {
             return Point{12 * t, 1.5 - 1.5 * std::cos(2 * pi * t)};
           },
           [](double) { return 0.6; }),
       {11.99, 0.29}},
      {"C",
       {{{0, -0.5}, {8, -0.5}, {8, 5.5}, {2, 5.5}, {2, 4.5}, {7, 4.5}, {7, 0.5}, {0, 0.5}}, {}},
       {2, 5.5}},
      {"L", {{{0, -0.5}, {8, -0.5}, {8, 6}, {7, 6}, {7, 0.5}, {0, 0.5}}, {}}, {7, 6}},
      {"cross",
       {{{0, -0.5},
         {4.5, -0.5},
         {4.5, -5},
         {5.5, -5},
         {5.5, -0.5},
         {10, -0.5},
         {10, 0.5},
         {5.5, 0.5},
         {5.5, 5},
         {4.5, 5},
         {4.5, 0.5},
         {0, 0.5}},
        {}},
       {10, 0.5}},
      {"with holes",
       {rectangle(0, -0.5, 20, 0.5),
        {rectangle(4, -0.1, 4.3, 0.1), rectangle(9.4, -0.1, 9.8, 0.1), rectangle(15, -0.2, 15.3, 0.2)}},
       {20, 0.5}},
  };
}

// The tip's sag under the body's own weight: of the automatic split against one a hundred times as exact
// (errors fall as 1/n²). For the straight beam that is checked against the closed form below.
TEST(Automatic, ErrorIsBelowTheTarget) {
  std::printf("%-12s %8s %8s %10s %10s\n", "shape", "target", "pieces", "estimated", "measured");
  for (const Shape& shape : shapes_to_split()) {
    const Plan exact = calibrate(clamped(shape.outline, 1e-4));
    const Point reference = Statics(exact).displacement(1, shape.tip);
    for (const double target : {0.1, 0.03, 0.01}) {
      const Plan plan = calibrate(clamped(shape.outline, target));
      const SplitError& split = plan.split_errors.at(0);
      const double measured =
          length(Statics(plan).displacement(1, shape.tip) - reference) / length(reference);
      std::printf("%-12s %8g %8zu %10.5f %10.5f\n", shape.name, target, plan.pieces.size() - 1, split.error,
                  measured);
      EXPECT_LE(measured, target) << shape.name << ' ' << target;
      EXPECT_EQ(split.governed_by == "target error", split.error <= target);
    }
  }
}

// q L⁴/8EI + q L²/2κGA, and between walls q L⁴/384EI + q L²/8κGA (Timoshenko).
TEST(Automatic, ClosedFormsOfAStraightBeam) {
  const double L = 20, q = density * g, EI = E / 12;
  for (const double target : {0.1, 0.01, 0.001}) {
    SceneDef scene = clamped({rectangle(0, -0.5, L, 0.5), {}}, target);
    Plan plan = calibrate(scene);
    double sag = -Statics(plan).displacement(1, {L, 0.5}).y,
           exact = q * L * L * (L * L / 8 / EI + 0.5 / kappa_G);
    EXPECT_LE(std::abs(sag / exact - 1), target);
    EXPECT_LE(plan.pieces.size() - 1,
              std::ceil(1 / std::sqrt(0.9 * target)));  // and not with more than it takes

    scene.bodies.push_back(
        {.name = "wall2", .type = BodyType::static_body, .outline = {rectangle(L, -1, L + 1, 1), {}}});
    scene.joints.push_back({.a = "beam", .b = "wall2"});
    plan = calibrate(scene);
    const Statics held(plan);
    sag = 0;
    for (double x = 8; x <= 12; x += 0.01) sag = std::max(sag, -held.displacement(1, {x, 0.5}).y);
    exact = q * L * L * (L * L / 384 / EI + 1 / kappa_G / 8);

    EXPECT_LE(std::abs(sag / exact - 1), target);
    EXPECT_LE(plan.pieces.size() - 2, std::ceil(std::sqrt(8 / (0.9 * target))));
  }
}

// Between nodes: q L⁴/384EI clamped and 5q L⁴/384EI pinned, and q L²/8κGA besides. The far node has the beam
// as its third body.
TEST(Automatic, NodesHoldABodyAsWallsDo) {
  const double L = 20, q = density * g, EI = E / 12;
  for (const bool welded : {true, false})
    for (const double target : {0.03, 0.01, 0.003}) {
      SceneDef scene = clamped({rectangle(0, -0.5, L, 0.5), {}}, target);
      scene.bodies[0].outline = {rectangle(-1, -1, -0.1, 1), {}};  // no edge of it is near the beam
      scene.bodies.push_back({.name = "wall2",
                              .type = BodyType::static_body,
                              .outline = {rectangle(L + 0.1, -1, L + 1, 1), {}}});
      scene.bodies.push_back(
          {.name = "box", .outline = {rectangle(L + 0.1, 1, L + 1, 2), {}}, .material = test_steel});
      scene.joints = {{.a = "wall", .b = "beam", .at = Point{0, 0}},
                      {.a = "wall2", .b = "box", .at = Point{L, 0}, .others = {"beam"}}};
      for (JointBetweenDef& j : scene.joints) j.overrides.moment = welded ? unlimited : 0;
      const Plan plan = calibrate(scene);
      const Statics held(plan);
      double sag = 0;
      for (double x = 8; x <= 12; x += 0.01) sag = std::max(sag, -held.displacement(1, {x, 0.5}).y);
      const double exact = q * L * L * ((welded ? 1 : 5) * L * L / 384 / EI + 1 / kappa_G / 8);
      EXPECT_LE(std::abs(sag / exact - 1), target) << welded;
      EXPECT_LE(plan.pieces.size() - 3, std::ceil(std::sqrt(8 / (0.9 * target))));
    }
}

// A pin beside a pin at the same point turns as freely as one; at a corner each, 1 m apart, they clamp.
TEST(Automatic, PinsAtOnePointClampNothing) {
  SceneDef scene = clamped({rectangle(0, -0.5, 20, 0.5), {}}, 0.003);
  scene.bodies[0].outline = {rectangle(-1, -5, 21, -2), {}};  // no edge of it is near the beam
  const auto pin = [](Point at) { return JointBetweenDef{.a = "wall", .b = "beam", .at = at}; };
  const auto split = [&](std::vector<JointBetweenDef> joints, std::vector<SupportDef> supports) {
    scene.joints = std::move(joints);
    scene.supports = std::move(supports);
    return calibrate(scene).split_errors.at(0);
  };
  const SplitError once = split({pin({0, 0}), pin({20, 0})}, {});
  const SplitError twice = split({pin({0, 0}), pin({0, 0}), pin({20, 0})},
                                 {{.body = "beam", .at = {20, 0}, .fix_x = true, .fix_y = true}});
  EXPECT_EQ(twice.error, once.error);

  const auto clamp = [&](Point at) {
    JointBetweenDef def = pin(at);
    def.overrides.moment = unlimited;
    return def;
  };
  const SplitError apart = split({pin({0, -0.5}), pin({0, 0.5}), pin({20, -0.5}), pin({20, 0.5})}, {});
  const SplitError stiff = split({clamp({0, 0}), clamp({20, 0})}, {});
  EXPECT_NE(stiff.error, once.error);
  EXPECT_EQ(apart.error, stiff.error);
}

// A rope between centres holds a body as one at its middle does: two cantilevers of 10 m.
TEST(Automatic, ARopeBetweenCentresHoldsTheMiddle) {
  SceneDef scene = clamped({rectangle(0, -0.5, 20, 0.5), {}}, 0.01);
  scene.bodies[0].outline = {rectangle(0, 5, 20, 6), {}};
  scene.joints = {{.a = "wall", .b = "beam", .carries = Carries::tension}};
  const Plan between_centres = calibrate(scene);
  scene.joints[0].line = {Point{10, 5.5}, Point{10, 0}};
  const Plan between_ends = calibrate(scene);
  EXPECT_EQ(between_centres.pieces.size(), between_ends.pieces.size());
  EXPECT_GE(between_centres.pieces.size() - 1, 20u);  // 1/n² of each half within 0.01
}

// 4 m in pieces of 0.025 m are 160, and no target asks for fewer than a coarser one. A cantilever of n pieces
// errs by 1/n², 4e-5.
TEST(Automatic, AFinerTargetNeverMakesFewerPieces) {
  std::size_t before = 0;
  for (const double target : {1e-2, 1e-3, 1e-4, 6e-5, 4.2e-5, 4e-5, 3.9e-5, 3e-5, 1e-5, 1e-7}) {
    const Plan plan = calibrate(clamped({rectangle(0, -0.1, 4, 0.1), {}}, target));
    EXPECT_GE(plan.pieces.size(), before) << target;
    EXPECT_EQ(plan.split_errors.at(0).governed_by == "target error", plan.split_errors.at(0).error <= target);
    before = plan.pieces.size();
    if (target < 3.9e-5) {
      EXPECT_EQ(before - 1, 160u) << target;
      EXPECT_NEAR(plan.split_errors.at(0).error * 160 * 160, 1, 0.1);
    }
  }
}

// Depths that go up and down every 1.8 m: the estimate must know the corners, or it finds fault with what it
// compares to, whatever the number of pieces.
TEST(Automatic, AJaggedGirderReachesItsTarget) {
  const double heights[] = {1.0, 0.8, 1.1, 0.85, 1.2, 0.9, 0.8, 1.15, 0.95, 1.2, 0.8, 1.0};
  Ring ring;
  for (int k = 0; k < 12; ++k) ring.push_back({20.0 / 11 * k, -heights[k]});
  for (int k = 11; k >= 0; --k) ring.push_back({20.0 / 11 * k, heights[(5 * k + 3) % 12]});
  for (const double target : {0.05, 0.02, 0.01, 0.005, 0.002}) {
    const Plan plan = calibrate(clamped({ring, {}}, target));
    EXPECT_EQ(plan.split_errors.at(0).governed_by, "target error") << target;
    EXPECT_LE(plan.pieces.size() - 1, std::ceil(2 / std::sqrt(target))) << target;
  }
}

// Where four arms meet, two triangles of three neighbours each are the middle: one node, and no strip of its
// own, across which cuts would run along two of the arms. All cuts are as high as an arm is wide.
TEST(Automatic, ArmsThatMeetInOnePoint) {
  const Ring cross{{-5, -0.5}, {-0.5, -0.5}, {-0.5, -5}, {0.5, -5}, {0.5, -0.5}, {5, -0.5},
                   {5, 0.5},   {0.5, 0.5},   {0.5, 5},   {-0.5, 5}, {-0.5, 0.5}, {-5, 0.5}};
  Ring star;
  for (int i = 0; i < 14; ++i)
    star.push_back((i % 2 == 0 ? 8.0 : 1.0) *
                   Point{std::cos(i * std::numbers::pi / 7), std::sin(i * std::numbers::pi / 7)});
  for (const Ring& as_drawn : {cross, star})
    for (const double turned : {0.0, 0.3, 1.0, std::numbers::pi / 4}) {
      Ring ring = as_drawn;
      for (Point& p : ring) p = std::cos(turned) * p + std::sin(turned) * left(p);
      const BodyDef body{.outline = {ring, {}}, .material = test_steel, .automatic = true};
      const Plan plan = calibrate(body);
      EXPECT_EQ(plan.joints.size(), plan.pieces.size() - 1) << turned;
      EXPECT_GE(plan.joints.size(), ring.size() == 12 ? 8u : 7u);
      for (const PlannedJoint& joint : plan.joints) EXPECT_LT(joint.height, 1.001) << turned;
    }
}

// Two and a half turns in few pieces are hardly a spiral: only several to a turn make its error fall.
TEST(Automatic, SpiralReachesItsTarget) {
  Ring ring, back;
  for (int i = 0; i < 180; ++i) {
    const Point u{std::cos(0.1 * i), std::sin(0.1 * i)};
    ring.push_back((2 + 0.02 * i) * u);
    back.push_back((1.7 + 0.02 * i) * u);
  }
  ring.insert(ring.end(), back.rbegin(), back.rend());
  SceneDef scene{
      .bodies = {{.name = "spiral", .outline = {ring, {}}, .material = test_steel, .automatic = true}},
      .supports = {{"spiral", ring[141], true, true, true}}};
  const Plan plan = calibrate(scene);
  EXPECT_EQ(plan.split_errors.at(0).governed_by, "target error");
  EXPECT_LT(plan.pieces.size(), 200u);
}

// A strip that widens so much that its axis turns into one of its corners: cuts along that would cross those
// before.
TEST(Automatic, HourglassIsCutAcross) {
  const Ring ring{{0, 0}, {4, 0}, {2.05, 3}, {4, 6}, {0, 6}, {1.95, 3}};
  const Plan plan = calibrate(BodyDef{.outline = {ring, {}}, .material = test_steel, .automatic = true});
  EXPECT_EQ(plan.split_errors.at(0).governed_by, "target error");
  EXPECT_EQ(plan.joints.size(), plan.pieces.size() - 1);
  for (const PlannedJoint& joint : plan.joints) EXPECT_NEAR(std::abs(joint.axis.y), 1, 1e-9);
}

}  // namespace
