#include "rate.h"

#include <algorithm>
#include <cmath>

#include "flow.h"

namespace ductile::dynamics {

namespace {

constexpr double static_rate = 1e-4;  // of D
constexpr double agreement = 1e-6;    // of the cap
constexpr double steepest = 0.5;      // tangent of a row, of G

// A cap hF in impulses, raised by its share o; r = D g(o).
struct Raised {
  double o = 0, tangent = 0;  // ds/dr, N s per m/s

  // Where hF(1 + o)/G + D g(o) = x, whose left side is convex, so that Newton's steps from above never pass
  // the root.
  Raised(double hF, double G, double D, double q, double x) {
    const double o_static = std::pow(static_rate, 1 / q), linear = static_rate / o_static;
    const auto rate = [&](double at) { return at < o_static ? linear * at : std::pow(at, q); };
    const auto slope = [&](double at) { return at < o_static ? linear : q * std::pow(at, q - 1); };
    if (!(x > 0)) return;  // as a spring that is let go
    o = std::max(o_static, std::min(G * x / hF - 1, std::pow(x / D, 1 / q)));
    for (int i = 0; i < 100; ++i) {
      const double step = (hF * (1 + o) / G + D * rate(o) - x) / (hF / G + D * slope(o));
      o -= step;
      if (!(std::abs(step) > 1e-14 * (1 + o))) break;
    }
    o = std::max(o, 0.0);
    tangent = hF / (D * slope(o));
  }
};

}  // namespace

bool raise_caps(System& system) {
  bool again = false;
  for (const int k : system.rated) {
    Joint& j = system.joints[z(k)];
    JointRecord& r = system.records[z(k)];
    const RateLaw& law = *r.material.rate;
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.G[i] > 0) || law.doubling[i] == unlimited) continue;
      const double x = flows(j.regime, i) ? r.x[i] : j.impulse[i] / j.G[i], raised = r.law.raised[i];
      const double hF = (x > 0 ? r.law.cap : r.law.cap_reverse)[i] - raised;
      if (!(hF > 0) || hF == unlimited) continue;
      const auto [G, all] = rated_law(j, r, i, x);
      double to = 0, after = 0, s = std::min(j.G[i] * std::abs(x), hF);
      if (j.G[i] * std::abs(x) > hF) {
        const Raised at(hF, G, law.doubling[i], law.exponent, x > 0 ? all : -all);
        s = hF * (1 + at.o);
        after = std::min(at.tangent / (1 + at.tangent / G) / j.G[i], steepest);
        to = (s - after * j.G[i] * std::abs(x)) / (1 - after) - hF;
      }
      if (std::abs(std::abs(j.impulse[i]) - s) <= agreement * hF) continue;
      again = true;
      r.law.cap[i] += to - raised;
      r.law.cap_reverse[i] += to - raised;
      r.law.raised[i] = to;
      r.law.after_yield[i] = after;
    }
    j.elastic_range = r.law.elastic_range();
  }
  return again;
}

bool lower_caps(System& system, const StepLaws& laws) {
  bool any = false;
  for (const int k : system.rated) {
    JointRecord& r = system.records[z(k)];
    for (unsigned i = 0; i < 3; ++i) {
      if (r.law.raised[i] == 0 && r.law.after_yield[i] == 0) continue;
      any = true;
      laws.set_law(system.joints[z(k)], r);
      break;
    }
  }
  return any;
}

}  // namespace ductile::dynamics
