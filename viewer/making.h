// What a user draws becomes part of a scene: beams between nodes, lines, supports, loads. A node is a point
// where beams meet; there they are pinned to each other or welded. Knows neither window nor pointer.
#pragma once

#include <string>
#include <vector>

#include "beam.h"
#include "ductile/calibrate.h"
#include "ductile/plane.h"

namespace ductile::viewer {

/// What pulls or pushes along a line between two bodies.
struct LineStyle {
  enum class Kind { rope, strut, spring, winch, jack } kind = Kind::rope;
  double stiffness = 1e6;  ///< N/m, of a spring
  double force = 100e3;    ///< N: of a winch or a jack, at most
  double stroke = 0.5;     ///< m: by which a jack grows, or shortens where it is negative; a winch, too
  double speed = 0.1;      ///< m/s, of both
};

/// What pulls at a body.
struct LoadStyle {
  double force = 100e3;    ///< N
  double direction = -90;  ///< degrees from x, counter-clockwise
  double ramp = 0;         ///< s over which it grows
  Point vector() const;    ///< N
};

/// What a polygon is made of.
struct BlockStyle {
  bool fixed = true;  ///< it stands still: a bank, a pier, a wall
  Material material = materials::S355;
  double depth = 1;  ///< m, out of the plane
  double price = 0;  ///< of a kg; 0: not known
};

/// A floor, and nothing else.
SceneDef empty_scene();

/// Where something ends, is pinned, held or loaded.
std::vector<Point> nodes(const SceneDef& scene);
/// A name that no body has: of that stem with the next number.
std::string unused_name(const SceneDef& scene, std::string stem);

// Each of these gives the scene as it has become, and throws InvalidInput where that cannot be.

/// One beam more, which touches no other but is pinned to all that are at its ends, and to static bodies.
SceneDef with_beam(SceneDef scene, const Axis& axis, const BeamStyle& style);
/// A body more, of these corners in either sense, which touches no other; one that stands still holds the
/// beams whose ends are in it.
SceneDef with_block(SceneDef scene, const Ring& corners, const BlockStyle& style);
/// A line from the body at one point to that at another, free to turn at both.
SceneDef with_line(SceneDef scene, const Axis& axis, const LineStyle& style);
/// The moving body in the midst of a line is cut across it, instead of into equal pieces.
SceneDef with_cut(SceneDef scene, const Axis& across);
/// The body at a point is held there: first by a hinge, then by a roller that lets it slide along, then
/// clamped, then by springs of that stiffness, N/m, in x and y, then no more.
SceneDef with_next_support(SceneDef scene, Point at, double stiffness);
/// A force on the body at a point instead of the one that is there; none, or the same once more: no more.
SceneDef with_load(SceneDef scene, Point at, Point force, double ramp = 0);
/// The bodies of a node are welded, where they were pinned, or pinned again. Elsewhere two bodies that touch
/// at a point, at least one of which moves, are joined along their edges, or no more.
SceneDef with_weld_or_pin(SceneDef scene, Point at);
/// A beam is of another section or material.
SceneDef with_style(SceneDef scene, const std::string& beam, const BeamStyle& style);

/// Whether a beam or a line ends at a point.
bool is_end(const SceneDef& scene, Point at);
/// A node where something ends is elsewhere: the beams and lines that end there, what holds and what loads
/// them, and what hangs on those beams in between.
SceneDef with_node_moved(SceneDef scene, Point from, Point to);
/// Bodies are elsewhere, with all that hangs on them.
SceneDef with_bodies_moved(SceneDef scene, const std::vector<std::string>& names, Point by);

/// A body, and what held, loaded and joined it.
SceneDef without_body(SceneDef scene, const std::string& name);
/// The load at a point, or else the support, or else the line in whose midst it is, or else the body, or else
/// the line that ends there.
SceneDef without(SceneDef scene, Point at);

}  // namespace ductile::viewer
