#include "system.h"

namespace ductile::dynamics {

void System::form(std::size_t free_bodies) {
  free = free_bodies;
  turn_inertias.clear();
  turn_inertias.reserve(joints.size());
  for (JointRecord& r : records) r.turn_inertia = -1;
  mass = 0;
  for (std::size_t i = 0; i < free; ++i) {
    Body& b = bodies[i];
    mass += b.mass;
    b.inverse_mass = 1 / b.mass;
    b.inverse_inertia = b.inertia > 0 ? 1 / b.inertia : 0;
  }
  for (const Joint& j : joints) {
    // 1/m_eff = J M⁻¹ Jᵀ with the anchors together
    const auto inverse_mass = [&](int body) { return is_free(body) ? bodies[z(body)].inverse_mass : 0; };
    const auto inverse_inertia = [&](int body) {
      return is_free(body) ? bodies[z(body)].inverse_inertia : 0;
    };
    const Frame& f = j.frame;
    const double ma = inverse_mass(j.a), mb = inverse_mass(j.b), ia = inverse_inertia(j.a),
                 ib = inverse_inertia(j.b);
    const Turn in_a = f.axis, in_b = in_a * turn_of(-f.reference);
    const auto cross = [](double x, double y, const Turn& t) { return x * t.s - y * t.c; };
    const auto along = [](double x, double y, const Turn& t) { return x * t.c + y * t.s; };
    const double ca = cross(f.ax, f.ay, in_a), cb = cross(f.bx, f.by, in_b);
    const double la = along(f.ax, f.ay, in_a), lb = along(f.bx, f.by, in_b);
    const Rows inverse_m{ma + mb + ia * ca * ca + ib * cb * cb, ma + mb + ia * la * la + ib * lb * lb,
                         ia + ib};
    for (unsigned i = 0; i < 3; ++i) record(j).m_eff[i] = inverse_m[i] > 0 ? 1 / inverse_m[i] : 0;
  }
}

Rows force(const Joint& j, const JointRecord& r) {
  const double h = r.law.h;
  if (!(h > 0)) return {};
  return {j.impulse[0] / h, j.impulse[1] / h, j.impulse[2] / h};
}

}  // namespace ductile::dynamics
