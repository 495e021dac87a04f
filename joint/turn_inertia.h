// Tension that turns with its bodies, kept stable at any step.
//
// J is taken at the step's start, so the moment that a tension T exerts on a piece as it turns comes a step
// late. A chain of pieces (length l, mass m, inertia I) under T is then a leapfrog integration of its lateral
// vibration, unstable where (ωh)² > 4: from T = m l/(3h²) on for bars. What is missing is inertia against
// that vibration.
//
//   f(v) += ½ Σ C_j (ω_b − ω_a − w_j)²      w: the relative turn rate after the last step
//
// resists only a change of the relative turn of two neighbours: it vanishes at rest, exerts opposite moments
// (momenta stay exact), and has the pattern of H. With the joints' lateral motions y as unknowns, tension is
// K = T L/l, L the second difference, and this is L C L/l². For any lumped mass m_j of the joints
//   M + L C L/l² − α L = (M^½ − ½α M^-½ L)ᵀ(M^½ − ½α M^-½ L) ≥ 0      C_j = α² l²/(4 m_j)
// and with α = s h² T/(4 l) the step is stable where s ≥ 1. A resolved mode of ωh = φ is slowed by s² φ⁴/128
// of its frequency. Rigid pieces have less mass in their shortest waves, m (1 − x (¼ − I/ml²)) for
// eigenvalues x ≤ 4 of L: the same square with α + m (¼ − I/ml²), or the bound at x = 4 where that is larger.
//
// A light body is turned by itself: one on a line, whose other end swings with something else, on a support,
// or on a body four times as heavy. A line of length ℓ pulls along its axis t at anchors r from the centres
// of mass, and its work to the second order, T/2 (y²/ℓ + t·r_a θ_a² − t·r_b θ_b²), with y by which the
// anchors move across, has three stiffnesses K; a joint has the last two, with all of its force for T t. Each
// that is not negative has an inertia of its rate:
//   C = max(0, s h²K/4 − m/8)      m: the mass that the rate moves
// Σ C + M ≥ h²K/4 where a body has up to four lines; s = 1.1, as T may rise. C is raised by 1.3 at least, so
// that a resolved vibration is slowed by (3.9 s − 1)φ²/24 at most; by the average acceleration method it is
// by φ²/12.
//
// Rates of bodies by themselves are not relative ones: their moments have no counterpart, and where the spin
// of what nothing holds (whole.h) changes, C would keep a share of its angular momentum. So after the solve
// all of it turns as one about its centre of mass, by what C took in this step:
//   δω = Σ c_j C_j (rate_j − w_j) / RᵀMR      c: the rate where all turns as one by 1 rad/s
// Its spin is that of v* then, to the last digit. The rest of its motion has of C what a free spin leaves of
// it, C − C c cᵀC/(RᵀMR + cᵀC c), the least of C over all spins, and is as stable as before: K of tensions
// that hold each other does not know the spin. What is held gives its moments to what holds it.
//
// Pieces that rigid rows hold to each other turn as one, a clump. What is ϱ times as long and as heavy as its
// pieces has T and all of the above with ϱ l and ϱ m; C of short pieces would be ϱ times what it needs, and
// what swings on it too slow for its load.
#pragma once

#include <span>

#include "system.h"

namespace ductile::dynamics {

/// Before a step of h seconds, from the impulses that the tension of the last one, which was of last_h, has
/// in it: inertia that is gained enters at the rate of its whole's spin, and beside that at equal turn rates,
/// so that no energy comes of it; what is not needed any more goes after half a second, so that factors last.
/// True where H changed.
bool follow_tension(System& system, double h, double last_h);

/// After a solve: true where its impulses ask for half as much again as there is, which was raised then, and
/// the solve is to be done once more.
bool raise_to_tension(System& system, double h);

/// After the last solve: wholes that nothing holds turn as one, each by the moment that it is owed. True
/// where velocities changed.
bool return_moments(System& system);

/// Sets the rates after a step, with bodies' velocities in their new frames, and joints located there.
void remember_turn_rates(System& system, std::span<const Vec3> velocities);

/// J M⁻¹ Jᵀ of the rate.
double inverse_mass(const System& system, const TurnInertia& t);

/// Adds the gradient at the bodies' v, and writes each one's impulse.
void add_turn_impulses(System& system, std::span<Vec3> g);

}  // namespace ductile::dynamics
