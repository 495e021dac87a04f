// Collapse by the lower bound theorem: the largest λ for which some forces R are in equilibrium with λ times
// the loads, Bᵀ R = f₀ + λ f₁, and no joint is beyond yield. A linear programme; its dual variables are the
// velocities of the mechanism.
//
// The yield surface g(N, M)² + (Q/Q_max)² ≤ 1 is round in Q. It is cut out plane by plane: where a solution
// lies outside, the tangent plane below it is added, until all lie inside.
#include <glpk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "deformed.h"
#include "ductile/design.h"
#include "equilibrium.h"
#include "simplex.h"
#include "units.h"
#include "yield.h"

namespace ductile {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double on_surface = 1e-8;        // a joint may use so much more than all of its surface
constexpr double share_of_a_hinge = 1e-6;  // of the power that the mechanism dissipates

[[noreturn]] void refuse(const char* what, const char* remedy) {
  throw InvalidInput({{"loads", what, remedy}});
}

class Programme {
 public:
  Programme(const Plan& plan, const Equilibrium& statics, const std::vector<Yield>& yields,
            const VectorXd& fixed, const VectorXd& scaled)
      : plan_(plan),
        statics_(statics),
        yields_(yields),
        units_(yields),
        problem_(glp_create_prob(), glp_delete_prob) {
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_.get(), GLP_MAX);
    add_variables();
    add_equilibrium(fixed, scaled);
  }

  LimitAnalysis solve() {
    glp_smcp settings = simplex_settings();
    settings.presolve = GLP_OFF;
    glp_adv_basis(problem_.get(), 0);
    do {
      if (glp_simplex(problem_.get(), &settings) != 0)
        throw std::runtime_error("limit analysis: the linear programme was not solved");
      switch (glp_get_status(problem_.get())) {
        case GLP_OPT:
          break;
        case GLP_UNBND:
          return {};
        case GLP_NOFEAS:
          refuse("cannot be carried, even times 0: gravity alone makes the structure collapse",
                 "let gravity grow with the loads (without --fixed-gravity), or strengthen the structure");
        default:
          throw std::runtime_error("limit analysis: the linear programme was not solved");
      }
      settings.meth = GLP_DUALP;  // cuts leave the last solution optimal, but not feasible
    } while (cut());
    const VectorXd velocity = velocities();
    return {.load_factor = glp_get_col_prim(problem_.get(), load_factor) * load_unit_,
            .hinges = hinges(velocity),
            .mechanism = shape_of(plan_, statics_, velocity)};
  }

 private:
  static constexpr int load_factor = 1;  // its column

  void add_variables() {
    glp_add_cols(problem_.get(), 1);
    glp_set_col_bnds(problem_.get(), load_factor, GLP_LO, 0, 0);
    glp_set_obj_coef(problem_.get(), load_factor, 1);
    variable_.assign(3 * yields_.size(), 0);
    for (std::size_t i = 0; i < yields_.size(); ++i)
      for (const Row row : {axial, shear, rotation}) {
        if (!statics_.held[i] || yields_[i].is_free(row)) continue;
        const int v = variable_[3 * i + row] = glp_add_cols(problem_.get(), 1);
        const double high = yields_[i].reach(row, false) / units_.of(row),
                     low = -yields_[i].reach(row, true) / units_.of(row);
        const bool top = high<unlimited, bottom = low> - unlimited;
        glp_set_col_bnds(problem_.get(), v,
                         top && bottom ? (low < high ? GLP_DB : GLP_FX)
                         : top         ? GLP_UP
                         : bottom      ? GLP_LO
                                       : GLP_FR,
                         low, high);
      }
  }

  // One row for each column of B, in forces and moments.
  void add_equilibrium(const VectorXd& fixed, const VectorXd& scaled) {
    unit_.resize(scaled.size());
    for (std::size_t p = 0; p < statics_.column.size(); ++p) {
      if (statics_.column[p] < 0) continue;
      const auto s = statics_.scale(static_cast<int>(p));
      for (int c = 0; c < 3; ++c)
        unit_[statics_.column[p] + c] = s[static_cast<std::size_t>(c)] * units_.of(c);
    }
    load_unit_ = 1 / scaled.cwiseQuotient(unit_).cwiseAbs().maxCoeff();
    glp_add_rows(problem_.get(), static_cast<int>(scaled.size()));
    for (Index c = 0; c < scaled.size(); ++c) {
      std::vector<int> columns{0};  // GLPK counts from 1
      std::vector<double> values{0};
      for (Eigen::SparseMatrix<double>::InnerIterator it(statics_.B, c); it; ++it) {
        columns.push_back(variable_[static_cast<std::size_t>(it.row())]);
        values.push_back(it.value() * units_.of(static_cast<int>(it.row() % 3)) / unit_[c]);
      }
      if (const double load = scaled[c] / unit_[c] * load_unit_; load != 0) {
        columns.push_back(load_factor);
        values.push_back(-load);
      }
      const int row = static_cast<int>(c) + 1;
      glp_set_mat_row(problem_.get(), row, static_cast<int>(columns.size()) - 1, columns.data(),
                      values.data());
      glp_set_row_bnds(problem_.get(), row, GLP_FX, fixed[c] / unit_[c], 0);
    }
  }

  double force(std::size_t joint, Row row) const {
    const int v = variable_[3 * joint + row];
    return v == 0 ? 0 : glp_get_col_prim(problem_.get(), v) * units_.of(row);
  }

  // Adds the tangent planes that the solution violates; false where there are none.
  bool cut() {
    bool any = false;
    for (std::size_t i = 0; i < yields_.size(); ++i) {
      const Yield& yield = yields_[i];
      if (yield.facets.empty() || !statics_.held[i]) continue;
      const std::array<double, 3> R{force(i, axial), force(i, shear), force(i, rotation)};
      const double used = yield.usage(R);
      if (used <= 1 + on_surface) continue;
      any = true;
      // At (p, q)/used on the unit circle, p of the steepest facet and q of shear.
      const Yield::Facet& facet = yield.steepest(R[0], R[2]);
      const double p = (facet.n * R[0] + facet.m * R[2]) / used, Q = yield.cap(shear, false);
      const double q = Q > 0 ? R[1] / Q / used : 0;
      const std::array<double, 3> normal{p * facet.n, Q > 0 ? q / Q : 0, p * facet.m};
      std::vector<int> columns{0};
      std::vector<double> values{0};
      for (const Row row : {axial, shear, rotation}) {
        if (variable_[3 * i + row] == 0 || normal[row] == 0) continue;
        columns.push_back(variable_[3 * i + row]);
        values.push_back(normal[row] * units_.of(row));
      }
      const int plane = glp_add_rows(problem_.get(), 1);
      glp_set_mat_row(problem_.get(), plane, static_cast<int>(columns.size()) - 1, columns.data(),
                      values.data());
      glp_set_row_bnds(problem_.get(), plane, GLP_UP, 0, 1);
    }
    return any;
  }

  // Of the mechanism, as B's columns: the duals of equilibrium.
  VectorXd velocities() const {
    VectorXd velocity(unit_.size());
    for (Index c = 0; c < unit_.size(); ++c)
      velocity[c] = -glp_get_row_dual(problem_.get(), static_cast<int>(c) + 1) / unit_[c];
    return velocity;
  }

  // Joints whose rows move in the mechanism and dissipate.
  std::vector<int> hinges(const VectorXd& velocity) const {
    const VectorXd slip = statics_.B * velocity;
    std::vector<double> power;
    double all = 0;
    for (std::size_t i = 0; i < yields_.size(); ++i) {
      power.push_back(0);
      for (const Row row : {axial, shear, rotation})
        power[i] += force(i, row) * slip[3 * static_cast<Index>(i) + row];
      all += std::abs(power[i]);
    }
    std::vector<int> result;
    for (std::size_t i = 0; i < yields_.size(); ++i)
      if (std::abs(power[i]) > share_of_a_hinge * all) result.push_back(static_cast<int>(i));
    return result;
  }

  const Plan& plan_;
  const Equilibrium& statics_;
  const std::vector<Yield>& yields_;
  Units units_;
  VectorXd unit_;  // of B's columns: what a row of the programme is divided by
  double load_unit_ = 1;
  std::unique_ptr<glp_prob, decltype(&glp_delete_prob)> problem_;
  std::vector<int> variable_;  // of 3·joint + row: its column; 0: none
};

}  // namespace

LimitAnalysis limit_analysis(const Plan& plan, bool fixed_gravity) {
  const Equilibrium statics(plan);
  std::vector<Yield> yields;
  for (const PlannedJoint& joint : plan.joints) yields.emplace_back(plan, joint);
  LimitAnalysis worst;
  bool loaded = false;
  for (const LoadCase& load_case : statics.cases()) {
    const VectorXd gravity = statics.balanced(load_case.gravity), loads = statics.balanced(load_case.loads);
    const VectorXd scaled = fixed_gravity ? loads : VectorXd(gravity + loads);
    if (scaled.cwiseAbs().maxCoeff() == 0) continue;
    loaded = true;
    const VectorXd fixed = fixed_gravity ? gravity : VectorXd(VectorXd::Zero(scaled.size()));
    LimitAnalysis now = Programme(plan, statics, yields, fixed, scaled).solve();
    now.time = load_case.time;
    if (now.load_factor < worst.load_factor) worst = std::move(now);
  }
  if (!loaded)
    refuse("are none: there is nothing to multiply",
           plan.settles()  ? "follow supports that are displaced by --second-order"
           : fixed_gravity ? "give the scene loads, or let gravity grow too"
                           : "give the scene gravity or loads");
  return worst;
}

}  // namespace ductile
