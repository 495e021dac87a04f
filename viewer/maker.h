// The tools that make things (making.h), moved by pointer or keys: a cursor that snaps to nodes and to a
// grid, and what a press, a drag and a release do at it. What is dragged is on the bench at every moment, so
// that its check is seen; it is one edit when it is let go.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "making.h"
#include "workbench.h"

namespace ductile::viewer {

class Maker {
 public:
  enum class Tool {
    none,
    beam,
    support,
    load,
    move,
    remove,
    line,
    node,
    choose,
    block,
    cut,
    paste,
    mirror,
    turn
  };

  BeamStyle style;
  LineStyle line;
  BlockStyle block;
  LoadStyle load;
  double stiffness = 1e6;  ///< N/m, of the next springs
  double grid = 0.5;       ///< m
  double turn_by = 90;     ///< degrees, counter-clockwise

  Tool tool() const { return tool_; }
  /// With a tool in the hand the scene stands at its start, and its static check is shown.
  void choose(Workbench& bench, Tool tool);
  /// Another scene has come: nothing of it is chosen.
  void forget() { chosen_.clear(); }

  /// m: where the next thing is done.
  Point cursor() const { return cursor_; }
  /// Where what is being drawn or moved was begun.
  std::optional<Point> start() const { return start_; }

  /// Corners of the polygon that is being drawn, so far.
  const Ring& corners() const { return corners_; }

  /// The cursor goes to the node nearest to a point within `reach`, m, or else to the nearest point of the
  /// grid; with a tool that needs something there, to the nearest beam within `reach` where nothing is at
  /// that point.
  void point(Workbench& bench, Point at, double reach);
  /// It goes on by so many lines of the grid.
  void step(Workbench& bench, int columns, int rows);
  /// It goes to the next node, from left to right, or to the previous.
  void next_node(Workbench& bench, int by);

  /// What is done by a press is done, what is drawn is begun. What cannot be becomes the bench's message.
  void press(Workbench& bench);
  /// What is drawn is done. `add`: what is chosen is chosen beside what was.
  void release(Workbench& bench, bool add = false);
  /// What is being drawn is given up.
  void cancel(Workbench& bench);

  // --- what is chosen, by the tool for that ---
  /// Names of bodies that there are.
  std::vector<std::string> chosen(const Workbench& bench) const;
  /// Keeps a copy for the tool that pastes; false: nothing is chosen.
  bool copy(const Workbench& bench);
  /// The same of what has been read from a file.
  void carry(SceneDef part) { copied_ = std::move(part); }
  bool can_paste() const { return !copied_.bodies.empty(); }
  /// False: nothing is chosen.
  bool remove_chosen(Workbench& bench);
  /// What is chosen becomes an assembly, which is chosen and moved as one from now on; false: it is no two
  /// bodies.
  bool group(Workbench& bench);
  /// Assemblies of which something is chosen are none any more.
  void ungroup(Workbench& bench);

  /// By what the bodies that are chosen can be turned, with the tool that chooses: a grip above the middle of
  /// their box, m.
  struct TurnGrip {
    Point about, at;
  };
  /// `arm`: how far above the box it is, m. Nothing where nothing is chosen.
  std::optional<TurnGrip> turn_grip(const Workbench& bench, double arm) const;
  /// The grip is taken: until release() what is chosen turns as the cursor goes about that point, by
  /// multiples of 5°.
  void take_grip(Workbench& bench, const TurnGrip& grip);
  /// By how much it is being turned, degrees; nothing where it is not.
  std::optional<double> turning() const { return grip_ ? std::optional(turned_by_) : std::nullopt; }

 private:
  void put(Workbench& bench, Point at);
  Point snapped(const Workbench& bench, Point at, double reach) const;
  void begin(Workbench& bench);
  void draw(Workbench& bench);
  void turn(Workbench& bench);
  void let_go();
  /// The scene with what is being drawn as far as the cursor.
  SceneDef drawn(std::vector<std::string>& chosen) const;
  SceneDef without_chosen(SceneDef scene) const;
  void click(Workbench& bench) const;
  void add_corner(Workbench& bench);
  void choose_between(const Workbench& bench, bool add);
  /// Another scene, an undo or a restart has come between: what was being drawn is no more.
  bool interrupted(const Workbench& bench);

  Tool tool_ = Tool::none;
  Point cursor_, aim_;  // where it is, and where it would be if it did not snap
  std::optional<Point> start_;
  Point begun_at_;                // start_, not snapped
  SceneDef before_;               // without what is being drawn
  bool drawn_ = false;            // it is on the bench
  int edition_ = 0;               // of the bench, since the press or the last drawing
  std::string problem_;           // why it is not
  std::optional<TurnGrip> grip_;  // that is held
  double turned_by_ = 0;          // degrees, since it was taken
  Ring corners_;
  std::vector<std::string> chosen_;
  SceneDef copied_;
};

}  // namespace ductile::viewer
