// The vehicle that is to get across.
#include "crossing.h"

#include <gtest/gtest.h>

#include "making.h"

namespace ductile::viewer {
namespace {

constexpr double span = 20, height = 0.4, depth = 0.5;

/// A beam on a hinge and a roller, with a truss over it that a vehicle would not get through were it solid.
SceneDef road(double yield_stress) {
  BeamStyle style;
  style.height = height;
  style.depth = depth;
  style.material.density = 100;
  style.material.yield_stress = yield_stress;
  style.material.fracture_strain = 0.1;
  SceneDef scene = with_beam(empty_scene(), {{-span / 2, 4}, {span / 2, 4}}, style);
  scene = with_next_support(scene, {-span / 2, 4}, 0);
  scene = with_next_support(with_next_support(scene, {span / 2, 4}, 0), {span / 2, 4}, 0);
  style.solid = false;
  const Point top{3 - span / 2, 7};
  return with_beam(with_beam(scene, {{-span / 2, 4}, top}, style), {top, {6 - span / 2, 4}}, style);
}

/// f_y with which the middle of the beam yields under a weight there: W L/4 = b h²/4 f_y.
double yields_under(double mass) { return mass * 9.81 * span / (depth * height * height); }

Crossing::State sent(Workbench& bench, double mass) {
  EXPECT_TRUE(send_across(bench, mass, 2, 5));
  for (int step = 1; step < 1200; ++step) {
    bench.run().go_to(step);
    if (bench.frame().crossing->state != Crossing::State::on_its_way) break;
  }
  return bench.frame().crossing->state;
}

TEST(Crossing, AStrongBridgeBearsTheVehicleAndAWeakOneDoesNot) {
  constexpr double mass = 5000;
  Workbench bench;
  bench.edit(road(3 * yields_under(mass)));
  EXPECT_EQ(crossing_text(bench.frame()), "");
  EXPECT_EQ(sent(bench, mass), Crossing::State::across);
  EXPECT_GT(bench.frame().time, (span - 3) / 5.);  // no faster than it drives
  EXPECT_EQ(bench.run().events().size(), 0u);
  bench.run().go_to(bench.run().cursor() + 300);  // beyond the end it falls: it has been across all the same
  EXPECT_EQ(crossing_text(bench.frame()), "the vehicle is across");
  bench.restart();
  EXPECT_FALSE(bench.frame().crossing);

  bench.edit(road(0.3 * yields_under(mass)));
  EXPECT_EQ(sent(bench, mass), Crossing::State::down);
  EXPECT_GT(bench.run().events().size(), 0u);
}

TEST(Crossing, ItsWeightIsTheOneAskedFor) {
  double mass = 0;
  for (const act::Throw& part : act::parts({.mass = 5000})) mass += part.mass;
  EXPECT_NEAR(mass, 5000, 1e-9);
}

TEST(Crossing, NothingToDriveOnIsSaid) {
  Workbench bench;
  EXPECT_FALSE(send_across(bench, 1000, 2, 5));
  EXPECT_NE(bench.message, "");
}

}  // namespace
}  // namespace ductile::viewer
