// A run as one HTML page that plays it back: time slider, the colours of the window, numbers on hover. The
// page holds everything and asks for nothing from anywhere.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "ductile/simulation.h"

namespace ductile {

class Replay {
 public:
  /// Keeps at most about `most_values` numbers: from then on every second frame, and so on.
  explicit Replay(const Plan& plan, std::size_t most_values = 20'000'000);

  /// Keeps the simulation as it is now. Call before the first step and after each one.
  void take(const Simulation& simulation);

  /// The page. `simulation` is the one that was taken, for its plan and events.
  std::string page(const std::string& title, const Simulation& simulation) const;

  std::size_t frames() const { return times_.size(); }

 private:
  void thin();

  std::size_t width_;  // numbers of a frame
  std::size_t most_frames_;
  long stride_ = 1, taken_ = 0;
  std::vector<double> times_;
  std::vector<std::vector<float>> frames_;  // [frame][number]: piece channels, then joint channels
};

}  // namespace ductile
