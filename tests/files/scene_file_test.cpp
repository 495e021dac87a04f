#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "ductile/files.h"

namespace {
using namespace ductile;
namespace fs = std::filesystem;

// Every key of the format somewhere.
const std::string everything = read_text(DUCTILE_SOURCE_DIR "/tests/files/schema/everything.scene.json");

void expect_everything(const SceneDef& scene) {
  EXPECT_EQ(scene.gravity, (Point{1, -9}));
  EXPECT_EQ(scene.gravity_ramp, 2);
  EXPECT_TRUE(scene.sleep);
  EXPECT_TRUE(scene.interaction);
  EXPECT_EQ(scene.joint.max_rotation, unlimited);
  EXPECT_FALSE(scene.joint.moment);

  ASSERT_EQ(scene.bodies.size(), 5u);
  const BodyDef &wall = scene.bodies[0], &beam = scene.bodies[1], &wheel = scene.bodies[2],
                &girder = scene.bodies[3], &arm = scene.bodies[4];
  EXPECT_EQ(wall.name, "wall");
  EXPECT_EQ(wall.type, BodyType::static_body);
  EXPECT_FALSE(wall.material);
  EXPECT_EQ(wall.depth, 1);
  EXPECT_EQ(wall.outline.outer, (Ring{{-1, -1}, {0, -1}, {0, 2}, {-1, 2}}));

  EXPECT_EQ(beam.type, BodyType::dynamic_body);
  EXPECT_EQ(beam.outline.holes, (std::vector<Ring>{{{1, 0.2}, {2, 0.2}, {2, 0.4}}}));
  EXPECT_EQ(beam.depth, 0.5);
  EXPECT_EQ(beam.pieces, 10);
  EXPECT_EQ(beam.along, (std::array<Point, 2>{{{0, 0.5}, {20, 0.5}}}));
  EXPECT_FALSE(beam.automatic);
  EXPECT_EQ(beam.material, (Material{.yield_stress = 350e6,
                                     .yield_stress_compression = 340e6,
                                     .shear_yield_stress = 200e6,
                                     .youngs_modulus = 210e9,
                                     .criterion = Criterion::von_mises,
                                     .density = 7800,
                                     .ultimate_stress = 490e6,
                                     .fracture_strain = 0.25,
                                     .brittle = true,
                                     .damping_ratio = 0.1,
                                     .rate_D = 40,
                                     .rate_q = 5.5,
                                     .friction = 0.6,
                                     .restitution = 0.3}));
  EXPECT_EQ(beam.joint.moment, 1e7);
  EXPECT_EQ(beam.joint.moment_reverse, 2e7);
  EXPECT_EQ(beam.joint.axial, unlimited);
  EXPECT_EQ(beam.joint.axial_compression, 3);
  EXPECT_EQ(beam.joint.shear, 0);
  EXPECT_EQ(beam.joint.elastic, Elasticity::frequency);
  EXPECT_EQ(beam.joint.frequency, 2);
  EXPECT_EQ(beam.joint.damping_ratio, 0.7);
  EXPECT_EQ(beam.joint.max_rotation, 3);
  EXPECT_EQ(beam.joint.max_elongation, 0.1);
  EXPECT_EQ(beam.joint.max_compression, unlimited);
  EXPECT_EQ(beam.joint.max_slip, 0.2);
  EXPECT_EQ(beam.joint.hinge_length, 0.5);
  EXPECT_EQ(beam.joint.combine, true);
  EXPECT_EQ(beam.joint.stiffness_axial, 5e8);
  EXPECT_EQ(beam.joint.stiffness_shear, unlimited);
  EXPECT_EQ(beam.joint.stiffness_moment, 7e6);
  EXPECT_EQ(beam.velocities, (std::vector<Point>{{1, 2}, {3, 4}}));

  EXPECT_EQ(wheel.type, BodyType::kinematic_body);
  EXPECT_EQ(wheel.circle, 0.4);
  EXPECT_EQ(wheel.at, (Point{30, 2}));
  EXPECT_EQ(wheel.angle, 0.5);
  EXPECT_EQ(wheel.velocity, (Point{1, 2}));
  EXPECT_EQ(wheel.angular_velocity, 3);
  EXPECT_EQ(wheel.material, materials::S355);
  EXPECT_EQ(wheel.group, -2);
  EXPECT_FALSE(wheel.collides);
  EXPECT_EQ(wheel.price, 1.5);
  EXPECT_EQ(wheel.assembly, "cart");
  EXPECT_TRUE(beam.collides);

  ASSERT_EQ(girder.profile.size(), 1u);
  EXPECT_EQ(girder.profile[0].material.yield_stress, 235e6);
  EXPECT_EQ(girder.material, materials::S235);
  EXPECT_EQ(girder.cuts, (std::vector<std::array<Point, 2>>{{{{5, 4}, {5, 7}}}, {{{10, 4}, {10, 7}}}}));
  EXPECT_TRUE(arm.automatic);
  EXPECT_EQ(arm.profile_name, "IPE 300");
  ASSERT_EQ(arm.profile.size(), 1u);
  EXPECT_EQ(arm.profile[0].material, materials::S355);

  ASSERT_EQ(scene.joints.size(), 7u);
  EXPECT_EQ(scene.joints[0].a, "wall");
  EXPECT_EQ(scene.joints[0].b, "beam");
  EXPECT_EQ(scene.joints[0].gap, 0.01);
  EXPECT_EQ(scene.joints[0].overrides.moment, 1e7);
  EXPECT_EQ(scene.joints[0].overrides.elastic, Elasticity::rigid);
  EXPECT_EQ(scene.joints[1].overrides.elastic, Elasticity::true_stiffness);
  EXPECT_EQ(scene.joints[2].overrides.elastic, Elasticity::elastic_rotation);
  EXPECT_EQ(scene.joints[2].overrides.elastic_rotation, 0.02);
  EXPECT_EQ(scene.joints[2].overrides.frequency, 3);
  EXPECT_EQ(scene.joints[0].at, std::nullopt);
  EXPECT_EQ(scene.joints[0].across, std::nullopt);
  EXPECT_EQ(scene.joints[1].across, (std::array<Point, 2>{{{0, 1}, {0, 2.5}}}));
  EXPECT_EQ(scene.joints[3].at, (Point{0, 0.5}));
  EXPECT_EQ(scene.joints[3].others, std::vector<std::string>{"arm"});
  EXPECT_EQ(scene.joints[3].overrides.axial, 1e6);
  const JointBetweenDef &winch = scene.joints[4], &strut = scene.joints[5], &motor = scene.joints[6];
  EXPECT_EQ(winch.line, (std::array<Point, 2>{{{-1, 2}, {20, 1}}}));
  EXPECT_EQ(winch.at, std::nullopt);
  EXPECT_EQ(winch.carries, Carries::tension);
  EXPECT_EQ(winch.length, 9);
  EXPECT_EQ(winch.overrides.stiffness_axial, 3e6);
  ASSERT_TRUE(winch.drive);
  EXPECT_EQ(winch.drive->row, axial);
  EXPECT_EQ(winch.drive->position, 4);
  EXPECT_EQ(winch.drive->speed, -0.5);
  EXPECT_EQ(winch.drive->cap, 2e5);
  EXPECT_EQ(winch.drive->from, 1);
  EXPECT_EQ(winch.drive->ramp, 2);
  EXPECT_EQ(strut.carries, Carries::compression);
  EXPECT_TRUE(strut.is_line());
  EXPECT_EQ(strut.line, std::nullopt);
  EXPECT_EQ(strut.drive.has_value(), false);
  EXPECT_FALSE(motor.is_line());
  ASSERT_TRUE(motor.drive);
  EXPECT_EQ(motor.drive->row, rotation);
  EXPECT_EQ(motor.drive->position, std::nullopt);
  EXPECT_EQ(motor.drive->cap, unlimited);

  ASSERT_EQ(scene.supports.size(), 2u);
  EXPECT_EQ(scene.supports[0].at, (Point{20, 0.5}));
  EXPECT_FALSE(scene.supports[0].fix_x);
  EXPECT_TRUE(scene.supports[0].fix_y);
  EXPECT_TRUE(scene.supports[0].fix_angle);
  EXPECT_EQ(scene.supports[0].stiffness_x, 4e5);
  EXPECT_EQ(scene.supports[0].displacement, (std::array<double, 3>{0.01, -0.02, 0}));
  EXPECT_EQ(scene.supports[0].ramp, 3);
  EXPECT_FALSE(scene.supports[1].fix_y);
  EXPECT_EQ(scene.supports[1].stiffness_x, 0);
  EXPECT_EQ(scene.supports[1].stiffness_y, 3);
  EXPECT_EQ(scene.supports[1].stiffness_angle, 2);

  ASSERT_EQ(scene.loads.size(), 2u);
  EXPECT_EQ(scene.loads[0].force, (Point{0, -1e6}));
  EXPECT_EQ(scene.loads[0].moment, 5);
  EXPECT_EQ(scene.loads[0].from, 1);
  EXPECT_EQ(scene.loads[0].ramp, 2);
  EXPECT_EQ(scene.loads[0].to, 9);
  EXPECT_EQ(scene.loads[1].to, unlimited);

  ASSERT_EQ(scene.wheels.size(), 1u);
  EXPECT_EQ(scene.wheels[0].chassis, "beam");
  EXPECT_EQ(scene.wheels[0].wheel, "wheel");
  EXPECT_EQ(scene.wheels[0].axis, (Point{1, 1}));
  EXPECT_EQ(scene.wheels[0].frequency, 5);
  EXPECT_EQ(scene.wheels[0].damping_ratio, 0.6);
  EXPECT_EQ(scene.wheels[0].motor_speed, -40);
  EXPECT_EQ(scene.wheels[0].motor_torque, 1000);
}

TEST(SceneFile, EveryKeyIsRead) { expect_everything(parse_scene(everything)); }

// A file as someone wrote it: with links, comments and a layout of its own.
constexpr const char* written = R"({
  // The crane on the quay.
  "materials": {
    "steel": { "density": 7800, "E": 210e9,   "fy": 350e6 /* from the mill */ },
    "plain": "S235" },
  "bodies": [
    { "name": "jib", "outline": "harbour_crane.svg#jib", "depth": 0.10, "material": "steel",
      "split": { "pieces": 4 } },
    { "name": "mast", "outline": "harbour_crane.svg#pillar", "material": "steel" },
    { "name": "box", "outline": [[0, 0], [1, 0],
                                 [1, 1]], "material": "plain" }
  ],
  "loads": [ { "body": "box", "at": [0.9, 0.5], "force": [0, -1e3] } ] // N
}
)";
constexpr const char* scenes = DUCTILE_SOURCE_DIR "/scenes";

struct Edited {
  const char* name;
  std::function<void(SceneDef&)> edit;
  std::vector<std::pair<std::string, std::string>> replaced;  ///< in the text above
};
class SceneFileEdited : public testing::TestWithParam<Edited> {};
TEST_P(SceneFileEdited, ChangesWhereItStands) {
  SceneDef scene = parse_scene(written, "scene", scenes);
  GetParam().edit(scene);
  std::string expected = written;
  for (const auto& [was, is] : GetParam().replaced) expected.replace(expected.find(was), was.size(), is);
  const std::string text = edited_scene(written, scene, scenes);
  EXPECT_EQ(text, expected);
  EXPECT_EQ(scene_text(parse_scene(text, "scene", scenes)), scene_text(scene));
}
void steel_of(SceneDef& scene, std::initializer_list<std::size_t> bodies, double fy) {
  for (const std::size_t i : bodies) scene.bodies[i].material->yield_stress = fy;
}
INSTANTIATE_TEST_SUITE_P(
    Scene, SceneFileEdited,
    testing::Values(
        Edited{"nothing", [](SceneDef&) {}, {}},
        Edited{"depth", [](SceneDef& s) { s.bodies[0].depth = 0.25; }, {{"0.10", "0.25"}}},
        Edited{"depth_that_was_default",
               [](SceneDef& s) { s.bodies[2].depth = 2; },
               {{R"("material": "plain" })", R"("material": "plain", "depth": 2.0 })"}}},
        Edited{"pieces", [](SceneDef& s) { s.bodies[0].pieces = 7; }, {{R"("pieces": 4)", R"("pieces": 7)"}}},
        Edited{"no_split",
               [](SceneDef& s) { s.bodies[0].pieces = 1; },
               {{R"(,
      "split": { "pieces": 4 })",
                 ""}}},
        Edited{"a_shared_material",
               [](SceneDef& s) {
                 steel_of(s, {0, 1}, 4e8);
               },
               {{"350e6", "400000000.0"}}},
        Edited{"a_material_of_one_body",
               [](SceneDef& s) { steel_of(s, {1}, 4e8); },
               {{R"(#pillar", "material": "steel")", R"(#pillar", "material": "steel 2")"},
                {R"("plain": "S235")",
                 R"("plain": "S235",
    "steel 2": {"fy":400000000.0,"E":210000000000.0,"density":7800.0})"}}},
        Edited{"a_built_in_material",
               [](SceneDef& s) { s.bodies[2].material = materials::S355; },
               {{R"("plain" })", R"("S355" })"}}},
        Edited{"a_limit",
               [](SceneDef& s) { s.bodies[0].joint.moment = 5; },
               {{R"({ "pieces": 4 })", R"({ "pieces": 4 },
      "joint": {"moment":5.0})"}}},
        Edited{"gravity",
               [](SceneDef& s) {
                 s.gravity = {0, -1};
               },
               {{"-1e3] } ]", "-1e3] } ],\n  \"gravity\": [0.0,-1.0]"}}},
        Edited{"an_outline",
               [](SceneDef& s) {
                 s.bodies[2].outline.outer[2] = {1, 3};
               },
               {{"[[0, 0], [1, 0],\n                                 [1, 1]]",
                 "[[0.0,0.0],[1.0,0.0],[1.0,3.0]]"}}},
        Edited{"a_load_less",
               [](SceneDef& s) { s.loads.clear(); },
               {{",\n  \"loads\": [ { \"body\": \"box\", \"at\": [0.9, 0.5], \"force\": [0, -1e3] } ]", ""}}},
        Edited{"a_load_more",
               [](SceneDef& s) {
                 s.loads.push_back({.body = "box", .at = {0.5, 0}, .moment = 2});
               },
               {{"-1e3] } ]", R"(-1e3] }, {"body":"box","at":[0.5,0.0],"moment":2.0} ])"}}},
        Edited{"a_load_more_and_another_force",
               [](SceneDef& s) {
                 s.loads.push_back({.body = "box", .at = {0.5, 0}, .moment = 2});
                 s.loads[0].force.y = -2;
               },
               {{"-1e3] } ]", R"(-2.0] }, {"body":"box","at":[0.5,0.0],"moment":2.0} ])"},
                {"[0, -2.0]", "[0.0,-2.0]"}}},
        Edited{"a_body_more",  // of a material that others have, and of one that none has
               [](SceneDef& s) {
                 for (const char* name : {"box 2", "box 3"}) {
                   s.bodies.push_back(s.bodies[2]);
                   s.bodies.back().name = name;
                 }
                 s.bodies[3].material = s.bodies[0].material;
                 s.bodies[4].material = Material{.yield_stress = 1, .youngs_modulus = 2, .density = 3};
               },
               {{R"("plain" }
)",
                 R"("plain" },
    {"name":"box 2","outline":[[0.0,0.0],[1.0,0.0],[1.0,1.0]],"material":"steel"},
    {"name":"box 3","outline":[[0.0,0.0],[1.0,0.0],[1.0,1.0]],"material":"material 2"}
)"},
                {R"("plain": "S235")",
                 R"("plain": "S235",
    "material 2": {"fy":1.0,"E":2.0,"density":3.0})"}}},
        Edited{"a_body_less",
               [](SceneDef& s) { s.bodies.erase(s.bodies.begin() + 1); },
               {{R"(,
    { "name": "mast", "outline": "harbour_crane.svg#pillar", "material": "steel" })",
                 ""}}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(SceneFile, ThatCannotBeEditedIsWrittenAnew) {
  SceneDef scene = parse_scene(written, "scene", scenes);
  std::swap(scene.bodies[0], scene.bodies[2]);
  EXPECT_EQ(edited_scene(written, scene, scenes), scene_text(scene));
  EXPECT_EQ(edited_scene(written, scene, "/nowhere"), scene_text(scene));  // the drawing is not there
  EXPECT_EQ(edited_scene("", scene), scene_text(scene));
}

TEST(SceneFile, WhatIsWrittenReadsBackTheSame) {
  const std::string text = scene_text(parse_scene(everything));
  expect_everything(parse_scene(text));
  EXPECT_EQ(scene_text(parse_scene(text)), text);
}

TEST(SceneFile, DefaultsAreTheReferences) {
  const SceneDef scene = parse_scene(R"({"bodies": []})");
  EXPECT_EQ(scene.gravity, (Point{0, -9.81}));
  EXPECT_EQ(scene.gravity_ramp, 0);
  EXPECT_FALSE(scene.sleep);
  EXPECT_FALSE(scene.interaction);
  EXPECT_EQ(scene_text(scene), "{\n  \"bodies\": []\n}\n");
}

TEST(SceneFile, ASceneMayRedefineABuiltInMaterial) {
  const SceneDef scene = parse_scene(R"({"materials": {"S355": {"density": 1, "E": 2, "fy": 3}},
    "bodies": [{"name": "a", "outline": [[0,0],[1,0],[1,1]], "material": "S355"}]})");
  EXPECT_EQ(scene.bodies[0].material->yield_stress, 3);
}

class SceneFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "ductile.XXXXXX").string();
    folder = ::mkdtemp(name.data());
  }
  void TearDown() override { fs::remove_all(folder); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  fs::path folder;
};

TEST_F(SceneFolder, NamesFilesRelativeToItself) {
  write("crane.svg",
        R"(<svg viewBox="0 0 2000 1000"><rect id="arm" y="400" width="2000" height="100"/></svg>)");
  write("strip.json", R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,1],[0,1]], "material": "S235"}]})");
  write("crane.scene.json", R"({"bodies": [
    {"name": "arm", "outline": "crane.svg#arm", "scale": 0.001, "material": "S355", "split": "auto"},
    {"name": "girder", "outline": [[0,0],[20,0],[20,1],[0,1]], "profile": "strip.json"}]})");
  const SceneDef scene = read_scene(folder / "crane.scene.json");
  EXPECT_EQ(scene.bodies[0].outline.outer, (Ring{{0, 0.6}, {2, 0.6}, {2, 0.5}, {0, 0.5}}));
  ASSERT_EQ(scene.bodies[1].profile.size(), 1u);
  EXPECT_EQ(scene.bodies[1].profile[0].material, materials::S235);
}

// A file of a profile's name goes before the profile; IPE 300 has a shear area of 2568 mm², and its file
// none.
TEST_F(SceneFolder, AFileOfAProfilesNameIsThatSection) {
  write("IPE300", R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,0.3],[0,0.3]], "material": "S235"}]})");
  write("bar2", R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,0.3],[0,0.3]], "material": "S235"}]})");
  for (const char* name : {"IPE300", "bar2"}) {
    write("beam.scene.json", R"({"bodies": [{"name": "beam", "outline": [[0,0],[6,0],[6,0.3],[0,0.3]],
      "profile": ")" + std::string(name) +
                                 R"(", "material": "S355"}]})");
    const BodyDef beam = read_scene(folder / "beam.scene.json").bodies[0];
    ASSERT_EQ(beam.profile.size(), 1u);
    EXPECT_EQ(beam.profile_name, "");
    EXPECT_NEAR(Section(beam.profile).area(), 0.03, 1e-12);
  }
}

TEST_F(SceneFolder, ErrorsInAFileThatItNamesAreSaidOfThatFile) {
  write("crane.svg", R"(<svg viewBox="0 0 20 10"><path id="arm" d="M 0 0 L x"/></svg>)");
  write("strip.json", R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,1],[0,1]], "material": "gold"}]})");
  write("crane.scene.json", R"({"bodies": [
    {"name": "arm", "outline": "crane.svg#arm", "scale": 0.001},
    {"name": "lost", "outline": "lost.svg#arm", "scale": 0.001},
    {"name": "lost again", "outline": "lost.svg#leg", "scale": 0.001},
    {"name": "girder", "outline": [[0,0],[20,0],[20,1],[0,1]], "profile": "strip.json"}]})");
  try {
    read_scene(folder / "crane.scene.json");
    FAIL() << "should throw";
  } catch (const InvalidInput& error) {
    ASSERT_EQ(error.problems().size(), 3u) << error.what();
    EXPECT_EQ(error.problems()[0].place, (folder / "crane.svg").string() + ":#arm, path command 2");
    EXPECT_EQ(error.problems()[1].place, (folder / "crane.scene.json").string() + ":bodies[1].outline");
    EXPECT_EQ(error.problems()[2].place, (folder / "strip.json").string() + ":regions[0].material");
  }
}

struct Bad {
  const char* name;
  std::string text, place;
};
std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.name; }
class BadScene : public testing::TestWithParam<Bad> {};

TEST_P(BadScene, IsRefusedWithItsPlace) {
  std::string said;
  try {
    parse_scene(GetParam().text, "bad.json");
  } catch (const InvalidInput& error) {
    said = error.what();
  }
  EXPECT_EQ(said.find("bad.json:" + GetParam().place), 0u) << said;
}

std::string body(const std::string& rest) {
  return R"({"bodies": [{"name": "a", "outline": [[0,0],[1,0],[1,1]], )" + rest + "}]}";
}
std::string material(const std::string& rest) {
  return R"({"bodies": [], "materials": {"steel": {)" + rest + "}}}";
}
std::string outline(const std::string& value, const std::string& rest = "") {
  return R"({"bodies": [{"name": "a", "outline": )" + value + rest + "}]}";
}
std::string joint(const std::string& rest) {
  return R"({"bodies": [], "joints": [{"between": ["a","b"], )" + rest + "}]}";
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadScene,
    testing::Values(
        Bad{"syntax", "{\"bodies\": [\n,]}", "2:1: "}, Bad{"trailing_text", "{\"bodies\": []} x", "1:16: "},
        Bad{"array", "[]", "top level: "}, Bad{"number", "3", "top level: "},
        Bad{"section", R"({"regions": []})", "top level: has \"regions\""},
        Bad{"empty", " \n", "2:1: is empty; save it anew"},
        Bad{"latin1", "{\"bodies\": [\n{\"name\": \"B\xE4r\"}]}", "2:12: has a byte that is no UTF-8"},
        Bad{"utf16", std::string("\xFF\xFE{\0}\0", 6), "1:1: is in UTF-16"},
        Bad{"nul", std::string("{\"bodies\": []}\n\0x", 16), "2:1: has a NUL byte"},
        Bad{"map_of_tiled", R"({"type": "map", "layers": [], "tilewidth": 32})", "top level: has \"layers\""},
        Bad{"no_bodies", "{}", "top level: has no \"bodies\""},
        Bad{"bodies_is_no_list", R"({"bodies": {}})", "bodies: "},
        Bad{"unknown_key", R"({"bodies": [], "bodys": []})", "top level: the key \"bodys\""},
        Bad{"repeated_key", R"({"bodies": [], "sleep": true, "sleep": true})",
            "top level: the key \"sleep\" stands twice"},
        Bad{"repeated_key_inside", R"({"bodies": [{"name": "a", "name": "b"}]})",
            "bodies[0]: the key \"name\""},
        Bad{"gravity", R"({"bodies": [], "gravity": -9.81})", "gravity: "},
        Bad{"gravity_ramp", R"({"bodies": [], "gravity_ramp": -1})", "gravity_ramp: "},
        Bad{"sleep", R"({"bodies": [], "sleep": 1})", "sleep: "},
        Bad{"no_density", material(R"("E": 1, "fy": 1)"), "materials.steel: has no \"density\""},
        Bad{"no_E", material(R"("density": 1, "fy": 1)"), "materials.steel: has no \"E\""},
        Bad{"no_fy", material(R"("density": 1, "E": 1)"), "materials.steel: has no \"fy\""},
        Bad{"negative_density", material(R"("density": -1, "E": 1, "fy": 1)"), "materials.steel.density: "},
        Bad{"zero_fyc", material(R"("density": 1, "E": 1, "fy": 1, "fyc": 0)"), "materials.steel.fyc: "},
        Bad{"unknown_material_key", material(R"("density": 1, "E": 1, "fy": 1, "nu": 0.3)"),
            "materials.steel: the key"},
        Bad{"unknown_built_in", R"({"bodies": [], "materials": {"steel": "S999"}})", "materials.steel: "},
        Bad{"no_name", R"({"bodies": [{"outline": [[0,0],[1,0],[1,1]]}]})", "bodies[0]: has no \"name\""},
        Bad{"no_outline", R"({"bodies": [{"name": "a"}]})", "bodies[0]: has no \"outline\""},
        Bad{"type", body(R"("type": "floating")"), "bodies[0].type: "},
        Bad{"unknown_material", body(R"("material": "gold")"), "bodies[0].material: "},
        Bad{"zero_depth", body(R"("depth": 0)"), "bodies[0].depth: "},
        Bad{"depth_and_profile",
            body(
                R"("depth": 1, "profile": {"regions": [{"outer": [[0,0],[1,0],[1,1]], "material": "S235"}]})"),
            "bodies[0].profile: "},
        Bad{"profile_of_no_table", body(R"("material": "S235", "profile": "IPE 310")"),
            "bodies[0].profile: is in no table; there are IPE 80"},
        Bad{"profile_without_a_material", body(R"("profile": "IPE 300")"), "bodies[0].profile: "},
        Bad{"scale_of_a_ring", body(R"("scale": 2)"), "bodies[0].scale: "},
        Bad{"outline_number", outline("3"), "bodies[0].outline: "},
        Bad{"outline_without_id", outline("\"crane.svg\""), "bodies[0].outline: "},
        Bad{"circle_of_nothing", outline(R"({"circle": 0})"), "bodies[0].outline.circle: "},
        Bad{"square", outline(R"({"square": 1})"), "bodies[0].outline: has no \"circle\""},
        Bad{"holes_in_a_circle", outline(R"({"circle": 1})", R"(, "holes": [])"), "bodies[0].holes: "},
        Bad{"point", outline("[[0,0],[1],[1,1]]"), "bodies[0].outline[1]: "},
        Bad{"hole", body(R"("holes": [[0,0],[1,1]])"), "bodies[0].holes[0][0]: "},
        Bad{"split", body(R"("split": "automatic")"), "bodies[0].split: "},
        Bad{"split_pieces", body(R"("split": {"pieces": 0})"), "bodies[0].split.pieces: "},
        Bad{"split_half_pieces", body(R"("split": {"pieces": 2.5})"), "bodies[0].split.pieces: "},
        Bad{"split_along", body(R"("split": {"pieces": 2, "along": [[0,0]]})"), "bodies[0].split.along: "},
        Bad{"split_along_nothing", body(R"("split": {"pieces": 2, "along": [[1,0],[1,0]]})"),
            "bodies[0].split.along: "},
        Bad{"split_both", body(R"("split": {"pieces": 2, "cuts": []})"), "bodies[0].split: "},
        Bad{"split_neither", body(R"("split": {})"), "bodies[0].split: "},
        Bad{"group", body(R"("group": 40000)"), "bodies[0].group: "},
        Bad{"between_one", R"({"bodies": [], "joints": [{"between": ["a"]}]})", "joints[0].between: "},
        Bad{"between_missing", R"({"bodies": [], "joints": [{}]})", "joints[0]: has no \"between\""},
        Bad{"negative_moment", joint(R"("moment": -1)"), "joints[0].moment: "},
        Bad{"moment_beyond", joint(R"("moment": 1e31)"),
            "joints[0].moment: is 1e+31; write a number >= 0, not beyond 1e+30, or null for unlimited"},
        Bad{"depth_beyond", body(R"("depth": 1e31)"),
            "bodies[0].depth: is 1e+31; write a number > 0, not beyond 1e+30"},
        Bad{"angle_beyond", body(R"("angle": -1e300)"),
            "bodies[0].angle: is -1e+300; write a finite number, not beyond 1e+30"},
        Bad{"density_beyond", material(R"("density": 1e31, "E": 1, "fy": 1)"),
            "materials.steel.density: is 1e+31; write a number > 0, not beyond 1e+30"},
        Bad{"force_beyond", R"({"bodies": [], "loads": [{"body": "a", "at": [0,0], "force": [1e31,0]}]})",
            "loads[0].force[0]: is 1e+31; write a finite number, not beyond 1e+30"},
        Bad{"damping_ratio", R"({"bodies": [], "damping_ratio": -1})", "damping_ratio: "},
        Bad{"across_one_point", joint(R"("across": [[0,0]])"),
            "joints[0].across: is an array of 1; write two"},
        Bad{"elastic", joint(R"("elastic": "soft")"), "joints[0].elastic: "},
        Bad{"elastic_false", joint(R"("elastic": false)"), "joints[0].elastic: "},
        Bad{"elastic_of_nothing", joint(R"("elastic": {"damping_ratio": 1})"), "joints[0].elastic: "},
        Bad{"zero_hinge_length", joint(R"("hinge_length": 0)"), "joints[0].hinge_length: "},
        Bad{"fix_nothing", R"({"bodies": [], "supports": [{"body": "a", "at": [0,0], "fix": []}]})",
            "supports[0].fix: "},
        Bad{"stiffness_of_nothing",
            R"({"bodies": [], "supports": [{"body": "a", "at": [0,0], "stiffness": {}}]})",
            "supports[0].stiffness: "},
        Bad{"stiffness_below_zero",
            R"({"bodies": [], "supports": [{"body": "a", "at": [0,0], "stiffness": {"x": -1}}]})",
            "supports[0].stiffness.x: "},
        Bad{"stiffness_zero", body(R"("joint": {"stiffness_axial": 0})"),
            "bodies[0].joint.stiffness_axial: "},
        Bad{"velocities_flat", body(R"("velocities": [1, 2])"), "bodies[0].velocities[0]"},
        Bad{"fix_x_twice", R"({"bodies": [], "supports": [{"body": "a", "at": [0,0], "fix": ["x", "x"]}]})",
            "supports[0].fix[1]: stands twice"},
        Bad{"fix_z", R"({"bodies": [], "supports": [{"body": "a", "at": [0,0], "fix": ["z"]}]})",
            "supports[0].fix[0]: "},
        Bad{"load_nowhere", R"({"bodies": [], "loads": [{"body": "a", "force": [0,1]}]})",
            "loads[0]: has no \"at\""},
        Bad{"load_ramp", R"({"bodies": [], "loads": [{"body": "a", "at": [0,0], "ramp": -1}]})",
            "loads[0].ramp: "},
        Bad{"wheel_axis", R"({"bodies": [], "wheels": [{"between": ["a","b"], "at": [0,0], "axis": [0,0]}]})",
            "wheels[0].axis: "}),
    [](const auto& info) { return info.param.name; });

TEST(SceneFile, ProfilesMayBeNamed) {  // IPE 300 is 5381 mm² in EN 10365's tables
  const SceneDef scene = parse_scene(R"({"bodies": [
    {"name": "beam", "outline": [[0,0],[6,0],[6,0.3],[0,0.3]], "profile": "ipe 300", "material": "S355"}]})",
                                     "level.json", ".");
  ASSERT_EQ(scene.bodies[0].profile.size(), 1u);
  EXPECT_NEAR(Section(scene.bodies[0].profile).area(), 5381e-6, 0.5e-6);
  EXPECT_EQ(scene.bodies[0].profile[0].material, materials::S355);
}

// It is that of each material that does not state its own, where a body, a section or a profile has it.
TEST_F(SceneFolder, ADampingRatioOfTheSceneIsThatOfItsMaterials) {
  write("box.json", R"({"regions": [{"outer": [[0,0],[0.1,0],[0.1,1],[0,1]], "material": {"fy": 3e8}}]})");
  const auto body = [](const std::string& name, const std::string& rest) {
    return R"({"name": ")" + name + R"(", "outline": [[0,0],[4,0],[4,1],[0,1]], )" + rest + "}";
  };
  const std::string scene = R"({"damping_ratio": 0.2, "materials": {
      "steel": {"density": 7800, "E": 210e9, "fy": 350e6},
      "rubber": {"density": 1100, "E": 1e7, "fy": 1e7, "damping_ratio": 0.05}, "timber": "oak"},
    "bodies": [)" + body("a", R"("material": "steel")") +
                            "," + body("b", R"("material": "rubber")") + "," +
                            body("c", R"("material": "timber")") + "," +
                            body("d", R"("material": "S355", "profile": "box.json")") + "]}";
  const auto expect_ratios = [](const SceneDef& read) {
    ASSERT_EQ(read.bodies.size(), 4u);
    const double ratios[] = {0.2, 0.05, 0.2, 0.2};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(read.bodies[i].material->damping_ratio, ratios[i]) << i;
    EXPECT_EQ(read.bodies[3].profile[0].material.damping_ratio, 0.2);
  };
  const SceneDef read = parse_scene(scene, "scene", folder);
  expect_ratios(read);
  SceneDef changed = read;
  changed.bodies[0].depth = 0.3;
  const std::string edited = edited_scene(scene, changed, folder);
  EXPECT_NE(edited.find("\"damping_ratio\": 0.2"), std::string::npos) << edited;
  expect_ratios(parse_scene(edited, "scene", folder));
  const SceneDef written = parse_scene(scene_text(read));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(written.bodies[i].material, read.bodies[i].material) << i;
}

TEST(SceneFile, NamesAllProblemsAtOnce) {
  try {
    parse_scene(R"({"gravity": 1, "sleep": 2, "bodies": [{"name": 3, "outline": 4}]})", "bad.json");
    FAIL() << "should throw";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.problems().size(), 4u) << error.what();
  }
}

TEST(Text, OfGzipIsUnpacked) {  // RFC 1952: "hello" by GNU gzip, and the same cut off
  const std::string packed("\x1F\x8B\x08\0\0\0\0\0\0\x03\xCB\x48\xCD\xC9\xC9\x07\0\x86\xA6\x10\x36\x05\0\0\0",
                           25);
  const fs::path file = fs::temp_directory_path() / ("ductile_gzip_" + std::to_string(::getpid()));
  write_text(file, packed);
  EXPECT_EQ(read_text(file), "hello");
  write_text(file, packed.substr(0, 14));
  EXPECT_THROW(read_text(file), InvalidInput);
  fs::remove(file);
}

TEST(Text, IsWrittenWholeOrNotAtAll) {
  const fs::path folder = fs::temp_directory_path() / ("ductile_text_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  write_text(folder / "a", "one");
  fs::create_symlink("a", folder / "link");
  write_text(folder / "link", "two");
  EXPECT_EQ(read_text(folder / "a"), "two");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_ANY_THROW(write_text(folder / "missing" / "a", "three"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
  fs::remove_all(folder);
}
}  // namespace
