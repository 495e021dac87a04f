// Axial force and moment together. As the neutral axis s0 moves from one extreme fibre to the other, (N,
// M_ref) runs along the yield curve; since dF/ds0 = −G, the curve's slope is dM_ref/dN = s0 − s_ref.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "section_data.h"

namespace ductile {
namespace {

struct CurvePoint {
  double s;  // neutral axis less reference line = slope of the curve, m
  double N, M;
};

/// One sense of bending, walked from one end of the curve to the other.
class Walk {
 public:
  Walk(double N_scale, double M_scale, double tolerance, std::vector<Interaction>& curve)
      : N_scale_(N_scale), M_scale_(M_scale), tolerance_(tolerance), curve_(curve) {}

  /// Adds the points after a up to b. The curve lies between the chord and the tangents at a and b, so the
  /// height of that triangle bounds its distance from the chord.
  template <class At>
  void refine(const CurvePoint& a, const CurvePoint& b, const At& at, int depth = 0) {
    if (height(a, b) > tolerance_ && depth < 50) {
      const CurvePoint middle = at(a.s + (b.s - a.s) / 2);
      refine(a, middle, at, depth + 1);
      refine(middle, b, at, depth + 1);
    } else {
      curve_.push_back({b.N, b.M});
    }
  }

 private:
  double height(const CurvePoint& a, const CurvePoint& b) const {
    const double N = (b.N - a.N) / N_scale_, M = (b.M - a.M) / M_scale_, chord = std::hypot(N, M);
    const double ka = a.s * N_scale_ / M_scale_, kb = b.s * N_scale_ / M_scale_;
    if (chord == 0 || ka == kb) return 0;
    const double apex = (M - kb * N) / (ka - kb);  // of the tangents, N from a
    return std::abs(apex * M - ka * apex * N) / chord;
  }

  double N_scale_, M_scale_, tolerance_;
  std::vector<Interaction>& curve_;
};

/// Rounding may leave points on a nearly straight run a hair inside; without them the polygon is convex.
void keep_convex(std::vector<Interaction>& curve) {
  const auto turns_left = [](const Interaction& a, const Interaction& b, const Interaction& c) {
    return (b.N - a.N) * (c.M - b.M) - (b.M - a.M) * (c.N - b.N) > 0;
  };
  std::vector<Interaction> kept;
  for (const Interaction& point : curve) {
    while (kept.size() > 1 && !turns_left(kept[kept.size() - 2], kept.back(), point)) kept.pop_back();
    kept.push_back(point);
  }
  while (kept.size() > 3 && !turns_left(kept[kept.size() - 2], kept.back(), kept.front())) kept.pop_back();
  curve = std::move(kept);
}

/// What shear leaves of every normal stress, f √(1 − (Q/Q_max)²), for Tresca and von Mises alike.
double left_by_shear(double Q, double Q_max) {
  const double q = std::min(std::abs(Q) / Q_max, 1.0);
  return std::sqrt((1 - q) * (1 + q));
}

}  // namespace

double Section::moment_at(Point direction, double N, double reference, bool reverse, double Q) const {
  require_direction(direction);
  const double left = left_by_shear(Q, data_->Q);
  if (left == 0) return 0;
  const double full_N = std::clamp(N / left, -data_->Nc, data_->N);
  const DoubleDouble C = data_->asymmetry.sum.A;
  const NeutralAxis axis = data_->neutral_axis(direction, reverse ? C - full_N : full_N - C);
  const auto d = unit<DoubleDouble>(direction);
  const Point o = data_->boundary.origin;
  const DoubleDouble arm = axis.s + (d.x * o.x + d.y * o.y - reference);
  const DoubleDouble rest = first_moment(data_->asymmetry.sum, d, axis.s) + arm * full_N;
  return left * to_double(reverse ? axis.F - rest : axis.F + rest);
}

std::vector<Interaction> Section::interaction(Point direction, double reference, double tolerance,
                                              double Q) const {
  require_direction(direction);
  const auto d = unit<double>(direction);
  const auto dd = unit<DoubleDouble>(direction);
  const Point o = data_->boundary.origin;
  const DoubleDouble s_ref = DoubleDouble(reference) - (dd.x * o.x + dd.y * o.y);
  const bool cancels = data_->neutral_axis(direction, -data_->asymmetry.sum.A).cancels;

  const auto at = [&](double s, double sense) -> CurvePoint {
    const DoubleDouble s0 = s_ref + s;
    DoubleDouble G, F;
    if (cancels) {
      const auto exact = cut<DoubleDouble>(data_->boundary, dd, s0);
      G = exact.difference, F = exact.moment;
    } else {
      const auto quick = cut<double>(data_->boundary, d, to_double(s0));
      G = quick.difference, F = quick.moment;
    }
    const DoubleDouble N = data_->asymmetry.sum.A + G * sense;
    return {s, to_double(N), to_double(F * sense + first_moment(data_->asymmetry.sum, dd, s0) + N * s)};
  };

  // The ends, where all fibres are in tension or in compression, belong to both senses.
  const DoubleDouble h = first_moment(data_->strength.sum, dd, s_ref),
                     g = first_moment(data_->asymmetry.sum, dd, s_ref);
  const auto [lowest, highest] = extent(direction);
  const double first = lowest - reference, last = highest - reference;
  const CurvePoint tension{first, data_->N, to_double(g + h)},
      compression{last, -data_->Nc, to_double(g - h)};
  // The curve is highest and lowest where its slope is zero: at the reference line.
  const double height = at(0, 1).M - at(0, -1).M;
  std::vector<Interaction> curve;
  Walk walk(data_->N + data_->Nc, height, std::clamp(tolerance, 1e-10, 0.1), curve);
  curve.push_back({tension.N, tension.M});
  walk.refine(tension, compression, [&](double s) { return at(s, 1); });
  walk.refine({first, compression.N, compression.M}, {last, tension.N, tension.M},
              [&](double s) { return at(s, -1); });
  curve.pop_back();  // back at the start
  keep_convex(curve);
  const double left = left_by_shear(Q, data_->Q);
  for (Interaction& point : curve) point = {left * point.N, left * point.M};
  return curve;
}

}  // namespace ductile
