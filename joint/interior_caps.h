// The caps of a joint's rows in a round of the interior point method: p = c ∓ s + ηz ≥ 0, z p = μ.
//
// Caps couple no rows: what the two of a row make of a change of its impulse is one number,
//   Δs = D (lack + J Δv + τ⁺ − τ⁻)      1/D = 1/G + z⁺/(p⁺ + ηz⁺) + z⁻/(p⁻ + ηz⁻)      τ = (z p − μ)/(p + ηz)
//   Δz = ± z/(p + ηz) Δs − τ            Δp = ∓ Δs + η Δz
// Friction's caps c = μλ are of the same round's normal impulse, λ = −s of row 0: both change by Δc = −μ Δs₀,
// so
//   Δs₁ = D (lack + J Δv + τ⁺ − τ⁻ + (z⁺/p⁺ − z⁻/p⁻) Δc)
// Row 1 follows row 0 and is not followed by it: ds/dx of the two is not symmetric.
// Where that leads nowhere, row 0 is led by the slip of row 1, too, as if what slides by z = z⁺ + z⁻ were to
// part by μz; and less what parts so by a slip z₀ that is given:
//   y₀ = J v + b − s₀/G − (what row 0 slips by) − μ (z⁺ + z⁻ − z₀)
// For z₀ = z⁺ + z⁻ that is Coulomb's law (De Saxcé and Feng 1998), and for any z₀ that stays a convex
// problem, in which friction is within its caps. D is then the inverse of
//   C = diag(1/D₀, 1/D₁ of the row alone) + μ (μ w⁺ + μ w⁻, w⁺ − w⁻; w⁺ − w⁻, 0)      w = z/(p + ηz)
// whose determinant and whose adjugate times a bound's (μ, ±1) are sums of positive terms.
// Both caps of a row are one Pair. A cap that is infinite has z = 0, p = `far` and no μ: it takes part in
// nothing, without being asked for. In D, 1/G is at least least_compliance().
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "interior_round.h"
#include "pair.h"

namespace ductile::dynamics {

class CappedRows {
 public:
  /// From the impulses s that are drawn within their caps; m_eff with J as it is; `inside` and `energy` as in
  /// InteriorPoint.
  void enter(const Joint& joint, const JointRecord& record, const Rows& s, const Rows& m_eff, double inside,
             double energy) {
    friction_ = 0;
    parts_ = false;
    for (unsigned i = 0; i < 3; ++i) {
      Row& r = rows_[i];
      r = {};
      if (!(joint.G[i] > 0)) continue;
      const double G = joint.G[i], m = m_eff[i];
      const std::array<double, 2> cap{record.law.cap[i], record.law.cap_reverse[i]};
      // A row that takes one sign only starts with an impulse of the size that may be asked for.
      const double size = std::min(cap[0] + cap[1], std::abs(s[i]) + std::sqrt(m * energy));
      const auto margin = [&](double c) { return (1 - inside) * std::max(std::min(c, size), size / 2); };
      r.s = std::max(std::min(s[i], cap[0] - margin(cap[0])), margin(cap[1]) - cap[1]);
      r.G = G;
      r.compliance = 1 / G;
      r.give = std::max(r.compliance, least_compliance(m));
      r.last_bits = m > 0 ? last_bits(G, m) : 0;
      // s = F + ηz is the law's share α of G beyond the cap where α G = η/(1 + η/G).
      const double alpha = record.law.after_yield[i];
      r.hardening = alpha * G / (1 - alpha);
      for (int side : {0, 1}) {
        const double c = cap[static_cast<std::size_t>(side)];
        if (std::isinf(c)) continue;
        r.p[side] = side == 0 ? c - r.s : c + r.s;
        r.counts[side] = 1;
      }
    }
  }

  /// z p = μ with p = p₀ + ηz.
  void centre(double mu) {
    for (Row& r : rows_) {
      for (int side : {0, 1}) {
        if (r.counts[side] == 0) continue;
        const double p = r.p[side];
        r.z[side] = 2 * mu / (p + std::sqrt(p * p + 4 * r.hardening * mu));
        r.p[side] += r.hardening * r.z[side];
      }
    }
  }

  Rows impulse() const { return {rows_[0].s, rows_[1].s, rows_[2].s}; }
  std::size_t count() const {
    double sum = 0;
    for (const Row& r : rows_) sum += r.counts[0] + r.counts[1];
    return static_cast<std::size_t>(sum);
  }
  /// What is left to the first cap of the axial row: of a contact, its normal impulse.
  double left() const { return rows_[0].p[0]; }

  /// Both caps of row 1, of friction.
  double friction() const { return (rows_[1].p[0] + rows_[1].p[1]) / 2; }
  /// Before centre(): from here on these are μ times what is left to the first cap of row 0. What the row
  /// carries stays the same share of them.
  void follow(double mu) {
    Row& r = rows_[1];
    const double share = mu * left() / friction();
    r.s *= share;
    r.p = share * r.p;
    friction_ = mu;
  }
  /// They stay what they are.
  void stop_following() { friction_ = 0; }
  /// They go on to follow, and what slides parts, but for what it slides by now.
  void part() {
    parts_ = friction_ > 0;
    slip_ = std::abs(rows_[1].z[0] - rows_[1].z[1]);
  }
  /// After eliminate(): ds₁/dx₀, where that is not ds₀/dx₁.
  double follows() const {
    const Row& r = rows_[1];
    if (parts_) return 0;
    return -friction_ * r.D * (r.weight[0] - r.weight[1]) * rows_[0].D;
  }

  /// At x = J v + b.
  void measure(const Rows& x, Distance& d) {
    for (unsigned i = 0; i < 3; ++i) {
      Row& r = rows_[i];
      const Pair products = r.z * r.p;
      d.products += std::abs(products[0]) + std::abs(products[1]);
      if (r.G == 0) continue;
      r.lack = x[i] - r.s * r.compliance - (r.z[0] - r.z[1]) - (i == 0 ? parting() : 0);
      d.lack += r.G * r.lack * r.lack / 2;
      d.rounding += r.last_bits * r.s * r.s;
    }
  }

  /// D
  Coupling eliminate() {
    for (Row& r : rows_) {
      if (r.G == 0) continue;
      r.weight = r.z / (r.p + r.hardening * r.z);
      r.D = 1 / (r.give + (r.weight[0] + r.weight[1]));
    }
    if (parts_) return eliminate_both();
    return {.nn = rows_[0].D, .qq = rows_[1].D, .mm = rows_[2].D};
  }

  /// Δs where no velocity changes, for z p = μ, with so much of the second-order term Δz Δp of the last
  /// direction.
  Rows aim(double mu, double second_order) {
    Rows ds;
    for (unsigned i = 0; i < 3; ++i) {
      Row& r = rows_[i];
      r.aim = (r.z * r.p + second_order * (r.dz * r.dp) - mu * r.counts) / (r.p + r.hardening * r.z);
      const double leads = i == 1 ? -friction_ * ds[0] : 0;
      ds[i] = r.D * (r.lack + (r.aim[0] - r.aim[1]) + leads * (r.weight[0] - r.weight[1]));
    }
    if (parts_) std::tie(ds[0], ds[1]) = answer(asked(0, 0));
    return ds;
  }

  /// The direction, where the rows' velocities change by so much.
  void direct(const Rows& change, Direction& direction) {
    if (parts_) direct_both(change, direction);
    for (unsigned i = parts_ ? 2 : 0; i < 3; ++i) {
      Row& r = rows_[i];
      const double leads = i == 1 ? -friction_ * rows_[0].ds : 0;
      // Δs less what its cap changes by, solved for: as a difference its last bits, times z/p, would be slip.
      const double push = r.lack + change[i] + (r.aim[0] - r.aim[1]);
      const Pair along{r.D * (push - leads * (r.give + 2 * r.weight[1])),
                       -r.D * (push + leads * (r.give + 2 * r.weight[0]))};
      r.ds = r.weight[0] > r.weight[1] ? along[0] + leads : -along[1] - leads;
      r.dz = r.weight * along - r.aim;
      r.dp = r.hardening * r.dz - along;
      for (int side : {0, 1}) direction.see(r.p[side], r.z[side], r.dp[side], r.dz[side]);
    }
  }

  // interior_settle.cpp
  /// Takes for active what a direction brings to p = 0 sooner than to z = 0; returns how many bounds are
  /// others than those of the last time.
  int recognise();
  /// p of impulses and caps as they are. By its changes alone it would not know what impulses have lost of
  /// their last bits on a detour by what a rigid row made of a bound that was wrong.
  void renew(const RowLaw& law);
  /// D where active bounds are met, p = 0, and all others have z = 0.
  Coupling hold_active();
  /// After hold_active(): ds₁/dx₀, as follows().
  double follows_active() const { return -friction_ * rows_[1].sign() * rows_[0].D; }
  /// The direction to there, where the rows' velocities change by so much; Δs.
  Rows settle(const Rows& change);
  /// After a whole step along it: an active bound with z < 0 is none, and another with p < 0 is one. Returns
  /// how many such there were.
  int correct_active();
  /// What move() changes.
  struct State {
    std::array<Pair, 3> p, z;
    Rows s;
  };
  State state() const {
    State now;
    for (unsigned i = 0; i < 3; ++i) now.p[i] = rows_[i].p, now.z[i] = rows_[i].z, now.s[i] = rows_[i].s;
    return now;
  }
  void restore(const State& to) {
    for (unsigned i = 0; i < 3; ++i) rows_[i].p = to.p[i], rows_[i].z = to.z[i], rows_[i].s = to.s[i];
  }

  void move(double step) {
    for (Row& r : rows_) {
      r.s += step * r.ds;
      r.p = r.p + step * r.dp;
      r.z = r.z + step * r.dz;
    }
  }

  /// A row flows where its slip is more than what is left to the cap would strain it.
  unsigned regime() const {
    unsigned regime = 0;
    for (unsigned i = 0; i < 3; ++i) {
      const Row& r = rows_[i];
      if ((r.z[0] + (i == 0 ? parting() : 0)) * r.G > r.p[0]) regime |= 1u << i;
      if (r.z[1] * r.G > r.p[1]) regime |= 8u << i;
    }
    return regime;
  }

 private:
  static constexpr double far = 1e300;
  static constexpr int none = -1;
  using Two = std::tuple<double, double>;

  // Of a contact that is to be open, and has no friction.
  bool is_open() const { return friction_ > 0 && rows_[0].is_active(); }
  double parting() const { return parts_ ? friction_ * (rows_[1].z[0] + rows_[1].z[1] - slip_) : 0; }
  Coupling eliminate_both() {
    const Row &n = rows_[0], &t = rows_[1];
    const double mu = friction_, first = n.give + (n.weight[0] + n.weight[1]);
    const double both = t.weight[0] + t.weight[1];
    const double determinant =
        first * (t.give + both) + mu * mu * (t.give * both + 4 * t.weight[0] * t.weight[1]);
    D_ = {.nn = (t.give + both) / determinant,
          .qq = (first + mu * mu * both) / determinant,
          .mm = rows_[2].D,
          .nq = -mu * (t.weight[0] - t.weight[1]) / determinant};
    for (int side : {0, 1}) {
      const double other = t.weight[1 - side];
      along_n_[side] = mu * (t.give + 2 * other) / determinant;
      along_t_[side] = (side == 0 ? 1 : -1) * (first + 2 * mu * mu * other) / determinant;
    }
    return D_;
  }
  // What rows 0 and 1 have to answer, where their velocities change by so much.
  Two asked(double change_n, double change_t) const {
    const Row &n = rows_[0], &t = rows_[1];
    return {n.lack + change_n + (n.aim[0] - n.aim[1]) + friction_ * (t.aim[0] + t.aim[1]),
            t.lack + change_t + (t.aim[0] - t.aim[1])};
  }
  Two answer(const Two& y) const {
    const auto [n, t] = y;
    return {D_.nn * n + D_.nq * t, D_.nq * n + D_.qq * t};
  }
  void direct_both(const Rows& change, Direction& direction) {
    Row &n = rows_[0], &t = rows_[1];
    const Two y = asked(change[0], change[1]);
    std::tie(n.ds, t.ds) = answer(y);
    // By what both bounds of friction come nearer: as differences their last bits, times z/p, would be slip.
    const Pair along_n{n.ds, -n.ds}, along_t = std::get<0>(y) * along_n_ + std::get<1>(y) * along_t_;
    n.dz = n.weight * along_n - n.aim;
    n.dp = n.hardening * n.dz - along_n;
    t.dz = t.weight * along_t - t.aim;
    t.dp = t.hardening * t.dz - along_t;
    for (const Row* r : {&n, &t})
      for (int side : {0, 1}) direction.see(r->p[side], r->z[side], r->dp[side], r->dz[side]);
  }

  struct Row {
    Pair p{far, far}, z{}, dp{}, dz{};
    Pair weight{}, aim{};  // z/(p + ηz) and τ
    Pair counts{};         // 1: there is this cap
    double s = 0, ds = 0, lack = 0;
    double D = 0;
    double G = 0, compliance = 0, hardening = 0;
    double give = 0;       // compliance in a round
    double last_bits = 0;  // times s²: what rounding of s makes of the gap
    int active = none;     // the side of its active cap

    bool is_active() const { return active != none; }
    double sign() const { return active == 0 ? 1 : active == 1 ? -1 : 0; }
  };
  std::array<Row, 3> rows_;
  double friction_ = 0;         // μ, where row 1 follows row 0
  bool parts_ = false;          // where row 0 follows row 1, too
  double slip_ = 0;             // but for this slip
  Coupling D_;                  // of both
  Pair along_n_{}, along_t_{};  // bound by bound (μ, ±1) C⁻¹
};

}  // namespace ductile::dynamics
