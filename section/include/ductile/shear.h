// The shear force that a section passes on along a beam.
#pragma once

#include "ductile/section.h"

namespace ductile {

/// Q, N: the greatest shear force along d by equilibrium, from the flow of shear along the section's outline
/// at the shear yield stress (section/shear.cpp derives it): b h τ_y of a rectangle along its sides, h t_w
/// τ_y of an I-section along its web. Eq 2's, which Capacities has, is that of all the area. How parts across
/// d pass the flow on sideways is not looked into. d must be finite and not zero (std::invalid_argument).
double shear_capacity(const Section& section, Point d);

}  // namespace ductile
