// A plan as C++: the source of one function that makes its bodies and ductile joints in a world.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include "built_plan.h"
#include "ductile/box2d.h"
#include "ductile/definitions.h"

namespace ductile {
namespace {

/// The shortest text that reads back as the same number.
template <class T>
std::string digits(T value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// Always with a point, so that it is no int: a large one would not compile, and -0 lose its sign.
std::string literal(double value) {
  if (std::isinf(value)) return value < 0 ? "-unlimited" : "unlimited";
  const std::string text = digits(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}
std::string literal(float value) {
  const std::string text = digits(value);
  return (text.find_first_of(".e") == std::string::npos ? text + ".0" : text) + "f";
}
std::string literal(const b2Vec2& v) { return "{" + literal(v.x) + ", " + literal(v.y) + "}"; }

/// Names may hold anything; a comment ends with its line.
std::string comment(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\'; }, ' ');
  return "  // " + name + "\n";
}

/// Likewise in quotes.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (code >= 0x20 && code != 0x7f && c != '"' && c != '\\') {
      text += c;
    } else {  // in octal
      text += '\\';
      for (const int shift : {6, 3, 0}) text += static_cast<char>('0' + (code >> shift & 7));
    }
  }
  return text + "\"";
}

std::string shape(const b2Fixture& fixture) {
  if (fixture.GetType() == b2Shape::e_circle) {
    const auto& disc = static_cast<const b2CircleShape&>(*fixture.GetShape());
    return "disc(" + literal(disc.m_radius) + ", " + literal(disc.m_p) + ")";
  }
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  std::string list;
  for (int i = 0; i < polygon.m_count; ++i) list += (i ? ", " : "") + literal(polygon.m_vertices[i]);
  return "polygon({" + list + "})";
}

std::string row(const RowDef& row) {
  std::string text = "{" + literal(row.stiffness) + ", " + literal(row.damping_ratio) + ", " +
                     literal(row.cap) + ", " + literal(row.cap_reverse) + ", " + literal(row.hardening) +
                     ", " + literal(row.damping);
  if (row.slackens || row.drive) text += row.slackens ? ", true" : ", false";
  if (row.drive)
    text += ", ductile::Drive{" + literal(row.drive->target) + ", " + literal(row.drive->speed) + "}";
  return text + "}";
}

// What every source begins with: one line per body, fixture and joint then suffices.
constexpr const char* tools = R"(
  struct Level {
    ductile::Structure structure;
    std::vector<std::pair<std::string, b2Body*>> bodies;  // by the names of their pieces
    std::vector<std::pair<std::string, ductile::ElasticPlasticJoint*>> joints;
    std::vector<std::pair<std::string, b2WheelJoint*>> motors;  // by the names of their wheels
  };
  Level level{ductile::Structure(world), {}, {}, {}};
  [[maybe_unused]] constexpr double unlimited = ductile::unlimited;
  const auto body = [&](b2BodyType type, b2Vec2 position, b2Vec2 velocity, float spin, bool sleep) {
    b2BodyDef def;
    def.type = type;
    def.position = position;
    def.linearVelocity = velocity;
    def.angularVelocity = spin;
    def.allowSleep = sleep;
    return world.CreateBody(&def);
  };
  [[maybe_unused]] const auto polygon = [](std::initializer_list<b2Vec2> vertices) {
    b2PolygonShape shape;
    shape.Set(vertices.begin(), static_cast<int32>(vertices.size()));
    return shape;
  };
  [[maybe_unused]] const auto disc = [](float radius, b2Vec2 center) {
    b2CircleShape shape;
    shape.m_radius = radius;
    shape.m_p = center;
    return shape;
  };
  const auto fixture = [](b2Body* of, const b2Shape& shape, float friction, float restitution, float density, int16 group) {
    b2FixtureDef def;
    def.shape = &shape;
    def.friction = friction;
    def.restitution = restitution;
    def.filter.groupIndex = group;
    of->CreateFixture(&def)->SetDensity(density);  // for later: the mass is set below
  };
  [[maybe_unused]] const auto mass = [](b2Body* of, float kilograms, float inertia) {
    const b2MassData data{kilograms, {0, 0}, inertia};
    of->SetMassData(&data);
  };
)";

constexpr const char* joint_tool = R"(
  struct Limits {
    double rotation, elongation, compression, slip;
  };
  [[maybe_unused]] const auto joint = [&](const char* name, int node, b2Body* a, b2Body* b, b2Vec2 anchor_a, b2Vec2 anchor_b, float axis, float follow,
                                          ductile::RowDef axial, ductile::RowDef shear, ductile::RowDef rotation, Limits limits,
                                          std::vector<ductile::AxialMoment> interaction = {}, double line = -1,
                                          std::optional<ductile::RateLaw> rate = {}) {
    ductile::ElasticPlasticJointDef def;
    def.bodyA = a;
    def.bodyB = b;
    def.localAnchorA = anchor_a;
    def.localAnchorB = anchor_b;
    def.axisAngle = axis;
    def.axisFollow = follow;
    def.rows[ductile::axial] = axial;
    def.rows[ductile::shear] = shear;
    def.rows[ductile::rotation] = rotation;
    def.max_rotation = limits.rotation;
    def.max_elongation = limits.elongation;
    def.max_compression = limits.compression;
    def.max_slip = limits.slip;
    def.interaction = std::move(interaction);
    def.node = node;
    def.line = def.collideConnected = line >= 0;
    def.length = line;
    def.rate = rate;
    level.joints.emplace_back(name, level.structure.create_joint(def));
  };
)";

}  // namespace

std::string function_name(const std::string& scene) {
  std::string name = "build_" + scene;
  const auto in_no_name = [](char c) {
    return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'));
  };
  std::replace_if(name.begin(), name.end(), in_no_name, '_');
  return name;
}

std::string cpp_text(const Plan& plan, const std::string& function) {
  BuiltPlan built(plan);
  constexpr const char* types[] = {"b2_staticBody", "b2_kinematicBody", "b2_dynamicBody"};
  std::string bodies, names, fixtures, joints, wheels;
  int lowest_group = 0;
  const auto add_body = [&](const b2Body& body, const std::string& name) {
    bodies += std::string("      body(") + types[body.GetType()] + ", " + literal(body.GetPosition()) + ", " +
              literal(body.GetLinearVelocity()) + ", " + literal(body.GetAngularVelocity()) + ", " +
              (body.IsSleepingAllowed() ? "true" : "false") + ")," + comment(name);
  };
  const auto body_at = [&](int piece) { return "bodies[" + std::to_string(built.body(piece)) + "]"; };
  for (const int piece : built.carriers) {
    const b2Body& body = *built.built.bodies[static_cast<std::size_t>(piece)];
    const std::string of = body_at(piece);
    add_body(body,
             std::to_string(built.body(piece)) + ": " + plan.pieces[static_cast<std::size_t>(piece)].name);
    for (const b2Fixture* fixture : fixtures_of(body)) {
      const int group = fixture->GetFilterData().groupIndex;
      lowest_group = std::min(lowest_group, group);
      fixtures += "  fixture(" + of + ", " + shape(*fixture) + ", " + literal(fixture->GetFriction()) + ", " +
                  literal(fixture->GetRestitution()) + ", " + literal(fixture->GetDensity()) + ", " +
                  std::to_string(group) + ");\n";
    }
    if (body.GetType() == b2_dynamicBody)
      fixtures +=
          "  mass(" + of + ", " + literal(body.GetMass()) + ", " + literal(body.GetInertia()) + ");\n";
  }
  if (built.built.ground) add_body(*built.built.ground, "ground");
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    names += "      {" + quoted(plan.pieces[i].name) + ", " + body_at(static_cast<int>(i)) + "},\n";
  for (std::size_t i = 0; i < plan.wheels.size(); ++i) {
    const b2WheelJoint& w = *built.built.wheels[i];
    wheels += "  {\n    b2WheelJointDef def;\n    def.bodyA = " + body_at(plan.wheels[i].chassis) +
              ";\n    def.bodyB = " + body_at(plan.wheels[i].wheel) +
              ";\n    def.localAnchorA = " + literal(w.GetLocalAnchorA()) +
              ";\n    def.localAnchorB = " + literal(w.GetLocalAnchorB()) +
              ";\n    def.localAxisA = " + literal(w.GetLocalAxisA()) +
              ";\n    def.stiffness = " + literal(w.GetStiffness()) +
              ";\n    def.damping = " + literal(w.GetDamping()) +
              ";\n    def.enableMotor = true;\n    def.motorSpeed = " + literal(w.GetMotorSpeed()) +
              ";\n    def.maxMotorTorque = " + literal(w.GetMaxMotorTorque()) +
              ";\n    level.motors.emplace_back(" +
              quoted(plan.pieces[static_cast<std::size_t>(plan.wheels[i].wheel)].name) +
              ", static_cast<b2WheelJoint*>(world.CreateJoint(&def)));\n  }\n";
  }
  for (const PlannedJoint& j : plan.joints) {
    const ElasticPlasticJointDef def = elastic_plastic_def(plan, j);
    joints += "  joint(" + quoted(j.name) + ", " + std::to_string(j.node) + ", " + body_at(j.a) + ", " +
              body_at(j.b) + ", " + literal(def.localAnchorA) + ", " + literal(def.localAnchorB) + ", " +
              literal(def.axisAngle) + ", " + literal(def.axisFollow) + ", " + row(def.rows[axial]) + ", " +
              row(def.rows[shear]) + ", " + row(def.rows[rotation]) + ", {" + literal(def.max_rotation) +
              ", " + literal(def.max_elongation) + ", " + literal(def.max_compression) + ", " +
              literal(def.max_slip) + "}";
    std::string points;
    for (const AxialMoment& p : def.interaction)
      points += (points.empty() ? "{" : ", {") + literal(p.N) + ", " + literal(p.M) + "}";
    if (!points.empty() || def.line || def.rate) joints += ", {" + points + "}";
    if (def.line || def.rate) joints += ", " + literal(def.length);
    if (def.rate) {
      const auto& D = def.rate->doubling;
      joints += ", ductile::RateLaw{{" + literal(D[axial]) + ", " + literal(D[shear]) + ", " +
                literal(D[rotation]) + "}, " + literal(def.rate->exponent) + "}";
    }
    joints += ");\n";
  }

  std::string text =
      "// Written by `ductile calibrate --to cpp`. Needs Box2D 2.4 and ductile::joint, no other part of "
      "ductile.\n"
      "#include <box2d/box2d.h>\n#include <ductile/joint.h>\n\n#include <initializer_list>\n#include "
      "<optional>\n#include <string>\n#include <utility>\n#include <vector>\n\n"
      "// Makes bodies and joints in `world`, which owns them, and tells them by name. Call "
      "structure.update() "
      "after each\n// Step.\n";
  if (lowest_group < 0) text += "// Uses the collision groups -1 to " + std::to_string(lowest_group) + ".\n";
  for (const std::string& lost : lost_in_definitions(plan)) text += comment("Not in it: " + lost).substr(2);
  text += "inline auto " + function + "(b2World& world) {";
  text += tools;
  text += "\n  world.SetGravity(" + literal(to_box2d(plan.gravity)) + ");\n";
  if (!bodies.empty()) text += "  b2Body* const bodies[] = {\n" + bodies + "  };\n";
  if (!names.empty()) fixtures = "  level.bodies = {\n" + names + "  };\n" + fixtures;
  return text + fixtures + wheels + joint_tool + joints + "  return level;\n}\n";
}

}  // namespace ductile
