// The geometry of an SVG shape: path data and basic shapes to curves, curves to rings.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "ductile/plane.h"
#include "ductile/section.h"

namespace ductile::svg {

using std::numbers::pi;

/// (x, y) → (a x + c y + e, b x + d y + f), as SVG's matrix(a b c d e f).
struct Affine {
  double a = 1, b = 0, c = 0, d = 1, e = 0, f = 0;
  Point operator()(const Point& p) const { return {a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
  /// Of a direction: without the shift.
  Point turn(const Point& p) const { return {a * p.x + c * p.y, b * p.x + d * p.y}; }
};
/// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);

struct Line {
  Point end;
};
struct Cubic {
  Point control1, control2, end;
};
/// P(t) = center + u cos t + v sin t, t from `from` over `sweep`: any ellipse, with u and v conjugate half
/// diameters.
struct Arc {
  Point center, u, v;
  double from, sweep;
  Point end;
};
using Curve = std::variant<Line, Cubic, Arc>;

struct Subpath {
  Point start;
  std::vector<Curve> curves;
  bool closed = false;  ///< a stroke joins its ends; filling closes every subpath

  bool drawn() const { return closed || !curves.empty(); }  ///< a move alone is not
};

/// What is wrong with a shape's data; `place` is within it ("command 3").
struct ShapeError : std::runtime_error {
  ShapeError(std::string where, const std::string& what, std::string right)
      : std::runtime_error(what), place(std::move(where)), remedy(std::move(right)) {}
  std::string place, remedy;
};

/// Numbers one after the other, separated as SVG allows: by spaces, a comma, or nothing where the grammar is
/// clear.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : text_(text) {}
  /// Skips white space; true at the end.
  bool end();
  /// The next character, which is no white space; 0 at the end.
  char peek() { return end() ? '\0' : text_[at_]; }
  char take() { return text_[at_++]; }
  /// The next number is finite, or this throws std::invalid_argument, saying what is there instead.
  double number();
  /// An arc's flag: a single 0 or 1.
  bool flag();
  /// A name such as "translate", up to something that is no letter.
  std::string_view name();

 private:
  void separator();
  std::string_view text_;
  std::size_t at_ = 0;
};

/// How many px of 1/96 inch a unit is (CSS Values 4 §6.2); nothing where it has no size of its own.
std::optional<double> px_of(std::string_view unit);

/// Path data: M L H V C S Q T A Z, absolute and relative.
std::vector<Subpath> parse_path(std::string_view data, const Affine& to);
std::vector<Subpath> polygon(std::string_view points, bool closed, const Affine& to);
std::vector<Subpath> ellipse(Point center, double rx, double ry, const Affine& to);
std::vector<Subpath> rectangle(Point corner, double width, double height, double rx, double ry,
                               const Affine& to);
/// A list of matrix, translate, scale, rotate, skewX, skewY, and what CSS has beside these, with its units.
Affine parse_transform(std::string_view text);

/// The largest length of a direction of length 1 after the map.
double stretch(const Affine& to);

/// The box around the curves; empty where there are none.
Bounds box_around(const std::vector<Subpath>& path);

struct Polyline {
  std::vector<Point> points;  ///< a closed one does not repeat its first point
  bool closed = false;
};
/// Chords that stay within `tolerance` of the curves, with their ends on them; points nearer to their
/// neighbour than a hundredth of the tolerance are left out: drawing programs close rings with their rounding
/// error. A ShapeError where a curve needs more than 10,000 chords.
std::vector<Polyline> flatten(const std::vector<Subpath>& path, double tolerance);

}  // namespace ductile::svg
