// The paper's way: joint by joint, in Box2D's own iterations. Each joint's three rows are solved as one block
// with its full effective mass; rows that would exceed their caps are put at them and the rest of the block
// is solved again (clamping alone creates energy); impulses are accumulated and carried over to the next
// step. Rigid rows are kept together by position correction, as in b2WeldJoint.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver.h"

namespace ductile {

namespace {

constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }

// The part of J of one body, its M⁻¹, and what they make of impulses.
struct Side {
  double row[3][3];
  double inverse_mass, inverse_inertia;

  Vec3 response(const Rows& s) const {
    Vec3 sum;
    for (int i = 0; i < 3; ++i) {
      sum += {row[i][0] * s[z(i)], row[i][1] * s[z(i)], row[i][2] * s[z(i)]};
    }
    return {inverse_mass * sum.x, inverse_mass * sum.y, inverse_inertia * sum.w};
  }
};

// J M⁻¹ Jᵀ of a joint.
struct EffectiveMass {
  Side a, b;
  double k[3][3];
};

EffectiveMass effective_mass(const Solver& solver, const SolverJoint& j) {
  const auto side = [&](int index, double sign, const Turn& axis, double u, double v) {
    const SolverBody& body = solver.bodies[z(index)];
    const bool moves = z(index) < solver.free_bodies();
    return Side{{{sign * axis.c, sign * axis.s, u}, {-sign * axis.s, sign * axis.c, v}, {0, 0, sign}},
                moves ? 1 / body.mass : 0,
                moves && body.inertia > 0 ? 1 / body.inertia : 0};
  };
  EffectiveMass m{side(j.a, -1, j.axis_a, j.au, j.av), side(j.b, 1, j.axis_b, j.bu, j.bv), {}};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      for (const Side* s : {&m.a, &m.b}) {
        m.k[r][c] += s->inverse_mass * (s->row[r][0] * s->row[c][0] + s->row[r][1] * s->row[c][1]) +
                     s->inverse_inertia * s->row[r][2] * s->row[c][2];
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

}  // namespace

// Sweeps that do not converge, as of pieces that turn by a radian a step, leave impulses that would be
// carried on and grow without end: where they would move a body by more than Box2D lets it move, and back,
// they are forgotten.
void Solver::warm_start() {
  for (std::size_t i = 0; i < free_; ++i) bodies[i].v = bodies[i].v_free;
  for (SolverJoint& j : joints) {
    const RowLaw& law = record(j).law;
    for (unsigned i = 0; i < 3; ++i) j.impulse[i] = std::clamp(j.impulse[i], -law.cap_reverse[i], law.cap[i]);
    const EffectiveMass m = effective_mass(*this, j);
    bodies[z(j.a)].v -= m.a.response(j.impulse);
    bodies[z(j.b)].v -= m.b.response(j.impulse);
  }
  drop_if_beyond(1);
}

// Impulses that would move a body by more than so many times what Box2D lets it move, there and back.
void Solver::drop_if_beyond(double times) {
  const auto within = [&](const SolverBody& b) {
    const Vec3 given = b.v - b.v_free;
    return h_ * std::hypot(given.x, given.y) <= times * 2 * 2.0 &&
           h_ * std::abs(given.w) <= times * std::numbers::pi;
  };
  if (std::all_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(free_), within)) return;
  drop_impulses();
}

void Solver::sweep() {
  flows_ = false;
  swept_ = true;
  for (SolverJoint& j : joints) {
    const EffectiveMass m = effective_mass(*this, j);
    const RowLaw& law = record(j).law;
    Rows r = relative(j, bodies[z(j.a)].v, bodies[z(j.b)].v), compliance{};
    unsigned held = 0, piece = 0;
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.G[i] > 0)) continue;
      held |= 1u << i;
      if (is_rigid(record(j), i)) continue;
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
        piece |= (s > within ? 1u : 8u) << i;
        change[i] = within - j.impulse[i];
      }
      if (exceeded == 0) break;
      held &= ~exceeded;
      change = solve_block(m.k, compliance, r, held, change);
    }
    for (unsigned i = 0; i < 3; ++i) j.impulse[i] += change[i];
    j.piece = static_cast<std::uint8_t>(piece);
    flows_ |= piece != 0;
    for (unsigned i = 0; i < 3 && piece != 0; ++i)
      record(j).x[i] = (piece >> i & 1u) != 0 ? 1 : (piece >> (3 + i) & 1u) != 0 ? -1 : 0;
    bodies[z(j.a)].v -= m.a.response(change);
    bodies[z(j.b)].v -= m.b.response(change);
  }
  drop_if_beyond(1e3);
}

void Solver::sweep_positions(std::span<const Pose> at) {
  for (std::size_t i = 0; i < free_; ++i) put(places[i], at[i]);
  for (SolverJoint& j : joints) {
    const Rows gap = locate(j);
    const EffectiveMass m = effective_mass(*this, j);
    Rows error{};
    unsigned held = 0;
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.G[i] > 0) || !is_rigid(record(j), i) || flows(j.piece, i)) continue;
      held |= 1u << i;
      error[i] = gap[i] - j.neutral[i];
    }
    if (held == 0) continue;
    const Rows correction = solve_block(m.k, {}, error, held, {});
    // As far as Box2D corrects at once: beyond, the tangent says nothing, and pieces on long arms are flung
    // away.
    const Vec3 a = m.a.response(correction), b = m.b.response(correction);
    const double reach = std::max(std::hypot(a.x, a.y), std::hypot(b.x, b.y)) / 0.2;
    const double turn = std::max(std::abs(a.w), std::abs(b.w)) / (8.0 / 180 * std::numbers::pi);
    const double share = 1 / std::max({1.0, reach, turn});
    if (z(j.a) < free_) displace(places[z(j.a)], -share * a);
    if (z(j.b) < free_) displace(places[z(j.b)], -share * b);
  }
  locate();
}

}  // namespace ductile
