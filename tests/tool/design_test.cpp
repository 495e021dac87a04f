#include <cmath>
#include <numbers>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

const std::string bracket = R"({"gravity": [0,0],
  "bodies": [{"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
             {"name": "beam", "outline": [[0,0],[4,0],[4,0.3],[0,0.3]], "depth": 0.02, "material": "S235",
              "split": {"pieces": 4}}],
  "joints": [{"between": ["wall","beam"]}],
  "loads": [{"body": "beam", "at": [4,0.3], "force": [0,-30e3]}]})";

class DesignCommand : public testing::Test {
 protected:
  Folder folder;
  std::string scene = folder.write("bracket.scene.json", bracket);
  Ran design(const std::string& rest) { return run("design " + scene + " " + rest); }
};

// b h²/4 f_y = 1.5 · 30 kN · 4 m, and `check` of what it writes says so.
TEST_F(DesignCommand, AReserveByDepth) {
  const std::string out = (folder / "out.scene.json").string();
  const Ran ran = design("--for reserve=1.5 --by depth --json --out " + out);
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NEAR(ran.json()["value"].get<double>(), 1.5 * 30e3 * 4 * 4 / 0.09 / 235e6, 1e-9);
  EXPECT_NEAR(ran.json()["reached"].get<double>(), 1.5, 1e-8);
  EXPECT_NEAR(run("check " + out + " --json").json()["reserve"].get<double>(), 1.5, 1e-8);
}

// W_pl f_y of the tables' IPE: 484 cm³ of IPE 270 are 113.7 kN m, 628 cm³ of IPE 300 147.6 kN m; 132 are
// needed.
TEST_F(DesignCommand, TheLightestProfileOfASeries) {
  const std::string out = (folder / "out.scene.json").string();
  const Ran ran = design("--for collapse=1.1 --by profile --among HEA,IPE --json --out " + out);
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.json()["value"], "IPE 300");
  EXPECT_NEAR(ran.json()["reached"].get<double>() / (628.4e-6 * 235e6 / 120e3), 1, 1e-3);
  EXPECT_NEAR(run("limit " + out + " --json").json()["load_factor"].get<double>(),
              ran.json()["reached"].get<double>(), 1e-9);
}

// 1.5 · 120 kN m over 450 cm³ are 400 MPa.
TEST_F(DesignCommand, AMaterialOfAList) {
  EXPECT_EQ(design("--for reserve=1.5 --by material --json").json()["value"], "S420");
  EXPECT_EQ(design("--for reserve=1.5 --by material --among S460,S420 --json").json()["value"], "S460");
}

TEST_F(DesignCommand, PiecesAndNumbers) {
  const json pieces = design("--for displacement=0.07 --by pieces --among 2,4,8,16 --json").json();
  EXPECT_TRUE(pieces["value"].is_number_integer());
  EXPECT_LE(pieces["reached"].get<double>(), 0.07);
  EXPECT_NEAR(design("--for damping=0.1 --by damping_ratio --json").json()["value"].get<double>(), 0.1, 1e-6);
  EXPECT_NEAR(design("--for mass=100 --by depth --json").json()["reached"].get<double>(), 100, 1e-6);
  EXPECT_NE(design("--for frequency=5 --by E").out.find("frequency of 5 Hz"), std::string::npos);
}

// A single piece is rigid and never yields. Of two, the joint under the load is at 4 M_p/L.
TEST_F(DesignCommand, NumbersOfPiecesThatCannotYieldArePassedOver) {
  const std::string beam = folder.write("beam.scene.json", R"({"gravity": [0,0],
  "bodies": [{"name": "b", "outline": [[0,-0.15],[8,-0.15],[8,0.15],[0,0.15]], "depth": 0.1, "material": "S355"}],
  "supports": [{"body": "b", "at": [0,0], "fix": ["x","y"]}, {"body": "b", "at": [8,0], "fix": ["y"]}],
  "loads": [{"body": "b", "at": [4,0], "force": [0,-100e3]}]})");
  const double M_p = 0.1 * 0.3 * 0.3 / 4 * 355e6;
  for (const std::string target : {"reserve", "collapse"}) {
    const json found = run("design " + beam + " --for " + target + "=1.5 --by pieces --json").json();
    EXPECT_EQ(found["value"], 2) << target;
    EXPECT_NEAR(found["reached"].get<double>(), 4 * M_p / 8 / 100e3, 1e-7) << target;
  }
  expect_bad_input(run("design " + beam + " --for reserve=1.5 --by pieces --among 1"), "yield");
}

// Where bars are welded, one of them needs a joint of its own that the weld is as strong as.
TEST_F(DesignCommand, NumbersOfPiecesThatASceneCannotHaveArePassedOver) {
  const std::string portal = folder.write("portal.scene.json", R"({"gravity": [0,0],
  "bodies": [{"name": "l", "outline": [[-0.1,0],[0.1,0],[0.1,4],[-0.1,4]], "depth": 0.1, "material": "S355"},
             {"name": "r", "outline": [[5.9,0],[6.1,0],[6.1,4],[5.9,4]], "depth": 0.1, "material": "S355"},
             {"name": "b", "outline": [[0,3.9],[6,3.9],[6,4.1],[0,4.1]], "depth": 0.1, "material": "S355"}],
  "joints": [{"between": ["l","b"], "at": [0,4], "welded": true},
             {"between": ["r","b"], "at": [6,4], "welded": true}],
  "supports": [{"body": "l", "at": [0,0], "fix": ["x","y","angle"]},
               {"body": "r", "at": [6,0], "fix": ["x","y","angle"]}],
  "loads": [{"body": "b", "at": [0,4], "force": [20e3,0]}]})");
  const auto first = [&](const std::string& rest) {
    return run("design " + portal + " --for displacement=0.02 --by pieces --json" + rest);
  };
  const Ran among = first(" --among 1,2,3,4,5,6,7,8"), any = first("");
  ASSERT_EQ(any.exit, 0) << any.err;
  EXPECT_GT(any.json()["value"].get<int>(), 1);
  EXPECT_EQ(any.out, among.out);
  expect_bad_input(first(" --among 1"), "is welded where neither body ends");
}

// √(k/m)/2π of a block on a spring, which falls as its depth d grows: m = 1000 d.
TEST_F(DesignCommand, WhatFallsWithDepth) {
  const std::string spring = folder.write("spring.scene.json", R"({
  "bodies": [{"name": "b", "outline": [[0,0],[1,0],[1,1],[0,1]], "material": "x"}],
  "materials": {"x": {"density": 1000, "E": 1e9, "fy": 1e9}},
  "supports": [{"body": "b", "at": [0.5,0.5], "fix": ["x","angle"], "stiffness": {"y": 1e5}}]})");
  const Ran ran = run("design " + spring + " --for frequency=2 --by depth --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NEAR(ran.json()["value"].get<double>() / (1e5 / std::pow(4 * std::numbers::pi, 2) / 1000), 1, 1e-9);
  EXPECT_NEAR(ran.json()["reached"].get<double>() / 2, 1, 1e-9);
}

// Oak's own damping is 0.1: the list has it exactly.
TEST_F(DesignCommand, AMemberOfAListThatIsJustEnough) {
  const Ran ran = design("--for damping=0.1 --by material --among oak --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.json()["value"], "oak");
  expect_bad_input(design("--for damping=0.10000001 --by material --among oak"), "the best comes to 0.1");
}

// As every command refuses to.
TEST_F(DesignCommand, DoesNotWriteOverItsScene) {
  const std::string before = slurp(scene);
  expect_bad_input(design("--for reserve=1.5 --by depth --out " + scene), "is the file that is read");
  EXPECT_EQ(slurp(scene), before);
}

// Of a bar of one depth its own mass and stiffness both are, and its frequency is not.
TEST_F(DesignCommand, SaysWhereANumberChangesNothing) {
  expect_bad_input(design("--for frequency=50 --by depth"), "the same whatever that number is");
  expect_bad_input(design("--for frequency=50 --by fy"), "the same whatever that number is");
}

TEST_F(DesignCommand, BadInput) {
  for (const char* wrong :
       {"--for reserve --by depth", "--for reserve=-1 --by depth", "--for reserve=nan --by depth",
        "--for strength=2 --by depth", "--for reserve=2 --by colour",
        "--for reserve=2 --by depth --body nobody", "--for reserve=2 --by depth --among 1,2",
        "--for reserve=2 --by profile", "--for reserve=2 --by profile --among IPE301",
        "--for reserve=2 --by profile --among nothing.section.json",
        "--for reserve=2 --by material --among cheese", "--for reserve=2 --by pieces --among 1.5",
        "--for reserve=99 --by material", "--for frequency=50 --by depth",
        "--for rotation=0.01 --by depth --body wall", "--for mass=100 --by depth --second-order"})
    expect_bad_input(design(wrong));
  for (const char* among : {"CHS", "IPX", "nothing.section.json", "IPX300", "IPE301"}) {
    const Ran ran = design(std::string("--for reserve=2 --by profile --among ") + among);
    expect_bad_input(ran, among);
    EXPECT_EQ(ran.err.find("command line:"), 0u) << ran.err;  // and no scene file before that
  }
  EXPECT_EQ(run("design --help").out.find("R.U.B.E."), std::string::npos);
}

// A search that finds nothing is not begun where its answer could not be written.
TEST_F(DesignCommand, AnUnwritableFileIsToldBeforeTheSearch) {
  const std::string search = "--for reserve=1.5 --by material --among oak";
  EXPECT_EQ(design(search).exit, 2);
  EXPECT_EQ(design(search + " --out /nowhere/out.scene.json").exit, 1);
}

// Thin enough, a mast bears its loads as drawn and buckles before that: it is told, and --second-order asks
// for more. By hand, π² EI/4L² = P of a square of 1 m.
TEST_F(DesignCommand, SaysWhenItBucklesAndAsksForTheDeformedState) {
  const std::string mast = folder.write("mast.scene.json", R"({"gravity": [0,0],
  "bodies": [{"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
             {"name": "mast", "outline": [[0,-0.05],[6,-0.05],[6,0.05],[0,0.05]], "depth": 0.1, "material": "S355",
              "split": {"pieces": 20}, "joint": {"stiffness_axial": null, "stiffness_shear": null}}],
  "joints": [{"between": ["wall","mast"]}],
  "loads": [{"body": "mast", "at": [6,0], "force": [-100e3,-200]}]})");
  const json first = run("design " + mast + " --for collapse=1 --by depth --json").json();
  const double b = first["value"].get<double>();
  EXPECT_NEAR(first["critical_load_factor"].get<double>() / (210e9 * b * 1e-3 / 12 * 9.8696 / 144 / 100e3), 1,
              1e-3);
  EXPECT_LT(first["critical_load_factor"].get<double>(), 0.5);
  EXPECT_NE(run("design " + mast + " --for collapse=1 --by depth").out.find("\nfirst order; buckles at 0."),
            std::string::npos);
  const Ran second = run("design " + mast + " --for collapse=1 --by depth --second-order");
  EXPECT_NE(second.out.find("collapse of 1 times the loads"), std::string::npos) << second.err;
  EXPECT_NE(second.out.find("\nsecond order; buckles at 1."), std::string::npos) << second.out;
}

// The outer half of a cantilever needs half of what the inner one does: b h²/4 f_y = λ P x.
TEST_F(DesignCommand, TheLeastMassOfSeveralBodies) {
  const std::string two = folder.write("two.scene.json", R"({"gravity": [0,0],
  "bodies": [{"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
             {"name": "inner", "outline": [[0,0],[2,0],[2,0.3],[0,0.3]], "depth": 0.02, "material": "S235"},
             {"name": "outer", "outline": [[2,0],[4,0],[4,0.3],[2,0.3]], "depth": 0.02, "material": "S235"}],
  "joints": [{"between": ["wall","inner"], "shear": null}, {"between": ["inner","outer"], "shear": null}],
  "loads": [{"body": "outer", "at": [4,0.3], "force": [0,-30e3]}]})");
  const std::string out = (folder / "out.scene.json").string();
  const Ran ran = run("design " + two + " --for collapse=1.5 --by depth --each --json --out " + out);
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const double inner = 1.5 * 30e3 * 4 * 4 / 0.09 / 235e6;
  EXPECT_NEAR(ran.json()["value"]["inner"].get<double>() / inner, 1, 1e-9);
  EXPECT_NEAR(ran.json()["value"]["outer"].get<double>() / inner, 0.5, 1e-9);
  EXPECT_NEAR(ran.json()["mass"].get<double>() / (7850 * 0.3 * 2 * 1.5 * inner), 1, 1e-9);
  EXPECT_NEAR(run("limit " + out + " --json").json()["load_factor"].get<double>(), 1.5, 1e-7);
  const Ran alike =
      run("design " + two + " --for collapse=1.5 --by depth --each --together inner,outer --json");
  EXPECT_NEAR(alike.json()["value"]["outer"].get<double>() / inner, 1, 1e-9);
  expect_bad_input(run("design " + two + " --for reserve=1.5 --by depth --each"), "goes with --by depth");
  expect_bad_input(run("design " + two + " --for collapse=1.5 --by depth --each --together inner,wall"),
                   "'wall' is none");
}

// What rests on a structure does not bear, and weighs nothing but where mass is asked for.
TEST_F(DesignCommand, SaysWhatIsLoose) {
  std::string text = bracket;
  text.insert(
      text.find(R"({"name": "beam")"),
      R"({"name": "block", "outline": [[3,0.3],[4,0.3],[4,1.3],[3,1.3]], "depth": 0.5, "material": "S235"},)");
  const std::string task =
      "design " + folder.write("loaded.scene.json", text) + " --by depth --body beam --for ";
  EXPECT_EQ(run(task + "reserve=1.5 --json").json()["loose"], json{"block"});
  EXPECT_NE(run(task + "reserve=1.5").out.find("\nloose, and not looked at: block\n"), std::string::npos);
  EXPECT_EQ(run(task + "mass=8000 --json").json()["loose"], json::array());
  EXPECT_EQ(run(task + "mass=8000").out.find("loose"), std::string::npos);
}

}  // namespace
