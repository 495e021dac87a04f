// A document that is written and read by the same lines: each names its fields once.
//
//   archive("velocity", v.x, v.y)      a number by its key, or several as a list
//   archive.list("bodies", n, each)    objects: each(archive, i), of n to be written or of all that are
//   there;
//                                      once more, and they have more fields
//
// Numbers that are not finite stand as "inf", "-inf" and "nan".
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace ductile {

class Archive {
 public:
  using Json = nlohmann::json;

  Archive(Json& node, bool reads) : node_(node), reads_(reads) {}

  bool reads() const { return reads_; }
  bool has(const char* key) const { return node_.is_object() && node_.contains(key); }

  template <class... T>
  void operator()(const char* key, T&... values) {
    Json& at = field(key);
    if constexpr (sizeof...(T) == 1) {
      (one(key, at, values), ...);
    } else {
      if (!reads_) {
        at = Json::array();
        for (std::size_t i = 0; i < sizeof...(T); ++i) at.push_back(nullptr);
      } else if (!at.is_array() || at.size() != sizeof...(T)) {
        refuse(key, "must be a list of " + std::to_string(sizeof...(T)));
      }
      std::size_t i = 0;
      (one(key, at[i++], values), ...);
    }
  }

  template <class T>
  void operator()(const char* key, std::vector<T>& values) {
    Json& at = field(key);
    if (reads_) {
      if (!at.is_array()) refuse(key, "must be a list of numbers");
      values.resize(at.size());
    } else {
      at = Json::array();
      for (std::size_t i = 0; i < values.size(); ++i) at.push_back(nullptr);
    }
    for (std::size_t i = 0; i < values.size(); ++i) one(key, at[i], values[i]);
  }

  template <class Each>
  void list(const char* key, std::size_t count, const Each& each) {
    Json& at = field(key);
    if (reads_ && !at.is_array()) refuse(key, "must be a list");
    if (!at.is_array()) at = Json::array();
    while (!reads_ && at.size() < count) at.push_back(Json::object());
    for (std::size_t i = 0; i < at.size(); ++i) {
      Archive child(at[i], reads_, this, key, i);
      each(child, i);
    }
  }

  template <class Each>
  void object(const char* key, const Each& each) {
    Json& at = field(key);
    if (!reads_ && !at.is_object()) at = Json::object();
    Archive child(at, reads_, this, key);
    each(child);
  }

  [[noreturn]] void refuse(const char* key, const std::string& what) const {
    throw std::invalid_argument("save: " + place() + key + ": " + what);
  }

 private:
  static std::string shown(const Json& at) { return at.dump(-1, ' ', false, Json::error_handler_t::replace); }
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  Archive(Json& node, bool reads, const Archive* parent, const char* key, std::size_t index = none)
      : node_(node), reads_(reads), parent_(parent), key_(key), index_(index) {}

  std::string place() const {
    if (parent_ == nullptr) return "";
    return parent_->place() + key_ + (index_ == none ? "" : "[" + std::to_string(index_) + "]") + ".";
  }

  Json& field(const char* key) {
    if (!reads_) return node_[key];
    if (!has(key)) refuse(key, "is not there");
    return node_[key];
  }

  template <class T>
  void one(const char* key, Json& at, T& value) {
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
      if (!reads_) {
        at = value;
      } else if (std::is_same_v<T, bool> ? !at.is_boolean() : !at.is_string()) {
        refuse(key, std::is_same_v<T, bool> ? "must be true or false" : "must be a text");
      } else {
        value = at.get<T>();
      }
    } else if constexpr (std::is_integral_v<T>) {
      if (!reads_) {
        at = value;
      } else if (at.is_number_unsigned() &&
                 at.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<T>::max())) {
        value = static_cast<T>(at.get<std::uint64_t>());
      } else if (at.is_number_integer() && !at.is_number_unsigned() && std::is_signed_v<T> &&
                 at.get<std::int64_t>() >= static_cast<std::int64_t>(std::numeric_limits<T>::min())) {
        value = static_cast<T>(at.get<std::int64_t>());
      } else {
        refuse(key,
               "is " + shown(at) + "; must be a whole number of " + std::to_string(8 * sizeof(T)) + " bits");
      }
    } else if (!reads_) {
      const double number = value;
      if (std::isfinite(number)) {
        at = number;
      } else {
        at = std::isnan(number) ? "nan" : number > 0 ? "inf" : "-inf";
      }
    } else if (at.is_number() && (sizeof(T) == sizeof(double) ||
                                  std::abs(at.get<double>()) <= double{std::numeric_limits<float>::max()})) {
      value = static_cast<T>(at.get<double>());
    } else if (at == "inf" || at == "-inf") {
      value = at == "inf" ? std::numeric_limits<T>::infinity() : -std::numeric_limits<T>::infinity();
    } else if (at == "nan") {
      value = std::numeric_limits<T>::quiet_NaN();
    } else {
      refuse(key, "is " + shown(at) + "; must be a number");
    }
  }

  Json& node_;
  bool reads_;
  const Archive* parent_ = nullptr;
  const char* key_ = "";
  std::size_t index_ = none;
};

}  // namespace ductile
