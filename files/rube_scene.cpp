// R.U.B.E. scenes calibrated: bodies that name a material become bodies of a SceneDef, their welds joints
// between them; what comes out is written back into the scene.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "built_plan.h"
#include "ductile/files.h"
#include "rube.h"
#include "section_file.h"

namespace ductile::rube {
namespace {

constexpr int most_pieces = 10'000;

/// A text that holds JSON: an outline or a section.
std::optional<Json> embedded(const Item& item, const std::string& name, Problems& problems) {
  const auto value = item.custom(name, {"string"});
  if (!value) return std::nullopt;
  const auto text = value->text();
  if (!text) return std::nullopt;
  try {
    return parse_json(*text, value->place());
  } catch (const InvalidInput& error) {
    for (const Problem& problem : error.problems()) problems.add(problem.place, problem.what, problem.remedy);
  }
  return std::nullopt;
}

bool names_material(const Item& body) {
  return body.custom("ductile.material", {"string"}) || body.custom("ductile.fy", {"float", "int"}) ||
         body.custom("ductile.profile", {"string"});
}

double distance(Point p, const Ring& ring) {
  double least = unlimited;
  for (std::size_t i = 0; i < ring.size(); ++i)
    least = std::min(least, distance(p, ring[i], ring[(i + 1) % ring.size()]));
  return least;
}

/// Reads a scene, calibrates it and writes back what came out.
class Reader {
 public:
  Reader(const Json& original, Scene& scene, Problems& problems)
      : original_(original), scene_(scene), problems_(problems) {}
  void read();

 private:
  struct Between {
    int joint, a, b;  // indices into the scene's lists, by def_.joints
  };

  std::optional<Material> material(const Item& item);
  bool outline(const Body& body, BodyDef& to);
  void take_part(int body);
  void take_part_if_it_can(int body);
  BodyDef definition(const Body& body);
  void joint(int index, const Value& value);
  void values(int index, const Item& item, int a, int b);
  std::string unique(std::string name);
  bool is_ground(int body) const;
  int piece_at(int body, Point at) const;
  void write_bodies();
  void redirect();
  void write_joints();
  void list_what_is_beyond();

  const Json& original_;  // values point into it
  Scene& scene_;
  Problems& problems_;
  std::vector<Body> bodies_;
  SceneDef def_;
  std::vector<bool> needed_;                    // by bodies: a ductile joint is on it
  std::vector<int> def_of_body_, body_of_def_;  // -1: takes no part
  std::vector<Between> between_;
  std::set<std::string> names_;
  std::vector<PlannedJoint> given_;  // joints that have their values; a and b are the scene's bodies
  std::vector<int> given_at_;
  std::vector<std::string> given_reasons_;
};

std::optional<Material> Reader::material(const Item& item) {
  if (const auto name = item.custom("ductile.material", {"string"})) return built_in_material(*name);
  Material m;
  if (!item.custom(fields::strength, m).contains("fy")) return std::nullopt;
  item.custom(fields::substance, m);
  if (const auto value = item.custom("ductile.criterion", {"string"})) {
    if (value->json() == "von_mises")
      m.criterion = Criterion::von_mises;
    else if (value->json() != "tresca")
      wrong_choice(*value, {"tresca", "von_mises"});
  }
  return m;
}

/// In world coordinates. False where the fixtures do not make one.
bool Reader::outline(const Body& body, BodyDef& to) {
  const Item item(body.value);
  if (const auto given = embedded(item, "ductile.outline", problems_)) {
    Object object(Value(*given, body.value.place() + ".ductile.outline", problems_));
    if (const auto outer = object.require("outer")) to.outline.outer = outer->ring().value_or(Ring{});
    if (const auto holes = object.find("holes"))
      to.outline.holes = holes->rings().value_or(std::vector<Ring>{});
  } else {
    std::vector<const Fixture*> solid;
    std::vector<Ring> polygons;
    for (const Fixture& fixture : body.fixtures) {
      if (fixture.sensor) continue;
      solid.push_back(&fixture);
      if (fixture.kind == Fixture::polygon) polygons.push_back(fixture.points);
    }
    if (solid.size() == 1 && solid[0]->kind == Fixture::circle) {
      to.circle = solid[0]->radius;
      to.at = body.frame.world(solid[0]->points[0]);
      return true;
    }
    const auto outline = polygons.size() == solid.size() ? joined(polygons) : std::nullopt;
    if (!outline || outline->outer.empty()) return false;
    to.outline = *outline;
  }
  const auto place = [&](Ring& ring) {
    for (Point& p : ring) p = body.frame.world(p);
  };
  place(to.outline.outer);
  for (Ring& hole : to.outline.holes) place(hole);
  return true;
}

std::string Reader::unique(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || c == '#' || c == '-'; }, '_');
  if (name.empty()) name = "body";
  if (name == "ground") name += "_";
  std::string candidate = name;
  for (int i = 2; !names_.insert(candidate).second; ++i) candidate = name + "_" + std::to_string(i);
  return candidate;
}

BodyDef Reader::definition(const Body& body) {
  const Item item(body.value);
  BodyDef to;
  to.type = body.type;
  if (!outline(body, to))
    body.value.wrong("has fixtures that do not make one outline",
                     "draw it as one polygon or one circle, or give its outline as \"ductile.outline\"");
  to.material = material(item);
  to.depth = item.custom_number("ductile.depth", positive).value_or(1);
  if (const auto profile = embedded(item, "ductile.profile", problems_))
    to.profile = read_regions(Value(*profile, body.value.place() + ".ductile.profile", problems_));
  if (const auto pieces = item.custom("ductile.pieces", {"int"}))
    to.pieces = pieces->integer(1, most_pieces).value_or(1);
  to.velocity = body.velocity;
  to.angular_velocity = body.angular_velocity;
  if (!to.material && body.type == BodyType::dynamic_body) {
    // A body without material does not govern: stronger than any other, and as heavy as the scene says.
    double area = std::abs(doubled_area(to.outline.outer)) / 2;
    for (const Ring& hole : to.outline.holes) area -= std::abs(doubled_area(hole)) / 2;
    if (to.circle > 0) area = std::numbers::pi * to.circle * to.circle;
    const bool known = body.mass > 0 && area > 0 && std::isfinite(body.mass / area);
    to.material = Material{.yield_stress = 1e30, .density = known ? body.mass / area : 1};
  }
  if (!body.fixtures.empty()) {
    const Item fixture(body.fixtures[0].value);
    to.group = static_cast<std::int16_t>(fixture.integer("filter-groupIndex", -32768, 32767));
    if (to.material) {
      to.material->friction = fixture.number("friction");
      to.material->restitution = fixture.number("restitution");
    }
  }
  return to;
}

void Reader::take_part(int index) {
  const Body& body = bodies_[static_cast<std::size_t>(index)];
  def_of_body_[static_cast<std::size_t>(index)] = static_cast<int>(def_.bodies.size());
  def_.bodies.push_back(definition(body));
  def_.bodies.back().name = unique(body.name);
  body_of_def_.push_back(index);
}

/// What ductile does not calibrate is in the plan all the same, where build() could make it.
void Reader::take_part_if_it_can(int index) {
  BodyDef trial;
  if (is_ground(index) || !outline(bodies_[static_cast<std::size_t>(index)], trial)) return;
  try {
    if (trial.circle == 0) {
      if (!validate(trial.outline).empty()) return;
      shapes(Piece{.outline = trial.outline});
    } else if (trial.circle < 2 * b2_linearSlop) {
      return;
    }
    take_part(index);
  } catch (const InvalidInput&) {  // too thin
  }
}

bool Reader::is_ground(int body) const {
  return Item(bodies_[static_cast<std::size_t>(body)].value).custom_boolean("ductile.ground").value_or(false);
}

/// A joint that has its values is taken with them.
void Reader::values(int index, const Item& item, int a, int b) {
  PlannedJoint j;
  j.name = item.text("name");
  j.a = a;
  j.b = b;
  j.Q = j.stiffness.N = j.stiffness.Q = j.stiffness.M = unlimited;
  const auto given = item.custom(fields::calibrated, j);
  if (!given.contains("Nc")) j.Nc = j.N;
  if (!given.contains("M_reverse")) j.M_reverse = j.M;
  item.custom(fields::stiffness, j.stiffness, "ductile.stiffness_");
  const Body& first = bodies_[static_cast<std::size_t>(a)];
  j.anchor = first.frame.world(item.vector("anchorA"));
  if (const auto axis = item.custom("ductile.axis", {"vec2"})) {
    Json holder{{"axis", axis->json()}};
    j.axis = Item(Value(holder, axis->place(), problems_)).vector("axis");
  }
  const double length = std::hypot(j.axis.x, j.axis.y);
  if (!(length > 1e-9))
    item.value().wrong("has no \"ductile.axis\" with a direction",
                       "give one from body A to body B, as a vec2");
  else
    j.axis = {j.axis.x / length, j.axis.y / length};
  for (const double k : {j.stiffness.N, j.stiffness.Q, j.stiffness.M})
    if (!(k > 0)) item.value().wrong("has a stiffness of 0", "give one > 0, or \"unlimited\"");
  given_reasons_.push_back(item.custom_text("ductile.governed_by").value_or("the scene"));
  given_.push_back(std::move(j));
  given_at_.push_back(index);
}

void Reader::joint(int index, const Value& value) {
  const Item item(value);
  if (!value.json().is_object()) return value.wrong("is " + value.shown(), "write an object, {...}");
  const int most = static_cast<int>(bodies_.size()) - 1;
  const int a = item.integer("bodyA", 0, most), b = item.integer("bodyB", 0, most);
  if (most < 0) return value.wrong("joins bodies where there are none", "give the scene bodies");
  if (a == b) return value.wrong("joins body " + std::to_string(a) + " to itself", "give two bodies");
  if (item.custom("ductile.N", {"float", "int", "string"}) ||
      item.custom("ductile.M", {"float", "int", "string"}))
    return values(index, item, a, b);

  const auto named = [&](int body) {
    return names_material(Item(bodies_[static_cast<std::size_t>(body)].value));
  };
  const std::string type = item.text("type");
  const auto wanted = item.custom_boolean("ductile.calibrate");
  if (!wanted.value_or(type == "weld" && (named(a) || named(b)))) return;
  if (type != "weld" && type != "revolute")
    return value.wrong("is a " + type + " joint", "only weld and revolute joints are calibrated");
  if (!named(a) && !named(b))
    return value.wrong("joins two bodies without a material", "name one as \"ductile.material\"");
  for (const Between& other : between_) {
    if (std::minmax(other.a, other.b) != std::minmax(a, b)) continue;
    return value.wrong("joins the bodies of joint[" + std::to_string(other.joint) + "] again",
                       "take it out: bodies are joined along all their common edges, or set its "
                       "\"ductile.calibrate\" to false");
  }
  JointBetweenDef joint;
  needed_[static_cast<std::size_t>(a)] = needed_[static_cast<std::size_t>(b)] = true;
  item.custom(fields::joint, joint);
  item.custom(fields::overrides, joint.overrides);
  joint.overrides.hinge_length = item.custom_number("ductile.hinge_length", positive);
  def_.joints.push_back(std::move(joint));
  between_.push_back({index, a, b});
}

void Reader::read() {
  const Item item(Value(original_, "top level", problems_));
  bodies_ = read_bodies(item);
  problems_.check();
  def_of_body_.assign(bodies_.size(), -1);
  needed_.assign(bodies_.size(), false);
  def_.gravity = item.vector("gravity");
  def_.sleep = item.boolean("allowSleep");
  def_.interaction = item.custom_boolean("ductile.interaction").value_or(false);
  const auto joints = item.list("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) joint(static_cast<int>(i), joints[i]);
  for (const PlannedJoint& j : given_) {
    if (!is_ground(j.a)) needed_[static_cast<std::size_t>(j.a)] = true;
    needed_[static_cast<std::size_t>(j.b)] = true;
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (needed_[i] || Item(bodies_[i].value).custom("ductile.pieces", {"int"}))
      take_part(static_cast<int>(i));
    else
      take_part_if_it_can(static_cast<int>(i));
  }
  problems_.check();
  const auto name = [&](int body) {
    return def_.bodies[static_cast<std::size_t>(def_of_body_[static_cast<std::size_t>(body)])].name;
  };
  for (std::size_t i = 0; i < between_.size(); ++i) {
    def_.joints[i].a = name(between_[i].a);
    def_.joints[i].b = name(between_[i].b);
  }
  scene_.plan = calibrate(def_);
  write_bodies();
  redirect();
  write_joints();
  list_what_is_beyond();
}

/// Bodies that are not split keep what they have, but for their mass where a joint takes their material. The
/// first piece of a split one takes its place, the others come last; all keep its frame, so that every anchor
/// on it stays as it is.
void Reader::write_bodies() {
  Plan& plan = scene_.plan;
  const BuiltPlan built(plan);
  Json& list = scene_.json["body"];
  int number = 0;  // of the piece in its body
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    Piece& piece = plan.pieces[i];
    const BodyDef& def = plan.bodies[static_cast<std::size_t>(piece.body)];
    const int index = body_of_def_[static_cast<std::size_t>(piece.body)];
    const Body& body = bodies_[static_cast<std::size_t>(index)];
    const Item item(body.value);
    number = i > 0 && plan.pieces[i - 1].body == piece.body ? number + 1 : 0;
    scene_.bodies.push_back(number == 0 ? index : static_cast<int>(list.size()));
    if (def.pieces > 1) {
      Json copy = body.value.json();
      copy["name"] = (body.name.empty() ? def.name : body.name) + "/" + std::to_string(number);
      remove_custom(copy, "ductile.pieces");
      remove_custom(copy, "ductile.outline");
      write_piece(copy, plan, static_cast<int>(i), *built.built.bodies[i], body.frame);
      if (number == 0)
        list[static_cast<std::size_t>(index)] = std::move(copy);
      else
        list.push_back(std::move(copy));
      continue;
    }
    if (!body.name.empty() && names_.insert("/" + body.name).second) piece.name = body.name;
    if (def.type != BodyType::dynamic_body) continue;
    const auto calibrated = [&](const Between& pair) { return pair.a == index || pair.b == index; };
    if (names_material(item) && std::any_of(between_.begin(), between_.end(), calibrated)) {
      write_mass(list[static_cast<std::size_t>(index)], *built.built.bodies[i], body.frame);
    } else if (body.mass > 0) {
      const Point c = body.mass_center;
      piece.mass = body.mass;
      piece.center = body.frame.world(c);
      piece.inertia = std::max(0.0, body.inertia - body.mass * (c.x * c.x + c.y * c.y));
    }
  }
}

int Reader::piece_at(int body, Point at) const {
  int nearest = -1;
  double least = unlimited;
  for (std::size_t i = 0; i < scene_.plan.pieces.size(); ++i) {
    const Piece& piece = scene_.plan.pieces[i];
    if (body_of_def_[static_cast<std::size_t>(piece.body)] != body) continue;
    const Ring& ring = piece.outline.outer;
    const double away = ring.empty() || contains(ring, at) ? 0 : distance(at, ring);
    if (nearest < 0 || away < least) {
      nearest = static_cast<int>(i);
      least = away;
    }
  }
  return nearest;
}

/// What was fixed to a body that is in pieces now is fixed to the piece under it.
void Reader::redirect() {
  const Item top(Value(original_, "top level", problems_));
  const auto follow = [&](Json& item, const char* key, const char* anchor, const Value& value) {
    const Item of(value);
    if (!of.has(key)) return;
    const int body = of.integer(key, -1, static_cast<int>(bodies_.size()) - 1, -1);
    if (body < 0 || def_of_body_[static_cast<std::size_t>(body)] < 0) return;
    const int piece = piece_at(body, bodies_[static_cast<std::size_t>(body)].frame.world(of.vector(anchor)));
    item[key] = scene_.bodies[static_cast<std::size_t>(piece)];
  };
  const auto joints = top.list("joint"), images = top.list("image");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    follow(scene_.json["joint"][i], "bodyA", "anchorA", joints[i]);
    follow(scene_.json["joint"][i], "bodyB", "anchorB", joints[i]);
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].json().is_object()) follow(scene_.json["image"][i], "body", "center", images[i]);
  }
}

/// The first joint between two bodies takes the place of the one that was there; further ones come last.
void Reader::write_joints() {
  Plan& plan = scene_.plan;
  const auto body_of = [&](int piece) {
    return body_of_def_[static_cast<std::size_t>(plan.pieces[static_cast<std::size_t>(piece)].body)];
  };
  const auto frame_of = [&](int piece) { return bodies_[static_cast<std::size_t>(body_of(piece))].frame; };
  std::set<int> taken;
  for (PlannedJoint& j : plan.joints) {
    Json& list = scene_.json["joint"];
    int index = -1;
    for (const Between& pair : between_) {
      if (pair.a == body_of(j.a) && pair.b == body_of(j.b) && taken.insert(pair.joint).second)
        index = pair.joint;
    }
    if (index < 0) {
      index = static_cast<int>(list.size());
      list.push_back(Json::object());
    }
    Json& item = list[static_cast<std::size_t>(index)];
    if (const std::string name = item.value("name", ""); !name.empty()) j.name = name;
    write_joint(item, plan, j, scene_.bodies[static_cast<std::size_t>(j.a)],
                scene_.bodies[static_cast<std::size_t>(j.b)], frame_of(j.a), frame_of(j.b));
    scene_.joints.push_back(index);
  }
  for (std::size_t i = 0; i < given_.size(); ++i) {
    PlannedJoint j = given_[i];
    j.a = is_ground(j.a) ? -1 : piece_at(j.a, j.anchor);
    j.b = piece_at(j.b, j.anchor);
    if (j.name.empty()) j.name = "joint[" + std::to_string(given_at_[i]) + "]";
    const auto reason = std::find(plan.reasons.begin(), plan.reasons.end(), given_reasons_[i]);
    j.governed_by = static_cast<int>(reason - plan.reasons.begin());
    if (reason == plan.reasons.end()) plan.reasons.push_back(given_reasons_[i]);
    plan.joints.push_back(std::move(j));
    scene_.joints.push_back(given_at_[i]);
  }
}

void Reader::list_what_is_beyond() {
  const auto beyond = [&](const Value& value, const std::string& what) {
    scene_.beyond_plan.push_back(
        {value.place(), what + ", which this command knows nothing of",
         "take it out, or run the scene in a game: ductile::load() takes all of it"});
  };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (def_of_body_[i] < 0 && !is_ground(static_cast<int>(i)))
      beyond(bodies_[i].value, "has fixtures that do not make one outline, or are too thin");
  }
  const auto joints = Item(Value(original_, "top level", problems_)).list("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (std::find(scene_.joints.begin(), scene_.joints.end(), static_cast<int>(i)) == scene_.joints.end())
      beyond(joints[i], "is a " + Item(joints[i]).text("type") + " joint");
  }
}

}  // namespace

Scene read(const Json& json, const std::string& name) {
  Problems problems(name);
  Scene scene;
  scene.json = json;
  try {
    Reader(json, scene, problems).read();
  } catch (const InvalidInput& error) {
    problems.check();  // those have their file already
    for (const Problem& problem : error.problems()) problems.add(problem.place, problem.what, problem.remedy);
  }
  problems.check();
  for (Problem& problem : scene.beyond_plan) problem.place = name + ":" + problem.place;
  return scene;
}

}  // namespace ductile::rube
