// What `--to box2d` and `--to cpp` write makes the worlds that build() makes.
#include "ductile/definitions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "../world_state.h"
#include "ductile/box2d.h"
#include "ductile/files.h"
#include "pasted/worlds.h"

namespace {
using namespace ductile;
using nlohmann::json;

Plan plan_of(const std::string& scene) {
  return calibrate(read_scene(DUCTILE_SOURCE_DIR "/scenes/" + scene + ".scene.json"));
}

class Pasted : public testing::TestWithParam<std::pair<const char*, pasted::Level (*)(b2World&)>> {};

// 240 steps, in which the car falls on its wheels and the crane's jib bends: not one bit differs.
TEST_P(Pasted, SourceMakesTheSameWorld) {
  const auto& [scene, make] = GetParam();
  const Plan plan = plan_of(scene);
  b2World world({static_cast<float>(plan.gravity.x), static_cast<float>(plan.gravity.y)}), copy({0, 0});
  Built built;
  Structure structure = build(world, plan, {}, &built);
  pasted::Level level = make(copy);
  const Structure& pasted = level.structure;
  EXPECT_EQ(copy.GetGravity(), world.GetGravity());
  ASSERT_EQ(pasted.joints().size(), structure.joints().size());
  const std::vector<float> start = world_state(world);
  for (int i = 0; i < 240; ++i) {
    for (b2World* w : {&world, &copy}) w->Step(1 / 60.0f, 8, 3);
    structure.update();
    level.structure.update();
    ASSERT_EQ(world_state(copy), world_state(world)) << "step " << i;
  }
  EXPECT_NE(world_state(world), start);

  // What it made, by name.
  ASSERT_EQ(level.bodies.size(), plan.pieces.size());
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    EXPECT_EQ(level.bodies[i].first, plan.pieces[i].name);
    EXPECT_EQ(level.bodies[i].second->GetPosition(), built.bodies[i]->GetPosition());
  }
  ASSERT_EQ(level.joints.size(), plan.joints.size());
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    EXPECT_EQ(level.joints[i].first, plan.joints[i].name);
    EXPECT_EQ(level.joints[i].second->force(rotation), structure.joints()[i]->force(rotation));
  }
  ASSERT_EQ(level.motors.size(), plan.wheels.size());
  for (std::size_t i = 0; i < plan.wheels.size(); ++i)
    EXPECT_EQ(level.motors[i].second->GetMotorSpeed(), built.wheels[i]->GetMotorSpeed());
}

INSTANTIATE_TEST_SUITE_P(Scenes, Pasted,
                         testing::Values(std::pair{"car", &pasted::car},
                                         std::pair{"harbour_crane", &pasted::harbour_crane},
                                         std::pair{"crane_winch", &pasted::crane_winch}),
                         [](const auto& info) { return info.param.first; });

TEST(CppText, NamesCannotLeaveTheirComments) {
  SceneDef scene;
  scene.bodies = {{.name = "a\nint main() {}\\", .outline = {{{0, 0}, {1, 0}, {1, 1}}, {}}}};
  scene.bodies[0].material = materials::oak;
  const std::string source = cpp_text(calibrate(scene), "f");
  EXPECT_NE(source.find("// 0: a int main() {} \n"), std::string::npos) << source;
  EXPECT_NE(source.find(R"({"a\012int main() {}\134", bodies[0]})"), std::string::npos) << source;
}

// A cantilever of two halves, 4 m × 0.5 m × 0.2 m of S355, held at its end by a pin.
struct Box2dText : testing::Test {
  static constexpr double L = 4, h = 0.5, b = 0.2;
  json doc;
  Box2dText() {
    SceneDef scene;
    scene.gravity_ramp = 1;
    scene.bodies = {{.name = "wall",
                     .type = BodyType::static_body,
                     .outline = {{{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {}}},
                    {.name = "beam",
                     .outline = {{{0, 0}, {L, 0}, {L, h}, {0, h}}, {}},
                     .material = materials::S355,
                     .depth = b,
                     .pieces = 2}};
    scene.joints = {{.a = "wall", .b = "beam"}};
    scene.supports = {{.body = "beam", .at = {L, h / 2}, .fix_x = true, .fix_y = true},
                      {.body = "beam", .at = {L, 0}, .fix_y = true}};
    scene.loads = {{.body = "beam", .at = {L, h}, .force = {0, -1}}};
    const Plan plan = calibrate(scene);
    omega = 2 * std::numbers::pi * plan.joints[0].damping_frequency;
    doc = json::parse(box2d_text(plan));
  }
  double omega;  // rad/s, which calibrate/Fundamental.* compares with closed forms
  const json& joint(const std::string& name) const {
    for (const json& j : doc["joints"])
      if (j["name"] == name) return j;
    throw std::runtime_error("no joint " + name);
  }
};

TEST_F(Box2dText, BodiesHaveTheirMassAndShape) {
  ASSERT_EQ(doc["bodies"].size(), 4u);  // with the ground of the supports
  const json& half = doc["bodies"][1];
  const double m = 7850 * L / 2 * h * b;
  EXPECT_EQ(half["name"], "beam/0");
  EXPECT_NEAR(half["mass"], m, 1e-6 * m);
  EXPECT_NEAR(half["inertia"], m * (L / 2 * L / 2 + h * h) / 12, 1e-6 * m);
  EXPECT_EQ(half["position"], (json{1.0, 0.25}));
  EXPECT_EQ(half["fixtures"][0]["polygon"].size(), 4u);
  EXPECT_EQ(doc["bodies"][0]["type"], "static");
  EXPECT_EQ(doc["bodies"][3]["name"], "ground");
}

TEST_F(Box2dText, AWeldHoldsAndAHingeYields) {
  const json& j = joint("beam/0-beam/1");
  const double I = b * h * h * h / 12, k = 210e9 * I / (L / 2), m = 7850 * L / 2 * h * b,
               inertia = m * (L / 2 * L / 2 + h * h) / 12 / 2;  // of two equal bodies
  const json& weld = j["holds"]["2.4"];
  EXPECT_EQ(weld["type"], "weld");
  EXPECT_EQ(weld["localAnchorA"], (json{1.0, 0.0}));
  EXPECT_NEAR(weld["stiffness"], k, 1e-6 * k);
  EXPECT_NEAR(weld["damping"], 2 * 0.05 * k / omega, 1e-6 * k);  // of the structure's lowest mode
  const json& weld_3 = j["holds"]["3"];
  EXPECT_EQ(weld_3["localFrameA"]["p"], (json{1.0, 0.0}));
  const double hertz = std::sqrt(k / inertia) / (2 * std::numbers::pi);
  EXPECT_NEAR(weld_3["angularHertz"], hertz, 1e-9 * hertz);
  EXPECT_EQ(weld_3["angularDampingRatio"], 0.05);
  const double M = b * h * h / 4 * 355e6;
  for (const char* version : {"2.4", "3"}) {
    const json& hinge = j["yields"][version];
    EXPECT_EQ(hinge["type"], "revolute");
    EXPECT_EQ(hinge["enableMotor"], true);
    EXPECT_EQ(hinge["motorSpeed"], 0);
    EXPECT_NEAR(hinge["maxMotorTorque"], M, 1e-6 * M);
  }
}

TEST_F(Box2dText, FreeRowsAreFreeInEveryVersion) {
  EXPECT_EQ(joint("support/0")["bodyA"], "ground");
  EXPECT_EQ(joint("support/0")["holds"]["2.4"]["type"], "revolute");
  EXPECT_EQ(joint("support/0")["holds"]["2.4"]["enableMotor"], false);
  EXPECT_FALSE(joint("support/0").contains("yields"));
  EXPECT_EQ(joint("support/1")["holds"]["2.4"]["type"], "wheel");  // a point on a line
  EXPECT_EQ(joint("support/1")["holds"]["3"]["type"], "wheel");
  EXPECT_EQ(joint("support/1")["holds"]["3"]["localFrameA"]["angle"], 0);  // along x
}

TEST_F(Box2dText, SaysWhatIsLost) {
  const auto lost = [&](const char* name, const char* role) { return joint(name)[role]["lost"].dump(); };
  EXPECT_NE(lost("beam/0-beam/1", "holds").find("any moment without yielding"), std::string::npos);
  EXPECT_EQ(lost("beam/0-beam/1", "yields").find("any moment"), std::string::npos);
  EXPECT_NE(lost("beam/0-beam/1", "yields").find("never breaks"), std::string::npos);
  EXPECT_EQ(lost("support/0", "holds"), "[]");
  EXPECT_EQ(lost("support/1", "holds"), "[]");
  EXPECT_EQ(doc["lost"].size(), 2u);  // the ramp and the load
  for (const char* role : {"holds", "yields"})
    EXPECT_EQ(lost("beam/0-beam/1", role).find("where it yields fast"), std::string::npos);
}

TEST(Box2dTextOfARate, SaysThatItIsLost) {
  SceneDef scene;
  scene.bodies = {{.name = "bar", .outline = {{{0, 0}, {4, 0}, {4, 1}, {0, 1}}, {}}, .pieces = 2}};
  scene.bodies[0].material = materials::S355;
  scene.bodies[0].material->rate_D = 40;
  const json doc = json::parse(box2d_text(calibrate(scene)));
  for (const char* role : {"holds", "yields"})
    EXPECT_NE(doc["joints"][0][role]["lost"].dump().find("where it yields fast"), std::string::npos);
}
}  // namespace
