// Area integrals of outlines: what a piece weighs and how it resists turning.
#pragma once

#include "ductile/section.h"

namespace ductile {

struct Moments {
  double area = 0;   ///< m²
  Point centroid;    ///< m
  double polar = 0;  ///< m⁴, ∫ r² dA about the centroid
};

/// Of an outline, whatever the orientation of its rings; rounding grows with the outline's size, not with its
/// distance from the origin.
Moments moments(const Outline& outline);

/// Doubled signed area of a ring, positive counter-clockwise.
double doubled_area(const Ring& ring);

}  // namespace ductile
