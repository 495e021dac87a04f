#include "pool.h"

#include <algorithm>
#include <new>

// The address sanitizer sees what is done beyond a piece, or to one that was given back.
#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/asan_interface.h>
#else
#define ASAN_POISON_MEMORY_REGION(memory, bytes) (static_cast<void>(memory), static_cast<void>(bytes))
#define ASAN_UNPOISON_MEMORY_REGION(memory, bytes) (static_cast<void>(memory), static_cast<void>(bytes))
#endif

namespace ductile::dynamics {

namespace {

// Where operator new does not align for any type by itself, as in 32 bits.
constexpr std::align_val_t alignment{Pool::least};
constexpr bool is_aligned = Pool::least <= __STDCPP_DEFAULT_NEW_ALIGNMENT__;

}  // namespace

void* Pool::ask(std::size_t bytes) {
  void* const memory = source_.take != nullptr ? source_.take(bytes, source_.user)
                       : is_aligned            ? ::operator new(bytes)
                                               : ::operator new(bytes, alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void Pool::release(void* memory, std::size_t bytes) noexcept {
  if (source_.take != nullptr) {
    source_.give(memory, bytes, source_.user);
  } else if (is_aligned) {
    ::operator delete(memory);
  } else {
    ::operator delete(memory, alignment);
  }
}

Pool::~Pool() {
  while (blocks_ != nullptr) {
    Block* const block = std::exchange(blocks_, blocks_->next);
    ASAN_UNPOISON_MEMORY_REGION(block, block->bytes);
    release(block, block->bytes);
  }
}

void* Pool::take(std::size_t bytes) {
  if (bytes > largest) {
    void* const all = ask(bytes);
    held_ += bytes;
    return all;
  }
  const std::size_t k = size_class(std::max(bytes, least)), size = least << k;
  if (free_[k] == nullptr && left_ < size) split(k);
  void* piece = free_[k];
  if (piece != nullptr) {
    free_[k] = free_[k]->next;
  } else {
    if (left_ < size) begin_block(2 * size);
    piece = next_;
    next_ += size;
    left_ -= size;
  }
  ASAN_UNPOISON_MEMORY_REGION(piece, bytes);
  held_ += bytes;
  return piece;
}

// The smallest of the larger pieces that are free, if there is one, becomes two of that size class, and one
// of each between.
void Pool::split(std::size_t into) {
  std::size_t from = into + 1;
  while (from < free_.size() && free_[from] == nullptr) ++from;
  if (from >= free_.size()) return;
  auto* const piece = reinterpret_cast<std::byte*>(free_[from]);
  free_[from] = free_[from]->next;
  while (from-- > into) put(piece + (least << from), from);
  put(piece, into);
}

// Of so many bytes at least. What is left of the last one becomes free pieces.
void Pool::begin_block(std::size_t bytes) {
  static_assert(sizeof(Block) <= least);
  while (left_ > 0) {
    const std::size_t size = std::min(std::bit_floor(left_), largest);
    put(next_, size_class(size));
    next_ += size;
    left_ -= size;
  }
  const std::size_t all = std::max(blocks_ != nullptr ? 2 * blocks_->bytes : first_block, bytes);
  auto* const block = static_cast<std::byte*>(ask(all));
  blocks_ = new (block) Block{blocks_, all};
  next_ = block + least;
  left_ = all - least;
  ASAN_POISON_MEMORY_REGION(next_, left_);
}

void Pool::give(void* piece, std::size_t bytes) noexcept {
  held_ -= bytes;
  if (bytes > largest) return release(piece, bytes);
  put(piece, size_class(std::max(bytes, least)));
}

void Pool::put(void* piece, std::size_t k) noexcept {
  ASAN_POISON_MEMORY_REGION(piece, least << k);
  ASAN_UNPOISON_MEMORY_REGION(piece, sizeof(Piece));
  free_[k] = new (piece) Piece{free_[k]};
}

}  // namespace ductile::dynamics
