// The jib of the harbour crane, "split": "auto": a flared root, a curved soffit, six lightening holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/design.h"
#include "ductile/files.h"
#include "structures.h"

namespace {
using namespace ductile;

Plan crane(double target) {
  SceneDef scene = read_scene(DUCTILE_SOURCE_DIR "/scenes/harbour_crane.scene.json");
  scene.target_error = target;
  for (BodyDef& body : scene.bodies)
    if (body.name == "jib") {
      body.pieces = 1;
      body.automatic = true;
    }
  scene.joints.resize(1);  // the jib alone, out of its pillar, under its own weight
  scene.loads.clear();
  std::erase_if(scene.bodies, [](const BodyDef& b) { return b.name == "rope" || b.name == "container"; });
  return calibrate(scene);
}

// Of the jib, from the pillar on: where its pieces' centres are, and how far they sink, m.
std::vector<Point> sag(const Plan& plan) {
  const StaticCheck check = static_check(plan);
  std::vector<Point> result;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (plan.pieces[i].name.starts_with("jib"))
      result.push_back({plan.pieces[i].center.x, -check.displacement[i].y});
  return result;
}

double sag_at(const std::vector<Point>& line, double x) {
  std::size_t i = 1;
  while (i + 1 < line.size() && line[i].x < x) ++i;
  return std::lerp(line[i - 1].y, line[i].y, (x - line[i - 1].x) / (line[i].x - line[i - 1].x));
}

TEST(AutomaticSplit, TheCranesJib) {
  const Plan fine = crane(0.0005);
  const std::vector<Point> exact = sag(fine);
  // Of the sag of a level cantilever as deep as the jib is half way out, shear is w L²/(2 κ G A) over w L⁴/(8
  // EI) with κ = 5/6, E/G = 2.6 and I/A = h²/12.
  const double long_way = exact.back().x - exact.front().x;
  const auto half_way = std::min_element(fine.joints.begin(), fine.joints.end(),
                                         [&](const PlannedJoint& a, const PlannedJoint& b) {
                                           const double x = exact.front().x + long_way / 2;
                                           return std::abs(a.anchor.x - x) < std::abs(b.anchor.x - x);
                                         });
  const double shear = 4 * 2.6 * 1.2 / 12 * std::pow(half_way->height / long_way, 2);
  for (const double target : {0.1, 0.05, 0.02, 0.01, 0.005, 0.003}) {
    SCOPED_TRACE(target);
    const Plan plan = crane(target);
    ASSERT_EQ(plan.split_errors.size(), 1u);
    EXPECT_LE(plan.split_errors[0].error, target);
    EXPECT_EQ(plan.split_errors[0].governed_by, "target error");
    EXPECT_LE(plan.pieces.size(), 5 + std::ceil(3 / std::sqrt(target)));
    // It ends at the pillar with one face, not in the corner below it.
    EXPECT_EQ(std::count_if(plan.joints.begin(), plan.joints.end(),
                            [](const PlannedJoint& j) { return j.name.starts_with("pillar-"); }),
              1);
    EXPECT_NEAR(plan.joints.back().axis.x, 1, 1e-9);
    double mass = 0;
    for (const Piece& piece : plan.pieces) {
      if (!piece.name.starts_with("jib")) continue;
      mass += piece.mass;
      const auto parts = shapes(piece);
      EXPECT_FALSE(parts.empty());
      for (const b2PolygonShape& shape : parts) EXPECT_TRUE(shape.Validate());
    }
    double whole = 0;
    for (const Piece& piece : fine.pieces) whole += piece.name.starts_with("jib") ? piece.mass : 0;
    EXPECT_NEAR(mass / whole, 1, 1e-12);
    const std::vector<Point> own = sag(plan);
    double measured = 0;
    for (const Point& p : own)
      measured = std::max(measured, std::abs(p.y - sag_at(exact, p.x)) / exact.back().y);
    // The estimate leaves out shear.
    EXPECT_LE(measured, target + shear);
  }
}

}  // namespace
