// Ropes, struts, winches, jacks and motors of scene files, through the command, against closed forms.
#include <cmath>
#include <numbers>
#include <string>

#include "run.h"

namespace {
using namespace ductile;
using nlohmann::json;

constexpr double g = 9.81;

json named(const json& list, const std::string& name) {
  for (const json& element : list)
    if (element["name"] == name) return element;
  throw std::runtime_error("no " + name);
}

// What `command` prints of a scene with this text.
json of(const std::string& command, const json& scene, const std::string& options = "") {
  const Folder folder;
  const Ran ran = run(command + " " + folder.write("it.scene.json", scene.dump()) + " --json " + options);
  EXPECT_EQ(ran.exit, 0) << ran.err;
  return ran.exit == 0 ? ran.json() : json();
}

json simulated(const json& scene, double seconds) {
  return of("simulate", scene, "--time " + std::to_string(seconds));
}

json box(double x, double y, double half) {
  return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

// A load of 1000 kg, 1 m high, at (0, y), under or over a static block at the origin, and a line between
// them.
json line(double y, const json& joint, double up = 0) {
  json scene{
      {"materials", {{"stuff", {{"density", 1000}, {"E", 1e9}, {"fy", 1e9}, {"damping_ratio", 1}}}}},
      {"bodies",
       {{{"name", "block"}, {"type", "static"}, {"outline", box(0, 0, 0.5)}, {"collides", false}},
        {{"name", "load"}, {"outline", box(0, y, 0.5)}, {"material", "stuff"}, {"velocity", {0, up}}}}},
      {"joints", {joint}}};
  scene["joints"][0]["between"] = {"block", "load"};
  scene["joints"][0]["at"] = {{0, 0}, {0, y}};
  return scene;
}
constexpr double weight = 1000 * g;

// Thrown up it goes slack, falls back, and hangs as long as it was.
TEST(SceneRope, HangsGoesSlackAndComesBackToItsLength) {
  for (const double k : {0., 1e6}) {
    json rope{{"kind", "rope"}};
    if (k > 0) rope["stiffness_axial"] = k;
    const json scene = line(-4, rope, 5);
    const json slack = simulated(scene, 0.5)["joints"][0];
    EXPECT_EQ(slack["N"], 0);
    EXPECT_LT(slack["length"], 3);
    const json hung = simulated(scene, 20)["joints"][0];
    EXPECT_NEAR(hung["N"], weight, 1e-6 * weight);
    EXPECT_NEAR(hung["length"], 4 + (k > 0 ? weight / k : 0), 4e-6);
    EXPECT_EQ(hung["plastic_axial"], 0);
    EXPECT_EQ(hung["broken"], false);
  }
}

TEST(SceneRope, LongerThanDrawnIsSlackUntilItIsTaut) {
  const json scene = line(-4, {{"kind", "rope"}, {"length", 5}});
  EXPECT_EQ(simulated(scene, 0.3)["joints"][0]["N"], 0);  // √(2/g) = 0.45 s to fall 1 m
  EXPECT_NEAR(simulated(scene, 6)["joints"][0]["length"], 5, 5e-6);
}

TEST(SceneRope, YieldsAtItsCapAndTears) {
  const json torn = simulated(line(-4, {{"kind", "rope"}, {"axial", 0.5 * weight}, {"max_elongation", 0.1}}),
                              1)["joints"][0];
  EXPECT_EQ(torn["broken"], true);
  EXPECT_NEAR(torn["broken_at"], std::sqrt(2 * 0.1 / (0.5 * g)), 2. / 60);
  EXPECT_NEAR(torn["dissipated"], 0.1 * 0.5 * weight, 0.05 * weight);  // in whole steps
}

TEST(SceneStrut, CarriesCompressionAlone) {
  const json scene = line(3, {{"kind", "strut"}, {"stiffness_axial", 1e6}}, 4);
  EXPECT_EQ(simulated(scene, 0.4)["joints"][0]["N"], 0);
  const json stands = simulated(scene, 10)["joints"][0];
  EXPECT_NEAR(stands["N"], -weight, 1e-6 * weight);
  EXPECT_NEAR(stands["length"], 3 - weight / 1e6, 4e-6);
}

TEST(SceneWinch, LiftsToItsPositionAndHoldsFromTheStart) {
  const json scene =
      line(-6, {{"kind", "rope"},
                {"drive", {{"row", "axial"}, {"speed", -0.5}, {"position", 3}, {"from", 2}, {"ramp", 1}}}});
  const json before = simulated(scene, 2)["joints"][0];
  EXPECT_NEAR(before["length"], 6, 1e-5);
  const json lifting = simulated(scene, 5);  // ½ · 0.5 · 1 + 0.5 · 2 = 1.25 m of rope
  EXPECT_NEAR(lifting["joints"][0]["drive"], 6 - 1.25, 1e-5);
  EXPECT_NEAR(lifting["joints"][0]["N"], weight, 1e-3 * weight);
  EXPECT_NEAR(named(lifting["pieces"], "load")["velocity"][1], 0.5, 1e-4);
  const json lifted = simulated(scene, 12);
  EXPECT_NEAR(lifted["joints"][0]["length"], 3, 4e-6);
  EXPECT_EQ(lifted["joints"][0]["drive"], 3);
  EXPECT_NEAR(lifted["energy"]["external"], 3 * weight, 2e-2 * 3 * weight);  // the winch's work
  EXPECT_NEAR(lifted["energy"]["total_error"], 0, 1e-3 * 3 * weight);
}

// What its cap does not hold sinks with a = g − F/m.
TEST(SceneJack, HoldsWithItsCapExactly) {
  const double cap = 0.8 * weight;
  const json scene = line(4, {{"drive", {{"row", "axial"}, {"position", 5}, {"speed", 1}, {"cap", cap}}}});
  const json sinks = simulated(scene, 1);
  EXPECT_NEAR(sinks["joints"][0]["N"], -cap, 1e-9 * cap);
  EXPECT_NEAR(named(sinks["pieces"], "load")["velocity"][1], -0.2 * g, 1e-4);
  EXPECT_EQ(sinks["joints"][0]["dissipated"], 0);
}

// A beam of 6 m and 471 kg/m, hinged at its left end, on a jack at 4 m: N a = q L²/2, where it is, at
// whatever angle; and its cap is reached at the load that statics say.
json levered(double cap, double tip_load) {
  return {{"bodies",
           {{{"name", "floor"}, {"type", "static"}, {"outline", {{-1, -1}, {7, -1}, {7, -0.9}, {-1, -0.9}}}},
            {{"name", "beam"},
             {"outline", {{0, -0.15}, {6, -0.15}, {6, 0.15}, {0, 0.15}}},
             {"depth", 0.2},
             {"material", "S355"},
             {"split", {{"pieces", 12}}}}}},
          {"joints",
           {{{"between", {"floor", "beam"}}, {"at", {0, 0}}},
            {{"between", {"floor", "beam"}},
             {"at", {{3.9, -0.9}, {3.9, -0.15}}},
             {"drive", {{"row", "axial"}, {"speed", 0}, {"cap", cap}}}}}},
          {"loads", {{{"body", "beam"}, {"at", {6, 0}}, {"force", {0, -tip_load}}, {"ramp", 2}}}}};
}
TEST(SceneJack, CarriesWhatStaticsSay) {
  const double q = 7850 * 0.06 * g, load = 50e3, needs = (q * 18 + load * 6) / 3.9;
  const std::string jack = "floor-beam/7";
  const json holds = named(simulated(levered(1.02 * needs, load), 10)["joints"], jack);
  EXPECT_NEAR(holds["N"], -needs, 2e-3 * needs);  // the beam sags by 1e-3 of its length
  const json sinks = named(simulated(levered(0.98 * needs, load), 2.5)["joints"], jack);
  EXPECT_NEAR(sinks["N"], -0.98 * needs, 1e-9 * needs);
  EXPECT_LT(sinks["drive"], 0.75 - 1e-3);

  const json check = of("check", levered(1.02 * needs, load));
  EXPECT_NEAR(named(check["joints"], jack)["N"], -needs, 1e-9 * needs);
  EXPECT_NEAR(check["reserve"], 1.02, 1e-9);
  EXPECT_EQ(check["first_to_yield"][0], jack);
  const json limit = of("limit", levered(1.02 * needs, load));
  EXPECT_NEAR(limit["load_factor"], 1.02, 1e-8);
  EXPECT_EQ(limit["hinges"], json({jack}));
}

// A deck of 12 m, 0.2 m by 0.2 m of steel: 314 kg/m, q L²/2 = 222 kN m at its hinge.
json drawbridge(int pieces) {
  return {{"bodies",
           {{{"name", "bank"},
             {"type", "static"},
             {"outline", {{-3, -1}, {0, -1}, {0, 6}, {-3, 6}}},
             {"collides", false}},
            {{"name", "deck"},
             {"outline", {{0, -0.1}, {12, -0.1}, {12, 0.1}, {0, 0.1}}},
             {"depth", 0.2},
             {"material", "S355"},
             {"split", {{"pieces", pieces}}},
             {"group", -1}}}}};
}
constexpr double held = 7850 * 0.04 * g * 12 * 12 / 2;

TEST(SceneDrawbridge, IsHeldAndLiftedByAMotor) {
  for (const int pieces : {1, 4, 12, 24}) {
    json scene = drawbridge(pieces);
    scene["joints"] = {
        {{"between", {"bank", "deck"}},
         {"at", {0, 0}},
         {"drive", {{"row", "rotation"}, {"speed", 0.1}, {"position", 0.8}, {"cap", 2e6}, {"from", 20}}}}};
    EXPECT_NEAR(held, 222e3, 0.01 * 222e3);
    const std::string hinge = pieces > 1 ? "bank-deck/0" : "bank-deck";
    const json still = named(simulated(scene, 20)["joints"], hinge);
    EXPECT_NEAR(std::abs(still["M"].get<double>()), held, 1e-3 * held) << pieces;
    EXPECT_EQ(still["drive"], 0);
    EXPECT_EQ(still["accumulated_rotation"], 0);
    const json lifted = simulated(scene, 40), at = named(lifted["joints"], hinge);
    EXPECT_NEAR(at["drive"], 0.8, 1e-9);
    EXPECT_NEAR(lifted["pieces"][1]["angle"], 0.8, 1e-4);
    EXPECT_NEAR(std::abs(at["M"].get<double>()), held * std::cos(0.8), 0.01 * held);
    const json check = named(of("check", scene)["joints"], hinge);
    EXPECT_NEAR(std::abs(check["M"].get<double>()), held, 1e-9 * held);
    EXPECT_NEAR(check["usage"]["M"], held / 2e6, 1e-9);
  }
}

// T · 12 sin α = q L²/2, on a rope from 5 m above the hinge to the tip; then wound in.
TEST(SceneDrawbridge, IsHeldAndLiftedByARope) {
  json scene = drawbridge(12);
  scene["joints"] = {{{"between", {"bank", "deck"}}, {"at", {0, 0}}},
                     {{"between", {"bank", "deck"}},
                      {"at", {{0, 5}, {12, 0}}},
                      {"kind", "rope"},
                      {"drive", {{"row", "axial"}, {"speed", 0.3}, {"position", 10}, {"from", 8}}}}};
  const double T = held / (12 * 5 / 13.);
  EXPECT_NEAR(of("check", scene)["joints"].back()["N"], T, 1e-8 * T);
  EXPECT_NEAR(simulated(scene, 8)["joints"][12]["N"], T, 2e-3 * T);
  const json lifted = simulated(scene, 25)["joints"][12];
  EXPECT_NEAR(lifted["length"], 10, 1e-4);
  // The triangle 5, 12, 10: its area is half of base times height, so the lever is 2 A/10.
  const double s = 13.5, A = std::sqrt(s * (s - 5) * (s - 12) * (s - 10)), sine = A / 30;
  EXPECT_NEAR(lifted["N"], held * sine / (2 * A / 10), 0.01 * T);
}

// A mast of 4 m on a pin, guyed to both sides at 45°: F at its top is held by one rope, T = √2 F.
json guyed(double length, double k, double F) {
  json scene{{"bodies",
              {{{"name", "floor"}, {"type", "static"}, {"outline", {{-6, -1}, {6, -1}, {6, 0}, {-6, 0}}}},
               {{"name", "mast"},
                {"outline", {{-0.1, 0}, {0.1, 0}, {0.1, 4}, {-0.1, 4}}},
                {"depth", 0.2},
                {"material", "S355"}}}},
             {"loads", {{{"body", "mast"}, {"at", {0, 4}}, {"force", {F, 0}}, {"ramp", 2}}}}};
  scene["joints"] = {{{"between", {"floor", "mast"}}, {"at", {0, 0}}}};
  for (const double x : {-4, 4})
    scene["joints"].push_back({{"between", {"floor", "mast"}},
                               {"at", {{x, 0}, {0, 4}}},
                               {"kind", "rope"},
                               {"axial", 100e3},
                               {"length", length},
                               {"stiffness_axial", k}});
  return scene;
}
TEST(SceneRope, OnTheSlackSideCarriesNothingInCheckAndLimit) {
  const double F = 20e3, T = std::sqrt(2.) * F, drawn = 4 * std::sqrt(2.);
  const json scene = guyed(drawn, 1e9, F);
  const json check = of("check", scene);
  EXPECT_NEAR(check["joints"][1]["N"], T, 1e-9 * T);
  EXPECT_EQ(check["joints"][2]["N"], 0);
  EXPECT_NEAR(check["reserve"], 100e3 / T, 1e-9);
  const json limit = of("limit", scene);
  EXPECT_NEAR(limit["load_factor"], 100e3 / T, 1e-8);
  EXPECT_EQ(limit["hinges"], json({"floor-mast#1"}));
  const json run = simulated(scene, 8);
  EXPECT_NEAR(run["joints"][1]["N"], T, 1e-3 * T);  // P–Δ of 1e-4
  EXPECT_EQ(run["joints"][2]["N"], 0);
}

// Ropes that are short are strained: k Δ each, ± F/√2 as long as both are taut. One that is long is slack.
TEST(SceneRope, ShortOnesAreStrainedInCheckAndLongOnesAreNot) {
  const double F = 10e3, k = 1e7, short_by = 2e-3, drawn = 4 * std::sqrt(2.);
  const json strained = of("check", guyed(drawn - short_by, k, F))["joints"];
  EXPECT_NEAR(strained[1]["N"], k * short_by + F / std::sqrt(2.), 10);  // the mast is shortened by 1e-6
  EXPECT_NEAR(strained[2]["N"], k * short_by - F / std::sqrt(2.), 10);
  const json run = simulated(guyed(drawn - short_by, k, F), 10)["joints"];
  EXPECT_NEAR(run[1]["N"], strained[1]["N"], 1e-3 * k * short_by);
  EXPECT_NEAR(run[2]["N"], strained[2]["N"], 1e-3 * k * short_by);
  const json loose = of("check", guyed(drawn + short_by, k, F))["joints"];
  EXPECT_NEAR(loose[1]["N"], std::sqrt(2.) * F, 1e-6 * F);
  EXPECT_EQ(loose[2]["N"], 0);
  EXPECT_NEAR(of("check", guyed(drawn + short_by, k, F))["reserve"], 100e3 / (std::sqrt(2.) * F), 1e-6);
}

// Two rigid links of 4 m and 2 m, upright, the upper one a line, with a spring k across their hinge:
// P_cr = k · 4 · 2/(4 + 2).
TEST(SceneLine, BucklesAsABarOnHinges) {
  constexpr double k = 1e5, P = 1e3;
  json scene = guyed(1, 1, 0);
  scene["gravity"] = {0, 0};
  scene["bodies"][0]["outline"] = {{-6, -1}, {6, -1}, {6, 0}, {-3.9, 0}, {-3.9, 4}, {-6, 4}};
  scene["bodies"].push_back({{"name", "slider"}, {"outline", box(0, 6.5, 0.5)}, {"material", "S355"}});
  scene["joints"] = {{{"between", {"floor", "mast"}}, {"at", {0, 0}}},
                     {{"between", {"floor", "mast"}}, {"at", {{-4, 4}, {0, 4}}}, {"stiffness_axial", k}},
                     {{"between", {"mast", "slider"}}, {"at", {{0, 4}, {0, 6}}}}};
  scene["supports"] = {{{"body", "slider"}, {"at", {0, 6.5}}, {"fix", {"x", "angle"}}}};
  scene["loads"] = {{{"body", "slider"}, {"at", {0, 6}}, {"force", {0, -P}}}};
  EXPECT_NEAR(of("check", scene)["critical_load_factor"], k * 8 / 6 / P, 1e-5 * k * 8 / 6 / P);
}

TEST(SceneLines, SayWhatIsWrong) {
  const Folder folder;
  const auto refused = [&](const json& joint, const std::string& place, const std::string& what) {
    json scene = line(-4, joint);
    if (joint.contains("at")) scene["joints"][0]["at"] = joint["at"];
    for (const char* command : {"calibrate", "check", "limit"}) {
      const Ran ran = run(std::string(command) + " " + folder.write("bad.scene.json", scene.dump()));
      EXPECT_EQ(ran.exit, 2);
      EXPECT_EQ(ran.out, "");
      EXPECT_NE(ran.err.find("bad.scene.json:" + place), std::string::npos) << ran.err;
      EXPECT_NE(ran.err.find(what), std::string::npos) << ran.err;
    }
  };
  refused({{"kind", "chain"}}, "joints[0].kind", "rope, strut");
  refused({{"kind", "rope"}, {"at", {0, 0}}}, "joint 0", "give two");
  refused({{"kind", "rope"}, {"at", {{1, 1}, {1, 1}}}}, "joint 0", "no length");
  refused({{"kind", "rope"}, {"at", {{30, 1}, {1, 1}}}}, "joint 0", "farther");
  refused({{"kind", "rope"}, {"length", 0}}, "joints[0].length", "a number > 0");
  refused({{"kind", "rope"}, {"axial_compression", 5}}, "joint 0", "goes slack");
  refused({{"kind", "rope"}, {"stiffness_axial", 1e-300}}, "joint 0", "at least 1e-30");
  refused({{"moment", 5}}, "joint 0", "bends or shears");
  refused({{"kind", "rope"}, {"drive", 1}}, "joints[0].drive", "");
  refused({{"kind", "rope"}, {"drive", {{"speed", 1}}}}, "joints[0].drive", "row");
  refused({{"kind", "rope"}, {"drive", {{"row", "shear"}, {"speed", 1}}}}, "joints[0].drive.row",
          "axial, rotation");
  refused({{"kind", "rope"}, {"drive", {{"row", "axial"}}}}, "joint 0", "without a goal");
  refused({{"kind", "rope"}, {"drive", {{"row", "axial"}, {"speed", 1}, {"cap", 0}}}}, "joints[0].drive.cap",
          "a number > 0");
  refused({{"kind", "rope"}, {"drive", {{"row", "axial"}, {"position", -1}}}}, "joint 0", "a length > 0");
  refused({{"kind", "rope"}, {"drive", {{"row", "axial"}, {"position", 1}, {"speed", 0}}}}, "joint 0",
          "at speed 0");
  refused({{"kind", "rope"}, {"axial", 5}, {"drive", {{"row", "axial"}, {"speed", 1}}}}, "joint 0",
          "beside that of its drive");
  refused({{"drive", {{"row", "rotation"}, {"speed", 1}}}}, "joint 0", "turns freely");
  refused({{"at", {0, 0}}, {"length", 3}}, "joint 0", "is no line");
}

// Other programs: what each makes of a rope, a strut, a jack and a motor, and what it says that it does not.
TEST(SceneLines, InOtherPrograms) {
  const Folder folder;
  const std::string scene = folder.write("it.scene.json", levered(1e6, 1e3).dump()),
                    rope =
                        folder.write("rope.scene.json", line(-4, {{"kind", "rope"}, {"length", 5}}).dump());
  const json box2d = json::parse(run("calibrate " + rope + " --to box2d").out)["joints"][0]["holds"];
  EXPECT_EQ(box2d["2.4"]["type"], "distance");
  EXPECT_EQ(box2d["2.4"]["minLength"], 0);
  EXPECT_EQ(box2d["2.4"]["maxLength"], 5);
  const Ran rube = run("calibrate " + rope + " --to rube");
  EXPECT_EQ(rube.json()["joint"][0]["type"], "rope");
  EXPECT_EQ(rube.json()["joint"][0]["maxLength"], 5);
  EXPECT_NE(rube.err.find("'block-load' is written as R.U.B.E. has it: a rope"), std::string::npos)
      << rube.err;
  const Ran jack = run("calibrate " + scene + " --to rube");
  EXPECT_NE(jack.err.find("a bar of that length"), std::string::npos) << jack.err;
  const Ran cpp = run("calibrate " + scene + " --to cpp");
  EXPECT_NE(cpp.out.find("ductile::Drive{"), std::string::npos);
  // A rope in stock Box2D carries what hangs on it, too.
  const json stock = of("simulate", line(-4, {{"kind", "rope"}}), "--time 5 --solver stock");
  EXPECT_NEAR(stock["joints"][0]["N"], weight, 0.01 * weight);
}

}  // namespace
