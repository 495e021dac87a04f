#include "objective.h"

#include "turn_inertia.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace ductile::dynamics {

double square(const System& system, std::span<Vec3> g) {
  double norm = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    if (system.bodies[i].inertia == 0) g[i].w = 0;
    norm += square(system.bodies[i], g[i]);
  }
  return norm;
}

void add_impulses(System& system, std::span<Vec3> g, Evaluation& at) {
  int changed = 0;
  unsigned crossed = 0, any = 0;
  const Body* bodies = system.bodies.data();
  for (Joint& j : system.joints) {
    const Rows x = biased_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
    const auto take = [&](const Rows& s, unsigned regime) {
      add_transposed(j, s, g[z(j.a)], g[z(j.b)]);
      j.impulse = s;
      if ((regime | j.regime | j.factored_flow) == 0) return;
      crossed |= (regime ^ j.regime) | (regime & on_surface);
      any |= regime;
      j.regime = static_cast<std::uint8_t>(regime);
      changed += std::popcount(flowing(regime) ^ j.factored_flow);
    };
    // Two calls: the one that most joints take keeps all in registers, as no address of `trial` is taken.
    const Rows trial{j.G[0] * x[0], j.G[1] * x[1], j.G[2] * x[2]};
    if (is_elastic(j, trial)) {
      take(trial, 0);
    } else {
      JointRecord& r = system.record(j);
      const Response beyond = respond(r.law, r.x = x);
      take(beyond.s, beyond.regime);
    }
  }
  add_turn_impulses(system, g);
  at.changed = changed;
  at.crossed = crossed != 0;
  at.flows = any != 0;
  at.curved = (any & on_surface) != 0;
}

void find_x(System& system) {
  for (const Joint& j : system.joints) {
    if (j.regime != 0) continue;  // known
    system.record(j).x = biased_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
  }
}

// By Moreau's identity φ(x) = s·x − φ*(s), with φ*(s) = ½ s²/G, and ½ (|s| − hF)²/η where a hardening row has
// slipped beyond its cap F; η is what the cap grows by per slip.
double objective(System& system, const Evaluation& at) {
  find_x(system);
  double f = at.impulse2 / 2;
  for (const Joint& j : system.joints) {
    const JointRecord& r = system.record(j);
    for (unsigned i = 0; i < 3; ++i) {
      const double s = j.impulse[i], after = r.law.after_yield[i];
      if (j.G[i] > 0) f += s * (r.x[i] - s / (2 * j.G[i]));
      if (after > 0 && flows(j.regime, i)) {
        const double over = std::abs(s) - (s > 0 ? r.law.cap : r.law.cap_reverse)[i];
        f -= over * over * (1 - after) / (2 * after * j.G[i]);
      }
    }
  }
  for (const TurnInertia& t : system.turn_inertias)
    f += t.impulse * (t.rate_of(system.bodies[z(t.a)].v, system.bodies[z(t.b)].v) - t.rate) / 2;
  return f;
}

double rounding_of_impulses(const System& system) {
  double sum = 0;
  for (const Joint& j : system.joints) {
    const Rows& m_eff = system.record(j).m_eff;
    for (unsigned i = 0; i < 3; ++i) sum += m_eff[i] > 0 ? j.impulse[i] * j.impulse[i] / m_eff[i] : 0;
  }
  return 1e-28 * sum;
}

}  // namespace ductile::dynamics
