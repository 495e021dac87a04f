// A plan as bodies, fixtures and joints of a b2World.
#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>
#include <variant>
#include <vector>

#include "areas.h"
#include "ductile/box2d.h"
#include "ductile/plane.h"

namespace ductile {
using namespace calibration;

namespace {

// Negative collision groups that nothing in the world or the plan uses yet.
class FreshGroups {
 public:
  FreshGroups(b2World& world, const Plan& plan) {
    for (const BodyDef& body : plan.bodies) use(body.group);
    for (b2Body* body = world.GetBodyList(); body; body = body->GetNext())
      for (b2Fixture* fixture = body->GetFixtureList(); fixture; fixture = fixture->GetNext())
        use(fixture->GetFilterData().groupIndex);
  }
  int16 next() {
    if (lowest_ == std::numeric_limits<int16>::min())
      throw InvalidInput({{"world", "has no collision group left", "give split bodies groups of their own"}});
    return --lowest_;
  }

 private:
  void use(int group) { lowest_ = static_cast<int16>(std::min<int>(lowest_, group)); }
  int16 lowest_ = 0;
};

// Bodies that hold together at nodes, where they overlap: by body, the first of those it is with.
std::vector<int> node_mates(const Plan& plan) {
  std::vector<int> mate(plan.bodies.size());
  std::iota(mate.begin(), mate.end(), 0);
  const auto first = [&](int body) {
    while (mate[body] != body) body = mate[body];
    return body;
  };
  std::map<int, int> of_node;
  for (const PlannedJoint& j : plan.joints) {
    if (j.node == 0) continue;
    for (const int piece : {j.a, j.b}) {
      if (!plan.is_dynamic(piece)) continue;
      const int body = plan.pieces[piece].body;
      const int a = first(body), b = first(of_node.try_emplace(j.node, body).first->second);
      mate[std::max(a, b)] = std::min(a, b);
    }
  }
  for (int& body : mate) body = first(body);
  return mate;
}

b2Joint* create_stock_joint(b2World& world, const Plan& plan, const PlannedJoint& j, b2Body* a, b2Body* b,
                            bool all_rigid) {
  std::optional<StockJointDef> stock = stock_def(plan, j);
  if (!stock) return nullptr;
  if (auto* weld = std::get_if<b2WeldJointDef>(&*stock); weld && all_rigid)
    weld->stiffness = weld->damping = 0;
  return std::visit(
      [&](auto& def) {
        def.bodyA = a;
        def.bodyB = b;
        return world.CreateJoint(&def);
      },
      *stock);
}

b2Body* body_of(const Built& built, int piece) { return piece < 0 ? built.ground : built.bodies[piece]; }

void set_masses(const Plan& plan, const Built& built) {
  std::vector<double> area(plan.pieces.size());
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    area[plan.pieces[i].part_of < 0 ? i : static_cast<std::size_t>(plan.pieces[i].part_of)] +=
        area_of(plan.pieces[i]);
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const Piece& piece = plan.pieces[i];
    if (piece.part_of >= 0 || !plan.is_dynamic(static_cast<int>(i))) continue;
    // The densities only matter where a user's call makes Box2D reset the mass from the fixtures.
    for (b2Fixture* f = built.bodies[i]->GetFixtureList(); f; f = f->GetNext())
      f->SetDensity(static_cast<float>(piece.mass / area[i]));
    const b2MassData mass{static_cast<float>(piece.mass), {0, 0}, static_cast<float>(piece.inertia)};
    built.bodies[i]->SetMassData(&mass);
  }
}

b2Body* create_ground(b2World& world, const Plan& plan) {
  const bool needed =
      std::any_of(plan.joints.begin(), plan.joints.end(), [](const PlannedJoint& j) { return j.a < 0; });
  const b2BodyDef def;
  return needed ? world.CreateBody(&def) : nullptr;
}

}  // namespace

b2Vec2 local_point(const Built& built, int piece, Point at) {
  const BodyPlace& place = built.places[static_cast<std::size_t>(piece)];
  return to_box2d(Rotation(place.angle).inverse(at - Point{place.origin.x, place.origin.y}));
}

Built build_bodies(b2World& world, const Plan& plan) {
  // Everything that can be refused is made before the world changes.
  std::vector<std::vector<b2PolygonShape>> polygons;
  std::vector<Problem> problems;
  for (const Piece& piece : plan.pieces) {
    polygons.emplace_back();
    const bool collides = plan.bodies[piece.body].collides;
    try {
      if (collides && piece.circle > 0) {
        if (piece.circle < 2 * b2_linearSlop)
          throw InvalidInput(
              {{"piece '" + piece.name + "'", "is a disc of radius " + to_string(piece.circle) + " m",
                "draw it with a radius of at least 0.01 m"}});
      } else if (collides) {
        Piece in_its_body = piece;
        in_its_body.center = plan.carrier(static_cast<int>(polygons.size()) - 1).center;
        polygons.back() = shapes(in_its_body);
      }
      const bool dynamic = piece.part_of < 0 && plan.is_dynamic(static_cast<int>(polygons.size()) - 1);
      // As in Box2D, a piece of no inertia does not turn.
      for (const double value : {piece.mass, piece.inertia == 0 ? piece.mass : piece.inertia})
        if (dynamic &&
            !(value >= std::numeric_limits<float>::min() && value <= std::numeric_limits<float>::max()))
          throw InvalidInput({{"piece '" + piece.name + "'",
                               "has a mass of " + to_string(piece.mass) + " kg and an inertia of " +
                                   to_string(piece.inertia) + " kg m², which no float holds",
                               "change its density or size"}});
    } catch (const InvalidInput& e) {
      problems.insert(problems.end(), e.problems().begin(), e.problems().end());
    }
  }
  if (!problems.empty()) throw InvalidInput(std::move(problems));
  FreshGroups groups(world, plan);

  Built built;
  built.ground = create_ground(world, plan);
  const std::vector<int> mates = node_mates(plan);
  std::vector<int> shared(mates.size());
  for (const int mate : mates) ++shared[mate];
  std::map<int, int16> group_of;  // of the first of mates
  int16 group = 0;
  Point centre;
  std::size_t first = 0;  // piece of the body
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const Piece& piece = plan.pieces[i];
    const BodyDef& body = plan.bodies[piece.body];
    if (i == 0 || plan.pieces[i - 1].body != piece.body) {
      const bool is_split = i + 1 < plan.pieces.size() && plan.pieces[i + 1].body == piece.body;
      first = i;
      const int mate = mates[piece.body];
      const bool in_node = shared[mate] > 1;
      group = body.group;
      if (group == 0 && (is_split || in_node)) {
        if (const auto known = group_of.find(mate); in_node && known != group_of.end())
          group = known->second;
        else
          group_of[mate] = group = groups.next();
      }
      centre = is_split && body.angular_velocity != 0 ? mass_centre(plan, piece.body) : piece.center;
    }
    b2Body* created = nullptr;
    if (piece.part_of >= 0) {
      created = built.bodies[piece.part_of];
    } else {
      b2BodyDef def;
      def.type = plan.is_dynamic(static_cast<int>(i))    ? b2_dynamicBody
                 : body.type == BodyType::kinematic_body ? b2_kinematicBody
                                                         : b2_staticBody;
      def.position = to_box2d(piece.center);
      if (def.type != b2_staticBody) {
        const Point own = body.velocities.empty()
                              ? body.velocity + body.angular_velocity * left(piece.center - centre)
                              : body.velocities[i - first];
        def.linearVelocity = to_box2d(own);
        def.angularVelocity = static_cast<float>(body.angular_velocity);
      }
      def.allowSleep = plan.sleep;
      created = world.CreateBody(&def);
    }

    b2FixtureDef fixture;
    fixture.filter.groupIndex = group;
    if (body.material) {
      fixture.friction = static_cast<float>(body.material->friction);
      fixture.restitution = static_cast<float>(body.material->restitution);
    }
    for (const b2PolygonShape& shape : polygons[i]) {
      fixture.shape = &shape;
      created->CreateFixture(&fixture);
    }
    if (piece.circle > 0 && body.collides) {
      b2CircleShape disc;
      disc.m_radius = static_cast<float>(piece.circle);
      disc.m_p = to_box2d(piece.center - plan.carrier(static_cast<int>(i)).center);
      fixture.shape = &disc;
      created->CreateFixture(&fixture);
    }
    built.bodies.push_back(created);
    built.places.push_back({created->GetPosition(), created->GetAngle()});
  }
  set_masses(plan, built);

  for (const Plan::Wheel& wheel : plan.wheels) {
    b2WheelJointDef def;
    def.Initialize(built.bodies[wheel.chassis], built.bodies[wheel.wheel], to_box2d(wheel.def.at),
                   to_box2d(unit(wheel.def.axis)));
    b2LinearStiffness(def.stiffness, def.damping, static_cast<float>(wheel.def.frequency),
                      static_cast<float>(wheel.def.damping_ratio), def.bodyA, def.bodyB);
    def.enableMotor = true;
    def.motorSpeed = static_cast<float>(wheel.def.motor_speed);
    def.maxMotorTorque = static_cast<float>(wheel.def.motor_torque);
    built.wheels.push_back(static_cast<b2WheelJoint*>(world.CreateJoint(&def)));
  }
  return built;
}

namespace {

Built build(Structure& structure, b2World& world, const Plan& plan,
            std::vector<ElasticPlasticJointDef> defs) {
  if (plan.make) return plan.make(world, plan, &structure);
  Built built = build_bodies(world, plan);
  std::map<int, int> nodes;  // of the plan, in the structure
  for (std::size_t i = 0; i < defs.size(); ++i) {
    defs[i].bodyA = body_of(built, plan.joints[i].a);
    defs[i].bodyB = body_of(built, plan.joints[i].b);
    if (int& node = defs[i].node; node != 0) {
      const auto [known, is_new] = nodes.try_emplace(node, 0);
      node = is_new ? known->second = structure.new_node() : known->second;
    }
    built.joints.push_back(structure.create_joint(defs[i]));
  }
  return built;
}

// What floats do not hold is found before anything is built.
std::vector<ElasticPlasticJointDef> defs_of(const Plan& plan) {
  std::vector<ElasticPlasticJointDef> defs;
  for (const PlannedJoint& j : plan.joints) defs.push_back(elastic_plastic_def(plan, j));
  return defs;
}

}  // namespace

Structure build(b2World& world, const Plan& plan, const StructureDef& def, Built* built) {
  auto defs = defs_of(plan);
  Structure structure(world, def);
  Built own = build(structure, world, plan, std::move(defs));
  if (built) *built = std::move(own);
  return structure;
}

Built build(Structure& structure, b2World& world, const Plan& plan) {
  if (structure.world() != nullptr && structure.world() != &world)
    throw std::invalid_argument(
        "build: the structure is of another world; give the world's own, Structure::of(world)");
  return build(structure, world, plan, defs_of(plan));
}

Built build_stock(b2World& world, const Plan& plan, bool all_rigid) {
  if (plan.make) return plan.make(world, plan, nullptr);
  Built built = build_bodies(world, plan);
  for (const PlannedJoint& j : plan.joints)
    built.joints.push_back(
        create_stock_joint(world, plan, j, body_of(built, j.a), body_of(built, j.b), all_rigid));
  return built;
}

namespace {

/// The part of a load that grows over `over` seconds, once it has set in, from t to t + dt: its mean.
double mean_of_ramp(double t, double dt, double over) {
  if (!(dt > 0)) return t < 0 ? 0 : t < over ? t / over : 1;
  const auto until = [over](double now) {  // the integral
    return now <= 0 ? 0 : now < over ? now * now / (2 * over) : now - over / 2;
  };
  return t >= over ? 1 : (until(t + dt) - until(t)) / dt;
}

}  // namespace

std::vector<AppliedLoad> apply_loads(b2World& world, const Plan& plan, const Built& built, double time,
                                     double dt) {
  std::vector<AppliedLoad> applied;
  world.SetGravity(to_box2d(mean_of_ramp(time, dt, plan.gravity_ramp) * plan.gravity));
  for (const Plan::Load& load : plan.loads) {
    if (time >= load.def.to) continue;
    const double lasts = std::min(dt, load.def.to - time);
    const double factor =
        mean_of_ramp(time - load.def.from, lasts, load.def.ramp) * (lasts < dt ? lasts / dt : 1);
    if (factor == 0) continue;
    b2Body* body = built.bodies[load.piece];
    const b2Vec2 at = body->GetWorldPoint(local_point(built, load.piece, load.at));
    const AppliedLoad now{body, at, to_box2d(factor * load.def.force),
                          static_cast<float>(factor * load.def.moment)};
    body->ApplyForce(now.force, at, true);
    body->ApplyTorque(now.moment, true);
    applied.push_back(now);
  }
  return applied;
}

void apply_drives(const Plan& plan, const Built& built, double time) {
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const std::optional<DriveDef>& def = plan.joints[i].drive;
    if (!def || !built.joints[i]) continue;
    ElasticPlasticJoint* joint = ElasticPlasticJoint::cast(built.joints[i]);
    if (!joint) continue;
    const Drive now = drive_at(plan.joints[i], time);
    const std::optional<Drive> before = joint->def().rows[def->row].drive;
    if (!before || before->speed != now.speed || before->target != now.target) joint->drive(def->row, now);
  }
}

}  // namespace ductile
