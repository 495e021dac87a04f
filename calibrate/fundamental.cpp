// The lowest non-zero eigenvalue of K φ = ω² M φ, by inverse iteration on a pencil that keeps rigid motion
// and mechanisms out.
//
//   φ ← (σM + K)⁻¹ M (σM + K)⁻¹ K φ
//
// multiplies the mode of ω by σω²/(σ + ω²)²: by nothing where ω = 0, and above ω² = σ by less and less. With
// σ below the lowest ω² it converges to that mode, as (ω₁/ω₂)² a round, for one factorisation.

#include "fundamental.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <vector>

namespace ductile::calibration {

namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

// Rigid rows are springs of so many times the row's mass a second² at least, and as many times as stiff as
// the stiffest elastic row: short pieces' are stiffer than any number that could be given here.
constexpr double least_rigid_rate = 1e10, rigid_ratio = 100;

struct Connected {
  std::vector<std::size_t> joints;
  std::vector<int> pieces;  // that move
};

std::size_t z(int i) { return static_cast<std::size_t>(i); }

// The rigid body that a piece is part of: −1 where it does not move.
int moving(const Plan& plan, int piece) {
  if (piece < 0) return -1;
  const Piece& p = plan.pieces[z(piece)];
  const int body = p.part_of < 0 ? piece : p.part_of;
  return plan.is_dynamic(piece) && plan.pieces[z(body)].mass > 0 ? body : -1;
}

std::vector<Connected> connected(const Plan& plan) {
  std::vector<int> root(plan.pieces.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[z(i)] != i) i = root[z(i)] = root[z(root[z(i)])];
    return i;
  };
  for (const PlannedJoint& j : plan.joints) {
    const int a = moving(plan, j.a), b = moving(plan, j.b);
    if (a >= 0 && b >= 0) root[z(find(a))] = find(b);
  }
  std::vector<int> number(plan.pieces.size(), -1);
  std::vector<Connected> found;
  const auto of = [&](int body) -> Connected& {
    int& n = number[z(find(body))];
    if (n < 0) n = static_cast<int>(found.size()), found.emplace_back();
    return found[z(n)];
  };
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (moving(plan, static_cast<int>(i)) == static_cast<int>(i))
      of(static_cast<int>(i)).pieces.push_back(static_cast<int>(i));
  for (std::size_t k = 0; k < plan.joints.size(); ++k) {
    const PlannedJoint& j = plan.joints[k];
    const int a = moving(plan, j.a), b = moving(plan, j.b);
    if (a >= 0 || b >= 0) of(a >= 0 ? a : b).joints.push_back(k);
  }
  return found;
}

// The gaps' derivatives by the poses of the bodies of one structure; 1/m_eff = J M⁻¹ Jᵀ of each row.
double fundamental(const Plan& plan, const Connected& structure) {
  std::vector<int> column(plan.pieces.size(), -1);
  for (std::size_t i = 0; i < structure.pieces.size(); ++i)
    column[z(structure.pieces[i])] = static_cast<int>(3 * i);
  const auto n = static_cast<Eigen::Index>(3 * structure.pieces.size());
  Vector mass(n);
  for (std::size_t i = 0; i < structure.pieces.size(); ++i) {
    const Piece& p = plan.pieces[z(structure.pieces[i])];
    mass.segment<3>(static_cast<Eigen::Index>(3 * i)) << p.mass, p.mass, p.inertia;
  }
  struct Row {
    double stiffness;
    double compliance = 0;  // of its bodies' masses
    int columns[6]{}, used = 0;
    double jacobian[6]{};
  };
  std::vector<Row> rows;
  double stiffest = 0;  // of elastic rows, 1/s²
  for (const std::size_t k : structure.joints) {
    const PlannedJoint& j = plan.joints[k];
    const double stiffness[3] = {j.N == 0 && j.Nc == 0 ? 0 : j.stiffness.N, j.Q == 0 ? 0 : j.stiffness.Q,
                                 j.M == 0 && j.M_reverse == 0 ? 0 : j.stiffness.M};
    for (int i = 0; i < 3; ++i) {
      if (!(stiffness[i] > 0)) continue;
      const Point d = i == 0 ? j.axis : Point{-j.axis.y, j.axis.x};
      Row row{.stiffness = stiffness[i]};
      for (const int side : {0, 1}) {
        const int body = moving(plan, side == 0 ? j.a : j.b);
        if (body < 0) continue;
        const Piece& p = plan.pieces[z(body)];
        const double sign = side == 0 ? -1 : 1;
        const Point at = side == 0 ? j.anchor : j.far_anchor();
        const Point arm{at.x - p.center.x, at.y - p.center.y};
        const double entry[3] = {i == 2 ? 0 : sign * d.x, i == 2 ? 0 : sign * d.y,
                                 i == 2 ? sign : sign * (arm.x * d.y - arm.y * d.x)};
        for (int c = 0; c < 3; ++c) {
          const double of_column = mass[column[z(body)] + c];
          if (!(of_column > 0)) continue;
          row.jacobian[row.used] = entry[c];
          row.columns[row.used++] = column[z(body)] + c;
          row.compliance += entry[c] * entry[c] / of_column;
        }
      }
      if (!(row.compliance > 0)) continue;
      if (row.stiffness < unlimited) stiffest = std::max(stiffest, row.stiffness * row.compliance);
      rows.push_back(row);
    }
  }
  if (stiffest == 0) return 0;
  const double rigid_rate = std::max(least_rigid_rate, rigid_ratio * stiffest);
  std::vector<Eigen::Triplet<double>> entries;
  for (const Row& row : rows) {
    const double rate = row.stiffness < unlimited ? row.stiffness : rigid_rate / row.compliance;
    for (int a = 0; a < row.used; ++a)
      for (int b = 0; b < row.used; ++b)
        entries.emplace_back(row.columns[a], row.columns[b], rate * row.jacobian[a] * row.jacobian[b]);
  }
  Matrix K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());

  // Some of every mode, and none of them by accident of symmetry.
  Vector start(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double turns = std::numbers::phi * static_cast<double>(i);
    start[i] = mass[i] > 0 ? 0.7 + 0.6 * (turns - std::floor(turns)) : 0;
  }
  // Eigen adds up in another order where the processor has vectors; this is the same everywhere.
  const auto product = [n](const Vector& a, const Vector& b) {
    double sum = 0;
    for (Eigen::Index i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
  };
  double shift = 1;  // σ, 1/s²
  for (int attempt = 0; attempt < 12; ++attempt) {
    Matrix H = K;
    for (Eigen::Index i = 0; i < n; ++i) H.coeffRef(i, i) += mass[i] > 0 ? shift * mass[i] : 1;
    const Eigen::SimplicialLDLT<Matrix> factor(H);
    if (factor.info() != Eigen::Success) return 0;
    Vector x = start;
    double square = 0;
    for (int round = 0; round < 60; ++round) {
      const Vector strained = factor.solve(Vector(K * x));
      x = factor.solve(Vector(mass.cwiseProduct(strained)));
      const double norm = product(x, mass.cwiseProduct(x));
      if (!(norm > 0) || !std::isfinite(norm)) return 0;
      x /= std::sqrt(norm);
      const double last = square;
      square = product(x, K * x);
      if (std::abs(square - last) <= 1e-6 * square) break;
    }
    if (!(square < 4 * shift)) return std::sqrt(square) / (2 * std::numbers::pi);
    shift = square / 100;
  }
  return 0;
}

}  // namespace

void find_damping_frequencies(Plan& plan) {
  for (const Connected& structure : connected(plan)) {
    double found = -1;
    for (const std::size_t k : structure.joints) {
      PlannedJoint& j = plan.joints[k];
      if (!(j.damping_ratio > 0) || j.damping_frequency > 0) continue;
      if (found < 0) found = fundamental(plan, structure);
      j.damping_frequency = found;
    }
  }
}

}  // namespace ductile::calibration
