// Parkes' struck cantilever.
#pragma once

#include <cmath>

namespace ductile {

// A tip mass G struck with v0; rigid-plastic theory (E. W. Parkes, Proc. R. Soc. A 228, 1955). A hinge runs
// from the tip to the root: with the stretch x beyond it turning as one, momentum and its moment about the
// tip give v = G v0/(G + mx/2) and M_p t = m x² v/6; then all turns about the root until M_p has used up the
// energy.
struct Parkes {
  double root_rotation, tip_deflection;
};

inline Parkes parkes(double tip_mass, double mass_per_length, double length, double speed, double moment) {
  const auto velocity = [&](double x) { return tip_mass * speed / (tip_mass + mass_per_length * x / 2); };
  const auto time = [&](double x) { return mass_per_length * x * x * velocity(x) / 6 / moment; };
  double deflection = 0;
  const int n = 10000;
  for (int i = 0; i < n; ++i) {
    const double x0 = length * i / n, x1 = length * (i + 1) / n;
    deflection += velocity((x0 + x1) / 2) * (time(x1) - time(x0));
  }
  const double omega = velocity(length) / length;
  const double inertia = tip_mass * length * length + mass_per_length * std::pow(length, 3) / 3;
  const double rotation = inertia * omega * omega / (2 * moment);
  return {rotation, deflection + rotation * length};
}

}  // namespace ductile
