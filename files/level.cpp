#include "ductile/level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "ductile/files.h"
#include "rube.h"

namespace ductile {
namespace {

b2Vec2 vector(Point p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }
float single(double value) { return static_cast<float>(value); }

/// A scene of R.U.B.E. in a world: first everything that can be refused is looked at, then it is made.
class Maker {
 public:
  Maker(const rube::Scene& scene, Problems& problems)
      : scene_(scene), top_(Value(scene.json, "top level", problems)) {
    bodies_ = rube::read_bodies(top_);
    for (const rube::Body& body : bodies_) check(body);
    for (const Value& joint : top_.list("joint")) joints_.emplace_back(joint);
    planned_.assign(joints_.size(), -1);
    for (std::size_t i = 0; i < scene.joints.size(); ++i)
      planned_[static_cast<std::size_t>(scene.joints[i])] = static_cast<int>(i);
    for (const rube::Item& joint : joints_) check(joint);
    problems.check();
  }

  Level make(b2World& world, const StructureDef& def);

 private:
  using Shapes = std::vector<std::pair<const rube::Fixture*, std::unique_ptr<b2Shape>>>;

  void check(const rube::Body& body);
  void check(const rube::Item& joint);
  std::unique_ptr<b2Shape> shape(const rube::Fixture& fixture);
  b2Body* make_body(b2World& world, std::size_t index);
  b2Joint* make_joint(b2World& world, const rube::Item& item, const std::vector<b2Joint*>& others);
  ElasticPlasticJointDef ductile_def(const rube::Item& item, int planned) const;

  const rube::Scene& scene_;
  rube::Item top_;
  std::vector<rube::Body> bodies_;
  std::vector<Shapes> shapes_;
  std::vector<rube::Item> joints_;
  std::vector<int> planned_;  // by joints: index into the plan's; -1: not ductile
  std::vector<b2Body*> made_;
};

std::unique_ptr<b2Shape> Maker::shape(const rube::Fixture& fixture) {
  const std::vector<Point>& points = fixture.points;
  const auto chain = [&](bool loop) {
    std::vector<b2Vec2> vertices;
    for (const Point& p : points) {
      const b2Vec2 v = vector(p);
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
    else
      shape->CreateChain(vertices.data(), count, vertices.front(), vertices.back());
    return shape;
  };
  switch (fixture.kind) {
    case rube::Fixture::circle: {
      auto disc = std::make_unique<b2CircleShape>();
      disc->m_radius = single(fixture.radius);
      disc->m_p = vector(points[0]);
      return disc;
    }
    case rube::Fixture::edge: {
      auto edge = std::make_unique<b2EdgeShape>();
      edge->SetTwoSided(vector(points[0]), vector(points[1]));
      return edge;
    }
    case rube::Fixture::chain:
      return chain(fixture.value.json().contains("loop"));
    default:
      if (const auto polygon = polygon_shape(points)) return std::make_unique<b2PolygonShape>(*polygon);
      return nullptr;
  }
}

void Maker::check(const rube::Body& body) {
  shapes_.emplace_back();
  for (const rube::Fixture& fixture : body.fixtures) {
    auto made = shape(fixture);
    if (!made)
      fixture.value.wrong("is too thin or has too many vertices for Box2D",
                          "draw it thicker than 0.005 m, as convex polygons of 3 to 8 vertices");
    shapes_.back().emplace_back(&fixture, std::move(made));
  }
  const rube::Item item(body.value);
  for (const char* key : {"linearDamping", "angularDamping"}) {
    if (item.number(key) < 0) item.at(key).wrong("is negative", "write a number >= 0");
  }
  // As b2Body::SetMassData will work it out: b2Assert wants it positive.
  const float mass = single(body.mass), inertia = single(body.inertia);
  const b2Vec2 centre = vector(body.mass_center);
  if (body.mass < 0) body.value.wrong("has a negative massData-mass", "write a mass >= 0");
  if (inertia > 0 && !item.boolean("fixedRotation")) {
    const float about_centre = inertia - (mass > 0 ? mass : 1) * b2Dot(centre, centre);
    if (!(about_centre > 0) || !std::isfinite(about_centre))
      body.value.wrong("has a massData-I that is too small for its massData-center",
                       "write the inertia about the body's origin");
  }
}

void Maker::check(const rube::Item& item) {
  const int most = static_cast<int>(bodies_.size()) - 1;
  const int a = item.integer("bodyA", 0, most), b = item.integer("bodyB", 0, most);
  if (a == b) item.value().wrong("joins body " + std::to_string(a) + " to itself", "give two bodies");
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
      if (!turns || planned_[static_cast<std::size_t>(other)] >= 0)
        item.value().wrong("gears a joint that is no revolute or prismatic one", "gear such joints");
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

b2Body* Maker::make_body(b2World& world, std::size_t index) {
  constexpr b2BodyType types[] = {b2_staticBody, b2_dynamicBody, b2_kinematicBody};  // as BodyType has them
  const rube::Body& body = bodies_[index];
  const rube::Item item(body.value);
  b2BodyDef def;
  def.type = types[static_cast<int>(body.type)];
  def.position = vector(body.frame.origin);
  def.angle = single(body.frame.angle);
  def.linearVelocity = vector(body.velocity);
  def.angularVelocity = single(body.angular_velocity);
  def.linearDamping = single(item.number("linearDamping"));
  def.angularDamping = single(item.number("angularDamping"));
  def.gravityScale = single(item.number("gravityScale", 1));
  def.allowSleep = item.boolean("allowSleep", true);
  def.awake = item.boolean("awake");
  def.fixedRotation = item.boolean("fixedRotation");
  def.bullet = item.boolean("bullet");
  def.enabled = item.boolean("active", true);
  b2Body* made = world.CreateBody(&def);
  for (const auto& [fixture, shape] : shapes_[index]) {
    const rube::Item of(fixture->value);
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
    const b2MassData mass{single(body.mass), vector(body.mass_center), single(body.inertia)};
    made->SetMassData(&mass);
    made->SetLinearVelocity(def.linearVelocity);  // of the centre of mass, which has just moved
  }
  return made;
}

ElasticPlasticJointDef Maker::ductile_def(const rube::Item& item, int planned) const {
  const PlannedJoint& j = scene_.plan.joints[static_cast<std::size_t>(planned)];
  ElasticPlasticJointDef def = elastic_plastic_def(scene_.plan, j);
  def.bodyA = made_[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
  def.bodyB = made_[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
  def.localAnchorA = vector(item.vector("anchorA"));
  def.localAnchorB = vector(item.vector("anchorB"));
  def.referenceAngle = single(item.number("refAngle"));
  def.axisAngle = single(std::atan2(j.axis.y, j.axis.x) - double{def.bodyA->GetAngle()});
  def.collideConnected = item.boolean("collideConnected");
  return def;
}

b2Joint* Maker::make_joint(b2World& world, const rube::Item& item, const std::vector<b2Joint*>& others) {
  const std::string type = item.text("type");
  const auto number = [&](const char* key) { return single(item.number(key)); };
  const auto create = [&](auto& def) {
    def.bodyA = made_[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made_[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    def.collideConnected = item.boolean("collideConnected");
    return world.CreateJoint(&def);
  };
  const auto bodies = [&](auto& def) {
    def.bodyA = made_[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made_[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    def.localAnchorA = vector(item.vector("anchorA"));
    def.localAnchorB = vector(item.vector("anchorB"));
  };
  const auto axis = [&] { return vector(item.vector(item.has("localAxisA") ? "localAxisA" : "localAxis1")); };
  if (type == "revolute") {
    b2RevoluteJointDef def;
    bodies(def);
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerAngle = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperAngle = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    return create(def);
  }
  if (type == "prismatic") {
    b2PrismaticJointDef def;
    bodies(def);
    def.localAxisA = axis();
    def.referenceAngle = number("refAngle");
    def.enableLimit = item.boolean("enableLimit");
    def.lowerTranslation = std::min(number("lowerLimit"), number("upperLimit"));
    def.upperTranslation = std::max(number("lowerLimit"), number("upperLimit"));
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorForce = number("maxMotorForce");
    return create(def);
  }
  if (type == "wheel") {
    b2WheelJointDef def;
    bodies(def);
    def.localAxisA = axis();
    def.enableMotor = item.boolean("enableMotor");
    def.motorSpeed = number("motorSpeed");
    def.maxMotorTorque = number("maxMotorTorque");
    b2LinearStiffness(def.stiffness, def.damping, number("springFrequency"), number("springDampingRatio"),
                      def.bodyA, def.bodyB);
    return create(def);
  }
  if (type == "distance") {
    b2DistanceJointDef def;
    bodies(def);
    def.length = def.minLength = def.maxLength = number("length");
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    if (def.stiffness > 0) {
      def.minLength = 0;
      def.maxLength = std::numeric_limits<float>::max();
    }
    return create(def);
  }
  if (type == "rope") {  // in 2.4 a distance joint that is only ever too long
    b2DistanceJointDef def;
    bodies(def);
    def.minLength = 0;
    def.length = def.maxLength = number("maxLength");
    def.stiffness = def.damping = 0;
    return create(def);
  }
  if (type == "weld") {
    b2WeldJointDef def;
    bodies(def);
    def.referenceAngle = number("refAngle");
    if (number("frequency") > 0)
      b2AngularStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                         def.bodyB);
    return create(def);
  }
  if (type == "friction") {
    b2FrictionJointDef def;
    bodies(def);
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    return create(def);
  }
  if (type == "motor") {
    b2MotorJointDef def;
    def.linearOffset = vector(item.vector(item.has("linearOffset") ? "linearOffset" : "anchorA"));
    def.angularOffset = number("refAngle");
    def.maxForce = number("maxForce");
    def.maxTorque = number("maxTorque");
    def.correctionFactor = number("correctionFactor");
    return create(def);
  }
  if (type == "mouse") {
    b2MouseJointDef def;
    def.target = vector(item.vector("target"));
    def.maxForce = number("maxForce");
    def.bodyA = made_[static_cast<std::size_t>(item.integer("bodyA", 0, 1 << 30))];
    def.bodyB = made_[static_cast<std::size_t>(item.integer("bodyB", 0, 1 << 30))];
    b2LinearStiffness(def.stiffness, def.damping, number("frequency"), number("dampingRatio"), def.bodyA,
                      def.bodyB);
    return create(def);
  }
  if (type == "pulley") {
    b2PulleyJointDef def;
    bodies(def);
    def.groundAnchorA = vector(item.vector("groundAnchorA"));
    def.groundAnchorB = vector(item.vector("groundAnchorB"));
    def.lengthA = number("lengthA");
    def.lengthB = number("lengthB");
    def.ratio = number("ratio");
    return create(def);
  }
  b2GearJointDef def;
  def.joint1 = others[static_cast<std::size_t>(item.integer("joint1", 0, 1 << 30))];
  def.joint2 = others[static_cast<std::size_t>(item.integer("joint2", 0, 1 << 30))];
  def.ratio = number("ratio");
  return create(def);
}

Level Maker::make(b2World& world, const StructureDef& structure_def) {
  Built built;
  world.SetGravity(vector(top_.vector("gravity")));
  for (std::size_t i = 0; i < bodies_.size(); ++i) made_.push_back(make_body(world, i));
  for (const int body : scene_.bodies) built.bodies.push_back(made_[static_cast<std::size_t>(body)]);
  built.joints.assign(scene_.joints.size(), nullptr);
  Structure structure(world, structure_def);
  std::vector<b2Joint*> joints(joints_.size());
  for (const bool gears : {false, true}) {  // which refer to other joints
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      if ((joints_[i].text("type") == "gear") != gears) continue;
      if (planned_[i] >= 0) {
        joints[i] = structure.create_joint(ductile_def(joints_[i], planned_[i]));
        built.joints[static_cast<std::size_t>(planned_[i])] = joints[i];
        if (scene_.plan.joints[static_cast<std::size_t>(planned_[i])].a < 0)
          built.ground = joints[i]->GetBodyA();
      } else {
        joints[i] = make_joint(world, joints_[i], joints);
      }
    }
  }
  Level level{scene_.plan, std::move(built), {}, {}, std::move(structure)};
  for (std::size_t i = 0; i < bodies_.size(); ++i) level.bodies.emplace(bodies_[i].name, made_[i]);
  for (std::size_t i = 0; i < joints_.size(); ++i) level.joints.emplace(joints_[i].text("name"), joints[i]);
  return level;
}

Level level_of_plan(b2World& world, Plan plan, const StructureDef& def) {
  Built built;
  Structure structure = build(world, plan, def, &built);
  world.SetGravity(vector(plan.gravity));
  Level level{std::move(plan), std::move(built), {}, {}, std::move(structure)};
  for (std::size_t i = 0; i < level.plan.pieces.size(); ++i)
    level.bodies.emplace(level.plan.pieces[i].name, level.built.bodies[i]);
  if (level.built.ground) level.bodies.emplace("ground", level.built.ground);
  for (std::size_t i = 0; i < level.plan.joints.size(); ++i)
    level.joints.emplace(level.plan.joints[i].name, level.built.joints[i]);
  return level;
}

}  // namespace

Level load_text(b2World& world, std::string_view text, const std::string& name,
                const std::filesystem::path& folder, const StructureDef& def) {
  const nlohmann::json json = parse_json(text, name);
  if (rube::is_scene(json)) {
    const rube::Scene scene = rube::read(json, name);
    Problems problems(name);
    return Maker(scene, problems).make(world, def);
  }
  const SceneDef scene = parse_scene(text, name, folder);
  return in_file(name, [&] { return level_of_plan(world, calibrate(scene), def); });
}

Level load(b2World& world, const std::filesystem::path& file, const StructureDef& def) {
  return load_text(world, read_text(file), file.string(), file.parent_path(), def);
}

Plan parse_plan(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                std::vector<Problem>* beyond) {
  const nlohmann::json json = parse_json(text, name);
  if (!rube::is_scene(json)) {
    const SceneDef scene = parse_scene(text, name, folder);
    return in_file(name, [&] { return calibrate(scene); });
  }
  rube::Scene scene = rube::read(json, name);
  if (beyond) *beyond = std::move(scene.beyond_plan);
  return std::move(scene.plan);
}

bool is_rube(std::string_view text) {
  try {
    return rube::is_scene(parse_json(text, ""));
  } catch (const InvalidInput&) {
    return false;
  }
}

std::string calibrated_rube(std::string_view text, const std::string& name) {
  return printed(nlohmann::ordered_json(rube::read(parse_json(text, name), name).json));
}

}  // namespace ductile
