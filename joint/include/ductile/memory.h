// The source of the memory in which structures are solved.
#pragma once

#include <cstddef>

namespace ductile {

/// The source of the memory in which structures are solved, such as a step needs where joints come or break.
/// Structures ask for blocks, each twice as large as the last; memory of parts that are gone serves the next
/// parts. All of it is given back when the last structure of the world is gone. The default is operator new.
struct MemorySource {
  /// Returns so many bytes, aligned for any type, or nullptr where there are none: then std::bad_alloc is
  /// thrown, out of b2World::Step, too.
  void* (*take)(std::size_t bytes, void* user) = nullptr;
  /// Takes back memory of so many bytes that `take` returned; needed where `take` is.
  void (*give)(void* memory, std::size_t bytes, void* user) = nullptr;
  void* user = nullptr;  ///< is passed to both
};

}  // namespace ductile
