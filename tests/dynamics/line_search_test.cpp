// The zero of a rising function, wherever it lies.
#include "../../joint/line_search.h"

#include <gtest/gtest.h>

namespace ductile::dynamics {
namespace {

// A slope as f' of a step has it: linear, and a kink per row.
struct Kinks {
  double zero, soft, stiff;  // beyond `zero` the rise is another than before it
  int calls = 0;
  Slope operator()(double t) {
    ++calls;
    const double rise = t < zero ? soft : stiff;
    return {rise * (t - zero), rise};
  }
};

TEST(LineSearch, FindsTheZeroInABracket) {
  for (const double zero : {1e-6, 0.1, 0.5, 0.999}) {
    for (const double ratio : {1e-6, 1.0, 1e6}) {
      Kinks f{zero, 1, ratio};
      const double enough = 1e-12;
      const double t = line_search([&](double at) { return f(at); }, 0.7, true, enough);
      EXPECT_LE(std::abs(f(t).value), enough) << zero << ", " << ratio;
      EXPECT_LT(f.calls, 60);
    }
  }
}

// f'(1) < 0: the zero lies beyond, as far as it likes.
TEST(LineSearch, FindsTheZeroBeyondTheStep) {
  for (const double zero : {1.5, 37.0, 1e4}) {
    for (const double ratio : {1e-3, 1.0, 1e3}) {
      // Before the zero the rise doubles in between, so that Newton's first guess is far off.
      const auto slope = [&](double t) {
        const double kink = 1 + (zero - 1) / 2;
        const double at_kink = -1;
        if (t < kink) return Slope{at_kink + ratio * (t - kink), ratio};
        return Slope{at_kink + (t - kink) / (zero - kink), 1 / (zero - kink)};
      };
      const double t = line_search(slope, 0.9, false, 1e-10);
      EXPECT_NEAR(t, zero, 1e-9 * zero) << zero << ", " << ratio;
    }
  }
}

// The second derivative may be wrong, as it leaves yield surfaces out: 60 evaluations halve the bracket 15
// times.
TEST(LineSearch, NeedsNoRightRise) {
  for (const double wrong : {0.01, 100.0}) {
    const auto slope = [&](double t) { return Slope{t * t * t - 0.2, wrong}; };
    EXPECT_NEAR(line_search(slope, 0.5, true, 1e-12), std::cbrt(0.2), 2e-5) << wrong;
  }
}

TEST(LineSearch, EndsOnWhatHasNoZero) {
  int calls = 0;
  line_search(
      [&](double) {
        ++calls;
        return Slope{-1, 0};
      },
      0.5, false, 1e-9);
  EXPECT_LE(calls, 60);
}

}  // namespace
}  // namespace ductile::dynamics
