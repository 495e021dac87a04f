// Where the energy of a world goes: each term integrated on its own, so that what is left over is an error.
#pragma once

#include <box2d/box2d.h>

#include <array>
#include <unordered_map>
#include <vector>

#include "ductile/box2d.h"
#include "ductile/joint.h"

namespace ductile {

/// Joules. The first three are stored now, the others have flowed since the start.
struct Energy {
  double kinetic = 0, potential = 0, elastic = 0;
  double external =
      0;  ///< work of loads, of a changing gravity, and of the user's own joints (motors, springs)
  double dissipated = 0;   ///< plastic work of the structure's joints
  double damping = 0;      ///< of their dampers
  double contacts = 0;     ///< work of contact impulses, and what contacts' pushes lifted; negative: taken
  double numerical = 0;    ///< what implicit integration took, per row and body
  double clamped = 0;      ///< what Box2D's speed limits took
  double total_error = 0;  ///< stored now + taken − given: + is energy from nowhere
};

/// Watches a world with one structure (direct solver, StructureDef::keep_ledger). For every body the impulses
/// of a step make its change of velocity, so the work of each is the impulse times the mean of the velocities
/// before and after.
class EnergyLedger : public b2ContactListener {
 public:
  /// Becomes the world's contact listener.
  explicit EnergyLedger(b2World& world);

  /// Just before b2World::Step, after the forces were applied: `loads` are those.
  void before_step(double dt, const std::vector<AppliedLoad>& loads);
  /// After Step and Structure::update().
  void after_step(const Structure& structure);

  Energy energy() const;
  /// Energy that has changed hands so far: what an error is to be small against.
  double turnover() const { return turnover_; }

  void PreSolve(b2Contact* contact, const b2Manifold* old) override;
  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override;

 private:
  struct Motion {
    b2Vec2 v{0, 0}, c{0, 0};
    float w = 0;
    bool awake = false;
  };
  struct Push {  // an impulse on b (and its opposite on a) with its arms
    b2Body *a, *b;
    b2Vec2 impulse, arm_a, arm_b;
    float twist;
  };
  double work(const Push& push) const;  // on dynamic bodies
  static double kinetic(const b2Body& body);
  void measure();

  b2World* world_;
  b2Vec2 gravity_{0, 0};
  double dt_ = 0, start_ = 0, potential_at_start_ = 0, turnover_ = 0;
  bool started_ = false;
  std::unordered_map<const b2Body*, Motion> before_;
  std::unordered_map<const b2Contact*, b2WorldManifold> manifolds_;
  std::unordered_map<const b2Contact*, std::array<b2Vec2, 4>> arms_;  // of each point to A and B
  std::vector<Push> contacts_, own_;
  std::vector<b2Joint*> joints_;
  std::vector<Push> joint_arms_;
  Energy sum_;
  JointEnergy joints_energy_;
};

}  // namespace ductile
