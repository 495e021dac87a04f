#include "svg_document.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "utf8.h"

namespace ductile::svg {
namespace {

using Node = pugi::xml_node;

/// A length, and what its unit is in px of 1/96 inch; nothing without a unit that has a size of its own.
struct Length {
  double value;
  std::optional<double> unit;
  char relative = 0;  ///< '%', or 'e': of the font
};
constexpr double usual_font = 16;  // px

Length parse_length(std::string_view text, const char* name) {
  const auto refuse = [&](const std::string& what) {
    throw ShapeError(name, what, "write a number, or a length in px, in, cm, mm, Q, pt, pc, em or ex");
  };
  Length length{};
  Numbers in(text);
  try {
    length.value = in.number();
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  if (in.peek() == '%') {
    in.take();
    length.relative = '%';
  }
  const std::string_view unit = in.name();
  if (!in.end()) refuse("is \"" + std::string(text) + "\"");
  if (unit.empty()) return length;
  if (unit == "em" || unit == "ex" || unit == "rem") {
    length.relative = 'e';
    if (unit == "ex") length.value /= 2;
    return length;
  }
  length.unit = px_of(unit);
  if (!length.unit) refuse("has the unit \"" + std::string(unit) + "\"");
  return length;
}

/// The root's width or height, where it is a length that depends on nothing around the drawing.
std::optional<Length> page_length(const Node& root, const char* name) {
  const std::string_view text = trimmed(root.attribute(name).value());
  if (text.empty() || text == "auto") return std::nullopt;
  const Length length = parse_length(text, name);
  if (length.relative) return std::nullopt;
  if (!(length.value > 0)) throw ShapeError(name, "is not > 0", "a drawing has a size");
  return length;
}

bool is_utf8(std::string_view text) { return valid_utf8(text) == text.size(); }

/// Does its XML declaration say so? The parser knows ISO-8859-1, UTF-8, UTF-16 and UTF-32 alone.
bool is_windows_1252(std::string_view text) {
  if (!text.starts_with("<?xml")) return false;
  std::string declaration(text.substr(0, text.find("?>")));
  std::transform(declaration.begin(), declaration.end(), declaration.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const auto at = declaration.find("encoding");
  if (at == std::string::npos) return false;
  const auto open = declaration.find_first_of("\"'", at);
  if (open == std::string::npos) return false;
  const std::string said =
      declaration.substr(open + 1, declaration.find(declaration[open], open + 1) - open - 1);
  return said == "windows-1252" || said == "cp1252" || said == "x-cp1252";
}

/// The text with what its document type declares, <!ENTITY name "value">, put in for &name;: old files of
/// Illustrator keep their styles there, and pugixml leaves them as they are.
std::string with_entities(std::string_view text, const std::string& file) {
  constexpr std::size_t most = std::size_t{64} << 20;
  const auto type = text.find("<!DOCTYPE"), open = text.find('[', type), close = text.find(']', open);
  if (type == std::string_view::npos || close == std::string_view::npos || text.find('>', type) < open)
    return std::string(text);
  std::map<std::string, std::string, std::less<>> entities;
  const auto expanded = [&](std::string_view rest) {
    std::string all;
    for (std::size_t at = 0; at < rest.size();) {
      const auto mark = std::min(rest.find('&', at), rest.size()), end = rest.find(';', mark);
      all += rest.substr(at, mark - at);
      const auto found = end == std::string_view::npos ? entities.end()
                                                       : entities.find(rest.substr(mark + 1, end - mark - 1));
      if (found != entities.end())
        all += found->second;
      else if (mark < rest.size())
        all += '&';
      at = found != entities.end() ? end + 1 : mark + 1;
      if (all.size() > most) {
        throw InvalidInput({{file + ":DOCTYPE", "has entities that become more than 64 MiB",
                             "write out what they stand for"}});
      }
    }
    return all;
  };
  for (auto at = text.find("<!ENTITY", open); at < close; at = text.find("<!ENTITY", at + 1)) {
    const std::string_view rest = trimmed(text.substr(at + 8, close - at - 8));
    const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n"));
    const std::string_view value = trimmed(rest.substr(name.size()));
    const auto end = value.empty() ? std::string_view::npos : value.find(value[0], 1);
    if (end != std::string_view::npos && (value[0] == '"' || value[0] == '\''))
      entities.emplace(name, expanded(value.substr(1, end - 1)));
  }
  return std::string(text.substr(0, close)) + expanded(text.substr(close));
}

}  // namespace

std::string_view get(const Style& style, std::string_view property, std::string_view missing) {
  const auto found = style.find(property);
  return found == style.end() ? missing : found->second;
}

double number(const Style& style, const char* property, double missing) {
  const std::string_view text = get(style, property);
  if (text.empty()) return missing;
  try {
    return Numbers(text).number() * (text.back() == '%' ? 0.01 : 1);
  } catch (const std::invalid_argument& error) {
    throw ShapeError(property, error.what(), "write a number");
  }
}

double user_length(std::string_view text, const char* name, double whole, double em) {
  const Length length = parse_length(text, name);
  if (length.relative == '%') return length.value / 100 * whole;
  return length.value * (length.relative ? em : length.unit.value_or(1));
}

double user_length(const Style& style, const char* name, double whole, double missing) {
  const std::string_view text = get(style, name);
  return text.empty() || text == "auto" ? missing : user_length(text, name, whole, font_size(style));
}

double font_size(const Style& style) {
  const std::string_view text = get(style, "font-size");
  const bool number = !text.empty() && text.front() >= '0' && text.front() <= '9';  // not "larger"
  return number ? user_length(text, "font-size", usual_font, usual_font) : usual_font;
}

std::optional<std::array<double, 4>> view_box(const Node& node) {
  if (!node.attribute("viewBox")) return std::nullopt;
  std::array<double, 4> box{};
  Numbers in(node.attribute("viewBox").value());
  try {
    for (double& number : box) number = in.number();
    if (!in.end() || !(box[2] > 0) || !(box[3] > 0)) throw std::invalid_argument("is no box");
  } catch (const std::invalid_argument& error) {
    throw ShapeError("viewBox", error.what(), "write viewBox=\"x y width height\"");
  }
  return box;
}

Affine fit(const std::array<double, 4>& box, const Point& frame, std::string_view aspect) {
  Point scale{frame.x / box[2], frame.y / box[3]};
  aspect = trimmed(aspect);
  Point shift{0, 0};
  if (!aspect.starts_with("none")) {
    const bool slice = aspect.ends_with("slice");
    scale.x = scale.y = slice ? std::max(scale.x, scale.y) : std::min(scale.x, scale.y);
    const auto align = [&](std::string_view axis) {
      const auto at = aspect.find(axis);
      const std::string_view kind = at == std::string_view::npos ? "Mid" : aspect.substr(at + 1, 3);
      return kind == "Min" ? 0 : kind == "Max" ? 1 : 0.5;
    };
    shift = {align("x") * (frame.x - scale.x * box[2]), align("Y") * (frame.y - scale.y * box[3])};
  }
  return {scale.x, 0, 0, scale.y, shift.x - scale.x * box[0], shift.y - scale.y * box[1]};
}

Document::Document(std::string_view data, std::string file) : name(std::move(file)) {
  const std::string text =
      with_entities(is_windows_1252(data) ? from_windows_1252(data) : std::string(data), name);
  const auto refuse = [&](const std::string& place, const std::string& what, const std::string& remedy) {
    throw InvalidInput({{name + ":" + place, what, remedy}});
  };
  const auto result = xml.load_buffer(text.data(), text.size());
  if (!result) {
    refuse(line_and_column(text, static_cast<std::size_t>(std::max<std::ptrdiff_t>(result.offset, 0))),
           "is not XML: " + std::string(result.description()), "an SVG drawing is well-formed XML");
  }
  if (const std::size_t valid = valid_utf8(text);
      result.encoding == pugi::encoding_utf8 && valid < text.size()) {
    refuse(line_and_column(text, valid), "has a byte that is no UTF-8",
           "save it in UTF-8, or let it begin with what it is in: <?xml version=\"1.0\" "
           "encoding=\"windows-1252\"?>, iso-8859-1 or UTF-16");
  }
  root = xml.document_element();
  if (local_name(root) == "map")
    refuse("1:1", "is a map of Tiled, whose polygons are no bodies yet",
           "make a scene of them, as docs/files/starting.md shows");
  if (local_name(root) != "svg") {
    refuse("1:1", "has <" + std::string(root.name()) + "> where <svg> should stand", "name an SVG drawing");
  }
  struct Walker : pugi::xml_tree_walker {
    Document& document;
    explicit Walker(Document& to) : document(to) {}
    bool for_each(Node& node) override {
      bool valid = is_utf8(node.value());
      for (const auto& attribute : node.attributes()) valid = valid && is_utf8(attribute.value());
      if (!valid) {
        const Node of = node.type() == pugi::node_element ? node : node.parent();
        throw InvalidInput({{document.name + ":" + of.name(), "refers to a character that there is not",
                             "characters are &#1; to &#x10FFFF; without &#xD800; to &#xDFFF;"}});
      }
      if (const auto id = node.attribute("id")) document.ids.emplace(id.value(), node);
      if (const auto label = node.attribute("inkscape:label")) document.labels.emplace(label.value(), node);
      const std::string_view media = trimmed(node.attribute("media").value());
      const std::string_view type = node.attribute("type").value();
      if (local_name(node) == "style" && (type.empty() || type == "text/css") &&
          (media.empty() || media == "all" || media == "screen")) {
        for (const Node& text : node.children()) document.sheet.add(text.value());
      }
      return true;
    }
  } walker(*this);
  xml.traverse(walker);
}

Node Document::find(std::string_view id) const {
  for (const auto* names : {&ids, &labels}) {
    if (const auto found = names->find(id); found != names->end()) return found->second;
  }
  return {};
}

Node Document::target(std::string_view reference) const {
  reference = trimmed(reference);
  return reference.starts_with('#') ? find(reference.substr(1)) : Node();
}

bool Document::sized() const {
  const auto width = page_length(root, "width"), height = page_length(root, "height");
  return (width && width->unit) || (height && height->unit);
}

Point Document::view() const {
  if (const auto box = view_box(root)) return {(*box)[2], (*box)[3]};
  const auto pixels = [&](const char* side, double missing) {
    const auto length = page_length(root, side);
    return length ? length->value * length->unit.value_or(1) : missing;
  };
  return {pixels("width", 300), pixels("height", 150)};  // what CSS gives to what has no size
}

Affine Document::page(const DrawingScale& scale) const {
  constexpr double metres_per_px = 0.0254 / 96;
  const auto width = page_length(root, "width"), height = page_length(root, "height");
  const auto box = view_box(root);
  Point unit{scale.metres_per_unit, scale.metres_per_unit};
  if (scale.metres_per_unit == 0) {
    if (!sized()) {
      throw ShapeError("svg", "has no physical size",
                       "give its width and height a unit (\"200mm\"), or say how many metres a unit is "
                       "(\"scale\" of the body, --scale)");
    }
    const auto px_per_unit = [&](const std::optional<Length>& length, double of) {
      return length && length->unit && box ? length->value * *length->unit / of : std::optional<double>();
    };
    const auto across = px_per_unit(width, box ? (*box)[2] : 1),
               up = px_per_unit(height, box ? (*box)[3] : 1);
    unit = {across.value_or(up.value_or(1)) * metres_per_px, up.value_or(across.value_or(1)) * metres_per_px};
    const std::string_view aspect = root.attribute("preserveAspectRatio").value();
    if (!aspect.starts_with("none")) {
      const bool slice = aspect.ends_with("slice");
      unit.x = unit.y = slice ? std::max(unit.x, unit.y) : std::min(unit.x, unit.y);
    }
  }
  const double bottom = box ? (*box)[1] + (*box)[3] : view().y;
  return {unit.x, 0, 0, -unit.y, 0, unit.y * bottom};
}

}  // namespace ductile::svg
