// What the pieces of a body make together.
#pragma once

#include <numbers>

#include "ductile/calibrate.h"
#include "ductile/moments.h"
#include "ductile/plane.h"

namespace ductile::calibration {

inline double area_of(const Piece& piece) {
  return piece.circle > 0 ? std::numbers::pi * piece.circle * piece.circle : moments(piece.outline).area;
}

/// Of a whole body, about which it turns.
inline Point mass_centre(const Plan& plan, int body) {
  double area = 0;
  Point first{};
  for (const Piece& piece : plan.pieces) {
    if (piece.body != body) continue;
    const double a = area_of(piece);
    area += a;
    first = first + a * piece.center;
  }
  return (1 / area) * first;
}

}  // namespace ductile::calibration
