// An SVG file, and what a browser shows of it: a list of painted shapes, each with its map to the page, its
// style and what clips it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "ductile/files.h"
#include "overlay.h"
#include "svg_path.h"
#include "svg_style.h"

namespace ductile::svg {

/// What cuts a shape: a clipPath, a mask within its region, or the frame of a nested view.
struct Clip {
  pugi::xml_node element;  ///< none: the frame alone
  Ring frame;              ///< on the page; of a clipPath none
  Affine to;               ///< from the coordinates of the element's content to the page
  bool mask = false;
};

constexpr int most_clips_deep = 8;

/// What of a drawing is looked at: what a browser paints; what is there, painted or not, as a clipPath takes
/// it; or also what is hidden.
enum class Take { seen, outlines, all };

struct Painted {
  pugi::xml_node node;
  Style style;
  Affine to;                       ///< from the shape's coordinates to the page
  Point view;                      ///< width and height that percentages are of
  std::vector<Clip> clips;         ///< the shape is within all of them
  std::string name;                ///< its id, label or title, else "path 7"
  std::vector<std::string> names;  ///< by which it can be asked for: these of it and of the groups around it
  std::optional<Problem> problem;  ///< why it cannot be drawn
};

/// A style's value; else `missing`.
std::string_view get(const Style& style, std::string_view property, std::string_view missing = {});

struct Shown {
  std::vector<Painted> shapes;     ///< in document order
  std::vector<Problem> not_taken;  ///< text, images, …
};

struct Areas {
  std::vector<Outline> outlines;
  std::size_t slivers = 0;  ///< areas and gaps that were thinner than the tolerance, and are mended
};

struct Document {
  std::string name;
  pugi::xml_document xml;
  pugi::xml_node root;
  std::map<std::string_view, pugi::xml_node> ids, labels;  ///< the first element of each
  StyleSheet sheet;

  /// Throws InvalidInput where it is no SVG.
  Document(std::string_view text, std::string file);

  /// By id, else by inkscape:label; else none.
  pugi::xml_node find(std::string_view id) const;
  /// What "#id" leads to.
  pugi::xml_node target(std::string_view reference) const;

  /// Has it a size in the world?
  bool sized() const;
  /// From the root's coordinates, y down, to metres, y up: flipped at the bottom of the viewBox.
  Affine page(const DrawingScale& scale) const;
  /// Width and height that the root's percentages are of, in its units.
  Point view() const;

  /// Does a style paint with its "fill" or "stroke"? `missing` is the colour where it has none.
  bool paints(const Style& style, const char* property, std::string_view missing) const;

  /// What the page shows; `page` comes after every shape's own map.
  Shown shown(const Affine& page) const;
  /// What an element holds, whether or not the page shows it.
  Shown held(const pugi::xml_node& element, const Affine& page) const;

  /// The same of a part of a clipPath or mask, whose coordinates `to` brings to the page.
  Shown shown_in(const pugi::xml_node& element, const Affine& to, const Point& view, Take take) const;

  /// The connected areas that a shape covers within what clips it, the largest first. A ring that is as it
  /// was drawn keeps its first point and its direction.
  Areas areas(const Painted& shape, double tolerance) const;
  /// The diagonal of a box around it, m. Throws ShapeError where its data is wrong.
  double extent(const Painted& shape) const;
  /// Around what it fills, or would fill, on the page. Throws ShapeError where its data is wrong.
  Bounds box(const Painted& shape) const;

 private:
  Layer filled(const Painted& shape, double tolerance) const;
  Layer stroked(const Painted& shape, double tolerance) const;
  std::vector<Ring> clip_area(const Clip& clip, const Point& view, double tolerance, int depth) const;
  std::vector<Ring> within(std::vector<Ring> rings, const Painted& shape, double tolerance, int depth) const;
};

bool is_shape(const pugi::xml_node& node);

/// A number of a style, percentages as parts of 1.
double number(const Style& style, const char* property, double missing);
/// A length of a style in user units; `whole` is what a percentage is of.
double user_length(const Style& style, const char* name, double whole, double missing = 0);
/// The same of a text; `em` is the size of its font.
double user_length(std::string_view text, const char* name, double whole, double em);
double font_size(const Style& style);

/// x, y, width, height; nothing where the element has no viewBox. Throws ShapeError where it is none.
std::optional<std::array<double, 4>> view_box(const pugi::xml_node& node);
/// From a viewBox to a frame at the origin, as preserveAspectRatio has it.
Affine fit(const std::array<double, 4>& box, const Point& frame, std::string_view aspect);

}  // namespace ductile::svg
