// Collapse loads against closed forms for the given hinge positions, and against the simulation.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <set>

#include "ductile/design.h"
#include "ductile/files.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20, P = 1e6, M = plastic_moment;
constexpr double exactly = 1e-6;

std::set<std::string> names(const Plan& plan, const std::vector<int>& joints) {
  std::set<std::string> result;
  for (const int i : joints) result.insert(plan.joints[static_cast<std::size_t>(i)].name);
  return result;
}
using Hinges = std::set<std::string>;

void expect_collapse(const Plan& plan, double factor, const Hinges& hinges) {
  const LimitAnalysis limit = limit_analysis(plan);
  EXPECT_NEAR(limit.load_factor / factor, 1, exactly);
  EXPECT_EQ(names(plan, limit.hinges), hinges);
}

TEST(LimitAnalysis, Beams) {
  expect_collapse(calibrate(cantilever(10, P)), M / L / P, {"wall-beam/0"});
  expect_collapse(calibrate(simply_supported(10, P)), 4 * M / L / P, {"beam/4-beam/5"});
  expect_collapse(calibrate(fixed_fixed(10, P)), 8 * M / L / P,
                  {"left-beam/0", "beam/4-beam/5", "beam/9-right"});
  expect_collapse(calibrate(propped(10, P)), 6 * M / L / P, {"wall-beam/0", "beam/4-beam/5"});
}

// What a support clamps yields there as beside a wall; of one with a moment of its own the joints do.
TEST(LimitAnalysis, ClampedBySupports) {
  SceneDef scene = simply_supported(10, P);
  for (SupportDef& support : scene.supports) support.fix_angle = true;
  expect_collapse(calibrate(scene), 8 * M / L / P, {"support/0", "beam/4-beam/5", "support/1"});
  scene.supports.pop_back();
  scene.loads[0].at = {20, 0};
  expect_collapse(calibrate(scene), M / L / P, {"support/0"});
  scene.supports[0].at = {20, 0};
  scene.loads[0].at = {0, 0};
  const Plan plan = calibrate(scene);
  expect_collapse(plan, M / L / P, {"support/0"});
  const FirstFibre fibre = first_fibre(plan, static_check(plan));
  EXPECT_NEAR(fibre.factor / (2.0 / 3 * M / L / P), 1, exactly);
  EXPECT_EQ(plan.joints[static_cast<std::size_t>(fibre.joint)].name, "support/0");
  scene.joint.moment = M;
  expect_collapse(calibrate(scene), M / (L - L / 10) / P, {"beam/8-beam/9"});
}

TEST(LimitAnalysis, UnitsDoNotMatter) {
  for (const double load : {1e-3, 1e12})
    expect_collapse(calibrate(propped(10, load)), 6 * M / L / load, {"wall-beam/0", "beam/4-beam/5"});
}

TEST(LimitAnalysis, MechanismsOfAPortal) {
  const Portal portal;
  expect_collapse(portal.hinged_in_beam(P), portal.beam_alone(P),
                  {"beam/0-beam/1", "beam/1-beam/2", "beam/2-beam/3"});
  ASSERT_LT(portal.sway(P), portal.combined(0, P));
  expect_collapse(portal.hinged_in_columns(0, P), portal.sway(P),
                  {"floor-left", "floor-right", "left-beam/0", "right-beam/3"});
  ASSERT_LT(portal.combined(P, P), portal.sway(P));
  expect_collapse(portal.hinged_in_columns(P, P), portal.combined(P, P),
                  {"floor-left", "floor-right", "beam/1-beam/2", "right-beam/3"});
}

// The weight of the beam does W L/4 θ of the work of P L/2 θ + W L/4 θ = 4 M θ.
TEST(LimitAnalysis, GravityCanBeHeldFixed) {
  SceneDef scene = fixed_fixed(10, P);
  scene.gravity = {0, -100};
  const Plan plan = calibrate(scene);
  const double weight = 7800 * L * 100;
  EXPECT_NEAR(limit_analysis(plan, true).load_factor / ((4 * M - weight * L / 4) / (P * L / 2)), 1, exactly);
  EXPECT_NEAR(limit_analysis(plan).load_factor / (4 * M / (P * L / 2 + weight * L / 4)), 1, exactly);
}

// s: s P L/M_p/√(1 − (sq)²) + (s n)²/(1 − (sq)²) = 1, a rectangle's surface with n = N/N_p, q = Q/Q_p.
TEST(LimitAnalysis, WithInteraction) {
  SceneDef scene = cantilever(4, P);
  scene.joint = {};
  scene.loads[0].force = {-200e6, -1e6};
  const double n = 200e6 / 350e6, m = P * L / M, q = P / 175e6;
  EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor * n, 1, exactly) << "caps alone: N";
  scene.interaction = true;
  double low = 0, high = 10;
  for (int i = 0; i < 100; ++i) {
    const double s = (low + high) / 2, left = 1 - s * s * q * q;
    (s * m / std::sqrt(left) + s * s * n * n / left < 1 ? low : high) = s;
  }
  const Plan plan = calibrate(scene);
  const double factor = limit_analysis(plan).load_factor;
  EXPECT_NEAR(factor / low, 1, 2e-3) << "the joint's polygon is inscribed within 1e-3";
  EXPECT_NEAR(factor / static_check(plan).reserve, 1, 1e-7) << "statically determinate";
}

// A pier of a material that bears a hundred times as much in compression as in tension: under pressure its
// section bears many times its plastic moment, x of its height h compressed:
// −N = f_c x − f_t (h − x), M = (f_t + f_c) x (h − x)/2.
TEST(LimitAnalysis, PressureHelpsAMomentBeyondItsCap) {
  constexpr double h = 0.5, f_t = 1e5, f_c = 1e7, H = 10e3, V = 300e3, l = 4;
  SceneDef scene = cantilever(1, H);
  scene.joint = {.shear = unlimited, .max_rotation = unlimited};
  scene.interaction = true;
  scene.bodies[1] = beam(8, l, h);
  scene.bodies[1].material->yield_stress = f_t;
  scene.bodies[1].material->yield_stress_compression = f_c;
  scene.bodies[1].material->youngs_modulus =
      1e15;  // 1e-6 of its critical load: the deformed state is the drawn one
  scene.loads[0].at.x = l;
  scene.loads[0].force.x = -V;
  double low = 0, high = 10;
  for (int i = 0; i < 100; ++i) {
    const double s = (low + high) / 2, x = (f_t * h + s * V) / (f_t + f_c);
    (s * H * l < (f_t + f_c) * x * (h - x) / 2 ? low : high) = s;
  }
  const Plan plan = calibrate(scene);
  ASSERT_GT(low * H * l, 5 * plan.joints.back().M);
  const double factor = limit_analysis(plan).load_factor;
  EXPECT_NEAR(factor / low, 1, 2e-3) << "the joint's polygon is inscribed within 1e-3";
  EXPECT_NEAR(factor / static_check(plan).reserve, 1, 1e-7) << "statically determinate";
  EXPECT_NEAR(factor / second_order_limit(plan).load_factor, 1, 1e-5);
}

// A post on a girder, and at its corner with a beam, pulled along and across by half of what the node bears
// so: twice that, whichever of the two is named first.
TEST(LimitAnalysis, ANodesCapsAreThoseOfTheBarThatEndsThere) {
  for (const double from : {-4., 0.})
    for (const bool post_first : {false, true})
      for (const bool along : {false, true}) {
        SceneDef scene;
        scene.gravity = {};
        BodyDef girder = beam(8, 4 - from, 0.4), post = beam(8, 4, 0.2);
        girder.name = "girder";
        girder.at = {from, 0};
        post.name = "post";
        post.angle = std::numbers::pi / 2;
        scene.bodies = {girder, post};
        scene.supports = {{.body = "girder", .at = {4, 0}, .fix_x = true, .fix_y = true, .fix_angle = true}};
        scene.joints = {{.a = post_first ? "post" : "girder",
                         .b = post_first ? "girder" : "post",
                         .at = Point{0, 0},
                         .welded = true}};
        (along ? scene.joints[0].overrides.axial : scene.joints[0].overrides.shear) = 10e3;
        scene.loads = {
            {.body = "post", .at = {0, along ? 4. : 0.}, .force = {along ? Point{0, 5e3} : Point{5e3, 0}}}};
        EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor, 2, 2 * exactly)
            << from << post_first << along;
      }
}

TEST(LimitAnalysis, ShearRoundsTheSurface) {
  SceneDef scene = cantilever(1, P);  // stubby: q = 1, m = 1 at loads of the same size
  scene.bodies[1] = beam(1, 0.5);
  scene.loads[0].at.x = 0.5;
  scene.joint = {};
  scene.interaction = true;
  const double q = P / 175e6, m = P * 0.5 / M;
  EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor * std::hypot(q, m), 1, 1e-7);
}

// A cantilever with a slit of 0.4 m between chords of 0.3 m at its root, L from the load. As one section it
// bears f b h (h + g)/L; as one joint each, as much and each chord's own f b h²/4 on top, which no chord
// bears that its axial force has made flow already: with the yield surface it is one section's again.
TEST(LimitAnalysis, IntervalsInLine) {
  constexpr double h = 0.3, g = 0.4, L = 10, f = 350e6;
  SceneDef scene = bending_only();
  scene.joint = {.shear = unlimited, .max_rotation = unlimited};
  scene.bodies = {
      wall("wall", -1, 0),
      {.name = "beam",
       .outline =
           {{{0, -0.5}, {L, -0.5}, {L, 0.5}, {0, 0.5}, {0, g / 2}, {0.5, g / 2}, {0.5, -g / 2}, {0, -g / 2}},
            {}},
       .material = test_steel}};
  scene.joints = {{.a = "wall", .b = "beam"}};
  scene.loads = {{.body = "beam", .at = {L, 0}, .force = {0, -1}}};
  const double one = f * h * (h + g) / L, own = f * h * h / 4 / L;
  EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor / (one + 2 * own), 1, 1e-6);
  scene.joint.combine = true;
  EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor / one, 1, 1e-6);
  scene.joint.combine = false;
  scene.interaction = true;
  EXPECT_NEAR(limit_analysis(calibrate(scene)).load_factor / one, 1, 2e-3);  // of polygons
}

// A T of cast iron bears more with its flange in compression: a bar of it that is welded to a wall at a node
// bears what one bears that touches the wall, up and down, whichever way it is drawn and joined.
TEST(LimitAnalysis, WeldedNodesKnowASectionsSides) {
  constexpr double l = 5;
  const Ring tee{{-0.01, 0}, {0.01, 0},   {0.01, 0.18}, {0.1, 0.18},
                 {0.1, 0.2}, {-0.1, 0.2}, {-0.1, 0.18}, {-0.01, 0.18}};
  Material iron = test_steel;
  iron.yield_stress_compression = 3 * iron.yield_stress;
  for (const bool outward : {true, false}) {
    std::vector<double> bears;
    for (const double load : {P, -P}) {
      SceneDef touching = bending_only();
      touching.bodies = {wall("wall", -1, 0), beam(4, l, 0.2)};
      BodyDef& bar = touching.bodies[1];
      bar.material = iron;
      bar.profile = {{{tee, {}}, iron}};
      if (!outward) std::swap(bar.along[0], bar.along[1]);
      touching.joints = {{.a = "wall", .b = "beam"}};
      touching.loads = {{.body = "beam", .at = {l, 0}, .force = {0, -load}}};
      bears.push_back(limit_analysis(calibrate(touching)).load_factor);
      for (const bool wall_first : {true, false}) {
        SceneDef welded = touching;
        welded.joints = {{.a = wall_first ? "wall" : "beam",
                          .b = wall_first ? "beam" : "wall",
                          .at = Point{0, 0},
                          .welded = true}};
        EXPECT_NEAR(limit_analysis(calibrate(welded)).load_factor / bears.back(), 1, exactly)
            << outward << wall_first << load;
      }
    }
    EXPECT_GT(std::max(bears[0], bears[1]), 1.5 * std::min(bears[0], bears[1]));
  }
}

TEST(LimitAnalysis, WhatHasNoAnswerSaysSo) {
  EXPECT_THROW(limit_analysis(calibrate(cantilever(2, 0))), InvalidInput) << "no load";
  SceneDef heavy = cantilever(2, P);
  heavy.gravity = {0, -1000};
  EXPECT_THROW(limit_analysis(calibrate(heavy), true), InvalidInput) << "gravity alone is too much";
  EXPECT_LT(limit_analysis(calibrate(heavy)).load_factor, 1);
  SceneDef hinged = cantilever(2, P);
  hinged.joints[0].overrides.moment = 0;
  EXPECT_THROW(limit_analysis(calibrate(hinged)), InvalidInput) << "a mechanism from the start";
  SceneDef strong = cantilever(2, P);
  strong.joint.moment = unlimited;
  EXPECT_EQ(limit_analysis(calibrate(strong)).load_factor, unlimited);
}

// --- against the simulation ---

struct Structure {
  const char* name;
  Plan plan;
};
void PrintTo(const Structure& s, std::ostream* out) { *out << s.name; }

constexpr double ramp = 4;  // s: several periods of the slowest

Plan loaded(Plan plan, double factor) {
  plan.gravity = {factor * plan.gravity.x, factor * plan.gravity.y};
  plan.gravity_ramp = ramp;
  for (Plan::Load& load : plan.loads) {
    load.def.force = {factor * load.def.force.x, factor * load.def.force.y};
    load.def.moment *= factor;
    load.def.ramp = ramp;
  }
  return plan;
}

/// At `factor` times its loads, from when they are all on: until some joint has turned by 0.03 rad more (by
/// then the geometry still is what was drawn) or all is over.
struct Played {
  double turned = 0;  // rad
  double speed = 0;   // m/s, of the fastest piece at the end
  Hinges hinges;      // what dissipated more than 1 % of all
  Played(const Plan& plan, double factor) {
    Simulation simulation(loaded(plan, factor));
    while (simulation.time() < ramp) simulation.step();
    std::vector<JointReading> before;
    for (std::size_t i = 0; i < plan.joints.size(); ++i) before.push_back(simulation.joint(i));
    std::vector<double> joules(before.size());
    while (turned < 0.03 && simulation.time() < 3 * ramp) {
      simulation.step();
      for (std::size_t i = 0; i < before.size(); ++i) {
        const JointReading now = simulation.joint(i);
        turned = std::max(turned, now.accumulated_rotation - before[i].accumulated_rotation);
        joules[i] = now.dissipated - before[i].dissipated;
      }
    }
    double all = 0;
    for (const double j : joules) all += j;
    for (std::size_t i = 0; i < joules.size(); ++i)
      if (joules[i] > 0.01 * all) hinges.insert(plan.joints[i].name);
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
      const Point v = simulation.piece(i).velocity;
      speed = std::max(speed, std::hypot(v.x, v.y));
    }
  }
};

class AgainstSimulation : public testing::TestWithParam<Structure> {};

TEST_P(AgainstSimulation, StandsBelowTheFactorAndFormsTheMechanismAbove) {
  const Plan& plan = GetParam().plan;
  const LimitAnalysis limit = limit_analysis(plan);
  const Played below(plan, 0.98 * limit.load_factor), above(plan, 1.02 * limit.load_factor);
  EXPECT_LT(below.speed, 1e-3);
  EXPECT_LT(below.turned, 3e-3);
  EXPECT_GT(above.turned, 0.03);
  EXPECT_EQ(above.hinges, names(plan, limit.hinges));
}

// The crane of the drawing, without the cargo's sway, its loads together.
Plan crane() {
  SceneDef scene = read_scene(DUCTILE_SOURCE_DIR "/scenes/harbour_crane.scene.json");
  scene.joint.max_rotation = scene.joint.max_elongation = unlimited;
  for (LoadDef& load : scene.loads) load.from = 0, load.to = unlimited;
  return calibrate(scene);
}

// So stiff that it does not lean before it collapses: the weight on a portal that leans adds to its sway.
const Portal stiff{.youngs_modulus = 210e11};

SceneDef damped(SceneDef scene) {
  scene.joint.damping_ratio = 0.3;
  return scene;
}

INSTANTIATE_TEST_SUITE_P(LimitAnalysis, AgainstSimulation,
                         testing::Values(Structure{"cantilever", calibrate(damped(cantilever(10, P)))},
                                         Structure{"simply_supported",
                                                   calibrate(damped(simply_supported(10, P)))},
                                         Structure{"fixed_fixed", calibrate(damped(fixed_fixed(10, P)))},
                                         Structure{"propped", calibrate(damped(propped(10, P)))},
                                         Structure{"portal_beam", stiff.hinged_in_beam(P)},
                                         Structure{"portal_sway", stiff.hinged_in_columns(0, P)},
                                         Structure{"portal_combined", stiff.hinged_in_columns(P, P)},
                                         Structure{"crane_from_svg", crane()}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
