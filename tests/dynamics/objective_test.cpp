// ∇f against differences of f, in every regime of the rows; f's convexity along random lines.
#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "random_system.h"

namespace ductile::dynamics {
namespace {

void move(System& system, const std::vector<Vec3>& d, double by) {
  for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v += by * d[i];
}

std::vector<Vec3> direction(RandomSystem& r) {
  std::vector<Vec3> d(r.system.bodies.size());
  for (std::size_t i = 0; i < r.system.free; ++i) {
    d[i] = {r.in(-1, 1), r.in(-1, 1), r.system.bodies[i].inertia > 0 ? r.in(-1, 1) : 0};
  }
  return d;
}

// Of the joints between free bodies, and as of lines of the others.
void add_turn_inertias(RandomSystem& r) {
  for (const Joint& j : r.system.joints) {
    const double inertia = r.in(0, 2) * r.system.bodies[z(j.a)].mass;
    TurnInertia t{.a = j.a, .b = j.b, .inertia = inertia, .rate = r.in(-1, 1)};
    if (!r.system.is_free(j.a) || !r.system.is_free(j.b)) {
      t.row_a = {r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)};
      t.row_b = {r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)};
    }
    r.system.turn_inertias.push_back(t);
  }
}

TEST(Objective, GradientIsItsDerivativeInEveryRegime) {
  unsigned seen = 0;  // regimes' bits
  std::size_t turn_inertias = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomSystem r(seed);
    if (seed % 2 == 1) add_turn_inertias(r);
    turn_inertias += r.system.turn_inertias.size();
    std::vector<Vec3> g(r.system.bodies.size()), scratch = g;
    evaluate(r.system, g);
    for (const Joint& j : r.system.joints) seen |= j.regime;
    for (int trial = 0; trial < 5; ++trial) {
      const std::vector<Vec3> d = direction(r);
      double slope = 0;
      for (std::size_t i = 0; i < r.system.free; ++i) slope += dot(g[i], d[i]);
      const auto f = [&](double by) {
        move(r.system, d, by);
        const double value = objective(r.system, evaluate(r.system, scratch));
        move(r.system, d, -by);
        return value;
      };
      // f is quadratic but for kinks, so that central differences are exact but for those and rounding.
      constexpr double step = 1e-5;
      EXPECT_NEAR((f(step) - f(-step)) / (2 * step), slope, 1e-5 * (1 + std::abs(slope))) << seed;
    }
  }
  EXPECT_EQ(seen, 64u | 63u) << "every row flowed both ways, and some on yield surfaces";
  EXPECT_GT(turn_inertias, 60u);
}

// f − ½|v|²_M is convex: f' along a line grows by at least |d|²_M times the way.
TEST(Objective, IsStrictlyConvexOnRandomLines) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomSystem r(seed);
    if (seed % 2 == 1) add_turn_inertias(r);
    std::vector<Vec3> g(r.system.bodies.size());
    const std::vector<Vec3> d = direction(r);
    double curvature = 0;
    for (std::size_t i = 0; i < r.system.free; ++i)
      curvature += dot(d[i], momentum(r.system.bodies[i], d[i]));
    double last = 0;
    for (int i = -20; i <= 20; ++i) {
      constexpr double way = 0.3;
      move(r.system, d, i == -20 ? -20 * way : way);
      evaluate(r.system, g);
      double slope = 0;
      for (std::size_t k = 0; k < r.system.free; ++k) slope += dot(g[k], d[k]);
      if (i > -20) {
        EXPECT_GE(slope - last, way * curvature * (1 - 1e-9)) << seed << ", " << i;
      }
      last = slope;
    }
  }
}

// What an evaluation tells, counted anew.
TEST(Objective, EvaluationTellsWhatItSaw) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomSystem r(seed);
    std::vector<Vec3> g(r.system.bodies.size());
    for (Joint& j : r.system.joints) j.factored_flow = static_cast<std::uint8_t>(r.any(8));
    const Evaluation e = evaluate(r.system, g);
    double speed2 = 0, impulse2 = 0, gradient2 = 0, fastest = 0, turn = 0;
    for (std::size_t i = 0; i < r.system.free; ++i) {
      const Body& b = r.system.bodies[i];
      speed2 += dot(b.v, momentum(b, b.v));
      impulse2 += dot(b.v - b.v_free, momentum(b, b.v - b.v_free));
      gradient2 +=
          (g[i].x * g[i].x + g[i].y * g[i].y) / b.mass + (b.inertia > 0 ? g[i].w * g[i].w / b.inertia : 0);
      fastest = std::max(fastest, std::hypot(b.v.x, b.v.y));
      turn = std::max(turn, std::abs(b.v.w));
    }
    EXPECT_NEAR(e.speed2, speed2, 1e-12 * speed2);
    EXPECT_NEAR(e.impulse2, impulse2, 1e-12 * impulse2);
    EXPECT_NEAR(e.gradient2, gradient2, 1e-12 * gradient2);
    EXPECT_NEAR(std::sqrt(e.fastest2), fastest, 1e-14);
    EXPECT_NEAR(std::sqrt(e.fastest_turn2), turn, 1e-14);
    int changed = 0;
    bool flow = false;
    for (const Joint& j : r.system.joints) {
      changed += std::popcount(flowing(j.regime) ^ j.factored_flow);
      flow |= j.regime != 0;
    }
    EXPECT_EQ(e.changed, changed);
    EXPECT_EQ(e.flows, flow);
    EXPECT_FALSE(evaluate(r.system, g).crossed && !e.curved) << "nothing moved since";
  }
}

}  // namespace
}  // namespace ductile::dynamics
