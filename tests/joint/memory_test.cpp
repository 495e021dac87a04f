// What a collapse takes of memory, and from where.
#include "ductile/memory.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "allocations.h"
#include "eventful.h"
#include "structures.h"

namespace ductile {
namespace {

// A frame of 36 bays, a hundred times as heavy as steel for its strength, loses the columns of its ground
// floor. What falls is formed anew in the first second; what breaks off later has the memory of what it was a
// part of.
TEST(MemoryOfComponents, OfACollapseIsTakenInItsFirstSecond) {
  const bench::Layout layout = bench::heavy_frame(6, 6, 100);
  bench::Built frame(layout, bench::Built::ours, 10);
  frame.run(0.5);
  bench::take_ground_floor(frame, layout);
  const std::size_t joints = frame.structure->joints().size();
  const long before = allocations();
  frame.run(1);
  const long then = allocations();
  frame.run(5);
  const std::size_t broken = joints - frame.structure->joints().size();
  EXPECT_GT(broken, 100U);
  EXPECT_LE(then - before, static_cast<long>(broken));
  EXPECT_EQ(allocations() - then, 0);
}

// A beam breaks in the middle, and a third piece is hung on what is left: all of that in memory of the
// game's, and all of it given back with the structure.
TEST(MemoryOfComponents, ComesFromWhereTheGameSays) {
  struct Source {
    long out = 0, taken = 0;
  } source;
  MemorySource memory{[](std::size_t bytes, void* user) {
                        static_cast<Source*>(user)->out += static_cast<long>(bytes);
                        ++static_cast<Source*>(user)->taken;
                        return std::malloc(bytes);
                      },
                      [](void* block, std::size_t bytes, void* user) {
                        static_cast<Source*>(user)->out -= static_cast<long>(bytes);
                        std::free(block);
                      },
                      &source};
  b2World world({0, -10});
  {
    Structure structure(world, {.memory = memory});
    b2Body* last = add_box(world, {.x = -0.5, .type = b2_staticBody, .group = -1});
    const auto hang = [&](double x) {
      b2Body* piece = add_box(world, {.x = x + 0.5, .group = -1});
      ElasticPlasticJointDef def;
      def.Initialize(last, piece, vec(x, 0), {1, 0});
      def.rows[rotation] = {.stiffness = 1e8, .cap = 2e5, .cap_reverse = 2e5};
      def.max_rotation = 0.1;
      structure.create_joint(def);
      last = piece;
    };
    for (int i = 0; i < 8; ++i) hang(i);
    for (int i = 0; i < 120; ++i) {
      const long before = allocations();
      world.Step(1 / 60.0f, 8, 3);
      EXPECT_LE(allocations() - before, i == 0 || i == 61 ? 2 : 0) << i;  // the list of them
      structure.update();
      if (i == 60) {
        EXPECT_LT(structure.joints().size(), 8U);
        last = structure.joints().front()->GetBodyB();
        hang(1);
      }
    }
    EXPECT_GT(source.taken, 0);
    Snapshot snapshot;
    snapshot.save(world);
    // What is restored grows in the game's memory as what was formed: a piece more is one list more.
    snapshot.restore(world);
    hang(2);
    const long before = allocations();
    world.Step(1 / 60.0f, 8, 3);
    EXPECT_LE(allocations() - before, 2);
  }
  EXPECT_EQ(source.out, 0);
}

}  // namespace
}  // namespace ductile
