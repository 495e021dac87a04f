#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "ductile/files.h"
#include "svg_path.h"

namespace ductile {
namespace {

using svg::Affine;
using svg::Numbers;
using svg::ShapeError;
using Node = pugi::xml_node;

/// "svg:path" → "path".
std::string_view local_name(const Node& node) {
  const std::string_view name = node.name();
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

bool is_shape(const Node& node) {
  static constexpr std::array<std::string_view, 7> shapes{"path",    "rect",     "circle", "ellipse",
                                                          "polygon", "polyline", "use"};
  return std::find(shapes.begin(), shapes.end(), local_name(node)) != shapes.end();
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view space = " \t\r\n\f";
  const auto from = text.find_first_not_of(space);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(space) - from + 1);
}

/// A presentation property: its declaration in the style attribute, else the attribute.
std::string_view property(const Node& node, const char* name) {
  std::string_view style = node.attribute("style").value();
  while (!style.empty()) {
    const auto end = std::min(style.find(';'), style.size());
    const std::string_view declaration = style.substr(0, end);
    style.remove_prefix(std::min(end + 1, style.size()));
    const auto colon = declaration.find(':');
    if (colon != std::string_view::npos && trim(declaration.substr(0, colon)) == name) {
      return trim(declaration.substr(colon + 1));
    }
  }
  return trim(node.attribute(name).value());
}

/// A length and what its unit is in px of 1/96 inch; nothing without a unit that has a size.
struct Length {
  double value;
  std::optional<double> unit;
};

Length parse_length(const Node& node, const char* name) {
  static constexpr std::array<std::pair<std::string_view, double>, 7> units{{{"px", 1},
                                                                             {"in", 96},
                                                                             {"cm", 96 / 2.54},
                                                                             {"mm", 96 / 25.4},
                                                                             {"Q", 96 / 101.6},
                                                                             {"pt", 96. / 72},
                                                                             {"pc", 16}}};
  const std::string_view text = node.attribute(name).value();
  const auto refuse = [&](const std::string& what) {
    throw ShapeError(name, what, "write a number, or a length in px, in, cm, mm, Q, pt or pc");
  };
  Length length{};
  Numbers in(text);
  try {
    length.value = in.number();
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  const std::string_view unit = in.name();
  if (!in.end()) refuse("is \"" + std::string(text) + "\"");
  if (unit.empty()) return length;
  const auto known = std::find_if(units.begin(), units.end(), [&](const auto& u) { return u.first == unit; });
  if (known == units.end()) refuse("has the unit \"" + std::string(unit) + "\"");
  length.unit = known->second;
  return length;
}

/// A shape's own length, in user units.
double user_length(const Node& node, const char* name, double standard = 0) {
  if (!node.attribute(name)) return standard;
  const Length length = parse_length(node, name);
  return length.value * length.unit.value_or(1);
}

double radius(const Node& node, const char* name) {
  const double r = user_length(node, name);
  if (!(r > 0)) throw ShapeError(name, "is not > 0", "such a shape has no area");
  return r;
}

/// The shape's curves, without its transform.
std::vector<svg::Subpath> curves(const Node& node, const Affine& to) {
  const std::string_view kind = local_name(node);
  const auto x = [&](const char* name) { return user_length(node, name); };
  if (kind == "path") return svg::parse_path(node.attribute("d").value(), to);
  if (kind == "circle") return svg::ellipse({x("cx"), x("cy")}, radius(node, "r"), radius(node, "r"), to);
  if (kind == "ellipse") return svg::ellipse({x("cx"), x("cy")}, radius(node, "rx"), radius(node, "ry"), to);
  if (kind == "rect") {
    // One of rx and ry stands for both.
    const bool has_rx = node.attribute("rx"), has_ry = node.attribute("ry");
    const double rx = has_rx || has_ry ? std::max(0., x(has_rx ? "rx" : "ry")) : 0;
    const double ry = has_rx || has_ry ? std::max(0., x(has_ry ? "ry" : "rx")) : 0;
    return svg::rectangle({x("x"), x("y")}, radius(node, "width"), radius(node, "height"), rx, ry, to);
  }
  return svg::polygon(node.attribute("points").value(), to);
}

/// How often a ring winds around a point that is not on it; counter-clockwise is positive.
int winding(const Ring& ring, const Point& p) {
  int turns = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point &a = ring[j], &b = ring[i];
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    const double left = (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y);
    if (b.y > a.y && left > 0) ++turns;
    if (b.y < a.y && left < 0) --turns;
  }
  return turns;
}

/// A point inside the ring, away from its edges: the middle of the widest span on a line through the widest
/// gap between the heights of its vertices.
Point inner_point(const Ring& ring) {
  std::vector<double> heights;
  for (const Point& p : ring) heights.push_back(p.y);
  std::sort(heights.begin(), heights.end());
  double y = heights.front(), gap = 0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i] - heights[i - 1] <= gap) continue;
    gap = heights[i] - heights[i - 1];
    y = heights[i - 1] + gap / 2;
  }
  std::vector<double> crossings;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Point &a = ring[j], &b = ring[i];
    if ((a.y <= y) != (b.y <= y)) crossings.push_back(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)));
  }
  std::sort(crossings.begin(), crossings.end());
  Point middle{ring.front().x, y};
  double span = 0;
  for (std::size_t i = 1; i < crossings.size(); i += 2) {
    if (crossings[i] - crossings[i - 1] <= span) continue;
    span = crossings[i] - crossings[i - 1];
    middle.x = crossings[i - 1] + span / 2;
  }
  return middle;
}

/// Which rings bound the filled area: where one is crossed inwards, the winding number changes by one. Takes
/// for granted that rings do not cross; whoever uses the outline validates it.
Outline fill(std::vector<Ring> rings, bool even_odd) {
  constexpr std::size_t most_work = 1'000'000'000;
  std::size_t points = 0;
  for (const Ring& ring : rings) points += ring.size();
  if (rings.size() > most_work / std::max<std::size_t>(points, 1)) {
    throw ShapeError("outline", "has " + std::to_string(rings.size()) + " rings", "draw it with fewer");
  }
  const auto filled = [&](int turns) { return even_odd ? turns % 2 != 0 : turns != 0; };
  std::sort(rings.begin(), rings.end(), [](const Ring& a, const Ring& b) {
    return std::abs(doubled_area(a)) > std::abs(doubled_area(b));
  });
  std::vector<Ring> outer, holes;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Point inner = inner_point(rings[i]);
    int outside = 0;  // only a larger ring can be around this one
    for (std::size_t j = 0; j < i; ++j) outside += winding(rings[j], inner);
    const int inside = outside + (doubled_area(rings[i]) > 0 ? 1 : -1);
    if (filled(inside) && !filled(outside)) outer.push_back(rings[i]);
    if (!filled(inside) && filled(outside)) holes.push_back(rings[i]);
  }
  if (outer.empty()) throw ShapeError("outline", "has no area", "draw a closed shape");
  if (outer.size() > 1) {
    throw ShapeError("outline", "has " + std::to_string(outer.size()) + " separate areas",
                     "draw one body as one connected area; unite overlapping parts, or give each its own id");
  }
  return {std::move(outer.front()), std::move(holes)};
}

/// All shapes in a subtree, itself included, in document order.
std::vector<Node> shapes_in(Node node) {
  struct Walker : pugi::xml_tree_walker {
    std::vector<Node> shapes;
    bool for_each(Node& node) override {
      if (is_shape(node)) shapes.push_back(node);
      return true;
    }
  } walker;
  if (is_shape(node)) return {node};
  node.traverse(walker);
  return std::move(walker.shapes);
}

std::string name_of(const Node& node) {
  const std::string_view id = node.attribute("id").value();
  return std::string(id.empty() ? node.attribute("inkscape:label").value() : id);
}

}  // namespace

struct Drawing::Data {
  std::string name;
  pugi::xml_document document;
  Node root;
  std::map<std::string_view, Node> ids, labels;  // the first element of each

  Data(std::string_view text, std::string file);
  [[noreturn]] void refuse(const std::string& place, const std::string& what,
                           const std::string& remedy) const {
    throw InvalidInput({{name + ":" + place, what, remedy}});
  }
  /// By id, else by inkscape:label.
  Node find(std::string_view id) const;
  /// From the viewBox's units, y down, to metres, y up.
  Affine page(const DrawingScale& scale) const;
  /// The transforms from below `above` down to the node.
  Affine placed(const Node& node, const Node& above) const;
};

Drawing::Data::Data(std::string_view text, std::string file) : name(std::move(file)) {
  const auto result = document.load_buffer(text.data(), text.size());
  if (!result) {
    const std::string_view before =
        text.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0)));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const auto start = before.rfind('\n');
    const auto column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
    refuse(std::to_string(line) + ":" + std::to_string(column),
           "is not XML: " + std::string(result.description()), "an SVG drawing is well-formed XML");
  }
  root = document.document_element();
  if (local_name(root) != "svg") {
    refuse("1:1", "has <" + std::string(root.name()) + "> where <svg> should stand", "name an SVG drawing");
  }
  struct Walker : pugi::xml_tree_walker {
    Data& data;
    explicit Walker(Data& to) : data(to) {}
    bool for_each(Node& node) override {
      if (const auto id = node.attribute("id")) data.ids.emplace(id.value(), node);
      if (const auto label = node.attribute("inkscape:label")) data.labels.emplace(label.value(), node);
      return true;
    }
  } walker(*this);
  document.traverse(walker);
}

Node Drawing::Data::find(std::string_view id) const {
  for (const auto& names : {std::cref(ids), std::cref(labels)}) {
    if (const auto found = names.get().find(id); found != names.get().end()) return found->second;
  }
  return {};
}

Affine Drawing::Data::page(const DrawingScale& scale) const {
  constexpr double metres_per_px = 0.0254 / 96;
  const auto size = [&](const char* name) -> std::optional<Length> {
    const std::string_view text = trim(root.attribute(name).value());
    if (text.empty() || text.back() == '%' || text == "auto") return std::nullopt;
    const Length length = parse_length(root, name);
    if (!(length.value > 0)) throw ShapeError(name, "is not > 0", "a drawing has a size");
    return length;
  };
  const auto width = size("width"), height = size("height");

  Point corner, extent;
  const bool has_box = root.attribute("viewBox");
  if (has_box) {
    Numbers in(root.attribute("viewBox").value());
    try {
      corner.x = in.number();
      corner.y = in.number();
      extent.x = in.number();
      extent.y = in.number();
      if (!in.end() || !(extent.x > 0) || !(extent.y > 0)) throw std::invalid_argument("is no box");
    } catch (const std::invalid_argument& error) {
      throw ShapeError("viewBox", error.what(), "write viewBox=\"x y width height\"");
    }
  } else if (height) {
    extent.y = height->value * height->unit.value_or(1);
  } else {
    throw ShapeError("svg", "has neither a viewBox nor a height",
                     "give it a viewBox: y is flipped at its bottom");
  }

  Point unit{scale.metres_per_unit, scale.metres_per_unit};
  if (scale.metres_per_unit == 0) {
    const bool sized = (width && width->unit) || (height && height->unit);
    if (!sized) {
      throw ShapeError(
          "svg", "has no physical size",
          "give its width and height a unit (\"200mm\"), or the body a \"scale\" in metres per unit");
    }
    const auto px_per_unit = [&](const std::optional<Length>& length, double of) {
      return length && length->unit && has_box ? length->value * *length->unit / of : std::optional<double>();
    };
    const auto across = px_per_unit(width, extent.x), up = px_per_unit(height, extent.y);
    unit = {across.value_or(up.value_or(1)) * metres_per_px, up.value_or(across.value_or(1)) * metres_per_px};
    const std::string_view aspect = root.attribute("preserveAspectRatio").value();
    if (!aspect.starts_with("none")) {
      const bool slice = aspect.ends_with("slice");
      unit.x = unit.y = slice ? std::max(unit.x, unit.y) : std::min(unit.x, unit.y);
    }
  }
  return {unit.x, 0, 0, -unit.y, 0, unit.y * (corner.y + extent.y)};
}

Affine Drawing::Data::placed(const Node& node, const Node& above) const {
  Affine all;
  for (Node at = node; at && at != above; at = at.parent()) {
    const std::string_view kind = local_name(at);
    if (kind == "symbol" || (kind == "svg" && at != root)) {
      throw ShapeError("<" + std::string(kind) + ">", "has a view of its own", "ungroup it");
    }
    const std::string_view transform = at.attribute("transform").value();
    if (at == root ? !transform.empty() : property(at, "transform") != trim(transform)) {
      throw ShapeError("<" + std::string(kind) + ">", "is transformed by style or at the root",
                       "put the transform into the shape's attribute");
    }
    all = svg::parse_transform(transform) * all;
  }
  return all;
}

Drawing::Drawing(const std::filesystem::path& file) : Drawing(read_text(file), file.string()) {}

Drawing::Drawing(std::string_view text, std::string name)
    : data_(std::make_shared<const Data>(text, std::move(name))) {}

std::vector<std::string> Drawing::ids() const {
  std::vector<std::string> ids;
  for (const Node& shape : shapes_in(data_->root)) {
    if (std::string name = name_of(shape); !name.empty()) ids.push_back(std::move(name));
  }
  return ids;
}

Outline Drawing::outline(std::string_view id, const DrawingScale& scale) const {
  const std::string place = "#" + std::string(id);
  Node at = data_->find(id);
  if (!at) {
    std::string known;
    const auto names = ids();
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 10); ++i)
      known += (i ? ", " : "") + names[i];
    data_->refuse(place, "is not in the drawing",
                  known.empty() ? "give the shape an id"
                                : "its shapes are " + known + (names.size() > 10 ? "..." : ""));
  }
  try {
    // Through groups and uses down to the shape itself.
    constexpr std::size_t most_hops = 16;
    struct Hop {
      Node shape, above;
    };
    std::vector<Hop> hops;
    Affine to = data_->page(scale);
    for (Node above = data_->root.parent();; above = at.parent()) {
      const auto shapes = shapes_in(at);
      if (shapes.size() != 1) {
        throw ShapeError("<" + std::string(at.name()) + ">",
                         "has " + std::to_string(shapes.size()) + " shapes", "name the shape itself");
      }
      const Node shape = shapes.front();
      hops.push_back({shape, above});
      to = to * data_->placed(shape, above);
      if (local_name(shape) != "use") break;
      to = to * Affine{1, 0, 0, 1, user_length(shape, "x"), user_length(shape, "y")};
      std::string_view target = shape.attribute("href").value();
      if (target.empty()) target = shape.attribute("xlink:href").value();
      at = target.starts_with('#') ? data_->find(target.substr(1)) : Node();
      if (!at || hops.size() == most_hops) {
        throw ShapeError("<use>", "leads nowhere: \"" + std::string(target) + "\"",
                         "let it show a shape of the drawing");
      }
    }

    std::string_view rule;
    for (auto hop = hops.rbegin(); hop != hops.rend(); ++hop) {
      for (Node node = hop->shape; node && node != hop->above && (rule.empty() || rule == "inherit");
           node = node.parent()) {
        rule = property(node, "fill-rule");
      }
    }
    if (!rule.empty() && rule != "evenodd" && rule != "nonzero" && rule != "inherit") {
      throw ShapeError("fill-rule", "is \"" + std::string(rule) + "\"", "write evenodd or nonzero");
    }

    const auto path = curves(hops.back().shape, to);
    const double size = svg::extent(path);
    if (!path.empty() && !std::isfinite(size)) {
      throw ShapeError("shape", "reaches beyond what a double holds",
                       "draw it smaller, or nearer to the origin");
    }
    auto rings = svg::flatten(path, scale.tolerance > 0 ? scale.tolerance : 1e-4 * size);
    const auto sheet = data_->root.find_node([](const Node& node) {
      return local_name(node) == "style" &&
             std::string_view(node.child_value()).find("fill-rule") != std::string::npos;
    });
    if (rule.empty() && rings.size() > 1 && sheet) {
      throw ShapeError("fill-rule", "may come from a style sheet, which is not read",
                       "write it as an attribute of the shape");
    }
    return fill(std::move(rings), rule == "evenodd");
  } catch (const ShapeError& error) {
    data_->refuse(place + ", " + error.place, error.what(), error.remedy);
  }
}

}  // namespace ductile
