#include "holes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ductile/plane.h"

namespace ductile::calibration {

Place between(const Place& a, const Place& b, double s) {
  const double share = b.s > a.s ? (s - a.s) / (b.s - a.s) : 0;
  return {s, a.at + share * (b.at - a.at), a.width + share * (b.width - a.width),
          a.area + share * (b.area - a.area), a.depth + share * (b.depth - a.depth)};
}

Place place_on(const std::vector<Place>& line, double s) {
  const auto after = std::lower_bound(line.begin() + 1, line.end() - 1, s,
                                      [](const Place& p, double value) { return p.s < value; });
  return between(*(after - 1), *after, s);
}

Holes::Holes(const Outline& outline) : holes_(outline.holes) {
  std::vector<Bounds> around;
  around.reserve(holes_.size());
  for (const Ring& hole : holes_) around.push_back(bounds_of(hole));
  std::size_t leaves = 1;
  while (leaves < holes_.size()) leaves *= 2;
  boxes_.resize(2 * leaves);
  order_.resize(holes_.size());
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) build(around, 1, order_);
}

std::vector<std::size_t> Holes::crossed_by(const Chord& chord) const {
  Bounds box;
  box.add(chord.left);
  box.add(chord.right);
  const double rounding = 1e-9 * (width(chord) + length(chord.left));
  std::vector<std::size_t> found, todo;
  if (!order_.empty()) todo.push_back(1);
  while (!todo.empty()) {
    const Box& at = boxes_[todo.back()];
    const std::size_t child = 2 * todo.back();
    todo.pop_back();
    if (!at.around.meets(box, rounding)) continue;
    if (at.holes.size() == 1)
      found.push_back(at.holes[0]);
    else
      todo.insert(todo.end(), {child, child + 1});
  }
  std::sort(found.begin(), found.end());
  return found;
}

void Holes::build(const std::vector<Bounds>& around, std::size_t at, std::span<std::size_t> holes) {
  Bounds all;
  for (const std::size_t hole : holes) {
    all.add(around[hole].low);
    all.add(around[hole].high);
  }
  boxes_[at] = {all, holes};
  if (holes.size() == 1) return;
  const bool wide = all.size().x > all.size().y;
  const auto place = [&](std::size_t hole) {
    return wide ? around[hole].middle().x : around[hole].middle().y;
  };
  const std::size_t half = holes.size() / 2;
  std::nth_element(holes.begin(), holes.begin() + static_cast<std::ptrdiff_t>(half), holes.end(),
                   [&](std::size_t i, std::size_t k) { return place(i) < place(k); });
  build(around, 2 * at, holes.first(half));
  build(around, 2 * at + 1, holes.subspan(half));
}

Place place_at(double s, const Chord& chord, const Holes& holes) {
  const double w = width(chord);
  Place place{s, middle(chord), w, w, w};
  if (holes.empty() || !(w > 0)) return place;
  // Even crossings with a hole's edges are pairs: between them there is nothing.
  const Point u = (1 / w) * (chord.right - chord.left);
  double moment = w * w / 2, second = w * w * w / 3;  // about the left end
  std::vector<double> crossings;
  for (const std::size_t index : holes.crossed_by(chord)) {
    const Ring& hole = holes[index];
    crossings.clear();
    for (std::size_t i = 0; i < hole.size(); ++i) {
      const Point p = hole[i] - chord.left, q = hole[(i + 1) % hole.size()] - chord.left;
      const double a = cross(u, p), b = cross(u, q);
      if ((a > 0) == (b > 0)) continue;
      crossings.push_back(std::clamp(dot(u, p) + a / (a - b) * dot(u, q - p), 0.0, w));
    }
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const double from = crossings[i], to = crossings[i + 1];
      place.area -= to - from;
      moment -= (to * to - from * from) / 2;
      second -= (to * to * to - from * from * from) / 3;
    }
  }
  const double inertia = place.area > 0 ? second - moment * moment / place.area : 0;
  place.depth = std::cbrt(std::max(0.0, 12 * inertia));
  return place;
}

}  // namespace ductile::calibration
