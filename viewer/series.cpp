#include "series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ductile::viewer {

std::vector<Column> columns(const Timeline& run, const std::function<double(const Frame&)>& value,
                            std::size_t width, double start, double end) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Column> list(width, {nan, nan, nan, nan});
  const double per_second = end > start ? static_cast<double>(width) / (end - start) : 0;
  for (long step = run.first_kept(); step <= run.last_kept(); ++step) {
    const Frame& frame = *run.kept(step);
    const double v = value(frame), at = (frame.time - start) * per_second;
    if (!std::isfinite(v) || at < 0) continue;
    Column& c = list[std::min(width - 1, static_cast<std::size_t>(at))];
    if (std::isnan(c.low)) {
      c = {v, v, v, v};
    } else {
      c = {std::min(c.low, v), std::max(c.high, v), c.first, v};
    }
  }
  return list;
}

long step_at(const Timeline& run, double time) {
  long low = run.first_kept(), high = run.last_kept();
  while (low < high) {
    const long middle = low + (high - low) / 2;
    if (run.kept(middle)->time < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  if (low > run.first_kept() && time - run.kept(low - 1)->time < run.kept(low)->time - time) --low;
  return low;
}

}  // namespace ductile::viewer
