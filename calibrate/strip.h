// What a body offers to a cut across it.
#pragma once

#include <array>
#include <optional>

#include "ductile/calibrate.h"

namespace ductile::calibration {

/// Of one cross-section: caps, the stiffness of a metre, and how far it can be strained.
struct Strength {
  double N = 0, Nc = 0, Q = 0, M = 0, M_reverse = 0;  ///< as PlannedJoint
  double EA = 0, GA = 0, EI = 0;  ///< N, N (with the shear coefficient κ), N m²; 0 where E is not known
  double farther = 0;             ///< m, from the plastic neutral axis to the fibre farthest from it
  double height = 0;              ///< m
};

/// From end to end of an outline through its centroid, along the axis about which its area is most slender;
/// in the direction of x, then of y.
std::array<Point, 2> ends_of_long_axis(const Outline& outline);

/// A body seen as the strip that it is drawn as: a rectangle of the body's depth at every cut, or its
/// profile.
class Strip {
 public:
  explicit Strip(const BodyDef& body);

  bool has_material() const { return body_->material || profile_; }
  double fracture_strain() const { return fracture_strain_; }
  double damping_ratio() const { return damping_ratio_; }
  /// D, 1/s, and q of what depends least on the rate of strain; D is unlimited where nothing does.
  double doubling_rate() const { return doubling_rate_; }
  double rate_exponent() const { return rate_exponent_; }
  double hardening() const { return hardening_; }  ///< f_u/f_y, of a profile the least; 1: none

  /// Of a joint's cut; `reversed`: its axis runs against the strip, so that what is left of the strip is
  /// right of the axis.
  Strength at(const PlannedJoint& joint, bool reversed = false) const;
  /// The same as a section: x out of plane, y to the left of the joint's axis, the anchor at the
  /// origin.
  Section section(const PlannedJoint& joint, bool reversed = false) const;
  /// m; a cut must be as high within 1 %. None without a profile: cuts may have any height.
  std::optional<double> profile_height() const;

  double mass_per_area() const { return mass_per_area_; }  ///< kg/m² of the outline
  /// kg m²: what the moment of inertia of a piece of this outline area is above that of mass spread evenly
  /// over the outline, because a profile has its mass in its flanges.
  double excess_inertia(double area) const;

 private:
  const BodyDef* body_;
  std::optional<Section> profile_;  // its centroid at the origin
  Strength of_profile_;
  double mass_per_area_ = 0, excess_inertia_per_area_ = 0;
  double fracture_strain_ = 0, damping_ratio_ = 0, hardening_ = 1;
  double doubling_rate_ = unlimited, rate_exponent_ = 1;
};

}  // namespace ductile::calibration
