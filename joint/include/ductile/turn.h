// Sine, cosine and arc tangent with the same bits everywhere: those of C libraries differ from one another,
// and from processor to processor (glibc fuses multiplications with additions where it can). A world whose
// geometry was made with these is the same world on every platform.
#pragma once

namespace ductile {

/// Cosine and sine of an angle.
struct Turn {
  double c = 1, s = 0;
};

/// Of an angle from 0.0077 rad on, as turn_of().
Turn turn_of_large(double angle);

/// The turn by an angle, rad, within an ulp of 1; the C library's from 10⁶ rad on. A Taylor series: the
/// angles by which bodies turn from step to step are so small that four terms are exact to the last bit.
inline Turn turn_of(double angle) {
  const double t = angle * angle;
  if (!(t < 6e-5)) return turn_of_large(angle);
  return {1 - t * (1. / 2) * (1 - t * (1. / 12) * (1 - t * (1. / 30))),
          angle * (1 - t * (1. / 6) * (1 - t * (1. / 20)))};
}

/// The angle of the direction (x, y), of any length, from −π to π rad, within four ulp of π; 0 of (0, 0).
double angle_of(double x, double y);

}  // namespace ductile
