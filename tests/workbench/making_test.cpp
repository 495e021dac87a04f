// Making scenes: what is joined to what, and the tools that do it.
#include "making.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ductile/design.h"
#include "ductile/files.h"
#include "maker.h"

namespace ductile::viewer {
namespace {

using Tool = Maker::Tool;

/// Two posts on the floor that carry a beam of 4 m, all pinned.
SceneDef gate() {
  const BeamStyle style;
  SceneDef scene = with_beam(empty_scene(), {{-2, 0}, {-2, 3}}, style);
  scene = with_beam(scene, {{2, 0}, {2, 3}}, style);
  return with_beam(scene, {{-2, 3}, {2, 3}}, style);
}

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

// A truss of two equal bars on hinges, half-span a and rise h, with a force P at its top: N = −P/(2 sin α) in
// both, and the bars' own weight is left out by making them light.
TEST(Making, TwoBarsCarryALoadAsStaticsSays) {
  BeamStyle style;
  style.material.density = 1e-6;
  const Point left{-3, 1}, right{3, 1}, top{0, 5};
  SceneDef scene = with_beam(empty_scene(), {left, top}, style);
  scene = with_beam(scene, {top, right}, style);
  scene = with_next_support(with_next_support(scene, left), right);
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
  const auto rows = [&] {
    const SupportDef& s = scene.supports.at(0);
    return std::array{s.fix_x, s.fix_y, s.fix_angle};
  };
  EXPECT_EQ((scene = with_next_support(scene, foot), rows()), (std::array{true, true, false}));
  EXPECT_EQ((scene = with_next_support(scene, foot), rows()), (std::array{false, true, false}));
  EXPECT_EQ((scene = with_next_support(scene, foot), rows()), (std::array{true, true, true}));
  EXPECT_TRUE(with_next_support(scene, foot).supports.empty());
  scene = with_load(scene, {0, 3}, {0, -1});  // within the span
  scene = with_load(scene, {0, 3}, {0, -2});
  ASSERT_EQ(scene.loads.size(), 1u);
  EXPECT_EQ(scene.loads[0].force.y, -2);
  EXPECT_EQ(scene.loads[0].body, "beam3");
  EXPECT_TRUE(with_load(scene, {0, 3}, {}).loads.empty());
  EXPECT_THROW(with_next_support(scene, {0, 2}), InvalidInput);
  EXPECT_THROW(with_load(scene, {0, 2}, {0, -1}), InvalidInput);
}

TEST(Making, AMovedNodeTakesItsBeamsSupportsAndLoadsAlong) {
  SceneDef scene = with_load(gate(), {0, 3}, {0, -1});
  scene = with_next_support(scene, {-2, 3});
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

TEST(Making, WhatIsDeletedLeavesNothingThatNamesIt) {
  SceneDef scene = with_next_support(with_load(gate(), {0, 3}, {0, -1}), {-2, 3});
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

TEST(Maker, DrawsOnTheGridAndFromNodeToNodeInOneEdit) {
  Workbench bench;
  Maker maker;
  maker.choose(bench, Tool::beam);
  EXPECT_FALSE(bench.playing);
  maker.point(bench, {-1.9, 0.1}, 0.2);
  EXPECT_EQ(length(maker.cursor() - Point{-2, 0}), 0);
  maker.press(bench);
  for (const double y : {1., 2., 3.}) maker.point(bench, {-2.1, y}, 0.2);
  EXPECT_EQ(bench.scene().bodies.size(), 2u);  // on the bench while it is drawn
  maker.release(bench);
  maker.point(bench, {-1.9, 2.9}, 0.2);  // snaps to the node
  EXPECT_NEAR(length(maker.cursor() - Point{-2, 3}), 0, node_size);
  bench.undo();
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
  EXPECT_FALSE(bench.can_undo());
  bench.redo();
  EXPECT_EQ(bench.scene().bodies.size(), 2u);
}

TEST(Maker, GivesUpWithoutATrace) {
  Workbench bench;
  Maker maker;
  maker.choose(bench, Tool::beam);
  maker.press(bench);
  maker.step(bench, 3, 2);
  maker.cancel(bench);
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
  maker.press(bench);
  maker.release(bench);  // in one place: nothing
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
  maker.press(bench);
  maker.step(bench, 3, 2);
  bench.undo();  // comes between
  maker.step(bench, 1, 0);
  maker.release(bench);
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
  EXPECT_TRUE(bench.message.empty());
}

TEST(Maker, SaysWhatTheStaticCheckSays) {
  Workbench bench;
  Maker maker;
  maker.choose(bench, Tool::beam);
  maker.point(bench, {-2, 3}, 0.1);
  maker.press(bench);
  maker.point(bench, {2, 3}, 0.1);
  maker.release(bench);
  const std::string falls = bench.verdict();
  EXPECT_FALSE(falls.empty());
  maker.choose(bench, Tool::support);
  for (const double x : {-2., 2.}) {
    maker.point(bench, {x, 3}, 0.1);
    maker.press(bench);
  }
  EXPECT_TRUE(bench.verdict().starts_with("yields at")) << falls << bench.verdict();
  const double reserve = static_check(bench.plan()).reserve;
  EXPECT_GT(bench.frame().joints[0].usage.M + bench.frame().joints[1].usage.M, 0);  // though no step was made
  maker.choose(bench, Tool::load);
  maker.point(bench, {0, 3}, 0.1);
  maker.press(bench);
  EXPECT_LT(static_check(bench.plan()).reserve, reserve);
  maker.press(bench);  // the same once more takes it away
  EXPECT_TRUE(bench.scene().loads.empty());
  maker.point(bench, {0, 9}, 0.1);
  maker.press(bench);
  EXPECT_NE(bench.message.find("no beam"), std::string::npos);
  maker.choose(bench, Tool::none);
  EXPECT_TRUE(bench.verdict().empty());
}

TEST(Maker, FindsNodesByKeys) {
  Workbench bench;
  Maker maker;
  bench.edit(gate());
  maker.choose(bench, Tool::support);
  maker.next_node(bench, 1);  // from (0, 0)
  EXPECT_EQ(maker.cursor().x, 2);
  maker.next_node(bench, 1);
  maker.next_node(bench, 1);
  EXPECT_EQ(maker.cursor().x, -2);
  EXPECT_EQ(maker.cursor().y, 0);
  maker.next_node(bench, -1);
  EXPECT_NEAR(length(maker.cursor() - Point{2, 3}), 0, node_size);
}

TEST(Workbench, ANewSceneTakesNoFilesPlace) {
  Workbench bench;
  ASSERT_TRUE(bench.try_new());
  EXPECT_FALSE(std::filesystem::exists(bench.file()));
  EXPECT_FALSE(bench.changed());
  bench.edit(gate());
  EXPECT_FALSE(bench.try_new());  // edits would be lost
  EXPECT_EQ(bench.scene().bodies.size(), 4u);
  EXPECT_TRUE(bench.try_new());
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
}

}  // namespace
}  // namespace ductile::viewer
