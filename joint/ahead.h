// What the next component of a structure reads comes into the cache while this one is solved. Many small
// components do not fit the cache, and each of their arrays is too short for the processor to notice that it
// is read from end to end.
#pragma once

#include <cstddef>
#include <vector>

namespace ductile {

class Ahead {
 public:
  /// Joints: what larger components read would drive out what is being solved, and is in long arrays.
  static constexpr std::size_t small = 160;

  /// Begins the list of what a component reads; returns its place among those of all components.
  std::size_t begin() {
    first_.push_back(parts_.size());
    return first_.size() - 1;
  }
  /// Nothing is read from there, only asked for: it may be gone by then.
  void add(const void* from, std::size_t bytes) {
    if (bytes > 0) parts_.push_back({static_cast<const char*>(from), bytes});
  }
  template <class T>
  void add(const std::vector<T>& all) {
    add(all.data(), all.size() * sizeof(T));
  }
  std::size_t components() const { return first_.size(); }
  void clear() {
    parts_.clear();
    first_.clear();
    follow(0);
  }

  /// From now on: what the component after `place` reads.
  void follow(std::size_t place) {
    const auto part = [this](std::size_t k) { return k < first_.size() ? first_[k] : parts_.size(); };
    part_ = part(place + 1);
    last_ = part(place + 2);
    at_ = 0;
  }
  /// Asks for a few lines more. Four passes of a step call it once per body or joint: then all of it has been
  /// asked for when they are through, at the pace of the computation.
  void fetch() {
    constexpr int read = 0, second_level = 2;
    for (int lines = 0; lines < 6 && part_ != last_; ++lines) {
      const Part& part = parts_[part_];
      __builtin_prefetch(part.from + at_, read, second_level);
      at_ += line;
      if (at_ < part.bytes) continue;
      at_ = 0;
      ++part_;
    }
  }

  std::size_t bytes() const {
    return parts_.capacity() * sizeof(Part) + first_.capacity() * sizeof(std::size_t);
  }

 private:
  static constexpr std::size_t line = 64;
  struct Part {
    const char* from;
    std::size_t bytes;
  };
  std::vector<Part> parts_;
  std::vector<std::size_t> first_;   // part of each component
  std::size_t part_ = 0, last_ = 0;  // the part at hand, and where to stop
  std::size_t at_ = 0;               // byte of it
};

}  // namespace ductile
