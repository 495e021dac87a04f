#include "diagram.h"

#include <gtest/gtest.h>

#include <cmath>

#include "quantity.h"
#include "scenes.h"
#include "series.h"

namespace ductile::viewer {
namespace {

const Material steel{.yield_stress = 400e6};

TEST(Diagram, IsTheBoxOfTheCapsOrTheCurve) {
  SceneDef scene = cantilever(2, unlimited);
  const Plan plan = calibrate(scene);  // bar/0-bar/1, then the root
  // 1 m × 1 m of 400 MPa: N = 400 MN, M = 100 MN m.
  const Diagram inside = diagram(plan, 0);
  ASSERT_EQ(inside.limit.size(), 4u);
  EXPECT_NEAR(inside.limit[0].N, 4e8, 1);
  EXPECT_NEAR(inside.limit[0].M, 1e8, 1);
  EXPECT_TRUE(diagram(plan, 1).limit.empty()) << "its moment is unlimited";
  double area = 0;
  for (const Convex& part : inside.parts) {
    for (std::size_t i = 0; i < part.size(); ++i) area += cross(part[i], part[(i + 1) % part.size()]) / 2;
  }
  EXPECT_NEAR(area, 1, 1e-12);

  scene.interaction = true;
  const Diagram curve = diagram(calibrate(scene), 0);
  ASSERT_GT(curve.limit.size(), 8u);
  for (const AxialMoment& at : curve.limit) {  // M = M_p (1 − (N/N_p)²)
    EXPECT_NEAR(std::abs(at.M), 1e8 * (1 - at.N * at.N / 16e16), 1e5);
  }
}

TEST(NeutralAxis, OfARectangleIsWhereTheForceLeavesIt) {
  // Above and below the axis b·f each: N = b f ((h/2 + y) − (h/2 − y)) = 2 b f y with the lower side, the
  // right of the joint's axis, in tension.
  const double b = 0.1, h = 0.4;
  const Section section(Outline{{{-b / 2, -h / 2}, {b / 2, -h / 2}, {b / 2, h / 2}, {-b / 2, h / 2}}, {}},
                        steel);
  for (const double N : {0., 4e6, -6e6, 15e6}) {
    EXPECT_NEAR(neutral_axis(section, N, true), N / (2 * b * 400e6), 1e-6 * h) << N;
    EXPECT_NEAR(neutral_axis(section, N, false), -N / (2 * b * 400e6), 1e-6 * h) << N;
  }
  EXPECT_NEAR(neutral_axis(section, 1e9, true), h / 2, 1e-3 * h) << "more than it holds";
}

TEST(Quantity, AsAnEngineerWritesIt) {
  EXPECT_EQ(si(-3214567, "N m"), "-3.215 MN m");
  EXPECT_EQ(si(999.96, "N"), "1 kN");
  EXPECT_EQ(si(0.02, "rad"), "20 mrad");
  EXPECT_EQ(si(0, "J"), "0 J");
  EXPECT_EQ(si(unlimited, "N"), "–");
  EXPECT_EQ(si(1e-30, "m"), "1e-21 nm");
  EXPECT_EQ(percent(0.85), "85.0 %");
  EXPECT_EQ(percent(0.0025), "0.25 %");
  EXPECT_EQ(percent(NAN), "–");
}

TEST(Series, NoPeakIsLost) {
  Timeline run(calibrate(cantilever(1, unlimited)));
  run.go_to(600);
  const auto spike = [](const Frame& frame) { return std::abs(frame.time - 5) < 1e-6 ? 7. : 1.; };
  const auto list = columns(run, spike, 40, 0, 10);
  ASSERT_EQ(list.size(), 40u);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(list[i].low, 1);
    if (i == 19 || i == 20) continue;
    EXPECT_EQ(list[i].high, 1) << i;
  }
  EXPECT_EQ(std::max(list[19].high, list[20].high), 7) << "5 s of 10 s in 40 columns";
  EXPECT_EQ(step_at(run, 5), 300);
  EXPECT_EQ(step_at(run, 5.007), 300);
  EXPECT_EQ(step_at(run, 5.01), 301);
  EXPECT_EQ(step_at(run, -1), 0);
  EXPECT_EQ(step_at(run, 99), 600);
}

}  // namespace
}  // namespace ductile::viewer
