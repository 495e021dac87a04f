// The step of a blow: at its start velocities jump, be it by a contact that closes or by the hand of the
// game.
//
// A row's impulse s belongs to the middle of its force, half a step before a step's start and half a step
// after it (row.h). Where the structure is struck in between, the row did not act on it in the first half.
// So it may take the mean of its force before, R₋, and of its cap,
//   −h (F⁻ − R₋)/2 ≤ s ≤ h (F⁺ + R₋)/2
// and on a yield surface that is used to the share g by R₋, s is within (1 + g)/2 of it. With all of the cap
// a body of mass m and speed v₀ on a cap F loses F h/m at once and its flow v₀h/2 of v₀²m/2F: a blow that
// ends within a step would leave no mark. What flows does so at its cap: work and elastic strain are F's.
//
// Elastic rows need no such thing, as R = k (e + (u − p)/4 + …) is the mean of both halves already.
#pragma once

#include <span>

#include "system.h"

namespace ductile::dynamics {

/// By what velocities must change at once for a blow, m/s or rad/s.
inline constexpr float blow_speed = 0.1f, blow_turn = 0.05f;

/// After the laws of a step and before its first solve.
void open_blow(System& system);
/// A joint that breaks after a share of what it would flow by in this step takes no more than so much of its
/// capacity: what is fast shall lose no more than the work that breaks it.
void weaken(Joint& joint, JointRecord& record, double share);

/// After the solve of a step that is struck: the most that the blow strains a row by, as a share of its
/// capacity. `before` are the joints' impulses before it.
double strained_by_blow(const System& system, std::span<const Rows> before);

/// After the step: its laws are again those of any step, and what flowed does so at its cap.
void close_blow(System& system);

/// Plastic flow that a blow should leave and that its step does not show.
struct LeftOut {
  double flow = 0;  // the most of a row, rad, or by the way between the two bodies
  double work = 0;  // of all, J
};

/// After the solve of a step that is struck, before poses move. `before` are the joints' impulses before it,
/// `closing` the speed of the fastest contact that closes, `scratch` is of the free bodies.
///
/// A row of cap F that takes Δs more than before brakes its bodies from J v₂ to J v, v₂ the velocities
/// without all Δs; no faster than they were brought, or than what closes may throw them. Of that work, ½ Δs
/// (J v₂ + J v), a spring takes F²/2k, and flow is booked; the rest over F is left out. That is nothing of
/// blows which last Δs/F ≥ ¾ h, and all of the flow, up to v₂h/4, of those below ½ h, whose Δs is within what
/// the row may take.
LeftOut left_out(const System& system, std::span<const Rows> before, double closing, std::span<Vec3> scratch);

/// What a row that flows would take in a step that no blow cut short, N s or N m s.
double impulse_at_yield(const Joint& joint, const JointRecord& record, unsigned row);

}  // namespace ductile::dynamics
