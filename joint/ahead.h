// What the next component of a structure reads comes into the cache while this one is solved. Many small
// components do not fit the cache, and each of their arrays is too short for the processor to notice that it
// is read from end to end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ductile {

class Ahead {
 public:
  /// Joints: what larger components read would drive out what is being solved, and is in long arrays.
  static constexpr std::size_t small = 160;

  /// Begins the list of what a component reads; returns its place among those of all components.
  std::size_t begin() {
    first_.push_back(pairs_.size());
    return first_.size() - 1;
  }
  /// Nothing is read from there, only asked for: it may be gone by then.
  void add(const void* from, std::size_t bytes) {
    const auto begin = reinterpret_cast<std::uintptr_t>(from) / line * line;
    const auto end = reinterpret_cast<std::uintptr_t>(from) + bytes;
    for (auto at = begin; at < end; at += 2 * line) pairs_.push_back(at);
  }
  template <class T>
  void add(const std::vector<T>& all) {
    add(all.data(), all.size() * sizeof(T));
  }
  std::size_t components() const { return first_.size(); }
  void clear() {
    pairs_.clear();
    first_.clear();
    follow(0);
  }

  /// From now on: what the component after `place` reads.
  void follow(std::size_t place) {
    const auto pair = [this](std::size_t k) { return k < first_.size() ? first_[k] : pairs_.size(); };
    at_ = pair(place + 1);
    last_ = pair(place + 2);
  }
  /// Asks for a few lines more, as long as there are so many. Four passes of a step call it once per body or
  /// joint: then all of it has been asked for when they are through, at the pace of the computation.
  void fetch() {
    constexpr int read = 0, second_level = 2;
    if (last_ - at_ < at_once) return;
    for (std::size_t pair = 0; pair < at_once; ++pair) {
      // NOLINTNEXTLINE(performance-no-int-to-ptr): never read through; some lie beside the array
      const auto* from = reinterpret_cast<const char*>(pairs_[at_ + pair]);
      __builtin_prefetch(from, read, second_level);
      __builtin_prefetch(from + line, read, second_level);
    }
    at_ += at_once;
  }

  std::size_t bytes() const {
    return pairs_.capacity() * sizeof(pairs_[0]) + first_.capacity() * sizeof(std::size_t);
  }

 private:
  static constexpr std::size_t line = 64, at_once = 3;
  std::vector<std::uintptr_t> pairs_;  // of lines
  std::vector<std::size_t> first_;     // pair of each component
  std::size_t at_ = 0, last_ = 0;      // the pair at hand, and where to stop
};

}  // namespace ductile
