// The run of the scene on the bench, and another one of the same beside it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "workbench.h"

namespace ductile::viewer {
namespace {

constexpr double most_owed = 0.1;  // s: what a slow machine does not show in time is shown later, not lost

}  // namespace

void Workbench::set_solver(JointSolver solver) {
  settle();
  const long step = run_->cursor();
  show(plan(), solver, run_->acts());
  run_->seek(step);
}

void Workbench::set_stepping(const Stepping& stepping) { act(act::Set{stepping}); }

void Workbench::act(const Act& what) {
  const bool in_step = beside_ && beside_->cursor() == step_beside();
  run_->act(what);
  if (!beside_) return;
  if (in_step && !std::holds_alternative<act::Set>(what)) {
    beside_->act(what);
  } else {
    start_beside();
  }
}

void Workbench::restart() {
  settle();
  const Stepping stepping = run_->stepping();
  show(plan(), solver(), {{0, act::Set{stepping}}});
}

bool Workbench::seek_first(JointEvent::Kind kind) {
  for (const TimelineEvent& event : run_->events()) {
    if (event.event.kind != kind) continue;
    playing = false;
    run_->seek(event.step);
    return true;
  }
  return false;
}

void Workbench::step_by(long steps) {
  settle();
  playing = false;
  run_->seek(run_->cursor() + steps);
}

void Workbench::tick(double seconds, double budget) {
  using Clock = std::chrono::steady_clock;
  if (playing) settle();
  const auto start = Clock::now();
  const auto left = [&] { return budget - std::chrono::duration<double>(Clock::now() - start).count(); };
  if (run_->work(budget) && playing) {
    const double dt = run_->stepping().dt;
    owed_ = std::min(owed_ + seconds * pace, std::max(most_owed, dt));
    while (playing && owed_ >= dt && left() > 0) {
      owed_ -= dt;
      const std::size_t events = run_->events().size();
      run_->seek(run_->cursor() + 1);
      if (!run_->work(left())) break;
      const auto stops = [this](const TimelineEvent& event) {
        return stop_at == StopAt::yield ||
               (stop_at == StopAt::broke && event.event.kind == JointEvent::broke);
      };
      playing = std::none_of(run_->events().begin() + static_cast<std::ptrdiff_t>(events),
                             run_->events().end(), stops);
    }
  }
  if (beside_) {
    beside_->seek(step_beside());
    beside_->work(budget);
  }
}

void Workbench::run_beside(std::optional<Beside> how) {
  how_beside_ = how;
  beside_.reset();
  if (how) start_beside();
}

long Workbench::step_beside() const {
  return how_beside_->dt > 0 ? std::lround(run_->frame().time / how_beside_->dt) : run_->cursor();
}

void Workbench::start_beside() {
  const double dt = how_beside_->dt;
  std::vector<Timeline::Entry> acts = run_->acts();
  if (dt > 0) {  // each act when it was done, not at its step
    Stepping stepping;
    double time = 0;
    long step = 0;
    for (Timeline::Entry& entry : acts) {
      time += stepping.dt * static_cast<double>(entry.step - std::exchange(step, entry.step));
      entry.step = std::lround(time / dt);
      if (auto* set = std::get_if<act::Set>(&entry.act)) {
        stepping = set->stepping;
        set->stepping.dt = dt;
      }
    }
    Stepping first;
    first.dt = dt;
    acts.insert(acts.begin(), {0, act::Set{first}});
  }
  beside_ = std::make_unique<Timeline>(plan(), how_beside_->solver, std::move(acts));
  beside_->seek(step_beside());
}

std::string Workbench::beside_text() const {
  if (!beside_) return "";
  const Frame &here = run_->frame(), &there = beside_->frame();
  double apart = 0;
  for (std::size_t i = 0; i < here.pieces.size(); ++i)
    apart = std::max(apart, length(here.pieces[i].position - there.pieces[i].position));
  const auto counted = [](const Frame& frame) {
    long yielded = 0, broken = 0;
    for (const JointReading& joint : frame.joints) {
      broken += joint.broken;
      yielded += !joint.broken && joint.dissipated > 0;
    }
    return fmt::format("{} yielded, {} broken", yielded, broken);
  };
  constexpr std::array solvers{"direct", "iterative", "stock"};
  return fmt::format("outlines: {} solver, {:.4g} steps/s, up to {:.3g} m away; {} (here {})",
                     solvers[static_cast<std::size_t>(beside_->solver())], 1 / beside_->stepping().dt, apart,
                     counted(there), counted(here));
}

}  // namespace ductile::viewer
