#include "blow.h"

#include <algorithm>
#include <cmath>

#include "flow.h"
#include "kinematics.h"

namespace ductile::dynamics {

namespace {

void set_caps(Joint& j, JointRecord& r, const Rows& cap, const Rows& cap_reverse, double share) {
  r.law.cap = cap;
  r.law.cap_reverse = cap_reverse;
  r.law.share = share;
  if (r.material.rate != nullptr) r.law.raised = r.law.after_yield = {};
  j.elastic_range = r.law.elastic_range();
}

Rows times(double h, const Rows& force) { return {h * force[0], h * force[1], h * force[2]}; }

}  // namespace

void open_blow(System& system) {
  for (Joint& j : system.own_joints()) {
    JointRecord& r = system.record(j);
    const double h = r.law.h;
    const Rows& s = j.impulse;
    Rows cap = r.law.cap, cap_reverse = r.law.cap_reverse;
    double share = 1;
    if (r.law.surface != nullptr) {
      share = (1 + std::min(1.0, r.law.surface->usage(s, h))) / 2;
    } else {
      for (unsigned i = 0; i < 3; ++i) {
        if (r.material.may_slacken(i) || r.material.is_driven(i)) continue;
        const double before = std::clamp(s[i], -cap_reverse[i], cap[i]);
        cap[i] = (cap[i] + before) / 2;
        cap_reverse[i] = (cap_reverse[i] - before) / 2;
      }
    }
    set_caps(j, r, cap, cap_reverse, share);
  }
}

void weaken(Joint& j, JointRecord& r, double share) {
  r.held = share;
  const double h = share * r.law.h;
  set_caps(j, r, times(h, r.material.cap), times(h, r.material.cap_reverse), share);
}

double strained_by_blow(const System& system, std::span<const Rows> before) {
  double most = 0;
  for (const Joint& j : system.own_joints()) {
    const JointRecord& r = system.record(j);
    Rows more = j.impulse;
    for (unsigned i = 0; i < 3; ++i) more[i] = (more[i] - before[system.index(j)][i]) / r.law.h;
    if (r.law.surface != nullptr) {
      most = std::max(most, r.law.surface->usage(more));
      continue;
    }
    for (unsigned i = 0; i < 3; ++i) {
      const double cap = std::min(r.material.cap[i], r.material.cap_reverse[i]);
      if (cap > 0) most = std::max(most, std::abs(more[i]) / cap);
    }
  }
  return most;
}

void close_blow(System& system) {
  for (Joint& j : system.own_joints()) {
    JointRecord& r = system.record(j);
    for (unsigned i = 0; i < 3; ++i)
      if (flows(j.regime, i)) j.impulse[i] = impulse_at_yield(j, r, i);
    r.held = 1;
    set_caps(j, r, times(r.law.h, r.material.cap), times(r.law.h, r.material.cap_reverse), 1);
  }
}

LeftOut left_out(const System& system, std::span<const Rows> before, double closing,
                 std::span<Vec3> scratch) {
  const std::span<const Joint> own = system.own_joints();
  const auto more = [&](const Joint& j) {
    Rows s = j.impulse;
    for (unsigned i = 0; i < 3; ++i) s[i] -= before[system.index(j)][i];
    return s;
  };
  // Σ Jᵀ Δs of the free bodies.
  std::fill(scratch.begin(), scratch.end(), Vec3{});
  Vec3 ground;
  const auto of = [&](int body) -> Vec3& { return system.is_free(body) ? scratch[z(body)] : ground; };
  for (const Joint& j : own) add_transposed(j, more(j), of(j.a), of(j.b));
  const auto without = [&](int body) {
    const Body& b = system.bodies[z(body)];
    const Vec3 p = of(body);
    return system.is_free(body)
               ? b.v + Vec3{b.inverse_mass * p.x, b.inverse_mass * p.y, b.inverse_inertia * p.w}
               : b.v;
  };
  LeftOut all;
  for (const Joint& j : own) {
    const JointRecord& r = system.record(j);
    if (r.held < 1) continue;  // it breaks, which is work enough
    const Rows s = more(j), v = relative_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v),
               v2 = relative_velocity(j, without(j.a), without(j.b)),
               v0 = relative_velocity(j, system.free_velocity(j.a), system.free_velocity(j.b));
    double way = 0, gyration = unlimited;
    const auto look_at = [&](int body, double across, double along) {
      if (!system.is_free(body)) return;
      way += std::hypot(across, along);
      const Body& b = system.bodies[z(body)];
      if (b.inertia > 0) gyration = std::min(gyration, std::sqrt(b.inertia / b.mass));
    };
    look_at(j.a, j.J.au, j.J.av);
    look_at(j.b, j.J.bu, j.J.bv);
    for (unsigned i = 0; i < 3; ++i) {
      const double cap = s[i] > 0 ? r.material.cap[i] : r.material.cap_reverse[i];
      if (!(j.G[i] > 0) || !std::isfinite(cap) || r.material.may_slacken(i) || r.material.is_driven(i))
        continue;
      const double most = std::abs(v0[i]) + closing / (i == 2 ? 2 * gyration : 1);
      const double booked = flows(j.regime, i) ? impulse_at_yield(j, r, i) / r.law.h * slip_of(j, r, i) : 0;
      const double work = s[i] * (std::clamp(v2[i], -most, most) + v[i]) / 2 -
                          cap * cap / (2 * r.material.stiffness[i]) - booked;
      if (!(work > 0)) continue;
      all.flow = std::max(all.flow, work / (cap * (i == 2 ? 1 : way)));
      all.work += work;
    }
  }
  return all;
}

double impulse_at_yield(const Joint& j, const JointRecord& r, unsigned i) {
  const double s = j.impulse[i], h = r.law.h;
  if (r.law.surface != nullptr) return s / r.law.share;
  const double raised = r.law.raised[i];
  const double missing = s > 0 ? h * r.material.cap[i] - (r.law.cap[i] - raised)
                               : (r.law.cap_reverse[i] - raised) - h * r.material.cap_reverse[i];
  return std::isfinite(missing) ? s + missing : s;
}

}  // namespace ductile::dynamics
