// The shear force that a section passes on, by equilibrium.
//
// Along a beam the normal stresses change by σ' = dσ/dz, and what changes above a level s flows down through
// it: q(s) = ∫ σ' dA above s, and Q = ∫ q ds. Q is greatest under two conditions.
// 1. No level passes on more than flows through it at the shear yield stress, q ≤ c. Between two sides that
// lean
//    by α1 and α2 to d the flow runs along both and turns evenly between them:
//      c = Σ τ_y w (sin α2 − sin α1)/(α2 − α1),   w the width of an interval of the level.
//    A side is never crossed, and a wall of thickness t passes on τ_y t, however it leans.
// 2. σ' grows with s, in proportion to the yield stress where that differs, as it does in a beam that bends:
// no
//    flange carries shear by bending within its own thickness. As σ' = −dq/dx, x the (strength-weighted) area
//    below s, that makes q a concave function of x.
// This is a linear program in q(x). Its dual divides the height into slices, and
//    Q = min Σ Δs c(x̄),   x̄ the mean of x over the slice:
// a polygon of tangents around the first moment S(x), which pays c where it bends. The division is found by
// dynamic programming over the levels of the vertices and some between them. A rectangle passes on τ_y b h,
// any section whose throat is a web t_w wide τ_y h t_w. Not looked into is how parts across d pass the flow
// on sideways.
#include "ductile/shear.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "section_data.h"

namespace ductile {
namespace {

/// Of a level, just above it and just below.
struct Level {
  double s = 0;
  std::array<double, 2> width{};     // Σ f w, N/m
  std::array<double, 2> capacity{};  // c, N/m
  double x = 0;                      // Σ f · area below, N
  double X = 0;                      // ∫ x ds, N m
};
enum : int { above, below };

double mean_cosine(double slope1, double slope2) {
  const double a = std::atan(slope1), b = std::atan(slope2);
  return std::abs(b - a) < 1e-6 ? std::cos((a + b) / 2) : (std::sin(b) - std::sin(a)) / (b - a);
}

class Flow {
 public:
  Flow(std::span<const Region> regions, Point direction) : boundary_(regions), regions_(regions) {
    const auto d = unit<double>(direction);
    for (const Point p : boundary_.local) {
      s_.push_back(p.x * d.x + p.y * d.y);
      w_.push_back(p.y * d.x - p.x * d.y);
    }
    choose_levels();
    for (Level& level : levels_)
      for (const int side : {above, below}) cross(level, side);
  }

  /// Q, N. A gap between levels separates parts that pass on what they can each for itself.
  double capacity() {
    double Q = 0;
    for (std::size_t i = 0; i + 1 < levels_.size(); ++i) {
      const std::size_t begin = i;
      while (i + 1 < levels_.size() && levels_[i].width[above] + levels_[i + 1].width[below] > 0) ++i;
      if (i > begin) Q += of_part(std::span(levels_).subspan(begin, i - begin + 1));
    }
    return Q;
  }

 private:
  /// Those of the vertices, rounding aside, and no strip higher than 1/32 of all; no more than some hundreds.
  void choose_levels() {
    std::vector<double> all = s_;
    std::sort(all.begin(), all.end());
    const double height = all.back() - all.front();
    std::vector<double> kept;
    for (const double s : all)
      if (kept.empty() || s - kept.back() > 1e-12 * height) kept.push_back(s);
    for (double& s : s_) s = *std::prev(std::upper_bound(kept.begin(), kept.end(), s));
    constexpr std::size_t most = 500;
    const std::size_t step = 1 + kept.size() / most;
    for (std::size_t i = 0; i < kept.size(); i += step) {
      if (!levels_.empty() && kept.size() > 2) {
        const double from = levels_.back().s, strip = kept[i] - from;
        const auto parts = static_cast<int>(std::ceil(32 * strip / height));
        for (int k = 1; k < parts; ++k) levels_.push_back({.s = from + strip * k / parts});
      }
      levels_.push_back({.s = kept[i]});
    }
    if (levels_.back().s < kept.back()) levels_.push_back({.s = kept.back()});
  }

  struct Crossing {
    std::size_t region;
    double w, slope;  // dw/ds
  };

  void cross(Level& level, int side) {
    crossings_.clear();
    for (const Boundary::Loop& loop : boundary_.loops) {
      for (std::size_t i = loop.begin; i < loop.end; ++i) {
        const double low = std::min(s_[i], s_[i + 1]), high = std::max(s_[i], s_[i + 1]);
        if (side == above ? low <= level.s && level.s < high : low < level.s && level.s <= high) {
          const double slope = (w_[i + 1] - w_[i]) / (s_[i + 1] - s_[i]);
          const double w = level.s == s_[i]       ? w_[i]  // the same of both edges at a vertex
                           : level.s == s_[i + 1] ? w_[i + 1]
                                                  : w_[i] + (level.s - s_[i]) * slope;
          crossings_.push_back({loop.region, w, slope});
        }
      }
    }
    std::sort(crossings_.begin(), crossings_.end(), [&](const Crossing& a, const Crossing& b) {
      if (a.region != b.region) return a.region < b.region;
      if (a.w != b.w) return a.w < b.w;
      return side == above ? a.slope < b.slope : a.slope > b.slope;
    });
    for (std::size_t i = 0; i + 1 < crossings_.size(); i += 2) {
      const Crossing &left = crossings_[i], &right = crossings_[i + 1];
      const Material& material = regions_[left.region].material;
      const double w = right.w - left.w;
      level.width[side] += w * (material.yield_stress + material.compression()) / 2;
      level.capacity[side] += w * material.shear() * mean_cosine(left.slope, right.slope);
    }
  }

  /// Of levels without a gap between them.
  static double of_part(std::span<Level> part) {
    const std::size_t n = part.size();
    part[0].x = part[0].X = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const Level& a = part[i];
      Level& b = part[i + 1];
      const double ds = b.s - a.s;
      b.x = a.x + ds * (a.width[above] + b.width[below]) / 2;
      b.X = a.X + ds * (a.x + ds * (2 * a.width[above] + b.width[below]) / 6);
    }
    const double A = part.back().x, height = part.back().s - part[0].s;
    const double Y_all = A * height - part.back().X;  // ∫ (A − x) ds
    const auto least = [&](std::size_t k) {
      return k == 0       ? part[0].capacity[above]
             : k == n - 1 ? part[k].capacity[below]
                          : std::min(part[k].capacity[above], part[k].capacity[below]);
    };
    const auto at = [&](double x) {  // c(x)
      std::size_t k = 0;
      for (std::size_t step = std::bit_floor(n - 1); step > 0; step /= 2)
        if (k + step < n - 1 && part[k + step].x <= x) k += step;
      const Level &a = part[k], &b = part[k + 1];
      const double tiny = 1e-12 * A, ds = b.s - a.s;
      if (x - a.x < tiny) return least(k);
      if (b.x - x < tiny) return least(k + 1);
      const double w = a.width[above], growth = (b.width[below] - w) / ds, rest = x - a.x;
      const double u = 2 * rest / (w + std::sqrt(std::max(0.0, w * w + 2 * growth * rest)));
      return a.capacity[above] + (b.capacity[below] - a.capacity[above]) * std::min(u / ds, 1.0);
    };

    // The least sum over the slices up to each level. A slice may reach beyond the section, where x is 0 or
    // A, so that it bends at a level of its choice.
    std::vector<double> sum(n, std::numeric_limits<double>::infinity());
    sum[0] = 0;
    double Q = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < n; ++j) {
      const Level& b = part[j];
      if (j > 0)
        sum[j] = sum[j - 1] + (b.s - part[j - 1].s) * (part[j - 1].capacity[above] + b.capacity[below]) / 2;
      for (std::size_t i = 0; i + 1 < j; ++i) {
        const double ds = b.s - part[i].s;
        sum[j] = std::min(sum[j], sum[i] + ds * at((b.X - part[i].X) / ds));
      }
      for (std::size_t k = 1; k < j && part[k].x * (b.s - part[0].s) <= b.X; ++k)
        sum[j] = std::min(sum[j], b.X / part[k].x * least(k));
      const double Y = Y_all - A * (b.s - part[0].s) + b.X;  // ∫ (A − x) ds above
      for (std::size_t k = n - 1; k-- > j + 1 && (A - part[k].x) * (part.back().s - b.s) <= Y;)
        Q = std::min(Q, sum[j] + Y / (A - part[k].x) * least(k));
    }
    return std::min(Q, sum.back());
  }

  Boundary boundary_;
  std::span<const Region> regions_;
  std::vector<double> s_, w_;  // m, of the vertices: along d, and across
  std::vector<Level> levels_;
  std::vector<Crossing> crossings_;
};

}  // namespace

double shear_capacity(const Section& section, Point d) {
  require_direction(d);
  return Flow(section.regions(), d).capacity();
}

}  // namespace ductile
