#include <cmath>
#include <cstdio>
#include <numbers>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

std::string rectangle(
    const std::string& material = R"({"fy": 355e6, "E": 210e9, "criterion": "von_mises"})") {
  return R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,0.2],[0,0.2]], "material": )" + material + "}]}";
}

template <class... Values>
std::string fmt(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

constexpr double b = 0.1, h = 0.2, fy = 355e6, E = 210e9;

void expect_near(const json& value, double exact, double relative = 1e-13) {
  ASSERT_TRUE(value.is_number()) << value;
  EXPECT_NEAR(value.get<double>(), exact, relative * std::abs(exact));
}

TEST(SectionCommand, RectangleHasTheCapacitiesOfTable1) {
  const Folder folder;
  const json result = run("section " + folder.write("r.json", rectangle()) + " --json").json();
  expect_near(result["area"], b * h);
  expect_near(result["centroid"][0], b / 2);
  expect_near(result["centroid"][1], h / 2);
  expect_near(result["N"], b * h * fy);
  expect_near(result["Nc"], b * h * fy);
  expect_near(result["Q"], b * h * fy / std::numbers::sqrt3);
  expect_near(result["M"], b * h * h / 4 * fy);
  expect_near(result["M_reverse"], b * h * h / 4 * fy);
  expect_near(result["pna"], h / 2);
  expect_near(result["EA"], E * b * h);
  expect_near(result["EI"], E * b * h * h * h / 12);
  expect_near(result["elastic_centroid"][1], h / 2);
  expect_near(result["I"], b * h * h * h / 12);
  expect_near(result["W_elastic"], b * h * h / 6);
  expect_near(result["W_plastic"], b * h * h / 4);
  expect_near(result["shape_factor"], 1.5);
  expect_near(result["yield_moment"], b * h * h / 6 * fy);
  ASSERT_GE(result["interaction"].size(), 8u);
  for (const json& point : result["interaction"]) {  // m = 1 − n²
    const double n = point["N"].get<double>() / (b * h * fy),
                 m = point["M"].get<double>() / (b * h * h / 4 * fy);
    EXPECT_NEAR(std::abs(m), 1 - n * n, 1e-12);
  }
}

TEST(SectionCommand, AngleTurnsTheBendingDirection) {
  const Folder folder;
  const std::string file = folder.write("r.json", rectangle());
  const json along_x = run("section " + file + " --angle 0 --json").json();
  expect_near(along_x["M"], h * b * b / 4 * fy);
  expect_near(along_x["pna"], b / 2);
  expect_near(run("section " + file + " --angle=-90 --json").json()["pna"], -h / 2);
}

TEST(SectionCommand, DefaultsAreThePapers) {
  const Folder folder;
  const json result =
      run("section " + folder.write("r.json", rectangle(R"({"fy": 355e6})")) + " --json").json();
  expect_near(result["Q"], b * h * fy / 2);  // Tresca
  EXPECT_TRUE(result["EA"].is_null());       // no E
}

TEST(SectionCommand, KnowsProfilesByName) {  // IPE 300 of S355: ArcelorMittal's table
  const json result = run("section IPE300 --material S355 --json").json();
  const auto printed = [&](const json& value, double table) { expect_near(value, table, 5e-4); };
  printed(result["area"], 53.81e-4);
  printed(result["I"], 8356e-8);
  printed(result["W_elastic"], 557.1e-6);
  printed(result["W_plastic"], 628.4e-6);
  printed(result["A_v"], 25.68e-4);
  expect_near(result["Q"], result["A_v"].get<double>() * 355e6 / std::numbers::sqrt3);
  EXPECT_NE(result["A_v_by"].get<std::string>().find("6.2.6"), std::string::npos);
  printed(result["principal"]["I_max"], 8356e-8);
  printed(result["principal"]["I_min"], 603.8e-8);
  expect_near(result["principal"]["angle"], 90);
  EXPECT_NEAR(result["I_yz"].get<double>(), 0, 1e-18);
  printed(result["radii_of_gyration"][0], 12.46e-2);
  EXPECT_EQ(result["class"]["compression"], 4);
  EXPECT_EQ(result["class"]["bending"], 1);
  EXPECT_TRUE(result["remarks"].empty()) << result["remarks"];
  EXPECT_FALSE(run("section IPE300 --material pine --json").json().contains("class"));  // a rule for steel
  // About its weak axis the flanges carry the shear: 2 b t_f.
  const json weak = run("section IPE300 --angle 0 --json").json();
  expect_near(weak["A_v"], 2 * 0.15 * 0.0107, 1e-9);
  expect_bad_input(run("section IPE310"), "IPE 80 100 120");
  expect_bad_input(run("section IPE300 --material cheese"), "ductile materials");
}

TEST(SectionCommand, TellsPrincipalAxesOfAnAngle) {  // L 100x100x10, SCI P363: I_u 280, I_v 73.0, I_y 177 cm⁴
  const json result = run("section L100x100x10 --json").json();
  EXPECT_NEAR(result["principal"]["I_max"].get<double>() * 1e8, 280, 0.5);
  EXPECT_NEAR(result["principal"]["I_min"].get<double>() * 1e8, 73.0, 0.05);
  expect_near(result["principal"]["angle"], -45);
  EXPECT_NEAR(result["I_yz"].get<double>() * 1e8, -(280 - 73.0) / 2, 0.5);  // its legs are below and left
  EXPECT_NEAR(result["radii_of_gyration"][0].get<double>() * 1e2, 3.83, 0.005);
  EXPECT_NE(result["remarks"].dump().find("bending sideways"), std::string::npos);
}

TEST(SectionCommand, TellsHowMuchOfASectionIsUsed) {  // rectangle: m + n² = 1 where shear leaves √(1 − q²)
  const Folder folder;
  const std::string file = folder.write("r.json", rectangle());
  const double N = b * h * fy, M = b * h * h / 4 * fy, Q = b * h * fy / std::numbers::sqrt3;
  const double n = 0.4, m = 0.5, q = 0.6;
  const json used =
      run(fmt("section %s --N %.17g --M %.17g --Q %.17g --json", file.c_str(), -n * N, -m * M, q * Q))
          .json()["utilisation"];
  expect_near(used["N"], n, 1e-12);
  expect_near(used["M"], m, 1e-12);
  expect_near(used["Q"], q, 1e-12);
  const double g = (m + std::sqrt(m * m + 4 * n * n)) / 2;  // m/g + (n/g)² = 1
  expect_near(used["together"], std::hypot(g, q), 1e-5);
  expect_near(used["first_fibre"], n + 1.5 * m, 1e-12);
}

// The first fibre of two materials: N over EA with the part of its E, and M about the elastic centroid, about
// which N has an arm where the area's centroid is another point.
TEST(SectionCommand, TellsTheFirstFibreOfSeveralMaterials) {
  const Folder folder;
  const std::string file = folder.write("two.section.json", R"({"regions": [
    {"outer": [[-0.1,0],[0.1,0],[0.1,0.1],[-0.1,0.1]], "material": {"E": 200e9, "fy": 400e6}},
    {"outer": [[-0.1,0.1],[0.1,0.1],[0.1,0.2],[-0.1,0.2]], "material": {"E": 100e9, "fy": 100e6}}]})");
  const json alone = run("section " + file + " --M 1e3 --json").json();
  EXPECT_NEAR(alone["utilisation"]["first_fibre"].get<double>() * alone["yield_moment"].get<double>() / 1e3,
              1, 1e-12);
  // A = 0.02 m² each; c = (200 · 0.05 + 100 · 0.15)/300, and the top's stress is E_top (N/EA + M (0.2 −
  // c)/EI).
  const double EA = 0.02 * 300e9, c = 0.25 / 3, strip = 0.2 * 1e-3 / 12;
  const double EI =
      200e9 * (strip + 0.02 * std::pow(c - 0.05, 2)) + 100e9 * (strip + 0.02 * std::pow(0.15 - c, 2));
  const double N = 1e5, M = 1e4, about = M + N * (0.1 - c);
  const json both = run("section " + file + " --N 1e5 --M 1e4 --json").json();
  const double top = 100e9 * (N / EA + about * (0.2 - c) / EI) / 100e6;
  expect_near(both["utilisation"]["first_fibre"], top, 1e-12);
}

TEST(SectionCommand, SaysWhatIsNeitherProfileNorFile) {
  for (const char* name : {"XXX", "XXX --material S355", "nothing.section.json"})
    expect_bad_input(run(std::string("section ") + name), "is no profile, series of profiles or file");
}

TEST(SectionCommand, RemarksOnWhatTheNumbersDoNotSay) {
  const Folder folder;
  const auto remarks = [&](const std::string& outer, const std::string& material) {
    const std::string text = R"({"regions": [{"outer": )" + outer + R"(, "material": ")" + material + "\"}]}";
    return run("section " + folder.write("s.json", text) + " --json").json()["remarks"].dump();
  };
  EXPECT_NE(remarks("[[0,0],[150,0],[150,300],[0,300]]", "S235").find("drawn in millimetres"),
            std::string::npos);
  EXPECT_EQ(remarks("[[0,0],[0.15,0],[0.15,0.3],[0,0.3]]", "S235"), "[]");
  for (const char* brittle : {"oak", "pine", "concrete", "glass", "cast iron"})
    EXPECT_NE(remarks("[[0,0],[0.1,0],[0.1,0.2],[0,0.2]]", brittle).find("M is not reached"),
              std::string::npos);
  EXPECT_NE(run("section UC152x152x23 --material S355").out.find("class 3"), std::string::npos);
}

TEST(MaterialsCommand, ListsEachWithItsSource) {
  const json list = run("materials --json").json()["materials"];
  EXPECT_GE(list.size(), 11u);
  for (const json& material : list) {
    EXPECT_GT(material["fy"].get<double>(), 0) << material;
    EXPECT_NE(material["source"].get<std::string>().find("EN "), std::string::npos) << material;
  }
  expect_near(list[2]["fy"], 355e6);  // S355
  EXPECT_NE(run("materials").out.find("EN 338:2016"), std::string::npos);
}

TEST(SectionCommand, PrintsATable) {
  const Folder folder;
  const Ran ran = run("section " + folder.write("r.json", rectangle()));
  EXPECT_EQ(ran.exit, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_NE(ran.out.find("355000 N m"), std::string::npos) << ran.out;
}

struct Bad {
  const char* name;
  std::string text, saying;
};
std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.name; }

class BadSection : public testing::TestWithParam<Bad> {};

TEST_P(BadSection, ExitsWith2AndSaysWhatIsWrong) {
  const Folder folder;
  const std::string file = folder.write("bad.json", GetParam().text);
  for (const char* options : {"", " --json"}) {
    const Ran ran = run("section " + file + options);
    expect_bad_input(ran, GetParam().saying);
    EXPECT_EQ(ran.err.find(file + ":"), 0u) << ran.err;
  }
}

std::string region(const std::string& outer, const std::string& rest = "", const std::string& fy = "1e6") {
  return R"({"outer": )" + outer + rest + R"(, "material": {"fy": )" + fy + "}}";
}
std::string regions(const std::string& list) { return R"({"regions": [)" + list + "]}"; }
const std::string square = "[[0,0],[1,0],[1,1],[0,1]]";

INSTANTIATE_TEST_SUITE_P(
    Files, BadSection,
    testing::Values(
        Bad{"empty", "", "1:1"}, Bad{"not_json", "hello", "1:1"},
        Bad{"cut_off", "{\"regions\": [\n  {\"outer\"", "bad.json:2:"}, Bad{"drawing", "<svg/>", "XML"},
        Bad{"scene", R"({"bodies": []})", "scene"},
        Bad{"unknown_key", R"({"regions": [], "colour": 1})", "\"colour\" is unknown"},
        Bad{"unknown_key_inside",
            regions(R"({"outer": [[0,0],[1,0],[1,1]], "material": {"fy": 1, "yield": 2}})"),
            "regions[0].material: the key \"yield\" is unknown"},
        Bad{"repeated_key", R"({"regions": [], "regions": []})", "\"regions\" stands twice"},
        Bad{"repeated_key_inside", regions(R"({"outer": )" + square + R"(, "material": {"fy": 1, "fy": 2}})"),
            "\"fy\" stands twice"},
        Bad{"no_regions", "{}", "\"regions\""}, Bad{"empty_regions", regions(""), "regions"},
        Bad{"no_outer", regions(R"({"material": {"fy": 1}})"), "\"outer\""},
        Bad{"no_fy", regions(R"({"outer": )" + square + R"(, "material": {}})"), "\"fy\""},
        Bad{"no_material", regions(R"({"outer": )" + square + "}"), "\"material\""},
        Bad{"unknown_material", regions(R"({"outer": )" + square + R"(, "material": "unobtainium"})"),
            "S355"},
        Bad{"negative_fy", regions(region(square, "", "-1")), "material.fy: is -1"},
        Bad{"zero_fy", regions(region(square, "", "0")), "fy"},
        Bad{"infinite_fy", regions(region(square, "", "1e999")), "1e999"},
        Bad{"nan_fy", regions(region(square, "", "NaN")), "1:"},
        Bad{"text_for_a_number", regions(region(square, "", "\"1\"")), "fy"},
        Bad{"infinite_point", regions(region("[[0,0],[1e999,0],[1,1]]")), "1e999"},
        Bad{"point_of_three", regions(region("[[0,0,0],[1,0],[1,1]]")), "regions[0].outer[0]"},
        Bad{"point_of_texts", regions(region(R"([[0,"a"],[1,0],[1,1]])")), "regions[0].outer[0][1]"},
        Bad{"criterion",
            regions(R"({"outer": )" + square + R"(, "material": {"fy": 1, "criterion": "mohr"}})"),
            "von_mises"},
        Bad{"two_points", regions(region("[[0,0],[1,0]]")), "outer"},
        Bad{"no_area", regions(region("[[0,0],[1,0],[2,0]]")), "outer"},
        Bad{"crosses_itself", regions(region("[[0,0],[1,1],[1,0],[0,1]]")), "outer"},
        Bad{"touches_itself", regions(region("[[0,0],[2,0],[2,2],[1,0],[0,2]]")), "outer"},
        Bad{"repeats_a_point", regions(region("[[0,0],[1,0],[1,0],[1,1]]")), "outer"},
        Bad{"hole_outside", regions(region(square, R"(, "holes": [[[2,2],[3,2],[3,3]]])")), "hole"},
        Bad{"hole_crossing", regions(region(square, R"(, "holes": [[[0.5,0.5],[2,0.5],[2,0.7]]])")), "hole"},
        Bad{"holes_overlapping",
            regions(
                region(square,
                       R"(, "holes": [[[0.2,0.2],[0.6,0.2],[0.6,0.6]], [[0.3,0.25],[0.7,0.25],[0.7,0.6]]])")),
            "hole"},
        Bad{"regions_overlapping", regions(region(square) + "," + region("[[0.5,0.5],[2,0.5],[2,2]]")),
            "overlap"},
        Bad{"E_on_one_region_only",
            regions(region(square) + R"(,{"outer": [[1,0],[2,0],[2,1]], "material": {"fy": 1, "E": 1}})"),
            "Young's modulus"},
        Bad{"too_deep", std::string(100'000, '['), "deep"}),
    [](const auto& info) { return info.param.name; });

TEST(SectionCommand, NamesEveryProblemButAtMost20Lines) {
  const Folder folder;
  const auto with = [&](int count) {
    std::string list;
    for (int i = 0; i < count; ++i) list += (i ? "," : "") + region(square, "", "-1");
    return run("section " + folder.write("bad.json", regions(list)));
  };
  EXPECT_EQ(with(3).error_lines(), 3);
  EXPECT_EQ(with(20).error_lines(), 20);
  const Ran many = with(50);
  expect_bad_input(many, "31 more problems");
  EXPECT_EQ(many.error_lines(), 20);
}

TEST(SectionCommand, AFileCannotBreakTheLinesOfItsErrors) {
  const Folder folder;
  const Ran ran = run("section " + folder.write("bad.json", R"({"regions": [], "a\nb\u001b[31m": 1})"));
  EXPECT_EQ(ran.error_lines(), 2) << ran.err;
  EXPECT_EQ(ran.err.find('\033'), std::string::npos);
}

TEST(CommandLine, MistakesAreBadInput) {
  const Folder folder;
  const std::string file = folder.write("r.json", rectangle());
  expect_bad_input(run(""));
  expect_bad_input(run("fold"));
  expect_bad_input(run("section"));
  expect_bad_input(run("section " + file + " --angel 3"));
  expect_bad_input(run("section " + file + " --angle north"), "north");
  expect_bad_input(run("section " + file + " --angle nan"));
  expect_bad_input(run("section " + file + " --angle 1e999"));
  expect_bad_input(run("section " + file + " second.json"));
  expect_bad_input(run("section " + file + " --material S355"), "section file");
  expect_bad_input(run("section " + (folder / "missing.json").string()), "missing.json");
  expect_bad_input(run("section " + (folder / "").string()), "folder");
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  EXPECT_EQ(run("--help").exit, 0);
  EXPECT_NE(run("--help").out.find("Every command but report"), std::string::npos);
  EXPECT_NE(run("section --help").out.find("--angle"), std::string::npos);
  EXPECT_EQ(run("--version").exit, 0);
}
}  // namespace
