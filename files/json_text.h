// JSON edited as text: values change where they stand, and everything else keeps its order, layout and
// comments.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace ductile {

class JsonText {
 public:
  using Json = nlohmann::ordered_json;
  using Path = nlohmann::json::json_pointer;  ///< of a value that is there, unless said otherwise

  /// `text` is valid JSON, in which comments may stand.
  explicit JsonText(std::string text) : text_(std::move(text)) {}
  const std::string& text() const { return text_; }

  /// Replaces a value; a member that is not there becomes the last of its object.
  void set(const Path& path, const Json& value);
  /// Takes a member or an element out.
  void erase(const Path& path);
  /// Adds an element at the end of an array.
  void append(const Path& array, const Json& value);

 private:
  /// A member of an object or an element of an array.
  struct Entry {
    std::string key;                 // empty for an element
    std::size_t begin = 0;           // of the key or the element
    std::size_t value = 0, end = 0;  // of the value
  };
  struct Container {
    std::size_t open = 0, close = 0;  // the brackets
    std::vector<Entry> entries;
  };

  std::size_t skip_space(std::size_t at) const;
  std::size_t skip_value(std::size_t at) const;
  std::size_t skip_string(std::size_t at) const;
  Container container(std::size_t at) const;
  Entry find(const Path& path) const;
  void add(std::size_t container, const std::string& entry);

  std::string text_;
};

}  // namespace ductile
