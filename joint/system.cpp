#include "system.h"

#include <algorithm>
#include <utility>

#include "drive.h"
#include "kinematics.h"
#include "step_laws.h"

namespace ductile::dynamics {

void System::form(std::size_t free_bodies, std::size_t first) {
  free = free_bodies;
  turn_inertias.clear();
  std::size_t inertias = first == 0 ? 0 : turn_inertias.capacity();
  for (std::size_t k = first; k < joints.size(); ++k) inertias += turns_each(joints[k]) ? 3 : 1;
  turn_inertias.reserve(inertias);
  clumps.assign(free_bodies, {});
  wholes.reserve(free_bodies);
  returned.clear();
  returned.reserve(free_bodies);
  for (JointRecord& r : records) r.turn_inertia = -1;
  mass = 0;
  for (std::size_t i = 0; i < free; ++i) {
    Body& b = bodies[i];
    mass += b.mass;
    b.inverse_mass = 1 / b.mass;
    b.inverse_inertia = b.inertia > 0 ? 1 / b.inertia : 0;
  }
  Vector<double> beside(free);
  for (std::size_t i = 0; i < free; ++i) beside[i] = bodies[i].mass;
  for (const Joint& j : joints) {
    if (!is_free(j.a) || !is_free(j.b)) continue;
    beside[z(j.a)] = std::max(beside[z(j.a)], bodies[z(j.b)].mass);
    beside[z(j.b)] = std::max(beside[z(j.b)], bodies[z(j.a)].mass);
  }
  for (std::size_t k = first; k < joints.size(); ++k) {
    const Joint& j = joints[k];
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
    const auto inverse_beside = [&](int body) { return is_free(body) ? 1 / beside[z(body)] : 0; };
    record(j).lightness = ma + mb > 0 ? (ma + mb) / (inverse_beside(j.a) + inverse_beside(j.b)) : 1;
  }
}

void System::remove(std::size_t joint) {
  const Joint& j = joints[joint];
  if (is_free(j.a) && is_free(j.b)) {
    const std::pair<int, int> pair = std::minmax(j.a, j.b);
    const auto place = std::lower_bound(pairs.begin(), pairs.end(), pair);
    if (place == pairs.end() || *place != pair) pairs.insert(place, pair);
  }
  if (const int first = records[joint].turn_inertia; first >= 0) {
    const int count = turns_each(j) ? 3 : 1;
    const auto begin = turn_inertias.begin() + first;
    turn_inertias.erase(begin, begin + count);
    for (JointRecord& r : records)
      if (r.turn_inertia > first) r.turn_inertia -= count;
  }
  const std::size_t last = own() - 1;
  joints[joint] = joints[last];
  records[joint] = records[last];
  joints.erase(joints.begin() + static_cast<std::ptrdiff_t>(last));
  records.erase(records.begin() + static_cast<std::ptrdiff_t>(last));
  if (!driven.empty() || !rated.empty() || !slackening.empty()) list_special(*this);
}

void System::insert_bodies(std::size_t first, std::size_t last) {
  const std::size_t joined = own();
  contacts.clear();
  links.clear();
  joints.resize(joined);
  records.resize(joined);
  bodies.insert(bodies.begin(), first, {});
  places.insert(places.begin(), first, {});
  bodies.resize(bodies.size() + last);
  places.resize(bodies.size());
  const int by = static_cast<int>(first);
  for (Joint& j : joints) j.a += by, j.b += by;
  for (auto& [a, b] : pairs) a += by, b += by;
}

bool System::turns_each(const Joint& j) const {
  constexpr double alike = 4;
  if (j.frame.line || !is_free(j.a) || !is_free(j.b)) return true;
  const double a = bodies[z(j.a)].mass, b = bodies[z(j.b)].mass;
  return a > alike * b || b > alike * a;
}

void System::keep(Tape& tape) {
  tape(places);
  if (tape.reads()) locate_all(*this);
  tape(bodies);
  if (!keep_others(tape)) return tape.refuse();
  tape(joints, records);
  std::size_t inertias = turn_inertias.size();
  tape(inertias);
  if (tape.reads()) turn_inertias.assign(std::min(inertias, turn_inertias.capacity()), {});
  for (std::size_t k = own(); k < joints.size() && tape.reads(); ++k) {
    joints[k].G = records[k].law.G;
    records[k].turn_inertia = -1;
    if (joints[k].regime > on_surface) joints[k].regime = 0;
  }
  for (Joint& j : own_joints()) {
    JointRecord& r = record(j);
    if (tape.reads()) restore(j, r);
    if (r.turn_inertia < 0) continue;
    const std::size_t count = turns_each(j) ? 3 : 1;
    if (z(r.turn_inertia) + count > turn_inertias.size() || (j.block < 0 && count == 1)) return tape.refuse();
    for (std::size_t i = 0; i < count; ++i) {
      TurnInertia& t = turn_inertias[z(r.turn_inertia) + i];
      if (tape.reads() && t.a != t.b) return tape.refuse();  // an earlier joint has it
      t.a = j.a, t.b = j.b, t.block = j.block;
    }
  }
  for (const TurnInertia& t : turn_inertias) {
    if (t.a == t.b) return tape.refuse();
  }
  tape(turn_inertias, biases_known);
  if (tape.reads()) list_special(*this);
}

// Links and contacts, and what of their rows follows from nothing else; false where they are of other bodies.
bool System::keep_others(Tape& tape) {
  std::size_t link_count = links.size(), contact_count = contacts.size();
  tape(link_count, contact_count);
  if (tape.reads()) {
    if (std::max(link_count, contact_count) > tape.left()) return false;
    const std::size_t own_count = own();
    links.resize(link_count);
    contacts.resize(contact_count);
    joints.resize(own_count + link_count + contact_count);
    records.resize(joints.size());
  }
  tape(links, contacts);
  for (std::size_t k = own(); k < joints.size(); ++k) {
    Joint& j = joints[k];
    tape(j.J, record(j).m_eff);
    if (!tape.reads()) continue;
    const auto take = [&j](const auto& of) { j.a = of.a, j.b = of.b; };
    k < first_contact() ? take(links[k - own()]) : take(contacts[k - first_contact()]);
    const auto [a, b] = std::minmax(j.a, j.b);
    if (a < 0 || z(b) >= bodies.size()) return false;
    if (is_free(b) && !std::binary_search(pairs.begin(), pairs.end(), std::pair<int, int>(a, b)))
      return false;
  }
  return true;
}

void restore(Joint& j, JointRecord& r) {
  r.law.surface = r.material.surface;
  j.special = (r.material.slackens | r.material.driven) != 0;
  StepLaws::take_law(j, r.law);
  if (j.regime > on_surface) j.regime = 0;
}

Rows force(const Joint& j, const JointRecord& r) {
  const double h = r.law.h;
  if (!(h > 0)) return {};
  return {j.impulse[0] / h, j.impulse[1] / h, j.impulse[2] / h};
}

}  // namespace ductile::dynamics
