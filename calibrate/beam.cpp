#include "beam.h"

#include <algorithm>
#include <cmath>

#include "ductile/plane.h"

namespace ductile::calibration {

Beam::Beam(const std::vector<Place>& line, double a, double b, std::size_t n, bool straight)
    : weight(n + 1), first(n + 1) {
  const double ds = std::abs(b - a) / static_cast<double>(n);
  parts.reserve(n);
  std::size_t after = 1;  // of the line's places
  for (std::size_t i = 0; i < n; ++i) {
    const double s = std::min(a, b) + (static_cast<double>(i) + 0.5) * ds;
    while (after + 1 < line.size() && line[after].s < s) ++after;
    Place p = between(line[after - 1], line[after], s);
    p.s = std::abs(s - a);
    if (straight) p.at = {p.s, 0};
    parts.push_back({p, ds});
  }
  if (b < a) std::reverse(parts.begin(), parts.end());
  for (std::size_t i = n; i-- > 0;) {
    const double w = parts[i].place.area * ds;
    weight[i] = weight[i + 1] + w;
    first[i] = first[i + 1] + w * parts[i].place.at;
  }
}

Point Beam::moments(const Place& p) const {
  const double x = std::clamp(p.s / parts.front().length, 0.0, static_cast<double>(parts.size()));
  const std::size_t i = std::min(static_cast<std::size_t>(x), parts.size() - 1);
  const double share = x - static_cast<double>(i);
  const double w = weight[i] + share * (weight[i + 1] - weight[i]);
  return left(first[i] + share * (first[i + 1] - first[i]) - w * p.at);
}

namespace {

double compliance(const Hinge& h) {  // but for the material's E and the depth
  const double d = h.place.depth;
  return d > 0 ? h.length / (d * d * d) : 0;
}

}  // namespace

std::vector<Displacement> cantilever(const Beam& beam, const std::vector<Hinge>& hinges) {
  std::vector<Displacement> result(beam.parts.size());
  Point turn{};  // Σ θ, under weight along x and along y
  Displacement moment{};
  auto hinge = hinges.begin();
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Place& part = beam.parts[i].place;
    for (; hinge != hinges.end() && hinge->place.s <= part.s; ++hinge) {
      const Point rotation = compliance(*hinge) * beam.moments(hinge->place);
      turn = turn + rotation;
      moment = {moment.x + rotation.x * hinge->place.at, moment.y + rotation.y * hinge->place.at};
    }
    result[i] = {turn.x * part.at - moment.x, turn.y * part.at - moment.y};
  }
  return result;
}

std::vector<Displacement> held_at_both_ends(const Beam& beam, const std::vector<Hinge>& hinges,
                                            bool clamped) {
  // M = M_cantilever + X1 + X2 (extent − s), with ∫ κ ds = 0 and ∫ κ s ds = 0, or with no moment at the ends.
  const double extent = beam.extent();
  double a = 0, b = 0, c = 0, p = 0, q = 0;
  std::vector<double> moments, rotations;
  for (const Hinge& h : hinges) {
    const double k = compliance(h), x = extent - h.place.s, m = beam.moments(h.place).y;
    moments.push_back(m);
    a += k, b += k * x, c += k * x * x;
    p -= k * m, q -= k * x * m;
  }
  double x1 = 0, x2 = -beam.moments({}).y / extent;
  if (const double det = a * c - b * b; clamped && det > 0) {
    x1 = (p * c - q * b) / det;
    x2 = (a * q - b * p) / det;
  }
  double end = 0;  // of a beam that is clamped at its start only
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const double x = extent - hinges[i].place.s;
    rotations.push_back(compliance(hinges[i]) * (moments[i] + x1 + x2 * x));
    end += rotations[i] * x;
  }
  const double turned = clamped ? 0 : end / extent;  // so that the far end stays
  std::vector<Displacement> result(beam.parts.size());
  double turn = 0, moment = 0;
  for (std::size_t i = 0, hinge = 0; i < result.size(); ++i) {
    const double s = beam.parts[i].place.s;
    for (; hinge < hinges.size() && hinges[hinge].place.s <= s; ++hinge) {
      turn += rotations[hinge];
      moment += rotations[hinge] * hinges[hinge].place.s;
    }
    result[i].y.x = (turn - turned) * s - moment;
  }
  return result;
}

Deviation compare(const std::vector<Displacement>& beam, const std::vector<Displacement>& chain) {
  Deviation x, y;
  for (std::size_t i = 0; i < beam.size(); ++i) {
    const Point dx = beam[i].x - chain[i].x, dy = beam[i].y - chain[i].y;
    x = {std::max(x.most, dot(beam[i].x, beam[i].x)), std::max(x.error, dot(dx, dx))};
    y = {std::max(y.most, dot(beam[i].y, beam[i].y)), std::max(y.error, dot(dy, dy))};
  }
  for (Deviation* d : {&x, &y}) *d = {std::sqrt(d->most), std::sqrt(d->error)};
  return y.most > 5 * x.most || (y.most > x.most / 5 && y.error * x.most > x.error * y.most) ? y : x;
}

}  // namespace ductile::calibration
