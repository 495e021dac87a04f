#include "svg_style.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace ductile::svg {
namespace {

using Node = pugi::xml_node;

constexpr std::array<std::string_view, 19> inherited{"clip-rule",
                                                     "color",
                                                     "fill",
                                                     "fill-opacity",
                                                     "fill-rule",
                                                     "font-size",
                                                     "marker",
                                                     "marker-end",
                                                     "marker-mid",
                                                     "marker-start",
                                                     "stroke",
                                                     "stroke-dasharray",
                                                     "stroke-dashoffset",
                                                     "stroke-linecap",
                                                     "stroke-linejoin",
                                                     "stroke-miterlimit",
                                                     "stroke-opacity",
                                                     "stroke-width",
                                                     "visibility"};
// Geometry is a matter of style, too (SVG 2 §8.9).
constexpr std::array<std::string_view, 21> own{"clip-path",
                                               "cx",
                                               "cy",
                                               "d",
                                               "display",
                                               "filter",
                                               "height",
                                               "mask",
                                               "mask-type",
                                               "opacity",
                                               "overflow",
                                               "r",
                                               "rx",
                                               "ry",
                                               "transform",
                                               "transform-box",
                                               "transform-origin",
                                               "vector-effect",
                                               "width",
                                               "x",
                                               "y"};

/// The property as it is written here, whose case CSS is free in; empty where it is of no use to geometry.
std::string_view known(std::string_view property) {
  const auto same = [&](std::string_view name) {
    return std::equal(name.begin(), name.end(), property.begin(), property.end(),
                      [](char a, unsigned char b) { return a == std::tolower(b); });
  };
  for (const std::string_view name : inherited)
    if (same(name)) return name;
  const auto found = std::find_if(own.begin(), own.end(), same);
  return found == own.end() ? std::string_view() : *found;
}
bool is_own(std::string_view property) { return std::find(own.begin(), own.end(), property) != own.end(); }

std::string_view part_until(std::string_view& text, std::string_view ends) {
  const auto end = std::min(text.find_first_of(ends), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

/// Calls take(property, value, important) for each declaration.
template <class Take>
void each_declaration(std::string_view text, const Take& take) {
  while (!text.empty()) {
    std::string_view value = part_until(text, ";");
    if (value.find(':') == std::string_view::npos) continue;
    const std::string_view property = known(trimmed(part_until(value, ":")));
    value = trimmed(value);
    const auto mark = value.rfind('!');
    const bool important = mark != std::string_view::npos && trimmed(value.substr(mark + 1)) == "important";
    if (important) value = trimmed(value.substr(0, mark));
    if (!property.empty() && !value.empty()) take(property, value, important);
  }
}

bool has_word(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    if (part_until(list, " \t\r\n\f") == word) return true;
  }
  return false;
}

/// "[a]", "[a=b]", "[a^='b']" and so on (Selectors 3 §6.3).
bool has_attribute(const Node& node, std::string_view test) {
  test = test.substr(1, test.size() - 2);
  const auto equals = test.find('=');
  std::string_view name = trimmed(test.substr(0, equals));
  const char how = name.empty() ? '=' : name.back();
  const bool marked =
      equals != std::string_view::npos && std::string_view("^$*~|").find(how) != std::string_view::npos;
  if (marked) name.remove_suffix(1);
  const auto attribute = node.attribute(std::string(trimmed(name)).c_str());
  if (attribute.empty() || equals == std::string_view::npos) return !attribute.empty();
  std::string_view value = trimmed(test.substr(equals + 1));
  if (value.size() >= 2 && (value[0] == '"' || value[0] == '\'')) value = value.substr(1, value.size() - 2);
  const std::string_view has = attribute.value();
  if (!marked) return has == value;
  if (how == '|') return has == value || has.starts_with(std::string(value) + "-");
  if (value.empty()) return false;
  switch (how) {
    case '^':
      return has.starts_with(value);
    case '$':
      return has.ends_with(value);
    case '*':
      return has.find(value) != std::string_view::npos;
    default:
      return has_word(has, value);
  }
}

/// Of what one points at or has visited, or of what is beside the element: never so on a page at rest.
bool of_a_moment(std::string_view selector) {
  static constexpr std::array<std::string_view, 6> states{":hover",   ":active", ":focus",
                                                          ":visited", ":target", "::"};
  return std::any_of(states.begin(), states.end(), [&](std::string_view state) {
    return selector.find(state) != std::string_view::npos && selector.find(":not(") == std::string_view::npos;
  });
}

/// An at-rule whose rules a browser would follow on a screen, under a condition.
bool is_conditional(std::string_view rule) {
  static constexpr std::array<std::string_view, 5> kinds{"@media", "@supports", "@layer", "@container",
                                                         "@scope"};
  const std::string_view kind = rule.substr(0, rule.find_first_of(" \t\r\n\f({"));
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) return false;
  return kind != "@media" || !trimmed(rule.substr(kind.size())).starts_with("print");
}

bool fits_part(const Node& node, std::string_view part) {
  if (part == "*") return true;
  switch (part[0]) {
    case '#':
      return node.attribute("id").value() == part.substr(1);
    case '.':
      return has_word(node.attribute("class").value(), part.substr(1));
    case '[':
      return has_attribute(node, part);
    case ':':
      return part == ":root" && node.parent().type() == pugi::node_document;
    default:
      return local_name(node) == part;
  }
}

}  // namespace

std::string_view local_name(const Node& node) {
  const std::string_view name = node.name();
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view space = " \t\r\n\f";
  const auto from = text.find_first_not_of(space);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(space) - from + 1);
}

void StyleSheet::add(std::string_view css) {
  std::string& kept = texts_.emplace_back();
  for (std::size_t at = 0; at < css.size();) {
    const auto comment = std::min(css.find("/*", at), css.size());
    kept += css.substr(at, comment - at);
    const auto end = css.find("*/", std::min(comment + 2, css.size()));
    at = comment == css.size() || end == std::string_view::npos ? css.size() : end + 2;
  }
  std::string_view text = kept;
  while (!(text = trimmed(text)).empty()) {
    const auto brace = text.find('{');
    const auto semicolon = text.find(';');
    if (text[0] == '@' && semicolon < brace) {  // @import, @charset
      if (text.starts_with("@import")) not_taken.emplace_back(text.substr(0, semicolon));
      text.remove_prefix(semicolon + 1);
      continue;
    }
    if (brace == std::string_view::npos) return;
    int depth = 1;
    std::size_t end = brace + 1;
    for (; end < text.size() && depth > 0; ++end) depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
    const std::string_view body = text.substr(brace + 1, end - brace - (depth == 0 ? 2 : 1));
    if (text[0] != '@') {
      add_rule(text.substr(0, brace), body);
    } else if (is_conditional(text) && StyleSheet(body).matters()) {
      not_taken.emplace_back(trimmed(text.substr(0, brace)));
    }
    text.remove_prefix(end);
  }
  std::stable_sort(rules_.begin(), rules_.end(),
                   [](const Rule& a, const Rule& b) { return a.specificity < b.specificity; });
}

void StyleSheet::add_rule(std::string_view selectors, std::string_view declarations) {
  while (!selectors.empty()) {
    const std::string_view whole = trimmed(part_until(selectors, ","));
    std::string_view selector = whole;
    Rule rule{{}, 0, declarations};
    bool child = false, understood = !selector.empty();
    while (!selector.empty() && understood) {
      if (selector[0] == '>') {
        child = true;
        selector = trimmed(selector.substr(1));
        continue;
      }
      Compound compound{{}, child};
      child = false;
      while (!selector.empty() &&
             std::string_view(" \t\r\n\f>").find(selector[0]) == std::string_view::npos) {
        const std::size_t end =
            selector[0] == '[' ? std::min(selector.find(']'), selector.size() - 1) + 1
                               : std::min(selector.find_first_of(" \t\r\n\f>.#[:+~", 1), selector.size());
        const std::string_view part = selector.substr(0, end);
        selector.remove_prefix(end);
        const bool simple = part[0] == '.' || part[0] == '#';
        understood = understood && (part[0] != ':' || part == ":root") && part[0] != '+' && part[0] != '~' &&
                     !(simple && part.size() == 1) && !(part[0] == '[' && part.back() != ']');
        rule.specificity += part[0] == '#'                                       ? 10000
                            : part[0] == '.' || part[0] == '[' || part[0] == ':' ? 100
                            : part == "*"                                        ? 0
                                                                                 : 1;
        compound.parts.push_back(part);
      }
      rule.selector.push_back(std::move(compound));
      selector = trimmed(selector);
    }
    if (understood && !rule.selector.empty()) {
      rules_.push_back(std::move(rule));
    } else if (!of_a_moment(whole)) {
      bool matters = false;
      each_declaration(declarations, [&](auto, auto, bool) { matters = true; });
      if (matters) not_taken.emplace_back(whole);
    }
  }
}

bool StyleSheet::matters() const {
  return !not_taken.empty() || std::any_of(rules_.begin(), rules_.end(), [](const Rule& rule) {
    bool any = false;
    each_declaration(rule.declarations, [&](auto, auto, bool) { any = true; });
    return any;
  });
}

bool StyleSheet::fits(const Rule& rule, const Node& node) const {
  const auto fits_compound = [](const Node& at, const Compound& compound) {
    return std::all_of(compound.parts.begin(), compound.parts.end(),
                       [&](std::string_view part) { return fits_part(at, part); });
  };
  // From the last compound outward; the nearest ancestor that fits is taken.
  Node at = node;
  for (std::size_t i = rule.selector.size(); i-- > 0;) {
    const bool only_this = i + 1 == rule.selector.size() || rule.selector[i + 1].child;
    while (!only_this && at.type() == pugi::node_element && !fits_compound(at, rule.selector[i]))
      at = at.parent();
    if (at.type() != pugi::node_element || !fits_compound(at, rule.selector[i])) return false;
    at = at.parent();
  }
  return true;
}

Style StyleSheet::style(const Node& node, const Style& parent) const {
  Style style, important;
  for (const auto& [property, value] : parent) {
    if (!is_own(property)) style[property] = value;
  }
  const auto set = [&](Style& to, std::string_view property, std::string_view value) {
    if (value != "inherit") {
      to[property] = value;
    } else if (const auto found = parent.find(property); found != parent.end()) {
      to[property] = found->second;
    } else {
      to.erase(property);
    }
  };
  for (const auto& attribute : node.attributes()) {
    const std::string_view value = trimmed(attribute.value());
    if (known(attribute.name()) == attribute.name() && !value.empty()) set(style, attribute.name(), value);
  }
  const auto declare = [&](std::string_view property, std::string_view value, bool is_important) {
    set(is_important ? important : style, property, value);
  };
  for (const Rule& rule : rules_) {
    if (fits(rule, node)) each_declaration(rule.declarations, declare);
  }
  each_declaration(node.attribute("style").value(), declare);
  for (const auto& [property, value] : important) style[property] = value;
  return style;
}

}  // namespace ductile::svg
