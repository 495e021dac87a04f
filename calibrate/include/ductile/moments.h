// Area integrals of outlines: what a piece weighs, how it resists turning, and which way it is long.
#pragma once

#include "ductile/section.h"

namespace ductile {

struct AreaMoments {
  double area = 0;                ///< m²
  Point centroid;                 ///< m
  double xx = 0, yy = 0, xy = 0;  ///< m⁴, ∫ x² dA, ∫ y² dA, ∫ xy dA about the centroid
  double polar() const { return xx + yy; }
};

/// Of an outline, whatever the orientation of its rings; rounding grows with the outline's size, not with its
/// distance from the origin.
AreaMoments moments(const Outline& outline);

/// How far an outline reaches along its principal axis of greatest extent, from its centroid.
struct LongAxis {
  Point direction{1, 0};     ///< unit vector, x ≥ 0
  double low = 0, high = 0;  ///< m, ≤ 0 and ≥ 0
};

/// Of an outline and its moments.
LongAxis long_axis(const Outline& outline, const AreaMoments& moments);

}  // namespace ductile
