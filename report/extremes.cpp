// Extremes: each promise at its edge and beyond it, in motion and with contacts, and what is said there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "case.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double dt = 1. / 60, length = 20, g = 10;  // s, m, m/s²

struct Seen {
  double error;      // relative
  std::string said;  // what the structure warns of
};
Seen seen(double error, Built& b) {
  std::string said;
  for (const std::string& warning : b.structure->warnings()) said += (said.empty() ? "" : "; ") + warning;
  return {error, std::move(said)};
}

Layout rigid(Layout layout) {
  layout.E = unlimited;
  layout.yields = false;
  return layout;
}

/// A free beam of ten pieces that flies for a second.
Seen fly(double speed) {
  Built b(rigid(bench::chains(1, 10, false)).let_go(), Built::ours, 0);
  b.set_rigid_motion(speed, 0, 0);
  const double from = b.pieces[0]->GetPosition().x;
  for (int i = 0; i < 60; ++i) b.step(dt);
  return seen((double{b.pieces[0]->GetPosition().x} - from) / speed - 1, b);
}

/// A free beam of 1 m in four pieces that spins for ten seconds: its kinetic energy.
Seen spin(double rate) {
  Layout layout;
  for (int i = 0; i < 4; ++i) {
    const int box = layout.box((i - 1.5) / 4, 0, 0, 0.25, 0.1);
    if (i > 0) layout.weld(box - 1, box, (i - 2) / 4., 0, 0, 0.25);
  }
  Built b(rigid(std::move(layout)), Built::ours, 0);
  b.set_rigid_motion(0, 0, rate);
  const double first = kinetic_energy(b.pieces);
  for (int i = 0; i < 600; ++i) b.step(dt);
  return seen(kinetic_energy(b.pieces) / first - 1, b);
}

/// A heavy box on the tip of a cantilever of ten pieces, its mass to a piece's: the root's moment after ten
/// seconds. Together they weigh as much whatever the ratio.
Seen heavy_tip(double ratio, bool welded) {
  constexpr double box_mass = 50e3;  // kg
  Layout layout = rigid(bench::chains(1, 10, false));
  for (Layout::Piece& piece : layout.pieces) piece.density = box_mass / ratio / (piece.length * piece.height);
  const double beam = 10 * box_mass / ratio * g * length / 2;
  double at = length;
  if (welded) {
    layout.weld(9, layout.box(length + 0.5, 0, 0, 1, 1), length, 0, 0, 1);
    layout.pieces.back().density = box_mass;
    at += 0.5;
  }
  Built b(layout, Built::ours, g);
  if (!welded) {
    at = length - 1;
    add_box(b.world, {.x = at, .y = 1, .mass = box_mass, .group = 0});
  }
  double sum = 0;
  for (int i = 0; i < 600; ++i) {
    b.step(dt);
    if (i >= 540) sum += std::abs(double{b.joints[0]->GetReactionTorque(60)}) / 60;
  }
  return seen(sum / (beam + box_mass * g * at) - 1, b);
}

/// A rigid-plastic cantilever that swings as one at a rate: its root gives way over ½ I ω²/M_p, in so many
/// steps.
Seen stop(double steps) {
  constexpr double rate = 1, inertia = Steel::density * length * length * length / 3;
  Layout layout = bench::chains(1, 10, false);
  layout.E = unlimited;
  layout.breaks = false;
  Built b(layout, Built::ours, 0);
  const double M_p = inertia * rate / (steps * dt);  // it stops after I ω/M_p
  for (b2Joint* joint : b.joints) {
    auto* j = static_cast<ElasticPlasticJoint*>(joint);
    for (const Row row : {axial, shear, rotation}) j->set_caps(row, unlimited, unlimited);
  }
  auto* root = static_cast<ElasticPlasticJoint*>(b.joints[0]);
  root->set_caps(rotation, M_p, M_p);
  b.set_rigid_motion(0, 0, rate);
  for (int i = 0; i < static_cast<int>(steps) + 60; ++i) b.step(dt);
  return seen(std::abs(root->plastic(rotation)) / (inertia * rate * rate / 2 / M_p) - 1, b);
}

struct Promise {
  std::string what, quantity, edge;  // the promise's own edge
  double allowed;
  std::vector<std::pair<double, bool>> at;  // how far, and whether that is promised
  std::function<Seen(double)> run;
};

Result run_extremes(const Context& context) {
  const std::vector<Promise> promises{
      {"speed of a free beam [m/s]",
       "way after 1 s",
       "Box2D moves a body by at most 2 m a step",
       0.001,
       {{10, true}, {110, true}, {240, false}},
       fly},
      {"rate of a free spin [rad/s]",
       "kinetic energy after 10 s",
       "0.1 rad a step, where ¾ of its square is lost; Box2D turns a body by at most 90°",
       0.01,
       {{1, true}, {6, true}, {60, false}, {200, false}},
       spin},
      {"welded masses, ratio",
       "root moment",
       "1e6",
       0.001,
       {{1e2, true}, {1e4, true}, {1e6, true}, {1e8, false}},
       [](double r) { return heavy_tip(r, true); }},
      {"masses that touch, ratio",
       "root moment",
       "1e3",
       0.01,
       {{1, true}, {1e2, true}, {1e3, true}, {1e5, false}},
       [](double r) { return heavy_tip(r, false); }},
      // Of a blow that lasts T steps, (T − K)²/T² of the flow is missing, K
      // the whole number next to T (tests/joint/warnings_test.cpp).
      {"steps that a plastic blow lasts",
       "plastic rotation",
       "three quarters, where a ninth is missing",
       0.112,
       {{20, true}, {5, true}, {1.5, true}, {0.75, true}, {0.6, false}, {0.2, false}},
       stop}};
  Result result;
  Table table{.name = "edges",
              .title = "Promises at their edge and beyond",
              .columns = {{"what"},
                          {"how far"},
                          {"promised"},
                          {"judged by"},
                          {"error [%]"},
                          {"allowed [%]"},
                          {"edge"},
                          {"what ductile says"}},
              .rows = {},
              .open = true};
  int kept = 0, promised = 0, silent = 0;
  std::string broken, quiet;
  for (const Promise& p : promises) {
    for (const auto& [far, in] : p.at) {
      const Seen s = p.run(far);
      const bool good = std::abs(s.error) <= p.allowed;
      const std::string where = fmt::format("{} {:g}", p.what, far);
      if (in) {
        ++promised;
        kept += good ? 1 : 0;
        if (!good) broken += fmt::format("; {} is {:+.2g} % off", where, 100 * s.error);
      } else if (!good && s.said.empty()) {
        ++silent;
        quiet += fmt::format("; {} is {:+.2g} % off", where, 100 * s.error);
      }
      table.rows.push_back({p.what, far, in ? "yes" : "beyond", p.quantity, 100 * s.error, 100 * p.allowed,
                            p.edge, s.said.empty() ? "nothing" : s.said});
    }
    context.progress(1);
  }
  result.text = {
      "At 60 Hz and 8/3 iterations, rigid joints: within each promise, at its edge, and beyond it, with the "
      "words of "
      "Structure::warnings(). The speed and the turn of a step are Box2D's own limits."};
  result.summary = fmt::format("Extremes: {} of {} cases within a promise are kept.", kept, promised);
  result.claims = {{"Within each promise, its edge included, the error is below what is allowed",
                    fmt::format("{} of {}{}", kept, promised, broken), kept == promised},
                   {"Beyond it, what goes wrong is told",
                    silent == 0 ? "all of it" : quiet.substr(2) + ", untold", silent == 0}};
  result.tables = {std::move(table)};
  return result;
}

}  // namespace

const Case extremes{"extremes", "Extremes: promises at their edge and beyond", run_extremes};

}  // namespace ductile::report
