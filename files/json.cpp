#include "json.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "utf8.h"

namespace ductile {
namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t most_problems = 100;  // more help nobody, and a hostile file could have millions

std::string shorten(std::string text) {
  constexpr std::size_t most = 40;
  if (text.size() <= most) return text;
  std::size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;  // not inside a UTF-8 character
  return text.substr(0, end) + "...";
}

std::string list(const std::vector<std::string_view>& names) {
  std::string text;
  for (const auto name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text;
}

/// Builds the tree, and refuses what nlohmann's own builder lets pass: repeated keys and endless nesting.
class Builder : public nlohmann::json_sax<nlohmann::json> {
  using Json = nlohmann::json;

 public:
  Builder(std::string_view text, Problems& problems) : text_(text), problems_(problems) {}
  Json root;

  bool null() override { return put(nullptr), true; }
  bool boolean(bool value) override { return put(value), true; }
  bool number_integer(number_integer_t value) override { return put(value), true; }
  bool number_unsigned(number_unsigned_t value) override { return put(value), true; }
  bool number_float(number_float_t value, const string_t&) override { return put(value), true; }
  bool string(string_t& value) override { return put(std::move(value)), true; }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    Level& level = levels_.back();
    if (level.container->contains(name)) {
      problems_.add(place(), "the key \"" + shorten(name) + "\" stands twice", "keep one of them");
    }
    level.key = std::move(name);
    return true;
  }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::json::exception& error) override {
    // The message after "[json.exception.…] parse error at line 1, column 5: ".
    std::string_view message = error.what();
    if (const auto end = message.find("] "); end != std::string_view::npos) message.remove_prefix(end + 2);
    if (const auto end = message.find(": ");
        message.starts_with("parse error") && end != std::string_view::npos) {
      message.remove_prefix(end + 2);
    }
    std::size_t at = std::min(position > 0 ? position - 1 : 0, text_.size());
    const std::string place = line_and_column(text_, at);
    if (text_.find_first_not_of(" \t\r\n") == std::string_view::npos) {
      problems_.add(place, "is empty", "save it anew, or name another file");
    } else if (valid_utf8(message) < message.size()) {  // which quotes what it could not read
      while (at > 0 && (at == text_.size() || static_cast<unsigned char>(text_[at]) < 0x80)) --at;
      problems_.add(line_and_column(text_, at), "has a byte that is no UTF-8", "save it in UTF-8");
    } else {
      problems_.add(place, std::string(message), "write valid JSON");
    }
    return false;
  }

 private:
  struct Level {
    Json* container;
    std::string key;
  };

  Json* put(Json&& value) {
    if (levels_.empty()) return &(root = std::move(value));
    Level& level = levels_.back();
    if (level.container->is_object()) return &((*level.container)[level.key] = std::move(value));
    return &level.container->emplace_back(std::move(value));
  }
  bool open(Json&& container) {
    if (levels_.size() == deepest) {
      problems_.add(place(), "nests deeper than " + std::to_string(deepest) + " levels",
                    "no ductile file does");
      return false;
    }
    levels_.push_back({put(std::move(container)), {}});
    return true;
  }
  bool close() { return levels_.pop_back(), true; }

  std::string place() const {
    std::string place;
    for (const Level& level : levels_) {
      if (&level == &levels_.back()) break;
      place += level.container->is_object() ? (place.empty() ? "" : ".") + shorten(level.key)
                                            : "[" + std::to_string(level.container->size() - 1) + "]";
    }
    return place.empty() ? "top level" : place;
  }

  std::string_view text_;
  Problems& problems_;
  std::vector<Level> levels_;
};

void print(const nlohmann::ordered_json& json, const std::string& indent, std::string& text) {
  const auto has_object = [](const auto& self, const nlohmann::ordered_json& value) -> bool {
    if (!value.is_array()) return value.is_object();
    return std::any_of(value.begin(), value.end(),
                       [&](const nlohmann::ordered_json& element) { return self(self, element); });
  };
  const bool leaf = indent.size() >= 4 && !(json.is_array() && has_object(has_object, json));
  if (leaf || !json.is_structured() || !has_object(has_object, json)) {
    text += json.dump();
    return;
  }
  const std::string deeper = indent + "  ";
  text += json.is_object() ? "{" : "[";
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    text += separator + deeper;
    if (json.is_object()) text += nlohmann::ordered_json(key).dump() + ": ";
    print(value, deeper, text);
    separator = ",\n";
  }
  text += "\n" + indent + (json.is_object() ? "}" : "]");
}

}  // namespace

void Problems::add(Problem problem) {
  const auto is_the_same = [&](const Problem& p) {
    return p.place == problem.place && p.what == problem.what && p.remedy == problem.remedy;
  };
  if (list_.size() < most_problems && std::none_of(list_.begin(), list_.end(), is_the_same))
    list_.push_back(std::move(problem));
}

void Problems::add(const std::string& place, std::string what, std::string remedy) {
  add(Problem{file_ + ":" + place, std::move(what), std::move(remedy)});
}

void Problems::add(const std::vector<Problem>& of_another_file) {
  for (const Problem& problem : of_another_file) add(problem);
}

void Problems::check() const {
  if (!list_.empty()) throw InvalidInput(list_);
}

nlohmann::json parse_json(std::string_view text, const std::string& file) {
  Problems problems(file);
  if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE")) {
    problems.add("1:1", "is in UTF-16", "save it in UTF-8");
    problems.check();
  }
  if (const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
      first != std::string_view::npos && text[first] == '<') {
    problems.add(line_and_column(text, first), "is XML (a drawing?), not JSON",
                 "name a section or scene file; a scene takes outlines from \"drawing.svg#id\"");
    problems.check();
  }
  if (const auto nul = text.find('\0');
      nul != std::string_view::npos) {  // which the parser takes for its end
    problems.add(line_and_column(text, nul), "has a NUL byte, of which text has none",
                 "save it as plain text");
    problems.check();
  }
  Builder builder(text, problems);
  constexpr bool strict = true, ignore_comments = true;
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder, nlohmann::json::input_format_t::json, strict,
                            ignore_comments);
  problems.check();
  return std::move(builder.root);
}

std::string Value::shown() const {
  switch (json_->type()) {
    case nlohmann::json::value_t::object:
      return "an object";
    case nlohmann::json::value_t::array:
      return "an array of " + std::to_string(json_->size());
    default:
      return shorten(json_->dump());
  }
}

std::optional<double> Value::number(const Range& range, double most) const {
  if (json_->is_null() && range.null) return range.null;
  const double value = json_->is_number() ? json_->get<double>() : 0;
  const bool beyond = std::abs(value) > most;
  std::string remedy = std::string("write ") + range.words;
  if (beyond) remedy += ", not beyond " + nlohmann::json(most).dump();
  if (range.null) remedy += range.null == unlimited ? ", or null for unlimited" : ", or null for the default";
  if (!json_->is_number()) return wrong("is " + shown() + ", not a number", remedy), std::nullopt;
  if (beyond || !range.contains(value)) return wrong("is " + shown(), remedy), std::nullopt;
  return value;
}

void Value::read(const Range&, std::int16_t& target) const {
  using Limits = std::numeric_limits<std::int16_t>;
  target = static_cast<std::int16_t>(integer(Limits::min(), Limits::max()).value_or(target));
}

std::optional<int> Value::integer(int low, int high) const {
  const double value = json_->is_number() ? json_->get<double>() : 0.5;
  if (value != std::floor(value) || value < low || value > high) {
    wrong("is " + shown(),
          "write a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    return std::nullopt;
  }
  return static_cast<int>(value);
}

std::optional<bool> Value::boolean() const {
  if (!json_->is_boolean()) return wrong("is " + shown(), "write true or false"), std::nullopt;
  return json_->get<bool>();
}

std::optional<std::string> Value::text() const {
  if (!json_->is_string()) return wrong("is " + shown(), "write a text in quotes"), std::nullopt;
  return json_->get<std::string>();
}

std::optional<Point> Value::point() const {
  if (!json_->is_array() || json_->size() != 2) return wrong("is " + shown(), "write [x, y]"), std::nullopt;
  const auto coordinate = [&](std::size_t i) {
    return Value((*json_)[i], place_ + "[" + std::to_string(i) + "]", *problems_).number();
  };
  const auto x = coordinate(0), y = coordinate(1);
  if (!x || !y) return std::nullopt;
  return Point{*x, *y};
}

std::optional<Ring> Value::ring() const {
  if (!json_->is_array())
    return wrong("is " + shown(), "write a ring, [[x, y], [x, y], [x, y]...]"), std::nullopt;
  Ring ring;
  ring.reserve(json_->size());
  for (std::size_t i = 0; i < json_->size(); ++i) {
    const nlohmann::json& p = (*json_)[i];
    if (p.is_array() && p.size() == 2 && p[0].is_number() && p[1].is_number()) {
      ring.push_back({p[0].get<double>(), p[1].get<double>()});
    } else {
      Value(p, place_ + "[" + std::to_string(i) + "]", *problems_).point();
    }
  }
  if (ring.size() != json_->size()) return std::nullopt;
  return ring;
}

std::optional<std::vector<Ring>> Value::rings() const {
  if (!json_->is_array()) return wrong("is " + shown(), "write an array of rings"), std::nullopt;
  std::vector<Ring> rings;
  for (const Value& element : elements()) {
    if (auto ring = element.ring()) rings.push_back(std::move(*ring));
  }
  return rings;
}

std::vector<Value> Value::elements() const {
  if (!json_->is_array()) return wrong("is " + shown(), "write an array, [...]"), std::vector<Value>{};
  std::vector<Value> elements;
  elements.reserve(json_->size());
  for (std::size_t i = 0; i < json_->size(); ++i) {
    elements.emplace_back((*json_)[i], place_ + "[" + std::to_string(i) + "]", *problems_);
  }
  return elements;
}

Object::Object(const Value& value) : value_(value) {
  if (!is_object()) value.wrong("is " + value.shown(), "write an object, {...}");
}

Object::~Object() {  // NOLINT(bugprone-exception-escape): see the header
  if (!is_object()) return;
  for (const auto& [key, ignored] : value_.json().items()) {
    if (std::find(asked_.begin(), asked_.end(), key) == asked_.end()) {
      value_.wrong("the key \"" + shorten(key) + "\" is unknown", "known here: " + list(asked_));
    }
  }
}

std::optional<Value> Object::find(const char* key) {
  asked_.emplace_back(key);
  if (!is_object()) return std::nullopt;
  const auto found = value_.json().find(key);
  if (found == value_.json().end()) return std::nullopt;
  const std::string& here = value_.place();
  return Value(*found, here == "top level" ? key : here + "." + key, value_.problems());
}

std::optional<Value> Object::require(const char* key) {
  auto value = find(key);
  if (!value && is_object()) value_.wrong(std::string("has no \"") + key + "\"", "it is required");
  return value;
}

void wrong_choice(const Value& value, const std::vector<std::string_view>& choices) {
  value.wrong("is " + value.shown(), "write one of: " + list(choices));
}

std::string printed(const nlohmann::ordered_json& json) {
  std::string text;
  print(json, "", text);
  return text + "\n";
}

}  // namespace ductile
