// Parts of scenes: copied, pasted, mirrored, turned.
#include "part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "ductile/design.h"
#include "ductile/files.h"
#include "gate.h"
#include "workbench.h"

namespace ductile::viewer {
namespace {

TEST(Part, IsPastedWithWhatHoldsLoadsAndJoinsIt) {
  SceneDef scene = with_next_support(with_load(gate(), {0, 3}, {0, -1}), {2, 3}, 0);
  scene = with_weld_or_pin(scene, {2, 3});
  const SceneDef part = part_of(scene, {"beam2", "beam3"});
  EXPECT_EQ(part.joints.size(), 1u);  // not those to the floor and to the other post
  EXPECT_EQ(length(grip_of(part) - Point{2, 0}), 0);
  const Joined joined = with_part(scene, shifted(part, {5, 0}));
  EXPECT_EQ(joined.added, (std::vector<std::string>{"beam4", "beam5"}));
  ASSERT_EQ(joined.scene.loads.size(), 2u);
  EXPECT_EQ(joined.scene.loads[1].body, "beam5");
  EXPECT_EQ(joined.scene.loads[1].at.x, 5);
  ASSERT_EQ(joined.scene.supports.size(), 2u);
  EXPECT_EQ(joined.scene.joints.size(), scene.joints.size() + 2);  // its own, and its foot on the floor
  const auto weld =
      std::find_if(joined.scene.joints.begin(), joined.scene.joints.end(),
                   [](const JointBetweenDef& j) { return j.at && j.at->x == 7 && j.at->y == 3; });
  ASSERT_NE(weld, joined.scene.joints.end());
  EXPECT_TRUE(weld->overrides.moment);
  EXPECT_NO_THROW(calibrate(joined.scene));
  EXPECT_EQ(with_part(scene, part).added.size(), 0u);  // where it is already
  EXPECT_EQ(with_part(scene, part).scene.loads.size(), 1u);
}

// What is pasted is an assembly of its own; what is turned stays the one that it was.
TEST(Part, AnAssemblyIsTakenAsOneAndACopyOfItIsAnother) {
  const SceneDef scene = with_assembly(gate(), {"beam1", "beam3"});
  EXPECT_EQ(with_assemblies(scene, {"beam3"}), (std::vector<std::string>{"beam3", "beam1"}));
  EXPECT_EQ(with_assemblies(scene, {"beam2"}), (std::vector<std::string>{"beam2"}));
  const SceneDef read = parse_scene(scene_text(scene));
  EXPECT_EQ(with_assemblies(read, {"beam3"}).size(), 2u);
  const SceneDef part = part_of(scene, {"beam1", "beam3"});
  const SceneDef twice = with_part(scene, shifted(part, {6, 0})).scene;
  EXPECT_EQ(with_assemblies(twice, {"beam4"}), (std::vector<std::string>{"beam4", "beam5"}));
  EXPECT_EQ(with_assemblies(twice, {"beam1"}), (std::vector<std::string>{"beam1", "beam3"}));
  const SceneDef rest = without_body(without_body(scene, "beam1"), "beam3");
  EXPECT_EQ(with_part(rest, part).scene.bodies.back().assembly, scene.bodies[1].assembly);
  EXPECT_EQ(with_assemblies(without_assemblies(twice, {"beam5"}), {"beam4"}).size(), 1u);
}

// A mirror changes no force: both halves of a bridge made of one carry the same, and what is mirrored twice
// is what it was.
TEST(Part, AMirrorShowsTheSameStructure) {
  BeamStyle style;
  style.profile = "UPN 100";
  SceneDef half = with_beam(empty_scene(), {{-4, 1}, {0, 1}}, style);
  half = with_beam(half, {{-4, 1}, {-2, 3}}, {});
  half = with_beam(half, {{-2, 3}, {0, 1}}, {});
  half = with_next_support(half, {-4, 1}, 0);
  half = with_load(half, {-2, 3}, {3e3, -20e3});
  const std::vector<std::string> all{"beam1", "beam2", "beam3"};
  SceneDef twice = mirrored(mirrored(part_of(half, all), 0.3), 0.3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(length(axis_of(twice.bodies[i])->from - axis_of(half.bodies[i + 1])->from), 0, 1e-12);
    EXPECT_NEAR(length(axis_of(twice.bodies[i])->to - axis_of(half.bodies[i + 1])->to), 0, 1e-12);
  }
  const Joined joined = with_part(half, mirrored(part_of(half, all), 0));
  EXPECT_EQ(joined.added.size(), 3u);
  ASSERT_EQ(joined.scene.loads.size(), 2u);
  EXPECT_EQ(joined.scene.loads[1].force.x, -3e3);
  SceneDef whole = joined.scene;
  whole = with_beam(whole, {{-2, 3}, {2, 3}}, style);
  const Plan plan = calibrate(whole);
  const StaticCheck check = static_check(plan);
  int compared = 0;
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const PlannedJoint& a = plan.joints[i];
    if (a.anchor.x > -1e-6 || a.a < 0 ||
        plan.pieces[static_cast<std::size_t>(a.a)].body != plan.pieces[static_cast<std::size_t>(a.b)].body)
      continue;
    for (std::size_t k = 0; k < plan.joints.size(); ++k) {
      const PlannedJoint& b = plan.joints[k];
      if (b.a < 0 || b.node != 0 || length(b.anchor - Point{-a.anchor.x, a.anchor.y}) > 1e-9) continue;
      EXPECT_NEAR(check.joints[i].N, check.joints[k].N, 1e-6 * 20e3) << a.name << b.name;
      EXPECT_NEAR(std::abs(check.joints[i].M), std::abs(check.joints[k].M), 1e-6 * 20e3) << a.name << b.name;
      ++compared;
    }
  }
  EXPECT_GE(compared, 15);
}

// What is turned with its loads, supports and gravity carries what it carried.
TEST(Part, TurnedWithAllThatLoadsItCarriesTheSame) {
  SceneDef scene = with_beam(empty_scene(), {{-4, 1}, {0, 1}}, {});
  scene = with_beam(scene, {{-4, 1}, {-2, 3}}, {});
  scene = with_beam(scene, {{-2, 3}, {0, 1}}, {});
  scene = with_next_support(scene, {-4, 1}, 0);
  scene = with_next_support(with_next_support(scene, {0, 1}, 0), {0, 1}, 0);  // a roller
  scene = with_load(scene, {-2, 3}, {3e3, -20e3});
  scene.bodies.erase(scene.bodies.begin());  // the floor
  std::erase_if(scene.joints, [](const JointBetweenDef& j) { return j.a == "floor" || j.b == "floor"; });
  constexpr double quarter_turn = std::numbers::pi / 2;
  SceneDef quarter = turned(scene, {1, 2}, quarter_turn);
  EXPECT_NEAR(length(axis_of(quarter.bodies[0])->from - Point{2, -3}), 0, 1e-14);
  EXPECT_NEAR(length(axis_of(quarter.bodies[0])->to - Point{2, 1}), 0, 1e-14);
  quarter.gravity = {-scene.gravity.y, scene.gravity.x};
  const Plan plan = calibrate(scene);
  const StaticCheck was = static_check(plan), is = static_check(calibrate(quarter));
  ASSERT_EQ(was.joints.size(), is.joints.size());
  for (std::size_t i = 0; i < was.joints.size(); ++i) {
    // A support's rows are along the world's axes, and did not turn.
    const bool support = plan.joints[i].a < 0 || plan.joints[i].b < 0;
    EXPECT_NEAR(is.joints[i].N, support ? -was.joints[i].Q : was.joints[i].N, 1e-6 * 20e3) << i;
    EXPECT_NEAR(std::abs(is.joints[i].M), std::abs(was.joints[i].M), 1e-6 * 20e3) << i;
  }
  SceneDef round = scene;
  for (int i = 0; i < 4; ++i) round = turned(round, {1, 2}, quarter_turn);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    EXPECT_NEAR(length(axis_of(round.bodies[i])->to - axis_of(scene.bodies[i])->to), 0, 1e-14);
  EXPECT_EQ(round.supports[1].fix_x, scene.supports[1].fix_x);
}

// By an angle at which a roller would roll neither along x nor along y, between hinges.
TEST(Part, TurnsByAnyAngleWhereItsSupportsCan) {
  constexpr double angle = 0.3;
  SceneDef scene = with_beam(empty_scene(), {{-4, 1}, {0, 1}}, {});
  scene = with_beam(scene, {{-4, 1}, {-2, 3}}, {});
  scene = with_beam(scene, {{-2, 3}, {0, 1}}, {});
  scene = with_next_support(with_next_support(scene, {-4, 1}, 0), {0, 1}, 0);
  scene = with_load(scene, {-2, 3}, {3e3, -20e3});
  scene = part_of(scene, {"beam1", "beam2", "beam3"});
  SceneDef aslant = turned(scene, {1, 2}, angle);
  const Point end = axis_of(aslant.bodies[1])->to;  // (-3, 1) from where it turns about
  EXPECT_NEAR(end.x, 1 - 3 * std::cos(angle) - std::sin(angle), 1e-14);
  EXPECT_NEAR(end.y, 2 - 3 * std::sin(angle) + std::cos(angle), 1e-14);
  EXPECT_NEAR(aslant.loads[0].force.x, 3e3 * std::cos(angle) + 20e3 * std::sin(angle), 1e-9);
  aslant.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle)};
  const Plan plan = calibrate(scene);
  const StaticCheck was = static_check(plan), is = static_check(calibrate(aslant));
  ASSERT_EQ(was.joints.size(), is.joints.size());
  int compared = 0;
  for (std::size_t i = 0; i < was.joints.size(); ++i) {
    if (plan.joints[i].a < 0 || plan.joints[i].b < 0)
      continue;                                  // a support's rows are along the world's axes
    const bool node = plan.joints[i].node != 0;  // and a pin's of its own
    EXPECT_NEAR(std::hypot(is.joints[i].N, is.joints[i].Q), std::hypot(was.joints[i].N, was.joints[i].Q),
                1e-6 * 20e3);
    if (!node) {
      EXPECT_NEAR(is.joints[i].M, was.joints[i].M, 1e-6 * 20e3) << plan.joints[i].name;
    }
    ++compared;
  }
  EXPECT_GE(compared, 15);
  EXPECT_THROW(turned(with_next_support(scene, {0, 1}, 0), {1, 2}, angle), InvalidInput);  // a roller
}

TEST(Part, OtherBodiesAreMirroredWithTheirCuts) {
  Workbench bench;
  bench.open(DUCTILE_SOURCE_DIR "/scenes/harbour_crane.scene.json");
  const SceneDef& scene = bench.scene();
  std::vector<std::string> all;
  for (const BodyDef& body : scene.bodies) all.push_back(body.name);
  const Plan plan = calibrate(scene), mirror = calibrate(mirrored(part_of(scene, all), 5));
  ASSERT_EQ(plan.pieces.size(), mirror.pieces.size());
  std::multiset<double> M, M_mirror;
  for (const PlannedJoint& joint : plan.joints) M.insert(joint.M + joint.M_reverse);
  for (const PlannedJoint& joint : mirror.joints) M_mirror.insert(joint.M + joint.M_reverse);
  ASSERT_EQ(M.size(), M_mirror.size());
  for (auto a = M.begin(), b = M_mirror.begin(); a != M.end(); ++a, ++b) {
    if (std::isfinite(*a)) {
      EXPECT_NEAR(*b, *a, 1e-9 * *a);
    } else {
      EXPECT_EQ(*b, *a);
    }
  }
}

}  // namespace
}  // namespace ductile::viewer
