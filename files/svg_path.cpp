#include "svg_path.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ductile/turn.h"

namespace ductile::svg {
namespace {

constexpr double degree = pi / 180;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_letter(char c) { return is_lower(c) || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Draws subpaths in local coordinates, and keeps them as `to` shows them.
class Tracer {
 public:
  explicit Tracer(const Affine& to) : to_(to) {}

  std::vector<Subpath> path;
  Point here;  ///< local

  void move(const Point& p) {
    start_ = here = p;
    begin();
  }
  void line(const Point& p) { add(Line{to_(p)}, p); }
  void cubic(const Point& c1, const Point& c2, const Point& p) { add(Cubic{to_(c1), to_(c2), to_(p)}, p); }
  void quadratic(const Point& c, const Point& p) {
    cubic(here + 2. / 3 * (c - here), p + 2. / 3 * (c - p), p);
  }
  /// From `here` at the angle `from` on the ellipse center + u cos t + v sin t.
  void arc(const Point& center, const Point& u, const Point& v, double from, double sweep, const Point& p) {
    add(Arc{to_(center), to_.turn(u), to_.turn(v), from, sweep, to_(p)}, p);
  }
  /// SVG 1.1, F.6.5: from end points to centre.
  void arc_to(double rx, double ry, double rotation, bool large, bool positive, const Point& p);
  void close() {
    if (!path.empty()) path.back().closed = true;
    here = start_;
    open_ = false;
  }

 private:
  void begin() {
    path.push_back({to_(start_), {}, false});
    open_ = true;
  }
  void add(const Curve& curve, const Point& end) {
    if (!open_) begin();  // after a Z, drawing goes on from the start of what was closed
    path.back().curves.push_back(curve);
    here = end;
  }

  Affine to_;
  Point start_;
  bool open_ = false;
};

void Tracer::arc_to(double rx, double ry, double rotation, bool large, bool positive, const Point& p) {
  rx = std::abs(rx);
  ry = std::abs(ry);
  if (p == here) return;
  if (rx == 0 || ry == 0) return line(p);
  const Turn turn = turn_of(rotation);
  const Point ex{turn.c, turn.s}, ey{-ex.y, ex.x};
  const Point half = 0.5 * (here - p);
  // In the frame in which the ellipse is the unit circle:
  Point q{(half.x * ex.x + half.y * ex.y) / rx, (half.x * ey.x + half.y * ey.y) / ry};
  const double reach = length(q);
  if (reach > 1) {  // too small to reach: grown until it does
    rx *= reach;
    ry *= reach;
    q = 1 / reach * q;
  }
  const double square = std::min(reach * reach, 1.0);
  const double offset = (large == positive ? -1 : 1) * std::sqrt((1 - square) / square);
  const Point c{offset * q.y, -offset * q.x};
  const double from = angle_of(q.x - c.x, q.y - c.y);
  double sweep = angle_of(-q.x - c.x, -q.y - c.y) - from;
  if (positive && sweep < 0) sweep += 2 * pi;
  if (!positive && sweep > 0) sweep -= 2 * pi;
  const Point u = rx * ex, v = ry * ey;
  arc(0.5 * (here + p) + c.x * u + c.y * v, u, v, from, sweep, p);
}

}  // namespace

Affine operator*(const Affine& o, const Affine& i) {
  const Point x = o.turn({i.a, i.b}), y = o.turn({i.c, i.d}), shift = o({i.e, i.f});
  return {x.x, x.y, y.x, y.y, shift.x, shift.y};
}

// ---- numbers

bool Numbers::end() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  return at_ == text_.size();
}

void Numbers::separator() {
  if (peek() == ',') {
    take();
    end();
  }
}

double Numbers::number() {
  const char first = peek();
  std::size_t digits = at_;
  if (first == '+' || first == '-') ++digits;
  const bool starts = digits < text_.size() &&
                      (is_digit(text_[digits]) ||
                       (text_[digits] == '.' && digits + 1 < text_.size() && is_digit(text_[digits + 1])));
  if (!starts) {
    throw std::invalid_argument(first == 0 ? "ends where a number should stand"
                                           : std::string("has '") + first + "' where a number should stand");
  }
  double value = 0;
  const char* const from = text_.data() + at_ + (first == '+' ? 1 : 0);  // from_chars knows no plus
  const auto [rest, error] = std::from_chars(from, text_.data() + text_.size(), value);
  if (error != std::errc{}) throw std::invalid_argument("has a number that a double does not hold");
  at_ = static_cast<std::size_t>(rest - text_.data());
  separator();
  return value;
}

bool Numbers::flag() {
  const char c = peek();
  if (c != '0' && c != '1') throw std::invalid_argument("has no 0 or 1 where an arc's flag should stand");
  take();
  separator();
  return c == '1';
}

std::string_view Numbers::name() {
  end();
  const std::size_t from = at_;
  while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
  return text_.substr(from, at_ - from);
}

// ---- shapes

std::vector<Subpath> parse_path(std::string_view data, const Affine& to) {
  Tracer tracer(to);
  Numbers in(data);
  char command = 0, before = 0;  // `before` is the last curve's letter, in upper case
  Point control;                 // of the last curve, for S and T
  int count = 0;
  try {
    while (!in.end()) {
      if (is_letter(in.peek())) {
        command = in.take();
        ++count;
        if (count == 1 && command != 'M' && command != 'm')
          throw std::invalid_argument("does not start with M");
      } else if (command == 'Z' || command == 'z' || command == 0) {
        throw std::invalid_argument(std::string("has '") + in.peek() + "' where a command should stand");
      }
      const bool relative = is_lower(command);
      const Point base = relative ? tracer.here : Point{};
      const auto point = [&] {
        const double x = in.number();
        return base + Point{x, in.number()};
      };
      const char letter = static_cast<char>(relative ? command - 'a' + 'A' : command);
      switch (letter) {
        case 'M':
          tracer.move(point());
          command = relative ? 'l' : 'L';  // further pairs are lines
          break;
        case 'L':
          tracer.line(point());
          break;
        case 'H':
          tracer.line({base.x + in.number(), tracer.here.y});
          break;
        case 'V':
          tracer.line({tracer.here.x, base.y + in.number()});
          break;
        case 'C': {
          const Point first = point();
          control = point();
          tracer.cubic(first, control, point());
          break;
        }
        case 'S': {
          const Point first = before == 'C' || before == 'S' ? 2 * tracer.here - control : tracer.here;
          control = point();
          tracer.cubic(first, control, point());
          break;
        }
        case 'Q':
          control = point();
          tracer.quadratic(control, point());
          break;
        case 'T':
          control = before == 'Q' || before == 'T' ? 2 * tracer.here - control : tracer.here;
          tracer.quadratic(control, point());
          break;
        case 'A': {
          const double rx = in.number(), ry = in.number(), rotation = in.number() * degree;
          const bool large = in.flag(), positive = in.flag();
          tracer.arc_to(rx, ry, rotation, large, positive, point());
          break;
        }
        case 'Z':
          tracer.close();
          break;
        default:
          throw std::invalid_argument(std::string("has '") + command + "', which is no path command");
      }
      before = letter;
    }
  } catch (const std::invalid_argument& error) {
    throw ShapeError(count == 0 ? "path data" : "path command " + std::to_string(count), error.what(),
                     "write path data as SVG 1.1 §8.3 has it");
  }
  return std::move(tracer.path);
}

std::vector<Subpath> polygon(std::string_view points, bool closed, const Affine& to) {
  Tracer tracer(to);
  Numbers in(points);
  int count = 0;
  try {
    while (!in.end()) {
      const double x = in.number();
      const Point p{x, in.number()};
      count == 0 ? tracer.move(p) : tracer.line(p);
      ++count;
    }
  } catch (const std::invalid_argument& error) {
    throw ShapeError("point " + std::to_string(count), error.what(), "write x,y x,y ...");
  }
  if (closed) tracer.close();
  return std::move(tracer.path);
}

std::vector<Subpath> ellipse(Point center, double rx, double ry, const Affine& to) {
  Tracer tracer(to);
  const Point right = center + Point{rx, 0}, left = center - Point{rx, 0};
  tracer.move(right);
  tracer.arc(center, {rx, 0}, {0, ry}, 0, pi, left);
  tracer.arc(center, {rx, 0}, {0, ry}, pi, pi, right);
  tracer.close();
  return std::move(tracer.path);
}

std::vector<Subpath> rectangle(Point corner, double width, double height, double rx, double ry,
                               const Affine& to) {
  Tracer tracer(to);
  rx = std::min(rx, width / 2);
  ry = std::min(ry, height / 2);
  if (rx == 0 || ry == 0) rx = ry = 0;
  const Point far = corner + Point{width, height}, x{rx, 0}, y{0, ry};
  const auto round = [&](double turn, const Point& center, const Point& end) {
    if (rx > 0) tracer.arc(center, x, y, turn * pi / 2, pi / 2, end);
  };
  tracer.move({corner.x + rx, corner.y});
  tracer.line({far.x - rx, corner.y});
  round(3, {far.x - rx, corner.y + ry}, {far.x, corner.y + ry});
  tracer.line({far.x, far.y - ry});
  round(0, {far.x - rx, far.y - ry}, {far.x - rx, far.y});
  tracer.line({corner.x + rx, far.y});
  round(1, {corner.x + rx, far.y - ry}, {corner.x, far.y - ry});
  tracer.line({corner.x, corner.y + ry});
  round(2, {corner.x + rx, corner.y + ry}, {corner.x + rx, corner.y});
  tracer.close();
  return std::move(tracer.path);
}

std::optional<double> px_of(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 7> units{{{"px", 1},
                                                                             {"in", 96},
                                                                             {"cm", 96 / 2.54},
                                                                             {"mm", 96 / 25.4},
                                                                             {"Q", 96 / 101.6},
                                                                             {"pt", 96. / 72},
                                                                             {"pc", 16}}};
  for (const auto& [name, px] : units)
    if (name == unit) return px;
  return std::nullopt;
}

namespace {

/// What a number with this unit means as the attribute's plain one: px, or degrees (CSS Values 4 §7.1).
double unit_in_transform(std::string_view unit) {
  if (unit.empty() || unit == "deg") return 1;
  if (unit == "grad") return 0.9;
  if (unit == "rad") return 1 / degree;
  if (unit == "turn") return 360;
  if (const auto px = px_of(unit)) return *px;
  throw std::invalid_argument("has the unit \"" + std::string(unit) + "\"");
}

}  // namespace

Affine parse_transform(std::string_view text) {
  Affine all;
  Numbers in(text);
  const auto refuse = [](const std::string& what) {
    throw ShapeError("transform", what,
                     "write matrix, translate, scale, rotate, skewX or skewY as SVG 1.1 §7.6 has it");
  };
  try {
    while (!in.end()) {
      const std::string_view name = in.name();
      std::vector<double> n;
      if (in.peek() != '(') refuse("has no name with '(' where one should stand");
      for (in.take(); in.peek() != ')' && n.size() <= 6;) {
        n.push_back(in.number());
        n.back() *= unit_in_transform(in.name());
        if (in.peek() == ',') in.take();
      }
      if (in.peek() == ')') in.take();
      if (in.peek() == ',') in.take();
      const auto has = [&](std::size_t least, std::size_t most) {
        return n.size() == least || n.size() == most;
      };
      if (name == "matrix" && has(6, 6)) {
        all = all * Affine{n[0], n[1], n[2], n[3], n[4], n[5]};
      } else if (name == "translate" && has(1, 2)) {
        all = all * Affine{1, 0, 0, 1, n[0], n.size() == 2 ? n[1] : 0};
      } else if (name == "translateX" && has(1, 1)) {  // CSS has four more
        all = all * Affine{1, 0, 0, 1, n[0], 0};
      } else if (name == "translateY" && has(1, 1)) {
        all = all * Affine{1, 0, 0, 1, 0, n[0]};
      } else if (name == "scaleX" && has(1, 1)) {
        all = all * Affine{n[0], 0, 0, 1, 0, 0};
      } else if (name == "scaleY" && has(1, 1)) {
        all = all * Affine{1, 0, 0, n[0], 0, 0};
      } else if (name == "scale" && has(1, 2)) {
        all = all * Affine{n[0], 0, 0, n.back(), 0, 0};
      } else if (name == "rotate" && has(1, 3)) {
        const auto [c, s] = turn_of(n[0] * degree);
        const Point about = n.size() == 3 ? Point{n[1], n[2]} : Point{};
        all = all * Affine{1, 0, 0, 1, about.x, about.y} * Affine{c, s, -s, c, 0, 0} *
              Affine{1, 0, 0, 1, -about.x, -about.y};
      } else if (name == "skewX" && has(1, 1)) {
        all = all * Affine{1, 0, std::tan(n[0] * degree), 1, 0, 0};
      } else if (name == "skewY" && has(1, 1)) {
        all = all * Affine{1, std::tan(n[0] * degree), 0, 1, 0, 0};
      } else {
        refuse("has " + std::string(name) + " with " + std::to_string(n.size()) + " numbers");
      }
    }
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  return all;
}

}  // namespace ductile::svg
