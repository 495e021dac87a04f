// Making scenes: what is joined to what.
#include "making.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ductile/design.h"
#include "ductile/files.h"
#include "gate.h"

namespace ductile::viewer {
namespace {

TEST(Making, BeamsArePinnedWhereTheyMeetAndToWhatIsStatic) {
  const SceneDef scene = gate();
  ASSERT_EQ(scene.bodies.size(), 4u);
  ASSERT_EQ(scene.joints.size(), 4u);
  EXPECT_EQ(scene.joints[0].a, "floor");
  EXPECT_EQ(scene.joints[0].b, "beam1");
  EXPECT_EQ(scene.joints[2].a, "beam1");
  EXPECT_EQ(scene.joints[2].b, "beam3");
  EXPECT_EQ(nodes(scene).size(), 4u);
  EXPECT_THROW(static_check(calibrate(with_load(scene, {-2, 3}, {1, 0}))), InvalidInput);  // it sways
}

TEST(Making, BlocksThatStandHoldWhatEndsInThem) {
  const Ring pier{{-1, 3}, {1, 3}, {1, 1}, {-1, 1}};  // clockwise
  SceneDef scene = with_beam(empty_scene(), {{-4, 3}, {0, 3}}, {});
  scene = with_block(scene, pier, {});
  EXPECT_EQ(scene.joints.size(), 1u);  // the beam that was there
  scene = with_beam(scene, {{0.5, 3}, {4, 3}}, {});
  ASSERT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.joints[1].a, "block1");
  EXPECT_EQ(scene.joints[1].b, "beam2");
  EXPECT_GT(calibrate(scene).joints.size(), 2u);
  scene = with_block(scene, {{5, 0}, {6, 0}, {6, 1}}, {.fixed = false});  // beside: nothing holds it
  EXPECT_EQ(scene.joints.size(), 2u);
  EXPECT_EQ(scene.bodies.back().type, BodyType::dynamic_body);
  EXPECT_THROW(calibrate(with_block(scene, {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {})), InvalidInput);
}

// A block on the floor with a force at its top: joined along its foot it bears up to M = b h²/4 f_y there.
TEST(Making, BlocksThatTouchAreJoinedAndParted) {
  const double width = 0.5, force = 1e6, rise = 4;
  const Ring post{{0, 0}, {width, 0}, {width, rise}, {0, rise}};
  BlockStyle style{.fixed = false, .depth = 0.1};
  style.material.density = 1e-6;
  SceneDef scene = with_block(empty_scene(), post, style);
  const Point foot{width / 2, 0};
  EXPECT_THROW(with_weld_or_pin(scene, {width / 2, rise}), InvalidInput);  // nothing touches there
  scene = with_load(with_weld_or_pin(scene, foot), {width, rise}, {force, 0});
  ASSERT_EQ(scene.joints.size(), 1u);
  const double reserve = style.depth * width * width / 4 * 355e6 / (force * rise);
  EXPECT_NEAR(static_check(calibrate(scene)).reserve / reserve, 1, 1e-6);
  EXPECT_TRUE(with_weld_or_pin(scene, foot).joints.empty());
}

// A truss of two equal bars on hinges, half-span a and rise h, with a force P at its top: N = −P/(2 sin α) in
// both, and the bars' own weight is left out by making them light.
TEST(Making, TwoBarsCarryALoadAsStaticsSays) {
  BeamStyle style;
  style.material.density = 1e-6;
  const Point left{-3, 1}, right{3, 1}, top{0, 5};
  SceneDef scene = with_beam(empty_scene(), {left, top}, style);
  scene = with_beam(scene, {top, right}, style);
  scene = with_next_support(with_next_support(scene, left, 0), right, 0);
  scene = with_load(scene, top, {0, -10e3});
  const Plan plan = calibrate(scene);
  const StaticCheck check = static_check(plan);
  int compared = 0;
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    if (!plan.joints[i].name.starts_with("beam1/")) continue;
    if (plan.pieces[static_cast<std::size_t>(plan.joints[i].b)].body != 1) continue;  // along the bar
    EXPECT_NEAR(check.joints[i].N, -10e3 / (2 * 4. / 5), 1e-3) << plan.joints[i].name;
    ++compared;
  }
  EXPECT_EQ(compared, style.pieces - 1);
}

TEST(Making, SupportsGoRoundAndLoadsAreReplaced) {
  SceneDef scene = gate();
  const Point foot{-2, 0};
  const double stiffness = 1e6;
  const auto rows = [&] {
    const SupportDef& s = scene.supports.at(0);
    return std::array{s.fix_x, s.fix_y, s.fix_angle};
  };
  EXPECT_EQ((scene = with_next_support(scene, foot, stiffness), rows()), (std::array{true, true, false}));
  EXPECT_EQ((scene = with_next_support(scene, foot, stiffness), rows()), (std::array{false, true, false}));
  EXPECT_EQ((scene = with_next_support(scene, foot, stiffness), rows()), (std::array{true, true, true}));
  EXPECT_EQ((scene = with_next_support(scene, foot, stiffness), rows()), (std::array{false, false, false}));
  EXPECT_EQ(scene.supports[0].stiffness_x, stiffness);
  EXPECT_EQ(scene.supports[0].stiffness_y, stiffness);
  EXPECT_TRUE(with_next_support(scene, foot, stiffness).supports.empty());
  scene = with_load(scene, {0, 3}, {0, -1});  // within the span
  scene = with_load(scene, {0, 3}, {0, -2});
  ASSERT_EQ(scene.loads.size(), 1u);
  EXPECT_EQ(scene.loads[0].force.y, -2);
  EXPECT_EQ(scene.loads[0].body, "beam3");
  EXPECT_TRUE(with_load(scene, {0, 3}, {}).loads.empty());
  EXPECT_THROW(with_next_support(scene, {0, 2}, 0), InvalidInput);
  EXPECT_THROW(with_load(scene, {0, 2}, {0, -1}), InvalidInput);
}

TEST(Making, AMovedNodeTakesItsBeamsSupportsAndLoadsAlong) {
  SceneDef scene = with_load(gate(), {0, 3}, {0, -1});
  scene = with_next_support(scene, {-2, 3}, 0);
  scene = with_node_moved(scene, {-2, 3}, {-2, 5});
  EXPECT_NEAR(length(axis_of(scene.bodies[1])->to - Point{-2, 5}), 0, 1e-12);
  EXPECT_NEAR(length(axis_of(scene.bodies[3])->from - Point{-2, 5}), 0, 1e-12);
  EXPECT_EQ(scene.supports[0].at.y, 5);
  EXPECT_NEAR(length(scene.loads[0].at - Point{0, 4}), 0, 1e-12);  // still in the middle
  EXPECT_EQ(scene.joints.size(), 4u);
  EXPECT_NO_THROW(calibrate(scene));
  // Onto another node: one pin of three beams. What becomes too short cannot be.
  scene = with_node_moved(gate(), {-2, 3}, {-2, 0.5});
  EXPECT_THROW(with_node_moved(scene, {-2, 0.5}, {-2, 0.1}), InvalidInput);
  EXPECT_THROW(with_node_moved(scene, {7, 7}, {8, 8}), InvalidInput);
}

TEST(Making, WhatHangsOnABeamGoesAlongWithIt) {
  // A post on the middle of the beam, a rope from there to the floor, and a post on that post's top.
  const BeamStyle style;
  SceneDef scene = with_beam(gate(), {{0, 3}, {0, 5}}, style);
  scene = with_line(scene, {{0, 3}, {0, 0}}, {});
  scene = with_beam(scene, {{0, 5}, {1, 7}}, style);
  const std::size_t joints = scene.joints.size();
  scene = with_node_moved(scene, {2, 3}, {2, 4});
  EXPECT_NEAR(length(axis_of(scene.bodies[4])->from - Point{0, 3.5}), 0, 1e-12);
  EXPECT_NEAR(length(axis_of(scene.bodies[4])->to - Point{0, 5}), 0, 1e-12);  // no further
  EXPECT_EQ(scene.joints.size(), joints);
  const auto rope = std::find_if(scene.joints.begin(), scene.joints.end(),
                                 [](const JointBetweenDef& j) { return j.line.has_value(); });
  ASSERT_NE(rope, scene.joints.end());
  EXPECT_NEAR(length((*rope->line)[0] - Point{0, 3.5}), 0, 1e-12);
  EXPECT_EQ(length((*rope->line)[1] - Point{0, 0}), 0);
  EXPECT_NO_THROW(calibrate(scene));
  // The rope's other end by itself, onto a post.
  scene = with_node_moved(scene, {0, 0}, {-2, 1});
  const auto moved = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [](const JointBetweenDef& j) { return j.line.has_value(); });
  EXPECT_EQ(moved->b, "beam1");
  EXPECT_EQ(length((*moved->line)[1] - Point{-2, 1}), 0);
}

TEST(Making, BodiesMoveWithAllThatHangsOnThem) {
  SceneDef scene = with_load(gate(), {0, 3}, {0, -1});
  const std::size_t joints = scene.joints.size();
  const SceneDef with_floor = with_bodies_moved(scene, {"floor"}, {1, -1});
  EXPECT_EQ(length(with_floor.bodies[0].at - Point{1, -1}), 0);
  EXPECT_EQ(length(axis_of(with_floor.bodies[1])->from - Point{-1, -1}), 0);  // the post's foot stays on it
  EXPECT_NEAR(length(axis_of(with_floor.bodies[1])->to - Point{-2, 3}), 0, 1e-12);
  EXPECT_EQ(with_floor.joints.size(), joints);
  EXPECT_NO_THROW(calibrate(with_floor));
  const SceneDef with_beam = with_bodies_moved(scene, {"beam3"}, {0, 1});
  EXPECT_NEAR(length(axis_of(with_beam.bodies[1])->to - Point{-2, 4}), 0, 1e-12);  // posts reach up to it
  EXPECT_EQ(length(with_beam.loads[0].at - Point{0, 4}), 0);
  EXPECT_EQ(with_beam.joints.size(), joints);
}

// A beam of 4 m on two posts, q = its weight per length: pinned at their tops its moment is qL²/8 in the
// middle and 0 at its ends. Welded to posts 1000 times as stiff, its joints, of which those at its ends
// stand for half a piece, turn by nothing in all: M_e − q x(L − x)/2 vanishes by the trapezoidal rule over x
// = kL/n, and M_e = qL²/12 (1 − 1/n²).
TEST(Making, AWeldTakesMomentsAndAPinNone) {
  BeamStyle stiff;
  stiff.height = 1;
  stiff.pieces = 2;
  BeamStyle slender;
  slender.height = 0.1;
  slender.pieces = 24;
  SceneDef scene = with_beam(empty_scene(), {{-2, 0}, {-2, 2}}, stiff);
  scene = with_beam(scene, {{2, 0}, {2, 2}}, stiff);
  scene = with_beam(scene, {{-2, 2}, {2, 2}}, slender);
  for (const double x : {-2., 2.}) {
    for (int clicks = 0; clicks < 3; ++clicks) scene = with_next_support(scene, {x, 0}, 0);  // clamped
  }
  const double q = 9.81 * slender.material.density * slender.height * slender.depth, L = 4;
  const auto moment = [](const SceneDef& of, const std::string& joint) {
    const Plan plan = calibrate(of);
    const auto found = std::find_if(plan.joints.begin(), plan.joints.end(),
                                    [&](const PlannedJoint& j) { return j.name == joint; });
    return std::abs(static_check(plan).joints[static_cast<std::size_t>(found - plan.joints.begin())].M);
  };
  const std::string middle = "beam3/11-beam3/12", end = "beam1/1-beam3/0";
  EXPECT_NEAR(moment(scene, middle) / (q * L * L / 8), 1, 1e-6);
  EXPECT_EQ(moment(scene, end), 0);
  for (const double x : {-2., 2.}) scene = with_weld_or_pin(scene, {x, 2});
  const double n = slender.pieces, fixed_end = q * L * L / 12 * (1 - 1 / (n * n));
  EXPECT_NEAR(moment(scene, end) / fixed_end, 1, 1e-3);
  EXPECT_NEAR(moment(scene, middle) / (q * L * L / 8 - fixed_end), 1, 2e-3);
  for (const double x : {-2., 2.}) scene = with_weld_or_pin(scene, {x, 2});
  EXPECT_EQ(moment(scene, end), 0);
  EXPECT_THROW(with_weld_or_pin(scene, {0, 2}), InvalidInput);
}

// 100 kN on a spring of 1 MN/m, straight below it: 0.1 m.
TEST(Making, ASpringYieldsAsItsStiffnessSays) {
  BeamStyle style;
  style.material.density = 1e-6;
  SceneDef scene = with_beam(empty_scene(), {{-1, 3}, {1, 3}}, style);
  for (const double x : {-1., 1.}) {
    for (int clicks = 0; clicks < 4; ++clicks) scene = with_next_support(scene, {x, 3}, 0.5e6);
  }
  scene = with_load(scene, {0, 3}, {0, -100e3});
  const StaticCheck check = static_check(calibrate(scene));
  EXPECT_NEAR(check.displacement[1].y, -0.1, 2e-3);  // beside what the beam bends
}

// A stiff bar turns about a hinge by θ against springs at its middle and its end: they carry k₁ θL/2 and k₂
// θL, of which the load at the end is F = k₁ θL/4 + k₂ θL. The bar bends by k₁ L³/3EI = 2e-4 of that at most.
TEST(Making, SpringsBetweenBodiesShareALoadByTheirStiffness) {
  const double F = 1e3, middle = 3e3, end = 1e3;
  BeamStyle style{.height = 1, .depth = 1};
  style.material.density = 1e-6;
  SceneDef scene = with_beam(empty_scene(), {{-2, 3}, {2, 3}}, style);
  scene = with_next_support(scene, {-2, 3}, 0);
  using Kind = LineStyle::Kind;
  scene = with_line(scene, {{0, 3}, {0, 0}}, {.kind = Kind::spring, .stiffness = middle});
  scene = with_line(scene, {{2, 3}, {2, 0}}, {.kind = Kind::spring, .stiffness = end});
  const LoadStyle up{.force = F, .direction = 90};
  const Plan plan = calibrate(with_load(scene, {2, 3}, up.vector()));
  const StaticCheck check = static_check(plan);
  const double end_lifts = F / (middle / 4 + end);
  int springs = 0;
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    if (!plan.joints[i].end) continue;
    const double stretches = plan.joints[i].anchor.x < 1 ? middle * end_lifts / 2 : end * end_lifts;
    EXPECT_NEAR(check.joints[i].N / stretches, 1, 1e-3) << plan.joints[i].name;
    ++springs;
  }
  EXPECT_EQ(springs, 2);
}

// A bar of 4 m that is cut at 3 m and then at 1 m has pieces of 1, 2 and 1 m, named from its beginning.
TEST(Making, ABodyIsCutWhereALineCrossesIt) {
  SceneDef scene = with_beam(empty_scene(), {{-2, 3}, {2, 3}}, {});
  scene = with_cut(scene, {{1, 2}, {1, 4}});
  scene = with_cut(scene, {{-1, 4}, {-1, 2}});
  const Plan plan = calibrate(scene);
  ASSERT_EQ(plan.pieces.size(), 4u);  // with the floor
  for (const auto& [piece, middle] : {std::pair{1u, -1.5}, std::pair{2u, 0.}, std::pair{3u, 1.5}}) {
    EXPECT_NEAR(plan.pieces[piece].center.x, middle, 1e-9);
    EXPECT_NEAR(plan.pieces[piece].mass / (7850 * 0.2 * 0.1 * (piece == 2 ? 2 : 1)), 1, 1e-9);
  }
  EXPECT_THROW(with_cut(scene, {{0, 5}, {0, 4}}), InvalidInput);                  // nothing there
  EXPECT_THROW(calibrate(with_cut(scene, {{0, 3.05}, {0, 2.8}})), InvalidInput);  // begins in it
}

TEST(Making, LoadsPullWhereTheyAreToldAndGrow) {
  const LoadStyle style{.force = 2e3, .direction = -60, .ramp = 3};
  EXPECT_NEAR(style.vector().x, 1e3, 1e-9);
  EXPECT_NEAR(style.vector().y, -1e3 * std::sqrt(3), 1e-9);
  EXPECT_EQ(LoadStyle{}.vector().x, 0);
  SceneDef scene = with_load(gate(), {0, 3}, style.vector(), style.ramp);
  EXPECT_EQ(scene.loads.at(0).ramp, 3);
  scene = with_load(scene, {0, 3}, style.vector(), 4);  // another one
  EXPECT_EQ(scene.loads.at(0).ramp, 4);
  EXPECT_TRUE(with_load(scene, {0, 3}, style.vector(), 4).loads.empty());  // once more
}

TEST(Making, LinesJoinTwoBodies) {
  SceneDef scene = with_line(gate(), {{0, 3}, {-2, 1}}, {.kind = LineStyle::Kind::strut});
  EXPECT_EQ(scene.joints.back().a, "beam3");
  EXPECT_EQ(scene.joints.back().b, "beam1");
  EXPECT_EQ(scene.joints.back().carries, Carries::compression);
  scene = with_line(scene, {{0, 3}, {0, 0}},
                    {.kind = LineStyle::Kind::jack, .force = 2e3, .stroke = -1, .speed = 0.2});
  ASSERT_TRUE(scene.joints.back().drive);
  EXPECT_EQ(scene.joints.back().b, "floor");
  EXPECT_EQ(*scene.joints.back().drive->position, 2);
  EXPECT_EQ(scene.joints.back().drive->cap, 2e3);
  EXPECT_NO_THROW(calibrate(scene));
  const SceneDef winch = with_line(scene, {{1, 3}, {1, 0}}, {.kind = LineStyle::Kind::winch, .stroke = -1});
  EXPECT_EQ(winch.joints.back().carries, Carries::tension);
  EXPECT_EQ(*winch.joints.back().drive->position, 2);
  EXPECT_NO_THROW(calibrate(winch));
  EXPECT_THROW(with_line(scene, {{0, 3}, {1, 3}}, {}), InvalidInput);          // one body
  EXPECT_THROW(with_line(scene, {{0, 3}, {9, 9}}, {}), InvalidInput);          // nothing there
  EXPECT_EQ(without(scene, {0, 1.5}).joints.size(), scene.joints.size() - 1);  // in its midst
  EXPECT_EQ(parse_scene(scene_text(scene)).joints.size(), scene.joints.size());
}

TEST(Making, ProfilesByTheirNames) {
  BeamStyle style;
  style.profile = "ipe200";
  SceneDef scene = with_beam(empty_scene(), {{-2, 3}, {2, 3}}, style);
  EXPECT_EQ(scene.bodies[1].profile_name, "IPE 200");
  const auto W_plastic = [](const SceneDef& of) { return calibrate(of).joints.at(0).M / 355e6; };
  EXPECT_NEAR(W_plastic(scene) / 220.6e-6, 1, 1e-3);  // tables of EN 10365: W_pl,y of IPE 200
  style.profile = "HEB 200";
  scene = with_style(scene, "beam1", style);
  EXPECT_NEAR(W_plastic(scene) / 642.5e-6, 1, 1e-3);
  style.profile.clear();
  scene = with_style(scene, "beam1", style);
  EXPECT_NEAR(W_plastic(scene) / (0.1 * 0.2 * 0.2 / 4), 1, 1e-6);
  style.profile = "IPE 13";
  EXPECT_THROW(with_style(scene, "beam1", style), InvalidInput);
  EXPECT_THROW(with_style(scene, "floor", {}), InvalidInput);
}

TEST(Making, WhatIsDeletedLeavesNothingThatNamesIt) {
  SceneDef scene = with_next_support(with_load(gate(), {0, 3}, {0, -1}), {-2, 3}, 0);
  scene = without(scene, {0, 3});
  EXPECT_TRUE(scene.loads.empty());
  EXPECT_EQ(scene.bodies.size(), 4u);
  ASSERT_EQ(scene.supports[0].body, "beam1");
  scene = without_body(scene, "beam1");
  EXPECT_EQ(scene.supports.at(0).body, "beam3");  // which ends there too
  EXPECT_EQ(scene.joints.size(), 2u);
  EXPECT_NO_THROW(calibrate(scene));
  EXPECT_THROW(without(scene, {9, 9}), InvalidInput);
}

TEST(Making, ReadsBackFromItsFile) {
  const SceneDef scene = with_node_moved(gate(), {-2, 3}, {-2.3, 4.1});
  const SceneDef back = parse_scene(scene_text(scene));
  for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
    EXPECT_NEAR(length(axis_of(back.bodies[i])->to - axis_of(scene.bodies[i])->to), 0, node_size);
  }
  EXPECT_EQ(nodes(back).size(), nodes(scene).size());
}

}  // namespace
}  // namespace ductile::viewer
