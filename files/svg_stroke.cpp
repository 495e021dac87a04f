#include "svg_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "ductile/turn.h"

namespace ductile::svg {
namespace {

Point turned(const Point& d, double angle) {
  const Turn turn = turn_of(angle);
  return turn.c * d + turn.s * left(d);
}

/// Draws the outline of one line. The rectangles over its segments all run counter-clockwise; strung together
/// through the points where they meet, their boundaries are the two sides of the stroke, so the winding
/// number of a point is the number of rectangles and wedges that cover it: never zero inside.
class Outliner {
 public:
  Outliner(const Pen& pen, double tolerance) : pen_(pen), half_(pen.width / 2) {
    // Sagitta of an arc over a step: half (1 − cos step/2).
    step_ = std::min(pi / 2, 4 * std::asin(std::sqrt(std::min(tolerance / (2 * half_), 1.))));
  }

  void draw(const Polyline& line) {
    const auto& points = line.points;
    if (points.size() == 1) return dot_at(points[0]);
    if (line.closed && points.size() > 2) {
      rings.push_back(side(points, true));
      rings.push_back(side({points.rbegin(), points.rend()}, true));
      return;
    }
    const std::vector<Point> back(points.rbegin(), points.rend());
    Ring ring = side(points, false);
    const Ring other = side(back, false);
    cap(ring, points.back(), unit(points.back() - points[points.size() - 2]));
    ring.insert(ring.end(), other.begin(), other.end());
    cap(ring, points.front(), unit(points[0] - points[1]));
    rings.push_back(std::move(ring));
  }

  std::vector<Ring> rings;

 private:
  static Point unit(const Point& d) { return 1 / length(d) * d; }

  /// What is to the right of the line, from its first point to its last.
  Ring side(const std::vector<Point>& points, bool closed) const {
    Ring ring;
    const std::size_t n = points.size(), segments = closed ? n : n - 1;
    const auto direction = [&](std::size_t i) { return points[(i + 1) % n] - points[i % n]; };
    for (std::size_t i = 0; i < segments; ++i) {
      const Point d = direction(i), right = -1 * left(unit(d));
      const Point& end = points[(i + 1) % n];
      if (i == 0 && !closed) ring.push_back(points[0] + half_ * right);
      if (i + 1 < segments || closed) {
        corner(ring, end, d, direction((i + 1) % n));
      } else {
        ring.push_back(end + half_ * right);
      }
    }
    return ring;
  }

  /// The right side's corner at p from direction d to e.
  void corner(Ring& ring, const Point& p, const Point& d, const Point& e) const {
    const Point u = unit(d), v = unit(e), m = -1 * left(u), n = -1 * left(v);
    const double sine = cross(u, v), cosine = dot(u, v);
    const Point from = p + half_ * m, to = p + half_ * n;
    const double reach = half_ * std::abs(sine) / (1 + cosine);  // half tan θ/2
    const Point tip = p + half_ / (1 + cosine) * (m + n);
    if (sine < 0 || (sine == 0 && cosine > 0)) {  // turns right: this is the inside
      if (2 * reach <= std::min(length(d), length(e))) {
        ring.push_back(tip);
      } else {
        ring.insert(ring.end(), {from, p, to});
      }
      return;
    }
    ring.push_back(from);
    // A mitre is 1/cos θ/2 half widths long, so its square is 2/(1 + cos θ).
    if (pen_.join == Pen::miter && 2 <= (1 + cosine) * pen_.miter_limit * pen_.miter_limit) {
      ring.push_back(tip);
    } else if (pen_.join == Pen::round_join) {
      fan(ring, p, m, angle_of(cosine, sine));
    }
    ring.push_back(to);
  }

  /// The arc around `center` from direction n counter-clockwise over `angle`, without its ends.
  void fan(Ring& ring, const Point& center, const Point& n, double angle) const {
    if (angle < 0) angle += 2 * pi;  // −π: a turn on the spot
    const int steps = static_cast<int>(std::ceil(angle / step_));
    for (int i = 1; i < steps; ++i) ring.push_back(center + half_ * turned(n, angle * i / steps));
  }

  /// From the right of the line's end to its left; d is the way on.
  void cap(Ring& ring, const Point& p, const Point& d) const {
    const Point right = -1 * left(d);
    if (pen_.cap == Pen::round_cap) fan(ring, p, right, pi);
    if (pen_.cap == Pen::square) {
      ring.push_back(p + half_ * (right + d));
      ring.push_back(p + half_ * (d - right));
    }
  }

  /// A line of no length has the shape of its caps, along x.
  void dot_at(const Point& p) {
    if (pen_.cap == Pen::butt) return;
    Ring ring;
    for (const Point& d : {Point{1, 0}, Point{-1, 0}}) {
      ring.push_back(p + half_ * (-1 * left(d)));
      cap(ring, p, d);
    }
    rings.push_back(std::move(ring));
  }

  const Pen& pen_;
  double half_, step_;
};

/// The line's dashes, each an open line.
void cut(const Polyline& line, const Pen& pen, std::vector<Polyline>& out) {
  std::vector<double> lengths = pen.dashes;
  if (lengths.size() % 2 == 1) lengths.insert(lengths.end(), pen.dashes.begin(), pen.dashes.end());
  const double period = std::accumulate(lengths.begin(), lengths.end(), 0.);
  if (!(period > 0)) return out.push_back(line);
  double offset = std::fmod(pen.dash_offset, period);
  if (offset < 0) offset += period;
  std::size_t at = 0;
  while (offset > 0 && offset >= lengths[at]) {  // a dash of no length at the start is one, too
    offset -= lengths[at];
    at = (at + 1) % lengths.size();
  }
  double left = lengths[at] - offset;
  constexpr std::size_t most = 10'000;
  const auto begin = [&](const Point& p) {
    if (at % 2 == 0) out.push_back({{p}, false});
    if (out.size() > most) {
      throw ShapeError("stroke-dasharray", "makes more than 10000 dashes", "make the dashes longer");
    }
  };
  begin(line.points[0]);
  const std::size_t n = line.points.size();
  for (std::size_t i = 0; i + (line.closed ? 0 : 1) < n; ++i) {
    const Point a = line.points[i], b = line.points[(i + 1) % n];
    const double whole = length(b - a);
    double done = 0;
    while (whole - done > left) {
      done += left;
      const Point p = a + done / whole * (b - a);
      if (at % 2 == 0) out.back().points.push_back(p);
      at = (at + 1) % lengths.size();
      left = lengths[at];
      begin(p);
    }
    left -= whole - done;
    if (at % 2 == 0) out.back().points.push_back(b);
  }
}

}  // namespace

std::vector<Ring> stroke(const std::vector<Polyline>& lines, const Pen& pen, double tolerance) {
  std::vector<Polyline> dashes;
  for (const Polyline& line : lines) {
    if (pen.dashes.empty() || line.points.size() < 2) {
      dashes.push_back(line);
    } else {
      cut(line, pen, dashes);
    }
  }
  Outliner outliner(pen, tolerance);
  for (Polyline& line : dashes) {
    const auto same = [](const Point& p, const Point& q) { return p.x == q.x && p.y == q.y; };
    line.points.erase(std::unique(line.points.begin(), line.points.end(), same), line.points.end());
    outliner.draw(line);
  }
  return std::move(outliner.rings);
}

}  // namespace ductile::svg
