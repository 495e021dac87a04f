// One run of a plan that can be looked at, rewound and played with.
//
// Every step is kept as a Frame, the oldest forgotten where memory is short. A step that is not kept, or that
// a user wants to go on from differently, is simulated again from the start with the same acts: the same
// input gives the same bits, so what is seen the second time is what was seen the first time.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "frame.h"

namespace ductile::viewer {

/// What a user does to a running scene.
namespace act {
/// Takes hold of a body, which then follows pulls as b2MouseJoint makes it.
struct Grab {
  int piece = -1, thrown = -1;  ///< the one that is not −1
  Point at;                     ///< m, world
  double strength = 1000;       ///< greatest force over mass, m/s²
};
struct Pull {
  Point to;  ///< m, world
};
struct Release {};
/// A new body.
struct Throw {
  Point at, velocity;  ///< m, m/s
  double mass = 1000;  ///< kg
  double size = 2;     ///< m: diameter of a disc, side of a square
  bool square = false;
  double flat = 1;  ///< height over width of a square
};
/// A new vehicle: a box on two driven wheels, which is to get to the right as far as `to`.
struct Vehicle {
  Point at;            ///< m: on the ground below its middle
  double mass = 5000;  ///< kg, of which each wheel has a tenth
  double size = 2;     ///< m: from wheel to wheel
  double speed = 5;    ///< m/s
  double to = 0;       ///< m, x: beyond `at`
  double lowest = 0;   ///< m, y: of its road as drawn
};
/// Its box, then its wheels.
std::array<Throw, 3> parts(const Vehicle& vehicle);
/// The motors of the wheels that have one: 1 as planned, −1 the other way, 0 stops.
struct Drive {
  int direction = 0;
};
struct Set {
  Stepping stepping;
};
}  // namespace act
using Act = std::variant<act::Grab, act::Pull, act::Release, act::Throw, act::Vehicle, act::Drive, act::Set>;

struct TimelineEvent {
  long step = 0;
  SceneEvent event;
};

class Timeline {
 public:
  /// An act after step `step`.
  struct Entry {
    long step;
    Act act;
  };

  /// Throws InvalidInput on what Box2D cannot hold. `acts` are done again when their step is reached.
  explicit Timeline(Plan plan, JointSolver solver = JointSolver::direct, std::vector<Entry> acts = {},
                    std::size_t memory = std::size_t{256} << 20);

  const Plan& plan() const { return simulation_->plan(); }
  /// As it is after the last step that was made, which the cursor need not be at.
  const Simulation& simulation() const { return *simulation_; }
  JointSolver solver() const { return simulation_->solver(); }
  const std::vector<Entry>& acts() const { return acts_; }
  /// How the steps from the cursor on are made.
  Stepping stepping() const;

  // --- what is looked at ---
  long cursor() const { return cursor_; }    ///< step
  long last() const { return last_known_; }  ///< the farthest step seen so far
  const Frame& frame() const { return *kept(cursor_); }
  /// Null where the step is not kept.
  const Frame* kept(long step) const;
  long first_kept() const { return first_kept_; }
  long last_kept() const { return first_kept_ + static_cast<long>(frames_.size()) - 1; }
  /// What was thrown in, in the order of Frame::thrown.
  std::vector<act::Throw> thrown() const;
  /// Yields and breaks of all steps seen so far.
  const std::vector<TimelineEvent>& events() const { return events_; }

  // --- going through time ---
  /// Wants to look at a step ≥ 0, old or new; done at once where it is kept, else by work().
  void seek(long step);
  /// Simulates towards the wanted step for about so many seconds. True when it is reached.
  bool work(double seconds);
  bool busy() const { return cursor_ != goal_ || behind(); }
  /// Of the simulation that work() has to do, the share that is done.
  double progress() const;
  /// All of it at once.
  void go_to(long step);

  // --- playing ---
  /// Does something at the cursor. What was to come after it is forgotten.
  void act(const Act& what);

 private:
  bool behind() const { return simulation_->steps() < last_kept(); }
  void start_again();
  void arrive();
  void keep();
  void apply(const Act& what);
  b2Body& add(const act::Throw& thrown);

  std::unique_ptr<Simulation> simulation_;
  std::size_t events_told_ = 0;  // of simulation_, which tells them again when it starts again
  b2Body* hand_ = nullptr;       // what a grabbed body is held against
  b2Joint* grip_ = nullptr;
  std::vector<b2Body*> thrown_;
  std::vector<Entry> acts_;  // by step
  std::deque<Frame> frames_;
  std::size_t memory_, used_ = 0;
  std::vector<TimelineEvent> events_;
  long first_kept_ = 0, last_known_ = -1, cursor_ = 0, goal_ = 0;
};

}  // namespace ductile::viewer
