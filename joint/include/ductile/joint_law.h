// The law of a joint as numbers, without an engine: three rows, and the yield curve that two or three of them
// may share. SI units.
#pragma once

#include <limits>
#include <optional>

namespace ductile {

/// A cap or a maximum that is never reached.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// The stiffness of a row that is as stiff as the step can integrate.
inline constexpr double rigid = std::numeric_limits<double>::infinity();

/// Index of a row.
enum Row : unsigned { axial, shear, rotation };

/// Where a driven row goes: its neutral position moves toward `target` at `speed`.
struct Drive {
  double target = unlimited;  ///< m or rad, in the row's own coordinate; ±unlimited: on and on
  double speed = 0;           ///< m/s or rad/s, ≥ 0; 0 holds: a brake
};

/// The law of one row.
struct RowDef {
  double stiffness = rigid;  ///< k, N/m or N m/rad; > 0
  double damping_ratio =
      0;  ///< ζ ≥ 0: c = 2ζ√(k·m_eff), m_eff the row's effective mass; no effect when rigid
  double cap = unlimited;  ///< F⁺ ≥ 0, N or N m: tension, left shear, counter-clockwise moment; 0: free
  double cap_reverse = unlimited;  ///< F⁻ ≥ 0, as a positive number
  double hardening = 0;            ///< stiffness after yield, N/m or N m/rad; ≥ 0, below `stiffness`;
                                   ///< 0 with an interaction curve
  /// c ≥ 0, N s/m or N m s, besides what `damping_ratio` makes; no effect when rigid. A structure whose rows
  /// all have c = 2ζk/ω damps a vibration of ω' by ζω'/ω of critical damping.
  double damping = 0;
  /// Beyond a cap of 0 the row goes slack instead of flowing: its neutral position stays, so that it carries
  /// again where it did before. The other cap is not 0.
  bool slackens = false;
  /// Drives the row: a motor (rotation), a winch or a hydraulic jack (axial). What the caps cannot hold
  /// slips, and the drive goes on from where it has got to: that is neither damage nor plastic work, and
  /// comes with no event.
  std::optional<Drive> drive = {};

  /// Tension only: a rope of stiffness k that flows at `cap`.
  static constexpr RowDef rope(double k = rigid, double cap = unlimited) {
    return {.stiffness = k, .cap = cap, .cap_reverse = 0, .slackens = true};
  }
  /// Compression only: what leans on something, and may lift off it.
  static constexpr RowDef strut(double k = rigid, double cap = unlimited) {
    return {.stiffness = k, .cap = 0, .cap_reverse = cap, .slackens = true};
  }
  /// A row that carries nothing: a pin is rotation = free(), a roller axial = free().
  static constexpr RowDef free() { return {.cap = 0, .cap_reverse = 0}; }
  /// A row of cap ±k·displacement: "max force given by a maximum elastic displacement or rotation".
  static constexpr RowDef elastic_up_to(double k, double displacement) {
    return {.stiffness = k, .cap = k * displacement, .cap_reverse = k * displacement};
  }
};

/// How caps grow with the rate r of plastic flow: |R| = F (1 + (r/D)^(1/q)), D a row's rate at which its cap
/// is doubled (G. R. Cowper, P. S. Symonds 1957). Below 1e-4 D, where tests called static are made, the raise
/// is linear in r.
struct RateLaw {
  double doubling[3] = {unlimited, unlimited,
                        unlimited};  ///< D of the rows, m/s, m/s, rad/s; > 0; unlimited: none
  double exponent = 5;               ///< q ≥ 1
};

/// A point of an N–M interaction curve: N in tension positive, M as the joint's.
struct AxialMoment {
  double N = 0, M = 0;
};

}  // namespace ductile
