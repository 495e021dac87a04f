// The same convex problem by a primal–dual interior point method: slower than Newton's where few rows flow,
// but a dozen rounds suffice whatever the number of rows that change their state at once (a struck chain, a
// collapse).
//
//   M (v − v*) + Jᵀ s = 0        J v + b = s/G + z⁺ − z⁻        z⁺ (F⁺ − s) = μ,   z⁻ (F⁻ + s) = μ,   μ → 0
//
// s are the impulses, kept strictly within the caps, z± ≥ 0 the plastic slips. Each round is one system with
// the pattern of H: the slope of a row is 1/(1/G + z⁺/(F⁺ − s) + z⁻/(F⁻ + s)). Mehrotra's
// predictor–corrector. Hardening is left out here: the Newton rounds that follow put it in.

#include <algorithm>
#include <cmath>

#include "solver.h"

namespace ductile {

namespace {
constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }
constexpr double boundary = 0.995;  // share of the way to a bound that a step may go
}  // namespace

int Solver::interior_point() {
  const auto bounded = [](double cap) { return std::isfinite(cap); };
  // Start well inside: slips of the size of the velocities at hand.
  double slip = 0;
  int rows = 0;
  for (const SolverJoint& j : joints) {
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.law.G[i] > 0) || !(bounded(j.law.cap[i]) || bounded(j.law.cap_reverse[i]))) continue;
      slip += std::abs(j.x[i]);
      ++rows;
    }
  }
  if (rows == 0) return 0;
  slip /= rows;
  double work = scale_ + speed_;  // J: what the slips' work is small against
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const SolverJoint& j = joints[k];
    Barrier& w = barrier_[k];
    w = {};
    for (unsigned i = 0; i < 3; ++i) {
      if (!(j.law.G[i] > 0)) continue;
      // A cap of zero leaves no inside; a share of the other one stands in for it.
      w.s[i] = std::clamp(j.law.G[i] * j.x[i], -0.9 * j.law.cap_reverse[i], 0.9 * j.law.cap[i]);
      if (bounded(j.law.cap[i])) w.over[i] = std::max(j.x[i], 0.0) + slip / 10;
      if (bounded(j.law.cap_reverse[i])) w.under[i] = std::max(-j.x[i], 0.0) + slip / 10;
      if (bounded(j.law.cap[i]) && bounded(j.law.cap_reverse[i])) {
        const double middle = (j.law.cap[i] - j.law.cap_reverse[i]) / 2;
        const double half = 0.9 * (j.law.cap[i] + j.law.cap_reverse[i]) / 2;
        w.s[i] = std::clamp(j.law.G[i] * j.x[i], middle - half, middle + half);
      }
    }
  }

  int factorisations = 0;
  for (int round = 0; round < 40; ++round) {
    // Complementarity, and the slopes that go with it.
    double gap = 0;
    int bounds = 0;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      SolverJoint& j = joints[k];
      const Barrier& w = barrier_[k];
      for (unsigned i = 0; i < 3; ++i) {
        j.slope[i] = 0;
        if (!(j.law.G[i] > 0)) continue;
        double compliance = 1 / j.law.G[i];
        if (bounded(j.law.cap[i])) {
          compliance += w.over[i] / (j.law.cap[i] - w.s[i]);
          gap += w.over[i] * (j.law.cap[i] - w.s[i]);
          ++bounds;
        }
        if (bounded(j.law.cap_reverse[i])) {
          compliance += w.under[i] / (j.law.cap_reverse[i] + w.s[i]);
          gap += w.under[i] * (j.law.cap_reverse[i] + w.s[i]);
          ++bounds;
        }
        j.slope[i] = 1 / compliance;
      }
    }
    if (!(gap > 1e-13 * work)) break;
    const double mu = gap / bounds;
    factor();
    ++factorisations;

    // Predictor (μ = 0), then a corrector with the centring and the second-order terms that it shows to be
    // needed.
    double centring = 0, step = 1;
    for (const bool corrector : {false, true}) {
      for (std::size_t i = 0; i < free_; ++i) {
        const SolverBody& b = bodies[i];
        const Vec3 given = b.v - b.v_free;
        g_[i] = {b.mass * given.x, b.mass * given.y, b.inertia * given.w};
      }
      const auto residual = [&](const SolverJoint& j, const Barrier& w, unsigned i) {
        double r = relative(j, bodies[z(j.a)].v, bodies[z(j.b)].v)[i] + j.law.bias[i] - w.s[i] / j.law.G[i];
        if (bounded(j.law.cap[i])) {
          const double second = corrector ? -w.ds[i] * w.dover[i] : 0;
          r -= (centring * mu - second) / (j.law.cap[i] - w.s[i]);
        }
        if (bounded(j.law.cap_reverse[i])) {
          const double second = corrector ? w.ds[i] * w.dunder[i] : 0;
          r += (centring * mu - second) / (j.law.cap_reverse[i] + w.s[i]);
        }
        return r;
      };
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const SolverJoint& j = joints[k];
        Barrier& w = barrier_[k];
        Rows s;
        for (unsigned i = 0; i < 3; ++i) {
          w.r[i] = j.law.G[i] > 0 ? residual(j, w, i) : 0;
          s[i] = w.s[i] + j.slope[i] * w.r[i];
        }
        scatter(j, s);
      }
      for (std::size_t i = 0; i < free_; ++i) {
        if (bodies[i].inertia == 0) g_[i].w = 0;
        d_[i] = -1.0 * g_[i];
      }
      ldlt_.solve({d_.data(), free_});

      double longest = 1;
      const auto limit = [&](double value, double change) {
        if (change < 0) longest = std::min(longest, -boundary * value / change);
      };
      double gap_after = 0;
      for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t k = 0; k < joints.size(); ++k) {
          const SolverJoint& j = joints[k];
          Barrier& w = barrier_[k];
          if (pass == 0) {
            const Rows y = relative(j, d_[z(j.a)], d_[z(j.b)]);
            for (unsigned i = 0; i < 3; ++i) {
              if (!(j.law.G[i] > 0)) continue;
              const double ds = j.slope[i] * (y[i] + w.r[i]);
              const double second_over = corrector ? -w.ds[i] * w.dover[i] : 0;
              const double second_under = corrector ? w.ds[i] * w.dunder[i] : 0;
              w.ds[i] = ds;
              if (bounded(j.law.cap[i])) {
                const double p = j.law.cap[i] - w.s[i];
                w.dover[i] = (centring * mu - second_over - w.over[i] * p + w.over[i] * ds) / p;
                limit(p, -ds);
                limit(w.over[i], w.dover[i]);
              }
              if (bounded(j.law.cap_reverse[i])) {
                const double q = j.law.cap_reverse[i] + w.s[i];
                w.dunder[i] = (centring * mu - second_under - w.under[i] * q - w.under[i] * ds) / q;
                limit(q, ds);
                limit(w.under[i], w.dunder[i]);
              }
            }
          } else {
            for (unsigned i = 0; i < 3; ++i) {
              if (!(j.law.G[i] > 0)) continue;
              if (bounded(j.law.cap[i])) {
                gap_after += (w.over[i] + longest * w.dover[i]) * (j.law.cap[i] - w.s[i] - longest * w.ds[i]);
              }
              if (bounded(j.law.cap_reverse[i])) {
                gap_after += (w.under[i] + longest * w.dunder[i]) *
                             (j.law.cap_reverse[i] + w.s[i] + longest * w.ds[i]);
              }
            }
          }
        }
        if (corrector) break;
      }
      step = longest;
      centring = std::pow(std::clamp(gap_after / gap, 0.0, 1.0), 3);
    }
    for (std::size_t i = 0; i < free_; ++i) bodies[i].v += step * d_[i];
    for (Barrier& w : barrier_) {
      for (unsigned i = 0; i < 3; ++i) {
        w.s[i] += step * w.ds[i];
        w.over[i] += step * w.dover[i];
        w.under[i] += step * w.dunder[i];
      }
    }
  }
  factored_ = false;
  return factorisations;
}

}  // namespace ductile
