#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

std::string cantilever(const std::string& rest) {
  return R"({"gravity": [0,0], "materials": {"steel": {"density": 8000, "E": 200e9, "fy": 400e6}},
    "bodies": [{"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,2],[-1,2]]},
               {"name": "beam", "outline": [[0,0],[10,0],[10,1],[0,1]], "material": "steel", "split": {"pieces": 2}}],
    "loads": [{"body": "beam", "at": [10,0.5], "force": [0,-1e6]}])" +
         rest + "}";
}

TEST(CheckCommand, ACantileverWithALoadAtItsTip) {
  const Folder folder;
  const std::string scene =
      folder.write("scene.json", cantilever(R"(, "joints": [{"between": ["wall","beam"]}])"));
  const Ran ran = run("check " + scene + " --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const json result = ran.json();
  EXPECT_NEAR(result["reserve"].get<double>(), 100e6 / 10e6, 1e-9);
  EXPECT_EQ(result["first_to_yield"], (json{"wall-beam/0", "beam/0-beam/1"}));
  for (const json& joint : result["joints"]) {
    const double M = joint["name"] == "wall-beam/0" ? -10e6 : -5e6;
    EXPECT_NEAR(joint["M"].get<double>(), M, 1);
    EXPECT_NEAR(joint["Q"].get<double>(), -1e6, 1e-3);
    EXPECT_EQ(joint["N"], 0);
    EXPECT_NEAR(joint["usage"]["M"].get<double>(), -M / 100e6, 1e-9);
    EXPECT_NEAR(joint["usage"]["Q"].get<double>(), 1e6 / 200e6, 1e-9);
  }
  const Ran table = run("check " + scene);
  EXPECT_NE(table.out.find("first yield at 10 times the loads, in wall-beam/0"), std::string::npos)
      << table.out;
}

TEST(CheckCommand, WhatCannotStandIsBadInput) {
  const Folder folder;
  expect_bad_input(run("check " + folder.write("loose.json", cantilever(""))), "no joint holds");
  expect_bad_input(
      run("check " + folder.write("hinge.json",
                                  cantilever(R"(, "joints": [{"between": ["wall","beam"], "moment": 0}])"))),
      "mechanism");
}

}  // namespace
