// What is taken and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "shapes.h"

namespace {
using namespace ductile;
using namespace ductile::shapes;

constexpr double infinity = std::numeric_limits<double>::infinity(),
                 nan_value = std::numeric_limits<double>::quiet_NaN();

std::string all(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + "\n";
  return text;
}

// ---- one outline ----

struct Good {
  const char* name;
  Outline outline;
  double area;
};

Ring closed(Ring ring) {
  ring.push_back(ring.front());
  return ring;
}
Ring reversed(Ring ring) { return {ring.rbegin(), ring.rend()}; }

class Accepted : public testing::TestWithParam<Good> {};

TEST_P(Accepted, OddButValid) {
  const auto& [name, outline, area] = GetParam();
  EXPECT_EQ(all(validate(outline)), "");
  EXPECT_NEAR(Section(outline, materials::S235).area(), area, 1e-14 * area);
}

INSTANTIATE_TEST_SUITE_P(
    Outlines, Accepted,
    testing::Values(Good{"plain", {rectangle(2, 1)}, 2}, Good{"closing point", {closed(rectangle(2, 1))}, 2},
                    Good{"clockwise", {reversed(rectangle(2, 1))}, 2},
                    Good{"clockwise with clockwise hole",
                         {reversed(rectangle(2, 1)), {reversed(rectangle(1, 0.5, {0.5, 0.25}))}},
                         1.5},
                    Good{"counter-clockwise hole", {rectangle(2, 1), {rectangle(1, 0.5, {0.5, 0.25})}}, 1.5},
                    Good{"closed hole", {rectangle(2, 1), {closed(rectangle(1, 0.5, {0.5, 0.25}))}}, 1.5},
                    Good{"collinear points",
                         {{{0, 0}, {1, 0}, {1.5, 0}, {2, 0}, {2, 0.5}, {2, 1}, {1, 1}, {0, 1}, {0, 0.25}}},
                         2},
                    Good{"triangle", {{{0, 0}, {1, 0}, {0, 1}}}, 0.5},
                    Good{"hole that touches the outline in a point",
                         {rectangle(2, 2), {{{0, 1}, {1, 0.5}, {1, 1.5}}}},
                         3.5},
                    Good{"hole that touches the outline along an edge",
                         {rectangle(2, 2), {rectangle(1, 0.5, {0, 0.5})}},
                         3.5},
                    Good{"hole in the corner, vertex on vertex",
                         {rectangle(2, 2), {{{0, 0}, {1, 0.5}, {0.5, 1}}}},
                         3.625},
                    Good{"holes that touch in a point",
                         {rectangle(4, 4), {rectangle(1, 1, {1, 1}), rectangle(1, 1, {2, 2})}},
                         14},
                    Good{"holes that touch along an edge",
                         {rectangle(4, 4), {rectangle(1, 1, {1, 1}), rectangle(1, 2, {2, 1})}},
                         13},
                    Good{"thin spike that is not flat",
                         {{{0, 0}, {1, 0}, {1, 1}, {0.5, 1}, {0.5, 2}, {0.5 - 1e-15, 1}, {0, 1}}},
                         1 + 0.5 * 1e-15},
                    Good{"very small", {rectangle(1e-40, 1e-40)}, 1e-80},
                    Good{"very large", {rectangle(1e40, 1e40)}, 1e80},
                    Good{"thinnest", {rectangle(1, 1e-9)}, 1e-9}),
    [](const auto& info) {
      std::string name = info.param.name;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

struct Bad {
  const char* name;
  Outline outline;
  std::vector<const char*> says;  // each in one line of the problems, which has no other lines
};

class Refused : public testing::TestWithParam<Bad> {};

TEST_P(Refused, WithOneLineForEachProblem) {
  const auto& [name, outline, says] = GetParam();
  const auto problems = validate(outline, "plate");
  ASSERT_EQ(problems.size(), says.size()) << all(problems);
  for (std::size_t i = 0; i < says.size(); ++i) {
    EXPECT_NE(to_string(problems[i]).find(says[i]), std::string::npos) << says[i] << "\nnot in\n"
                                                                       << all(problems);
    EXPECT_FALSE(problems[i].place.empty() || problems[i].what.empty() || problems[i].remedy.empty());
  }
  EXPECT_THROW(Section(outline, materials::S235), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(
    Outlines, Refused,
    testing::Values(
        Bad{"empty", {}, {"plate.outer: has 0 points; a ring needs at least three"}},
        Bad{"one point", {{{0, 0}}}, {"plate.outer: has 1 point;"}},
        Bad{"two points", {{{0, 0}, {1, 1}}}, {"plate.outer: has 2 points;"}},
        Bad{"two points closed", {{{0, 0}, {1, 1}, {0, 0}}}, {"plate.outer: has 2 points;"}},
        Bad{"not a number", {{{0, 0}, {1, nan_value}, {1, 1}}}, {"plate.outer[1]: (1, nan) is not finite"}},
        Bad{"infinite", {{{0, 0}, {1, 0}, {-infinity, 1}}}, {"plate.outer[2]: (-inf, 1) is not finite"}},
        Bad{"all not finite",
            {{{nan_value, 0}, {infinity, 0}, {1, 1}}},
            {"plate.outer[0]", "plate.outer[1]"}},
        Bad{"too far", {{{0, 0}, {1e200, 0}, {0, 1}}}, {"plate.outer[1]: (1e+200, 0) is too far away"}},
        Bad{"too small", {rectangle(1e-60, 1e-60)}, {"is 1e-60 m by 1e-60 m"}},
        Bad{"line", {{{0, 0}, {1, 1}, {2, 2}, {3, 3}}}, {"plate.outer: has no area"}},
        Bad{"one point four times", {{{1, 1}, {1, 1}, {1, 1}, {1, 1}}}, {"plate.outer: has no area"}},
        Bad{"line but for rounding",
            {{{0.1, 0}, {0.7, 0.2}, {1.9, 0.6}}},
            {"plate: 2.22045e-17 m2 in an extent of 1.8 m"}},
        Bad{"there and back", {{{0, 0}, {1, 0}, {2, 0}, {1, 0}}}, {"plate.outer: has no area"}},
        Bad{"repeats a point at once",
            {{{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}}},
            {"plate.outer[2]: repeats the point (1, 0) of vertex 1"}},
        Bad{"closing point twice",
            {{{0, 0}, {1, 0}, {1, 1}, {0, 0}, {0, 0}}},
            {"plate.outer[0]: repeats the point (0, 0) of vertex 3"}},
        Bad{"repeats a point later",
            {{{0, 0}, {2, 0}, {1, 1}, {2, 2}, {0, 2}, {1, 1}}},
            {"plate.outer[5]: is the same point (1, 1) as vertex 2"}},
        Bad{"bow tie",
            {{{0, 0}, {1, 1}, {1, 0}, {0, 1}}},
            {"plate.outer: edges 0 and 2 cross near (0.5, 0.5)"}},
        Bad{"pentagram",
            {{{0, 1}, {0.6, -0.8}, {-0.9, 0.3}, {0.9, 0.3}, {-0.6, -0.8}}},
            {"cross", "cross", "cross"}},
        Bad{"vertex on an edge",
            {{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}},
            {"plate.outer[3]: (1, 0) lies on edge 0"}},
        Bad{"spike",
            {{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {1, 1}, {0, 1}}},
            {"plate.outer[4]: is the same point (1, 1) as vertex 2"}},
        Bad{"spike back over an edge",
            {{{0, 0}, {2, 0}, {1, 0}, {1, 1}}},
            {"plate.outer[2]: (1, 0) lies on edge 0"}},
        Bad{"hole outside",
            {rectangle(1, 1), {rectangle(1, 1, {2, 0})}},
            {"plate.holes[0]: lies outside its outline near (2, 1)"}},
        Bad{"hole around",
            {rectangle(1, 1), {rectangle(3, 3, {-1, -1})}},
            {"plate.holes[0]: lies outside its outline"}},
        Bad{"hole across",
            {rectangle(2, 2), {rectangle(2, 1, {1, 0.5})}},
            {"plate.holes[0]: edge 0 crosses edge 1 of plate.outer near (2, 0.5)"}},
        Bad{"hole across through vertices",
            {{{0, 0}, {2, 0}, {2, 1}, {2, 2}, {0, 2}}, {{{1, 0.5}, {2, 1}, {3, 1}, {1, 1.5}}}},
            {"plate.holes[0]"}},
        Bad{"holes overlap",
            {rectangle(4, 4), {rectangle(1, 1, {1, 1}), rectangle(1, 1, {1.5, 1.5})}},
            {"plate.holes[1]: edge"}},
        Bad{"hole twice",
            {rectangle(4, 4), {rectangle(1, 1, {1, 1}), rectangle(1, 1, {1, 1})}},
            {"plate.holes[1]: overlaps plate.holes[0] in area near (1, 2)"}},
        Bad{"hole in a hole",
            {rectangle(4, 4), {rectangle(2, 2, {1, 1}), rectangle(1, 1, {1.5, 1.5})}},
            {"plate.holes[1]: overlaps plate.holes[0] in area near (1.5, 2.5)"}},
        Bad{"all hole", {rectangle(4, 4), {rectangle(4, 4)}}, {"plate.outer: has no area left"}},
        Bad{"holes share it out",
            {rectangle(4, 4), {rectangle(4, 1), rectangle(4, 3, {0, 1})}},
            {"plate.outer: has no area left"}},
        Bad{"hole crosses itself",
            {rectangle(4, 4), {{{1, 1}, {2, 2}, {2, 1}, {1, 2}}}},
            {"plate.holes[0]: edges 0 and 2 cross near (1.5, 1.5)"}},
        Bad{"several at once",
            {{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {{{0, nan_value}, {1, 1}, {2, 2}}, {{0, 0}, {1, 1}}}},
            {"plate.holes[0][0]: (0, nan) is not finite", "plate.holes[1]: has 2 points",
             "plate.outer: edges 0 and 2 cross"}}),
    [](const auto& info) {
      std::string name = info.param.name;
      for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
      return name;
    });

// ---- many vertices: names what is wrong among 10⁵ of them ----

Ring gear(int n) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * 3.14159265358979323846 * i / n, r = i % 2 == 0 ? 1 : 0.9;
    ring.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return ring;
}

TEST(Large, AValidOutlineIsAccepted) { EXPECT_EQ(all(validate({gear(100000)})), ""); }

TEST(Large, EachFaultIsNamed) {
  Ring ring = regular(100000, 1);
  std::swap(ring[500], ring[501]);
  ring[40000] = ring[70000];
  EXPECT_EQ(validate({ring}).size(), 2u);
  const std::string text = all(validate({ring}));
  EXPECT_NE(text.find("outline.outer: edges 499 and 501 cross"), std::string::npos) << text;
  EXPECT_NE(text.find("outline.outer[70000]: is the same point"), std::string::npos) << text;
}

TEST(Large, EverythingCrossingEndsSoon) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  Ring ring;
  for (int i = 0; i < 20000; ++i) ring.push_back({uniform(random), uniform(random)});
  const auto problems = validate({ring});
  EXPECT_GE(problems.size(), 50u);
  EXPECT_LE(problems.size(), 200u);
}

TEST(Large, ManyHolesAndManyRegions) {
  Outline sieve{rectangle(100, 100), {}};
  std::vector<Region> tiles;
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) {
      sieve.holes.push_back(rectangle(0.5, 0.5, {i + 0.25, j + 0.25}));
      tiles.push_back({{rectangle(1, 1, {1.0 * i, 1.0 * j})}, materials::S235});
    }
  EXPECT_EQ(all(validate(sieve)), "");
  EXPECT_EQ(all(validate(tiles)), "");
  sieve.holes[1234] = rectangle(2, 0.5, {sieve.holes[1234][0].x, sieve.holes[1234][0].y});
  EXPECT_FALSE(validate(sieve).empty());
  tiles[777].outline.outer[2].x += 0.5;
  EXPECT_NE(all(validate(tiles)).find("regions[777]"), std::string::npos);
}

// ---- several regions ----

Region steel(Outline outline) { return {std::move(outline), materials::S235}; }

TEST(Regions, MayTouchAndFillHoles) {
  const Outline frame{rectangle(4, 4), {rectangle(2, 2, {1, 1})}};
  for (const auto& regions : std::vector<std::vector<Region>>{
           {steel({rectangle(1, 1)}), steel({rectangle(1, 1, {1, 0})})},     // along an edge
           {steel({rectangle(1, 1)}), steel({rectangle(3, 3, {1, 0.25})})},  // along part of an edge
           {steel({rectangle(1, 1)}), steel({rectangle(1, 1, {1, 1})})},     // in a point
           {steel({rectangle(1, 1)}), steel({rectangle(1, 1, {5, 0})})},     // apart
           {steel(frame), steel({rectangle(2, 2, {1, 1})})},                 // filled hole
           {steel(frame), steel({rectangle(1, 1, {1.5, 1.5})})},             // loose in the hole
           {steel(frame), steel({rectangle(1, 2, {1, 1})}), steel({rectangle(1, 2, {2, 1})})}})
    EXPECT_EQ(all(validate(regions)), "");
}

TEST(Regions, TouchAlongASlantedEdgeWithAVertexThatRoundingMovesOffIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 200; ++i) {
    const double scale = std::pow(10, 3 * uniform(random)), away = i % 2 ? 1e3 * scale : 0;
    const auto point = [&](double x, double y) -> Point { return {away + scale * x, away + scale * y}; };
    // A long slanted edge a–b of one region; the other side has the points of a chain on it.
    const double ax = uniform(random), ay = uniform(random), bx = ax + 2 + uniform(random),
                 by = uniform(random);
    Ring below{point(ax, ay - 3), point(bx, by - 3), point(bx, by), point(ax, ay)};
    Ring above{point(ax, ay)};
    for (int k = 1; k < 7; ++k) above.push_back(point(ax + (bx - ax) * k / 7, ay + (by - ay) * k / 7));
    above.push_back(point(bx, by));
    above.push_back(point(bx, by + 3));
    above.push_back(point(ax, ay + 3));
    const std::vector<Region> regions{steel({below}), steel({above})};
    EXPECT_EQ(all(validate(regions)), "") << i;
  }
}

TEST(Regions, ThatNearlyShareAVertexTouch) {
  const std::vector<Region> regions{steel({rectangle(0.1 + 0.2, 1)}),
                                    steel({{{0.3, 0}, {1, 0}, {1, 1}, {0.3, 1}}})};
  ASSERT_NE(0.1 + 0.2, 0.3);
  EXPECT_EQ(all(validate(regions)), "");
}

struct BadRegions {
  const char* name;
  std::vector<Region> regions;
  std::vector<const char*> says;
};

TEST(Regions, Refused) {
  const Material wood{.yield_stress = 24e6}, unknown{.yield_stress = 0},
      negative{.yield_stress = 1, .youngs_modulus = -1};
  const std::vector<BadRegions> table{
      {"none", {}, {"regions: is empty"}},
      {"twice",
       {steel({rectangle(1, 1)}), steel({rectangle(1, 1)})},
       {"regions[1].outer: overlaps regions[0].outer in area"}},
      {"inside",
       {steel({rectangle(4, 4)}), steel({rectangle(1, 1, {1, 1})})},
       {"regions[1].outer: overlaps regions[0].outer in area"}},
      {"around",
       {steel({rectangle(1, 1, {1, 1})}), steel({rectangle(4, 4)})},
       {"regions[1].outer: overlaps regions[0].outer in area"}},
      {"across", {steel({rectangle(2, 2)}), steel({rectangle(2, 2, {1, 1})})}, {"regions[1].outer: edge"}},
      {"a little",
       {steel({rectangle(1, 1)}), steel({rectangle(1, 1, {1 - 1e-12, 0})})},
       {"regions[1].outer: overlaps regions[0].outer"}},
      {"through vertices",
       {steel({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}), steel({{{0, 0}, {2, 2}, {3, 1}}})},
       {"regions[1].outer"}},
      {"over a filled hole",
       {steel({rectangle(4, 4), {rectangle(2, 2, {1, 1})}}), steel({rectangle(3, 2, {1, 1})})},
       {"regions[1].outer"}},
      {"hole outside hidden by a neighbour",
       {steel({rectangle(1, 1), {rectangle(1, 1, {2, 0})}}), steel({rectangle(1, 1, {2, 0})})},
       {"regions[0].holes[0]: lies outside"}},
      {"no yield stress", {{{rectangle(1, 1)}, unknown}}, {"regions[0].material: yield stress is 0 Pa"}},
      {"negative modulus",
       {{{rectangle(1, 1)}, negative}},
       {"regions[0].material: Young's modulus is -1 Pa"}},
      {"nan", {{{rectangle(1, 1)}, {.yield_stress = nan_value}}}, {"yield stress is nan Pa"}},
      {"too thin", {steel({rectangle(1, 0.9e-9)})}, {"regions: 9e-10 m2 in an extent of 1 m"}},
      {"tiny beside huge", {steel({rectangle(1, 1)}), steel({{{5, 1}, {2, 1}, {0, 1e40}}})}, {"too thin"}},
      {"stresses too far apart",
       {{{rectangle(1, 1)}, {.yield_stress = 28e36, .yield_stress_compression = 355e6}}},
       {"regions: yield at 3.55e+08 Pa and at 2.8e+37 Pa"}},
      {"modulus on one only",
       {steel({rectangle(1, 1)}), {{rectangle(1, 1, {1, 0})}, wood}},
       {"regions[1].material: has no Young's modulus"}},
  };
  for (const auto& [name, regions, says] : table) {
    const auto problems = validate(regions);
    EXPECT_EQ(problems.size(), says.size()) << name << "\n" << all(problems);
    for (std::size_t i = 0; i < std::min(says.size(), problems.size()); ++i)
      EXPECT_NE(to_string(problems[i]).find(says[i]), std::string::npos) << name << "\n" << all(problems);
    EXPECT_THROW(Section{regions}, InvalidInput) << name;
  }
}
}  // namespace
