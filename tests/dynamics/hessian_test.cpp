// H and its factor against dense matrices, H against differences of ∇f, and what is known of the factor.
#include "../../joint/hessian.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "random_system.h"

namespace ductile::dynamics {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Vector in_one(std::span<const Vec3> v) {
  Vector all(3 * v.size());
  for (std::size_t i = 0; i < v.size(); ++i)
    all.segment<3>(3 * static_cast<int>(i)) << v[i].x, v[i].y, v[i].w;
  return all;
}

// M + Jᵀ D J and turn inertias by dense matrices; 1 where a body does not rotate.
Matrix dense(const System& system) {
  const auto n = static_cast<int>(3 * system.free);
  Matrix H = Matrix::Zero(n, n);
  for (int i = 0; i < n / 3; ++i) {
    const Body& b = system.bodies[z(i)];
    H.diagonal().segment<3>(3 * i) << b.mass, b.mass, b.inertia > 0 ? b.inertia : 1;
  }
  for (const Joint& j : system.joints) {
    Matrix J = Matrix::Zero(3, n);
    for (const int body : {j.a, j.b}) {
      if (!system.is_free(body)) continue;
      const JacobianRows rows = body == j.a ? rows_of_a(j.J) : rows_of_b(j.J);
      const double turns = system.bodies[z(body)].inertia > 0 ? 1 : 0;
      J.block<3, 3>(0, 3 * body) << rows.u.x, rows.u.y, turns * rows.u.w, rows.v.x, rows.v.y,
          turns * rows.v.w, rows.w.x, rows.w.y, turns * rows.w.w;
    }
    const Coupling& c = system.record(j).tangent;
    Eigen::Matrix3d D;
    D << c.nn, c.nq, c.nm, c.nq, c.qq, c.qm, c.nm, c.qm, c.mm;
    H += J.transpose() * D * J;
  }
  for (const TurnInertia& t : system.turn_inertias) {
    Vector d = Vector::Zero(n);
    for (const auto& [body, row] : {std::pair{t.a, t.row_a}, std::pair{t.b, t.row_b}}) {
      if (!system.is_free(body)) continue;
      d.segment<3>(3 * body) << row.x, row.y, system.bodies[z(body)].inertia > 0 ? row.w : 0;
    }
    H += t.inertia * d * d.transpose();
  }
  return H;
}

void expect_inverse(const System& system, const Hessian& hessian, RandomSystem& r, double tolerance) {
  const Matrix H = dense(system);
  std::vector<Vec3> x(system.free);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = {r.in(-1, 1), r.in(-1, 1), system.bodies[i].inertia > 0 ? r.in(-1, 1) : 0};
  }
  const Vector b = in_one(x), exact = H.ldlt().solve(b);
  std::vector<Vec3> halves = x;
  EXPECT_NEAR(hessian.forward(halves), b.dot(exact), tolerance * std::abs(b.dot(exact)));
  hessian.backward(halves);
  hessian.solve(x);
  EXPECT_LE((in_one(x) - exact).norm(), tolerance * exact.norm());
  EXPECT_LE((in_one(halves) - exact).norm(), tolerance * exact.norm());
}

// Rows of contacts whose friction follows the normal impulse: against a dense matrix that is not symmetric.
TEST(Hessian, FactorKnowsFrictionThatFollows) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    RandomSystem r(seed, 4 + static_cast<int>(seed % 17));
    Hessian hessian;
    hessian.analyse(r.system);
    hessian.factor_tangents(r.system, false);
    // The last joints as contacts: a few, all, none.
    const std::size_t contacts =
        static_cast<std::size_t>(r.any(static_cast<int>(r.system.joints.size()) + 1));
    r.system.contacts.resize(contacts);
    Matrix H = dense(r.system);
    const auto n = static_cast<int>(3 * r.system.free);
    std::vector<double> follows(contacts);
    for (std::size_t k = 0; k < contacts; ++k) {
      const Joint& j = r.system.joints[r.system.first_contact() + k];
      follows[k] = r.any(3) == 0 ? 0 : r.in(-0.5, 0.5) * r.system.record(j).tangent.nn;
      Vector u = Vector::Zero(n), v = Vector::Zero(n);
      for (const int body : {j.a, j.b}) {
        if (!r.system.is_free(body)) continue;
        const JacobianRows rows = body == j.a ? rows_of_a(j.J) : rows_of_b(j.J);
        const double turns = r.system.bodies[z(body)].inertia > 0 ? 1 : 0;
        u.segment<3>(3 * body) << rows.u.x, rows.u.y, turns * rows.u.w;
        v.segment<3>(3 * body) << rows.v.x, rows.v.y, turns * rows.v.w;
      }
      H += follows[k] * v * u.transpose();
    }
    hessian.factor_following(r.system, follows);
    EXPECT_EQ(hessian.factored(), Factored::nothing);  // others know nothing of it
    std::vector<Vec3> x(r.system.free);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = {r.in(-1, 1), r.in(-1, 1), r.system.bodies[i].inertia > 0 ? r.in(-1, 1) : 0};
    const Eigen::PartialPivLU<Matrix> lu(H);
    const Vector exact = lu.solve(in_one(x));
    hessian.solve_following(x);
    // There is no pivoting, so that rounding may grow; here by no more than a few digits beyond the
    // condition.
    EXPECT_LE((in_one(x) - exact).norm(), 1e-12 / lu.rcond() * exact.norm()) << "seed " << seed;
  }
}

// Beside a body that does not rotate, too: it once was turned by its neighbour, without end.
TEST(Hessian, FactorKnowsTurnInertias) {
  int held = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomSystem r(seed, 4 + static_cast<int>(seed % 12));
    Hessian hessian;
    hessian.analyse(r.system);
    for (const Joint& j : r.system.joints) {
      TurnInertia t{
          .a = j.a, .b = j.b, .block = j.block, .inertia = r.in(0, 2) * r.system.bodies[z(j.a)].mass};
      if (seed % 2 == 1) {  // as of lines
        t.row_a = {r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)};
        t.row_b = {r.in(-1, 1), r.in(-1, 1), r.in(-1, 1)};
      } else if (j.block < 0) {
        continue;
      }
      r.system.turn_inertias.push_back(t);
      held += (r.system.bodies[z(j.a)].inertia > 0) != (r.system.bodies[z(j.b)].inertia > 0) ? 1 : 0;
    }
    std::vector<Vec3> g(r.system.bodies.size());
    evaluate(r.system, g);
    hessian.factor_tangents(r.system, false);
    expect_inverse(r.system, hessian, r, 1e-10);
  }
  EXPECT_GT(held, 20);
}

TEST(Hessian, FactorIsThatOfTheDenseMatrix) {
  int surfaces = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomSystem r(seed, 4 + static_cast<int>(seed % 12));
    Hessian hessian;
    hessian.analyse(r.system);
    std::vector<Vec3> g(r.system.bodies.size());
    evaluate(r.system, g);
    for (const Joint& j : r.system.joints) surfaces += j.regime == on_surface ? 1 : 0;
    hessian.factor_tangents(r.system, false);
    EXPECT_EQ(hessian.factored(), Factored::tangents);
    expect_inverse(r.system, hessian, r, 1e-10);
    hessian.factor_tangents(r.system, true);
    EXPECT_EQ(hessian.factored(), Factored::secants);
    expect_inverse(r.system, hessian, r, 1e-10);
  }
  EXPECT_GT(surfaces, 20);
}

// H is the derivative of ∇f where that has one: at random velocities it does.
TEST(Hessian, IsTheDerivativeOfTheGradient) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    RandomSystem r(seed);
    System& system = r.system;
    Hessian hessian;
    hessian.analyse(system);
    std::vector<Vec3> g(system.bodies.size()), ahead = g, back = g;
    evaluate(system, g);
    hessian.factor_tangents(system, false);
    const Matrix H = dense(system);
    std::vector<Vec3> d(system.free);
    for (std::size_t i = 0; i < system.free; ++i) {
      d[i] = {r.in(-1, 1), r.in(-1, 1), system.bodies[i].inertia > 0 ? r.in(-1, 1) : 0};
    }
    constexpr double step = 1e-6;
    const auto move = [&](double by) {
      for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v += by * d[i];
    };
    move(step), evaluate(system, ahead);
    move(-2 * step), evaluate(system, back);
    const Vector change = (in_one(ahead) - in_one(back)).head(H.rows()) / (2 * step), exact = H * in_one(d);
    EXPECT_LE((change - exact).norm(), 1e-6 * exact.norm()) << seed;
  }
}

// For pushes, what holds has at least κ m_eff and what flows nothing; a factor that is that already is kept.
TEST(Hessian, HoldsWithAllItsStrength) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomSystem r(seed, 6, true);
    Hessian hessian;
    hessian.analyse(r.system);
    std::vector<Vec3> g(r.system.bodies.size());
    const Evaluation e = evaluate(r.system, g);
    hessian.factor_holding(r.system, e.changed);
    EXPECT_EQ(hessian.factored(), Factored::holding);
    for (const Joint& j : r.system.joints) {
      const Coupling& D = r.system.record(j).tangent;
      const double of_row[] = {D.nn, D.qq, D.mm};
      for (unsigned i = 0; i < 3; ++i) {
        const bool holds = j.G[i] > 0 && !flows(j.regime, i);
        EXPECT_NEAR(of_row[i], holds ? rigid_ratio * r.system.record(j).m_eff[i] : 0, 1e-12 * of_row[i]);
      }
    }
  }
}

TEST(Hessian, GrowsOldWithTheStep) {
  RandomSystem r(1);
  Hessian hessian;
  hessian.analyse(r.system);
  EXPECT_EQ(hessian.factored(), Factored::nothing);
  hessian.begin_step();
  EXPECT_EQ(hessian.factored(), Factored::nothing);
  for (const bool secants : {false, true}) {
    hessian.factor_tangents(r.system, secants);
    hessian.begin_step();
    EXPECT_EQ(hessian.factored(), Factored::earlier);
  }
  hessian.forget();
  EXPECT_EQ(hessian.factored(), Factored::nothing);
}

}  // namespace
}  // namespace ductile::dynamics
