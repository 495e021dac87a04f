#include <gtest/gtest.h>

#include <pugixml.hpp>
#include <regex>

#include "ductile/picture.h"

namespace {
using namespace ductile;

const Material steel = materials::S355;

struct Drawn {
  explicit Drawn(const Section& section, Point direction = {0, 1}) {
    const std::string svg = section_svg(section, direction, "A & B");
    EXPECT_TRUE(document.load_string(svg.c_str())) << svg;
    EXPECT_FALSE(std::regex_search(svg, std::regex("[ \"(,](nan|-?inf)"))) << svg;
  }
  std::string words() const {
    std::string all;
    for (const auto& match : document.select_nodes("//text"))
      all += std::string(match.node().child_value()) + "\n";
    return all;
  }
  /// Heights of the numbers after M, L of a path, px.
  std::vector<double> heights(const char* path) const {
    std::vector<double> found;
    const std::string d = document.select_node(path).node().attribute("d").value();
    const std::regex point("[ML]([-0-9.]+) ([-0-9.]+)");
    for (std::sregex_iterator i(d.begin(), d.end(), point), end; i != end; ++i)
      found.push_back(std::stod((*i)[2]));
    return found;
  }
  pugi::xml_document document;
};

TEST(SectionPicture, ShowsARectanglesCapacitiesAndItsNeutralAxisInTheMiddle) {
  const Drawn drawn(Section({{{0, 0}, {0.1, 0}, {0.1, 0.2}, {0, 0.2}}}, steel));
  const std::string words = drawn.words();
  // ¼ b h² f, b h f, shape factor 3/2.
  for (const char* said : {"355 kN m", "-355 kN m", "7.1 MN", "-7.1 MN", "shape factor 1.5", "A & B"})
    EXPECT_NE(words.find(said), std::string::npos) << said << "\n" << words;
  const auto axis = drawn.heights("//g[@class='pna']/path"),
             outline = drawn.heights("//g[@class='tension']/path");
  ASSERT_EQ(axis.size(), 2u);
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_EQ(axis[0], axis[1]);
  EXPECT_NEAR(axis[0], (outline[0] + outline[2]) / 2, 0.11);
}

TEST(SectionPicture, DrawsAnyDirectionHolesAndSeveralMaterials) {
  const Outline box{{{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {{{0.2, 0.2}, {1.8, 0.2}, {1.8, 0.8}, {0.2, 0.8}}}};
  const std::vector<Region> regions{{box, steel},
                                    {{{{0, 1}, {2, 1}, {2, 1.5}, {0, 1.5}}}, materials::concrete},
                                    {{{{0.2, 0.2}, {1, 0.2}, {1, 0.8}, {0.2, 0.8}}}, {.yield_stress = 1}}};
  std::vector<Region> without_E = regions;
  for (Region& region : without_E) region.material.youngs_modulus = 0;
  for (const Point direction : {Point{0, 1}, Point{-3, 0}, Point{1e-9, -1e-9}, Point{7, 0.1}}) {
    const Drawn drawn(Section(without_E), direction);
    EXPECT_EQ(drawn.document.select_nodes("//g[@class='tension']/path").size(), 3u);
    EXPECT_EQ(drawn.document.select_nodes("//path[@class='interaction']").size(), 1u);
  }
}
}  // namespace
