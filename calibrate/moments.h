// Area integrals of outlines: what a piece weighs and how it resists turning.
#pragma once

#include "ductile/section.h"

namespace ductile::calibration {

struct AreaMoments {
  double area = 0;                ///< m²
  Point centroid;                 ///< m
  double xx = 0, yy = 0, xy = 0;  ///< m⁴, ∫ x² dA, ∫ y² dA, ∫ xy dA about the centroid
  double polar() const { return xx + yy; }
};

/// Of an outline, whatever the orientation of its rings; rounding grows with the outline's size, not with its
/// distance from the origin.
AreaMoments moments(const Outline& outline);

}  // namespace ductile::calibration
