#include "ductile/view.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "command.h"

namespace ductile::tool {
namespace {

struct Options {
  ViewDef view;
  std::string scene, screenshot;
  bool json = false;
};

std::string run(Options options) {
  keep_inputs({options.scene}, {{"--screenshot", {options.screenshot}}});
  options.view.scene = options.scene;
  options.view.screenshot = options.screenshot;
  const ViewCost cost = view(options.view);
  if (options.view.frames < 0) return "";
  if (options.json) {
    return Json{{"frames", cost.frames},
                {"drawing_ms", {{"median", number(cost.median_ms)}, {"most", number(cost.most_ms)}}}}
               .dump() +
           "\n";
  }
  return fmt::format("{}: {} frames, {:.2f} ms of CPU time to draw one (median; most {:.2f} ms)\n",
                     options.scene, cost.frames, cost.median_ms, cost.most_ms);
}

}  // namespace

void add_view(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("view", "The window: run a scene, look into its joints, play with it, edit it");
  command->add_option("SCENE", options->scene, "scene file, level of R.U.B.E. or SVG drawing")->required();
  add_scale(command, options->view.metres_per_unit);
  command->add_option("--select", options->view.select, "name of a joint to look into; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--tab", options->view.tab, "what is open at first on the right")
      ->check(CLI::IsMember({"joint", "joints", "edit", "events", "ledger", "make"}));
  command->add_flag("--forces", options->view.forces, "draw forces and moments at first");
  command->add_option("--zoom", options->view.scale, "size of everything (default: as the display asks for)")
      ->check(CLI::Range(0.5, 8.));
  auto* frames = command->add_option("--frames", options->view.frames, "run so many steps, then end")
                     ->check(CLI::Range(0L, 10'000'000L));
  command->add_option("--screenshot", options->screenshot, "write the last frame to this PNG file")
      ->check(file_name())
      ->needs(frames);
  command->add_flag("--json", options->json, "what drawing cost as one JSON object")->needs(frames);
  command->add_flag("--trace", options->view.trace)->group("");  // for tests: a line of JSON a frame
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
