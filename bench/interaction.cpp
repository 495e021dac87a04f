// What N, Q and M within one yield surface cost against independent caps: the same frame of three bays and
// four storeys with each, 60 Hz, 8/3 iterations, for ten seconds. Standing under its own weight, where the
// surfaces are looked at and nothing flows; and pushed over, where they do.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "ductile/box2d.h"
#include "ratio.h"

namespace ductile::bench {
namespace {

constexpr int few = 5, steps = 600;

Outline box(double left, double low, double right, double high) {
  return {{{left, low}, {right, low}, {right, high}, {left, high}}, {}};
}

// Bars of S235, 0.3 and 0.4 m × 0.1 m; `push` grows at every storey over 5 s.
SceneDef frame_of_bars(double push, bool interaction) {
  constexpr int storeys = 4, bays = 3;
  SceneDef scene{.interaction = interaction};
  scene.bodies.push_back(
      {.name = "floor", .type = BodyType::static_body, .outline = box(-5, -1, 5 * bays + 5, 0)});
  BodyDef bar{.material = materials::S235, .depth = 0.1, .group = -1};
  for (int s = 0; s < storeys; ++s) {
    const double low = 3 * s + (s > 0 ? 0.2 : 0), high = 3 * s + 2.8;
    const std::string beam = "beam" + std::to_string(s);
    for (int b = 0; b <= bays; ++b) {
      bar.name = "column" + std::to_string(s) + "." + std::to_string(b);
      bar.outline = box(5 * b - 0.15, low, 5 * b + 0.15, high);
      bar.pieces = 4;
      scene.bodies.push_back(bar);
      scene.joints.push_back({.a = s > 0 ? "beam" + std::to_string(s - 1) : "floor", .b = bar.name});
      scene.joints.push_back({.a = bar.name, .b = beam});
    }
    bar.name = beam;
    bar.outline = box(-0.15, high, 5 * bays + 0.15, high + 0.4);
    bar.pieces = 8 * bays;
    scene.bodies.push_back(bar);
    scene.loads.push_back({.body = beam, .at = {0, high + 0.2}, .force = {push, 0}, .ramp = 5});
  }
  return scene;
}

struct Pushed {
  explicit Pushed(const SceneDef& scene)
      : plan(calibrate(scene)), structure(build(world, plan, {}, &built)) {}
  double step() {
    apply_loads(world, plan, built, step_ / 60.0);
    const double time = seconds([&] {
      world.Step(1 / 60.0f, 8, 3);
      structure.update();
    });
    factorisations += structure.report().factorisations;
    bounds_hit += structure.report().bounds_hit;
    worst = std::max(worst, time);
    sum += time;
    ++step_;
    return time;
  }
  b2World world{{0, 0}};
  Plan plan;
  Built built;
  Structure structure;
  double worst = 0, sum = 0;  // s
  int factorisations = 0, bounds_hit = 0;

 private:
  int step_ = 0;
};

void interaction(benchmark::State& state, double push) {
  Pushed surface(frame_of_bars(push, true)), caps(frame_of_bars(push, false));
  const auto run = [](Pushed& frame) {
    double sum = 0;
    for (int i = 0; i < few; ++i) sum += frame.step();
    return sum / few;
  };
  alternate(
      state, "caps", [&] { return run(surface); }, [&] { return run(caps); });
  int flowed = 0;
  for (const ElasticPlasticJoint* joint : surface.structure.joints()) flowed += joint->yielded() ? 1 : 0;
  state.counters["joints"] = static_cast<double>(surface.plan.joints.size());
  state.counters["flowed"] = flowed;
  state.counters["all_vs_caps"] = surface.sum / caps.sum;
  state.counters["worst_us"] = 1e6 * surface.worst;
  state.counters["caps_worst_us"] = 1e6 * caps.worst;
  state.counters["factorisations"] = static_cast<double>(surface.factorisations) / steps;
  state.counters["caps_factorisations"] = static_cast<double>(caps.factorisations) / steps;
  state.counters["bounds_hit"] = surface.bounds_hit + caps.bounds_hit;
}
BENCHMARK_CAPTURE(interaction, standing, 0)
    ->Name("joint/interaction/standing")
    ->UseManualTime()
    ->Iterations(steps / few)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(interaction, pushed_over, 400e3)
    ->Name("joint/interaction/pushed_over")
    ->UseManualTime()
    ->Iterations(steps / few)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ductile::bench
