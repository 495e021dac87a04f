#include "kinematics.h"

#include <cmath>

namespace ductile::dynamics {

Rows effective_masses(const System& system, const Joint& j) {
  Rows inverse{};
  const auto add = [&](int body, const JacobianRows& rows) {
    if (!system.is_free(body)) return;
    const Body& b = system.bodies[z(body)];
    const Vec3* const of_row[] = {&rows.u, &rows.v, &rows.w};
    for (unsigned i = 0; i < 3; ++i) {
      const Vec3& r = *of_row[i];
      inverse[i] += b.inverse_mass * (r.x * r.x + r.y * r.y) + b.inverse_inertia * r.w * r.w;
    }
  };
  add(j.a, rows_of_a(j.J));
  add(j.b, rows_of_b(j.J));
  for (unsigned i = 0; i < 3; ++i) inverse[i] = inverse[i] > 0 ? 1 / inverse[i] : 0;
  return inverse;
}

Rows locate(Joint& j, const Place& a, const Place& b) {
  Jacobian& J = j.J;
  const Frame& f = j.frame;
  const Turn relative = inverse(a.turn) * b.turn;
  const double bend = b.pose.angle - a.pose.angle - f.reference;
  // From anchor to anchor, in A's frame and then along and across the axis.
  const double wx = b.pose.x - a.pose.x, wy = b.pose.y - a.pose.y;
  const double dx = a.turn.c * wx + a.turn.s * wy + relative.c * f.bx - relative.s * f.by - f.ax;
  const double dy = -a.turn.s * wx + a.turn.c * wy + relative.s * f.bx + relative.c * f.by - f.ay;
  const double length = f.line ? std::sqrt(dx * dx + dy * dy) : 0;
  J.axis_a = length > 0      ? Turn{dx / length, dy / length}
             : f.follow == 0 ? f.axis
                             : f.axis * turn_of(f.follow * bend);
  J.axis_b = J.axis_a * inverse(relative);
  const double u = J.axis_a.c * dx + J.axis_a.s * dy;
  const double v = -J.axis_a.s * dx + J.axis_a.c * dy;
  J.au = -(f.ax * J.axis_a.s - f.ay * J.axis_a.c) + (1 - f.follow) * v;
  J.av = -(f.ax * J.axis_a.c + f.ay * J.axis_a.s) - (1 - f.follow) * u;
  J.bu = f.bx * J.axis_b.s - f.by * J.axis_b.c + f.follow * v;
  J.bv = f.bx * J.axis_b.c + f.by * J.axis_b.s - f.follow * u;
  return {u, v, bend};
}

void locate_all(System& system) {
  system.biases_known = false;
  for (Joint& j : system.own_joints()) system.record(j).gap = locate(j, system.places);
}

}  // namespace ductile::dynamics
