// What the fixtures of a body cover.
#pragma once

#include <vector>

#include "rube.h"

namespace ductile::rube {

/// The connected areas that a body's solid fixtures cover together, in its own coordinates, the largest
/// first; overlapping fixtures are united. Chains and edges are strips 0.025 m thick, what Box2D collides
/// with; circles are polygons within a thousandth of their radius. None where there are no solid fixtures.
std::vector<Outline> covered(const Body& body);

/// A disc as a polygon within a thousandth of its radius.
Ring disc(Point center, double radius);

}  // namespace ductile::rube
