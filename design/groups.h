// Which of n things hang together (union–find).
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace ductile {

class Groups {
 public:
  explicit Groups(std::size_t n) : leader_(n) { std::iota(leader_.begin(), leader_.end(), 0); }
  /// The thing that stands for the group of i.
  std::size_t of(std::size_t i) const {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  /// Both groups become one; that of `lead` stands for it.
  void unite(std::size_t lead, std::size_t other) { leader_[of(other)] = of(lead); }

 private:
  mutable std::vector<std::size_t> leader_;  // shortened as it is read
};

}  // namespace ductile
