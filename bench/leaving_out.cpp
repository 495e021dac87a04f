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

void leaving_out(benchmark::State& state, const std::string& scene, double seconds_of_scene) {
  const Plan plan = calibrate(read_scene(DUCTILE_SOURCE_DIR "/scenes/" + scene + ".scene.json"));
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

void each(benchmark::internal::Benchmark* b) { b->UseManualTime()->Unit(benchmark::kMicrosecond); }
BENCHMARK_CAPTURE(leaving_out, frame, "frame", 5)->Apply(each);
BENCHMARK_CAPTURE(leaving_out, frame_pushed, "frame_pushed", 5)->Apply(each);
BENCHMARK_CAPTURE(leaving_out, frame_large, "frame_large", 5)->Apply(each);
BENCHMARK_CAPTURE(leaving_out, car, "car", 10)->Apply(each);
BENCHMARK_CAPTURE(leaving_out, harbour_crane, "harbour_crane", 6)->Apply(each);
BENCHMARK_CAPTURE(leaving_out, viaduct, "viaduct", 5)->Apply(each);

}  // namespace
}  // namespace ductile::bench
