// A plan as a R.U.B.E. scene whose joints are stock joints, with what ductile knows of them besides.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "built_plan.h"
#include "ductile/box2d.h"
#include "ductile/definitions.h"
#include "rube.h"
#include "scene_text.h"

namespace ductile::rube {
namespace {

Json number(float value) { return decimal(value); }
Json vector(const b2Vec2& v) {
  if (v.x == 0 && v.y == 0) return 0;
  return {{"x", decimal(v.x)}, {"y", decimal(v.y)}};
}

Json json(const b2Fixture& fixture, const Frame& piece, const Frame& body) {
  const auto local = [&](const b2Vec2& p) { return to_box2d(body.local(piece.world({p.x, p.y}))); };
  Json item{{"density", number(fixture.GetDensity())},
            {"friction", number(fixture.GetFriction())},
            {"restitution", number(fixture.GetRestitution())}};
  if (const int group = fixture.GetFilterData().groupIndex) item["filter-groupIndex"] = group;
  if (fixture.GetType() == b2Shape::e_circle) {
    const b2Vec2 centre = static_cast<const b2CircleShape&>(*fixture.GetShape()).m_p;
    item["circle"] = {{"center", vector(local(centre))}, {"radius", number(fixture.GetShape()->m_radius)}};
    return item;
  }
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  Json& vertices = item["polygon"]["vertices"];
  for (int i = 0; i < polygon.m_count; ++i) {
    const b2Vec2 p = local(polygon.m_vertices[i]);
    vertices["x"].push_back(number(p.x));
    vertices["y"].push_back(number(p.y));
  }
  return item;
}

/// Box2D 2.3 (LibGDX, cocos2d-x) welds vertices that are nearer than √(0.0025) m, as it takes half of its
/// slop of 0.005 m for the square of a distance, and asserts that three are left.
bool is_taken_by_2_3(const b2Fixture& fixture) {
  if (fixture.GetType() != b2Shape::e_polygon) return true;
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  std::vector<b2Vec2> kept;
  for (int i = 0; i < polygon.m_count; ++i) {
    const b2Vec2 p = polygon.m_vertices[i];
    const auto near = [&](const b2Vec2& q) { return b2DistanceSquared(p, q) < 0.5f * b2_linearSlop; };
    if (std::none_of(kept.begin(), kept.end(), near)) kept.push_back(p);
  }
  return kept.size() >= 3;
}

/// As scene files have a material; a built-in one by its name.
void write_material(Json& item, const Material& material) {
  for (NamedMaterial known : materials::all()) {
    known.material.friction = material.friction;  // the fixtures have these
    known.material.restitution = material.restitution;
    if (known.material == material) return set_custom(item, "ductile.material", "string", known.name);
  }
  const nlohmann::ordered_json fields = material_json(material);
  for (const auto& [key, value] : fields.items()) {
    if (key == "friction" || key == "restitution") continue;
    if (value.is_string()) {
      set_custom(item, "ductile." + key, "string", value);
    } else {
      set_custom(item, "ductile." + key, value.is_null() ? unlimited : value.get<double>());
    }
  }
}

}  // namespace

Json vector(Point p) { return vector(to_box2d(p)); }

void write_mass(Json& item, const b2Body& built, const Frame& frame) {
  const Point centre = frame.local({built.GetPosition().x, built.GetPosition().y});
  const double squared = centre.x * centre.x + centre.y * centre.y;
  item["massData-mass"] = number(built.GetMass());
  item["massData-center"] = vector(centre);
  item["massData-I"] = number(static_cast<float>(built.GetInertia() + built.GetMass() * squared));
  for (Json& fixture : item["fixture"]) fixture["density"] = number(built.GetFixtureList()->GetDensity());
}

void write_piece(Json& item, const Plan& plan, int index, const b2Body& built, const Frame& frame) {
  const Piece& piece = plan.pieces[static_cast<std::size_t>(index)];
  const Frame own{{built.GetPosition().x, built.GetPosition().y}, 0};
  Json common = Json::object();
  if (item.contains("fixture") && !item["fixture"].empty()) common = item["fixture"][0];
  for (const char* shape : {"polygon", "circle", "chain", "loop", "edge"}) common.erase(shape);
  item["fixture"] = Json::array();
  std::size_t vertices = 0;
  std::vector<const b2Fixture*> fixtures = fixtures_of(built);
  // Without slivers that only newer players take: mass and outline do not depend on them.
  if (std::any_of(fixtures.begin(), fixtures.end(), [](auto* fixture) { return is_taken_by_2_3(*fixture); }))
    std::erase_if(fixtures, [](auto* fixture) { return !is_taken_by_2_3(*fixture); });
  for (const b2Fixture* fixture : fixtures) {
    Json entry = common;
    entry.update(json(*fixture, own, frame));
    item["fixture"].push_back(std::move(entry));
    if (fixture->GetType() == b2Shape::e_polygon)
      vertices += static_cast<std::size_t>(static_cast<const b2PolygonShape*>(fixture->GetShape())->m_count);
  }
  if (built.GetType() == b2_dynamicBody) write_mass(item, built, frame);
  if (item["fixture"].size() == 1 && piece.outline.outer.size() == vertices) return;
  if (piece.circle > 0) return;
  // Convex parts leave out what Box2D would not see: the outline itself goes along, and that of what shares
  // the body.
  std::vector<Ring> rings;
  std::vector<Ring> holes;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const Piece& part = plan.pieces[i];
    if (static_cast<int>(i) != index && part.part_of != index) continue;
    rings.push_back(part.outline.outer);
    holes.insert(holes.end(), part.outline.holes.begin(), part.outline.holes.end());
  }
  const auto whole = joined(rings);
  if (!whole) return;
  const auto local = [&](const Ring& ring) {
    Json list = Json::array();
    for (const Point& p : ring) {
      const Point q = frame.local(p);
      list.push_back({q.x, q.y});
    }
    return list;
  };
  holes.insert(holes.end(), whole->holes.begin(), whole->holes.end());
  Json outline{{"outer", local(whole->outer)}};
  for (const Ring& hole : holes) outline["holes"].push_back(local(hole));
  set_custom(item, "ductile.outline", "string", outline.dump());
}

void write_loads(Json& item, const Plan& plan, int piece, const Frame& frame) {
  nlohmann::ordered_json list;
  for (const Plan::Load& load : plan.loads) {
    if (load.piece != piece) continue;
    LoadDef own = load.def;
    own.at = frame.local(load.at);
    list.push_back(load_json(own));
    list.back().erase("body");
  }
  if (!list.empty()) set_custom(item, "ductile.loads", "string", list.dump());
}

void write_joint(Json& item, const Plan& plan, const PlannedJoint& j, StockJoint as, int body_a, int body_b,
                 const Frame& a, const Frame& b) {
  const double moment = std::min(j.M, j.M_reverse);
  auto def = stock_def(plan, j);
  if (as == StockJoint::hinge && def && std::holds_alternative<b2WeldJointDef>(*def) && moment > 0 &&
      moment < unlimited)
    def = hinge_def(plan, j);
  if (!def) def = b2MotorJointDef();  // carries nothing
  item["name"] = j.name;
  item["bodyA"] = body_a;
  item["bodyB"] = body_b;
  item["anchorA"] = vector(a.local(j.anchor));
  item["anchorB"] = vector(b.local(j.far_anchor()));
  item["refAngle"] = b.angle - a.angle;
  const auto along = [&](const b2Vec2& axis) {
    item["localAxisA"] = vector(a.rotation.inverse({axis.x, axis.y}));
  };
  if (std::holds_alternative<b2WeldJointDef>(*def)) {
    const double I = reduced_inertia(plan, j);
    const bool soft = j.stiffness.M < unlimited && I > 0;
    item["type"] = "weld";
    item["frequency"] = soft ? std::sqrt(j.stiffness.M / I) / (2 * std::numbers::pi) : 0;
    item["dampingRatio"] = soft ? j.damping_ratio : 0;
  } else if (const auto* hinge = std::get_if<b2RevoluteJointDef>(&*def)) {
    item["type"] = "revolute";
    item["enableLimit"] = hinge->enableLimit;
    item["lowerLimit"] = number(hinge->lowerAngle);
    item["upperLimit"] = number(hinge->upperAngle);
    item["jointSpeed"] = 0;
    item["enableMotor"] = hinge->enableMotor;
    item["motorSpeed"] = number(hinge->motorSpeed);
    item["maxMotorTorque"] = number(hinge->maxMotorTorque);
  } else if (const auto* slide = std::get_if<b2PrismaticJointDef>(&*def)) {
    item["type"] = "prismatic";
    item["enableLimit"] = item["enableMotor"] = false;
    along(slide->localAxisA);
  } else if (const auto* line = std::get_if<b2WheelJointDef>(&*def)) {
    item["type"] = "wheel";
    item["enableMotor"] = false;
    item["springFrequency"] = 1e-3;  // nothing to speak of; with 0 planck.js 1.4 makes NaN
    item["springDampingRatio"] = 0;
    along(line->localAxisA);
  } else if (const auto* distance = std::get_if<b2DistanceJointDef>(&*def)) {
    item["collideConnected"] = true;
    if (j.carries == Carries::tension) {
      item["type"] = "rope";
      item["maxLength"] = number(distance->maxLength);
    } else {  // a strut pulls as well: R.U.B.E. has none
      item["type"] = "distance";
      item["length"] = number(distance->length);
      item["frequency"] = item["dampingRatio"] = 0;
    }
  } else {
    const auto& motor = std::get<b2MotorJointDef>(*def);
    item["type"] = "motor";
    item["linearOffset"] = vector(a.local(b.origin));
    item["maxForce"] = number(motor.maxForce);
    item["maxTorque"] = number(motor.maxTorque);
    item["correctionFactor"] = number(motor.correctionFactor);
  }
  // Those of R.U.B.E. have no line and no drive: load() leaves a joint without values to Box2D.
  if (j.end || j.drive) return;

  fields::for_each(fields::calibrated, [&](const auto& field) {
    set_custom(item, std::string("ductile.") + field.key, j.*field.member);
  });
  fields::for_each(fields::stiffness, [&](const auto& field) {
    set_custom(item, std::string("ductile.stiffness_") + field.key, j.stiffness.*field.member);
  });
  if (j.rate) {
    for (const Row row : {axial, shear, rotation})
      set_custom(item, std::string("ductile.") + doubling_rates[row], j.rate->doubling[row]);
    set_custom(item, std::string("ductile.") + rate_exponent, j.rate->exponent);
  }
  set_custom(item, "ductile.axis", "vec2", {{"x", j.axis.x}, {"y", j.axis.y}});
  if (j.governed_by >= 0)
    set_custom(item, "ductile.governed_by", "string", plan.reasons[static_cast<std::size_t>(j.governed_by)]);
}

namespace {

Json body_json(const b2Body& body, const std::string& name) {
  return {{"name", name},
          {"type", static_cast<int>(body.GetType())},
          {"position", vector(body.GetPosition())},
          {"angle", 0},
          {"linearVelocity", vector(body.GetLinearVelocity())},
          {"angularVelocity", number(body.GetAngularVelocity())},
          {"awake", true},
          {"active", true},
          {"allowSleep", body.IsSleepingAllowed()},
          {"gravityScale", 1}};
}

Json wheel_json(const Plan::Wheel& wheel, const b2WheelJoint& joint, const Plan& plan,
                const BuiltPlan& built) {
  const auto name = [&](int piece) { return plan.pieces[static_cast<std::size_t>(piece)].name; };
  return {{"type", "wheel"},
          {"name", name(wheel.chassis) + "-" + name(wheel.wheel)},
          {"bodyA", built.body(wheel.chassis)},
          {"bodyB", built.body(wheel.wheel)},
          {"anchorA", vector(joint.GetLocalAnchorA())},
          {"anchorB", vector(joint.GetLocalAnchorB())},
          {"localAxisA", vector(joint.GetLocalAxisA())},
          {"enableMotor", true},
          {"motorSpeed", number(joint.GetMotorSpeed())},
          {"maxMotorTorque", number(joint.GetMaxMotorTorque())},
          {"springFrequency", wheel.def.frequency},
          {"springDampingRatio", wheel.def.damping_ratio}};
}

}  // namespace
}  // namespace ductile::rube

namespace ductile {

std::string rube_text(const Plan& plan, StockJoint as) {
  using namespace rube;
  const BuiltPlan built(plan);
  rube::Json scene{{"gravity", vector(plan.gravity)},
                   {"allowSleep", true},
                   {"autoClearForces", true},
                   {"warmStarting", true},
                   {"continuousPhysics", true},
                   {"subStepping", false},
                   {"stepsPerSecond", 60},
                   {"velocityIterations", 8},
                   {"positionIterations", 3},
                   {"body", rube::Json::array()},
                   {"joint", rube::Json::array()}};
  if (plan.interaction) set_custom(scene, "ductile.interaction", "bool", true);
  if (plan.gravity_ramp > 0) set_custom(scene, "ductile.gravity_ramp", plan.gravity_ramp);
  const auto add_body = [&](const b2Body& body, const std::string& name) -> rube::Json& {
    return scene["body"].emplace_back(body_json(body, name));
  };
  for (const int piece : built.carriers) {
    const auto i = static_cast<std::size_t>(piece);
    const BodyDef& body = plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)];
    rube::Json& item = add_body(*built.built.bodies[i], plan.pieces[i].name);
    const b2Vec2 at = built.built.bodies[i]->GetPosition();
    write_piece(item, plan, piece, *built.built.bodies[i], {{at.x, at.y}});
    write_loads(item, plan, piece, {{at.x, at.y}});
    if (!body.material && body.profile.empty()) continue;
    if (body.material) write_material(item, *body.material);
    if (body.profile.empty())
      set_custom(item, "ductile.depth", "float", body.depth);
    else
      set_custom(item, "ductile.profile", "string", section_json(body.profile).dump());
  }
  if (built.built.ground) set_custom(add_body(*built.built.ground, "ground"), "ductile.ground", "bool", true);
  for (std::size_t i = 0; i < plan.wheels.size(); ++i)
    scene["joint"].push_back(wheel_json(plan.wheels[i], *built.built.wheels[i], plan, built));
  for (const PlannedJoint& j : plan.joints) {
    const auto frame = [&](int piece) { return piece < 0 ? Frame{} : Frame{plan.carrier(piece).center}; };
    rube::Json item;
    write_joint(item, plan, j, as, built.body(j.a), built.body(j.b), frame(j.a), frame(j.b));
    scene["joint"].push_back(std::move(item));
  }
  return printed(nlohmann::ordered_json(scene));
}

}  // namespace ductile
