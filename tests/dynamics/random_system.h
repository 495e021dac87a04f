// Random structures for the tests of the solver's parts: bodies of any mass that hang together in loops, some
// held, some that do not rotate, and joints of every kind of law, strained so that all regimes occur.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "../../joint/objective.h"
#include "../../joint/step_laws.h"

namespace ductile::dynamics {

struct RandomSystem {
  explicit RandomSystem(unsigned seed, int bodies = 6, bool rigid_rows = false) : random(seed) {
    for (int i = 0; i < bodies; ++i) {
      Body body;
      body.mass = std::pow(10, in(0, 2));
      body.inertia = i % 5 == 4 ? 0 : body.mass * in(0.1, 2);
      system.bodies.push_back(body);
      put(system.places.emplace_back(), {in(-5, 5), in(-5, 5), in(-4, 4)});
    }
    for (int i = 1; i < bodies; ++i)
      join(i, static_cast<int>(random() % static_cast<unsigned>(i)), rigid_rows);
    for (int i = 0; i < bodies / 2; ++i) {
      const int a = any(bodies), b = any(bodies);
      if (a != b) join(a, b, rigid_rows);
    }
    // The last two bodies are held, or move as prescribed.
    system.form(static_cast<std::size_t>(bodies - 2));
    locate_all(system);
    for (Joint& j : system.joints) j.neutral = system.record(j).gap;
    laws.begin(system, h);
    // Stress-free up to here; now strained, each row by about its yield strain.
    for (Joint& j : system.joints) {
      for (unsigned i = 0; i < 3; ++i) j.neutral[i] += in(-1, 1) * yield / (k * h);
    }
    system.biases_known = false;
    laws.begin(system, h);
    for (Body& b : system.bodies) {
      b.v_free = {in(-1, 1), in(-1, 1), in(-1, 1)};
      b.v = {in(-1, 1), in(-1, 1), in(-1, 1)};
      if (b.inertia == 0) b.v.w = b.v_free.w;
    }
  }

  double in(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  int any(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }

  void join(int a, int b, bool rigid_rows) {
    Joint joint;
    joint.a = a, joint.b = b;
    joint.frame = {in(-1, 1), in(-1, 1), in(-1, 1), in(-1, 1), turn_of(in(-3, 3)), any(3) / 2.0, in(-1, 1)};
    system.joints.push_back(joint);
    JointRecord record;
    Material& m = record.material;
    for (unsigned i = 0; i < 3; ++i) {
      m.stiffness[i] = rigid_rows && any(3) == 0 ? rigid : k * in(0.5, 2);
      m.damping_ratio[i] = any(2) * in(0, 0.5);
      m.cap[i] = any(5) == 0 ? unlimited : yield / h * in(0.1, 2);
      m.cap_reverse[i] = yield / h * in(0.1, 2);
      if (any(6) == 0) m.cap[i] = m.cap_reverse[i] = 0;  // free
      if (any(3) == 0) m.hardening[i] = k * in(0.01, 0.4);
    }
    if (any(4) == 0) {
      const double N = yield / h, M = yield / h;
      const AxialMoment curve[] = {{N, 0}, {0.3 * N, M}, {-N, 0.1 * M}, {0.2 * N, -M}};
      surfaces.push_back(std::make_unique<YieldSurface>(curve, any(2) == 0 ? unlimited : yield / h));
      m.surface = surfaces.back().get();
      m.cap = m.cap_reverse = {yield / h, yield / h, yield / h};
      m.hardening = {};
    }
    system.records.push_back(record);
  }

  static constexpr double h = 1.0 / 60;
  static constexpr double k = 1e4;    // N/m: G is of the order of the masses
  static constexpr double yield = 3;  // N s
  std::mt19937 random;
  std::vector<std::unique_ptr<YieldSurface>> surfaces;
  System system;
  StepLaws laws;
};

}  // namespace ductile::dynamics
