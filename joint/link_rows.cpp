#include "link_rows.h"

#include <cmath>

#include "contact_rows.h"
#include "kinematics.h"

namespace ductile::dynamics {

bool enter_links(System& system, std::span<const Link> links, double h) {
  bool same = same_rows<Link>(links, system.links);
  const std::size_t own = system.own();
  if (!same) {
    // The rows of contacts move along.
    system.contacts.clear();
    system.joints.resize(own);
    system.records.resize(own);
    system.joints.resize(own + links.size());
    system.records.resize(own + links.size());
  }
  system.links.assign(links.begin(), links.end());
  for (std::size_t k = 0; k < links.size(); ++k) {
    const Link& link = links[k];
    Joint& j = system.joints[own + k];
    JointRecord& r = system.records[own + k];
    j.a = link.a;
    j.b = link.b;
    j.J = link.J;
    j.bias = link.bias;
    j.impulse = link.impulse;
    r.m_eff = effective_masses(system, j);
    r.law.h = h;
    for (unsigned i = 0; i < 3; ++i) {
      double G = std::isfinite(link.G[i]) ? link.G[i] : contact_ratio * r.m_eff[i];
      // What can hold nothing is no row: it would leave an interior point no room.
      if (!(r.m_eff[i] > 0) || (link.cap[i] <= 0 && link.cap_reverse[i] <= 0)) G = 0;
      same &= (j.G[i] > 0) == (G > 0);
      if ((link.goes_on >> i & 1u) != 0 && G > 0) j.bias[i] += link.impulse[i] / G;
      r.law.G[i] = j.G[i] = G;
      r.law.cap[i] = link.cap[i];
      r.law.cap_reverse[i] = link.cap_reverse[i];
    }
    j.elastic_range = r.law.elastic_range();
  }
  return same;
}

void read_links(System& system) {
  for (std::size_t k = 0; k < system.links.size(); ++k)
    system.links[k].impulse = system.joints[system.own() + k].impulse;
}

}  // namespace ductile::dynamics
