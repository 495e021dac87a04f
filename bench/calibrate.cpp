// What a game waits for while a level loads: outlines in memory become joint definitions, against reading the
// same scene from JSON text in memory.
#include "ductile/calibrate.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "ductile/box2d.h"
#include "ductile/files.h"
#include "ratio.h"

namespace ductile::bench {
namespace {

// Girders of 24 vertices, no two alike, each in 21 pieces, or in what a displacement error of 0.55 % asks: 21
// on average.
SceneDef girders(std::int64_t count, bool automatic) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(0.8, 1.2);
  SceneDef scene;
  scene.target_error = 0.0055;
  for (std::int64_t i = 0; i < count; ++i) {
    const double y = 4.0 * static_cast<double>(i);
    BodyDef& body = scene.bodies.emplace_back();
    body.name = "girder" + std::to_string(i);
    for (int k = 0; k < 12; ++k) body.outline.outer.push_back({20.0 / 11 * k, y - height(random)});
    for (int k = 11; k >= 0; --k) body.outline.outer.push_back({20.0 / 11 * k, y + height(random)});
    body.material = materials::S355;
    body.depth = 0.3;
    body.automatic = automatic;
    if (automatic) continue;
    body.pieces = 21;
    body.along = {Point{0, y}, Point{20, y}};
  }
  return scene;
}

// vs_parse: against parse_scene(), text to SceneDef; json_us: of which nlohmann::json::parse alone.
void load(benchmark::State& state, bool automatic) {
  const SceneDef scene = girders(state.range(0) / 20, automatic);
  const std::string text = scene_text(scene);
  std::vector<double> json;
  std::size_t joints = 0;
  alternate(
      state, "parse",
      [&] {
        return seconds([&] {
          const Plan plan = calibrate(scene);
          std::vector<ElasticPlasticJointDef> defs;
          defs.reserve(plan.joints.size());
          for (const PlannedJoint& joint : plan.joints) defs.push_back(elastic_plastic_def(plan, joint));
          benchmark::DoNotOptimize(defs.data());
          joints = defs.size();
        });
      },
      [&] {
        json.push_back(seconds([&] { benchmark::DoNotOptimize(nlohmann::json::parse(text)); }));
        return seconds([&] { benchmark::DoNotOptimize(parse_scene(text)); });
      });
  state.counters["joints"] = static_cast<double>(joints);
  state.counters["json_us"] = 1e6 * median(json);
  state.counters["ns_per_joint"] = 1e3 * state.counters["us"].value / static_cast<double>(joints);
}
void sizes(benchmark::internal::Benchmark* b) {
  b->Arg(1'000)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(load, given, false)->Name("calibrate/load")->Apply(sizes)->UseManualTime();
BENCHMARK_CAPTURE(load, automatic, true)->Name("calibrate/load_automatic")->Apply(sizes)->UseManualTime();

// A coastline: one outline of very many vertices, into convex parts.
void outline(benchmark::State& state) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> radius(90, 110);
  const auto n = state.range(0);
  Piece piece;
  for (std::int64_t i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n),
                 r = radius(random);
    piece.outline.outer.push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  for (auto _ : state) benchmark::DoNotOptimize(convex_parts(piece));
  state.counters["s_per_vertex"] = benchmark::Counter(
      static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(outline)->Name("calibrate/outline")->Apply(sizes);

}  // namespace
}  // namespace ductile::bench
