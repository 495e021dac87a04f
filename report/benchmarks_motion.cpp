// Benchmarks in motion.
#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "benchmark.h"
#include "parkes_run.h"
#include "period.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double pi = std::numbers::pi;

/// A bar of 20 m from its wall along x, in n pieces.
Layout bar(int n, double thick, double E) {
  Layout layout;
  layout.E = E;
  layout.yields = false;
  const double l = 20. / n;
  for (int i = 0; i < n; ++i)
    layout.weld(i - 1, layout.box((i + 0.5) * l, 0, 0, l, thick), i * l, 0, 0, i == 0 ? l / 2 : l);
  return layout;
}

// d'Alembert: a bar that flies at its wall with v and sticks there is stopped by a wave from the wall, c =
// √(E/ρ), and sent back by it from the free end. A point at x comes v x/c far, and back after 4 L/c.
struct Wave {
  static constexpr int n = 80;
  static constexpr double E = 2.1e7, v = 1,
                          at = 20 - 10. / n;  // Pa, m/s, m: so soft that floats tell its waves
  static double speed() { return std::sqrt(E / Steel::density); }
  double farthest = 0, period = 0;
  explicit Wave(double dt) {
    Built b(bar(n, 1, E), Built::ours, 0);
    for (b2Body* piece : b.pieces) piece->SetLinearVelocity(vec(-v, 0));
    period = report::period(2, dt, [&] {
      b.step(dt);
      const double moved = double{b.pieces.back()->GetPosition().x} - at;
      farthest = std::max(farthest, -moved);
      return moved;
    });
  }
};

/// A cantilever of Euler and Bernoulli.
double bending_period(double dt) {
  Built b(bar(40, 0.2, Steel::E), Built::ours, 0);
  for (b2Joint* joint : b.joints)
    static_cast<ElasticPlasticJoint*>(joint)->set_stiffness(shear, unlimited, 0);
  return slowest_period(b, 20, dt);
}

constexpr double g = 9.81, rod = 1;  // m/s², m

/// One rod hung from a pin, or two in a row, let go from the level.
Built pendulum(int rods) {
  Layout layout;
  layout.E = unlimited;
  layout.yields = false;
  for (int i = 0; i < rods; ++i)
    layout.weld(i - 1, layout.box((i + 0.5) * rod, 0, 0, rod, 0.05), i * rod, 0, 0, rod, true);
  return Built(layout, Built::ours, g);
}

double swing(double dt) {
  Built b = pendulum(1);
  return period(5, dt, [&] {
    b.step(dt);
    return double{b.pieces[0]->GetAngle()} + pi / 2;
  });
}

/// 4 K(sin 45°) √(2 l/3 g) with the complete elliptic integral K from Gauss' arithmetic-geometric mean.
double exact_swing() {
  double a = 1, b = std::cos(pi / 4);
  for (int i = 0; i < 8; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 4 * pi / (2 * a) * std::sqrt(2 * rod / (3 * g));
}

constexpr double after = 1;  // s

/// Height of the free end of two rods.
double free_end(double dt) {
  Built b = pendulum(2);
  for (long i = 0, steps = std::lround(after / dt); i < steps; ++i) b.step(dt);
  return b.pieces[1]->GetWorldPoint({static_cast<float>(rod / 2), 0}).y;
}

/// The same from Lagrange's equations, angles from the vertical, by Runge and Kutta's fourth order.
double exact_free_end() {
  using State = Eigen::Vector4d;  // both angles, their rates
  const auto rate = [](const State& s) {
    const double between = s[0] - s[1], c = std::cos(between), d = std::sin(between);
    const Eigen::Matrix2d mass{{4. / 3, c / 2}, {c / 2, 1. / 3}};
    const Eigen::Vector2d force(-s[3] * s[3] * d / 2 - 1.5 * g / rod * std::sin(s[0]),
                                s[2] * s[2] * d / 2 - 0.5 * g / rod * std::sin(s[1]));
    State r;
    r << s.tail<2>(), mass.inverse() * force;
    return r;
  };
  State s(pi / 2, pi / 2, 0, 0);
  constexpr int steps = 10000;
  constexpr double h = after / steps;
  for (int i = 0; i < steps; ++i) {
    const State a = rate(s), b = rate(s + h / 2 * a), c = rate(s + h / 2 * b), d = rate(s + h * c);
    s += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return -rod * (std::cos(s[0]) + std::cos(s[1]));
}

// The multibody benchmark A02: N windows of four bars, N + 1 cranks and N couplers of 1 m and 1 kg, upright,
// pushed at 1 m/s. Where all lie level it is singular: N + 1 cranks could go on in either sense.
struct FourBars {
  static constexpr int revolutions = 5;
  /// Of all cranks alike: ∫ dθ/ω with ω² = 1 + 2 k (1 − cos θ), s for so many revolutions.
  static double exact(int n) {
    const double k = g * ((n + 1) / 2. + n) / ((n + 1) / 3. + n);
    constexpr int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double theta = 2 * pi * (i + 0.5) / steps;
      sum += 2 * pi / steps / std::sqrt(1 + 2 * k * (1 - std::cos(theta)));
    }
    return revolutions * sum;
  }
  static double simulated(int n, double dt) {
    Layout layout;
    layout.E = unlimited;
    layout.yields = false;
    constexpr double thick = 0.01;
    const auto link = [&](double x, double y, double angle) {
      const int box = layout.box(x, y, angle, 1, thick);
      layout.pieces.back().density = 1 / thick;  // 1 kg
      return box;
    };
    for (int i = 0; i <= n; ++i) layout.weld(-1, link(i, 0.5, pi / 2), i, 0, pi / 2, 1, true);
    for (int i = 0; i < n; ++i) {
      const int coupler = link(i + 0.5, 1, 0);
      layout.weld(i, coupler, i, 1, 0, 1, true);
      layout.weld(i + 1, coupler, i + 1, 1, 0, 1, true);
    }
    Built b(layout, Built::ours, g);
    for (int i = 0; i <= n; ++i) {
      b.pieces[static_cast<std::size_t>(i)]->SetAngularVelocity(-1);
      b.pieces[static_cast<std::size_t>(i)]->SetLinearVelocity(vec(0.5, 0));
    }
    for (int i = n + 1; i < 2 * n + 1; ++i)
      b.pieces[static_cast<std::size_t>(i)]->SetLinearVelocity(vec(1, 0));
    const double end = 2 * pi * revolutions;
    double before = 0;
    for (long i = 0, steps = std::lround(60 / dt); i < steps; ++i) {
      b.step(dt);
      const double turned = pi / 2 - double{b.pieces[0]->GetAngle()};
      if (turned >= end) return (static_cast<double>(i) + (end - before) / (turned - before)) * dt;
      before = turned;
    }
    return NAN;
  }
};

}  // namespace

std::vector<Benchmark> motion_benchmarks(const Context& context) {
  std::vector<Benchmark> rows;
  const double c = Wave::speed();
  const double bending =
      2 * pi * 400 / (1.8751041 * 1.8751041 * 0.2 * std::sqrt(Steel::E / (12 * Steel::density)));
  double done = 0;
  for (const double rate : {context.quick ? 960. : 3840., 60.}) {
    const double dt = 1 / rate, allowed = rate > 60 ? 0.03 : 0.1;
    const std::string hz = fmt::format("; {:g} Hz", rate);
    const Wave wave(dt);
    const std::string bar_input = "E = 21 MPa, ρ = 7800 kg/m³, 20 m, 1 m/s, 80 pieces" + hz;
    rows.push_back({"Wave in a bar that hits a wall", "d'Alembert, 1747", "closed form", bar_input,
                    "displacement near the free end, v x/c [m]", Wave::v * Wave::at / c, wave.farthest,
                    allowed});
    rows.push_back({"Wave in a bar that hits a wall", "d'Alembert, 1747", "closed form", bar_input,
                    "period, 4 L/c [s]", 80 / c, wave.period, allowed});
    rows.push_back({"Vibration of a cantilever", "D. Bernoulli and Euler, 1751: (1.8751/L)² √(EI/ρA)",
                    "closed form", "steel, 20 m × 0.2 m, E = 210 GPa, 40 pieces that do not shear" + hz,
                    "period [s]", bending, bending_period(dt), allowed});
    rows.push_back({"Pendulum of 90 degrees", "Huygens, 1673; Legendre: 4 K(sin 45°) √(2 l/3 g)",
                    "closed form", "rod of 1 m, 9.81 m/s²" + hz, "period [s]", exact_swing(), swing(dt),
                    allowed});
    rows.push_back({"Double pendulum", "Lagrange's equations, by Runge and Kutta", "integrated here",
                    "two rods of 1 m, let go level, 9.81 m/s²" + hz, "height of the free end after 1 s [m]",
                    exact_free_end(), free_end(dt), allowed});
    for (const int windows : {2, 40})
      rows.push_back(
          {"N four-bars", "IFToMM's library of multibody benchmarks, A02; after Bayo and Avello, 1994",
           "the problem's specification; its solution, of one degree of freedom, integrated here",
           fmt::format("N = {}, links of 1 m and 1 kg on pins, 9.81 m/s², upright, 1 m/s", windows) + hz,
           "time of 5 revolutions [s]", FourBars::exact(windows), FourBars::simulated(windows, dt), allowed});
    const int n = rate > 60 ? 40 : 20;
    const double step = rate > 60 ? 1. / 6000 : dt;
    rows.push_back(
        {"Struck cantilever", "Parkes, 1955: a hinge that travels from the tip to the root",
         "closed form; not read",
         fmt::format("rigid-plastic, 20 m × 1 m, f_y = 350 MPa, tip as heavy, 12 m/s, {} pieces; {:g} Hz", n,
                     1 / step),
         "rotation of the root [rad]", ParkesRun::exact(), ParkesRun::root_rotation(n, step), allowed});
    context.progress(0.6 + 0.4 * ++done / 2);
  }
  return rows;
}

}  // namespace ductile::report
