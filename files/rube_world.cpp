#include "rube_world.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace ductile::rube {
namespace {

/// None where Box2D would not take it. A chain has one side, to the right of its direction: `backwards` it
/// has the other one.
std::unique_ptr<b2Shape> shape(const Fixture& fixture, bool backwards = false) {
  std::vector<Point> points = fixture.points;
  if (backwards) std::reverse(points.begin(), points.end());
  const auto chain = [&](bool loop) {
    std::vector<b2Vec2> vertices;
    for (const Point& p : points) {
      const b2Vec2 v = single(p);
      // Box2D does without vertices nearer than this.
      if (vertices.empty() || b2DistanceSquared(vertices.back(), v) > b2_linearSlop * b2_linearSlop)
        vertices.push_back(v);
    }
    while (loop && vertices.size() > 1 &&
           b2DistanceSquared(vertices.back(), vertices[0]) <= b2_linearSlop * b2_linearSlop)
      vertices.pop_back();
    auto shape = std::make_unique<b2ChainShape>();
    if (vertices.size() < (loop ? 3u : 2u)) return std::unique_ptr<b2ChainShape>();
    const auto count = static_cast<int32>(vertices.size());
    if (loop)
      shape->CreateLoop(vertices.data(), count);
    else  // as if it went on straight at its ends
      shape->CreateChain(vertices.data(), count, 2 * vertices[0] - vertices[1],
                         2 * vertices.back() - vertices[vertices.size() - 2]);
    return shape;
  };
  switch (fixture.kind) {
    case Fixture::circle: {
      auto disc = std::make_unique<b2CircleShape>();
      disc->m_radius = single(fixture.radius);
      disc->m_p = single(points[0]);
      return disc;
    }
    case Fixture::edge: {
      auto edge = std::make_unique<b2EdgeShape>();
      edge->SetTwoSided(single(points[0]), single(points[1]));
      return edge;
    }
    case Fixture::chain:
      return chain(fixture.value.json().contains("loop"));
    default:
      if (const auto polygon = polygon_shape(points)) return std::make_unique<b2PolygonShape>(*polygon);
      return nullptr;
  }
}

/// Puts a planned joint where the scene has it: the plan's definitions are for bodies about their centres of
/// mass that are not turned.
struct Place {
  const Item& item;
  const PlannedJoint& joint;
  b2Body *a, *b;

  b2Vec2 axis() const { return a->GetLocalVector(single(joint.axis)); }
  template <class Def>
  void common(Def& def) const {
    def.bodyA = a;
    def.bodyB = b;
    def.collideConnected = item.boolean("collideConnected");
  }
  template <class Def>
  void anchors(Def& def) const {
    common(def);
    def.localAnchorA = single(item.vector("anchorA"));
    def.localAnchorB = single(item.vector("anchorB"));
    if constexpr (requires { def.referenceAngle; }) def.referenceAngle = single(item.number("refAngle"));
    if constexpr (requires { def.localAxisA; }) def.localAxisA = axis();
  }
  void operator()(ElasticPlasticJointDef& def) const {
    anchors(def);
    def.axisAngle = single(std::atan2(joint.axis.y, joint.axis.x) - double{a->GetAngle()});
  }
  void operator()(b2MotorJointDef& def) const {
    common(def);
    def.linearOffset = a->GetLocalPoint(b->GetPosition());
    def.angularOffset = b->GetAngle() - a->GetAngle();
  }
  template <class Def>
  void operator()(Def& def) const {
    anchors(def);
  }
};

}  // namespace

World::World(Scene scene, const std::string& name)
    : scene_(std::move(scene)), problems_(name), top_(Value(scene_.json, "top level", problems_)) {
  bodies_ = read_bodies(top_);
  for (const Body& body : bodies_) check(body);
  for (const Value& joint : top_.list("joint")) joints_.emplace_back(joint);
  planned_.assign(joints_.size(), -1);
  for (std::size_t i = 0; i < scene_.joints.size(); ++i)
    planned_[static_cast<std::size_t>(scene_.joints[i])] = static_cast<int>(i);
  for (const Item& joint : joints_) check(joint);
  problems_.check();
}

void World::check(const Body& body) {
  shapes_.emplace_back();
  for (const Fixture& fixture : body.fixtures) {
    auto made = shape(fixture);
    if (!made)
      fixture.value.wrong("is too thin or has too many vertices for Box2D",
                          "draw it thicker than 0.005 m, as convex polygons of 3 to 8 vertices");
    shapes_.back().emplace_back(&fixture, std::move(made));
    // In Box2D 2.3, for which the editor is made, chains have both sides.
    if (fixture.kind == Fixture::chain) shapes_.back().emplace_back(&fixture, shape(fixture, true));
  }
  const Item item(body.value);
  for (const char* key : {"linearDamping", "angularDamping"}) {
    if (item.number(key) < 0) item.at(key).wrong("is negative", "write a number >= 0");
  }
  // As b2Body::SetMassData will work it out: b2Assert wants it positive.
  const float mass = single(body.mass), inertia = single(body.inertia);
  const b2Vec2 centre = single(body.mass_center);
  if (body.mass < 0) body.value.wrong("has a negative massData-mass", "write a mass >= 0");
  if (inertia > 0 && !item.boolean("fixedRotation")) {
    const float about_centre = inertia - (mass > 0 ? mass : 1) * b2Dot(centre, centre);
    if (!(about_centre > 0) || !std::isfinite(about_centre))
      body.value.wrong("has a massData-I that is too small for its massData-center",
                       "write the inertia about the body's origin");
  }
}

void World::check(const Item& item) {
  const int most = static_cast<int>(bodies_.size()) - 1;
  const std::optional<int> of_a = item.index("bodyA", most), of_b = item.index("bodyB", most);
  const int a = of_a.value_or(0), b = of_b.value_or(0);
  if (of_a && of_b && a == b)
    item.value().wrong("joins body " + std::to_string(a) + " to itself", "give two bodies");
  const std::string type = item.text("type");
  if (type == "prismatic" || type == "wheel") {
    const Point axis = item.vector(item.has("localAxisA") ? "localAxisA" : "localAxis1");
    if (!(std::hypot(axis.x, axis.y) > 1e-6))
      item.value().wrong("has no axis", "give \"localAxisA\" a length");
  }
  if (type == "gear") {
    for (const char* key : {"joint1", "joint2"}) {
      const int other = item.integer(key, 0, static_cast<int>(joints_.size()) - 1);
      const std::string kind = other < static_cast<int>(joints_.size())
                                   ? joints_[static_cast<std::size_t>(other)].text("type")
                                   : "";
      const bool turns = kind == "revolute" || kind == "prismatic";
      if (!turns) {
        item.value().wrong(std::string("gears a joint that is no revolute or prismatic one, its ") + key,
                           "gear such joints");
      } else if (planned_[static_cast<std::size_t>(other)] >= 0) {
        item.value().wrong(std::string("gears a joint that is calibrated, its ") + key,
                           "give that one \"ductile.calibrate\": false");
      } else if (const int turned = joints_[static_cast<std::size_t>(other)].integer("bodyB", 0, most);
                 bodies_[static_cast<std::size_t>(turned)].type != BodyType::dynamic_body) {
        item.value().wrong("gears a joint whose bodyB is not dynamic", "give bodyB of what it gears type 2");
      }
    }
  }
  if (type == "pulley" && !(item.number("ratio") > 0)) item.value().wrong("has no ratio", "give one > 0");
  for (const char* key : {"maxForce", "maxTorque", "correctionFactor", "frequency", "dampingRatio",
                          "springFrequency", "springDampingRatio", "maxLength", "length"}) {
    if (item.number(key) < 0) item.at(key).wrong("is negative", "write a number >= 0");
  }
  if (item.number("correctionFactor") > 1) item.at("correctionFactor").wrong("is above 1", "write 0 to 1");
  for (const char* known : {"revolute", "prismatic", "distance", "pulley", "mouse", "gear", "wheel", "motor",
                            "weld", "friction", "rope"}) {
    if (type == known) return;
  }
  item.value().wrong("has the unknown type \"" + type + "\"", "take it out");
}

b2Body* World::make_body(b2World& world, std::size_t index) const {
  constexpr b2BodyType types[] = {b2_staticBody, b2_dynamicBody, b2_kinematicBody};  // as BodyType has them
  const Body& body = bodies_[index];
  const Item item(body.value);
  b2BodyDef def;
  def.type = types[static_cast<int>(body.type)];
  def.position = single(body.frame.origin);
  def.angle = single(body.frame.angle);
  def.linearVelocity = single(body.velocity);
  def.angularVelocity = single(body.angular_velocity);
  def.linearDamping = single(item.number("linearDamping"));
  def.angularDamping = single(item.number("angularDamping"));
  def.gravityScale = single(item.number("gravityScale", 1));
  def.allowSleep = item.boolean("allowSleep", true);
  def.awake = item.boolean("awake") || !top_.boolean("allowSleep");  // nobody sleeps in a world without sleep
  def.fixedRotation = item.boolean("fixedRotation");
  def.bullet = item.boolean("bullet");
  def.enabled = item.boolean("active", true);
  b2Body* made = world.CreateBody(&def);
  for (const auto& [fixture, shape] : shapes_[index]) {
    const Item of(fixture->value);
    b2FixtureDef fixture_def;
    fixture_def.shape = shape.get();
    fixture_def.friction = single(of.number("friction"));
    fixture_def.restitution = single(of.number("restitution"));
    fixture_def.isSensor = fixture->sensor;
    fixture_def.filter.categoryBits = static_cast<uint16>(of.integer("filter-categoryBits", 0, 0xffff, 1));
    fixture_def.filter.maskBits = static_cast<uint16>(of.integer("filter-maskBits", -32768, 0xffff, 0xffff));
    fixture_def.filter.groupIndex = static_cast<int16>(of.integer("filter-groupIndex", -32768, 32767));
    // The density is for later calls: the mass is the body's own.
    made->CreateFixture(&fixture_def)->SetDensity(std::max(0.0f, single(of.number("density"))));
  }
  if (def.type == b2_dynamicBody) {
    const b2MassData mass{single(body.mass), single(body.mass_center), single(body.inertia)};
    made->SetMassData(&mass);
    made->SetLinearVelocity(def.linearVelocity);  // of the centre of mass, which has just moved
  }
  return made;
}

Built World::make(b2World& world, const Plan& plan, Structure* structure, Names* names) const {
  Built built;
  world.SetGravity(single(top_.vector("gravity")));
  std::vector<b2Body*> bodies;
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies.push_back(make_body(world, i));
  for (const int body : scene_.bodies) {
    built.bodies.push_back(bodies[static_cast<std::size_t>(body)]);
    built.places.push_back({built.bodies.back()->GetPosition(), built.bodies.back()->GetAngle()});
  }
  const auto planned_joint = [&](const Item& item, const PlannedJoint& j) -> b2Joint* {
    const auto body = [&](const char* key) {
      return bodies[static_cast<std::size_t>(item.integer(key, 0, 1 << 30))];
    };
    const Place place{item, j, body("bodyA"), body("bodyB")};
    if (j.a < 0) built.ground = place.a;
    if (structure) {
      ElasticPlasticJointDef def = elastic_plastic_def(plan, j);
      place(def);
      return structure->create_joint(def);
    }
    auto stock = stock_def(plan, j);
    if (!stock) return nullptr;
    return std::visit(
        [&](auto& def) {
          place(def);
          return world.CreateJoint(&def);
        },
        *stock);
  };
  built.joints.assign(plan.joints.size(), nullptr);
  std::vector<b2Joint*> joints(joints_.size());
  for (const bool gears : {false, true}) {  // which refer to other joints
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if ((joints_[i].text("type") == "gear") != gears) continue;
      if (planned_[i] < 0) {
        joints[i] = make_joint(world, joints_[i], bodies, joints);
        continue;
      }
      const auto k = static_cast<std::size_t>(planned_[i]);
      joints[i] = built.joints[k] = planned_joint(joints_[i], plan.joints[k]);
    }
  }
  if (!names) return built;
  for (std::size_t i = 0; i < bodies_.size(); ++i) names->bodies.emplace(bodies_[i].name, bodies[i]);
  for (std::size_t i = 0; i < joints_.size(); ++i)
    if (joints[i]) names->joints.emplace(joints_[i].text("name"), joints[i]);
  return built;
}

}  // namespace ductile::rube
