// What a level's designer waits for: static check, critical load, limit analysis and leaving out, of the
// drawing of 500 joints and of the frame of 2085.
#include "ductile/design.h"

#include <benchmark/benchmark.h>

#include <string>

#include "ductile/files.h"

namespace ductile::bench {
namespace {

Plan plan_of(const std::string& name) {
  return calibrate(read_scene(DUCTILE_SOURCE_DIR "/scenes/" + name + ".scene.json"));
}

void check(benchmark::State& state, const std::string& scene) {
  const Plan plan = plan_of(scene);
  for (auto _ : state) benchmark::DoNotOptimize(static_check(plan));
}
void critical(benchmark::State& state, const std::string& scene) {
  const Plan plan = plan_of(scene);
  for (auto _ : state) benchmark::DoNotOptimize(critical_load(plan));
}
void limit(benchmark::State& state, const std::string& scene) {
  const Plan plan = plan_of(scene);
  for (auto _ : state) benchmark::DoNotOptimize(limit_analysis(plan));
}
void leave(benchmark::State& state, const std::string& scene) {
  const Plan plan = plan_of(scene);
  for (auto _ : state) benchmark::DoNotOptimize(leave_out(plan));
}
BENCHMARK_CAPTURE(check, viaduct, "viaduct")->Name("design/check/500")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(check, frame, "frame_large")->Name("design/check/2085")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(critical, viaduct, "viaduct")->Name("design/critical/500")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(critical, frame, "frame_large")
    ->Name("design/critical/2085")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(limit, viaduct, "viaduct")->Name("design/limit/500")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(limit, frame, "frame_large")->Name("design/limit/2085")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(leave, viaduct, "viaduct")->Name("design/leave_out/500")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(leave, frame, "frame_large")->Name("design/leave_out/2085")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ductile::bench
