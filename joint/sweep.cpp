#include "sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "block_ldlt.h"

namespace ductile::dynamics::sweep {

namespace {

// One body's half of J, its M⁻¹, and what they make of impulses.
struct Side {
  JacobianRows rows;
  double inverse_mass, inverse_inertia;

  Vec3 response(const Rows& s) const {
    const Vec3 sum = s[0] * rows.u + s[1] * rows.v + s[2] * rows.w;
    return {inverse_mass * sum.x, inverse_mass * sum.y, inverse_inertia * sum.w};
  }
};

// J M⁻¹ Jᵀ of a joint.
struct EffectiveMass {
  Side a, b;
  double k[3][3];
};

EffectiveMass effective_mass(const System& system, const Joint& j) {
  const auto side = [&](int index, const JacobianRows& rows) {
    const Body& body = system.bodies[z(index)];
    const bool moves = system.is_free(index);
    return Side{rows, moves ? 1 / body.mass : 0, moves && body.inertia > 0 ? 1 / body.inertia : 0};
  };
  EffectiveMass m{side(j.a, rows_of_a(j.J)), side(j.b, rows_of_b(j.J)), {}};
  for (const Side* s : {&m.a, &m.b}) {
    const Vec3 rows[3] = {s->rows.u, s->rows.v, s->rows.w};
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        m.k[r][c] += s->inverse_mass * (rows[r].x * rows[c].x + rows[r].y * rows[c].y) +
                     s->inverse_inertia * rows[r].w * rows[c].w;
      }
    }
  }
  return m;
}

// x with (K + diag(compliance)) x = r over the rows in `held`, and x as given in the others; in all of them
// where arms are so long that K is singular to rounding.
Rows solve_block(const double (&k)[3][3], const Rows& compliance, const Rows& r, unsigned held, Rows x) {
  Block m{};
  Rows rhs{};
  for (std::size_t i = 0; i < 3; ++i) {
    m.a[4 * i] = 1;
    if ((held >> i & 1u) == 0) continue;
    rhs[i] = r[i];
    for (std::size_t c = 0; c < 3; ++c) {
      if ((held >> c & 1u) != 0) {
        m.a[3 * i + c] = k[i][c] + (i == c ? compliance[i] : 0);
      } else {
        rhs[i] -= k[i][c] * x[c];
      }
    }
  }
  factor_block(m);
  solve_block(m, rhs[0], rhs[1], rhs[2]);
  if (!std::isfinite(rhs[0] + rhs[1] + rhs[2])) return x;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((held >> i & 1u) != 0) x[i] = rhs[i];
  }
  return x;
}

// Sweeps that do not converge, as of regimes that turn by a radian a step, leave impulses that would be
// carried on and grow without end: where they would move a body by more than so many times what Box2D lets it
// move, and back, they are forgotten.
void drop_if_beyond(double times, System& system, double h, Evaluation& at) {
  const auto within = [&](const Body& b) {
    const Vec3 given = b.v - b.v_free;
    return h * std::hypot(given.x, given.y) <= times * 2 * 2.0 &&
           h * std::abs(given.w) <= times * std::numbers::pi;
  };
  const auto end = system.bodies.begin() + static_cast<std::ptrdiff_t>(system.free);
  if (std::all_of(system.bodies.begin(), end, within)) return;
  at.fastest2 = at.fastest_turn2 = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    Body& b = system.bodies[i];
    b.v = b.v_free;
    at.see(b);
  }
  for (Joint& j : system.joints) system.record(j).x = j.impulse = {};
}

}  // namespace

void warm_start(System& system, double h, Evaluation& at) {
  for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v = system.bodies[i].v_free;
  for (Joint& j : system.joints) {
    const RowLaw& law = system.record(j).law;
    for (unsigned i = 0; i < 3; ++i) j.impulse[i] = std::clamp(j.impulse[i], -law.cap_reverse[i], law.cap[i]);
    const EffectiveMass m = effective_mass(system, j);
    system.bodies[z(j.a)].v -= m.a.response(j.impulse);
    system.bodies[z(j.b)].v -= m.b.response(j.impulse);
  }
  drop_if_beyond(1, system, h, at);
}

void velocities(System& system, double h, Evaluation& at) {
  at.flows = false;
  Vector<Body>& bodies = system.bodies;
  for (Joint& j : system.joints) {
    const EffectiveMass m = effective_mass(system, j);
    const RowLaw& law = system.record(j).law;
    Rows r = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v), compliance{};
    unsigned held = 0, regime = 0;
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.G[i] > 0)) continue;
      held |= 1u << i;
      if (is_rigid(system.record(j), i)) continue;
      compliance[i] = 1 / j.G[i];
      r[i] += j.bias[i] - compliance[i] * j.impulse[i];
    }
    Rows change = solve_block(m.k, compliance, r, held, {});
    for (int again = 0; again < 3; ++again) {
      unsigned exceeded = 0;
      for (unsigned i = 0; i < 3; ++i) {
        if ((held >> i & 1u) == 0) continue;
        const double s = j.impulse[i] + change[i];
        const double within = std::clamp(s, -law.cap_reverse[i], law.cap[i]);
        if (within == s) continue;
        exceeded |= 1u << i;
        regime |= (s > within ? 1u : 8u) << i;
        change[i] = within - j.impulse[i];
      }
      if (exceeded == 0) break;
      held &= ~exceeded;
      change = solve_block(m.k, compliance, r, held, change);
    }
    for (unsigned i = 0; i < 3; ++i) j.impulse[i] += change[i];
    j.regime = static_cast<std::uint8_t>(regime);
    at.flows |= regime != 0;
    for (unsigned i = 0; i < 3 && regime != 0; ++i)
      system.record(j).x[i] = (regime >> i & 1u) != 0 ? 1 : (regime >> (3 + i) & 1u) != 0 ? -1 : 0;
    bodies[z(j.a)].v -= m.a.response(change);
    bodies[z(j.b)].v -= m.b.response(change);
  }
  drop_if_beyond(1e3, system, h, at);
}

void positions(System& system, std::span<const Pose> at) {
  Vector<Place>& places = system.places;
  for (std::size_t i = 0; i < system.free; ++i) put(places[i], at[i]);
  for (Joint& j : system.joints) {
    const Rows gap = locate(j, places);
    const EffectiveMass m = effective_mass(system, j);
    Rows error{};
    unsigned held = 0;
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.G[i] > 0) || !is_rigid(system.record(j), i) || flows(j.regime, i)) continue;
      held |= 1u << i;
      error[i] = gap[i] - j.neutral[i];
    }
    if (held == 0) continue;
    const Rows correction = solve_block(m.k, {}, error, held, {});
    // As far as Box2D corrects at once: beyond, the tangent says nothing, and regimes on long arms are flung
    // away.
    const Vec3 a = m.a.response(correction), b = m.b.response(correction);
    const double reach = std::max(std::hypot(a.x, a.y), std::hypot(b.x, b.y)) / 0.2;
    const double turn = std::max(std::abs(a.w), std::abs(b.w)) / (8.0 / 180 * std::numbers::pi);
    const double share = 1 / std::max({1.0, reach, turn});
    if (system.is_free(j.a)) displace(places[z(j.a)], -share * a);
    if (system.is_free(j.b)) displace(places[z(j.b)], -share * b);
  }
  locate_all(system);
}

}  // namespace ductile::dynamics::sweep
