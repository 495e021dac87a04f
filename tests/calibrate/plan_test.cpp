// From a scene to a plan: names, masses, caps, stiffnesses, limits against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ductile/box2d.h"
#include "ductile/calibrate.h"
#include "ductile/rolled.h"
#include "scenes.h"

namespace {
using namespace ductile;

const std::string& reason(const Plan& plan, const PlannedJoint& joint) {
  return plan.reasons.at(static_cast<std::size_t>(joint.governed_by));
}

PlannedJoint joint(const Plan& plan, const std::string& name) {
  for (const PlannedJoint& j : plan.joints)
    if (j.name == name) return j;
  throw std::out_of_range("no joint " + name);
}

std::string problems_of(const SceneDef& scene) {
  try {
    calibrate(scene);
    return "";
  } catch (const InvalidInput& e) {
    return e.what();
  }
}

TEST(Calibrate, NamesPiecesAndJoints) {
  const Plan plan = calibrate(cantilever(3));
  ASSERT_EQ(plan.pieces.size(), 4u);
  EXPECT_EQ(plan.pieces[0].name, "wall");
  EXPECT_EQ(plan.pieces[1].name, "beam/0");
  EXPECT_EQ(plan.pieces[3].name, "beam/2");
  ASSERT_EQ(plan.joints.size(), 3u);
  EXPECT_EQ(plan.joints[0].name, "beam/0-beam/1");
  EXPECT_EQ(plan.joints[1].name, "beam/1-beam/2");
  EXPECT_EQ(plan.joints[2].name, "wall-beam/0");
}

TEST(Calibrate, MassAndInertiaOfTheOutline) {
  const Plan plan = calibrate(cantilever(10));
  for (int i = 1; i <= 10; ++i) {
    const Piece& piece = plan.pieces[static_cast<std::size_t>(i)];
    EXPECT_DOUBLE_EQ(piece.mass, 7800.0 * 2);
    EXPECT_DOUBLE_EQ(piece.inertia, 7800.0 * 2 * (4 + 1) / 12);
    EXPECT_NEAR(piece.center.x, 2 * i - 1, 1e-14);
    EXPECT_DOUBLE_EQ(piece.center.y, 0.5);
  }
  EXPECT_EQ(plan.pieces[0].mass, 0);  // static
}

TEST(Calibrate, CapsOfARectangularCut) {
  SceneDef scene = cantilever(10);
  scene.bodies[1].depth = 0.3;
  const Plan plan = calibrate(scene);
  const PlannedJoint tresca = joint(plan, "beam/4-beam/5");
  EXPECT_DOUBLE_EQ(tresca.N, 0.3 * 350e6);
  EXPECT_DOUBLE_EQ(tresca.Nc, 0.3 * 350e6);
  EXPECT_DOUBLE_EQ(tresca.Q, 0.5 * 0.3 * 350e6);
  EXPECT_DOUBLE_EQ(tresca.M, 0.25 * 0.3 * 350e6);
  EXPECT_DOUBLE_EQ(tresca.M_reverse, 0.25 * 0.3 * 350e6);
  EXPECT_EQ(reason(plan, tresca),
            "N, Nc, Q, M, M_reverse: section of beam; max_rotation, max_elongation: fracture strain of beam; "
            "max_compression, max_slip: size of beam; stiffness: E");
  scene.bodies[1].material->criterion = Criterion::von_mises;
  EXPECT_DOUBLE_EQ(joint(calibrate(scene), "beam/4-beam/5").Q, 0.3 * 350e6 / std::sqrt(3.0));
}

TEST(Calibrate, TrueStiffnessOverHalfOfEachNeighbour) {
  const Plan plan = calibrate(cantilever(10));
  const double E = 210e9, G = E / 2.6, I = 1.0 / 12;
  const PlannedJoint inner = joint(plan, "beam/4-beam/5"), root = joint(plan, "wall-beam/0");
  EXPECT_NEAR(inner.stiffness.N / (E / 2), 1, 1e-14);
  EXPECT_NEAR(inner.stiffness.Q / (5.0 / 6 * G / 2), 1, 1e-14);
  EXPECT_NEAR(inner.stiffness.M / (E * I / 2), 1, 1e-14);
  EXPECT_NEAR(root.stiffness.N / E, 1, 1e-14);
  EXPECT_NEAR(root.stiffness.M / (E * I), 1, 1e-14);
  EXPECT_EQ(inner.damping_ratio, 0.05);
}

TEST(Calibrate, AHigherNeighbourGivesAsItIsHigh) {
  SceneDef
      scene;  // an arm 0.2 m high in the middle of a block's side of 4 m, and a bar of half its height on it
  scene.bodies = {
      {.name = "block", .outline = {rectangle(-4, -2, 0, 2), {}}, .material = test_steel},
      {.name = "arm", .outline = {rectangle(0, -0.1, 2, 0.1), {}}, .material = test_steel, .pieces = 20},
      {.name = "bar", .outline = {rectangle(2, -0.05, 3, 0.05), {}}, .material = test_steel, .pieces = 2}};
  scene.joints = {{.a = "block", .b = "arm"}, {.a = "arm", .b = "bar"}};
  const double E = 210e9, G = E / 2.6, EI = E * 0.008 / 12, small = EI / 8;
  const Plan plan = calibrate(scene);
  const PlannedJoint root = joint(plan, "block-arm/0"), step = joint(plan, "arm/19-bar/0");
  EXPECT_NEAR(root.stiffness.M * (0.05 / EI + 2 / (8000 * EI)), 1, 1e-12);
  EXPECT_NEAR(root.stiffness.N * (0.05 / (E * 0.2) + 2 / (E * 4)), 1, 1e-12);
  EXPECT_NEAR(root.stiffness.Q * (0.05 / (E * 0.2) + 2 / (E * 4)) * E / (5. / 6 * G), 1, 1e-12);
  EXPECT_NEAR(step.stiffness.M * (0.05 / EI + 0.25 / small), 1, 1e-12);
  EXPECT_NEAR(step.mean[0].EI, 8, 1e-12);
  EXPECT_EQ(step.mean[1].EI, 1);
  EXPECT_DOUBLE_EQ(step.M, 0.01 / 4 * 350e6);  // strength is the cut's
}

// Two halves of a course carry as much as one of their width.
TEST(Calibrate, JointsOnOneEdgeShareWhatIsBehindIt) {
  SceneDef scene;
  scene.bodies = {{.name = "l", .outline = {rectangle(0, 0, 1, 1), {}}, .material = test_steel},
                  {.name = "r", .outline = {rectangle(1, 0, 2, 1), {}}, .material = test_steel},
                  {.name = "top", .outline = {rectangle(0, 1, 2, 2), {}}, .material = test_steel}};
  scene.joints = {{.a = "l", .b = "top"}, {.a = "r", .b = "top"}};
  const double E = 210e9;
  for (const PlannedJoint& j : calibrate(scene).joints)
    EXPECT_NEAR(j.stiffness.N / E, 1, 1e-12);  // E 1 m²/1 m
}

TEST(Calibrate, AStripGivesAsItsCutToTheBit) {
  for (const double angle : {0., 0.3, 2.}) {
    SceneDef scene = cantilever(7);
    scene.bodies[1].angle = angle;
    scene.joints.clear();
    for (const PlannedJoint& j : calibrate(scene).joints)
      for (const PlannedJoint::Mean& mean : j.mean) EXPECT_TRUE(mean.EA == 1 && mean.EI == 1) << j.name;
  }
}

// Of a taper, joints are the trapezoidal rule: EI of the cut over the pieces' length. A step at a cut in a
// body is as one between bodies; ∫ ds/h³ of a block that tapers is (1/h₁² − 1/h₀²)/2m from h₀ to h₁ by a
// slope of m.
TEST(Calibrate, TapersAndStepsInABody) {
  SceneDef scene;
  scene.bodies = {{.name = "bar",
                   .outline = {{{0, -1}, {4, -0.5}, {4, 0.5}, {0, 1}}, {}},
                   .material = test_steel,
                   .pieces = 2,
                   .along = {Point{0, 0}, Point{4, 0}}}};
  const double E = 210e9;
  EXPECT_NEAR(calibrate(scene).joints[0].stiffness.M * 12 / E * 2 / (1.5 * 1.5 * 1.5), 1, 1e-14);
  EXPECT_EQ(calibrate(scene).joints[0].mean[0].EI, 1);
  scene.bodies[0].outline.outer = {{0, -1},  {2, -1},  {2, -0.5}, {4, -0.5},
                                   {4, 0.5}, {2, 0.5}, {2, 1},    {0, 1}};
  EXPECT_NEAR(calibrate(scene).joints[0].stiffness.M * 12 / E * (1 + 1. / 8), 1, 1e-12);
  scene.bodies[0].outline.outer = {{0, -0.75}, {2, -1},  {2, -0.5}, {4, -0.5},
                                   {4, 0.5},   {2, 0.5}, {2, 1},    {0, 0.75}};
  const double h0 = 2, h1 = 1.75, m = 0.25;
  EXPECT_NEAR(
      calibrate(scene).joints[0].stiffness.M * 12 / E * (1 + (1 / (h1 * h1) - 1 / (h0 * h0)) / (2 * m)), 1,
      1e-6);
}

TEST(Calibrate, LimitsFromFractureStrainAndHingeLength) {
  SceneDef scene = cantilever(4);
  // θ_max = ε_f·L_p/y with L_p = h = 1 m and y = h/2.
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_rotation, 0.2 * 1 / 0.5);
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_elongation, 0.2);
  // Crushed to nothing, and past each other.
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_compression, 1);
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_slip, 1);
  scene.bodies[1].joint.hinge_length = 0.3;
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_rotation, 0.2 * 0.3 / 0.5);
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].hinge_length, 0.3);
  // Unequal yield stresses: the neutral axis lies h·f_t/(f_t + f_c) from the compressed side.
  scene.bodies[1].material->yield_stress_compression = 3 * 350e6;
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].max_rotation, 0.2 * 0.3 / 0.75);
  EXPECT_DOUBLE_EQ(calibrate(scene).joints[0].M, 0.5 * 350e6 * 0.75);
}

// A cantilever 20 m long whose moment falls from (f_u/f_y) M_p at its root: how far is it above M_p?
// At a plastic rate D L_p, over L_p, the strain rate is D: in shear by von Mises, in bending in the farthest
// fibre.
TEST(Calibrate, RatesOfStrain) {
  SceneDef scene = cantilever(10);
  EXPECT_FALSE(calibrate(scene).joints[0].rate);
  scene.bodies[1].material->rate_D = 40;
  scene.bodies[1].material->rate_q = 5;
  scene.bodies[1].joint.hinge_length = 0.3;
  const PlannedJoint joint = calibrate(scene).joints[0];
  ASSERT_TRUE(joint.rate);
  EXPECT_DOUBLE_EQ(joint.rate->doubling[axial], 40 * 0.3);
  EXPECT_DOUBLE_EQ(joint.rate->doubling[shear], std::numbers::sqrt3 * 40 * 0.3);
  EXPECT_DOUBLE_EQ(joint.rate->doubling[rotation], 40 * 0.3 / 0.5);
  EXPECT_EQ(joint.rate->exponent, 5);
  scene.interaction = true;
  EXPECT_NE(problems_of(scene).find("rate of strain"), std::string::npos);
}

// What is joined to a body that depends on it less, or not at all, depends on it as that does.
TEST(Calibrate, TheSideThatDependsLessOnTheRateGoverns) {
  SceneDef scene = cantilever(2);
  scene.bodies[1].material->rate_D = 40;
  BodyDef other = scene.bodies[1];
  other.name = "other";
  other.at = {20, 0};
  other.material->rate_D = 100;
  other.material->rate_q = 10;
  scene.bodies.push_back(other);
  scene.joints.push_back({.a = "beam", .b = "other"});
  const PlannedJoint between = joint(calibrate(scene), "beam/1-other/0");
  ASSERT_TRUE(between.rate);
  EXPECT_EQ(between.rate->exponent, 10);
  EXPECT_DOUBLE_EQ(between.rate->doubling[axial], 100 * between.hinge_length);
  scene.bodies.back().material->rate_D = 0;
  EXPECT_FALSE(joint(calibrate(scene), "beam/1-other/0").rate);
}

TEST(Calibrate, HingeLengthFromHardening) {
  SceneDef scene = cantilever(4);
  scene.bodies[1].material->ultimate_stress = 490e6;
  scene.bodies[1].joint.shear_span = 20;
  scene.joints[0].overrides.shear_span = 20;
  const double ratio = 490e6 / 350e6, M_p = 1;
  double zone = 0;
  for (const double dx = 1e-3; ratio * M_p * (1 - (zone + dx) / 20) > M_p;) zone += dx;
  const Plan plan = calibrate(scene);
  for (const PlannedJoint& j : plan.joints) {
    EXPECT_NEAR(j.hinge_length, zone, 2e-3);
    EXPECT_NEAR(j.hinge_length, 20 * (1 - 350.0 / 490), 1e-12);
    EXPECT_NEAR(j.max_rotation, 0.2 * j.hinge_length / 0.5, 1e-12);  // ε_f L_p/y
    EXPECT_NEAR(j.max_elongation, 0.2 * j.hinge_length, 1e-12);
  }
  const std::string why = "; hinge length: hardening of beam over the shear span of ";
  EXPECT_NE(reason(plan, joint(plan, "wall-beam/0")).find(why + "joint"), std::string::npos);
  EXPECT_NE(reason(plan, joint(plan, "beam/0-beam/1")).find(why + "body"), std::string::npos);

  // The innermost word counts, whichever of the two it is.
  scene.joints[0].overrides.shear_span.reset();
  scene.joints[0].overrides.hinge_length = 0.7;
  scene.joint.shear_span = 5;
  const Plan given = calibrate(scene);
  EXPECT_EQ(joint(given, "wall-beam/0").hinge_length, 0.7);
  EXPECT_NE(reason(given, joint(given, "wall-beam/0")).find("; hinge length: joint"), std::string::npos);

  scene.bodies[1].material->ultimate_stress = 0;  // as f_y
  EXPECT_THROW(calibrate(scene), InvalidInput);
}

TEST(Calibrate, RefusesAnUltimateStressBelowYield) {
  SceneDef scene = cantilever(4);
  scene.bodies[1].material->ultimate_stress = scene.bodies[1].material->yield_stress;
  EXPECT_NO_THROW(calibrate(scene));
  scene.bodies[1].material->ultimate_stress /= 2;
  try {
    calibrate(scene);
    ADD_FAILURE();
  } catch (const InvalidInput& e) {
    ASSERT_EQ(e.problems().size(), 1u) << e.what();
    EXPECT_EQ(e.problems()[0].what, "fu is 1.75e+08, below fy, 3.5e+08");
  }
}

TEST(Calibrate, AnchorAndAxis) {
  SceneDef scene = cantilever(2);
  scene.bodies[1].angle = std::numbers::pi / 2;
  scene.bodies[1].at = {5, 3};
  scene.joints.clear();
  const PlannedJoint j = calibrate(scene).joints[0];
  EXPECT_NEAR(j.anchor.x, 4.5, 1e-14);
  EXPECT_NEAR(j.anchor.y, 13, 1e-14);
  EXPECT_NEAR(j.axis.x, 0, 1e-15);
  EXPECT_NEAR(j.axis.y, 1, 1e-15);
  EXPECT_EQ(j.height, 1);
}

// Cracking: M = f_t I/y, at once, for what breaks where it ceases to be elastic. With N, σ = N/A + M y/I.
TEST(Calibrate, BrittleSectionsCrackAtTheirFirstFibre) {
  SceneDef scene = cantilever(4);
  scene.bodies[1].material = materials::concrete;
  scene.interaction = true;
  const double b = scene.bodies[1].depth, h = 1, ft = 2.9e6, fc = 30e6, W = b * h * h / 6;
  Plan plan = calibrate(scene);
  EXPECT_NEAR(plan.joints[0].M, ft * W, 1e-12 * ft * W);
  EXPECT_NEAR(plan.joints[0].M_reverse, ft * W, 1e-12 * ft * W);
  EXPECT_DOUBLE_EQ(plan.joints[0].N, ft * b * h);
  EXPECT_DOUBLE_EQ(plan.joints[0].max_rotation, 2.9e6 / 33e9 * h / (h / 2));
  // Corners: uniform tension and compression, and f_t at one fibre with f_c at the other.
  const double N = (ft - fc) / 2 * b * h, M = (ft + fc) / 2 * W;
  const std::vector<AxialMoment> corners{{ft * b * h, 0}, {N, M}, {-fc * b * h, 0}, {N, -M}};
  const std::vector<AxialMoment> polygon = interaction_of(plan, plan.joints[0]);
  ASSERT_EQ(polygon.size(), 4u);
  for (const AxialMoment& c : corners) {
    EXPECT_TRUE(std::any_of(polygon.begin(), polygon.end(),
                            [&](const AxialMoment& p) {
                              return std::abs(p.N - c.N) < 1e-9 * fc * b * h &&
                                     std::abs(p.M - c.M) < 1e-9 * M;
                            }))
        << c.N << " " << c.M;
  }
  // A tee, 0.6 m × 0.2 m on 0.2 m × 0.8 m: its centroid is ΣA y/ΣA from the bottom, and I by Steiner's rule.
  scene.bodies[1].profile = {{{{{-0.1, -0.5}, {0.1, -0.5}, {0.1, 0.3}, {-0.1, 0.3}}, {}}, materials::glass},
                             {{{{-0.3, 0.3}, {0.3, 0.3}, {0.3, 0.5}, {-0.3, 0.5}}, {}}, materials::glass}};
  plan = calibrate(scene);
  const double y = (0.16 * 0.4 + 0.12 * 0.9) / 0.28;
  const double I =
      0.2 * 0.512 / 12 + 0.16 * (y - 0.4) * (y - 0.4) + 0.6 * 0.008 / 12 + 0.12 * (0.9 - y) * (0.9 - y);
  EXPECT_NEAR(plan.joints[0].M, 45e6 * I / y, 1e-9 * 45e6 * I / y);  // equal strengths: the farther fibre
  EXPECT_NEAR(plan.joints[0].max_rotation, 45e6 / 70e9 * 1 / y, 1e-12);
}

TEST(Calibrate, OverridesFromTheInsideOut) {
  SceneDef scene = cantilever(2);
  scene.joint = {.moment = 1, .axial = 2, .shear = 3, .max_slip = 0.1};
  scene.bodies[1].joint = {.moment = 10, .moment_reverse = 11};
  scene.joints[0].overrides = {.moment = 100, .axial_compression = unlimited, .elastic = Elasticity::rigid};
  const Plan plan = calibrate(scene);
  const PlannedJoint &inner = plan.joints[0], &root = plan.joints[1];
  EXPECT_EQ(inner.M, 10);
  EXPECT_EQ(inner.M_reverse, 11);
  EXPECT_EQ(inner.N, 2);
  EXPECT_EQ(inner.Nc, 2);
  EXPECT_EQ(inner.Q, 3);
  EXPECT_EQ(inner.max_slip, 0.1);
  EXPECT_EQ(root.M, 100);
  EXPECT_EQ(root.M_reverse, 100);
  EXPECT_EQ(root.N, 2);
  EXPECT_EQ(root.Nc, unlimited);
  EXPECT_EQ(root.stiffness.M, unlimited);
  EXPECT_EQ(
      reason(plan, root),
      "N: scene; Nc: joint; Q: scene; M, M_reverse: joint; max_rotation, max_elongation: fracture strain of "
      "beam; max_compression: size of beam; max_slip: scene; stiffness: joint");
}

TEST(Calibrate, ElasticityByFrequencyAndByRotation) {
  SceneDef scene = cantilever(2);
  // As b2AngularStiffness: k = ω²·I_a·I_b/(I_a + I_b); against a wall ω²·I_b.
  const double I = 7800.0 * 10 * (100 + 1) / 12, omega = 2 * std::numbers::pi * 3;
  scene.joint = {.elastic = Elasticity::frequency, .frequency = 3, .damping_ratio = 0.7};
  Plan plan = calibrate(scene);
  EXPECT_NEAR(plan.joints[0].stiffness.M / (omega * omega * I / 2), 1, 1e-14);
  EXPECT_NEAR(plan.joints[1].stiffness.M / (omega * omega * I), 1, 1e-14);
  EXPECT_EQ(plan.joints[0].damping_ratio, 0.7);
  // k = M/θ_e.
  scene.joint = {.elastic = Elasticity::elastic_rotation, .elastic_rotation = 0.01};
  plan = calibrate(scene);
  EXPECT_DOUBLE_EQ(plan.joints[1].stiffness.M, plan.joints[1].M / 0.01);
  // M = k·θ_e.
  scene.joint = {.elastic = Elasticity::elastic_rotation, .frequency = 3, .elastic_rotation = 0.01};
  plan = calibrate(scene);
  EXPECT_NEAR(plan.joints[1].M / (omega * omega * I * 0.01), 1, 1e-14);
}

TEST(Calibrate, TheWeakerSideGoverns) {
  SceneDef scene = cantilever(2);
  scene.bodies[0].material = Material{.yield_stress = 100e6, .fracture_strain = 0.5};
  const Plan plan = calibrate(scene);
  const PlannedJoint root = joint(plan, "wall-beam/0");
  EXPECT_DOUBLE_EQ(root.M, 0.25 * 100e6);
  EXPECT_DOUBLE_EQ(root.max_rotation, 0.4);  // of the beam: 0.2·1/0.5
  EXPECT_EQ(reason(plan, root).substr(0, 40), "N, Nc, Q, M, M_reverse: section of wall;");
}

TEST(Calibrate, ProfileGivesCapsAndMass) {
  // An I of h = 0.4, b = 0.2, t_f = 0.02, t_w = 0.01; the drawn strip is 6 m long and as high as the profile.
  const double h = 0.4, b = 0.2, tf = 0.02, tw = 0.01;
  const Ring i{{-b / 2, 0},      {b / 2, 0},        {b / 2, tf},   {tw / 2, tf},
               {tw / 2, h - tf}, {b / 2, h - tf},   {b / 2, h},    {-b / 2, h},
               {-b / 2, h - tf}, {-tw / 2, h - tf}, {-tw / 2, tf}, {-b / 2, tf}};
  SceneDef scene;
  scene.bodies.push_back({.name = "beam",
                          .outline = {rectangle(0, 3, 6, 3 + h), {}},
                          .material = test_steel,
                          .profile = {{{i, {}}, test_steel}},
                          .pieces = 3});
  const Plan plan = calibrate(scene);
  const double area = 2 * b * tf + (h - 2 * tf) * tw;
  const double Z = b * tf * (h - tf) + tw * (h - 2 * tf) * (h - 2 * tf) / 4;
  const double I = b * h * h * h / 12 - (b - tw) * std::pow(h - 2 * tf, 3) / 12;
  ASSERT_EQ(plan.joints.size(), 2u);
  const PlannedJoint& j = plan.joints[0];
  EXPECT_NEAR(j.N / (area * 350e6), 1, 1e-13);
  EXPECT_NEAR(j.M / (Z * 350e6), 1, 1e-13);
  EXPECT_NEAR(j.M_reverse / (Z * 350e6), 1, 1e-13);
  EXPECT_NEAR(j.Q / (h * tw * test_steel.shear()), 1, 1e-12);
  EXPECT_NEAR(j.stiffness.M / (210e9 * I / 2), 1, 1e-13);
  EXPECT_NEAR(j.max_rotation / (0.2 * h / (h / 2)), 1, 1e-13);
  for (const Piece& piece : plan.pieces) {
    EXPECT_NEAR(piece.mass / (7800 * area * 2), 1, 1e-13);
    EXPECT_NEAR(piece.inertia / (7800 * (area * 8 / 12 + I * 2)), 1, 1e-13);
  }
  scene.bodies[0].outline.outer = rectangle(0, 3, 6, 3 + 1.02 * h);
  EXPECT_NE(problems_of(scene).find("0.408 m high where the profile of 'beam' is 0.4 m"), std::string::npos)
      << problems_of(scene);
}

TEST(Calibrate, NamedProfilesHaveTheShearAreaOfTheirStandard) {  // IPE 300: A_v = 25.68 cm² in its table
  SceneDef scene = cantilever(2);
  scene.bodies[1].outline = {rectangle(0, 0, 20, 0.3), {}};
  scene.bodies[1].along = {};
  scene.bodies[1].profile = {{draw(rolled("IPE 300")).outline, materials::S355}};
  scene.bodies[1].profile_name = "IPE 300";
  EXPECT_NEAR(joint(calibrate(scene), "beam/0-beam/1").Q / (25.68e-4 * 355e6 / std::sqrt(3.0)), 1, 2e-4);
}

TEST(Calibrate, EachStiffnessMayBeGivenAlone) {  // they go before `elastic`, the inner level before the outer
  SceneDef scene = cantilever(2);
  const PlannedJoint own = joint(calibrate(scene), "beam/0-beam/1");
  scene.joint.stiffness_shear = unlimited;
  scene.joint.stiffness_moment = 5;
  scene.bodies[1].joint.stiffness_moment = 7;
  PlannedJoint j = joint(calibrate(scene), "beam/0-beam/1");
  EXPECT_EQ(j.stiffness.N, own.stiffness.N);
  EXPECT_EQ(j.stiffness.Q, unlimited);
  EXPECT_EQ(j.stiffness.M, 7);
  scene.bodies[1].joint.elastic = Elasticity::rigid;
  scene.bodies[1].joint.stiffness_axial = 3;
  j = joint(calibrate(scene), "beam/0-beam/1");
  EXPECT_EQ(j.stiffness.N, 3);
  EXPECT_EQ(j.stiffness.M, 7);
  scene.bodies[1].joint.stiffness_moment = {};
  EXPECT_EQ(joint(calibrate(scene), "beam/0-beam/1").stiffness.M, unlimited);  // not the scene's 5
  scene.joint.stiffness_shear = 0;
  EXPECT_NE(problems_of(scene).find("stiffness_shear is 0"), std::string::npos);
}

TEST(Calibrate, SupportsMayBeSprings) {
  SceneDef scene = cantilever(2);
  scene.supports.push_back({.body = "beam", .at = {10, 0.5}, .fix_x = true, .stiffness_y = 4e5});
  const Plan plan = calibrate(scene);
  const PlannedJoint& s = joint(plan, "support/0");
  EXPECT_EQ(s.stiffness.N, unlimited);
  EXPECT_EQ(s.N, unlimited);
  EXPECT_EQ(s.stiffness.Q, 4e5);
  EXPECT_EQ(s.Q, unlimited);
  EXPECT_EQ(s.M, 0);  // free
  scene.supports[0].stiffness_y = -1;
  EXPECT_NE(problems_of(scene).find("y is -1"), std::string::npos);
}

TEST(Calibrate, VelocitiesAreOnePerPiece) {
  SceneDef scene = cantilever(3);
  scene.bodies[1].velocities = {{1, 0}, {0, 2}};
  EXPECT_NE(problems_of(scene).find("2 velocities for 3 pieces"), std::string::npos) << problems_of(scene);
  scene.bodies[1].velocities.push_back({3, 4});
  EXPECT_EQ(calibrate(scene).bodies[1].velocities.size(), 3u);
  scene.bodies[1].velocity = {1, 1};
  EXPECT_NE(problems_of(scene).find("both velocities"), std::string::npos);
}

// A tee that is weak in one sense keeps it when another body's joint looks along it from the other end.
TEST(Calibrate, ProfileSeenFromEitherEnd) {
  const Ring tee{{-0.1, 0},    {0.1, 0},      {0.1, 0.02},    {0.005, 0.02},
                 {0.005, 0.3}, {-0.005, 0.3}, {-0.005, 0.02}, {-0.1, 0.02}};
  SceneDef scene;
  Material m = test_steel;
  m.yield_stress_compression = 100e6;
  scene.bodies.push_back(
      {.name = "l", .type = BodyType::static_body, .outline = {rectangle(-1, -1, 0, 1), {}}});
  scene.bodies.push_back({.name = "beam",
                          .outline = {rectangle(0, 0, 6, 0.3), {}},
                          .material = m,
                          .profile = {{{tee, {}}, m}},
                          .pieces = 2});
  scene.bodies.push_back(
      {.name = "r", .type = BodyType::static_body, .outline = {rectangle(6, -1, 7, 1), {}}});
  scene.joints = {{.a = "l", .b = "beam"}, {.a = "beam", .b = "r"}};
  const Plan along = calibrate(scene);
  scene.joints = {{.a = "beam", .b = "l"}, {.a = "r", .b = "beam"}};
  const Plan against = calibrate(scene);
  const PlannedJoint& inner = along.joints[0];
  EXPECT_GT(std::abs(inner.M - inner.M_reverse), 0.1 * inner.M);
  for (std::size_t k : {1, 2}) {
    EXPECT_DOUBLE_EQ(along.joints[k].M, inner.M);
    EXPECT_DOUBLE_EQ(against.joints[k].M, inner.M_reverse);
    EXPECT_DOUBLE_EQ(against.joints[k].M_reverse, inner.M);
    const PlannedJoint& j = against.joints[k];
    const int piece = against.pieces[j.a].name[0] == 'b' ? j.a : j.b;
    EXPECT_NEAR(section_at(against, j, piece)->capacities({0, -1}).M / j.M, 1, 1e-13);
  }
}

TEST(Calibrate, SeveralIntervalsAreSeveralJoints) {
  SceneDef scene;
  scene.bodies.push_back({.name = "frame",
                          .outline = {rectangle(0, 0, 4, 3), {rectangle(1, 1, 3, 2)}},
                          .material = test_steel,
                          .cuts = {{Point{2, -1}, Point{2, 4}}}});
  const Plan plan = calibrate(scene);
  ASSERT_EQ(plan.joints.size(), 2u);
  EXPECT_EQ(plan.joints[0].name, "frame/0-frame/1");
  EXPECT_EQ(plan.joints[1].name, "frame/0-frame/1#1");
  EXPECT_DOUBLE_EQ(plan.joints[0].height, 1);
  EXPECT_LT(plan.pieces[0].center.x, plan.pieces[1].center.x);
  EXPECT_NEAR(plan.joints[0].axis.x, 1, 1e-15);
}

// A strip b deep with a slit of height g along it, cut across: below h1 and above h2 of it are left.
BodyDef slit(double h1, double g, double h2, double b) {
  return {.name = "beam",
          .outline = {rectangle(0, 0, 4, h1 + g + h2), {rectangle(1, h1, 3, h1 + g)}},
          .material = test_steel,
          .depth = b,
          .cuts = {{Point{2, -1}, Point{2, 9}}}};
}

TEST(Calibrate, IntervalsInLineMayBeOneSection) {
  constexpr double f = 350e6, E = 210e9, b = 0.2, g = 0.5;
  SceneDef scene;
  scene.bodies = {slit(0.3, g, 0.3, b)};
  const Plan apart = calibrate(scene);
  ASSERT_EQ(apart.joints.size(), 2u);
  EXPECT_NE(reason(apart, apart.joints[0]).find("; 2 intervals in line, each a joint"), std::string::npos);
  EXPECT_NEAR(apart.joints[1].M / (f * b * 0.3 * 0.3 / 4), 1, 1e-14);

  // Each chord's whole force, as far from each other as their middles: f b h (h + g).
  scene.bodies[0].joint.combine = true;
  const Plan plan = calibrate(scene);
  ASSERT_EQ(plan.joints.size(), 1u);
  const PlannedJoint& equal = plan.joints[0];
  EXPECT_EQ(equal.name, "beam/0-beam/1");
  EXPECT_NE(reason(plan, equal).find("; 2 intervals in line make one section: combine"), std::string::npos);
  EXPECT_NEAR(equal.M / (f * b * 0.3 * (0.3 + g)), 1, 1e-14);
  EXPECT_NEAR(equal.N / (f * b * 0.6), 1, 1e-14);
  EXPECT_NEAR(equal.Q / (0.5 * f * b * 0.6), 1, 1e-14);
  EXPECT_DOUBLE_EQ(equal.height, 1.1);
  EXPECT_NEAR(equal.anchor.x, 2, 1e-15);
  EXPECT_NEAR(equal.anchor.y, 0.55, 1e-15);
  EXPECT_NEAR(equal.stiffness.M / (E * b * (1.1 * 1.1 * 1.1 - g * g * g) / 12 / 2), 1, 1e-14);  // ℓ = 2 m
  EXPECT_NEAR(equal.max_rotation / (0.2 * 1.1 / 0.55), 1, 1e-14);  // the neutral axis is in the slit

  // Unequal ones: the neutral axis halves the area, c up in the thicker chord.
  constexpr double h1 = 0.4, h2 = 0.2, c = (h1 + h2) / 2;
  for (const bool upside_down : {false, true}) {
    scene.bodies[0] = upside_down ? slit(h2, g, h1, b) : slit(h1, g, h2, b);
    scene.bodies[0].joint.combine = true;
    const PlannedJoint unequal = calibrate(scene).joints.at(0);
    const double Z = c * c / 2 + (h1 - c) * (h1 - c) / 2 + h2 * (h1 - c + g + h2 / 2);
    EXPECT_NEAR(unequal.M / (f * b * Z), 1, 1e-13);
    EXPECT_NEAR(unequal.M_reverse / (f * b * Z), 1, 1e-13);
    const double centroid = (h1 * h1 / 2 + h2 * (h1 + g + h2 / 2)) / (h1 + h2);
    EXPECT_NEAR(unequal.anchor.y, upside_down ? 1.1 - centroid : centroid, 1e-14);
    const Plan both = calibrate(scene);
    EXPECT_NEAR(section_at(both, unequal, 0)->capacities({0, -1}).M / unequal.M, 1, 1e-13);
  }
}

// Two feet on one floor; a profile is one interval by its nature.
TEST(Calibrate, IntervalsOfTwoBodiesMayBeOneSection) {
  SceneDef scene;
  const Ring legs{{0, 0}, {1, 0}, {1, 2}, {3, 2}, {3, 0}, {4, 0}, {4, 3}, {0, 3}};
  scene.bodies = {{.name = "floor", .type = BodyType::static_body, .outline = {rectangle(-1, -1, 5, 0), {}}},
                  {.name = "table", .outline = {legs, {}}, .material = test_steel, .depth = 0.1}};
  scene.joints = {{.a = "floor", .b = "table"}};
  ASSERT_EQ(calibrate(scene).joints.size(), 2u);
  scene.joint.combine = true;
  const Plan plan = calibrate(scene);
  ASSERT_EQ(plan.joints.size(), 1u);
  EXPECT_NEAR(plan.joints[0].M / (350e6 * 0.1 * 1 * 3), 1, 1e-13);  // f b h times 3 m between the legs
  scene.joints[0].overrides.combine = false;                        // the innermost word counts
  EXPECT_EQ(calibrate(scene).joints.size(), 2u);
  scene.joints[0].overrides.combine.reset();
  scene.bodies[1].profile = {{{rectangle(-0.05, -0.5, 0.05, 0.5), {}}, test_steel}};
  const Plan profiles = calibrate(scene);
  EXPECT_EQ(profiles.joints.size(), 2u);
  EXPECT_NE(reason(profiles, profiles.joints[0]).find("; 2 intervals in line, each a profile"),
            std::string::npos);
}

TEST(Calibrate, DiscsWeighWhatDiscsWeigh) {
  SceneDef scene;
  scene.bodies.push_back(
      {.name = "wheel", .circle = 0.4, .material = Material{.yield_stress = 1, .density = 100}});
  const Plan plan = calibrate(scene);
  const double m = 100 * std::numbers::pi * 0.16;
  EXPECT_DOUBLE_EQ(plan.pieces[0].mass, m);
  EXPECT_DOUBLE_EQ(plan.pieces[0].inertia, m * 0.16 / 2);
}

TEST(Calibrate, SupportsHoldThePieceUnderThePoint) {
  SceneDef scene = cantilever(10);
  scene.supports = {{.body = "beam", .at = {20, 0.5}, .fix_y = true},
                    {.body = "beam", .at = {2, 0}, .fix_x = true, .fix_angle = true}};
  const Plan plan = calibrate(scene);
  const PlannedJoint roller = joint(plan, "support/0"), other = joint(plan, "support/1");
  EXPECT_EQ(roller.a, -1);
  EXPECT_EQ(plan.pieces[static_cast<std::size_t>(roller.b)].name, "beam/9");
  EXPECT_EQ(roller.axis, (Point{1, 0}));
  EXPECT_EQ(roller.Q, unlimited);
  EXPECT_EQ(roller.N, 0);
  EXPECT_EQ(roller.M, 0);
  EXPECT_EQ(plan.pieces[static_cast<std::size_t>(other.b)].name, "beam/0");  // on the cut: the lower
  EXPECT_EQ(other.M_reverse, unlimited);
  scene.supports[0].at.x = 20.1;
  EXPECT_NE(problems_of(scene).find("support 0: there is nothing of 'beam' at (20.1, 0.5)"),
            std::string::npos);
}

TEST(Calibrate, BodiesJoinWhereEdgesOverlap) {
  SceneDef scene = cantilever(1);
  scene.bodies[1].at = {0.001, 0};
  EXPECT_NE(problems_of(scene).find("their edges do not overlap anywhere"), std::string::npos);
  for (const double gap : {0.002, 0.2, 0.5, 3.0}) {  // any that is large enough
    scene.joints[0].gap = gap;
    const Plan plan = calibrate(scene);
    ASSERT_EQ(plan.joints.size(), 1u) << gap;
    EXPECT_EQ(plan.joints[0].name, "wall-beam");
    EXPECT_DOUBLE_EQ(plan.joints[0].height, 1) << gap;
    EXPECT_EQ(plan.joints[0].axis, (Point{1, 0}));
  }
}

// The end of a beam 0.2 m high is 0.1 m away from its wall, in which it may also stick. No gap that is large
// enough has it joined to the far side of the wall, to pieces behind its first or to a ledge below it.
TEST(Calibrate, BodiesJoinWithinAnyGapThatIsLargeEnough) {
  for (const auto& [at, pieces] : {std::pair(0.1, 200), std::pair(-0.1, 1)}) {
    SceneDef scene = cantilever(pieces);
    scene.bodies[0].outline = {{{-1, -1}, {0.05, -1}, {0.05, -0.15}, {0, -0.15}, {0, 2}, {-1, 2}}, {}};
    scene.bodies[1].outline = {rectangle(0, 0, 4, 0.2), {}};
    scene.bodies[1].along = {Point{0, 0.1}, Point{4, 0.1}};
    scene.bodies[1].at = {at, 0};
    scene.joints[0].gap = 0.099;
    EXPECT_NE(problems_of(scene).find("within 0.099 m"), std::string::npos) << at;
    for (const double gap : {0.101, 0.2, 0.5, 1.0, 10.0}) {
      scene.joints[0].gap = gap;
      ASSERT_EQ(problems_of(scene), "") << gap;
      const Plan plan = calibrate(scene);
      ASSERT_EQ(std::ssize(plan.joints), pieces) << at << ' ' << gap;
      EXPECT_EQ(plan.joints.back().name, pieces > 1 ? "wall-beam/0" : "wall-beam") << gap;
      EXPECT_NEAR(plan.joints.back().height, 0.2, 1e-12) << gap;
    }
  }
}

// Two plates of 0.1 m on one another share one edge of 4 m, and their outer faces none; a box that is turned
// by 45° shares none with what its corner touches.
TEST(Calibrate, OnlyFacesThatSeeEachOtherAreShared) {
  SceneDef scene;
  scene.bodies = {{.name = "lower", .outline = {rectangle(0, 0, 4, 0.1), {}}, .material = test_steel},
                  {.name = "upper", .outline = {rectangle(0, 0.1, 4, 0.2), {}}, .material = test_steel}};
  scene.joints = {{.a = "lower", .b = "upper"}};
  for (const double gap : {0.0, 0.01, 0.3, 5.0}) {
    scene.joints[0].gap = gap;
    ASSERT_EQ(problems_of(scene), "") << gap;
    const Plan plan = calibrate(scene);
    ASSERT_EQ(plan.joints.size(), 1u) << gap;
    EXPECT_NEAR(plan.joints[0].height, 4, 1e-12) << gap;
    EXPECT_NEAR(plan.joints[0].anchor.y, 0.1, 1e-12) << gap;
  }
  scene.bodies[1].outline = {{{2, 0.1}, {3, 1.1}, {2, 2.1}, {1, 1.1}}, {}};
  EXPECT_NE(problems_of(scene).find("do not overlap anywhere"), std::string::npos);
}

// A wedge that comes to a point: cut where its height drowns in the rounding of its coordinates.
TEST(Calibrate, SectionsTooThinToComputeWithAreRefused) {
  SceneDef scene;
  scene.bodies = {{.name = "wedge",
                   .outline = {{{0, 0}, {100, 1}, {0, 2}}, {}},
                   .material = test_steel,
                   .cuts = {{Point{50, -9}, Point{50, 9}}, {Point{100 - 1e-5, -9}, Point{100 - 1e-5, 9}}}}};
  EXPECT_EQ(problems_of(scene), "");
  scene.bodies[0].cuts[1] = {Point{100 - 1e-6, -9}, Point{100 - 1e-6, 9}};
  EXPECT_NE(problems_of(scene).find("m high, less than 3e-10 of its coordinates, which is too thin"),
            std::string::npos)
      << problems_of(scene);
}

TEST(Calibrate, AllProblemsAtOnce) {
  SceneDef scene = cantilever(3);
  scene.bodies[1].material->density = -1;
  scene.bodies[0].name = "a/b";
  scene.loads.push_back({.body = "nobody", .at = {1e31, 0}});
  const std::string text = problems_of(scene);
  EXPECT_NE(text.find("body 'beam': density is -1"), std::string::npos) << text;
  EXPECT_NE(text.find("body 'a/b'"), std::string::npos) << text;
  EXPECT_NE(text.find("load 0: there is no body 'nobody'"), std::string::npos) << text;
  EXPECT_NE(text.find("load 0: at is beyond 1e30"), std::string::npos) << text;
}

TEST(Calibrate, RefusesMorePiecesThanFilesMayHave) {
  EXPECT_THROW(calibrate(cantilever(10'001)), InvalidInput);
}

TEST(Calibrate, LevelLoadCall) {
  const Outline girder{{{0, 0}, {20, 0}, {20, 1}, {0, 1}}, {}};
  const Plan plan = calibrate({.outline = girder, .material = materials::S355, .depth = 0.3, .pieces = 8});
  ASSERT_EQ(plan.joints.size(), 7u);
  EXPECT_DOUBLE_EQ(plan.joints[0].M, 0.25 * 0.3 * 355e6);
  EXPECT_NEAR(plan.joints[0].axis.x, 1, 1e-15);
}

}  // namespace
