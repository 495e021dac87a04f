#include "crossing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ductile::viewer {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();

const BodyDef& body_of(const Plan& plan, const Piece& piece) {
  return plan.bodies[static_cast<std::size_t>(piece.body)];
}

/// The highest point of a piece as drawn between two x; minus infinity where it has none.
double top(const Piece& piece, double from, double to) {
  double y = nothing;
  if (piece.circle > 0) {
    const double x = std::clamp(piece.center.x, from, to) - piece.center.x;
    return std::abs(x) < piece.circle ? piece.center.y + std::sqrt(piece.circle * piece.circle - x * x) : y;
  }
  const Ring& ring = piece.outline.outer;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    Point a = ring[i], b = ring[(i + 1) % ring.size()];
    if (a.x > b.x) std::swap(a, b);
    if (b.x < from || a.x > to) continue;
    if (a.x == b.x) {
      y = std::max({y, a.y, b.y});
      continue;
    }
    for (const double x : {std::max(a.x, from), std::min(b.x, to)})
      y = std::max(y, a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
  }
  return y;
}

}  // namespace

bool send_across(Workbench& bench, double mass, double size, double speed) {
  bench.restart();
  const Plan& plan = bench.plan();
  Bounds road;
  for (const Piece& piece : plan.pieces) {
    const BodyDef& body = body_of(plan, piece);
    if (body.type == BodyType::dynamic_body && body.collides)
      for (const Point p : piece.outline.outer) road.add(p);
  }
  const double half = 0.75 * size;  // with its wheels
  if (road.empty() || road.size().x < 2 * half) {
    bench.message = "Nothing here is long enough to drive across; a smaller vehicle may.";
    return false;
  }
  act::Vehicle sent{.mass = mass, .size = size, .speed = speed};
  sent.at.x = road.low.x + half;
  sent.to = road.high.x - half;
  sent.lowest = road.low.y;
  sent.at.y = nothing;
  for (const Piece& piece : plan.pieces) {
    if (body_of(plan, piece).collides)
      sent.at.y = std::max(sent.at.y, top(piece, road.low.x, road.low.x + 2 * half));
  }
  sent.at.y += 0.01 * size;
  bench.act(sent);
  bench.playing = true;
  return true;
}

std::string crossing_text(const Frame& frame) {
  if (!frame.crossing) return "";
  if (frame.crossing->state == Crossing::State::across) return "the vehicle is across";
  if (frame.crossing->state == Crossing::State::down) return "the vehicle is down";
  return fmt::format("the vehicle is {:.0f} % of its way", std::floor(100 * frame.crossing->share));
}

}  // namespace ductile::viewer
