// Memory of components.
#include "../../joint/pool.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>

namespace ductile::dynamics {
namespace {

/// What was taken and not given back, and how often.
struct Source {
  std::map<void*, std::size_t> out;
  int taken = 0;
  bool empty = false;

  MemorySource source() {
    return {[](std::size_t bytes, void* user) -> void* {
              auto& self = *static_cast<Source*>(user);
              if (self.empty) return nullptr;
              ++self.taken;
              void* memory = std::malloc(bytes);
              self.out[memory] = bytes;
              return memory;
            },
            [](void* memory, std::size_t bytes, void* user) {
              auto& self = *static_cast<Source*>(user);
              EXPECT_EQ(self.out.at(memory), bytes);
              self.out.erase(memory);
              std::free(memory);
            },
            this};
  }
};

TEST(Pool, GivesAgainWhatWasGivenBack) {
  Source source;
  {
    Pool pool(source.source());
    void* const piece = pool.take(100);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(piece) % alignof(std::max_align_t), 0U);
    EXPECT_NE(pool.take(100), piece);
    pool.give(piece, 100);
    EXPECT_EQ(pool.take(128), piece);  // of the same power of two
    EXPECT_EQ(source.taken, 1);
    std::size_t all = 0;
    for (std::size_t bytes = 1; bytes < 5000; bytes += 7)
      std::memset(pool.take(bytes), 1, bytes), all += bytes;
    EXPECT_LT(source.taken, 12);  // 1.8 MB, in blocks that double
    std::size_t held = 0;
    for (const auto& [memory, bytes] : source.out) held += bytes;
    EXPECT_LT(held, 2 * 2 * 2 * all);  // pieces, blocks and what is left of them: twice each, at most
    void* const large = pool.take(50'000'000);
    EXPECT_EQ(source.out.at(large), 50'000'000U);
    pool.give(large, 50'000'000);
    EXPECT_FALSE(source.out.contains(large));
  }
  EXPECT_TRUE(source.out.empty());
}

TEST(Pool, DividesWhatALargePieceLeaves) {
  Source source;
  Pool pool(source.source());
  pool.give(pool.take(1 << 20), 1 << 20);
  while (source.taken == 1) std::memset(pool.take(1 << 18), 1, 1 << 18);  // all of the first block
  std::size_t held = 0;
  for (const auto& [memory, bytes] : source.out) held += bytes;
  EXPECT_EQ(held, 3U << 21);  // a second block, twice as large
  const int before = source.taken;
  std::size_t small = 0;
  for (; source.taken == before; small += 1 << 10) std::memset(pool.take(1 << 10), 1, 1 << 10);
  EXPECT_GE(small, (1U << 22) - (1U << 19));
}

TEST(Pool, ThrowsWhereThereIsNone) {
  Source source;
  source.empty = true;
  Pool pool(source.source());
  EXPECT_THROW(pool.take(10), std::bad_alloc);
  EXPECT_THROW(pool.take(50'000'000), std::bad_alloc);
  source.empty = false;
  EXPECT_NO_THROW(pool.take(10));
}

// A vector stays with the pool that it was made in; a copy of it is a snapshot, which may outlive that.
TEST(Pool, HoldsVectorsThatAreMadeInIt) {
  Source source;
  Vector<int> copy, outside;
  {
    Pool pool(source.source());
    Vector<int> inside = [&] {
      const Pool::Use use(pool);
      return Vector<int>(3, 7);
    }();
    inside.resize(100'000, 8);
    outside.resize(10);
    copy = Vector<int>(inside);
    EXPECT_EQ(source.taken, 2);
    EXPECT_EQ(Pool::in_use(), nullptr);
  }
  EXPECT_TRUE(source.out.empty());
  EXPECT_EQ(copy[0] + copy.back(), 15);
}

}  // namespace
}  // namespace ductile::dynamics
