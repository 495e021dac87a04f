// Memory of components, which come and go while a structure breaks: what one leaves, the next takes, and what
// a large one leaves, several smaller ones. Pieces are powers of two, cut from blocks that double; those
// above `largest` are asked for one by one. Not for several threads at once, as a world is not.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "ductile/memory.h"

namespace ductile::dynamics {

class Pool {
 public:
  static constexpr std::size_t least = 16;  // bytes of a piece, and its alignment

  explicit Pool(const MemorySource& source) : source_(source) {}
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void* take(std::size_t bytes);
  void give(void* piece, std::size_t bytes) noexcept;
  /// Bytes that were taken and not given back.
  std::size_t held() const { return held_; }

  /// Vectors that are made while one is there, in this thread, have their memory from the pool for good.
  class Use {
   public:
    explicit Use(Pool& pool) : before_(std::exchange(in_use_, &pool)) {}
    ~Use() { in_use_ = before_; }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Pool* before_;
  };
  static Pool* in_use() { return in_use_; }

  template <class T>
  struct Return {
    Pool* pool;
    void operator()(T* object) const noexcept {
      std::destroy_at(object);
      pool->give(object, sizeof(T));
    }
  };
  template <class T>
  using Owned = std::unique_ptr<T, Return<T>>;
  /// An object in the pool.
  template <class T, class... Arguments>
  Owned<T> make(Arguments&&... arguments) {
    struct Piece {
      ~Piece() {
        if (at != nullptr) pool.give(at, sizeof(T));
      }
      Pool& pool;
      void* at;
    } piece{*this, take(sizeof(T))};
    T* const object = std::construct_at(static_cast<T*>(piece.at), std::forward<Arguments>(arguments)...);
    piece.at = nullptr;
    return {object, {this}};
  }

 private:
  static constexpr std::size_t largest = 1 << 24, first_block = 1 << 14;
  struct Piece {
    Piece* next;
  };
  struct Block {
    Block* next;
    std::size_t bytes;
  };
  static std::size_t size_class(std::size_t bytes) {
    return static_cast<std::size_t>(std::bit_width((bytes - 1) / least));
  }
  void put(void* piece, std::size_t k) noexcept;
  void begin_block(std::size_t bytes);
  void split(std::size_t into);
  void* ask(std::size_t bytes);
  void release(void* memory, std::size_t bytes) noexcept;

  static inline thread_local Pool* in_use_ = nullptr;
  MemorySource source_;
  std::array<Piece*, std::bit_width(largest / least)> free_{};  // of least · 2ᵏ bytes
  Block* blocks_ = nullptr;                                     // the last comes first
  std::byte* next_ = nullptr;                                   // in the last block
  std::size_t left_ = 0, held_ = 0;
};

template <class T>
struct PoolAllocator {
  using value_type = T;
  PoolAllocator() = default;
  template <class U>
  PoolAllocator(const PoolAllocator<U>& other) : pool(other.pool) {}  // NOLINT: as allocators are converted

  // NOLINTBEGIN(bugprone-sizeof-expression): of pointers, too
  T* allocate(std::size_t count) {
    static_assert(alignof(T) <= Pool::least);
    return pool != nullptr ? static_cast<T*>(pool->take(count * sizeof(T)))
                           : std::allocator<T>().allocate(count);
  }
  void deallocate(T* memory, std::size_t count) noexcept {
    pool != nullptr ? pool->give(memory, count * sizeof(T)) : std::allocator<T>().deallocate(memory, count);
  }
  // NOLINTEND(bugprone-sizeof-expression)
  /// Copies are snapshots, which may outlive the pool.
  PoolAllocator select_on_container_copy_construction() const { return {}; }
  friend bool operator==(const PoolAllocator& a, const PoolAllocator& b) { return a.pool == b.pool; }

  Pool* pool = Pool::in_use();
};

template <class T>
using Vector = std::vector<T, PoolAllocator<T>>;

}  // namespace ductile::dynamics
