#include "solver.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace ductile {

namespace {

constexpr std::size_t z(int i) { return static_cast<std::size_t>(i); }

constexpr double over(double n) { return 1 / n; }

Turn turn_of_more(double angle) {
  const double t = angle * angle;
  if (!(t < 4e-3)) return {std::cos(angle), std::sin(angle)};
  return {1 - t * over(2) * (1 - t * over(12) * (1 - t * over(30) * (1 - t * over(56) * (1 - t * over(90))))),
          angle * (1 - t * over(6) * (1 - t * over(20) * (1 - t * over(42) * (1 - t * over(72)))))};
}

// Joints bend little from step to step and in all: a few terms of the series do, to the last bit.
inline Turn turn_of(double angle) {
  const double t = angle * angle;
  if (!(t < 6e-5)) return turn_of_more(angle);
  return {1 - t * over(2) * (1 - t * over(12) * (1 - t * over(30))),
          angle * (1 - t * over(6) * (1 - t * over(20)))};
}

// J v
inline Rows relative_velocity(const SolverJoint& j, const Vec3& a, const Vec3& b) {
  return {
      b.x * j.axis_b.c + b.y * j.axis_b.s - (a.x * j.axis_a.c + a.y * j.axis_a.s) + a.w * j.au + b.w * j.bu,
      b.y * j.axis_b.c - b.x * j.axis_b.s - (a.y * j.axis_a.c - a.x * j.axis_a.s) + a.w * j.av + b.w * j.bv,
      b.w - a.w};
}

// J v + b
inline Rows biased_velocity(const SolverJoint& j, const Vec3& a, const Vec3& b) {
  Rows x = relative_velocity(j, a, b);
  for (unsigned i = 0; i < 3; ++i) x[i] += j.bias[i];
  return x;
}

// g += Jᵀ s
inline void add_transposed(const SolverJoint& j, const Rows& s, Vec3& a, Vec3& b) {
  a -= {s[0] * j.axis_a.c - s[1] * j.axis_a.s, s[0] * j.axis_a.s + s[1] * j.axis_a.c,
        s[2] - (s[0] * j.au + s[1] * j.av)};
  b += {s[0] * j.axis_b.c - s[1] * j.axis_b.s, s[0] * j.axis_b.s + s[1] * j.axis_b.c,
        s[0] * j.bu + s[1] * j.bv + s[2]};
}

inline bool is_elastic(const SolverJoint& j, const Rows& s) {
  const auto within = [&](unsigned i) { return std::abs(s[i]) <= j.elastic_range[i]; };
  return within(0) && within(1) && within(2);
}

// The three rows of one body's share of J, and of what they are multiplied by.
struct JacobianRows {
  Vec3 u, v, w;
};

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

}  // namespace

void Solver::form(std::size_t free_bodies) {
  free_ = free_bodies;
  std::vector<std::pair<int, int>> edges;
  const auto is_free = [&](int body) { return z(body) < free_; };
  for (const SolverJoint& j : joints) {
    if (is_free(j.a) && is_free(j.b)) edges.emplace_back(j.a, j.b);
  }
  ldlt_.analyse(static_cast<int>(free_), edges);
  for (auto* v : {&g_, &d_, &z_}) v->assign(bodies.size(), {});
  poses_.assign(bodies.size(), {});
  start_.assign(bodies.size(), {});
  barrier_.assign(joints.size(), {});
  gaps_.assign(joints.size(), {});
  before.assign(bodies.size(), {});
  turns_.assign(bodies.size(), {});
  touched_.assign(free_, 0);
  factored_ = held_ = false;
  mass_ = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    SolverBody& b = bodies[i];
    mass_ += b.mass;
    b.inverse_mass = 1 / b.mass;
    b.inverse_inertia = b.inertia > 0 ? 1 / b.inertia : 0;
    d_[i] = {b.mass, b.mass, b.inertia};
  }
  forecast_.form({d_.data(), free_});
  for (SolverJoint& j : joints) {
    JointRecord& r = record(j);
    j.block = is_free(j.a) && is_free(j.b) ? ldlt_.slot(std::max(j.a, j.b), std::min(j.a, j.b)) : -1;
    // 1/m_eff = J M⁻¹ Jᵀ with the anchors together
    const auto inverse_mass = [&](int body) { return z(body) < free_ ? bodies[z(body)].inverse_mass : 0; };
    const auto inverse_inertia = [&](int body) {
      return z(body) < free_ ? bodies[z(body)].inverse_inertia : 0;
    };
    const double ma = inverse_mass(j.a), mb = inverse_mass(j.b), ia = inverse_inertia(j.a),
                 ib = inverse_inertia(j.b);
    const Turn in_a = j.axis, in_b = in_a * turn_of(-j.reference);
    const auto cross = [](double x, double y, const Turn& t) { return x * t.s - y * t.c; };
    const auto along = [](double x, double y, const Turn& t) { return x * t.c + y * t.s; };
    const double ca = cross(j.ax, j.ay, in_a), cb = cross(j.bx, j.by, in_b);
    const double la = along(j.ax, j.ay, in_a), lb = along(j.bx, j.by, in_b);
    const Rows inverse_m{ma + mb + ia * ca * ca + ib * cb * cb, ma + mb + ia * la * la + ib * lb * lb,
                         ia + ib};
    for (unsigned i = 0; i < 3; ++i) r.m_eff[i] = inverse_m[i] > 0 ? 1 / inverse_m[i] : 0;
  }
  laws_set_ = false;
}

// J anew; the gap.
Rows Solver::locate(SolverJoint& j) const {
  const Place &a = places[z(j.a)], &b = places[z(j.b)];
  const Turn relative = inverse(a.turn) * b.turn;
  const double bend = b.pose.angle - a.pose.angle - j.reference;
  j.axis_a = j.follow == 0 ? j.axis : j.axis * turn_of(j.follow * bend);
  j.axis_b = j.axis_a * inverse(relative);
  // From anchor to anchor, in A's frame and then along and across the axis.
  const double wx = b.pose.x - a.pose.x, wy = b.pose.y - a.pose.y;
  const double dx = a.turn.c * wx + a.turn.s * wy + relative.c * j.bx - relative.s * j.by - j.ax;
  const double dy = -a.turn.s * wx + a.turn.c * wy + relative.s * j.bx + relative.c * j.by - j.ay;
  const double u = j.axis_a.c * dx + j.axis_a.s * dy;
  const double v = -j.axis_a.s * dx + j.axis_a.c * dy;
  // J of u and v with the frame turning at (1 − follow)·ω_a + follow·ω_b: the entries ±v, ∓u take J at the
  // midpoint of the two anchors, without which a spin with a plastic set gains energy.
  j.au = -(j.ax * j.axis_a.s - j.ay * j.axis_a.c) + (1 - j.follow) * v;
  j.av = -(j.ax * j.axis_a.c + j.ay * j.axis_a.s) - (1 - j.follow) * u;
  j.bu = j.bx * j.axis_b.s - j.by * j.axis_b.c + j.follow * v;
  j.bv = j.bx * j.axis_b.c + j.by * j.axis_b.s - j.follow * u;
  return {u, v, bend};
}

void Solver::locate() {
  biased_ = gaps_found_ = false;
  find_gaps();
}

void Solver::find_gaps() {
  if (std::exchange(gaps_found_, true)) return;
  for (SolverJoint& j : joints) record(j).gap = locate(j);
}

void Solver::set_law(SolverJoint& j) {
  JointRecord& r = record(j);
  RowLaw& law = r.law;
  for (unsigned i = 0; i < 3; ++i) {
    const double limit = rigid_ratio * r.m_eff[i];
    if (!(r.stiffness[i] > 0) || !(limit > 0) || (r.cap[i] <= 0 && r.cap_reverse[i] <= 0)) {
      law.G[i] = j.bias[i] = law.after_yield[i] = law.cap[i] = law.cap_reverse[i] = r.spring[i] =
          r.damping[i] = r.relaxation[i] = 0;
      continue;
    }
    double k = r.stiffness[i], c = 0;
    if (h_ * h_ * k < elastic_ratio * r.m_eff[i]) {
      c = std::min(2 * r.damping_ratio[i] * std::sqrt(k * r.m_eff[i]), (limit - h_ * h_ * k) / h_);
    } else {
      k = (softened_ && r.surface != nullptr ? soft_ratio * r.m_eff[i] : limit) / (h_ * h_);
    }
    const double G = h_ * h_ * k + h_ * c;
    r.spring[i] = k;
    r.damping[i] = c;
    law.G[i] = G;
    r.relaxation[i] = h_ * k / G;
    law.cap[i] = h_ * r.cap[i];
    law.cap_reverse[i] = h_ * r.cap_reverse[i];
    // A slider of modulus H in series with the spring: 1/hardening = 1/k + 1/H. s/G + (s − hF)/(h²H) = x.
    const double after = std::min(r.hardening[i], 0.99 * k), H = after * k / (k - after);
    law.after_yield[i] = h_ * h_ * H / (h_ * h_ * H + G);
  }
  law.surface = r.surface;
  law.h = h_;
  j.G = law.G;
  j.elastic_range = law.elastic_range();
  j.free = law.G[0] == 0 || law.G[1] == 0 || law.G[2] == 0;
}

void Solver::begin(double h) {
  newton_ = false;
  slowed_ = 1;
  if (softened_ && !flows_) softened_ = laws_set_ = false;
  const bool changed = h != h_ || !laws_set_;
  if (changed) factored_ = held_ = false;
  if (h != h_) forecast_.forget();
  laws_set_ = true;
  h_ = h;
  // What turning bodies parted in a step is taken back in as much time, be it in several shorter steps: at
  // once it would be a blow. What these part themselves is taken back at once: it would pile up. Which is
  // which, is known by size alone; all rows wait for the same share of theirs, so that those of parallel
  // joints agree.
  const double share = h < drift_time ? h / drift_time : 1;
  drift_time = std::max(h, drift_time - h);
  const auto parted = [this](const SolverJoint& j) {
    const JointRecord& r = record(j);
    double sum = 0;
    for (unsigned i = 0; i < 3; ++i) {
      const double d = r.gap[i] - j.neutral[i] - elastic(j, r, i);
      if (j.G[i] > 0) sum += r.m_eff[i] * d * d;
    }
    return sum;
  };
  double waits = 0;  // share of what is parted that is not taken back in this step
  if (changed || share < 1 || peculiar_ || !biased_) find_gaps();
  if (share < 1) {
    double late = 0, all = 0;
    for (SolverJoint& j : joints) {
      JointRecord& r = record(j);
      const double now = parted(j);
      late += h < r.law.h ? now : r.late;
      all += now;
      r.late = now;
    }
    waits = (1 - share) * (late < all ? std::sqrt(late / all) : 1);
    for (JointRecord& r : records) r.late *= waits * waits;
  }
  if (!changed && share == 1 && !peculiar_) {
    if (!std::exchange(biased_, false)) {
      for (SolverJoint& j : joints) set_bias(j, record(j).gap, 1 / h_);
    }
    return;
  }
  for (SolverJoint& j : joints) {
    JointRecord& r = record(j);
    Rows strain{};
    if (changed || share < 1 || damped_ || r.surface != nullptr)
      strain = {elastic(j, r, 0), elastic(j, r, 1), elastic(j, r, 2)};
    if (changed) {
      // A rigid row's spring goes with the step, and keeps its force. Where a spring was edited, or a rigid
      // one's masses, it keeps its force if it became stiffer, its strain if softer: no energy comes of it.
      Rows spring = r.spring;
      const double longer = r.law.h > 0 ? h / r.law.h : 1;
      const std::array<bool, 3> was_rigid{is_rigid(r, 0), is_rigid(r, 1), is_rigid(r, 2)};
      set_law(j);
      for (unsigned i = 0; i < 3; ++i) {
        // The same force, but none larger than the step: what was rough in a short one would be a blow.
        j.impulse[i] *= std::min(1.0, longer);
        // What holds nothing any more, as both its bodies are held, forgets its force.
        if (!(r.spring[i] > 0)) j.neutral[i] = r.gap[i], strain[i] = 0;
        if (!(spring[i] > 0 && r.spring[i] > 0)) continue;
        const auto strain_by = [&](double by) {
          j.neutral[i] += strain[i] * (1 - by);
          strain[i] *= by;
          spring[i] /= by;
        };
        if (was_rigid[i] && is_rigid(r, i)) strain_by(longer * longer);
        if (r.spring[i] > spring[i]) strain_by(spring[i] / r.spring[i]);
      }
    }
    for (unsigned i = 0; i < 3; ++i) {
      double e = r.gap[i] - j.neutral[i];
      e -= waits * (e - strain[i]);
      j.bias[i] = r.relaxation[i] * e;
      if (r.damping[i] > 0) {
        // A damper would let what turning bodies part grow from step to step, and the spring store it.
        j.bias[i] = r.relaxation[i] * strain[i] + (e - strain[i]) / h;
      }
    }
    if (damped_ || changed || r.surface != nullptr) r.strain = strain;
  }
  if (changed) {
    damped_ = std::any_of(records.begin(), records.end(), [](const JointRecord& r) {
      return r.damping[0] > 0 || r.damping[1] > 0 || r.damping[2] > 0;
    });
    peculiar_ = damped_ || std::any_of(records.begin(), records.end(),
                                       [](const JointRecord& r) { return r.surface != nullptr; });
  }
}

// Rigid rows of joints with a yield surface keep their energy, and lose stiffness until nothing flows any
// more.
void Solver::soften() {
  softened_ = true;
  factored_ = held_ = false;
  for (SolverJoint& j : joints) {
    JointRecord& r = record(j);
    if (r.surface == nullptr) continue;
    const Rows spring = r.spring;
    set_law(j);
    for (unsigned i = 0; i < 3; ++i) {
      if (!(r.spring[i] < spring[i])) continue;
      const double more = r.strain[i] * (std::sqrt(spring[i] / r.spring[i]) - 1);
      j.neutral[i] -= more;
      j.bias[i] += r.relaxation[i] * more;
      r.strain[i] += more;
    }
  }
}

bool Solver::at_rest() {
  const bool rests = stands_still();
  if (rests) predicted_ = false;  // it will go on from this solution
  return rests;
}

bool Solver::stands_still() {
  if (flows_ || coasting_ || !(speed_ <= 1e-10 * scale_)) return false;
  // What poses do not resolve moves nothing, whatever it asks of stiff rows.
  double farthest = 0;
  for (const Place& p : places) farthest = std::max({farthest, std::abs(p.pose.x), std::abs(p.pose.y)});
  const double last_bits = 2 * std::numeric_limits<double>::epsilon() * farthest;
  if (h_ * h_ * speed_ <= mass_ * last_bits * last_bits) return true;
  // Moving on by h v changes a row's impulse by G J v at most.
  std::fill(g_.begin(), g_.end(), Vec3{});
  for (const SolverJoint& j : joints) {
    Rows s;
    const Rows v = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
    for (unsigned i = 0; i < 3; ++i) s[i] = j.G[i] * v[i];
    add_transposed(j, s, g_[z(j.a)], g_[z(j.b)]);
  }
  return norm_of_gradient() <= rest_tolerance * rest_tolerance * scale_;
}

void Solver::see_speed(const Vec3& v) {
  fastest_ = std::max(fastest_, v.x * v.x + v.y * v.y);
  fastest_turn_ = std::max(fastest_turn_, v.w * v.w);
}

// A body's own part of ∇f; adds up what an evaluation tells of all bodies.
inline Vec3 Solver::own_part(const SolverBody& b) {
  see_speed(b.v);
  const Vec3 given = b.v - b.v_free;
  const Vec3 momentum{b.mass * given.x, b.mass * given.y, b.inertia * given.w};
  scale_ += dot(given, momentum);
  speed_ += b.mass * (b.v.x * b.v.x + b.v.y * b.v.y) + b.inertia * b.v.w * b.v.w;
  return momentum;
}

// ∇f at bodies' v, once `change` has changed it, into g_; returns |∇f|² in the norm of M⁻¹.
template <class Change>
double Solver::evaluate(const Change& change) {
  scale_ = speed_ = fastest_ = fastest_turn_ = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    SolverBody& b = bodies[i];
    change(i, b);
    g_[i] = own_part(b);
  }
  add_impulses();
  return norm_of_gradient();
}

double Solver::evaluate() {
  return evaluate([](std::size_t, SolverBody&) {});
}

// The joints' part of ∇f.
void Solver::add_impulses() {
  changed_ = 0;
  unsigned crossed = 0, any = 0;
  held_ = false;
  for (SolverJoint& j : joints) {
    const Rows x = biased_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
    const auto take = [&](const Rows& s, unsigned piece) {
      add_transposed(j, s, g_[z(j.a)], g_[z(j.b)]);
      j.impulse = s;
      if ((piece | j.piece | j.factored) == 0) return;
      crossed |= (piece ^ j.piece) | (piece & on_surface);
      any |= piece;
      j.piece = static_cast<std::uint8_t>(piece);
      changed_ += std::popcount(flowing(piece) ^ j.factored);
    };
    // Two calls: the one that most joints take keeps all in registers, as no address of `trial` is taken.
    const Rows trial{j.G[0] * x[0], j.G[1] * x[1], j.G[2] * x[2]};
    if (is_elastic(j, trial)) {
      take(trial, 0);
    } else {
      JointRecord& r = record(j);
      const Response beyond = respond(r.law, r.x = x);
      take(beyond.s, beyond.piece);
    }
  }
  crossed_ = crossed != 0;
  flows_ = any != 0;
  curved_ = (any & on_surface) != 0;
}

// At so many times the velocities that bodies have.
void Solver::find_x(double faster) {
  for (SolverJoint& j : joints) {
    if (j.piece != 0) continue;  // known
    const Rows v = relative_velocity(j, bodies[z(j.a)].v, bodies[z(j.b)].v);
    for (unsigned i = 0; i < 3; ++i) record(j).x[i] = faster * v[i] + j.bias[i];
  }
}

Rows Solver::relative(const SolverJoint& j, const Vec3& a, const Vec3& b) {
  return relative_velocity(j, a, b);
}

void Solver::scatter(const SolverJoint& j, const Rows& s) { add_transposed(j, s, g_[z(j.a)], g_[z(j.b)]); }

// |g_|² in the norm of M⁻¹; bodies that do not rotate take no moment.
double Solver::norm_of_gradient() {
  double norm = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    if (bodies[i].inertia == 0) g_[i].w = 0;
    norm += square(bodies[i], g_[i]);
  }
  return norm;
}

double Solver::square(const SolverBody& b, const Vec3& g) {
  return (g.x * g.x + g.y * g.y) * b.inverse_mass + g.w * g.w * b.inverse_inertia;
}

// What the last bits of impulses are in |∇f|².
double Solver::rounding_of_impulses() const {
  double sum = 0;
  for (const SolverJoint& j : joints) {
    const JointRecord& r = record(j);
    for (unsigned i = 0; i < 3; ++i) sum += r.m_eff[i] > 0 ? j.impulse[i] * j.impulse[i] / r.m_eff[i] : 0;
  }
  return 1e-28 * sum;
}

// f at the last evaluation. By Moreau's identity φ(x) = s·x − ½ s²/G in every state of a row.
double Solver::objective() {
  find_x();
  double f = scale_ / 2;
  for (const SolverJoint& j : joints) {
    const Rows& x = record(j).x;
    for (unsigned i = 0; i < 3; ++i) {
      if (j.G[i] > 0) f += j.impulse[i] * (x[i] - j.impulse[i] / (2 * j.G[i]));
    }
  }
  return f;
}

void Solver::factor_tangents() {
  for (SolverJoint& j : joints) {
    JointRecord& r = record(j);
    for (unsigned i = 0; i < 3; ++i) {
      r.slope[i] = tangent(r.law, j.piece, i);
      if (short_step_ && flows(j.piece, i) && j.piece != on_surface)
        r.slope[i] = std::max(r.slope[i], j.impulse[i] / r.x[i]);
    }
    r.slope_nq = r.slope_nm = r.slope_qm = 0;
    if (j.piece == on_surface) {
      const Coupling c = r.law.surface->tangent(j.G, h_, {j.G[0] * r.x[0], j.G[1] * r.x[1], j.G[2] * r.x[2]});
      r.slope = {c.nn, c.qq, c.mm};
      r.slope_nq = c.nq, r.slope_nm = c.nm, r.slope_qm = c.qm;
    }
    j.factored = static_cast<std::uint8_t>(flowing(j.piece));
  }
  factor();
  holding_ = held_ = false;
  newton_ = !short_step_;
  changed_ = 0;
}

// H for project(): whatever holds is as stiff as κ allows, so that a push moves the bodies as one that does
// not give. With their own stiffness in it, rows took up a share of every push, and a block on a beam was
// catapulted.
void Solver::factor_holding() {
  if (held_) return;
  held_ = true;
  bool at_hand = factored_ && (holding_ || changed_ == 0);
  for (SolverJoint& j : joints) {
    JointRecord& r = record(j);
    for (unsigned i = 0; i < 3; ++i) {
      const bool holds = j.G[i] > 0 && !flows(j.piece, i);
      const bool stiffest = is_rigid(r, i) && !softened_;
      const double stiff = !holds ? 0 : stiffest ? j.G[i] : rigid_ratio * r.m_eff[i];
      at_hand &= r.slope[i] == stiff;
      r.slope[i] = stiff;
    }
    r.slope_nq = r.slope_nm = r.slope_qm = 0;
    at_hand &= j.piece != on_surface;
  }
  if (!at_hand) {
    factor();
    holding_ = true;
  }
}

// H = M + Jᵀ diag(slope) J
void Solver::factor() {
  ldlt_.clear();
  for (std::size_t i = 0; i < free_; ++i) {
    const SolverBody& b = bodies[i];
    double* d = ldlt_.diagonal(static_cast<int>(i)).a;
    d[0] = d[4] = b.mass;
    d[8] = b.inertia > 0 ? b.inertia : 1;
  }
  for (const SolverJoint& j : joints) {
    const JointRecord& r = record(j);
    const bool free_a = z(j.a) < free_, free_b = z(j.b) < free_;
    const double turns_a = bodies[z(j.a)].inertia > 0 ? 1 : 0, turns_b = bodies[z(j.b)].inertia > 0 ? 1 : 0;
    const JacobianRows a{{-j.axis_a.c, -j.axis_a.s, turns_a * j.au},
                         {j.axis_a.s, -j.axis_a.c, turns_a * j.av},
                         {0, 0, -turns_a}};
    const JacobianRows b{
        {j.axis_b.c, j.axis_b.s, turns_b * j.bu}, {-j.axis_b.s, j.axis_b.c, turns_b * j.bv}, {0, 0, turns_b}};
    const auto scaled = [&j, &r](const JacobianRows& rows) {
      JacobianRows d{r.slope[0] * rows.u, r.slope[1] * rows.v, r.slope[2] * rows.w};
      if (j.piece == on_surface) {
        d.u += r.slope_nq * rows.v + r.slope_nm * rows.w;
        d.v += r.slope_nq * rows.u + r.slope_qm * rows.w;
        d.w += r.slope_nm * rows.u + r.slope_qm * rows.v;
      }
      return d;
    };
    const JacobianRows da = scaled(a), db = scaled(b);
    if (free_a) add_product(ldlt_.diagonal(j.a), a, da);
    if (free_b) add_product(ldlt_.diagonal(j.b), b, db);
    if (j.block >= 0) add_product(ldlt_.block(j.block), j.a > j.b ? a : b, j.a > j.b ? db : da);
  }
  ldlt_.factor();
  factored_ = true;
}

// Zero of f'(t) = ∇f(v0 + t d)·d, which rises monotonically and is piecewise linear. Called after evaluate()
// at t = 1, with every row's x at t = 0 and 1 and f' at both; leaves bodies' v there. False when they were
// there already.
bool Solver::line_search(double slope0, double slope1) {
  const auto move_to = [this](double t) {
    for (std::size_t i = 0; i < free_; ++i) bodies[i].v += (t - 1) * d_[i];
  };
  double t = slope0 / (slope0 - slope1);
  short_step_ = false;
  if (!crossed_ && std::abs(t - 1) < 0.01) return false;
  if (!crossed_ && t > 0 && t < 1) {
    move_to(t);
    return true;
  }
  find_x();
  double at_rest = 0, curvature = 0;  // f' = at_rest + t·curvature + Σ y s(x0 + t y)
  for (std::size_t i = 0; i < free_; ++i) {
    const SolverBody& b = bodies[i];
    const Vec3 md{b.mass * d_[i].x, b.mass * d_[i].y, b.inertia * d_[i].w};
    at_rest += dot(md, b.v - d_[i] - b.v_free);
    curvature += dot(md, d_[i]);
  }
  double low = slope1 > 0 ? 0 : 1, high = slope1 > 0 ? 1 : std::numeric_limits<double>::infinity();
  if (!(t > low && t < high)) t = 2;
  for (int i = 0; i < 60; ++i) {
    double slope = at_rest + t * curvature, rise = curvature;
    for (const SolverJoint& j : joints) {
      const Rows y = relative_velocity(j, d_[z(j.a)], d_[z(j.b)]);
      const RowLaw& law = record(j).law;
      Rows x = record(j).x;
      for (unsigned r = 0; r < 3; ++r) x[r] += (t - 1) * y[r];
      const auto [s, piece] = respond(law, x);
      for (unsigned r = 0; r < 3; ++r) {
        slope += y[r] * s[r];
        rise += y[r] * y[r] * tangent(law, piece, r);
      }
    }
    if (std::abs(slope) <= 1e-9 * std::abs(slope0)) break;
    (slope < 0 ? low : high) = t;
    const double newton = t - slope / rise;
    // `rise` knows nothing of yield surfaces: now and then the bracket is halved, whatever Newton says.
    const bool halve = i % 4 == 3 && std::isfinite(high);
    if (newton > low && newton < high && !halve) {
      t = newton;
    } else if (std::isinf(high)) {
      t *= 2;
    } else {
      t = (low + high) / 2;
    }
    if (high - low <= 1e-15 * high) break;
  }
  short_step_ = t < 0.1;
  move_to(t);
  return true;
}

// ∇f = M (v − v*) + …, and v is where the last evaluation was.
void Solver::push(std::size_t body, const Vec3& change) {
  SolverBody& b = bodies[body];
  b.v_free += change;
  Vec3& g = g_[body];
  pushed_ -= square(b, g);
  g -= {b.mass * change.x, b.mass * change.y, b.inertia * change.w};
  pushed_ += square(b, g);
  if (touches_ < touched_.size()) touched_[touches_++] = body;
}

bool Solver::solve(SolveReport& report) {
  swept_ = false;
  // The structure's impulses to `tolerance` of themselves, or to what rounding leaves: in a rigid row the
  // velocity's last bits are multiplied by κ.
  constexpr double floor = 2 * rigid_ratio * std::numeric_limits<double>::epsilon();
  const auto target = [this] { return tolerance * tolerance * scale_ + floor * floor * speed_; };
  const bool same_v = std::exchange(gradient_known_, true) && touches_ > 0 && !coasting_;
  coasting_ = false;
  const bool guessed = std::exchange(predicted_, false) && !flows_;
  if (guessed) forecast_.next({z_.data(), free_});
  const auto start = [this, guessed](std::size_t i, SolverBody& b) {
    if (guessed) b.v = z_[i];
    if (b.inverse_inertia == 0) b.v.w = b.v_free.w;  // no joint changes it
  };
  double norm = same_v ? std::max(0.0, left_ + pushed_) : evaluate(start);
  if (!std::isfinite(norm)) {
    // The past, too, knew what is not finite; this step need not.
    for (std::size_t i = 0; i < free_; ++i) bodies[i].v = bodies[i].v_free;
    norm = evaluate();
  }
  if (norm > target() && flows_ && !same_v) {
    // Start from the lower of the last solution and v*.
    const double f_last = objective();
    for (std::size_t i = 0; i < free_; ++i) d_[i] = bodies[i].v, bodies[i].v = bodies[i].v_free;
    norm = evaluate();
    if (objective() > f_last) {
      for (std::size_t i = 0; i < free_; ++i) bodies[i].v = d_[i];
      norm = evaluate();
    }
  }

  // Preconditioned conjugate gradients on f with an exact line search; the preconditioner is the factor at
  // hand. With a fresh factor a round is a Newton step.
  const double round_work = static_cast<double>(ldlt_.solve_work() + 3 * joints.size());
  const double factor_work = static_cast<double>(ldlt_.factor_work() + 3 * joints.size());
  bool conjugate = false;  // d_ continues the last one
  bool searched = false;   // rows changed their state in the last round: its tangent is not this one's
  bool smoothed = false;   // interior_point() was called
  double zg = 0, beta = 0;
  double best = norm;                 // |∇f|² so far
  double first = norm;                // |∇f|² where the factor at hand began
  int round = 0, idle = 0, used = 0;  // rounds, those that gained nothing, those with the factor at hand
  short_step_ = false;
  // A predicted start always takes one round, even within tolerance: that removes the prediction's bias.
  for (; (norm > target() || (guessed && round == 0)) && round < round_bound; ++round) {
    // Rounds that the factor at hand would still need: one per row that changed its state, or by its
    // contraction.
    const double by_rate =
        norm <= shrinks_ * target() ? 1 : std::ceil(std::log(norm / target()) / std::log(shrinks_));
    const double expected = changed_ > 0 ? changed_ + 1.0 : by_rate;
    const bool stale = !newton_ || changed_ > 0 || short_step_;
    // What a row that changed its state asks for is but a guess: rounding may deny conjugate directions.
    const bool in_vain = changed_ > 0 && used > changed_ + 1;
    if (round >= newton_rounds && (flows_ || searched) && !smoothed) {
      // Many rows change their state against each other: find out which, the robust way, and go on from
      // there.
      report.factorisations += interior_point();
      best = norm = evaluate();
      smoothed = true;
      searched = conjugate = false;
    }
    if (round == soften_round && curved_ && !softened_) {
      soften();
      best = norm = evaluate();
    }
    if (!factored_ || holding_ || searched || curved_ ||
        (stale && (in_vain || (expected - 1) * round_work > factor_work))) {
      factor_tangents();
      ++report.factorisations;
      used = 0;
      first = norm;
      conjugate = false;
      shrinks_ = std::pow(shrinks_, 1.1);  // in the hope that the next step's motion calls for less
    }
    ++used;
    double turned = 0;  // gᵀ H⁻¹ of the last g
    if (conjugate) {
      const std::vector<Vec3>& last = beta == 0 ? d_ : z_;
      for (std::size_t i = 0; i < free_; ++i) turned -= dot(g_[i], last[i]);
    }
    if (round == 0 && same_v && norm > 1e4 * left_) {
      // The pushes are all that there is to answer to: a few right-hand sides, and half a solve.
      std::fill_n(z_.begin(), free_, Vec3{});
      for (std::size_t k = 0; k < touches_; ++k) z_[touched_[k]] = -1.0 * g_[touched_[k]];
    } else {
      for (std::size_t i = 0; i < free_; ++i) z_[i] = -1.0 * g_[i];
    }
    const double last_zg = zg;
    zg = ldlt_.forward({z_.data(), free_});  // gᵀ H⁻¹ g
    ldlt_.backward({z_.data(), free_});
    beta = conjugate ? std::max(0.0, (zg - turned) / last_zg) : 0;
    if (beta == 0) {
      std::swap(d_, z_);
    } else {
      for (std::size_t i = 0; i < free_; ++i) d_[i] = z_[i] + beta * d_[i];
    }
    const bool exact = newton_ && beta == 0 && changed_ == 0 && !curved_;
    const double before = norm;
    double slope0 = 0;
    norm = evaluate([&](std::size_t i, SolverBody& b) {
      slope0 += dot(g_[i], d_[i]);
      b.v += d_[i];
    });
    conjugate = true;
    searched = crossed_;
    // A Newton step within one linear piece: this is the solution, as far as rounding allows; and that is not
    // far where the step came from much faster velocities.
    if (exact && !searched && !(norm > target() && norm <= 1e-4 * before)) {
      ++round;
      break;
    }
    if (norm > target()) {
      double slope1 = 0;
      for (std::size_t i = 0; i < free_; ++i) slope1 += dot(g_[i], d_[i]);
      if (line_search(slope0, slope1)) norm = evaluate();
    }
    // Rounding may be worse than `floor` says (what others move is not in speed_, long arms): where round
    // after round gains nothing, this is the minimum. So it is where what is left of joints that press
    // against each other is the last bits of their impulses.
    const bool gains = norm <= 0.999 * best;
    best = std::min(best, norm);
    if (!gains && norm <= rounding_of_impulses()) break;
    idle = !gains && norm <= 1e-10 * scale_ + 1e-8 * speed_ ? idle + 1 : 0;
    if (idle == 5) break;
    if (!newton_ && !searched && first > target())
      shrinks_ = std::clamp(used == 1 ? first / norm : std::pow(first / norm, 1.0 / used), 1.2, 1e17);
  }
  report.rounds += round;
  // Across gaps of 100 km all that H holds is what it gains from rigid rows, and what rounding makes of a
  // turn there is as fast as anything else.
  const bool lost = !std::isfinite(norm) || !(norm <= target() || norm <= 1e-4 * (scale_ + speed_) ||
                                              norm <= 1e4 * rounding_of_impulses());
  if (round == round_bound || lost) {
    report.bound_hit = true;
    coast();
  }
  if (lost) factored_ = held_ = false;
  report.residual = norm > 0 ? tolerance * std::sqrt(norm / target()) : 0;
  left_ = norm;
  pushed_ = 0;
  touches_ = 0;
  return round > 0;
}

void Solver::slow_down(double share) {
  slowed_ = share;
  for (std::size_t i = 0; i < free_; ++i) {
    SolverBody& b = bodies[i];
    b.v_free -= (1 - share) * b.v;
    b.v = share * b.v;
  }
}

// The safe way out of a solve that did not end: the structure exerts nothing for a step. What its gaps do
// meanwhile becomes neutral in advance(), so that no energy is stored or given.
void Solver::coast() {
  drop_impulses();
  coasting_ = true;
}

void Solver::drop_impulses() {
  fastest_ = fastest_turn_ = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    bodies[i].v = bodies[i].v_free;
    see_speed(bodies[i].v);
  }
  for (SolverJoint& j : joints) record(j).x = j.impulse = {};
}

void Solver::advance() {
  gradient_known_ = false;
  pushed_ = 0;
  touches_ = 0;
  if (keeps_ledger) open_ledger();
  if (coasting_) find_gaps();
  // The next begin() asks for the gaps of what is peculiar.
  gaps_found_ = peculiar_ || coasting_;
  predicted_ = !swept_;
  const std::span<Vec3> newest = predicted_ ? forecast_.newest() : std::span<Vec3>{};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (i < newest.size()) newest[i] = bodies[i].v;
    displace(places[i], h_ * bodies[i].v);
  }
  if (predicted_) forecast_.fit();
  const bool books = keeps_ledger || coasting_ || gaps_found_ || slowed_ < 1;
  const double rate = 1 / h_;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    SolverJoint& j = joints[k];
    const Rows gap = locate(j);
    if (books || j.piece != 0 || j.free) book(j, gap);
    set_bias(j, gap, rate);
  }
  biased_ = true;
  coasting_ = false;
}

// What a joint's rows do in a step beyond being strained.
void Solver::book(SolverJoint& j, const Rows& gap) {
  JointRecord& r = record(j);
  for (unsigned i = 0; i < 3; ++i) {
    if (j.G[i] == 0) {
      j.neutral[i] = gap[i];
    } else if (coasting_) {
      j.neutral[i] += gap[i] - r.gap[i];
    }
  }
  if (gaps_found_) r.gap = gap;
  if (coasting_) return;
  const Rows booked = r.dissipated;
  if (j.piece != 0) flow(j, gap);
  if (keeps_ledger) account(j, gaps_[static_cast<std::size_t>(&j - joints.data())], booked);
  if (slowed_ < 1) slow_down(j);
}

// The bodies went less far than was solved for, and so did a spring that has a damper beside it. What other
// rows are strained by, begin() reads from their gaps.
void Solver::slow_down(SolverJoint& j) {
  JointRecord& r = record(j);
  for (unsigned i = 0; i < 3; ++i) {
    if (!(r.damping[i] > 0)) continue;
    const double before = r.strain[i], after = before + slowed_ * (elastic(j, r, i) - before);
    j.impulse[i] = j.G[i] / h_ * after - r.damping[i] * before;
    if (!keeps_ledger) continue;
    ledger.numerical += std::exchange(r.stored[i], r.spring[i] * after * after / 2);
    ledger.numerical -= r.stored[i];
  }
}

// Of the next step, if it is as long: hk/G is 1/h without a damper.
void Solver::set_bias(SolverJoint& j, const Rows& gap, double rate) {
  for (unsigned i = 0; i < 3; ++i) j.bias[i] = rate * (gap[i] - j.neutral[i]);
}

// The phases of breaking 1–3: a row at its cap flows; its new neutral position is the current one less the
// elastic part, in velocities as solved; the plastic offset is incremented.
void Solver::flow(SolverJoint& j, const Rows& gap) {
  JointRecord& r = record(j);
  // On a yield surface single rows may give back, all three together never; but by rounding, at its apex.
  double rate = 0;
  for (unsigned i = 0; i < 3 && j.piece == on_surface; ++i) {
    if (j.G[i] > 0) rate += j.impulse[i] * (r.x[i] - j.impulse[i] / j.G[i]);
  }
  for (unsigned i = 0; i < 3; ++i) {
    if (!flows(j.piece, i) || !(j.G[i] > 0)) continue;
    const double s = j.impulse[i];
    // In velocities: what turning bodies part along their tangents must not count as flow, which would strain
    // what is parallel, and be work.
    const double increment =
        swept_ ? gap[i] - j.neutral[i] - elastic(j, r, i) : slowed_ * h_ * (r.x[i] - s / j.G[i]);
    if (!(increment * r.x[i] > 0) && j.piece != on_surface) continue;
    j.neutral[i] += increment;
    r.plastic[i] += increment;
    (increment > 0 ? r.flowed_forward : r.flowed_back)[i] += std::abs(increment);
    if (rate >= 0) r.dissipated[i] += s / h_ * increment;
    if (r.hardening[i] > 0) {
      // Isotropic: the cap reached is the cap from now on, in both directions.
      const double growth = std::abs(s) / h_ - (s > 0 ? r.cap : r.cap_reverse)[i];
      r.cap[i] += growth;
      r.cap_reverse[i] += growth;
      set_law(j);
    }
  }
}

// The part of a body's velocity that joints do not change.
Vec3 Solver::told_velocity(std::size_t i) const {
  const SolverBody& b = bodies[i];
  if (i >= free_) return b.v;
  return {0, 0, b.inverse_inertia == 0 ? b.v.w : 0};
}

// The part of a row's numerical loss that needs the step's own J: with R = s/h the row takes s·J v̄ from the
// bodies, v̄ the mean of the velocities before and after, which may have been slowed down; implicit Euler
// counts with those after, as solved. Strains before go to gaps_.
void Solver::open_ledger() {
  opened_ = joints;
  if (!coasting_) find_x(1 / slowed_);
  for (std::size_t i = 0; i < bodies.size(); ++i) turns_[i] = places[i].turn;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const SolverJoint& j = joints[k];
    const JointRecord& r = record(j);
    const Rows v0 = relative_velocity(j, before[z(j.a)], before[z(j.b)]);
    for (unsigned i = 0; i < 3; ++i) {
      gaps_[k][i] = r.damping[i] > 0 ? r.strain[i] : r.relaxation[i] > 0 ? j.bias[i] / r.relaxation[i] : 0;
      ledger.numerical -= j.impulse[i] * ((2 - slowed_) * (r.x[i] - j.bias[i]) - v0[i]) / 2;
    }
    const Rows told = relative_velocity(j, told_velocity(z(j.a)), told_velocity(z(j.b)));
    for (unsigned i = 0; i < 3; ++i) ledger.driven += j.impulse[i] * told[i];
  }
}

// Of R h J v, the rest: spring and damper side by side take k e' Δe + c Δe²/h, with e' = e + Δe the strain
// that the force stands for and that ½ k e'² is stored of; the slider takes R (h J v − Δe). Between the steps
// the strain went from the last e' to e: the chord that a turning piece moves along, rounding, pushes, a
// spring that goes with the step.
void Solver::account(SolverJoint& j, const Rows& strain, const Rows& booked) {
  JointRecord& r = record(j);
  for (unsigned i = 0; i < 3; ++i) {
    const double held = r.stored[i];
    r.stored[i] = 0;
    if (!(j.G[i] > 0)) {
      ledger.numerical += held;
      continue;
    }
    const double k = r.spring[i], R = j.impulse[i] / h_;
    const double v = r.x[i] - j.bias[i];
    const bool not_all = flows(j.piece, i) || r.damping[i] > 0;  // of the row's motion is elastic
    const double after = not_all ? elastic(j, r, i) : strain[i] + h_ * v;
    const double change = after - strain[i];
    r.stored[i] = k * after * after / 2;
    ledger.damping += r.damping[i] * change * change / h_;
    ledger.numerical += k * change * change / 2 + held - k * strain[i] * strain[i] / 2;
    if (not_all) ledger.numerical += R * (h_ * v - change) - (r.dissipated[i] - booked[i]);
  }
}

void Solver::close_ledger(std::span<const Vec3> change) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Turn& t = turns_[i];
    d_[i] = {t.c * change[i].x + t.s * change[i].y, t.c * change[i].y - t.s * change[i].x, change[i].w};
  }
  for (const SolverJoint& j : opened_) {
    const Rows v = relative_velocity(j, d_[z(j.a)], d_[z(j.b)]);
    for (unsigned i = 0; i < 3; ++i) ledger.numerical += j.impulse[i] * v[i] / 2;
  }
}

// ½|x − goal|²_M; its gradient into g_.
double Solver::pull(std::span<const Pose> goal) {
  double sum = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    const SolverBody& b = bodies[i];
    const auto& [pose, turn] = places[i];
    const double dx = pose.x - goal[i].x, dy = pose.y - goal[i].y, dw = pose.angle - goal[i].angle;
    g_[i] = {b.mass * (turn.c * dx + turn.s * dy), b.mass * (turn.c * dy - turn.s * dx), b.inertia * dw};
    sum += (b.mass * (dx * dx + dy * dy) + b.inertia * dw * dw) / 2;
  }
  return sum;
}

// ½ Σ G (gap − gaps_)² over the rows that hold; its gradient is added to g_.
double Solver::strain() {
  double sum = 0;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    SolverJoint& j = joints[k];
    const JointRecord& r = record(j);
    const Rows gap = locate(j);
    Rows s;
    for (unsigned i = 0; i < 3; ++i) {
      const double strain = gap[i] - gaps_[k][i];
      s[i] = r.slope[i] * strain;
      sum += s[i] * strain / 2;
    }
    scatter(j, s);
  }
  return sum;
}

// d = −H⁻¹g; |d|²_M. As M ≤ H, that is no more than gᵀH⁻¹g: where this is less than `enough`, d is not
// needed.
double Solver::correction(std::span<Vec3> d, double enough) {
  for (std::size_t i = 0; i < free_; ++i) {
    if (bodies[i].inverse_inertia == 0) g_[i].w = 0;
    d[i] = -1.0 * g_[i];
  }
  if (ldlt_.forward(d.first(free_)) < enough) return 0;
  ldlt_.backward(d.first(free_));
  double size = 0;
  for (std::size_t i = 0; i < free_; ++i) {
    const SolverBody& b = bodies[i];
    size += b.mass * (d[i].x * d[i].x + d[i].y * d[i].y) + b.inertia * d[i].w * d[i].w;
  }
  return size;
}

// Gauss–Newton from poses_. κ multiplies what a step along the tangent misses the gaps by: the sum need not
// fall. What must fall is the step that comes next. A factor of other poses is good as long as it shortens
// that; where it does not, what its J and the present one differ by comes out multiplied by κ.
bool Solver::push_far(std::span<const Pose> goal, double enough) {
  const auto move = [&](double t) {
    for (std::size_t i = 0; i < free_; ++i) {
      put(places[i], poses_[i]);
      displace(places[i], t * d_[i]);
    }
    pull(goal);
    strain();
  };
  move(0);
  double size = correction(d_);
  bool fresh = false;  // d_ is of a factor of its own poses
  for (int round = 0; !(size <= enough); ++round) {
    if (round == 20) return false;
    for (std::size_t i = 0; i < free_; ++i) poses_[i] = places[i].pose;
    const double whole = 1 / largest_turn();
    for (double t = whole;;) {
      move(t);
      double next = correction(z_);
      const bool refactor = next > 0.01 * size;
      if (refactor) {
        factor();
        next = correction(z_);
      }
      if (next <= (1 - t / 2) * size) {
        std::swap(d_, z_);
        size = next;
        fresh = refactor;
        break;
      }
      if (fresh) {
        t /= 2;
        if (t < 0.02 * whole) return false;
      } else {
        move(0);
        factor();
        size = correction(d_);
        fresh = true;
      }
    }
  }
  return true;
}

// Of d_, rad, at least 1: beyond that the tangent says nothing.
double Solver::largest_turn() const {
  double turn = 1;
  for (std::size_t i = 0; i < free_; ++i) turn = std::max(turn, std::abs(d_[i].w));
  return turn;
}

bool Solver::project(std::span<const Pose> goal, bool try_goal) {
  factor_holding();
  double size = 0, distance = 0;  // |d|²_M; |goal|²_M / 2 where nothing is strained
  // It gives way by less than a thousandth: the structure holds it.
  const auto holds = [&] { return (size = correction(d_, 1e-6 * distance)) < 1e-6 * distance; };
  if (!try_goal) {
    distance = pull(goal);
    if (holds()) return true;
  }
  find_gaps();
  gaps_found_ = false;  // bodies will move
  for (std::size_t k = 0; k < joints.size(); ++k) gaps_[k] = records[k].gap;
  for (std::size_t i = free_; i < bodies.size(); ++i) put(places[i], goal[i]);
  double reach = 1;  // farthest coordinate, longest arm
  for (std::size_t i = 0; i < free_; ++i) {
    start_[i] = poses_[i] = places[i].pose;
    reach = std::max({reach, std::abs(poses_[i].x), std::abs(poses_[i].y)});
  }
  for (const SolverJoint& j : joints) {
    for (const double arm : {j.ax, j.ay, j.bx, j.by}) reach = std::max(reach, std::abs(arm));
  }
  const auto pull_and_strain = [&] {
    const double pulled = pull(goal);
    return pulled + strain();
  };
  const double rounding = 32 * std::numeric_limits<double>::epsilon() * reach;
  const auto place_all = [this](std::span<const Pose> at) {
    for (std::size_t i = 0; i < free_; ++i) put(places[i], at[i]);
  };
  bool small = true;
  if (try_goal) {
    // Where all of it was moved alike, the goal itself is the better start. Otherwise, from where nothing is
    // strained, it is a push like any other.
    place_all(goal);
    const double there = pull_and_strain();
    place_all(start_);
    const double pulled = pull(goal), strained = strain();
    small = pulled + strained < there && strained <= rigid_ratio * mass_ * rounding * rounding;
    if (small) distance = pulled;
    if (there <= pulled + strained) {
      place_all(goal);
      pull_and_strain();
    }
    for (std::size_t i = 0; i < free_; ++i) poses_[i] = places[i].pose;
    if (holds()) return true;
  }
  const double enough = 1e-8 * size + rounding * rounding * mass_;
  const auto let_go = [&] {
    std::fill_n(g_.begin(), free_, Vec3{});
    strain();
    return correction(d_);
  };
  const auto displace_all = [&](double t) {
    for (std::size_t i = 0; i < free_; ++i) displace(places[i], t * d_[i]);
  };
  // A small push: let go of what the pull strains, which may be all of it, and of what a step along the
  // tangent misses the gaps by, its square.
  double last = size;
  for (int round = 0; small && (round == 0 || last > enough); ++round) {
    displace_all(1);
    const double next = let_go();
    small = next <= (round == 0 ? last : std::max(enough, 1e-3 * last));
    last = next;
  }
  bool kept = small || push_far(goal, enough);
  // Where the nearest is not found (a joint that turns far under the pull), what keeps the gaps will do, from
  // where the bodies were.
  if (!kept) place_all(start_);
  for (int round = 0; !kept && round < 20; ++round) {
    let_go();
    factor();
    last = let_go();
    const double turn = largest_turn();
    displace_all(1 / turn);
    kept = turn == 1 && last <= enough;
  }
  // What is still open closes in the next step, as fast as that is short, and what strains rows that are
  // parallel stays: neither may be more than rounding, or than a trifle of how the structure moves and is
  // loaded.
  const double trifle = std::min(enough, 1e-14 * h_ * h_ * (speed_ + scale_) + rounding * rounding * mass_);
  if (kept) {
    if (!small) last = let_go();  // of the pull toward the goal, which has left strains of 1/κ of it
    displace_all(1);
    for (double next; last > trifle && (next = let_go()) < 0.1 * last; last = next) displace_all(1);
    kept = std::all_of(places.begin(), places.end(),
                       [](const Place& p) { return std::isfinite(p.pose.x + p.pose.y + p.pose.angle); });
  }
  if (!kept) place_all(goal);
  locate();
  // Rows that flow, and gaps that could not be kept (supports that were moved apart), take their new place as
  // neutral: a push stores no energy.
  for (std::size_t k = 0; k < joints.size(); ++k) {
    SolverJoint& j = joints[k];
    JointRecord& r = record(j);
    for (unsigned i = 0; i < 3; ++i) {
      const bool free = j.G[i] == 0;
      const double change = r.gap[i] - gaps_[k][i];
      const bool closed = kept && r.m_eff[i] * change * change <= trifle + rounding * rounding * r.m_eff[i];
      if (closed && !free && !flows(j.piece, i)) continue;
      j.neutral[i] += change;
      if (!free) r.plastic[i] += change;
    }
  }
  return kept;
}

void Solver::put(Place& p, const Pose& at) {
  if (at.angle != p.pose.angle) p.turn = turn_of(at.angle);
  p.pose = at;
}

void Solver::displace(Place& p, const Vec3& by) {
  p.pose.x += p.turn.c * by.x - p.turn.s * by.y;
  p.pose.y += p.turn.s * by.x + p.turn.c * by.y;
  const double before = p.pose.angle;
  p.pose.angle += by.w;
  if (p.pose.angle == before) return;
  // By what the angle has really grown, so that turn and angle do not drift apart; brought back to length 1.
  const Turn t = p.turn * turn_of(p.pose.angle - before);
  const double length = (3 - t.c * t.c - t.s * t.s) / 2;
  p.turn = {length * t.c, length * t.s};
}

// Spring and damper side by side, in series with the slider: s/h = k e' + c (e' − e)/h, G = h²k + hc.
double Solver::elastic(const SolverJoint& j, const JointRecord& r, unsigned i) {
  return j.G[i] > 0 ? r.law.h * (j.impulse[i] + r.damping[i] * r.strain[i]) / j.G[i] : 0;
}

Rows Solver::force(const SolverJoint& j, const JointRecord& r) {
  const double h = r.law.h;
  if (!(h > 0)) return {};
  return {j.impulse[0] / h, j.impulse[1] / h, j.impulse[2] / h};
}

std::size_t Solver::bytes() const {
  return bodies.capacity() * sizeof(SolverBody) + places.capacity() * sizeof(Place) +
         joints.capacity() * sizeof(SolverJoint) + records.capacity() * sizeof(JointRecord) + ldlt_.bytes() +
         forecast_.bytes() + (g_.capacity() + d_.capacity() + z_.capacity()) * sizeof(Vec3) +
         (poses_.capacity() + start_.capacity()) * sizeof(Pose) + barrier_.capacity() * sizeof(barrier_[0]) +
         gaps_.capacity() * sizeof(Rows);
}

}  // namespace ductile
