// What a designer waits for between moving the pointer and seeing what the static check says: a node of a
// frame of 2000 joints is dragged in the window's workbench.
#include "maker.h"

#include <benchmark/benchmark.h>

namespace ductile::viewer {
namespace {

/// Bays of 5 m by 3 m, each with a diagonal.
SceneDef frame(int bays, int floors) {
  SceneDef scene = empty_scene();
  const double width = 5.0 * bays;
  scene.bodies[0].outline.outer = {{-1, -1}, {width + 1, -1}, {width + 1, 0}, {-1, 0}};
  for (int floor = 0; floor < floors; ++floor) {
    const double low = 3.0 * floor, high = low + 3;
    for (int bay = 0; bay <= bays; ++bay) {
      const double left = 5.0 * bay;
      scene = with_beam(scene, {{left, low}, {left, high}}, {});
      if (bay == bays) continue;
      scene = with_beam(scene, {{left, high}, {left + 5, high}}, {});
      scene = with_beam(scene, {{left, low}, {left + 5, high}}, {});
    }
  }
  return scene;
}

void drag(benchmark::State& state) {
  Workbench bench;
  bench.edit(frame(12, 8));
  Maker maker;
  maker.choose(bench, Maker::Tool::move);
  const Point node{30, 12};
  maker.point(bench, node, 0.1);
  maker.press(bench);
  double by = 0;
  for (auto _ : state) {
    by = by > 1.5 ? 0.5 : by + 0.5;
    maker.point(bench, node + Point{by, 0}, 0);
  }
  state.counters["joints"] = static_cast<double>(bench.plan().joints.size());
  if (!bench.verdict().starts_with("yields at")) state.SkipWithError(bench.verdict().c_str());
}
BENCHMARK(drag)->Name("making/drag/2000")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ductile::viewer
