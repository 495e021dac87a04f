// The bodies of a R.U.B.E. scene as bodies of a SceneDef: what their fixtures cover, and what they are made
// of.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/files.h"
#include "rube_outline.h"
#include "rube_reader.h"
#include "section_file.h"

namespace ductile::rube {
namespace {

/// A text that holds JSON: an outline, a section, loads.
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

void place(Outline& outline, const Frame& frame) {
  for (Point& p : outline.outer) p = frame.world(p);
  for (Ring& hole : outline.holes) {
    for (Point& p : hole) p = frame.world(p);
  }
}

double area_of(const BodyDef& body) {
  if (body.circle > 0) return std::numbers::pi * body.circle * body.circle;
  double area = std::abs(doubled_area(body.outline.outer)) / 2;
  for (const Ring& hole : body.outline.holes) area -= std::abs(doubled_area(hole)) / 2;
  return area;
}

/// Could build() make it?
bool can_be_built(const BodyDef& body) {
  if (body.circle > 0) return body.circle >= 2 * b2_linearSlop;
  if (!validate(body.outline).empty()) return false;
  try {
    shapes(Piece{.outline = body.outline});
    return true;
  } catch (const InvalidInput&) {  // too thin
    return false;
  }
}

double distance(Point p, const Ring& ring) {
  double least = unlimited;
  for (std::size_t i = 0; i < ring.size(); ++i)
    least = std::min(least, ductile::distance(p, ring[i], ring[(i + 1) % ring.size()]));
  return least;
}

}  // namespace

double distance(Point p, const Outline& outline, double circle, Point centre) {
  if (circle > 0) return std::max(0.0, length(p - centre) - circle);
  return contains(outline.outer, p) ? 0 : distance(p, outline.outer);
}

bool names_material(const Item& body) {
  return body.custom("ductile.material", {"string"}) || body.custom("ductile.fy", {"float", "int"}) ||
         body.custom("ductile.profile", {"string"});
}

bool Reader::is_ground(int body) const {
  return Item(bodies_[static_cast<std::size_t>(body)].value).custom_boolean("ductile.ground").value_or(false);
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

std::optional<Material> Reader::material(const Item& item) {
  Material m;
  auto given = item.custom(fields::strength, m);
  given.merge(item.custom(fields::substance, m));
  const std::string first = given.empty() ? "" : "has \"ductile." + std::string(*given.begin());
  if (const auto name = item.custom("ductile.material", {"string"})) {
    if (!given.empty())
      item.value().wrong(first + "\" beside \"ductile.material\"", "write one or the other");
    return built_in_material(*name);
  }
  if (!given.contains("fy")) {
    if (!given.empty())
      item.value().wrong(first + "\" without \"ductile.fy\"", "give that, too, or a \"ductile.material\"");
    return std::nullopt;
  }
  if (const auto value = item.custom("ductile.criterion", {"string"})) {
    if (value->json() == "von_mises")
      m.criterion = Criterion::von_mises;
    else if (value->json() != "tresca")
      wrong_choice(*value, {"tresca", "von_mises"});
  }
  return m;
}

/// What a body's solid fixtures cover, in world coordinates: one outline or disc, or several that do not
/// touch. What is too thin to be built is left out.
std::vector<BodyDef> Reader::parts_of(const Body& body) {
  const Item item(body.value);
  std::vector<BodyDef> parts;
  std::vector<const Fixture*> solid;
  std::vector<Ring> polygons;
  for (const Fixture& fixture : body.fixtures) {
    if (fixture.sensor) continue;
    solid.push_back(&fixture);
    if (fixture.kind == Fixture::polygon) polygons.push_back(fixture.points);
  }
  if (const auto given = embedded(item, "ductile.outline", problems_)) {
    Object object(Value(*given, body.value.place() + ".ductile.outline", problems_));
    BodyDef& part = parts.emplace_back();
    if (const auto outer = object.require("outer")) part.outline.outer = outer->ring().value_or(Ring{});
    if (const auto holes = object.find("holes"))
      part.outline.holes = holes->rings().value_or(std::vector<Ring>{});
    place(part.outline, body.frame);
    return parts;
  }
  if (solid.size() == 1 && solid[0]->kind == Fixture::circle) {
    BodyDef& disc = parts.emplace_back();
    disc.circle = solid[0]->radius;
    disc.at = body.frame.world(solid[0]->points[0]);
  } else if (auto whole = polygons.size() == solid.size() ? joined(polygons) : std::nullopt;
             whole && !whole->outer.empty()) {
    parts.emplace_back().outline = std::move(*whole);
    place(parts.back().outline, body.frame);
  } else {
    for (Outline& area : covered(body)) {
      place(area, body.frame);
      parts.emplace_back().outline = std::move(area);
    }
  }
  std::erase_if(parts, [](const BodyDef& part) { return !can_be_built(part); });
  return parts;
}

/// All but the outlines.
void Reader::describe(const Body& body, std::vector<BodyDef>& parts) {
  const Item item(body.value);
  BodyDef common;
  common.type = body.type;
  common.material = material(item);
  common.depth = item.custom_number("ductile.depth", positive).value_or(1);
  if (const auto profile = embedded(item, "ductile.profile", problems_)) {
    common.profile = read_regions(Value(*profile, body.value.place() + ".ductile.profile", problems_));
  }
  if (const auto pieces = item.custom("ductile.pieces", {"int", "string"})) {
    if (pieces->json() == "auto")
      common.automatic = true;
    else if (pieces->json().is_string())
      wrong_choice(*pieces, {"auto"});
    else
      common.pieces = pieces->integer(1, BodyDef::most_pieces).value_or(1);
    if (parts.size() != 1)
      body.value.wrong(parts.empty() ? "has nothing that could be split" : "is in several parts already",
                       "draw it as one polygon, or give its outline as \"ductile.outline\"");
  }
  common.velocity = body.velocity;
  common.angular_velocity = body.angular_velocity;
  if (!common.material && body.type == BodyType::dynamic_body) {
    // A body without material does not govern: stronger than any other, and as heavy as the scene says.
    double area = 0;
    for (const BodyDef& part : parts) area += area_of(part);
    const bool known = body.mass > 0 && area > 0 && std::isfinite(body.mass / area);
    common.material = Material{.yield_stress = 1e30, .density = known ? body.mass / area : 1};
  }
  if (!body.fixtures.empty()) {
    const Item fixture(body.fixtures[0].value);
    common.group = static_cast<std::int16_t>(fixture.integer("filter-groupIndex", -32768, 32767));
    if (common.material) {
      common.material->friction = fixture.number("friction");
      common.material->restitution = fixture.number("restitution");
    }
  }
  for (BodyDef& part : parts) {
    common.outline = std::move(part.outline);
    common.circle = part.circle;
    common.at = part.at;
    common.name = unique(body.name);
    part = common;
  }
}

void Reader::take_part(int index) {
  const Body& body = bodies_[static_cast<std::size_t>(index)];
  if (is_ground(index)) return;
  std::vector<BodyDef> parts = parts_of(body);
  describe(body, parts);
  for (BodyDef& part : parts) {
    def_.bodies.push_back(std::move(part));
    body_of_def_.push_back(index);
  }
  read_loads(index);
}

/// Loads stand in the body's coordinates, so that they go where it is put; their forces in the world's.
void Reader::read_loads(int index) {
  const Body& body = bodies_[static_cast<std::size_t>(index)];
  const auto list = embedded(Item(body.value), "ductile.loads", problems_);
  if (!list) return;
  const Value loads(*list, body.value.place() + ".ductile.loads", problems_);
  for (const Value& value : loads.elements()) {
    if (!value.json().is_object()) return value.wrong("is " + value.shown(), "write an object, {...}");
    Json entry = value.json();
    entry["body"] = body.name;
    LoadDef load;
    Object(Value(entry, value.place(), problems_)).read(fields::load, load);
    load.at = body.frame.world(load.at);
    const auto own = std::find(body_of_def_.begin(), body_of_def_.end(), index);
    if (own == body_of_def_.end())
      return value.wrong("loads a body without a shape", "give the body a fixture that is no sensor");
    load.body = part_at(index, load.at).name;
    def_.loads.push_back(std::move(load));
  }
}

}  // namespace ductile::rube
