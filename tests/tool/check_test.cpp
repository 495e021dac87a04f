#include <cmath>

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
  EXPECT_NE(table.out.find("first hinge at 10 times the loads, in wall-beam/0"), std::string::npos)
      << table.out;
}

// A mast on a pin, pressed down: any load pushes it over, which every command says that looks at stability.
TEST(CheckCommand, AMechanismIsNotCalledStable) {
  const Folder folder;
  const auto scene = [&](const std::string& support) {
    return folder.write("scene.json",
                        R"({"gravity": [0,0], "bodies": [{"name": "mast",
      "outline": [[-0.05,0],[0.05,0],[0.05,6],[-0.05,6]], "depth": 0.1, "material": "S355", "split": {"pieces": 4}}],
      "supports": [{"body": "mast", "at": [0,0], "fix": ["x","y"]})" +
                            support + R"(], "loads": [{"body": "mast", "at": [0,6], "force": [0,-1e4]}]})");
  };
  const std::string file = scene("");
  const std::string remark =
      "mast: can move without strain, a mechanism that these loads push over, however small they are; brace "
      "it, "
      "support it, or weld a joint that turns freely";
  for (const std::string command :
       {"check", "check --second-order", "limit", "limit --second-order", "design --for reserve=2 --by fy"}) {
    const Ran ran = run(command + " " + file + " --json");
    ASSERT_EQ(ran.exit, 0) << command << ran.err;
    EXPECT_EQ(ran.json()["critical_load_factor"], 0) << command;
    EXPECT_EQ(ran.json()["remarks"], json{remark}) << command;
    const std::string text = run(command + " " + file).out;
    EXPECT_NE(text.find("unstable under any multiple of the loads"), std::string::npos) << text;
    EXPECT_NE(text.find(remark), std::string::npos) << text;
  }
  EXPECT_EQ(run("limit --second-order " + file + " --json").json()["second_order_load_factor"], 0);
  expect_bad_input(run("design --second-order --for collapse=2 --by fy " + file));
  const json rolls = run("check --json " + scene(R"(, {"body": "mast", "at": [0,6], "fix": ["x"]})")).json();
  EXPECT_GT(rolls["critical_load_factor"], 1);
  EXPECT_EQ(rolls["remarks"], json::array());
}

// P in the middle of seven pieces: P L/4, of which the joints at 3 L/7 see 6/7.
TEST(CheckCommand, TellsOfMomentsWithinAPiece) {
  const Folder folder;
  const auto beam = [&](int pieces) {
    return folder.write("scene.json", R"({"gravity": [0,0], "bodies": [{"name": "b",
      "outline": [[0,-0.15],[8,-0.15],[8,0.15],[0,0.15]], "depth": 0.1, "material": "S355", "split": {"pieces": )" +
                                          std::to_string(pieces) + R"(}}],
      "supports": [{"body": "b", "at": [0,0], "fix": ["x","y"]}, {"body": "b", "at": [8,0], "fix": ["y"]}],
      "loads": [{"body": "b", "at": [4,0], "force": [0,-1e5]}]})");
  };
  const std::string said = "b/3: the moment inside is 1.17 times what its joints see";
  for (const std::string command : {"check", "limit", "design --for collapse=1.5 --by depth"}) {
    EXPECT_NE(run(command + " " + beam(7)).out.find(said), std::string::npos) << command;
    EXPECT_NE(run(command + " --json " + beam(7)).json()["remarks"].dump().find(said), std::string::npos);
    EXPECT_EQ(run(command + " --json " + beam(8)).json()["remarks"], json::array()) << command;
  }
  const json fibre = run("check --json " + beam(7)).json()["first_fibre"];
  EXPECT_EQ(fibre["piece"], "b/3");
  EXPECT_EQ(fibre["joint"], nullptr);
  EXPECT_NEAR(fibre["factor"].get<double>(), 0.1 * 0.09 / 6 * 355e6 / 2e5, 1e-9);
}

// IPE 300 of S355: class 4 in compression (web 248.6/7.1 = 35.0 > 34.2), 1 in bending; P L = W_el f_y and
// W_pl f_y.
TEST(CheckCommand, ProfilesHaveTheirClassAndJointsTheirFirstFibre) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", R"({"gravity": [0,0], "bodies": [
    {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
    {"name": "beam", "outline": [[0,-0.15],[3,-0.15],[3,0.15],[0,0.15]], "material": "S355", "profile": "IPE300",
     "split": {"pieces": 3}}], "joints": [{"between": ["wall","beam"]}],
    "loads": [{"body": "beam", "at": [3,0], "force": [0,-10e3]}]})");
  const json result = run("check " + scene + " --json").json();
  ASSERT_EQ(result["profiles"].size(), 1u);
  EXPECT_EQ(result["profiles"][0]["profile"], "IPE 300");
  EXPECT_EQ(result["profiles"][0]["class"], (json{{"compression", 4}, {"bending", 1}}));
  EXPECT_EQ(run("calibrate " + scene + " --json").json()["profiles"], result["profiles"]);
  for (const json& joint : result["joints"]) {
    if (joint["name"] != "wall-beam/0") continue;
    EXPECT_NEAR(joint["first_fibre_at"].get<double>(), 557.1e-6 * 355e6 / 30e3, 1e-3 * 6.6);
    EXPECT_NEAR(joint["yields_at"].get<double>(), 628.4e-6 * 355e6 / 30e3, 1e-3 * 7.4);
  }
  const std::string table = run("check " + scene).out;
  EXPECT_NE(table.find("beam: IPE 300, class 4 in compression, 1 in bending"), std::string::npos) << table;
  EXPECT_NE(table.find("A_eff f_y"), std::string::npos) << table;
}

// Oak breaks where it yields (EN 338 has no plastic strain), concrete and glass too, cast iron at 0.003 of
// 165 MPa/103 GPa, 1.87 times: none has a hinge that turns. Steel does, and a body that nothing joins needs
// none.
TEST(CheckCommand, TellsOfMaterialsWithoutPlasticHinges) {
  const Folder folder;
  const auto remarks = [&](const std::string& material, const std::string& command) {
    const std::string scene = folder.write("scene.json", R"({"bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
      {"name": "crate", "outline": [[9,0],[10,0],[10,1],[9,1]], "material": "oak"},
      {"name": "beam", "outline": [[0,0],[3,0],[3,0.3],[0,0.3]], "material": ")" +
                                                             material + R"(", "split": {"pieces": 3}}],
      "joints": [{"between": ["wall","beam"]}]})");
    const json list = run(command + " " + scene + " --json").json()["remarks"];
    const std::string table = run(command + " " + scene).out;
    for (const json& remark : list)
      EXPECT_NE(table.find(remark.get<std::string>() + "\n"), std::string::npos) << table;
    return list;
  };
  for (const char* command : {"check", "limit", "calibrate"}) {
    EXPECT_EQ(remarks("S355", command), json::array());
    EXPECT_EQ(remarks("oak", command),
              (json{"beam: breaks at 1 times the yield strain, before a plastic hinge turns; design with the "
                    "first fibre"}));
    EXPECT_NE(remarks("cast iron", command)[0].get<std::string>().find("at 1.9 times"), std::string::npos);
  }
}

// A cut that runs 0.4 m along a strip of 0.2 m is √5 times as long as the strip is wide, and its section 5
// times as strong; a mitre of 45° twice. Up to 5 % longer, across a block, or where a moment is given, there
// is nothing to say.
TEST(CheckCommand, TellsOfCutsAskew) {
  const Folder folder;
  const auto remarks = [&](const std::string& bodies) {
    const std::string scene = folder.write("scene.json", R"({"bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]}, )" +
                                                             bodies);
    for (const char* command : {"limit", "calibrate"})
      EXPECT_EQ(run(command + (" " + scene) + " --json").json()["remarks"],
                run("check " + scene + " --json").json()["remarks"]);
    return run("check " + scene + " --json").json()["remarks"];
  };
  const auto cut = [&](const std::string& from, const std::string& to, const std::string& more = "") {
    return remarks(R"({"name": "bar", "outline": [[0,-0.1],[4,-0.1],[4,0.1],[0,0.1]], "material": "S355", )" +
                   more + R"("split": {"cuts": [[[)" + from + ",-0.2],[" + to + R"(,0.2]]]}}],
      "joints": [{"between": ["wall", "bar"]}]})");
  };
  EXPECT_EQ(cut("1.6", "2.4"),
            (json{"bar/0-bar/1: cut askew over 0.447 m where the body is 0.2 m across: 5 times as "
                  "strong in bending as a hinge beside it, which no joint stands for; cut across "
                  "the body, or give `moment`"}));
  EXPECT_EQ(cut("2", "2"), json::array());
  EXPECT_EQ(cut("1.95", "2.05"), json::array());
  EXPECT_EQ(cut("1.6", "2.4", R"("joint": {"moment": 355e3}, )"), json::array());
  const json mitre =
      remarks(R"({"name": "post", "outline": [[0,0],[0.2,0],[0.2,2.8],[0,3]], "material": "S355"},
      {"name": "arm", "outline": [[0.2,2.8],[3,2.8],[3,3],[0,3]], "material": "S355"}],
      "joints": [{"between": ["wall", "post"]}, {"between": ["post", "arm"]}]})");
  ASSERT_EQ(mitre.size(), 2u) << mitre;  // and one on bars of one piece
  EXPECT_NE(mitre[1].get<std::string>().find(
                "post-arm: cut askew over 0.283 m where the body is 0.2 m across: 2 times"),
            std::string::npos)
      << mitre;
}

// Numbers of tables, where the unit is not the scene's.
TEST(CheckCommand, TellsOfOtherUnits) {
  const Folder folder;
  const auto remarks = [&](const std::string& fy, const std::string& E, const std::string& density) {
    const std::string scene =
        folder.write("scene.json", R"({"materials": {"steel": {"fy": )" + fy + R"(, "E": )" + E +
                                       R"(, "density": )" + density + R"(}},
      "bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
      {"name": "beam", "outline": [[0,0],[3,0],[3,0.3],[0,0.3]], "material": "steel", "split": {"pieces": 3}}],
      "joints": [{"between": ["wall","beam"]}]})");
    return run("check " + scene + " --json").json()["remarks"];
  };
  EXPECT_EQ(remarks("355e6", "210e9", "7850"), json::array());
  EXPECT_EQ(remarks("355", "210e9", "7850"), (json{"beam: fy is 355 Pa; in MPa it needs 1e6"}));
  EXPECT_EQ(remarks("355e6", "210e3", "7850")[0], "beam: E is 210000 Pa; in GPa it needs 1e9, in MPa 1e6");
  EXPECT_EQ(remarks("355e6", "210e9", "7.85"),
            (json{"beam: density is 7.85 kg/m³; in g/cm³ or t/m³ it needs 1000"}));
}

// An angle's principal axes lie across its drawn ones; an I-section's and a channel's do not.
TEST(CheckCommand, TellsOfSectionsThatWouldBendSideways) {
  const Folder folder;
  const auto remarks = [&](const std::string& profile) {
    const std::string scene = folder.write("scene.json", R"({"bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
      {"name": "beam", "outline": [[0,0],[3,0],[3,0.1],[0,0.1]], "material": "S355", "profile": ")" +
                                                             profile + R"(", "split": {"pieces": 3}}],
      "joints": [{"between": ["wall","beam"]}]})");
    return run("check " + scene + " --json").json()["remarks"];
  };
  EXPECT_EQ(remarks("IPE100"), json::array());
  EXPECT_EQ(remarks("U100"), json::array());
  ASSERT_EQ(remarks("L100x100x10").size(), 1u);
  EXPECT_NE(remarks("L100x50x8")[0].get<std::string>().find("beam: the scene's plane is no principal one"),
            std::string::npos);
}

// A beam that is not split is told of, a block and a beam of several pieces are not.
TEST(CheckCommand, TellsOfBarsThatAreRigid) {
  const Folder folder;
  const auto remarks = [&](double length, int pieces) {
    const std::string l = std::to_string(length);
    const std::string scene =
        folder.write("scene.json", R"({"bodies": [{"name": "beam", "outline": [[0,0],[)" + l + ",0],[" + l +
                                       R"(,0.3],[0,0.3]], "material": "S355", "split": {"pieces": )" +
                                       std::to_string(pieces) + R"(}}],
      "supports": [{"body": "beam", "at": [0,0], "fix": ["x","y"]}, {"body": "beam", "at": [)" +
                                       l + R"(,0], "fix": ["y"]}]})");
    return run("check " + scene + " --json").json()["remarks"];
  };
  ASSERT_EQ(remarks(6, 1).size(), 1u);
  EXPECT_NE(remarks(6, 1)[0].get<std::string>().find("beam: one piece is rigid"), std::string::npos);
  EXPECT_EQ(remarks(6, 4), json::array());
  EXPECT_EQ(remarks(0.6, 1), json::array());
}

// Its joints alone give: a column of one piece is told to bear more than Euler has it, or never to buckle.
TEST(CheckCommand, TellsOfAClampedBarOfOnePiece) {
  const Folder folder;
  const auto remarks = [&](const std::string& holds) {
    return run("check --json " + folder.write("scene.json", R"({"gravity": [0,0], "bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
      {"name": "c", "outline": [[0,-0.1],[4,-0.1],[4,0.1],[0,0.1]], "depth": 0.1, "material": "S355"}],
      "loads": [{"body": "c", "at": [4,0], "force": [-1e5,-1e3]}], )" +
                                                                holds + "}"))
        .json()["remarks"];
  };
  const std::string said = "c: one piece is rigid";
  EXPECT_NE(remarks(R"("joints": [{"between": ["wall","c"]}])").dump().find(said), std::string::npos);
  EXPECT_NE(
      remarks(R"("supports": [{"body": "c", "at": [0,0], "fix": ["x","y","angle"]}])").dump().find(said),
      std::string::npos);
}

// A beam clamped at both ends, with a moment of 20 kN m in its middle: a quarter of it at either end, by
// symmetry. Over a cut the piece on one side takes it all.
TEST(CheckCommand, TellsOfNodesAtCuts) {
  const Folder folder;
  const auto beam = [&](int pieces, const std::string& node) {
    return folder.write("beam.scene.json", R"({"gravity": [0,0], "bodies": [
      {"name": "w", "type": "static", "outline": [[-1,-2],[0,-2],[0,2],[-1,2]]},
      {"name": "v", "type": "static", "outline": [[8,-2],[9,-2],[9,2],[8,2]]},
      {"name": "b", "outline": [[0,-0.1],[8,-0.1],[8,0.1],[0,0.1]], "material": "S355", "depth": 0.1,
       "split": {"pieces": )" + std::to_string(pieces) +
                                               R"(}},
      {"name": "s", "outline": [[3.9,0],[4.1,0],[4.1,2],[3.9,2]], "material": "S355", "depth": 0.1,
       "split": {"pieces": 8}}],
      "joints": [{"between": ["w","b"]}, {"between": ["v","b"]}, {"between": ["b","s"], "at": )" +
                                               node + R"(}],
      "loads": [{"body": "s", "at": [4,2], "force": [10e3,0]}]})");
  };
  const std::string welded = R"([4,0], "welded": true)";
  const auto ends = [](const Ran& ran) {
    std::vector<double> moments;
    const json result = ran.json();
    for (const json& joint : result["joints"])
      if (const auto name = joint["name"].get<std::string>();
          name.starts_with("w-") || name.starts_with("v-"))
        moments.push_back(std::abs(joint["M"].get<double>()));
    return moments;
  };
  const std::string said = "b: a node holds it at one of its cuts";
  const Ran even = run("check --json " + beam(20, welded));
  EXPECT_GT(std::abs(ends(even)[0] - ends(even)[1]), 500);
  for (const char* command : {"calibrate ", "check ", "limit "})
    EXPECT_NE(run(command + beam(20, welded)).out.find(said), std::string::npos) << command;
  EXPECT_NE(even.json()["remarks"].dump().find(said), std::string::npos);
  const Ran odd = run("check --json " + beam(21, welded));
  EXPECT_NEAR(ends(odd)[0] / ends(odd)[1], 1, 1e-6);
  EXPECT_TRUE(odd.json()["remarks"].empty()) << odd.out;
  EXPECT_EQ(run("calibrate " + beam(20, "[4.01,0], \"moment\": 0")).out.find(said), std::string::npos);
}

// What stands still feels nothing, and a load right over a support goes into it.
TEST(CheckCommand, LoadsThatDoNothing) {
  const Folder folder;
  const auto check = [&](const std::string& rest) {
    return run("check --json " + folder.write("scene.json", R"({"gravity": [0,0], "bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
      {"name": "beam", "outline": [[0,-0.1],[6,-0.1],[6,0.1],[0,0.1]], "depth": 0.1, "material": "S355",
       "split": {"pieces": 6}}], "joints": [{"between": ["wall","beam"]}], )" +
                                                                rest + "}"))
        .json();
  };
  const json idle{
      "wall: does not move, so a load or a support on it does nothing; give it to a body that does"};
  EXPECT_EQ(check(R"("loads": [{"body": "wall", "at": [-0.5,0], "force": [0,-1e4]}])")["remarks"], idle);
  EXPECT_EQ(check(R"("loads": [{"body": "beam", "at": [6,0], "force": [0,-1e4]}],
                     "supports": [{"body": "wall", "at": [-0.5,0], "fix": ["x"]}])")["remarks"],
            idle);
  const json over = check(R"("loads": [{"body": "beam", "at": [6,0], "force": [0,-1e4]}],
    "supports": [{"body": "beam", "at": [6,0], "fix": ["y"]}, {"body": "beam", "at": [6,0], "fix": ["y"]}])");
  EXPECT_EQ(over["first_hinge"]["joint"], nullptr);
  EXPECT_EQ(over["first_fibre"]["joint"], nullptr);
  EXPECT_EQ(over["remarks"], json::array());
}

TEST(CheckCommand, TellsOfADrawingInMillimetres) {
  const Folder folder;
  const auto remarks = [&](double unit) {
    const auto length = [&](double mm) { return std::to_string(mm * unit); };
    const std::string scene =
        folder.write("scene.json", R"({"bodies": [{"name": "beam", "outline": [[0,0],[)" + length(6000) +
                                       ",0],[" + length(6000) + "," + length(300) + "],[0," + length(300) +
                                       R"(]], "material": "S355",
      "depth": )" + length(100) + R"(, "split": {"pieces": 4}}],
      "supports": [{"body": "beam", "at": [0,0], "fix": ["x","y","angle"]}]})");
    return run("check " + scene + " --json").json()["remarks"];
  };
  EXPECT_EQ(remarks(0.001), json::array());
  const json told = remarks(1);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].get<std::string>().find("beam: 300 m high where it is cut"), std::string::npos) << told;
}

// P_cr = π²EI/4L² = π² 200e9/12/400; first fibre at M_p/1.5; M = −P L tan φ/φ of a beam-column.
TEST(CheckCommand, BucklingFirstFibreAndSecondOrder) {
  const Folder folder;
  const std::string body = cantilever(R"(, "joints": [{"between": ["wall","beam"]}])");
  std::string pushed = body;
  pushed.replace(pushed.find("[0,-1e6]"), 8, "[-2e8,-1e6]");
  pushed.replace(pushed.find("\"pieces\": 2"), 11, "\"pieces\": 20");
  const std::string plain = folder.write("plain.json", body), column = folder.write("column.json", pushed);
  const json bent = run("check " + plain + " --json").json();
  EXPECT_EQ(bent["first_fibre"]["joint"], "wall-beam/0");
  EXPECT_NEAR(bent["first_fibre"]["factor"].get<double>(), 10 / 1.5, 1e-9);
  EXPECT_EQ(bent["first_hinge"]["joint"], "wall-beam/0");
  EXPECT_NEAR(bent["first_hinge"]["factor"].get<double>(), 10, 1e-9);
  // Nothing is in compression: all that turning pieces feel is shear, thousands of times below what moves
  // them.
  EXPECT_GT(bent["critical_load_factor"].get<double>(), 1000);

  // Engesser's bar, which shears: 1/P = 1/P_E + 1/κGA.
  const double EI = 200e9 / 12, euler = 3.14159265358979 * 3.14159265358979 * EI / 400,
               shear = 5. / 6 * 200e9 / 2.6;
  const json first = run("check " + column + " --json").json();
  EXPECT_NEAR(first["critical_load_factor"].get<double>() * 2e8 / (1 / (1 / euler + 1 / shear)), 1, 2e-3);
  const json second = run("check " + column + " --second-order --json").json();
  const auto root = [](const json& result) {
    for (const json& joint : result["joints"])
      if (joint["name"] == "wall-beam/0") return joint["M"].get<double>();
    return 0.0;
  };
  EXPECT_NEAR(root(first), -1e7, 1);
  const double phi = std::sqrt(2e8 / EI) * 10;
  EXPECT_NEAR(root(second) / (-1e7 * std::tan(phi) / phi), 1, 1e-2);  // which does not shear
  EXPECT_LT(second["reserve"].get<double>(), first["critical_load_factor"].get<double>());
  EXPECT_NE(run("check " + column).out.find("first order; buckles at "), std::string::npos);
  EXPECT_NE(run("check " + column + " --second-order").out.find("second order; buckles at "),
            std::string::npos);
}

// A diagram of each kind and the deformed shape, of the same file the same picture.
TEST(CheckCommand, DrawsWhatPiecesCarry) {
  const Folder folder;
  const std::string scene =
      folder.write("scene.json", cantilever(R"(, "joints": [{"between": ["wall","beam"]}])"));
  const Ran ran = run("check " + scene + " --picture " + (folder / "a.svg").string());
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const std::string svg = slurp(folder / "a.svg");
  for (const char* said : {"moment, on the side in tension", ">10 MN m<", "shear force", ">-1 MN<",
                           "axial force", "displacements times 50"})
    EXPECT_NE(svg.find(said), std::string::npos) << said;
  EXPECT_EQ(std::regex_search(svg, std::regex("[ (,\"](nan|-?inf)")), false);
}

// 6 EI δ/L² and 12 EI δ/L³ of a beam clamped at both ends, one of which settles.
TEST(CheckCommand, ASupportThatSettles) {
  const Folder folder;
  std::string text = cantilever(
      R"(, "joint": {"stiffness_shear": null}, "joints": [{"between": ["wall","beam"]}],
      "supports": [{"body": "beam", "at": [10,0.5], "fix": ["y", "angle"], "displacement": [0, -1e-4, 0]}])");
  text.replace(text.find("[0,-1e6]"), 8, "[0,0]");
  const json settled = run("check " + folder.write("a.json", text) + " --second-order --json").json();
  for (const json& joint : settled["joints"]) {
    if (joint["name"] != "wall-beam/0") continue;
    EXPECT_NEAR(joint["M"].get<double>() / (-6 * 200e9 / 12 * 1e-4 / 100), 1, 1e-4);
  }
  text.replace(text.find("[0, -1e-4, 0]"), 13, "[0, -1e-4]");
  expect_bad_input(run("check " + folder.write("b.json", text)), "has 2 numbers; write [x, y, angle]");
}

// A column of 6 m on pins under 100 kN, pushed by 2 kN in the middle: 1 kN at each end, whatever it sways,
// and nothing beside that where both ends are moved by 50 mm.
TEST(CheckCommand, SupportsOfSecondOrderCarryWhatActs) {
  const Folder folder;
  for (const char* by : {"[0,0,0]", "[0.05,0,0]"}) {
    const std::string moved = std::string(R"(, "displacement": )") + by + "}";
    const std::string scene = folder.write(
        "a.json", R"({"gravity": [0,0], "bodies": [{"name": "c", "depth": 0.1, "material": "S355",
            "outline": [[-0.05,0],[0.05,0],[0.05,6],[-0.05,6]], "split": {"pieces": 20}}],
          "loads": [{"body": "c", "at": [0,3], "force": [2e3,0]}, {"body": "c", "at": [0,6], "force": [0,-100e3]}],
          "supports": [{"body": "c", "at": [0,0], "fix": ["x","y"])" +
                      moved + R"(, {"body": "c", "at": [0,6], "fix": ["x"])" + moved + "]}");
    const json check = run("check " + scene + " --second-order --json").json();
    for (const char* support : {"support/0", "support/1"}) {
      const auto joint = std::find_if(check["joints"].begin(), check["joints"].end(),
                                      [&](const json& each) { return each["name"] == support; });
      ASSERT_NE(joint, check["joints"].end());
      EXPECT_NEAR((*joint)["N"].get<double>(), 1e3, 0.1) << support << by;
    }
  }
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
