// Beams of a scene, and what a user points at: which body is at a point. Knows neither window nor pointer.
#pragma once

#include <optional>
#include <string>

#include "ductile/calibrate.h"
#include "ductile/plane.h"

namespace ductile::viewer {

/// Where beams begin and end, m: closer points are one node.
constexpr double node_size = 1e-6;
inline bool is_same(Point a, Point b) { return length(a - b) < node_size; }

/// A straight line, as of the middles of a bar's ends, m.
struct Axis {
  Point from, to;
  double length() const { return ductile::length(to - from); }
  /// The point of it that is nearest to another.
  Point nearest(Point p) const;
  double distance(Point p) const { return ductile::distance(p, from, to); }
  bool ends_at(Point p) const { return is_same(from, p) || is_same(to, p); }
};

/// What a beam is made of: a rectangle, or a profile of rolled.h.
struct BeamStyle {
  Material material = materials::S355;
  double height = 0.2, depth = 0.1;  ///< m, of a rectangle, in the plane and out of it
  std::string profile;               ///< the name of a profile instead; empty: a rectangle
  int pieces = 6;
  bool solid = true;  ///< false: everything passes it, as what runs on a bridge passes its truss
  double price = 0;   ///< of a kg; 0: not known
};

/// The axis of a body that is a beam, a rectangle that begins at its own origin; nothing of another.
std::optional<Axis> axis_of(const BodyDef& body);
BeamStyle style_of(const BodyDef& beam);
/// Lays a beam of that style along an axis. Throws InvalidInput where it would be no longer than it is high,
/// or where there is no such profile.
void lay(BodyDef& beam, const Axis& axis, const BeamStyle& style);
/// Lays it elsewhere as it is.
void lay(BodyDef& beam, const Axis& axis);

bool ends_at(const BodyDef& body, Point at);
/// Whether a point is on the axis of a beam.
bool passes(const BodyDef& body, Point at);
/// Whether a body as placed covers a point or has it on its edge.
bool covers(const BodyDef& body, Point at);

/// The body at a point: a beam that ends there, else one that passes, else the last that covers it, of those
/// that move before those that do not. Null where there is none.
const BodyDef* body_at(const SceneDef& scene, Point at);
const BodyDef* body_named(const SceneDef& scene, const std::string& name);

}  // namespace ductile::viewer
