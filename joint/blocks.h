// The blocks of b2World's allocator: a joint of ours and the watch of a world live in blocks that were asked
// for by something smaller. As in b2_block_allocator.cpp of Box2D 2.4.1.
#pragma once

#include <cstddef>

namespace ductile {

inline constexpr std::size_t chunk_size = std::size_t{16} * 1024;
inline constexpr std::size_t block_sizes[] = {16,  32,  64,  96,  128, 160, 192,
                                              224, 256, 320, 384, 448, 512, 640};

/// The block that an object of that many bytes is given; 0: it lies elsewhere.
constexpr std::size_t block_of(std::size_t bytes) {
  for (const std::size_t size : block_sizes) {
    if (bytes <= size) return size;
  }
  return 0;
}

}  // namespace ductile
