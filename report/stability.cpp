// Stability: mass ratio × stiffness × dt × pieces × solver, every cell run.
//
// The domain in which the direct solver must stand was fixed before the first run: welded mass ratio up to
// 1e4, contact up to 100, dt 1/30 … 1/1000 s, up to 80 pieces, true steel and rigid, below Box2D's speed
// limits (2 m and π/2 a step).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double length = 20, height = 1;  // m
constexpr double share = 0.1;  // of the plastic capacity, that the root carries at rest and a spinning middle
constexpr double g = 10;       // m/s²
constexpr double block_at = 19;  // m: where a block rests
constexpr double rest =
    height / 2 + 0.5 + 2 * b2_polygonRadius;  // of a block of 1 m on the beam: skin on skin, m

/// Where the heavy masses are.
enum class Mass {
  even,
  welded_to_the_tip,
  alternating,
  resting_on_the_tip,
  spinning,
  spinning_alternating,
  tearing
};

struct Row {
  std::string name;
  Mass mass;
  double ratio;  // of the heavy mass to a piece's
  bool promised;
  bool spins() const { return mass >= Mass::spinning; }
};

constexpr auto even = Mass::even, tip = Mass::welded_to_the_tip, alternating = Mass::alternating,
               resting = Mass::resting_on_the_tip, spinning = Mass::spinning,
               spinning_alternating = Mass::spinning_alternating, tearing = Mass::tearing;

std::vector<Row> rows(bool quick) {
  if (quick) {
    return {{"even", even, 1, true},
            {"welded tip 1e4", tip, 1e4, true},
            {"resting block 100", resting, 100, true}};
  }
  return {{"even", even, 1, true},
          {"welded tip, 100", tip, 100, true},
          {"welded tip, 1e4", tip, 1e4, true},
          {"welded tip, 1e6", tip, 1e6, false},
          {"every other piece, 100", alternating, 100, true},
          {"every other piece, 1e4", alternating, 1e4, true},
          {"every other piece, 1e6", alternating, 1e6, false},
          {"resting block, 1", resting, 1, true},
          {"resting block, 10", resting, 10, true},
          {"resting block, 100", resting, 100, true},
          {"resting block, 1000", resting, 1000, false},
          {"spinning, even", spinning, 1, true},
          {"spinning, every other piece, 1e4", spinning_alternating, 1e4, true},
          {"spinning, every other piece, 1e6", spinning_alternating, 1e6, false},
          {"spinning at 3 N_p, every other piece, 1e4", tearing, 1e4, true},
          {"spinning at 3 N_p, every other piece, 1e6", tearing, 1e6, false}};
}

struct Cell {
  bool elastic;
  double dt;
  int pieces;
};

/// What became of a cell.
struct Outcome {
  enum Verdict { stands, drifts, diverges } verdict = stands;
  double residual = 0;  // energy that should not be there, by the energy scale of the cell
  double off = 0;       // how far a piece was from where it belongs in the second half, m
  double ever = 0;      // and at any time
  int bounds_hit = 0;
};
constexpr const char* names[] = {"stands", "drifts", "diverges"};

/// The beam with its masses. A heavy box of 1 m at the tip is as heavy as makes the root carry `share` of its
/// plastic moment; the beam's pieces are lighter by the ratio. Of alternating pieces the heavy ones are
/// steel.
struct Scene {
  Layout layout;
  double gravity = g, block = 0;  // m/s², kg
};

Scene scene_of(const Row& row, const Cell& cell) {
  Scene scene;
  Layout& layout = scene.layout;
  layout = bench::chains(1, cell.pieces, false);
  if (row.spins()) {
    layout = layout.let_go();
    scene.gravity = 0;
  }
  if (!cell.elastic) layout.E = unlimited;
  layout.breaks = false;
  const double l = length / cell.pieces, heavy = share * Steel::fy * height * height / 4 / (g * length) /
                                                 (1 + cell.pieces / (2 * row.ratio));
  for (std::size_t i = 0; i < layout.pieces.size(); ++i) {
    double& density = layout.pieces[i].density;
    if (row.mass == alternating && i % 2 == 0) density /= row.ratio;
    if ((row.mass == spinning_alternating || row.mass == tearing) && i % 2 == 1) density *= row.ratio;
    if (row.mass == tip || row.mass == resting) density = heavy / row.ratio / (l * height);
  }
  if (row.mass == tip) {
    const int box = layout.box(length + 0.5, 0, 0, 1, 1);
    layout.pieces.back().density = heavy;
    layout.weld(box - 1, box, length, 0, 0, (l + 1) / 2);
  }
  if (row.mass == resting) scene.block = heavy;
  return scene;
}

// In the middle of the last step of h seconds, where the velocities belong: half a step's way back, and what
// the solver's ledger tells is stored there. Where there is none, the mean of what was stored before and
// after the step, which is no less; `stored` goes on from step to step.
double energy(const Built& b, const Layout& layout, const b2Body* block, double block_mass, double gravity,
              double h, double& stored) {
  double sum = 0;
  const auto add = [&](const b2Body* body, double mass, double inertia, double y0) {
    const double vx = body->GetLinearVelocity().x, vy = body->GetLinearVelocity().y,
                 w = body->GetAngularVelocity();
    sum += (mass * (vx * vx + vy * vy) + inertia * w * w) / 2 +
           mass * gravity * (double{body->GetWorldCenter().y} - h / 2 * vy - y0);
  };
  for (std::size_t i = 0; i < b.pieces.size(); ++i) {
    const Layout::Piece& p = layout.pieces[i];
    add(b.pieces[i], p.mass(), p.inertia(), p.y);
  }
  if (block != nullptr) add(block, block_mass, block_mass / 6, rest);
  double now = 0;
  if (b.has_ledger) return sum + b.structure->energy().elastic;
  if (b.structure) {
    for (const auto* joint : b.structure->joints()) now += joint->elastic_energy();
  }
  return sum + (std::exchange(stored, now) + now) / 2;
}

// What rests on an elastic beam that swings undamped is lifted by Box2D's corrections of overlap, step by
// step: at 1/30 s by more than 1 % of the scale. It is promised from 50 Hz on.
bool lifts(const Row& row, bool elastic, double dt) { return row.mass == resting && elastic && dt > 0.02; }

Outcome run(const Row& row, const Cell& cell, Built::Kind kind, double seconds) {
  const Scene scene = scene_of(row, cell);
  const Layout& layout = scene.layout;
  Built b(layout, kind, scene.gravity, true);
  b2Body* block = nullptr;
  if (scene.block > 0) {
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = Built::vec(block_at, rest);
    block = b.world.CreateBody(&def);
    b2PolygonShape box;
    box.SetAsBox(0.5f, 0.5f);
    b2FixtureDef fixture;
    fixture.shape = &box;
    fixture.friction = 0.6f;
    fixture.density = static_cast<float>(scene.block);
    block->CreateFixture(&fixture);
  }
  const auto steps = static_cast<int>(std::lround(seconds / cell.dt));
  if (row.spins()) {
    double mass = 0, x = 0, pull = 0;
    for (const auto& p : layout.pieces) mass += p.mass(), x += p.mass() * p.x / length;
    const double middle = x * length / mass;
    for (const auto& p : layout.pieces) pull += p.mass() * std::max(p.x - middle, 0.);
    const double capacity = row.mass == tearing ? 3 * Steel::fy : share * Steel::fy;
    const double omega =
        std::min(3., std::sqrt(capacity * height / pull));  // 3: below the speed limit at 1/30 s
    b.set_rigid_motion(0, -omega * middle, omega);
  }
  double stored = 0;
  const double first = energy(b, layout, block, scene.block, scene.gravity, 0, stored);
  const double EI = Steel::E * std::pow(height, 3) / 12,
               sag = Steel::density * height * g * std::pow(length, 4) / (8 * EI);
  double weight = 0;
  for (const auto& p : layout.pieces) weight += p.mass() * scene.gravity;
  weight += scene.block * scene.gravity;
  const double scale = row.spins() ? first : weight * sag;
  Outcome out;
  std::vector<b2Vec2> halfway;
  double last = first;
  for (int i = 0; i < steps && out.verdict != Outcome::diverges; ++i) {
    b.step(cell.dt);
    out.bounds_hit = b.sum.bounds_hit;
    last = energy(b, layout, block, scene.block, scene.gravity, cell.dt, stored);
    out.residual = std::max(out.residual, (last - first) / scale);
    if (!std::isfinite(last) || out.residual > 0.01) out.verdict = Outcome::diverges;
    double flowed = 0;
    if (b.structure) {
      for (const auto* joint : b.structure->joints())
        flowed = std::max(flowed, joint->accumulated_rotation());
    }
    if (flowed > 0 && row.mass != tearing && out.verdict == Outcome::stands) out.verdict = Outcome::drifts;
    out.ever = std::max(out.ever, out.off);
    if (i == steps / 2) {
      out.off = 0;
      for (const b2Body* piece : b.pieces) halfway.push_back(piece->GetPosition());
    }
    if (row.spins()) {
      // A spinning beam stays straight and as long.
      const double span = (b.pieces.back()->GetWorldCenter() - b.pieces.front()->GetWorldCenter()).Length();
      out.off = std::max(out.off, std::abs(span - (layout.pieces.back().x - layout.pieces.front().x)));
    } else {
      for (std::size_t k = 0; k < b.pieces.size(); ++k) {
        out.off = std::max(out.off, std::hypot(double{b.pieces[k]->GetPosition().x} - layout.pieces[k].x,
                                               double{b.pieces[k]->GetPosition().y} - layout.pieces[k].y));
      }
      if (block != nullptr) {
        out.off = std::max(out.off, std::hypot(double{block->GetPosition().x} - block_at,
                                               double{block->GetPosition().y} - rest));
      }
    }
  }
  out.ever = std::max(out.ever, out.off);
  if (row.mass == tearing) return out;  // it is to flow: its energy alone is judged
  if (!(out.off <= 0.02 * length) && out.verdict == Outcome::stands) out.verdict = Outcome::drifts;
  for (std::size_t k = 0; k < halfway.size() && !cell.elastic && !row.spins(); ++k) {
    const double crept = (b.pieces[k]->GetPosition() - halfway[k]).Length();
    if (!(crept <= 0.001 * length) && out.verdict == Outcome::stands) out.verdict = Outcome::drifts;
  }
  if (row.spins() && last < 0.9 * first && out.verdict == Outcome::stands) out.verdict = Outcome::drifts;
  return out;
}

/// What a user may rely on, row by row of the direct solver's matrix.
Table promises(const std::vector<Row>& rows, const Matrix& direct, const std::vector<double>& steps,
               const std::vector<int>& sizes) {
  Table table{.name = "promises",
              .title = "What is promised of the direct solver",
              .columns = {{"masses"}, {"promised"}, {"stand"}, {"of"}, {"the others"}},
              .rows = {},
              .open = true};
  const std::string domain = fmt::format("{} to {} pieces, steps of 1/{:.0f} to 1/{:.0f} s, rigid and steel",
                                         sizes.front(), sizes.back(), 1 / steps.front(), 1 / steps.back());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& cells = direct.rows[r].cells;
    int stand = 0;
    std::string others;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (cells[c].verdict == "stands") {
        ++stand;
        continue;
      }
      std::string where = direct.columns[c];
      for (std::size_t at; (at = where.find('|')) != std::string::npos;) where.replace(at, 1, ", ");
      others += fmt::format("{}{} pieces {}", others.empty() ? "" : "; ", where, cells[c].verdict);
    }
    const std::string what = !rows[r].promised         ? "no"
                             : rows[r].mass == resting ? domain + " (steel: from 50 Hz on)"
                                                       : domain;
    table.rows.push_back({rows[r].name, what, stand, cells.size(), others});
  }
  return table;
}

Result run_stability(const Context& context) {
  const auto all_rows = rows(context.quick);
  const auto steps = context.quick ? std::vector<double>{1. / 30, 1. / 60}
                                   : std::vector<double>{1. / 30, 1. / 60, 1. / 240, 1. / 1000};
  const auto sizes = context.quick ? std::vector<int>{5, 20} : std::vector<int>{5, 20, 80};
  constexpr double seconds = 4;
  struct Solver {
    const char* name;
    Built::Kind kind;
  };
  constexpr Solver solvers[] = {
      {"direct", Built::ours}, {"iterative", Built::iterative}, {"stock", Built::stock}};
  Result result;
  result.text = {
      "Cantilevers of 20 m × 1 m in 5, 20 and 80 pieces, at four time steps: with even masses; with a heavy "
      "box welded to or "
      "resting near the tip (together a tenth of the root's plastic moment; the beam's pieces are lighter by "
      "the ratio); "
      "with every other piece of steel and the ones between lighter; and spinning free with every other "
      "piece heavier. "
      "Gravity is 10 m/s² and sets in at once; a spin is at 3 rad/s, or so fast that the middle carries a "
      "tenth of its "
      "plastic tension, or three times it: only there may joints flow.",
      "The domain in which the direct solver must stand (●) was fixed beforehand: welded mass ratio up to "
      "10⁴, contact up "
      "to 100, dt 1/30 … 1/1000 s, up to 80 pieces, true steel and rigid, below Box2D's speed limits. What "
      "lies beyond is "
      "shown for what happens.",
      "A cell diverges where its energy grows by more than 1 % of the scale (the weight times the elastic "
      "sag; of a spin "
      "its kinetic energy) or a number is lost. It drifts where in the second half of the 4 s a piece is "
      "farther than 2 % "
      "of the length from where it belongs (the elastic sag, doubled because gravity sets in at once, is 0.9 "
      "%) or a rigid "
      "one still moves by 0.1 %, where a joint flows, or a spin loses a tenth of its energy. Else it stands. "
      "Point at a "
      "cell for its residual energy and its displacements. Stock joints are rigid welds, and soft ones "
      "(EI/l) for steel."};
  Table table{"cells",
              "Every cell",
              {{"masses"},
               {"promised"},
               {"stiffness"},
               {"dt [s]"},
               {"pieces"},
               {"solver"},
               {"verdict"},
               {"residual energy"},
               {"displacement, second half [m]"},
               {"largest displacement [m]"},
               {"bounds hit"}},
              {}};
  int promised[3] = {}, clean[3] = {}, hits = 0, hits_beyond = 0;
  std::string unclean, deepest_where;
  double deepest = 0;
  double done = 0;
  const double all = static_cast<double>(all_rows.size()) * 3;
  for (std::size_t s = 0; s < 3; ++s) {
    Matrix matrix{.name = fmt::format("stability-{}", solvers[s].name),
                  .title = fmt::format("{}: 8/3 iterations", solvers[s].name),
                  .caption =
                      "✓ stands, ~ drifts, ✗ diverges; ● promised of the direct solver (a block on a steel "
                      "beam: from 50 Hz on).",
                  .levels = {"stiffness", "time step", "pieces"}};
    for (const bool elastic : {false, true}) {
      for (const double dt : steps) {
        for (const int n : sizes) {
          matrix.columns.push_back(
              fmt::format("{}|dt 1/{:.0f} s|{}", elastic ? "steel" : "rigid", 1 / dt, n));
        }
      }
    }
    for (const Row& row : all_rows) {
      Matrix::Row& line = matrix.rows.emplace_back(Matrix::Row{row.name, row.promised, {}});
      for (const bool elastic : {false, true}) {
        for (const double dt : steps) {
          for (const int n : sizes) {
            const Cell cell{elastic, dt, n};
            const Built::Kind kind =
                solvers[s].kind == Built::stock && elastic ? Built::stock_soft : solvers[s].kind;
            const Outcome o = run(row, cell, kind, seconds);
            const std::string told = fmt::format(
                "residual energy {:.2g}, displacement {:.3g} m, {:.3g} m at most", o.residual, o.off, o.ever);
            line.cells.push_back({names[o.verdict], told});
            const bool promise = row.promised && !lifts(row, elastic, dt);
            table.rows.push_back({row.name, promise, elastic ? "steel" : "rigid", dt, n, solvers[s].name,
                                  names[o.verdict], o.residual, o.off, o.ever, o.bounds_hit});
            if (s == 0) (promise ? hits : hits_beyond) += o.bounds_hit;
            if (!promise) continue;
            if (s == 0 && row.mass == resting && o.ever > deepest) {
              deepest = o.ever;
              deepest_where = fmt::format("{}, {}, 1/{:.0f} s, {} pieces", row.name,
                                          elastic ? "steel" : "rigid", 1 / dt, n);
            }
            ++promised[s];
            clean[s] += o.verdict == Outcome::stands ? 1 : 0;
            if (s == 0 && o.verdict != Outcome::stands) {
              unclean += fmt::format("; {} ({}, 1/{:.0f} s, {} pieces) {}", row.name,
                                     elastic ? "steel" : "rigid", 1 / dt, n, names[o.verdict]);
            }
          }
        }
      }
      context.progress(++done / all);
    }
    result.matrices.push_back(std::move(matrix));
  }
  result.summary = fmt::format(
      "Stability: {} of {} cells of the promised domain stand with the direct solver, {} with the iterative "
      "one and {} with "
      "stock joints.",
      clean[0], promised[0], clean[1], clean[2]);
  result.claims = {{"No unclean cell for the direct solver in the domain that was fixed beforehand",
                    fmt::format("{} of {} stand{}; iterative {}, stock {}", clean[0], promised[0], unclean,
                                clean[1], clean[2]),
                    clean[0] == promised[0]},
                   {"The direct solver never hit a bound in that domain",
                    fmt::format("{} times; beyond it {}", hits, hits_beyond), hits == 0}};
  result.text.push_back(fmt::format(
      "A block that lands on far lighter pieces sinks in at first, until the impulses that Box2D carries "
      "over from step to "
      "step have grown to its weight; then it is pushed out again. The most in that domain is {:.2g} m ({}).",
      deepest, deepest_where));
  result.tables = {promises(all_rows, result.matrices[0], steps, sizes), std::move(table)};
  return result;
}

}  // namespace

const Case stability{"stability", "Stability: stiff and extreme cases", run_stability};

}  // namespace ductile::report
