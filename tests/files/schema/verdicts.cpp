// Reads JSON texts from stdin, one a line; says of each whether the reader accepts its form. Or prints the
// tables of fields as JSON, {table: [field…]}.
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "ductile/fields.h"
#include "ductile/files.h"

namespace {

using Json = nlohmann::json;
using namespace ductile;

Json json(double value) { return std::isinf(value) ? Json() : Json(value); }
Json json(const Point& p) { return {p.x, p.y}; }
Json json(bool value) { return value; }
Json json(std::int16_t value) { return value; }
Json json(const std::string&) { return "no default"; }
template <class T>
Json json(const std::optional<T>&) {
  return "no default";
}

template <class Owner, class... Fields>
Json table(const std::tuple<Fields...>& fields) {
  const Owner standard;
  Json list;
  fields::for_each(fields, [&](const auto& field) {
    list.push_back({{"key", field.key},
                    {"unit", field.unit},
                    {"required", field.required},
                    {"default", json(standard.*field.member)}});
  });
  return list;
}

Json tables() {
  return {{"strength", table<Material>(fields::strength)},
          {"substance", table<Material>(fields::substance)},
          {"overrides", table<JointOverrides>(fields::overrides)},
          {"elastic", table<JointOverrides>(fields::elastic)},
          {"body", table<BodyDef>(fields::body)},
          {"joint", table<JointBetweenDef>(fields::joint)},
          {"drive", table<DriveDef>(fields::drive)},
          {"support", table<SupportDef>(fields::support)},
          {"springs", table<SupportDef>(fields::springs)},
          {"load", table<LoadDef>(fields::load)},
          {"wheel", table<WheelDef>(fields::wheel)},
          {"scene", table<SceneDef>(fields::scene)}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "";
  if (kind == "fields") {
    std::cout << tables() << '\n';
    return 0;
  }
  for (std::string line; std::getline(std::cin, line);) {
    try {
      kind == "section" ? void(ductile::parse_section(line)) : void(ductile::parse_scene(line));
      std::cout << "accepted\n";
    } catch (const ductile::InvalidInput& error) {
      std::string what = error.what();
      std::cout << "refused: " << what.substr(0, what.find('\n')) << '\n';
    }
  }
}
