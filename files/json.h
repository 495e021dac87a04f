// JSON that is read strictly: every key is known and stands once, every number is finite and in its range,
// and everything wrong is said with its place.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "ductile/fields.h"
#include "ductile/problem.h"
#include "ductile/section.h"

namespace ductile {

/// What is wrong with one file.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  /// Each is kept once: what is read in several places is wrong in one.
  void add(const std::string& place, std::string what, std::string remedy);
  void add(const std::vector<Problem>& of_another_file);
  /// Throws InvalidInput if there are any.
  void check() const;

 private:
  void add(Problem problem);

  std::string file_;
  std::vector<Problem> list_;
};

/// Comments (// and /* */) are skipped. Throws InvalidInput on text that is not JSON, repeats a key, nests
/// deeper than 64 levels, or has a number that a double does not hold.
nlohmann::json parse_json(std::string_view text, const std::string& file);

/// Indented, with points, rings and short lists on one line each, as one would write them.
std::string printed(const nlohmann::ordered_json& json);

using fields::any_number;
using fields::limit;
using fields::not_negative;
using fields::positive;
using fields::Range;

/// A JSON value, where it stands, and where to complain. Every reader returns nothing after complaining.
class Value {
 public:
  Value(const nlohmann::json& json, std::string place, Problems& problems)
      : json_(&json), place_(std::move(place)), problems_(&problems) {}

  const nlohmann::json& json() const { return *json_; }
  const std::string& place() const { return place_; }
  Problems& problems() const { return *problems_; }
  void wrong(std::string what, std::string remedy) const {
    problems_->add(place_, std::move(what), std::move(remedy));
  }
  /// The value as a message shows it, shortened.
  std::string shown() const;

  /// `most` is what calibrate() takes of any number.
  std::optional<double> number(const Range& range = any_number, double most = 1e30) const;
  std::optional<int> integer(int low, int high) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> text() const;
  std::optional<Point> point() const;
  std::optional<Ring> ring() const;
  std::optional<std::vector<Ring>> rings() const;
  /// The elements of an array; none after complaining that it is not one.
  std::vector<Value> elements() const;

  /// Each of these leaves its target as it is after complaining.
  void read(const Range& range, double& target) const { target = number(range).value_or(target); }
  void read(const Range& range, std::int16_t& target) const;
  void read(const Range&, bool& target) const { target = boolean().value_or(target); }
  void read(const Range&, std::string& target) const { target = text().value_or(target); }
  void read(const Range&, Point& target) const { target = point().value_or(target); }
  void read(const Range& range, std::optional<double>& target) const { target = number(range); }
  void read(const Range&, std::optional<bool>& target) const { target = boolean(); }

 private:
  const nlohmann::json* json_;
  std::string place_;
  Problems* problems_;
};

/// A JSON object whose keys are asked for one by one; a key that nobody asked for is unknown.
class Object {
 public:
  explicit Object(const Value& value);
  /// Complains of the keys that were not asked for.
  ~Object();  // NOLINT(bugprone-exception-escape): may run out of memory, which ends the program
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  bool is_object() const { return value_.json().is_object(); }
  std::optional<Value> find(const char* key);
  /// Complains when it is missing.
  std::optional<Value> require(const char* key);

  /// The fields of a table; a target stays as it is where its key is absent.
  template <class Owner, class... Fields>
  void read(const std::tuple<Fields...>& table, Owner& target) {
    fields::for_each(table, [&](const auto& field) {
      const auto value = field.required ? require(field.key) : find(field.key);
      if (value) value->read(field.range, target.*field.member);
    });
  }
  template <class T>
  void choice(const char* key, T& target, std::initializer_list<std::pair<const char*, T>> choices);

 private:
  Value value_;
  std::vector<std::string_view> asked_;
};

/// Complains that a text is none of the choices, naming them.
void wrong_choice(const Value& value, const std::vector<std::string_view>& choices);

template <class T>
void Object::choice(const char* key, T& target, std::initializer_list<std::pair<const char*, T>> choices) {
  const auto value = find(key);
  if (!value) return;
  std::vector<std::string_view> names;
  for (const auto& [name, choice] : choices) {
    if (value->json().is_string() && value->json().get_ref<const std::string&>() == name) {
      target = choice;
      return;
    }
    names.emplace_back(name);
  }
  wrong_choice(*value, names);
}

}  // namespace ductile
