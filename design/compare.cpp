#include "compare.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/clock.h"
#include "ductile/plane.h"

namespace ductile {
namespace {

double time_of_step(Simulation& simulation) {
  return seconds([&] { simulation.step(); });
}

// Where the piece is that was centred on `at`: whatever body carries it.
b2Vec2 place(const Simulation& simulation, std::size_t piece, Point at) {
  const Point centre = simulation.plan().carrier(static_cast<int>(piece)).center;
  return simulation.built().bodies[piece]->GetWorldPoint(to_box2d(at - centre));
}

bool broke(const Simulation& simulation) {
  return std::any_of(simulation.events().begin(), simulation.events().end(),
                     [](const SceneEvent& event) { return event.kind == JointEvent::broke; });
}

}  // namespace

Comparison compare(const Plan& full, JointSolver full_solver, const Plan& lean, JointSolver lean_solver,
                   double seconds, const Stepping& stepping, const std::vector<int>& structure,
                   const std::vector<double>& size, const std::function<void(double)>& progress) {
  Simulation one(full, full_solver, stepping), other(lean, lean_solver, stepping);
  Comparison result;
  std::vector<double> ratios;
  bool whole = true;
  while (one.time() < seconds - stepping.dt / 2) {
    progress(one.time() / seconds);
    const double time = time_of_step(one);
    ratios.push_back(time_of_step(other) / time);
    whole = whole && !broke(one) && !broke(other);
    for (std::size_t i = 0; whole && i < full.pieces.size(); ++i) {
      if (structure[i] < 0) continue;
      const Point at = full.pieces[i].center;
      const b2Vec2 apart = place(one, i, at) - place(other, i, at);
      const double error = static_cast<double>(apart.Length()) / size[static_cast<std::size_t>(structure[i])];
      result.error = std::max(result.error, error);
    }
  }
  if (ratios.empty()) return result;
  std::sort(ratios.begin(), ratios.end());
  const auto n = ratios.size();
  // Of n ratios, each is below the median with probability ½: n/2 ± √n/2 of them.
  const auto above = static_cast<std::size_t>(static_cast<double>(n) / 2 + std::sqrt(static_cast<double>(n)));
  result.time_saved = 1 - ratios[n / 2];
  result.saved_at_least = 1 - ratios[std::min(above, n - 1)];
  return result;
}

}  // namespace ductile
