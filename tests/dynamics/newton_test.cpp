// The minimum of f, however it is found: with a fresh factor or an old one, from far or from there, by
// Newton's method or past the interior point; and what is left where it is not found.
#include "../../joint/newton.h"

#include <gtest/gtest.h>

#include "random_system.h"

namespace ductile::dynamics {
namespace {

struct Problem : RandomSystem {
  explicit Problem(unsigned seed, int bodies = 6, bool rigid_rows = false)
      : RandomSystem(seed, bodies, rigid_rows) {
    hessian.analyse(system);
    newton.form(system);
  }
  Solution solve() {
    report = {};
    last = newton.solve(system, hessian, last.at, nullptr, report);
    return last;
  }
  /// |∇f| at the bodies' v, found anew.
  double gradient() {
    std::vector<Vec3> g(system.bodies.size());
    return std::sqrt(evaluate(system, g).gradient2);
  }
  /// The same over what is promised: 1e-8 of the impulses, and what rounding of velocities is in a row of κ.
  double residual() {
    constexpr double rounding = 2 * rigid_ratio * std::numeric_limits<double>::epsilon();
    return gradient() / std::sqrt(1e-16 * last.at.impulse2 + rounding * rounding * last.at.speed2);
  }
  Hessian hessian;
  Newton newton;
  Solution last;
  SolveReport report;
};

// f − ½|v|²_M is convex: two points are no farther from each other than their gradients tell.
void expect_same(Problem& p, Problem& q, unsigned seed) {
  double distance2 = 0;
  for (std::size_t i = 0; i < p.system.free; ++i) {
    const Vec3 d = p.system.bodies[i].v - q.system.bodies[i].v;
    distance2 += dot(d, momentum(p.system.bodies[i], d));
  }
  EXPECT_LE(p.residual(), 1.001) << seed;
  EXPECT_LE(q.residual(), 1.001) << seed;
  EXPECT_LE(std::sqrt(distance2), 1.001 * (p.gradient() + q.gradient()) + 1e-12) << seed;
}

TEST(Newton, FindsTheMinimumOfRandomProblems) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    Problem p(seed, 4 + static_cast<int>(seed % 20));
    p.solve();
    EXPECT_FALSE(p.report.unsolved) << seed;
    EXPECT_LE(p.residual(), 1.001) << seed;
  }
}

// The minimum is unique: from anywhere the same velocities come out.
TEST(Newton, EndsAtOneMinimumWhereverItStarts) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Problem p(seed), q(seed);
    for (std::size_t i = 0; i < q.system.free; ++i) q.system.bodies[i].v = q.system.bodies[i].v_free;
    p.solve(), q.solve();
    expect_same(p, q, seed);
  }
}

// A factor of other poses and regimes is but a preconditioner.
TEST(Newton, EndsAtTheSameMinimumWithAnOldFactor) {
  int fewer = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    Problem old(seed), fresh(seed);
    old.solve();
    for (Problem* p : {&old, &fresh}) {
      for (std::size_t i = 0; i < p->system.free; ++i)
        displace(p->system.places[i], {1e-4, -1e-4, p->system.bodies[i].inertia > 0 ? 1e-4 : 0});
      locate_all(p->system);
      for (Body& b : p->system.bodies) b.v = {}, b.v_free = {0.1, 0.2, b.inertia > 0 ? 0.05 : 0};
    }
    old.hessian.begin_step();
    EXPECT_EQ(old.hessian.factored(), Factored::earlier);
    old.newton.forget();
    old.last = {};  // it would start from the regimes that it had, with a factor of its own
    old.solve(), fresh.solve();
    expect_same(old, fresh, seed);
    fewer += fresh.report.factorisations - old.report.factorisations;
  }
  EXPECT_GT(fewer, 0) << "old factors were used";
}

// A solve after nothing has changed ends where it began, without a factor; one after a push answers to it as
// one that is told nothing.
TEST(Newton, AnswersToAPushAsToANewProblem) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    Problem p(seed, 12), q(seed, 12);
    p.solve();
    EXPECT_FALSE(p.solve().moved);
    EXPECT_EQ(p.report.factorisations, 0);
    const Vec3 push{0.3, -0.2, p.system.bodies[1].inertia > 0 ? 0.1 : 0};
    p.newton.push(p.system, 1, push);
    p.solve();
    q.system.bodies[1].v_free += push;
    q.solve();
    expect_same(p, q, seed);
  }
}

TEST(Newton, SaysWhatItMayNotFinishAndRecovers) {
  Problem p(3);
  p.newton.tunables.flow_rounds = p.newton.tunables.round_bound =
      p.newton.interior_point.tunables.round_bound = 0;
  p.solve();
  EXPECT_TRUE(p.report.unsolved);
  p.newton.tunables = {};
  p.newton.interior_point.tunables = {};
  p.solve();
  EXPECT_FALSE(p.report.unsolved);
  EXPECT_LE(p.residual(), 1.001);
}

TEST(Newton, SaysWhatIsNotFinite) {
  Problem p(3);
  p.system.bodies[0].v_free.x = std::numeric_limits<double>::quiet_NaN();
  p.solve();
  EXPECT_TRUE(p.report.unsolved);
  EXPECT_EQ(p.hessian.factored(), Factored::nothing);
}

}  // namespace
}  // namespace ductile::dynamics
