#include "yield_surface.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ductile::dynamics {

namespace {

// Nearest point of w² + q² = 1 to (w, q) in the metric diag(1/cw, 1/cq): both shrink by 1 + μc. 1/√(w² + q²)
// is nearly linear in μ: Newton on it converges from μ = 0 in a few steps, from the left (Hebden).
double onto_ellipse(double& w, double& q, double cw, double cq) {
  double mu = 0;
  for (int i = 0; i < 60; ++i) {
    const double a = w / (1 + mu * cw), b = q / (1 + mu * cq);
    const double square = a * a + b * b, radius = std::sqrt(square);
    if (!(std::abs(radius - 1) > 4e-16)) break;
    const double slope = -(a * a * cw / (1 + mu * cw) + b * b * cq / (1 + mu * cq));  // of square/2
    const double next = mu - square * (radius - 1) / slope;
    if (!(next > mu)) break;
    mu = next;
  }
  w /= 1 + mu * cw;
  q /= 1 + mu * cq;
  return mu;
}

}  // namespace

YieldSurface::YieldSurface(std::span<const AxialMoment> polygon, double shear)
    : vertices_(polygon.begin(), polygon.end()), shear_(shear) {
  if (polygon.size() < 3 || !(shear > 0)) {
    throw std::invalid_argument("yield surface: needs at least three points and a shear cap > 0");
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const AxialMoment &p = polygon[(i + polygon.size() - 1) % polygon.size()], &q = polygon[i];
    const double twice_area = p.N * q.M - p.M * q.N;
    if (!(twice_area > 0) || !std::isfinite(twice_area)) {
      throw std::invalid_argument(
          "yield surface: the origin must lie inside the polygon, and its points run counter-clockwise in "
          "(N, M)");
    }
    facets_.push_back({(q.M - p.M) / twice_area, (p.N - q.N) / twice_area});
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const AxialMoment &before = vertices_[(i + polygon.size() - 1) % polygon.size()], &at = vertices_[i],
                      &after = vertices_[(i + 1) % polygon.size()];
    const double ux = at.N - before.N, uy = at.M - before.M, wx = after.N - at.N, wy = after.M - at.M;
    if (ux * wy - uy * wx < -1e-9 * std::hypot(ux, uy) * std::hypot(wx, wy)) {
      throw std::invalid_argument("yield surface: the polygon must be convex");
    }
  }
}

// The facet whose sector, seen from the origin, holds (N, M): vertices run counter-clockwise, so it is found
// by bisection.
std::size_t YieldSurface::steepest(double N, double M) const {
  const AxialMoment& first = vertices_.front();
  const auto beyond_half = [&](double n, double m) {
    const double cross = first.N * m - first.M * n;
    return cross < 0 || (cross == 0 && first.N * n + first.M * m < 0);
  };
  const bool half = beyond_half(N, M);
  const auto next =
      std::upper_bound(vertices_.begin() + 1, vertices_.end(), 0, [&](int, const AxialMoment& v) {
        const bool v_half = beyond_half(v.N, v.M);
        return v_half != half ? v_half : N * v.M - M * v.N > 0;
      });
  return next == vertices_.end() ? 0 : static_cast<std::size_t>(next - vertices_.begin());
}

double YieldSurface::usage(const Rows& force) const {
  const Facet& f = facets_[steepest(force[0], force[2])];
  const double w = std::max(0.0, f.n * force[0] + f.m * force[2]), q = force[1] / shear_;
  return std::sqrt(w * w + q * q);
}

YieldSurface::Point YieldSurface::nearest(const Rows& G, double h, const Rows& trial) const {
  const double q_trial = trial[1] / (shear_ * h), q_metric = G[1] / (shear_ * h * shear_ * h);
  const std::size_t count = facets_.size();
  std::size_t f = steepest(trial[0], trial[2]);
  if (G[0] == 0 || G[2] == 0) {
    // A free row carries nothing: the other stays on its ray, within one facet.
    const double n = G[0] > 0 ? facets_[f].n / h : 0, m = G[2] > 0 ? facets_[f].m / h : 0;
    double w = n * trial[0] + m * trial[2], q = q_trial;
    Point p{{}, onto_ellipse(w, q, n * n * G[0] + m * m * G[2], q_metric), false, f};
    p.s = {n != 0 ? w / n : 0, std::isinf(shear_) ? trial[1] : q * shear_ * h, m != 0 ? w / m : 0};
    return p;
  }
  // Bisection over the facets: each says on which side of it the nearest point lies.
  std::size_t low = f + count - count / 2,
              high = f + count + count / 2;  // all + count, so that nothing is negative
  f += count;
  for (;;) {
    // On the cylinder of one facet.
    const double n = facets_[f % count].n / h, m = facets_[f % count].m / h, c = n * n * G[0] + m * m * G[2];
    const double w_trial = n * trial[0] + m * trial[2];
    double w = w_trial, q = q_trial;
    Point p{trial, onto_ellipse(w, q, c, q_metric), false, f % count};
    const double back = c > 0 ? (w_trial - w) / c : 0;
    p.s = {trial[0] - back * n * G[0], std::isinf(shear_) ? trial[1] : q * shear_ * h,
           trial[2] - back * m * G[2]};
    const std::size_t there = steepest(p.s[0], p.s[2]);
    const double excess = (facets_[there].n * p.s[0] + facets_[there].m * p.s[2]) / h - w;
    if (there == f % count || excess <= 1e-13) return p;
    // Beyond its edge: on the vertex toward that side, or further.
    const bool forward = (there + count - f % count) % count <= count / 2;
    const std::size_t v = (forward ? f : f + count - 1) % count;
    const double N = vertices_[v].N * h, M = vertices_[v].M * h;
    const double stiffness = (G[0] > 0 ? N * N / G[0] : 0) + (G[2] > 0 ? M * M / G[2] : 0);
    double r = ((G[0] > 0 ? N * trial[0] / G[0] : 0) + (G[2] > 0 ? M * trial[2] / G[2] : 0)) / stiffness;
    q = q_trial;
    Point at{trial, onto_ellipse(r, q, 1 / stiffness, q_metric), true, v};
    at.s = {r * N, std::isinf(shear_) ? trial[1] : q * shear_ * h, r * M};
    // It is the nearest when G⁻¹(trial − s) lies between the normals of the two facets.
    const Facet &before = facets_[v], &after = facets_[(v + 1) % count];
    const double en = G[0] > 0 ? (trial[0] - at.s[0]) / G[0] : 0,
                 em = G[2] > 0 ? (trial[2] - at.s[2]) / G[2] : 0;
    if (before.n * em - before.m * en >= 0 && en * after.m - em * after.n >= 0) return at;
    (forward ? low : high) = f;
    if (high - low <= 1) return at;
    const std::size_t next = (low + high) / 2;
    f = next == f ? (forward ? f + 1 : f - 1) : next;
  }
}

bool YieldSurface::project(const Rows& G, double h, Rows& s) const {
  const Rows force{s[0] / h, s[1] / h, s[2] / h};
  if (!(usage(force) > 1)) return false;
  s = nearest(G, h, s).s;
  return true;
}

Coupling YieldSurface::tangent(const Rows& G, double h, const Rows& trial) const {
  const Point p = nearest(G, h, trial);
  const double q = std::isinf(shear_) ? 0 : p.s[1] / (shear_ * h);
  if (p.vertex) {
    // In the plane of (r, q): N = r N_v, M = r M_v.
    const double N = vertices_[p.facet].N * h, M = vertices_[p.facet].M * h, Q = shear_ * h;
    if (std::isinf(shear_)) return {.qq = G[1]};
    const double stiffness = (G[0] > 0 ? N * N / G[0] : 0) + (G[2] > 0 ? M * M / G[2] : 0);
    const double r = std::abs(N) > std::abs(M) ? p.s[0] / N : p.s[2] / M;
    const double pr = 1 / (stiffness + p.mu), pq = 1 / (Q * Q / G[1] + p.mu);
    const double bottom = r * r * pr + q * q * pq;
    const double rr = pr - pr * r * r * pr / bottom, qq = pq - pq * q * q * pq / bottom,
                 rq = -pr * r * q * pq / bottom;
    return {.nn = rr * N * N,
            .qq = qq * Q * Q,
            .mm = rr * M * M,
            .nq = rq * N * Q,
            .nm = rr * N * M,
            .qm = rq * M * Q};
  }
  const double n = facets_[p.facet].n / h, m = facets_[p.facet].m / h;
  const double w = n * p.s[0] + m * p.s[2];
  // P of the (N, M) block: (G⁻¹ + μ a aᵀ)⁻¹ = G − μ G a aᵀ G / (1 + μ aᵀ G a), written without differences:
  // far outside the surface μ aᵀ G a is all there is.
  const double an = n * G[0], am = m * G[2], cn = n * an, cm = m * am, shrink = 1 / (1 + p.mu * (cn + cm));
  const double pnn = G[0] * (1 + p.mu * cm) * shrink, pmm = G[2] * (1 + p.mu * cn) * shrink,
               pnm = -p.mu * an * am * shrink;
  const double inverse_q = std::isinf(shear_) ? 0 : 1 / (shear_ * h);
  const double pqq = 1 / (1 / G[1] + p.mu * inverse_q * inverse_q);
  const double gq = q * inverse_q;  // ∇φ = (w n, gq, w m)
  const double vn = w * an * shrink, vm = w * am * shrink, vq = pqq * gq;
  const double bottom = w * w * (cn + cm) * shrink + gq * vq;
  return {.nn = pnn - vn * vn / bottom,
          .qq = pqq - vq * vq / bottom,
          .mm = pmm - vm * vm / bottom,
          .nq = -vn * vq / bottom,
          .nm = pnm - vn * vm / bottom,
          .qm = -vq * vm / bottom};
}

}  // namespace ductile::dynamics
