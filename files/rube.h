// R.U.B.E. scenes: the JSON that the editor exports (iforce2d.net/rube/json-structure).
//
// What is missing is 0, false or ""; a zero vector is 0; a float may be a text of 8 hex digits, its IEEE
// bits. What stands there and is not understood stays as it is.
#pragma once

#include <box2d/box2d.h>

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "ductile/calibrate.h"
#include "ductile/definitions.h"
#include "ductile/plane.h"
#include "json.h"

namespace ductile::rube {

using Json = nlohmann::json;

/// An object of a scene. Every reader complains where it stands, and then returns what stands for missing.
class Item {
 public:
  explicit Item(const Value& value) : value_(value) {}
  const Value& value() const { return value_; }

  bool has(const char* key) const;
  Value at(const char* key) const;  ///< of a key that it has
  double number(const char* key, double missing = 0) const;
  Point vector(const char* key) const;
  bool boolean(const char* key, bool missing = false) const;
  std::string text(const char* key) const;
  int integer(const char* key, int low, int high, int missing = 0) const;
  /// Of a body, 0 where the key is missing; none where it is no such number, which is told.
  std::optional<int> index(const char* key, int most) const;
  std::vector<Value> list(const char* key) const;
  /// {"x": […], "y": […]}
  std::vector<Point> vectors(const char* key) const;

  /// A custom property of one of these types, which its name does not tell.
  std::optional<Value> custom(const std::string& name, std::initializer_list<const char*> types) const;
  /// Infinity, where it is in the range, is the text "unlimited".
  std::optional<double> custom_number(const std::string& name, const Range& range) const;
  std::optional<std::string> custom_text(const std::string& name) const;
  std::optional<bool> custom_boolean(const std::string& name) const;
  /// The fields of a table that are there, as custom properties "ductile." + key. Says which.
  template <class Owner, class... Fields>
  std::set<std::string_view> custom(const std::tuple<Fields...>& table, Owner& target,
                                    const std::string& prefix = "ductile.") const {
    std::set<std::string_view> given;
    fields::for_each(table, [&](const auto& field) {
      if (read_custom(prefix + field.key, field.range, target.*field.member)) given.insert(field.key);
    });
    return given;
  }

 private:
  bool read_custom(const std::string& name, const Range& range, double& target) const;
  bool read_custom(const std::string& name, const Range& range, std::optional<double>& target) const;
  bool read_custom(const std::string& name, const Range& range, bool& target) const;
  bool read_custom(const std::string& name, const Range& range, std::optional<bool>& target) const;
  Value value_;
};

struct Fixture {
  enum Kind { polygon, circle, chain, edge } kind = polygon;
  std::vector<Point> points;  ///< of the polygon or chain, of the edge two; of the circle its centre
  double radius = 0;
  bool sensor = false;
  Value value;
};

struct Body {
  Value value;
  std::string name;
  BodyType type = BodyType::static_body;
  Frame frame;
  Point velocity;
  double angular_velocity = 0;
  double mass = 0, inertia = 0;  ///< about the origin, as b2MassData
  Point mass_center;
  std::vector<Fixture> fixtures;
};

/// The outline that polygons make which share whole edges: those that are not shared, strung together. None
/// where they do not.
std::optional<Outline> joined(const std::vector<Ring>& polygons);

/// A float as JSON has it: a number, or 8 hex digits. Complains where it is neither, or no float holds it.
std::optional<double> read_float(const Value& value);

std::vector<Body> read_bodies(const Item& scene);

/// Properties of a joint whose caps grow with the rate of flow: RateLaw's, by row.
inline constexpr const char* doubling_rates[] = {"rate_D_N", "rate_D_Q", "rate_D_M"};
inline constexpr const char* rate_exponent = "rate_q";

/// Replaces the custom property of that name, or adds it.
void set_custom(Json& item, const std::string& name, const char* type, Json value);
void remove_custom(Json& item, const std::string& name);
/// Writes a number as such, infinity as "unlimited".
void set_custom(Json& item, const std::string& name, double value);
Json vector(Point p);

/// The fields of the joint's stock stand-in, and its values as custom properties; what else stands in `item`
/// stays.
void write_joint(Json& item, const Plan& plan, const PlannedJoint& joint, StockJoint as, int body_a,
                 int body_b, const Frame& a, const Frame& b);
/// Mass, and density of the fixtures, of a body as it was built, for one that has that frame.
void write_mass(Json& item, const b2Body& built, const Frame& frame);
/// Fixtures and mass of a piece, whose body has that frame. What the first fixture was beyond its shape, all
/// are.
void write_piece(Json& item, const Plan& plan, int piece, const b2Body& built, const Frame& frame);

/// The plan's loads on a piece, whose body has that frame, as its "ductile.loads".
void write_loads(Json& item, const Plan& plan, int piece, const Frame& frame);

/// Does the text hold a R.U.B.E. scene (and not a ductile one)?
bool is_scene(const Json& json);

/// A scene and what ductile knows of it.
// NOLINTNEXTLINE(bugprone-exception-escape): may run out of memory, which ends the program
struct Scene {
  Json json;                ///< calibrated: split bodies are pieces, and joints have their values
  Plan plan;                ///< the bodies and joints that ductile understands
  std::vector<int> bodies;  ///< indices into json["body"], by Plan::pieces
  std::vector<int> joints;  ///< into json["joint"], by Plan::joints
  /// What of the scene the plan does not hold, and where.
  std::vector<Problem> beyond_plan;
};

/// Calibrates what names a material. Throws InvalidInput.
Scene read(const Json& json, const std::string& name, StockJoint as = StockJoint::hinge);

}  // namespace ductile::rube
