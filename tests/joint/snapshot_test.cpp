// A world that is brought back runs on as it did: to the bit, whatever happened in between.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "bodies.h"
#include "eventful.h"

namespace ductile {
namespace {

using eventful::Kind;
using eventful::kinds;
using eventful::Scene;

class Snapshots : public testing::TestWithParam<std::size_t> {};

TEST_P(Snapshots, RunOnAsTheWorldDid) {
  const Kind& kind = kinds[GetParam()];
  std::uint64_t undisturbed;
  {
    Scene scene;
    kind.build(scene);
    scene.run(kind.until_save);
    undisturbed = scene.run(300);
  }
  Scene scene;
  kind.build(scene);
  scene.run(kind.until_save);
  Snapshot start, later;
  start.save(scene.world);
  const std::size_t joints = scene.structure.joints().size();
  ASSERT_EQ(scene.run(300), undisturbed);
  EXPECT_EQ(scene.structure.joints().size() < joints, kind.breaks);
  later.save(scene.world);
  const std::uint64_t after = scene.run(50);
  for (int again = 0; again < 2; ++again) {
    start.restore(scene.world);
    scene.step = kind.until_save;
    ASSERT_EQ(scene.structure.joints().size(), joints);
    ASSERT_EQ(scene.run(300), undisturbed) << again;
  }
  // And forward.
  start.restore(scene.world);
  later.restore(scene.world);
  scene.step = kind.until_save + 300;
  EXPECT_EQ(scene.run(50), after);
}

INSTANTIATE_TEST_SUITE_P(All, Snapshots, testing::Range(std::size_t{0}, kinds.size()),
                         [](const auto& info) { return kinds[info.param].name; });

// Eight steps back and nine ahead, as a game does whose players are far apart.
TEST(Snapshot, OfEveryFrame) {
  const auto build = [](Scene& s) { kinds.back().build(s); };
  Scene straight, rolled;
  build(straight), build(rolled);
  std::vector<Snapshot> ring(8);
  for (int frame = 0; frame < 120; ++frame) {
    if (frame >= 8) {
      ring[static_cast<std::size_t>(frame % 8)].restore(rolled.world);
      rolled.step = frame - 8;
      rolled.run(8);
    }
    ring[static_cast<std::size_t>(frame % 8)].save(rolled.world);
    ASSERT_EQ(rolled.run(1), straight.run(1)) << frame;
  }
}

TEST(Snapshot, BetweenAStepAndItsEvents) {
  Scene scene;
  kinds[3].build(scene);
  int events = 0;
  scene.structure.on_event([&](const JointEvent& e) {
    ++events;
    EXPECT_NE(e.joint->GetBodyA(), nullptr);
  });
  Snapshot snapshot;
  while (events == 0) {
    scene.world.Step(1.0f / 60, 8, 3);
    snapshot.save(scene.world);
    scene.structure.update();
  }
  const int told = events;
  snapshot.restore(scene.world);
  scene.structure.update();
  EXPECT_EQ(events, 2 * told);
}

TEST(Snapshot, GoesBackOnlyWhereItCame) {
  Scene scene, other;
  kinds[0].build(scene);
  b2ChainShape line;
  const b2Vec2 points[] = {{0, -9}, {5, -9}, {9, -8}};
  line.CreateChain(points, 3, {-1, -9}, {10, -8});
  b2Body* ground = add_box(scene.world, {.y = -20, .type = b2_staticBody});
  b2Fixture* chain = ground->CreateFixture(&line, 0);
  scene.run(5);
  Snapshot snapshot;
  snapshot.save(scene.world);
  const std::uint64_t once = scene.run(20);
  EXPECT_THROW(snapshot.restore(other.world), std::logic_error);
  {
    Structure third(scene.world);
    EXPECT_THROW(snapshot.restore(scene.world), std::logic_error);
  }
  snapshot.restore(scene.world);
  EXPECT_EQ(scene.run(20), once);
  struct Listener : b2ContactListener {
    void BeginContact(b2Contact*) override {
      EXPECT_THROW(snapshot->save(*world), std::logic_error);
      EXPECT_THROW(snapshot->restore(*world), std::logic_error);
      ++called;
    }
    Snapshot* snapshot;
    b2World* world;
    int called = 0;
  } listener;
  listener.snapshot = &snapshot, listener.world = &scene.world;
  scene.world.SetContactListener(&listener);
  add_box(scene.world, {.x = 20, .type = b2_staticBody, .group = 0});
  add_box(scene.world, {.x = 20, .y = 0.5, .group = 0});
  scene.run(2);
  EXPECT_GT(listener.called, 0);
  snapshot.restore(scene.world);
  EXPECT_EQ(scene.run(20), once);
  ground->DestroyFixture(chain);
  EXPECT_THROW(snapshot.restore(scene.world), std::logic_error);
}

// The next level's world and structure may be where the last one's were.
TEST(Snapshot, IsOfItsOwnWorldAlone) {
  std::optional<b2World> world;
  std::optional<Structure> structure;
  const auto make = [&] {
    world.emplace(b2Vec2{0, -10});
    structure.emplace(*world);
    b2Body *wall = add_box(*world, {.type = b2_staticBody}), *box = add_box(*world, {.x = 1});
    ElasticPlasticJointDef def;
    def.Initialize(wall, box, {0.5f, 0}, {1, 0});
    structure->create_joint(def);
  };
  make();
  Snapshot snapshot;
  snapshot.save(*world);
  structure.reset();
  world.reset();
  b2World other({0, 0});  // takes the memory
  add_box(other, {});
  make();
  EXPECT_THROW(snapshot.restore(*world), std::logic_error);
  world->Step(1 / 60.0f, 8, 3);
  structure->update();
}

}  // namespace
}  // namespace ductile
