#include "rube.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace ductile::rube {

namespace {
/// A directed edge; equal coordinates are equal bits, as the editor cuts a polygon into parts.
using Edge = std::array<double, 4>;

}  // namespace

std::optional<Outline> joined(const std::vector<Ring>& polygons) {
  std::set<Edge> edges;
  for (Ring ring : polygons) {
    if (ring.size() < 3) return std::nullopt;
    if (doubled_area(ring) < 0) std::reverse(ring.begin(), ring.end());
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point a = ring[i], b = ring[(i + 1) % ring.size()];
      if (edges.erase({b.x, b.y, a.x, a.y}) == 0 && !edges.insert({a.x, a.y, b.x, b.y}).second)
        return std::nullopt;
    }
  }
  std::map<std::array<double, 2>, Point> next;
  for (const Edge& e : edges) {
    if (!next.insert({{e[0], e[1]}, {e[2], e[3]}}).second) return std::nullopt;  // two rings touch
  }
  Outline outline;
  while (!next.empty()) {
    Ring ring;
    for (auto at = next.begin(); at != next.end();) {
      ring.push_back({at->first[0], at->first[1]});
      const Point to = at->second;
      next.erase(at);
      at = next.find({to.x, to.y});
    }
    if (doubled_area(ring) < 0) {
      outline.holes.push_back(std::move(ring));
    } else if (outline.outer.empty()) {
      outline.outer = std::move(ring);
    } else {
      return std::nullopt;
    }
  }
  return outline;
}

std::optional<double> read_float(const Value& value) {
  constexpr const char* remedy = "write a number that a float holds, or its 8 hex digits";
  double number = 0;
  if (value.json().is_string()) {
    const auto& text = value.json().get_ref<const std::string&>();
    std::uint32_t bits = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bits, 16);
    if (text.size() != 8 || error != std::errc() || end != text.data() + text.size())
      return value.wrong("is " + value.shown(), remedy), std::nullopt;
    number = std::bit_cast<float>(bits);
  } else if (value.json().is_number()) {
    number = value.json().get<double>();
  } else {
    return value.wrong("is " + value.shown(), remedy), std::nullopt;
  }
  if (!(std::abs(number) <= std::numeric_limits<float>::max()))
    return value.wrong("is " + value.shown(), remedy), std::nullopt;
  return number;
}

namespace {

std::optional<Point> read_vector(const Value& value) {
  if (value.json().is_number() && value.json() == 0) return Point{};
  if (!value.json().is_object())
    return value.wrong("is " + value.shown(), R"(write {"x": …, "y": …}, or 0)"), std::nullopt;
  const Item item(value);
  return Point{item.number("x"), item.number("y")};
}

Fixture read_fixture(const Value& value) {
  Fixture fixture{.value = value};
  const Item item(value);
  fixture.sensor = item.boolean("sensor");
  const auto take = [&](const char* key, Fixture::Kind kind) {
    if (!item.has(key)) return false;
    const Item shape(item.at(key));
    fixture.kind = kind;
    if (kind == Fixture::circle) {
      fixture.points = {shape.vector("center")};
      fixture.radius = shape.number("radius");
      if (!(fixture.radius > 0)) shape.value().wrong("has no radius", "write a radius > 0");
    } else if (kind == Fixture::edge) {
      fixture.points = {shape.vector("vertex1"), shape.vector("vertex2")};
    } else {
      fixture.points = shape.vectors("vertices");
      if (fixture.points.empty())
        shape.value().wrong("has no vertices", R"(write "vertices": {"x": […], "y": […]})");
    }
    return true;
  };
  if (!take("polygon", Fixture::polygon) && !take("circle", Fixture::circle) &&
      !take("chain", Fixture::chain) && !take("loop", Fixture::chain) && !take("edge", Fixture::edge))
    value.wrong("has no shape that is known", "known are: polygon, circle, chain, loop, edge");
  return fixture;
}

Body read_body(const Value& value) {
  constexpr BodyType types[] = {BodyType::static_body, BodyType::kinematic_body, BodyType::dynamic_body};
  Body body{.value = value};
  if (!value.json().is_object()) value.wrong("is " + value.shown(), "write an object, {...}");
  const Item item(value);
  body.name = item.text("name");
  body.type = types[item.integer("type", 0, 2)];
  body.frame = {item.vector("position"), item.number("angle")};
  body.velocity = item.vector("linearVelocity");
  body.angular_velocity = item.number("angularVelocity");
  body.mass = item.number("massData-mass");
  body.inertia = item.number("massData-I");
  body.mass_center = item.vector("massData-center");
  for (const Value& fixture : item.list("fixture")) body.fixtures.push_back(read_fixture(fixture));
  return body;
}

}  // namespace

bool Item::has(const char* key) const { return value_.json().is_object() && value_.json().contains(key); }
Value Item::at(const char* key) const {
  const std::string& here = value_.place();
  return {value_.json()[key], here == "top level" ? key : here + "." + key, value_.problems()};
}
double Item::number(const char* key, double missing) const {
  return has(key) ? read_float(at(key)).value_or(missing) : missing;
}
Point Item::vector(const char* key) const {
  return has(key) ? read_vector(at(key)).value_or(Point{}) : Point{};
}
bool Item::boolean(const char* key, bool missing) const {
  return has(key) ? at(key).boolean().value_or(missing) : missing;
}
std::string Item::text(const char* key) const { return has(key) ? at(key).text().value_or("") : ""; }
int Item::integer(const char* key, int low, int high, int missing) const {
  return has(key) ? at(key).integer(low, high).value_or(missing) : missing;
}
std::optional<int> Item::index(const char* key, int most) const {
  return has(key) ? at(key).integer(0, most) : 0;
}
std::vector<Value> Item::list(const char* key) const {
  return has(key) ? at(key).elements() : std::vector<Value>{};
}
std::vector<Point> Item::vectors(const char* key) const {
  if (!has(key)) return {};
  const Item both(at(key));
  const auto x = both.list("x"), y = both.list("y");
  if (x.size() != y.size()) both.value().wrong("has more of x than of y, or less", "write as many of both");
  std::vector<Point> points;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i)
    points.push_back({read_float(x[i]).value_or(0), read_float(y[i]).value_or(0)});
  return points;
}

std::optional<Value> Item::custom(const std::string& name, std::initializer_list<const char*> types) const {
  if (!has("customProperties")) return std::nullopt;
  for (const Value& property : list("customProperties")) {
    const Item item(property);
    if (!item.has("name") || property.json()["name"] != name) continue;
    for (const char* type : types) {
      if (item.has(type)) return item.at(type);
    }
    std::string known;
    for (const char* type : types) known.append(known.empty() ? "" : " or ").append(type);
    property.wrong("is \"" + name + "\" without a value of its type", "write it as " + known);
  }
  return std::nullopt;
}
std::optional<double> Item::custom_number(const std::string& name, const Range& range) const {
  Range finite = range;
  finite.null.reset();
  std::optional<Value> value;
  std::string words;
  if (range.null == unlimited) {
    value = custom(name, {"float", "int", "string"});
    if (value && value->json() == "unlimited") return unlimited;
    words = std::string(range.words) + ", or \"unlimited\" as a string";
    finite.words = words.c_str();
  } else {
    value = custom(name, {"float", "int"});
  }
  if (!value || !value->json().is_string()) return value ? value->number(finite, unlimited) : std::nullopt;
  const auto number = read_float(*value);
  return number ? Value(Json(*number), value->place(), value->problems()).number(finite, unlimited)
                : std::nullopt;
}
bool Item::read_custom(const std::string& name, const Range& range, double& target) const {
  const auto value = custom_number(name, range);
  target = value.value_or(target);
  return value.has_value();
}
bool Item::read_custom(const std::string& name, const Range& range, std::optional<double>& target) const {
  target = custom_number(name, range);
  return target.has_value();
}
bool Item::read_custom(const std::string& name, const Range&, bool& target) const {
  const auto value = custom_boolean(name);
  target = value.value_or(target);
  return value.has_value();
}
bool Item::read_custom(const std::string& name, const Range&, std::optional<bool>& target) const {
  target = custom_boolean(name);
  return target.has_value();
}
std::optional<std::string> Item::custom_text(const std::string& name) const {
  const auto value = custom(name, {"string"});
  return value ? value->text() : std::nullopt;
}
std::optional<bool> Item::custom_boolean(const std::string& name) const {
  const auto value = custom(name, {"bool"});
  return value ? value->boolean() : std::nullopt;
}

std::vector<Body> read_bodies(const Item& scene) {
  std::vector<Body> bodies;
  for (const Value& value : scene.list("body")) bodies.push_back(read_body(value));
  return bodies;
}

void set_custom(Json& item, const std::string& name, const char* type, Json value) {
  Json& list = item["customProperties"];
  for (Json& property : list) {
    if (property.is_object() && property.value("name", Json()) == name) {
      property = {{"name", name}, {type, std::move(value)}};
      return;
    }
  }
  list.push_back({{"name", name}, {type, std::move(value)}});
}

void set_custom(Json& item, const std::string& name, double value) {
  if (std::isinf(value)) return set_custom(item, name, "string", "unlimited");
  set_custom(item, name, "float", value);
}

void remove_custom(Json& item, const std::string& name) {
  if (!item.contains("customProperties")) return;
  Json& list = item["customProperties"];
  for (auto property = list.begin(); property != list.end();)
    property = property->is_object() && property->value("name", Json()) == name ? list.erase(property)
                                                                                : std::next(property);
}

bool is_scene(const Json& json) {
  if (!json.is_object() || json.contains("bodies") || json.contains("regions")) return false;
  for (const char* key :
       {"body", "joint", "image", "stepsPerSecond", "warmStarting", "metaworld", "metabody"}) {
    if (json.contains(key)) return true;
  }
  return false;
}

}  // namespace ductile::rube
