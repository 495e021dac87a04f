// What the structure costs: the whole b2World::Step (and Structure::update) with our joints against the same
// scene with stock b2WeldJoint, 60 Hz, 8/3 iterations, sleeping off on both sides.
//
// A stock structure under load folds, and costs more: in the broad phase, and in its joints, which take all
// three position iterations of a step, and one where nothing pulls at them. So where ours stands, swings or
// sways under load, stock stays straight in a gravity of 1e-3 m/s²: the cheapest stock there is. Chains swing
// beside stock under the same load as well, both without their broad phase. In rigid motion both move alike.
#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>

#include "ratio.h"
#include "structures.h"

namespace ductile::bench {
namespace {

constexpr double g = 10, nearly_none = 1e-3;

struct Case {
  std::string name;
  std::function<Layout()> layout;
  double gravity = g, stock_gravity = nearly_none;
  std::function<void(Built&)> start = [](Built&) {};        // both sides
  std::function<void(Built&)> before_step = [](Built&) {};  // ours, not timed
  double settle = 5;                                        // s that ours runs before it is timed
  double damping = 0;                                       // 1/s, of its bodies for the s before that
  int steps = 300;                                          // timed
  bool broad_phase = true;                                  // it is timed, too
};

// A few steps of one, a few of the other: each finds its own data in the cache, as in a game.
constexpr int few = 5;

double time_steps(Built& b, const std::function<void(Built&)>& before_step, bool broad_phase = true) {
  double sum = 0;
  for (int i = 0; i < few; ++i) {
    before_step(b);
    sum += seconds([&] { b.step(); });
    if (!broad_phase) sum -= 1e-3 * double{b.world.GetProfile().broadphase};
  }
  return sum / few;
}

void report(benchmark::State& state, const Built& b, std::size_t joints) {
  const double steps = static_cast<double>(state.iterations()) * few;
  state.counters["joints"] = static_cast<double>(joints);
  state.counters["rounds"] = b.sum.rounds / steps;
  state.counters["factorisations"] = b.sum.factorisations / steps;
  state.counters["solves"] = b.sum.solves / steps;
  state.counters["skipped"] = b.sum.skipped / steps;
  state.counters["projections"] = b.sum.projections / steps;
  state.counters["bounds_hit"] = b.sum.bounds_hit;
  state.counters["ns_per_joint"] = 1e3 * state.counters["us"].value / static_cast<double>(joints);
  state.counters["bytes_per_joint"] = static_cast<double>(b.structure->bytes()) / static_cast<double>(joints);
}

void run(benchmark::State& state, const Case& c) {
  const Layout layout = c.layout();
  Built ours(layout, Built::ours, c.gravity), stock(layout, Built::stock, c.stock_gravity);
  c.start(ours);
  c.start(stock);
  if (c.damping > 0) {
    damp(ours, c.damping);
    ours.run(20);
    damp(ours, 0);
  }
  for (int i = 0; i < 60 * c.settle; ++i) {
    c.before_step(ours);
    ours.step();
  }
  stock.run(0.25);
  ours.sum = {};
  double whole = 0, without_joints = 0;
  const auto look_at_last_step = [&](Built& b) {
    const b2Profile& p = b.world.GetProfile();
    whole += p.step;
    without_joints += p.step - p.solveInit - p.solveVelocity - p.solvePosition;
  };
  alternate(
      state, "stock", [&] { return time_steps(ours, c.before_step, c.broad_phase); },
      [&] { return time_steps(stock, look_at_last_step, c.broad_phase); });
  report(state, ours, layout.welds.size());
  // What vs_stock would be of joints that cost nothing: islands, broad phase, contacts.
  state.counters["free_joints"] = without_joints / whole;
  double bent = 0;
  for (const auto* joint : ours.structure->joints())
    bent = std::max(bent, std::abs(joint->elastic(rotation)));
  state.counters["elastic_rotation"] = bent;
  // These cases are elastic: what flows or breaks would be another case.
  if (ours.structure->joints().size() != layout.welds.size()) state.SkipWithError("joints broke");
  for (const auto* joint : ours.structure->joints()) {
    if (joint->dissipated() > 0) return state.SkipWithError("joints flowed");
  }
}

void spin(Built& b) { b.set_rigid_motion(1, 2, 0.5); }

Layout softened(Layout layout, double by) {
  layout.E /= by;
  return layout;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const int pieces : {10, 40}) {
    const std::string name = "joint/chain/" + std::to_string(pieces);
    // At rest, which undamped chains never are.
    all.push_back({.name = name + "/rest",
                   .layout = [=] { return chains(100, pieces, false); },
                   .settle = 30,
                   .damping = 3});
    // Gravity has set in at once: they swing about their rest. Ten fit a second-level cache of 2 MB.
    for (const int count : {100, 10}) {
      const Case swinging{.name = name + "/swinging" + (count == 10 ? "/ten" : ""),
                          .layout = [=] { return chains(count, pieces, false); },
                          .settle = 0.25};
      Case loaded = swinging;
      loaded.name += "/loaded";
      loaded.stock_gravity = g;
      loaded.broad_phase = false;
      all.push_back(swinging);
      all.push_back(loaded);
    }
    // Hinged at the wall they fall, at 25 m/s in the end: Box2D's broad phase alone costs more than stock's
    // whole step.
    all.push_back(
        {.name = name + "/pendulum", .layout = [=] { return chains(100, pieces, true); }, .settle = 1});
  }
  const std::tuple<std::string, int, int> frames[] = {{"160", 4, 4}, {"2000", 15, 15}};
  for (const auto& [size, storeys, bays] : frames) {
    const std::string name = "joint/frame/" + size;
    const auto layout = [storeys = storeys, bays = bays] { return frame(storeys, bays); };
    // Steel damps little: a large frame would sway for minutes after gravity has set in at once.
    all.push_back({.name = name + "/rest", .layout = layout, .damping = 3});
    all.push_back({.name = name + "/rigid_motion",
                   .layout = [=] { return layout().let_go(); },
                   .gravity = 0,
                   .stock_gravity = 0,
                   .start = spin,
                   .settle = 1});
    all.push_back({.name = name + "/swaying", .layout = layout, .before_step = shake});
  }
  all.push_back({.name = "joint/grid/30/rest", .layout = [] { return grid(30, 30); }, .damping = 3});
  all.push_back({.name = "joint/grid/30/rigid_motion",
                 .layout = [] { return grid(30, 30).let_go(); },
                 .gravity = 0,
                 .stock_gravity = 0,
                 .start = spin,
                 .settle = 1});
  for (const int softer : {1, 100, 1000}) {
    all.push_back(
        {.name = "joint/grid/30/deforming" + (softer == 1 ? "" : "/softer_" + std::to_string(softer)),
         .layout = [=] { return softened(grid(30, 30), softer); },
         .before_step = shake});
  }
  for (const int pieces : {1000, 10000, 100000}) {
    const std::string name = "joint/scale/chain/" + std::to_string(pieces);
    const auto layout = [=] { return serpentine(pieces); };
    const int steps = 50;  // of all sizes the same: what settles asks for fewer rounds from second to second
    all.push_back({.name = name + "/rest", .layout = layout, .damping = 3, .steps = steps});
    all.push_back({.name = name + "/settling", .layout = layout, .settle = 1, .steps = steps});
    all.push_back(
        {.name = name + "/swaying", .layout = layout, .before_step = shake, .settle = 1, .steps = steps});
  }
  const auto building = [] { return frame(25, 44); };
  all.push_back({.name = "joint/scale/building/10000/rest", .layout = building, .settle = 2, .damping = 3});
  all.push_back({.name = "joint/scale/building/10000/settling", .layout = building, .settle = 2});
  return all;
}

// A bomb into a frame, and the five seconds after it, against a step of the same frame, standing, that
// factors H once (a stiffness was set anew). Several times over: vs_quiet is the median over the episodes of
// the mean over the steps; worst_us the dearest step, each step by its fastest episode.
void impact(benchmark::State& state, const Layout& layout, double bomb_mass, double x, double y) {
  constexpr int steps = 300;
  std::vector<double> ratios, times, quiet_times, fastest(steps, INFINITY);
  double flowing = 0, broken = 0;
  StepReport sum;
  for (auto _ : state) {
    Built hit(layout, Built::ours, g), quiet(layout, Built::ours, g);
    hit.run(2);
    quiet.run(2);
    hit.sum = quiet.sum = {};
    hit.throw_bomb(bomb_mass, 1, x, y, 30, 0);
    double after = 0;
    std::vector<double> quiet_steps;
    for (int i = 0; i < steps; ++i) {
      const double one = seconds([&] { hit.step(); });
      after += one / steps;
      auto& best = fastest[static_cast<std::size_t>(i)];
      best = std::min(best, one);
      const RowDef same{.stiffness =
                            layout.E * std::pow(layout.pieces[0].height, 3) / 12 / layout.welds[0].span};
      quiet.structure->joints()[0]->set_stiffness(rotation, same.stiffness, 0);
      const double quiet_step = seconds([&] { quiet.step(); });
      // Where the forecast is as good as a solution, nothing is factored at all.
      if (quiet.structure->report().factorisations == 1) quiet_steps.push_back(quiet_step);
    }
    if (quiet_steps.size() < steps / 2) return state.SkipWithError("too few quiet steps factor once");
    state.SetIterationTime(after);
    times.push_back(after);
    quiet_times.push_back(median(quiet_steps));
    ratios.push_back(after / quiet_times.back());
    flowing = 0;
    for (const auto* joint : hit.structure->joints()) flowing += joint->dissipated() > 0 ? 1 : 0;
    broken = static_cast<double>(layout.welds.size() - hit.structure->joints().size());
    sum = hit.sum;
  }
  state.counters["vs_quiet"] = median(ratios);
  state.counters["us"] = 1e6 * median(times);
  state.counters["quiet_us"] = 1e6 * median(quiet_times);
  const double worst = *std::max_element(fastest.begin(), fastest.end());
  state.counters["worst_us"] = 1e6 * worst;
  state.counters["worst_vs_quiet"] = worst / median(quiet_times);
  state.counters["joints"] = static_cast<double>(layout.welds.size());
  state.counters["flowed"] = flowing;
  state.counters["broken"] = broken;
  state.counters["rounds"] = static_cast<double>(sum.rounds) / steps;
  state.counters["factorisations"] = static_cast<double>(sum.factorisations) / steps;
  state.counters["bounds_hit"] = sum.bounds_hit;
}

// A block of a tonne in the middle of each bay of the roof, against the same frame without; and what the
// blocks cost in stock Box2D. Of steel that damps both come to rest, where nothing is solved any more; of
// steel that does not they sway, by some 10 µm/s.
void loaded(benchmark::State& state, int size, bool rests) {
  Layout layout = frame(size, size);
  if (rests) layout.damping = 0.05;
  Built with(layout, Built::ours, g), without(layout, Built::ours, g), stock_with(layout, Built::stock, g),
      stock_without(layout, Built::stock, g);
  for (Built* b : {&with, &stock_with}) load_roof(*b, size);
  for (Built* b : {&with, &without, &stock_with, &stock_without}) {
    calm(*b);
    if (rests) b->run(60);
  }
  with.sum = without.sum = {};
  const auto run = [](Built& b) { return time_steps(b, [](Built&) {}); };
  std::vector<double> stock, stock_more;  // share, s
  alternate(
      state, "without", [&] { return run(with); },
      [&] {
        const double loaded = run(stock_with), bare = run(stock_without);
        stock.push_back(loaded / bare);
        stock_more.push_back(loaded - bare);
        return run(without);
      });
  report(state, with, layout.welds.size());
  state.counters["stock_with_vs_without"] = median(stock);
  state.counters["stock_more_us"] = 1e6 * median(stock_more);
  state.counters["more_us"] = state.counters["us"].value - state.counters["without_us"].value;
}

// Sixty boxes in six rows on the roof of a frame of 160 joints, against the same with stock welds: of so many
// contacts those of the pieces are rows, and the rest pushes.
void pile(benchmark::State& state) {
  const Layout layout = frame(4, 4);
  Built ours(layout, Built::ours, g), stock(layout, Built::stock, g);
  for (Built* b : {&ours, &stock}) {
    pile_on_roof(*b);
    b->run(40);  // until it has settled: the frame swings under what fell on it
  }
  ours.sum = {};
  const auto run = [](Built& b) { return time_steps(b, [](Built&) {}); };
  alternate(
      state, "stock", [&] { return run(ours); }, [&] { return run(stock); });
  report(state, ours, layout.welds.size());
}

const bool registered = [] {
  for (const int size : {4, 15}) {
    for (const bool rests : {true, false}) {
      const std::string name = size == 4 ? "joint/loaded/frame/160" : "joint/loaded/frame/2000";
      benchmark::RegisterBenchmark((name + (rests ? "/rest" : "")).c_str(),
                                   [=](benchmark::State& state) { loaded(state, size, rests); })
          ->UseManualTime()
          ->Iterations(60)
          ->Unit(benchmark::kMicrosecond);
    }
  }
  benchmark::RegisterBenchmark("joint/pile/frame/160", pile)
      ->UseManualTime()
      ->Iterations(60)
      ->Unit(benchmark::kMicrosecond);
  for (const Case& c : cases()) {
    benchmark::RegisterBenchmark(c.name.c_str(), [c](benchmark::State& state) { run(state, c); })
        ->UseManualTime()
        ->Iterations(c.steps / few)
        ->Unit(benchmark::kMicrosecond);
  }
  struct Impact {
    const char* name;
    int size;
    double mass, y;
    bool breaks;
  };
  // At 30 m/s from the left against a column between two storeys.
  for (const Impact& i : {Impact{"joint/impact/frame/160", 4, 2e3, 3.9, true},
                          Impact{"joint/impact/frame/160/heavy", 4, 5e4, 3.9, false},
                          Impact{"joint/impact/frame/2000", 15, 2e4, 18.9, true},
                          Impact{"joint/impact/frame/2000/heavy", 15, 2e5, 18.9, false}}) {
    benchmark::RegisterBenchmark(i.name,
                                 [i](benchmark::State& state) {
                                   Layout layout = frame(i.size, i.size);
                                   layout.breaks = i.breaks;
                                   impact(state, layout, i.mass, -2, i.y);
                                 })
        ->UseManualTime()
        ->Iterations(3)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace ductile::bench
