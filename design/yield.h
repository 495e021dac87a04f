// When a joint yields: by each row's own cap, or with Plan::interaction within g(N, M)² + (Q/Q_max)² ≤ 1,
// g the gauge of its N–M polygon (joint/yield_surface.h).
#pragma once

#include <array>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

/// 0 in a free row; `reverse`: where the force is negative.
double cap(const PlannedJoint& joint, Row row, bool reverse);
bool is_free(const PlannedJoint& joint, Row row);

class Yield {
 public:
  Yield(const Plan& plan, const PlannedJoint& joint);

  double cap(Row row, bool reverse) const { return ductile::cap(joint_, row, reverse); }
  bool is_free(Row row) const { return ductile::is_free(joint_, row); }

  /// Of one row: |value| / cap of its sign. NaN where unlimited, 0 where free, infinite against a cap of 0.
  double usage(Row row, double value) const;
  /// Of the joint, NaN-free: it yields at 1. Grows in proportion to the forces (N, Q, M).
  double usage(const std::array<double, 3>& force) const;

  /// n·N + m·M ≤ 1 for every facet of the polygon; none where the caps are independent.
  struct Facet {
    double n, m;
  };
  std::vector<Facet> facets;
  const Facet& steepest(double N, double M) const;

  /// What no state within bears more of: the cap, or of N and M the farthest that the polygon reaches, which
  /// is beyond the cap where a normal force helps the moment.
  double reach(Row row, bool reverse) const;

 private:
  const PlannedJoint& joint_;
  AxialMoment most_{}, least_{};  // of the polygon
};

}  // namespace ductile
