// The law of a joint as numbers, without an engine: three rows, and the yield curve that two or three of them
// may share. SI units.
#pragma once

#include <limits>

namespace ductile {

/// A cap or a maximum that is never reached.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();
/// The stiffness of a row that is as stiff as the step can integrate.
inline constexpr double rigid = std::numeric_limits<double>::infinity();

/// Index of a row.
enum Row : unsigned { axial, shear, rotation };

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

  /// A row that carries nothing: a pin is rotation = free(), a roller axial = free().
  static constexpr RowDef free() { return {.cap = 0, .cap_reverse = 0}; }
  /// A row of cap ±k·displacement: "max force given by a maximum elastic displacement or rotation".
  static constexpr RowDef elastic_up_to(double k, double displacement) {
    return {.stiffness = k, .cap = k * displacement, .cap_reverse = k * displacement};
  }
};

/// A point of an N–M interaction curve: N in tension positive, M as the joint's.
struct AxialMoment {
  double N = 0, M = 0;
};

}  // namespace ductile
