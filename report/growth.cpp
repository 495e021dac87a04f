// Growth: time and memory from ten joints to a hundred thousand.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "case.h"
#include "ductile/clock.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;

struct Family {
  const char* name;
  std::function<Layout(int)> of;  // about so many joints
};

Result run_growth(const Context& context) {
  const Family families[] = {
      {"chain", [](int joints) { return bench::serpentine(joints * 50 / 51); }},
      {"frame",
       [](int joints) {
         const int n = std::max(1, static_cast<int>(std::lround(std::sqrt(joints / 9.0 + 0.05) - 0.2)));
         return bench::frame(n, n);
       }},
      {"grid", [](int joints) {
         const int n = std::max(2, static_cast<int>(std::lround(std::sqrt(joints / 2.0))));
         return bench::grid(n, n);
       }}};
  const auto sizes =
      context.quick ? std::vector<int>{10, 100, 1000} : std::vector<int>{10, 100, 1000, 10000, 100000};
  Result result;
  Table table{"sizes",
              "Every size",
              {{"structure"},
               {"joints"},
               {"bytes per joint"},
               {"largest residual"},
               {"bounds hit"},
               {"swaying, against stock", true},
               {"from", true},
               {"to", true},
               {"at rest, against stock", true},
               {"us per joint, swaying", true},
               {"us per joint, stock", true},
               {"s to build", true}},
              {}};

  Figure memory{.name = "growth-memory",
                .title = "Memory per joint",
                .x = {"joints", true},
                .y = {"bytes per joint", true}};
  double done = 0, dearest = 0, most_bytes = 0;
  int hits = 0;
  for (const Family& family : families) {
    Series ours{.name = "direct, swaying", .look = "swaying"},
        resting{.name = "direct, standing", .look = "standing"},
        stock{.name = "stock welds", .look = "stock"}, bytes{.name = family.name, .look = family.name};
    for (const int size : sizes) {
      const Layout layout = family.of(size);
      const double joints = static_cast<double>(layout.welds.size());
      std::optional<Built> built;
      const double to_build = seconds([&] { built.emplace(layout, Built::ours, 10); });
      Built still(layout, Built::ours, 10), welds(layout, Built::stock, 1e-3);
      const int few = size > 10000  ? 1
                      : size > 1000 ? 3
                                    : 10,
                settle = size > 10000 ? 10 : 60, pairs = size > 1000 ? 9 : 21;
      for (int i = 0; i < settle; ++i) {
        bench::shake(*built);
        built->step();
        still.step();
      }
      for (int i = 0; i < 5; ++i) welds.step();
      std::vector<double> ratios, rest_ratios, yard;
      for (int p = 0; p < pairs; ++p) {
        double a = 0;
        for (int i = 0; i < few; ++i) {
          bench::shake(*built);
          a += seconds([&] { built->step(); });
        }
        const double s = seconds([&] {
          for (int i = 0; i < few; ++i) welds.step();
        });
        const double r = seconds([&] {
          for (int i = 0; i < few; ++i) still.step();
        });
        ratios.push_back(a / s), rest_ratios.push_back(r / s), yard.push_back(s / few);
      }
      const auto [ratio, low, high] = spread(ratios, 0.1);
      const double us = 1e6 * median(yard) / joints;
      const double rest = median(rest_ratios), each = static_cast<double>(built->structure->bytes()) / joints;
      for (auto* s : {&ours, &resting, &stock, &bytes})
        s->x.push_back(joints), s->marked.push_back(false),
            s->told.push_back(fmt::format("{:.0f} joints", joints));
      ours.y.push_back(ratio * us), resting.y.push_back(rest * us), stock.y.push_back(us),
          bytes.y.push_back(each);
      ours.told.back() += fmt::format("<br>{:.3g} times stock ({:.3g} … {:.3g})", ratio, low, high);
      table.rows.push_back({family.name, layout.welds.size(), each, built->sum.residual,
                            built->sum.bounds_hit, ratio, low, high, rest, ratio * us, us, to_build});
      hits += built->sum.bounds_hit + still.sum.bounds_hit;
      dearest = std::max(dearest, ratio);
      most_bytes = std::max(most_bytes, each);
      context.progress(++done / static_cast<double>(3 * sizes.size()));
    }
    result.figures.push_back({.name = fmt::format("growth-time-{}", family.name),
                              .group = "growth-time",
                              .tab = family.name,
                              .first = &family == families + 1,
                              .title = fmt::format("Time of a step per joint: {}", family.name),
                              .x = {"joints", true},
                              .y = {"time per joint and step [µs]", true},
                              .series = {std::move(ours), std::move(resting), std::move(stock)}});
    memory.series.push_back(std::move(bytes));
  }
  result.figures.push_back(std::move(memory));
  result.tables = {std::move(table)};
  result.text = {
      "Structures of true steel on ground that shakes sideways (2 Hz, 3 m/s²), so that every step is solved, "
      "and the same standing "
      "still, against the same in stock welds at 8/3 iterations, unloaded. Chains are laid to and fro and "
      "held every 50 pieces, frames "
      "are n storeys of n bays, grids n × n boxes held at one side. Each timed in turn with stock.",
      fmt::format("The dearest took {:.2g} times stock's time; the most memory is {:.0f} bytes a joint.",
                  dearest, most_bytes)};
  result.summary = fmt::format(
      "From ten joints to a hundred thousand a step takes at most {:.2g} times that of stock welds, and "
      "{:.0f} bytes a joint.",
      dearest, most_bytes);
  result.claims = {{"No bound was hit at any size", fmt::format("{} times", hits), hits == 0}};
  return result;
}

}  // namespace

const Case growth{"growth", "Growth: from ten joints to a hundred thousand", run_growth};

}  // namespace ductile::report
