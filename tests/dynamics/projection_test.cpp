// Pushes spread through a structure: gaps are kept, and no pose that keeps them is nearer.
#include "../../joint/projection.h"

#include <gtest/gtest.h>

#include "random_system.h"

namespace ductile::dynamics {
namespace {

// Boxes on a line, welded rigidly but for one hinge, the last of them held or not.
struct Chain {
  explicit Chain(int n, bool held) {
    for (int i = 0; i < n; ++i) {
      Body body;
      body.mass = 100 + 50 * (i % 3), body.inertia = 20 + 5 * (i % 2);
      system.bodies.push_back(body);
      put(system.places.emplace_back(), {i + 0.1, 0.2 * i, 0.1 * i});
    }
    for (int i = 1; i < n; ++i) {
      Joint joint;
      joint.a = i - 1, joint.b = i;
      joint.frame.ax = 0.5, joint.frame.bx = -0.5;
      system.joints.push_back(joint);
      JointRecord record;
      record.material.stiffness = {rigid, rigid, rigid};
      record.material.cap = record.material.cap_reverse = {unlimited, unlimited, i == 2 ? 0 : unlimited};
      system.records.push_back(record);
    }
    system.form(static_cast<std::size_t>(held ? n - 1 : n));
    locate_all(system);
    for (Joint& j : system.joints) j.neutral = system.record(j).gap;
    laws.begin(system, 1.0 / 60);
    hessian.analyse(system);
    projection.form(system);
  }
  std::vector<Pose> poses() const {
    std::vector<Pose> all;
    for (const Place& p : system.places) all.push_back(p.pose);
    return all;
  }
  bool project(const std::vector<Pose>& goal) {
    return projection.project(system, hessian, {}, 1.0 / 60, goal, false);
  }
  double distance2(const std::vector<Pose>& goal) const {
    double sum = 0;
    for (std::size_t i = 0; i < system.free; ++i) {
      const Pose& p = system.places[i].pose;
      const double x = p.x - goal[i].x, y = p.y - goal[i].y, w = p.angle - goal[i].angle;
      sum += system.bodies[i].mass * (x * x + y * y) + system.bodies[i].inertia * w * w;
    }
    return sum;
  }
  std::vector<Rows> gaps() {
    locate_all(system);
    std::vector<Rows> all;
    for (const JointRecord& r : system.records) all.push_back(r.gap);
    return all;
  }
  System system;
  StepLaws laws;
  Hessian hessian;
  Projection projection;
};

TEST(Projection, KeepsGapsAndGoesNoFartherThanItMust) {
  std::mt19937 random(1);
  const auto in = [&](double range) { return std::uniform_real_distribution(-range, range)(random); };
  for (const bool held : {false, true}) {
    for (const double far : {1e-4, 1e-2, 0.3}) {
      for (int trial = 0; trial < 10; ++trial) {
        Chain chain(6, held);
        const std::vector<Rows> before = chain.gaps();
        std::vector<Pose> goal = chain.poses();
        for (int k = 0; k < 2; ++k) {
          Pose& p = goal[random() % chain.system.free];
          p.x += in(far), p.y += in(far), p.angle += in(far);
        }
        ASSERT_TRUE(chain.project(goal));
        const std::vector<Rows> after = chain.gaps();
        for (std::size_t k = 0; k < before.size(); ++k) {
          for (unsigned i = 0; i < 3; ++i) {
            if (k == 1 && i == 2) continue;  // the hinge
            EXPECT_NEAR(after[k][i], before[k][i], 1e-9) << far;
          }
        }
        // Poses nearby that keep the gaps as well, found as projections of random ones, are not nearer.
        const double nearest = chain.distance2(goal);
        for (int k = 0; k < 5; ++k) {
          Chain other = chain;
          std::vector<Pose> elsewhere = other.poses();
          for (std::size_t i = 0; i < other.system.free; ++i) {
            elsewhere[i].x += in(0.1 * far), elsewhere[i].y += in(0.1 * far),
                elsewhere[i].angle += in(0.1 * far);
          }
          ASSERT_TRUE(other.project(elsewhere));
          EXPECT_GE(other.distance2(goal), nearest * (1 - 1e-4)) << far;
        }
      }
    }
  }
}

// Supports that are moved apart part their joints; the joints' neutral positions go along, and no force is
// left.
TEST(Projection, LetsGoOfWhatCannotBeKept) {
  Chain chain(3, false);
  chain.system.form(1);  // all but the first body are held
  chain.hessian.analyse(chain.system);
  chain.projection.form(chain.system);
  chain.laws.invalidate();
  chain.laws.begin(chain.system, 1.0 / 60);
  std::vector<Pose> goal = chain.poses();
  goal[2].x += 0.5;
  const Rows neutral = chain.system.joints[1].neutral;
  chain.projection.project(chain.system, chain.hessian, {}, 1.0 / 60, goal, true);
  EXPECT_GT(std::abs(chain.system.joints[1].neutral[0] - neutral[0]), 0.3);
  for (const Joint& j : chain.system.joints) {
    for (unsigned i = 0; i < 3; ++i) EXPECT_NEAR(chain.system.record(j).gap[i], j.neutral[i], 1e-9);
  }
}

}  // namespace
}  // namespace ductile::dynamics
