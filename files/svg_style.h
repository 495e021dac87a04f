// How an SVG element is styled: presentation attributes, style sheets, style attributes, and what it inherits
// (CSS 2.1 §6.4: the cascade).
#pragma once

#include <list>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ductile::svg {

/// "svg:path" → "path".
std::string_view local_name(const pugi::xml_node& node);
std::string_view trimmed(std::string_view text);

/// Values of properties; a view into the document or the style sheet.
using Style = std::map<std::string_view, std::string_view>;

class StyleSheet {
 public:
  StyleSheet() = default;
  explicit StyleSheet(std::string_view css) { add(css); }
  /// The rules of a style element's text. Rules within an at-rule, and selectors with a pseudo-class, never
  /// apply: a page that is not interacted with, on no particular medium.
  void add(std::string_view css);

  /// Selectors and at-rules that a browser would follow, and sheets that it would import.
  std::vector<std::string> not_taken;
  /// Is there a rule that geometry depends on, taken or not?
  bool matters() const;

  /// The element's own values for the properties that geometry depends on, over those that it inherits.
  Style style(const pugi::xml_node& node, const Style& parent) const;

 private:
  /// "rect.a#b": all must fit.
  struct Compound {
    std::vector<std::string_view> parts;  ///< with their ".", "#" or "["
    bool child = false;                   ///< of the compound before it, not just a descendant
  };
  struct Rule {
    std::vector<Compound> selector;
    int specificity;
    std::string_view declarations;
  };
  bool fits(const Rule& rule, const pugi::xml_node& node) const;
  void add_rule(std::string_view selectors, std::string_view declarations);

  std::list<std::string> texts_;  // without comments
  std::vector<Rule> rules_;       // by specificity, then order
};

}  // namespace ductile::svg
