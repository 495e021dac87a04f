#include "pick.h"

#include <algorithm>

#include "ductile/colours.h"

namespace ductile::viewer {
namespace {

bool inside(const Convex& polygon, Point p) {  // counter-clockwise
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (cross(b - a, p - a) < 0) return false;
  }
  return true;
}

bool covers(const Piece& piece, Point local) {
  if (piece.circle > 0) return length(local) <= piece.circle;
  return std::any_of(piece.fixtures.begin(), piece.fixtures.end(),
                     [&](const Convex& convex) { return inside(convex, local); });
}

}  // namespace

std::optional<std::size_t> joint_at(const Plan& plan, const Frame& frame, Point at, double reach) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const double distance = length(place(plan, i, frame).anchor - at);
    if (distance <= reach) {
      reach = distance;
      best = i;
    }
  }
  return best;
}

std::vector<std::size_t> joints_in(const Plan& plan, const Frame& frame, const Box& box) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    if (box.contains(place(plan, i, frame).anchor)) found.push_back(i);
  }
  return found;
}

std::vector<std::size_t> joints_from(const Frame& frame, double least) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < frame.joints.size(); ++i) {
    if (stage(frame.joints[i]) >= least) found.push_back(i);
  }
  return found;
}

std::optional<std::size_t> piece_at(const Plan& plan, const Frame& frame, Point at) {
  for (std::size_t i = plan.pieces.size(); i-- > 0;) {
    if (covers(plan.pieces[i], Turn(frame.pieces[i].angle).back(at - frame.pieces[i].position))) return i;
  }
  return std::nullopt;
}

Box extent(const Plan& plan) {
  Box moving, all;
  for (const Piece& piece : plan.pieces) {
    const bool moves = plan.bodies[static_cast<std::size_t>(piece.body)].type == BodyType::dynamic_body;
    const auto add = [&](Point p) {
      all.add(p);
      if (moves) moving.add(p);
    };
    for (const Point& p : piece.outline.outer) add(p);
    if (piece.circle > 0) {
      const Point radius{piece.circle, piece.circle};
      add(piece.center + radius);
      add(piece.center - radius);
    }
  }
  if (all.empty()) return {{-1, -1}, {1, 1}};
  return moving.empty() ? all : moving;
}

}  // namespace ductile::viewer
