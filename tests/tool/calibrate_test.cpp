#include <cmath>
#include <numbers>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

// L × h × b cantilever of a steel of its own.
constexpr double L = 20, h = 1, b = 0.5, density = 7800, E = 210e9, fy = 350e6, fracture_strain = 0.25;

std::string cantilever(const std::string& rest = "", const std::string& beam = "") {
  return R"({"materials": {"steel": {"density": 7800, "E": 210e9, "fy": 350e6, "fracture_strain": 0.25,
                                     "criterion": "von_mises"}},
    "bodies": [
      {"name": "wall", "type": "static", "outline": [[-1,-1],[0,-1],[0,2],[-1,2]]},
      {"name": "beam", "outline": [[0,0],[20,0],[20,1],[0,1]], "depth": 0.5, "material": "steel",
       "split": {"pieces": 4, "along": [[0,0.5],[20,0.5]]})" +
         beam + R"(}],
    "joints": [{"between": ["wall","beam"]}])" +
         rest + "}";
}

void expect_near(const json& value, double exact, double relative = 1e-12) {
  ASSERT_TRUE(value.is_number()) << value;
  EXPECT_NEAR(value.get<double>(), exact, relative * std::abs(exact));
}

const json& joint(const json& plan, const std::string& name) {
  for (const json& joint : plan["joints"]) {
    if (joint["name"] == name) return joint;
  }
  throw std::runtime_error("no joint " + name);
}

TEST(CalibrateCommand, CantileverHasTheCapsOfItsSection) {
  const Folder folder;
  const Ran ran = run("calibrate " + folder.write("scene.json", cantilever()) + " --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const json plan = ran.json();
  ASSERT_EQ(plan["bodies"].size(), 2u);
  EXPECT_EQ(plan["bodies"][0]["type"], "static");
  const json& pieces = plan["bodies"][1]["pieces"];
  ASSERT_EQ(pieces.size(), 4u);
  const double m = density * L / 4 * h * b;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(pieces[i]["name"], "beam/" + std::to_string(i));
    expect_near(pieces[i]["mass"], m);
    expect_near(pieces[i]["inertia"], m * (L / 4 * L / 4 + h * h) / 12);
    expect_near(pieces[i]["center"][0], (static_cast<double>(i) + 0.5) * L / 4);
    expect_near(pieces[i]["center"][1], h / 2);
    EXPECT_EQ(pieces[i]["vertices"].size(), 4u);
  }
  ASSERT_EQ(plan["joints"].size(), 4u);
  for (const char* name : {"wall-beam/0", "beam/0-beam/1", "beam/1-beam/2", "beam/2-beam/3"}) {
    const json& j = joint(plan, name);
    expect_near(j["N"], b * h * fy);
    expect_near(j["Nc"], b * h * fy);
    expect_near(j["Q"], b * h * fy / std::numbers::sqrt3);
    expect_near(j["M"], b * h * h / 4 * fy);
    expect_near(j["M_reverse"], b * h * h / 4 * fy);
    expect_near(j["axis"][0], 1);
    EXPECT_NEAR(j["axis"][1].get<double>(), 0, 1e-12);
    const double reach = j["between"][0] == "wall" ? L / 8 : L / 4;  // half of each neighbour
    expect_near(j["stiffness"]["N"], E * b * h / reach);
    expect_near(j["stiffness"]["Q"], 5. / 6 * E / 2.6 * b * h / reach);
    expect_near(j["stiffness"]["M"], E * b * h * h * h / 12 / reach);
    expect_near(j["max_rotation"], fracture_strain * h / (h / 2));  // ε_f L_p / y, L_p = h
    expect_near(j["max_elongation"], fracture_strain * h);
    expect_near(j["max_compression"], h);
    expect_near(j["max_slip"], h);
    EXPECT_FALSE(j["governed_by"].get<std::string>().empty());
  }
  EXPECT_EQ(joint(plan, "wall-beam/0")["between"], (json{"wall", "beam/0"}));
  EXPECT_TRUE(plan["left_out"].is_array());
}

TEST(CalibrateCommand, SupportsHoldThePieceToTheGround) {
  const Folder folder;
  const json plan =
      run("calibrate --json " +
          folder.write("scene.json", cantilever(R"(, "supports": [{"body": "beam", "at": [20,0.5],
                                                                                 "fix": ["y"]}])")))
          .json();
  const json& support = joint(plan, "support/0");
  EXPECT_EQ(support["between"], (json{"ground", "beam/3"}));
  EXPECT_EQ(support["axis"], (json{1., 0.}));
  expect_near(support["N"], 0);         // free
  EXPECT_TRUE(support["Q"].is_null());  // unlimited
  expect_near(support["M"], 0);
}

TEST(CalibrateCommand, ADrawingGivesTheSamePlanAsItsRing) {
  const Folder folder;
  folder.write("beam.svg",
               "<svg viewBox='0 0 20000 1000'><g transform='translate(10000 0)'>"
               "<path id='beam' d='m-10000 0h20000v1000h-20000z'/></g></svg>");
  std::string scene = cantilever();
  const std::string ring = "[[0,0],[20,0],[20,1],[0,1]]";
  scene.replace(scene.find(ring), ring.size(), R"("beam.svg#beam", "scale": 0.001)");
  const json drawn = run("calibrate --json " + folder.write("drawn.json", scene)).json();
  const json written = run("calibrate --json " + folder.write("written.json", cantilever())).json();
  for (const json& j : written["joints"]) expect_near(joint(drawn, j["name"])["M"], j["M"].get<double>());
}

TEST(CalibrateCommand, PrintsATable) {
  const Folder folder;
  const Ran ran = run("calibrate " + folder.write("scene.json", cantilever()));
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_NE(ran.out.find("beam/2-beam/3"), std::string::npos);
  EXPECT_NE(ran.out.find("4.375e+07"), std::string::npos) << ran.out;  // M = b h² fy / 4
}

TEST(CalibrateCommand, KeepsEachLineOfItsTableWhateverTheNames) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", R"({"bodies": [
    {"name": "a\nb", "outline": [[0,0],[9,0],[9,1],[0,1]], "material": "S355", "split": {"pieces": 2}}],
    "supports": [{"body": "a\nb", "at": [0, 0.5], "fix": ["x", "y", "angle"]}]})");
  for (const char* command : {"calibrate ", "check ", "simulate --time 0 "}) {
    const Ran ran = run(command + scene);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    EXPECT_NE(ran.out.find("\na b/0-a b/1 "), std::string::npos) << ran.out;
    EXPECT_EQ(ran.out.find("a\nb"), std::string::npos) << ran.out;
  }
}

TEST(CalibrateCommand, WritesDefinitionsToAFile) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const Ran ran = run("calibrate " + scene + " --to json --out " + (folder / "plan.json").string());
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(json::parse(slurp(folder / "plan.json")), run("calibrate --json " + scene).json());
  EXPECT_EQ(run("calibrate --to json " + scene).json(), run("calibrate --json " + scene).json());
}

TEST(CalibrateCommand, WritesNothingOverWhatItReads) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  const std::string drawing = folder.write(
      "plate.svg",
      "<svg width='4m' height='1m' viewBox='0 0 4 1'><rect id='plate' width='4' height='1'/></svg>");
  for (const std::string& command :
       {"calibrate " + scene + " --to cpp --out " + scene, "calibrate " + scene + " --out " + scene,
        "calibrate " + scene + " --to rube --out " + scene,
        "calibrate " + drawing + " --to scene --out " + drawing,
        "calibrate " + drawing + " --picture " + drawing, "check " + drawing + " --picture " + drawing,
        "simulate " + scene + " --time 0.1 --history " + scene,
        "simulate " + scene + " --time 0.1 --replay " + scene})
    expect_bad_input(run(command), "is the file that is read");
  EXPECT_EQ(slurp(scene), cantilever());
  EXPECT_EQ(run("calibrate " + scene + " --to scene --out " + scene).exit, 0);
}

// A drawing or a section that a scene names is read, too.
TEST(CalibrateCommand, WritesNothingOverWhatItsSceneNames) {
  const Folder folder;
  const std::string drawing_text =
      "<svg width='400cm' height='100cm' viewBox='0 0 4 1'><rect id='plate' width='4' height='1'/></svg>";
  const std::string section_text =
      R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,1],[0,1]], "material": "S355"}]})";
  const std::string drawing = folder.write("art.svg", drawing_text);
  const std::string section = folder.write("box.section.svg", section_text);
  const std::string scene = folder.write("scene.json", R"({"gravity": [0,0], "bodies": [
    {"name": "a", "outline": "art.svg#plate", "material": "S355", "profile": "box.section.svg",
     "split": {"pieces": 4}}], "supports": [{"body": "a", "at": [0,0.5], "fix": ["x","y","angle"]}],
    "loads": [{"body": "a", "at": [4,0.5], "force": [0,-1e3]}]})");
  for (const std::string& read : {drawing, section})
    for (const std::string& command :
         {"calibrate " + scene + " --picture ", "calibrate " + scene + " --out ",
          "calibrate " + scene + " --to scene --out ", "calibrate " + scene + " --to rube --out ",
          "check " + scene + " --picture ", "limit " + scene + " --picture ",
          "design " + scene + " --for reserve=2 --by depth --out ",
          "simulate " + scene + " --time 0.1 --history ", "simulate " + scene + " --time 0.1 --replay ",
          "view " + scene + " --frames 1 --screenshot "})
      expect_bad_input(run(command + read), "is the file that is read");
  expect_bad_input(run("design " + drawing + " --for mass=1 --by depth --out " + drawing),
                   "is the file that is read");
  expect_bad_input(run("design " + scene + " --for mass=1 --by profile --among " + section + " --out " +
                       (folder / "./box.section.svg").string()),
                   "is the file that is read");
  EXPECT_EQ(slurp(drawing), drawing_text);
  EXPECT_EQ(slurp(section), section_text);
}

TEST(CalibrateCommand, WritesNothingOfWhatFails) {
  const Folder folder;
  const std::string out = (folder / "plan.json").string();
  expect_bad_input(run("calibrate " + folder.write("bad.json", "{}") + " --out " + out));
  EXPECT_FALSE(std::filesystem::exists(out));
  const Ran ran = run("calibrate " + folder.write("scene.json", cantilever()) + " --out " +
                      (folder / "missing/plan.json").string());
  EXPECT_EQ(ran.exit, 1);
  EXPECT_EQ(ran.out, "");
  EXPECT_EQ(ran.error_lines(), 1);
  const std::string scene = (folder / "scene.json").string(), missing = (folder / "missing/a.svg").string();
  EXPECT_EQ(run("calibrate " + scene + " --out " + out + " --picture " + missing).exit, 1);
  EXPECT_EQ(
      run("calibrate " + scene + " --picture " + (folder / "a.svg").string() + " --out " + missing).exit, 1);
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
}

struct Bad {
  const char* name;
  std::string text, saying;
};
class BadScene : public testing::TestWithParam<Bad> {};

TEST_P(BadScene, ExitsWith2AndSaysWhatIsWrong) {
  const Folder folder;
  const std::string file = folder.write("bad.json", GetParam().text);
  const Ran ran = run("calibrate " + file + " --json");
  expect_bad_input(ran, GetParam().saying);
  EXPECT_EQ(ran.err.find(file + ":"), 0u) << ran.err;
}

std::string bodies(const std::string& list) { return R"({"bodies": [)" + list + "]}"; }
std::string body(const std::string& name, const std::string& ring,
                 const std::string& rest = R"("type": "static")") {
  return R"({"name": ")" + name + R"(", "outline": )" + ring + ", " + rest + "}";
}
const std::string square = "[[0,0],[1,0],[1,1],[0,1]]", far = "[[5,0],[6,0],[6,1],[5,1]]";

INSTANTIATE_TEST_SUITE_P(
    Files, BadScene,
    testing::Values(
        Bad{"syntax", "{", "1:"}, Bad{"unknown_key", cantilever(R"(, "colour": 1)"), "colour"},
        Bad{"repeated_key", cantilever(R"(, "joints": [])"), "twice"},
        Bad{"unknown_material", cantilever("", R"(, "material": "gold")"), "twice"},
        Bad{"same_name_twice", bodies(body("a", square) + "," + body("a", far)), "'a'"},
        Bad{"name_with_a_slash", bodies(body("a/b", square)), "a/b"},
        Bad{"name_with_a_hash", bodies(body("a#b", square)), "a#b"},
        Bad{"name_with_a_dash", bodies(body("a-b", square)), "a-b"},
        Bad{"named_ground", bodies(body("ground", square)), "ground"},
        Bad{"dynamic_without_material", bodies(body("a", square, R"("depth": 1)")), "material"},
        Bad{"outline_crosses_itself", bodies(body("a", "[[0,0],[1,1],[1,0],[0,1]]")), "'a'"},
        Bad{"outline_of_two_points", bodies(body("a", "[[0,0],[1,1]]")), "'a'"},
        Bad{"hole_outside", bodies(body("a", square, R"("type": "static", "holes": [[[5,5],[6,5],[6,6]]])")),
            "hole"},
        Bad{"joint_to_nobody", R"({"bodies": [], "joints": [{"between": ["a","b"]}]})", "'a'"},
        Bad{"joint_where_nothing_touches",
            R"({"bodies": [)" + body("a", square) + "," + body("b", far) +
                R"(], "joints": [{"between": ["a","b"]}]})",
            "edges do not overlap"},
        Bad{"support_beside_the_body",
            cantilever(R"(, "supports": [{"body": "beam", "at": [50,50], "fix": ["x"]}])"), "support"},
        Bad{"support_of_nobody", cantilever(R"(, "supports": [{"body": "b", "at": [1,1], "fix": ["x"]}])"),
            "'b'"},
        Bad{"load_beside_the_body",
            cantilever(R"(, "loads": [{"body": "beam", "at": [50,50], "force": [1,0]}])"), "load"},
        Bad{"load_of_nobody", cantilever(R"(, "loads": [{"body": "b", "at": [1,1], "force": [1,0]}])"),
            "'b'"},
        Bad{"cut_that_ends_inside",
            bodies(body("a", "[[0,0],[4,0],[4,1],[0,1]]",
                        R"("material": "S355", "split": {"cuts": [[[2,-1],[2,0.5]]]})")),
            "cut"},
        Bad{"profile_of_another_height",
            bodies(body("a", "[[0,0],[4,0],[4,1],[0,1]]",
                        R"("material": "S355", "split": {"pieces": 2}, "profile": {"regions": [
                           {"outer": [[0,0],[0.1,0],[0.1,0.5],[0,0.5]], "material": "S355"}]})")),
            "profile"},
        Bad{"drawing_missing", bodies(body("a", R"("lost.svg#a", "scale": 1)")), "lost.svg"}),
    [](const auto& info) { return info.param.name; });

TEST(CalibrateCommand, ErrorsInADrawingNameTheDrawing) {
  const Folder folder;
  const std::string svg =
      folder.write("arm.svg", R"(<svg viewBox="0 0 9 9"><path id="arm" d="M 0 0 L 1"/></svg>)");
  const Ran ran = run("calibrate " + folder.write("scene.json", bodies(body("a", R"("arm.svg#arm")"))));
  expect_bad_input(ran, "no physical size");
  const Ran scaled =
      run("calibrate " + folder.write("scene.json", bodies(body("a", R"("arm.svg#arm", "scale": 1)"))));
  expect_bad_input(scaled, "path command 2");
  EXPECT_EQ(scaled.err.find(svg + ":#arm"), 0u) << scaled.err;
}

TEST(CalibrateCommand, NamesThatAreNoUtf8AreDecodedOrRefused) {
  const Folder folder;
  const auto drawn = [&](const std::string& declared) {
    const std::string file = folder.write(
        "page.svg",
        "<?xml version='1.0'" + declared +
            "?><svg width='1000mm' height='1000mm'><rect id='B\xE4r' width='99' height='9'/></svg>");
    return std::pair(run("calibrate --json " + file), run("calibrate " + file));
  };
  const auto [printed, table] = drawn(" encoding='windows-1252'");
  ASSERT_EQ(printed.exit, 0) << printed.err;
  EXPECT_EQ(printed.json()["bodies"][1]["name"], "B\xC3\xA4r");
  EXPECT_NE(table.out.find("B\xC3\xA4r/0"), std::string::npos);
  const auto [refused, no_table] = drawn("");
  expect_bad_input(refused, "page.svg:1:");
  expect_bad_input(no_table, "has a byte that is no UTF-8; save it in UTF-8");
  // A file's own name may be any bytes.
  const std::string scene = folder.write("b\xE4r.scene.json", cantilever()),
                    picture = (folder / "p.svg").string();
  EXPECT_EQ(run("calibrate " + scene + " --json --picture " + picture).exit, 0);
  EXPECT_NE(slurp(picture).find(">B\xEF\xBF\xBDr<"), std::string::npos);
}

TEST(CalibrateCommand, AScaleOfWhatIsNoDrawingIsTold) {
  const Folder folder;
  const Ran ran = run("calibrate " + folder.write("scene.json", cantilever()) + " --scale 0.001");
  EXPECT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("--scale changes nothing"), std::string::npos) << ran.err;
}

TEST(CalibrateCommand, OptionsOutOfRangeAreBadInput) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  expect_bad_input(run("calibrate " + scene + " --to fortran"));
  expect_bad_input(run("calibrate " + scene + " --target-error -1"));
  expect_bad_input(run("calibrate " + scene + " --target-error nan"));
  expect_bad_input(run("calibrate"));
  expect_bad_input(run("calibrate " + scene + " --out ''"), "--out");
}

TEST(CalibrateCommand, OptionsWithoutEffectAreBadInput) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", cantilever());
  for (const char* options : {"--to scene --json", "--to cpp --json", "--to scene --leave-out 0.01",
                              "--to cpp --leave-out 0.01", "--to json --as weld", "--to box2d --as hinge",
                              "--to scene --target-error 0.1", "--to scene --picture a.svg"})
    expect_bad_input(run("calibrate " + scene + " " + options), "does not go with --to");
  for (const char* to : {"json", "box2d", "rube"})
    EXPECT_TRUE(run("calibrate " + scene + " --json --to " + to).json().is_object());
}

// A strip of 4 m in pieces of 0.025 m errs by 1/160², 0.004 %.
TEST(CalibrateCommand, SaysWhereASplitDoesNotReachItsTarget) {
  const Folder folder;
  const std::string scene = folder.write("scene.json", R"({"bodies": [
    {"name": "w", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
    {"name": "b", "outline": [[0,0],[4,0],[4,0.2],[0,0.2]], "material": "S355", "split": "auto"}],
    "joints": [{"between": ["w", "b"]}]})");
  EXPECT_EQ(run("calibrate " + scene + " --json --target-error 1e-4").err, "");
  const Ran ran = run("calibrate " + scene + " --json --target-error 1e-5");
  EXPECT_EQ(ran.exit, 0);
  EXPECT_NE(ran.err.find("'b' is split with a displacement error of 0.004"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("above the target error"), std::string::npos) << ran.err;

  // So do commands that only use the split: a bar of 0.12 m has no room for enough pieces.
  const std::string small = folder.write("small.json", R"({"gravity": [0,-10], "bodies": [
    {"name": "w", "type": "static", "outline": [[-1,-1],[0,-1],[0,1],[-1,1]]},
    {"name": "b", "outline": [[0,0],[0.12,0],[0.12,0.03],[0,0.03]], "material": "S355", "split": "auto"}],
    "joints": [{"between": ["w", "b"]}]})");
  for (const std::string& command :
       {"check " + small, "limit " + small, "design " + small + " --for mass=20 --by depth"}) {
    const Ran warns = run(command);
    EXPECT_EQ(warns.exit, 0) << warns.err;
    EXPECT_NE(warns.err.find("above the target error"), std::string::npos) << command << warns.err;
  }
}

TEST(CalibrateCommand, WritesEveryKindOfDefinition) {
  const Folder folder;
  const std::string scene = folder.write("my scene.json", cantilever());
  const std::string quoted = "'" + scene + "'";
  for (const char* to : {"json", "box2d", "cpp", "rube"}) {
    const Ran ran = run("calibrate " + quoted + " --to " + to);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    const std::string out = (folder / to).string();
    EXPECT_EQ(run("calibrate " + quoted + " --to " + to + " --out " + out).exit, 0);
    EXPECT_EQ(slurp(out), ran.out);
  }
  EXPECT_NE(slurp(folder / "cpp").find("build_my_scene(b2World& world)"), std::string::npos);
  EXPECT_EQ(json::parse(slurp(folder / "box2d"))["joints"].size(), 4u);
}

// No other program moves them: each format says so.
TEST(CalibrateCommand, GroundsStandStillInOtherPrograms) {
  const Folder folder;
  const std::string scene = folder.write("a.json", cantilever(R"(,
      "supports": [{"body": "beam", "at": [20,0.5], "fix": ["y"], "displacement": [0, -1e-3, 0]}])"));
  for (const auto& [to, said] :
       {std::pair("box2d", "the ground of support/0 does not move"),
        std::pair("cpp", "the ground of support/0 does not move"),
        std::pair("rube", "'support/0' is written as R.U.B.E. has it: its ground does not move")}) {
    const Ran ran = run("calibrate " + scene + " --to " + to);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    EXPECT_NE((ran.out + ran.err).find(said), std::string::npos) << to << ran.err;
  }
}

TEST(CalibrateCommand, RefusesWhatBox2DCannotHold) {
  const Folder folder;
  const std::string thin = folder.write(
      "thin.json", bodies(body("a", "[[0,0],[1,0],[1,0.01],[0,0.01]]", R"("material": "S355")")));
  EXPECT_EQ(run("calibrate " + thin + " --to json").exit, 0);
  for (const char* to : {"box2d", "cpp", "rube"}) {
    const Ran ran = run("calibrate " + thin + " --to " + to + " --out " + (folder / "out").string());
    expect_bad_input(ran, "0.01 m wide");
    EXPECT_EQ(ran.err.find(thin + ":"), 0u) << ran.err;
    EXPECT_EQ(ran.err.find(thin, 1), std::string::npos) << ran.err;  // once
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

// A level of someone who draws in R.U.B.E.: a plank welded to a wall, of steel since a property says so.
const std::string level = R"({"gravity": {"x": 0, "y": -10}, "allowSleep": true,
  "body": [
    {"name": "wall", "fixture": [{"polygon": {"vertices": {"x": [-1, 0, 0, -1], "y": [-1, -1, 1, 1]}}}]},
    {"name": "plank", "type": 2, "customProperties": [{"name": "ductile.material", "string": "S355"}],
     "fixture": [{"polygon": {"vertices": {"x": [0, 4, 4, 0], "y": [0, 0, 0.5, 0.5]}}}]}],
  "joint": [{"type": "weld", "name": "root", "bodyA": 0, "bodyB": 1}])";

TEST(CalibrateCommand, TakesALevelOfAnEditor) {
  const Folder folder;
  const std::string file = folder.write("level.json", level + "}");
  const Ran table = run("calibrate " + file), plan = run("calibrate --json " + file);
  EXPECT_EQ(table.exit, 0) << table.err;
  ASSERT_EQ(plan.exit, 0) << plan.err;
  const double M = 0.5 * 0.5 / 4 * 355e6;
  expect_near(plan.json()["joints"][0]["M"], M);
  EXPECT_EQ(plan.json()["joints"][0]["name"], "root");
  EXPECT_EQ(plan.json()["bodies"][1]["pieces"][0]["name"], "plank");
  const Ran written = run("calibrate " + file + " --to rube");
  ASSERT_EQ(written.exit, 0) << written.err;
  EXPECT_EQ(written.json()["joint"][0]["maxMotorTorque"].get<float>(), static_cast<float>(M));
  // What was written is read as the same plan, and runs.
  const std::string again = folder.write("again.json", written.out);
  expect_near(run("calibrate --json " + again).json()["joints"][0]["M"], M);
  const Ran ran = run("simulate " + again + " --time 1 --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  EXPECT_EQ(ran.json()["joints"][0]["name"], "root");
}

TEST(CalibrateCommand, ReadsFromAPipe) {
  const Folder folder;
  for (const std::string& text : {cantilever(), level + "}"}) {
    const std::string file = folder.write("scene.json", text), out = (folder / "out").string();
    const std::string piped = "cat " + file + " | " DUCTILE_COMMAND " calibrate --json /dev/stdin >" + out;
    EXPECT_EQ(std::system(piped.c_str()), 0);
    EXPECT_EQ(slurp(out), run("calibrate --json " + file).out);
  }
}

TEST(CalibrateCommand, ALevelIsNoScene) {
  const Folder folder;
  expect_bad_input(run("calibrate --to scene " + folder.write("level.json", level + "}")), "--to rube");
}

TEST(CalibrateCommand, ASpoiltLevelIsBadInput) {
  const Folder folder;
  std::string text = level + "}";
  text.replace(text.find("\"bodyB\": 1"), 10, "\"bodyB\": 7");
  const std::string file = folder.write("level.json", text), out = (folder / "out.json").string();
  for (const char* command : {"calibrate ", "calibrate --to rube --out ", "simulate --time 1 "}) {
    const std::string to = std::string(command).ends_with("--out ") ? out + " " : "";
    const Ran ran = run(command + to + file);
    expect_bad_input(ran, "joint[0].bodyB");
    EXPECT_EQ(ran.err.find(file + ":"), 0u) << ran.err;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(CalibrateCommand, SaysWhatOfALevelNoPlanHolds) {
  const Folder folder;
  std::string text = level + "}";
  text.insert(text.rfind("]}"), R"(, {"type": "rope", "name": "r", "bodyA": 0, "bodyB": 1, "maxLength": 9})");
  const std::string file = folder.write("level.json", text);
  EXPECT_EQ(run("calibrate " + file).exit, 0);
  EXPECT_EQ(run("calibrate " + file + " --to rube").json()["joint"][1]["maxLength"], 9);
  EXPECT_EQ(run("simulate --time 1 " + file).err, "");  // which has it
  const Ran definitions = run("calibrate --to cpp " + file), statics = run("check " + file);
  expect_bad_input(definitions, "joint[1]: is a rope joint");
  EXPECT_EQ(definitions.err.find(file + ":"), 0u) << definitions.err;
  EXPECT_EQ(statics.exit, 0);
  EXPECT_NE(statics.err.find("joint[1]: is a rope joint that is not calibrated: statics leaves it out"),
            std::string::npos)
      << statics.err;
}

TEST(CalibrateCommand, WritesHingesOrWeldsForPlayersOfLevels) {
  const Folder folder;
  const std::string file = folder.write("level.json", level + "}");
  EXPECT_EQ(run("calibrate " + file + " --to rube").json()["joint"][0]["type"], "revolute");
  EXPECT_EQ(run("calibrate " + file + " --to rube --as weld").json()["joint"][0]["type"], "weld");
  expect_bad_input(run("calibrate " + file + " --to rube --as glue"), "glue");
  const Ran crane = run("calibrate " DUCTILE_SOURCE_DIR "/scenes/frame_pushed.scene.json --to rube");
  EXPECT_NE(crane.err.find("loads are written as properties"), std::string::npos) << crane.err;
}

TEST(CalibrateCommand, LeavesOutWhatTheSceneDoesNotNeed) {
  const std::string scene = DUCTILE_SOURCE_DIR "/scenes/cantilever.scene.json";
  const Ran ran = run("calibrate " + scene + " --leave-out 0.01 --time 2 --json");
  ASSERT_EQ(ran.exit, 0) << ran.err;
  const json result = ran.json();
  EXPECT_TRUE(result["joints"].empty());
  ASSERT_EQ(result["left_out"].size(), 1u);
  const json& item = result["left_out"][0];
  EXPECT_EQ(item["what"], "10 joints merged with the pieces at both sides");
  EXPECT_LE(item["measured"], item["error"]);
  EXPECT_LE(item["error"], 0.01);
  EXPECT_GT(item["time_saved"], 0);
  EXPECT_EQ(result["bodies"][1]["pieces"][3]["stands_still"], true);
  EXPECT_NE(run("calibrate " + scene + " --leave-out 0.01 --time 2").out.find("promised"), std::string::npos);
  expect_bad_input(run("calibrate " + scene + " --leave-out 0.01 --to box2d"), "--leave-out");
  expect_bad_input(run("calibrate " + scene + " --leave-out 2"), "--leave-out");
  expect_bad_input(run("calibrate " + scene + " --leave-out -1"));
}

}  // namespace
