#include "response.h"

#include <algorithm>
#include <cmath>

#include "around.h"
#include "buckling.h"
#include "ductile/plane.h"
#include "groups.h"

namespace ductile {

using Eigen::Index;
using Eigen::SparseVector;
using Eigen::VectorXd;

Response::Response(const Plan& plan, double impact)
    : plan_(plan), statics_(plan), rows_(statics_.B), impact_(impact + energy_around(plan, statics_.loose)) {
  find_structures();
  leverage_ = VectorXd::Constant(statics_.B.rows(), -1);
  double energy = impact_;  // a structure that is thrown is not bounded
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    if (statics_.column[i] < 0 || plan.pieces[i].part_of >= 0) continue;
    const BodyDef& body = plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)];
    if (body.velocity != Point{} || body.angular_velocity != 0 || !body.velocities.empty())
      energy = unlimited;
  }
  swing_.assign(swing_.size(), std::sqrt(2 * energy));
  strain_.assign(swing_.size(), 0);

  if (plan.settles())
    throw InvalidInput({{"supports", "their ground moves, which no bound of what joints carry looks at",
                         "leave nothing out of this scene, or set the displacements to 0"}});
  add(statics_.gravity(), plan.gravity_ramp, false);
  for (const Plan::Load& load : plan.loads) add(statics_.load(load), load.def.ramp, load.def.to < unlimited);
  lean();
}

void Response::lean() {
  VectorXd forces = VectorXd::Zero(statics_.B.rows());
  for (const Answer& answer : answers_) forces += answer.forces;
  const GeometricStiffness K_g =
      geometric_stiffness(plan_, statics_, forces, [](const Plan::Load&) { return 1.; });
  for (std::size_t s = 0; s < swing_.size(); ++s) {
    VectorXd start(statics_.B.cols());  // some of every mode
    for (Index c = 0; c < start.size(); ++c)
      start[c] = of_column_[static_cast<std::size_t>(c)] == static_cast<int>(s)
                     ? std::cos(static_cast<double>(c))
                     : 0;
    const double mu = buckling(statics_, K_g, start).inverse_factor;
    swing_[s] = mu < 1 ? swing_[s] / std::pow(1 - mu, 1.5) + mu / (1 - mu) * strain_[s] : unlimited;
  }
}

void Response::find_structures() {
  const std::size_t n = plan_.pieces.size();
  Groups groups(n);
  const auto moves = [&](int piece) {
    return piece >= 0 && statics_.column[static_cast<std::size_t>(piece)] >= 0;
  };
  for (const PlannedJoint& j : plan_.joints)
    if (moves(j.a) && moves(j.b)) groups.unite(static_cast<std::size_t>(j.a), static_cast<std::size_t>(j.b));
  for (std::size_t i = 0; i < n; ++i)
    if (moves(static_cast<int>(i)) && plan_.pieces[i].part_of >= 0)
      groups.unite(static_cast<std::size_t>(plan_.pieces[i].part_of), i);
  structure_.assign(n, -1);
  of_column_.assign(static_cast<std::size_t>(statics_.B.cols()), -1);
  std::vector<int> number(n, -1);
  int count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!moves(static_cast<int>(i))) continue;
    int& own = number[groups.of(i)];
    if (own < 0) own = count++;
    structure_[i] = own;
    std::fill_n(of_column_.begin() + statics_.column[i], 3, own);
  }
  swing_.resize(static_cast<std::size_t>(count));
}

void Response::add(const VectorXd& load, double ramp, bool ends) {
  const VectorXd f = statics_.balanced(load);
  Answer& answer = answers_.emplace_back(Answer{statics_.motions(f), statics_.forces(f)});
  std::vector<double> work(swing_.size()), square(swing_.size());  // xᵀ K x = f·x, and xᵀ M x
  for (Index c = 0; c < f.size(); ++c) {
    const auto s = static_cast<std::size_t>(of_column_[static_cast<std::size_t>(c)]);
    work[s] += f[c] * answer.motion[c];
    square[s] += answer.motion[c] * answer.motion[c];
  }
  for (std::size_t s = 0; s < swing_.size(); ++s) {
    const double at_once = std::sqrt(std::max(0.0, work[s]));
    const double slowly = ramp > 0 ? 2 * std::sqrt(square[s]) / ramp : unlimited;
    strain_[s] += at_once;
    swing_[s] += std::min(at_once, slowly) + (ends ? at_once : 0);
  }
}

double Response::rest(int row) const {
  double low = 0, high = 0;  // loads act or do not
  for (const Answer& answer : answers_) {
    const double value = answer.forces[row];
    (value < 0 ? low : high) += value;
  }
  return std::max(-low, high);
}

double Response::force(int row) const {
  const PlannedJoint& joint = plan_.joints[static_cast<std::size_t>(row / 3)];
  int structure = -1;
  for (const int piece : {joint.a, joint.b})
    if (piece >= 0 && structure_[static_cast<std::size_t>(piece)] >= 0)
      structure = structure_[static_cast<std::size_t>(piece)];
  const double k = statics_.stiffness()[row];
  if (structure < 0 || k == 0) return 0;
  if (swing_[static_cast<std::size_t>(structure)] == unlimited) return unlimited;
  double& h = leverage_[row];
  if (h < 0) {
    h = std::min(k * statics_.flexibility(rows_.row(row).transpose()), 1.0);
  }
  return rest(row) + swing_[static_cast<std::size_t>(structure)] * std::sqrt(k * h);
}

SparseVector<double> Response::functional(int piece, Point at, bool along_y) const {
  SparseVector<double> c(statics_.B.cols());
  const int column = statics_.column[static_cast<std::size_t>(piece)];
  if (column < 0) return c;
  const Point arm = at - plan_.carrier(piece).center;
  const auto s = statics_.scale(piece);
  c.insert(column + along_y) = s[along_y];
  c.insert(column + 2) = s[2] * (along_y ? arm.x : -arm.y);
  return c;
}

double Response::swing(const SparseVector<double>& c, int piece) const {
  const int s = structure_[static_cast<std::size_t>(piece)];
  return s < 0 ? 0 : swing_[static_cast<std::size_t>(s)] * std::sqrt(statics_.flexibility(c));
}

double Response::apart(const Response* lean, int piece, Point at) const {
  double square = 0;
  for (const bool along_y : {false, true}) {
    const SparseVector<double> c = functional(piece, at, along_y);
    const SparseVector<double> d = lean ? lean->functional(piece, at, along_y) : SparseVector<double>();
    double low = 0, high = 0;
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      const double value = c.dot(answers_[i].motion) - (lean ? d.dot(lean->answers_[i].motion) : 0);
      (value < 0 ? low : high) += value;
    }
    const double most = std::max(-low, high) + swing(c, piece) + (lean ? lean->swing(d, piece) : 0);
    square += most * most;
  }
  return std::sqrt(square);
}

}  // namespace ductile
