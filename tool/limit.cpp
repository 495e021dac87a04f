#include <fmt/format.h>

#include <memory>

#include "command.h"
#include "ductile/design.h"

namespace ductile::tool {
namespace {

struct Options {
  SceneFile scene;
  bool fixed_gravity = false, json = false;
};

std::string run(const Options& options) {
  const Plan plan = plan_of(options.scene);
  const LimitAnalysis limit =
      in_file(options.scene, [&] { return limit_analysis(plan, options.fixed_gravity); });
  Json hinges = Json::array();
  for (const int i : limit.hinges) hinges.push_back(plan.joints[static_cast<std::size_t>(i)].name);
  if (options.json) {
    const Json result{
        {"load_factor", number(limit.load_factor)}, {"hinges", std::move(hinges)}, {"time", limit.time}};
    return result.dump() + "\n";
  }
  const char* what = options.fixed_gravity ? "the loads, gravity as it is" : "the loads and gravity";
  if (limit.load_factor == unlimited)
    return fmt::format("{}: no multiple of {} collapses it\n", options.scene.name, what);
  std::string text =
      fmt::format("{}: collapses at {:.6g} times {}, in\n", options.scene.name, limit.load_factor, what);
  for (const Json& hinge : hinges) text += fmt::format("  {}\n", hinge.get<std::string>());
  if (limit.time > 0) text += fmt::format("the loads are those from {:g} s on\n", limit.time);
  return text;
}

}  // namespace

void add_limit(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("limit", "Collapse load factor and hinges by limit analysis");
  add_scene(command, options->scene);
  command->add_flag("--fixed-gravity", options->fixed_gravity, "multiply the loads only");
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] { output = run(*options); });
}

}  // namespace ductile::tool
