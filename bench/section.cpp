// Sections beside one plain shoelace pass over the same vertices, which is the least that any integral over
// an outline can cost.
#include "ductile/section.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <numbers>
#include <random>

#include "ratio.h"

namespace {
using namespace ductile;

/// A ragged pear, all vertices seen from the centre: no symmetry, centroid and plastic neutral axis apart.
Ring asymmetric(int n) {
  std::mt19937 random(static_cast<unsigned>(n));
  std::uniform_real_distribution<double> uniform(0, 1);
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.8 * uniform(random)) / n;
    const double r = 0.1 * (1 + 0.4 * std::cos(angle) + 0.3 * std::sin(2 * angle) + 0.1 * uniform(random));
    ring.push_back({0.3 + 1.5 * r * std::cos(angle), -0.2 + r * std::sin(angle)});
  }
  return ring;
}

[[gnu::noinline]] double shoelace(const Point* p, std::size_t n) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < n; ++i) sum += p[i].x * p[i + 1].y - p[i + 1].x * p[i].y;
  return (sum + p[n - 1].x * p[0].y - p[0].x * p[n - 1].y) / 2;
}

/// s of this thread's processor time for one call of f, from as many calls as fill a tenth of a millisecond.
template <class F>
auto timed(const F& f) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const auto measure = [f, now](int calls) {
    const double start = now();
    for (int i = 0; i < calls; ++i) f();
    return (now() - start) / calls;
  };
  int calls = 1;
  while (measure(calls) * calls < 1e-4) calls *= 2;
  return [measure, calls] { return measure(calls); };
}

template <class Ours>
void beside_shoelace(benchmark::State& state, const Ring& ring, const Ours& ours) {
  alternate(state, "shoelace", timed(ours),
            timed([&] { benchmark::DoNotOptimize(shoelace(ring.data(), ring.size())); }));
  const double vertices = static_cast<double>(ring.size());
  state.counters["ns_per_vertex"] = 1000 * state.counters["us"] / vertices;
  state.counters["shoelace_ns_per_vertex"] = 1000 * state.counters["shoelace_us"] / vertices;
}

/// Another direction every time, so that nothing is learnt from the last.
Point next_direction() {
  static double angle = 0;
  angle += 0.61803398874989485;
  if (angle > 2 * std::numbers::pi) angle -= 2 * std::numbers::pi;
  return {std::cos(angle), std::sin(angle)};
}

std::vector<Point> directions() {
  std::vector<Point> all(1024);
  for (Point& d : all) d = next_direction();
  return all;
}

constexpr Material steel{.yield_stress = 355e6, .youngs_modulus = 210e9};

void capacities(benchmark::State& state) {
  const Ring ring = asymmetric(static_cast<int>(state.range(0)));
  const Section section({ring}, steel);
  const std::vector<Point> all = directions();
  std::size_t i = 0;
  beside_shoelace(state, ring, [&] { benchmark::DoNotOptimize(section.capacities(all[i++ % all.size()])); });
}
BENCHMARK(capacities)
    ->Name("section/capacities")
    ->UseManualTime()
    ->Iterations(101)
    ->Arg(4)
    ->Arg(64)
    ->Arg(1024)
    ->Arg(16384);

void capacities_cast_iron(benchmark::State& state) {
  const Ring ring = asymmetric(static_cast<int>(state.range(0)));
  const Section section({ring}, materials::cast_iron);
  const std::vector<Point> all = directions();
  std::size_t i = 0;
  beside_shoelace(state, ring, [&] { benchmark::DoNotOptimize(section.capacities(all[i++ % all.size()])); });
}
BENCHMARK(capacities_cast_iron)
    ->Name("section/capacities_two_senses")
    ->UseManualTime()
    ->Iterations(101)
    ->Arg(64)
    ->Arg(1024);

void moment_at(benchmark::State& state) {
  const Ring ring = asymmetric(static_cast<int>(state.range(0)));
  const Section section({ring}, steel);
  const double N = section.capacities({0, 1}).N;
  const std::vector<Point> all = directions();
  std::size_t i = 0;
  beside_shoelace(state, ring, [&] {
    ++i;
    const double n = static_cast<double>(i * 37 % 191) / 100 - 0.95;
    benchmark::DoNotOptimize(section.moment_at(all[i % all.size()], n * N, 0));
  });
}
BENCHMARK(moment_at)->Name("section/moment_at_N")->UseManualTime()->Iterations(101)->Arg(64)->Arg(1024);

void elastic(benchmark::State& state) {
  const Ring ring = asymmetric(static_cast<int>(state.range(0)));
  const Section section({ring}, steel);
  const std::vector<Point> all = directions();
  std::size_t i = 0;
  beside_shoelace(state, ring, [&] { benchmark::DoNotOptimize(section.elastic(all[i++ % all.size()])); });
}
BENCHMARK(elastic)->Name("section/elastic")->UseManualTime()->Iterations(101)->Arg(64);

void interaction(benchmark::State& state) {
  const Ring ring = asymmetric(64);
  const Section section({ring}, steel);
  const double tolerance = std::pow(10, -static_cast<double>(state.range(0)));
  beside_shoelace(state, ring, [&] {
    benchmark::DoNotOptimize(section.interaction({0.6, 0.8}, 0.02, tolerance));
  });
  state.counters["points"] = static_cast<double>(section.interaction({0.6, 0.8}, 0.02, tolerance).size());
}
BENCHMARK(interaction)
    ->Name("section/interaction_tolerance_1e-")
    ->UseManualTime()
    ->Iterations(101)
    ->Arg(2)
    ->Arg(3)
    ->Arg(5);

void validation(benchmark::State& state) {
  const Outline outline{asymmetric(static_cast<int>(state.range(0))), {}};
  beside_shoelace(state, outline.outer, [&] { benchmark::DoNotOptimize(validate(outline)); });
}
BENCHMARK(validation)
    ->Name("section/validate")
    ->UseManualTime()
    ->Iterations(21)
    ->Arg(4)
    ->Arg(64)
    ->Arg(1024)
    ->Arg(100000)
    ->Unit(benchmark::kMicrosecond);

void construction(benchmark::State& state) {
  const Outline outline{asymmetric(static_cast<int>(state.range(0))), {}};
  beside_shoelace(state, outline.outer, [&] { benchmark::DoNotOptimize(Section(outline, steel)); });
}
BENCHMARK(construction)->Name("section/construct")->UseManualTime()->Iterations(101)->Arg(4)->Arg(64);

/// A comb with 25000 teeth at a slant: where sorting by one coordinate leaves all pairs to check.
void validation_comb(benchmark::State& state) {
  const int teeth = static_cast<int>(state.range(0)) / 4;
  Outline comb{{{-1, 1.1}, {-1, 1}}, {}};
  for (int i = 0; i < teeth; ++i) {
    const double x = -1 + 2.0 * i / teeth, w = 1.0 / teeth;
    if (i > 0) comb.outer.push_back({x, 1});
    comb.outer.push_back({x, -1});
    comb.outer.push_back({x + w, -1});
    comb.outer.push_back({x + w, 1});
  }
  comb.outer.push_back({1, 1.1});
  for (Point& p : comb.outer) p = {0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y};
  for (auto _ : state) benchmark::DoNotOptimize(validate(comb));
  state.counters["vertices"] = static_cast<double>(comb.outer.size());
}
BENCHMARK(validation_comb)->Name("section/validate_comb")->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
