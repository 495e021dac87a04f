// Periods of what swings.
#pragma once

#include <functional>

#include "bodies.h"
#include "structures.h"

namespace ductile::report {

/// The mean over so many periods of what `step_and_tell` tells, step by step of dt: from rise to rise through
/// zero.
inline double period(int periods, double dt, const std::function<double()>& step_and_tell) {
  double before = step_and_tell(), first = 0;
  int seen = 0;
  for (long i = 1;; ++i) {
    const double now = step_and_tell();
    if (before < 0 && now >= 0) {
      const double at = dt * (static_cast<double>(i) - now / (now - before));
      if (seen == 0) first = at;
      if (++seen > periods) return (at - first) / periods;
    }
    before = now;
  }
}

/// Of a cantilever along x, set in motion as its own weight bends it: x² (6 − 4 x + x²)/3, with x over the
/// length.
inline double slowest_period(bench::Built& b, double length, double dt) {
  for (b2Body* piece : b.pieces) {
    const double x = piece->GetPosition().x / length;
    piece->SetLinearVelocity(vec(0, x * x * (6 - 4 * x + x * x) / 3));
    piece->SetAngularVelocity(static_cast<float>((12 * x - 12 * x * x + 4 * x * x * x) / (3 * length)));
  }
  return period(5, dt, [&] {
    b.step(dt);
    return double{b.pieces.back()->GetPosition().y};
  });
}

}  // namespace ductile::report
