// The phases of an island in b2World::Step, and the components that its joints form.

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "box2d_private.h"
#include "structure.h"

namespace ductile {

using namespace dynamics;

void Structure::Impl::stop_if_not_finite(b2Body& body, const b2SolverData& data) {
  b2Velocity& velocity = data.velocities[dynamics::of(body, b2Body_m_islandIndex{})];
  if (velocity.v.IsValid() && b2IsValid(velocity.w)) return;
  velocity = {{0, 0}, 0};
  body.SetLinearVelocity({0, 0});
  body.SetAngularVelocity(0);
  ++reports.stopped;
}

// Joints are solved in the order in which they were initialised: the first does the work of all.
bool Structure::Impl::enlist(Member* member, Component* component) {
  const bool first = island_.velocity_calls > 0 || island_.enlisted.empty();
  if (first) {
    island_.enlisted.clear();
    island_.active.clear();
    island_.velocity_calls = 0;
    if (std::exchange(reports.stepped, true) == false) {
      reports.step = {};
      reports.bodies_in_parts = 0;
    }
  }
  island_.enlisted.push_back(member);
  if (component != nullptr && component->enlisted++ == 0) island_.active.push_back(component);
  return first;
}

void Structure::Impl::velocity(const b2SolverData& data) {
  const int last = data.step.velocityIterations;
  if (island_.velocity_calls == last) return;
  if (island_.velocity_calls++ == 0) {
    choose_contacts(data);
    std::size_t known = 0;
    bool fits = true;
    for (Component* c : island_.active) {
      const std::size_t enlisted = std::exchange(c->enlisted, 0);
      known += enlisted;
      fits = fits && enlisted == c->members.size() && c->look(data, island_.contacts, island_.stock);
    }
    fits = fits && known == island_.enlisted.size();
    if (!fits || !distribute()) {
      form();
      for (Component* c : island_.active) c->look(data, island_.contacts, island_.stock);
      distribute();
    }
    hold_bullets();
    for (Component* c : island_.active) c->first_velocity(data);
    if (std::all_of(island_.active.begin(), island_.active.end(),
                    [](const Component* c) { return c->whole(); })) {
      reports.step.skipped += static_cast<int>(island_.active.size()) * (last - island_.velocity_calls);
      island_.velocity_calls = last;
    }
  } else {
    for (Component* c : island_.active) c->next_velocity(data);
  }
  if (island_.velocity_calls < last) return;
  for (Component* c : island_.active) {
    if (c->rests() || c->advanced()) continue;
    c->limit_speed(data);
    c->advance(data);
    look_for_breaks(*c);
  }
}

void Structure::Impl::position(const b2SolverData& data) {
  for (Component* c : island_.active) c->position(data);
}

// Forms components of the joints of this island, keeping what is known of their bodies and strains.
void Structure::Impl::form() {
  for (Component* c : island_.active) dissolve(*c);
  std::erase_if(components, [&](const auto& c) {
    return std::find(island_.active.begin(), island_.active.end(), c.get()) != island_.active.end();
  });
  island_.active.clear();

  // Contacts change the order of joints between steps; elimination must not depend on it.
  std::vector<Member*> all = island_.enlisted;
  std::sort(all.begin(), all.end(), [](const Member* a, const Member* b) { return a->id < b->id; });
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> first_joint(static_cast<std::size_t>(world->GetBodyCount()), none);
  std::vector<const b2Body*> seen(first_joint.size());  // others have places in other islands, or none
  const auto first = [&](const b2Body& body) -> std::size_t& {
    const std::size_t place = IslandContacts::place_of(body);
    seen[place] = &body;
    return first_joint[place];
  };
  std::vector<std::size_t> root(all.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const b2Body* body : {all[i]->joint->GetBodyA(), all[i]->joint->GetBodyB()}) {
      if (!is_free(body)) continue;
      if (first(*body) == none) first(*body) = i;
      const std::size_t other = find(first(*body)), mine = find(i);
      root[std::max(other, mine)] = std::min(other, mine);
    }
  }
  // What touches or is tied hangs together, too. Of bodies without joints, by way of those that they touch.
  std::vector<BodyPair> pairs;
  for (const StockJoint& t : island_.stock) pairs.push_back({t.a(), t.b()});
  for (const Touch& t : island_.contacts.touches()) pairs.push_back({t.a(), t.b()});
  for (bool again = true; std::exchange(again, false);) {
    for (const BodyPair& pair : pairs) {
      if (!is_free(pair.a) || !is_free(pair.b)) continue;
      std::size_t &a = first(*pair.a), &b = first(*pair.b);
      if (a == none && b == none) continue;
      if (a == none || b == none) {
        a = b = std::min(a, b);
        again = true;
      } else {
        const std::size_t one = find(a), other = find(b);
        root[std::max(one, other)] = std::min(one, other);
      }
    }
  }
  std::vector<std::vector<Member*>> groups(all.size());
  std::vector<std::vector<BodyPair>> touched(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) groups[find(i)].push_back(all[i]);
  for (const BodyPair& pair : pairs) {
    if (!is_free(pair.a) && !is_free(pair.b)) continue;
    const std::size_t joint = first(is_free(pair.a) ? *pair.a : *pair.b);
    if (joint != none) touched[find(joint)].push_back(pair);
  }
  // What is near may touch in the next step: known by then, it need not be formed anew.
  std::vector<char> looked_at(first_joint.size());
  for (const BodyPair& pair : pairs) {
    for (b2Body* body : {pair.a, pair.b}) {
      if (!is_free(body) || first(*body) == none) continue;
      if (std::exchange(looked_at[IslandContacts::place_of(*body)], 1) != 0) continue;
      const std::size_t group = find(first(*body));
      for (const b2ContactEdge* e = body->GetContactList(); e != nullptr; e = e->next) {
        if (e->contact->IsTouching()) continue;
        const std::size_t place = IslandContacts::place_of(*e->other);
        const bool is_in = place < seen.size() && seen[place] == e->other && first_joint[place] != none &&
                           find(first_joint[place]) == group;
        if (may_take(*e->other) && (is_in || !is_free(e->other))) touched[group].push_back({body, e->other});
      }
    }
  }
  for (std::size_t k = 0; k < groups.size(); ++k) {
    auto& group = groups[k];
    if (group.empty()) continue;
    Component& c = form(std::move(group), std::move(touched[k]));
    island_.active.push_back(&c);
  }
}

Component& Structure::Impl::form(std::vector<Member*> group, std::vector<BodyPair> touching) {
  Component& c = *components.emplace_back(
      std::make_unique<Component>(std::move(group), def.solver, std::move(touching)));
  c.structure = this;
  c.solver.keeps_ledger = def.keep_ledger && def.solver == SolverKind::direct;
  return c;
}

void Structure::Impl::dissolve(Component& component) {
  gone_.damping += component.solver.energies().damping;
  gone_.numerical += component.solver.energies().numerical;
  gone_.driven += component.solver.energies().driven;
  gone_.contacts += component.solver.energies().contacts;
  component.solver.find_gaps();
  for (Member* m : component.members) {
    component.hand_back(*m);
    if (m->broken) m->own.joint.impulse = {};
    m->belong_to(nullptr);
  }
}

}  // namespace ductile
