// Where the memory comes from in which structures are solved.
#pragma once

#include <cstddef>

namespace ductile {

/// Where structures have the memory from in which they are solved: what a step needs as joints come, or as
/// something breaks. They ask for blocks, each twice as large as the last, keep what is left of parts that
/// are no more for the next, and give all back when the last structure of the world is gone. As it stands, it
/// is operator new.
struct MemorySource {
  /// So many bytes, aligned for any type. nullptr says that there are none: then std::bad_alloc is thrown, be
  /// it out of b2World::Step.
  void* (*take)(std::size_t bytes, void* user) = nullptr;
  /// Back, as many bytes as were taken there; needed where `take` is.
  void (*give)(void* memory, std::size_t bytes, void* user) = nullptr;
  void* user = nullptr;  ///< what both are told
};

}  // namespace ductile
