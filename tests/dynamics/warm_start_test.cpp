// What a forecast tells, against sums of modes, which it must know to rounding once it has seen enough of
// them.
#include "../../joint/warm_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ductile::dynamics {
namespace {

struct Mode {
  double decay, angle;  // per step
  Vec3 shape(std::size_t body) const {
    const double i = static_cast<double>(body);
    return {std::cos(i + angle), std::sin(2 * i + angle), 0.3 * std::cos(3 * i)};
  }
};

// What bodies have at step n: damped swinging in the modes, their phases different from body to body.
Vec3 sum(const std::vector<Mode>& modes, std::size_t body, int n) {
  Vec3 v;
  for (const Mode& m : modes)
    v += std::pow(m.decay, n) * std::cos(m.angle * n + 0.1 * static_cast<double>(body)) * m.shape(body);
  return v;
}

struct Told {
  explicit Told(std::size_t n) : masses(n) {
    for (std::size_t i = 0; i < n; ++i) {
      const double m = 100 + 10 * static_cast<double>(i);
      masses[i] = {m, m, m / 3};
    }
    forecast.form(masses);
  }
  template <class Velocity>
  void see(const Velocity& velocity) {
    const std::span<Vec3> newest = forecast.newest();
    for (std::size_t i = 0; i < newest.size(); ++i) newest[i] = velocity(i);
    forecast.fit();
  }
  /// Largest difference of what is told and what comes.
  template <class Velocity>
  double error(const Velocity& velocity) const {
    std::vector<Vec3> next(masses.size());
    forecast.next(next);
    double largest = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const Vec3 d = next[i] - velocity(i);
      largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.w)});
    }
    return largest;
  }
  std::vector<Vec3> masses;
  LinearPrediction forecast;
};

// Seven terms know six geometric sequences, which three damped modes are, and what stays.
TEST(LinearPrediction, KnowsASumOfModes) {
  const std::vector<Mode> modes{{0.99, 0.2}, {0.9, 0.7}, {1, 0.05}};
  for (const std::size_t bodies : {4u, 5u, 40u, 99u, 100u, 300u}) {
    Told told(bodies);
    for (int n = 0; n < 30; ++n) {
      // The slow modes among fast ones are a matter of seventh differences, 1e-16 / 0.05⁷ at worst.
      if (n >= 20) {
        EXPECT_LE(told.error([&](std::size_t i) { return sum(modes, i, n); }), 1e-7) << bodies << ", " << n;
      }
      told.see([&](std::size_t i) { return sum(modes, i, n); });
    }
  }
}

TEST(LinearPrediction, OfWhatStaysIsThatItStays) {
  Told told(3);
  const auto same = [](std::size_t i) { return Vec3{1, 2.0 * static_cast<double>(i), -3}; };
  for (int n = 0; n < 12; ++n) {
    told.see(same);
    EXPECT_LE(told.error(same), 1e-13);
  }
}

TEST(LinearPrediction, OfNothingIsNothing) {
  Told told(2);
  for (int n = 0; n < 12; ++n) told.see([](std::size_t) { return Vec3{}; });
  EXPECT_EQ(told.error([](std::size_t) { return Vec3{}; }), 0);
  Told none(0);
  none.see([](std::size_t) { return Vec3{}; });
}

// What swings on with another law than before, as after a blow, is known again once what was is forgotten.
TEST(LinearPrediction, LearnsAnew) {
  const std::vector<Mode> before{{1, 1.3}}, after{{0.95, 0.3}};
  Told told(6);
  for (int n = 0; n < 10; ++n) told.see([&](std::size_t i) { return sum(before, i, n); });
  told.forecast.forget();
  for (int n = 0; n < 10; ++n) told.see([&](std::size_t i) { return sum(after, i, n); });
  EXPECT_LE(told.error([&](std::size_t i) { return sum(after, i, 10); }), 1e-7);
}

// What lay still but for rounding and is thrown does not become the same multiple of itself once more.
TEST(LinearPrediction, IsNotCarriedAwayByAThrow) {
  Told told(4);
  for (int n = 0; n < 12; ++n) {
    told.see([&](std::size_t i) {
      return Vec3{1e-12 * std::sin(5.0 * n + static_cast<double>(i)), 1e-12 * std::cos(7.0 * n), 0};
    });
  }
  const auto thrown = [](std::size_t) { return Vec3{8e3, -2e3, 1}; };
  told.see(thrown);
  EXPECT_LE(told.error(thrown), 1e-9);
}

TEST(LinearPrediction, IsFiniteAgainAfterWhatIsNot) {
  Told told(4);
  for (int n = 0; n < 10; ++n) told.see([](std::size_t) { return Vec3{std::sin(1e3), 1e200, 0}; });
  told.see([](std::size_t) { return Vec3{std::numeric_limits<double>::quiet_NaN(), 0, 0}; });
  const auto calm = [](std::size_t) { return Vec3{1, 1, 1}; };
  for (int n = 0; n < 10; ++n) told.see(calm);
  EXPECT_LE(told.error(calm), 1e-12);
}

}  // namespace
}  // namespace ductile::dynamics
