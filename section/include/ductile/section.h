// What a cross-section can carry: plastic and elastic capacities of arbitrary polygon sections.
//
// Equations 1–3 of "Breakable Elastic-plastic Constraint for Rigid Body Simulation": with s the coordinate
// along the bending direction d and s_pna the plastic neutral axis,
//   N = ∫ f_t dA,  N_c = ∫ f_c dA   (Eq 1)      Q = ∫ τ_y dA   (Eq 2)      M = ∫ |s − s_pna| f dA   (Eq 3)
// SI units; a section lies in its own x–y plane.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ductile/material.h"
#include "ductile/problem.h"

namespace ductile {

/// A point or direction in the plane, m.
struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

/// A closed polygon. Orientation is free; a last point equal to the first is accepted; collinear points are
/// legal.
using Ring = std::vector<Point>;

/// m²: twice the area that a ring encloses, positive counter-clockwise. Rounding grows with the ring's size,
/// not with its distance from the origin.
double doubled_area(const Ring& ring);

/// A simple polygon with holes.
struct Outline {
  Ring outer{};
  std::vector<Ring> holes{};
};

/// A part of a section, of one material. Regions of one section may touch but not overlap.
struct Region {
  Outline outline{};
  Material material{};
};

/// Everything wrong with an outline; empty when it is valid. `place` prefixes every problem ("body
/// 'girder'"). Wrong are: a ring that crosses or touches itself, repeats a point, has fewer than three points
/// or no area; a hole outside, crossing or overlapping; a coordinate that is not finite; an area below 1e-9
/// of the square of the extent, too thin to compute with. O(n log n).
std::vector<Problem> validate(const Outline& outline, const std::string& place = "outline");

/// The same for a section: every region's outline and material, and regions that overlap in area; Young's
/// modulus on all regions or on none; an area below 1e-9 of the square of the extent of all; yield stresses
/// more than a factor of 1e9 apart.
std::vector<Problem> validate(std::span<const Region> regions);

/// The same for a material: stresses and moduli finite and not negative, yield stress above zero.
std::vector<Problem> validate(const Material& material, const std::string& place = "material");

/// Plastic capacities about one bending direction.
struct Capacities {
  double N = 0;          ///< N_t, N: full tension (Eq 1)
  double Nc = 0;         ///< N_c, N: full compression, as a positive number (Eq 1)
  double Q = 0;          ///< N: full shear (Eq 2)
  double M = 0;          ///< N m: fully plastic moment, the side toward d in tension (Eq 3)
  double M_reverse = 0;  ///< N m: the other sense
  double pna =
      0;  ///< m: plastic neutral axis of M, coordinate along d; middle of the interval where not unique
  double pna_reverse = 0;  ///< m: plastic neutral axis of M_reverse
};

/// A point of the N–M interaction curve.
struct Interaction {
  double N = 0;  ///< N, tension positive
  double M = 0;  ///< N m, about the reference line; positive: the side toward d in tension
};

/// Elastic values about one bending direction, modulus-weighted where E differs between the regions.
struct Elastic {
  Point centroid;           ///< m; where an axial force bends nothing. Area-weighted where no E is known
  double EA = 0, EI = 0;    ///< N, N m²; 0 where no E is known
  double I = 0;             ///< m⁴; NaN where E or fy differ between regions
  double W_elastic = 0;     ///< m³, I / farther fibre; NaN likewise
  double W_plastic = 0;     ///< m³, M / fy; NaN likewise
  double yield_moment = 0;  ///< N m: the moment at which the first fibre yields, the side toward d in tension
  double shape_factor = 0;  ///< M / yield_moment (rectangle 1.5)
};

/// Principal bending directions, unit vectors at right angles; modulus-weighted where E differs.
struct PrincipalAxes {
  Point strong;  ///< greatest EI (I where no E is known)
  Point weak;    ///< least
};

/// A validated cross-section. Immutable; safe to read from several threads. No call after construction
/// allocates, except those that return a vector. Results are within 1e-13 relative of the exact integrals
/// over the coordinates as given, also for slivers and combs; a direction must be finite and not zero
/// (std::invalid_argument).
class Section {
 public:
  /// Takes what validate() accepts; throws InvalidInput otherwise.
  explicit Section(std::span<const Region> regions);
  explicit Section(const Outline& outline, const Material& material);

  double area() const;     ///< m²
  Point centroid() const;  ///< m, geometric
  std::span<const Region> regions() const;

  /// About the bending direction d (any length > 0); Eqs 1–3 in closed form over the edges. O(vertices).
  Capacities capacities(Point direction) const;
  Elastic elastic(Point direction) const;

  /// Extreme coordinates along d, m: {lowest, highest}.
  std::pair<double, double> extent(Point direction) const;

  PrincipalAxes principal_axes() const;

  /// M that goes with the axial force N (tension positive) and the shear force Q, about the line at
  /// coordinate `reference` along d; as a positive number in the other sense where `reverse`. N in [−N_c,
  /// N_t] and |Q| ≤ Q_max (else clamped). At full N it is what N carries about the reference line, so it may
  /// be negative.
  double moment_at(Point direction, double N, double reference, bool reverse = false, double Q = 0) const;

  /// The convex N–M curve about the line at coordinate `reference` along d, as a closed polygon inscribed in
  /// the exact one, counter-clockwise from full tension, whose distance from it is at most `tolerance` of the
  /// curve's extent in N and M. Shear reduces every stress: f·√(1 − (Q/Q_max)²).
  std::vector<Interaction> interaction(Point direction, double reference, double tolerance = 1e-3,
                                       double Q = 0) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace ductile
