// The joints of a R.U.B.E. scene: which are calibrated, and across which section.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/files.h"
#include "rube_outline.h"
#include "rube_reader.h"
#include "rube_section.h"

namespace ductile::rube {

namespace {

constexpr double coincident = 1e-6;  // of the smaller body's size: as calibrate() has it

double size_of(const BodyDef& body) {
  return body.circle > 0 ? 2 * body.circle : bounds_of(body.outline.outer).diagonal();
}

Outline outline_of(const BodyDef& body) {
  return body.circle == 0 ? body.outline : Outline{.outer = disc(body.at, body.circle)};
}

/// The body whose section a joint has: one that moves before one that does not, then the smaller one.
const BodyDef& smaller(const BodyDef& a, const BodyDef& b) {
  const auto rank = [](const BodyDef& body) {
    return std::pair(body.type != BodyType::dynamic_body, std::abs(doubled_area(outline_of(body).outer)));
  };
  return rank(b) < rank(a) ? b : a;
}

}  // namespace

/// The part of a body that is nearest to a point.
const BodyDef& Reader::part_at(int body, Point at) const {
  const BodyDef* nearest = nullptr;
  double least = unlimited;
  for (std::size_t i = 0; i < def_.bodies.size(); ++i) {
    if (body_of_def_[i] != body) continue;
    const BodyDef& part = def_.bodies[i];
    const double away = distance(at, part.outline, part.circle, part.at);
    if (nearest && away >= least) continue;
    nearest = &part;
    least = away;
  }
  return *nearest;
}

/// Of a joint that has one.
std::optional<RateLaw> Reader::rate(const Item& item) const {
  RateLaw law;
  bool given = false;
  for (const Row row : {axial, shear, rotation})
    if (const auto D = item.custom_number(std::string("ductile.") + doubling_rates[row],
                                          {0, true, unlimited, "a number > 0"}))
      law.doubling[row] = *D, given = true;
  if (const auto q =
          item.custom_number(std::string("ductile.") + rate_exponent, {1, false, {}, "a number >= 1"}))
    law.exponent = *q;
  if (given && def_.interaction)
    item.value().wrong("depends on the rate of strain, and the scene has \"ductile.interaction\"",
                       "leave one of both out");
  return given ? std::optional(law) : std::nullopt;
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
  j.rate = rate(item);
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
  for (const int body : {a, b}) {
    if (is_ground(body)) continue;
    if (std::find(body_of_def_.begin(), body_of_def_.end(), body) == body_of_def_.end())
      item.value().wrong("joins body " + std::to_string(body) + ", which has no shape",
                         "give that body a fixture that is no sensor");
  }
  if (is_ground(b)) item.value().wrong("has the ground as body B", "make it body A");
  given_reasons_.push_back(item.custom_text("ductile.governed_by").value_or("the scene"));
  given_.push_back(std::move(j));
  given_at_.push_back(index);
}

/// A weld of a body that names a material is calibrated, and so is a revolute joint, as a pin, unless a limit
/// or a motor drives it: what those do, no row does. A motor that only brakes is the pin's plastic moment.
void Reader::joint(int index, const Value& value) {
  const Item item(value);
  if (!value.json().is_object()) return value.wrong("is " + value.shown(), "write an object, {...}");
  const int most = static_cast<int>(bodies_.size()) - 1;
  if (most < 0) return value.wrong("joins bodies where there are none", "give the scene bodies");
  const std::optional<int> of_a = item.index("bodyA", most), of_b = item.index("bodyB", most);
  if (!of_a || !of_b) return;
  const int a = *of_a, b = *of_b;
  if (a == b) return value.wrong("joins body " + std::to_string(a) + " to itself", "give two bodies");
  if (item.custom("ductile.N", {"float", "int", "string"}) ||
      item.custom("ductile.M", {"float", "int", "string"}))
    return values(index, item, a, b);

  const auto named = [&](int body) {
    return names_material(Item(bodies_[static_cast<std::size_t>(body)].value));
  };
  const auto shaped = [&](int body) {
    return std::find(body_of_def_.begin(), body_of_def_.end(), body) != body_of_def_.end();
  };
  const std::string type = item.text("type");
  const auto wanted = item.custom_boolean("ductile.calibrate");
  const bool brakes = item.boolean("enableMotor") && item.number("motorSpeed") == 0;
  const bool pin = type == "revolute" && !wanted;
  if (wanted == false) return;
  if (!wanted) {
    if (type != "weld" && type != "revolute") return;
    if (pin && (item.boolean("enableLimit") || (item.boolean("enableMotor") && !brakes))) return;
    if (!(named(a) || named(b)) || !shaped(a) || !shaped(b)) return;
  }
  if (type != "weld" && type != "revolute")
    return value.wrong("is a " + type + " joint", "only weld and revolute joints are calibrated");
  if (!named(a) && !named(b))
    return value.wrong("joins two bodies without a material", "name one as \"ductile.material\"");
  if (!shaped(a) || !shaped(b))
    return value.wrong("joins a body without a shape", "give both bodies fixtures that are no sensors");
  JointBetweenDef joint;
  item.custom(fields::joint, joint);
  JointOverrides& overrides = joint.overrides;
  item.custom(fields::overrides, overrides);
  overrides.hinge_length = item.custom_number("ductile.hinge_length", positive);
  overrides.shear_span = item.custom_number("ductile.shear_span", positive);
  if (pin && !overrides.moment) {
    overrides.moment = brakes ? std::max(0.0, item.number("maxMotorTorque")) : 0;
    if (!overrides.max_rotation) overrides.max_rotation = unlimited;
  }
  const Point anchor = bodies_[static_cast<std::size_t>(a)].frame.world(item.vector("anchorA"));
  def_.joints.push_back(std::move(joint));
  between_.push_back({index, a, b, anchor, pin});
}

/// Along the common edges of two bodies, where they have such and one weld; else across the smaller one at
/// the anchor.
void Reader::find_section(JointBetweenDef& joint, const Between& between) {
  const BodyDef &a = part_at(between.a, between.anchor), &b = part_at(between.b, between.anchor);
  joint.a = a.name;
  joint.b = b.name;
  const auto same = std::count_if(between_.begin(), between_.end(), [&](const Between& other) {
    return std::minmax(other.a, other.b) == std::minmax(between.a, between.b);
  });
  const double gap = joint.gap > 0 ? joint.gap : coincident * std::min(size_of(a), size_of(b));
  if (!between.pin && same == 1 && share_an_edge(outline_of(a), outline_of(b), gap)) return;
  const auto cut = cut_at(outline_of(smaller(a, b)), between.anchor);
  if (!cut) {
    problems_.add("joint[" + std::to_string(between.joint) + "]", "has no section in either of its bodies",
                  "put its anchor on one of them, or set its \"ductile.calibrate\" to false");
    return;
  }
  auto [from, to] = *cut;
  if (between.pin) {  // it turns about its anchor
    const Point half = 0.5 * (to - from);
    from = between.anchor - half;
    to = between.anchor + half;
  }
  joint.across = {from, to};
}

void Reader::read() {
  const Item item(Value(original_, "top level", problems_));
  bodies_ = read_bodies(item);
  refuse_unknown_properties(item);
  problems_.check();
  def_.gravity = item.vector("gravity");
  def_.gravity_ramp = item.custom_number("ductile.gravity_ramp", not_negative).value_or(0);
  def_.sleep = item.boolean("allowSleep");
  def_.interaction = item.custom_boolean("ductile.interaction").value_or(false);
  def_.target_error = item.custom_number("ductile.target_error", positive).value_or(def_.target_error);
  for (std::size_t i = 0; i < bodies_.size(); ++i) take_part(static_cast<int>(i));
  const auto joints = item.list("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) joint(static_cast<int>(i), joints[i]);
  problems_.check();
  for (std::size_t i = 0; i < between_.size(); ++i) find_section(def_.joints[i], between_[i]);
  problems_.check();
  scene_.plan = calibrate(def_);
  unite_parts();
  write_bodies();
  redirect();
  write_joints();
  list_what_is_beyond();
}

void Reader::list_what_is_beyond() {
  const auto joints = Item(Value(original_, "top level", problems_)).list("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (std::find(scene_.joints.begin(), scene_.joints.end(), static_cast<int>(i)) == scene_.joints.end())
      scene_.beyond_plan.push_back({joints[i].place(),
                                    "is a " + Item(joints[i]).text("type") + " joint that is not calibrated",
                                    "take it out, or run the level: ductile simulate and ductile::load() "
                                    "take it as it is"});
  }
}

Scene read(const Json& json, const std::string& name, StockJoint as) {
  if (json.contains("metaworld") || json.contains("metabody")) {
    throw InvalidInput({{name, "is a project of the R.U.B.E. editor, not a level",
                         "export it from there as JSON (File > Export)"}});
  }
  Problems problems(name);
  Scene scene;
  scene.json = json;
  try {
    Reader(json, scene, as, problems).read();
  } catch (const InvalidInput& error) {
    problems.check();  // those have their file already
    for (const Problem& problem : error.problems()) problems.add(problem.place, problem.what, problem.remedy);
  }
  problems.check();
  for (Problem& problem : scene.beyond_plan) problem.place = name + ":" + problem.place;
  return scene;
}

}  // namespace ductile::rube
