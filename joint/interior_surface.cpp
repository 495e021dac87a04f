#include "interior_surface.h"

#include <algorithm>
#include <cmath>

namespace ductile::dynamics {

// Rows that are free carry nothing: they leave the facets.
void SurfaceRows::enter(const Joint& j, const JointRecord& r, const Rows& s, const Rows& m_eff, double inside,
                        std::span<Bound> room) {
  *this = {};
  G_ = j.G;
  m_eff_ = m_eff;
  for (std::size_t i = 0; i < 3; ++i) x_[i] = holds(i) ? s[i] : 0;
  const YieldSurface& surface = *r.law.surface;
  const double h = r.law.share * r.law.h, usage = surface.usage({x_[0] / h, x_[1] / h, x_[2] / h});
  for (unsigned i = 0; i < 3; ++i) x_[i] *= std::min(1.0, inside / usage);
  if (std::isfinite(surface.shear()) && holds(1)) shear_ = h * surface.shear();
  double share = 0;
  std::size_t count = 0;
  for (const auto& [n, m] : surface.facets()) {
    const Row4 a{holds(0) ? n / h : 0, 0, holds(2) ? m / h : 0, shear_ > 0 ? -1.0 : 0.0};
    if (a[0] == 0 && a[2] == 0) continue;
    const double used = a[0] * x_[0] + a[2] * x_[2];
    share = std::max(share, used);
    Bound& b = room[count++] = {};
    b.a = a;
    b.p = 1 - used;
  }
  bounds_ = room.first(count);
  if (shear_ == 0) return;
  const double q = x_[1] / shear_, left = (1 - share * share - q * q) / 2;
  x_[3] = std::sqrt(share * share + left);
  for (Bound& b : bounds_) b.p -= 1 - x_[3];
  room[count] = {};
  room[count].p = left / 2;
  bounds_ = room.first(count + 1);
}

void SurfaceRows::centre(double mu) {
  for (Bound& b : bounds_) b.z = mu / b.p;
}

// Multipliers of a cone and its facets that do not agree: either what they differ by is multiplied with t ≤
// 1, or the ones or the others are scaled to agree, and the flow changes. A cone that is not kept: s gives up
// that share of itself, which moves its rows.
double SurfaceRows::cone_lack() const {
  const Bound& cone = bounds_.back();
  double sum = 0, N = 0, M = 0;
  for (const Bound& b : bounds_.first(bounds_.size() - 1)) {
    sum += b.z;
    N += b.z * b.a[0];
    M += b.z * b.a[2];
  }
  const auto by = [&](unsigned i, double change) { return G_[i] * change * (lack_[i] + change / 2); };
  const double q = x_[1] / (shear_ * shear_), off = lack_[3] / sum;
  double lack = std::min({std::abs(lack_[3]), by(1, -lack_[3] / x_[3] * q), by(0, off * N) + by(2, off * M)});
  lack += cone.z * std::abs(cone.missing);
  for (unsigned i = 0; i < 3; ++i) {
    const double give = m_eff_[i] > 0 ? std::max(-cone.missing, 0.0) * x_[i] / m_eff_[i] : 0;
    lack += G_[i] * give * give / 2;
  }
  return lack;
}

void SurfaceRows::measure(const Rows& x, Distance& d) {
  for (unsigned i = 0; i < 3; ++i) lack_[i] = holds(i) ? x[i] - x_[i] / G_[i] : 0;
  lack_[3] = 0;
  if (shear_ > 0) bounds_.back().a = {0, x_[1] / (shear_ * shear_), 0, x_[3]};
  for (const Bound& b : bounds_) {
    d.products += b.z * b.p;
    for (std::size_t i = 0; i < 4; ++i) lack_[i] -= b.z * b.a[i];
  }
  for (unsigned i = 0; i < 3; ++i) {
    d.lack += G_[i] * lack_[i] * lack_[i] / 2;
    if (m_eff_[i] > 0) d.rounding += last_bits(G_[i], m_eff_[i]) * x_[i] * x_[i];
  }
  if (shear_ > 0) d.lack += cone_lack();
}

// D is the part of C⁻¹ on s.
Coupling SurfaceRows::eliminate(const Scratch& scratch) {
  for (std::size_t i = 0; i < 3; ++i) root_[i] = holds(i) ? std::sqrt(compliance(i)) : 1;
  root_[3] = 1;
  if (shear_ > 0) {
    const Bound& cone = bounds_.back();  // whose own curvature is z diag(1/(hQ)², 1) on (s_Q, t)
    root_[1] = std::sqrt(compliance(1) + cone.z / (shear_ * shear_));
    root_[3] = std::sqrt(cone.z);
  }
  const std::size_t n = 4 + bounds_.size();
  for (std::size_t i = 0; i < 4; ++i) {
    scratch.rows[i] = {};
    scratch.rows[i][i] = root_[i];
  }
  for (std::size_t k = 4; k < n; ++k) {
    Bound& b = bounds_[k - 4];
    b.weight = std::sqrt(b.z / b.p);
    for (std::size_t i = 0; i < 4; ++i) scratch.rows[k][i] = b.weight * b.a[i];
  }
  orthogonalise(scratch.rows.first(n), scratch.order.first(n));
  for (std::size_t i = 0; i < 4; ++i) q_[i] = scratch.rows[i];
  for (std::size_t k = 4; k < n; ++k) bounds_[k - 4].q = scratch.rows[k];
  const auto D = [this](std::size_t a, std::size_t b) {
    return holds(a) && holds(b) ? dot(q_[a], q_[b]) / (root_[a] * root_[b]) : 0;
  };
  return {.nn = D(0, 0), .qq = D(1, 1), .mm = D(2, 2), .nq = D(0, 1), .nm = D(0, 2), .qm = D(1, 2)};
}

// Qᵀ (root⁻¹ y, aims of the bounds)
Row4 SurfaceRows::project(const Row4& y) const {
  Row4 c{};
  const auto add = [&c](const Row4& q, double by) {
    for (std::size_t k = 0; k < 4; ++k) c[k] += by * q[k];
  };
  for (std::size_t i = 0; i < 4; ++i) add(q_[i], y[i] / root_[i]);
  for (const Bound& b : bounds_) add(b.q, b.aim);
  return c;
}

Rows SurfaceRows::aim(double mu, double second_order) {
  for (Bound& b : bounds_) {
    const double left = b.z * (b.p + b.missing) + second_order * b.dp * b.dz - mu;
    b.aim = left / std::sqrt(b.z * b.p);
  }
  const Row4 c = project(lack_);
  Rows ds;
  for (std::size_t i = 0; i < 3; ++i) ds[i] = holds(i) ? dot(q_[i], c) / root_[i] : 0;
  return ds;
}

void SurfaceRows::direct(const Rows& change, Direction& direction) {
  Row4 y = lack_;
  for (std::size_t i = 0; i < 3; ++i) y[i] = holds(i) ? y[i] + change[i] : 0;
  const Row4 c = project(y);
  for (std::size_t i = 0; i < 4; ++i) dx_[i] = dot(q_[i], c) / root_[i];
  for (Bound& b : bounds_) {
    const double u = dot(b.q, c);
    b.dz = b.weight * (u - b.aim);
    b.dp = b.missing - u / b.weight;
    direction.see(b.p, b.z, b.dp, b.dz);
  }
}

void SurfaceRows::move(double step) {
  for (Bound& b : bounds_) {
    b.p += step * b.dp;
    b.z += step * b.dz;
  }
  for (std::size_t i = 0; i < 4; ++i) x_[i] += step * dx_[i];
  if (shear_ == 0) return;
  const double dq = dx_[1] / shear_, dt = dx_[3];
  double& missing = bounds_.back().missing;
  missing = (1 - step) * missing - step * step * (dt * dt + dq * dq) / 2;
}

unsigned SurfaceRows::regime() const {
  for (const Bound& b : bounds_) {
    double stiffness = 0;
    for (unsigned i = 0; i < 3; ++i) stiffness += b.a[i] * b.a[i] * G_[i];
    if (b.z * stiffness > b.p) return on_surface;
  }
  return 0;
}

}  // namespace ductile::dynamics
