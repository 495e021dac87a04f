// What a damping ratio means in a scene: that of the structure's own lowest vibration, at the rate of games.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ductile/files.h"
#include "ductile/simulation.h"

namespace {
using namespace ductile;

std::string body(const std::string& name, double x0, double y0, double x1, double y1, bool upright) {
  const auto at = [](double x, double y) { return "[" + std::to_string(x) + ", " + std::to_string(y) + "]"; };
  const double x = (x0 + x1) / 2, y = (y0 + y1) / 2;
  return R"({"name": ")" + name + R"(", "outline": [)" + at(x0, y0) + ", " + at(x1, y0) + ", " + at(x1, y1) +
         ", " + at(x0, y1) +
         R"(], "depth": 0.1, "material": "m", "group": -1, "split": {"pieces": 6, "along": [)" +
         (upright ? at(x, y0) + ", " + at(x, y1) : at(x0, y) + ", " + at(x1, y)) + "]}}";
}

// Two columns and a beam, 10 m by 8 m, that a force at the beam's end sways from the start.
SceneDef frame(double ratio) {
  return parse_scene(
      R"({"gravity": [0, 0], "materials": {"m": {"density": 7800, "E": 210e9, "fy": 350e6, "damping_ratio": )" +
      std::to_string(ratio) + R"(}}, "bodies": [
      {"name": "base", "type": "static", "outline": [[-1, -1], [9.2, -1], [9.2, 0], [-1, 0]], "material": "m"}, )" +
      body("left", 0, 0, 0.2, 10, true) + ", " + body("right", 8, 0, 8.2, 10, true) + ", " +
      body("beam", 0, 10, 8.2, 10.2, false) + R"(],
    "joints": [{"between": ["base", "left"]}, {"between": ["base", "right"]},
               {"between": ["left", "beam"]}, {"between": ["right", "beam"]}],
    "loads": [{"body": "beam", "at": [0.1, 10.1], "force": [1000, 0]}]})");
}

// How far the beam's end has moved after each step, m.
std::vector<double> sway(double ratio, double rate, double time) {
  Simulation run(calibrate(frame(ratio)), JointSolver::direct, {.dt = 1 / rate});
  const auto& all = run.plan().pieces;
  const auto end =
      std::find_if(all.begin(), all.end(), [](const Piece& p) { return p.name.starts_with("beam"); });
  const auto index = static_cast<std::size_t>(end - all.begin());
  const double start = run.piece(index).position.x;
  std::vector<double> x{0};
  while (run.time() < time) {
    run.step();
    x.push_back(run.piece(index).position.x - start);
  }
  return x;
}

double first_peak(double ratio, double rate) {
  const std::vector<double> x = sway(ratio, rate, 1);
  return *std::max_element(x.begin(), x.end());
}

// Of swings from one turning point to the next: rest cancels.
double damping_of(const std::vector<double>& x) {
  std::vector<double> turns;
  for (std::size_t i = 2; i < x.size(); ++i) {
    const double a = x[i - 2], b = x[i - 1], c = x[i];
    if ((b - a) * (c - b) < 0) turns.push_back(b + (c - a) * (c - a) / (8 * (2 * b - a - c)));
  }
  EXPECT_GE(turns.size(), 14u);
  if (turns.size() < 14) return 0;
  const auto swing = [&](std::size_t i) { return std::abs(turns[i + 1] - turns[i]); };
  const double decrement = std::log(swing(1) / swing(11)) / 5;
  return decrement / std::hypot(2 * std::numbers::pi, decrement);
}

TEST(Frame, IsDampedAsAsked) {
  for (const double ratio : {0.0, 0.02, 0.05}) {
    EXPECT_NEAR(damping_of(sway(ratio, 60, 15)), ratio, std::max(0.002, 0.1 * ratio));
    EXPECT_NEAR(first_peak(ratio, 60) / first_peak(ratio, 4000), 1, 0.04) << ratio;
  }
}

// A deck on springs that are softer than it, and stiffer.
TEST(Deck, OnSpringsIsDampedAsAsked) {
  for (const char* k : {"2e4", "2e6"}) {
    const std::string spring = std::string(R"("stiffness": {"x": 1e6, "y": )") + k + "}}";
    Simulation run(calibrate(parse_scene(
                       R"({"bodies": [{"name": "deck", "outline": [[0, -0.1], [8, -0.1], [8, 0.1], [0, 0.1]],
          "depth": 0.1, "material": "S355", "split": {"pieces": 10}}],
        "supports": [{"body": "deck", "at": [0.1, 0], )" +
                       spring + R"(, {"body": "deck", "at": [7.9, 0], )" + spring + "]}")),
                   JointSolver::direct, {.dt = 1.0 / 60});
    std::vector<double> y;
    while (run.time() < 12) {
      run.step();
      y.push_back(run.piece(4).position.y);
    }
    EXPECT_NEAR(damping_of(y), 0.05, 0.005) << k;
  }
}

}  // namespace
