#include "blow.h"

#include <algorithm>
#include <cmath>

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
      share = (1 + std::min(1.0, r.law.surface->usage({s[0] / h, s[1] / h, s[2] / h}))) / 2;
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

void close_blow(System& system) {
  for (Joint& j : system.own_joints()) {
    JointRecord& r = system.record(j);
    for (unsigned i = 0; i < 3; ++i)
      if (flows(j.regime, i)) j.impulse[i] = impulse_at_yield(j, r, i);
    r.held = 1;
    set_caps(j, r, times(r.law.h, r.material.cap), times(r.law.h, r.material.cap_reverse), 1);
  }
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
