#include "diagram.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ductile/box2d.h"

namespace ductile::viewer {
namespace {

constexpr Point right{0, -1};  // d of a joint's M in its section's coordinates

}  // namespace

Diagram diagram(const Plan& plan, std::size_t joint) {
  const PlannedJoint& j = plan.joints[joint];
  Diagram d;
  for (const int side : {j.a, j.b}) {
    if (side < 0) continue;
    auto section = section_at(plan, j, side);
    if (section && (!d.section || section->capacities(right).M < d.section->capacities(right).M)) {
      d.section = std::move(section);
    }
  }
  if (d.section) {
    for (const Interaction& at : d.section->interaction(right, 0)) d.curve.push_back({at.N, at.M});
    for (const Region& region : d.section->regions()) {
      const auto parts = convex_parts({.outline = region.outline});
      d.parts.insert(d.parts.end(), parts.begin(), parts.end());
    }
  }
  if (plan.interaction) d.limit = interaction_of(plan, j);
  const double caps[] = {j.N, j.Nc, j.M, j.M_reverse};
  if (d.limit.empty() &&
      std::all_of(std::begin(caps), std::end(caps), [](double cap) { return cap > 0 && cap < unlimited; })) {
    d.limit = {{j.N, j.M}, {-j.Nc, j.M}, {-j.Nc, -j.M_reverse}, {j.N, -j.M_reverse}};
  }
  return d;
}

// Along the N–M curve a fibre at the neutral axis turns from compression to tension, so that dM = s dN with s
// its coordinate along d.
double neutral_axis(const Section& section, double N, bool positive) {
  const Capacities c = section.capacities(right);
  const double h = 1e-5 * (c.N + c.Nc);
  const double n = std::clamp(N, -c.Nc + h, c.N - h);
  const double slope =
      (section.moment_at(right, n + h, 0, !positive) - section.moment_at(right, n - h, 0, !positive)) /
      (2 * h);
  return positive ? -slope : slope;  // y = −s; the other sense counts M the other way round
}

}  // namespace ductile::viewer
