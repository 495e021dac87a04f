// A value of the frames of a run, as what there is to draw of it.
#pragma once

#include <functional>
#include <vector>

#include "timeline.h"

namespace ductile::viewer {

/// What a value did during the time that one column of pixels stands for; NaN where no frame falls into it,
/// or the value does not exist.
struct Column {
  double low, high;
  double first, last;  ///< to be joined to its neighbours
};

/// Of the kept steps, with times from `start` to `end` over the whole width. No peak is lost, however many
/// steps there are.
std::vector<Column> columns(const Timeline& run, const std::function<double(const Frame&)>& value,
                            std::size_t width, double start, double end);

/// The kept step whose time is nearest.
long step_at(const Timeline& run, double time);

}  // namespace ductile::viewer
