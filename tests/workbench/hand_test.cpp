#include "hand.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "ductile/files.h"
#include "scenes.h"

namespace ductile::viewer {
namespace {

/// A cantilever on the bench, at rest at its first step, seen by a camera of 100 px per m.
class HandTest : public testing::Test {
 protected:
  HandTest() {
    const auto file = std::filesystem::temp_directory_path() /
                      ("ductile_hand_" + std::to_string(::getpid()) + ".scene.json");
    write_text(file, scene_text(cantilever(4, unlimited)));
    bench.open(file);
    std::filesystem::remove(file);
    camera.screen = {{100, 50}, {1300, 650}};
    camera.centre = {5, 0.5};
    camera.scale = 100;
  }
  void drag(Point from, Point to, Hand::Keys keys = {}) {
    hand.press(camera, camera.to_screen(from), keys);
    hand.move(bench, camera, camera.to_screen(to));
    hand.release(bench, camera, camera.to_screen(to));
  }
  std::vector<std::string> selected() const {
    std::vector<std::string> names;
    for (const std::size_t i : bench.selected) names.push_back(bench.plan().joints[i].name);
    return names;
  }

  Workbench bench;
  Camera camera;
  Hand hand;
};

using Names = std::vector<std::string>;

TEST_F(HandTest, AClickSelectsTheJointThatIsWithinReach) {
  drag({2.5, 0.5}, {2.5, 0.5});
  EXPECT_EQ(selected(), Names{"bar/0-bar/1"});
  drag({5.1, 0.5}, {5.1, 0.5});  // 10 px beside it
  EXPECT_EQ(selected(), Names{"bar/1-bar/2"});
  drag({7.5, 0.5}, {7.5, 0.52}, {.shift = true});  // 2 px are no drag
  EXPECT_EQ(selected(), (Names{"bar/1-bar/2", "bar/2-bar/3"}));
  drag({6, 0.5}, {6, 0.5});
  EXPECT_EQ(selected().size(), 2u) << "a body is chosen, the joints stay";
  EXPECT_EQ(bench.body, 1u);
  drag({6, 3}, {6, 3});
  EXPECT_TRUE(selected().empty());
}

TEST_F(HandTest, ABoxIsDrawnFromEmptyGroundOrWithCtrl) {
  drag({2, -0.5}, {6, 1.5});
  EXPECT_EQ(selected(), (Names{"bar/0-bar/1", "bar/1-bar/2"}));
  drag({6, 0.2}, {8, 0.8}, {.ctrl = true});
  EXPECT_EQ(selected(), Names{"bar/2-bar/3"});
  EXPECT_TRUE(bench.run().acts().empty()) << "no body was moved";
}

TEST_F(HandTest, ADragFromABodyPullsIt) {
  hand.press(camera, camera.to_screen({9, 0.5}), {});
  hand.move(bench, camera, camera.to_screen({9, 1.5}));
  EXPECT_EQ(hand.doing(), Hand::Doing::dragging);
  hand.move(bench, camera, camera.to_screen({9, 2}));
  hand.release(bench, camera, camera.to_screen({9, 2}));
  const auto& acts = bench.run().acts();
  ASSERT_EQ(acts.size(), 4u);
  EXPECT_EQ(std::get<act::Grab>(acts[0].act).piece, 4);
  EXPECT_NEAR(std::get<act::Pull>(acts[2].act).to.y, 2, 1e-9);
  EXPECT_TRUE(std::holds_alternative<act::Release>(acts[3].act));
  drag({-0.5, 0}, {-0.5, 3});  // the wall stays where it is: a box
  EXPECT_EQ(bench.run().acts().size(), 4u);
}

TEST_F(HandTest, WhatWasThrownIsDraggedToo) {
  hand.size = 1;
  hand.put(bench, {5, 3});
  hand.press(camera, camera.to_screen({5.4, 3.4}), {});  // in the square's corner, outside of a disc
  hand.move(bench, camera, camera.to_screen({5.4, 4}));
  EXPECT_EQ(std::get<act::Grab>(bench.run().acts()[1].act).thrown, 0);
}

TEST_F(HandTest, ABombGoesAsFarAsItWasPulledInAQuarterOfASecond) {
  hand.mass = 7;
  drag({5, 3}, {4, 2.5}, {.shift = true});
  const auto& thrown = std::get<act::Throw>(bench.run().acts().back().act);
  EXPECT_EQ(thrown.at, (Point{5, 3}));
  EXPECT_NEAR(thrown.velocity.x, 4, 1e-9);
  EXPECT_NEAR(thrown.velocity.y, 2, 1e-9);
  EXPECT_EQ(thrown.mass, 7);
}

TEST_F(HandTest, ABombHitsWhatItIsThrownAt) {
  hand.speed = 20;
  hand.throw_at(bench, camera, {5, 0.5});
  const auto& thrown = std::get<act::Throw>(bench.run().acts().back().act);
  const Point way = Point{5, 0.5} - thrown.at;
  EXPECT_NEAR(cross(way, thrown.velocity), 0, 1e-9 * length(way) * 20);
  EXPECT_GT(dot(way, thrown.velocity), 0);
  EXPECT_NEAR(length(thrown.velocity), 20, 1e-9);
}

TEST_F(HandTest, ThrowsSuitTheScene) {
  hand.suit(bench.plan());  // 80 t, 10 m long
  hand.speed = 7;
  hand.suit(calibrate(cantilever(1, 1)), true);
  EXPECT_EQ(hand.speed, 7);  // as the user has it
  hand.suit(bench.plan());
  EXPECT_EQ(hand.mass, 8000);
  EXPECT_EQ(hand.size, 0.5);
  EXPECT_EQ(hand.speed, 30);  // 2 √(2·10·10) = 28
}

TEST(Camera, ZoomKeepsWhatIsUnderThePointer) {
  Camera camera{.screen = {{240, 0}, {940, 600}}, .centre = {3, 4}, .scale = 20};
  const Point pointer{300, 500}, under = camera.to_world(pointer);
  camera.zoom(1.5, pointer);
  EXPECT_NEAR(camera.to_screen(under).x, pointer.x, 1e-9);
  EXPECT_NEAR(camera.to_screen(under).y, pointer.y, 1e-9);
  EXPECT_EQ(camera.scale, 30);
  camera.show({{0, 0}, {10, 1}});
  EXPECT_EQ(camera.to_screen({5, 0.5}), camera.screen.middle());
  EXPECT_GT(camera.to_screen({0, 0}).x, 240);
  EXPECT_LT(camera.to_screen({10, 0}).x, 940);
  EXPECT_GT(camera.to_screen({0, 0}).y, camera.to_screen({0, 1}).y) << "y is up in the world";
}

}  // namespace
}  // namespace ductile::viewer
