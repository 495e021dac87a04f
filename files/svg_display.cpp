// The walk through a drawing in the order in which a browser paints it.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "svg_document.h"

namespace ductile::svg {
namespace {

using Node = pugi::xml_node;

template <std::size_t n>
bool among(std::string_view name, const std::array<std::string_view, n>& list) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

/// What is around an element.
struct Around {
  Style style;
  Affine to;
  Point view;
  std::vector<Clip> clips;
  std::vector<std::string> names;
  std::vector<Node> uses;  ///< what is shown as a copy
  bool whole = false;      ///< clips are not asked for
  int depth = 0;
};

/// "x y", each a length or a word; percentages and words are of the view.
Point origin_of(const Style& style, const Point& view) {
  Point origin = get(style, "transform-origin").empty() ? Point{0, 0} : 0.5 * view;
  std::string_view text = get(style, "transform-origin");
  for (int axis = 0; axis < 2 && !text.empty(); ++axis) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\n"));
    text = trimmed(text.substr(word.size()));
    const bool down = word == "top" || word == "bottom" || (axis == 1 && word != "left" && word != "right");
    double& at = down ? origin.y : origin.x;
    const double whole = down ? view.y : view.x;
    if (word == "left" || word == "top") {
      at = 0;
    } else if (word == "right" || word == "bottom") {
      at = whole;
    } else if (word != "center") {
      at = user_length(word, "transform-origin", whole, font_size(style));
    }
  }
  return origin;
}

Affine transform_of(const Style& style, const Point& view) {
  const std::string_view text = get(style, "transform");
  if (text.empty() || text == "none") return {};
  if (const auto box = get(style, "transform-box"); box != "" && box != "view-box")
    throw ShapeError("transform-box", "is not taken", "put the transform into a matrix");
  const Point origin = origin_of(style, view);
  return Affine{1, 0, 0, 1, origin.x, origin.y} * parse_transform(text) *
         Affine{1, 0, 0, 1, -origin.x, -origin.y};
}

/// Does the reader's language fit the element? It is English.
bool speaks(const Node& node) {
  std::string_view list = node.attribute("systemLanguage").value();
  if (!node.attribute("systemLanguage")) return true;
  while (!list.empty()) {
    const std::string_view one = trimmed(list.substr(0, list.find(',')));
    if (one == "en" || one.starts_with("en-")) return true;
    list.remove_prefix(std::min(list.find(','), list.size() - 1) + 1);
  }
  return false;
}

class Walk {
 public:
  Walk(const Document& document, Take take) : document_(document), take_(take) {}

  void visit(const Node& node, const Around& around);
  /// The shape's number among all of its kind, shown or not.
  void count(const Node& node) {
    if (is_shape(node)) numbers_.emplace(node, ++counts_[std::string(local_name(node))]);
  }

  Shown shown;

 private:
  void enter(const Node& node, Around here, std::string_view kind);
  void use(const Node& node, const Around& here);
  void show(const Node& target, const Around& around);
  void frame(const Node& node, Around& here, const Point& corner, const Point& size) const;
  void clip(const Node& node, Around& here, const Style& of, std::string_view property, int depth = 0);
  Affine box_of(const Node& node, Around here);
  std::string place(const Node& node) const { return document_.name + ":" + title(node); }
  std::string title(const Node& node) const;

  const Document& document_;
  Take take_;
  std::map<Node, int> numbers_;
  std::map<std::string, int> counts_;
  std::size_t visits_ = 0;
};

/// What a user finds it by.
std::string Walk::title(const Node& node) const {
  for (const char* attribute : {"id", "inkscape:label", "aria-label"}) {
    const std::string_view text = trimmed(node.attribute(attribute).value());
    if (!text.empty()) return std::string(text);
  }
  for (const Node& child : node.children()) {
    if (local_name(child) == "title" && *child.child_value())
      return std::string(trimmed(child.child_value()));
  }
  const auto number = numbers_.find(node);
  return std::string(local_name(node)) +
         (number == numbers_.end() ? "" : " " + std::to_string(number->second));
}

void Walk::visit(const Node& node, const Around& around) {
  static constexpr std::array<std::string_view, 4> containers{"svg", "g", "a", "switch"};
  static constexpr std::array<std::string_view, 3> unlike{"text", "image", "foreignObject"};
  constexpr std::size_t most_visits = 1'000'000;
  constexpr int most_depth = 256;
  const std::string_view kind = local_name(node);
  const bool container = among(kind, containers);
  if (!container && !is_shape(node) && kind != "use" && !among(kind, unlike) &&
      !(kind == "symbol" && take_ == Take::all))
    return;
  if (!speaks(node)) return;
  if (around.depth > most_depth) {
    throw InvalidInput({{place(node), "is more than 256 groups deep", "ungroup them"}});
  }
  if (++visits_ > most_visits) {
    throw InvalidInput({{document_.name, "shows more than 1000000 elements", "use fewer copies"}});
  }
  Around here = around;
  ++here.depth;
  here.style = document_.sheet.style(node, around.style);
  if (get(here.style, "display") == "none" && take_ != Take::all) return;
  if (among(kind, unlike)) {
    const bool text = kind == "text";
    shown.not_taken.push_back({place(node), text ? "is text" : "is no shape",
                               text ? "turn it into a path to make a body of it" : "draw it as a path"});
    return;
  }
  for (const char* attribute : {"id", "inkscape:label"}) {
    if (const std::string_view name = node.attribute(attribute).value(); !name.empty())
      here.names.emplace_back(name);
  }
  try {
    here.to = here.to * transform_of(here.style, here.view);
    if (take_ == Take::seen && number(here.style, "opacity", 1) <= 0) return;
    clip(node, here, here.style, "clip-path");
    clip(node, here, here.style, "mask");
    const std::string_view filter = get(here.style, "filter");
    if (take_ != Take::outlines && !filter.empty() && filter != "none")
      shown.not_taken.push_back({place(node), "has a filter, which is not taken", "expand it into shapes"});
    enter(node, std::move(here), kind);
  } catch (const ShapeError& error) {
    Painted bad{node, {}, {}, {}, {}, title(node), std::move(here.names), {}};
    bad.names.push_back(bad.name);
    bad.problem = {place(node) + ", " + error.place, error.what(), error.remedy};
    shown.shapes.push_back(std::move(bad));
  }
}

void Walk::enter(const Node& node, Around here, std::string_view kind) {
  if (kind == "use") return use(node, here);
  if (is_shape(node)) {
    const std::string_view visibility = get(here.style, "visibility");
    if (take_ != Take::all && (visibility == "hidden" || visibility == "collapse")) return;
    for (const char* marker : {"marker", "marker-start", "marker-mid", "marker-end"}) {
      if (const auto value = get(here.style, marker);
          take_ != Take::outlines && !value.empty() && value != "none") {
        shown.not_taken.push_back(
            {place(node), "has markers, which are not taken", "expand them into shapes"});
        break;
      }
    }
    if (take_ == Take::seen && !document_.paints(here.style, "fill", "black") &&
        !document_.paints(here.style, "stroke", "none")) {
      return;  // a guide, or the frame of an icon
    }
    Painted shape{node,        std::move(here.style), here.to, here.view, std::move(here.clips),
                  title(node), std::move(here.names), {}};
    shape.names.push_back(shape.name);
    shown.shapes.push_back(std::move(shape));
    return;
  }
  if (kind == "svg" && node != document_.root) {
    const Point corner{user_length(here.style, "x", here.view.x), user_length(here.style, "y", here.view.y)};
    const Point size{user_length(here.style, "width", here.view.x, here.view.x),
                     user_length(here.style, "height", here.view.y, here.view.y)};
    frame(node, here, corner, size);
  }
  for (const Node& child : node.children()) {
    if (kind != "switch") {
      visit(child, here);
    } else if (child.type() == pugi::node_element && local_name(child) != "foreignObject" && speaks(child) &&
               !*child.attribute("requiredExtensions").value()) {
      return visit(child, here);  // the first that can be shown; foreignObject is HTML
    }
  }
}

/// A view of its own: what is outside of it is cut off, unless it says that it overflows.
void Walk::frame(const Node& node, Around& here, const Point& corner, const Point& size) const {
  here.to = here.to * Affine{1, 0, 0, 1, corner.x, corner.y};
  const std::string_view overflow = get(here.style, "overflow");
  if (overflow != "visible" && overflow != "auto") {
    Ring ring;
    for (const Point p : {Point{0, 0}, Point{size.x, 0}, size, Point{0, size.y}}) ring.push_back(here.to(p));
    here.clips.push_back({{}, std::move(ring), {}, false});
  }
  here.view = size;
  if (const auto box = view_box(node)) {
    here.to = here.to * fit(*box, size, node.attribute("preserveAspectRatio").value());
    here.view = {(*box)[2], (*box)[3]};
  }
}

void Walk::use(const Node& node, const Around& around) {
  std::string_view reference = node.attribute("href").value();
  if (reference.empty()) reference = node.attribute("xlink:href").value();
  const Node target = document_.target(reference);
  bool within = std::find(around.uses.begin(), around.uses.end(), target) != around.uses.end();
  for (Node at = node; at && !within; at = at.parent()) within = at == target;
  if (!target || within) {
    throw ShapeError("<use>",
                     (within ? "shows itself: \"" : "leads nowhere: \"") + std::string(reference) + "\"",
                     "let it show another shape of the drawing");
  }
  const std::size_t before = shown.shapes.size();
  show(target, around);
  // A copy is called by the name of its use where it has one.
  if (shown.shapes.size() == before + 1 && !title(node).empty() && title(node) != "use") {
    Painted& copy = shown.shapes.back();
    copy.name = title(node);
    copy.names.push_back(copy.name);
  }
}

/// What a use shows, in its place.
void Walk::show(const Node& target, const Around& around) {
  Around here = around;
  here.uses.push_back(target);
  const Point corner{user_length(here.style, "x", here.view.x), user_length(here.style, "y", here.view.y)};
  const std::string_view kind = local_name(target);
  if (kind == "symbol" || kind == "svg") {
    const Around outside = here;
    here.style = document_.sheet.style(target, here.style);
    if (get(here.style, "display") == "none" && take_ != Take::all) return;
    const auto side = [&](const char* name, double whole) {
      const double own = user_length(here.style, name, whole, whole);
      return user_length(around.style, name, whole, own);
    };
    frame(target, here, corner, {side("width", here.view.x), side("height", here.view.y)});
    for (const Node& child : target.children()) visit(child, here);
    return;
  }
  here.to = here.to * Affine{1, 0, 0, 1, corner.x, corner.y};
  visit(target, here);
}

/// From the unit square to the box around what an element fills, in its own coordinates (SVG 2 §8.10).
Affine Walk::box_of(const Node& node, Around here) {
  Walk within(document_, take_ == Take::all ? Take::all : Take::outlines);
  within.visits_ = visits_;
  here.to = {};
  here.clips.clear();
  here.whole = true;
  within.enter(node, here, local_name(node));
  visits_ = within.visits_;
  Bounds box;
  for (const Painted& shape : within.shown.shapes) {
    if (shape.problem) continue;  // it is said where it is shown
    const Bounds own = document_.box(shape);
    if (own.empty()) continue;
    box.add(own.low);
    box.add(own.high);
  }
  if (box.empty()) return {0, 0, 0, 0, 0, 0};
  return {box.size().x, 0, 0, box.size().y, box.low.x, box.low.y};
}

/// The clipPath or mask that a style names; `of` is the node's own style, or that of a clipPath of it, which
/// may be cut itself. (A mask may not.)
void Walk::clip(const Node& node, Around& here, const Style& of, std::string_view property, int depth) {
  const std::string_view value = get(of, property);
  if (value.empty() || value == "none" || here.whole) return;
  if (depth > most_clips_deep) throw ShapeError(std::string(property), "clips itself", "take the circle out");
  const auto open = value.find('('), close = value.find(')');
  std::string_view reference;
  if (value.starts_with("url") && open < close && close != std::string_view::npos) {
    reference = trimmed(value.substr(open + 1, close - open - 1));
    if (reference.size() > 1 && (reference[0] == '"' || reference[0] == '\''))
      reference = reference.substr(1, reference.size() - 2);
  }
  const Node element = document_.target(reference);
  if (!element) {
    if (!reference.starts_with('#')) {
      shown.not_taken.push_back(
          {place(node),
           "has the " + std::string(property) + " \"" + std::string(value) + "\", which is not taken",
           "name a clipPath of the drawing"});
    }
    return;  // what is not there does not clip
  }
  const bool mask = property == "mask";
  const std::string_view kind = local_name(element);
  if (kind != (mask ? "mask" : "clipPath")) {
    throw ShapeError(std::string(property), "is a <" + std::string(kind) + ">",
                     mask ? "name a mask" : "name a clipPath");
  }
  const Style style = document_.sheet.style(element, {});
  const std::string_view units = element.attribute("maskUnits").value(),
                         content = element.attribute(mask ? "maskContentUnits" : "clipPathUnits").value();
  const bool region_in_box = mask && units != "userSpaceOnUse", in_box = content == "objectBoundingBox";
  const Affine box = region_in_box || in_box ? box_of(node, here) : Affine{};
  Clip cut{element, {}, in_box ? here.to * box : here.to, mask};
  if (mask) {
    const Point whole = region_in_box ? Point{1, 1} : here.view;
    const Point corner{user_length(style, "x", whole.x, -0.1 * whole.x),
                       user_length(style, "y", whole.y, -0.1 * whole.y)},
        size{user_length(style, "width", whole.x, 1.2 * whole.x),
             user_length(style, "height", whole.y, 1.2 * whole.y)};
    const Affine to = region_in_box ? here.to * box : here.to;
    for (const Point p : {Point{0, 0}, Point{size.x, 0}, size, Point{0, size.y}})
      cut.frame.push_back(to(corner + p));
  }
  here.clips.push_back(std::move(cut));
  if (!mask) clip(node, here, style, property, depth + 1);
}

/// Numbers the shapes, and visits `from` with what is around it.
Shown walk(const Document& document, const Node& from, const Around& around, Take take) {
  Walk walk(document, take);
  struct Counter : pugi::xml_tree_walker {
    Walk& walk;
    explicit Counter(Walk& of) : walk(of) {}
    bool for_each(Node& node) override {
      walk.count(node);
      return true;
    }
  } counter(walk);
  Node(document.root).traverse(counter);
  walk.visit(from, around);
  return std::move(walk.shown);
}

/// The element's ancestors, from the root.
std::vector<Node> ancestors(const Node& element) {
  std::vector<Node> path;
  for (Node node = element.parent(); node.type() == pugi::node_element; node = node.parent())
    path.push_back(node);
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace

bool is_shape(const Node& node) {
  static constexpr std::array<std::string_view, 7> shapes{"path",    "rect",     "circle", "ellipse",
                                                          "polygon", "polyline", "line"};
  return among(local_name(node), shapes);
}

Shown Document::shown(const Affine& page) const {
  Around around;
  around.to = page;
  around.view = view();
  Shown all = walk(*this, root, around, Take::seen);
  if (const auto& rules = sheet.not_taken; !rules.empty()) {
    all.not_taken.push_back(
        {name + ":style",
         "has rules that are not taken: \"" + rules.front() + "\"" +
             (rules.size() > 1 ? " and " + std::to_string(rules.size() - 1) + " more" : ""),
         "give the shapes a class"});
  }
  return all;
}

Shown Document::held(const Node& element, const Affine& page) const {
  Around around;
  around.to = page;
  around.view = view();
  for (const Node& node : ancestors(element)) {
    around.style = sheet.style(node, around.style);
    around.to = around.to * transform_of(around.style, around.view);
  }
  return walk(*this, element, around, Take::all);
}

Shown Document::shown_in(const Node& element, const Affine& to, const Point& view, Take take) const {
  Around around;
  around.to = to;
  around.view = view;
  for (const Node& node : ancestors(element)) around.style = sheet.style(node, around.style);
  // The clipPath's own transform comes on top of the coordinates of what it clips.
  around.to = around.to * transform_of(around.style, around.view);
  Walk walk(*this, take);  // whose shapes need no names
  walk.visit(element, around);
  return std::move(walk.shown);
}

}  // namespace ductile::svg
