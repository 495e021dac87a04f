// Convex parts of an outline, as Box2D's fixtures want them.
#pragma once

#include <memory>
#include <vector>

#include "ductile/section.h"

namespace ductile {

/// Takes outlines apart into convex polygons; keeps its memory from one to the next.
class ConvexParts {
 public:
  explicit ConvexParts(int most_vertices);
  ~ConvexParts();

  /// Convex polygons of at most `most_vertices` vertices, counter-clockwise, that cover the outline without
  /// overlap and use no other vertices than its own. Takes rings that touch; of rings that cross by rounding
  /// it makes the best it can, and always ends.
  std::vector<Ring> of(const Outline& outline);

 private:
  struct Workspace;
  int most_vertices_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace ductile
