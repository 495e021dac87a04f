// Draws the scene: pieces, joints by how far they are, hinges, forces, numbers.
#pragma once

#include <optional>
#include <vector>

#include "hand.h"
#include "paint.h"

namespace ductile::viewer {

/// What of the scene is drawn.
struct Look {
  bool forces = false, moments = false, loads = true, names = false;
  bool contrast = false;       ///< few colours that are far apart, and strong outlines
  bool peaks = false;          ///< colours tell the farthest that each joint has been so far, not where it is
  std::optional<Row> diagram;  ///< of what pieces carry between their joints
  double force_scale = 1, moment_scale = 1;
  enum class Numbers { none, selected, all } numbers = Numbers::selected;
  enum class As { value, share } as = As::share;
};

class Canvas {
 public:
  /// `ui`: pixels per pixel of a window at scale 1; `pointed`: the joint under the pointer.
  void draw(ImDrawList& to, const Workbench& bench, const Camera& camera, const Look& look, const Hand& hand,
            double ui, std::optional<std::size_t> pointed);

 private:
  void prepare(const Workbench& bench);
  /// What the colour of a joint tells.
  double shown_stage(std::size_t joint) const;
  ImU32 colour_of(double stage) const;
  void pieces();
  void joints();
  void beside();
  void collapse();
  void diagram();
  void forces();
  void loads();
  void thrown();
  void chosen(std::optional<std::size_t> pointed);
  void numbers();
  void hand(const Hand& hand);
  void legend();

  /// A piece as it is drawn, about its centre of mass.
  struct Skin {
    std::vector<Convex> fills;
    std::vector<Ring> edges;
    bool moves;
    double thickness;                 ///< m: twice its area over its perimeter, of a strip its height
    std::vector<std::size_t> joints;  ///< that hold it
  };
  int edition_ = -1;
  std::vector<Skin> skins_;
  // What is usual in this plan: a force or moment of that size has the length that scale 1 gives it.
  double usual_force_ = 0, usual_moment_ = 0;

  // Of the frame that is being drawn.
  ImDrawList* to_ = nullptr;
  const Workbench* bench_ = nullptr;
  Camera camera_;
  Look look_;
  double ui_ = 1;
  std::vector<Placed> placed_;
  std::vector<ImVec2> points_;
};

}  // namespace ductile::viewer
