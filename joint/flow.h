// What a step leaves in a joint: the phases of breaking 1–3. A row at its cap flows; its new neutral position
// is the present one less the elastic part, in velocities as solved; the plastic offset is incremented. Of
// hardening rows the cap grows.
//
// The elastic strain of a row that flows is e' = e + ½(1 + δ)h w_A, w_A = s/G − b the rate that the law gives
// the spring, within what its force holds, |R|/k: the mean of e before and after that is R/k. Its slip is the
// rest of h J v.
//
// The increment is taken from velocities: what turning bodies part along their tangents must not count as
// flow, which would strain what is parallel, and be work. Nor is it strain: where bodies turn evenly, e of a
// row of Newmark's holds half of what they part by in a step, T, and u = −T (row.h), of steel dozens of times
// R/k. With T₋ of the last step and T = ½h (J₊ − J) v of this one,
//   ê = e − T₋/2        û = u + (T₋ + T)/2        p̂ = p − T₋
// are what a row is strained by and moves by along its axis in the middle between a step's ends: e₊ = e + u +
// T. They have the row's law, R = k (ê + (û − p̂)/4 + …) but for (T₋ − T)/8, and the flow is û − (ê' − ê),
// which leaves ê' within |R|/k at the step's end. After flow p̂ and û₋ are 0: p = T, u₋ = −T.
#pragma once

#include "step_laws.h"

namespace ductile::dynamics {

/// How a step's velocities came about, and what became of them.
struct Motion {
  double share = 1;    // of the solution that the bodies move with
  bool swept = false;  // in the paper's way (sweep.h): of rows that flow, x is but the direction
};

/// The rate of flow of a row with a rate law, x − s/G, in impulses s at its cap (rate.h).
struct RatedLaw {
  double G = 0;  // kg or kg m²
  double x = 0;  // m/s or rad/s
};

/// At x of the row's own law.
RatedLaw rated_law(const Joint& joint, const JointRecord& record, unsigned row, double x);

/// What a row flows by in the step as it was solved, m or rad, with T as it was in the last step.
double slip_of(const Joint& joint, const JointRecord& record, unsigned row);

/// Books the plastic flow of a joint whose gap is now `gap`, and whose rows' T is `parted`, m.
void flow(Joint& joint, JointRecord& record, const Rows& gap, const Rows& parted, const StepLaws& laws,
          const Motion& motion);

/// Rows that hold nothing have their neutral position where they are.
void follow_gap(Joint& joint, const Rows& gap);

}  // namespace ductile::dynamics
