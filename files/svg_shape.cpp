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

double number(const Style& style, const char* property, double missing) {
  const std::string_view text = get(style, property);
  if (text.empty()) return missing;
  try {
    return Numbers(text).number() * (text.back() == '%' ? 0.01 : 1);
  } catch (const std::invalid_argument& error) {
    throw ShapeError(property, error.what(), "write a number");
  }
}

/// A length > 0, or the reason why there is no area.
double positive(const char* name, double length) {
  if (!(length > 0)) throw ShapeError(name, "is not > 0", "such a shape has no area");
  return length;
}

std::vector<Subpath> curves(const Painted& shape, const Affine& to) {
  const Node& node = shape.node;
  const Style& style = shape.style;
  const Point& view = shape.view;
  const std::string_view kind = local_name(node);
  const double diagonal = length(view) / std::sqrt(2.);
  const auto x = [&](const char* name) { return user_length(style, name, view.x); };
  const auto y = [&](const char* name) { return user_length(style, name, view.y); };
  if (kind == "path") return parse_path(node.attribute("d").value(), to);
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
    Numbers in(dashes);
    try {
      while (!in.end()) {
        double dash = in.number();
        if (in.peek() == '%') {
          in.take();
          dash *= diagonal / 100;
        }
        in.name();  // px
        if (in.peek() == ',') in.take();
        pen.dashes.push_back(dash);
      }
    } catch (const std::invalid_argument& error) {
      throw ShapeError("stroke-dasharray", error.what(), "write lengths");
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

/// Takes rings out that are thinner than the tolerance: nothing that one drew.
std::vector<Ring> without_slivers(std::vector<Ring> rings, double tolerance) {
  std::erase_if(rings, [&](const Ring& ring) {
    double perimeter = 0;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      perimeter += length(ring[i] - ring[j]);
    return std::abs(doubled_area_of(ring)) < tolerance * perimeter;
  });
  return rings;
}

bool finite(const Bounds& box) {
  return std::isfinite(length(box.low)) && std::isfinite(length(box.high)) &&
         std::isfinite(length(box.high - box.low));
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
  if (path.empty()) return 0;
  Bounds box = box_around(path);
  if (paints(shape.style, "stroke", "none")) {
    const double half = stretch(shape.to) * pen_of(shape.style, shape.view).width / 2;
    box = {box.low - Point{half, half}, box.high + Point{half, half}};
  }
  if (!finite(box)) {
    throw ShapeError("shape", "reaches beyond what a double holds",
                     "draw it smaller, or nearer to the origin");
  }
  return length(box.high - box.low);
}

std::vector<Ring> Document::painted(const Painted& shape, double tolerance) const {
  std::vector<Layer> layers;
  const bool fill = paints(shape.style, "fill", "black") && local_name(shape.node) != "line";
  if (fill) {
    layers.push_back({filled_rings(flatten(curves(shape, shape.to), tolerance), tolerance),
                      even_odd(shape.style, "fill-rule")});
  }
  if (paints(shape.style, "stroke", "none")) {
    // A pen is round in the shape's own coordinates; unless it is told to keep its width on the page.
    const Pen pen = pen_of(shape.style, shape.view);
    const bool fixed = get(shape.style, "vector-effect") == "non-scaling-stroke";
    if (fixed)
      throw ShapeError("vector-effect", "is not taken", "give the stroke a width in the shape's units");
    const double growth = stretch(shape.to);
    if (pen.width > 0 && growth > 0) {
      auto rings = stroke(flatten(curves(shape, {}), tolerance / growth), pen, tolerance / growth);
      for (Ring& ring : rings) {
        for (Point& p : ring) p = shape.to(p);
      }
      layers.push_back({std::move(rings), false});
    }
  }
  return overlay(layers, Overlay::unite);
}

std::vector<Ring> Document::clip_area(const Clip& clip, const Painted& of, double tolerance,
                                      int depth) const {
  if (!clip.element) return {clip.frame};
  if (depth > 8) throw ShapeError("clip-path", "clips itself", "take the circle out");
  const std::string_view kind = local_name(clip.element);
  if (kind != "clipPath" && kind != "mask") {
    throw ShapeError(clip.mask ? "mask" : "clip-path", "is a <" + std::string(kind) + ">",
                     "name a clipPath or a mask");
  }
  Painted around;  // the element itself, in the coordinates of what it clips
  around.node = clip.element;
  around.to = clip.to;
  const std::string_view units =
      clip.element.attribute(clip.mask ? "maskContentUnits" : "clipPathUnits").value();
  if (units == "objectBoundingBox") {
    if (clip.to.a != of.to.a || clip.to.e != of.to.e || clip.to.f != of.to.f) {
      throw ShapeError("clip-path", "is in units of a group's box", "give it userSpaceOnUse");
    }
    const Bounds box = box_around(curves(of, {}));
    around.to = clip.to * Affine{box.high.x - box.low.x, 0, 0, box.high.y - box.low.y, box.low.x, box.low.y};
  }
  std::vector<Ring> area;
  for (const Node& child : clip.element.children()) {
    if (child.type() != pugi::node_element) continue;
    for (Painted& shape : shown_in(child, around.to, of.view).shapes) {
      if (shape.problem) throw ShapeError("clip-path", shape.problem->what, shape.problem->remedy);
      if (clip.mask) {
        // White shows and black hides; what is between is neither there nor gone.
        const bool filled = paints(shape.style, "fill", "black");
        const std::string paint =
            lower(filled ? get(shape.style, "fill", "black") : get(shape.style, "stroke"));
        const bool white = paint == "#fff" || paint == "#ffffff" || paint == "white" ||
                           paint == "rgb(255,255,255)" ||
                           get(sheet.style(clip.element, {}), "mask-type") == "alpha";
        const bool black = paint == "#000" || paint == "#000000" || paint == "black";
        if (!white && !black)
          throw ShapeError("mask", "is half transparent: \"" + std::string(paint) + "\"",
                           "paint it white where it shows");
        auto rings = within(painted(shape, tolerance), shape, tolerance, depth + 1);
        area = overlay({{std::move(area)}, {std::move(rings)}}, white ? Overlay::unite : Overlay::subtract);
        continue;
      }
      const auto lines = flatten(curves(shape, shape.to), tolerance);
      auto rings =
          overlay({{filled_rings(lines, tolerance), even_odd(shape.style, "clip-rule")}}, Overlay::unite);
      rings = within(std::move(rings), shape, tolerance, depth + 1);
      area = overlay({{std::move(area)}, {std::move(rings)}}, Overlay::unite);
    }
  }
  return area;
}

std::vector<Ring> Document::within(std::vector<Ring> rings, const Painted& shape, double tolerance,
                                   int depth) const {
  for (const Clip& clip : shape.clips) {
    rings = overlay({{std::move(rings)}, {clip_area(clip, shape, tolerance, depth)}}, Overlay::intersect);
  }
  return rings;
}

std::vector<Outline> Document::areas(const Painted& shape, double tolerance) const {
  auto areas = outlines(without_slivers(within(painted(shape, tolerance), shape, tolerance, 0), tolerance));
  const auto drawn = filled_rings(flatten(curves(shape, shape.to), tolerance), tolerance);
  constexpr std::size_t few = 1000;  // comparing takes quadratic time
  const auto as_drawn = [&](Ring& ring) {
    const auto same = std::find_if(drawn.begin(), drawn.end(), [&](const Ring& other) {
      return ring.size() <= few && other.size() == ring.size() &&
             std::is_permutation(ring.begin(), ring.end(), other.begin());
    });
    if (same != drawn.end()) ring = *same;
  };
  for (Outline& area : areas) {
    as_drawn(area.outer);
    for (Ring& hole : area.holes) as_drawn(hole);
  }
  return areas;
}

}  // namespace ductile::svg
