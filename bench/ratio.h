// Two things timed in turn in one run, so that both see the same machine: what is reported is the median of
// their ratios, which a busy neighbour hardly moves.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace ductile {

/// Seconds on this thread's own clock, which stands still while others have the processor; where there is
/// none (POSIX has it), on the wall's.
inline double now() {
#ifdef CLOCK_THREAD_CPUTIME_ID
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
#else
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
#endif
}

/// The time that f() takes; some 0.3 µs of it are the clock's.
template <class F>
double seconds(F&& f) {
  const double start = now();
  f();
  return now() - start;
}

/// The upper median; 0 of nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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
