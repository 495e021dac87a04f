// Benchmarks of blows: beams on two clamps under a falling mass, an impulse, or without their column; a beam
// that tumbles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "benchmark.h"
#include "bodies.h"
#include "ductile/simulation.h"
#include "parkes.h"
#include "structures.h"

namespace ductile::report {
namespace {

using bench::Built;
using bench::Layout;
using bench::Steel;

constexpr double half = 10, height = 1;                // m: half the span
constexpr double line_mass = Steel::density * height;  // kg/m
constexpr double fy = 35e6;                            // Pa: so weak that blows take several steps at 60 Hz
constexpr double moment(double yield_stress) { return yield_stress * height * height / 4; }  // N m
constexpr double M_p = moment(fy);
constexpr double EI = Steel::E * height * height * height / 12;  // N m²

/// Of 2 n pieces from x = −half to half, on two clamps, that nothing stretches: the right one slides. Or both
/// hold, and all of it stretches at its yield force. A mass in its middle where there is one.
struct ClampedBeam {
  ClampedBeam(int n, double E, double density, double mass, double gravity, double yield_stress = fy,
              bool stretches = false)
      : built(layout(n, E, density, mass), Built::ours, gravity) {
    for (b2Joint* joint : built.joints) {
      auto* j = static_cast<ElasticPlasticJoint*>(joint);
      for (const Row row : {axial, shear}) {
        const double cap = row == axial && stretches ? yield_stress * height : unlimited;
        j->set_caps(row, cap, cap);
        j->set_stiffness(row, unlimited, 0);
      }
      j->set_caps(rotation, moment(yield_stress), moment(yield_stress));
    }
    const auto joint = [&](std::size_t i) { return static_cast<ElasticPlasticJoint*>(built.joints[i]); };
    const int last = 2 * n;
    if (!stretches) joint(static_cast<std::size_t>(last))->set_caps(axial, 0, 0);
    if (mass > 0) joint(built.joints.size() - 1)->set_caps(rotation, unlimited, unlimited);
    middle = built.pieces[static_cast<std::size_t>(n - 1)];
    to_middle = static_cast<float>(half / n / 2);
  }
  double sag() const { return -double{middle->GetWorldPoint({to_middle, 0}).y}; }
  /// The farthest that the middle goes within so many seconds.
  double farthest(double seconds, double dt) {
    double most = 0;
    for (long i = 0, steps = std::lround(seconds / dt); i < steps; ++i) {
      built.step(dt);
      most = std::max(most, sag());
    }
    return most;
  }

  Built built;
  b2Body* middle;
  float to_middle;

 private:
  static Layout layout(int n, double E, double density, double mass) {
    Layout layout;
    layout.E = E;
    layout.breaks = false;
    const double l = half / n;
    for (int i = 0; i < 2 * n; ++i) {
      layout.weld(i - 1, layout.box(-half + (i + 0.5) * l, 0, 0, l, height), -half + i * l, 0, 0,
                  i == 0 ? l / 2 : l);
      layout.pieces.back().density = density;
    }
    layout.weld(-1, 2 * n - 1, half, 0, 0, l / 2);
    if (mass > 0) {
      layout.weld(n - 1, layout.box(0, 0, 0, 0.1, 0.1), 0, 0, 0, 1);
      layout.pieces.back().density = mass / 0.01;
    }
    return layout;
  }
};

// As Parkes' cantilever, half of the mass on half of the beam; its middle resists as its end does: 2 M_p.
struct FallingMass {
  static constexpr double mass = line_mass * half, speed = 8;
  static double exact(double yield_stress = fy) {
    return parkes(mass / 2, line_mass, half, speed, 2 * moment(yield_stress)).tip_deflection;
  }
  static double sag(int n, double dt, double yield_stress = fy) {
    ClampedBeam beam(n, unlimited, Steel::density, mass, 0, yield_stress);
    beam.built.pieces.back()->SetLinearVelocity(vec(0, -speed));
    return beam.farthest(1, dt);
  }
};

// All of the beam at once at v: hinges run from the clamps to the middle.
struct Impulse {
  static constexpr double speed = 8;
  static double exact(double yield_stress = fy) {
    return line_mass * speed * speed * half * half / (6 * moment(yield_stress));
  }
  static double sag(int n, double dt, double yield_stress = fy) {
    ClampedBeam beam(n, unlimited, Steel::density, 0, 0, yield_stress);
    return sag(beam, speed, dt);
  }
  static double sag(ClampedBeam& beam, double v, double dt) {
    for (b2Body* piece : beam.built.pieces) piece->SetLinearVelocity(vec(0, -v));
    return beam.farthest(1, dt);
  }
};

// The same on two pins: hinges run from the ends to the middle.
struct PinnedImpulse {
  static constexpr double speed = 6;
  static double exact() { return line_mass * speed * speed * 4 * half * half / (12 * M_p); }
  static double sag(int n, double dt) {
    ClampedBeam beam(n, unlimited, Steel::density, 0, 0);
    for (const int end : {0, 2 * n})
      static_cast<ElasticPlasticJoint*>(beam.built.joints[static_cast<std::size_t>(end)])
          ->set_caps(rotation, 0, 0);
    return Impulse::sag(beam, speed, dt);
  }
};

// The same between clamps that hold, where N and M yield each by itself: Jones' estimate by one mode, whose
// hinges stand still, W/H = ½ (√(1 + 3λ/4) − 1), λ = m v² L²/(M_p H), which is an eighth above the exact λ/6
// where λ is small.
struct StretchedBeam {
  static constexpr double speed = 16;
  static double estimate() {
    const double lambda = line_mass * speed * speed * half * half / (M_p * height);
    return height / 2 * (std::sqrt(1 + 3 * lambda / 4) - 1);
  }
  static double sag(int n, double dt) {
    ClampedBeam beam(n, unlimited, Steel::density, 0, 0, fy, true);
    return Impulse::sag(beam, speed, dt);
  }
};

// A bar that turns about its end is stopped by a hinge of mild steel, whose moment grows with the rate by
// Cowper and Symonds: I ω' = −M_p (1 + (ω/R)^(1/q)), R = D L_p/y. Its rotation is ∫ I ω dω / M, in o =
// (ω/R)^(1/q) ∫ I R² q o^(2q − 1)/(M_p (1 + o)) do.
struct RateOfStrain {
  static constexpr double length = 10, depth = 0.5, yield = 235e6, D = 40, q = 5,
                          turns = 5;  // m, m, Pa, 1/s, rad/s
  static double exact() {
    constexpr double density = 7850, R = D * depth / (depth / 2), M = yield * depth * depth / 4;
    constexpr double I = density * length * depth * (length * length / 3 + depth * depth / 12);
    const double end = std::pow(turns / R, 1 / q);
    constexpr int n = 1000;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const double o = end * (i + 0.5) / n;
      sum += std::pow(o, 2 * q - 1) / (1 + o) * end / n;
    }
    return I * R * R * q / M * sum;
  }
  static double rotation(double dt) {
    SceneDef scene;
    scene.gravity = {};
    scene.joint.axial = scene.joint.shear = scene.joint.max_rotation = unlimited;
    scene.joint.elastic = Elasticity::rigid;
    Material steel = materials::S235;
    steel.rate_D = D;
    steel.rate_q = q;
    scene.bodies = {
        {.name = "wall",
         .type = BodyType::static_body,
         .outline = {{{-1, -1}, {0, -1}, {0, 1}, {-1, 1}}, {}}},
        {.name = "bar",
         .outline = {{{0, -depth / 2}, {length, -depth / 2}, {length, depth / 2}, {0, depth / 2}}, {}},
         .material = steel,
         .velocity = {0, turns * length / 2},
         .angular_velocity = turns,
         .collides = false}};
    scene.joints = {{.a = "wall", .b = "bar"}};
    Simulation simulation(calibrate(scene), JointSolver::direct, {.dt = dt});
    while (simulation.time() < 2) simulation.step();
    return simulation.joint(0).accumulated_rotation;
  }
};

// The column under a heavy floor is gone at once: the light beam takes F where it yields at R = 8 M_p/2 half
// in all three hinges together. Energy: F w = R (w − w_y/2).
struct LostColumn {
  static double exact(double share) { return 1 / (2 * (1 - share)); }
  static double ductility(double share, int n, double dt) {
    constexpr double R = 4 * M_p / half, yields = R * 8 * half * half * half / (192 * EI), g = 10;
    ClampedBeam beam(n, Steel::E, Steel::density / 1000, share * R / g, g);
    return beam.farthest(5, dt) / yields;
  }
};

/// Of a beam of steel in so many pieces, thrown up turning: how far it has turned, and where its middle is.
struct Tumbling {
  static constexpr double turns = 3, up = 20, g = 9.81, seconds = 2;  // rad/s, m/s, m/s², s
  double angle = 0, rise = 0;
  Tumbling(int n, double dt) {
    Built b(bench::chains(1, n, false).let_go(), Built::ours, g);
    b.set_rigid_motion(0, up - turns * half, turns);
    for (long i = 0, steps = std::lround(seconds / dt); i < steps; ++i) b.step(dt);
    for (const b2Body* piece : b.pieces) {
      angle += double{piece->GetAngle()} / n;
      rise += double{piece->GetWorldCenter().y} / n;
    }
  }
};

}  // namespace

std::vector<Benchmark> blow_benchmarks(const Context& context) {
  std::vector<Benchmark> rows;
  for (const bool fine : {true, false}) {
    const double small = context.quick ? 1. / 1920 : 1. / 6000, dt = fine ? small : 1. / 60,
                 allowed = fine ? 0.03 : 0.1;
    const int n = fine ? 20 : 10;
    const std::string hz = fmt::format("; {} pieces, {:g} Hz", 2 * n, 1 / dt),
                      rigid = "rigid-plastic, 20 m × 1 m on two clamps, one slides, f_y = 35 MPa, ";
    rows.push_back({"Mass that falls on a clamped beam",
                    "Parkes, 1958: his cantilever, with half the mass and 2 M_p", "worked out here; not read",
                    fmt::format("{}half the beam's mass at 8 m/s in its middle{}", rigid, hz),
                    "set of the middle [m]", FallingMass::exact(), FallingMass::sag(n, dt), allowed});
    rows.push_back({"Clamped beam under an impulse",
                    "Symonds; Jones, Structural Impact: m v² L²/(6 M_p), L half the span",
                    "closed form; not read", fmt::format("{}all of it at 8 m/s{}", rigid, hz),
                    "set of the middle [m]", Impulse::exact(), Impulse::sag(n, dt), allowed});
    rows.push_back(
        {"Beam on two pins under an impulse",
         "Jones, Structural Impact: W_f m M_p/I² = 0.08333, with I = m v L: m v² L²/(12 M_p)",
         "value in a secondary source: Scientific Reports 12, 2022, s41598-022-14082-4, table 3",
         fmt::format("rigid-plastic, 20 m × 1 m on two pins, one slides, f_y = 35 MPa, all of it at 6 m/s{}",
                     hz),
         "set of the middle [m]", PinnedImpulse::exact(), PinnedImpulse::sag(n, dt), allowed});
    rows.push_back(
        {"Bar stopped by a hinge that depends on the rate of strain",
         "Cowper and Symonds, 1957: I ω' = −M_p (1 + (ω/R)^(1/q)), R = D L_p/y", "integrated here",
         fmt::format("S235, D = 40/s, q = 5, 10 m × 0.5 m, L_p = 0.5 m, 5 rad/s about its end; {:g} Hz",
                     1 / dt),
         "rotation of the hinge [rad]", RateOfStrain::exact(), RateOfStrain::rotation(dt), allowed});
    for (const double share : {0.75, 0.9})
      rows.push_back({"Loss of a column", "Biggs, 1964; Izzuddin et al., 2008: 1/(2 (1 − F/R))",
                      "closed form; not read",
                      fmt::format("light beam of 20 m × 1 m, E = 210 GPa, f_y = 35 MPa, on two clamps, one "
                                  "slides, F = {:g} of its "
                                  "collapse load in its middle, its column gone at once",
                                  share) +
                          hz,
                      fmt::format("largest sag over that at yield, F = {:g} R", share),
                      LostColumn::exact(share), LostColumn::ductility(share, n, dt), allowed});
    const Tumbling thrown(20, dt);
    const std::string throw_input =
        fmt::format("steel, 20 m × 1 m, 20 pieces, 20 m/s up, 3 rad/s; {:g} Hz", 1 / dt);
    rows.push_back({"Beam that tumbles", "closed form: ω t", "closed form", throw_input,
                    "angle after 2 s [rad]", Tumbling::turns * Tumbling::seconds, thrown.angle, allowed});
    rows.push_back(
        {"Beam that tumbles", "Galilei: v t − g t²/2", "closed form", throw_input, "rise after 2 s [m]",
         Tumbling::up * Tumbling::seconds - Tumbling::g * Tumbling::seconds * Tumbling::seconds / 2,
         thrown.rise, allowed});
  }
  return rows;
}

std::vector<Benchmark> strong_blow_benchmarks(const Context& context) {
  std::vector<Benchmark> rows;
  for (const bool fine : {true, false}) {
    const double dt = fine ? (context.quick ? 1. / 1920 : 1. / 6000) : 1. / 60, allowed = fine ? 0.03 : 0.1;
    const int n = fine ? 20 : 10;
    const std::string hz = fmt::format("; {} pieces, {:g} Hz", 2 * n, 1 / dt),
                      rigid = "rigid-plastic, 20 m × 1 m on two clamps, f_y = ";
    rows.push_back(
        {"Mass that falls on a clamped beam, at the yield stress of steel",
         "Parkes, 1958: his cantilever, with half the mass and 2 M_p", "worked out here; not read",
         fmt::format("{}350 MPa, one slides, half the beam's mass at 8 m/s in its middle{}", rigid, hz),
         "set of the middle [m]", FallingMass::exact(Steel::fy), FallingMass::sag(n, dt, Steel::fy),
         allowed});
    rows.push_back(
        {"Clamped beam under an impulse, at the yield stress of steel",
         "Symonds; Jones, Structural Impact: m v² L²/(6 M_p), L half the span", "closed form; not read",
         fmt::format("{}350 MPa, one slides, all of it at 8 m/s{}", rigid, hz), "set of the middle [m]",
         Impulse::exact(Steel::fy), Impulse::sag(n, dt, Steel::fy), allowed});
    rows.push_back(
        {"Clamped beam that stretches under an impulse",
         "Jones, Structural Impact, an estimate by one mode: W/H = ½ (√(1 + 3λ/4) − 1), λ = m v² L²/(M_p H)",
         "closed form; not read", fmt::format("{}35 MPa, both hold, all of it at 16 m/s{}", rigid, hz),
         "set of the middle [m]", StretchedBeam::estimate(), StretchedBeam::sag(n, dt), 0.125});
  }
  return rows;
}

}  // namespace ductile::report
