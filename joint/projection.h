// Pushes that are not the structure's own (contacts, continuous collision, SetTransform) spread through it:
// the poses x that are nearest to where bodies were pushed, and strain no row by it.
//
//   least ½|x − goal|²_M with the gaps of all rows that hold kept, and no line longer than it is
//
// by Gauss–Newton on ½|x − goal|²_M + ½ Σ G (gap − kept)² with the holding factor of H: what holds is as
// stiff as κ allows, what flows is left out.
#pragma once

#include <span>

#include "hessian.h"
#include "objective.h"
#include "pool.h"

namespace ductile::dynamics {

class Projection {
 public:
  void form(const System& system);
  /// Moves the bodies toward `goal`. With `try_goal` the goal itself is tried first: right where all of it
  /// may have been moved alike. False where gaps could not be kept: then the bodies stay where they were
  /// pushed to. `last` and h are those of the last solve.
  bool project(System& system, Hessian& hessian, const Evaluation& last, double h, std::span<const Pose> goal,
               bool try_goal);

 private:
  struct Work {
    System& system;
    Hessian& hessian;
    std::span<const Pose> goal;
    double rounding;  // of poses, m
    double enough;    // |d|²_M of a step that need not be taken any more
  };
  double pull(const System& system, std::span<const Pose> goal);
  double strain(System& system);
  double correction(const System& system, const Hessian& hessian, std::span<Vec3> d, double enough = 0);
  double let_go(Work& work);
  bool push_far(Work& work);
  bool close_gaps(Work& work);
  double largest_turn(const System& system) const;
  void displace_all(System& system, double t) const;
  bool draws_taut(System& system) const;
  void take_neutral(System& system, bool kept, double trifle, double rounding) const;

  Vector<Vec3> g_, d_, z_;
  Vector<Pose> poses_;  // where a step begins
  Vector<Pose> start_;
  Vector<Rows> kept_;  // gaps
};

}  // namespace ductile::dynamics
