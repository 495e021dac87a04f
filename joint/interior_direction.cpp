// The direction of a round of the interior point method: each joint's curvature and bounds eliminated by an
// orthogonal factorisation of its own, the velocities by the Hessian's.

#include <algorithm>
#include <cmath>

#include "interior_point.h"

namespace ductile::dynamics {

// The curvature of a joint is C = BᵀB, with a row of B for each unknown, 1/√G, and for each bound, √(z/p) a.
// With B = QR the solution of C x = y and what it means for the bounds, B x, come of Q alone, and as
// accurately for rows of any weight: B x = Q Q₀ᵀ root⁻¹ y, Q₀ the rows of the unknowns.
//
// Caps couple no rows: B has one unknown a row, and its columns need but be of length 1.
void InteriorPoint::eliminate_caps(Local& l) {
  Row4 square;
  for (std::size_t i = 0; i < 4; ++i) square[i] = l.root[i] * l.root[i];
  for (std::size_t k = l.first; k < l.last; ++k) {
    const Bound& b = bounds_[k];
    for (std::size_t i = 0; i < 3; ++i) square[i] += b.weight * b.weight * b.a[i] * b.a[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    l.q[i] = {};
    l.q[i][i] = l.root[i] / std::sqrt(square[i]);
  }
  for (std::size_t k = l.first; k < l.last; ++k) {
    Bound& b = bounds_[k];
    for (std::size_t i = 0; i < 3; ++i) b.q[i] = b.weight * b.a[i] / std::sqrt(square[i]);
  }
}

void InteriorPoint::eliminate(const Joint& j, Local& l) {
  for (unsigned i = 0; i < 3; ++i) l.root[i] = j.G[i] > 0 ? 1 / std::sqrt(j.G[i]) : 1;
  l.root[3] = 1;
  const std::size_t n = 4 + l.last - l.first;
  for (std::size_t k = l.first; k < l.last; ++k) {
    Bound& b = bounds_[k];
    b.weight = std::sqrt(b.z / (b.p + b.hardening * b.z));
  }
  if (!l.on_surface) return eliminate_caps(l);
  if (l.shear > 0) {
    const Bound& cone = bounds_[l.last - 1];  // whose own curvature is z diag(1/(hQ)², 1) on (s_Q, t)
    l.root[1] = std::sqrt(1 / j.G[1] + cone.z / (l.shear * l.shear));
    l.root[3] = std::sqrt(cone.z);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    rows_[i] = {};
    rows_[i][i] = l.root[i];
  }
  for (std::size_t k = 4; k < n; ++k) {
    const Bound& b = bounds_[l.first + k - 4];
    for (std::size_t i = 0; i < 4; ++i) rows_[k][i] = b.weight * b.a[i];
  }
  orthogonalise({rows_.data(), n}, {order_.data(), n});
  for (std::size_t i = 0; i < 4; ++i) l.q[i] = rows_[i];
  for (std::size_t k = 4; k < n; ++k) bounds_[l.first + k - 4].q = rows_[k];
}

// H = M + Jᵀ D J with D the part of C⁻¹ on s.
void InteriorPoint::factor(System& system, Hessian& hessian) {
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    Local& l = locals_[k];
    eliminate(j, l);
    const auto D = [&](unsigned a, unsigned b) {
      return j.G[a] > 0 && j.G[b] > 0 ? dot(l.q[a], l.q[b]) / (l.root[a] * l.root[b]) : 0;
    };
    system.records[k].tangent = {
        .nn = D(0, 0), .qq = D(1, 1), .mm = D(2, 2), .nq = D(0, 1), .nm = D(0, 2), .qm = D(1, 2)};
  }
  hessian.factor_given(system);
}

// Qᵀ (root⁻¹ y, aims of the bounds)
Row4 InteriorPoint::project(const Local& l, const Row4& y) const {
  Row4 c{};
  const auto add = [&c](const Row4& q, double by) {
    for (std::size_t k = 0; k < 4; ++k) c[k] += by * q[k];
  };
  for (std::size_t i = 0; i < 4; ++i) add(l.q[i], y[i] / l.root[i]);
  for (std::size_t k = l.first; k < l.last; ++k) add(bounds_[k].q, bounds_[k].aim);
  return c;
}

// Newton's step for z p = μ, with so much of the second-order term Δz Δp of the last direction. Unknowns are
// written as what they change by, never as what they become: a rigid row multiplies by κ what rounding
// leaves.
void InteriorPoint::find_direction(const System& system, const Hessian& hessian, double mu,
                                   double second_order) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  const auto impulse = [](const Joint& j, const Local& l, const Row4& c, unsigned i) {
    return j.G[i] > 0 ? dot(l.q[i], c) / l.root[i] : 0;
  };
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const Local& l = locals_[k];
    for (std::size_t c = l.first; c < l.last; ++c) {
      Bound& b = bounds_[c];
      const double left = b.z * (b.p + b.missing) + second_order * b.dp * b.dz - mu;
      b.aim = left / std::sqrt(b.z * (b.p + b.hardening * b.z));
    }
    const Row4 c = project(l, l.lack);
    add_transposed(j, {-impulse(j, l, c, 0), -impulse(j, l, c, 1), -impulse(j, l, c, 2)}, d_[z(j.a)],
                   d_[z(j.b)]);
  }
  for (std::size_t i = 0; i < d_.size(); ++i) {
    if (i >= system.free) d_[i] = {};
    if (system.bodies[i].inverse_inertia == 0) d_[i].w = 0;
  }
  hessian.solve({d_.data(), system.free});
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    Local& l = locals_[k];
    const Rows change = relative_velocity(j, d_[z(j.a)], d_[z(j.b)]);
    Row4 y = l.lack;
    for (unsigned i = 0; i < 3; ++i) y[i] = j.G[i] > 0 ? y[i] + change[i] : 0;
    const Row4 c = project(l, y);
    for (std::size_t i = 0; i < 4; ++i) l.dx[i] = dot(l.q[i], c) / l.root[i];
    for (std::size_t n = l.first; n < l.last; ++n) {
      Bound& b = bounds_[n];
      const double u = dot(b.q, c);
      b.dz = b.weight * (u - b.aim);
      b.dp = b.missing - u / b.weight + b.hardening * b.dz;
    }
  }
}

// The largest step, up to 1, that goes no more than `reach` of the way to a bound.
double InteriorPoint::step_within(double reach) const {
  double step = 1;
  for (const Bound& b : bounds_) {
    if (b.dp < 0) step = std::min(step, -reach * b.p / b.dp);
    if (b.dz < 0) step = std::min(step, -reach * b.z / b.dz);
  }
  return step;
}

void InteriorPoint::move(double step) {
  for (Bound& b : bounds_) {
    b.p += step * b.dp;
    b.z += step * b.dz;
  }
  for (Local& l : locals_) {
    for (std::size_t i = 0; i < 4; ++i) l.x[i] += step * l.dx[i];
    if (l.shear == 0) continue;
    const double dq = l.dx[1] / l.shear, dt = l.dx[3];
    double& missing = bounds_[l.last - 1].missing;
    missing = (1 - step) * missing - step * step * (dt * dt + dq * dq) / 2;
  }
}

}  // namespace ductile::dynamics
