// Bars that bend between the middles of pieces, as beam theory has them.
//
// A joint lumps the bending of a bar, from the middle of one piece to the middle of the other, where the
// pieces touch (EI/ℓ), a support that clamps that between itself and the middle of its piece; between one
// that does not and the middle nothing bends at all. With n pieces sags and buckling loads are wrong by some
// 1/n² and 1/n. What lacks is known in closed form: a moment that grows with the distance from the joint, so
// that shear bends the bar, too, and an axial force on a curved line. With it, nodes in the middles of pieces
// carry beam elements, which are exact without axial force and within n⁻⁴ of the buckling load.
#pragma once

#include <array>
#include <vector>

#include "equilibrium.h"

namespace ductile {

/// Bars of a plan: by joints, on the side of a and of b, as cantilevers from the middle of the piece. A joint
/// stands for bars where its bending stiffness is that of its sections over half of each piece; the bar to a
/// support or a node is as stiff as the piece's other bars. Length 0: none.
std::vector<std::array<Arm, 2>> arms_of(const Plan& plan);

/// Of a joint of stiffness k = (k_N, k_Q, k_M; 0 in free rows), with the arms of both sides.
Root with_bars(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Eigen::Vector3d& k);

/// What the bars add to the geometric stiffness of rigid pieces: times N, in (θ_a, θ_b, v), of a joint of
/// stiffness k. `follow`: the shares of both turns that the joint's axis follows. 0 where the joint stands
/// for no bar, or a row is free.
Eigen::Matrix3d curved(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Eigen::Vector3d& k,
                       std::array<double, 2> follow);

/// The same of a support's arm, in (θ, d, γ): the turn of its piece, how far to the left of the support's
/// ground the rigid piece has its end, and the turn of that ground. k: the support's stiffness across the
/// arm, N/m, > 0, and against turns, N m/rad, with the arm in line.
Eigen::Matrix3d curved_at_support(const Arm& arm, double k_across, double k_turn);

}  // namespace ductile
