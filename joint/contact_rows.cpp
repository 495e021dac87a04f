#include "contact_rows.h"

#include <algorithm>
#include <cmath>

namespace ductile::dynamics {

namespace {

double effective_mass(const System& system, const Joint& j, double arm_a, double arm_b) {
  const auto add = [&](int body, double arm) {
    const Body& b = system.bodies[z(body)];
    return system.is_free(body) ? b.inverse_mass + b.inverse_inertia * arm * arm : 0;
  };
  const double sum = add(j.a, arm_a) + add(j.b, arm_b);
  return sum > 0 ? 1 / sum : 0;
}

}  // namespace

// A friction that may hold nothing is no row: it would leave an interior point no room.
void set_friction(Joint& j, JointRecord& r, double cap) {
  r.law.cap[1] = r.law.cap_reverse[1] = cap;
  r.law.G[1] = j.G[1] = cap > 0 ? contact_ratio * r.m_eff[1] : 0;
}

bool enter_contacts(System& system, std::span<const Contact> contacts, double h) {
  bool same = same_rows<Contact>(contacts, system.contacts);
  const std::size_t first = system.first_contact();
  system.contacts.assign(contacts.begin(), contacts.end());
  system.joints.resize(first + contacts.size());
  system.records.resize(first + contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const Contact& c = contacts[k];
    Joint& j = system.joints[first + k];
    JointRecord& r = system.records[first + k];
    if (!same) j = {}, r = {};
    j.a = c.a;
    j.b = c.b;
    const auto cross = [](double x, double y, const Turn& n) { return x * n.s - y * n.c; };
    const auto along = [](double x, double y, const Turn& n) { return x * n.c + y * n.s; };
    j.J = {c.normal_a,
           c.normal_b,
           -cross(c.ax, c.ay, c.normal_a),
           -along(c.ax, c.ay, c.normal_a),
           cross(c.bx, c.by, c.normal_b),
           along(c.bx, c.by, c.normal_b)};
    j.bias = {-c.bounce, c.conveyor, 0};
    j.impulse = {-c.normal, c.tangent, 0};
    r.m_eff = {effective_mass(system, j, j.J.au, j.J.bu), effective_mass(system, j, j.J.av, j.J.bv), 0};
    const bool slid = r.law.G[1] > 0;
    r.law.h = h;
    r.law.G[0] = j.G[0] = contact_ratio * r.m_eff[0];
    r.law.cap_reverse[0] = unlimited;
    set_friction(j, r, c.friction * c.normal);
    for (unsigned i = 0; i < 2; ++i) {
      if (!(j.G[i] > 0)) continue;
      j.impulse[i] = std::clamp(j.impulse[i], -most_carried * j.G[i], most_carried * j.G[i]);
      j.bias[i] += j.impulse[i] / j.G[i];
    }
    same &= slid == (j.G[1] > 0);
  }
  return same;
}

void read_contacts(System& system) {
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    const Rows& s = system.joints[system.first_contact() + k].impulse;
    system.contacts[k].normal = std::max(0.0, -s[0]);
    system.contacts[k].tangent = s[1];
  }
}

void write_contacts(System& system) {
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    const Contact& c = system.contacts[k];
    system.joints[system.first_contact() + k].impulse = {-c.normal, c.tangent, 0};
  }
}

Lag lag_friction(System& system, int round, bool of_open) {
  Lag lag;
  double largest = 0;
  for (const Contact& c : system.contacts) largest = std::max(largest, c.friction * c.normal);
  for (std::size_t k = 0; k < system.contacts.size(); ++k) {
    const Contact& c = system.contacts[k];
    Joint& j = system.joints[system.first_contact() + k];
    JointRecord& r = system.records[system.first_contact() + k];
    const double cap = r.law.cap[1], wanted = c.friction * c.normal;
    if (of_open && (wanted > 0 || c.tangent == 0)) continue;
    if (std::abs(wanted - cap) <= 1e-3 * std::max(wanted, cap) + 1e-5 * largest) continue;
    // What sticks within both caps is not changed by them.
    lag.again |= !(std::abs(c.tangent) < std::min(cap, wanted));
    const bool held = j.G[1] > 0;
    set_friction(j, r, round < 3 ? wanted : (wanted + cap) / 2);
    lag.other_rows |= held != (j.G[1] > 0);
  }
  return lag;
}

}  // namespace ductile::dynamics
