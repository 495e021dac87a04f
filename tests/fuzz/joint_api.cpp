// A game that does as it likes: the input is a program of operations on a world and its structure. Whatever
// it is, nothing becomes NaN, no solve ends at its bound, and where nobody puts energy in, none appears.
#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "ductile/joint.h"
#include "fuzz.h"

namespace ductile {
namespace {

/// The program, byte by byte; zeros when it is over.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}
  bool over() const { return data_ == end_; }
  unsigned next() { return over() ? 0 : *data_++; }
  bool flag() { return (next() & 1u) != 0; }
  int below(int n) { return static_cast<int>(next()) % n; }
  /// From −1 to 1, 0 among them.
  double share() { return (static_cast<double>(next()) - 128) / 128; }
  /// 10^low … 10^high
  double scale(double low, double high) { return std::pow(10, low + (high - low) * next() / 255.0); }

 private:
  const std::uint8_t *data_, *end_;
};

/// The energy that there may be, as steps of some length see it: velocities are means of a step, and a long
/// one sees less of a fast vibration. What it saw is no bound for a shorter one.
class Budget {
 public:
  void add(double energy) {
    for (double& most : most_) most += energy;
  }
  void set(double energy) { most_.fill(energy); }
  void lower(float dt, double to) {
    double& most = most_[place(dt)];
    most = std::min(most, to);
  }
  void raise(double to) {
    for (double& most : most_) most = std::max(most, to);
  }
  double in(float dt) const { return *std::min_element(most_.begin(), most_.begin() + place(dt) + 1); }

 private:
  static std::ptrdiff_t place(float dt) {
    return std::lower_bound(lengths.begin(), lengths.end() - 1, dt) - lengths.begin();
  }
  static constexpr std::array<float, 5> lengths{1.0f / 5000, 1.0f / 1000, 1.0f / 240, 1.0f / 60, 1.0f / 15};
  std::array<double, 5> most_{};
};

class Game : b2DestructionListener {
 public:
  explicit Game(const std::uint8_t* data, std::size_t size) : in_(data, size) {
    const unsigned setup = in_.next();
    // Judged: no gravity, no contacts, nothing that moves by itself. Then energy cannot grow.
    judged_ = (setup & 1u) != 0;
    if (!judged_) {
      const float gravities[] = {10, 10, 0, 1e4f};
      world_->SetGravity({0, -gravities[setup >> 1 & 3u]});
    }
    world_->SetAllowSleeping((setup & 8u) != 0);
    world_->SetContinuousPhysics((setup & 16u) == 0);
    def_.keep_ledger = true;
    if ((setup & 32u) != 0 && !judged_) {
      def_.solver = SolverKind::iterative;
      world_->SetGravity({0, -10});
    }
    const double sizes[] = {1, 1, 0.05, 50}, places[] = {0, 0, 1e3, 1e5};
    size_ = sizes[setup >> 6];
    place_ = places[in_.below(4)];
    world_->SetDestructionListener(this);
    make_structure();
  }

  void play() {
    for (int operations = 0; !in_.over() && operations < 200; ++operations) operate();
    step();
    step();
    if (in_.flag()) world_.reset();
  }

 private:
  void SayGoodbye(b2Joint* joint) override { std::erase(stock_, joint); }
  void SayGoodbye(b2Fixture*) override {}

  void make_structure() {
    structure_.emplace(*world_, def_);
    structure_->on_event([this](const JointEvent& event) { happened(event); });
    structure_->may_break([this](const ElasticPlasticJoint& joint) {
      require(joint.capacity_used() > 1, "only what is exceeded may break");
      return !veto_;
    });
  }

  b2Body* body() {
    return bodies_.empty() ? nullptr : bodies_[static_cast<std::size_t>(in_.below(64)) % bodies_.size()];
  }
  ElasticPlasticJoint* joint() {
    const auto all = structure_->joints();
    return all.empty() ? nullptr : all[static_cast<std::size_t>(in_.below(64)) % all.size()];
  }

  void operate() {
    const double before = kinetic();
    const unsigned code = in_.next();
    if (code == 240) {
      snapshot_.save(*world_);
      saved_ = {bodies_, stock_, budget_, most_, turn_, unheld_, last_dt_, drift_time_};
      return;
    }
    if (code == 243) return go_back();
    switch (code % 24) {
      case 0:
        make_body();
        break;
      case 1:
      case 2:
        if (body() != nullptr) {
          b2Body *a = body(), *b = body();
          make_joint(a, b);
        }
        break;
      case 3:
        make_chain(1 + in_.below(8));
        break;
      case 4:
      case 5:
      case 6:
      case 7:
        for (int n = 1 + in_.below(16); n > 0; --n) step();
        return;
      case 8:
        change_type(body());
        break;
      case 9:
        if (b2Body* b = body()) b->SetEnabled(!b->IsEnabled());
        break;
      case 10:
        move(body());
        break;
      case 11:
        if (b2Body* b = body()) {
          const double fast = in_.scale(-3, 3) * size_;
          b->SetLinearVelocity(Vec{fast * in_.share(), fast * in_.share()});
          const double turn = in_.scale(-3, 2);
          b->SetAngularVelocity(static_cast<float>(turn * in_.share()));
        }
        break;
      case 12:
        world_->ShiftOrigin(Vec{place_ * in_.share(), size_ * 100 * in_.share()});
        break;
      case 13:
        if (b2Body* b = body()) {
          std::erase(bodies_, b);
          world_->DestroyBody(b);
        }
        break;
      case 14:
        if (ElasticPlasticJoint* j = joint()) world_->DestroyJoint(j);
        break;
      case 15:
        change_fixtures(body());
        break;
      case 16:
        if (ElasticPlasticJoint* j = joint()) change_joint(*j);
        break;
      case 17:
        make_stock_joint();
        break;
      case 18:
        change_mass(body());
        break;
      case 19:
        structure_.reset();
        forgive();
        make_structure();
        break;
      case 20:
        adopt_welds();
        break;
      case 21:
        if (b2Body* b = body(); b && !judged_) {
          b->ApplyForceToCenter(Vec{share_of(0, 8), share_of(0, 8)}, true);
          b->ApplyTorque(static_cast<float>(share_of(0, 8)), true);
        }
        break;
      case 22:
        mischief_ = in_.below(8);
        veto_ = in_.flag();
        break;
      default:
        if (b2Body* b = body()) {
          b->SetAwake(in_.flag());
          b->SetBullet(in_.flag());
          world_->SetSubStepping(in_.flag());
          world_->SetWarmStarting(in_.flag());
        }
        break;
    }
    if (judged_) stop_drives();
    budget_.add(std::max(0.0, kinetic() - before));
  }

  /// What moves and cannot be slowed down would drive what hangs on it.
  void stop_drives() {
    for (b2Body* b : bodies_) {
      if (!holds(*b)) continue;
      b->SetAngularVelocity(0);
      if (b->GetType() != b2_dynamicBody || b->GetMass() == 0) b->SetLinearVelocity({0, 0});
    }
  }

  /// Every compiler reads the numbers in its braces from left to right; GCC reads a function's arguments from
  /// the right.
  struct Vec {
    double x, y;
    operator b2Vec2() const { return {static_cast<float>(x), static_cast<float>(y)}; }
  };

  b2Body* make_body(const b2Vec2* at = nullptr) {
    if (bodies_.size() >= 24) return nullptr;
    b2BodyDef def;
    const b2BodyType types[] = {b2_dynamicBody, b2_dynamicBody, b2_dynamicBody, b2_staticBody,
                                b2_kinematicBody};
    def.type = types[in_.below(5)];
    def.position = at ? *at : Vec{place_ + 8 * size_ * in_.share(), 8 * size_ * in_.share()};
    def.angle = static_cast<float>(in_.share() * 2 * std::numbers::pi);
    const unsigned how = in_.next();
    def.fixedRotation = (how & 7u) == 7;
    def.bullet = (how & 8u) != 0;
    def.enabled = (how & 0xf0u) != 0xf0;
    if (def.type == b2_kinematicBody && !judged_) {
      def.linearVelocity = Vec{size_ * 4 * in_.share(), size_ * 4 * in_.share()};
      def.angularVelocity = static_cast<float>(in_.share());
    }
    b2Body* b = world_->CreateBody(&def);
    bodies_.push_back(b);
    const double wide = size_ * in_.scale(-0.5, 0.5), high = size_ * in_.scale(-0.5, 0.5);
    add_fixture(b, wide, high);
    set_mass(b, some_mass(), wide, high);
    return b;
  }

  void add_fixture(b2Body* b, double wide, double high) {
    if (size_ < 0.1) return;  // Box2D's polygons cannot be so small
    b2PolygonShape box;
    box.SetAsBox(static_cast<float>(wide / 2), static_cast<float>(high / 2));
    b2CircleShape disc;
    disc.m_radius = static_cast<float>(wide / 2);
    b2FixtureDef def;
    def.shape = in_.flag() ? static_cast<const b2Shape*>(&disc) : &box;
    def.density = in_.flag() ? 1 : 0;
    def.friction = in_.flag() ? 0.6f : 0;
    def.filter.groupIndex = judged_ || in_.flag() ? -1 : 0;
    b->CreateFixture(&def);
  }

  double share_of(double low, double high) {
    const double share = in_.share();
    return share * in_.scale(low, high);
  }
  /// Joint by joint only pieces that are about as heavy as each other hold together.
  double some_mass() { return iterative() ? in_.scale(2, 3) : in_.scale(0, 6); }
  bool iterative() const { return def_.solver == SolverKind::iterative; }

  void set_mass(b2Body* b, double mass, double wide, double high) {
    const double inertia = mass * (wide * wide + high * high) / 12;
    const double x = wide * in_.share() / 4, y = high * in_.share() / 4;
    const b2MassData data{static_cast<float>(mass), Vec{x, y},
                          static_cast<float>(inertia + mass * (x * x + y * y))};
    b->SetMassData(&data);
  }

  RowDef row(double strong, double stiff) {
    RowDef row;
    const unsigned how = in_.next();
    if ((how & 3u) == 0) return row;
    if ((how & 3u) == 1) return RowDef::free();
    if ((how & 4u) != 0) row.stiffness = stiff * in_.scale(-8, 8);
    if ((how & 8u) != 0) row.damping_ratio = in_.scale(-3, 2);
    if ((how & 16u) != 0) row.cap = strong * in_.scale(-6, 3);
    row.cap_reverse = (how & 32u) != 0 ? strong * in_.scale(-6, 3) : row.cap;
    if ((how & 0xc0u) == 0xc0) {
      row.hardening = (std::isinf(row.stiffness) ? stiff : row.stiffness) * in_.scale(-8, -0.1);
    }
    return row;
  }

  void make_joint(b2Body* a, b2Body* b) {
    if (a == b || structure_->joints().size() >= 40) return;
    // On arms of kilometres the effective mass of a row is nothing, and what no row can hold is not judged.
    if (judged_ && apart(*a, *b) > 100) return;
    ElasticPlasticJointDef def;
    const double out = in_.flag() ? 0.5 : 3;
    const b2Vec2 between = 0.5f * (a->GetWorldCenter() + b->GetWorldCenter());
    const Vec from{out * size_ * in_.share(), out * size_ * in_.share()};
    const Vec axis{in_.share() + 1.01, in_.share()};
    def.Initialize(a, b, between + from, axis);
    // As strong as to carry so many kilograms over its length.
    const double strong = 1e5, stiff = 1e9;
    def.rows[axial] = row(strong, stiff);
    def.rows[shear] = row(strong, stiff);
    def.rows[rotation] = row(strong * size_, stiff * size_ * size_);
    const unsigned how = in_.next();
    if ((how & 1u) != 0) def.max_rotation = in_.scale(-3, 1);
    if ((how & 2u) != 0) def.max_elongation = def.max_compression = size_ * in_.scale(-3, 1);
    if ((how & 4u) != 0) def.max_slip = size_ * in_.scale(-3, 1);
    if ((how & 8u) != 0) def.break_group = 1 + in_.below(3);
    if ((how & 48u) == 16) def.axisFollow = 0;
    if ((how & 48u) == 32) def.axisFollow = 1;
    def.collideConnected = (how & 64u) != 0;
    if ((how & 128u) != 0) {
      const double N = strong * in_.scale(-3, 2), M = N * size_ * in_.scale(-1, 1);
      // A struck surface of few facets, seen as a needle, can need more rounds than there are.
      curved_ = true;
      def.interaction = {{N, 0}, {0.3 * N, M}, {-N, 0}, {0.2 * N, -M}};
    }
    try {
      structure_->create_joint(def);
    } catch (const std::invalid_argument&) {
      require(!def.interaction.empty() || def.rows[0].hardening > 0 || def.rows[1].hardening > 0 ||
                  def.rows[2].hardening > 0,
              "a joint that is right is taken");
    }
  }

  void make_chain(int pieces) {
    b2Body* last = body();
    for (int i = 0; i < pieces; ++i) {
      const b2Vec2 at = last ? last->GetWorldCenter() + Vec{size_, 0} : b2Vec2(Vec{place_, 0});
      b2Body* next = make_body(&at);
      if (!next) return;
      if (last) make_joint(last, next);
      last = next;
    }
  }

  void change_type(b2Body* b) {
    if (!b) return;
    const b2BodyType types[] = {b2_staticBody, b2_kinematicBody, b2_dynamicBody};
    const b2BodyType type = types[in_.below(3)];
    b->SetType(type);
    if (type == b2_dynamicBody) set_mass(b, some_mass(), size_, size_);
  }

  void move(b2Body* b) {
    if (!b) return;
    moved_ |= holds(*b);
    const double far = in_.scale(-4, 0) * size_;
    const Vec by{far * in_.share(), far * in_.share()};
    b->SetTransform(b->GetPosition() + by, b->GetAngle() + static_cast<float>(share_of(-4, 0.5)));
  }

  void change_fixtures(b2Body* b) {
    if (!b) return;
    if (in_.flag() && b->GetFixtureList()) {
      b->DestroyFixture(b->GetFixtureList());
    } else {
      int count = 0;
      for (const b2Fixture* f = b->GetFixtureList(); f; f = f->GetNext()) ++count;
      if (count >= 3) return;
      const Vec size{size_ * in_.scale(-0.5, 0.5), size_ * in_.scale(-0.5, 0.5)};
      add_fixture(b, size.x, size.y);
    }
  }

  void change_mass(b2Body* b) {
    if (!b) return;
    switch (in_.below(3)) {
      case 0:
        b->SetFixedRotation(!b->IsFixedRotation());
        break;
      case 1:
        b->ResetMassData();
        break;
      default:
        set_mass(b, some_mass(), size_, size_);
        break;
    }
  }

  void change_joint(ElasticPlasticJoint& j) {
    const Row which = static_cast<Row>(in_.below(3));
    const int what = in_.below(3);
    try {
      change(j, which, what);
    } catch (const std::invalid_argument&) {  // softer than it hardens
    }
  }

  void change(ElasticPlasticJoint& j, Row which, int what) {
    if (what == 0) {
      const double caps[] = {in_.scale(-3, 9), in_.scale(-3, 9)};
      j.set_caps(which, caps[0], caps[1]);
    } else if (what == 1) {
      const double spring[] = {in_.flag() ? rigid : in_.scale(0, 15), in_.scale(-3, 2)};
      j.set_stiffness(which, spring[0], spring[1]);
    } else {
      const double limits[] = {in_.scale(-3, 1), in_.scale(-3, 1), in_.scale(-3, 1), in_.scale(-3, 1)};
      j.set_limits(limits[0], limits[1], limits[2], limits[3]);
    }
  }

  void make_stock_joint() {
    b2Body *a = body(), *b = body();
    // Box2D's joints fling pieces on long arms about by themselves, which sweeps joint by joint do not hold
    // back.
    if (judged_ || iterative() || !a || !b || a == b || stock_.size() >= 8) return;
    if (!bears(*a, *b)) return;
    const b2Vec2 at = b->GetWorldCenter();
    b2RevoluteJointDef pin;
    pin.Initialize(a, b, at);
    b2DistanceJointDef rope;
    rope.Initialize(a, b, a->GetWorldCenter(), at);
    b2WeldJointDef weld;
    weld.Initialize(a, b, at);
    b2MouseJointDef mouse;
    mouse.bodyA = a, mouse.bodyB = b, mouse.target = at + Vec{size_, size_};
    mouse.maxForce = 1e5f, mouse.stiffness = 1e4f, mouse.damping = 1e3f;
    const b2JointDef* defs[] = {&pin, &rope, &weld, &mouse};
    const int kind = in_.below(4);
    if (kind == 3 && b->GetType() != b2_dynamicBody) return;
    stock_.push_back(world_->CreateJoint(defs[kind]));
  }

  void adopt_welds() {
    for (std::size_t i = stock_.size(); i-- > 0;) {
      if (stock_[i]->GetType() != e_weldJoint) continue;
      ElasticPlasticJointDef def;
      def.rows[rotation].cap = def.rows[rotation].cap_reverse = in_.scale(0, 8);
      structure_->adopt(static_cast<b2WeldJoint*>(stock_[i]), def);
      stock_.erase(stock_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void go_back() {
    try {
      snapshot_.restore(*world_);
    } catch (const std::logic_error&) {
      return;  // nothing was saved, or the structure is another one
    }
    bodies_ = saved_.bodies;
    stock_ = saved_.stock;
    budget_ = saved_.budget, most_ = saved_.most, turn_ = saved_.turn;
    unheld_ = saved_.unheld, last_dt_ = saved_.last_dt, drift_time_ = saved_.drift_time;
  }

  void happened(const JointEvent& event) {
    require(event.joint != nullptr, "an event is about a joint");
    require_finite({event.force, event.energy}, "event");
    b2Body *a = event.joint->GetBodyA(), *b = event.joint->GetBodyB();
    switch (mischief_) {
      case 1:
        world_->DestroyJoint(event.joint);
        break;
      case 2:
        std::erase(bodies_, b);
        world_->DestroyBody(b);
        break;
      case 3:
        for (b2Body* each : std::exchange(bodies_, {})) world_->DestroyBody(each);
        break;
      case 4:
        make_joint(a, b);
        break;
      case 5:
        try {
          event.joint->set_caps(rotation, unlimited, unlimited);
        } catch (const std::invalid_argument&) {
          require(curved_, "only those of an interaction curve are refused");
        }
        break;
      case 6:
        a->SetType(b2_staticBody);
        break;
      default:
        break;
    }
  }

  void step() {
    if (++steps_ > 400) return;
    const float lengths[] = {1.0f / 60,  1.0f / 60,   1.0f / 60,   1.0f / 15,
                             1.0f / 240, 1.0f / 1000, 1.0f / 5000, 0};
    const unsigned how = in_.next();
    const float dt = lengths[how & 7u];
    const int velocity = (how & 0x38u) == 0x38 ? 0 : 8, position = (how & 0xc0u) == 0xc0 ? 0 : 3;
    // Without iterations of velocities nothing holds: what parts then comes back in the next step, as fast as
    // that is short.
    const bool held = !std::exchange(unheld_, velocity == 0 && dt > 0);
    drop_stock_joints([this](b2Joint& j) { return !bears(*j.GetBodyA(), *j.GetBodyB()); });
    const JointEnergy start = structure_->energy();
    const double moving = kinetic_of_pieces();
    const auto awake = count_awake();
    const bool was_far = far();
    world_->Step(dt, velocity, position);
    const double lost = moving - kinetic_of_pieces();
    const bool seen = velocity > 0 && count_awake() == awake;  // Box2D stops what falls asleep
    // Pieces that are thrown about by hand may come to where no pose keeps all gaps.
    const StepReport& report = structure_->report();
    const bool whole = report.divided == 0;
    require(report.bounds_hit == report.parted || curved_ || impossible() || was_far || far(),
            "solves end in time");
    for (const b2Body* b : bodies_) {
      require_finite({b->GetPosition().x, b->GetPosition().y, b->GetAngle(), b->GetLinearVelocity().x,
                      b->GetLinearVelocity().y, b->GetAngularVelocity()},
                     "body");
    }
    for (const ElasticPlasticJoint* j : structure_->joints()) {
      for (const Row which : {axial, shear, rotation}) {
        require_finite({j->force(which), j->elastic(which), j->plastic(which)}, "row");
      }
      require_finite({j->accumulated_rotation(), j->slip(), j->dissipated(), j->elastic_energy(), j->axis().x,
                      j->GetReactionForce(60).x, j->GetReactionTorque(60)},
                     "joint");
      require(j->dissipated() >= 0, "plastic work is never negative");
    }
    structure_->update();
    const JointEnergy e = structure_->energy();
    require_finite({e.elastic, e.dissipated, e.damping, e.numerical, e.clamped}, "ledger");
    if (!judged_) return;

    // Rounding: of all that ever was, and of the gaps that a push leaves, 3e-7 sizes, which are closed in a
    // step, in the shortest the fastest.
    double mass = 0;
    for (const b2Body* b : bodies_) mass += b->GetMass();
    heaviest_ = std::max(heaviest_, mass);
    if (dt > 0) shortest_ = std::min(shortest_, static_cast<double>(dt));
    const double budget = budget_.in(dt);
    most_ = std::max(most_, budget);
    const double left = 3e-7 * size_ / shortest_, rounding = 1e-7 * most_ + heaviest_ * left * left;

    // What limits of speed take of a velocity may be far more than they leave of it, which is rounded to
    // floats: so is its share in the work.
    const double clamped = e.clamped - start.clamped, in_floats = 0x1p-23 * std::abs(clamped);
    const double booked = (e.elastic - start.elastic) + (e.dissipated - start.dissipated) +
                          (e.damping - start.damping) + (e.numerical - start.numerical) + clamped -
                          (e.driven - start.driven);
    require(!seen || std::abs(lost - booked) <= 1e-5 * moving + in_floats + rounding,
            "what pieces lose is booked");

    // What turning bodies part by along their tangents is taken back later: energy to second order in the
    // angle of a step, the more so on long arms. Beyond a third of a radian it is not judged.
    turn_ = std::max(turn_, turn_in(dt));
    const double now = kinetic() + e.elastic;
    // Velocities are those of the step's middle, strains those of its end, where turning has stretched them
    // to second order: kinetic energy alone is held to what there was.
    require(turn_ > 0.3 || !held || kinetic() <= budget * (1 + 1e-4 + 20 * turn_ * turn_) + rounding,
            "no energy from nowhere");
    // While the speed limit keeps a gap from closing, what it takes comes back with the gap. After a step of
    // another length velocities are as old as half of both, and strains are not: what is too little of a
    // vibration then comes back, too, as less than nothing that the method takes. What a longer step leaves
    // of drift does so in as much time as that took. A step of no length brings them no closer. So it is
    // after one in parts, of which velocities are the mean, and strains the end.
    const bool drifts = dt < drift_time_;
    if (dt > 0) drift_time_ = std::max(dt, drift_time_ - dt);
    const bool of_one_time =
        dt > 0 && std::exchange(last_dt_, dt) == dt && !drifts && whole && e.numerical >= start.numerical;
    if (report.slowed == 0 && (of_one_time || !held)) held ? budget_.lower(dt, now) : budget_.raise(now);
  }

  /// The angle, rad, by which a body turns in a step against the world or a body that it is joined to, times
  /// the square root of its longest lever: 1 + (arm/radius of gyration)², in units of the 4 of a rod held at
  /// its end.
  double turn_in(float dt) const {
    double turn = 0, lever = 4;
    for (const b2Body* b : bodies_) turn = std::max(turn, double{dt} * std::abs(b->GetAngularVelocity()));
    for (ElasticPlasticJoint* j : structure_->joints()) {
      const b2Body *a = j->GetBodyA(), *b = j->GetBodyB();
      turn = std::max(turn, double{dt} * std::abs(b->GetAngularVelocity() - a->GetAngularVelocity()));
      for (const auto& [body, anchor] : {std::pair{a, j->GetAnchorA()}, std::pair{b, j->GetAnchorB()}}) {
        const double inertia = central_inertia(*body);
        const float r = b2Distance(anchor, body->GetWorldCenter());
        if (inertia > 0) lever = std::max(lever, 1 + double{body->GetMass()} * r * r / inertia);
      }
    }
    return turn * std::sqrt(lever / 4);
  }

  /// Welds of a structure that is gone are Box2D's, whose energy is not ours to judge.
  void forgive() {
    stock_.clear();
    for (b2Joint* j = world_->GetJointList(); j; j = j->GetNext()) stock_.push_back(j);
    drop_stock_joints([this](b2Joint&) { return judged_; });
    if (judged_) budget_.set(kinetic());
  }

  template <class Which>
  void drop_stock_joints(Which&& which) {
    std::vector<b2Joint*> dropped;
    std::copy_if(stock_.begin(), stock_.end(), std::back_inserter(dropped),
                 [&](b2Joint* j) { return which(*j); });
    for (b2Joint* j : dropped) {
      std::erase(stock_, j);
      world_->DestroyJoint(j);
    }
  }

  /// Over long arms Box2D's own joints fling what they hold about until nothing is finite.
  bool bears(const b2Body& a, const b2Body& b) const { return apart(a, b) < 4; }

  /// In sizes.
  double apart(const b2Body& a, const b2Vec2& b) const { return b2Distance(a.GetWorldCenter(), b) / size_; }
  double apart(const b2Body& a, const b2Body& b) const { return apart(a, b.GetWorldCenter()); }

  /// Not the structure's to move.
  static bool holds(const b2Body& b) {
    return b.GetType() != b2_dynamicBody || b.GetMass() == 0 || b.IsFixedRotation();
  }

  /// What is held at several places that part cannot keep together.
  bool impossible() const {
    int held = 0;
    bool moving = moved_;
    for (const b2Body* b : bodies_) {
      if (b->GetJointList() == nullptr || !holds(*b)) continue;
      ++held;
      moving |= b->GetType() == b2_kinematicBody &&
                (b->GetLinearVelocity().LengthSquared() > 0 || b->GetAngularVelocity() != 0);
    }
    return held > 1 && moving;
  }

  /// Joints reach so far that rounding of what turns is as fast as anything else; or were thrown so far apart
  /// that their forces at the arms that they have now are beyond double precision; or are where the floats of
  /// Box2D's poses are a hundredth of a size apart, and part them by that in each step.
  bool far() const {
    return std::any_of(
        structure_->joints().begin(), structure_->joints().end(), [this](ElasticPlasticJoint* j) {
          return 6e-8f * j->GetAnchorA().Length() > 0.01 * size_ ||
                 std::max(apart(*j->GetBodyA(), j->GetAnchorA()), apart(*j->GetBodyB(), j->GetAnchorB())) >
                     1000 ||
                 b2Distance(j->GetAnchorA(), j->GetAnchorB()) > 30 * size_;
        });
  }

  static double central_inertia(const b2Body& b) {
    return double{b.GetInertia()} - double{b.GetMass()} * b.GetLocalCenter().LengthSquared();
  }

  static double kinetic(const b2Body& b) {
    if (b.GetType() != b2_dynamicBody || !b.IsEnabled()) return 0;
    return (double{b.GetMass()} * b.GetLinearVelocity().LengthSquared() +
            central_inertia(b) * b.GetAngularVelocity() * b.GetAngularVelocity()) /
           2;
  }
  double kinetic() const {
    double sum = 0;
    for (const b2Body* b : bodies_) sum += kinetic(*b);
    return sum;
  }
  /// Does a joint hold it in this step?
  static bool is_piece(const b2Body& b) {
    for (const b2JointEdge* edge = b.GetJointList(); edge != nullptr; edge = edge->next)
      if (edge->other->IsEnabled()) return true;
    return false;
  }
  double kinetic_of_pieces() const {
    double sum = 0;
    for (const b2Body* b : bodies_) sum += is_piece(*b) ? kinetic(*b) : 0;
    return sum;
  }

  std::ptrdiff_t count_awake() const {
    return std::count_if(bodies_.begin(), bodies_.end(), [](const b2Body* b) { return b->IsAwake(); });
  }

  Bytes in_;
  bool judged_ = false, veto_ = false;
  bool curved_ = false;   // some joint has a yield surface
  bool unheld_ = false;   // in the last step, by request
  float last_dt_ = 0;     // s
  float drift_time_ = 0;  // s, in which what a longer step has left is taken back
  bool moved_ = false;    // a body that holds others, by hand
  int mischief_ = 0, steps_ = 0;
  double size_ = 1, place_ = 0;
  Budget budget_;
  double most_ = 0;      // J that there ever might be
  double shortest_ = 1;  // s, of all steps
  double heaviest_ = 0;  // kg, all bodies together, ever
  double turn_ = 0;      // rad, the most of a step
  Snapshot snapshot_;
  struct {
    std::vector<b2Body*> bodies;
    std::vector<b2Joint*> stock;
    Budget budget;
    double most = 0, turn = 0;
    bool unheld = false;
    float last_dt = 0, drift_time = 0;
  } saved_;
  StructureDef def_;
  std::unique_ptr<b2World> world_ = std::make_unique<b2World>(b2Vec2{0, 0});
  std::vector<b2Body*> bodies_;
  std::vector<b2Joint*> stock_;
  std::optional<Structure> structure_;  // goes before the world, where play() does not turn that around
};

}  // namespace
}  // namespace ductile

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ductile::Game(data, size).play();
  return 0;
}
