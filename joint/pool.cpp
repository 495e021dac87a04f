#include "pool.h"

#include <algorithm>
#include <new>

namespace ductile::dynamics {

void* Pool::ask(std::size_t bytes) {
  void* const memory = source_.take != nullptr ? source_.take(bytes, source_.user) : ::operator new(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void Pool::release(void* memory, std::size_t bytes) noexcept {
  if (source_.take != nullptr) {
    source_.give(memory, bytes, source_.user);
  } else {
    ::operator delete(memory);
  }
}

Pool::~Pool() {
  while (blocks_ != nullptr) {
    Block* const block = std::exchange(blocks_, blocks_->next);
    release(block, block->bytes);
  }
}

void* Pool::take(std::size_t bytes) {
  if (bytes > largest) return ask(bytes);
  const std::size_t k = size_class(std::max(bytes, least)), size = least << k;
  if (Piece* const piece = free_[k]; piece != nullptr) {
    free_[k] = piece->next;
    return piece;
  }
  if (left_ < size) {
    const std::size_t all = std::max(blocks_ != nullptr ? 2 * blocks_->bytes : first_block, 2 * size);
    auto* const block = static_cast<std::byte*>(ask(all));
    blocks_ = new (block) Block{blocks_, all};
    static_assert(sizeof(Block) <= least);
    next_ = block + least;
    left_ = all - least;
  }
  void* const piece = next_;
  next_ += size;
  left_ -= size;
  return piece;
}

void Pool::give(void* piece, std::size_t bytes) noexcept {
  if (bytes > largest) return release(piece, bytes);
  const std::size_t k = size_class(std::max(bytes, least));
  free_[k] = new (piece) Piece{free_[k]};
}

}  // namespace ductile::dynamics
