// Runs a plan: a Box2D world with the plan's bodies, joints and loads, stepped and read out.
//
// Signs and meanings of what is read are those of `ductile simulate` (docs): N positive in tension, +M turns
// the second body counter-clockwise against the first and puts the right of the axis in tension. SI units.
#pragma once

#include <box2d/box2d.h>

#include <functional>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/calibrate.h"
#include "ductile/joint.h"
#include "ductile/ledger.h"

namespace ductile {

/// What holds the pieces together.
enum class JointSolver {
  direct,     ///< ductile joints, solved together
  iterative,  ///< ductile joints in the paper's own scheme
  stock,      ///< Box2D's own welds, rigid or soft, which never give way
};

/// How the world is stepped; may be changed between steps.
struct Stepping {
  double dt = 1. / 60;  ///< s
  int velocity_iterations = 8, position_iterations = 3;
};

/// What a joint carries and what it has suffered.
struct JointReading {
  double N = 0, Q = 0, M = 0;  ///< N, N, N m: of the last step; 0 when broken
  struct Usage {
    double N = 0, Q = 0, M = 0;  ///< |value| / cap of its sign; NaN where unlimited, 0 where the row is free
  } usage;
  double plastic_rotation = 0;                  ///< rad, net
  double accumulated_rotation = 0;              ///< rad: Σ|plastic rotation|
  double plastic_axial = 0, plastic_shear = 0;  ///< m, net
  double capacity_used = 0;                     ///< of the maximum that is nearest: it breaks at 1
  bool broken = false;
  double broken_at = std::numeric_limits<double>::quiet_NaN();  ///< s
  double dissipated = 0;                                        ///< J: its plastic work
  double length = std::numeric_limits<double>::quiet_NaN();     ///< m: of a line now; else NaN
  double drive = std::numeric_limits<double>::quiet_NaN();  ///< m or rad: how far a drive has got; else NaN
};

struct PieceReading {
  Point position;    ///< m, centre of mass
  double angle = 0;  ///< rad, turn since the start
  Point velocity;    ///< m/s, of the centre of mass
  double angular_velocity = 0;
};

/// Something that happened to a joint: its yield or its end.
struct SceneEvent {
  double time = 0;  ///< s
  int joint = 0;    ///< index into Plan::joints
  JointEvent::Kind kind = JointEvent::yield;
  JointEvent::Mode mode = JointEvent::rotation;
  double force = 0;   ///< N or N m
  double energy = 0;  ///< J dissipated by the joint so far
};

/// One run of a plan. The world may be played with between steps: bodies and joints added, the ground
/// destroyed; the pieces of the plan stay.
class Simulation {
 public:
  /// Throws InvalidInput on what Box2D cannot hold (pieces that are too small, numbers beyond floats). With
  /// `ledger` one is kept, at a small cost per step (not with iterative joints, which keep no account of
  /// theirs).
  explicit Simulation(Plan plan, JointSolver solver = JointSolver::direct, const Stepping& stepping = {},
                      bool ledger = false);

  Stepping stepping;

  /// One b2World::Step with the loads as they are in its middle; then breaks and events.
  void step();

  const Plan& plan() const { return plan_; }
  JointSolver solver() const { return solver_; }
  double time() const { return time_; }  ///< s
  long steps() const { return steps_; }

  JointReading joint(std::size_t index) const;  ///< by Plan::joints
  PieceReading piece(std::size_t index) const;  ///< by Plan::pieces
  /// Yields and breaks so far.
  const std::vector<SceneEvent>& events() const { return events_; }

  /// µs: median of b2World::Step alone over the steps from the tenth on; NaN before.
  double time_per_step_us() const;
  /// µs: the last b2World::Step alone; 0 before.
  double last_step_us() const { return last_step_us_; }

  /// Null when no ledger is kept.
  const EnergyLedger* ledger() const { return ledger_ ? &*ledger_ : nullptr; }

  b2World& world() { return world_; }
  const Built& built() const { return built_; }                           ///< a joint that is gone is null
  Structure* structure() { return structure_ ? &*structure_ : nullptr; }  ///< null with stock joints

 private:
  /// Forgets joints that go with a body that the user destroys.
  class Goodbye : public b2DestructionListener {
   public:
    explicit Goodbye(Simulation& simulation) : simulation_(simulation) {}
    void SayGoodbye(b2Joint* joint) override;
    void SayGoodbye(b2Fixture*) override {}

   private:
    Simulation& simulation_;
  };

  void record(const JointEvent& event);
  JointReading read_stock(std::size_t index) const;
  double turn_of(int piece) const;  // rad, since the start
  double length_of(std::size_t index) const;

  Plan plan_;
  JointSolver solver_;
  b2World world_;
  Goodbye goodbye_;
  Built built_;
  std::optional<Structure> structure_;
  std::optional<EnergyLedger> ledger_;
  std::unordered_map<const b2Joint*, std::size_t> index_;        // of the joints that are there
  std::unordered_map<std::size_t, JointReading> last_readings_;  // of those that are broken
  std::vector<SceneEvent> events_;
  std::vector<float> step_us_;
  float last_step_us_ = 0;
  double time_ = 0;
  long steps_ = 0;
};

}  // namespace ductile
