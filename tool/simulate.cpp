// ductile simulate: runs a scene without a window, and tells of forces, usage, damage and energy.
#include "ductile/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command.h"
#include "ductile/files.h"
#include "ductile/picture.h"
#include "ductile/replay.h"
#include "progress.h"

namespace ductile::tool {
namespace {

constexpr double most_steps = 1e7;

struct Options {
  SceneFile scene;
  std::string history, replay, solver = "direct";
  std::vector<std::string> pictures;
  std::vector<double> picture_at;
  double time = 0;
  Stepping stepping;
  bool json = false;
};

Json json(const Point& p) { return {number(p.x), number(p.y)}; }

Json joints_json(const Simulation& simulation) {
  Json list = Json::array();
  for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i) {
    const JointReading j = simulation.joint(i);
    list.push_back({{"name", simulation.plan().joints[i].name},
                    {"N", number(j.N)},
                    {"Q", number(j.Q)},
                    {"M", number(j.M)},
                    {"usage", {{"N", number(j.usage.N)}, {"Q", number(j.usage.Q)}, {"M", number(j.usage.M)}}},
                    {"plastic_rotation", number(j.plastic_rotation)},
                    {"accumulated_rotation", number(j.accumulated_rotation)},
                    {"plastic_axial", number(j.plastic_axial)},
                    {"plastic_shear", number(j.plastic_shear)},
                    {"capacity_used", number(j.capacity_used)},
                    {"broken", j.broken},
                    {"broken_at", number(j.broken_at)},
                    {"dissipated", number(j.dissipated)}});
    if (simulation.plan().joints[i].end) list.back()["length"] = number(j.length);
    if (simulation.plan().joints[i].drive) list.back()["drive"] = number(j.drive);
  }
  return list;
}

Json pieces_json(const Simulation& simulation) {
  Json list = Json::array();
  for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i) {
    const PieceReading p = simulation.piece(i);
    list.push_back({{"name", simulation.plan().pieces[i].name},
                    {"position", json(p.position)},
                    {"angle", number(p.angle)},
                    {"velocity", json(p.velocity)},
                    {"angular_velocity", number(p.angular_velocity)}});
  }
  return list;
}

/// The terms of the energy by their names; NaN with iterative joints, which keep no ledger.
std::vector<std::pair<const char*, double>> energy_of(const Simulation& simulation) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Energy e = simulation.ledger() ? simulation.ledger()->energy()
                                       : Energy{nan, nan, nan, nan, nan, nan, nan, nan, nan, nan};
  return {{"kinetic", e.kinetic},        {"potential", e.potential},   {"elastic", e.elastic},
          {"external", e.external},      {"dissipated", e.dissipated}, {"damping", e.damping},
          {"contacts", e.contacts},      {"numerical", e.numerical},   {"clamped", e.clamped},
          {"total_error", e.total_error}};
}

Json energy_json(const Simulation& simulation) {
  Json object;
  for (const auto& [name, value] : energy_of(simulation)) object[name] = number(value);
  return object;
}

/// A field of CSV by RFC 4180, whatever a name brings along.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

/// One row a step: time, energies, every piece's pose and every joint's forces and plastic offsets.
class History {
 public:
  History(NewFiles& files, std::string file) : files_(files), file_(std::move(file)) {}

  void head(const Simulation& simulation) {
    const Plan& plan = simulation.plan();
    std::string line = "time";
    for (const auto& [name, value] : energy_of(simulation)) line += fmt::format(",{}", name);
    const auto add = [&](const std::string& name, std::initializer_list<const char*> values) {
      for (const char* value : values) line += ',' + field(name + ' ' + value);
    };
    for (const Piece& piece : plan.pieces) add(piece.name, {"x", "y", "angle"});
    for (const PlannedJoint& joint : plan.joints)
      add(joint.name, {"N", "Q", "M", "plastic_rotation", "plastic_axial", "plastic_shear", "broken"});
    files_.write(file_, line + "\n");
  }
  void row(const Simulation& simulation) {
    fmt::memory_buffer line;
    const auto out = std::back_inserter(line);
    fmt::format_to(out, "{}", simulation.time());
    for (const auto& [name, value] : energy_of(simulation)) fmt::format_to(out, ",{}", value);
    for (std::size_t i = 0; i < simulation.plan().pieces.size(); ++i) {
      const PieceReading p = simulation.piece(i);
      fmt::format_to(out, ",{},{},{}", p.position.x, p.position.y, p.angle);
    }
    for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i) {
      const JointReading j = simulation.joint(i);
      fmt::format_to(out, ",{},{},{},{},{},{},{}", j.N, j.Q, j.M, j.plastic_rotation, j.plastic_axial,
                     j.plastic_shear, j.broken ? 1 : 0);
    }
    line.push_back('\n');
    files_.write(file_, {line.data(), line.size()});
  }

 private:
  NewFiles& files_;
  std::string file_;
};

std::string damage(const std::vector<JointReading>& joints) {
  const auto yielded = std::count_if(joints.begin(), joints.end(), [](auto& j) { return j.dissipated > 0; });
  const auto broken = std::count_if(joints.begin(), joints.end(), [](auto& j) { return j.broken; });
  return fmt::format("{} of {} joints yielded, {} broke", yielded, joints.size(), broken);
}

/// The panels of --picture, taken as their times come by.
class Pictures {
 public:
  explicit Pictures(const Options& options)
      : due_(options.picture_at), half_step_(0.50001 * options.stepping.dt) {
    if (options.pictures.empty()) return;
    if (due_.empty()) due_ = {0, options.time};
    std::sort(due_.begin(), due_.end());
  }
  void look(const Simulation& simulation) {
    for (; next_ < due_.size() && simulation.time() > due_[next_] - half_step_; ++next_) {
      Panel panel = panel_of(simulation, "");
      panel.title = fmt::format("{:.4g} s: {}", simulation.time(), damage(panel.joints));
      panels_.push_back(std::move(panel));
    }
  }
  std::string svg(const Simulation& simulation, const Options& options) {
    const std::string how = fmt::format("{} joints, {} solver, steps of {:.3g} s",
                                        simulation.plan().joints.size(), options.solver, options.stepping.dt);
    return picture_svg(
        simulation.plan(),
        {.title = title_of(options.scene.name), .subtitle = how, .panels = std::move(panels_)});
  }

 private:
  std::vector<double> due_;
  double half_step_;
  std::size_t next_ = 0;
  std::vector<Panel> panels_;
};

std::string table(const Simulation& simulation, const std::string& scene) {
  std::size_t widest = 5;
  std::vector<JointReading> joints;
  for (std::size_t i = 0; i < simulation.plan().joints.size(); ++i) {
    joints.push_back(simulation.joint(i));
    widest = std::max(widest, simulation.plan().joints[i].name.size());
  }
  std::string text =
      fmt::format("{}: {} steps of {:.6g} s, {}; {} us a step\n\n", scene, simulation.steps(),
                  simulation.stepping.dt, damage(joints), shown(simulation.time_per_step_us()));
  text += fmt::format("{:<{}} {:>12} {:>12} {:>12} {:>6} {:>12} {:>12} {:>6}\n", "joint", widest, "N [N]",
                      "Q [N]", "M [N m]", "M use", "rot. [rad]", "diss. [J]", "limit");
  const auto percent = [](double share) {
    return std::isfinite(share) ? fmt::format("{:.0f} %", 100 * share) : std::string("-");
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const JointReading& j = joints[i];
    text += fmt::format("{:<{}} {:>12} {:>12} {:>12} {:>6} {:>12} {:>12} {:>6}\n",
                        one_line(simulation.plan().joints[i].name), widest, shown(j.N), shown(j.Q),
                        shown(j.M), percent(j.usage.M), shown(j.plastic_rotation), shown(j.dissipated),
                        j.broken ? "broke" : percent(j.capacity_used));
  }
  text += "\nenergy [J]:";
  for (const auto& [name, value] : energy_of(simulation)) text += fmt::format(" {} {}", name, shown(value));
  return text + "\n";
}

struct Result {
  std::string text;
  int unsolved = 0;  // solves that did not reach their tolerance
};

Result run(const Options& options) {
  const Outputs outputs{
      {"--history", {options.history}}, {"--replay", {options.replay}}, {"--picture", options.pictures}};
  keep_apart(outputs);
  keep_inputs({options.scene.name}, outputs);
  const double steps = std::round(options.time / options.stepping.dt);
  if (steps < 1 && options.time > 0) {
    throw InvalidInput(
        {{"command line:--dt", fmt::format("is {:.3g} s, longer than --time", options.stepping.dt),
          "give a step that fits into the time"}});
  }
  if (!(steps <= most_steps)) {
    throw InvalidInput({{"command line:--time", fmt::format("asks for {:.3g} steps", steps),
                         fmt::format("let it be at most {:.0e} steps of --dt", most_steps)}});
  }
  for (const double at : options.picture_at) {
    if (at > options.time)
      throw InvalidInput({{"command line:--picture-at", fmt::format("has {:g} s, after the end", at),
                           fmt::format("name times up to --time, {:g} s", options.time)}});
  }
  const JointSolver solver = options.solver == "direct"      ? JointSolver::direct
                             : options.solver == "iterative" ? JointSolver::iterative
                                                             : JointSolver::stock;
  Plan plan = plan_of(options.scene, NotInPlan::made, outputs);
  std::optional<Simulation> simulation;
  in_file(options.scene, [&] { simulation.emplace(std::move(plan), solver, options.stepping, true); });
  NewFiles files(outputs);
  std::optional<History> history;
  if (!options.history.empty()) {
    history.emplace(files, options.history);
    history->head(*simulation);
    history->row(*simulation);
  }
  Replay replay(simulation->plan());
  if (!options.replay.empty()) replay.take(*simulation);
  Pictures pictures(options);
  pictures.look(*simulation);
  int unsolved = 0;
  {
    Progress progress;
    while (static_cast<double>(simulation->steps()) < steps) {
      simulation->step();
      if (const Structure* structure = simulation->structure()) {
        unsolved += structure->report().bounds_hit - structure->report().parted;
      }
      if (history) history->row(*simulation);
      if (!options.replay.empty()) replay.take(*simulation);
      pictures.look(*simulation);
      progress.show(static_cast<double>(simulation->steps()) / steps);
    }
  }
  if (!options.replay.empty())
    files.write(options.replay,
                replay.page(std::filesystem::path(options.scene.name).filename().string(), *simulation));
  if (!options.pictures.empty()) files.write_pictures(options.pictures, pictures.svg(*simulation, options));
  files.keep();
  if (const Structure* structure = simulation->structure()) {
    for (const std::string& warning : structure->warnings()) fmt::print(stderr, "warning: {}\n", warning);
  }
  if (!options.json) return {table(*simulation, options.scene), unsolved};
  const Json result{{"time_per_step_us", number(simulation->time_per_step_us())},
                    {"joints", joints_json(*simulation)},
                    {"pieces", pieces_json(*simulation)},
                    {"energy", energy_json(*simulation)},
                    {"unsolved", unsolved}};
  return {result.dump() + "\n", unsolved};
}

}  // namespace

void add_simulate(CLI::App& app, std::string& output) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("simulate", "Run a scene and report forces, usage, damage and energy");
  add_scene(command, options->scene);
  command->add_option("--time", options->time, "how long, s")->required()->check(finite(0));
  command->add_option("--dt", options->stepping.dt, "time step, s (default 1/60)")->check(finite(0, true));
  command
      ->add_option(
          "--solver", options->solver,
          "direct: all joints together; iterative: as in the paper; stock: Box2D's welds, which never "
          "yield")
      ->check(CLI::IsMember({"direct", "iterative", "stock"}))
      ->capture_default_str();
  constexpr int most_iterations = 1'000'000;
  command
      ->add_option("--velocity-iterations", options->stepping.velocity_iterations,
                   "as b2World::Step (default 8)")
      ->check(CLI::Range(1, most_iterations));
  command
      ->add_option("--position-iterations", options->stepping.position_iterations,
                   "as b2World::Step (default 3)")
      ->check(CLI::Range(0, most_iterations));
  command->add_option("--history", options->history, "write every step's values to this CSV file")
      ->check(file_name());
  auto* picture = add_picture(command, options->pictures, "draw the scene before and after");
  command->add_option("--picture-at", options->picture_at, "draw it at these times instead: 0,1.5,4")
      ->delimiter(',')
      ->needs(picture)
      ->check(finite(0));
  command
      ->add_option("--replay", options->replay,
                   "write this HTML page, which plays the run back in any browser")
      ->check(file_name());
  command->add_flag("--json", options->json, "one JSON object");
  command->callback([options, &output] {
    const Result result = run(*options);
    output = result.text;
    if (result.unsolved > 0) {
      throw Unsolved(fmt::format(
          "{} solves did not reach their tolerance; what is printed is not the solution", result.unsolved));
    }
  });
}

}  // namespace ductile::tool
