// Discretisation: what the number of pieces and the time step cost, with observed orders; impacts against
// rigid-plastic theory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "case.h"
#include "parkes_run.h"
#include "period.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double length = 20, height = 1, g = 10;
constexpr double EI = Steel::E / 12, shear_stiffness = 5. / 6 * Steel::E / 2.6,
                 weight = Steel::density * height * g;

constexpr double settling = 0.1;  // s, c/k: what is to come to rest is damped

/// The elastic beam of n pieces at rest under its own weight.
double elastic_sag(int n) {
  Layout layout = bench::chains(1, n, false);
  layout.yields = false;
  layout.damping = settling;
  Built b(layout, Built::ours, g);
  b.run(15);
  // The tip, from the last piece and its turn.
  const b2Body* last = b.pieces.back();
  return -(double{last->GetPosition().y} + std::sin(double{last->GetAngle()}) * length / n / 2);
}

/// The same beam held at both ends, in so little gravity that it spans no cable: the moment at an end.
double end_moment(int n, double gravity) {
  Layout layout = bench::chains(1, n, false);
  layout.yields = false;
  layout.damping = settling;
  Built b(layout, Built::ours, gravity);
  Layout::Weld right{-1, n - 1, length, 0, 0, length / n / 2};
  ElasticPlasticJointDef def = Built::joint(layout, right, height, b.pieces.back(), b.ground);
  auto* joint = b.structure->create_joint(def);
  b.run(10);
  return std::abs(joint->force(rotation));
}

/// Of its slowest vibration, of 20 pieces.
double vibration(double dt) {
  Layout layout = bench::chains(1, 20, false);
  layout.yields = false;
  Built b(layout, Built::ours, 0);
  return slowest_period(b, length, dt);
}

/// Where a rigid-plastic cantilever, M/M_p = 1.05, comes to rest.
double rest_angle(double dt) {
  Layout layout = bench::chains(1, 10, false);
  layout.E = unlimited;
  layout.breaks = false;
  Built b(layout, Built::ours, 1.05 * Steel::fy / 4 / (Steel::density * length * length / 2));
  // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): steps of time
  for (double t = 0; t < 12; t += dt) b.step(dt);
  return static_cast<ElasticPlasticJoint*>(b.joints[0])->plastic(rotation);
}

double exact_rest_angle() {
  double low = 0.1, high = std::numbers::pi;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::sin(middle) / middle > 1 / 1.05 ? low : high) = middle;
  }
  return low;
}

/// A mass flies into a bar that a rigid-plastic row holds, and both are braked together: the permanent set.
struct Struck {
  static constexpr double mass = 500, bar = 1500, speed = 8, force = 2e5;
  static double exact() {
    const double v = mass * speed / (mass + bar);
    return v * v * (mass + bar) / (2 * force);
  }
  /// As it is solved in parts of 1/3840 s at any step: (h/T)² of what brakes for T.
  static double allowed() {
    const double braked = mass * speed / force;
    return 1 / (3840 * braked) / (3840 * braked);
  }
  static double set(double dt) {
    b2World world({0, 0});
    ductile::Structure structure(world);
    b2Body* ground = add_box(world, {.x = -1, .type = b2_staticBody});
    b2Body* held = add_box(world, {.x = 1, .mass = bar});
    ElasticPlasticJointDef def;
    def.Initialize(ground, held, {0, 0}, {1, 0});
    def.rows[axial] = {.cap = force, .cap_reverse = force};
    auto* joint = structure.create_joint(def);
    b2Body* striker = add_box(world, {.x = 2, .mass = mass, .group = 0});
    striker->SetLinearVelocity(vec(-speed, 0));
    ElasticPlasticJointDef weld;
    weld.Initialize(held, striker, {1.5f, 0}, {1, 0});
    structure.create_joint(weld);
    // NOLINTNEXTLINE(clang-analyzer-security.FloatLoopCounter): steps of time
    for (double t = 0; t < 0.5; t += dt) {
      world.Step(static_cast<float>(dt), 8, 3);
      structure.update();
    }
    return joint->compression();
  }
};

/// One quantity over a sweep: errors against its exact value, and the order that they fall with.
struct Sweep {
  std::string name, title, axis;
  double exact;
  std::vector<double> at;  // number of pieces, or dt
  std::function<double(double)> value;
  double order;  // expected; 0: none
  double told;   // below this relative error floats, or another part of the error, take over; without an
                 // order, what is allowed in all of the sweep; 0: a tenth, at its finest
};

Result run_discretisation(const Context& context) {
  const bool quick = context.quick;
  const auto pieces = quick ? std::vector<double>{2, 5, 10} : std::vector<double>{2, 5, 10, 20, 40};
  const auto even = quick ? std::vector<double>{2, 4, 10} : std::vector<double>{2, 4, 10, 20, 40};
  const auto steps =
      quick ? std::vector<double>{1. / 30, 1. / 60, 1. / 240}
            : std::vector<double>{1. / 30, 1. / 60, 1. / 120, 1. / 240, 1. / 480, 1. / 960, 1. / 3840};
  const double sag =
      weight * std::pow(length, 4) / (8 * EI) + weight * length * length / (2 * shear_stiffness);
  constexpr double tiny = 0.1;
  // The period in the limit of small steps is that of the 20 pieces; the finest step stands for it.
  const double finest = vibration(quick ? 1. / 7680 : 1. / 15360);
  const std::vector<Sweep> sweeps{
      {"sag", "Elastic sag of a cantilever, against Timoshenko's beam", "pieces", sag, pieces,
       [](double n) { return elastic_sag(static_cast<int>(n)); }, 2, 1e-5},
      {"end", "End moment of a beam built in at both ends, against qL²/12", "pieces",
       weight / g * tiny * length * length / 12, even,
       [](double n) { return end_moment(static_cast<int>(n), tiny); }, 2, 1e-5},
      {"vibration", "Period of a cantilever's slowest vibration, against the finest step", "dt", finest,
       steps, vibration, 2, 1e-5},
      {"rest", "Plastic rotation at rest, M/M_p = 1.05, against sin θ/θ = M_p/M", "dt", -exact_rest_angle(),
       steps, rest_angle, 2, 5e-5},
      {"struck", "Set of a bar struck by a mass, against (mv)²/2N(m+m_p)", "dt", Struck::exact(), steps,
       Struck::set, 0, Struck::allowed()},
      {"parkes-dt", "Parkes' struck cantilever, 20 pieces: root rotation, against rigid-plastic theory", "dt",
       ParkesRun::exact(), steps, [](double dt) { return ParkesRun::root_rotation(20, dt); }, 0, 0},
      {"parkes", "Parkes' struck cantilever at 6000 Hz: root rotation, against rigid-plastic theory",
       "pieces", ParkesRun::exact(),
       quick ? std::vector<double>{5, 10} : std::vector<double>{5, 10, 20, 40, 80},
       [](double n) { return ParkesRun::root_rotation(static_cast<int>(n), 1. / 6000); }, 0, 0}};
  Result result;
  Table table{
      "sweeps",
      "Every run",
      {{"quantity"}, {"pieces or dt [s]"}, {"value"}, {"exact"}, {"relative error"}, {"observed order"}},
      {}};
  Figure by_pieces{.name = "discretisation-pieces",
                   .title = "Error against the number of pieces",
                   .x = {"pieces", true},
                   .y = {"relative error", true},
                   .floor = 1e-9};
  Figure by_step{.name = "discretisation-dt",
                 .title = "Error against the time step",
                 .x = {"time step [s]", true},
                 .y = {"relative error", true},
                 .floor = 1e-9};
  double done = 0;
  for (const Sweep& sweep : sweeps) {
    Series series{.name = sweep.title.substr(0, sweep.title.find(", against")), .look = sweep.name};
    double before = 0, before_at = 0, first = 0, first_at = 0, overall = NAN, worst = 0;
    for (const double at : sweep.at) {
      const double value = sweep.value(at), error = std::abs(value / sweep.exact - 1);
      const auto order_since = [&](double e, double where) {
        return std::abs(std::log(error / e) / std::log(at / where));
      };
      double order = NAN;
      if (first == 0) first = error, first_at = at;
      if (before > 0 && error > sweep.told) {
        order = order_since(before, before_at);
        overall = order_since(first, first_at);
      }
      before = error, before_at = at;
      worst = std::max(worst, error);
      series.x.push_back(at), series.y.push_back(error);
      series.marked.push_back(sweep.axis == "dt" && std::abs(at * 60 - 1) < 1e-9);
      series.told.push_back(
          fmt::format("value {:.6g}, exact {:.6g}{}", value, sweep.exact,
                      std::isfinite(order) ? fmt::format("<br>observed order {:.2f}", order) : ""));
      table.rows.push_back(
          {sweep.title, at, value, sweep.exact, error, std::isfinite(order) ? Json(order) : Json()});
      context.progress(++done / static_cast<double>(sweeps.size() * sweep.at.size()));
    }
    (sweep.axis == "dt" ? by_step : by_pieces).series.push_back(std::move(series));
    if (sweep.order > 0) {
      result.claims.push_back({sweep.title,
                               fmt::format("order {:.2f}, at least {:g} expected", overall, sweep.order),
                               overall > sweep.order - 0.25});
    } else if (sweep.told > 0) {
      result.claims.push_back(
          {sweep.title,
           fmt::format("{:.2g} % off at most, at any step; {:.2g} % allowed", 100 * worst, 100 * sweep.told),
           worst <= sweep.told});
    } else {
      const double last = std::abs(table.rows.back()[4].get<double>());
      result.claims.push_back(
          {sweep.title, fmt::format("{:.1f} % off at the finest", 100 * last), last < 0.1});
    }
  }
  result.summary = fmt::format(
      "Errors fall with the pieces (sag: {}) and with the time step; Parkes' travelling hinge: {}.",
      result.claims.front().measured, result.claims.back().measured);
  result.figures = {std::move(by_pieces), std::move(by_step)};
  result.tables = {std::move(table)};
  result.text = {
      "What is left when a solver makes no error of its own: beams are cut into finitely many pieces, and "
      "time into steps. A "
      "cantilever of 20 m × 1 m unless said otherwise. Statics converges with the square of the number of "
      "pieces; what moves, "
      "with the square of the time step, until floats tell no more. A step in which something strikes is "
      "solved in parts of "
      "1/3840 s, however long it is, so that its error does not fall with the step. The order of a claim is "
      "that over the whole "
      "sweep. 60 Hz is drawn large."};
  return result;
}

}  // namespace

const Case discretisation{"discretisation", "Discretisation: pieces and time steps", run_discretisation};

}  // namespace ductile::report
