// A structure's joints from their making to their end, its state, and its public face.

#include "structure.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "box2d_private.h"

namespace ductile {

using namespace dynamics;

namespace {

// Bodies that a joint holds are no contact of Box2D's, which looks for contacts of a body where that leaves
// its margin of 0.1 m: what stands on what it broke off would fall so far. So one of the two is looked at
// before the next step, and once, however many of its joints broke.
void mark_broken_off(b2Joint& joint) {
  b2Body* moving = joint.GetBodyB()->GetType() == b2_dynamicBody ? joint.GetBodyB() : joint.GetBodyA();
  of(*moving, b2Body_m_flags{}) |= broke_off;
}

void look_for_pairs(b2World& world) {
  for (b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext()) {
    uint16& flags = of(*body, b2Body_m_flags{});
    if ((flags & broke_off) == 0) continue;
    flags = static_cast<uint16>(flags & ~broke_off);
    for (b2Fixture* f = body->GetFixtureList(); f != nullptr; f = f->GetNext()) f->Refilter();
    of(world, b2World_m_newContacts{}) = true;
  }
}

}  // namespace

Structure::Impl::Impl(b2World& w, const StructureDef& d) : world(&w), def(d), watch(nullptr) {
  enter_world();
}

void Structure::Impl::enter_world() {
  if (watch != nullptr) return;
  for (const Impl* other : structures_in(*world)) {
    if (other->def.solver == def.solver) island = other->island;
  }
  if (island == nullptr) island = std::make_shared<Island>(def.memory);
  island->enter(*this);
  watch = watch_world(*world, *this);
}

Structure::Impl::~Impl() {
  if (watch == nullptr) return;
  island->let_go(*world);
  destroy_broken();
  island->leave(*this);
  for (const auto& m : members) m->joint->member_ = nullptr;
  world->DestroyBody(std::exchange(watch, nullptr));
}

void Structure::Impl::watch_is_gone(bool with_world) {
  // Destroying the watch by hand comes here too: the joints, still there, go on as welds.
  if (watch == nullptr) return;
  if (!with_world) island->let_go(*world);
  island->leave(*this);
  for (const auto& m : members) m->joint->member_ = nullptr;
  members.clear();
  joints.clear();
  events.pending.clear();
  nodes.orphans.clear();
  events.delivered = 0;
  watch = nullptr;
  if (with_world) world = nullptr;
}

ElasticPlasticJoint* Structure::Impl::join(b2World& in, const ElasticPlasticJointDef& def) {
  b2WeldJointDef weld;
  static_cast<b2JointDef&>(weld) = def;
  weld.type = e_weldJoint;
  weld.localAnchorA = def.localAnchorA;
  weld.localAnchorB = def.localAnchorB;
  weld.referenceAngle = def.referenceAngle;
  return take(static_cast<b2WeldJoint*>(in.CreateJoint(&weld)), def);
}

ElasticPlasticJoint* Structure::Impl::take(b2WeldJoint* weld, const ElasticPlasticJointDef& d) {
  auto member = std::make_unique<Member>();
  Member& m = *member;
  m.structure = this;
  m.id = island->next_id++;
  m.limits = {d.max_rotation, d.max_elongation, d.max_compression, d.max_slip};
  m.break_group = d.break_group;
  m.node = d.node;
  m.length = d.line ? d.length : -1;
  for (unsigned i = 0; i < 3; ++i) {
    const RowDef& row = d.rows[i];
    m.own.record.material.stiffness[i] = row.stiffness;
    m.own.record.material.damping_ratio[i] = row.damping_ratio;
    m.own.record.material.damping[i] = row.damping;
    m.own.record.material.cap[i] = row.cap;
    m.own.record.material.cap_reverse[i] = row.cap_reverse;
    m.own.record.material.hardening[i] = row.hardening;
    if (row.slackens) m.own.record.material.slackens |= 1u << i;
    if (row.drive) m.own.record.material.drive(i, row.drive->target, row.drive->speed);
  }
  if (!d.interaction.empty()) {
    m.surface = std::make_shared<const YieldSurface>(d.interaction, d.rows[shear].cap);
    m.own.record.material.surface = m.surface.get();
  }
  if (d.rate) {
    m.rate = std::make_shared<const RateLaw>(*d.rate);
    m.own.record.material.rate = m.rate.get();
  }
  m.own.joint.frame.axis = turn_of(d.axisAngle);
  m.own.joint.frame.follow = d.axisFollow;
  m.own.joint.frame.reference = weld->GetReferenceAngle();
  m.own.joint.frame.line = d.line;
  b2Body *a = weld->GetBodyA(), *b = weld->GetBodyB();
  m.joint = ElasticPlasticJoint::put_in_place(weld, &m);
  m.set_state(d.state);
  members.push_back(std::move(member));
  joints.push_back(m.joint);
  island->make_room();
  events.pending.reserve(4 * members.capacity());
  if (d.node != 0) mark(*a), mark(*b);
  a->SetAwake(true);
  b->SetAwake(true);
  return m.joint;
}

void Structure::Impl::forget(Member& member) {
  if (member.component != nullptr) island->remove(member);
  for (const double joules : member.own.record.dissipated) gone.dissipated += joules;
  for (const double joules : member.own.record.stored) gone.numerical += joules;  // lost with the joint
  if (member.node != 0 && !member.broken) nodes.orphans.push_back(member.joint->def());
  const auto place = static_cast<std::ptrdiff_t>(place_of(member.id));
  joints.erase(joints.begin() + place);
  members.erase(members.begin() + place);
}

JointEnergy Structure::Impl::energy() const {
  JointEnergy sum = gone;
  for (const auto& m : members) {
    for (const double joules : m->record().stored) sum.elastic += joules;
    sum.dissipated += m->joint->dissipated();
  }
  for (const auto& c : island->components) {
    if (c->structures.front() == this) add(sum, c->solver.energies());
  }
  return sum;
}

void dynamics::add(JointEnergy& sum, const Energies& booked) {
  sum.damping += booked.damping;
  sum.numerical += booked.numerical;
  sum.driven += booked.driven;
  sum.contacts += booked.contacts;
}

void dynamics::Reports::open_step() {
  if (std::exchange(stepped, true)) return;
  step = {};
  in_parts = 0;
}

void dynamics::Reports::close_step() {
  if (!std::exchange(stepped, false)) step = {};  // what sleeps is not solved
  worst.bounds_hit += step.bounds_hit;
  worst.parted += step.parted;
  worst.residual = std::max(worst.residual, step.residual);
  worst.slowed = std::max(worst.slowed, step.slowed);
}

void Structure::Impl::update() {
  if (watch == nullptr || events.delivering) return;
  if (world->IsLocked())
    throw std::logic_error("structure: update() while the world is stepping; call it after b2World::Step");
  island->let_go(*world);
  if (def.solver == SolverKind::direct && !world->GetSubStepping()) island->meet_guests(*world);
  reports.close_step();
  for (const auto& c : island->components) {
    if (c->is_of(*this)) c->structures.front()->gone.clamped += c->close_ledger();
  }
  deliver();
  if (watch == nullptr) return;
  destroy_broken();
  join_orphans();
}

void Structure::Impl::destroy_broken() {
  if (!std::exchange(broke_, false)) return;
  for (std::size_t i = members.size(); i-- > 0;) {
    if (i >= members.size() || !members[i]->broken) continue;
    ElasticPlasticJoint* joint = members[i]->joint;
    if (!joint->GetCollideConnected()) mark_broken_off(*joint);
    world->DestroyJoint(joint);
  }
  look_for_pairs(*world);
}

std::size_t Structure::Impl::place_of(std::uint32_t id) const {
  const auto place = std::lower_bound(members.begin(), members.end(), id,
                                      [](const auto& m, std::uint32_t value) { return m->id < value; });
  return static_cast<std::size_t>(place - members.begin());
}

Member* Structure::Impl::find(std::uint32_t id) const {
  const std::size_t place = place_of(id);
  return place < members.size() && members[place]->id == id ? members[place].get() : nullptr;
}

void Structure::Impl::shift_origin(const b2Vec2& new_origin, Member& caller) {
  // Called for every joint; each component is shifted by its first.
  Component* c = caller.component;
  for (KnownPose& known : caller.own.known) {
    known.pose.x -= new_origin.x;
    known.pose.y -= new_origin.y;
  }
  if (c == nullptr || caller.index != 0) return;
  c->origin.x -= new_origin.x;
  c->origin.y -= new_origin.y;
  for (Mirror& m : c->mirrors) m.left.c -= new_origin;
}

bool Structure::Impl::delivered_all() const {
  const auto open = [this](const auto& c) { return c->account.open && c->is_of(*this); };
  const auto broken = [](const auto& m) { return m->broken; };
  return !reports.stepped && events.pending.empty() && nodes.orphans.empty() && !events.delivering &&
         !island->holds_any() && std::none_of(island->components.begin(), island->components.end(), open) &&
         std::none_of(members.begin(), members.end(), broken);
}

std::size_t Structure::Impl::bytes() const {
  return sizeof(*this) + members.capacity() * (sizeof(Member) + sizeof(void*)) +
         joints.capacity() * sizeof(void*) + events.pending.capacity() * sizeof(Events::Pending) +
         island->held_by(*this);
}

auto Structure::Impl::state() const -> State {
  State s{.def = def,
          .watch = watch,
          .island = island,
          .members = {},
          .pending = {},
          .reports = reports,
          .nodes = nodes,
          .gone = gone};
  s.pending.assign(events.pending.begin() + static_cast<std::ptrdiff_t>(events.delivered),
                   events.pending.end());
  for (const auto& m : members) s.members.push_back(*m);
  return s;
}

// The joints are at their addresses again; members are made anew, and components after them.
void Structure::Impl::restore(const State& s) {
  def = s.def;
  watch = s.watch;
  reports = s.reports;
  nodes = s.nodes;
  gone = s.gone;
  events.pending.assign(s.pending.begin(), s.pending.end());
  events.delivered = 0;
  broke_ = true;  // update() looks for itself
  members.clear();
  joints.clear();
  for (const Member& saved : s.members) {
    members.push_back(std::make_unique<Member>(saved));
    joints.push_back(saved.joint);
    saved.joint->member_ = members.back().get();
    members.back()->belong_to(nullptr);
  }
}

namespace {

b2World& between_steps(b2World& world) {
  if (world.IsLocked())
    throw std::logic_error("structure: the world is stepping; make structures between steps");
  return world;
}

[[noreturn]] void refuse(const std::vector<std::string>& problems) {
  std::string all;
  for (const std::string& problem : problems) all += (all.empty() ? "" : "\n") + problem;
  throw std::invalid_argument(all);
}

}  // namespace

Structure::Structure(b2World& world, const StructureDef& def)
    : impl_(std::make_unique<Impl>(between_steps(world), def)) {
  impl_->handle = this;
}
Structure::~Structure() = default;
Structure::Structure(Structure&& other) noexcept : impl_(std::move(other.impl_)) {
  if (impl_) impl_->handle = this;
}
Structure& Structure::operator=(Structure&& other) noexcept {
  impl_ = std::move(other.impl_);
  if (impl_) impl_->handle = this;
  return *this;
}

Structure* Structure::of(b2World& world) {
  const std::vector<Impl*> all = structures_in(world);
  return all.empty() ? nullptr : all.front()->handle;
}

b2World* Structure::world() const { return impl_->watch != nullptr ? impl_->world : nullptr; }

std::vector<std::string> Structure::problems(const ElasticPlasticJointDef& def) const {
  return impl_->problems(def);
}

ElasticPlasticJoint* Structure::create_joint(const ElasticPlasticJointDef& def) {
  if (const auto problems = impl_->problems(def); !problems.empty()) refuse(problems);
  impl_->enter_world();
  impl_->join_orphans();
  return impl_->join(*impl_->world, def);
}

ElasticPlasticJoint* Structure::adopt(b2WeldJoint* weld, const ElasticPlasticJointDef& def) {
  if (weld == nullptr) throw std::invalid_argument("structure: no weld to adopt");
  if (const auto* own_kind = ElasticPlasticJoint::cast(weld); own_kind && own_kind->member_ != nullptr) {
    throw std::invalid_argument(
        "structure: the weld is a joint of a structure already; adopt stock welds, or those of one that is "
        "gone");
  }
  ElasticPlasticJointDef own = def;
  own.bodyA = weld->GetBodyA();
  own.bodyB = weld->GetBodyB();
  if (const auto problems = impl_->problems(own); !problems.empty()) refuse(problems);
  impl_->enter_world();
  impl_->join_orphans();
  return impl_->take(weld, own);
}

void Structure::update() { impl_->update(); }
void Structure::on_event(std::function<void(const JointEvent&)> handler) {
  impl_->events.handler = shared(std::move(handler));
}
void Structure::may_break(std::function<bool(const ElasticPlasticJoint&)> veto) {
  impl_->events.veto = shared(std::move(veto));
}
std::span<ElasticPlasticJoint* const> Structure::joints() const { return impl_->joints; }
const StepReport& Structure::report() const { return impl_->reports.step; }
JointEnergy Structure::energy() const { return impl_->energy(); }
std::size_t Structure::bytes() const { return impl_->bytes(); }

}  // namespace ductile
