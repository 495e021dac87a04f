// The end of the interior point method where all bounds are caps. Rounds come nearer to every bound at once,
// and which of them are active (p = 0) and which are not (z = 0) is plain long before their products vanish.
// With all of them known the minimum is the solution of one linear system with the pattern of H: D of a row
// is that of its law within the cap or beyond it. What that shows to be wrong, an active bound with z < 0 or
// another one with p < 0, is corrected, and the system is solved again, as in a primal–dual active set method
// (Hintermüller, Ito and Kunisch 2002), for as long as there is less of it each time. Near the minimum one or
// two corrections end where six to ten rounds would, and nearer: all z p are 0, and the gap is that of
// rounding.
#include <cmath>
#include <limits>

#include "interior_point.h"

namespace ductile::dynamics {

int CappedRows::recognise() {
  int others = 0;
  for (Row& r : rows_) {
    int active = none;
    for (const int side : {0, 1}) {
      if (r.counts[side] == 0 || !(r.dp[side] * r.z[side] < r.dz[side] * r.p[side])) continue;
      if (active == none || r.p[side] < r.p[active]) active = side;
    }
    others += active != r.active ? 1 : 0;
    r.active = active;
  }
  return others;
}

void CappedRows::renew(const RowLaw& law) {
  constexpr double last_bit = std::numeric_limits<double>::epsilon();
  for (unsigned i = 0; i < 3; ++i) {
    Row& r = rows_[i];
    const double follows = friction_ * left();
    const Pair cap = i == 1 && friction_ > 0 ? Pair{follows, follows} : Pair{law.cap[i], law.cap_reverse[i]};
    for (const int side : {0, 1}) {
      if (r.counts[side] == 0) continue;
      const double moved = cap[side] + r.hardening * r.z[side], left = moved + (side == 0 ? -r.s : r.s);
      r.p[side] = std::abs(left) <= last_bit * (moved + std::abs(r.s)) ? 0 : left;
    }
  }
}

// Beyond a cap s = F + ηz and x = s/G + z.
Coupling CappedRows::hold_active() {
  for (Row& r : rows_) {
    if (r.G == 0) continue;
    r.D = r.is_active() ? r.hardening / (1 + r.hardening * r.give) : 1 / r.give;
  }
  if (is_open()) rows_[1].D = 0;
  return {.nn = rows_[0].D, .qq = rows_[1].D, .mm = rows_[2].D};
}

Rows CappedRows::settle(const Rows& change) {
  for (unsigned i = 0; i < 3; ++i) {
    Row& r = rows_[i];
    if (r.G == 0) continue;
    // What there is to answer where all z but that of an active bound become 0: of that what it changes by is
    // looked for, as η times z would leave its last bits.
    double y = r.lack + change[i];
    for (const int side : {0, 1})
      if (side != r.active) y += side == 0 ? r.z[0] : -r.z[1];
    r.dz = -1.0 * r.z;
    if (i == 1 && is_open()) {
      r.ds = -r.s;
      const double slip = y - r.give * r.ds + (r.is_active() ? r.sign() * r.z[r.active] : 0);
      r.dz[slip > 0 ? 0 : 1] += std::abs(slip);
      r.dp = -1.0 * r.p;
      continue;
    }
    const double leads = i == 1 ? -friction_ * rows_[0].ds : 0;  // what both caps change by
    if (!r.is_active()) {
      r.ds = r.D * y;
      r.dp = Pair{leads - r.ds, leads + r.ds} + r.hardening * r.dz;
    } else {
      const int side = r.active;
      r.ds = r.sign() * (r.p[side] + leads) / (1 + r.hardening * r.give) + r.D * y;
      r.dz[side] = r.sign() * (y - r.give * r.ds);
      r.dp = Pair{leads - r.ds, leads + r.ds} + r.hardening * r.dz;
      r.dp[side] = -r.p[side];
    }
    for (int side : {0, 1})
      if (r.counts[side] == 0) r.dp[side] = r.dz[side] = 0;
  }
  return {rows_[0].ds, rows_[1].ds, rows_[2].ds};
}

// What is to slide where an open contact closes is what slides now.
int CappedRows::correct_active() {
  int wrong = 0;
  for (unsigned i = 0; i < 3; ++i) {
    Row& r = rows_[i];
    if (r.G == 0) continue;
    if (i == 1 && is_open()) {
      r.active = r.z[0] > 0 ? 0 : r.z[1] > 0 ? 1 : none;
      continue;
    }
    for (int side : {0, 1}) {
      if (r.counts[side] == 0 || (r.active == side ? r.z : r.p)[side] >= 0) continue;
      ++wrong;
      r.active = r.active == side ? none : side;
    }
  }
  return wrong;
}

// Returns how many bounds it finds to be wrong.
int InteriorPoint::step_to_active(System& system, const Hessian& hessian, bool follows) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    const Joint& j = system.joints[k];
    const Rows ds = caps_[k].settle({});
    add_transposed(j, {-ds[0], -ds[1], -ds[2]}, d_[z(j.a)], d_[z(j.b)]);
  }
  answer(system, hessian, follows);
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    const Joint& j = system.joints[k];
    caps_[k].settle(relative_velocity(j, d_[z(j.a)], d_[z(j.b)]));
  }
  move(1);
  int wrong = 0;
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    caps_[k].renew(system.records[k].law);
    wrong += caps_[k].correct_active();
  }
  return wrong;
}

// Whether the minimum was found; if not, all is as it was. With a row as stiff as 1e12 m a step leaves a
// trifle of what rows lack, which another one with the same factor mends.
bool InteriorPoint::settle(System& system, Hessian& hessian, bool follows, int& factorisations) {
  constexpr int most_refined = 2;
  kept_.resize(caps_.size());
  for (std::size_t k = 0; k < caps_.size(); ++k) kept_[k] = caps_[k].state();
  for (TurnRow& r : turns_) r.kept = r.s;
  for (int wrong = 0, last = std::numeric_limits<int>::max(); last > 0; last = wrong) {
    for (std::size_t k = 0; k < caps_.size(); ++k) system.records[k].tangent = caps_[k].hold_active();
    factor_tangents(system, hessian, follows, [](const CappedRows& rows) { return rows.follows_active(); });
    ++factorisations;
    for (int refined = 0; refined <= most_refined; ++refined) {
      wrong = step_to_active(system, hessian, follows);
      const double scale = balance(system);
      const Distance now = measure(system);
      if (wrong > 0) break;
      if (now.gap() <= tunables.goal * scale + now.rounding) return true;
    }
    if (wrong > last / 2) break;
  }
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    caps_[k].restore(kept_[k]);
    impulses_[k] = caps_[k].impulse();
  }
  for (TurnRow& r : turns_) r.s = r.kept;
  balance(system);
  measure(system);
  return false;
}

}  // namespace ductile::dynamics
