// A structure and its world as a document. What a game may want to read or change has names: bodies, joints
// with their rows and states. What only the solver understands are its tapes of numbers (tape.h), which hold
// for `past` alone.
#include "ductile/save.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "structure.h"
#include "world_archive.h"

namespace ductile {

using namespace dynamics;

namespace {

constexpr int format = 1;  // changes where older readers would misread
constexpr int past = 30;   // changes with what the solver carries from step to step

void three(Archive& a, const char* key, double (&values)[3]) { a(key, values[0], values[1], values[2]); }

void tape(Archive& a, const char* key, const auto& keep) {
  std::vector<double> numbers;
  if (!a.reads()) {
    Tape writes;
    keep(writes);
    numbers = writes.numbers();
  }
  a(key, numbers);
  if (!a.reads()) return;
  Tape reads(std::move(numbers));
  keep(reads);
  if (!reads.fits()) a.refuse(key, "is not of this structure");
}

void fields(Archive& a, ElasticPlasticJointDef& d) {
  a("anchor_a", d.localAnchorA.x, d.localAnchorA.y);
  a("anchor_b", d.localAnchorB.x, d.localAnchorB.y);
  a("reference_angle", d.referenceAngle);
  a("axis_follow", d.axisFollow);
  a("line", d.line);
  a("length", d.length);
  std::size_t rows = 0;
  a.list("rows", 3, [&](Archive& each, std::size_t i) {
    if (++rows > 3) each.refuse("stiffness", "is of a fourth row");
    RowDef& r = d.rows[i];
    each("stiffness", r.stiffness);
    each("damping", r.damping_ratio, r.damping);
    each("caps", r.cap, r.cap_reverse);
    each("hardening", r.hardening);
    each("slackens", r.slackens);
    bool driven = r.drive.has_value();
    each("driven", driven);
    if (!driven) return;
    if (!r.drive) r.drive.emplace();
    each("drive", r.drive->target, r.drive->speed);
  });
  if (rows != 3) a.refuse("rows", "are " + std::to_string(rows) + "; must be 3");
  a("max", d.max_rotation, d.max_elongation, d.max_compression, d.max_slip);
  a.list("interaction", d.interaction.size(), [&](Archive& each, std::size_t i) {
    if (each.reads()) d.interaction.emplace_back();
    each("at", d.interaction[i].N, d.interaction[i].M);
  });
  if (a.reads() ? a.has("rate") : d.rate.has_value()) {
    if (!d.rate) d.rate.emplace();
    a("rate", d.rate->doubling[0], d.rate->doubling[1], d.rate->doubling[2], d.rate->exponent);
  }
  a("break_group", d.break_group);
  a("node", d.node);
  three(a, "elastic", d.state.elastic);
  three(a, "plastic", d.state.plastic);
  three(a, "forward", d.state.forward);
  three(a, "back", d.state.back);
  three(a, "dissipated", d.state.dissipated);
  a("yielded", d.state.yielded);
}

}  // namespace

class Structure::Impl::Save {
 public:
  Save(Impl& structure, Archive& document) : s_(structure), a_(document), world_(*structure.world) {}

  void run() {
    int version = format, of_past = past;
    a_("ductile", version);
    a_("past", of_past);
    if (version != format) a_.refuse("ductile", "is " + std::to_string(version) + "; this reads 1");
    knows_past_ = of_past == past;
    if (!a_.reads()) leave_unfit();
    const std::uint32_t next_id = settings();
    world_.settings(a_);
    world_.bodies(a_);
    world_.contacts(a_);
    for (const auto& m : s_.members) member_of_[m->joint] = m.get();
    a_.list("joints", world_.all_joints.size(), [&](Archive& each, std::size_t i) { joint(each, i); });
    if (a_.reads()) number(next_id);
    world_.motion(a_);
    if (knows_past_) components();
  }

 private:
  // Components whose bodies have changed since their last step will be formed anew before the next: they are
  // written as what they leave to their joints.
  void leave_unfit() {
    for (const auto& c : s_.island->components)
      if (!c->fits_bodies()) unfit_.insert(c.get());
  }

  std::uint32_t settings() {
    JointEnergy gone = s_.gone;
    for (const auto& c : s_.island->components)
      if (unfit_.contains(c.get())) add(gone, c->solver.energies());
    std::uint32_t next_id = s_.island->next_id;
    a_.object("structure", [&](Archive& a) {
      bool iterative = s_.def.solver == SolverKind::iterative;
      a("iterative", iterative);
      s_.def.solver = iterative ? SolverKind::iterative : SolverKind::direct;
      a("flow_share", s_.def.flow_share);
      a("keep_ledger", s_.def.keep_ledger);
      a("next_id", next_id);
      a("last_node", s_.nodes.last);
      a("energy", gone.dissipated, gone.damping, gone.numerical, gone.driven, gone.clamped, gone.contacts);
    });
    if (a_.reads()) s_.gone = gone;
    return next_id;
  }

  // Members stand in the order of their ids, which is not that of the world's joints where welds were
  // adopted.
  void number(std::uint32_t next_id) {
    std::vector<std::unique_ptr<Member>>& members = s_.members;
    std::sort(members.begin(), members.end(), [](const auto& m, const auto& n) { return m->id < n->id; });
    const auto twice = [](const auto& m, const auto& next) { return m->id == next->id; };
    if (std::adjacent_find(members.begin(), members.end(), twice) != members.end() ||
        (!members.empty() && members.back()->id >= next_id))
      a_.refuse("joints", "each must have an id of its own, below next_id");
    s_.island->next_id = next_id;
    std::transform(members.begin(), members.end(), s_.joints.begin(), [](const auto& m) { return m->joint; });
  }

  void joint(Archive& a, std::size_t i) {
    std::string type = "elastic_plastic";
    b2Joint* const there = a.reads() ? nullptr : world_.all_joints[i];
    const auto found = member_of_.find(there);
    Member* m = found != member_of_.end() ? found->second : nullptr;
    if (a.reads()) a("type", type);
    if (a.reads() ? type != "elastic_plastic" : m == nullptr) return world_.stock_joint(a, there);
    a("type", type);
    ElasticPlasticJointDef def;
    if (m != nullptr) def = m->joint->def();
    world_.body(a, "a", def.bodyA);
    world_.body(a, "b", def.bodyB);
    a("collide_connected", def.collideConnected);
    if constexpr (requires { def.userData.pointer; }) a("user", def.userData.pointer);
    fields(a, def);
    Turn axis = m != nullptr ? m->data().frame.axis : Turn{};
    a("axis", axis.c, axis.s);
    if (!(std::abs(std::hypot(axis.c, axis.s) - 1) < 1e-6)) a.refuse("axis", "must be of length 1");
    if (m == nullptr) m = &make(a, def, axis);
    a("id", m->id);
    a("told", m->said.used, m->said.energy);
    const bool unfit = unfit_.contains(m->component);
    bool alone = m->component == nullptr || unfit;
    a("alone", alone);  // in no component
    if (!alone || !knows_past_) return;
    Member left = *m;
    if (unfit) m->component->hand_back(left);
    tape(a, "past", [&](Tape& t) {
      t(left.own);
      if (t.reads()) dynamics::restore(left.own.joint, left.own.record);
    });
    if (a.reads()) *m = left;
  }

  Member& make(Archive& a, ElasticPlasticJointDef& def, const Turn& axis) {
    def.axisAngle = static_cast<float>(std::atan2(axis.s, axis.c));
    if (const auto wrong = s_.problems(def); !wrong.empty()) a.refuse("rows", wrong.front());
    ElasticPlasticJoint* joint = s_.join(world_.world(), def);
    world_.all_joints.push_back(joint);
    Member& m = *s_.members.back();
    m.own.joint.frame.axis = axis;
    return m;
  }

  void components() {
    std::vector<Component*> all;
    for (const auto& c : s_.island->components) {
      if (!unfit_.contains(c.get())) all.push_back(c.get());
    }
    a_.list("components", all.size(), [&](Archive& a, std::size_t i) {
      std::vector<std::uint32_t> ids;
      for (const Member* m : a.reads() ? Vector<Member*>{} : all[i]->members) ids.push_back(m->id);
      a("joints", ids);
      Guests guests = touching(a, a.reads() ? nullptr : all[i]);
      Component& c = a.reads() ? form(a, ids, guests) : *all[i];
      if (a.reads()) dismiss(c, guests.gone);
      tape(a, "past", [&](Tape& t) { c.keep(t); });
    });
  }

  /// A guest that is gone from the world: another body may stand at its address.
  struct Gone {
    b2Body* body;
    double mass, inertia;  // 0, 0: not free
  };
  struct Guests {
    std::vector<Gone> gone;
    std::vector<BodyPair> met;  // of them and of the world's bodies
    /// In the order of elimination: of a component that has changed since it was formed.
    std::vector<b2Body*> order;
  };

  // What touched when the component was formed. Guests that are no more keep their places in it, and are not
  // asked again: where it is read, bodies stand in for them while it is formed.
  Guests touching(Archive& a, const Component* c) {
    Guests guests;
    const std::vector<b2Body*>& known = world_.all_bodies;
    for (std::size_t i = 0; c != nullptr && i < c->mirrors.size(); ++i) {
      const Mirror& m = c->mirrors[i];
      if (!m.guest() || (std::count(known.begin(), known.end(), m.body) != 0 && m.fits())) continue;
      const Body& b = c->solver.bodies[i];
      const bool moves = i < c->solver.free_bodies();
      guests.gone.push_back({m.body, moves ? b.mass : 0, moves ? b.inertia : 0});
    }
    a.list("gone", guests.gone.size(), [&](Archive& each, std::size_t i) {
      if (each.reads()) guests.gone.emplace_back();
      Gone& g = guests.gone[i];
      each("mass", g.mass, g.inertia);
      if (!each.reads()) return;
      const b2MassData data{static_cast<float>(g.mass), {0, 0}, static_cast<float>(g.inertia)};
      if (!(data.mass >= 0 && data.I >= 0 && std::isfinite(data.mass) && std::isfinite(data.I)) ||
          (data.mass > 0) != (g.mass > 0) || (data.I > 0) != (g.inertia > 0))
        each.refuse("mass", "must be a mass and an inertia >= 0");
      b2BodyDef def;
      def.type = g.mass > 0 ? b2_dynamicBody : b2_staticBody;
      g.body = world_.world().CreateBody(&def);
      g.body->SetMassData(&data);
    });
    std::vector<b2Body*> all = known;
    for (const Gone& g : guests.gone) all.push_back(g.body);
    // From the back: a guest that is gone has the address of a body that is there.
    const auto number_of = [&all](const b2Body* body) {
      return static_cast<std::uint32_t>(all.rend() - std::find(all.rbegin(), all.rend(), body) - 1);
    };
    std::vector<std::uint32_t> met, order;
    if (c != nullptr) {
      for (const BodyPair& pair : c->met) met.push_back(number_of(pair.a)), met.push_back(number_of(pair.b));
      for (const Mirror& m : c->is_worn() ? c->mirrors : Vector<Mirror>{}) order.push_back(number_of(m.body));
    }
    a("met", met);
    a("order", order);
    for (std::size_t k = 0; a.reads() && k + 1 < met.size(); k += 2) {
      if (met[k] == met[k + 1] || std::max(met[k], met[k + 1]) >= all.size())
        a.refuse("met", "must be pairs of bodies");
      guests.met.push_back({all[met[k]], all[met[k + 1]]});
    }
    for (const std::uint32_t number : a.reads() ? order : std::vector<std::uint32_t>{}) {
      if (number >= all.size()) a.refuse("order", "must be of bodies");
      guests.order.push_back(all[number]);
    }
    return guests;
  }

  // The component keeps addresses of what stood in, and masses as they were, which floats may not hold.
  void dismiss(Component& c, const std::vector<Gone>& gone) {
    for (const Gone& g : gone) {
      const auto mirror =
          std::find_if(c.mirrors.begin(), c.mirrors.end(), [&](const Mirror& m) { return m.body == g.body; });
      if (mirror != c.mirrors.end() && g.mass > 0)
        c.solver.bodies[static_cast<std::size_t>(mirror - c.mirrors.begin())].inertia = g.inertia;
      world_.world().DestroyBody(g.body);
    }
    if (!gone.empty()) c.solver.form(c.solver.free_bodies());
  }

  Component& form(Archive& a, const std::vector<std::uint32_t>& ids, const Guests& guests) {
    std::vector<Member*> members;
    for (const std::uint32_t id : ids) {
      Member* found = s_.find(id);
      if (found == nullptr || found->component != nullptr) a.refuse("joints", "names a joint twice, or none");
      members.push_back(found);
    }
    if (members.empty()) a.refuse("joints", "are none");
    if (!guests.order.empty()) {
      std::vector<b2Body*> bodies, ordered = guests.order;
      for (const Member* m : members)
        bodies.push_back(m->joint->GetBodyA()), bodies.push_back(m->joint->GetBodyB());
      for (const BodyPair& pair : guests.met) bodies.push_back(pair.a), bodies.push_back(pair.b);
      std::sort(bodies.begin(), bodies.end());
      bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
      std::sort(ordered.begin(), ordered.end());
      if (ordered != bodies || !std::is_partitioned(guests.order.begin(), guests.order.end(), is_free))
        a.refuse("order", "must be of the component's bodies, those first that joints move");
    }
    return s_.island->form(members, guests.met, guests.order);
  }

  Impl& s_;
  Archive& a_;
  WorldArchive world_;
  std::unordered_map<const b2Joint*, Member*> member_of_;
  std::unordered_set<const Component*> unfit_;
  bool knows_past_ = true;
};

void Structure::Impl::clear() {
  // Components that were read half have lists that do not fit each other: no joint can be taken out of one.
  island->discard();
  for (std::uint32_t i = 0; i < members.size(); ++i) members[i]->id = i;  // some may stand in no order
  WorldArchive::clear(*world);
  nodes.orphans.clear();
  gone = {};
}

namespace {

Structure::Impl& impl_of(const Structure& structure) {
  b2World* world = structure.world();
  if (world == nullptr)
    throw std::logic_error("save: the structure's world is gone, or all its bodies; make a new structure");
  if (world->IsLocked()) throw std::logic_error("save: the world is stepping; save and load between steps");
  const auto all = structures_in(*world);
  if (all.size() != 1) throw std::logic_error("save: the world has several structures; make one per world");
  return *all.front();
}

Archive::Json written(const Structure& structure) {
  Structure::Impl& impl = impl_of(structure);
  if (!impl.delivered_all())
    throw std::logic_error("save: call Structure::update() after the step, then save");
  Archive::Json document;
  Archive archive(document, false);
  Structure::Impl::Save(impl, archive).run();
  return document;
}

void read(Structure& structure, Archive::Json document) {
  Structure::Impl& impl = impl_of(structure);
  b2World& world = *impl.world;
  if (world.GetBodyCount() > 1 || world.GetJointCount() > 0)
    throw std::logic_error("save: the world has bodies; load into one that has none");
  const StructureDef before = impl.def;
  const JointEnergy gone = impl.gone;
  const int last_node = impl.nodes.last;
  Archive::Json settings;
  Archive kept(settings, false);
  WorldArchive(world).settings(kept);
  Archive archive(document, true);
  try {
    Structure::Impl::Save(impl, archive).run();
  } catch (...) {
    impl.clear();
    impl.def = before;
    impl.gone = gone;
    impl.nodes.last = last_node;
    Archive back(settings, true);
    WorldArchive(world).settings(back);
    throw;
  }
}

}  // namespace

std::vector<std::uint8_t> save_bytes(const Structure& structure) {
  return Archive::Json::to_cbor(written(structure));
}

std::string save_json(const Structure& structure) { return written(structure).dump(); }

void load_bytes(Structure& structure, std::span<const std::uint8_t> bytes) {
  Archive::Json document;
  try {
    document = Archive::Json::from_cbor(bytes.begin(), bytes.end());
  } catch (const Archive::Json::exception&) {  // also of what promises more entries than there is memory
    throw std::invalid_argument("save: these bytes are no CBOR, or not all of it");
  }
  read(structure, std::move(document));
}

void load_json(Structure& structure, std::string_view text) {
  Archive::Json document = Archive::Json::parse(text.begin(), text.end(), nullptr, false);
  if (document.is_discarded()) throw std::invalid_argument("save: the text is no JSON, or not all of it");
  read(structure, std::move(document));
}

}  // namespace ductile
