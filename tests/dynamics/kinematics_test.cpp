// J against differences of the gap, and what follows from the gap's being the same wherever all of it is.
#include <gtest/gtest.h>

#include <cmath>

#include "random_system.h"

namespace ductile::dynamics {
namespace {

double& entry(Vec3& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.w; }

TEST(Kinematics, JacobianIsTheDerivativeOfTheGap) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    System system = RandomSystem(seed).system;
    for (Joint& j : system.joints) {
      for (const int body : {j.a, j.b}) {
        for (int i = 0; i < 3; ++i) {
          constexpr double step = 1e-5;
          const auto gap = [&](double by) {
            Joint moved = j;
            Vector<Place> places = system.places;
            Vec3 d;
            entry(d, i) = by;
            displace(places[z(body)], d);
            return locate(moved, places);
          };
          Vec3 a, b;
          entry(body == j.a ? a : b, i) = 1;
          locate(j, system.places);
          const Rows v = relative_velocity(j, a, b), ahead = gap(step), back = gap(-step);
          for (unsigned row = 0; row < 3; ++row)
            EXPECT_NEAR(v[row], (ahead[row] - back[row]) / (2 * step), 1e-8)
                << seed << ", " << i << ", " << row;
        }
      }
    }
  }
}

TEST(Kinematics, LinesMeasureTheDistanceOfTheirAnchors) {
  System system = RandomSystem(3).system;
  for (Joint j : system.joints) {
    j.frame.line = true;
    j.frame.bx += 3;
    const Place &a = system.places[z(j.a)], &b = system.places[z(j.b)];
    const auto anchor = [](const Place& p, double x, double y) {
      return Vec3{p.pose.x + p.turn.c * x - p.turn.s * y, p.pose.y + p.turn.s * x + p.turn.c * y, 0};
    };
    const auto distance = [&](const Place& on_a, const Place& on_b) {
      const Vec3 d = anchor(on_b, j.frame.bx, j.frame.by) - anchor(on_a, j.frame.ax, j.frame.ay);
      return std::hypot(d.x, d.y);
    };
    EXPECT_NEAR(locate(j, a, b)[0], distance(a, b), 1e-14 * distance(a, b));
    for (int i = 0; i < 6; ++i) {
      constexpr double step = 1e-5;
      Vec3 da, db;
      entry(i < 3 ? da : db, i % 3) = 1;
      const auto moved = [&](double by) {
        Place on_a = a, on_b = b;
        displace(on_a, by * da);
        displace(on_b, by * db);
        return distance(on_a, on_b);
      };
      EXPECT_NEAR(relative_velocity(j, da, db)[0], (moved(step) - moved(-step)) / (2 * step), 1e-8) << i;
    }
  }
}

TEST(Kinematics, AllFormsOfJacobianAreOne) {
  RandomSystem random(1);
  for (const Joint& j : random.system.joints) {
    const Vec3 a{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)},
        b{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
    const Rows s{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
    const JacobianRows of_a = rows_of_a(j.J), of_b = rows_of_b(j.J);
    const Rows v = relative_velocity(j, a, b);
    EXPECT_NEAR(v[0], dot(of_a.u, a) + dot(of_b.u, b), 1e-14);
    EXPECT_NEAR(v[1], dot(of_a.v, a) + dot(of_b.v, b), 1e-14);
    EXPECT_NEAR(v[2], dot(of_a.w, a) + dot(of_b.w, b), 1e-14);
    // s·(J v) = (Jᵀ s)·v
    Vec3 on_a, on_b;
    add_transposed(j, s, on_a, on_b);
    EXPECT_NEAR(s[0] * v[0] + s[1] * v[1] + s[2] * v[2], dot(on_a, a) + dot(on_b, b), 1e-13);
  }
}

// Whatever the gap, impulses change neither momentum nor angular momentum of the two bodies together.
TEST(Kinematics, ImpulsesKeepMomentum) {
  RandomSystem random(2);
  for (const Joint& j : random.system.joints) {
    const Rows s{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
    Vec3 on[2];
    add_transposed(j, s, on[0], on[1]);
    double x = 0, y = 0, moment = 0;
    for (int side = 0; side < 2; ++side) {
      const Place& p = random.system.places[z(side == 0 ? j.a : j.b)];
      const double fx = p.turn.c * on[side].x - p.turn.s * on[side].y;
      const double fy = p.turn.s * on[side].x + p.turn.c * on[side].y;
      x += fx, y += fy, moment += p.pose.x * fy - p.pose.y * fx + on[side].w;
    }
    EXPECT_NEAR(x, 0, 1e-14);
    EXPECT_NEAR(y, 0, 1e-14);
    EXPECT_NEAR(moment, 0, 1e-13);
  }
}

}  // namespace
}  // namespace ductile::dynamics
