#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "ductile/box2d.h"
#include "ductile/files.h"

namespace {
using namespace ductile;
using std::numbers::pi;

double area(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    sum += ring[j].x * ring[i].y - ring[i].x * ring[j].y;
  }
  return std::abs(sum) / 2;
}
double area(const Outline& outline) {
  double sum = area(outline.outer);
  for (const Ring& hole : outline.holes) sum -= area(hole);
  return sum;
}
double perimeter(const Outline& outline) {
  double sum = 0;
  const auto add = [&](const Ring& ring) {
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
      sum += std::hypot(ring[i].x - ring[j].x, ring[i].y - ring[j].y);
    }
  };
  add(outline.outer);
  for (const Ring& hole : outline.holes) add(hole);
  return sum;
}
struct Box {
  double left, bottom, right, top;
};
Box box(const Ring& ring) {
  Box box{ring[0].x, ring[0].y, ring[0].x, ring[0].y};
  for (const Point& p : ring) {
    box = {std::min(box.left, p.x), std::min(box.bottom, p.y), std::max(box.right, p.x),
           std::max(box.top, p.y)};
  }
  return box;
}

std::string drawing(const std::string& content, const std::string& attributes = R"(viewBox="0 0 100 100")") {
  return R"(<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" )"
         R"(xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" )" +
         attributes + ">" + content + "</svg>";
}
std::string path(const std::string& data, const std::string& attributes = "") {
  return "<path id='a' d='" + data + "' " + attributes + "/>";
}
constexpr double tolerance = 1e-5;
Outline outline(const std::string& content, const std::string& attributes = R"(viewBox="0 0 100 100")") {
  return Drawing(drawing(content, attributes), "test.svg")
      .outline("a", {.metres_per_unit = 1, .tolerance = tolerance});
}

struct Shape {
  const char* name;
  std::string content;
  double area;  ///< closed form
};
std::ostream& operator<<(std::ostream& out, const Shape& shape) { return out << shape.name; }
class Shapes : public testing::TestWithParam<Shape> {};

// Chords within a tolerance of the curve leave at most tolerance × length of its area.
TEST_P(Shapes, HasTheAreaOfItsClosedForm) {
  const Outline found = outline(GetParam().content);
  EXPECT_NEAR(area(found), GetParam().area, tolerance * perimeter(found)) << found.outer.size() << " points";
  EXPECT_TRUE(validate(found).empty());
}

/// Of a circle, between a chord that is seen from the centre under `angle` and the smaller arc.
double segment(double r, double angle) { return r * r / 2 * (angle - std::sin(angle)); }

INSTANTIATE_TEST_SUITE_P(
    Svg, Shapes,
    testing::Values(
        Shape{"lines", path("M 1 1 L 5 1 L 5 4 Z"), 6},
        Shape{"relative_lines", path("m 1 1 l 4 0 l 0 3 z"), 6},
        Shape{"not_closed", path("M 1 1 L 5 1 L 5 4"), 6},
        Shape{"closed_twice", path("M 1 1 L 5 1 L 5 4 L 1 1 Z"), 6},
        Shape{"horizontal_and_vertical", path("M1 1H5V4H1z"), 12},
        Shape{"relative_h_and_v", path("m1 1h4v3h-4z"), 12},
        Shape{"repeated_commands", path("M1,1 5,1 5,4 1,4"), 12},
        Shape{"relative_repeats", path("m1 1 4 0 0 3-4 0"), 12},
        Shape{"terse_numbers", path("M.5.5L4.5.5 4.5+3.5.5,35e-1z"), 12},
        Shape{"after_closing_goes_on_from_the_start", path("m5 5h10v10h-10z l2 4l2 -2z"), 94},
        Shape{"cubic", path("M 0 0 C 0 10 10 10 10 0 Z"), 60},  // ∫ y dx = 100 ∫ 18 t²(1−t)² dt
        Shape{"relative_cubic", path("m 20 20 c 0 10 10 10 10 0 z"), 60},
        Shape{"smooth_cubic", path("M 0 0 C 0 10 10 10 10 0 S 20 -10 20 0 L 20 20 L 0 20 Z"), 400},
        Shape{"smooth_after_a_line_starts_at_the_point", path("M 0 0 L 0 0 S 10 10 10 0 Z"), 30},
        Shape{"quadratic", path("M 0 0 Q 5 10 10 0 Z"), 100. / 3},  // 2/3 of base × height 5
        Shape{"relative_quadratic", path("m 0 0 q 5 10 10 0 z"), 100. / 3},
        Shape{"smooth_quadratic", path("M 0 0 Q 5 10 10 0 T 20 0 V 20 H 0 Z"), 400},
        Shape{"relative_smooth_quadratic", path("m 0 0 q 5 10 10 0 t 10 0 v 20 h -20 z"), 400},
        Shape{"half_disc", path("M 10 0 A 5 5 0 0 1 10 10 Z"), pi * 25 / 2},
        Shape{"arc_too_small_is_grown", path("M 10 0 A 1 1 0 0 1 10 10 Z"), pi * 25 / 2},
        Shape{"small_arc", path("M 0 0 A 10 10 0 0 0 10 0 Z"), segment(10, pi / 3)},
        Shape{"small_arc_other_side", path("M 0 0 A 10 10 0 0 1 10 0 Z"), segment(10, pi / 3)},
        Shape{"large_arc", path("M 0 0 A 10 10 0 1 0 10 0 Z"), 100 * pi - segment(10, pi / 3)},
        Shape{"large_arc_other_side", path("M 0 0 A 10 10 0 1 1 10 0 Z"), 100 * pi - segment(10, pi / 3)},
        Shape{"arc_flags_without_separators", path("M0 0a10 10 0 1110 0z"), 100 * pi - segment(10, pi / 3)},
        Shape{"arc_with_negative_radii", path("M 10 0 A -5 -5 0 0 1 10 10 Z"), pi * 25 / 2},
        Shape{"turned_elliptic_arc", path("M 0 0 A 10 5 30 0 0 17.320508075688775 10 Z"), pi * 10 * 5 / 2},
        Shape{"arc_of_no_radius_is_a_line", path("M 0 0 A 0 5 0 0 0 10 0 L 10 10 Z"), 50},
        Shape{"rect", "<rect id='a' x='1' y='2' width='3' height='4'/>", 12},
        Shape{"rounded_rect", "<rect id='a' width='10' height='20' rx='2' ry='3'/>", 200 - (4 - pi) * 6},
        Shape{"rect_rounded_by_one_radius", "<rect id='a' width='10' height='20' ry='3'/>",
              200 - (4 - pi) * 9},
        Shape{"rect_rounded_beyond_its_half", "<rect id='a' width='10' height='10' rx='99'/>", 25 * pi},
        Shape{"circle", "<circle id='a' cx='50' cy='50' r='20'/>", 400 * pi},
        Shape{"ellipse", "<ellipse id='a' cx='50' cy='50' rx='20' ry='10'/>", 200 * pi},
        Shape{"polygon", "<polygon id='a' points='0,0 10,0 10,10'/>", 50},
        Shape{"polyline", "<polyline id='a' points='0 0 10 0,10 10 0 10'/>", 100},
        Shape{"lengths_with_units", "<rect id='a' width='1in' height='2.54cm'/>", 96. * 96},
        Shape{"translated", path("M0 0h2v3h-2z", "transform='translate(5,6)'"), 6},
        Shape{"scaled", path("M0 0h2v3h-2z", "transform='scale(2)'"), 24},
        Shape{"scaled_two_ways", path("M0 0h2v3h-2z", "transform='scale(2 -5)'"), 60},
        Shape{"rotated", path("M0 0h2v3h-2z", "transform='rotate(33)'"), 6},
        Shape{"rotated_about_a_point", path("M0 0h2v3h-2z", "transform='rotate(33, 7, 8)'"), 6},
        Shape{"skewed", path("M0 0h2v3h-2z", "transform='skewX(20) skewY(-10)'"), 6},
        Shape{"matrix", path("M0 0h2v3h-2z", "transform='matrix(1 2 3 4 5 6)'"), 12},  // |det| = 2
        Shape{"turned_and_stretched_circle", "<circle id='a' r='5' transform='matrix(1 2 3 4 5 6)'/>",
              50 * pi},
        Shape{"in_groups",
              "<g transform='scale(2)'><g transform='scale(3)'>" + path("M0 0h1v1h-1z") + "</g></g>", 36},
        Shape{"group_of_one_shape", "<g id='a' transform='scale(2)'><g><rect width='1' height='1'/></g></g>",
              4},
        Shape{"used",
              "<defs><rect id='b' width='2' height='3' transform='scale(2)'/></defs>"
              "<g transform='scale(3)'><use id='a' href='#b' x='5' y='5'/></g>",
              6 * 36},
        Shape{"used_by_old_link", "<rect id='b' width='2' height='3'/><use id='a' xlink:href='#b'/>", 6},
        Shape{"labelled", "<rect inkscape:label='a' width='2' height='3'/>", 6},
        Shape{"prefixed", "<svg:rect xmlns:svg='http://www.w3.org/2000/svg' id='a' width='2' height='3'/>",
              6},
        Shape{"hole_by_turn", path("M0 0h10v10h-10z M2 2v2h2v-2z"), 96},
        Shape{"same_turn_fills", path("M0 0h10v10h-10z M2 2h2v2h-2z"), 100},
        Shape{"hole_by_even_odd", path("M0 0h10v10h-10z M2 2h2v2h-2z", "fill-rule='evenodd'"), 96},
        Shape{"even_odd_in_the_style",
              path("M0 0h10v10h-10z M2 2h2v2h-2z", "style='fill:red; fill-rule : evenodd'"), 96},
        Shape{"even_odd_inherited", "<g fill-rule='evenodd'>" + path("M0 0h10v10h-10z M2 2h2v2h-2z") + "</g>",
              96},
        Shape{"hole_drawn_first", path("M2 2v2h2v-2z M0 0h10v10h-10z"), 96},
        Shape{"hole_that_touches_the_corner", path("M0 0h10v10h-10z M0 0l2 4l2 -2z"), 94},
        Shape{"two_holes", path("M0 0h10v10h-10z M2 2v2h2v-2z M6 6v2h2v-2z"), 92},
        Shape{"stray_points_and_lines", path("M50 50 M0 0h10v10h-10z M20 20 l5 5 z M3 3 z"), 100}),
    [](const auto& info) { return info.param.name; });

TEST(Svg, SkewsMoveXByYAndYByX) {
  const Box x = box(outline(path("M0 0h2v3h-2z", "transform='skewX(45)'")).outer);
  EXPECT_NEAR(x.right - x.left, 5, 1e-12);
  const Box y = box(outline(path("M0 0h2v3h-2z", "transform='skewY(45)'")).outer);
  EXPECT_NEAR(y.top - y.bottom, 5, 1e-12);
}

TEST(Svg, TransformsApplyFromRightToLeft) {
  const Box found =
      box(outline(path("M0 0h1v1h-1z", "transform='translate(10 20) rotate(90) scale(2,3)'")).outer);
  // (x, y) → (2x, 3y) → (−3y, 2x) → (10 − 3y, 20 + 2x), then flipped at 100
  EXPECT_NEAR(found.left, 7, 1e-12);
  EXPECT_NEAR(found.right, 10, 1e-12);
  EXPECT_NEAR(found.bottom, 78, 1e-12);
  EXPECT_NEAR(found.top, 80, 1e-12);
}

TEST(Svg, ArcsBulgeToTheSideOfTheirSweep) {
  // Positive is clockwise on the page, so that from left to right the arc goes above the chord.
  EXPECT_NEAR(box(outline(path("M 10 50 A 20 20 0 0 1 50 50 Z")).outer).top, 70, tolerance);
  EXPECT_NEAR(box(outline(path("M 10 50 A 20 20 0 0 0 50 50 Z")).outer).bottom, 30, tolerance);
}

TEST(Svg, CurvesPassThroughTheirPointsWithinTheTolerance) {
  for (const double within : {1e-1, 1e-3, 1e-5}) {
    const Outline circle = Drawing(drawing("<circle id='a' cx='50' cy='50' r='10'/>"), "t.svg")
                               .outline("a", {.metres_per_unit = 1, .tolerance = within});
    double worst = 0;
    for (std::size_t i = 0, j = circle.outer.size() - 1; i < circle.outer.size(); j = i++) {
      const Point &p = circle.outer[i], &q = circle.outer[j];
      EXPECT_NEAR(std::hypot(p.x - 50, p.y - 50), 10, 1e-12);
      worst = std::max(worst, 10 - std::hypot((p.x + q.x) / 2 - 50, (p.y + q.y) / 2 - 50));
    }
    EXPECT_LE(worst, within);
    EXPECT_GE(worst, within / 4) << "more points than the tolerance asks for";
  }
}

TEST(Svg, YIsFlippedAtTheBottomOfTheViewBox) {
  const Drawing page(
      drawing("<rect id='a' x='10' y='20' width='30' height='40'/>", "viewBox='-5 -50 100 200'"), "t.svg");
  const Box found = box(page.outline("a", {.metres_per_unit = 0.01}).outer);
  EXPECT_NEAR(found.left, 0.1, 1e-14);
  EXPECT_NEAR(found.right, 0.4, 1e-14);
  EXPECT_NEAR(found.bottom, 0.9, 1e-14);  // (150 − 60) / 100
  EXPECT_NEAR(found.top, 1.3, 1e-14);
}

struct Page {
  const char* name;
  std::string attributes;
  double width, height;  ///< of a rectangle of 10 × 10 units, m
};
std::ostream& operator<<(std::ostream& out, const Page& page) { return out << page.name; }
class Pages : public testing::TestWithParam<Page> {};

TEST_P(Pages, HaveTheirPhysicalSize) {
  const Drawing page(drawing("<rect id='a' width='10' height='10'/>", GetParam().attributes), "t.svg");
  const Box found = box(page.outline("a").outer);
  EXPECT_NEAR(found.right - found.left, GetParam().width, 1e-12);
  EXPECT_NEAR(found.top - found.bottom, GetParam().height, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    Svg, Pages,
    testing::Values(
        Page{"millimetres", "width='100mm' height='50mm' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"centimetres", "width='100cm' height='50cm' viewBox='0 0 100 50'", 0.1, 0.1},
        Page{"inches", "width='10in' height='5in' viewBox='0 0 100 50'", 0.0254, 0.0254},
        Page{"points", "width='72pt' height='36pt' viewBox='0 0 100 50'", 0.00254, 0.00254},
        Page{"picas", "width='6pc' height='3pc' viewBox='0 0 100 50'", 0.00254, 0.00254},
        Page{"quarters", "width='400Q' height='200Q' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"pixels", "width='96px' height='48px' viewBox='0 0 100 50'", 0.00254, 0.00254},
        Page{"width_alone", "width='100mm' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"height_alone", "height='50mm' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"percent_beside", "width='100%' height='50mm' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"no_view_box", "width='96px' height='1in'", 0.00264583333333333, 0.00264583333333333},
        Page{"fits_the_narrower", "width='200mm' height='50mm' viewBox='0 0 100 50'", 0.01, 0.01},
        Page{"stretched", "width='200mm' height='50mm' viewBox='0 0 100 50' preserveAspectRatio='none'", 0.02,
             0.01},
        Page{"sliced",
             "width='200mm' height='50mm' viewBox='0 0 100 50' preserveAspectRatio='xMidYMid slice'", 0.02,
             0.02}),
    [](const auto& info) { return info.param.name; });

TEST(Svg, AScaleOverridesThePhysicalSize) {
  const Drawing page(drawing("<rect id='a' width='10' height='10'/>", "width='10mm' viewBox='0 0 100 100'"),
                     "t.svg");
  EXPECT_NEAR(area(page.outline("a", {.metres_per_unit = 0.5})), 25, 1e-12);
}

TEST(Svg, KnowsItsShapes) {
  const Drawing page(drawing("<g id='g'><rect id='b'/><path inkscape:label='c'/></g><text id='d'/><circle/>"
                             "<circle><title>wheel</title></circle><rect fill='none'/>"),
                     "t.svg");
  EXPECT_EQ(page.ids(), (std::vector<std::string>{"b", "c", "circle 1", "wheel"}));
  EXPECT_EQ(Drawing(drawing("<defs><rect id='r'/><symbol id='s'><rect/></symbol></defs>"
                            "<use id='u' href='#r'/><use id='v' href='#s'/><use href='#r'/>"),
                    "t.svg")
                .ids(),
            (std::vector<std::string>{"u", "v", "r"}));
}

struct Bad {
  const char* name;
  std::string content, saying;
};
std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.name; }
class BadDrawing : public testing::TestWithParam<Bad> {};

/// From anywhere to anywhere, over and over.
std::string scribble(int lines) {
  std::minstd_rand random;
  std::string d = "M";
  for (int i = 0; i <= lines; ++i)
    for (int axis = 0; axis < 2; ++axis) d += " " + std::to_string(double(random() % 10'000) / 100);
  return d;
}

/// So many lines along x and as many along y.
std::string grating(int lines) {
  std::string d;
  for (int i = 0; i < lines; ++i) {
    const std::string at = std::to_string((i + 0.5) * 100 / lines);
    d += "M0 " + at + "H100M" + at + " 0V100";
  }
  return d;
}

TEST_P(BadDrawing, NamesFileElementAndCommand) {
  std::string said;
  try {
    Drawing(drawing(GetParam().content, "viewBox='0 0 100 100' width='100mm'"), "bad.svg").outline("a");
  } catch (const InvalidInput& error) {
    said = error.what();
  }
  EXPECT_EQ(said.find("bad.svg:"), 0u) << said;
  EXPECT_NE(said.find(GetParam().saying), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(
    Svg, BadDrawing,
    testing::Values(
        Bad{"no_such_id", "<rect id='b'/><circle id='c'/>", "#a: is not in the drawing; its shapes are b, c"},
        Bad{"no_data", path(""), "no area"}, Bad{"starts_with_a_line", path("L 1 1"), "path command 1"},
        Bad{"number_first", path("1 1 L 2 2"), "path data"},
        Bad{"unknown_command", path("M 0 0 L 1 1 X 3 3"), "path command 3"},
        Bad{"half_a_point", path("M 0 0 L 1 1 1"), "path command 2"},
        Bad{"letter_for_a_number", path("M 0 0 L 1 b"), "path command 2"},
        Bad{"number_after_closing", path("M 0 0 L 1 1 Z 3"), "path command 3"},
        Bad{"arc_flag", path("M 0 0 A 1 1 0 2 0 3 3"), "path command 2"},
        Bad{"infinite", path("M 0 0 L 1e999 0 L 1 1"), "path command 2"},
        Bad{"not_a_number", path("M 0 0 L nan 0 L 1 1"), "path command 2"},
        Bad{"overflows", path("M 1e308 0 l 1e308 0 l 1e308 9 z"), "1e12 m"},
        Bad{"two_areas", path("M0 0h1v1h-1z M3 3h1v1h-1z"), "2 separate areas"},
        Bad{"island_in_a_hole", path("M0 0h9v9h-9z M1 1v7h7v-7z M3 3h2v2h-2z"), "2 separate areas"},
        Bad{"only_a_line", path("M 0 0 L 10 10"), "no area"},
        Bad{"dashes_without_end", "<path id='a' d='M 0 0 H 99' stroke='red' stroke-dasharray='0.001'/>",
            "makes more than 10000 dashes; make the dashes longer"},
        Bad{"scribble", path(scribble(3000)), "crosses itself too often; draw it with fewer lines"},
        Bad{"grating", path(grating(102), "fill='none' stroke='red' stroke-width='0.1'"),
            "has 10201 holes, more than 10000; draw it with fewer lines"},
        Bad{"group_of_two", "<g id='a'><rect width='1' height='1'/><rect width='1' height='1'/></g>",
            "2 shapes; name the shape itself: rect 1, rect 2"},
        Bad{"text", "<text id='a'>x</text>", "#a: is text; turn it into a path"},
        Bad{"empty_group", "<g id='a'/>", "#a: has no shapes"},
        Bad{"bad_transform_around_it", "<g transform='bend(3)'><path id='a' d='M0 0h1v1z'/></g>",
            "transform"},
        Bad{"bad_clip_of_the_hidden",
            "<g display='none'><g transform='bend(3)'>" + path("M0 0h1v1z") + "</g></g>", "transform"},
        Bad{"rect_without_height", "<rect id='a' width='1'/>", "height"},
        Bad{"negative_radius", "<circle id='a' r='-1'/>", "r: is not > 0"},
        Bad{"unknown_unit", "<circle id='a' r='10furlong'/>", "furlong"},
        Bad{"half_a_polygon_point", "<polygon id='a' points='0,0 1'/>", "point 1"},
        Bad{"unknown_transform", path("M0 0h1v1z", "transform='bend(3)'"), "transform"},
        Bad{"transform_of_too_few", path("M0 0h1v1z", "transform='matrix(1 2 3)'"), "transform"},
        Bad{"transform_cut_off", path("M0 0h1v1z", "transform='rotate(1'"), "transform"},
        Bad{"transform_about_its_own_box",
            path("M0 0h1v1z", "style='transform: rotate(3deg); transform-box: fill-box'"), "transform-box"},
        Bad{"flattened_by_its_transform", path("M0 0h1v1z", "transform='scale(1 0)'"), "no area"},
        Bad{"fill_rule", path("M0 0h1v1z", "fill-rule='odd'"), "fill-rule"},
        Bad{"use_of_nothing", "<use id='a' href='#b'/>", "#b"},
        Bad{"use_of_another_file", "<use id='a' href='other.svg#b'/>", "other.svg"},
        Bad{"use_of_itself", "<use id='a' href='#a'/>", "shows itself: \"#a\""},
        Bad{"use_in_a_circle", "<use id='a' href='#b'/><g id='b'><use href='#a'/></g>", "shows itself"},
        Bad{"half_transparent_mask",
            "<mask id='m'><rect width='9' height='9' fill='gray'/></mask>" +
                path("M0 0h5v5h-5z", "mask='url(#m)'"),
            "half transparent"}),
    [](const auto& info) { return info.param.name; });

TEST(Svg, AMapOfTiledIsToldSo) {
  try {
    const Drawing drawing("<?xml version='1.0'?><map version='1.10'><tileset/></map>", "level.tmx");
    FAIL();
  } catch (const InvalidInput& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_EQ(error.problems()[0].place, "level.tmx:1:1");
    EXPECT_EQ(error.problems()[0].what, "is a map of Tiled, whose polygons are no bodies yet");
  }
}

TEST(Svg, ADrawingWithoutSizeNeedsAScale) {
  for (const char* attributes :
       {"viewBox='0 0 100 100'", "width='100' height='100' viewBox='0 0 100 100'",
        "width='100%' viewBox='0 0 100 100'", "viewBox='0 0 0 1' width='1cm'", "viewBox='0 0 1' width='1cm'",
        "viewBox='0 0 1 1' width='-1cm'", "viewBox='0 0 1 1' width='1furlong'"}) {
    EXPECT_THROW(Drawing(drawing(path("M0 0h1v1z"), attributes), "t.svg").outline("a"), InvalidInput)
        << attributes;
  }
}

TEST(Svg, AnIconOfOneEmIsReadByItsScale) {
  const Drawing icon(
      drawing("<rect id='a' width='12' height='10'/>", "width='1em' height='1em' viewBox='0 0 24 24'"),
      "t.svg");
  EXPECT_FALSE(icon.sized());
  EXPECT_NEAR(area(icon.outline("a", {.metres_per_unit = 1})), 120, 1e-12);
}

TEST(Svg, IsToldFromASceneInEachEncoding) {
  for (const std::string_view text :
       {std::string_view(" \n<svg/>"), std::string_view("\xEF\xBB\xBF<svg/>"),
        std::string_view("\xFF\xFE<\0s\0", 6), std::string_view("\xFE\xFF\0<\0s", 6)}) {
    EXPECT_TRUE(is_drawing(text)) << text;
  }
  EXPECT_FALSE(is_drawing("{}"));
  EXPECT_FALSE(is_drawing(std::string_view("\xFF\xFE{\0}\0", 6)));
}

TEST(Svg, WhatIsNoDrawingIsRefused) {
  for (const char* text : {"", "{}", "<svg", "<svg><path></svg>", "<html/>", "\xff\xfe\x00"}) {
    EXPECT_THROW(Drawing(std::string_view(text), "t.svg"), InvalidInput) << text;
  }
}

TEST(Svg, AToleranceThatAsksForEndlessChordsIsRefused) {
  const Drawing page(drawing("<circle id='a' r='5'/>"), "t.svg");
  EXPECT_THROW(page.outline("a", {.metres_per_unit = 1, .tolerance = 1e-300}), InvalidInput);
}

/// What a drawing shows, by name: areas in closed form, of shapes 10 units and more across.
struct Seen {
  const char* name;
  std::string content;
  std::map<std::string, double> areas;
  double tolerance = 1e-5;
};
std::ostream& operator<<(std::ostream& out, const Seen& seen) { return out << seen.name; }
class AsABrowser : public testing::TestWithParam<Seen> {};

TEST_P(AsABrowser, ShowsTheseAreas) {
  const auto drawn = Drawing(drawing(GetParam().content), "t.svg")
                         .shapes({.metres_per_unit = 1, .tolerance = GetParam().tolerance});
  std::map<std::string, double> areas;
  for (const auto& shape : drawn.shapes) {
    EXPECT_TRUE(validate(shape.outline).empty()) << shape.name;
    areas[shape.name] = area(shape.outline);
  }
  ASSERT_EQ(areas.size(), GetParam().areas.size());
  for (const auto& [name, expected] : GetParam().areas) {
    ASSERT_TRUE(areas.contains(name)) << name;
    EXPECT_NEAR(areas[name], expected, GetParam().tolerance * 300) << name;  // chords: tolerance × perimeter
  }
}

const std::string square = "<rect id='a' width='10' height='10'/>";
INSTANTIATE_TEST_SUITE_P(
    Svg, AsABrowser,
    testing::Values(
        Seen{"nothing_hidden",
             "<style>.gone{display:none} #b{visibility:hidden}</style>" + square +
                 "<rect id='b' width='10' height='10'/><rect class='x gone' width='9' height='9'/>"
                 "<g style='display:none'><rect id='c' width='9' height='9'/></g>"
                 "<rect fill='none' width='9' height='9'/><rect fill-opacity='0' width='9' height='9'/>"
                 "<g opacity='0'><rect width='9' height='9'/></g><defs><rect width='9' height='9'/></defs>",
             {{"a", 100}}},
        Seen{"visible_in_hidden",
             "<g visibility='hidden'><rect id='a' visibility='visible' width='10' height='10'/></g>",
             {{"a", 100}}},
        Seen{"the_more_specific_rule",
             "<style>#a{display:inline} rect{display:none} rect.b{display:inline} g "
             "rect.b{display:none}</style>" +
                 square +
                 "<rect class='b' id='b' width='5' height='5'/><g><rect class='b' width='7' height='7'/></g>",
             {{"a", 100}, {"b", 25}}},
        Seen{"important_wins",
             "<style>rect{display:none !important}</style><rect style='display:inline' width='9' height='9'/>"
             "<circle id='a' r='10'/>",
             {{"a", 100 * pi}}},
        Seen{"fill_rule_by_sheet",
             "<style>path { fill-rule: evenodd }</style>" + path("M0 0h10v10h-10z M2 2h2v2h-2z"),
             {{"a", 96}}},
        Seen{"bow_tie", path("M0 0 L10 10 L10 0 L0 10 Z"), {{"a 1", 25}, {"a 2", 25}}},
        // A pentagram of circumradius 10: its points are 5 triangles, its middle a pentagon. With φ the
        // golden ratio its inner circumradius is 10/φ², and its area 5 R r sin 36°.
        Seen{"star",
             path("M0 -10 L5.877852522924731 8.090169943749475 L-9.510565162951535 -3.0901699437494745"
                  " L9.510565162951535 -3.0901699437494745 L-5.877852522924731 8.090169943749475 Z",
                  "transform='translate(20 20)'"),
             {{"a", 5 * 10 * 10 * 0.3819660112501051 * std::sin(pi / 5)}}},
        Seen{"wire", path("M10 10 H60", "fill='none' stroke='black' stroke-width='4'"), {{"a", 200}}},
        Seen{"wire_with_round_ends",
             path("M10 10 H60", "stroke='black' stroke-width='4' stroke-linecap='round'"),
             {{"a", 200 + 4 * pi}}},
        Seen{"wire_with_square_ends",
             path("M10 10 H60", "stroke='black' stroke-width='4' stroke-linecap='square'"),
             {{"a", 216}}},
        Seen{"mitred_corner",
             path("M10 10 H60 V60", "fill='none' stroke='black' stroke-width='4'"),
             {{"a", 400}}},
        Seen{"bevelled_corner",
             path("M10 10 H60 V60", "fill='none' stroke='black' stroke-width='4' stroke-linejoin='bevel'"),
             {{"a", 398}}},
        Seen{"rounded_corner",
             path("M10 10 H60 V60", "fill='none' stroke='black' stroke-width='4' stroke-linejoin='round'"),
             {{"a", 396 + pi}}},
        Seen{"mitre_beyond_its_limit",
             path("M10 10 H60 V60", "fill='none' stroke='black' stroke-width='4' stroke-miterlimit='1.4'"),
             {{"a", 398}}},
        Seen{
            "frame",
            "<rect id='a' x='10' y='10' width='50' height='50' fill='none' stroke='black' stroke-width='4'/>",
            {{"a", 54 * 54 - 46 * 46}}},
        Seen{"ring",
             "<circle id='a' cx='50' cy='50' r='20' fill='none' stroke='black' stroke-width='4'/>",
             {{"a", pi*(22 * 22 - 18 * 18)}}},
        Seen{"pen_wider_than_its_circle",
             "<circle id='a' cx='50' cy='50' r='5' fill='none' stroke='black' stroke-width='30'/>",
             {{"a", pi * 400}},
             1e-3},
        Seen{"fill_and_stroke",
             "<rect id='a' x='10' y='10' width='50' height='50' stroke='black' stroke-width='4'/>",
             {{"a", 54 * 54}}},
        Seen{"dashes",
             path("M10 10 H60", "stroke='black' stroke-width='4' stroke-dasharray='10 20'"),
             {{"a 1", 40}, {"a 2", 40}}},
        Seen{
            "dashes_from_an_offset",
            path("M10 10 H40", "stroke='black' stroke-width='4' stroke-dasharray='10' stroke-dashoffset='5'"),
            {{"a 1", 40}, {"a 2", 20}}},
        Seen{"stroke_under_a_skewed_scale",
             path("M10 10 H60", "stroke='black' stroke-width='4' transform='scale(1 3)'"),
             {{"a", 600}}},
        Seen{"clipped",
             "<clipPath id='p'><circle cx='10' cy='10' r='5'/></clipPath>"
             "<rect id='a' width='50' height='10' clip-path='url(#p)'/>",
             {{"a", 12.5 * pi}}},
        Seen{"clipped_to_its_box",
             "<clipPath id='p' clipPathUnits='objectBoundingBox'><rect width='0.5' height='1'/></clipPath>"
             "<rect id='a' x='20' y='5' width='50' height='10' clip-path='url(#p)'/>",
             {{"a", 250}}},
        Seen{"clipped_twice",
             "<clipPath id='p'><rect width='20' height='9'/></clipPath><clipPath id='q'><rect x='10' "
             "width='50' height='9'/></clipPath>"
             "<g clip-path='url(#p)'><rect id='a' width='50' height='50' clip-path='url(#q)'/></g>",
             {{"a", 90}}},
        Seen{"masked",
             "<mask id='m'><rect width='20' height='20' fill='white'/><rect width='5' height='5'/></mask>"
             "<rect id='a' width='50' height='10' mask='url(#m)'/>",
             {{"a", 175}}},
        Seen{"copies",
             "<defs><rect id='b' width='10' height='10'/></defs><use id='u' href='#b' x='20'/>"
             "<use href='#b' transform='scale(2)'/>",
             {{"u", 100}, {"b", 400}}},
        // A symbol of 10 units in a frame of 20 × 40 is scaled by 2 and centred; what leaves the frame is
        // cut.
        Seen{"symbol",
             "<symbol id='s' viewBox='0 0 10 10'><rect id='b' x='5' width='10' height='10'/></symbol>"
             "<use href='#s' width='20' height='40'/>",
             {{"b", 200}}},
        Seen{"nested_view",
             "<svg width='50' height='25' viewBox='0 0 10 10' preserveAspectRatio='none'>"
             "<rect id='a' width='2' height='2'/></svg>",
             {{"a", 50}}},
        Seen{"sliced_view",
             "<svg width='50' height='25' viewBox='0 0 10 10' preserveAspectRatio='xMidYMin slice'>"
             "<rect id='a' width='10' height='10'/></svg>",
             {{"a", 1250}}},
        Seen{"percent", "<rect id='a' width='10%' height='50%'/>", {{"a", 500}}},
        Seen{"symbol_is_no_shape_itself",
             "<symbol id='s'>" + square + "</symbol><use href='#s' width='5' height='20'/>",
             {{"a", 50}}},
        Seen{"group_that_holds_its_own_copy",
             "<g id='g'>" + square + "<use href='#g' x='20'/></g>",
             {{"a", 100}}},
        Seen{"first_of_a_switch",
             "<switch><foreignObject/><rect systemLanguage='de, fr' width='9' height='9'/>"
             "<rect requiredExtensions='x' width='9' height='9'/><g systemLanguage='de,en-GB'>" +
                 square + "<rect id='b' width='2' height='2'/></g><rect width='9' height='9'/></switch>",
             {{"a", 100}, {"b", 4}}},
        Seen{
            "ems_of_a_font", "<g font-size='20px'><rect id='a' width='1em' height='4ex'/></g>", {{"a", 800}}},
        Seen{"ems_of_no_font", "<rect id='a' width='1em' height='2rem'/>", {{"a", 512}}},
        Seen{"sizes_by_style",
             "<style>circle{cx:50px;cy:50px;r:10px} rect{width:4px}</style><circle id='c'/><rect id='a' "
             "width='9' "
             "height='5' style='height:3px'/>",
             {{"c", 100 * pi}, {"a", 12}}},
        Seen{"one_radius_for_both", "<ellipse id='a' cx='50' cy='50' ry='10'/>", {{"a", 100 * pi}}},
        Seen{
            "see_through",
            "<style>.a{fill:rgb(0 0 0 / 0)} .b{fill:RGBA(9, 9, 9, .0)} .c{fill:None} .d{fill:#ABC0}</style>" +
                square +
                "<rect class='a' width='9' height='9'/><rect class='b' width='9' height='9'/>"
                "<rect class='c' width='9' height='9'/><rect class='d' width='9' height='9'/>"
                "<rect id='b' fill='rgb(0,0,0)' width='3' height='3'/>",
            {{"a", 100}, {"b", 9}}},
        Seen{"mask_of_alpha",
             "<mask id='m' style='mask-type:alpha'><rect width='5' height='20' fill='#D9D9D9'/></mask>"
             "<rect id='a' width='50' height='10' mask='url(#m)'/>",
             {{"a", 50}}},
        Seen{"mask_that_is_a_line",
             "<mask id='m'><path d='M0 5H100' fill='none' stroke='white' stroke-width='2'/></mask>"
             "<rect id='a' width='50' height='10' mask='url(#m)'/>",
             {{"a", 100}}},
        Seen{"mask_of_a_stroke_around_a_fill",
             "<mask id='m'><rect x='20' y='20' width='60' height='60' fill='black' stroke='white' "
             "stroke-width='10'/></mask><rect id='a' x='10' y='10' width='80' height='80' mask='url(#m)'/>",
             {{"a", 70 * 70 - 50 * 50}}},
        Seen{"mask_within_its_region",
             "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='20' height='9'>"
             "<rect width='100' height='100' fill='RGB(255, 255, 255)'/></mask>"
             "<rect id='a' width='50' height='50' mask='url(#m)'/>",
             {{"a", 180}}},
        // A tenth of the box wider on each side, unless the mask says otherwise (CSS Masking 1 §7.3).
        Seen{"mask_within_its_usual_region",
             "<mask id='m'><rect width='100' height='100' fill='white'/></mask>"
             "<rect id='a' x='10' y='10' width='40' height='40' stroke='black' stroke-width='30' "
             "mask='url(#m)'/>",
             {{"a", 48 * 48}}},
        Seen{"mask_in_a_box",
             "<mask id='m' maskContentUnits='objectBoundingBox'><rect width='.5' height='.25' "
             "fill='white'/></mask><rect id='a' x='10' y='10' width='40' height='40' mask='url(#m)'/>",
             {{"a", 20 * 10}}},
        // The box around both is 40 wide: a cut at 35 leaves half of the second.
        Seen{"clipped_to_the_box_of_a_group",
             "<clipPath id='p' clipPathUnits='objectBoundingBox'><rect width='.875' height='1'/></clipPath>"
             "<g clip-path='url(#p)' transform='scale(2)'><rect id='a' width='10' height='10'/>"
             "<rect id='b' x='30' width='10' height='10'/></g>",
             {{"a", 400}, {"b", 200}}},
        Seen{"clipped_to_the_box_of_a_copy",
             "<clipPath id='p' clipPathUnits='objectBoundingBox'><rect width='.5' height='1'/></clipPath>"
             "<defs><rect id='b' x='20' width='10' height='10'/></defs><use id='a' href='#b' x='5' "
             "clip-path='url(#p)'/>",
             {{"a", 50}}},
        // A parabola 40 wide and 20 high, whose control point is 40 up: of its area 2/3 · 40 · 20 goes what
        // is above half of it, 40/√2 wide and 10 high.
        Seen{"clipped_to_the_box_of_a_curve",
             "<clipPath id='p' clipPathUnits='objectBoundingBox'><rect width='1' height='.5'/></clipPath>" +
                 path("M0 0 Q20 40 40 0 Z", "clip-path='url(#p)'"),
             {{"a", 2. / 3 * 40 * 20 - 2. / 3 * 40 / std::numbers::sqrt2 * 10}}},
        Seen{"clip_that_is_clipped",
             "<clipPath id='p'><rect width='5' height='100'/></clipPath>"
             "<clipPath id='q' clip-path='url(#p)'><rect width='100' height='6'/></clipPath>"
             "<rect id='a' width='50' height='50' clip-path='url(#q)'/>",
             {{"a", 30}}},
        Seen{"clip_whose_paint_does_not_matter",
             "<clipPath id='p'><rect width='5' height='100' fill='none' opacity='0'/></clipPath>"
             "<rect id='a' width='50' height='10' clip-path='url(#p)'/>",
             {{"a", 50}}},
        Seen{"dots",
             path("M10 10 H35",
                  "stroke='black' stroke-width='6' stroke-linecap='round' stroke-dasharray='0 10'"),
             {{"a 1", 9 * pi}, {"a 2", 9 * pi}, {"a 3", 9 * pi}}},
        Seen{"dashes_in_ems",
             path("M10 10 H60", "stroke='black' stroke-width='4' font-size='10' stroke-dasharray='1em,200%'"),
             {{"a", 40}}},
        Seen{"dashes_of_a_path_that_says_its_length",
             path("M10 10 H60", "stroke='black' stroke-width='4' pathLength='5' stroke-dasharray='1 2'"),
             {{"a 1", 40}, {"a 2", 40}}},
        Seen{"a_move_alone_is_no_dot",
             path("M10 10h10v10h-10z M50 50",
                  "fill='none' stroke='black' stroke-width='4' stroke-linecap='round'"),
             {{"a", 14 * 14 - 6 * 6}}},
        Seen{"properties_in_any_case",
             square +
                 "<rect width='9' height='9' style='FILL: none'/><rect width='9' height='9' opacity='.00'/>",
             {{"a", 100}}},
        Seen{"by_a_part_of_an_attribute",
             "<style>[id^=gui],[id$='ide2'],[class*=xy],[class~=c],[lang|=en]{display:none}</style>" +
                 square +
                 "<g id='guide'><rect width='9' height='9'/></g><rect id='hide2' width='9' height='9'/>"
                 "<rect class='wxyz' width='9' height='9'/><rect class='b c' width='9' height='9'/>"
                 "<rect lang='en-GB' width='9' height='9'/><rect id='b' class='cd' width='3' height='3'/>",
             {{"a", 100}, {"b", 9}}},
        Seen{"sheets_of_other_types",
             "<style type='text/x'>rect{display:none}</style><style type='text/css'>#b{fill:none}</style>" +
                 square + "<rect id='b' width='10' height='10'/>",
             {{"a", 100}}},
        Seen{"what_is_printed_is_not_shown",
             "<style media='print'>rect{display:none}</style><style media='screen'>#b{fill:none}</style>" +
                 square + "<rect id='b' width='3' height='3'/>",
             {{"a", 100}}},
        // 20 x 10 turned by a right angle, with its long side along the frame's left edge, 5 of 10 inside.
        Seen{"units_of_transforms",
             "<svg width='50' height='100'><rect id='a' width='20' height='10' "
             "style='transform: translate(5px, .1in) rotate(.25turn)'/><rect id='b' width='20' height='10' "
             "style='transform: translateX(5px) rotate(1.5707963267948966rad)'/></svg>",
             {{"a", 100}, {"b", 100}}},
        // A square on its corner about the frame's edge: half of it is in.
        Seen{"turned_about_an_origin",
             "<svg width='50' height='100'><rect id='a' x='40' y='40' width='20' height='20' "
             "style='transform-origin: 50px 50px; transform: rotate(45deg)'/></svg>",
             {{"a", 200}}},
        Seen{"turned_about_the_middle_of_the_view",
             "<svg width='100' height='50'><rect id='a' x='40' y='15' width='20' height='20' "
             "style='transform-origin: center; transform: scaleX(2) rotate(90deg) translateX(25px)'/></svg>",
             {{"a", 400}}},
        Seen{"style_transform",
             path("M0 0h10v10h-10z", "style='transform: rotate(30deg) scale(2)'"),
             {{"a", 400}}},
        Seen{"ring_drawn_in_one_line", path("M0 0H30V30H0V0H10V20H20V10H0Z"), {{"a", 900 - 100}}},
        Seen{"hole_that_touches_the_edge",
             path("M0 0H30V30H0Z M15 0 L20 10 L10 10 Z", "fill-rule='evenodd'"),
             {{"a", 850}}}),
    [](const auto& info) { return info.param.name; });

TEST(Svg, EntitiesStandForWhatTheDocumentTypeSays) {
  const std::string type =
      "<!DOCTYPE svg PUBLIC '-//W3C//DTD SVG 1.1//EN' 'svg11.dtd' [<!ENTITY s 'fill:none;stroke:#000;"
      "stroke-width:4'> <!ENTITY d \"10 H60\"> <!ENTITY e \"M10 &d;\">]>";
  const auto drawn = [&](const std::string& types, const char* shape) {
    return Drawing("<?xml version='1.0'?>" + types + drawing(shape), "t.svg")
        .shapes({.metres_per_unit = 1})
        .shapes;
  };
  const auto wire = drawn(type, "<path id='a' style='&s;' d='&e;'/>");
  ASSERT_EQ(wire.size(), 1u);
  EXPECT_NEAR(area(wire[0].outline), 200, 1e-9);
  std::string tower = "<!DOCTYPE svg [<!ENTITY e0 '0123456789'>";
  for (int i = 1; i < 12; ++i) {
    const std::string below = "&e" + std::to_string(i - 1) + ";";
    tower += "<!ENTITY e" + std::to_string(i) + " '";
    for (int j = 0; j < 10; ++j) tower += below;
    tower += "'>";
  }
  EXPECT_THROW(drawn(tower + "]>", "<rect id='&e11;' width='1' height='1'/>"), InvalidInput);
}

TEST(Svg, PathDataMayBeAMatterOfStyle) {
  const std::string styled = path("M0 0h9v9h-9z", "style='d:path(&quot;M 0,0 h2 v2 h-2 z&quot;)'");
  EXPECT_NEAR(area(outline(styled)), 4, 1e-12);
  EXPECT_NEAR(area(outline("<style>path { d: path(\"M0 0h3v3h-3z\") }</style>" + path("M0 0h9v9h-9z"))), 9,
              1e-12);
}

TEST(Svg, RulesThatAreNotFollowedAreSaid) {
  const auto left_out = [](const std::string& sheet) {
    return Drawing(drawing("<style>" + sheet + "</style>" + square), "t.svg")
        .shapes({.metres_per_unit = 1})
        .left_out;
  };
  for (const char* said :
       {"rect:nth-child(2){fill:none}", "g + rect{display:none}", "g~rect{r:2px}", "@import 'a.css';",
        "rect:not(.b){stroke:red}", "@media screen{rect{display:none}}",
        "@media (min-width:1px){a:not(.b){r:2px}}", "@supports (fill:none){rect{fill:none}}"}) {
    EXPECT_EQ(left_out(said).size(), 1u) << said;
  }
  for (const char* silent :
       {"rect:hover{fill:none}", "a:not(.b){cursor:pointer}", "@media print{rect{fill:none}}",
        "@charset 'x';", "@media screen{a{cursor:pointer}}", "@font-face{src:url(x)}"}) {
    EXPECT_TRUE(left_out(silent).empty()) << silent;
  }
}

// The corners of a square are quarters of circles; one of its sides is an arc of a circle of 30 km. Chords
// are within a ten-thousandth of the shape's diagonal, so what they leave of the area is within that times
// the perimeter.
TEST(Svg, ChordsFollowTheShapeNotTheCirclesThatItsArcsArePartsOf) {
  const std::string data =
      "M10 0 H90 A10 10 0 0 1 100 10 V90 A10 10 0 0 1 90 100 H10 A10 10 0 0 1 0 90 "
      "A30000000 30000000 0 0 1 0 10 A10 10 0 0 1 10 0 Z";
  const auto drawn = Drawing(drawing(path(data)), "t.svg").shapes({.metres_per_unit = 1});
  ASSERT_EQ(drawn.shapes.size(), 1u);
  const Outline& outline = drawn.shapes[0].outline;
  EXPECT_NEAR(area(outline), 100 * 100 - (4 - pi) * 10 * 10,
              1e-4 * std::hypot(100, 100) * perimeter(outline));
  // Of a quarter of a circle of 10, sagitta 0.0141: step 2 acos(1 - 0.00141) = 0.1064, 15 chords; of the
  // others one each.
  EXPECT_EQ(outline.outer.size(), 4 * 15 + 4u);
}

// Within a ten-thousandth of its own diagonal: of the first, 150 x 100, 0.018 m.
TEST(Svg, SliversAreMendedAndSaid) {
  const auto drawn = [](const std::string& content) {
    return Drawing(drawing(content), "t.svg").shapes({.metres_per_unit = 1});
  };
  const auto one = drawn(path("M0 0h100v100h-100z M150 0h0.001v100h-0.001z M10 10 v80 h.001 v-80z"));
  ASSERT_EQ(one.shapes.size(), 1u);
  EXPECT_DOUBLE_EQ(area(one.shapes[0].outline), 1e4);
  EXPECT_TRUE(one.shapes[0].outline.holes.empty());
  ASSERT_EQ(one.left_out.size(), 1u);
  EXPECT_EQ(one.left_out[0].place, "t.svg:#a");
  EXPECT_EQ(one.left_out[0].what, "has 2 slivers, areas or gaps thinner than 0.018 m");
  const auto hair = drawn("<rect id='hair' width='100' height='0.001'/>");
  EXPECT_TRUE(hair.shapes.empty());
  ASSERT_EQ(hair.left_out.size(), 1u);
  EXPECT_EQ(hair.left_out[0].what, "has 1 sliver, an area or a gap thinner than 0.01 m");
  // What rounding leaves where a stroke's round joins meet its sides is not worth a word.
  EXPECT_TRUE(drawn("<circle id='a' cx='50' cy='50' r='20' fill='none' stroke='black' stroke-width='9.3' "
                    "stroke-dasharray='7 3' stroke-linecap='round' transform='rotate(7)'/>")
                  .left_out.empty());
}

TEST(Svg, WhatReachesTooFarIsLeftOutAlone) {
  const auto drawn = Drawing(drawing("<circle id='far' r='1e30'/>" + path("M0 0h9v9h-9z")), "t.svg")
                         .shapes({.metres_per_unit = 1});
  ASSERT_EQ(drawn.shapes.size(), 1u);
  EXPECT_EQ(drawn.shapes[0].name, "a");
  ASSERT_EQ(drawn.left_out.size(), 1u);
  EXPECT_EQ(drawn.left_out[0].place, "t.svg:#far, shape");
  EXPECT_EQ(drawn.left_out[0].what, "reaches beyond 1e12 m");
}

TEST(Svg, ClipsOfWhatIsNoShapeAreSaid) {
  const auto places = [](const std::string& content) {
    const auto drawn = Drawing(drawing(content), "t.svg").shapes({.metres_per_unit = 1});
    EXPECT_TRUE(drawn.shapes.empty());
    std::string all;
    for (const Problem& problem : drawn.left_out) all += problem.place + " " + problem.what + "\n";
    return all;
  };
  const std::string clipped = "<rect id='a' width='10' height='10' clip-path='url(#p)'/>";
  EXPECT_EQ(places("<clipPath id='p'><text>x</text></clipPath>" + clipped),
            "t.svg:#a, clip-path has a part that is text\n");
  EXPECT_EQ(places("<mask id='p'/>" + clipped), "t.svg:a, clip-path is a <mask>\n");
  EXPECT_EQ(places("<clipPath id='p' clip-path='url(#p)'/>" + clipped), "t.svg:a, clip-path clips itself\n");
  EXPECT_EQ(places("<mask id='m'><rect width='9' height='9' fill='#777'/></mask>"
                   "<rect id='a' width='10' height='10' mask='url(#m)'/>"),
            "t.svg:#a, mask is half transparent: \"#777\"\n");
}

TEST(Svg, OneBadShapeIsLeftOutAndSaid) {
  const auto drawn = Drawing(drawing(square + "<path id='b' d='M 0 0 L 1 x'/><text id='t'>x</text>"), "t.svg")
                         .shapes({.metres_per_unit = 1});
  ASSERT_EQ(drawn.shapes.size(), 1u);
  ASSERT_EQ(drawn.left_out.size(), 2u);
  EXPECT_EQ(drawn.left_out[0].place, "t.svg:t");
  EXPECT_EQ(drawn.left_out[1].place, "t.svg:#b, path command 2");
}

TEST(DrawnScene, PiecesAreAsFewAsBox2DCanCollide) {
  const Drawing page(drawing("<rect id='wide' y='0' width='100' height='100'/>"
                             "<rect id='thin' x='200' width='10' height='10'/>"
                             "<rect id='large' y='-500' width='400' height='200'/>"),
                     "t.svg");
  const DrawnScene drawn = drawing_scene(page, 0.001);  // 0.1, 0.01 and 0.4 m
  ASSERT_EQ(drawn.scene.bodies.size(), 4u);
  const auto& bodies = drawn.scene.bodies;
  EXPECT_EQ(bodies[1].pieces, 4);  // of 25 mm, where 8 would be of 12.5
  EXPECT_EQ(bodies[3].pieces, 8);
  EXPECT_TRUE(bodies[1].collides && bodies[3].collides);
  EXPECT_FALSE(bodies[2].collides);
  EXPECT_EQ(drawn.too_thin, 1);
  b2World world({0, -10});
  EXPECT_NO_THROW(build(world, calibrate(drawn.scene)));
}

// Cuts across the long axis alone would leave the legs of the portal whole, or run along them.
TEST(DrawnScene, WhatBendsIsSplitAcrossItsMiddleLine) {
  const Drawing page(
      drawing("<path id='portal' fill='none' stroke='black' stroke-width='2' d='M10 50L18 10H62L70 50'/>"
              "<rect id='bar' x='80' y='10' width='2' height='30' transform='rotate(7)'/>"
              "<path id='wedge' d='M0 0h30v-8z'/><circle id='disc' cx='40' cy='-20' r='5'/>"
              "<path id='bent' fill='none' stroke='black' d='M0 -30h20v-5'/>"
              "<circle id='ring' cx='60' cy='-20' r='5' fill='none' stroke='black'/>"),
      "t.svg");
  const DrawnScene drawn = drawing_scene(page, 0.1);
  std::map<std::string, BodyDef> body;
  for (const BodyDef& each : drawn.scene.bodies) body[each.name] = each;
  for (const char* bent : {"portal", "bent", "ring"}) {
    EXPECT_TRUE(body[bent].automatic) << bent;
    EXPECT_EQ(body[bent].pieces, 1) << bent;
  }
  for (const char* straight : {"bar", "wedge", "disc"}) {
    EXPECT_FALSE(body[straight].automatic) << straight;
    EXPECT_EQ(body[straight].pieces, 8) << straight;
  }
  const Plan plan = calibrate(drawn.scene);
  double least = unlimited, most = 0;  // heights of the portal's cuts: none runs along a leg
  for (const PlannedJoint& joint : plan.joints) {
    if (joint.a < 0 || drawn.scene.bodies[plan.pieces[joint.a].body].name != "portal") continue;
    least = std::min(least, joint.height);
    most = std::max(most, joint.height);
  }
  EXPECT_NEAR(least, 0.2, 1e-3);
  EXPECT_LT(most, 0.25);
}

TEST(DrawnScene, WhatLiesOverAnotherDoesNotCollideWithIt) {
  const Drawing page(
      drawing(
          "<rect id='a' width='100' height='100'/><rect id='on_a' y='-100' width='100' height='100.05'/>"
          "<rect id='upright' x='300' width='20' height='100'/>"
          "<rect id='across' x='250' y='40' width='120' height='20'/>"
          "<rect id='end' x='360' y='45' width='100' height='10'/>"
          "<path id='frame' d='M500 0H600V100H500Z M510 10V90H590V10Z'/>"
          "<rect id='within' x='530' y='30' width='40' height='40'/>"
          "<rect id='sheet' x='700' width='100' height='100'/><circle id='eye' cx='750' cy='50' r='20'/>"),
      "t.svg");
  const DrawnScene drawn = drawing_scene(page, 0.1);
  std::map<std::string, int> group;
  for (const BodyDef& body : drawn.scene.bodies) group[body.name] = body.group;
  for (const char* alone : {"floor", "a", "on_a", "frame", "within"}) EXPECT_EQ(group[alone], 0) << alone;
  EXPECT_LT(group["across"], 0);  // the bars cross, and no corner of either is in the other
  EXPECT_EQ(group["upright"], group["across"]);
  EXPECT_EQ(group["end"], group["across"]);
  EXPECT_LT(group["sheet"], 0);
  EXPECT_EQ(group["eye"], group["sheet"]);
  EXPECT_NE(group["eye"], group["across"]);
  EXPECT_EQ(drawn.heaped, 5);
}

TEST(DrawnScene, EachStretchOnTheFloorIsHeldOnce) {
  const Drawing page(drawing("<path id='table' d='M0 0H90V100H80L75 100H70V20H20V100L15 100H10Z'/>"
                             "<path id='lamp' d='M0 -50H90V-20Z'/>"),
                     "t.svg");
  const DrawnScene drawn = drawing_scene(page, 0.1);
  ASSERT_EQ(drawn.scene.supports.size(), 2u);
  for (const SupportDef& support : drawn.scene.supports) {
    EXPECT_EQ(support.body, "table");
    EXPECT_TRUE(std::abs(support.at.x - 1.5) < 1e-12 || std::abs(support.at.x - 8) < 1e-12) << support.at.x;
  }
}

TEST(Svg, EncodingsAreDecodedOrRefused) {
  const auto ids = [](const std::string& declared, const std::string& id) {
    const std::string page = drawing("<rect id='" + id + "' width='9' height='9'/>");
    return Drawing("<?xml version=\"1.0\"" + declared + "?>" + page.substr(page.find("<svg")), "t.svg").ids();
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(ids("", "B\xC3\xA4r"), Names{"B\xC3\xA4r"});
  EXPECT_EQ(ids(" encoding='ISO-8859-1'", "B\xE4r"), Names{"B\xC3\xA4r"});
  EXPECT_EQ(ids(" encoding=\"Windows-1252\" standalone='no'", "B\xE4r \x80"),
            Names{"B\xC3\xA4r \xE2\x82\xAC"});
  EXPECT_EQ(ids(" encoding='cp1252'", "Bar"), Names{"Bar"});
  EXPECT_EQ(ids(" encoding=", "Bar"), Names{"Bar"});
  const auto refused = [&](const std::string& declared, const std::string& id) -> std::string {
    try {
      ids(declared, id);
      return "";
    } catch (const InvalidInput& error) {
      return error.problems().at(0).place + " " + error.problems().at(0).what;
    }
  };
  const std::string what = "has a byte that is no UTF-8";
  EXPECT_EQ(refused("", "B\xE4r").find("t.svg:1:"), 0u);
  for (const char* bad : {"B\xE4r", "\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xFF"})
    EXPECT_NE(refused("", bad).find(what), std::string::npos) << bad;
  EXPECT_NE(refused(" encoding='utf-8'", "B\xE4r").find(what), std::string::npos);
  EXPECT_EQ(refused("", "\xF4\x8F\xBF\xBF\xED\x9F\xBF\xE0\xA0\x80"), "");
  EXPECT_EQ(refused("", "&#xD800;"), "t.svg:rect refers to a character that there is not");
}

TEST(Svg, AHiddenShapeIsTakenByItsName) {
  EXPECT_NEAR(area(outline("<defs><rect id='a' width='10' height='10'/></defs>")), 100, 1e-12);
  EXPECT_NEAR(area(outline("<g display='none' transform='scale(2)'>" + square + "</g>")), 400, 1e-12);
}

TEST(Svg, OneOfSeveralAreasIsTakenByItsNumber) {
  const Drawing page(drawing(path("M0 0h1v1h-1z M3 3h2v2h-2z")), "t.svg");
  EXPECT_NEAR(area(page.outline("a 1", {.metres_per_unit = 1})), 4, 1e-12);
  EXPECT_NEAR(area(page.outline("a 2", {.metres_per_unit = 1})), 1, 1e-12);
  EXPECT_THROW(page.outline("a 3", {.metres_per_unit = 1}), InvalidInput);
}
}  // namespace
