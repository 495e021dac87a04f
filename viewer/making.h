// What a user draws becomes part of a scene: beams between nodes, supports, loads. A node is a point where
// beams meet; there they are pinned to each other. Knows neither window nor pointer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ductile/calibrate.h"
#include "geometry.h"

namespace ductile::viewer {

/// Where beams begin and end, m: closer points are one node.
constexpr double node_size = 1e-6;

/// A straight bar of rectangular section, from the middle of one end to that of the other, m.
struct Axis {
  Point from, to;
};
struct BeamStyle {
  Material material = materials::S355;
  double height = 0.2, depth = 0.1;  ///< m, in the plane and out of it
  int pieces = 6;
};

/// A floor, and nothing else.
SceneDef empty_scene();

/// The axis of a body that is a beam as with_beam() makes it; nothing of another.
std::optional<Axis> axis_of(const BodyDef& body);

/// Where something ends, is pinned, held or loaded.
std::vector<Point> nodes(const SceneDef& scene);

// Each of these gives the scene as it has become, and throws InvalidInput where that cannot be.

/// One beam more, which touches no other but is pinned to all that are at its ends, and to static bodies.
SceneDef with_beam(SceneDef scene, const Axis& axis, const BeamStyle& style);
/// The beam at a point is held there: first by a hinge, then by a roller that lets it slide along, then
/// clamped, then no more.
SceneDef with_next_support(SceneDef scene, Point at);
/// A force on the beam at a point instead of the one that is there; none: no more.
SceneDef with_load(SceneDef scene, Point at, Point force);
/// A node is elsewhere: the beams that end there, what holds and what loads them.
SceneDef with_node_moved(SceneDef scene, Point from, Point to);
/// A body, and what held, loaded and joined it.
SceneDef without_body(SceneDef scene, const std::string& name);
/// The load at a point, or else the support, or else the beam.
SceneDef without(SceneDef scene, Point at);

}  // namespace ductile::viewer
