// Values over time, and what one joint can carry, as small drawings between the controls.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "diagram.h"
#include "paint.h"
#include "series.h"

namespace ductile::viewer {

struct Line {
  std::string name;
  ImU32 colour;
  std::function<double(const Frame&)> value;
  const Timeline* run = nullptr;  ///< another than the plot's
};

/// Lines over the time of a run with a mark where it is looked at; the values there, and under the pointer.
/// What a click there asks for: a step.
std::optional<long> plot(const char* title, const Timeline& run, const std::vector<Line>& lines,
                         std::string (*show)(double), ImVec2 size, double ui);

/// N to the right, M up: where the joint yields, its section's own curve, where it has been and where it is.
void plot_limits(const Diagram& diagram, const Timeline& run, std::size_t joint, ImVec2 size, double ui);

/// The section with what is in tension and what in compression where it yields with the present N.
void plot_section(const Diagram& diagram, const JointReading& joint, ImVec2 size, double ui);

}  // namespace ductile::viewer
