#include "bars.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "ductile/plane.h"
#include "yield.h"

namespace ductile {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double same = 1e-6;  // a joint's bending stiffness is that of its bars, but for rounding

// A displacement across an arm, to its left, in the joint's (u, v).
Vector3d across(const PlannedJoint& joint, const Arm& arm) {
  return {dot(left(arm.along), joint.axis), dot(left(arm.along), left(joint.axis)), 0};
}

// As calibrate() has it: half of the piece's extent along the axis bends as the piece is high there.
Arm arm(const Plan& plan, const PlannedJoint& joint, bool of_b) {
  const int piece = of_b ? joint.b : joint.a;
  if (piece < 0 || !plan.is_dynamic(piece) || !(joint.stiffness.M < unlimited)) return {};
  const std::optional<Section> section = section_at(plan, joint, piece);
  if (!section) return {};
  const Point outward = of_b ? joint.axis : -joint.axis;
  double reach = 0;
  for (const Point& p : plan.pieces[static_cast<std::size_t>(piece)].outline.outer)
    reach = std::max(reach, dot(p - joint.anchor, outward) / 2);
  const Elastic e = section->elastic({0, -1});
  const PlannedJoint::Mean& mean = joint.mean[of_b];
  return e.EI > 0 ? Arm{reach, mean.EI * e.EI, -outward, mean.EA * 5. / 6 * e.EA / 2.6} : Arm{};
}

// rad per N m.
double compliance(const std::array<Arm, 2>& arms) {
  double sum = 0;
  for (const Arm& arm : arms)
    if (arm.length > 0) sum += arm.length / arm.EI;
  return sum;
}

// rad per N m, of a support's own spring, which is in line with the bar to it.
double support_gives(double k, double bar) { return std::max(1 / k - bar, 0.); }

bool stands_for(const PlannedJoint& joint, const std::array<Arm, 2>& arms) {
  return std::abs(compliance(arms) * joint.stiffness.M - 1) < same;
}

// Whether a body of several pieces ends with this one.
bool ends(const Plan& plan, int piece) {
  return std::count_if(plan.joints.begin(), plan.joints.end(), [&](const PlannedJoint& joint) {
           return plan.is_inside(joint) && (joint.a == piece || joint.b == piece);
         }) == 1;
}

}  // namespace

std::vector<std::array<Arm, 2>> arms_of(const Plan& plan) {
  std::vector<std::array<Arm, 2>> arms(plan.joints.size());
  std::vector<double> stiffest(plan.pieces.size());  // EI of a piece's bars
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const PlannedJoint& joint = plan.joints[i];
    std::array<Arm, 2> own{arm(plan, joint, false), arm(plan, joint, true)};
    if (!stands_for(joint, own)) continue;
    arms[i] = own;
    for (const bool b : {false, true})
      if (own[b].length > 0) {
        double& most = stiffest[static_cast<std::size_t>(b ? joint.b : joint.a)];
        most = std::max(most, own[b].EI);
      }
  }
  // From the middle of a piece to a point where no section is cut.
  const auto arm_to = [&](int index, Point at) {
    if (index < 0 || stiffest[static_cast<std::size_t>(index)] == 0) return Arm{};
    const Piece& piece = plan.carrier(index);
    const Point from_middle = at - piece.center;
    if (length(from_middle) <= 1e-6 * std::sqrt(piece.inertia / piece.mass))
      return Arm{};  // in the middle, but for rounding
    return Arm{length(from_middle), stiffest[static_cast<std::size_t>(index)], unit(from_middle)};
  };
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const PlannedJoint& joint = plan.joints[i];
    if (joint.a < 0) {
      arms[i][1] = arm_to(joint.b, joint.anchor);
    } else if (joint.node != 0) {  // stands for both bars, for that of one, or for none
      const Arm of_a = arm_to(joint.a, joint.anchor), of_b = arm_to(joint.b, joint.anchor);
      std::array ways{std::array{of_a, of_b}, std::array{Arm{}, of_b}, std::array{of_a, Arm{}}};
      if (!ends(plan, joint.b)) std::swap(ways[1], ways[2]);  // arms that are alike do not tell
      const auto way = std::find_if(ways.begin(), ways.end(),
                                    [&](const std::array<Arm, 2>& own) { return stands_for(joint, own); });
      if (way != ways.end()) arms[i] = *way;
    }
  }
  return arms;
}

namespace {

// m/N …: of (u, v, φ) per (N, Q, M), by complementary energy ½ ∫ (M + F s)²/EI ds of each arm, F across it at
// its end, s from there. Turns are the arms', but for a support's spring.
Matrix3d flexibility_of(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Vector3d& k) {
  Matrix3d flexibility = k.cwiseInverse().asDiagonal();
  flexibility(rotation, rotation) = joint.a >= 0 ? 0 : support_gives(k[rotation], compliance(arms));
  for (const Arm& arm : arms) {
    if (arm.length == 0) continue;
    const Vector3d n = across(joint, arm), turn = Vector3d::UnitZ();
    const double l = arm.length;
    flexibility += l * l * l / (3 * arm.EI) * n * n.transpose();
    flexibility += l * l / (2 * arm.EI) * (n * turn.transpose() + turn * n.transpose());
    flexibility += l / arm.EI * turn * turn.transpose();
  }
  return flexibility;
}

// Of the joint's slip v, in (θ_a, θ_b, v), what is a spring's between the bars: all but their own shear.
Vector3d jump(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Vector3d& k) {
  double gives = 1 / k[shear];
  for (const Arm& arm : arms)
    if (arm.length > 0) gives -= arm.GA > 0 ? arm.length / arm.GA : gives;
  if (gives <= same / k[shear]) return Vector3d::Zero();
  const Vector3d Q = flexibility_of(joint, arms, k).inverse().row(shear);
  return gives * Vector3d(-Q[rotation], Q[rotation], Q[shear]);
}

}  // namespace

// The root of an inverse is the inverse of a root.
Root with_bars(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Vector3d& k) {
  if (!(compliance(arms) > 0)) return k.cwiseSqrt().asDiagonal();
  std::vector<int> rows;
  for (int row = 0; row < 3; ++row)
    if (k[row] > 0) rows.push_back(row);
  const Eigen::MatrixXd own = flexibility_of(joint, arms, k)(rows, rows), lower = own.llt().matrixL();
  const Eigen::MatrixXd inverse = lower.inverse();
  Root root = Root::Zero();
  root(rows, rows) = inverse;
  return root;
}

// ∫ w'² ds of the cubic whose ends' slopes are α and β against its chord's, ψ = (ℓ_a θ_a + v + ℓ_b θ_b)/ℓ,
//   ℓ ψ² + ℓ (4 α² − 2 α β + 4 β²)/30,
// less that of two straight halves with the joint's slip between them, ℓ_a θ_a² + ℓ_b θ_b² + 2 φ v. A
// spring's part of v bends nothing: 2 φ_j v of it, φ_j the bars' slope where they meet.
Matrix3d curved(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Vector3d& k,
                std::array<double, 2> follow) {
  const double a = arms[0].length, b = arms[1].length, length = a + b;
  if (length == 0 || joint.a < 0 || joint.node != 0 || is_free(joint, axial) || is_free(joint, shear) ||
      is_free(joint, rotation))
    return Matrix3d::Zero();
  const Vector3d slip = Vector3d::UnitZ(), turn(follow[0], follow[1], 0), apart = jump(joint, arms, k),
                 chord = (Vector3d(a, b, 1) - apart) / length;
  const double of_a = a > 0 ? a / arms[0].EI / compliance(arms) : 0;
  const Vector3d meet(1 - of_a, of_a, 0);
  const Vector3d alpha = Vector3d::UnitX() - chord, beta = Vector3d::UnitY() - chord;
  Matrix3d form = length * chord * chord.transpose();
  form += length / 30 * (4 * alpha * alpha.transpose() + 4 * beta * beta.transpose());
  form -= length / 30 * (alpha * beta.transpose() + beta * alpha.transpose());
  form -= turn * slip.transpose() + slip * turn.transpose();
  form += meet * apart.transpose() + apart * meet.transpose();
  form.diagonal() -= Vector3d(a, b, 0);
  return form;
}

// The same cubic of one arm: slope θ in the middle of the piece, its end w to the left of the rigid piece's,
// the chord ψ = (ℓ θ + w)/ℓ, and at the end the slope of a spring s against the ground's γ,
// 4 EI/ℓ β + 2 EI/ℓ α = −s (ψ + β − γ): γ − ψ where it clamps, −α/2 where there is none. The end goes with
// the ground's spring across, d + w = F/k, F from (d, θ − γ) by the flexibility of spring and arm in line.
Matrix3d curved_at_support(const Arm& arm, double k_across, double k_turn) {
  const double length = arm.length, EI = arm.EI, bar = length / EI;
  const double gives = support_gives(k_turn, bar) / bar;
  const double clamped = k_turn > 0 ? 1 / (1 + 4 * gives) : 0;
  Matrix2d flexibility;
  flexibility << 1 / k_across + length * length * bar / 3, length * bar / 2, length * bar / 2,
      bar * (1 + gives);
  const Vector2d of_d_and_turn =
      k_turn > 0 ? Vector2d(flexibility.inverse().row(0)) : Vector2d(1 / flexibility(0, 0), 0);
  const Vector3d turn = Vector3d::UnitX(), d = Vector3d::UnitY(), ground = Vector3d::UnitZ();
  const Vector3d F = of_d_and_turn.x() * d + of_d_and_turn.y() * (turn - ground), w = F / k_across - d;
  const Vector3d chord = turn + w / length, alpha = turn - chord,
                 beta = clamped * (ground - chord) - (1 - clamped) / 2 * alpha;
  Matrix3d form = length * (chord * chord.transpose() - turn * turn.transpose());
  form += length / 30 * (4 * alpha * alpha.transpose() + 4 * beta * beta.transpose());
  form -= length / 30 * (alpha * beta.transpose() + beta * alpha.transpose());
  return form;
}

}  // namespace ductile
