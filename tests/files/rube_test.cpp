// R.U.B.E. scenes: what we write, what we read, and that nothing gets lost on the way.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "../world_state.h"
#include "ductile/definitions.h"
#include "ductile/files.h"
#include "ductile/level.h"

namespace {
using namespace ductile;
using nlohmann::json;

json property(const json& item, const std::string& name) {
  for (const json& p : item.value("customProperties", json::array())) {
    if (p["name"] != name) continue;
    for (const char* type : {"float", "int", "string", "bool", "vec2"})
      if (p.contains(type)) return p[type];
  }
  return nullptr;
}

void add(json& item, json property) { item["customProperties"].push_back(std::move(property)); }

std::string error_of(const std::string& text) {
  try {
    b2World world({0, 0});
    load_text(world, text, "level.json");
    return "";
  } catch (const InvalidInput& error) {
    return error.what();
  }
}

/// An IEEE float as the editor writes it.
std::string hex(float value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08X", std::bit_cast<std::uint32_t>(value));
  return text;
}

// A level as an editor writes it, of someone who knows nothing of ductile: a wall, a plank of two planks
// welded on, a lamp on a rope, an image, and things that nobody here knows. Only materials are named in it.
constexpr double h = 0.5, depth = 0.2;
json level() {
  json scene = json::parse(R"({
    "allowSleep": true, "autoClearForces": true, "continuousPhysics": true, "gravity": {"x": 0, "y": -10},
    "stepsPerSecond": 60, "velocityIterations": 8, "positionIterations": 3, "warmStarting": true,
    "collisionbitplanes": {"names": ["a", "b"]},
    "body": [
      {"name": "wall", "type": 0, "position": 0, "awake": true,
       "fixture": [{"name": "f", "friction": 0.2, "polygon": {"vertices": {"x": [-1, 0, 0, -1], "y": [-1, -1, 1, 1]}}}]},
      {"name": "plank", "type": 2, "position": {"x": 2, "y": 0}, "angle": 0, "awake": true,
       "massData-mass": 3, "massData-I": 1, "path": "planks/first",
       "customProperties": [{"name": "ductile.material", "string": "S355"}, {"name": "ductile.depth", "float": 0.2},
                            {"name": "loot", "int": 7}],
       "fixture": [
         {"name": "left", "density": 1, "friction": 0.7, "filter-categoryBits": 2,
          "polygon": {"vertices": {"x": [-2, 0, 0, -2], "y": [0, 0, 0.5, 0.5]}}},
         {"name": "right", "density": 1, "friction": 0.7,
          "polygon": {"vertices": {"x": [0, 2, 2, 0], "y": [0, 0, 0.5, 0.5]}}}]},
      {"name": "lamp", "type": 2, "position": {"x": 4, "y": -1}, "awake": true, "linearDamping": 0.1,
       "massData-mass": 2, "massData-I": 0.25,
       "fixture": [{"density": 1, "circle": {"center": 0, "radius": 0.5}}]},
      {"type": 0, "position": {"x": 0, "y": -9},
       "fixture": [{"chain": {"vertices": {"x": [-50, 0, 50], "y": [1, 0, 1]}}}]}],
    "image": [{"body": 1, "file": "plank.png", "center": {"x": 0, "y": 0.25}, "opacity": 1}],
    "joint": [
      {"name": "root", "type": "weld", "bodyA": 0, "bodyB": 1, "anchorA": 0, "anchorB": {"x": -2, "y": 0},
       "dampingRatio": 0, "frequency": 0, "customProperties": [{"name": "sound", "string": "creak"}]},
      {"name": "rope", "type": "rope", "bodyA": 1, "bodyB": 2, "anchorA": {"x": 2, "y": 0}, "anchorB": 0,
       "maxLength": 1.5}]})");
  scene["body"][1]["position"]["x"] = hex(2);
  scene["body"][1]["fixture"][0]["friction"] = hex(0.7f);
  return scene;
}

// A beam of four pieces on a wall.
SceneDef beam_on_wall() {
  SceneDef scene;
  scene.bodies = {
      {.name = "wall", .type = BodyType::static_body, .outline = {{{-1, -1}, {0, -1}, {0, 2}, {-1, 2}}, {}}},
      {.name = "beam",
       .outline = {{{0, 0}, {8, 0}, {8, 1}, {0, 1}}, {}},
       .material = materials::oak,
       .pieces = 4}};
  scene.joints = {{.a = "wall", .b = "beam"}};
  return scene;
}

TEST(Rube, NamingAMaterialCalibratesAWeld) {
  const json scene = json::parse(calibrated_rube(level().dump()));
  const json& joint = scene["joint"][0];
  const double M = depth * h * h / 4 * 355e6;
  EXPECT_NEAR(property(joint, "ductile.M"), M, 1e-12 * M);
  EXPECT_NEAR(property(joint, "ductile.N"), depth * h * 355e6, 1e-12 * depth * h * 355e6);
  // A player without ductile gets a hinge that gives way at M.
  EXPECT_EQ(joint["type"], "revolute");
  EXPECT_EQ(joint["enableMotor"], true);
  EXPECT_NEAR(joint["maxMotorTorque"], M, 1e-6 * M);
  EXPECT_EQ(joint["anchorA"], (json{{"x", 0.0}, {"y", 0.25}}));  // the middle of the common edge
  EXPECT_EQ(joint["anchorB"], (json{{"x", -2.0}, {"y", 0.25}}));
  // What is made of steel weighs as much.
  const double m = 7850 * 4 * h * depth, centre = 0.25;
  EXPECT_NEAR(scene["body"][1]["massData-mass"], m, 1e-6 * m);
  EXPECT_NEAR(scene["body"][1]["massData-I"], m * ((16 + h * h) / 12 + centre * centre), 1e-5 * m);
}

/// Takes out of `scene` what calibration may change of it.
json without(json scene, const std::vector<std::string>& pointers) {
  for (const std::string& pointer : pointers) {
    const json::json_pointer at(pointer);
    if (scene.contains(at)) scene[at.parent_pointer()].erase(at.back());
  }
  for (json& joint : scene["joint"]) {
    json kept = json::array();
    for (const json& p : joint.value("customProperties", json::array()))
      if (!p["name"].get<std::string>().starts_with("ductile.")) kept.push_back(p);
    if (!kept.empty()) joint["customProperties"] = kept;
  }
  return scene;
}

TEST(Rube, EverythingElseStaysAsItWas) {
  const std::vector<std::string> changed{"/body/1/massData-mass",     "/body/1/massData-I",
                                         "/body/1/massData-center",   "/joint/0/type",
                                         "/joint/0/anchorA",          "/joint/0/anchorB",
                                         "/joint/0/refAngle",         "/joint/0/enableMotor",
                                         "/joint/0/motorSpeed",       "/joint/0/maxMotorTorque",
                                         "/joint/0/enableLimit",      "/joint/0/lowerLimit",
                                         "/joint/0/upperLimit",       "/joint/0/jointSpeed",
                                         "/body/1/fixture/0/density", "/body/1/fixture/1/density"};
  const json before = level(), after = json::parse(calibrated_rube(before.dump()));
  EXPECT_EQ(without(after, changed), without(before, changed));
}

TEST(Rube, ACalibratedSceneStaysAsItIs) {
  const std::string once = calibrated_rube(level().dump());
  EXPECT_EQ(json::parse(calibrated_rube(once)), json::parse(once));
}

TEST(Rube, LoadsWithDuctileJointsAndEverythingElse) {
  b2World world({0, 0});
  Level level = load_text(world, ::level().dump());
  EXPECT_EQ(world.GetGravity(), b2Vec2(0, -10));
  EXPECT_EQ(level.bodies.size(), 4u);
  EXPECT_EQ(world.GetJointCount(), 2);
  ASSERT_EQ(level.structure.joints().size(), 1u);
  EXPECT_EQ(level.joints.find("root")->second, level.structure.joints()[0]);
  EXPECT_EQ(level.joints.find("rope")->second->GetType(), e_distanceJoint);
  b2Body* lamp = level.bodies.find("lamp")->second;
  EXPECT_FLOAT_EQ(lamp->GetLinearDamping(), 0.1f);
  EXPECT_FLOAT_EQ(lamp->GetMass(), 2);
  EXPECT_EQ(level.bodies.find("plank")->second->GetFixtureList()->GetNext()->GetFilterData().categoryBits, 2);
  for (int i = 0; i < 1200; ++i) {
    world.Step(1 / 60.0f, 8, 3);
    level.structure.update();
  }
  // The rope's lamp and the plank's weight at the root.
  const double moment = 10 * (7850 * 4 * h * depth * 2 + 2 * 4);
  // The rope is a stock joint: what it pulls after the structure's last solve of a step is not in its moment,
  // a share of the lamp's 2.4 %.
  EXPECT_NEAR(-level.structure.joints()[0]->force(rotation) / moment, 1, 0.015);
}

TEST(Rube, SplitsABodyAndTellsWhatWasFixedToIt) {
  json scene = level();
  scene["body"][1]["customProperties"].push_back({{"name", "ductile.pieces"}, {"int", 4}});
  const json after = json::parse(calibrated_rube(scene.dump()));
  ASSERT_EQ(after["body"].size(), 7u);
  ASSERT_EQ(after["joint"].size(), 5u);
  EXPECT_EQ(after["body"][1]["name"], "plank/0");
  EXPECT_EQ(after["body"][4]["name"], "plank/1");
  EXPECT_EQ(after["body"][6]["name"], "plank/3");
  EXPECT_EQ(after["joint"][0]["bodyB"], 1);
  EXPECT_EQ(after["joint"][1]["bodyA"], 6);  // the rope hangs on the tip
  EXPECT_EQ(after["joint"][1]["anchorA"], scene["joint"][1]["anchorA"]);
  EXPECT_EQ(property(after["body"][6], "loot"), 7);
  EXPECT_TRUE(property(after["body"][6], "ductile.pieces").is_null());
  EXPECT_EQ(after["body"][6]["fixture"][0]["filter-categoryBits"], 2);
  b2World world({0, 0});
  Level level = load_text(world, scene.dump());
  EXPECT_EQ(level.structure.joints().size(), 4u);
  EXPECT_NEAR(level.bodies.find("plank/3")->second->GetWorldCenter().x, 3.5, 1e-6);
  EXPECT_NEAR(level.bodies.find("plank/3")->second->GetMass(), 7850 * h * depth, 0.01);
}

TEST(Rube, AFlagSaysWhichJointsAreDuctile) {
  json scene = level();
  scene["joint"][0]["customProperties"].push_back({{"name", "ductile.calibrate"}, {"bool", false}});
  EXPECT_EQ(json::parse(calibrated_rube(scene.dump()))["joint"], scene["joint"]);
  scene["joint"][0]["customProperties"].back()["bool"] = true;
  scene["joint"][0]["type"] = "revolute";  // as if it were a weld
  scene["joint"][0]["customProperties"].push_back({{"name", "ductile.moment"}, {"float", 5e5}});
  const json after = json::parse(calibrated_rube(scene.dump()));
  EXPECT_EQ(property(after["joint"][0], "ductile.M"), 5e5);
}

// The section at a joint is that of the plank, 0.5 m high, wherever the bodies stand to one another.
TEST(Rube, BodiesThatOverlapOrStandApartAreJoinedAcrossTheSmallerOne) {
  const double M = depth * h * h / 4 * 355e6;
  for (const double x : {2 - 0.3, 2 + 0.004, 2 + 0.3}) {
    json scene = level();
    scene["body"][1]["position"] = {{"x", x}, {"y", 0}};
    scene["joint"][0]["anchorA"] = {{"x", 0}, {"y", 0.25}};
    const json joint = json::parse(calibrated_rube(scene.dump()))["joint"][0];
    EXPECT_NEAR(property(joint, "ductile.M"), M, 1e-6 * M) << x;
    EXPECT_NEAR(property(joint, "ductile.height"), h, 1e-6) << x;
    EXPECT_NEAR(property(joint, "ductile.axis")["x"], 1, 1e-6) << x;
  }
  // Two welds of one pair: each has its section, here at the plank's end and 1 m from it.
  json scene = level();
  scene["body"][1]["position"] = {{"x", 1}, {"y", 0}};
  scene["joint"].push_back(scene["joint"][0]);
  scene["joint"][0]["anchorA"] = {{"x", -1}, {"y", 0.25}};
  scene["joint"][2]["anchorA"] = {{"x", 0}, {"y", 0.25}};
  const json joints = json::parse(calibrated_rube(scene.dump()))["joint"];
  ASSERT_EQ(joints.size(), 3u);
  for (const int i : {0, 2}) EXPECT_NEAR(property(joints[i], "ductile.M"), M, 1e-6 * M) << i;
  EXPECT_NEAR(joints[2]["anchorA"]["x"], 0, 1e-6);
  EXPECT_NEAR(joints[2]["anchorA"]["y"], h / 2, 1e-6);
}

// A tee: its web, 0.2 m wide and 1 m long, hangs on the ceiling; the flange is a fixture of its own, which
// overlaps the web.
TEST(Rube, ABodyOfSeveralFixturesHasTheSectionAtItsAnchor) {
  json scene = level();
  scene["body"][1]["position"] = 0;
  const auto box = [](double x0, double x1, double y0, double y1) {
    return json{{"density", 1},
                {"polygon", {{"vertices", {{"x", {x0, x1, x1, x0}}, {"y", {y0, y0, y1, y1}}}}}}};
  };
  scene["body"][1]["fixture"] = {box(-0.1, 0.1, -2, -0.9), box(-1, 1, -2.2, -1.9)};
  scene["joint"][0]["anchorA"] = scene["joint"][0]["anchorB"] = {{"x", 0}, {"y", -1}};
  const double N = depth * 0.2 * 355e6, mass = 7850 * depth * (0.2 * 1 + 2 * 0.3);
  const json after = json::parse(calibrated_rube(scene.dump()));
  EXPECT_NEAR(property(after["joint"][0], "ductile.N"), N, 1e-6 * N);
  EXPECT_NEAR(after["body"][1]["massData-mass"], mass, 1e-6 * mass);
  // Two fixtures that do not touch are one rigid body of both.
  scene["body"][1]["fixture"][1] = box(-1, 1, -2.5, -2.2);
  const double apart = 7850 * depth * (0.2 * 1.1 + 2 * 0.3);
  EXPECT_NEAR(json::parse(calibrated_rube(scene.dump()))["body"][1]["massData-mass"], apart, 1e-6 * apart);
  b2World world({0, 0});
  EXPECT_NEAR(load_text(world, scene.dump()).bodies.find("plank")->second->GetMass(), apart, 1e-6 * apart);
}

TEST(Rube, ARevoluteJointIsAPinAtItsAnchor) {
  json scene = level();
  json& joint = scene["joint"][0];
  joint["type"] = "revolute";
  joint["anchorA"] = {{"x", 0}, {"y", 0.1}};
  joint["anchorB"] = {{"x", -2}, {"y", 0.1}};
  const double N = depth * h * 355e6;
  json after = json::parse(calibrated_rube(scene.dump()))["joint"][0];
  EXPECT_EQ(property(after, "ductile.M"), 0);
  EXPECT_NEAR(property(after, "ductile.N"), N, 1e-6 * N);
  EXPECT_EQ(after["type"], "revolute");
  EXPECT_NEAR(after["anchorA"]["y"], 0.1, 1e-6);
  EXPECT_NEAR(after["anchorB"]["x"], -2, 1e-6);
  // A motor that only brakes is its plastic moment, and never wears out.
  joint["enableMotor"] = true;
  joint["maxMotorTorque"] = 700;
  after = json::parse(calibrated_rube(scene.dump()))["joint"][0];
  EXPECT_EQ(property(after, "ductile.M"), 700);
  EXPECT_EQ(property(after, "ductile.max_rotation"), "unlimited");
  EXPECT_EQ(after["maxMotorTorque"], 700);
  // What drives and limits joints is no matter of material.
  for (const auto& [key, value] : {std::pair<const char*, json>{"motorSpeed", 1}, {"enableLimit", true}}) {
    json driven = scene;
    driven["joint"][0][key] = value;
    EXPECT_EQ(json::parse(calibrated_rube(driven.dump()))["joint"], driven["joint"]) << key;
  }
}

// A load at a corner, of bars whose pieces' vertices are no floats: a level holds the one in double, the
// others not.
TEST(Rube, LoadsAtCornersStandOnTheirBodies) {
  for (const double length : {1.0, 4.0, 7.3, 20.0}) {
    for (const int pieces : {3, 5, 10, 11, 12}) {
      SceneDef scene = beam_on_wall();
      scene.bodies[1].outline = {{{0, 0}, {length, 0}, {length, 1}, {0, 1}}, {}};
      scene.bodies[1].pieces = pieces;
      scene.loads = {{.body = "beam", .at = {length, 1}, .force = {0, -1}}};
      const Plan read = parse_plan(rube_text(calibrate(scene)));
      ASSERT_EQ(read.loads.size(), 1u) << length << ", " << pieces;
      EXPECT_NEAR(read.loads[0].at.x, length, 1e-6 * length);
    }
  }
}

TEST(Rube, LoadsAreProperties) {
  SceneDef scene = beam_on_wall();
  scene.gravity_ramp = 2;
  scene.loads = {{.body = "beam", .at = {7.5, 1}, .force = {3, -4}, .from = 1, .ramp = 2, .to = 9},
                 {.body = "beam", .at = {1, 0.5}, .moment = 5}};
  const Plan written = calibrate(scene), read = parse_plan(rube_text(written));
  EXPECT_EQ(read.gravity_ramp, 2);
  ASSERT_EQ(read.loads.size(), 2u);
  for (const Plan::Load& load : written.loads) {  // they stand with their bodies
    const auto same = std::find_if(read.loads.begin(), read.loads.end(),
                                   [&](const Plan::Load& l) { return l.piece == load.piece; });
    ASSERT_NE(same, read.loads.end());
    EXPECT_NEAR(same->at.x, load.at.x, 1e-6);
    EXPECT_NEAR(same->at.y, load.at.y, 1e-6);
    EXPECT_EQ(same->def.force, load.def.force);
    EXPECT_EQ(same->def.moment, load.def.moment);
    EXPECT_EQ(same->def.from, load.def.from);
    EXPECT_EQ(same->def.ramp, load.def.ramp);
    EXPECT_EQ(same->def.to, load.def.to);
  }
  // A body that is split takes each load to the piece under it.
  json split = level();
  add(split["body"][1], {{"name", "ductile.pieces"}, {"int", 4}});
  add(split["body"][1], {{"name", "ductile.loads"}, {"string", R"([{"at": [1.5, 0.5], "force": [0, -9]}])"}});
  const std::string once = calibrated_rube(split.dump());
  EXPECT_EQ(calibrated_rube(once), once);
  const Plan plan = parse_plan(once);
  ASSERT_EQ(plan.loads.size(), 1u);
  EXPECT_EQ(plan.pieces[static_cast<std::size_t>(plan.loads[0].piece)].name, "plank/3");
}

TEST(Rube, JointsThatYieldAreHingesOrWelds) {
  const std::string text = level().dump();
  const json hinge = json::parse(calibrated_rube(text))["joint"][0],
             weld = json::parse(calibrated_rube(text, "level", StockJoint::weld))["joint"][0];
  EXPECT_EQ(hinge["type"], "revolute");
  EXPECT_EQ(weld["type"], "weld");
  EXPECT_GT(weld["frequency"], 0);
  EXPECT_EQ(property(hinge, "ductile.M"), property(weld, "ductile.M"));
}

TEST(Rube, WhatALevelDoesNotHaveIsNotWritten) {
  const json nothing = json::parse(R"({"gravity": {"x": 0, "y": -10}, "stepsPerSecond": 60})");
  EXPECT_EQ(json::parse(calibrated_rube(nothing.dump())), nothing);
  json bodies = level();
  bodies.erase("joint");
  bodies.erase("image");
  EXPECT_EQ(json::parse(calibrated_rube(bodies.dump())), bodies);
}

class WhatWeWrite : public testing::TestWithParam<const char*> {};

// Read back, it is the world that build() makes. With an N-M polygon that is cut from the pieces' sections
// anew, numbers agree to rounding only.
TEST_P(WhatWeWrite, LoadsAsTheSameWorld) {
  const Plan plan =
      calibrate(read_scene(std::string(DUCTILE_SOURCE_DIR "/scenes/") + GetParam() + ".scene.json"));
  const std::string text = rube_text(plan);
  EXPECT_EQ(json::parse(calibrated_rube(text)), json::parse(text));
  b2World world({static_cast<float>(plan.gravity.x), static_cast<float>(plan.gravity.y)}), copy({0, 0});
  Structure structure = build(world, plan);
  Level level = load_text(copy, text);
  ASSERT_EQ(level.structure.joints().size(), structure.joints().size());
  ASSERT_EQ(world_state(copy), world_state(world));
  for (int i = 0; i < 120; ++i) {
    for (b2World* w : {&world, &copy}) w->Step(1 / 60.0f, 8, 3);
    structure.update();
    level.structure.update();
    const std::vector<float> a = world_state(world), b = world_state(copy);
    if (!plan.interaction) {
      ASSERT_EQ(b, a) << "step " << i;
    }
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(b[k], a[k], 1e-3) << "step " << i;
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, WhatWeWrite, testing::Values("car", "frame", "cantilever", "harbour_crane"),
                         [](const auto& info) { return std::string(info.param); });

// A beam that yields under its own weight, of a steel whose caps grow with the rate.
TEST(Rube, TheRateLawSurvives) {
  SceneDef scene = beam_on_wall();
  Material& steel = scene.bodies[1].material.emplace(materials::S355);
  steel.yield_stress = 8e6;  // of the 9.9 MPa at which b h² f_y/4 = 7850 kg/m³ g b h L²/2
  steel.rate_D = 40;
  steel.rate_q = 4;
  const Plan plan = calibrate(scene);
  const std::string text = rube_text(plan);
  EXPECT_EQ(json::parse(calibrated_rube(text)), json::parse(text));
  const b2Vec2 gravity{static_cast<float>(plan.gravity.x), static_cast<float>(plan.gravity.y)};
  b2World world(gravity), copy({0, 0});
  Structure structure = build(world, plan);
  Level level = load_text(copy, text);
  ASSERT_EQ(level.structure.joints().size(), structure.joints().size());
  for (std::size_t i = 0; i < structure.joints().size(); ++i) {
    const auto def = structure.joints()[i]->def(), read = level.structure.joints()[i]->def();
    ASSERT_TRUE(def.rate && read.rate);
    for (const Row row : {axial, shear, rotation})
      EXPECT_EQ(read.rate->doubling[row], def.rate->doubling[row]);
    EXPECT_EQ(read.rate->exponent, 4);
  }
  for (int i = 0; i < 60; ++i) {
    for (b2World* w : {&world, &copy}) w->Step(1 / 60.0f, 8, 3);
    structure.update();
    level.structure.update();
  }
  EXPECT_GT(structure.joints().back()->dissipated(), 0);  // at the wall
  EXPECT_EQ(world_state(copy), world_state(world));

  json both = json::parse(text);
  add(both, {{"name", "ductile.interaction"}, {"bool", true}});
  EXPECT_NE(error_of(both.dump()).find("joint[0]: depends on the rate of strain"), std::string::npos);
  json negative = json::parse(text);
  std::string place;
  json& properties = negative["joint"][0]["customProperties"];
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i]["name"] != "ductile.rate_D_M") continue;
    properties[i]["float"] = -1;
    place = "joint[0].customProperties[" + std::to_string(i) + "].float: is -1";
  }
  ASSERT_FALSE(place.empty());
  EXPECT_NE(error_of(negative.dump()).find(place), std::string::npos);
}

// The two last of four pieces of a beam, as one rigid body.
TEST(Rube, PiecesThatShareABodyAreOne) {
  Plan plan = calibrate(beam_on_wall());
  Piece& third = plan.pieces[3];
  ASSERT_EQ(third.name, "beam/2");
  plan.pieces[4].part_of = 3;
  third.mass *= 2;
  third.center.x += 1;
  third.inertia = third.mass * (4 * 4 + 1) / 12;
  std::erase_if(plan.joints, [](const PlannedJoint& j) { return j.name == "beam/2-beam/3"; });

  const std::string text = rube_text(plan);
  EXPECT_EQ(json::parse(text)["body"].size(), 4u);
  EXPECT_EQ(json::parse(box2d_text(plan))["bodies"].size(), 4u);
  b2World world({0, -9.81f}), copy({0, 0});
  Structure structure = build(world, plan);
  Level level = load_text(copy, text);
  EXPECT_EQ(level.plan.pieces.size(), 4u);
  double low = 8, high = 0;
  for (const Point& p : level.plan.pieces[3].outline.outer) {
    low = std::min(low, p.x);
    high = std::max(high, p.x);
  }
  EXPECT_NEAR(low, 4, 1e-6);
  EXPECT_NEAR(high, 8, 1e-6);
  for (int i = 0; i < 60; ++i) {
    for (b2World* w : {&world, &copy}) w->Step(1 / 60.0f, 8, 3);
    structure.update();
    level.structure.update();
    ASSERT_EQ(world_state(copy), world_state(world)) << "step " << i;
  }
}

TEST(Rube, SupportsAndProfilesSurvive) {
  SceneDef scene;
  scene.bodies = {{.name = "beam",
                   .outline = {{{0, 0}, {4, 0}, {4, 0.2}, {0, 0.2}}, {}},
                   .material = Material{.yield_stress = 300e6, .youngs_modulus = 200e9, .density = 7000},
                   .profile = {{{{{0, 0}, {0.1, 0}, {0.1, 0.2}, {0, 0.2}}, {}}, materials::S235}},
                   .pieces = 2}};
  scene.supports = {{.body = "beam", .at = {0, 0.1}, .fix_x = true, .fix_y = true},
                    {.body = "beam", .at = {4, 0.1}, .fix_y = true}};
  const Plan plan = calibrate(scene);
  b2World world({0, 0});
  const Level level = load_text(world, rube_text(plan));
  ASSERT_EQ(level.plan.joints.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const PlannedJoint &read = level.plan.joints[i], &written = plan.joints[i];
    EXPECT_EQ(read.name, written.name);
    EXPECT_EQ(read.a, written.a);
    EXPECT_EQ(read.b, written.b);
    EXPECT_EQ(read.M, written.M);
    EXPECT_EQ(read.N, written.N);
    EXPECT_EQ(read.stiffness.M, written.stiffness.M);
    EXPECT_EQ(read.max_rotation, written.max_rotation);
    EXPECT_EQ(level.plan.reasons[static_cast<std::size_t>(read.governed_by)],
              plan.reasons[static_cast<std::size_t>(written.governed_by)]);
  }
  EXPECT_NEAR(section_at(level.plan, level.plan.joints[0], 0)->capacities({0, -1}).M, plan.joints[0].M, 1);
}

// --- what is wrong with a file ---

TEST(Rube, AWrongIndexIsOneError) {
  for (const json& wrong : {json(7), json(1.5)}) {
    json scene = level();
    scene["joint"][0]["bodyB"] = wrong;
    const std::string error = error_of(scene.dump());
    EXPECT_NE(error.find("joint[0].bodyB: is " + wrong.dump()), std::string::npos) << error;
    EXPECT_EQ(error.find("to itself"), std::string::npos) << error;
  }
}

struct Spoilt {
  const char* name;
  std::function<void(json&)> spoil;
  const char* saying;
};
class SpoiltRube : public testing::TestWithParam<Spoilt> {};

TEST_P(SpoiltRube, SaysWhatAndWhere) {
  json scene = level();
  GetParam().spoil(scene);
  const std::string error = error_of(scene.dump());
  EXPECT_EQ(error.find("level.json:"), 0u) << error;
  EXPECT_NE(error.find(GetParam().saying), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(
    Files, SpoiltRube,
    testing::Values(
        Spoilt{"no_such_body", [](json& s) { s["joint"][0]["bodyB"] = 9; }, "joint[0].bodyB"},
        Spoilt{"negative_body", [](json& s) { s["joint"][1]["bodyA"] = -1; }, "joint[1].bodyA"},
        Spoilt{"to_itself", [](json& s) { s["joint"][0]["bodyB"] = 0; }, "joint[0]: joins body 0 to itself"},
        Spoilt{"unknown_joint", [](json& s) { s["joint"][1]["type"] = "glue"; }, "\"glue\""},
        Spoilt{"hex_of_seven", [](json& s) { s["body"][1]["angle"] = "3F80000"; }, "body[1].angle"},
        Spoilt{"hex_of_infinity", [](json& s) { s["body"][1]["angle"] = "7F800000"; }, "body[1].angle"},
        Spoilt{"beyond_float", [](json& s) { s["body"][1]["angle"] = 1e39; }, "body[1].angle"},
        Spoilt{"no_vector", [](json& s) { s["body"][1]["position"] = 5; }, "body[1].position"},
        Spoilt{"body_is_no_list", [](json& s) { s["body"] = 5; }, "body"},
        Spoilt{"body_is_no_object", [](json& s) { s["body"][0] = 5; }, "body[0]"},
        Spoilt{"more_x_than_y",
               [](json& s) { s["body"][0]["fixture"][0]["polygon"]["vertices"]["x"].push_back(1); },
               "body[0].fixture[0].polygon.vertices"},
        Spoilt{"no_shape", [](json& s) { s["body"][0]["fixture"][0].erase("polygon"); },
               "body[0].fixture[0]"},
        Spoilt{"chain_without_vertices",
               [](json& s) {
                 s["body"][0]["fixture"][0].erase("polygon");
                 s["body"][0]["fixture"][0]["chain"] = {
                     {"vertices", {{"x", json::array()}, {"y", json::array()}}}};
               },
               "body[0].fixture[0].chain: has no vertices"},
        Spoilt{"unknown_material", [](json& s) { s["body"][1]["customProperties"][0]["string"] = "cheese"; },
               "cheese"},
        Spoilt{"material_is_a_number",
               [](json& s) {
                 s["body"][1]["customProperties"][0] = {{"name", "ductile.material"}, {"int", 1}};
               },
               "ductile.material"},
        Spoilt{"two_depths",
               [](json& s) {
                 add(s["body"][1], {{"name", "ductile.depth"}, {"float", 0.1}});
               },
               "body[1].customProperties[3]: is \"ductile.depth\" once more; keep one of them"},
        Spoilt{"no_depth", [](json& s) { s["body"][1]["customProperties"][1]["float"] = 0; }, "body[1]"},
        Spoilt{"a_body_without_shape",
               [](json& s) {
                 s["body"][1].erase("fixture");
                 add(s["joint"][0], {{"name", "ductile.calibrate"}, {"bool", true}});
               },
               "joint[0]: joins a body without a shape"},
        Spoilt{"pieces_of_two_parts",
               [](json& s) {
                 s["body"][1]["fixture"][1]["polygon"]["vertices"]["x"] = {0.5, 2, 2, 0.5};
                 add(s["body"][1], {{"name", "ductile.pieces"}, {"int", 3}});
               },
               "body[1]: is in several parts already"},
        Spoilt{"a_load_beside_its_body",
               [](json& s) {
                 add(s["body"][1], {{"name", "ductile.loads"}, {"string", R"([{"at": [0, 9]}])"}});
               },
               "load 0"},
        Spoilt{"axis_of_nothing", [](json& s) { s["joint"][1]["type"] = "prismatic"; },
               "joint[1]: has no axis"},
        Spoilt{"gear_of_ropes",
               [](json& s) {
                 s["joint"].push_back(
                     {{"type", "gear"}, {"bodyA", 1}, {"bodyB", 2}, {"joint1", 1}, {"joint2", 1}});
               },
               "joint[2]"},
        Spoilt{"gear_that_turns_what_stands",  // bodyB of what is geared is what a gear of Box2D turns
               [](json& s) {
                 s["joint"].push_back({{"type", "revolute"}, {"bodyA", 2}, {"bodyB", 3}});
                 s["joint"].push_back(
                     {{"type", "gear"}, {"bodyA", 2}, {"bodyB", 2}, {"joint1", 2}, {"joint2", 2}});
                 s["joint"][3]["bodyB"] = 1;
               },
               "joint[3]: gears a joint whose bodyB is not dynamic"},
        Spoilt{"inertia_below_zero",
               [](json& s) {
                 s["body"][2]["massData-center"] = {{"x", 9}, {"y", 0}};
               },
               "massData-I"},
        Spoilt{"thin_fixture",
               [](json& s) {
                 s["body"].push_back(s["body"][0]);
                 s["body"][4]["fixture"][0]["polygon"]["vertices"]["x"] = {0, 1e-4, 1e-4, 0};
               },
               "body[4].fixture[0]"},
        Spoilt{"value_without_axis",
               [](json& s) {
                 add(s["joint"][0], {{"name", "ductile.M"}, {"float", 5}});
               },
               "ductile.axis"},
        Spoilt{
            "body_property_with_a_slip",
            [](json& s) {
              add(s["body"][1], {{"name", "ductile.depht"}, {"float", 0.1}});
            },
            R"(customProperties[3]: is "ductile.depht", which no body has; write "ductile." and one of: E, )"},
        Spoilt{"material_named_and_described",
               [](json& s) {
                 add(s["body"][1], {{"name", "ductile.fu"}, {"float", 5e8}});
               },
               R"(body[1]: has "ductile.fu" beside "ductile.material"; write one or the other)"},
        Spoilt{"material_without_strength",
               [](json& s) {
                 add(s["body"][2], {{"name", "ductile.E"}, {"float", 2e11}});
               },
               R"(body[2]: has "ductile.E" without "ductile.fy"; give that, too, or a "ductile.material")"},
        Spoilt{"joint_property_on_a_body",
               [](json& s) {
                 add(s["body"][0], {{"name", "ductile.moment"}, {"float", 5}});
               },
               R"(body[0].customProperties[0]: is "ductile.moment", which no body has)"},
        Spoilt{"joint_property_with_a_slip",
               [](json& s) {
                 add(s["joint"][1], {{"name", "ductile.shear_spam"}, {"float", 5}});
               },
               R"(joint[1].customProperties[0]: is "ductile.shear_spam", which no joint has)"},
        Spoilt{"world_property_with_a_slip",
               [](json& s) {
                 add(s, {{"name", "ductile.target"}, {"float", 5}});
               },
               R"(customProperties[0]: is "ductile.target", which no world has)"},
        Spoilt{"body_property_on_a_fixture",
               [](json& s) {
                 add(s["body"][0]["fixture"][0], {{"name", "ductile.material"}, {"string", "oak"}});
               },
               "fixture[0].customProperties[0]: is \"ductile.material\", which no fixture has; give it to "
               "the body"}),
    [](const auto& info) { return info.param.name; });

/// What commands run of a level: a box of 0.6 m × 1 m that falls from its centre's height of 2 m.
// A plan of a level brings all of it into the world.

Plan falling_on(const std::string& ground, const std::string& more = "") {
  return parse_plan(R"({"gravity": {"x": 0, "y": -10}, "body": [
      {"name": "ground", "type": 0, "position": 0, "fixture": [)" +
                    ground + R"(]},
      {"name": "box", "type": 2, "position": {"x": 0, "y": 2}, "massData-mass": 3, "massData-I": 0.34)" +
                    more + R"(,
       "fixture": [{"density": 5, "polygon": {"vertices": {"x": [-0.3, 0.3, 0.3, -0.3], "y": [-0.5, -0.5, 0.5, 0.5]}}}]}]})");
}

TEST(Rube, SaysEachProblemOnce) {
  for (const auto& spoil :
       {+[](json& s) {
          s["body"][1]["customProperties"][0] = {{"name", "ductile.material"}, {"float", 1}};
        },
        +[](json& s) { s["body"] = json::object(); }}) {
    json scene = level();
    spoil(scene);
    std::istringstream lines(error_of(scene.dump()));
    std::set<std::string> said;
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(said.insert(line).second) << line;
    EXPECT_FALSE(said.empty());
  }
}

TEST(Plan, ChainsEdgesAndOverlappingFixturesAreGround) {
  for (const char* ground : {R"({"chain": {"vertices": {"x": [10, -10], "y": [0, 0]}}})",
                             R"({"chain": {"vertices": {"x": [-10, 10], "y": [0, 0]}}})",
                             R"({"chain": {"vertices": {"x": [-10, -3, 3, 10], "y": [4, 0, 0, 4]}}})",
                             R"({"loop": {"vertices": {"x": [-10, 10, 10, -10], "y": [0, 0, 9, 9]}}})",
                             R"({"edge": {"vertex1": {"x": -10, "y": 0}, "vertex2": {"x": 10, "y": 0}}})",
                             R"({"polygon": {"vertices": {"x": [-5, 1, 1, -5], "y": [-1, -1, 0, 0]}}},
                                {"polygon": {"vertices": {"x": [-1, 5, 5, -1], "y": [-2, -2, 0, 0]}}})",
                             R"({"polygon": {"vertices": {"x": [-5, -0.1, -0.1, -5], "y": [-1, -1, 0, 0]}}},
                                {"polygon": {"vertices": {"x": [0.1, 5, 5, 0.1], "y": [-1, -1, 0, 0]}}})"}) {
    const Plan plan = falling_on(ground);
    EXPECT_GE(plan.pieces.size(), 2u) << "the ground is drawn: " << ground;
    b2World world({0, 0});
    Built built;
    const Structure structure = build(world, plan, {}, &built);
    for (int i = 0; i < 180; ++i) world.Step(1 / 60.f, 8, 3);
    EXPECT_NEAR(built.bodies.back()->GetPosition().y, 0.5, 0.02) << ground;  // within Box2D's slop
  }
}

TEST(Plan, ABodyOfFixedRotationDoesNotTurn) {
  const Plan plan = falling_on(R"({"polygon": {"vertices": {"x": [0.2, 5, 5, 0.2], "y": [-1, -1, 0, 0]}}})",
                               R"(, "fixedRotation": true)");
  b2World world({0, 0});
  const Built built = build_stock(world, plan);
  for (int i = 0; i < 60; ++i) world.Step(1 / 60.f, 8, 3);
  EXPECT_EQ(built.bodies.back()->GetAngle(), 0);
  EXPECT_NEAR(built.bodies.back()->GetPosition().y, 0.5,
              0.02);  // on the ground's corner, 0.2 m off its centre
}

TEST(Plan, BringsRopesSensorsAndTurnedBodiesAlong) {
  json scene = level();
  scene["body"][1]["fixture"].push_back(
      {{"sensor", true}, {"circle", {{"center", 0}, {"radius", 9}}}, {"name", "near"}});
  // Turned by 180 degrees about the origin of the world, and gravity with it: all is as before.
  json turned = scene;
  turned["gravity"] = {{"x", 0}, {"y", 10}};
  for (json& body : turned["body"]) {
    if (body["position"].is_object()) {
      body["position"]["x"] =
          -(body["position"]["x"].is_string() ? 2.0 : body["position"]["x"].get<double>());
      body["position"]["y"] = -body["position"]["y"].get<double>();
    }
    body["angle"] = 3.14159265;
  }
  for (const bool stock : {false, true}) {
    std::array<Point, 2> lamp;
    for (const int way : {0, 1}) {
      std::vector<Problem> beyond;
      const Plan plan = parse_plan((way ? turned : scene).dump(), "level.json", ".", &beyond);
      EXPECT_EQ(beyond.size(), 1u);  // the rope
      b2World world({0, 0});
      Built built;
      std::optional<Structure> structure;
      if (stock)
        built = build_stock(world, plan);
      else
        structure.emplace(build(world, plan, {}, &built));
      EXPECT_EQ(world.GetJointCount(), 2);
      EXPECT_EQ(structure ? structure->joints().size() : 0, stock ? 0u : 1u);
      for (int i = 0; i < 600; ++i) {
        world.Step(1 / 60.f, 8, 3);
        if (structure) structure->update();
      }
      const b2Vec2 at = built.bodies[2]->GetPosition();
      lamp[static_cast<std::size_t>(way)] = way ? Point{-at.x, -at.y} : Point{at.x, at.y};
    }
    EXPECT_NEAR(lamp[0].x, 4, 0.05) << stock;
    EXPECT_NEAR(lamp[0].y, -1.5, 0.05) << stock;  // the rope's length below the plank's tip
    EXPECT_NEAR(lamp[1].x, lamp[0].x, 1e-3) << stock;
    EXPECT_NEAR(lamp[1].y, lamp[0].y, 1e-3) << stock;
  }
}

TEST(Rube, AProjectOfTheEditorIsToldAsSuch) {
  EXPECT_NE(error_of(R"({"metaworld": {"metabody": []}})").find("is a project of the R.U.B.E. editor"),
            std::string::npos);
}

TEST(Level, OfASceneFileAndItsDrawing) {
  b2World world({0, 0});
  Level level = load(world, DUCTILE_SOURCE_DIR "/scenes/harbour_crane.scene.json");
  EXPECT_EQ(level.structure.joints().size(), 19u);
  EXPECT_NE(level.bodies.find("jib/3"), level.bodies.end());
  EXPECT_EQ(world.GetGravity(), b2Vec2(0, -9.81f));
}

TEST(Level, AFailureLeavesTheWorldAlone) {
  json scene = level();
  scene["joint"][1]["type"] = "glue";
  b2World world({1, 2});
  EXPECT_THROW(load_text(world, scene.dump()), InvalidInput);
  EXPECT_EQ(world.GetBodyCount(), 0);
  EXPECT_EQ(world.GetGravity(), b2Vec2(1, 2));
}
}  // namespace
