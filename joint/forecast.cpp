#include "forecast.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pair.h"

namespace ductile {

void Forecast::form(std::span<const Vec3> masses) {
  for (auto& v : past_) v.assign(masses.size(), {});
  samples_.clear();
  const std::size_t count = std::min(sampled, (masses.size() + 4) / 5);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t body = i * masses.size() / count;
    samples_.push_back({body, masses[body], {}, {}, {}});
  }
  forget();
}

std::span<Vec3> Forecast::newest() {
  newest_ = (newest_ + terms - 1) % terms;
  known_ = std::min(known_ + 1, terms + 2);
  return past_[static_cast<std::size_t>(newest_)];
}

void Forecast::fit() {
  const auto slot = [this](int steps_ago) { return static_cast<std::size_t>((newest_ + steps_ago) % terms); };
  const int n = std::min(known_ - 1, terms);  // terms that are known of the solution before the newest,
  const double older = known_ > terms + 1 ? 0.5 : 0;  // and were of the one before that
  for (auto& row : gram_) {
    for (double& sum : row) sum = older > 0 ? older * sum : 0;
  }
  for (Sample& s : samples_) {
    const Vec3& v = past_[slot(0)][s.body];
    s.x[terms] = v.x - s.x[0], s.y[terms] = v.y - s.y[0], s.w[terms] = v.w - s.w[0];
    for (int i = 0; i < terms; ++i) {
      const double x = s.mass.x * s.x[i], y = s.mass.y * s.y[i], w = s.mass.w * s.w[i];
      for (int k = i / 2 * 2; k <= terms; k += 2)
        add(gram_[i] + k, x * load(s.x + k) + y * load(s.y + k) + w * load(s.w + k));
    }
    const auto differences = [](double(&d)[terms + 1], double now) {
      for (int k = 0; k < terms; ++k) now -= std::exchange(d[k], now);
    };
    differences(s.x, v.x), differences(s.y, v.y), differences(s.w, v.w);
  }
  double a[terms] = {};
  if (!solve(n, a)) forget();
  // v + Σ a_k ∇ᵏv in terms of v now and before: ∇ᵏ has the binomials of k, with alternating signs.
  share_ = {};
  share_[slot(0)] = 1;
  for (int k = 0; k < n; ++k) {
    double binomial = a[k];
    for (int i = 0; i <= k; ++i) {
      share_[slot(i)] += binomial;
      binomial *= -static_cast<double>(k - i) / (i + 1);
    }
  }
}

// L D Lᵀ; a trifle on the diagonal keeps terms out that rounding alone tells apart. False where nothing
// moves, or nothing is finite.
bool Forecast::solve(int n, double (&a)[terms]) const {
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
  // Where modes are told from each other, the a_k are of the order of 1.
  const bool sane = std::all_of(x, x + n, [](double value) { return std::abs(value) <= 100; });
  if (sane) std::copy_n(x, n, a);
  return true;
}

std::size_t Forecast::bytes() const {
  std::size_t sum = samples_.capacity() * sizeof(Sample);
  for (const auto& v : past_) sum += v.capacity() * sizeof(Vec3);
  return sum;
}

}  // namespace ductile
