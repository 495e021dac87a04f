#include "row.h"

#include <algorithm>
#include <cmath>

namespace ductile::dynamics {

Rows RowLaw::elastic_range() const {
  if (surface != nullptr) return {-1, -1, -1};
  Rows range;
  for (unsigned i = 0; i < 3; ++i) range[i] = std::min(cap[i], cap_reverse[i]);
  return range;
}

RowLaw make_law(const Material& material, const Rows& m_eff, double h, const Integration& how) {
  RowLaw law;
  law.surface = material.surface;
  law.h = h;
  double shared = 0;  // δ of the dampers of all rows that share a yield surface, but of the implicit ones
  const auto special = [&](unsigned i) { return material.may_slacken(i) || material.is_driven(i); };
  for (unsigned i = 0; i < 3; ++i) {
    const double limit = rigid_ratio * m_eff[i];
    if (!(material.stiffness[i] > 0) || !(limit > 0) ||
        (material.cap[i] <= 0 && material.cap_reverse[i] <= 0))
      continue;
    double k = material.stiffness[i], c = 0, delta = 1;
    const double least = i < 2 ? how.delta : how.delta_rotation;
    if (h * h * k < how.rigid_from * m_eff[i]) {
      c = 2 * material.damping_ratio[i] * std::sqrt(k * m_eff[i]) + material.damping[i];
      double of_damper = c / (k * h);
      // Where bodies turn far, J of u and v is right to first order only; a damper that is beyond what the
      // row's own frequency lets the step resolve would store what that misses.
      if (i < 2 && least > 0 && least < 1 && h * h * k > m_eff[i]) of_damper = std::min(of_damper, 1.0);
      if (special(i)) of_damper = std::max(of_damper, special_delta);
      // Beside implicit Euler, the damper is one of its own.
      delta = least < 1 ? std::max(least, of_damper) : 1 + of_damper;
      delta = std::min(delta, limit / (h * h * k));
      const bool unresolved = h * h * k > unresolved_ratio * m_eff[i] && !special(i);
      if (least < 1 && ((unresolved && ((how.halts >> i & 1u) != 0 || (i < 2 && least > 0))) ||
                        (i < 2 && h * h * k > how.stiff_from * m_eff[i]))) {
        delta = 1;
      } else {
        shared = std::max(shared, std::min(of_damper, delta));
      }
    } else {
      k = limit / (h * h);
    }
    law.spring[i] = k;
    // What the step cannot take of a damper beside a stiff spring is not there.
    law.damping[i] = least < 1 ? std::min(c, delta * k * h) : c;
    law.delta[i] = delta;
    law.cap[i] = h * material.cap[i];
    law.cap_reverse[i] = h * material.cap_reverse[i];
  }
  for (unsigned i = 0; i < 3; ++i) {
    const double k = law.spring[i];
    if (!(k > 0)) continue;
    double& delta = law.delta[i];
    if (material.surface != nullptr && k == material.stiffness[i] && delta != 1)
      delta = std::max(delta, shared);
    double share = delta, over = 1 - delta;  // of u and of −p in R/k
    if (delta < 1) {
      const bool alone = special(i);
      const double d = alone ? delta : law.damping[i] / (k * h), q = std::min(d, most_detuning);
      law.third[i] = alone ? 0 : third_difference;
      law.detuning[i] = law.third[i] / 2 + q * (2 * d - q) / 4;
      const double damper = alone ? delta / 2 : 5 * delta / 12 + law.third[i];
      share = 0.25 + damper + law.detuning[i];
      over = 0.25 - damper + (alone ? law.detuning[i] : 0);
    }
    law.G[i] = share * h * h * k;
    law.relaxation[i] = 1 / (share * h);
    law.carry[i] = over / share;
    // A slider of modulus H in series with the spring: s/G + (s − hF)/(h²H) = x.
    const double H = material.slider_modulus(i, k);
    law.after_yield[i] = h * h * H / (h * h * H + law.G[i]);
  }
  return law;
}

Response respond(const RowLaw& law, const Rows& x) {
  const Rows trial{law.G[0] * x[0], law.G[1] * x[1], law.G[2] * x[2]};
  Response r{trial, 0};
  if (law.surface != nullptr) {
    r.regime = law.surface->project(law.G, law.share * law.h, r.s) ? on_surface : 0;
    return r;
  }
  for (unsigned i = 0; i < 3; ++i) {
    const double held = std::min(std::max(trial[i], -law.cap_reverse[i]), law.cap[i]);
    r.s[i] = held + law.after_yield[i] * (trial[i] - held);
    r.regime |= (trial[i] > held ? 1u : 0u) << i | (trial[i] < held ? 8u : 0u) << i;
  }
  return r;
}

}  // namespace ductile::dynamics
