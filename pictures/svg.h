// What the pictures of this room are written with.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <string>
#include <type_traits>

#include "ductile/colours.h"
#include "ductile/section.h"

namespace ductile::picture {

using Node = pugi::xml_node;

inline constexpr auto ink = "#22303c", quiet = "#5d6b78", edge = "#8794a0", ground = "#f7f9fb";
inline constexpr double margin = 20, header = 62;

/// Empty at first.
struct Box {
  double x0 = unlimited, y0 = unlimited, x1 = -unlimited, y1 = -unlimited;

  void add(Point p) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  void add(const Box& other) {
    if (other.empty()) return;
    add(Point{other.x0, other.y0});
    add(Point{other.x1, other.y1});
  }
  bool empty() const { return !(x0 <= x1); }
  bool holds(Point p) const { return x0 <= p.x && p.x <= x1 && y0 <= p.y && p.y <= y1; }
  double width() const { return x1 - x0; }
  double height() const { return y1 - y0; }
  Box grown(double by) const { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
  Box within(const Box& limit) const {
    return {std::max(x0, limit.x0), std::max(y0, limit.y0), std::min(x1, limit.x1), std::min(y1, limit.y1)};
  }
};

inline void set(Node) {}
template <class Value, class... Rest>
void set(Node node, const char* name, const Value& value, const Rest&... rest) {
  if constexpr (std::is_floating_point_v<Value>) {
    node.append_attribute(name) = fmt::format("{:.5g}", value).c_str();
  } else if constexpr (std::is_same_v<Value, std::string>) {
    node.append_attribute(name) = value.c_str();
  } else {
    node.append_attribute(name) = value;
  }
  set(node, rest...);
}

/// A child element with attributes, given as name, value, name, value …
template <class... Attributes>
Node add(Node parent, const char* element, const Attributes&... attributes) {
  Node node = parent.append_child(element);
  set(node, attributes...);
  return node;
}

template <class... Attributes>
void write(Node parent, const std::string& text, double x, double y, const Attributes&... attributes) {
  add(parent, "text", "x", x, "y", y, attributes...).text() = text.c_str();
}

inline void hover(Node node, const std::string& text) { add(node, "title").text() = text.c_str(); }

/// "88.9 kN m": three digits, with the prefix that fits.
std::string quantity(double value, const char* unit);

/// "#d9534f"
std::string hex(Colour colour);

/// The root of a document of that size, with its title and subtitle.
Node page(pugi::xml_document& document, double width, double height, const std::string& title,
          const std::string& subtitle);

/// A round length as a bar that ends at `right` and is at most so many px long.
void scale_bar(Node to, double px_per_metre, Point right, double most);

std::string text_of(const pugi::xml_document& document);

}  // namespace ductile::picture
