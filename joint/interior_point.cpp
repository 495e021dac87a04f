#include "interior_point.h"

#include <algorithm>
#include <cmath>

#include "objective.h"

namespace ductile::dynamics {

int interior_point(System& system, Hessian& hessian, double work, std::span<BarrierRows> barrier,
                   std::span<Vec3> g, std::span<Vec3> d) {
  constexpr double boundary = 0.995;  // share of the way to a bound that a step may go
  // Of the work: rows that slip a hundred-millionth of what others do are told apart from those that hold.
  // What is left undecided makes the Newton rounds that follow cycle: at 1e-11 in a struck beam at 6000 Hz,
  // at 1e-15 in a spinning chain whose pieces weigh 1e4 times as much as their neighbours and which stretches
  // everywhere at once.
  constexpr double accuracy = 1e-19;

  // Start well inside, with slips of the size of the velocities at hand.
  std::vector<Joint>& joints = system.joints;
  std::vector<JointRecord>& records = system.records;
  const auto velocity = [&](const Joint& j) {
    return relative_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
  };
  // d ← −H⁻¹g
  const auto solve_for_step = [&] {
    for (std::size_t i = 0; i < system.free; ++i) {
      if (system.bodies[i].inertia == 0) g[i].w = 0;
      d[i] = -1.0 * g[i];
    }
    hessian.solve(d.first(system.free));
  };
  find_x(system);
  double slip = 0;
  int bounds = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& j = joints[k];
    const Rows& x = records[k].x;
    for (unsigned i = 0; i < 3; ++i) {
      Barrier& w = barrier[k][i];
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
      Barrier& w = barrier[k][i];
      const double x = records[k].x[i];
      w.z[0] = std::max(x, 0.0) + slip / 10;
      w.z[1] = std::max(-x, 0.0) + slip / 10;
      // s = F⁺ + ηz is the law's share a of G beyond the cap where a G = η/(1 + η/G).
      const double a = records[k].law.after_yield[i];
      w.hardening = a * joints[k].G[i] / (1 - a);
      for (int side = 0; side < 2; ++side) w.p[side] += w.hardening * w.z[side];
    }
  }

  const auto each_bound = [&](auto&& visit) {
    for (std::size_t k = 0; k < joints.size(); ++k) {
      for (unsigned i = 0; i < 3; ++i) {
        for (int side = 0; side < 2; ++side) {
          if (barrier[k][i].bounded[side]) visit(barrier[k][i], side);
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
      const Joint& j = joints[k];
      for (unsigned i = 0; i < 3; ++i) {
        Barrier& w = barrier[k][i];
        double compliance = 1 / j.G[i];
        for (int side = 0; side < 2; ++side) {
          if (w.bounded[side]) compliance += w.z[side] / (w.p[side] + w.hardening * w.z[side]);
        }
        w.slope = j.G[i] > 0 ? 1 / compliance : 0;
      }
      Coupling& D = records[k].tangent;
      D.nn = barrier[k][0].slope, D.qq = barrier[k][1].slope, D.mm = barrier[k][2].slope;
    }
    hessian.refactor(system);
    ++factorisations;

    // Predictor (μ = 0), then a corrector with the centring and the second-order terms that the predictor
    // calls for.
    double mu = 0, step = 1;
    for (const bool corrector : {false, true}) {
      inertial_gradient(system, g);
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const Joint& j = joints[k];
        const Rows v = velocity(j);
        Rows s{};
        for (unsigned i = 0; i < 3; ++i) {
          if (!(j.G[i] > 0)) continue;
          Barrier& w = barrier[k][i];
          w.r = v[i] + j.bias[i] - w.s / j.G[i];
          for (int side = 0; side < 2; ++side) {
            if (!w.bounded[side]) continue;
            w.second[side] = corrector ? w.dp[side] * w.dz[side] : 0;
            const double over = w.z[side], after = w.hardening * over;
            w.r -= (side == 0 ? 1 : -1) * (mu - w.second[side] + after * over) / (w.p[side] + after);
          }
          s[i] = w.s + w.slope * w.r;
        }
        add_transposed(j, s, g[z(j.a)], g[z(j.b)]);
      }
      solve_for_step();
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const Joint& j = joints[k];
        const Rows y = relative_velocity(j, d[z(j.a)], d[z(j.b)]);
        for (unsigned i = 0; i < 3; ++i) {
          Barrier& w = barrier[k][i];
          w.ds = w.slope * (y[i] + w.r);
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
    for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v += step * d[i];
    for (auto& rows : barrier) {
      for (Barrier& w : rows) w.s += step * w.ds;
    }
    each_bound([&](Barrier& w, int side) {
      w.p[side] += step * w.dp[side];
      w.z[side] += step * w.dz[side];
    });
  }

  // The rows that flow are known now. Velocities are not yet good enough to tell by: a rigid row multiplies
  // what they lack by κ. So the law is taken in those regimes, whatever x says, and solved there.
  for (std::size_t k = 0; k < joints.size(); ++k) {
    unsigned regime = 0;
    for (unsigned i = 0; i < 3; ++i) {
      for (unsigned side = 0; side < 2; ++side) {
        const Barrier& w = barrier[k][i];
        if (w.bounded[side] && w.z[side] * joints[k].G[i] > w.p[side]) regime |= 1u << (i + 3 * side);
      }
    }
    joints[k].regime = static_cast<std::uint8_t>(regime);
  }
  hessian.factor_tangents(system, false);
  ++factorisations;
  for (int refinement = 0; refinement < 2; ++refinement) {
    inertial_gradient(system, g);
    for (const Joint& j : joints) {
      Rows x = velocity(j);
      for (unsigned i = 0; i < 3; ++i) x[i] += j.bias[i];
      add_transposed(j, respond_in(system.record(j).law, j.regime, x), g[z(j.a)], g[z(j.b)]);
    }
    solve_for_step();
    for (std::size_t i = 0; i < system.free; ++i) system.bodies[i].v += d[i];
  }
  return factorisations;
}

}  // namespace ductile::dynamics
