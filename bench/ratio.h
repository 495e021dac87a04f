// Two things timed in turn in one run, so that both see the same machine: what is reported is the median of
// their ratios, which a busy neighbour hardly moves.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "ductile/clock.h"

namespace ductile {

/// The loop of a benchmark that has a yardstick. `ours` and `yardstick` do a small share of the work each
/// time they are called and return the seconds that one unit of it took. The benchmark (registered with
/// UseManualTime) shows our time; counters: `vs_NAME`, the median ratio; `us` and `NAME_us`, the median
/// times.
template <class Ours, class Yardstick>
void alternate(benchmark::State& state, const std::string& name, Ours&& ours, Yardstick&& yardstick) {
  std::vector<double> ratios, our_times, yardstick_times;
  for (auto _ : state) {
    const double a = ours(), b = yardstick();
    state.SetIterationTime(a);
    ratios.push_back(a / b);
    our_times.push_back(a);
    yardstick_times.push_back(b);
  }
  state.counters["vs_" + name] = median(ratios);
  state.counters["us"] = 1e6 * median(our_times);
  state.counters[name + "_us"] = 1e6 * median(yardstick_times);
}

}  // namespace ductile
