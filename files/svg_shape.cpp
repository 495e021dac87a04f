// The area that a shape paints: fill and stroke, within its clips and masks.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "svg_document.h"
#include "svg_stroke.h"

namespace ductile::svg {
namespace {

using Node = pugi::xml_node;

/// A length > 0, or the reason why there is no area.
double positive(const char* name, double length) {
  if (!(length > 0)) throw ShapeError(name, "is not > 0", "such a shape has no area");
  return length;
}

/// Of an attribute, or of a style: path("M 0 0 h 1").
std::string_view path_data(std::string_view d) {
  if (d == "none") return {};
  if (!d.starts_with("path(")) return d;
  const auto open = d.find_first_of("\"'"), close = d.find_last_of("\"'");
  return open < close ? d.substr(open + 1, close - open - 1) : std::string_view();
}

std::vector<Subpath> curves(const Painted& shape, const Affine& to) {
  const Node& node = shape.node;
  const Style& style = shape.style;
  const Point& view = shape.view;
  const std::string_view kind = local_name(node);
  const double diagonal = length(view) / std::sqrt(2.);
  const auto x = [&](const char* name) { return user_length(style, name, view.x); };
  const auto y = [&](const char* name) { return user_length(style, name, view.y); };
  if (kind == "path") return parse_path(path_data(get(style, "d")), to);
  if (kind == "circle") {
    const double r = positive("r", user_length(style, "r", diagonal));
    return ellipse({x("cx"), y("cy")}, r, r, to);
  }
  const double one = y("ry"), rx = user_length(style, "rx", view.x, one),  // one of them stands for both
      ry = user_length(style, "ry", view.y, rx);
  if (kind == "ellipse") {
    return ellipse({x("cx"), y("cy")}, positive("rx", rx), positive("ry", ry), to);
  }
  if (kind == "rect") {
    return rectangle({x("x"), y("y")}, positive("width", x("width")), positive("height", y("height")),
                     std::max(0., rx), std::max(0., ry), to);
  }
  if (kind == "line") {
    const auto end = [&](const char* name, double whole) {
      const std::string_view text = trimmed(node.attribute(name).value());
      return text.empty() ? 0 : user_length(text, name, whole, font_size(style));
    };
    const Point from{end("x1", view.x), end("y1", view.y)}, at{end("x2", view.x), end("y2", view.y)};
    std::vector<Subpath> line{{to(from), {Line{to(at)}}, false}};
    return line;
  }
  return polygon(node.attribute("points").value(), kind == "polygon", to);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return result;
}

bool transparent(std::string_view colour) {
  const std::string paint = lower(colour);
  if (paint == "none" || paint == "transparent") return true;
  if (paint.starts_with('#')) {
    return (paint.size() == 9 && paint.ends_with("00")) || (paint.size() == 5 && paint.ends_with('0'));
  }
  // rgb(r g b / alpha) or rgba(r, g, b, alpha)
  const auto slash = paint.find('/');
  const auto before = slash != std::string::npos                         ? slash
                      : std::count(paint.begin(), paint.end(), ',') == 3 ? paint.rfind(',')
                                                                         : std::string::npos;
  if (before == std::string::npos || !paint.ends_with(')')) return false;
  try {
    return Numbers(std::string_view(paint).substr(before + 1)).number() == 0;
  } catch (const std::invalid_argument&) {
    return false;  // none, calc(…)
  }
}

bool even_odd(const Style& style, const char* property) {
  const std::string_view rule = get(style, property, "nonzero");
  if (rule != "evenodd" && rule != "nonzero") {
    throw ShapeError(property, "is \"" + std::string(rule) + "\"", "write evenodd or nonzero");
  }
  return rule == "evenodd";
}

Pen pen_of(const Style& style, const Point& view) {
  Pen pen;
  const double diagonal = length(view) / std::sqrt(2.);
  pen.width = user_length(style, "stroke-width", diagonal, pen.width);
  const std::string_view cap = get(style, "stroke-linecap"), join = get(style, "stroke-linejoin");
  pen.cap = cap == "round" ? Pen::round_cap : cap == "square" ? Pen::square : Pen::butt;
  pen.join = join == "round" ? Pen::round_join : join == "bevel" ? Pen::bevel : Pen::miter;
  pen.miter_limit = number(style, "stroke-miterlimit", 4);
  const std::string_view dashes = get(style, "stroke-dasharray");
  if (!dashes.empty() && dashes != "none") {
    for (std::string_view rest = trimmed(dashes); !rest.empty();) {
      const std::string_view dash = rest.substr(0, rest.find_first_of(", \t\r\n"));
      pen.dashes.push_back(user_length(dash, "stroke-dasharray", diagonal, font_size(style)));
      rest = trimmed(rest.substr(dash.size()));
      if (rest.starts_with(',')) rest = trimmed(rest.substr(1));
    }
    if (std::any_of(pen.dashes.begin(), pen.dashes.end(), [](double d) { return d < 0; })) pen.dashes.clear();
    pen.dash_offset = user_length(style, "stroke-dashoffset", diagonal, pen.dash_offset);
  }
  return pen;
}

std::vector<Ring> filled_rings(std::vector<Polyline> lines, double tolerance) {
  std::vector<Ring> rings;
  for (Polyline& line : lines) {
    Ring& ring = line.points;
    while (ring.size() > 1 && length(ring.back() - ring.front()) <= tolerance / 100) ring.pop_back();
    if (ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

/// Takes rings out that are thinner than the tolerance. Returns how many one could have seen: more than a
/// hundred times as long, which no rounding leaves.
std::size_t take_slivers_out(std::vector<Ring>& rings, double tolerance) {
  std::size_t seen = 0;
  std::erase_if(rings, [&](const Ring& ring) {
    double perimeter = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      perimeter += length(ring[i] - ring[j]);
    const bool sliver = std::abs(doubled_area_of(ring)) < tolerance * perimeter;
    seen += sliver && perimeter > 200 * tolerance;
    return sliver;
  });
  return seen;
}

/// Making pieces of a shape with more holes would take too long.
void refuse_riddled(const std::vector<Ring>& rings) {
  constexpr std::ptrdiff_t most = 10'000;
  const auto holes =
      std::count_if(rings.begin(), rings.end(), [](const Ring& ring) { return doubled_area_of(ring) < 0; });
  if (holes > most) {
    throw ShapeError("outline", "has " + std::to_string(holes) + " holes, more than " + std::to_string(most),
                     "draw it with fewer lines");
  }
}

double length_of(const Polyline& line) {
  double whole = line.closed ? length(line.points.front() - line.points.back()) : 0;
  for (std::size_t i = 1; i < line.points.size(); ++i) whole += length(line.points[i] - line.points[i - 1]);
  return whole;
}

// m: no body reaches farther.
constexpr double farthest = 1e12;

bool within_reach(const Bounds& box) {
  const auto near = [](Point p) { return std::abs(p.x) < farthest && std::abs(p.y) < farthest; };
  return near(box.low) && near(box.high);
}

}  // namespace

// A gradient or pattern that is not there paints what stands behind it.
bool Document::paints(const Style& style, const char* property, std::string_view missing) const {
  std::string_view paint = get(style, property, missing);
  if (paint.starts_with("url(")) {
    const auto close = std::min(paint.find(')'), paint.size() - 1);
    std::string_view reference = trimmed(paint.substr(4, close - 4));
    if (reference.size() > 1 && (reference[0] == '"' || reference[0] == '\''))
      reference = reference.substr(1, reference.size() - 2);
    if (target(reference)) {
      paint = "there";
    } else {
      paint = trimmed(paint.substr(close + 1));
      if (paint.empty()) paint = "none";
    }
  }
  if (paint == "currentColor" || paint == "currentcolor") paint = get(style, "color", "black");
  const std::string opacity = std::string(property) + "-opacity";
  return !transparent(paint) && number(style, opacity.c_str(), 1) > 0;
}

double Document::extent(const Painted& shape) const {
  const auto path = curves(shape, shape.to);
  if (std::none_of(path.begin(), path.end(), [](const Subpath& part) { return part.drawn(); })) return 0;
  Bounds box = box_around(path);
  if (paints(shape.style, "stroke", "none")) {
    const double half = stretch(shape.to) * pen_of(shape.style, shape.view).width / 2;
    box = {box.low - Point{half, half}, box.high + Point{half, half}};
  }
  if (!within_reach(box)) {
    throw ShapeError("shape", "reaches beyond 1e12 m", "draw it smaller, or nearer to the origin");
  }
  return length(box.high - box.low);
}

Bounds Document::box(const Painted& shape) const {
  const Bounds box = box_around(curves(shape, shape.to));
  return within_reach(box) ? box : Bounds();
}

Layer Document::filled(const Painted& shape, double tolerance) const {
  if (!paints(shape.style, "fill", "black") || local_name(shape.node) == "line") return {};
  return {filled_rings(flatten(curves(shape, shape.to), tolerance), tolerance),
          even_odd(shape.style, "fill-rule")};
}

Layer Document::stroked(const Painted& shape, double tolerance) const {
  if (!paints(shape.style, "stroke", "none")) return {};
  // A pen is round in the shape's own coordinates; unless it is told to keep its width on the page.
  Pen pen = pen_of(shape.style, shape.view);
  if (get(shape.style, "vector-effect") == "non-scaling-stroke")
    throw ShapeError("vector-effect", "is not taken", "give the stroke a width in the shape's units");
  const double growth = stretch(shape.to);
  if (!(pen.width > 0 && growth > 0)) return {};
  const auto lines = flatten(curves(shape, {}), tolerance / growth);
  if (const double own = shape.node.attribute("pathLength").as_double(); own > 0) {
    double whole = 0;  // dashes are measured as if the path were as long as it says
    for (const Polyline& line : lines) whole += length_of(line);
    for (double& dash : pen.dashes) dash *= whole / own;
    pen.dash_offset *= whole / own;
  }
  Layer layer{stroke(lines, pen, tolerance / growth), false};
  for (Ring& ring : layer.rings) {
    for (Point& p : ring) p = shape.to(p);
  }
  return layer;
}

namespace {

/// White shows and black hides; what is between is neither there nor gone.
bool shows(const Style& style, const char* property) {
  std::string paint = lower(get(style, property, "black"));
  if (paint == "currentcolor") paint = lower(get(style, "color", "black"));
  std::erase(paint, ' ');
  for (const char* white : {"#fff", "#ffffff", "white", "rgb(255,255,255)", "rgb(100%,100%,100%)"})
    if (paint == white) return true;
  for (const char* black : {"#000", "#000000", "black", "rgb(0,0,0)", "rgb(0%,0%,0%)"})
    if (paint == black) return false;
  throw ShapeError("mask", "is half transparent: \"" + paint + "\"", "paint it white where it shows");
}

}  // namespace

std::vector<Ring> Document::clip_area(const Clip& clip, const Point& view, double tolerance,
                                      int depth) const {
  if (!clip.element) return {clip.frame};
  const char* const property = clip.mask ? "mask" : "clip-path";
  if (depth > most_clips_deep) throw ShapeError(property, "clips itself", "take the circle out");
  const bool alpha = get(sheet.style(clip.element, {}), "mask-type") == "alpha";
  std::vector<Ring> area;
  for (const Node& child : clip.element.children()) {
    if (child.type() != pugi::node_element) continue;
    const Shown part = shown_in(child, clip.to, view, clip.mask ? Take::seen : Take::outlines);
    if (!part.not_taken.empty()) {
      const Problem& first = part.not_taken.front();
      throw ShapeError(property, "has a part that " + first.what, first.remedy);
    }
    for (const Painted& shape : part.shapes) {
      if (shape.problem) throw ShapeError(property, shape.problem->what, shape.problem->remedy);
      const auto lay = [&](Layer layer, bool white) {
        auto rings = within(overlay({std::move(layer)}, Overlay::unite), shape, tolerance, depth + 1);
        area = overlay({{std::move(area)}, {std::move(rings)}}, white ? Overlay::unite : Overlay::subtract);
      };
      if (!clip.mask) {
        lay({filled_rings(flatten(curves(shape, shape.to), tolerance), tolerance),
             even_odd(shape.style, "clip-rule")},
            true);
        continue;
      }
      if (Layer fill = filled(shape, tolerance); !fill.rings.empty())
        lay(std::move(fill), alpha || shows(shape.style, "fill"));
      if (Layer line = stroked(shape, tolerance); !line.rings.empty())
        lay(std::move(line), alpha || shows(shape.style, "stroke"));
    }
  }
  if (clip.mask) area = overlay({{std::move(area)}, {{clip.frame}}}, Overlay::intersect);
  return area;
}

std::vector<Ring> Document::within(std::vector<Ring> rings, const Painted& shape, double tolerance,
                                   int depth) const {
  for (const Clip& clip : shape.clips) {
    rings =
        overlay({{std::move(rings)}, {clip_area(clip, shape.view, tolerance, depth)}}, Overlay::intersect);
  }
  return rings;
}

Areas Document::areas(const Painted& shape, double tolerance) const {
  auto rings = overlay({filled(shape, tolerance), stroked(shape, tolerance)}, Overlay::unite);
  rings = within(std::move(rings), shape, tolerance, 0);
  Areas areas;
  areas.slivers = take_slivers_out(rings, tolerance);
  refuse_riddled(rings);
  areas.outlines = outlines(std::move(rings));
  const auto drawn = filled_rings(flatten(curves(shape, shape.to), tolerance), tolerance);
  constexpr std::size_t few = 1000;  // comparing takes quadratic time
  const auto as_drawn = [&](Ring& ring) {
    const auto same = std::find_if(drawn.begin(), drawn.end(), [&](const Ring& other) {
      return ring.size() <= few && other.size() == ring.size() &&
             std::is_permutation(ring.begin(), ring.end(), other.begin());
    });
    if (same != drawn.end()) ring = *same;
  };
  for (Outline& area : areas.outlines) {
    as_drawn(area.outer);
    for (Ring& hole : area.holes) as_drawn(hole);
  }
  return areas;
}

}  // namespace ductile::svg
