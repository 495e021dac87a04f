// The same convex problem by a primal–dual interior point method: slower than Newton's where few rows flow,
// but a dozen rounds suffice whatever the number of rows that change their state at once (a struck chain, a
// collapse).
//
//   M (v − v*) + Jᵀ s = 0        J v + b = s/G + z⁺ − z⁻        z⁺ p⁺ = μ,   z⁻ p⁻ = μ,   μ → 0
//
// s are the impulses, z± the plastic slips, p⁺ = F⁺ + ηz⁺ − s and p⁻ = F⁻ + ηz⁻ + s what is left to the caps,
// which hardening raises by η per slip; all p, z > 0. Each round is one system with the pattern of H: the
// slope of a row is 1/(1/G + z⁺/(p⁺ + ηz⁺) + z⁻/(p⁻ + ηz⁻)). Mehrotra's predictor–corrector.

#include <algorithm>
#include <cmath>

#include "solver.h"

namespace ductile {

namespace {
constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }
}  // namespace

int Solver::interior_point() {
  constexpr double boundary = 0.995;  // share of the way to a bound that a step may go
  // Of the work: rows that slip a hundred-millionth of what others do are told apart from those that hold.
  // What is left undecided makes the Newton rounds that follow cycle: at 1e-11 in a struck beam at 6000 Hz,
  // at 1e-15 in a spinning chain whose pieces weigh 1e4 times as much as their neighbours and which stretches
  // everywhere at once.
  constexpr double accuracy = 1e-19;
  const double work = scale_ + speed_;

  // Start well inside, with slips of the size of the velocities at hand.
  find_x();
  double slip = 0;
  int bounds = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const SolverJoint& j = joints[k];
    const Rows& x = records[k].x;
    for (unsigned i = 0; i < 3; ++i) {
      Barrier& w = barrier_[k][i];
      w = {};
      if (!(j.G[i] > 0)) continue;
      const double cap[2] = {records[k].law.cap[i], records[k].law.cap_reverse[i]};
      if (std::isinf(cap[0]) && std::isinf(cap[1])) {
        w.s = j.G[i] * x[i];
        continue;
      }
      const double inside =
          0.05 * std::min(cap[0] + cap[1], std::abs(j.G[i] * x[i]) + std::min(cap[0], cap[1]));
      w.s = std::clamp(j.G[i] * x[i], inside - cap[1], cap[0] - inside);
      for (int side = 0; side < 2; ++side) {
        w.p[side] = side == 0 ? cap[0] - w.s : cap[1] + w.s;
        w.bounded[side] = std::isfinite(cap[side]) && w.p[side] > 0;
        if (!w.bounded[side]) continue;
        slip += std::abs(x[i]);
        ++bounds;
      }
    }
  }
  if (bounds == 0) return 0;
  slip /= bounds;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    for (unsigned i = 0; i < 3; ++i) {
      Barrier& w = barrier_[k][i];
      const double x = records[k].x[i];
      w.z[0] = std::max(x, 0.0) + slip / 10;
      w.z[1] = std::max(-x, 0.0) + slip / 10;
      // s = F⁺ + ηz is the law's share a of G beyond the cap where a G = η/(1 + η/G).
      const double a = records[k].law.after_yield[i];
      w.hardening = a * joints[k].G[i] / (1 - a);
      for (int side = 0; side < 2; ++side) w.p[side] += w.hardening * w.z[side];
    }
  }

  const auto each_bound = [this](auto&& visit) {
    for (std::size_t k = 0; k < joints.size(); ++k) {
      for (unsigned i = 0; i < 3; ++i) {
        for (int side = 0; side < 2; ++side) {
          if (barrier_[k][i].bounded[side]) visit(barrier_[k][i], side);
        }
      }
    }
  };

  int factorisations = 0;
  for (int round = 0; round < 40; ++round) {
    double gap = 0;  // Σ z p
    each_bound([&](const Barrier& w, int side) { gap += w.z[side] * w.p[side]; });
    if (!(gap > accuracy * work)) break;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      SolverJoint& j = joints[k];
      for (unsigned i = 0; i < 3; ++i) {
        const Barrier& w = barrier_[k][i];
        double compliance = 1 / j.G[i];
        for (int side = 0; side < 2; ++side) {
          if (w.bounded[side]) compliance += w.z[side] / (w.p[side] + w.hardening * w.z[side]);
        }
        records[k].slope[i] = j.G[i] > 0 ? 1 / compliance : 0;
      }
    }
    factor();
    ++factorisations;

    // Predictor (μ = 0), then a corrector with the centring and the second-order terms that the predictor
    // calls for.
    double mu = 0, step = 1;
    for (const bool corrector : {false, true}) {
      for (std::size_t i = 0; i < free_; ++i) {
        const SolverBody& b = bodies[i];
        const Vec3 given = b.v - b.v_free;
        g_[i] = {b.mass * given.x, b.mass * given.y, b.inertia * given.w};
      }
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const SolverJoint& j = joints[k];
        const Rows v = relative(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
        Rows s{};
        for (unsigned i = 0; i < 3; ++i) {
          if (!(j.G[i] > 0)) continue;
          Barrier& w = barrier_[k][i];
          w.r = v[i] + j.bias[i] - w.s / j.G[i];
          for (int side = 0; side < 2; ++side) {
            if (!w.bounded[side]) continue;
            w.second[side] = corrector ? w.dp[side] * w.dz[side] : 0;
            const double over = w.z[side], after = w.hardening * over;
            w.r -= (side == 0 ? 1 : -1) * (mu - w.second[side] + after * over) / (w.p[side] + after);
          }
          s[i] = w.s + records[k].slope[i] * w.r;
        }
        scatter(j, s);
      }
      for (std::size_t i = 0; i < free_; ++i) {
        if (bodies[i].inertia == 0) g_[i].w = 0;
        d_[i] = -1.0 * g_[i];
      }
      ldlt_.solve({d_.data(), free_});
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const SolverJoint& j = joints[k];
        const Rows y = relative(j, d_[z(j.a)], d_[z(j.b)]);
        for (unsigned i = 0; i < 3; ++i) {
          Barrier& w = barrier_[k][i];
          w.ds = records[k].slope[i] * (y[i] + w.r);
          for (int side = 0; side < 2; ++side) {
            if (!w.bounded[side]) continue;
            const double over = w.z[side], ds = side == 0 ? w.ds : -w.ds;
            w.dz[side] = (mu - w.second[side] - over * (w.p[side] - ds)) / (w.p[side] + w.hardening * over);
            w.dp[side] = w.hardening * w.dz[side] - ds;
          }
        }
      }
      step = 1;
      each_bound([&](const Barrier& w, int side) {
        if (w.dp[side] < 0) step = std::min(step, -boundary * w.p[side] / w.dp[side]);
        if (w.dz[side] < 0) step = std::min(step, -boundary * w.z[side] / w.dz[side]);
      });
      if (corrector) break;
      double after = 0;
      each_bound([&](const Barrier& w, int side) {
        after += (w.z[side] + step * w.dz[side]) * (w.p[side] + step * w.dp[side]);
      });
      mu = std::pow(std::clamp(after / gap, 0.0, 1.0), 3) * gap / bounds;
    }
    for (std::size_t i = 0; i < free_; ++i) bodies[i].v += step * d_[i];
    for (auto& rows : barrier_) {
      for (Barrier& w : rows) w.s += step * w.ds;
    }
    each_bound([&](Barrier& w, int side) {
      w.p[side] += step * w.dp[side];
      w.z[side] += step * w.dz[side];
    });
  }

  // The rows that flow are known now. Velocities are not yet good enough to tell by: a rigid row multiplies
  // what they lack by κ. So the law is taken on those linear pieces, whatever x says, and solved there.
  for (std::size_t k = 0; k < joints.size(); ++k) {
    unsigned piece = 0;
    for (unsigned i = 0; i < 3; ++i) {
      for (unsigned side = 0; side < 2; ++side) {
        const Barrier& w = barrier_[k][i];
        if (w.bounded[side] && w.z[side] * joints[k].G[i] > w.p[side]) piece |= 1u << (i + 3 * side);
      }
    }
    joints[k].piece = static_cast<std::uint8_t>(piece);
  }
  short_step_ = false;
  factor_tangents();
  ++factorisations;
  for (int refinement = 0; refinement < 2; ++refinement) {
    for (std::size_t i = 0; i < free_; ++i) {
      const SolverBody& b = bodies[i];
      const Vec3 given = b.v - b.v_free;
      g_[i] = {b.mass * given.x, b.mass * given.y, b.inertia * given.w};
    }
    for (const SolverJoint& j : joints) {
      const RowLaw& law = record(j).law;
      const Rows v = relative(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
      Rows s;
      for (unsigned i = 0; i < 3; ++i) {
        const double trial = j.G[i] * (v[i] + j.bias[i]);
        const double held = (j.piece >> i & 1) != 0         ? law.cap[i]
                            : (j.piece >> (i + 3) & 1) != 0 ? -law.cap_reverse[i]
                                                            : trial;
        s[i] = held + law.after_yield[i] * (trial - held);
      }
      scatter(j, s);
    }
    for (std::size_t i = 0; i < free_; ++i) {
      if (bodies[i].inertia == 0) g_[i].w = 0;
      d_[i] = -1.0 * g_[i];
    }
    ldlt_.solve({d_.data(), free_});
    for (std::size_t i = 0; i < free_; ++i) bodies[i].v += d_[i];
  }
  return factorisations;
}

}  // namespace ductile
