// A joint's yield surface in a round of the interior point method: p = t − a·s ≥ 0 of its facets and, with
// shear, p = ½ (1 − t² − q²) ≥ 0 of a cone, with t the share of the surface that N and M may take, and
// q = s_Q / hQ_max.
//
// The curvature of a joint is C = BᵀB, with a row of B for each unknown, 1/√G, and for each bound, √(z/p) a.
// With B = QR the solution of C x = y and what it means for the bounds, B x, come of Q alone, and as
// accurately for rows of any weight: B x = Q Q₀ᵀ root⁻¹ y, Q₀ the rows of the unknowns.
#pragma once

#include <algorithm>
#include <span>

#include "interior_round.h"
#include "weighted_rows.h"

namespace ductile::dynamics {

class SurfaceRows {
 public:
  /// An inequality p ≥ 0, its multiplier z ≥ 0, and what a round changes them by.
  struct Bound {
    Row4 a{};  // −∂p/∂(s, t)
    double p = 0, z = 0, dp = 0, dz = 0;
    double missing = 0;  // what p is short of the function that it stands for: that of a cone is curved
    double weight = 0;   // √(z/p)
    double aim = 0;      // √(…) times what p is to fall by, for z p to become μ
    Row4 q{};            // its row of Q
  };
  /// For orthogonalise(): as many as there are bounds, and 4.
  struct Scratch {
    std::span<Row4> rows;
    std::span<std::size_t> order;
  };
  static std::size_t most_bounds(const YieldSurface& surface) { return surface.facets().size() + 1; }

  /// From impulses that are drawn within the surface, into `room` for most_bounds(); as CappedRows.
  void enter(const Joint& joint, const JointRecord& record, const Rows& s, const Rows& m_eff, double inside,
             std::span<Bound> room);
  void centre(double mu);
  Rows impulse() const { return {x_[0], x_[1], x_[2]}; }
  std::size_t count() const { return bounds_.size(); }
  void measure(const Rows& x, Distance& d);
  Coupling eliminate(const Scratch& scratch);
  Rows aim(double mu, double second_order);
  void direct(const Rows& change, Direction& direction);
  void move(double step);
  unsigned regime() const;

 private:
  Row4 project(const Row4& y) const;
  double cone_lack() const;
  bool holds(std::size_t row) const { return G_[row] > 0; }
  double compliance(std::size_t row) const { return std::max(1 / G_[row], least_compliance(m_eff_[row])); }

  std::span<Bound> bounds_;  // the cone is the last
  Row4 x_{}, dx_{};          // (s, t)
  Row4 lack_{};              // J v + b − s/G − Σ z a, which is to vanish; and −Σ z a on t
  Row4 root_{};              // roots of the curvature without bounds: 1/√G (least_compliance())
  std::array<Row4, 4> q_{};  // its rows of Q
  Rows G_{}, m_eff_{};
  double shear_ = 0;  // h Q_max; 0: no cone
};

}  // namespace ductile::dynamics
