// Caps that grow with the rate r of plastic flow, |R| = F (1 + (r/D)^(1/q)): G. R. Cowper, P. S. Symonds,
// Strain Hardening and Strain Rate Effects in the Impact Loading of Cantilever Beams, Brown University 1957.
//
// In a step the slider is a power law of r = J v − w, w the rate of spring and damper. Those of a row that
// flows are integrated by implicit Euler, R = k (e + h w) + c w: with e + h w = R/k the spring would store
// what the damper holds, and dissipate it once more. A damper heavier than δ = 1 has the row's own law
// (row.h), w = s/G − b. The solver's laws are lines (row.h), so a row has, at the x of the round before, the
// value and the tangent of its own, and the step is solved anew until the two agree: Newton's method. The
// tangent is kept below G/2, where those of springs that a step resolves are more. Dissipated is R r, the
// raise included. Between steps caps are static again.
//
// The tangent at r = 0 would be infinite: below 1e-4 D the raise is linear, up to 10^(−4/q).
#pragma once

#include "step_laws.h"

namespace ductile::dynamics {

inline constexpr int most_rate_rounds = 20;

/// After a solve: laws as they are where it has ended; false where they were so already.
bool raise_caps(System& system);

/// After a step: static caps; whether any was not.
bool lower_caps(System& system, const StepLaws& laws);

}  // namespace ductile::dynamics
