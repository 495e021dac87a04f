// Where a structure is heading, from where it has been: linear prediction of its velocities.
//
// What swings freely or is driven steadily is a sum of few modes, each a geometric sequence from step to
// step:
//   v_next = v + Σ a_k ∇ᵏv   with k = 0 … 6 and ∇ the difference from the step before.
// The a_k are those that would have predicted the last steps best: least squares in the norm of
// kinetic energy, each step counting half as much as the one after it. Of v itself instead of its differences
// the normal equations would be singular to rounding. Polynomials (all a_k = 1) miss what swings by its (ωh)
// to the power of their order, and a solve that starts there needs more rounds, or a factor, than this costs.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "pool.h"
#include "vec3.h"

namespace ductile::dynamics {

class LinearPrediction {
 public:
  /// For bodies of these masses (m, m, I). Allocates.
  void form(std::span<const Vec3> masses);
  /// What comes does not go on from what was.
  void forget() { known_ = 0; }
  /// Whether any solution is known since forget().
  bool known() const { return known_ > 0; }
  /// Where to write the newest velocities, in place of the oldest; then fit(), then next().
  std::span<Vec3> newest();
  void fit();
  /// Of all bodies.
  void next(std::span<Vec3> to) const;
  void keep(Tape& tape) {
    tape(newest_, known_, past_, share_, samples_, gram_);
    if (newest_ < 0 || newest_ >= terms || known_ < 0 || known_ > most_known)
      tape.refuse(), newest_ = known_ = 0;
  }

 private:
  /// With 5, a step of a swaying frame of 2000 joints costs a fifth more.
  static constexpr int terms = 7;
  static constexpr int most_known = terms + 2;
  static constexpr std::size_t sampled = 4;  // bodies, or a tenth of them, determine the few a_k as all would
  struct Sample {
    std::size_t body;
    Vec3 mass;
    double x[terms + 1], y[terms + 1], w[terms + 1];  // ∇ᵏ of its newest velocity
    void keep(Tape& tape) { tape(x, y, w); }
  };

  bool solve(int n, double (&a)[terms]) const;

  std::array<Vector<Vec3>, terms> past_;  // a ring
  std::array<double, terms> share_{};     // of each in what comes next
  int newest_ = 0;
  int known_ = 0;  // solutions since the last forget(), as far as it matters
  Vector<Sample> samples_;
  double gram_[terms][terms + 1] = {};  // the normal equations; the column after them is their right side
};

}  // namespace ductile::dynamics
