// Which joints yield, flow and break in a step, and how update() delivers these events after it.

#include <bit>
#include <utility>

#include "drive.h"
#include "structure.h"

namespace ductile {

using namespace dynamics;

void dynamics::look_for_breaks(Component& component) {
  if (!component.solver.any_flows()) return;
  for (Member* m : component.members) {
    if (component.solver.joints[m->index].regime != 0 && !m->broken) m->structure->look_for_break(*m);
  }
}

void Structure::Impl::look_for_break(Member& m) {
  const Joint& j = m.data();
  unsigned yields = flowing(j.regime);
  for (unsigned i = 0; i < 3; ++i) {
    if (is_driven(m.record(), i) || is_slack(j, m.record(), i)) yields &= ~(1u << i);
  }
  if (yields == 0) return;
  const Rows force = dynamics::force(j, m.record());
  const unsigned row =
      j.regime == on_surface && (yields & 4u) != 0 ? 2u : static_cast<unsigned>(std::countr_zero(yields));
  const double energy = m.joint->dissipated();
  const auto mode = row == axial   ? (force[0] >= 0 ? JointEvent::tension : JointEvent::compression)
                    : row == shear ? JointEvent::shear
                                   : JointEvent::rotation;
  const double used = m.joint->capacity_used();
  if (!std::exchange(m.said.yielded, true)) {
    say(m, {JointEvent::yield, mode, m.joint, force[row], energy});
  } else if ((used > 0 ? used >= m.said.used + def.flow_share : energy >= 2 * m.said.energy) &&
             say(m, {JointEvent::flow, mode, m.joint, force[row], energy})) {
    m.said.used = used;
  }
  if (!(used > 1)) return;
  if (const auto veto = events.veto; veto != nullptr && !(*veto)(*m.joint)) return;
  break_joint(m, mode, static_cast<Row>(row));
}

// Never allocates inside a step: a flow that finds no room is not said, and counts with the next. Each
// joint's yield and break have room.
bool Structure::Impl::say(Member& member, JointEvent event) {
  if (!events.delivering && events.delivered > 0) {  // a handler threw
    events.pending.erase(events.pending.begin(),
                         events.pending.begin() + static_cast<std::ptrdiff_t>(events.delivered));
    events.delivered = 0;
  }
  const std::size_t kept_free = event.kind == JointEvent::flow ? 2 * members.size() : 0;
  if (events.pending.size() + kept_free >= events.pending.capacity()) return false;
  event.worked = event.energy - std::exchange(member.said.energy, event.energy);
  events.pending.push_back({member.id, event});
  return true;
}

// Until update() destroys it, a broken joint has no caps. Its group goes with it, in the same mode.
void Structure::Impl::break_joint(Member& member, JointEvent::Mode mode, Row row) {
  const auto let_go = [&](Member& m) {
    m.broken = broke_ = true;
    say(m, {.kind = JointEvent::broke,
            .mode = mode,
            .joint = m.joint,
            .force = m.joint->force(row),
            .energy = m.joint->dissipated(),
            .released = m.joint->elastic_energy()});
    Joint& j = m.data();
    JointRecord& r = m.record();
    for (unsigned i = 0; i < 3; ++i) {
      r.dissipated[i] += r.stored[i];  // what it still held is set free
      r.stored[i] = 0;
      j.neutral[i] = r.gap[i];
    }
    r.material.cap = r.material.cap_reverse = {};
    r.material.surface = nullptr;
    if (m.component != nullptr) m.component->disturb();
  };
  let_go(member);
  if (member.break_group == 0) return;
  for (const auto& other : members) {
    if (other->break_group == member.break_group && !other->broken) let_go(*other);
  }
}

// The handler may destroy anything: joints are looked up by id each time. It may throw: an event that
// it got is not delivered again.
void Structure::Impl::deliver() {
  struct Delivering {
    bool& flag;
    explicit Delivering(bool& set) : flag(set) { flag = true; }
    ~Delivering() { flag = false; }
  } delivering(events.delivering);
  while (events.delivered < events.pending.size()) {
    Events::Pending p = events.pending[events.delivered++];
    const Member* member = find(p.id);
    const auto handler = events.handler;
    if (handler == nullptr || member == nullptr) continue;
    p.event.at = member->joint->GetAnchorA();
    (*handler)(p.event);
  }
  events.pending.clear();
  events.delivered = 0;
}

}  // namespace ductile
