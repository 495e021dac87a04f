// The tools that make things, the cursor that they are moved by, and what becomes of the scene.
#include "maker.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>

#include "ductile/design.h"
#include "ductile/files.h"
#include "exporting.h"
#include "gate.h"

namespace ductile::viewer {
namespace {

using Tool = Maker::Tool;

void drag(Maker& maker, Workbench& bench, Tool tool, Point from, Point to) {
  maker.choose(bench, tool);
  maker.point(bench, from, 0.1);
  maker.press(bench);
  maker.point(bench, to, 0.1);
  maker.release(bench);
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

// While something is drawn its joints have no dampers, which the static check does not need; what is let go
// has.
TEST(Maker, WhatIsLetGoIsDamped) {
  Workbench bench;
  Maker maker;
  maker.choose(bench, Tool::beam);
  maker.point(bench, {-2, 0}, 0.1);
  maker.press(bench);
  maker.point(bench, {-2, 3}, 0.1);
  EXPECT_EQ(bench.plan().joints.at(0).damping_ratio, 0);
  bench.step_by(1);  // played while it is drawn
  EXPECT_GT(bench.plan().joints.at(0).damping_ratio, 0);
  bench.restart();
  bench.undo();
  maker.press(bench);
  maker.point(bench, {-1, 3}, 0.1);
  maker.release(bench);
  EXPECT_GT(bench.plan().joints.at(0).damping_ratio, 0);
  EXPECT_GT(bench.plan().joints.at(0).damping_frequency, 0);
  EXPECT_GT(parse_scene(scene_text(bench.scene())).bodies.at(1).material->damping_ratio, 0);
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

TEST(Maker, DrawsAPolygonCornerByCorner) {
  Workbench bench;
  Maker maker;
  maker.choose(bench, Tool::block);
  const auto click = [&](Point at) {
    maker.point(bench, at, 0.1);
    maker.press(bench);
    maker.release(bench);
  };
  for (const Point p : {Point{-3, 0}, Point{-1, 0}, Point{-2, 2}}) click(p);
  EXPECT_EQ(maker.corners().size(), 3u);
  maker.cancel(bench);
  EXPECT_TRUE(maker.corners().empty());
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
  for (const Point p : {Point{-3, 0}, Point{-1, 0}, Point{-2, 2}, Point{-2.05, 2.03}})
    click(p);  // its last once more
  ASSERT_EQ(bench.scene().bodies.size(), 2u);
  EXPECT_EQ(bench.scene().bodies[1].outline.outer.size(), 3u);
  EXPECT_TRUE(maker.corners().empty());
  for (const Point p : {Point{3, 0}, Point{1, 0}, Point{2, 2}, Point{2, 3}, Point{3.05, 0}})
    click(p);  // its first
  ASSERT_EQ(bench.scene().bodies.size(), 3u);
  EXPECT_EQ(bench.scene().bodies[2].outline.outer.size(), 4u);
  bench.undo();
  EXPECT_EQ(bench.scene().bodies.size(), 2u);
}

TEST(Maker, SaysWhatTheStaticCheckSays) {
  Workbench bench;
  Maker maker;
  drag(maker, bench, Tool::beam, {-2, 3}, {2, 3});
  const std::string falls = bench.verdict();
  EXPECT_FALSE(falls.empty());
  maker.choose(bench, Tool::support);
  for (const double x : {-2., 2.}) {
    maker.point(bench, {x, 3}, 0.1);
    maker.press(bench);
  }
  EXPECT_TRUE(bench.verdict().starts_with("yields at")) << falls << bench.verdict();
  EXPECT_TRUE(bench.verdict().ends_with("; 628 kg"))
      << bench.verdict();  // 4 m of 0.2 m by 0.1 m of 7850 kg/m³
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
  EXPECT_NE(bench.message.find("nothing here"), std::string::npos);
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

TEST(Maker, CopiesMirrorsTurnsAndMovesWhatIsChosen) {
  Workbench bench;
  Maker maker;
  bench.edit(gate());
  maker.choose(bench, Tool::paste);
  maker.press(bench);
  EXPECT_NE(bench.message.find("Nothing is chosen"), std::string::npos);
  drag(maker, bench, Tool::choose, {-2.5, -0.5}, {2.5, 3.5});
  EXPECT_EQ(maker.chosen(bench).size(), 3u);
  EXPECT_TRUE(maker.copy(bench));
  drag(maker, bench, Tool::paste, {4, 0}, {5, 0});
  EXPECT_EQ(bench.scene().bodies.size(), 7u);
  EXPECT_EQ(axis_of(bench.scene().bodies[4])->from.x, 5);
  EXPECT_EQ(maker.chosen(bench).size(), 3u);
  EXPECT_EQ(maker.chosen(bench)[0], "beam4");
  bench.undo();
  EXPECT_EQ(bench.scene().bodies.size(), 4u);
  bench.redo();
  drag(maker, bench, Tool::mirror, {5, 0}, {5, 0});  // in its own left post: two more
  EXPECT_EQ(bench.scene().bodies.size(), 9u);
  bench.undo();
  drag(maker, bench, Tool::turn, {7, 3}, {7, 3});
  EXPECT_EQ(bench.scene().bodies.size(), 7u);
  EXPECT_EQ(maker.chosen(bench)[0], "beam4");
  EXPECT_NEAR(length(axis_of(bench.scene().bodies[4])->from - Point{10, 1}), 0, 1e-12);
  EXPECT_NEAR(length(axis_of(bench.scene().bodies[4])->to - Point{7, 1}), 0, 1e-12);
  bench.undo();
  // All that is chosen goes with the one that is dragged.
  drag(maker, bench, Tool::move, {7, 3}, {7, 4});  // by a beam, not by a node
  EXPECT_EQ(axis_of(bench.scene().bodies[4])->from.y, 1);
  EXPECT_EQ(axis_of(bench.scene().bodies[6])->to.y, 4);
  bench.undo();
  EXPECT_TRUE(maker.remove_chosen(bench));
  EXPECT_EQ(bench.scene().bodies.size(), 4u);
  EXPECT_FALSE(maker.remove_chosen(bench));
}

// A gate of 4 by 3 m turns about the middle of its box, (0, 1.5), by multiples of 5°, in one edit.
TEST(Maker, TurnsWhatIsChosenByAGrip) {
  Workbench bench;
  Maker maker;
  bench.edit(gate());
  EXPECT_FALSE(maker.turn_grip(bench, 1));
  drag(maker, bench, Tool::choose, {-2.5, -0.5}, {2.5, 3.5});
  const auto grip = maker.turn_grip(bench, 1);
  ASSERT_TRUE(grip);
  EXPECT_NEAR(length(grip->about - Point{0, 1.5}), 0, 1e-12);
  EXPECT_NEAR(length(grip->at - Point{0, 4}), 0, 1e-12);
  maker.take_grip(bench, *grip);
  const auto aim = [&](double degrees) {
    maker.point(bench, grip->about + Rotation(degrees * std::numbers::pi / 180) * Point{0, 9}, 0.1);
  };
  for (const double degrees : {10., 20., 31.}) aim(degrees);
  EXPECT_EQ(maker.turning(), 30);
  maker.release(bench);
  EXPECT_FALSE(maker.turning());
  const Point foot = grip->about + Rotation(std::numbers::pi / 6) * Point{-2, -1.5};
  EXPECT_NEAR(length(axis_of(*body_named(bench.scene(), "beam1"))->from - foot), 0, 1e-12);
  EXPECT_EQ(maker.chosen(bench).size(), 3u);
  bench.undo();
  EXPECT_EQ(axis_of(*body_named(bench.scene(), "beam1"))->from, (Point{-2, 0}));
  maker.take_grip(bench, *grip);  // there and back: nothing
  aim(50);
  aim(1);
  maker.release(bench);
  EXPECT_EQ(axis_of(*body_named(bench.scene(), "beam1"))->from, (Point{-2, 0}));
  maker.take_grip(bench, *grip);
  aim(50);
  maker.cancel(bench);
  EXPECT_EQ(axis_of(*body_named(bench.scene(), "beam1"))->from, (Point{-2, 0}));
  EXPECT_EQ(bench.scene().bodies.size(), 4u);
}

TEST(Maker, MovesABodyByThePointWhereItIsHeld) {
  Workbench bench;
  bench.open(DUCTILE_SOURCE_DIR "/scenes/cantilever.scene.json");
  ASSERT_FALSE(axis_of(bench.scene().bodies[1]));
  const Point at{1, 0.5};
  Maker maker;
  maker.choose(bench, Tool::support);
  maker.point(bench, at, 0.01);
  maker.press(bench);
  ASSERT_EQ(bench.scene().supports.size(), 1u) << bench.message;
  maker.choose(bench, Tool::move);
  maker.press(bench);
  maker.step(bench, 0, 1);
  maker.release(bench);
  EXPECT_EQ(bench.scene().supports.at(0).at.y, at.y + 0.5) << bench.message;
}

TEST(Maker, SnapsToABeamThatTheGridMisses) {
  Workbench bench;
  Maker maker;
  drag(maker, bench, Tool::beam, {-1, 1}, {2, 2});
  maker.choose(bench, Tool::load);
  maker.point(bench, {0.25, 1.45}, 0.2);
  EXPECT_NEAR(axis_of(bench.scene().bodies[1])->distance(maker.cursor()), 0, 1e-12);
  maker.press(bench);
  EXPECT_EQ(bench.scene().loads.size(), 1u) << bench.message;
  maker.choose(bench, Tool::remove);
  maker.point(bench, {1.1, 1.75}, 0.2);
  maker.press(bench);
  EXPECT_EQ(bench.scene().bodies.size(), 1u);
}

TEST(Export, EveryFormatOfEveryMadeScene) {
  Workbench bench;
  bench.edit(gate());
  bench.run().go_to(5);
  for (const ExportFormat& format : export_formats()) {
    const std::string text = format.text(bench);
    EXPECT_GT(text.size(), 1000u) << format.name;
    EXPECT_NE(text.find("beam3/5"), std::string::npos) << format.name;
  }
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
