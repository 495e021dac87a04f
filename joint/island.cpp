// The phases of an island in b2World::Step, and the components that its joints form.
#include "island.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {

bool stop_if_not_finite(b2Body& body, const b2SolverData& data) {
  b2Velocity& velocity = data.velocities[of(body, b2Body_m_islandIndex{})];
  if (velocity.v.IsValid() && b2IsValid(velocity.w)) return false;
  velocity = {{0, 0}, 0};
  body.SetLinearVelocity({0, 0});
  body.SetAngularVelocity(0);
  return true;
}

b2World& Island::world() const { return *enlisted_.front()->joint->GetBodyA()->GetWorld(); }

bool Island::direct() const { return enlisted_.front()->structure->def.solver == SolverKind::direct; }

std::size_t Island::joints() const {
  std::size_t sum = 0;
  for (const Structure::Impl* s : structures_) sum += s->members.size();
  return sum;
}

std::size_t Island::held_by(const Structure::Impl& structure) const {
  return pool_.held() * structure.members.size() / std::max<std::size_t>(1, joints());
}

void Island::enter(Structure::Impl& structure) {
  structures_.push_back(&structure);
  make_room();
}

void Island::leave(Structure::Impl& structure) {
  std::erase(structures_, &structure);
  std::erase_if(components, [&](const auto& c) {
    if (!c->is_of(structure)) return false;
    hand_back(*c);
    return true;
  });
  forget_last();
}

void Island::make_room() {
  std::size_t room = 0;
  for (const Structure::Impl* s : structures_) room += s->members.capacity();
  enlisted_.reserve(room);
  active_.reserve(room);
  components.reserve(room);
  contacts_.make_room(room);
  struck_.reserve(room);
}

void Island::forget_last() {
  enlisted_.clear();
  active_.clear();
  velocity_calls_ = 0;
}

// Joints are solved in the order in which they were initialised: the first does the work of all.
bool Island::enlist(Member* member, Component* component) {
  const bool first = velocity_calls_ > 0 || enlisted_.empty();
  if (first) forget_last();
  enlisted_.push_back(member);
  if (component == nullptr) {
    member->structure->reports.open_step();
  } else if (component->enlisted++ == 0) {
    active_.push_back(component);
    component->report([](Reports& r) { r.open_step(); });
  }
  return first;
}

void Island::velocity(const b2SolverData& data) {
  const int last = data.step.velocityIterations;
  if (velocity_calls_ == last) return;
  if (velocity_calls_++ == 0) {
    choose_contacts(data);
    for (Component* c : active_) {
      if (c->enlisted < c->members.size()) separate(*c);
    }
    std::erase_if(active_, [](const Component* c) { return c->enlisted == 0; });
    bool fits = (is_known() && distribute()) || (grow() && distribute());
    for (Component* c : active_) {
      const std::size_t enlisted = std::exchange(c->enlisted, 0);
      fits = fits && enlisted == c->members.size() && c->find_present();
    }
    if (!fits) {
      form();
      distribute();
      for (Component* c : active_) c->find_present();
    }
    for (Component* c : active_) c->look(data);
    hold_bullets();
    for (Component* c : active_) c->first_velocity(data);
    if (std::all_of(active_.begin(), active_.end(), [](const Component* c) { return c->whole(); })) {
      for (const Component* c : active_)
        c->report([&](Reports& r) { r.step.skipped += last - velocity_calls_; });
      velocity_calls_ = last;
    }
  } else {
    for (Component* c : active_) c->next_velocity(data);
  }
  if (velocity_calls_ < last) return;
  for (Component* c : active_) {
    if (c->rests() || c->advanced()) continue;
    c->limit_speed(data);
    c->advance(data);
    look_for_breaks(*c);
  }
  hold_apart(data.step.dt);
}

void Island::position(const b2SolverData& data) {
  for (Component* c : active_) c->position(data);
}

// What broke off has come into an island of its own: the lesser part leaves, and is formed anew.
void Island::separate(Component& c) {
  const Pool::Use use(pool_);
  for (Member* m : enlisted_) m->is_here = true;
  const bool stays = 2 * c.enlisted >= c.members.size();
  Vector<Member*> leaving;
  for (Member* m : c.members) {
    if (m->is_here != stays) leaving.push_back(m);
  }
  for (Member* m : enlisted_) m->is_here = false;
  if (!c.outlasts(leaving.size()) || !c.broke_off(leaving)) return;
  for (Member* m : leaving) c.remove(*m);
  c.enlisted = stays ? c.members.size() : 0;
}

// Whether all of its joints are in components.
bool Island::is_known() const {
  std::size_t known = 0;
  for (const Component* c : active_) known += c->enlisted;
  return known == enlisted_.size();
}

// The component of the island that a body is a piece of, or else a guest.
Component* Island::component_of(const b2Body& body) const {
  if (!is_free(&body)) return nullptr;
  Component* found = nullptr;
  for (Component* c : active_) {
    const int i = c->index_of(&body);
    if (i < 0 || c->is_of_another(i)) continue;
    if (!c->mirrors[z(i)].guest()) return c;
    found = c;
  }
  return found;
}

// Whether a guest of the island's components is no more, or another stands at its address.
bool Island::misses_guests() const {
  Vector<std::pair<const b2Body*, const Mirror*>> guests;
  for (const Component* c : active_) {
    for (const Mirror& m : c->mirrors)
      if (m.guest()) guests.emplace_back(m.body, &m);
  }
  if (guests.empty()) return false;
  std::sort(guests.begin(), guests.end());
  std::size_t there = 0;
  for (const b2Body* body = world().GetBodyList(); body != nullptr; body = body->GetNext()) {
    auto at =
        std::lower_bound(guests.begin(), guests.end(), std::pair{body, static_cast<const Mirror*>(nullptr)});
    for (; at != guests.end() && at->first == body; ++at) there += at->second->fits() ? 1 : 0;
  }
  return there < guests.size();
}

// Joints that are new, and what touches or is tied for the first time, join the component that they hang on:
// it costs what comes, not what is there. False where anything hangs on two, or on none, or a component does
// not outlast what would join it.
bool Island::grow() {
  const Pool::Use use(pool_);
  struct Share {
    Vector<Member*> joining;
    Vector<BodyPair> touching;
  };
  Vector<Share> shares(active_.size());
  Vector<std::pair<const b2Body*, Component*>> entering;
  const auto component_of = [&](const b2Body* body) {
    const auto at =
        std::find_if(entering.begin(), entering.end(), [&](const auto& e) { return e.first == body; });
    return at != entering.end() ? at->second : this->component_of(*body);
  };
  bool fits = direct() && !misses_guests();
  const auto belongs = [&](b2Body* a, b2Body* b) -> Component* {
    Component *of_a = component_of(a), *of_b = component_of(b);
    if (of_a != nullptr && of_b != nullptr && of_a != of_b) fits = false;
    Component* const one = of_a != nullptr ? of_a : of_b;
    if (one == nullptr || !fits) return nullptr;
    for (const b2Body* body : {a, b}) {
      const int i = one->index_of(body);
      if (i < 0 && is_free(body)) entering.emplace_back(body, one);
      fits &= i < 0 || one->solver.is_free(i) == is_free(body);
    }
    return one;
  };
  const auto share_of = [&](const Component* c) -> Share& {
    return shares[static_cast<std::size_t>(std::find(active_.begin(), active_.end(), c) - active_.begin())];
  };

  Vector<Member*> joints;
  for (Member* m : enlisted_) {
    if (m->component == nullptr) joints.push_back(m);
  }
  std::sort(joints.begin(), joints.end(), [](const Member* a, const Member* b) { return a->id < b->id; });
  Vector<BodyPair> pairs;
  const auto add_unknown = [&](b2Body* a, b2Body* b) {
    const bool known = std::any_of(active_.begin(), active_.end(), [&](const Component* c) {
      return c->knows(c->index_of(a), c->index_of(b));
    });
    if (!known && (is_free(a) || is_free(b))) pairs.push_back({a, b});
  };
  for (const StockJoint& t : stock_) add_unknown(t.a(), t.b());
  for (const Touch& t : contacts_.touches()) add_unknown(t.a(), t.b());
  for (bool again = true; std::exchange(again, false) && fits;) {
    std::erase_if(joints, [&](Member* m) {
      Component* c = belongs(m->joint->GetBodyA(), m->joint->GetBodyB());
      if (c != nullptr) share_of(c).joining.push_back(m);
      again |= c != nullptr;
      return c != nullptr;
    });
    std::erase_if(pairs, [&](const BodyPair& pair) {
      Component* c = belongs(pair.a, pair.b);
      if (c != nullptr) share_of(c).touching.push_back(pair);
      again |= c != nullptr;
      return c != nullptr;
    });
  }
  if (!fits || !joints.empty() || !pairs.empty()) return false;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (!active_[i]->outlasts(0, shares[i].joining.size(), shares[i].touching.size())) return false;
  }
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const auto& [joining, touching] = shares[i];
    if (joining.empty() && touching.empty()) continue;
    active_[i]->join(joining, touching);
    active_[i]->enlisted += joining.size();
  }
  return true;
}

// Forms components of the joints of this island, keeping what is known of their bodies and strains.
void Island::form() {
  const Pool::Use use(pool_);
  for (Component* c : active_) hand_back(*c);
  std::erase_if(components, [&](const auto& c) {
    return std::find(active_.begin(), active_.end(), c.get()) != active_.end();
  });
  active_.clear();

  // Contacts change the order of joints between steps; elimination must not depend on it.
  Vector<Member*> all(enlisted_.begin(), enlisted_.end());
  std::sort(all.begin(), all.end(), [](const Member* a, const Member* b) { return a->id < b->id; });
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  Vector<std::size_t> first_joint(static_cast<std::size_t>(world().GetBodyCount()), none);
  Vector<const b2Body*> seen(first_joint.size());  // others have places in other islands, or none
  const auto first = [&](const b2Body& body) -> std::size_t& {
    const std::size_t place = IslandContacts::place_of(body);
    seen[place] = &body;
    return first_joint[place];
  };
  Vector<std::size_t> root(all.size());
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
  Vector<BodyPair> pairs;
  for (const StockJoint& t : stock_) pairs.push_back({t.a(), t.b()});
  for (const Touch& t : contacts_.touches()) pairs.push_back({t.a(), t.b()});
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
  Vector<Vector<Member*>> groups(all.size());
  Vector<Vector<BodyPair>> touched(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) groups[find(i)].push_back(all[i]);
  for (const BodyPair& pair : pairs) {
    if (!is_free(pair.a) && !is_free(pair.b)) continue;
    const std::size_t joint = first(is_free(pair.a) ? *pair.a : *pair.b);
    if (joint != none) touched[find(joint)].push_back(pair);
  }
  // What is near may touch in the next step: known by then, it need not be formed anew.
  Vector<char> looked_at(first_joint.size());
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
    if (!groups[k].empty()) active_.push_back(&form(groups[k], touched[k]));
  }
}

Component& Island::form(std::span<Member* const> group, std::span<const BodyPair> touching,
                        std::span<b2Body* const> order) {
  const Pool::Use use(pool_);
  const SolverKind solver = group.front()->structure->def.solver;
  Component& c = *components.emplace_back(pool_.make<Component>(group, solver, touching, order));
  for (const Member* m : c.members) {
    if (!c.is_of(*m->structure)) c.take_in(*m->structure);
  }
  return c;
}

void Island::remove(Member& m) {
  Component& component = *m.component;
  if (component.outlasts(1)) return component.remove(m);
  hand_back(component);
  std::erase_if(components, [&](const auto& c) { return c.get() == &component; });
}

void Island::discard() {
  forget_last();
  for (const auto& c : components) {
    for (Member* m : c->members) m->belong_to(nullptr);
  }
  components.clear();
}

void Island::hand_back(Component& component) {
  add(component.structures.front()->gone, component.solver.energies());
  for (Member* m : component.members) {
    component.hand_back(*m);
    m->belong_to(nullptr);
  }
}

auto Island::state() const -> State {
  State s{.next_id = next_id,
          .components = {},
          .holds_bullets = holds_bullets_,
          .holds_contacts = holds_contacts_};
  for (const auto& c : components) {
    auto& formed = s.components.emplace_back(State::Formed{*c, {}});
    for (const Member* m : c->members) formed.members.emplace_back(m->structure, m->id);
  }
  return s;
}

void Island::restore(const State& s) {
  const Pool::Use use(pool_);
  next_id = s.next_id;
  holds_bullets_ = s.holds_bullets;
  holds_contacts_ = s.holds_contacts;
  forget_last();
  components.clear();
  for (const State::Formed& saved : s.components) {
    Component& c = *components.emplace_back(pool_.make<Component>(saved.component));
    for (std::size_t i = 0; i < saved.members.size(); ++i) {
      const auto& [structure, id] = saved.members[i];
      c.members[i] = structure->find(id);
      c.members[i]->belong_to(&c);
    }
  }
}

}  // namespace ductile::dynamics
