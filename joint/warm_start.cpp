#include "warm_start.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ductile::dynamics {

namespace {

// ∇ᵏ, k < n, in terms of v now and before: the binomials of k, with alternating signs.
template <std::size_t n>
constexpr auto differences_up_to() {
  std::array<std::array<double, n>, n> d{};
  for (std::size_t k = 0; k < n; ++k) {
    d[k][0] = 1;
    for (std::size_t i = 1; i <= k; ++i) d[k][i] = d[k - 1][i] - d[k - 1][i - 1];
  }
  return d;
}

}  // namespace

void LinearPrediction::form(std::span<const Vec3> masses) {
  for (auto& v : past_) v.assign(masses.size(), {});
  samples_.clear();
  const std::size_t count = std::min(sampled, (masses.size() + 9) / 10);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t body = i * masses.size() / count;
    samples_.push_back({body, masses[body], {}, {}, {}});
  }
  forget();
}

std::span<Vec3> LinearPrediction::newest() {
  newest_ = (newest_ + terms - 1) % terms;
  known_ = std::min(known_ + 1, most_known);
  return past_[z(newest_)];
}

void LinearPrediction::next(std::span<Vec3> to) const {
  // Number by number, whichever of the three it is: two at once.
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const double* past[terms];
  for (std::size_t k = 0; k < terms; ++k) past[k] = reinterpret_cast<const double*>(past_[k].data());
  auto* const all = reinterpret_cast<double*>(to.data());
  for (std::size_t i = 0; i < 3 * to.size(); ++i) {
    double v = 0;
    for (std::size_t k = 0; k < terms; ++k) v += share_[k] * past[k][i];
    all[i] = v;
  }
}

void LinearPrediction::fit() {
  const auto slot = [this](int steps_ago) { return z((newest_ + steps_ago) % terms); };
  const int n = std::min(known_ - 1, terms);  // terms that are known of the solution before the newest,
  const double older = known_ > terms + 1 ? 0.5 : 0;  // and were of the one before that
  for (int i = 0; i < terms; ++i) {
    for (double& sum : gram_[i]) sum = older > 0 ? older * sum : 0;
  }
  for (Sample& s : samples_) {
    const Vec3& v = past_[slot(0)][s.body];
    s.x[terms] = v.x - s.x[0], s.y[terms] = v.y - s.y[0], s.w[terms] = v.w - s.w[0];
    for (int i = 0; i < terms; ++i) {
      const double x = s.mass.x * s.x[i], y = s.mass.y * s.y[i], w = s.mass.w * s.w[i];
      for (int k = i; k <= terms; ++k) gram_[i][k] += x * s.x[k] + y * s.y[k] + w * s.w[k];
    }
    const auto differences = [](double(&d)[terms + 1], double now) {
      for (int k = 0; k < terms; ++k) now -= std::exchange(d[k], now);
    };
    differences(s.x, v.x), differences(s.y, v.y), differences(s.w, v.w);
  }
  double a[terms] = {};
  if (!solve(n, a)) forget();
  // v + Σ a_k ∇ᵏv in terms of v now and before.
  static constexpr auto difference = differences_up_to<z(terms)>();
  share_ = {};
  share_[slot(0)] = 1;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i <= k; ++i) share_[slot(i)] += a[k] * difference[z(k)][z(i)];
  }
}

// L D Lᵀ; a trifle on the diagonal keeps terms out that differ by rounding alone. False where nothing
// moves, or nothing is finite.
bool LinearPrediction::solve(int n, double (&a)[terms]) const {
  double l[terms][terms], inverse[terms], x[terms] = {};
  for (int i = 0; i < n; ++i) {
    double d = gram_[i][i] * (1 + 1e-14), scaled[terms];
    x[i] = gram_[i][terms];
    for (int k = 0; k < i; ++k) {
      scaled[k] = gram_[k][i];
      for (int m = 0; m < k; ++m) scaled[k] -= scaled[m] * l[k][m];
      l[i][k] = scaled[k] * inverse[k];
      d -= scaled[k] * l[i][k];
      x[i] -= l[i][k] * x[k];
    }
    if (!(d > 0)) return false;
    inverse[i] = 1 / d;
  }
  for (int i = n; i-- > 0;) {
    x[i] *= inverse[i];
    for (int k = i + 1; k < n; ++k) x[i] -= l[k][i] * x[k];
  }
  // What was thrown out of a standstill became a huge multiple of what it was, and will not do that again.
  // Where modes can be distinguished, the a_k are of the order of 1.
  const bool sane = std::all_of(x, x + n, [](double value) { return std::abs(value) <= 100; });
  if (sane) std::copy_n(x, n, a);
  return true;
}

}  // namespace ductile::dynamics
