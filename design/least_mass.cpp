// Plastic design for least mass (Foulkes 1953, Heyman 1951), as a linear programme.
//
// With depths d_g = s_g d_g⁰ of groups of bodies, masses, weights and what sections bear all grow with s_g,
// so that
//   minimise Σ m_g s_g   with   Bᵀ R = λ (f + Σ s_g w_g),   R_i ≤ s_g c_gi
// is linear: R any forces in equilibrium with λ times loads f and weights w_g (lower bound theorem), c_gi
// what row i of a joint bears on the side of group g. At the least mass the frame collapses in a mechanism,
// or several at once, whose hinges in each group dissipate in proportion to its mass (Foulkes' condition: the
// programme's dual).
#include <glpk.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ductile/targets.h"
#include "equilibrium.h"
#include "simplex.h"
#include "units.h"

namespace ductile {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double thinnest = 1e-3;  // of what is drawn
constexpr double strong = 1e6;     // times as much: governs nothing

// Which group a body is in; −1: none.
std::vector<int> groups_of(const SceneDef& scene, const std::vector<std::vector<std::size_t>>& groups) {
  std::vector<int> group(scene.bodies.size(), -1);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const std::size_t body : groups[g]) {
      const BodyDef& def = scene.bodies[body];
      if (!def.profile.empty() || def.type != BodyType::dynamic_body)
        throw InvalidInput({{"body '" + def.name + "'", "has no depth that could be less, or does not move",
                             "choose bodies with a depth"}});
      if (group[body] >= 0)
        throw InvalidInput({{"body '" + def.name + "'", "is in two groups", "name it once"}});
      group[body] = static_cast<int>(g);
    }
  return group;
}

void strengthen(BodyDef& body) {
  if (body.material) scale_strength(*body.material, strong);
  for (Region& region : body.profile) scale_strength(region.material, strong);
}

// What the joints' rows bear, both senses, by section of one group alone, at its drawn depth times `depth`;
// of group −1: of all that is in no group, and of what joints are given.
class Caps {
 public:
  Caps(const SceneDef& scene, const std::vector<int>& group, int of, double depth)
      : plan_(calibrate(changed(scene, group, of, depth))) {}
  const PlannedJoint& operator[](std::size_t joint) const { return plan_.joints[joint]; }

 private:
  static SceneDef changed(SceneDef scene, const std::vector<int>& group, int of, double depth) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (group[i] != of) strengthen(scene.bodies[i]);
      if (group[i] == of && of >= 0) scene.bodies[i].depth *= depth;
    }
    return scene;
  }
  Plan plan_;
};

class LeastMassProgramme {
 public:
  LeastMassProgramme(const SceneDef& scene, const std::vector<int>& group, std::size_t groups)
      : plan_(calibrate(scene)),
        statics_(plan_),
        units_(yields(plan_)),
        group_(group),
        problem_(glp_create_prob(), glp_delete_prob) {
    if (plan_.interaction)
      throw InvalidInput({{"scene", "has \"interaction\", and this programme independent caps",
                           "leave \"interaction\" out, and check what it gives by ductile limit"}});
    glp_term_out(GLP_OFF);
    glp_set_obj_dir(problem_.get(), GLP_MIN);
    add_shares(groups);
    for (const LoadCase& load_case : statics_.cases()) cases_.push_back({load_case, add_forces()});
    limit_by(Caps(scene, group, -1, 1), nullptr, 0);
    for (std::size_t g = 0; g < groups; ++g) {
      const int of = static_cast<int>(g);
      const Caps twice(scene, group, of, 2);
      limit_by(Caps(scene, group, of, 1), &twice, of);
    }
  }

  /// Of each group, how many times its drawn depth.
  std::vector<double> solve(double collapse) {
    for (const Case& each : cases_) add_equilibrium(each, collapse);
    const glp_smcp settings = simplex_settings();
    glp_adv_basis(problem_.get(), 0);
    if (glp_simplex(problem_.get(), &settings) != 0 ||
        (glp_get_status(problem_.get()) != GLP_OPT && glp_get_status(problem_.get()) != GLP_NOFEAS))
      throw std::runtime_error("least mass: the linear programme was not solved");
    if (glp_get_status(problem_.get()) == GLP_NOFEAS)
      throw InvalidInput({{"target",
                           "no depths of these bodies bear it: other bodies, or what joints are "
                           "given, govern, or gravity grows with the depths",
                           "change those, or the target"}});
    std::vector<double> shares;
    for (std::size_t g = 0; g < mass_.size(); ++g)
      shares.push_back(glp_get_col_prim(problem_.get(), share(static_cast<int>(g))));
    return shares;
  }

 private:
  struct Case {
    LoadCase load;
    std::vector<int> force;  // of 3·joint + row: its column; 0: none
  };

  static std::vector<Yield> yields(const Plan& plan) {
    std::vector<Yield> yields;
    for (const PlannedJoint& joint : plan.joints) yields.emplace_back(plan, joint);
    return yields;
  }
  static int share(int group) { return group + 1; }
  int group_of(std::size_t piece) const { return group_[static_cast<std::size_t>(plan_.pieces[piece].body)]; }

  void add_shares(std::size_t groups) {
    mass_.resize(groups);
    for (std::size_t i = 0; i < plan_.pieces.size(); ++i)
      if (group_of(i) >= 0) mass_[static_cast<std::size_t>(group_of(i))] += plan_.pieces[i].mass;
    double all = 0;
    for (const double mass : mass_) all += mass;
    glp_add_cols(problem_.get(), static_cast<int>(groups));
    for (std::size_t g = 0; g < groups; ++g) {
      glp_set_col_bnds(problem_.get(), share(static_cast<int>(g)), GLP_LO, thinnest, 0);
      glp_set_obj_coef(problem_.get(), share(static_cast<int>(g)), mass_[g] / all);
    }
  }

  std::vector<int> add_forces() {
    std::vector<int> force(3 * plan_.joints.size());
    for (std::size_t i = 0; i < plan_.joints.size(); ++i)
      for (const Row row : {axial, shear, rotation}) {
        if (!statics_.held[i] || is_free(plan_.joints[i], row)) continue;
        force[3 * i + row] = glp_add_cols(problem_.get(), 1);
        glp_set_col_bnds(problem_.get(), force[3 * i + row], GLP_FR, 0, 0);
      }
    return force;
  }

  void add_row(const std::vector<std::pair<int, double>>& entries, int kind, double bound) {
    std::vector<int> columns{0};  // GLPK counts from 1
    std::vector<double> values{0};
    for (const auto& [column, value] : entries) {
      columns.push_back(column);
      values.push_back(value);
    }
    const int row = glp_add_rows(problem_.get(), 1);
    glp_set_mat_row(problem_.get(), row, static_cast<int>(entries.size()), columns.data(), values.data());
    glp_set_row_bnds(problem_.get(), row, kind, bound, bound);
  }

  // |R| within the caps; in proportion to the group's depth where they double with it.
  void limit_by(const Caps& caps, const Caps* twice, int group) {
    for (std::size_t i = 0; i < plan_.joints.size(); ++i)
      for (const Row row : {axial, shear, rotation})
        for (const bool reverse : {false, true}) {
          const double unit = units_.of(row), c = cap(caps[i], row, reverse);
          if (c == unlimited || c > strong / 10 * cap(plan_.joints[i], row, reverse)) continue;
          if (twice && std::abs(cap((*twice)[i], row, reverse) / c - 2) > 1e-9) continue;
          for (const Case& each : cases_) {
            const int force = each.force[3 * i + row];
            if (force == 0) continue;
            if (twice)
              add_row({{force, reverse ? -1 : 1}, {share(group), -c / unit}}, GLP_UP, 0);
            else
              add_row({{force, reverse ? -1 : 1}}, GLP_UP, c / unit);
          }
        }
  }

  void add_equilibrium(const Case& now, double collapse) {
    VectorXd unit(statics_.B.cols());
    std::vector<VectorXd> weight(mass_.size(), VectorXd::Zero(unit.size()));
    VectorXd fixed = statics_.balanced(now.load.loads);
    for (std::size_t p = 0; p < plan_.pieces.size(); ++p) {
      if (statics_.column[p] < 0) continue;
      const auto s = statics_.scale(static_cast<int>(p));
      for (int c = 0; c < 3; ++c)
        unit[statics_.column[p] + c] = s[static_cast<std::size_t>(c)] * units_.of(c);
      VectorXd& own = group_of(p) < 0 ? fixed : weight[static_cast<std::size_t>(group_of(p))];
      statics_.add(own, static_cast<int>(p),
                   Point{plan_.pieces[p].mass * plan_.gravity.x, plan_.pieces[p].mass * plan_.gravity.y}, 0);
    }
    for (Index c = 0; c < unit.size(); ++c) {
      std::vector<std::pair<int, double>> entries;
      for (Eigen::SparseMatrix<double>::InnerIterator it(statics_.B, c); it; ++it)
        if (const int force = now.force[static_cast<std::size_t>(it.row())]; force != 0)
          entries.emplace_back(force, it.value() * units_.of(static_cast<int>(it.row() % 3)) / unit[c]);
      for (std::size_t g = 0; g < weight.size(); ++g)
        if (weight[g][c] != 0)
          entries.emplace_back(share(static_cast<int>(g)), -collapse * weight[g][c] / unit[c]);
      add_row(entries, GLP_FX, collapse * fixed[c] / unit[c]);
    }
  }

  Plan plan_;
  Equilibrium statics_;
  Units units_;
  const std::vector<int>& group_;
  std::vector<double> mass_;  // of groups, as drawn
  std::vector<Case> cases_;
  std::unique_ptr<glp_prob, decltype(&glp_delete_prob)> problem_;
};

}  // namespace

LeastMass least_mass(const SceneDef& scene, const std::vector<std::vector<std::size_t>>& groups,
                     double collapse) {
  if (!(collapse > 0 && collapse < unlimited))
    throw InvalidInput({{"target", "is not above 0 and finite", "give a factor such as 1.5"}});
  const std::vector<int> group = groups_of(scene, groups);
  const std::vector<double> shares = LeastMassProgramme(scene, group, groups.size()).solve(collapse);
  LeastMass result{.scene = scene};
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (group[i] >= 0) result.scene.bodies[i].depth *= shares[static_cast<std::size_t>(group[i])];
  const Plan plan = calibrate(result.scene);
  result.mass = measured(plan, Measure::mass);
  result.collapse = measured(plan, Measure::collapse);
  return result;
}

}  // namespace ductile
