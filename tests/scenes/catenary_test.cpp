// A rigid-plastic beam between walls that is pushed down in its middle goes over from bending to hanging.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "ductile/files.h"
#include "ductile/simulation.h"

namespace {
using namespace ductile;

constexpr double half = 0.99, h = 0.1, depth = 0.05, fy = 300e6, ramp = 10;  // m, m, m, Pa, s
constexpr double collapse = 4 * (fy * depth * h * h / 4) / half;             // N: P_c, four hinges

std::string rectangle(double x0, double x1) {
  return "[[" + std::to_string(x0) + ", 0], [" + std::to_string(x1) + ", 0], [" + std::to_string(x1) +
         ", 0.1], [" + std::to_string(x0) + ", 0.1]]";
}

std::string body(const std::string& name, double x0, double x1, const std::string& more) {
  return R"({"name": ")" + name + R"(", "outline": )" + rectangle(x0, x1) +
         R"(, "depth": 0.05, "material": "m", "group": -1)" + more + "}";
}

std::string split(int pieces, double x0, double x1) {
  return R"(, "split": {"pieces": )" + std::to_string(pieces) + R"(, "along": [[)" + std::to_string(x0) +
         ", 0.05], [" + std::to_string(x1) + ", 0.05]]}";
}

SceneDef beam(int pieces, bool interaction, double load) {
  return parse_scene(R"({"gravity": [0, 0], "interaction": )" + std::string(interaction ? "true" : "false") +
                     R"(,
    "materials": {"m": {"density": 7800, "E": 210e9, "fy": 300e6, "criterion": "von_mises"}},
    "bodies": [)" + body("w", -0.1, 0, R"(, "type": "static")") +
                     ", " + body("e", 2, 2.1, R"(, "type": "static")") + ", " +
                     body("l", 0, half, split(pieces, 0, half)) + ", " + body("c", half, 2 - half, "") +
                     ", " + body("r", 2 - half, 2, split(pieces, 2 - half, 2)) + R"(],
    "joints": [{"between": ["w", "l"]}, {"between": ["l", "c"]}, {"between": ["c", "r"]}, {"between": ["r", "e"]}],
    "joint": {"elastic": "rigid", "max_rotation": null, "max_elongation": null, "shear": null},
    "loads": [{"body": "c", "at": [1, 0.05], "force": [0, )" +
                     std::to_string(-load) + R"(], "ramp": 10}]})");
}

class Catenary : public testing::TestWithParam<std::tuple<int, int, bool, double>> {};

// With N and M of a full rectangle, n² + m = 1, the sag is w h with 1 + w² = P/P_c up to w = 1, and 2 w =
// P/P_c beyond, where nothing bends any more (R. M. Haythornthwaite, Engineering 183, 1957); with caps of
// their own 1 + 2 w = P/P_c. Both for small slopes: the steepest here, w h/half = 0.13, is a cosine of 1 %.
// What hangs takes hold only once it sags: the first step moves freely. From then on tension that turns with
// its bars slows what swings on it to what the step resolves (joint/turn_inertia.h).
TEST_P(Catenary, Sags) {
  const auto [pieces, hertz, interaction, times] = GetParam();
  Simulation run(calibrate(beam(pieces, interaction, times * collapse)), JointSolver::direct,
                 {.dt = 1.0 / hertz});
  const auto& all = run.plan().pieces;
  const auto middle = std::find_if(all.begin(), all.end(), [](const Piece& p) { return p.name == "c"; });
  ASSERT_NE(middle, all.end());
  while (run.time() < ramp + 2) run.step();
  const double w = (h / 2 - run.piece(static_cast<std::size_t>(middle - all.begin())).position.y) / h;
  const double expected = !interaction ? (times - 1) / 2 : times <= 2 ? std::sqrt(times - 1) : times / 2;
  EXPECT_NEAR(w, expected, 0.03 * expected);
  EXPECT_TRUE(std::all_of(all.begin(), all.end(), [&](const Piece& p) {
    return std::abs(run.piece(static_cast<std::size_t>(&p - all.data())).position.y) < 2 * h + h / 2;
  })) << "torn";
}

std::string name_of(const testing::TestParamInfo<Catenary::ParamType>& info) {
  const auto [pieces, hertz, interaction, times] = info.param;
  return std::to_string(pieces) + "_pieces_" + std::to_string(hertz) + "_Hz_" +
         (interaction ? "surface_" : "caps_") + std::to_string(std::lround(100 * times));
}

INSTANTIATE_TEST_SUITE_P(Rigid, Catenary,
                         testing::Combine(testing::Values(1, 3, 12), testing::Values(60, 120, 600),
                                          testing::Bool(), testing::Values(1.25, 2.5)),
                         name_of);

}  // namespace
