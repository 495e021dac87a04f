#include "buckling.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bars.h"
#include "ductile/plane.h"

namespace ductile {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// One side of a joint, of a piece that moves.
struct End {
  int column;
  double sign;    // −1: the first piece, +1: the second
  double follow;  // share of its turn that the joint's axis follows
  Point arm;      // from its centre to the joint
  std::array<double, 3> scale;
};

// The sides of a joint that move.
std::vector<End> ends_of(const Plan& plan, const Equilibrium& statics, const PlannedJoint& j) {
  std::vector<End> ends;
  for (const auto& [piece, sign] : {std::pair(j.a, -1.), std::pair(j.b, 1.)}) {
    if (piece < 0 || statics.column[static_cast<std::size_t>(piece)] < 0) continue;
    ends.push_back({statics.column[static_cast<std::size_t>(piece)], sign, j.a < 0 ? 0 : 0.5,
                    (sign < 0 ? j.anchor : j.far_anchor()) - plan.carrier(piece).center,
                    statics.scale(piece)});
  }
  return ends;
}

// In (θ_a, θ_b, v), v = Σ ± (Je·x + e·r θ). Q is dE/dv along axes that turn with both sides. The moment at a
// wall is what it would give way to, −dE/dθ_a or dE/dθ_b, as the energy also has N φ v of the axes' turn φ.
BentBars between(const PlannedJoint& joint, const std::array<Arm, 2>& arms, const Eigen::Vector3d& k,
                 double N, const std::vector<End>& ends) {
  BentBars bars;
  bars.form = N * curved(joint, arms, k, {0.5, 0.5});
  const Point across = left(joint.axis);
  for (const End& end : ends) {
    bars.columns.emplace_back(end.column, Eigen::Vector3d(0, 0, end.sign * across.x * end.scale[0]));
    bars.columns.emplace_back(end.column + 1, Eigen::Vector3d(0, 0, end.sign * across.y * end.scale[1]));
    bars.columns.emplace_back(
        end.column + 2,
        end.scale[2] * Eigen::Vector3d(end.sign<0, end.sign> 0, end.sign * dot(across, left(end.arm))));
  }
  bars.carries.row(shear) = bars.form.row(2);
  if (ends.size() == 1) {
    const bool wall_is_b = ends.front().sign < 0;
    bars.carries.row(rotation) = bars.form.row(wall_is_b) + N / 2 * Eigen::RowVector3d::UnitZ();
    if (!wall_is_b) bars.carries.row(rotation) *= -1;
  }
  return bars;
}

// A line's axis turns by w/L, w what its ends part by across it: N w²/L.
void add_line(std::vector<Eigen::Triplet<double>>& entries, const PlannedJoint& joint, double N,
              const std::vector<End>& ends) {
  const Point across = left(joint.axis);
  std::vector<std::pair<int, double>> w;
  for (const End& end : ends) {
    w.emplace_back(end.column, end.sign * across.x * end.scale[0]);
    w.emplace_back(end.column + 1, end.sign * across.y * end.scale[1]);
    w.emplace_back(end.column + 2, end.sign * dot(across, left(end.arm)) * end.scale[2]);
  }
  const double drawn = length(*joint.end - joint.anchor);
  for (const auto& [row, a] : w)
    for (const auto& [column, b] : w) entries.emplace_back(row, column, N / drawn * a * b);
}

// What acts at the end of a support's arm, the support and loads there, acts on the bent bar, not on the
// rigid piece, which is off the support. In (θ, d, γ): the turn of the piece, how far to the left of the
// ground's point it has its end, and the turn of the ground, which carries −dE/dg of its own motion g.
BentBars at_support(const Plan& plan, const Equilibrium& statics, std::size_t index, Point force,
                    const std::function<double(const Plan::Load&)>& dead) {
  BentBars bars;
  const PlannedJoint& joint = plan.joints[index];
  const Arm& arm = statics.arms()[index][1];
  if (arm.length == 0) return bars;
  const Point across = left(arm.along);
  const Eigen::Vector3d k = statics.stiffness().segment<3>(3 * static_cast<Index>(index));
  const bool along_axis = std::abs(dot(across, joint.axis)) > 0.99;
  if (!along_axis && std::abs(dot(across, joint.axis)) > 0.01) return bars;
  const Row row = along_axis ? axial : shear;
  if (k[row] == 0) return bars;
  double N = -dot(force, arm.along);  // the support pulls its piece back
  for (const Plan::Load& load : plan.loads)
    if (load.piece == joint.b && length(load.at - joint.anchor) < 1e-6 * arm.length)
      N += dead(load) * dot(load.def.force, arm.along);
  bars.form = N * curved_at_support(arm, k[row], k[rotation]);
  const int c = statics.column[static_cast<std::size_t>(joint.b)];
  const auto s = statics.scale(joint.b);
  bars.columns = {
      {c, {0, s[0] * across.x, 0}}, {c + 1, {0, s[1] * across.y, 0}}, {c + 2, {s[2], s[2] * arm.length, 0}}};
  const double left_of_arm = dot(across, along_axis ? joint.axis : left(joint.axis));
  bars.ground = {0, -left_of_arm * joint.displacement[row], joint.displacement[rotation]};
  bars.carries.row(row) = left_of_arm * bars.form.row(1);
  bars.carries.row(rotation) = -bars.form.row(2);
  return bars;
}

// Two bars that meet in a node, each from the middle of its piece (θ) to the node (θ_n = θ + δ), bent evenly
// by the moment between them: ∫ w'² ds is ℓ (θ² + θ δ + δ²/3), its end w = ℓ δ/2 beside that of the rigid
// piece. The rigid pieces' own form has ℓ θ² of the axial force and of loads at the end, and φ ℓ δ of the
// joint's force.
void add_node(std::vector<Eigen::Triplet<double>>& entries, const Plan& plan, const PlannedJoint& joint,
              const std::array<Arm, 2>& arms, Point force, const std::vector<End>& ends,
              const std::function<double(const Plan::Load&)>& dead) {
  double compliance = 0;
  Eigen::Vector2d phi = Eigen::Vector2d::Zero(), part = Eigen::Vector2d(-1, 1);  // of (θ_a, θ_b)
  for (const Arm& arm : arms)
    if (arm.length > 0) compliance += arm.length / arm.EI;
  if (compliance == 0) return;
  for (const End& end : ends) phi[end.sign > 0] = end.follow;
  Eigen::Matrix2d form = Eigen::Matrix2d::Zero();
  for (const bool b : {false, true}) {
    const Arm& arm = arms[b];
    if (arm.length == 0) continue;
    const double from_joint = (b ? -1 : 1) * dot(force, arm.along);
    double N = from_joint;
    for (const Plan::Load& load : plan.loads)
      if (load.piece == (b ? joint.b : joint.a) && length(load.at - joint.anchor) < 1e-6 * arm.length)
        N += dead(load) * dot(load.def.force, arm.along);
    const Eigen::Vector2d theta = b ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
    const Eigen::Vector2d delta = (b ? -1 : 1) * arm.length / arm.EI / compliance * part;
    const Eigen::Vector2d turn = N * theta - from_joint * phi;
    form += arm.length / 2 * (turn * delta.transpose() + delta * turn.transpose());
    form += N * arm.length / 3 * delta * delta.transpose();
  }
  for (const End& row : ends)
    for (const End& column : ends)
      entries.emplace_back(row.column + 2, column.column + 2,
                           form(row.sign > 0, column.sign > 0) * row.scale[2] * column.scale[2]);
}

// Rigid rows are very stiff ones to these factors: a mode of theirs alone is none.
bool gives(const Equilibrium& statics, const VectorXd& mode) {
  const VectorXd energy = statics.resist(mode).cwiseProduct(statics.B * mode);
  double elastic = 0;
  for (Index row = 0; row < energy.size(); ++row)
    if (statics.gives(row)) elastic += energy[row];
  return elastic > energy.sum() / 2;
}

}  // namespace

std::vector<BentBars> bent_bars(const Plan& plan, const Equilibrium& statics, const VectorXd& forces,
                                const std::function<double(const Plan::Load&)>& dead) {
  std::vector<BentBars> all;
  for (std::size_t i = 0; i < statics.arms().size(); ++i) {
    const PlannedJoint& j = plan.joints[i];
    const auto r = 3 * static_cast<Index>(i);
    if (!statics.held[i] || j.node != 0) continue;
    BentBars bars =
        j.a < 0 ? at_support(plan, statics, i, forces[r] * j.axis + forces[r + 1] * left(j.axis), dead)
                : between(j, statics.arms()[i], statics.stiffness().segment<3>(r), forces[r],
                          ends_of(plan, statics, j));
    if (bars.form.isZero(0)) continue;
    bars.joint = i;
    all.push_back(std::move(bars));
  }
  return all;
}

// With δ = x_b + θ_b J r_b − x_a − θ_a J r_a between the anchors (J turns left), φ the turn of the axis e:
//   u = e·δ + φ Je·δ + ½ e·(θ_a² r_a − θ_b² r_b) + …      v = Je·δ − φ e·δ + ½ Je·(θ_a² r_a − θ_b² r_b) + …
// and a point at r from the centre comes back by ½ θ² r.
GeometricStiffness geometric_stiffness(const Plan& plan, const Equilibrium& statics, const VectorXd& forces,
                                       const std::function<double(const Plan::Load&)>& dead) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto both = [&](Index row, Index column, double value) {
    entries.emplace_back(row, column, value);
    entries.emplace_back(column, row, value);
  };
  const auto column = [&](int piece) {
    return piece < 0 ? -1 : statics.column[static_cast<std::size_t>(piece)];
  };
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const PlannedJoint& j = plan.joints[i];
    const double N = forces[3 * static_cast<Index>(i)], Q = forces[3 * static_cast<Index>(i) + 1];
    const Point force = N * j.axis + Q * left(j.axis), across = N * left(j.axis) - Q * j.axis;
    if (N == 0 && Q == 0) continue;
    const std::vector<End> ends = ends_of(plan, statics, j);
    if (j.end) add_line(entries, j, N, ends);
    for (const End& end : ends) {
      entries.emplace_back(end.column + 2, end.column + 2,
                           -end.sign * dot(force, end.arm) * end.scale[2] * end.scale[2]);
      if (j.end) continue;
      for (const End& turn : ends) {  // φ across·δ
        const double phi = turn.follow * turn.scale[2] * end.sign;
        both(turn.column + 2, end.column, phi * across.x * end.scale[0]);
        both(turn.column + 2, end.column + 1, phi * across.y * end.scale[1]);
        both(turn.column + 2, end.column + 2, phi * dot(across, left(end.arm)) * end.scale[2]);
      }
    }
    if (!statics.arms().empty() && j.node != 0)
      add_node(entries, plan, j, statics.arms()[i], force, ends, dead);
  }
  for (const BentBars& bars : bent_bars(plan, statics, forces, dead))
    for (const auto& [row, a] : bars.columns)
      for (const auto& [column, b] : bars.columns) entries.emplace_back(row, column, a.dot(bars.form * b));
  for (const Plan::Load& load : plan.loads) {
    const int c = column(load.piece);
    const double share = dead(load);
    if (c < 0 || share == 0) continue;
    const double turn = statics.scale(load.piece)[2];
    entries.emplace_back(
        c + 2, c + 2, share * dot(load.def.force, load.at - plan.carrier(load.piece).center) * turn * turn);
  }
  Eigen::SparseMatrix<double> K_g(statics.B.cols(), statics.B.cols());
  K_g.setFromTriplets(entries.begin(), entries.end());
  return {std::move(K_g), statics.free_motions()};
}

// Of Zᵀ K_g Z's eigenvectors, one that the loads push on or hold does more work than rounding, which is of
// the size of the work of all of its parts, and of K_g.
GeometricStiffness::GeometricStiffness(Eigen::SparseMatrix<double> K_g, const Eigen::MatrixXd& Z)
    : K_g_(std::move(K_g)) {
  if (Z.cols() == 0) return;
  constexpr double rounding = 1e-9, of_all = 1e-14;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(Z.transpose() * (K_g_ * Z));
  const Eigen::MatrixXd motions = Z * modes.eigenvectors();
  const Eigen::SparseMatrix<double> sizes = K_g_.cwiseAbs();
  const double largest = sizes.nonZeros() > 0 ? sizes.coeffs().maxCoeff() : 0;
  std::vector<Index> held;
  for (Index i = 0; i < Z.cols(); ++i) {  // the eigenvalues ascend
    const VectorXd size = motions.col(i).cwiseAbs();
    const double work = modes.eigenvalues()[i],
                 none = std::max(rounding * size.dot(sizes * size), of_all * largest);
    if (work > none) {
      held.push_back(i);
    } else if (work < -none) {
      if (pushed.size() == 0) pushed = motions.col(i);
    } else {
      if (adrift.size() == 0) adrift = VectorXd::Zero(Z.rows());
      adrift += std::cos(static_cast<double>(i)) * motions.col(i);
    }
  }
  held_ = motions(Eigen::all, held) * modes.eigenvalues()(held).cwiseSqrt().cwiseInverse().asDiagonal();
  pulled_ = K_g_ * held_;
}

VectorXd GeometricStiffness::settled(const VectorXd& x) const {
  return held_.cols() == 0 ? x : VectorXd(x - held_ * (pulled_.transpose() * x));
}

Buckle buckling(const Equilibrium& statics, const GeometricStiffness& K_g, const VectorXd& start) {
  if (K_g.pushed.size() > 0) return {unlimited, K_g.pushed};
  constexpr int most = 400;
  std::vector<VectorXd> basis, images;  // orthonormal in K, and K times them
  std::vector<double> diagonal, beside;
  VectorXd x = statics.motions(start);
  Buckle result;
  double first = 0;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
  const auto solve = [&](int what) {
    ritz.computeFromTridiagonal(
        Eigen::Map<const VectorXd>(diagonal.data(), static_cast<Index>(diagonal.size())),
        Eigen::Map<const VectorXd>(beside.data(), static_cast<Index>(diagonal.size()) - 1), what);
    return std::max(0.0, ritz.eigenvalues().maxCoeff());
  };
  for (int step = 0; step < most; ++step) {
    const VectorXd Kx = statics.B.transpose() * statics.resist(x);
    const double norm = std::sqrt(std::max(0.0, x.dot(Kx)));
    if (step == 1) first = norm;
    if (norm == 0 || norm < 1e-10 * first) break;  // the basis holds all
    if (!basis.empty()) beside.push_back(norm);
    basis.push_back(x / norm);
    images.push_back(Kx / norm);
    x = statics.motions(-(K_g * basis.back()));
    diagonal.push_back(x.dot(images.back()));
    for (int twice = 0; twice < 2; ++twice)
      for (std::size_t i = 0; i < basis.size(); ++i) x -= x.dot(images[i]) * basis[i];
    if (step > 8 && step % 4 != 0) continue;
    const double now = solve(Eigen::EigenvaluesOnly), change = std::abs(now - result.inverse_factor);
    result.inverse_factor = now;
    if (step > 8 && change <= 1e-8 * now) break;
  }
  if (diagonal.empty() || !((result.inverse_factor = solve(Eigen::ComputeEigenvectors)) > 0)) return result;
  const VectorXd share = ritz.eigenvectors().col(ritz.eigenvectors().cols() - 1);  // in ascending order
  result.mode = VectorXd::Zero(start.size());
  for (Index i = 0; i < share.size(); ++i) result.mode += share[i] * basis[static_cast<std::size_t>(i)];
  return gives(statics, result.mode) ? result : Buckle{};
}

VectorXd any_motion(const Equilibrium& statics) {
  VectorXd start(statics.B.cols());
  for (Index c = 0; c < start.size(); ++c) start[c] = std::cos(static_cast<double>(c));
  return start;
}

}  // namespace ductile
