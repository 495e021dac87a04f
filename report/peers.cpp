// Peers: the same cantilever in the engines that others build games and robots with.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "case.h"
#include "ductile/clock.h"
#include "npm.h"
#include "report_page.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double length = 20, g = 10;                                                           // m, m/s²
constexpr double exact_moment = Steel::density * g * length * length / 2, M_p = Steel::fy / 4;  // N m

struct Way {
  const char* engine;
  Built::Kind kind;
  bool steel, iterates;  // elastic, damped; it is told how often to iterate
};
constexpr Way ways[] = {{"ductile, rigid", Built::ours, false, false},
                        {"ductile, steel", Built::ours, true, false},
                        {"the paper's scheme", Built::iterative, false, true},
                        {"Box2D 2.4.1", Built::stock, false, true}};

struct Run {
  int n, hz, iterations;
};

struct Measured {
  std::string engine, per;  // what is counted by `iterations`
  Run run;
  double moment, tip, gap, us;  // M/M_exact − 1; m; m; per joint and step
};

Measured measure(const Way& way, const Run& run, double seconds) {
  Layout layout = bench::chains(1, run.n, false);
  layout.yields = false;
  if (way.steel)
    layout.damping = 0.1;  // s: as the springs in peers.mjs
  else
    layout.E = unlimited;
  Built b(layout, way.kind, g);
  const double dt = 1. / run.hz;
  const auto steps = static_cast<int>(seconds * run.hz);
  constexpr int batch = 5;
  Measured m{way.engine, way.iterates ? "iterations" : "", run, 0, 0, 0, 0};
  int counted = 0;
  for (int i = 0; i < steps; i += batch) {
    m.us += 1e6 * ductile::seconds([&] {
              for (int k = 0; k < batch; ++k) b.step(dt, run.iterations, (3 * run.iterations + 7) / 8);
            });
    for (const b2Joint* joint : b.joints)
      m.gap = std::max(m.gap, double{(joint->GetAnchorA() - joint->GetAnchorB()).Length()});
    if (i < steps - 5 * run.hz) continue;
    m.moment += std::abs(double{b.joints[0]->GetReactionTorque(static_cast<float>(run.hz))});
    ++counted;
  }
  m.moment = m.moment / counted / exact_moment - 1;
  m.tip = b.pieces.back()->GetPosition().y;
  m.us /= steps * static_cast<double>(run.n);
  return m;
}

/// A thing that drops on the tip of a steel cantilever at rest.
struct Thing {
  const char* name;
  double mass, speed;  // kg, m/s
};
constexpr Thing things[] = {{"light and fast: 1 t at 100 m/s", 1000, 100},
                            {"heavy and slow: 300 t at 0.3 m/s", 300e3, 0.3}};

struct Blow {
  double moment = 0, used = 0;  // the largest of the root over M_p; of what it may turn plastically
};
Blow strike(const Thing& thing, Built::Kind kind, int hz, int iterations) {
  Layout layout = bench::chains(1, 5, false);
  layout.damping = 0.01;
  Built b(layout, kind, g);
  const double dt = 1. / hz;
  for (int i = 0; i < 5 * hz; ++i) b.step(dt, iterations, (3 * iterations + 7) / 8);
  const double radius = 0.3, top = double{b.pieces.back()->GetPosition().y} + 0.5;
  b.throw_bomb(thing.mass, radius, 19.5, top + radius + 0.02, 0, -thing.speed);
  Blow blow;
  for (int i = 0; i < 2 * hz; ++i) {
    b.step(dt, iterations, (3 * iterations + 7) / 8);
    if (kind == Built::ours) {
      if (b.structure->joints().size() < 5) return {1, 1};
      const ElasticPlasticJoint* root = b.structure->joints()[0];
      blow.moment = std::max(blow.moment,
                             std::abs(double{b.joints[0]->GetReactionTorque(static_cast<float>(hz))}) / M_p);
      blow.used = std::max(blow.used, root->accumulated_rotation() / 0.4);
    } else {
      blow.moment = std::max(blow.moment,
                             std::abs(double{b.joints[0]->GetReactionTorque(static_cast<float>(hz))}) / M_p);
    }
  }
  return blow;
}

Result run_peers(const Context& context) {
  const double seconds = context.quick ? 10 : 60;
  const auto sizes = context.quick ? std::vector<int>{10} : std::vector<int>{5, 10, 20, 40};
  constexpr std::pair<int, int> rates[] = {{60, 10}, {60, 40}, {120, 10}, {240, 10}};
  std::vector<Measured> all;
  for (const Way& way : ways)
    for (const int n : sizes)
      for (const auto& [hz, iterations] : rates)
        if (way.iterates || iterations == 10) all.push_back(measure(way, {n, hz, iterations}, seconds));
  context.progress(0.4);
  std::string absent;
  ::setenv("DUCTILE_PEERS", peers_program, 1);
  const auto said = run_with_cache(peers_script, context.quick ? "--quick" : "");
  const Json others = Json::parse(said.value_or(""), nullptr, false);
  if (others.is_object()) {
    for (const Json& r : others["rows"]) {
      const auto number = [&](const char* key) { return r[key].is_number() ? r[key].get<double>() : NAN; };
      all.push_back({r["engine"],
                     r["per"],
                     {r["n"], r["hz"], r["iterations"]},
                     number("moment"),
                     number("tip"),
                     number("gap"),
                     number("us")});
    }
    for (const Json& reason : others["absent"]) absent += " Not here: " + reason.get<std::string>() + ".";
  } else {
    absent = " Nothing of npm could be had here: planck, phaser-box2d, box2d3-wasm and MuJoCo are missing.";
  }
  context.progress(0.8);

  Result result;
  Table table{.name = "cantilever",
              .title = "A cantilever of 20 m × 1 m × 1 m, steel, for a minute",
              .columns = {{"engine"},
                          {"pieces"},
                          {"steps a second"},
                          {"iterations or sub-steps"},
                          {"error of the root moment"},
                          {"tip [m]"},
                          {"largest gap [m]"},
                          {"us per joint and step", true}},
              .rows = {}};
  for (const Measured& m : all)
    table.rows.push_back({m.engine, m.run.n, m.run.hz,
                          m.per.empty() ? Json("–") : Json(fmt::format("{} {}", m.run.iterations, m.per)),
                          m.moment, m.tip, m.gap, m.us});
  std::vector<std::string> engines;
  for (const Measured& m : all)
    if (std::find(engines.begin(), engines.end(), m.engine) == engines.end()) engines.push_back(m.engine);
  constexpr double floor = 1e-7;
  int beaten = 0;
  std::string by;
  for (const int n : sizes) {
    Figure figure{
        .name = fmt::format("peers-moment-{}", n),
        .group = "peers-moment",
        .tab = fmt::format("{} pieces", n),
        .first = n == 20,
        .title = fmt::format("Root moment of a cantilever of {} pieces", n),
        .caption =
            "Lower left is better. Each mark is an engine at 60, 120 or 240 steps a second and 10 or 40 "
            "iterations; point at it for which, for how far its tip is from where it was drawn after a "
            "minute, and for its largest gap. planck and phaser-box2d run in JavaScript, "
            "box2d3-wasm and MuJoCo in WebAssembly, the others as machine code: what their runtime takes "
            "is in their times.",
        .x = {"time per joint and step [us]", true},
        .y = {"error of the root's moment, relative", true},
        .floor = floor};
    for (const std::string& engine : engines) {
      Series s{.name = engine, .look = engine, .line = false};
      for (const Measured& m : all) {
        if (m.engine != engine || m.run.n != n) continue;
        s.x.push_back(m.us);
        s.y.push_back(std::abs(m.moment));
        s.told.push_back(
            fmt::format("{} Hz{}{}; tip {:.3g} m, gap {:.2g} m", m.run.hz, m.per.empty() ? "" : ", ",
                        m.per.empty() ? "" : fmt::format("{} {}", m.run.iterations, m.per), m.tip, m.gap));
        s.marked.push_back(m.run.hz == 60 && m.run.iterations == 10);
      }
      figure.series.push_back(std::move(s));
    }
    result.figures.push_back(std::move(figure));
    for (const Measured& ours : all) {
      if (ours.run.n != n || ours.run.hz != 60 || ours.engine != "ductile, rigid") continue;
      for (const Measured& m : all) {
        if (m.run.n != n || m.engine.starts_with("ductile") || m.us >= ours.us) continue;
        if (std::max(std::abs(m.moment), 1e-5) >= std::max(std::abs(ours.moment), 1e-5)) continue;
        ++beaten;
        by += fmt::format("{}{} at {} pieces", by.empty() ? ": " : ", ", m.engine, n);
      }
    }
  }
  const auto worst = [&](const std::string& engine, double Measured::*value) {
    double most = 0;
    for (const Measured& m : all)
      if (m.engine == engine && m.run.hz == 60 && m.run.iterations == 10)
        most = std::max(most, std::abs(m.*value));
    return most;
  };
  Table blows{.name = "thresholds",
              .title = "What breaks: a force threshold, and plastic work",
              .columns = {{"what hits the tip"},
                          {"solver"},
                          {"steps a second"},
                          {"largest moment of the root over M_p"},
                          {"a threshold of M_p says"},
                          {"of what the root may turn plastically"}},
              .rows = {},
              .open = true};
  bool same = true;
  for (const Thing& thing : things) {
    std::vector<double> used;
    for (const int iterations : {10, 40})
      for (const int hz : {60, 120, 240}) {
        const Blow stock = strike(thing, Built::stock, hz, iterations);
        blows.rows.push_back({thing.name, fmt::format("Box2D 2.4.1, {} iterations", iterations), hz,
                              stock.moment, stock.moment > 1 ? "breaks" : "holds", nullptr});
      }
    for (const int hz : {60, 120, 240}) {
      const Blow ours = strike(thing, Built::ours, hz, 8);
      used.push_back(ours.used);
      blows.rows.push_back({thing.name, "ductile", hz, ours.moment, "–", ours.used});
    }
    same = same && std::all_of(used.begin(), used.end(), [&](double u) { return (u > 0) == (used[0] > 0); });
  }
  result.text = {
      "The same boxes, steps and units in each engine: a cantilever of steel, 20 m × 1 m × 1 m, of 5 to 40 "
      "welded boxes "
      "under 10 m/s² for a minute. Statics says what its root carries, whatever the boxes. Stock Box2D, "
      "planck and "
      "the paper's scheme iterate; Box2D v3, which phaser-box2d and box2d3-wasm are, takes sub-steps; its "
      "joints are "
      "as soft as it makes them by default. MuJoCo has no welds between boxes but a chain of hinges with the "
      "springs of "
      "a steel beam, in relative coordinates, which cannot gape; it is as exact here as ductile, elastic; it "
      "has no "
      "plastic limits of joints, and nothing that breaks.",
      "AVBD (Giles, Diaz and Yuksel, 2025) is not in this run: its demonstration is in no package, and code "
      "or "
      "recipes of it are none of this project's." +
          absent,
      "A force threshold breaks a joint where the solver's reaction of one step exceeds what it bears. That "
      "reaction is "
      "the impulse of the blow over the length of the step: the shorter the step, the sooner a light thing "
      "breaks what "
      "a heavy one did not. Below, a light fast thing and a heavy slow one drop on the tip of a steel beam "
      "that stands "
      "under its own weight. Plastic work asks for energy beyond what the beam takes elastically."};
  result.summary = fmt::format(
      "Peers: at 60 Hz, 10 iterations and up to {} pieces, ductile's root moment errs by at most {:.1g}; {}.",
      sizes.back(), worst("ductile, rigid", &Measured::moment), [&] {
        std::string list;
        for (const std::string& engine : engines)
          if (!engine.starts_with("ductile"))
            list += fmt::format("{}{} by {:.2g}", list.empty() ? "" : ", ", engine,
                                worst(engine, &Measured::moment));
        return list;
      }());
  result.claims = {{"A minute of any of these cantilevers, rigid, at 60 to 240 Hz: root moment within 1e-5, "
                    "tip within 1 mm",
                    fmt::format("{:.1g}, {:.1g} m at 60 Hz", worst("ductile, rigid", &Measured::moment),
                                worst("ductile, rigid", &Measured::tip)),
                    std::none_of(all.begin(), all.end(),
                                 [](const Measured& m) {
                                   return m.engine == "ductile, rigid" &&
                                          !(std::abs(m.moment) < 1e-5 && std::abs(m.tip) < 1e-3);
                                 })},
                   {"No engine here is both quicker and nearer to statics (errors below 1e-5 count as none)",
                    fmt::format("{} are{}", beaten, by), beaten == 0, true},
                   {"Whether ductile's beam yields under a blow is the same at 60, 120 and 240 Hz",
                    same ? "it is" : "it is not", same}};
  result.tables = {std::move(blows), std::move(table)};
  return result;
}

}  // namespace

const Case peers{"peers", "Peers: the same cantilever in other engines", run_peers};

}  // namespace ductile::report
