// Where the energy of a world goes: each term integrated on its own, so that what is left over is an error.
#pragma once

#include <box2d/box2d.h>

#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/joint.h"

namespace ductile {

/// Joules. The first three are stored now, the others have flowed since the start.
struct Energy {
  double kinetic = 0;
  double potential = 0;   ///< against where each body began
  double elastic = 0;     ///< of the structure's joints; of soft stock welds that are judged
  double external = 0;    ///< work of loads, of the user's own joints, of moving kinematic bodies, of growing
                          ///< gravity, and of what was changed between steps
  double dissipated = 0;  ///< plastic work of the structure's joints, and what breaking ones set free
  double damping = 0;     ///< of all dampers
  double contacts = 0;    ///< work of contact impulses, and of pushing bodies apart; negative: taken
  double numerical = 0;   ///< what implicit integration took, per row, spring and body
  double clamped = 0;     ///< what Box2D's speed limits took
  double total_error = 0;  ///< stored now + taken − given: + is energy from nowhere
};

/// A force or impulse with its moment about the centre of mass; times a speed it is power or work.
struct Wrench {
  double x = 0, y = 0, moment = 0;
};
/// Of a body at its centre of mass, m/s and rad/s.
struct Speed {
  double x = 0, y = 0, turn = 0;
};

/// Watches a world with at most one structure (direct solver, StructureDef::keep_ledger).
///
/// An impulse P on a body changes its kinetic energy by P·v̄, v̄ the mean of its velocities before and after
/// the step, exactly, however many impulses act. So every source is booked with P·v̄ (contacts by the impulses
/// that Box2D reports, the structure's joints row by row in itself); and where the true work is another one,
/// because a body moves with its velocity after the step, the difference is numerical. What stock joints do
/// besides their springs and motors, above all by correcting positions, is not booked: it is their error; and
/// pulleys, gears and mouse joints exert more than they tell.
class EnergyLedger final : public b2ContactListener {
 public:
  /// Becomes the world's contact listener. What is in the world now is there from the start.
  /// Stock joints are the user's own, and what they do is external work (motors, springs); but of those that
  /// are `judged` only the elastic and viscous work of soft welds is booked: whatever else they do, above all
  /// by correcting positions, is error.
  explicit EnergyLedger(b2World& world, std::span<b2Joint* const> judged = {});

  /// Just before b2World::Step, after the forces were applied: `loads` are those.
  void before_step(double dt, const std::vector<AppliedLoad>& loads);
  /// After Step, before Structure::update(), which puts back what met a piece on its way.
  void after_step(const Structure* structure);
  /// After Structure::update(), or without a structure.
  void after_update(const Structure* structure);

  const Energy& energy() const { return now_; }
  /// Energy that has changed hands so far: what an error is to be small against.
  double turnover() const { return turnover_; }

 private:
  /// A body during a step.
  struct Motion {
    b2Vec2 place{0, 0};  // before
    Speed before;
    Wrench loads;              // N, N m
    Wrench contacts;           // N s, N m s
    bool touched = false;      // by a contact, itself or through the structure
    bool sub_stepped = false;  // continuous collision cut its step
  };
  /// The spring of a soft weld.
  struct Spring {
    double stiffness, damping;  // N m/rad, N m s/rad
    double strain, speed;       // rad, rad/s
  };
  /// A joint as it was before the step.
  struct Hold {
    b2Vec2 arm_a{0, 0}, arm_b{0, 0};  // from the centres of mass to where it acts
    std::optional<Spring> spring;
  };

  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override;

  std::optional<Spring> spring_of(b2Joint& joint) const;
  std::pair<Wrench, Wrench> reaction(b2Joint& joint, const Hold& hold) const;
  bool is_judged(const b2Body& body) const;
  void touch(b2Body& body);
  void account(b2Body& body, const Motion& motion);
  void account(b2Joint& joint);
  double clamped(b2Body& body, const Motion& motion, Speed& after) const;
  double mechanical() const;
  double stored_in_springs() const;

  b2World& world_;
  std::unordered_map<const b2Body*, b2Vec2> origins_;  // where a body's potential energy is 0
  std::unordered_map<const b2Body*, Motion> motions_;
  std::unordered_set<const b2Joint*> judged_;
  std::unordered_map<const b2Joint*, Hold> holds_;
  double dt_ = 0, turnover_ = 0;
  double start_ = 0;  // all there was
  double last_ = 0;   // kinetic and potential after the last step
  Energy sums_;       // of what adds up, without the structure's
  Energy now_;
};

}  // namespace ductile
