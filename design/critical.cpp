// The elastic critical load.
#include <algorithm>
#include <cmath>
#include <vector>

#include "ductile/design.h"
#include "ductile/plane.h"
#include "elastic_path.h"

namespace ductile {

std::vector<Motion> shape_of(const Plan& plan, const Equilibrium& statics, const Eigen::VectorXd& x) {
  std::vector<Motion> result(plan.pieces.size());
  double largest = 0;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const int c = statics.column[i];
    if (c < 0) continue;
    const auto s = statics.scale(static_cast<int>(i));
    const Point carried = plan.pieces[i].center - plan.carrier(static_cast<int>(i)).center;
    result[i].turn = s[2] * x[c + 2];
    result[i].along = Point{s[0] * x[c], s[1] * x[c + 1]} + result[i].turn * left(carried);
    largest = std::max(largest, length(result[i].along));
  }
  for (Motion& motion : result)
    if (largest > 0) motion = {(1 / largest) * motion.along, motion.turn / largest};
  return result;
}

CriticalLoad critical_load(const Plan& plan) {
  Equilibrium statics(plan, Between::elastic_bars);
  CriticalLoad result;
  for (const LoadCase& load_case : statics.cases()) {
    const ElasticPath path(plan, statics, load_case);
    if (path.critical() < result.factor) {
      result.factor = path.critical();
      result.mode = shape_of(plan, statics, path.mode());
      result.time = load_case.time;
    }
    if (path.free_motion().size() > 0 && (result.mechanism.empty() || path.critical() == 0))
      result.mechanism = shape_of(plan, statics, path.free_motion());
  }
  return result;
}

}  // namespace ductile
