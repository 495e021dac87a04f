// Numbers in a row: what the solver carries from step to step, written down and read again.
//
// A type whose state outlives a step names it once, for both directions, in `void keep(Tape& tape)`. What
// each step makes anew, and what follows from bodies, joints and materials, is left out. Vectors are as long
// as form() made them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace ductile::dynamics {

/// Types that are nothing but doubles.
template <class T>
inline constexpr bool all_doubles = false;

class Tape {
 public:
  Tape() = default;  // writes
  explicit Tape(std::vector<double> numbers) : numbers_(std::move(numbers)), reads_(true) {}

  bool reads() const { return reads_; }
  const std::vector<double>& numbers() const { return numbers_; }
  /// All that was written was read, and fitted.
  bool fits() const { return fits_ && at_ == numbers_.size(); }
  void refuse() { fits_ = false; }
  /// Numbers that are still to be read: a list is no longer.
  std::size_t left() const { return numbers_.size() - at_; }

  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  void one(double& value) {
    if (!reads_) return numbers_.push_back(value);
    if (at_ < numbers_.size()) {
      value = numbers_[at_++];
    } else {
      fits_ = false;
    }
  }

  template <class T>
  void one(T& value) {
    if constexpr (requires { value.keep(*this); }) {
      value.keep(*this);
    } else if constexpr (all_doubles<T>) {
      auto list = std::bit_cast<std::array<double, sizeof(T) / sizeof(double)>>(value);
      for (double& number : list) one(number);
      value = std::bit_cast<T>(list);
    } else if constexpr (std::is_arithmetic_v<T>) {
      auto number = static_cast<double>(value);
      one(number);
      using Limits = std::numeric_limits<T>;
      // A whole number's greatest value may be none that doubles have, but a power of 2 follows it.
      const bool holds = std::is_floating_point_v<T> || (number >= static_cast<double>(Limits::lowest()) &&
                                                         number < std::ldexp(1.0, Limits::digits));
      if (holds) {
        value = static_cast<T>(number);
      } else {
        fits_ = false;
      }
    } else {
      for (auto& each : value) one(each);
    }
  }

  std::vector<double> numbers_;
  std::size_t at_ = 0;
  bool reads_ = false, fits_ = true;
};

}  // namespace ductile::dynamics
