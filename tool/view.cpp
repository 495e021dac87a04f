// ductile view: opens the window.
#include "ductile/view.h"

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "command.h"
#include "ductile/level.h"

namespace ductile::tool {
namespace {

struct Options {
  ViewDef view;
  std::string scene, screenshot;
  bool json = false;
};

// view() reads the scene itself; where a screenshot is to be written, this asks before which files it names.
// A pipe can be read once only.
void keep_named(const std::string& scene, const Outputs& outputs) {
  std::error_code none;
  if (outputs.front().second.front().empty() || !std::filesystem::is_regular_file(scene, none)) return;
  const std::string text = read_text(scene);
  if (!is_rube(text) && !is_drawing(text)) scene_of({.name = scene}, text, outputs);
}

std::string run(Options options) {
  const Outputs outputs{{"--screenshot", {options.screenshot}}};
  keep_inputs({options.scene}, outputs);
  keep_named(options.scene, outputs);
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
