// Stock joints of a step as rows of a component: read from Box2D, and given back to it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "component.h"
#include "frames.h"
#include "structure.h"
#include "whole.h"

namespace ductile::dynamics {

namespace {

// A joint that closes its gap may press so many times as hard as bringing all bodies to that speed, and
// bearing them for a step, takes.
constexpr double most_weights = 30;

}  // namespace

bool Component::tie(StockJoint t) {
  t.in_a = index_of(t.a());
  t.in_b = index_of(t.b());
  if (!knows(t.in_a, t.in_b)) return false;
  outside_.ties.push_back(t);
  return true;
}

// Velocities as they were before Box2D gave them the joints' impulses: those stored, and where such a joint
// comes before ours in the island, those of its first iteration.
void Component::set_ties_aside(const b2SolverData& data) {
  const b2Vec2 near = origin.in_floats();
  const auto place_of = [&](const Mirror& m) {
    Place place;
    put(place, origin.relative(m.pose_in(data)));
    return place;
  };
  for (StockJoint& t : outside_.ties) {
    Mirror &a = mirrors[z(t.in_a)], &b = mirrors[z(t.in_b)];
    const Place at_a = place_of(a), at_b = place_of(b);
    const double h = data.step.dt;
    t.rows = rows_of(*t.joint, at_a, at_b, near, h, h);
    for (std::size_t k = 0; k < t.rows.count; ++k) {
      Joint j;
      j.J = t.rows.links[k].J;
      j.J.au -= t.rows.apart[shear];
      j.J.av += t.rows.apart[axial];
      Vec3 for_a, for_b;
      add_transposed(j, t.rows.links[k].impulse, for_a, for_b);
      const auto take_back = [&](int body, const Place& at, const Vec3& impulse) {
        if (!solver.is_free(body)) return;
        const Body& m = solver.bodies[z(body)];
        mirrors[z(body)].exact += into_world(
            at.turn, {m.inverse_mass * impulse.x, m.inverse_mass * impulse.y, m.inverse_inertia * impulse.w});
      };
      take_back(t.in_a, at_a, for_a);
      take_back(t.in_b, at_b, for_b);
    }
  }
}

// As one of so many parts of a step.
void Component::enter_ties(int parts) {
  outside_.links.clear();
  if (std::exchange(ties_in_groups_, !outside_.ties.empty()) || ties_in_groups_) groups_.clear();
  const b2Vec2 near = origin.in_floats();
  // What also touches something may be unable to close its gaps. Rows that went on to ask for it would press
  // harder in each step, without end; Box2D's iterations of positions do not press.
  const auto touches = [this](int i) {
    return mirrors[z(i)].guest() && solver.is_free(i) &&
           (std::any_of(outside_.touches.begin(), outside_.touches.end(),
                        [i](const Touch& t) { return (t.in_a == i || t.in_b == i) && !t.at_seam; }) ||
            std::find(outside_.at_corners.begin(), outside_.at_corners.end(), i) !=
                outside_.at_corners.end());
  };
  for (StockJoint& t : outside_.ties) {
    t.rows =
        rows_of(*t.joint, solver.places[z(t.in_a)], solver.places[z(t.in_b)], near, parts * solver.step(),
                solver.step(), !(jam_time_ > 0 || touches(t.in_a) || touches(t.in_b)));
    for (std::size_t k = 0; k < t.rows.count; ++k) {
      Link& link = outside_.links.emplace_back(t.rows.links[k]);
      link.a = t.in_a;
      link.b = t.in_b;
      for (double& impulse : link.impulse) impulse /= parts;
    }
  }
}

// Whether a joint that closes its gap presses harder than the bodies' masses and motors could ask for:
// something that touches them is in its way, and presses back harder in each step.
bool Component::is_jammed() const {
  if (jam_time_ > 0 || solver.links.empty() || solver.contacts.empty()) return false;
  const double weight = solver.step() * b2Distance(structures.front()->world->GetGravity(), b2Vec2_zero);
  const auto is_bounded = [](const Link& link, unsigned i) {
    return std::max(link.cap[i], link.cap_reverse[i]) < unlimited;
  };
  double motors = 0;
  for (const Link& link : solver.links)
    for (unsigned i = 0; i < 2; ++i) motors += is_bounded(link, i) ? std::abs(link.impulse[i]) : 0;
  for (const Joint& j : solver.own_joints())
    for (unsigned i = 0; i < 2 && j.special; ++i)
      if (solver.record(j).material.is_driven(i)) motors += std::abs(j.impulse[i]);
  return std::any_of(solver.links.begin(), solver.links.end(), [&](const Link& link) {
    for (unsigned i = 0; i < 2; ++i) {
      const double asked = most_weights * solver.mass * (std::abs(link.bias[i]) + weight) + motors;
      if (link.G[i] == unlimited && !is_bounded(link, i) && link.bias[i] != 0 &&
          std::abs(link.impulse[i]) > asked)
        return true;
    }
    return false;
  });
}

void Component::return_ties() {
  std::span<const Link> left = solver.links;
  for (StockJoint& t : outside_.ties) {
    if (t.rows.count == 0) continue;
    dynamics::hand_back(t, left.first(t.rows.count));
    left = left.subspan(t.rows.count);
  }
}

bool Component::is_held() const {
  return std::any_of(mirrors.begin() + static_cast<std::ptrdiff_t>(solver.free_bodies()), mirrors.end(),
                     [](const Mirror& m) { return !m.guest(); });
}

// What the structures' joints and stock joints hold together, and whether what does not give holds it.
void Component::find_groups(std::span<const StockJoint> ties) {
  groups_.resize(solver.free_bodies());
  for (std::size_t i = 0; i < groups_.size(); ++i) groups_[i] = {.part_of = static_cast<int>(i)};
  const auto hold = [this](int a, int b) {
    if (!solver.is_free(a) && !solver.is_free(b)) return;
    if (!solver.is_free(a)) std::swap(a, b);
    const int root = root_of(groups_, a);
    if (!solver.is_free(b)) {
      groups_[z(root)].anchored = true;
      return;
    }
    const int other = root_of(groups_, b);
    groups_[z(other)].anchored |= groups_[z(root)].anchored;
    groups_[z(root)].part_of = other;
  };
  for (const Joint& j : solver.own_joints()) hold(j.a, j.b);
  for (const StockJoint& t : ties)
    if (t.rows.near && t.rows.count > 0 && t.joint->GetType() != e_mouseJoint) hold(t.in_a, t.in_b);
  for (std::size_t i = 0; i < groups_.size(); ++i) groups_[i].part_of = root_of(groups_, static_cast<int>(i));
}

bool Component::is_piece_apart(const b2Body& body, const b2Body& from) {
  const int i = index_of(&body);
  if (i < 0 || !solver.is_free(i) || mirrors[z(i)].guest() || is_of_another(i)) return false;
  // Which stock joints there are in this step is not known yet.
  if (std::exchange(ties_in_groups_, false) || groups_.empty()) find_groups({});
  return !hang_together(i, index_of(&from));
}

}  // namespace ductile::dynamics
