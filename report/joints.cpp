// Joints: error against time per step, for stock welds with more and more iterations or sub-steps, and for
// ours.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "case.h"
#include "ductile/clock.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double g = 10, frequency = 60, duration = 15;  // m/s², Hz, s
constexpr double settling = 0.1;  // s, c/k of elastic joints: without it they would swing for ever

/// How a structure is stepped.
struct Way {
  std::string name, family;
  Built::Kind kind = Built::ours;
  bool elastic = false;
  int velocity = 8, position = 3, substeps = 1;
  bool is_default() const { return velocity == 8 && substeps == 1; }
};

std::vector<Way> ways(bool quick) {
  std::vector<Way> all{{"direct, rigid", "direct, rigid", Built::ours},
                       {"direct, true stiffness", "direct, true stiffness", Built::ours, true}};
  using Iterations = std::vector<std::pair<int, int>>;
  for (const auto& [v, p] :
       quick ? Iterations{{1, 1}, {8, 3}, {50, 20}}
             : Iterations{{1, 1}, {3, 2}, {8, 3}, {20, 8}, {50, 20}, {200, 80}, {1000, 400}, {5000, 2000}}) {
    all.push_back(
        {fmt::format("stock, {}/{} iterations", v, p), "stock, iterations", Built::stock, false, v, p});
    if (v > 200) continue;  // some 4 times the time of stock
    all.push_back({fmt::format("iterative, {}/{} iterations", v, p), "iterative (the paper's)",
                   Built::iterative, false, v, p});
  }
  for (const int s : quick ? std::vector<int>{4} : std::vector<int>{2, 4, 16, 64}) {
    all.push_back({fmt::format("stock, {} sub-steps", s), "stock, sub-steps", Built::stock, false, 8, 3, s});
  }
  all.push_back({"stock, soft (EI/l)", "stock, soft", Built::stock_soft, true});
  return all;
}

struct Structure {
  std::string name, family;
  Layout layout;
  bool yields = false;  // judged by the plastic rotation of its root
  double gravity = g;
};

/// M/M_p of the cantilever that gives way.
constexpr double overload = 1.05;

std::vector<Structure> structures(bool quick) {
  std::vector<Structure> all;
  for (const int n : quick ? std::vector<int>{10} : std::vector<int>{5, 10, 20, 40, 80}) {
    all.push_back({fmt::format("chain of {}", n), "chain", bench::chains(1, n, false)});
  }
  // Four pieces per storey's column and per bay's beam.
  using Size = std::pair<int, int>;
  for (const auto& [storeys, bays] :
       quick ? std::vector<Size>{{1, 1}} : std::vector<Size>{{1, 1}, {2, 1}, {2, 2}, {4, 2}}) {
    const Layout layout = bench::frame(storeys, bays);
    all.push_back({fmt::format("frame of {}", layout.pieces.size()), "frame", layout});
  }
  for (const auto& [columns, rows] :
       quick ? std::vector<Size>{{10, 2}}
             : std::vector<Size>{{5, 2}, {10, 2}, {20, 2}, {30, 2}, {4, 4}, {9, 9}}) {
    all.push_back({fmt::format("grid of {} x {}", columns, rows), "grid", bench::grid(columns, rows)});
  }
  // The cantilever whose gravity, applied at once, is 5 % more than its root can carry.
  for (const int n : quick ? std::vector<int>{10} : std::vector<int>{5, 10, 20, 40, 80}) {
    Structure s{fmt::format("yielding chain of {}", n), "yielding chain", bench::chains(1, n, false), true};
    const double plastic_moment = Steel::fy / 4, moment_per_g = Steel::density * 20 * 20 / 2;
    s.gravity = overload * plastic_moment / moment_per_g;
    s.layout.breaks = false;
    all.push_back(s);
  }
  return all;
}

/// θ where sinθ/θ = M_p/M: there the plastic work of the root is the work of the weight.
double plastic_rotation() {
  double low = 0.1, high = std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::sin(middle) / middle > 1 / overload ? low : high) = middle;
  }
  return low;
}

/// Where every piece goes, (x, y, θ) each: the springs' linear statics, K u = f, by Eigen. Nothing of joint/
/// is in it.
Eigen::VectorXd displacements(const Layout& layout, double gravity) {
  const auto n = static_cast<Eigen::Index>(layout.pieces.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (const Layout::Weld& w : layout.welds) {
    const ElasticPlasticJointDef def = [&] {
      b2World world({0, 0});
      b2BodyDef none;
      return Built::joint(layout, w, layout.pieces[static_cast<std::size_t>(w.b)].height,
                          world.CreateBody(&none), world.CreateBody(&none));
    }();
    const double c = std::cos(w.angle), s = std::sin(w.angle);
    // Gap of the anchors along the axis, across it, and in angle, of the displacements (x, y, θ) of a and b.
    Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
    const auto side = [&](int piece, int at, double sign) {
      if (piece < 0) return;
      const Layout::Piece& p = layout.pieces[static_cast<std::size_t>(piece)];
      const double rx = w.x - p.x, ry = w.y - p.y;
      J.block<1, 3>(0, at) << sign * c, sign * s, sign * (-ry * c + rx * s);
      J.block<1, 3>(1, at) << -sign * s, sign * c, sign * (ry * s + rx * c);
      J(2, at + 2) = sign;
    };
    side(w.a, 0, -1);
    side(w.b, 3, 1);
    Eigen::Vector3d k;
    for (int r = 0; r < 3; ++r) k[r] = def.rows[r].stiffness;
    const Eigen::Matrix<double, 6, 6> block = J.transpose() * k.asDiagonal() * J;
    const int of[] = {w.a, w.b};
    for (Eigen::Index i = 0; i < 2; ++i) {
      for (Eigen::Index j = 0; j < 2; ++j) {
        if (of[i] >= 0 && of[j] >= 0)
          K.block<3, 3>(Eigen::Index{3} * of[i], Eigen::Index{3} * of[j]) += block.block<3, 3>(3 * i, 3 * j);
      }
    }
  }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(3 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    f[3 * i + 1] = -gravity * layout.pieces[static_cast<std::size_t>(i)].mass();
  return K.ldlt().solve(f);
}

double extent(const Layout& layout) {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  for (const Layout::Piece& p : layout.pieces) {
    x0 = std::min(x0, p.x - p.length / 2), x1 = std::max(x1, p.x + p.length / 2);
    y0 = std::min(y0, p.y - p.height / 2), y1 = std::max(y1, p.y + p.height / 2);
  }
  return std::max(x1 - x0, y1 - y0);
}

/// Errors, and the time of the whole run as a share of the yardstick's.
struct Outcome {
  double moment = 0;    // root mean square over the last second of M/M_exact − 1
  double sag = 0;       // largest vertical error of a piece, by the structure's size
  double rotation = 0;  // |θ − θ_exact|, rad: of the root that yields
  double ratio = 0, yardstick_us = 0;
  int bounds_hit = 0;
};

/// Moment of all that the ground takes, about the origin: statics alone says what it is.
double ground_moment(const Built& b, double inv_dt) {
  double sum = 0;
  for (b2Joint* joint : b.joints) {
    if (joint->GetBodyA() != b.ground) continue;
    const b2Vec2 at = joint->GetAnchorB(), force = joint->GetReactionForce(static_cast<float>(inv_dt));
    sum += double{joint->GetReactionTorque(static_cast<float>(inv_dt))} + double{at.x} * force.y -
           double{at.y} * force.x;
  }
  return sum;
}

Outcome run(const Structure& s, const Way& way) {
  Layout layout = s.layout;
  if (way.elastic)
    layout.damping = settling;
  else
    layout.E = unlimited;
  layout.yields = s.yields;
  const Eigen::VectorXd u = way.elastic
                                ? displacements(layout, s.gravity)
                                : Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(layout.pieces.size()));
  const auto moved = [&](std::size_t piece, Eigen::Index axis) {
    return u[3 * static_cast<Eigen::Index>(piece) + axis];
  };
  double weight_moment = 0;  // of the weights where they come to rest
  for (std::size_t i = 0; i < layout.pieces.size(); ++i) {
    weight_moment += layout.pieces[i].mass() * s.gravity * (layout.pieces[i].x + moved(i, 0));
  }
  const double dt = 1 / frequency / way.substeps;
  Built built(layout, s.yields && way.kind == Built::stock ? Built::stock_hinges : way.kind, s.gravity);
  Built yardstick(layout, Built::stock, 1e-3);  // straight: stock at its cheapest
  Outcome out;
  constexpr int steps = static_cast<int>(frequency * duration), last = static_cast<int>(frequency), few = 5;
  std::vector<double> ours, yard;
  for (int i = 0; i < steps; i += few) {
    const auto several = [&](auto&& step) {
      return seconds([&] {
        for (int k = 0; k < few; ++k) step();
      });
    };
    yard.push_back(several([&] { yardstick.step(); }));
    ours.push_back(several([&] {
      for (int k = 0; k < way.substeps; ++k) built.step(dt, way.velocity, way.position);
    }));
    if (i < steps - last) continue;
    const double error = ground_moment(built, 1 / dt) / weight_moment - 1;
    out.moment += error * error * few / last;
  }
  out.moment = std::sqrt(out.moment);
  const double size = extent(layout);
  for (std::size_t i = 0; i < built.pieces.size(); ++i) {
    const double sunk = double{built.pieces[i]->GetPosition().y} - layout.pieces[i].y;
    out.sag = std::max(out.sag, std::abs(sunk - moved(i, 1)) / size);
  }
  out.rotation = std::abs(-double{built.pieces[0]->GetAngle()} - plastic_rotation());
  out.yardstick_us = 1e6 * median(yard) / few;
  // Second by second: a machine that slows down meanwhile slows both.
  constexpr std::ptrdiff_t second = last / few;
  for (auto a = ours.begin(), b = yard.begin(); a != ours.end(); a += second, b += second) {
    out.ratio += std::accumulate(a, a + second, 0.) / second / median({b, b + second}) / duration;
  }
  out.bounds_hit = built.sum.bounds_hit;
  return out;
}

/// The same run several times: the same errors, to the bit, and a spread of the time.
struct Measured : Outcome {
  double low = 0, high = 0;
};

Measured measure(const Structure& s, const Way& way, int times) {
  std::vector<double> ratios, yardsticks;
  Measured m;
  for (int i = 0; i < times; ++i) {
    const Outcome one = run(s, way);
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    if (i > 0 && !(same(one.moment, m.moment) && same(one.sag, m.sag) && same(one.rotation, m.rotation))) {
      throw std::logic_error(s.name + ", " + way.name + ": the same run gave other errors");
    }
    static_cast<Outcome&>(m) = one;
    ratios.push_back(one.ratio);
    yardsticks.push_back(one.yardstick_us);
  }
  m.yardstick_us = median(yardsticks);
  const Spread all = spread(ratios, 0);
  m.ratio = all.median, m.low = all.low, m.high = all.high;
  return m;
}

/// What is judged: an error of an Outcome, and where it means something.
struct Error {
  const char *name, *title, *axis;
  double Outcome::*value;
  bool of_yielding;
};
constexpr Error errors[] = {{"moment", "Moment at the ground", "error of the moment at the ground, relative",
                             &Outcome::moment, false},
                            {"sag", "Sag", "error of the sag, share of the size", &Outcome::sag, false},
                            {"rotation", "Plastic rotation",
                             "error of the plastic rotation of the root [rad]", &Outcome::rotation, true}};

/// Where stock errs by less there is nothing to gain.
constexpr double good_enough = 1e-4;

struct Point {
  const Way* way;
  Measured measured;
};

double worst(double error) { return std::isfinite(error) ? error : unlimited; }

/// A solver's own family, on the front: none is both as good and as cheap, and better in one of both.
bool on_front(const std::vector<Point>& points, const Point& ours, double Outcome::*error) {
  return std::none_of(points.begin(), points.end(), [&](const Point& p) {
    const double e = worst(p.measured.*error), t = p.measured.ratio;
    const double e0 = worst(ours.measured.*error), t0 = ours.measured.ratio;
    return p.way->kind != Built::ours && e <= e0 && t <= t0 && (e < e0 || t < t0);
  });
}

/// The error of the cheapest stock that takes at least our time; NaN where none is so dear.
double stock_error(const std::vector<Point>& points, const Point& ours, double Outcome::*error) {
  const Point* peer = nullptr;
  for (const Point& p : points) {
    if (p.way->kind != Built::stock || p.measured.ratio < ours.measured.ratio) continue;
    if (peer == nullptr || p.measured.ratio < peer->measured.ratio) peer = &p;
  }
  return peer == nullptr ? std::nan("") : worst(peer->measured.*error);
}

Result run_joints(const Context& context) {
  const std::vector<Structure> all = structures(context.quick);
  const std::vector<Way> all_ways = ways(context.quick);
  Result result;
  Table table{"errors",
              "Every run",
              {{"structure"},
               {"way"},
               {"error of the moment"},
               {"error of the sag"},
               {"error of the plastic rotation [rad]"},
               {"bounds hit"},
               {"time against stock 8/3", true},
               {"from", true},
               {"to", true},
               {"time per step [us]", true}},
              {}};
  int judged = 0, on = 0, compared = 0, gained = 0, hits = 0, nothing_to_gain = 0;
  double least_gain = unlimited, dearest = 0;
  std::string least_where, dearest_where, missed;
  std::vector<Figure> figures;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Structure& s = all[k];
    std::vector<Point> points;
    for (std::size_t w = 0; w < all_ways.size(); ++w) {
      const Way& way = all_ways[w];
      // With elastic joints the load applied at once swings: no closed form says how far it flows.
      if (s.yields && (way.elastic || way.family == "stock, soft")) continue;
      if (way.velocity > 1000 && s.family != "chain" && s.family != "yielding chain") continue;  // minutes
      points.push_back({&way, measure(s, way, context.quick ? 1 : 3)});
      const Measured& m = points.back().measured;
      hits += way.kind == Built::ours ? m.bounds_hit : 0;
      table.rows.push_back({s.name, way.name, s.yields ? Json() : Json(m.moment),
                            s.yields ? Json() : Json(m.sag), s.yields ? Json(m.rotation) : Json(),
                            m.bounds_hit, m.ratio, m.low, m.high, m.ratio * m.yardstick_us});
      context.progress(
          (static_cast<double>(k) + static_cast<double>(w + 1) / static_cast<double>(all_ways.size())) /
          static_cast<double>(all.size()));
    }
    for (const Error& e : errors) {
      if (e.of_yielding != s.yields) continue;
      Figure f{.name = fmt::format("{}-{}", e.name, k),
               .group = std::string("joints-") + e.name,
               .tab = s.name,
               .first = s.layout.pieces.size() == 20,
               .title = fmt::format("{}: {}", e.title, s.name),
               .x = {"time per step [µs]", true},
               .y = {e.axis, true},
               .floor = 1e-9};
      bool there = false;
      for (const Point& p : points) {
        auto at =
            std::find_if(f.series.begin(), f.series.end(), [&](auto& x) { return x.name == p.way->family; });
        if (at == f.series.end()) {
          at = f.series.insert(f.series.end(), {.name = p.way->family, .look = p.way->family});
        }
        const Measured& m = p.measured;
        at->x.push_back(m.ratio * m.yardstick_us);
        at->low.push_back(m.low * m.yardstick_us);
        at->high.push_back(m.high * m.yardstick_us);
        at->y.push_back(m.*e.value);
        at->told.push_back(fmt::format("{}<br>{:.3g} times stock at 8/3, unloaded", p.way->name, m.ratio));
        at->marked.push_back(p.way->is_default() &&
                             (p.way->kind == Built::ours || p.way->kind == Built::stock));
        if (p.way->kind != Built::ours) continue;
        if (on_front(points, p, e.value)) {
          there = true;
        } else {
          missed += fmt::format(" {}, {} ({}).", s.name, p.way->name, e.name);
        }
        if (m.ratio > dearest) {
          dearest = m.ratio;
          dearest_where = fmt::format("{}, {}", s.name, p.way->name);
        }
        if (s.layout.pieces.size() < 10) continue;
        const double stock = stock_error(points, p, e.value), factor = stock / (m.*e.value);
        if (stock < good_enough) {
          ++nothing_to_gain;
          continue;
        }
        ++compared;
        gained += factor >= 1000 ? 1 : 0;
        if (factor < least_gain) {
          least_gain = factor;
          least_where = fmt::format("{}, {} ({})", s.name, p.way->name, e.name);
        }
      }
      ++judged;
      on += there ? 1 : 0;
      figures.push_back(std::move(f));
    }
  }
  result.text = {
      "A structure of steel boxes is put into gravity all at once and steps for 15 s at 60 Hz. Judged over "
      "the last "
      "second are the moment that the ground takes (statics alone says what it is), how far every piece sank "
      "(linear "
      "statics of the same springs, solved apart; nothing for rigid joints), and where a cantilever whose "
      "weight is 5 % "
      "more than its root can carry comes to rest (sin θ/θ = M_p/M). Elastic joints, ours and stock, are "
      "damped as a material is, c = 0.1 s · k, or they would swing on.",
      "Time is that of the whole run, settling included, divided by its steps: ours as it stands there, "
      "stock as it "
      "folds there. Each is timed in turn with the same structure in stock welds at 8/3 iterations that "
      "hangs straight, "
      "in a gravity of 0.001 m/s²; the ratio of the two, and its spread, stands in the table and on hover. "
      "Chains are "
      "20 m × 1 m cantilevers, frames the storeys and bays of the paper, grids boxes of 1 m held at one side "
      "(columns x rows)."};
  result.summary = fmt::format(
      "At 60 Hz the direct solver has at least {:.2g} times less error than stock welds that are given its "
      "time (from 10 "
      "pieces on); it is on the front of error against time in {} of {} pictures, and takes at most {:.2g} "
      "times the time "
      "of the cheapest stock welds.",
      least_gain, on, judged, dearest);
  result.claims.push_back({"Direct is on the Pareto front: none of the other solvers is as good and as cheap",
                           fmt::format("{} of {} pictures{}{}", on, judged,
                                       missed.empty() ? "" : "; one of both direct points is not:", missed),
                           on == judged, true});
  result.claims.push_back(
      {"From 10 pieces on, 1000 times less error than the cheapest stock setting that takes at least the "
       "time",
       fmt::format(
           "{} of {} where that errs by more than {:g} (in {} more it does not); the least {:.3g} times: {}",
           gained, compared, good_enough, nothing_to_gain, least_gain, least_where),
       gained == compared && compared > 0, true});
  result.claims.push_back(
      {"The direct solver never hit a bound", fmt::format("{} times", hits), hits == 0, false});
  result.text.push_back(
      fmt::format("The dearest of the direct runs took {:.2f} times the time of the unloaded stock "
                  "welds at 8/3: {}.",
                  dearest, dearest_where));
  result.figures = std::move(figures);
  result.tables = {std::move(table)};
  return result;
}

}  // namespace

const Case joints{"joints", "Joints: error against time per step", run_joints};

}  // namespace ductile::report
