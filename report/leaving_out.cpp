// Leaving out: what each scene does without, the error that was promised and the one that a run shows, the
// time saved.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "ductile/design.h"
#include "ductile/files.h"
#include "ductile/scene_list.h"

namespace ductile::report {
namespace {

Result run_leaving_out(const Context& context) {
  Result result;
  Table table{"items",
              "Every item",
              {{"scene"},
               {"what", true},  // what saves no time stays, so the list is the clock's too
               {"promised error", true},
               {"measured error", true},
               {"time saved", true}},
              {}};
  Figure figure{.name = "leaving-out",
                .title = "What each scene does without, as a whole",
                .x = {"promised error, share of the size", true},
                .y = {"measured error, share of the size", true},
                .floor = 1e-9};
  int kept_promises = 0, items = 0;
  std::vector<SceneEntry> scenes(std::begin(scene_list), std::end(scene_list));
  if (context.quick)
    std::erase_if(scenes, [](auto& s) { return s.name != "cantilever" && s.name != "B2-1"; });
  double done = 0;
  for (const SceneEntry& entry : scenes) {
    const Plan plan = calibrate(
        read_scene(std::filesystem::path(DUCTILE_SCENES) / fmt::format("{}.scene.json", entry.name)));
    const LeanPlan lean = leave_out(plan, {.seconds = context.quick ? 1. : entry.seconds});
    const auto add = [&](const std::string& what, const LeftOut& item) {
      table.rows.push_back({entry.name, what, item.error, item.measured, item.time_saved});
    };
    for (const LeftOut& item : lean.plan.left_out) {
      add(item.what, item);
      ++items;
      kept_promises += item.measured <= item.error ? 1 : 0;
    }
    add(lean.plan.left_out.empty() ? "nothing" : "all together", lean.all);
    for (const LeftOut& item : lean.kept)
      add(item.what +
              (item.measured > item.error ? " (kept: more error)" : " (kept: no time is surely saved)"),
          item);
    figure.series.push_back({.name = std::string(entry.name),
                             .look = entry.outcome == Outcome::stands  ? "stands"
                                     : entry.outcome == Outcome::bends ? "bends"
                                                                       : "breaks",
                             .x = {std::max(lean.all.error, 1e-9)},
                             .y = {lean.all.measured},
                             .told = {fmt::format("{} items, {:.0f} % of the step's time saved",
                                                  lean.plan.left_out.size(), 100 * lean.all.time_saved)},
                             .marked = {false},
                             .line = false});
    context.progress(++done / static_cast<double>(scenes.size()));
  }
  result.text = {
      "What a scene does not need is left out on request: pieces whose joints nothing can bring to yield are "
      "merged, elasticity "
      "that is not seen becomes rigid, caps that are not reached go, and the direct solver goes where joints "
      "are alone. Each item "
      "comes with the displacement error that it may bring, is run with and without, and stays out only "
      "where the run shows no "
      "more, and is 98 % sure to save time. The table names what was tried and kept, too. Colours: what "
      "becomes of the scene (stands, bends, breaks)."};
  result.summary = fmt::format("{} of {} items that scenes can do without bring no more error than promised.",
                               kept_promises, items);
  result.claims = {{"What was left out brings no more error than promised",
                    fmt::format("{} of {} items", kept_promises, items), kept_promises == items}};
  result.figures = {std::move(figure)};
  result.tables = {std::move(table)};
  return result;
}

}  // namespace

const Case leaving_out{"leaving_out", "Leaving out: what scenes do without", run_leaving_out};

}  // namespace ductile::report
