// What a piece of work costs on the processor, whatever else the machine does.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
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

}  // namespace ductile
