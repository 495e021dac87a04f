// Outlines into pieces into convex parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convex.h"
#include "ductile/box2d.h"
#include "ductile/moments.h"
#include "orientation.h"
#include "random_outlines.h"
#include "regions.h"
#include "scenes.h"
#include "split.h"

namespace {
using namespace ductile;
using namespace ductile::calibration;

Split split(const Outline& outline, std::span<const Cut> cuts, const std::string& place) {
  return Splitter().split(outline, cuts, place);
}

double area(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const Ring& ring : rings) sum += doubled_area(ring) / 2;
  return sum;
}

void expect_convex(const Ring& ring) {
  EXPECT_GE(ring.size(), 3u);
  EXPECT_LE(ring.size(), 8u);
  for (std::size_t i = 0; i < ring.size(); ++i)
    EXPECT_EQ(orientation(ring[i], ring[(i + 1) % ring.size()], ring[(i + 2) % ring.size()]), 1);
}

TEST(Moments, Rectangle) {
  const AreaMoments m = moments({rectangle(1e6, 0, 1e6 + 4, 2), {}});
  EXPECT_DOUBLE_EQ(m.area, 8);
  EXPECT_EQ(m.centroid, (Point{1e6 + 2, 1}));
  EXPECT_DOUBLE_EQ(m.polar(), 8.0 * (16 + 4) / 12);
}

TEST(Moments, RingsOfAnyOrientation) {
  // A square tube: ∫ r² dA = (a⁴ − b⁴)/6.
  Outline tube{rectangle(-2, -2, 2, 2), {rectangle(-1, -1, 1, 1)}};
  EXPECT_DOUBLE_EQ(moments(tube).polar(), (256.0 - 16.0) / 6);
  std::reverse(tube.outer.begin(), tube.outer.end());
  EXPECT_DOUBLE_EQ(moments(tube).polar(), (256.0 - 16.0) / 6);
  EXPECT_DOUBLE_EQ(moments(tube).area, 12);
}

TEST(Moments, RightTriangle) {
  // Legs b, h: centroid at a third, ∫ r² dA = bh(b² + h²)/36.
  const AreaMoments m = moments({{{0, 0}, {3, 0}, {0, 5}}, {}});
  EXPECT_DOUBLE_EQ(m.area, 7.5);
  EXPECT_DOUBLE_EQ(m.centroid.x, 1);
  EXPECT_DOUBLE_EQ(m.centroid.y, 5.0 / 3);
  EXPECT_DOUBLE_EQ(m.polar(), 15.0 * 34 / 36);
  EXPECT_DOUBLE_EQ(m.xy, -9.0 * 25 / 72);  // −b²h²/72
}

TEST(Split, BeamInThree) {
  const std::vector<Cut> cuts{{{1, 9}, {1, -9}}, {{2, 9}, {2, -9}}};
  const Split s = split({rectangle(0, 0, 3, 1), {}}, cuts, "beam");
  ASSERT_EQ(s.pieces.size(), 3u);
  ASSERT_EQ(s.intervals.size(), 2u);
  for (const Outline& piece : s.pieces) EXPECT_DOUBLE_EQ(moments(piece).area, 1);
  EXPECT_EQ(s.intervals[0].from, (Point{1, 1}));
  EXPECT_EQ(s.intervals[0].to, (Point{1, 0}));
}

TEST(Split, WindowGivesTwoIntervals) {
  const std::vector<Cut> cuts{{{2, -9}, {2, 9}}};
  const Split s = split({rectangle(0, 0, 4, 3), {rectangle(1, 1, 3, 2)}}, cuts, "frame");
  ASSERT_EQ(s.pieces.size(), 2u);
  ASSERT_EQ(s.intervals.size(), 2u);
  EXPECT_EQ(s.intervals[0].to, (Point{2, 1}));
  EXPECT_EQ(s.intervals[1].from, (Point{2, 2}));
  EXPECT_DOUBLE_EQ(moments(s.pieces[0]).area, 5);
}

TEST(Split, WindowBetweenTheCutsStaysAHole) {
  const std::vector<Cut> cuts{{{1, -9}, {1, 9}}, {{9, -9}, {9, 9}}};
  const Split s =
      split({rectangle(0, 0, 10, 3), {rectangle(2, 1, 3, 2), rectangle(4, 1, 5, 2)}}, cuts, "frame");
  ASSERT_EQ(s.pieces.size(), 3u);
  std::size_t holes = 0;
  for (const Outline& piece : s.pieces) holes += piece.holes.size();
  EXPECT_EQ(holes, 2u);
}

// A portal cut along the underside of its beam: the cut runs along an edge between the columns.
TEST(Split, CutAlongAnEdge) {
  const Ring portal{{0, 0}, {1, 0}, {1, 4}, {5, 4}, {5, 0}, {6, 0}, {6, 5}, {0, 5}};
  for (const Cut& cut : {Cut{{-1, 4}, {7, 4}}, Cut{{7, 4}, {-1, 4}}}) {
    const Split s = split({portal, {}}, std::vector{cut}, "portal");
    ASSERT_EQ(s.pieces.size(), 3u);
    ASSERT_EQ(s.intervals.size(), 2u);
    for (const Interval& i : s.intervals) EXPECT_DOUBLE_EQ(length(i.to - i.from), 1);
  }
}

// Where a hole touches the cut with a corner, both sides of that point are still one interval.
TEST(Split, HoleTouchesTheCut) {
  const Outline body{rectangle(0, 0, 4, 4), {{{2, 2}, {1, 2.5}, {1, 1.5}}}};
  const Split s = split(body, std::vector{Cut{{2, -1}, {2, 5}}}, "body");
  ASSERT_EQ(s.pieces.size(), 2u);
  ASSERT_EQ(s.intervals.size(), 1u);
  EXPECT_DOUBLE_EQ(length(s.intervals[0].to - s.intervals[0].from), 4);
  EXPECT_DOUBLE_EQ(moments(s.pieces[0]).area + moments(s.pieces[1]).area, 15.5);
}

TEST(Split, CrossingCutsMakeAGrid) {
  std::vector<Cut> cuts;
  for (int i = 1; i < 5; ++i) cuts.push_back({{i * 1.0, -1}, {i * 1.0, 6}});
  for (int i = 1; i < 5; ++i) cuts.push_back({{-1, i * 1.0}, {6, i * 1.0}});
  const Split s = split({rectangle(0, 0, 5, 5), {}}, cuts, "grid");
  EXPECT_EQ(s.pieces.size(), 25u);
  EXPECT_EQ(s.intervals.size(), 40u);
  for (const Outline& piece : s.pieces) EXPECT_DOUBLE_EQ(moments(piece).area, 1);
}

TEST(Split, ThreeCutsThroughOnePoint) {
  const std::vector<Cut> cuts{{{-9, 0}, {9, 0}}, {{0, -9}, {0, 9}}, {{-9, -8.1}, {9, 8.1}}};
  const Split s = split({rectangle(-1, -1, 1, 1), {}}, cuts, "square");
  EXPECT_EQ(s.pieces.size(), 6u);
  EXPECT_EQ(s.intervals.size(), 6u);
}

TEST(Split, BothLegsOfAU) {
  const Ring u{{0, 0}, {5, 0}, {5, 4}, {4, 4}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
  const Split whole = split({u, {}}, std::vector{Cut{{-1, 2}, {6, 2}}}, "u");
  EXPECT_EQ(whole.pieces.size(), 3u);
  EXPECT_EQ(whole.intervals.size(), 2u);
  const Split one = split({u, {}}, std::vector{Cut{{-1, 2}, {2, 2}}}, "u");
  EXPECT_EQ(one.pieces.size(), 2u);
  EXPECT_EQ(one.intervals.size(), 1u);
  // Ends on the outline count as outside.
  EXPECT_EQ(split({u, {}}, std::vector{Cut{{0, 2}, {1, 2}}}, "u").intervals.size(), 1u);
}

// A spike whose two sides lie on each other but for rounding: cuts that meet both sides in one point make a
// crowd of edges there, whose order around the point nothing tells.
TEST(Split, SpikeWithoutWidth) {
  Outline spikes{{{0, 33}, {81, 15}, {0, 96}, {96, 0}, {0, 30}}, {}};
  for (Point& p : spikes.outer) p = 0.23713737056616552 * p;
  ASSERT_TRUE(validate(spikes).empty());
  SceneDef scene{.bodies = {{.outline = spikes, .material = test_steel, .automatic = true}}};
  const double whole = moments(spikes).area * test_steel.density;
  for (const double error : {0.1, 0.03, 0.01, 0.003, 0.001, 0.0003}) {
    scene.target_error = error;
    double sum = 0;
    for (const Piece& piece : calibrate(scene).pieces) {
      EXPECT_GT(piece.mass, 1e-6 * whole) << error;
      sum += piece.mass;
    }
    EXPECT_NEAR(sum, whole, 1e-14 * whole) << error;
  }
}

TEST(Split, RefusesCutsThatDoNotCut) {
  const Outline ring{rectangle(0, 0, 4, 4), {rectangle(1, 1, 3, 3)}};
  EXPECT_THROW(split(ring, std::vector{Cut{{-1, 5}, {5, 5}}}, "ring"), InvalidInput);    // misses
  EXPECT_THROW(split(ring, std::vector{Cut{{-1, 2}, {0.5, 2}}}, "ring"), InvalidInput);  // ends inside
  EXPECT_THROW(split(ring, std::vector{Cut{{-1, 2}, {2, 2}}}, "ring"), InvalidInput);    // still one piece
  EXPECT_THROW(split(ring, std::vector{Cut{{-1, 0}, {5, 0}}}, "ring"), InvalidInput);    // along an edge
  EXPECT_NO_THROW(split(ring, std::vector{Cut{{-1, 2}, {5, 2}}}, "ring"));
}

// Where rounding puts a vertex that is almost in line with an edge below it, the calipers still find the
// other side.
TEST(LeastWidth, AlmostStraightSides) {
  const Ring ring = hull({{-21.396765879850513, 28.188002244584862},
                          {-21.84212969794255, 27.966828507229437},
                          {-23.571405701396518, 26.260958220142335},
                          {-6.466481955266886, 10.018157500443612},
                          {-5.3435464862207649, 10.435045663569575},
                          {-2.7666546876115108, 7.8826389878421912},
                          {-3.1835741472791943, 6.9007149384238442},
                          {26.288825593616949, -21.086215773909561},
                          {27.996015044544656, -18.715281830459329}});
  double least = unlimited;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point p = ring[i], u = unit(ring[(i + 1) % ring.size()] - p);
    double most = 0;
    for (const Point& q : ring) most = std::max(most, cross(u, q - p));
    least = std::min(least, most);
  }
  EXPECT_NEAR(least_width(ring), least, 1e-12);
}

TEST(ConvexParts, FewForPlainShapes) {
  EXPECT_EQ(convex_parts({rectangle(0, 0, 4, 1), {}}, 8).size(), 1u);
  const Ring l{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  EXPECT_EQ(convex_parts({l, {}}, 8).size(), 2u);
  EXPECT_EQ(convex_parts({rectangle(0, 0, 4, 4), {rectangle(1, 1, 3, 3)}}, 8).size(), 4u);
  // Collinear vertices are not corners.
  const Ring dotted{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {4, 1}, {3, 1}, {2, 1}, {1, 1}, {0, 1}, {0, 0.5}};
  EXPECT_LE(convex_parts({dotted, {}}, 8).size(), 2u);
  Ring disc;
  for (int i = 0; i < 64; ++i)
    disc.push_back({std::cos(i * std::numbers::pi / 32), std::sin(i * std::numbers::pi / 32)});
  EXPECT_LE(convex_parts({disc, {}}, 8).size(), 22u);  // 62 triangles, at most 6 in a part: at least 11
}

// Three edges on one line, folded: the spike to (5, 10) has no width but by rounding, and is no corner of
// what lies beside its foot.
TEST(ConvexParts, LeaveOutASpikeWithoutWidth) {
  Outline folded{{{-15, 5}, {-4, -7}, {-3, 8}, {-11, 6}, {5, 10}}, {}};
  for (Point& p : folded.outer) p = 3.3982083289425596 * p;
  const double whole = moments(folded).area;
  EXPECT_NEAR(area(convex_parts(folded, 8)), whole, 1e-12 * whole);
}

// Two spikes on one line, to (101, −151) and (−101, 50): within 1e-12 of the size their sides go straight on
// into each other, and a part that takes that for convex would lose the corner at their feet.
TEST(ConvexParts, KeepTheCornerAtTheFeetOfTwoSpikes) {
  const Outline spikes{{{0, -50.48065716667471},
                        {0.75228820587278744, -97.122525930787532},
                        {2.1654459264312274, -184.7383046054108},
                        {149.19714605293123, -184.13151744744755},
                        {150.36479620398885, -35.839948263130282},
                        {33.307125681699716, -83.78778284837442},
                        {100.96131433334942, -151.44197150002412},
                        {33.307125681699688, -83.787782848374391},
                        {-28.062830890831279, -22.417826275843424},
                        {-100.96131433334942, 50.48065716667471},
                        {-28.062830890831293, -22.417826275843417}},
                       {}};
  const double whole = moments(spikes).area;
  EXPECT_NEAR(area(convex_parts(spikes, 8)), whole, 1e-12 * whole);
}

// What touches is bounded together; the convex parts cover it and leave the holes out.
struct TouchingCase {
  const char* name;
  std::vector<Ring> holes;  // in a rectangle 0 ≤ x ≤ 60, 0 ≤ y ≤ 20
  std::vector<double> areas;
  std::size_t holes_left;
};

class Touching : public testing::TestWithParam<TouchingCase> {};

TEST_P(Touching, RegionsAndConvexParts) {
  const TouchingCase& c = GetParam();
  const Outline outline{rectangle(0, 0, 60, 20), c.holes};
  std::vector<double> areas;
  std::size_t holes = 0;
  double sum = 0;
  for (const Outline& region : regions(outline)) {
    areas.push_back(moments(region).area);
    holes += region.holes.size();
  }
  for (const double area : c.areas) sum += area;
  std::sort(areas.begin(), areas.end());
  EXPECT_EQ(areas, c.areas);
  EXPECT_EQ(holes, c.holes_left);
  const std::vector<Ring> parts = convex_parts(outline, 8);
  for (const Ring& part : parts) expect_convex(part);
  EXPECT_NEAR(area(parts), sum, 1e-12 * sum);
}

const TouchingCase touching_cases[] = {
    {"nothing", {rectangle(10, 5, 20, 15)}, {1100}, 1},
    {"a_corner", {{{10, 5}, {20, 0}, {20, 10}}}, {1150}, 0},
    {"part_of_an_edge", {rectangle(10, 0, 20, 10)}, {1100}, 0},
    {"a_whole_side", {rectangle(0, 0, 10, 20)}, {1000}, 0},
    {"side_to_side", {rectangle(10, 0, 20, 20)}, {200, 800}, 0},
    {"side_to_side_by_a_corner", {{{30, 0}, {0, 0}, {17, 20}}}, {170, 730}, 0},
    {"each_other", {rectangle(10, 5, 20, 15), rectangle(20, 5, 30, 15)}, {1000}, 1},
    {"each_other_from_side_to_side", {rectangle(10, 0, 20, 12), rectangle(10, 12, 20, 20)}, {200, 800}, 0},
    {"around_an_island",
     {{{10, 5}, {20, 5}, {20, 6}, {11, 6}, {11, 14}, {20, 14}, {20, 15}, {10, 15}},
      {{20, 5}, {30, 5}, {30, 15}, {20, 15}, {20, 14}, {29, 14}, {29, 6}, {20, 6}}},
     {144, 1000},
     1},
};
INSTANTIATE_TEST_SUITE_P(Holes, Touching, testing::ValuesIn(touching_cases),
                         [](const auto& info) { return info.param.name; });

TEST(Fuzz, AreasAddUpAndPartsAreConvex) {
  for (int seed = 0, n = rounds(3000); seed < n && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Outline outline = random_outline(random);
    if (!validate(outline).empty()) continue;
    std::vector<Cut> cuts = random_cuts(random, outline);
    const AreaMoments whole = moments(outline);
    Split s;
    for (;;) try {
        s = split(outline, cuts, "body");
        break;
      } catch (const InvalidInput&) {
        ASSERT_FALSE(cuts.empty());
        cuts.pop_back();  // a cut that touches only a vertex, say
      }
    double sum = 0;
    for (const Outline& piece : s.pieces) {
      const double own = moments(piece).area;
      EXPECT_GT(own, 0);
      sum += own;
      const std::vector<Ring> parts = convex_parts(piece, 8);
      for (const Ring& part : parts) expect_convex(part);
      // Parts may bulge by 1e-12 of the outline's size.
      double size = 0;
      for (const Point& p : outline.outer) size = std::max(size, length(p - outline.outer[0]));
      EXPECT_NEAR(area(parts), own, 1e-9 * whole.area + 1e-11 * size * size);
    }
    // Where an outline lies far from the origin, the points that a cut makes are rounded to its coordinates.
    double coordinate = 0;
    for (const Point& p : outline.outer) coordinate = std::max(coordinate, length(p));
    const double rounding = 2.2e-16 * coordinate * length(outline.outer[0] - whole.centroid) * 10;
    EXPECT_NEAR(sum, whole.area, 1e-12 * whole.area + rounding);
    for (const Interval& i : s.intervals) EXPECT_NE(i.left, i.right);

    // All the way to Box2D, whose asserts abort; too thin for it is refused.
    BodyDef body{.outline = outline, .material = test_steel};
    for (const Cut& cut : cuts) body.cuts.push_back({cut.from, cut.to});
    std::vector<Piece> pieces;
    try {
      pieces = calibrate(body).pieces;
    } catch (const InvalidInput&) {  // a section too thin to compute with
    }
    for (const Piece& piece : pieces) {
      try {
        for (const b2PolygonShape& shape : shapes(piece)) EXPECT_TRUE(shape.Validate());
      } catch (const InvalidInput&) {
      }
    }
  }
}

// Whatever Box2D takes whole, it takes in the pieces that it is split into, and they are as much.
TEST(Fuzz, AutomaticPiecesAreForBox2D) {
  int split = 0, welded = 0;
  for (int seed = 0, n = rounds(3000); seed < n && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const Outline outline = random_outline(random);
    if (!validate(outline).empty()) continue;
    BodyDef body{.outline = outline, .material = test_steel};
    const Piece whole = calibrate(body).pieces[0];
    body.automatic = true;
    SceneDef scene;
    scene.target_error = std::pow(10, uniform(random, -3, -0.5));
    scene.bodies = {body};
    if (seed % 2 == 1) {  // welded to a wall along its longest edge
      const Ring& ring = outline.outer;
      std::size_t longest = 0;
      const auto edge = [&](std::size_t i) { return ring[(i + 1) % ring.size()] - ring[i]; };
      for (std::size_t i = 1; i < ring.size(); ++i)
        if (length(edge(i)) > length(edge(longest))) longest = i;
      const Point p = ring[longest], q = p + edge(longest),
                  out = (doubled_area(ring) > 0 ? 1 : -1) * right(q - p);
      scene.bodies.push_back(
          {.name = "wall", .type = BodyType::static_body, .outline = {{q, p, p + out, q + out}, {}}});
      scene.joints = {{.a = "wall", .b = "body"}};
    }
    Plan plan;
    try {
      plan = calibrate(scene);
    } catch (const InvalidInput&) {
      if (scene.joints.empty()) throw;
      continue;  // a weld of no height
    }
    std::erase_if(plan.pieces, [](const Piece& piece) { return piece.body > 0; });
    split += plan.pieces.size() > 1;
    double mass = 0;
    bool taken = true;
    try {
      shapes(whole);
    } catch (const InvalidInput&) {
      taken = false;
    }
    for (const Piece& piece : plan.pieces) {
      mass += piece.mass;
      EXPECT_GT(piece.inertia, 0);
      if (!taken) continue;
      for (const b2PolygonShape& shape : shapes(piece)) EXPECT_TRUE(shape.Validate());
    }
    double coordinate = 0;
    for (const Point& p : outline.outer) coordinate = std::max(coordinate, length(p));
    const double rounding = 2.2e-16 * coordinate * length(outline.outer[0] - whole.center) *
                            static_cast<double>(plan.pieces.size());
    EXPECT_NEAR(mass, whole.mass, 1e-12 * whole.mass + rounding * 7800);
    for (const PlannedJoint& joint : plan.joints) EXPECT_GT(joint.stiffness.M, 0);
    welded += !scene.joints.empty();
  }
  EXPECT_GT(welded, rounds(3000) / 8);
  EXPECT_GT(split, rounds(3000) / 4);
}

}  // namespace
