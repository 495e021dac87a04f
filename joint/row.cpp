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

RowLaw make_law(const Material& material, const Rows& m_eff, double h, double rigid_from) {
  RowLaw law;
  law.surface = material.surface;
  law.h = h;
  for (unsigned i = 0; i < 3; ++i) {
    const double limit = rigid_ratio * m_eff[i];
    if (!(material.stiffness[i] > 0) || !(limit > 0) ||
        (material.cap[i] <= 0 && material.cap_reverse[i] <= 0))
      continue;
    double k = material.stiffness[i], c = 0;
    if (h * h * k < rigid_from * m_eff[i]) {
      c = std::min(2 * material.damping_ratio[i] * std::sqrt(k * m_eff[i]), (limit - h * h * k) / h);
    } else {
      k = limit / (h * h);
    }
    const double G = h * h * k + h * c;
    law.spring[i] = k;
    law.damping[i] = c;
    law.G[i] = G;
    law.relaxation[i] = h * k / G;
    law.cap[i] = h * material.cap[i];
    law.cap_reverse[i] = h * material.cap_reverse[i];
    // A slider of modulus H in series with the spring: 1/hardening = 1/k + 1/H. s/G + (s − hF)/(h²H) = x.
    const double after = std::min(material.hardening[i], 0.99 * k), H = after * k / (k - after);
    law.after_yield[i] = h * h * H / (h * h * H + G);
  }
  return law;
}

Response respond(const RowLaw& law, const Rows& x) {
  const Rows trial{law.G[0] * x[0], law.G[1] * x[1], law.G[2] * x[2]};
  Response r{trial, 0};
  if (law.surface != nullptr) {
    r.regime = law.surface->project(law.G, law.h, r.s) ? on_surface : 0;
    return r;
  }
  for (unsigned i = 0; i < 3; ++i) {
    const double held = std::min(std::max(trial[i], -law.cap_reverse[i]), law.cap[i]);
    r.s[i] = held + law.after_yield[i] * (trial[i] - held);
    r.regime |= (trial[i] > held ? 1u : 0u) << i | (trial[i] < held ? 8u : 0u) << i;
  }
  return r;
}

Rows respond_in(const RowLaw& law, unsigned regime, const Rows& x) {
  Rows s;
  for (unsigned i = 0; i < 3; ++i) {
    const double trial = law.G[i] * x[i];
    const double held = (regime >> i & 1u) != 0         ? law.cap[i]
                        : (regime >> (i + 3) & 1u) != 0 ? -law.cap_reverse[i]
                                                        : trial;
    s[i] = held + law.after_yield[i] * (trial - held);
  }
  return s;
}

}  // namespace ductile::dynamics
