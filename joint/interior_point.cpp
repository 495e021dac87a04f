#include "interior_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "contact_rows.h"

namespace ductile::dynamics {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double epsilon = std::numeric_limits<double>::epsilon();

double energy_of(const Body& b, const Vec3& v) { return dot(v, momentum(b, v)); }

// The rows of a joint at the present velocities.
Rows x_of(const System& system, const Joint& j) {
  return biased_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
}

double positive(double x) { return x > 0 ? x : 0; }

}  // namespace

void InteriorPoint::form(const System& system) {
  std::size_t bounds = 0, most = 0;
  for (const JointRecord& r : system.records) {
    const YieldSurface* surface = r.material.surface;
    const std::size_t own = std::max<std::size_t>(6, surface != nullptr ? surface->facets().size() + 1 : 0);
    bounds += own;
    most = std::max(most, own);
  }
  locals_.assign(system.joints.size(), {});
  best_.assign(system.joints.size(), {});
  bounds_.reserve(bounds);
  d_.assign(system.bodies.size(), {});
  rows_.assign(most + 4, {});
  order_.assign(most + 4, 0);
}

void InteriorPoint::start_from(const System& system) {
  best_.resize(system.joints.size());
  for (std::size_t k = 0; k < best_.size(); ++k) best_[k] = system.joints[k].impulse;
  start_known_ = true;
}

// v = v* − M⁻¹ Jᵀ s; |v − v*|²_M + |v|²_M. What s lacks is thus always a lack of compatibility, never of
// balance: whatever iterate the rounds end with gives velocities that conserve momentum.
template <class Impulse>
double InteriorPoint::balance(System& system, const Impulse& impulse) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    add_transposed(j, impulse(k), d_[z(j.a)], d_[z(j.b)]);
  }
  double scale = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    Body& b = system.bodies[i];
    const Vec3 change{b.inverse_mass * d_[i].x, b.inverse_mass * d_[i].y, b.inverse_inertia * d_[i].w};
    b.v = b.v_free - change;
    scale += energy_of(b, change) + energy_of(b, b.v);
  }
  return scale;
}

// The impulses of the last step, drawn within their caps.
void InteriorPoint::enter_caps(const Joint& j, const JointRecord& r, double energy, Local& l) {
  const double outside = 1 - tunables.inside;
  for (unsigned i = 0; i < 3; ++i) {
    if (!(j.G[i] > 0)) continue;
    const std::array<double, 2> cap{r.law.cap[i], r.law.cap_reverse[i]};
    // A row that takes one sign only starts with an impulse of the size that may be asked for.
    const double size = std::min(cap[0] + cap[1], std::abs(l.x[i]) + std::sqrt(r.m_eff[i] * energy));
    const auto margin = [&](double c) { return outside * std::max(std::min(c, size), size / 2); };
    l.x[i] = std::max(std::min(l.x[i], cap[0] - margin(cap[0])), margin(cap[1]) - cap[1]);
    // s = F + ηz is the law's share α of G beyond the cap where α G = η/(1 + η/G).
    const double alpha = r.law.after_yield[i];
    for (const double side : {1.0, -1.0}) {
      const double c = cap[side > 0 ? 0 : 1];
      if (std::isinf(c)) continue;
      Bound& b = bounds_.emplace_back();
      b.a[i] = side;
      b.p = c - side * l.x[i];
      b.hardening = alpha * j.G[i] / (1 - alpha);
    }
  }
}

// Likewise within a yield surface. Rows that are free carry nothing: they leave the facets.
void InteriorPoint::enter_surface(const Joint& j, const RowLaw& law, Local& l) {
  const YieldSurface& surface = *law.surface;
  const double h = law.share * law.h, usage = surface.usage({l.x[0] / h, l.x[1] / h, l.x[2] / h});
  for (unsigned i = 0; i < 3; ++i) l.x[i] *= std::min(1.0, tunables.inside / usage);
  if (std::isfinite(surface.shear()) && j.G[1] > 0) l.shear = h * surface.shear();
  double share = 0;
  for (const auto& [n, m] : surface.facets()) {
    const Row4 a{j.G[0] > 0 ? n / h : 0, 0, j.G[2] > 0 ? m / h : 0, l.shear > 0 ? -1.0 : 0.0};
    if (a[0] == 0 && a[2] == 0) continue;
    const double used = a[0] * l.x[0] + a[2] * l.x[2];
    share = std::max(share, used);
    Bound& b = bounds_.emplace_back();
    b.a = a;
    b.p = 1 - used;
  }
  if (l.shear == 0) return;
  const double q = l.x[1] / l.shear, left = (1 - share * share - q * q) / 2;
  l.x[3] = std::sqrt(share * share + left);
  for (std::size_t k = l.first; k < bounds_.size(); ++k) bounds_[k].p -= 1 - l.x[3];
  bounds_.emplace_back().p = left / 2;
}

void InteriorPoint::start(const System& system) {
  double energy = 0;  // what impulses may have to answer to
  for (std::size_t i = 0; i < system.free; ++i)
    energy += energy_of(system.bodies[i], system.bodies[i].v_free);
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Rows &bias = system.joints[k].bias, &m_eff = system.records[k].m_eff;
    for (unsigned i = 0; i < 3; ++i) energy += m_eff[i] * bias[i] * bias[i];
  }
  if (!start_known_) start_from(system);
  start_known_ = false;
  bounds_.clear();
  locals_.resize(system.joints.size());
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const JointRecord& r = system.records[k];
    Local& l = locals_[k];
    l = {};
    l.first = bounds_.size();
    for (unsigned i = 0; i < 3; ++i) l.x[i] = j.G[i] > 0 ? best_[k][i] : 0;
    l.on_surface = r.law.surface != nullptr;
    if (l.on_surface) {
      enter_surface(j, r.law, l);
    } else {
      enter_caps(j, r, energy, l);
    }
    l.last = bounds_.size();
  }
}

// Within the rounds a contact that may press has friction, too: its normal impulse is never 0.
void InteriorPoint::open_friction(System& system) {
  for (std::size_t k = system.first_contact(); k < system.joints.size(); ++k) {
    const Contact& c = system.contacts[k - system.first_contact()];
    Joint& j = system.joints[k];
    if (c.friction > 0 && !(j.G[1] > 0))
      set_friction(j, system.record(j), c.friction * std::max(c.normal, 1.0));
  }
}

// Caps of friction from the normal impulses of this round, where it matters among velocities of so much
// energy. What friction carries stays the same share of its cap; and beside what opens z p does not fall
// below the mean μ, or the next step would be as short as p has become. Whether any cap moved.
bool InteriorPoint::follow_friction(System& system, double energy, double mu) {
  bool moved = false;
  for (std::size_t k = system.first_contact(); k < system.joints.size(); ++k) {
    Joint& j = system.joints[k];
    if (!(j.G[1] > 0)) continue;
    JointRecord& r = system.record(j);
    Local& l = locals_[k];
    const double cap = system.contacts[k - system.first_contact()].friction * bounds_[l.first].p,
                 share = cap / r.law.cap[1];
    if (std::abs(cap - r.law.cap[1]) <= 1e-4 * cap + 1e-7 * std::sqrt(r.m_eff[1] * energy)) continue;
    moved = true;
    set_friction(j, r, cap);
    l.x[1] *= share;
    for (std::size_t c = l.first; c < l.last; ++c) {
      Bound& b = bounds_[c];
      if (b.a[1] == 0) continue;
      b.p *= share;
      if (b.z * b.p < mu) b.z = std::max(b.z, std::min(b.z / share, mu / b.p));
    }
  }
  return moved;
}

// Multipliers of a cone and its facets that do not agree: either what they differ by is multiplied with t ≤
// 1, or the ones or the others are scaled to agree, and the flow changes. A cone that is not kept: s gives up
// that share of itself, which moves its rows.
double InteriorPoint::cone_lack(const Joint& j, const Rows& m_eff, const Local& l) const {
  const Bound& cone = bounds_[l.last - 1];
  double sum = 0, N = 0, M = 0;
  for (std::size_t k = l.first; k + 1 < l.last; ++k) {
    const Bound& b = bounds_[k];
    sum += b.z;
    N += b.z * b.a[0];
    M += b.z * b.a[2];
  }
  const auto by = [&](unsigned i, double change) { return j.G[i] * change * (l.lack[i] + change / 2); };
  const double q = l.x[1] / (l.shear * l.shear), off = l.lack[3] / sum;
  double lack =
      std::min({std::abs(l.lack[3]), by(1, -l.lack[3] / l.x[3] * q), by(0, off * N) + by(2, off * M)});
  lack += cone.z * std::abs(cone.missing);
  for (unsigned i = 0; i < 3; ++i) {
    const double give = m_eff[i] > 0 ? positive(-cone.missing) * l.x[i] / m_eff[i] : 0;
    lack += j.G[i] * give * give / 2;
  }
  return lack;
}

// f − min f is at most Σ z p + ½ Σ G lack² (Fenchel's inequality, joint by joint).
InteriorPoint::Distance InteriorPoint::measure(const System& system) {
  Distance d;
  for (const Bound& b : bounds_) d.products += b.z * b.p;
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const Rows& m_eff = system.records[k].m_eff;
    Local& l = locals_[k];
    const Rows x = x_of(system, j);
    for (unsigned i = 0; i < 3; ++i) l.lack[i] = j.G[i] > 0 ? x[i] - l.x[i] / j.G[i] : 0;
    l.lack[3] = 0;
    if (l.shear > 0) bounds_[l.last - 1].a = {0, l.x[1] / (l.shear * l.shear), 0, l.x[3]};
    for (std::size_t c = l.first; c < l.last; ++c) {
      for (std::size_t i = 0; i < 4; ++i) l.lack[i] -= bounds_[c].z * bounds_[c].a[i];
    }
    for (unsigned i = 0; i < 3; ++i) {
      d.lack += j.G[i] * l.lack[i] * l.lack[i] / 2;
      // The last bits of s move its row by ε s/m_eff, which the row answers by G.
      const double m = m_eff[i], moved = m > 0 ? epsilon * l.x[i] / m : 0;
      d.rounding += 16 * std::max(j.G[i], m) * moved * moved;
    }
    if (l.shear > 0) d.lack += cone_lack(j, m_eff, l);
  }
  return d;
}

InteriorPoint::Outcome InteriorPoint::solve(System& system, Hessian& hessian, Evaluation& at) {
  Outcome outcome;
  const auto current = [this](std::size_t k) { return locals_[k].impulse(); };
  open_friction(system);
  start(system);
  follow_friction(system, 0, 0);
  double scale = balance(system, current), work = 0, moving = 0;
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Rows x = x_of(system, system.joints[k]);
    for (unsigned i = 0; i < 3; ++i) work += std::abs(locals_[k].x[i] * x[i]);
  }
  for (std::size_t i = 0; i < system.free; ++i) moving += energy_of(system.bodies[i], system.bodies[i].v);
  const bool alone = system.contacts.empty();
  const double count = std::max(1.0, static_cast<double>(bounds_.size()));
  for (Bound& b : bounds_) {
    // z p = μ with p = p₀ + ηz
    const double mu = (alone ? tunables.start : tunables.contact_start) * std::max(work, moving) / count;
    b.z = 2 * mu / (b.p + std::sqrt(b.p * b.p + 4 * b.hardening * mu));
    b.p += b.hardening * b.z;
  }

  const double goal = alone ? tunables.goal : tunables.contact_goal;
  const double tolerance = alone ? tunables.tolerance : tunables.contact_tolerance;
  outcome.gap = infinity;
  std::array<double, 2> earlier{infinity, infinity};  // Σ z p two rounds ago and in the last
  for (int round = 0, idle = 0, careful = 0;; ++round) {
    const Distance now = measure(system);
    // Rounding is what gains nothing any more where lack is all that there is left.
    idle = now.gap() < outcome.gap / 2 || now.products > now.lack ? 0 : idle + 1;
    if (now.gap() < outcome.gap) {
      outcome.gap = now.gap();
      for (std::size_t k = 0; k < best_.size(); ++k) best_[k] = current(k);
    }
    outcome.tolerance = tolerance * scale + now.rounding;
    if (outcome.gap <= goal * scale + now.rounding || !std::isfinite(now.gap())) break;
    if ((idle >= 2 && outcome.gap <= outcome.tolerance) || round == tunables.round_bound) break;

    factor(system, hessian);
    ++outcome.factorisations;
    // Predictor (μ = 0), then a corrector with the centring that its success calls for and with its
    // second-order terms (Mehrotra 1992), by the square of the step that it could go. Where two rounds have
    // gained nothing, these are left out for five, and centring is no less than half: else one structure in
    // 3000 goes round in circles.
    if (now.products > 0.8 * earlier[0]) careful = 5;
    const bool stalls = careful-- > 0;
    earlier = {earlier[1], now.products};
    const double reach = 1 - std::clamp(std::sqrt(now.products / scale), 1e-6, 0.005);
    find_direction(system, hessian, 0, 0);
    const double affine = step_within(reach);
    double left = 0;  // share of Σ z p that the predictor leaves
    for (const Bound& b : bounds_) left += (b.z + affine * b.dz) * (b.p + affine * b.dp) / now.products;
    const double remains = std::max(std::min(left, 1.0), 1 - affine);
    const double centring = std::max(remains * remains * remains, stalls ? 0.5 : 0);
    // With contacts not below what the goal allows: as they open, Σ z p may vanish before the rest settles.
    const double least = alone ? 0 : 0.1 * goal * scale;
    find_direction(system, hessian, std::max(centring * now.products, least) / count,
                   stalls ? 0 : affine * affine);
    move(step_within(reach));
    // A gap is of the caps that it was measured with.
    if (round < tunables.friction_rounds && follow_friction(system, scale, now.products / count))
      outcome.gap = infinity;
    scale = balance(system, current);
  }
  outcome.reached = outcome.gap <= outcome.tolerance;
  finish(system, outcome.reached, at);
  return outcome;
}

// With impulses τ s the step adds −Σ τ s·(x − τ s/G) − ½ |v − v*|²_M at most to kinetic and elastic energy.
double InteriorPoint::share_without_gain(System& system) {
  double given = 0, taken = 0;  // s·(J v* + b) and ½ |v − v*|²_M + sᵀ G⁻¹ s
  for (const Joint& j : system.joints) {
    const Rows x = x_of(system, j);
    for (unsigned i = 0; i < 3; ++i) {
      given += j.impulse[i] * x[i];
      if (j.G[i] > 0) taken += j.impulse[i] * j.impulse[i] / j.G[i];
    }
  }
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    const double change = energy_of(b, b.v - b.v_free);
    given += change;
    taken += change / 2;
  }
  return given > 0 ? std::min(1.0, given / taken) : 0;
}

void InteriorPoint::finish(System& system, bool reached, Evaluation& at) {
  at = {};
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    Joint& j = system.joints[k];
    JointRecord& r = system.records[k];
    const Local& l = locals_[k];
    j.impulse = best_[k];
    if (r.law.surface != nullptr) {
      const double h = r.law.share * r.law.h,
                   usage = r.law.surface->usage({j.impulse[0] / h, j.impulse[1] / h, j.impulse[2] / h});
      for (double& s : j.impulse) s /= std::max(1.0, usage);
    } else {
      for (unsigned i = 0; i < 3; ++i) {
        if (!(r.law.after_yield[i] > 0))
          j.impulse[i] = std::clamp(j.impulse[i], -r.law.cap_reverse[i], r.law.cap[i]);
      }
    }
    // A row flows where its slip is more than what is left to the cap would strain it.
    unsigned regime = 0;
    for (std::size_t c = l.first; c < l.last; ++c) {
      const Bound& b = bounds_[c];
      double stiffness = 0;
      for (unsigned i = 0; i < 3; ++i) stiffness += b.a[i] * b.a[i] * j.G[i];
      if (!(b.z * stiffness > b.p)) continue;
      for (unsigned i = 0; i < 3; ++i) regime |= b.a[i] > 0 ? 1u << i : b.a[i] < 0 ? 8u << i : 0u;
    }
    j.regime = static_cast<std::uint8_t>(r.law.surface != nullptr && regime != 0 ? on_surface : regime);
    j.factored_flow = static_cast<std::uint8_t>(flowing(j.regime));
    at.flows |= j.regime != 0;
    at.curved |= j.regime == on_surface;
  }
  const auto impulse = [&](std::size_t k) { return system.joints[k].impulse; };
  balance(system, impulse);
  if (!reached) {
    const double share = share_without_gain(system);
    for (Joint& j : system.joints) {
      for (double& s : j.impulse) s = std::isfinite(s) ? share * s : 0;
      j.regime = on_surface;  // whatever each row gives way by is booked
      j.factored_flow = static_cast<std::uint8_t>(flowing(j.regime));
    }
    at.flows = true;
    balance(system, impulse);
  }
  for (std::size_t k = 0; k < system.joints.size(); ++k) system.records[k].x = x_of(system, system.joints[k]);
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    at.see(b);
    at.impulse2 += energy_of(b, b.v - b.v_free);
    at.speed2 += energy_of(b, b.v);
  }
}

std::size_t InteriorPoint::bytes() const {
  return locals_.capacity() * sizeof(Local) + bounds_.capacity() * sizeof(Bound) +
         best_.capacity() * sizeof(Rows) + d_.capacity() * sizeof(Vec3) + rows_.capacity() * sizeof(Row4) +
         order_.capacity() * sizeof(std::size_t);
}

}  // namespace ductile::dynamics
