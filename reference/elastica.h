// The elastica, and frames of two of them: large displacements of bars that do not shear, by shooting.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

namespace ductile {

/// Along a bar of bending stiffness 1: place, slope, curvature = moment.
struct Elastica {
  double x = 0, y = 0, slope = 0, curvature = 0;
  double compliance = 0;  // 1/EA: the stretch is this times the force along the bar

  /// `length` further by Runge and Kutta's fourth order; each cut carries the force (fx, fy) from the part
  /// ahead, so that M' = −(r' × f), with r' the tangent, as long as the stretch.
  Elastica along(double length, double fx, double fy, int steps = 200) const {
    using State = Eigen::Vector4d;
    const auto rate = [&](const State& s) {
      const double c = std::cos(s[2]), d = std::sin(s[2]), stretch = 1 + compliance * (c * fx + d * fy);
      return State(stretch * c, stretch * d, s[3], stretch * (d * fx - c * fy));
    };
    State s(x, y, slope, curvature);
    const double h = length / steps;
    for (int i = 0; i < steps; ++i) {
      const State a = rate(s), b = rate(s + h / 2 * a), c = rate(s + h / 2 * b), d = rate(s + h * c);
      s += h / 6 * (a + 2 * b + 2 * c + d);
    }
    return {s[0], s[1], s[2], s[3], compliance};
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

namespace elastica {

/// The first peak of the last unknown on the way of solutions of residual(unknowns, down) = 0 from rest, down
/// growing to `most` in so many steps; Newton's method.
template <int n, class Residual>
double limit(const Residual& residual, double most, int steps) {
  using Unknown = Eigen::Matrix<double, n, 1>;
  Unknown u = Unknown::Zero();
  double peak = 0;
  for (int k = 1; k <= steps; ++k) {
    const double down = most * k / steps;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Unknown r = residual(u, down);
      if (r.cwiseAbs().maxCoeff() < 1e-11) break;
      Eigen::Matrix<double, n, n> slope;
      for (int i = 0; i < n; ++i) {
        Unknown moved = u;
        moved[i] += 1e-6;
        slope.col(i) = (residual(moved, down) - r) / 1e-6;
      }
      u -= slope.partialPivLu().solve(r);
    }
    if (u[n - 1] < peak) break;
    peak = u[n - 1];
  }
  return peak;
}

}  // namespace elastica

/// Lee's frame: a column and a beam of length 1, rigidly joined, pinned at their far ends; P down at 0.2 of
/// the beam from the corner. The first limit load, PL²/EI, met by pushing the loaded point down.
inline double lees_limit_load() {
  using Unknown = Eigen::Vector4d;  // reactions of the foot, its slope's change, P
  return elastica::limit<4>(
      [](const Unknown& u, double down) {
        const Elastica foot{.slope = std::numbers::pi / 2 + u[2]};
        Elastica corner = foot.along(1, -u[0], -u[1]);
        corner.slope -= std::numbers::pi / 2;
        const Elastica loaded = corner.along(0.2, -u[0], -u[1], 40),
                       end = loaded.along(0.8, -u[0], -u[1] + u[3], 160);
        return Unknown(end.x - 1, end.y - 1, end.curvature, loaded.y - (1 - down));
      },
      0.6, 60);
}

/// Williams' toggle: two bars that rise from clamped feet, 1 apart from the crown each, to a rigid crown that
/// P pushes down. The limit load, P s²/EI, s = 1 the half span; `slenderness2` = EA s²/EI.
inline double williams_limit_load(double rise, double slenderness2) {
  using Unknown = Eigen::Vector3d;  // force along x and curvature at the foot, P
  const double slope = std::atan(rise), length = std::hypot(1, rise);
  return elastica::limit<3>(
      [&](const Unknown& u, double down) {
        const Elastica foot{.slope = slope, .curvature = u[1], .compliance = 1 / slenderness2},
            crown = foot.along(length, u[0], -u[2] / 2);
        return Unknown(crown.x - 1, crown.y - (rise - down), crown.slope - slope);
      },
      1.5 * rise, 150);
}

}  // namespace ductile
