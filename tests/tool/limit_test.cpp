#include <cmath>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

// 8 M_p/L = 8·100e6/10, M_p = 400e6/4.
std::string fixed_fixed(const std::string& gravity, const std::string& loads) {
  return R"({"gravity": )" + gravity +
         R"(, "materials": {"steel": {"density": 8000, "E": 200e9, "fy": 400e6}},
    "bodies": [{"name": "left", "type": "static", "outline": [[-1,-1],[0,-1],[0,2],[-1,2]]},
               {"name": "right", "type": "static", "outline": [[10,-1],[11,-1],[11,2],[10,2]]},
               {"name": "beam", "outline": [[0,0],[10,0],[10,1],[0,1]], "material": "steel", "split": {"pieces": 2}}],
    "joints": [{"between": ["left","beam"]}, {"between": ["beam","right"]}], "loads": [)" +
         loads + "]}";
}
const std::string load = R"({"body": "beam", "at": [5,0.5], "force": [0,-1e6]})";

TEST(LimitCommand, AClampedBeamCollapsesInThreeHinges) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", fixed_fixed("[0,-10]", load));
  const double weight = 8000 * 10 * 10, mp = 100e6, L = 10;
  const Ran both = run("limit " + scene + " --json"),
            loads = run("limit " + scene + " --fixed-gravity --json");
  ASSERT_EQ(both.exit, 0) << both.err;
  EXPECT_NEAR(both.json()["load_factor"].get<double>() / (4 * mp / (1e6 * L / 2 + weight * L / 4)), 1, 1e-6);
  EXPECT_EQ(both.json()["hinges"], (json{"beam/0-beam/1", "left-beam/0", "beam/1-right"}));
  EXPECT_NEAR(loads.json()["load_factor"].get<double>() / ((4 * mp - weight * L / 4) / (1e6 * L / 2)), 1,
              1e-6);
  const Ran table = run("limit " + scene);
  EXPECT_NE(table.out.find("  left-beam/0\n"), std::string::npos) << table.out;
}

TEST(LimitCommand, DrawsMechanismsAndTheBucklingMode) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", fixed_fixed("[0,-10]", load));
  const Ran ran = run("limit " + scene + " --second-order --picture " + (folder / "a.svg").string());
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const std::string svg = slurp(folder / "a.svg");
  for (const char* said : {"collapses at 57.14 times", "second order: goes at", "buckles at", ">3</text>"})
    EXPECT_NE(svg.find(said), std::string::npos) << said;
}

// A cantilever's tip pushed across: M_p at its root, and M_p/L from then on.
TEST(LimitCommand, PushesASupport) {
  const Folder folder;
  std::string text = fixed_fixed("[0,0]", "");
  text.replace(text.find(R"(, {"between": ["beam","right"]})"), 31, "");
  text.insert(
      text.rfind('}'),
      R"(, "supports": [{"body": "beam", "at": [10,0.5], "fix": ["y"], "displacement": [0, -0.1, 0]}])");
  const std::string scene = folder.write("scene.json", text);
  expect_bad_input(run("limit " + scene), "--second-order");
  const Ran ran = run("limit " + scene + " --second-order --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.json()["second_order_load_factor"], nullptr);
  EXPECT_EQ(ran.json()["hinges"], (json{"left-beam/0"}));
  EXPECT_EQ(ran.json()["supports"][0]["name"], "support/0");
  EXPECT_NEAR(std::abs(ran.json()["supports"][0]["Q"].get<double>()) / (100e6 / 10), 1, 1e-3);
}

TEST(LimitCommand, WhatHasNoAnswerIsBadInput) {
  const Folder folder;
  expect_bad_input(run("limit " + folder.write("none.json", fixed_fixed("[0,0]", ""))),
                   "nothing to multiply");
  expect_bad_input(
      run("limit " + folder.write("heavy.json", fixed_fixed("[0,-1e5]", load)) + " --fixed-gravity"),
      "gravity alone");
}

// What rests on a structure is no part of it: limit says so as check does.
TEST(LimitCommand, SaysWhatIsLoose) {
  const Folder folder;
  std::string text = fixed_fixed("[0,-10]", load);
  const std::string alone = folder.write("alone.json", text);
  text.insert(text.find(R"({"name": "beam")"),
              R"({"name": "block", "outline": [[4,1],[6,1],[6,2],[4,2]], "material": "steel"},)");
  const std::string scene = folder.write("scene.json", text);
  for (const char* command : {"check ", "limit ", "limit --second-order "}) {
    EXPECT_EQ(run(command + alone + " --json").json()["loose"], json::array());
    EXPECT_EQ(run(command + alone).out.find("loose"), std::string::npos);
    EXPECT_EQ(run(command + scene + " --json").json()["loose"], json{"block"});
    EXPECT_NE(run(command + scene).out.find("\nloose, and not looked at: block\n"), std::string::npos);
  }
}

}  // namespace
