#include "row.h"

#include <algorithm>

namespace ductile {

Rows RowLaw::elastic_range() const {
  if (surface != nullptr) return {-1, -1, -1};
  Rows range;
  for (unsigned i = 0; i < 3; ++i) range[i] = std::min(cap[i], cap_reverse[i]);
  return range;
}

Response respond(const RowLaw& law, const Rows& x) {
  const Rows trial{law.G[0] * x[0], law.G[1] * x[1], law.G[2] * x[2]};
  Response r{trial, 0};
  if (law.surface != nullptr) {
    r.piece = law.surface->project(law.G, law.h, r.s) ? on_surface : 0;
    return r;
  }
  for (unsigned i = 0; i < 3; ++i) {
    const double held = std::min(std::max(trial[i], -law.cap_reverse[i]), law.cap[i]);
    r.s[i] = held + law.after_yield[i] * (trial[i] - held);
    r.piece |= (trial[i] > held ? 1u : 0u) << i | (trial[i] < held ? 8u : 0u) << i;
  }
  return r;
}

}  // namespace ductile
