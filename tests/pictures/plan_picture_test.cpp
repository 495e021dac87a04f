#include "ductile/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <pugixml.hpp>
#include <regex>
#include <set>

#include "ductile/colours.h"
#include "ductile/files.h"
#include "ductile/plane.h"
#include "ductile/strips.h"

namespace ductile {
namespace {

using Node = pugi::xml_node;

/// A wall and a 4 m beam of four pieces that sticks out of it.
Plan beam() {
  BodyDef wall{
      .name = "wall", .type = BodyType::static_body, .outline = {{{-1, -1}, {0, -1}, {0, 2}, {-1, 2}}}};
  BodyDef beam{.name = "beam", .outline = {{{0, 0}, {4, 0}, {4, 1}, {0, 1}}}, .material = materials::S355};
  beam.pieces = 4;
  beam.along = {{{0, 0.5}, {4, 0.5}}};
  SceneDef scene{.bodies = {wall, beam}, .joints = {{"wall", "beam"}}};
  scene.loads = {{.body = "beam", .at = {4, 0.5}, .force = {0, -2e3}, .from = 1, .ramp = 2, .to = 5}};
  return calibrate(scene);
}

pugi::xml_document parse(const std::string& svg) {
  pugi::xml_document document;
  const auto result = document.load_string(svg.c_str());
  EXPECT_TRUE(result) << result.description();
  EXPECT_STREQ(document.document_element().name(), "svg");
  EXPECT_FALSE(std::regex_search(svg, std::regex("[ \"(,](nan|-?inf)"))) << svg;
  return document;
}

std::vector<Node> all(Node below, const char* css_class) {
  std::vector<Node> found;
  for (const auto& match : below.select_nodes((".//g[@class='" + std::string(css_class) + "']").c_str()))
    found.push_back(match.node());
  return found;
}

Node named(Node below, const char* css_class, const std::string& name) {
  for (const Node& node : all(below, css_class))
    if (std::string(node.child_value("title")).starts_with(name + ":") || node.child_value("title") == name)
      return node;
  ADD_FAILURE() << css_class << " '" << name << "' is not in the picture";
  return {};
}

Point dot(const Node& joint) {
  const Node circle = joint.child("circle");
  return {circle.attribute("cx").as_double(), circle.attribute("cy").as_double()};
}

std::string hex(Colour c) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c.red, c.green, c.blue);
  return text;
}

std::string words(const Node& node) {
  std::string all;
  for (const auto& match : node.select_nodes(".//text"))
    all += std::string(match.node().child_value()) + "\n";
  return all;
}

/// px per metre as the scale bar says.
double scale_bar(const Node& svg) {
  std::smatch length, px;
  const std::string text = words(svg);
  EXPECT_TRUE(std::regex_search(text, length, std::regex("\n([0-9.]+) (m?)m\n$"))) << text;
  const double metres = std::stod(length[1]) * (length[2] == "m" ? 1e-3 : 1);
  for (const auto& match : svg.select_nodes("path")) {
    const std::string d = match.node().attribute("d").value();
    if (std::regex_match(d, px, std::regex("M.*v-8h([0-9.]+)v8"))) return std::stod(px[1]) / metres;
  }
  ADD_FAILURE() << "no scale bar";
  return 0;
}

TEST(Picture, HasEveryPieceAndJointOnceAndToScale) {
  const Plan plan = beam();
  const auto document = parse(picture_svg(plan, {.title = "A <beam> & a wall", .panels = {Panel{}}}));
  const Node svg = document.document_element();
  EXPECT_NE(words(svg).find("A <beam> & a wall"), std::string::npos);
  EXPECT_EQ(all(svg, "piece").size(), plan.pieces.size());
  EXPECT_EQ(all(svg, "joint").size(), plan.joints.size());
  for (const Piece& piece : plan.pieces) named(svg, "piece", piece.name);
  const Point a = dot(named(svg, "joint", "beam/0-beam/1")), b = dot(named(svg, "joint", "beam/2-beam/3"));
  EXPECT_NEAR((b.x - a.x) / scale_bar(svg), 2, 0.005);  // drawn to a tenth of a px
  EXPECT_NEAR(b.y, a.y, 0.11);
}

TEST(Picture, ColoursJointsByPlasticMoment) {
  Plan plan = beam();
  plan.joints[0].M = 1e3;
  plan.joints[1].M = 0;
  plan.joints[2].M = unlimited;
  plan.joints[3].M = 1e6;
  const auto document = parse(picture_svg(plan, {.panels = {Panel{}}}));
  std::vector<std::string> paints;
  for (const Node& joint : all(document, "joint"))
    paints.emplace_back(joint.child("circle").attribute("fill").value());
  const auto stops = document.select_nodes("//linearGradient[@id='moments']/stop");
  ASSERT_GE(stops.size(), 2u);
  EXPECT_EQ(paints[0], stops[0].node().attribute("stop-color").value());
  EXPECT_EQ(paints[1], "#ffffff");
  EXPECT_EQ(paints[3], stops[stops.size() - 1].node().attribute("stop-color").value());
  EXPECT_EQ(std::count(paints.begin(), paints.end(), paints[2]), 1);
  const std::string text = words(document);
  EXPECT_NE(text.find("1 kN m"), std::string::npos) << text;
  EXPECT_NE(text.find("1 MN m"), std::string::npos) << text;
}

TEST(Picture, ShowsARunInItsOwnPanels) {
  const Plan plan = beam();
  std::vector<PieceReading> pieces;
  for (const Piece& piece : plan.pieces) pieces.push_back({.position = piece.center});
  std::vector<JointReading> joints(plan.joints.size());
  const auto index = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(plan.joints.begin(), plan.joints.end(), [&](auto& j) { return j.name == name; }) -
        plan.joints.begin());
  };
  joints[index("wall-beam/0")].usage.M = 0.5;
  joints[index("beam/0-beam/1")] = {.accumulated_rotation = 0.2, .capacity_used = 0.4, .dissipated = 1};
  joints[index("beam/2-beam/3")] = {.broken = true, .broken_at = 1.25};
  pieces.back().position.y -= 1;  // the last piece has dropped by 1 m
  const Panel whole{.title = "before", .time = 0, .pieces = pieces, .joints = {}};
  Panel broken{.title = "after", .time = 2, .pieces = pieces, .joints = joints};
  const auto document = parse(picture_svg(plan, {.panels = {broken, broken, whole}}));
  const auto panels = all(document, "panel");
  ASSERT_EQ(panels.size(), 3u);
  EXPECT_EQ(all(document, "joint").size(), 3 * plan.joints.size());

  const Node elastic = named(panels[0], "joint", "wall-beam/0"),
             hinge = named(panels[0], "joint", "beam/0-beam/1"),
             gone = named(panels[0], "joint", "beam/2-beam/3");
  EXPECT_EQ(elastic.child("circle").attribute("fill").value(), hex(stage_colour(0.5)));
  EXPECT_EQ(hinge.child("circle").attribute("fill").value(), hex(stage_colour(1.4)));
  EXPECT_GT(hinge.child("circle").attribute("r").as_double(),
            elastic.child("circle").attribute("r").as_double());
  EXPECT_FALSE(gone.child("circle"));
  EXPECT_NE(std::string(gone.child_value("title")).find("broke at 1.25 s"), std::string::npos);

  // Its banks are a metre apart now: each is the first path of its group's two halves.
  std::vector<double> heights;
  for (const Node& path : gone.children("path")) {
    std::smatch match;
    const std::string d = path.attribute("d").value();
    if (std::regex_match(d, match, std::regex("M[0-9.]+ ([0-9.]+)L.*")))
      heights.push_back(std::stod(match[1]));
  }
  ASSERT_EQ(heights.size(), 2u);
  EXPECT_NEAR((heights[1] - heights[0]) / scale_bar(document.document_element()), 1, 0.01);
}

// What rounding makes of equal sections is one colour and one tick.
TEST(Picture, EqualMomentsHaveOneColour) {
  Plan plan = beam();
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    plan.joints[i].M = 1e6 * (1 + 1e-13 * static_cast<double>(i));
  const auto document = parse(picture_svg(plan, {.panels = {Panel{}}}));
  std::set<std::string> paints;
  for (const Node& joint : all(document, "joint"))
    paints.insert(joint.child("circle").attribute("fill").value());
  EXPECT_EQ(paints.size(), 1u);
  plan.joints[0].M *= 1.1;
  const auto apart = parse(picture_svg(plan, {.panels = {Panel{}}}));
  paints.clear();
  for (const Node& joint : all(apart, "joint"))
    paints.insert(joint.child("circle").attribute("fill").value());
  EXPECT_EQ(paints.size(), 2u);
}

TEST(Picture, DrawsLoadsAsTheyAreAtThePanelsTime) {
  const Plan plan = beam();
  const auto loads = [&](std::optional<double> time) {
    Panel panel;
    panel.time = time;
    const auto document = parse(picture_svg(plan, {.panels = {panel}}));
    std::string text;
    for (const Node& load : all(document, "load")) text += words(load);
    return text;
  };
  EXPECT_EQ(loads(std::nullopt), "2 kN\n");
  EXPECT_EQ(loads(0.5), "");
  EXPECT_EQ(loads(2), "1 kN\n");
  EXPECT_EQ(loads(4), "2 kN\n");
  EXPECT_EQ(loads(5), "");
}

TEST(Picture, HoldsWhateverAPlanHolds) {
  parse(picture_svg(Plan{}, {.panels = {Panel{}}}));
  SceneDef scene;
  scene.bodies = {{.name = "ground",
                   .type = BodyType::static_body,
                   .outline = {{{-1e4, -1}, {1e4, -1}, {1e4, 0}, {-1e4, 0}}}}};
  scene.bodies[0].name = "floor";
  BodyDef wheel{.name = "wheel", .circle = 0.5, .material = materials::S355, .at = {0, 0.5}};
  scene.bodies.push_back(wheel);
  scene.loads = {{.body = "wheel", .at = {0, 0.5}, .moment = -5}};
  const Plan plan = calibrate(scene);
  const auto document = parse(picture_svg(plan, {.panels = {Panel{}}}));
  EXPECT_EQ(words(all(document, "load").front()), "5 N m\n");
  // The floor of 20 km does not make a dot of the wheel.
  EXPECT_GT(document.select_node("//circle").node().attribute("r").as_double(), 50);

  Panel away;
  for (const Piece& piece : plan.pieces)
    away.pieces.push_back({.position = {piece.center.x, piece.center.y + 1e30}});
  parse(picture_svg(plan, {.panels = {away}}));
}

// Of a group's path, the farthest that its points are above `y` px, and below.
std::array<double, 2> reach(const Node& path, double y) {
  std::array<double, 2> most{};
  const std::string d = path.attribute("d").value();
  const std::regex point("[ML][-0-9.]+ ([-0-9.]+)");
  for (std::sregex_iterator i(d.begin(), d.end(), point), end; i != end; ++i) {
    most[0] = std::max(most[0], y - std::stod((*i)[1]));
    most[1] = std::max(most[1], std::stod((*i)[1]) - y);
  }
  return most;
}

// 4 m beam out of a wall, 2 kN at its tip, no weight: M = −8 kN m at the wall, in proportion to the distance
// from the tip, above the line (in tension); Q = −2 kN all along, below it.
TEST(Picture, DrawsDiagramsOfWhatPiecesCarry) {
  Plan plan = beam();
  plan.gravity = {};
  std::vector<JointReading> joints;
  for (const PlannedJoint& joint : plan.joints)
    joints.push_back({.Q = -2e3, .M = -2e3 * (4 - joint.anchor.x)});
  const auto drawn = [&](Row row) {
    return parse(picture_svg(plan, {.panels = {{.joints = joints, .diagram = row}}}));
  };
  const auto moments = drawn(rotation), shears = drawn(shear);
  ASSERT_EQ(all(moments, "strip").size(), 4u);
  EXPECT_EQ(words(all(moments, "diagram").front()), "8 kN m\n");
  EXPECT_EQ(words(all(shears, "diagram").front()), "-2 kN\n");
  const auto line = [](const Node& strip) {  // the last points are those of the line
    const std::string d = strip.child("path").attribute("d").value();
    return std::stod(d.substr(d.rfind(' ') + 1));
  };
  const Node first = named(moments, "strip", "beam/0"), last = named(moments, "strip", "beam/3");
  const auto at_wall = reach(first.child("path"), line(first)),
             at_tip = reach(last.child("path"), line(last));
  EXPECT_NEAR(at_wall[0] / at_tip[0], 4, 0.05);
  EXPECT_NEAR(at_wall[1], 0, 0.11);
  for (const Node& strip : all(shears, "strip")) {
    const auto [above, below] = reach(strip.child("path"), line(strip));
    EXPECT_NEAR(above, 0, 0.11);
    EXPECT_NEAR(below, at_wall[0], 0.11);  // each is the largest of its kind
  }
  joints[0].M = std::nan("");  // of a loose structure
  drawn(rotation);
}

TEST(Picture, DrawsMotionsToAScaleWithTheirHinges) {
  const Plan plan = beam();
  std::vector<Motion> motions(plan.pieces.size());
  motions.back() = {{0, -0.001}, 0};
  EXPECT_EQ(exaggeration(plan, motions), 200);  // 0.12 of 4 m, or a little less
  EXPECT_EQ(exaggeration(plan, std::vector<Motion>(plan.pieces.size())), 1);
  const auto document = parse(picture_svg(
      plan, {.panels = {{.motions = motions, .times = 500, .hinges = {3, 0}, .numbered = true}}}));
  const auto height = [&](const char* piece) {
    const std::string d = named(document, "piece", piece).child("path").attribute("d").value();
    return std::stod(d.substr(d.find(' ') + 1));
  };
  EXPECT_NEAR((height("beam/3") - height("beam/2")) / scale_bar(document.document_element()), 0.5, 0.01);
  EXPECT_EQ(words(named(document, "joint", plan.joints[3].name)), "1\n");
  EXPECT_EQ(words(named(document, "joint", plan.joints[0].name)), "2\n");
  EXPECT_FALSE(named(document, "joint", plan.joints[1].name).child("circle"));
}

// Loads side by side: no label lies on another, whichever way they point.
TEST(Picture, LabelsLieBesideEachOther) {
  Plan plan = beam();
  plan.loads.clear();
  for (int i = 0; i < 6; ++i) {
    const Point at{3 + 0.2 * i, 1};
    plan.loads.push_back({3, at, {.body = "beam", .at = at, .force = {i % 2 ? 1e3 : 0., -1e6 - i * 1e3}}});
  }
  const auto document = parse(picture_svg(plan, {.panels = {Panel{}}}));
  struct Label {
    double x0, x1, y;
  };
  std::vector<Label> labels;
  for (const Node& load : all(document, "load")) {
    const Node text = load.child("text");
    const double x = text.attribute("x").as_double(), w = 7 * static_cast<double>(words(load).size() - 1);
    const std::string anchor = text.attribute("text-anchor").value();
    const double x0 = anchor == "end" ? x - w : anchor == "middle" ? x - w / 2 : x;
    labels.push_back({x0, x0 + w, text.attribute("y").as_double()});
  }
  ASSERT_EQ(labels.size(), 6u);
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_TRUE(labels[i].x1 <= labels[j].x0 || labels[j].x1 <= labels[i].x0 ||
                  std::abs(labels[i].y - labels[j].y) >= 12)
          << i << " " << j;
}

// The same beam, which a rope pulls up by 4 kN 2.5 m out, in the middle of a piece: M = −2 kN · 1.5 m there.
TEST(Picture, SupportsAreDrawnAsWhatTheyHold) {
  const auto drawn = [](SupportDef support) {
    BodyDef beam{.name = "beam", .outline = {{{0, 0}, {4, 0}, {4, 1}, {0, 1}}}, .material = materials::S355};
    beam.pieces = 4;
    support.body = "beam";
    SceneDef scene{.bodies = {beam}, .supports = {support}};
    const auto svg = parse(picture_svg(calibrate(scene), {.title = "t", .panels = {Panel{}}}));
    std::string paths;
    for (const Node& path : named(svg, "joint", "support/0").children("path"))
      paths += std::regex_replace(path.attribute("d").value(), std::regex("[-0-9. ]+"), " ") + ";";
    return paths;
  };
  const std::string triangle = drawn({.at = {0, 0.5}, .fix_x = true, .fix_y = true}),
                    clamp = drawn({.at = {0, 0.5}, .fix_x = true, .fix_y = true, .fix_angle = true}),
                    x_spring = drawn({.at = {0, 0.5}, .fix_y = false, .stiffness_x = 1e6}),
                    both = drawn({.at = {0, 0.5}, .fix_y = true, .stiffness_x = 1e6});
  EXPECT_EQ(drawn({.at = {0, 0.5}, .fix_y = true}), triangle);
  EXPECT_NE(clamp, triangle);
  EXPECT_NE(x_spring, triangle);
  EXPECT_EQ(both, x_spring + triangle);
}

TEST(Picture, ARopePullsWhereItIsFixed) {
  Plan plan = beam();
  plan.gravity = {};
  const Point top{0, 2}, fixed{2.5, 0.5};
  plan.joints.push_back(
      {.name = "rope", .a = 0, .b = 3, .anchor = top, .axis = unit(fixed - top), .end = fixed});
  std::vector<JointReading> joints;
  for (const PlannedJoint& joint : plan.joints) {
    const double x = joint.anchor.x, lift = x < fixed.x ? 4e3 : 0;
    joints.push_back({.N = -lift / 0.6, .Q = lift - 2e3, .M = -2e3 * (4 - x) + lift * (fixed.x - x)});
  }
  joints.back() = {.N = 4e3 * std::hypot(1, 0.6) / 0.6};
  std::size_t stations = 0;
  for (const diagram::Strip& strip : diagram::strips(plan, joints))
    for (const diagram::Station& s : strip.stations) {
      ++stations;
      EXPECT_NEAR(s.M, -2e3 * (4 - s.at.x) + 4e3 * std::max(0., fixed.x - s.at.x), 1) << s.at.x;
    }
  EXPECT_GT(stations, 16u);
}

// In the deformed state: all of the beam turned by 0.1, the joint to the wall by half of that, and the load
// not.
TEST(Picture, DiagramsOfPiecesThatHaveTurned) {
  Plan plan = beam();
  plan.gravity = {};
  const double turn = 0.1;
  std::vector<Motion> gone;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    gone.push_back({{}, plan.is_dynamic(static_cast<int>(i)) ? turn : 0});
  std::vector<JointReading> joints;
  for (const PlannedJoint& joint : plan.joints) {
    const double of_axis = plan.is_dynamic(joint.a) ? turn : turn / 2;
    joints.push_back({.N = -2e3 * std::sin(of_axis),
                      .Q = -2e3 * std::cos(of_axis),
                      .M = -2e3 * std::cos(turn) * (4 - joint.anchor.x)});
  }
  const std::vector<diagram::Strip> strips = diagram::strips(plan, joints, gone);
  ASSERT_EQ(strips.size(), 4u);
  for (const diagram::Strip& strip : strips)
    for (const diagram::Station& s : strip.stations) {
      if (s.at.x > 4 - 1e-9) continue;  // beyond the load
      EXPECT_NEAR(s.N, -2e3 * std::sin(turn), 1e-6) << s.at.x;
      EXPECT_NEAR(s.Q, -2e3 * std::cos(turn), 1e-6) << s.at.x;
      EXPECT_NEAR(s.M, -2e3 * std::cos(turn) * (4 - s.at.x), 1e-6) << s.at.x;
    }
}

// Forty equal loads along a bar: some are labelled, and no label lies on another.
TEST(Picture, EqualLoadsInARowShareLabels) {
  Plan plan = beam();
  plan.loads.clear();
  for (int i = 0; i < 40; ++i) {
    const Point at{0.1 * i, 1};
    plan.loads.push_back({1 + i / 10, at, {.body = "beam", .at = at, .force = {0, -4e3}}});
  }
  const auto document = parse(picture_svg(plan, {.panels = {Panel{}}}));
  std::vector<Point> labels;
  for (const Node& load : all(document, "load"))
    if (const Node text = load.child("text")) {
      EXPECT_EQ(words(load), "4 kN\n");
      labels.push_back({text.attribute("x").as_double(), text.attribute("y").as_double()});
    }
  EXPECT_EQ(all(document, "load").size(), 40u);
  EXPECT_GT(labels.size(), 3u);
  EXPECT_LT(labels.size(), 40u);
  for (std::size_t i = 0; i < labels.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_TRUE(std::abs(labels[i].x - labels[j].x) >= 28 || std::abs(labels[i].y - labels[j].y) >= 12)
          << i << " " << j;
}

// An arrow that would leave the panel, as under the lowest bar, ends where it acts instead.
TEST(Picture, ArrowsStayInThePanel) {
  Plan plan = beam();
  plan.pieces[0].outline = {{{0, -0.01}, {0, 0.01}, {-0.01, 0}}};
  for (const double down : {1., -1.}) {
    plan.loads = {{4, {3.9, 0.5}, {.body = "beam", .at = {3.9, 0.5}, .force = {0, -down * 1e3}}}};
    const auto document = parse(picture_svg(plan, {.panels = {Panel{}, Panel{}, Panel{}}}));
    const auto panel = document.document_element().child("g").child("rect");
    const double low = panel.attribute("y").as_double(), high = low + panel.attribute("height").as_double();
    const std::string d =
        all(document, "load").front().child("path").next_sibling("path").attribute("d").value();
    const double tip = std::stod(d.substr(d.find(' ') + 1));
    EXPECT_GE(tip, low);
    EXPECT_LE(tip, high);
  }
}

TEST(Picture, IsThatOfASimulation) {
  Simulation simulation(beam());
  for (int i = 0; i < 30; ++i) simulation.step();
  const Panel panel = panel_of(simulation, "now");
  EXPECT_EQ(panel.time, simulation.time());
  ASSERT_EQ(panel.pieces.size(), simulation.plan().pieces.size());
  ASSERT_EQ(panel.joints.size(), simulation.plan().joints.size());
  EXPECT_EQ(panel.pieces.back().position, simulation.piece(panel.pieces.size() - 1).position);
  EXPECT_EQ(panel.joints.front().M, simulation.joint(0).M);
}

}  // namespace
}  // namespace ductile
