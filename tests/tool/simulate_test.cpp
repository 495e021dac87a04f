#include <cmath>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

constexpr double L = 10, density = 8000, g = 10, weight = density * L * g;

std::string cantilever(const std::string& rest = "", const std::string& elastic = "\"rigid\"") {
  return R"({"gravity": [0,-10], "joint": {"elastic": )" + elastic + R"(},
    "materials": {"steel": {"density": 8000, "E": 200e9, "fy": 400e6}},
    "bodies": [{"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,2],[-1,2]]},
               {"name": "beam", "outline": [[0,0],[10,0],[10,1],[0,1]], "material": "steel", "split": {"pieces": 4}}],
    "joints": [{"between": ["wall","beam"]}])" +
         rest + "}";
}

const json& find(const json& list, const std::string& name) {
  for (const json& element : list) {
    if (element["name"] == name) return element;
  }
  throw std::runtime_error("no " + name);
}

TEST(SimulateCommand, ARigidCantileverCarriesItsWeightExactly) {
  const Folder folder;
  const Ran ran = run("simulate " + folder.write("scene.json", cantilever()) + " --time 3 --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const json result = ran.json();
  const json& root = find(result["joints"], "wall-beam/0");
  EXPECT_NEAR(root["M"].get<double>(), -weight * L / 2, 1e-6 * weight * L / 2);
  EXPECT_NEAR(root["Q"].get<double>(), -weight, 1e-6 * weight);
  EXPECT_NEAR(root["usage"]["M"].get<double>(), weight * L / 2 / (0.25 * 400e6), 1e-6);
  EXPECT_EQ(root["broken"], false);
  EXPECT_TRUE(root["broken_at"].is_null());
  EXPECT_EQ(root["dissipated"], 0);
  EXPECT_EQ(root["capacity_used"], 0);
  EXPECT_GT(result["time_per_step_us"].get<double>(), 0);
  const json& tip = find(result["pieces"], "beam/3");
  EXPECT_NEAR(tip["position"][0].get<double>(), 8.75, 1e-3);
  EXPECT_NEAR(tip["position"][1].get<double>(), 0.5, 1e-3);
  EXPECT_NEAR(tip["velocity"][1].get<double>(), 0, 1e-3);
  EXPECT_NEAR(tip["angle"].get<double>(), 0, 1e-3);
}

TEST(SimulateCommand, EverySolverRuns) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  for (const char* solver : {"direct", "iterative", "stock"}) {
    const Ran ran = run("simulate " + scene + " --time 0.5 --json --solver " + solver);
    ASSERT_EQ(ran.exit, 0) << ran.err;
    EXPECT_EQ(ran.json()["joints"].size(), 4u);
    EXPECT_EQ(ran.json()["pieces"].size(), 5u);
    EXPECT_EQ(ran.json()["energy"].size(), 10u);
    EXPECT_EQ(ran.json()["energy"]["total_error"].is_null(), solver == std::string("iterative"));
  }
}

TEST(SimulateCommand, TellsWhereTheEnergyWent) {
  const Folder folder;
  const std::string falling = folder.write("scene.json", R"({"gravity": [0,-10], "bodies": [
    {"name": "stone", "outline": [[0,0],[1,0],[1,1],[0,1]], "material": "S355", "velocity": [3,0]}]})");
  const double m = 7850;
  const json at_start = run("simulate " + falling + " --time 0 --json").json()["energy"];
  EXPECT_NEAR(at_start["kinetic"].get<double>(), m * 9 / 2, 1e-3 * m);
  const json energy = run("simulate " + falling + " --time 1 --json").json()["energy"];
  EXPECT_NEAR(energy["kinetic"].get<double>(), m * (9 + 100) / 2, 1e-3 * m * 50);
  EXPECT_NEAR(energy["potential"].get<double>(), -m * 100 / 2, 0.02 * m * 50);  // Euler falls g h t/2 farther
  for (const char* name : {"elastic", "external", "dissipated", "damping", "contacts", "clamped"}) {
    EXPECT_EQ(energy[name], 0) << name;
  }
  EXPECT_NEAR(energy["total_error"].get<double>(), 0, 1e-5 * m * 100);
}

TEST(SimulateCommand, WhatIsUnlimitedIsNullAndWhatIsFreeIsZero) {
  const Folder folder;
  const std::string scene = folder.write(
      "scene.json", cantilever(R"(, "supports": [{"body": "beam", "at": [10,0.5], "fix": ["y"]}])", "true"));
  const json usage =
      find(run("simulate " + scene + " --time 1 --json").json()["joints"], "support/0")["usage"];
  EXPECT_EQ(usage["N"], 0);
  EXPECT_TRUE(usage["Q"].is_null());
  EXPECT_EQ(usage["M"], 0);
}

TEST(SimulateCommand, WritesEveryStepOfItsHistory) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const std::string file = (folder / "history.csv").string();
  const Ran ran = run("simulate " + scene + " --time 1 --dt 0.01 --json --history " + file);
  ASSERT_EQ(ran.exit, 0) << ran.err;
  std::istringstream lines(slurp(file));
  std::string head, line, last;
  std::getline(lines, head);
  const auto columns = std::count(head.begin(), head.end(), ',');
  EXPECT_EQ(head.rfind("time,", 0), 0u);
  int rows = 0;
  for (; std::getline(lines, line); ++rows) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
    last = line;
  }
  EXPECT_EQ(rows, 101);  // the start and every step
  EXPECT_NEAR(std::stod(last), 1, 1e-9);
}

// RFC 4180: a name with a comma, a quote or a line's end stands in quotes, its own quotes doubled.
TEST(SimulateCommand, QuotesNamesInItsHistory) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", R"({"bodies": [
    {"name": "a, \"b\"\nc", "outline": [[0,0],[1,0],[1,1],[0,1]], "material": "S355"}]})");
  const std::string file = (folder / "h.csv").string();
  ASSERT_EQ(run("simulate " + scene + " --time 0 --history " + file).exit, 0);
  const std::string text = slurp(file), name = "\"a, \"\"b\"\"\nc ";
  EXPECT_NE(text.find("," + name + "x\"," + name + "y\"," + name + "angle\"\n"), std::string::npos) << text;
}

TEST(SimulateCommand, PrintsATable) {
  const Folder folder;
  const Ran ran = run("simulate " + folder.write("scene.json", cantilever()) + " --time 1");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  EXPECT_NE(ran.out.find("60 steps"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("beam/2-beam/3"), std::string::npos);
}

TEST(SimulateCommand, BadInputLeavesNothingBehind) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const std::string history = (folder / "history.csv").string();
  expect_bad_input(run("simulate " + folder.write("bad.json", "{}") + " --time 1 --history " + history));
  EXPECT_FALSE(std::filesystem::exists(history));
  const std::string tiny =
      R"({"bodies": [{"name": "mite", "outline": [[0,0],[0.001,0],[0.001,0.001]], "material": "S355"}]})";
  expect_bad_input(run("simulate " + folder.write("tiny.json", tiny) + " --time 1"), "mite");
  for (const char* options :
       {"", "--time x", "--time -1", "--time nan", "--time 1 --dt 0", "--time 1 --dt -1", "--time 1e300",
        "--time 1 --dt 1e-300", "--time 1 --solver magic", "--time 1 --velocity-iterations -1",
        "--time 1 --velocity-iterations 0", "--time 1 --dt 10", "--time 1 --position-iterations 1.5",
        "--time 1 --history ''", "--time 1 --replay ''"}) {
    expect_bad_input(run("simulate " + scene + " " + options));
  }
  const Ran ran = run("simulate " + scene + " --time 1 --history " + (folder / "missing/h.csv").string());
  EXPECT_EQ(ran.exit, 1);
  EXPECT_EQ(ran.out, "");
}

TEST(SimulateCommand, WritesAllItsFilesOrNone) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const std::string history = (folder / "h.csv").string(), picture = (folder / "p.svg").string();
  const std::string run_it =
      "simulate " + scene + " --time 0.1 --history " + history + " --picture " + picture;
  EXPECT_EQ(run(run_it + " --picture " + (folder / "missing/x.svg").string()).exit, 1);
  EXPECT_EQ(run(run_it + " --replay /dev/full").exit, 1);
  EXPECT_FALSE(std::filesystem::exists(history));
  EXPECT_FALSE(std::filesystem::exists(picture));
  EXPECT_EQ(run(run_it + " --replay /dev/null").exit, 0);
  EXPECT_TRUE(std::filesystem::exists(history));
  EXPECT_TRUE(std::filesystem::exists(picture));
}

TEST(SimulateCommand, WritesNoTwoOutputsToOneFile) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const std::string file = (folder / "p.svg").string(), same = (folder / "./p.svg").string();
  for (const std::string& options :
       {" --history " + file + " --replay " + file, " --history " + file + " --picture " + same,
        " --replay " + file + " --picture " + same}) {
    expect_bad_input(run("simulate " + scene + " --time 0.1" + options), "too");
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  expect_bad_input(run("calibrate " + scene + " --out " + file + " --picture " + same), "too");
  EXPECT_EQ(run("simulate " + scene + " --time 0.1 --history /dev/null --replay /dev/null").exit, 0);
}
}  // namespace
