// The tools that make things (making.h), moved by pointer or keys: a cursor that snaps to nodes and to a
// grid, and what a press, a drag and a release do at it. What is dragged is on the bench at every moment, so
// that its check is seen; it is one edit when it is let go.
#pragma once

#include <optional>
#include <string>

#include "making.h"
#include "workbench.h"

namespace ductile::viewer {

class Maker {
 public:
  enum class Tool { none, beam, support, load, move, remove };

  BeamStyle style;
  double force = 100e3;  ///< N, downwards
  double grid = 0.5;     ///< m

  Tool tool() const { return tool_; }
  /// With a tool in the hand the scene stands at its start, and its static check is shown.
  void choose(Workbench& bench, Tool tool);

  /// m: where the next thing is done.
  Point cursor() const { return cursor_; }
  /// Where the beam that is being drawn, or the node that is being moved, was.
  std::optional<Point> start() const { return start_; }

  /// The cursor goes to the node nearest to a point within `reach`, m, or else to the nearest point of the
  /// grid.
  void point(Workbench& bench, Point at, double reach);
  /// It goes on by so many lines of the grid.
  void step(Workbench& bench, int columns, int rows);
  /// It goes to the next node, from left to right, or to the previous.
  void next_node(Workbench& bench, int by);

  /// What is done by a press is done, what is drawn is begun. What cannot be becomes the bench's message.
  void press(Workbench& bench);
  void release(Workbench& bench);
  /// What is being drawn is given up.
  void cancel(Workbench& bench);

 private:
  void put(Workbench& bench, Point at);
  void draw(Workbench& bench);
  /// Another scene, an undo or a restart has come between: what was being drawn is no more.
  bool interrupted(const Workbench& bench);

  Tool tool_ = Tool::none;
  Point cursor_;
  std::optional<Point> start_;
  SceneDef before_;      // without what is being drawn
  bool drawn_ = false;   // it is on the bench
  int edition_ = 0;      // of the bench, since the press or the last drawing
  std::string problem_;  // why it is not
};

}  // namespace ductile::viewer
