// Outlines that several tests build on.
#pragma once

#include <cmath>
#include <numbers>

#include "ductile/section.h"

namespace ductile::shapes {

inline Ring rectangle(double b, double h, Point corner = {0, 0}) {
  return {corner, {corner.x + b, corner.y}, {corner.x + b, corner.y + h}, {corner.x, corner.y + h}};
}

/// Corners on a circle of radius R, the first at (R, 0).
inline Ring regular(int n, double R, Point centre = {0, 0}) {
  Ring ring;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    ring.push_back({centre.x + R * std::cos(a), centre.y + R * std::sin(a)});
  }
  return ring;
}

/// Symmetric about x = 0, its foot on y = 0; without fillets.
inline Ring i_section(double h, double b, double tw, double tf) {
  return {{-b / 2, 0}, {b / 2, 0},  {b / 2, tf},      {tw / 2, tf},      {tw / 2, h - tf}, {b / 2, h - tf},
          {b / 2, h},  {-b / 2, h}, {-b / 2, h - tf}, {-tw / 2, h - tf}, {-tw / 2, tf},    {-b / 2, tf}};
}

/// Stem down: flange b × tf on top of a stem tw × hs.
inline Ring t_section(double b, double tf, double tw, double hs) {
  return {{-tw / 2, 0},     {tw / 2, 0},       {tw / 2, hs}, {b / 2, hs},
          {b / 2, hs + tf}, {-b / 2, hs + tf}, {-b / 2, hs}, {-tw / 2, hs}};
}

inline Point direction(double angle) { return {std::cos(angle), std::sin(angle)}; }

constexpr Point along_x{1, 0}, along_y{0, 1};

}  // namespace ductile::shapes
