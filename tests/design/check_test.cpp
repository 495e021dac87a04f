// Static forces against closed forms, and against the simulation at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/design.h"
#include "ductile/files.h"
#include "ductile/plane.h"
#include "ductile/simulation.h"
#include "structures.h"

namespace {
using namespace ductile;

constexpr double L = 20, P = 1e6;

const StaticJoint& at(const Plan& plan, const StaticCheck& check, const std::string& name) {
  return check.joints.at(static_cast<std::size_t>(joint_named(plan, name)));
}

TEST(StaticCheck, StaticsAloneDecidesACantileverWhateverItsStiffness) {
  for (const int pieces : {1, 2, 10, 100}) {
    for (const auto elastic : {Elasticity::true_stiffness, Elasticity::rigid}) {
      SceneDef scene = cantilever(pieces, P);
      scene.joint.elastic = elastic;
      const Plan plan = calibrate(scene);
      const StaticCheck check = static_check(plan);
      for (int i = 0; i < pieces; ++i) {
        const std::string name = i == 0 ? "wall-beam/0" : plan.joints[static_cast<std::size_t>(i - 1)].name;
        const double arm = L - L * i / pieces;
        const StaticJoint& j = at(plan, check, pieces == 1 ? "wall-beam" : name);
        EXPECT_NEAR(j.M / (-P * arm), 1, 1e-9) << name << " of " << pieces;
        EXPECT_NEAR(j.Q / -P, 1, 1e-9);
        EXPECT_NEAR(j.N / P, 0, 1e-9);
      }
      EXPECT_NEAR(check.reserve * P * L / plastic_moment, 1, 1e-9);
      EXPECT_EQ(check.first_to_yield.size(), static_cast<std::size_t>(pieces));
      const std::string root = pieces == 1 ? "wall-beam" : "wall-beam/0";
      EXPECT_EQ(check.first_to_yield.front(), joint_named(plan, root));
    }
  }
}

// A cantilever whose tip rests on a spring: the spring takes P k f/(1 + k f) of the load on it, f = L³/3EI.
TEST(StaticCheck, ASpringSharesTheLoadByItsStiffness) {
  const double f = L * L * L / 3 / (210e9 / 12), k = 2 / f;
  SceneDef scene = cantilever(40, P);
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.supports = {{.body = "beam", .at = {L, 0}, .stiffness_y = k}};
  const Plan plan = calibrate(scene);
  const StaticCheck check = static_check(plan);
  EXPECT_NEAR(std::abs(at(plan, check, "support/0").Q) / (P * k * f / (1 + k * f)), 1, 1e-3);
  EXPECT_NEAR(at(plan, check, "wall-beam/0").M / (-P * L / (1 + k * f)), 1, 1e-3);
}

// A cantilever on a foot that turns: P L²/k + P L³/3EI (1 + 1/2n²) at its tip.
TEST(StaticCheck, ASpringIsInLineWithTheBar) {
  const double EI = 210e9 / 12, k = 3 * EI / L;
  SceneDef scene = cantilever(40, P);
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.bodies.erase(scene.bodies.begin());
  scene.joints.clear();
  scene.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true, .stiffness_angle = k}};
  const StaticCheck check = static_check(calibrate(scene));
  const double tip = check.displacement.back().y + check.turn.back() * L / 80;
  EXPECT_NEAR(-tip / (P * L * L / k + P * L * L * L / 3 / EI), 1, 1e-3);
}

// Bending alone P L³/3EI; the pieces' rotations are lumped in joints of ℓ, the root's of ℓ/2: the sum over
// joints of M_i² ℓ_i/(P EI) differs from the integral by 1/2n² of it, and by n more pieces for shear.
TEST(StaticCheck, ElasticTipDeflection) {
  for (const int n : {10, 40}) {
    SceneDef scene = cantilever(n, P);
    scene.joint.shear = unlimited;
    Plan plan = calibrate(scene);
    for (PlannedJoint& joint : plan.joints) joint.stiffness.Q = joint.stiffness.N = unlimited;
    const StaticCheck check = static_check(plan);
    const double EI = 210e9 / 12, l = L / n;
    double tip = 0, slope = 0;  // closed sum at the last piece's centre
    for (int i = 0; i < n; ++i) {
      const double x = l * i, angle = P * (L - x) * (i == 0 ? l / 2 : l) / EI;
      tip += angle * (L - l / 2 - x);
      slope += angle;
    }
    EXPECT_NEAR(check.displacement.back().y / -tip, 1, 1e-5) << n;  // rigid is 1e6 times stiffer
    EXPECT_NEAR((tip + slope * l / 2) / (P * L * L * L / 3 / EI), 1, 1. / (n * n)) << n;
  }
}

// An arm on a block that moves bends as on a wall: P L³/3EI, but for 1/2n² of it.
TEST(StaticCheck, AnArmOnABlock) {
  constexpr int n = 20;
  SceneDef scene = cantilever(n, P);
  scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
  scene.bodies[0] = {.name = "wall", .outline = {rectangle(-40, -20, 0, 20), {}}, .material = test_steel};
  scene.supports = {{.body = "wall", .at = {-40, -20}, .fix_x = true, .fix_y = true},
                    {.body = "wall", .at = {0, -20}, .fix_y = true}};
  const StaticCheck check = static_check(calibrate(scene));
  const double tip = check.displacement.back().y + check.turn.back() * L / (2 * n);
  EXPECT_NEAR(-tip / (P * L * L * L / 3 / (210e9 / 12)), 1, 1. / (n * n));
}

// A cantilever of two bars, the outer one half as high, with P where they meet and a prop at its end: R of it
// is ∫ M m/EI over ∫ m²/EI, (20/3)/40 of P.
TEST(StaticCheck, AStepInAProppedBarIsOfSecondOrder) {
  const auto error = [](int n) {
    SceneDef scene = cantilever(n, 0);
    scene.joint.stiffness_axial = scene.joint.stiffness_shear = unlimited;
    scene.bodies[1] = beam(n, L / 2);
    BodyDef outer = beam(n, L / 2, 0.5);
    outer.name = "outer";
    outer.at = {L / 2, 0};
    scene.bodies.push_back(outer);
    scene.joints.push_back({.a = "beam", .b = "outer"});
    scene.supports = {{.body = "outer", .at = {L, 0}, .fix_y = true}};
    scene.loads = {{.body = "outer", .at = {L / 2, 0}, .force = {0, -P}}};
    const Plan plan = calibrate(scene);
    return std::abs(at(plan, static_check(plan), "support/0").Q) / P - 1. / 6;
  };
  EXPECT_NEAR(error(8) * 6, 0, 0.01);
  EXPECT_NEAR(error(4) / error(8), 4, 0.3);
  EXPECT_NEAR(error(8) / error(16), 4, 0.1);
}

// P L/8 at the ends and in the middle of a clamped beam; 3 P L/16 at the clamped end of a propped one.
TEST(StaticCheck, IndeterminateForcesFollowTheStiffness) {
  for (const int n : {20, 40}) {
    const double order = 2. / (n * n);  // of the joints' discretisation
    const Plan clamped = calibrate(fixed_fixed(n, P));
    const StaticCheck c = static_check(clamped);
    EXPECT_NEAR(at(clamped, c, "left-beam/0").M / (-P * L / 8), 1, order);
    const std::string middle = "beam/" + std::to_string(n / 2 - 1) + "-beam/" + std::to_string(n / 2);
    EXPECT_NEAR(at(clamped, c, middle).M / (P * L / 8), 1, order);

    SceneDef scene = propped(n, P);
    Plan plan = calibrate(scene);
    for (PlannedJoint& joint : plan.joints) joint.stiffness.Q = unlimited;  // Bernoulli
    EXPECT_NEAR(at(plan, static_check(plan), "wall-beam/0").M / (-3 * P * L / 16), 1, order);
  }
}

TEST(StaticCheck, AgreesWithTheSimulationAtRest) {
  for (const char* name : {"frame", "viaduct", "fixed_fixed", "cantilever"}) {
    SceneDef scene = read_scene(DUCTILE_SOURCE_DIR "/scenes/" + std::string(name) + ".scene.json");
    scene.gravity_ramp = 1;
    for (BodyDef& body : scene.bodies)
      if (body.material) body.material->damping_ratio = 1;
    const Plan plan = calibrate(scene);
    const StaticCheck check = static_check(plan);
    Simulation simulation(plan);
    while (simulation.time() < 10) simulation.step();
    double largest[3] = {}, apart[3] = {};
    for (std::size_t i = 0; i < plan.joints.size(); ++i) {
      const JointReading r = simulation.joint(i);
      const double simulated[] = {r.N, r.Q, r.M},
                   statics[] = {check.joints[i].N, check.joints[i].Q, check.joints[i].M};
      for (int k = 0; k < 3; ++k) {
        largest[k] = std::max(largest[k], std::abs(statics[k]));
        apart[k] = std::max(apart[k], std::abs(statics[k] - simulated[k]));
      }
    }
    // The simulation's axes have turned with the sag, by up to 6e-3 in the cantilever.
    EXPECT_LT(apart[0], 7e-3 * std::max(largest[0], largest[1])) << name;
    EXPECT_LT(apart[1], 2e-3 * largest[1]) << name;
    EXPECT_LT(apart[2], 2e-3 * largest[2]) << name;
  }
}

// What the joints, the loads and its weight bring on each piece of a drawing of 500 joints and of a frame of
// 2085 adds up to nothing: 1e-11 of the largest force, 1e-10 of it at an arm of 1 m.
TEST(StaticCheck, EveryPieceOfALargeStructureIsInEquilibrium) {
  for (const auto& [name, joints] : {std::pair("viaduct", 500u), std::pair("frame_large", 2085u)}) {
    const Plan plan =
        calibrate(read_scene(DUCTILE_SOURCE_DIR "/scenes/" + std::string(name) + ".scene.json"));
    ASSERT_EQ(plan.joints.size(), joints);
    const StaticCheck check = static_check(plan);
    std::vector<Point> force(plan.pieces.size());
    std::vector<double> moment(plan.pieces.size());
    double largest = 0;
    const auto push = [&](int piece, Point by, double turn, Point where) {
      if (piece < 0) return;
      const auto p = static_cast<std::size_t>(piece);
      force[p] = force[p] + by;
      moment[p] += turn + cross(where - plan.pieces[p].center, by);
      largest = std::max(largest, length(by));
    };
    for (std::size_t i = 0; i < joints; ++i) {
      const PlannedJoint& j = plan.joints[i];
      const StaticJoint& carries = check.joints[i];
      const Point on_a = carries.N * j.axis + carries.Q * left(j.axis);
      push(j.a, on_a, carries.M, j.anchor);
      push(j.b, -1 * on_a, -carries.M, j.anchor);
    }
    for (const Plan::Load& load : plan.loads) push(load.piece, load.def.force, load.def.moment, load.at);
    for (std::size_t p = 0; p < plan.pieces.size(); ++p) {
      const Piece& piece = plan.pieces[p];
      if (!plan.is_dynamic(static_cast<int>(p))) continue;
      push(static_cast<int>(p), piece.mass * plan.gravity, 0, piece.center);
      EXPECT_LT(length(force[p]), 1e-11 * largest) << piece.name;
      EXPECT_LT(std::abs(moment[p]), 1e-10 * largest) << piece.name;
    }
  }
}

// N/N_p and M/M_p of a rectangle: m + n² = 1 along the ray.
TEST(StaticCheck, ReserveOnTheYieldSurface) {
  SceneDef scene = cantilever(1, P);
  scene.joint = {};
  scene.interaction = true;
  scene.loads[0].force = {-200e6, -1e6};
  const StaticCheck check = static_check(calibrate(scene));
  const double m = P * L / plastic_moment, n = 200e6 / 350e6, q = P / 175e6;
  // s: (s m)/√(1 − (s q)²) + (s n)²/(1 − (s q)²) = 1
  double low = 0, high = 10;
  for (int i = 0; i < 100; ++i) {
    const double s = (low + high) / 2, left = 1 - s * s * q * q;
    (s * m / std::sqrt(left) + s * s * n * n / left < 1 ? low : high) = s;
  }
  EXPECT_NEAR(check.reserve / low, 1, 2e-3);  // the joint's polygon is within 1e-3 of the curve
  EXPECT_LT(check.reserve, low * (1 + 1e-9)) << "inscribed";
}

TEST(StaticCheck, LoadsThatEndAreLookedAtWhenTheyAct) {
  SceneDef scene = cantilever(4, 1e6);
  scene.loads[0].to = 2;
  scene.loads.push_back({.body = "beam", .at = {20, 0}, .force = {0, -3e6}, .from = 3, .ramp = 1, .to = 5});
  const StaticCheck check = static_check(calibrate(scene));
  EXPECT_EQ(check.time, 3);
  EXPECT_NEAR(check.reserve, plastic_moment / (3e6 * L), 1e-9);
}

TEST(StaticCheck, NothingYieldsWithoutLoad) {
  const StaticCheck check = static_check(calibrate(cantilever(4, 0)));
  EXPECT_EQ(check.reserve, unlimited);
  EXPECT_TRUE(check.first_to_yield.empty());
}

TEST(StaticCheck, LoosePiecesAreNamedAndLeftOut) {
  const SceneDef scene = with_a_loose_stone(cantilever(4, P));
  const Plan plan = calibrate(scene);
  const StaticCheck check = static_check(plan);
  ASSERT_EQ(check.loose.size(), 2u);
  EXPECT_EQ(plan.pieces[static_cast<std::size_t>(check.loose[0])].name, "stone/0");
  EXPECT_TRUE(std::isnan(at(plan, check, "stone/0-stone/1").M));
  EXPECT_NEAR(check.reserve * P * L / plastic_moment, 1, 1e-9);
}

std::string refusal(const SceneDef& scene) {
  try {
    static_check(calibrate(scene));
  } catch (const InvalidInput& e) {
    return to_string(e.problems().front());
  }
  return "";
}

TEST(StaticCheck, AMechanismIsRefused) {
  SceneDef rolling = simply_supported(4, P);
  rolling.supports[0].fix_x = false;
  EXPECT_EQ(refusal(rolling), "") << "a beam on rollers carries what does not push it along";
  rolling.loads[0].force.x = 1e-4 * P;
  EXPECT_NE(refusal(rolling).find("mechanism"), std::string::npos);
  SceneDef hinged = cantilever(4, P);
  hinged.joints[0].overrides.moment = 0;
  EXPECT_NE(refusal(hinged).find("mechanism"), std::string::npos);
  SceneDef flying = cantilever(4, P);
  flying.joints.clear();
  EXPECT_NE(refusal(flying).find("no joint holds"), std::string::npos);
  SceneDef standing = cantilever(4, P);
  standing.bodies[1].type = BodyType::static_body;
  EXPECT_NE(refusal(standing).find("no joint holds"), std::string::npos);
}

// The tip turns by Σ M/k: every joint stands for half of each neighbour, the root for half of the first
// piece.
TEST(StaticCheck, ASupportClampsAsAWallDoes) {
  const int n = 4;
  SceneDef walled = cantilever(n, P);
  walled.joint.stiffness_axial = walled.joint.stiffness_shear = unlimited;
  walled.bodies[1].material->damping_ratio = 1;
  SceneDef supported = walled;
  supported.bodies.erase(supported.bodies.begin());
  supported.joints.clear();
  supported.supports = {{.body = "beam", .at = {0, 0}, .fix_x = true, .fix_y = true, .fix_angle = true}};
  const double EI = 210e9 / 12, l = L / n;
  double turn = P * L * (l / 2) / EI;
  for (int i = 1; i < n; ++i) turn += P * (L - i * l) * l / EI;
  for (const SceneDef& scene : {walled, supported}) {
    const Plan plan = calibrate(scene);
    EXPECT_NEAR(static_check(plan).turn.back() / -turn, 1, 1e-6);
    Simulation simulation(plan);
    while (simulation.time() < 20) simulation.step();
    EXPECT_NEAR(simulation.piece(plan.pieces.size() - 1).angle / -turn, 1, 1e-3);
  }
  supported.joint.elastic = Elasticity::rigid;
  EXPECT_EQ(calibrate(supported).joints.back().stiffness.M, unlimited);
}

TEST(StaticCheck, RoundingIsNoForce) {
  SceneDef scene = bending_only();
  scene.bodies = {beam(8)};
  scene.bodies[0].at = {3, 4};
  scene.bodies[0].angle = 1.1;
  const Point along{std::cos(1.1), std::sin(1.1)}, foot{3, 4}, top = foot + L * along;
  scene.supports = {{.body = "beam", .at = foot, .fix_x = true, .fix_y = true, .fix_angle = true}};
  scene.loads = {{.body = "beam", .at = top, .force = (-P) * along}};
  const Plan plan = calibrate(scene);
  const StaticCheck check = static_check(plan);
  for (std::size_t i = 0; i + 1 < plan.joints.size(); ++i) {
    EXPECT_EQ(check.joints[i].Q, 0) << plan.joints[i].name;
    EXPECT_EQ(check.joints[i].M, 0) << plan.joints[i].name;
    EXPECT_NEAR(check.joints[i].N / -P, 1, 1e-12);
  }
}

// A beam on two supports in seven pieces, P in its middle: PL/4 there, of which the cuts beside it, at 3L/7,
// see 6/7. The first fibre yields at W f_y/(PL/4), M_p/1.5 of a rectangle.
TEST(MissedMoments, OfALoadWithinAPiece) {
  const Plan plan = calibrate(simply_supported(7, 1e6));
  const StaticCheck check = static_check(plan);
  const std::vector<MissedMoment> missed = missed_moments(plan, check);
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_EQ(plan.pieces[static_cast<std::size_t>(missed[0].piece)].name, "beam/3");
  EXPECT_NEAR(missed[0].factor, 7. / 6, 1e-9);
  for (const Order order : {Order::first, Order::second}) {
    const FirstFibre fibre = first_fibre(plan, check, order);
    EXPECT_EQ(fibre.joint, -1);
    EXPECT_EQ(fibre.piece, missed[0].piece);
    // Of second order turned pieces carry some of the load along them: 1e-6 with a slope of 1e-3.
    EXPECT_NEAR(fibre.factor / (plastic_moment / 1.5 / (1e6 * 20 / 4)), 1,
                order == Order::first ? 1e-9 : 1e-5);
  }
  const Plan even = calibrate(simply_supported(8, 1e6));
  EXPECT_TRUE(missed_moments(even, static_check(even)).empty());
  EXPECT_EQ(even.joints[static_cast<std::size_t>(first_fibre(even, static_check(even)).joint)].name,
            "beam/3-beam/4");
}

// Its own weight, w: wL²/8 in the middle of three pieces, whose cuts see wL²/9.
TEST(MissedMoments, OfItsOwnWeight) {
  SceneDef scene = simply_supported(3, 0);
  scene.gravity = {0, -10};
  const Plan plan = calibrate(scene);
  const std::vector<MissedMoment> missed = missed_moments(plan, static_check(plan));
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_NEAR(missed[0].factor, 9. / 8, 1e-9);
}

// It goes on beyond its second support, at 12 m in the middle of the third of five pieces of 5 m, by 13 m to
// P: 13 P over the support, 10/12 of it at the cut before.
TEST(MissedMoments, OfASupportWithinAPiece) {
  SceneDef scene = simply_supported(5, 1e6);
  scene.bodies[0] = beam(5, 25);
  scene.supports[1].at.x = 12;
  scene.loads[0].at.x = 25;
  const Plan plan = calibrate(scene);
  const std::vector<MissedMoment> missed = missed_moments(plan, static_check(plan));
  ASSERT_EQ(missed.size(), 1u);
  EXPECT_NEAR(missed[0].factor, 1.2, 1e-9);
  const FirstFibre fibre = first_fibre(plan, static_check(plan));
  EXPECT_EQ(fibre.joint, joint_named(plan, "support/1"));
  EXPECT_NEAR(fibre.factor, plastic_moment / 1.5 / 13e6, 1e-9);
}

// A girder with a window over its length between two solid ends, cut through both of its chords: these bear
// N as well, and no section bears the whole moment.
TEST(MissedMoments, NoneOfAWindow) {
  for (const int pieces : {2, 3, 4}) {
    SceneDef scene = cantilever(pieces, 1e6);
    scene.bodies[1].outline.holes = {rectangle(1, -0.3, 19, 0.3)};
    const Plan plan = calibrate(scene);
    const StaticCheck check = static_check(plan);
    ASSERT_EQ(plan.joints.size(), 2u * static_cast<std::size_t>(pieces) - 1);
    EXPECT_TRUE(missed_moments(plan, check).empty());
    const FirstFibre fibre = first_fibre(plan, check);
    EXPECT_EQ(fibre.piece, -1);
    EXPECT_EQ(fibre.factor, *std::min_element(fibre.joints.begin(), fibre.joints.end()));
  }
}

// A mast with an arm welded to its top: the corner has all of the moment, whichever number of pieces there
// are, and the thinner of the two yields first, at W f_y/(P l).
TEST(FirstFibre, OfAWeldedCorner) {
  for (const int pieces : {2, 8}) {
    SceneDef scene = cantilever(pieces, 0);
    scene.bodies.push_back(beam(pieces, 10, 0.5));
    scene.bodies[2].name = "arm";
    scene.bodies[2].at = {20, 0};
    scene.bodies[2].angle = std::numbers::pi / 2;
    scene.joints.push_back({.a = "beam", .b = "arm", .at = Point{20, 0}, .welded = true});
    scene.loads = {{.body = "arm", .at = {20, 10}, .force = {1e6, 0}}};
    const Plan plan = calibrate(scene);
    const FirstFibre fibre = first_fibre(plan, static_check(plan));
    const double expected = plastic_moment * 0.25 / 1.5 / 1e7;
    EXPECT_EQ(fibre.joint, joint_named(plan, "beam/" + std::to_string(pieces - 1) + "-arm/0"));
    EXPECT_NEAR(fibre.factor, expected, 1e-9 * expected);
    EXPECT_LT(fibre.factor, static_check(plan).reserve);
  }
}

}  // namespace
