// What the pointer does to the scene: selects, drags, throws. As in Box2D's testbed where that has it: a body
// follows the pointer, and with shift a bomb is pulled back and let go.
#pragma once

#include "camera.h"
#include "workbench.h"

namespace ductile::viewer {

class Hand {
 public:
  /// What is thrown next.
  double mass = 1000, size = 1, speed = 20;  ///< kg, m, m/s
  double drive = 5;                          ///< m/s: how fast a vehicle gets across
  /// Greatest force on what is dragged, over its mass, m/s².
  double strength = 1000;

  /// Mass, size and speed that matter to a scene, in round numbers; what the user has changed since the last
  /// time stays where the scene is the same, edited.
  void suit(const Plan& plan, bool edited = false);

  struct Keys {
    bool shift = false, ctrl = false;
  };
  /// The pointer, px. Pressed and let go in one place it selects the joint there (shift: one more), or else
  /// the body; moved, it drags the body there, or, from empty ground or with ctrl, draws a box of joints.
  void press(const Camera& camera, Point px, Keys keys);
  void move(Workbench& bench, const Camera& camera, Point px);
  void release(Workbench& bench, const Camera& camera, Point px);

  /// A disc that comes from the upper left and hits `target`, m.
  void throw_at(Workbench& bench, const Camera& camera, Point target) const;
  /// A square at rest.
  void put(Workbench& bench, Point at) const;

  enum class Doing { nothing, pressing, dragging, boxing, aiming };
  Doing doing() const { return doing_; }
  Point from() const { return from_; }  ///< m: where the button went down
  Point now() const { return now_; }    ///< m
  /// Reach of a pick, px of a window at scale 1.
  static constexpr double reach = 12;
  double ui_scale = 1;

 private:
  struct Throwing {
    double mass, size, speed;
  };
  static Throwing suited(const Plan& plan);

  Throwing suited_{};
  Doing doing_ = Doing::nothing;
  Keys keys_;
  Point from_, now_;
};

}  // namespace ductile::viewer
