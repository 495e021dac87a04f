// What it saves to leave out what a scene does not need: a step of the lean plan against one of the full
// plan, at 1 % tolerance. Counters: joints of both; the error that was promised and the one that the run
// showed.
#include <benchmark/benchmark.h>

#include <optional>
#include <string>

#include "ductile/design.h"
#include "ductile/files.h"
#include "ductile/simulation.h"
#include "ratio.h"

namespace ductile::bench {
namespace {

SceneDef scene_of(const std::string& name) {
  return read_scene(DUCTILE_SOURCE_DIR "/scenes/" + name + ".scene.json");
}

void leaving_out(benchmark::State& state, const SceneDef& scene, double seconds_of_scene) {
  const Plan plan = calibrate(scene);
  const LeanPlan lean = leave_out(plan, {.tolerance = 0.01, .seconds = seconds_of_scene});
  std::optional<Simulation> full, less;
  const auto start = [&] {
    full.emplace(plan);
    less.emplace(lean.plan, lean.solver);
  };
  start();
  alternate(
      state, "full",
      [&] {
        if (less->time() > seconds_of_scene) start();
        return seconds([&] { less->step(); });
      },
      [&] { return seconds([&] { full->step(); }); });
  state.counters["joints"] = static_cast<double>(plan.joints.size());
  state.counters["joints_left"] = static_cast<double>(lean.plan.joints.size());
  state.counters["items"] = static_cast<double>(lean.plan.left_out.size());
  state.counters["promised"] = lean.all.error;
  state.counters["measured"] = lean.all.measured;
}

void frame(benchmark::State& state) { leaving_out(state, scene_of("frame"), 5); }
void frame_pushed(benchmark::State& state) { leaving_out(state, scene_of("frame_pushed"), 5); }
void frame_large(benchmark::State& state) { leaving_out(state, scene_of("frame_large"), 5); }
void car(benchmark::State& state) { leaving_out(state, scene_of("car"), 10); }
void crane(benchmark::State& state) { leaving_out(state, scene_of("harbour_crane"), 6); }
void viaduct(benchmark::State& state) { leaving_out(state, scene_of("viaduct"), 5); }
BENCHMARK(frame)->Name("leaving_out/frame")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(frame_pushed)->Name("leaving_out/frame_pushed")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(frame_large)->Name("leaving_out/frame_large")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(car)->Name("leaving_out/car")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(crane)->Name("leaving_out/harbour_crane")->UseManualTime()->Unit(benchmark::kMicrosecond);
BENCHMARK(viaduct)->Name("leaving_out/viaduct")->UseManualTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ductile::bench
