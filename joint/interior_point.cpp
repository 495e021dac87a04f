#include "interior_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "contact_rows.h"
#include "turn_inertia.h"

namespace ductile::dynamics {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double turn_rate(const System& system, const TurnInertia& t) {
  return t.rate_of(system.bodies[z(t.a)].v, system.bodies[z(t.b)].v);
}

// The rows of a joint at the present velocities.
Rows x_of(const System& system, const Joint& j) {
  return biased_velocity(j, system.bodies[z(j.a)].v, system.bodies[z(j.b)].v);
}

// |J|, entry by entry.
struct AbsoluteRows {
  explicit AbsoluteRows(const Jacobian& J) : a(of(rows_of_a(J))), b(of(rows_of_b(J))) {}
  std::array<Vec3, 3> a, b;

 private:
  static Vec3 of(const Vec3& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.w)}; }
  static std::array<Vec3, 3> of(const JacobianRows& rows) { return {of(rows.u), of(rows.v), of(rows.w)}; }
};

}  // namespace

void InteriorPoint::form(const System& system) {
  std::size_t bounds = 0, most = 0, surfaces = 0;
  for (const JointRecord& r : system.records) {
    if (r.material.surface == nullptr) continue;
    const std::size_t own = SurfaceRows::most_bounds(*r.material.surface);
    bounds += own;
    most = std::max(most, own);
    ++surfaces;
  }
  const std::size_t room = system.joints.capacity();  // contacts will come
  caps_.reserve(room);
  surface_of_.reserve(room);
  surfaces_.reserve(surfaces);
  bounds_.assign(bounds, {});
  turns_.reserve(system.turn_inertias.capacity());
  impulses_.reserve(room);
  best_.reserve(room);
  kept_.reserve(room);
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
double InteriorPoint::balance(System& system) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    add_transposed(j, impulses_[k], d_[z(j.a)], d_[z(j.b)]);
  }
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    const TurnInertia& t = system.turn_inertias[k];
    t.add(turns_[k].s, d_[z(t.a)], d_[z(t.b)]);
  }
  double scale = 0;
  for (std::size_t i = 0; i < system.free; ++i) {
    Body& b = system.bodies[i];
    const Vec3 change{b.inverse_mass * d_[i].x, b.inverse_mass * d_[i].y, b.inverse_inertia * d_[i].w};
    b.v = b.v_free - change;
    scale += twice_kinetic(b, change) + twice_kinetic(b, b.v);
  }
  return scale;
}

// Of the impulses to start from, the share at which what is to be minimised is least, where that is far from
// all of them: so they are of rows that were jammed until somebody moved them, or have flowed since. From so
// far, rounds lose the last bits of what is left to the caps.
void InteriorPoint::moderate_start(const System& system) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  double asked = 0, taken = 0;  // s·(J v* + b) and |M⁻¹ Jᵀ s|²_M + sᵀ G⁻¹ s
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const Rows x = biased_velocity(j, system.free_velocity(j.a), system.free_velocity(j.b));
    for (unsigned i = 0; i < 3; ++i) {
      asked += best_[k][i] * x[i];
      if (j.G[i] > 0) taken += best_[k][i] * best_[k][i] / j.G[i];
    }
    add_transposed(j, best_[k], d_[z(j.a)], d_[z(j.b)]);
  }
  for (std::size_t i = 0; i < system.free; ++i) taken += square(system.bodies[i], d_[i]);
  const double share = std::max(0.0, asked / taken);
  if (!(share < 1e-3)) return;
  for (Rows& s : best_)
    for (double& each : s) each = share > 0 ? share * each : 0;
}

// Whether anything moves, or asks for an impulse: else there is none, and bodies rest.
bool InteriorPoint::start(const System& system) {
  double energy = 0;  // what impulses may have to answer to
  for (std::size_t i = 0; i < system.free; ++i)
    energy += twice_kinetic(system.bodies[i], system.bodies[i].v_free);
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Rows &bias = system.joints[k].bias, &m_eff = system.records[k].m_eff;
    for (unsigned i = 0; i < 3; ++i) energy += m_eff[i] * bias[i] * bias[i];
  }
  for (const TurnInertia& t : system.turn_inertias) energy += t.inertia * t.rate * t.rate;
  if (energy == 0) std::fill(best_.begin(), best_.end(), Rows{});
  const std::size_t count = system.joints.size();
  caps_.resize(count);
  surface_of_.resize(count);
  impulses_.resize(count);
  surfaces_.clear();
  turns_.assign(system.turn_inertias.size(), {});
  std::span<SurfaceRows::Bound> room = bounds_;
  for (std::size_t k = 0; k < count; ++k) {
    const Joint& j = system.joints[k];
    const JointRecord& r = system.records[k];
    const Rows m_eff = effective_masses(system, j);
    if (r.law.surface == nullptr) {
      surface_of_[k] = -1;
      caps_[k].enter(j, r, best_[k], m_eff, tunables.inside, energy);
      impulses_[k] = caps_[k].impulse();
    } else {
      surface_of_[k] = static_cast<int>(surfaces_.size());
      SurfaceRows& rows = surfaces_.emplace_back();
      rows.enter(j, r, best_[k], m_eff, tunables.inside, room);
      room = room.subspan(rows.count());
      impulses_[k] = rows.impulse();
    }
  }
  return energy != 0;
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

// f − min f is at most Σ z p + ½ Σ G lack² (Fenchel's inequality, joint by joint).
Distance InteriorPoint::measure(const System& system) {
  Distance d;
  each([&](std::size_t k, auto& rows) { rows.measure(x_of(system, system.joints[k]), d); });
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    const TurnInertia& t = system.turn_inertias[k];
    TurnRow& r = turns_[k];
    const double inverse = inverse_mass(system, t);
    if (!(t.inertia * inverse > 0)) continue;
    r.lack = turn_rate(system, t) - t.rate - r.s / t.inertia;
    d.lack += t.inertia * r.lack * r.lack / 2;
    d.rounding += last_bits(t.inertia, 1 / inverse) * r.s * r.s;
  }
  return d;
}

// What a last bit of each impulse makes of the gap: its row moves by ε |J| M⁻¹ |Jᵀ s| of all rows of its
// bodies. Of rows that press against each other that may be 1e10 times what they give.
double InteriorPoint::rounding_of_best(const System& system) {
  constexpr double last_bit = std::numeric_limits<double>::epsilon();
  std::fill(d_.begin(), d_.end(), Vec3{});
  for (std::size_t k = 0; k < best_.size(); ++k) {
    const Joint& j = system.joints[k];
    const AbsoluteRows rows(j.J);
    for (unsigned i = 0; i < 3; ++i) {
      d_[z(j.a)] += std::abs(best_[k][i]) * rows.a[i];
      d_[z(j.b)] += std::abs(best_[k][i]) * rows.b[i];
    }
  }
  for (std::size_t i = 0; i < d_.size(); ++i) {
    const Body& b = system.bodies[i];
    d_[i] = i < system.free
                ? Vec3{b.inverse_mass * d_[i].x, b.inverse_mass * d_[i].y, b.inverse_inertia * d_[i].w}
                : Vec3{};
  }
  double gap = 0;
  for (const Joint& j : system.joints) {
    const AbsoluteRows rows(j.J);
    const Rows m_eff = effective_masses(system, j);
    for (unsigned i = 0; i < 3; ++i) {
      const double x = last_bit * (dot(rows.a[i], d_[z(j.a)]) + dot(rows.b[i], d_[z(j.b)]));
      gap += std::max(j.G[i], m_eff[i]) * x * x / 2;
    }
  }
  return gap;
}

// H = M + Jᵀ D J
void InteriorPoint::factor(System& system, Hessian& hessian, bool follows) {
  for (std::size_t k = 0; k < caps_.size(); ++k) {
    system.records[k].tangent =
        surface_of_[k] < 0 ? caps_[k].eliminate() : surfaces_[z(surface_of_[k])].eliminate({rows_, order_});
  }
  factor_tangents(system, hessian, follows, [](const CappedRows& rows) { return rows.follows(); });
}

// From what the rows of joints ask for in d_ what velocities change by, and what that means for turn rows.
void InteriorPoint::answer(const System& system, const Hessian& hessian, bool follows) {
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    const TurnInertia& t = system.turn_inertias[k];
    t.add(-t.inertia * turns_[k].lack, d_[z(t.a)], d_[z(t.b)]);
  }
  for (std::size_t i = 0; i < d_.size(); ++i) {
    if (i >= system.free) d_[i] = {};
    if (system.bodies[i].inverse_inertia == 0) d_[i].w = 0;
  }
  follows ? hessian.solve_following({d_.data(), system.free}) : hessian.solve({d_.data(), system.free});
  for (std::size_t k = 0; k < turns_.size(); ++k) {
    const TurnInertia& t = system.turn_inertias[k];
    turns_[k].ds = t.inertia * (turns_[k].lack + t.rate_of(d_[z(t.a)], d_[z(t.b)]));
  }
}

// Newton's step for z p = μ, with so much of the second-order term Δz Δp of the last direction. Unknowns are
// written as what they change by, never as what they become: a rigid row multiplies by κ what rounding
// leaves.
Direction InteriorPoint::find_direction(const System& system, const Hessian& hessian, double mu,
                                        double second_order, bool follows) {
  std::fill(d_.begin(), d_.end(), Vec3{});
  each([&](std::size_t k, auto& rows) {
    const Joint& j = system.joints[k];
    const Rows ds = rows.aim(mu, second_order);
    add_transposed(j, {-ds[0], -ds[1], -ds[2]}, d_[z(j.a)], d_[z(j.b)]);
  });
  answer(system, hessian, follows);
  Direction direction;
  each([&](std::size_t k, auto& rows) {
    const Joint& j = system.joints[k];
    rows.direct(relative_velocity(j, d_[z(j.a)], d_[z(j.b)]), direction);
  });
  return direction;
}

void InteriorPoint::move(double step) {
  each([&](std::size_t k, auto& rows) {
    rows.move(step);
    impulses_[k] = rows.impulse();
  });
  for (TurnRow& r : turns_) r.s += step * r.ds;
}

InteriorPoint::Outcome InteriorPoint::solve(System& system, Hessian& hessian, Evaluation& at) {
  Outcome outcome;
  if (!std::exchange(start_known_, false)) start_from(system);
  open_friction(system);
  moderate_start(system);
  const bool found = follows_friction_ && !system.contacts.empty() && go(system, hessian, true, outcome);
  if (!found) {
    // Coulomb's law is no potential's derivative, and there may be no way to where it holds. Caps that stay
    // leave a convex problem; the solve after this one has other caps. What led nowhere is no place to start
    // from.
    follows_friction_ = system.contacts.empty();
    moderate_start(system);
    go(system, hessian, false, outcome);
  }
  outcome.reached = outcome.gap <= outcome.tolerance;
  finish(system, outcome.reached, at);
  return outcome;
}

// The rounds, from the best impulses so far, with friction that follows normal impulses or caps as they are.
// False where friction's following leads nowhere.
bool InteriorPoint::go(System& system, Hessian& hessian, bool follows, Outcome& outcome) {
  if (!start(system)) {
    outcome.gap = 0;
    return true;
  }
  if (follows) {
    each_friction(system, [this](std::size_t k, double mu) {
      caps_[k].follow(mu);
      impulses_[k] = caps_[k].impulse();
    });
  }
  double scale = balance(system), work = 0, moving = 0, asked = 0;
  for (std::size_t k = 0; k < system.joints.size(); ++k) {
    const Joint& j = system.joints[k];
    const Rows x = x_of(system, j), &m_eff = system.records[k].m_eff;
    for (unsigned i = 0; i < 3; ++i) {
      work += std::abs(impulses_[k][i] * x[i]);
      asked += std::min(j.G[i], m_eff[i]) * x[i] * x[i];
    }
  }
  for (std::size_t i = 0; i < system.free; ++i) moving += twice_kinetic(system.bodies[i], system.bodies[i].v);
  const bool alone = system.contacts.empty();
  std::size_t bounds = 0;
  each([&](std::size_t, auto& rows) { bounds += rows.count(); });
  const double count = static_cast<double>(std::max<std::size_t>(1, bounds));
  // Impulses to start from and velocities may be nothing beside what is asked for: of bodies at rest, by one
  // whose velocity is prescribed.
  constexpr double last_bit = std::numeric_limits<double>::epsilon();
  const double known = std::max(work, moving),
               size = known > last_bit * last_bit * asked ? known : 1e-3 * asked;
  const double mu = (alone ? tunables.start : tunables.contact_start) * size / count;
  each([&](std::size_t, auto& rows) { rows.centre(mu); });

  outcome.gap = infinity;
  // Of the best iterate, as its gap is: |v|² of one that is astray would allow any gap that there ever was.
  double goal_gap = 0, tolerance = 0;
  std::array<double, 2> earlier{infinity, infinity};  // Σ z p two rounds ago and in the last
  int short_steps = 0;                                // one after the other
  double last_lack = infinity;
  const double first_scale = scale;
  bool parts = !surfaces_.empty();  // of rows whose bounds settle() does not know
  int settles_from = 0;             // this round on
  int slip_rounds = 0;              // in which what slides parts, but for its slip in the same round
  for (int round = 0, idle = 0, careful = 0;; ++round) {
    if (slip_rounds > 0) {
      slip_rounds = earlier[1] > tunables.slip_goal * scale ? slip_rounds - 1 : 0;
      each_friction(system, [this](std::size_t k, double) { caps_[k].part(); });
      outcome.gap = infinity;
    }
    const Distance now = measure(system);
    // Rounding is what gains nothing any more where lack is all that there is left.
    idle = now.gap() < outcome.gap / 2 || now.products > now.lack ? 0 : idle + 1;
    if (now.gap() < outcome.gap) {
      outcome.gap = now.gap();
      goal_gap = tunables.goal * scale + now.rounding;
      outcome.tolerance = tolerance = tunables.tolerance * scale + now.rounding;
      best_ = impulses_;
      for (TurnRow& r : turns_) r.best = r.s;
      each_friction(system, [&](std::size_t k, double) {
        set_friction(system.joints[k], system.records[k], caps_[k].friction());
      });
    }
    if (outcome.gap <= goal_gap || !std::isfinite(now.gap())) break;
    // Rounding was thought to make the last bits of a row's own impulse.
    const bool last = round == tunables.round_bound;
    if (idle >= tunables.idle_rounds || last) outcome.tolerance = tolerance + rounding_of_best(system);
    if ((idle >= 2 && outcome.gap <= outcome.tolerance) || last) break;
    // Where friction that follows can go no further, a small gap will do: caps that stay may lead away from
    // it, with no way back.
    const bool stands = now.products > 0.8 * earlier[0];
    if (follows && stands && now.gap() <= tunables.followed_goal * scale) break;
    // Friction that follows is factored without pivoting between bodies: at the end caps stay. A step along a
    // good direction shortens what is lacking. Where it does not, or is short, or two rounds have gained
    // nothing, there is no way on to where Coulomb's law holds, and caps that stayed would be those of other
    // normal impulses than the ones that are found with them: what slides parts from then on. Far from
    // compatible one short step, or what is gained, tells nothing yet.
    const bool ends =
        now.gap() <= tunables.friction_goal * scale || (stands && now.gap() <= tunables.tolerance * scale);
    const bool halts = now.lack < now.products ? stands || short_steps > 0 : short_steps == 2;
    if (follows && (ends || halts || now.lack > 4 * last_lack + tunables.tolerance * scale)) {
      if (scale > 10 * first_scale) return false;
      follows = false;
      parts |= !ends;
      slip_rounds = ends ? 0 : tunables.slip_rounds;
      each_friction(system, [&](std::size_t k, double) {
        if (!ends) return caps_[k].part();
        set_friction(system.joints[k], system.records[k], caps_[k].friction());
        caps_[k].stop_following();
      });
      outcome.gap = infinity;
      idle = 0;
    }
    last_lack = now.lack;

    if (round > 0 && round >= settles_from && !parts && now.gap() <= tunables.settle_gap * scale &&
        static_cast<double>(others_) <= tunables.settle_share * static_cast<double>(caps_.size())) {
      if (settle(system, hessian, follows, outcome.factorisations)) {
        scale = balance(system);
        continue;
      }
      settles_from = round + tunables.settle_pause;
    }

    factor(system, hessian, follows);
    ++outcome.factorisations;
    // Predictor (μ = 0), then a corrector with the centring that its success calls for and with its
    // second-order terms (Mehrotra 1992), by the square of the step that it could go. Where two rounds have
    // gained nothing, these are left out for five, or until a step goes nearly all the way, and centring is
    // no less than half: else one structure in 3000 goes round in circles. Nor does a step go all the way to
    // a bound then: what is too near one would come 200 times nearer in each round, and friction would jump
    // from one of its caps to the other.
    if (stands) careful = 5;
    const bool stalls = careful-- > 0;
    earlier = {earlier[1], now.products};
    const double reach = stalls ? 0.8 : 1 - std::clamp(std::sqrt(now.products / scale), 1e-6, 0.005);
    const Direction predictor = find_direction(system, hessian, 0, 0, follows);
    const double affine = predictor.step_within(reach);
    const double left = now.products > 0 ? predictor.products(now.products, affine) / now.products : 0;
    const double remains = std::max(std::min(left, 1.0), 1 - affine);
    const double centring = std::max(remains * remains * remains, stalls ? 0.5 : 0);
    // Not below what the goal allows: Σ z p may vanish before the rest settles, and no step is possible then.
    const double least = 1e-3 * tunables.goal * scale;
    const Direction corrector =
        find_direction(system, hessian, std::max(centring * now.products, least) / count,
                       stalls ? 0 : affine * affine, follows);
    const double step = corrector.step_within(reach);
    short_steps = step < 0.1 ? short_steps + 1 : 0;
    if (step > 0.9) careful = 0;
    others_ = 0;
    for (CappedRows& rows : caps_) others_ += rows.recognise();
    move(step);
    scale = balance(system);
  }
  return outcome.gap <= outcome.tolerance;
}

// With impulses τ s the step adds −Σ τ s·(x − τ s/G) − ½ |v − v*|²_M at most to kinetic and elastic energy;
// turn inertia stores nothing.
double InteriorPoint::share_without_gain(System& system) {
  double given = 0, taken = 0;  // s·(J v* + b) and ½ |v − v*|²_M + sᵀ G⁻¹ s
  for (const Joint& j : system.joints) {
    const Rows x = x_of(system, j);
    for (unsigned i = 0; i < 3; ++i) {
      given += j.impulse[i] * x[i];
      if (j.G[i] > 0) taken += j.impulse[i] * j.impulse[i] / j.G[i];
    }
  }
  for (std::size_t k = 0; k < turns_.size(); ++k)
    given += turns_[k].s * turn_rate(system, system.turn_inertias[k]);
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    const double change = twice_kinetic(b, b.v - b.v_free);
    given += change;
    taken += change / 2;
  }
  return given > 0 ? std::min(1.0, given / taken) : 0;
}

void InteriorPoint::finish(System& system, bool reached, Evaluation& at) {
  at = {};
  each([&](std::size_t k, const auto& rows) {
    Joint& j = system.joints[k];
    JointRecord& r = system.records[k];
    j.impulse = best_[k];
    if (r.law.surface != nullptr) {
      const double usage = r.law.surface->usage(j.impulse, r.law.share * r.law.h);
      for (double& s : j.impulse) s /= std::max(1.0, usage);
    } else {
      for (unsigned i = 0; i < 3; ++i) {
        if (!(r.law.after_yield[i] > 0))
          j.impulse[i] = std::clamp(j.impulse[i], -r.law.cap_reverse[i], r.law.cap[i]);
      }
    }
    j.regime = static_cast<std::uint8_t>(rows.regime());
    j.factored_flow = static_cast<std::uint8_t>(flowing(j.regime));
    // What is left to a cap of 0 is no force: a row that goes slack has none.
    for (unsigned i = 0; i < 3 && r.material.slackens != 0; ++i) {
      const double cap = (j.regime >> i & 1u) != 0 ? r.law.cap[i] : r.law.cap_reverse[i];
      if (r.material.may_slacken(i) && flows(j.regime, i) && cap == 0) j.impulse[i] = 0;
    }
    at.flows |= j.regime != 0;
    at.curved |= j.regime == on_surface;
  });
  for (TurnRow& r : turns_) r.s = r.best;
  const auto take = [&] {
    for (std::size_t k = 0; k < impulses_.size(); ++k) impulses_[k] = system.joints[k].impulse;
    balance(system);
  };
  take();
  if (!reached) {
    const double share = share_without_gain(system);
    for (Joint& j : system.joints) {
      for (double& s : j.impulse) s = std::isfinite(s) ? share * s : 0;
      j.regime = on_surface;  // whatever each row gives way by is booked
      j.factored_flow = static_cast<std::uint8_t>(flowing(j.regime));
    }
    for (TurnRow& r : turns_) r.s = std::isfinite(r.s) ? share * r.s : 0;
    at.flows = true;
    take();
  }
  for (std::size_t k = 0; k < turns_.size(); ++k) system.turn_inertias[k].impulse = turns_[k].s;
  for (std::size_t k = 0; k < system.joints.size(); ++k) system.records[k].x = x_of(system, system.joints[k]);
  for (std::size_t i = 0; i < system.free; ++i) {
    const Body& b = system.bodies[i];
    at.see(b);
    at.impulse2 += twice_kinetic(b, b.v - b.v_free);
    at.speed2 += twice_kinetic(b, b.v);
  }
}

}  // namespace ductile::dynamics
