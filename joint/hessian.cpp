#include "hessian.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "kinematics.h"

namespace ductile::dynamics {

namespace {

// block += leftᵀ right, with left.w = (0, 0, ±1)
inline void add_product(Block& block, const JacobianRows& left, const JacobianRows& right) {
  const Vec3 rows[3] = {left.u.x * right.u + left.v.x * right.v, left.u.y * right.u + left.v.y * right.v,
                        left.u.w * right.u + left.v.w * right.v + left.w.w * right.w};
  for (std::size_t r = 0; r < 3; ++r) {
    block.a[3 * r] += rows[r].x;
    block.a[3 * r + 1] += rows[r].y;
    block.a[3 * r + 2] += rows[r].w;
  }
}

// Likewise, of a row each.
void add_product(Block& block, double by, const Vec3& left, const Vec3& right) {
  const double rows[3] = {by * left.x, by * left.y, by * left.w};
  for (std::size_t r = 0; r < 3; ++r) {
    block.a[3 * r] += rows[r] * right.x;
    block.a[3 * r + 1] += rows[r] * right.y;
    block.a[3 * r + 2] += rows[r] * right.w;
  }
}

// Without the columns of a body that does not rotate.
JacobianRows of_body(JacobianRows rows, const Body& body) {
  if (body.inertia > 0) return rows;
  rows.u.w = rows.v.w = rows.w.w = 0;
  return rows;
}

}  // namespace

void Hessian::analyse(System& system) {
  Vector<std::pair<int, int>> edges;
  edges.reserve(system.joints.size() + system.pairs.size());
  for (const Joint& j : system.joints) {
    if (system.is_free(j.a) && system.is_free(j.b)) edges.emplace_back(j.a, j.b);
  }
  edges.insert(edges.end(), system.pairs.begin(), system.pairs.end());
  const auto has = [this](const auto& edge) {
    return ldlt_.has(std::max(edge.first, edge.second), std::min(edge.first, edge.second));
  };
  if (z(ldlt_.size()) != system.free || !std::all_of(edges.begin(), edges.end(), has))
    ldlt_.analyse(static_cast<int>(system.free), edges);
  for (Joint& j : system.joints) {
    j.block = system.is_free(j.a) && system.is_free(j.b) ? block(j.a, j.b) : -1;
  }
  forget();
}

void Hessian::begin_step() {
  if (factored_ == Factored::tangents || factored_ == Factored::secants) factored_ = Factored::earlier;
}

void Hessian::factor_tangents(System& system, bool secants) {
  for (Joint& j : system.joints) {
    JointRecord& r = system.record(j);
    Rows slope;
    for (unsigned i = 0; i < 3; ++i) {
      slope[i] = tangent(r.law, j.regime, i);
      if (secants && flows(j.regime, i) && j.regime != on_surface)
        slope[i] = std::max(slope[i], j.impulse[i] / r.x[i]);
    }
    r.tangent = {.nn = slope[0], .qq = slope[1], .mm = slope[2]};
    if (j.regime == on_surface) {
      r.tangent = r.law.surface->tangent(j.G, r.law.share * r.law.h,
                                         {j.G[0] * r.x[0], j.G[1] * r.x[1], j.G[2] * r.x[2]});
    }
    j.factored_flow = static_cast<std::uint8_t>(flowing(j.regime));
  }
  refactor(system);
  factored_ = secants ? Factored::secants : Factored::tangents;
}

void Hessian::factor_holding(System& system, int changed) {
  const std::size_t own = system.own();
  bool holds_already = factored_ == Factored::holding || (factored_ != Factored::nothing && changed == 0);
  for (const Joint& j : system.joints) {
    JointRecord& r = system.record(j);
    Rows stiff;
    for (unsigned i = 0; i < 3; ++i) {
      const bool holds = j.G[i] > 0 && !flows(j.regime, i) && system.index(j) < own;
      stiff[i] = !holds ? 0 : is_rigid(r, i) ? j.G[i] : rigid_ratio * r.m_eff[i];
    }
    holds_already &= r.tangent.nn == stiff[0] && r.tangent.qq == stiff[1] && r.tangent.mm == stiff[2] &&
                     j.regime != on_surface;
    r.tangent = {.nn = stiff[0], .qq = stiff[1], .mm = stiff[2]};
  }
  if (holds_already && (factored_ == Factored::holding || system.turn_inertias.empty())) return;
  refactor(system, false);
  factored_ = Factored::holding;
}

void Hessian::refactor(const System& system, bool turn_inertias) {
  assemble(system, turn_inertias);
  ldlt_.factor();
}

void Hessian::factor_following(const System& system, std::span<const double> follows) {
  assemble(system, true);
  lu_.take(ldlt_);
  const std::size_t first = system.first_contact();
  for (std::size_t k = first; k < system.joints.size(); ++k) {
    const double by = follows[k - first];
    if (by == 0) continue;
    const Joint& j = system.joints[k];
    const JacobianRows a = of_body(rows_of_a(j.J), system.bodies[z(j.a)]);
    const JacobianRows b = of_body(rows_of_b(j.J), system.bodies[z(j.b)]);
    if (system.is_free(j.a)) add_product(lu_.diagonal(j.a), by, a.v, a.u);
    if (system.is_free(j.b)) add_product(lu_.diagonal(j.b), by, b.v, b.u);
    if (j.block < 0) continue;
    const JacobianRows &later = j.a > j.b ? a : b, &earlier = j.a > j.b ? b : a;
    add_product(lu_.lower(j.block), by, later.v, earlier.u);
    add_product(lu_.excess(j.block), by, later.u, earlier.v);
    add_product(lu_.excess(j.block), -by, later.v, earlier.u);
  }
  lu_.factor(ldlt_);
  factored_ = Factored::nothing;
}

// H without its factorisation.
void Hessian::assemble(const System& system, bool turn_inertias) {
  ldlt_.clear();
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    double* d = ldlt_.diagonal(static_cast<int>(i)).a;
    d[0] = d[4] = b.mass;
    d[8] = b.inertia > 0 ? b.inertia : 1;
  }
  for (const Joint& j : system.joints) {
    const Coupling& D = system.record(j).tangent;
    const JacobianRows a = of_body(rows_of_a(j.J), system.bodies[z(j.a)]);
    const JacobianRows b = of_body(rows_of_b(j.J), system.bodies[z(j.b)]);
    const auto scaled = [&D](const JacobianRows& rows) {
      JacobianRows d{D.nn * rows.u, D.qq * rows.v, D.mm * rows.w};
      if (D.nq != 0 || D.nm != 0 || D.qm != 0) {
        d.u += D.nq * rows.v + D.nm * rows.w;
        d.v += D.nq * rows.u + D.qm * rows.w;
        d.w += D.nm * rows.u + D.qm * rows.v;
      }
      return d;
    };
    const JacobianRows da = scaled(a), db = scaled(b);
    if (system.is_free(j.a)) add_product(ldlt_.diagonal(j.a), a, da);
    if (system.is_free(j.b)) add_product(ldlt_.diagonal(j.b), b, db);
    if (j.block >= 0) add_product(ldlt_.block(j.block), j.a > j.b ? a : b, j.a > j.b ? db : da);
  }
  for (const TurnInertia& t : system.turn_inertias) {
    if (!turn_inertias) break;
    const Vec3 a = of_body({.u = t.row_a}, system.bodies[z(t.a)]).u;
    const Vec3 b = of_body({.u = t.row_b}, system.bodies[z(t.b)]).u;
    if (system.is_free(t.a)) add_product(ldlt_.diagonal(t.a), t.inertia, a, a);
    if (system.is_free(t.b)) add_product(ldlt_.diagonal(t.b), t.inertia, b, b);
    if (t.block >= 0) add_product(ldlt_.block(t.block), t.inertia, t.a > t.b ? a : b, t.a > t.b ? b : a);
  }
}

}  // namespace ductile::dynamics
