// What a newcomer sees: the harbour crane, from its drawing to the pictures.
#include <cmath>
#include <pugixml.hpp>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

const std::string crane = DUCTILE_SOURCE_DIR "/scenes/harbour_crane.scene.json";

const json& find(const json& list, const std::string& name) {
  for (const json& element : list) {
    if (element["name"] == name) return element;
  }
  throw std::runtime_error("no " + name);
}

std::size_t count(const pugi::xml_document& svg, const char* what) { return svg.select_nodes(what).size(); }

TEST(Demo, RunsAndLeavesItsPictures) {
  const Folder folder;
  const std::string out = (folder / "demo").string(), said = (folder / "said").string();
  const int status = std::system(
      (DUCTILE_SOURCE_DIR "/scenes/demo.sh " DUCTILE_COMMAND " " + out + " >" + said + " 2>&1").c_str());
  ASSERT_EQ(status, 0) << slurp(said);
  EXPECT_NE(slurp(said).find("19 joints"), std::string::npos);
  EXPECT_NE(slurp(said).find("2 broke"), std::string::npos);

  pugi::xml_document capacities, run;
  ASSERT_TRUE(capacities.load_file((out + "/capacities.svg").c_str()));
  EXPECT_EQ(count(capacities, "//g[@class='panel']"), 1u);
  EXPECT_EQ(count(capacities, "//g[@class='piece']"), 17u);
  EXPECT_EQ(count(capacities, "//g[@class='joint']"), 19u);
  ASSERT_TRUE(run.load_file((out + "/run.svg").c_str()));
  EXPECT_EQ(count(run, "//g[@class='panel']"), 3u);
  EXPECT_EQ(count(run, "//g[@class='joint']"), 3 * 19u);
  if (std::system("rsvg-convert --version >/dev/null 2>&1") != 0) return;
  for (const char* name : {"/capacities.png", "/run.png"}) EXPECT_EQ(slurp(out + name).substr(1, 3), "PNG");
}

// Heights of cuts as the drawing has them: back and soffit at the root; at x = 7.9 the straight back, which
// falls from 1.7 m to 0.95 m over 8 m, and a hole of radius 0.24 m about y = 1.64 m. Curves are flattened to
// 1e-4 of the jib's diagonal, which is below 9 m.
TEST(Demo, CapacitiesAreThoseOfTheDrawing) {
  const Ran ran = run("calibrate " + crane + " --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const json joints = ran.json()["joints"];
  constexpr double fy = 355e6, t = 0.016;

  const json& root = find(joints, "pillar-jib/0");
  EXPECT_NEAR(root["M"], t * 2.5 * 2.5 / 4 * fy, 1e-9 * 1e7);
  EXPECT_NEAR(root["N"], t * 2.5 * fy, 1e-9 * 1e8);
  EXPECT_NEAR(root["Q"], t * 2.5 * fy / std::sqrt(3.), 1e-9 * 1e8);

  const json& above = find(joints, "jib/6-jib/7#1");
  const double height = (1.64 - 0.24) - (1.7 - 0.75 * (7.9 - 3) / 8);
  EXPECT_NEAR(above["N"].get<double>() / (t * fy), height, 9e-4);
  EXPECT_NEAR(std::sqrt(above["M"].get<double>() * 4 / (t * fy)), height, 9e-4);
  EXPECT_NEAR(find(joints, "jib/11-rope")["M"], 0, 0);
}

TEST(Demo, TheFirstSwellBendsTheJibAndTheSecondBreaksIt) {
  const Ran bent = run("simulate " + crane + " --time 3.9 --json");
  ASSERT_EQ(bent.exit, 0) << bent.err;
  const json after_first = bent.json()["joints"];
  for (const json& joint : after_first) EXPECT_EQ(joint["broken"], false) << joint["name"];
  EXPECT_LT(find(after_first, "jib/6-jib/7")["plastic_rotation"], -0.1);
  EXPECT_EQ(find(after_first, "pillar-jib/0")["dissipated"], 0);

  const Ran broken = run("simulate " + crane + " --time 6 --json");
  ASSERT_EQ(broken.exit, 0) << broken.err;
  const json after_second = broken.json()["joints"];
  for (const json& joint : after_second) {
    const bool at_the_hole = joint["name"].get<std::string>().starts_with("jib/6-jib/7");
    EXPECT_EQ(joint["broken"], at_the_hole) << joint["name"];
    if (at_the_hole) {
      EXPECT_GT(joint["broken_at"], 4);
    }
  }
}

TEST(Picture, BadNamesAndTimesAreRefusedBeforeAnythingRuns) {
  const Folder folder;
  expect_bad_input(run("calibrate " + crane + " --picture " + (folder / "a.jpg").string()), "a.jpg");
  expect_bad_input(run("simulate " + crane + " --time 1 --picture " + (folder / "a").string()), "svg");
  const std::string picture = (folder / "a.svg").string();
  expect_bad_input(run("simulate " + crane + " --time 1 --picture " + picture + " --picture-at 0,2"), "2 s");
  expect_bad_input(run("simulate " + crane + " --time 1 --picture " + picture + " --picture-at nan"), "nan");
  expect_bad_input(run("simulate " + crane + " --time 1 --picture-at 0"), "picture");
  EXPECT_FALSE(std::filesystem::exists(picture));
  EXPECT_EQ(run("calibrate " + crane + " --picture /nowhere/a.svg").exit, 1);
}
}  // namespace
