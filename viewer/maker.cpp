#include "maker.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace ductile::viewer {

void Maker::choose(Workbench& bench, Tool tool) {
  cancel(bench);
  tool_ = tool;
  if (tool != Tool::none) {
    bench.playing = false;
    if (bench.run().cursor() > 0) bench.restart();
  }
  bench.check_at_rest(tool != Tool::none);
}

void Maker::point(Workbench& bench, Point at, double reach) {
  Point to{grid * std::round(at.x / grid), grid * std::round(at.y / grid)};
  // What is being drawn has its own end under the pointer.
  for (const Point node : nodes(drawn_ ? before_ : bench.scene())) {
    if (length(node - at) > reach) continue;
    reach = length(node - at);
    to = node;
  }
  put(bench, to);
}

void Maker::step(Workbench& bench, int columns, int rows) {
  const auto on = [this](double from, int by) {
    return by == 0 ? from : grid * (std::round(from / grid) + by);
  };
  put(bench, {on(cursor_.x, columns), on(cursor_.y, rows)});
}

void Maker::next_node(Workbench& bench, int by) {
  std::vector<Point> all = nodes(drawn_ ? before_ : bench.scene());
  if (all.empty()) return;
  const auto before = [](Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::sort(all.begin(), all.end(), before);
  const auto n = static_cast<std::ptrdiff_t>(all.size());
  const auto here = std::lower_bound(all.begin(), all.end(), cursor_, before) - all.begin();
  const bool on_node = here < n && length(all[static_cast<std::size_t>(here)] - cursor_) < node_size;
  const std::ptrdiff_t next = by > 0 ? here + (on_node ? 1 : 0) : here - 1;
  put(bench, all[static_cast<std::size_t>((next + n) % n)]);
}

void Maker::put(Workbench& bench, Point at) {
  if (length(at - cursor_) < node_size) return;
  cursor_ = at;
  if (start_) draw(bench);
}

void Maker::press(Workbench& bench) {
  if (tool_ == Tool::none) return;
  bench.playing = false;
  if (bench.run().cursor() > 0) return bench.restart();  // what is seen stands elsewhere
  if (tool_ == Tool::beam || tool_ == Tool::move) {
    start_ = cursor_;
    before_ = bench.scene();
    edition_ = bench.edition();
    problem_.clear();
    return;
  }
  try {
    if (tool_ == Tool::support) bench.edit(with_next_support(bench.scene(), cursor_));
    if (tool_ == Tool::load) {
      const auto& loads = bench.scene().loads;
      const bool same = std::any_of(loads.begin(), loads.end(), [this](const LoadDef& l) {
        return length(l.at - cursor_) < node_size && l.force.x == 0 && l.force.y == -force;
      });
      bench.edit(with_load(bench.scene(), cursor_, {0, same ? 0 : -force}));
    }
    if (tool_ == Tool::remove) bench.edit(without(bench.scene(), cursor_));
  } catch (const InvalidInput& error) {
    bench.message = "This cannot be.\n" + std::string(error.what());
  }
}

bool Maker::interrupted(const Workbench& bench) {
  if (bench.edition() == edition_) return false;
  start_.reset();
  drawn_ = false;
  return true;
}

void Maker::draw(Workbench& bench) {
  if (interrupted(bench)) return;
  try {
    bench.edit(tool_ == Tool::beam ? with_beam(before_, {*start_, cursor_}, style)
                                   : with_node_moved(before_, *start_, cursor_),
               drawn_);
    drawn_ = true;
    edition_ = bench.edition();
    problem_.clear();
  } catch (const InvalidInput& error) {
    problem_ = error.what();
  }
}

void Maker::release(Workbench& bench) {
  if (!start_ || interrupted(bench)) return;
  const bool moved = length(cursor_ - *start_) >= node_size;
  if (moved && !problem_.empty()) bench.message = "This cannot be.\n" + problem_;
  if (!moved || !problem_.empty()) return cancel(bench);
  start_.reset();
  drawn_ = false;
}

void Maker::cancel(Workbench& bench) {
  if (!start_ || interrupted(bench)) return;
  if (drawn_) bench.undo();
  start_.reset();
  drawn_ = false;
}

}  // namespace ductile::viewer
