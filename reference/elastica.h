// The elastica, and Lee's frame of two of them: large displacements of bars that neither stretch nor shear,
// by shooting.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace ductile {

/// Along a bar of bending stiffness 1: place, slope, curvature = moment.
struct Elastica {
  double x = 0, y = 0, slope = 0, curvature = 0;

  /// `length` further by Runge and Kutta's fourth order; each cut carries the force (fx, fy) from the part
  /// ahead, so that M' = −(t × f).
  Elastica along(double length, double fx, double fy, int steps = 200) const {
    using State = Eigen::Vector4d;
    const auto rate = [&](const State& s) {
      const double c = std::cos(s[2]), d = std::sin(s[2]);
      return State(c, d, s[3], d * fx - c * fy);
    };
    State s(x, y, slope, curvature);
    const double h = length / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(s + h / 2 * a), c = rate(s + h / 2 * b), d = rate(s + h * c);
      s += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return {s[0], s[1], s[2], s[3]};
  }
};

/// The tip of a cantilever along x of length 1 and bending stiffness 1, a dead load across its tip: PL²/EI.
inline Elastica loaded_tip(double load) {
  double low = 0, high = load;  // the root's moment is at most the load's at the full arm
  for (int i = 0; i < 60; ++i) {
    const double root = (low + high) / 2;
    // It bends down where the load pulls down.
    (Elastica{.curvature = -root}.along(1, 0, -load).curvature < 0 ? high : low) = root;
  }
  return Elastica{.curvature = -low}.along(1, 0, -load);
}

/// Lee's frame: a column and a beam of length 1, rigidly joined, pinned at their far ends; P down at 0.2 of
/// the beam from the corner. The first limit load, PL²/EI, followed by the displacement of the loaded point.
inline double lees_limit_load() {
  using Unknown = Eigen::Vector4d;  // reactions of the foot, its slope's change, P
  const auto residual = [](const Unknown& u, double down) {
    const Elastica foot{.slope = std::numbers::pi / 2 + u[2]};
    Elastica corner = foot.along(1, -u[0], -u[1]);
    corner.slope -= std::numbers::pi / 2;
    const Elastica loaded = corner.along(0.2, -u[0], -u[1], 40),
                   end = loaded.along(0.8, -u[0], -u[1] + u[3], 160);
    return Unknown(end.x - 1, end.y - 1, end.curvature, loaded.y - (1 - down));
  };
  Unknown u = Unknown::Zero();
  double most = 0;
  for (int k = 1; k <= 60; ++k) {  // beyond 0.5 the load falls
    const double down = 0.01 * k;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Unknown r = residual(u, down);
      if (r.cwiseAbs().maxCoeff() < 1e-11) break;
      Eigen::Matrix4d slope;
      for (int i = 0; i < 4; ++i) {
        Unknown moved = u;
        moved[i] += 1e-6;
        slope.col(i) = (residual(moved, down) - r) / 1e-6;
      }
      u -= slope.partialPivLu().solve(r);
    }
    most = std::max(most, u[3]);
  }
  return most;
}

}  // namespace ductile
