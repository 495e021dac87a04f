#include "equilibrium.h"

#include <Eigen/SPQRSupport>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "bars.h"
#include "ductile/joint.h"
#include "ductile/plane.h"
#include "groups.h"
#include "yield.h"

namespace ductile {
namespace {

using Eigen::Index;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

// Of a row of B on one piece at `arm` from its centre: what it lengthens by per unit of x, y and θ.
std::array<double, 3> row_on_piece(Row row, Point axis, Point arm) {
  if (row == rotation) return {0, 0, 1};
  const Point e = row == axial ? axis : left(axis);
  return {e.x, e.y, dot(e, left(arm))};
}

// Of pieces: whether joints hold them to something that stands still, or they stand still themselves.
std::vector<bool> held_pieces(const Plan& plan) {
  const std::size_t n = plan.pieces.size();
  Groups groups(n + 1);  // the last one: all that stands still
  const auto index = [&](int piece) { return piece < 0 ? n : static_cast<std::size_t>(piece); };
  for (std::size_t i = 0; i < n; ++i) {
    if (!plan.is_dynamic(static_cast<int>(i))) groups.unite(n, i);
    if (plan.pieces[i].part_of >= 0) groups.unite(index(plan.pieces[i].part_of), i);
  }
  for (const PlannedJoint& j : plan.joints)
    if (!is_free(j, axial) || !is_free(j, shear) || !is_free(j, rotation))
      groups.unite(index(j.b), index(j.a));
  std::vector<bool> held;
  for (std::size_t i = 0; i < n; ++i) held.push_back(groups.of(i) == groups.of(n));
  return held;
}

std::vector<int> others_than(const std::vector<bool>& held) {
  std::vector<int> loose;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i]) loose.push_back(static_cast<int>(i));
  return loose;
}

}  // namespace

std::vector<int> loose_pieces(const Plan& plan) { return others_than(held_pieces(plan)); }

// A = √k B = Q [Lᵀ …] Pᵀ, √k the root of k; what is not shown belongs to mechanisms. L Lᵀ = Pᵀ K P without
// squaring A's condition. SPQR, for its fronts: Eigen's own sparse QR took a thousand times as long on a
// frame of 2000 joints.
struct Equilibrium::Factors {
  explicit Factors(const SparseMatrix<double>& A) {
    // A column that keeps less of itself than rounding leaves is a motion that no row resists.
    double largest = 0;
    for (Index i = 0; i < A.outerSize(); ++i) largest = std::max(largest, A.col(i).norm());
    qr.setPivotThreshold(1e-11 * largest);
    qr.setSPQROrdering(SPQR_ORDERING_AMD);
    qr.compute(A);
    L = qr.matrixR().topLeftCorner(qr.rank(), qr.rank()).transpose();
  }
  // L⁻¹ Pᵀ f. Eigen passes over the columns of L whose unknown is 0.
  VectorXd forward(const VectorXd& f) const {
    const VectorXd permuted = qr.colsPermutation().transpose() * f;
    return L.triangularView<Eigen::Lower>().solve(permuted.head(L.cols()));
  }

  Eigen::SPQR<SparseMatrix<double>> qr;
  SparseMatrix<double> L;
};

Equilibrium::~Equilibrium() = default;

Equilibrium::Equilibrium(const Plan& plan, Between between) : plan_(plan) {
  if (between == Between::elastic_bars) arms_ = arms_of(plan);
  number_columns();
  if (std::all_of(column.begin(), column.end(), [](int c) { return c < 0; }))
    throw InvalidInput(
        {{"joints", "no joint holds anything that could move to the ground or to a body that stands still",
          "add a support, or a joint to a static body"}});
  fill();
  set_stiffness();
  stiffen(roots());
}

bool Equilibrium::gives(Index row) const {
  const auto joint = static_cast<std::size_t>(row / 3);
  const bool bends = !arms_.empty() && arms_[joint][0].length + arms_[joint][1].length > 0;
  return k_[row] > 0 && (bends || plan_.joints[joint].stiffness[static_cast<Row>(row % 3)] < unlimited);
}

std::vector<Root> Equilibrium::roots() const {
  std::vector<Root> roots;
  for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
    const Eigen::Vector3d k = k_.segment<3>(3 * static_cast<Index>(i));
    roots.emplace_back(arms_.empty() ? Root(k.cwiseSqrt().asDiagonal())
                                     : with_bars(plan_.joints[i], arms_[i], k));
  }
  return roots;
}

void Equilibrium::stiffen(const std::vector<Root>& roots) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < roots.size(); ++i)
    for (int row = 0; row < 3; ++row)
      for (int c = 0; c < 3; ++c)
        if (roots[i](row, c) != 0)
          entries.emplace_back(3 * static_cast<int>(i) + row, 3 * static_cast<int>(i) + c, roots[i](row, c));
  root_.resize(B.rows(), B.rows());
  root_.setFromTriplets(entries.begin(), entries.end());
  factors_ = std::make_unique<Factors>(root_ * B);
}

void Equilibrium::number_columns() {
  const std::vector<bool> is_held = held_pieces(plan_);
  column.assign(plan_.pieces.size(), -1);
  int columns = 0;
  for (std::size_t i = 0; i < plan_.pieces.size(); ++i) {
    if (!plan_.is_dynamic(static_cast<int>(i)) || !is_held[i]) continue;
    const int carrier = plan_.pieces[i].part_of;  // comes before its parts
    column[i] = carrier >= 0 ? column[static_cast<std::size_t>(carrier)] : columns;
    if (carrier < 0) columns += 3;
  }
  loose = others_than(is_held);
  for (const PlannedJoint& j : plan_.joints)
    held.push_back(j.b < 0 || is_held[static_cast<std::size_t>(j.b)]);
}

std::array<double, 3> Equilibrium::scale(int piece) const {
  const Piece& p = plan_.carrier(piece);
  const double s = 1 / std::sqrt(p.mass);
  return {s, s, 1 / std::sqrt(p.inertia)};
}

void Equilibrium::fill() {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
    const PlannedJoint& j = plan_.joints[i];
    if (!held[i]) continue;
    for (const auto& [piece, sign] : {std::pair(j.a, -1.), std::pair(j.b, 1.)}) {
      if (piece < 0 || column[static_cast<std::size_t>(piece)] < 0) continue;
      const Point arm = (sign < 0 ? j.anchor : j.far_anchor()) - plan_.carrier(piece).center;
      const auto s = scale(piece);
      for (const Row row : {axial, shear, rotation}) {
        if (is_free(j, row)) continue;
        const auto entry = row_on_piece(row, j.axis, arm);
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(3 * static_cast<int>(i) + row, column[static_cast<std::size_t>(piece)] + c,
                               sign * entry[static_cast<std::size_t>(c)] * s[static_cast<std::size_t>(c)]);
      }
    }
  }
  B.resize(3 * static_cast<Index>(plan_.joints.size()), *std::max_element(column.begin(), column.end()) + 3);
  B.setFromTriplets(entries.begin(), entries.end());
}

// k / m_eff where no row is elastic, 1/s²: what the structure's solver makes of rigid rows at 60 Hz.
constexpr double all_rigid = 1e9 * 60 * 60;

// A row's effective mass is 1 / ‖its row of B‖², since B's columns are scaled by the masses.
void Equilibrium::set_stiffness() {
  VectorXd squares = VectorXd::Zero(B.rows());
  for (Index c = 0; c < B.outerSize(); ++c)
    for (SparseMatrix<double>::InnerIterator it(B, c); it; ++it) squares[it.row()] += it.value() * it.value();
  k_ = VectorXd::Zero(B.rows());
  double fastest = 0;  // k / m_eff of the stiffest elastic row, 1/s²
  for (const bool elastic : {true, false})
    for (std::size_t i = 0; i < plan_.joints.size(); ++i)
      for (const Row row : {axial, shear, rotation}) {
        const Index r = 3 * static_cast<Index>(i) + row;
        const double k = plan_.joints[i].stiffness[row];
        if (squares[r] == 0 || elastic != (k < unlimited)) continue;
        if (elastic) fastest = std::max(fastest, k * squares[r]);
        k_[r] = elastic ? k : (fastest > 0 ? 1e6 * fastest : all_rigid) / squares[r];
      }
}

void Equilibrium::add(VectorXd& f, int piece, Point force, double moment) const {
  const int c = column[static_cast<std::size_t>(piece)];
  if (c < 0) return;
  const auto s = scale(piece);
  f[c] += s[0] * force.x;
  f[c + 1] += s[1] * force.y;
  f[c + 2] += s[2] * moment;
}

VectorXd Equilibrium::gravity() const {
  VectorXd f = VectorXd::Zero(B.cols());
  for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
    if (plan_.pieces[i].part_of < 0) add(f, static_cast<int>(i), plan_.pieces[i].mass * plan_.gravity, 0);
  return f;
}

VectorXd Equilibrium::load(const Plan::Load& load) const {
  VectorXd f = VectorXd::Zero(B.cols());
  const Point arm = load.at - plan_.carrier(load.piece).center;
  add(f, load.piece, load.def.force, cross(arm, load.def.force) + load.def.moment);
  return f;
}

// A load between the middle of its piece and a joint bends the arm, a cantilever from the middle (bars.h),
// beyond what the piece's motion says: the joint is longer by what its end goes. Eccentric loads act by their
// moment.
void Equilibrium::bend(const Plan::Load& load, VectorXd& elongation) const {
  const Point from_middle = load.at - plan_.carrier(load.piece).center;
  const auto for_each_arm = [&](auto&& visit) {
    for (std::size_t i = 0; i < arms_.size(); ++i)
      for (const bool b : {false, true})
        if ((b ? plan_.joints[i].b : plan_.joints[i].a) == load.piece && arms_[i][b].length > 0)
          visit(i, b, arms_[i][b]);
  };
  Point along;
  double reach = 0;
  for_each_arm([&](std::size_t, bool, const Arm& arm) {
    if (dot(from_middle, arm.along) <= reach) return;
    reach = dot(from_middle, arm.along);
    along = arm.along;
  });
  for_each_arm([&](std::size_t i, bool b, const Arm& arm) {
    if (reach == 0 || dot(along, arm.along) < 0.99) return;
    const double s = std::min(reach, arm.length);
    const Point n = left(arm.along), aside = from_middle - s * arm.along;
    const double F = dot(load.def.force, n), M = load.def.moment + cross(aside, load.def.force);
    const double turn = (M * s + F * s * s / 2) / arm.EI;
    const double sag = (M * s * s / 2 + F * s * s * s / 3) / arm.EI + turn * (arm.length - s);
    const PlannedJoint& joint = plan_.joints[i];
    elongation.segment<3>(3 * static_cast<Index>(i)) +=
        (b ? 1 : -1) * Eigen::Vector3d(sag * dot(n, joint.axis), sag * dot(n, left(joint.axis)), turn);
  });
}

std::vector<LoadCase> Equilibrium::cases() const {
  std::set<double> starts{0};
  for (const Plan::Load& load : plan_.loads)
    if (load.def.to > 0) starts.insert(std::max(0., load.def.from));
  std::vector<LoadCase> result;
  for (const double time : starts) {
    const VectorXd none = VectorXd::Zero(B.rows());
    LoadCase& now = result.emplace_back(LoadCase{time, gravity(), VectorXd::Zero(B.cols()), none, none});
    for (const Plan::Load& each : plan_.loads)
      if (each.def.from <= time && each.def.to > time) {
        now.loads += load(each);
        bend(each, now.elongation);
      }
    for (std::size_t i = 0; i < plan_.joints.size(); ++i)
      for (const Row row : {axial, shear, rotation})
        if (held[i]) now.elongation[3 * static_cast<Index>(i) + row] -= plan_.joints[i].displacement[row];
    for (std::size_t i = 0; i < plan_.joints.size(); ++i) {
      const PlannedJoint& j = plan_.joints[i];
      if (!held[i] || !j.end) continue;
      const double drawn = length(*j.end - j.anchor), longer = drawn - j.length;  // than without force
      if (std::abs(longer) > 1e-12 * drawn) now.prestress[3 * static_cast<Index>(i)] = longer;
    }
  }
  return result;
}

ElasticState Equilibrium::elastic(const LoadCase& load_case) const {
  const VectorXd f = balanced(load_case.gravity + load_case.loads);
  const ElasticState bent = imposed(load_case.elongation);
  return {motions(f) + bent.x, forces(f) + bent.forces};
}

// The forces' energy is convex, so the set of taut lines is one: those that pull the wrong way are let go and
// those that parted too far taken back until nothing changes. A slack line keeps a trace of its stiffness
// meanwhile, or what hangs on it alone would have no place; the force in it says how near it is to being
// taut.
double Equilibrium::let_slack(const LoadCase& load_case, double factor) {
  std::vector<std::size_t> lines;
  for (std::size_t i = 0; i < plan_.joints.size(); ++i)
    if (held[i] && plan_.joints[i].carries != Carries::both) lines.push_back(i);
  if (lines.empty()) return unlimited;
  constexpr double trace = 1e-8;
  const std::vector<Root> whole = roots();
  std::vector<bool> slack(plan_.joints.size(), false);
  const auto set = [&](double of_slack) {
    std::vector<Root> now = whole;
    for (const std::size_t i : lines)
      if (slack[i]) now[i] *= std::sqrt(of_slack);
    stiffen(now);
  };
  double last = unlimited;
  for (std::size_t round = 0, changes = 1; changes > 0; ++round) {
    if (round > 20 + 2 * lines.size())
      throw InvalidInput({{"joints", "no set of taut ropes and struts balances the loads",
                           "check their lengths, or what they hold"}});
    set(trace);
    const VectorXd fixed = prestressed(load_case).forces, growing = elastic(load_case).forces;
    const double rounding = 1e-10 * (fixed + factor * growing).cwiseAbs().maxCoeff();
    changes = 0;
    last = unlimited;
    for (const std::size_t i : lines) {
      const double sense = plan_.joints[i].carries == Carries::tension ? -1 : 1;
      const Index row = 3 * static_cast<Index>(i);
      const double against = sense * (fixed[row] + factor * growing[row]);
      if (slack[i] ? against < 0 : against > rounding) {
        slack[i] = !slack[i];
        if (++changes == 1 && round > 20) break;  // one by one, should they take turns
      }
      const double turns = -fixed[row] / growing[row];
      if (fixed[row] != 0 && turns > factor) last = std::min(last, turns);
    }
  }
  set(0);
  return last;
}

Index Equilibrium::freedoms() const { return B.cols() - factors_->L.cols(); }

// With R = [Lᵀ S] the rows of A P that are not 0: of (y, z) = Pᵀ x, y = −L⁻ᵀ S z.
Eigen::MatrixXd Equilibrium::free_motions() const {
  const auto& [qr, L] = *factors_;
  const Index free = freedoms();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(B.cols(), free);
  if (free == 0) return basis;
  const SparseMatrix<double> R = qr.matrixR();
  const Eigen::MatrixXd S = R.topRightCorner(L.cols(), free);
  basis.topRows(L.cols()) = -L.transpose().triangularView<Eigen::Upper>().solve(S);
  basis.bottomRows(free).setIdentity();
  basis = (qr.colsPermutation() * basis).eval();
  for (Index i = 0; i < free; ++i)
    basis.col(i) -= motions(B.transpose() * resist(basis.col(i)));  // rounding of y
  const Eigen::HouseholderQR<Eigen::MatrixXd> orthonormal(basis);
  return orthonormal.householderQ() * Eigen::MatrixXd::Identity(B.cols(), free);
}

// With A = √k B and Y = R/√k: the least-norm solution of Aᵀ Y = f is Q L⁻¹ Pᵀ f.
VectorXd Equilibrium::least_energy(const VectorXd& f) const {
  VectorXd y = VectorXd::Zero(B.rows());
  y.head(factors_->L.cols()) = factors_->forward(f);
  const VectorXd Y = factors_->qr.matrixQ() * y;
  return root_.transpose() * Y;
}

VectorXd Equilibrium::forces(const VectorXd& f) const {
  VectorXd result = least_energy(f);
  result += least_energy(f - B.transpose() * result);
  return result;
}

VectorXd Equilibrium::motions(const VectorXd& f) const {
  const auto& [qr, L] = *factors_;
  VectorXd x = VectorXd::Zero(B.cols());
  x.head(L.cols()) = L.transpose().triangularView<Eigen::Upper>().solve(factors_->forward(f));
  return qr.colsPermutation() * x;
}

// With A = √k B and y = √k e: x minimises |A x + y|, and R = √kᵀ (A x + y), the part of y that no motion
// takes up. Rigid rows' k e itself, which all but cancels, is never formed.
ElasticState Equilibrium::imposed(const VectorXd& elongation) const {
  const auto& [qr, L] = *factors_;
  ElasticState result{VectorXd::Zero(B.cols()), VectorXd::Zero(B.rows())};
  if (elongation.isZero(0)) return result;
  const VectorXd y = root_ * elongation;
  VectorXd turned = qr.matrixQ().transpose() * y;
  const VectorXd taken = turned.head(L.cols());
  result.x.head(L.cols()) = L.transpose().triangularView<Eigen::Upper>().solve(-taken);
  result.x = qr.colsPermutation() * result.x;
  turned.head(L.cols()).setZero();
  const VectorXd rest = qr.matrixQ() * turned;
  result.forces = root_.transpose() * rest;
  result.forces -= least_energy(B.transpose() * result.forces);
  return result;
}

double Equilibrium::flexibility(const Eigen::SparseVector<double>& c) const {
  return factors_->forward(c).squaredNorm();
}

namespace {
bool is_rounding(const VectorXd& rest, const VectorXd& f) {
  return rest.cwiseAbs().maxCoeff() <= 1e-6 * f.cwiseAbs().maxCoeff();
}
}  // namespace

bool Equilibrium::bears(const VectorXd& f) const { return is_rounding(f - B.transpose() * forces(f), f); }

VectorXd Equilibrium::balanced(const VectorXd& f) const {
  VectorXd kept = B.transpose() * forces(f);
  if (!is_rounding(f - kept, f)) {
    Index worst = 0;
    (f - kept).cwiseAbs().maxCoeff(&worst);
    const auto piece =
        static_cast<std::size_t>(std::find(column.begin(), column.end(), worst / 3 * 3) - column.begin());
    throw InvalidInput({{"piece '" + plan_.pieces[piece].name + "'",
                         "the loads move it, and no joint resists: the structure is a mechanism",
                         "add a support, or give a free row of its joints a capacity"}});
  }
  return kept;
}

}  // namespace ductile
