#include "pick.h"

#include <algorithm>
#include <cmath>

#include "ductile/colours.h"

namespace ductile::viewer {
namespace {

/// Of a point as it was at t = 0.
bool covers(const Piece& piece, Point p) {
  return piece.circle > 0 ? length(p - piece.center) <= piece.circle : contains(piece.outline, p);
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

std::vector<std::size_t> joints_in(const Plan& plan, const Frame& frame, const Bounds& box) {
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
    const PieceReading& now = frame.pieces[i];
    if (covers(plan.pieces[i], plan.pieces[i].center + Rotation(now.angle).inverse(at - now.position)))
      return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> thrown_at(const Timeline& run, Point at) {
  const std::vector<act::Throw> thrown = run.thrown();
  for (std::size_t i = run.frame().thrown.size(); i-- > 0;) {
    const Pose& pose = run.frame().thrown[i];
    const Point p = Rotation(pose.angle).inverse(at - pose.position);
    const double half = thrown[i].size / 2;
    if (thrown[i].square ? std::max(std::abs(p.x), std::abs(p.y) / thrown[i].flat) <= half
                         : length(p) <= half)
      return i;
  }
  return std::nullopt;
}

Bounds extent(const Plan& plan) {
  Bounds moving, all;
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
