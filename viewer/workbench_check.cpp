// What is known of the scene on the bench before it runs: its static check, and how it collapses.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "workbench.h"

namespace ductile::viewer {

void Workbench::check_at_rest(bool on) {
  checks_ = on;
  check();
}

void Workbench::find_collapse() {
  playing = false;
  if (run_->cursor() > 0) restart();
  try {
    collapse_ = limit_analysis(plan());
  } catch (const InvalidInput& error) {
    message = "It has no collapse load: " + error.problems().front().what + ".";
    return;
  }
  if (collapse_->hinges.empty()) {
    message = "No factor on its loads makes it collapse.";
    return collapse_.reset();
  }
  message = fmt::format("It collapses at {:.4g} times its loads, by", collapse_->load_factor);
  constexpr std::size_t most = 6;  // names that a message has room for
  for (std::size_t i = 0; i < std::min(most, collapse_->hinges.size()); ++i) {
    message += (i == 0 ? " " : ", ") + plan().joints[static_cast<std::size_t>(collapse_->hinges[i])].name;
  }
  if (collapse_->hinges.size() > most)
    message += fmt::format(" and {} more", collapse_->hinges.size() - most);
  message += '.';
  try {
    if (const CriticalLoad buckling = critical_load(plan()); buckling.factor < unlimited)
      message += fmt::format(" As an elastic structure it buckles at {:.4g} times.", buckling.factor);
  } catch (const InvalidInput&) {  // what collapses is no mechanism yet may have no stiffness to buckle
  }
}

void Workbench::check() {
  if (collapse_) message.clear();  // it told of that
  collapse_.reset();
  at_rest_.reset();
  verdict_.clear();
  const Frame* start = run_->kept(0);
  if (!checks_ || !start) return;
  try {
    const StaticCheck found = static_check(plan());
    Frame frame = *start;
    for (std::size_t i = 0; i < found.joints.size(); ++i) {
      const StaticJoint& joint = found.joints[i];
      frame.joints[i] = {.N = joint.N, .Q = joint.Q, .M = joint.M, .usage = joint.usage};
    }
    at_rest_ = std::move(frame);
    verdict_ = found.first_to_yield.empty()
                   ? "no factor on its loads makes it yield"
                   : fmt::format("yields at {:.3g} times its loads, first in {}", found.reserve,
                                 plan().joints[static_cast<std::size_t>(found.first_to_yield.front())].name);
    double mass = 0;
    for (const Piece& piece : plan().pieces) mass += piece.mass;
    verdict_ += fmt::format("; {:.4g} kg", mass);
  } catch (const InvalidInput& error) {
    verdict_ = error.problems().front().what;
  }
}

}  // namespace ductile::viewer
