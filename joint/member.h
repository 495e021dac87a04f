// One joint of a structure, beside what Box2D keeps of it.
#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "ductile/joint.h"
#include "system.h"

namespace ductile::dynamics {

struct Component;

/// A body as a component that is no more left it: poses in double survive the re-forming of components.
struct KnownPose {
  Pose pose;  // of the centre of mass, in the world
  b2Vec2 local_center{0, 0};
  int freedom = 0;  // of motion: 2, 3 where it turned, too; 0: held
  b2Velocity given{{0, 0}, 0};

  void keep(Tape& tape) {
    tape(pose, local_center.x, local_center.y, freedom, given.v.x, given.v.y, given.w);
  }
};

/// The plastic flow beyond which a joint breaks, m or rad.
struct BreakLimits {
  double rotation = unlimited, elongation = unlimited, compression = unlimited, slip = unlimited;

  /// By what a row may still flow forward, or back where `sense` < 0.
  double left(const PlasticFlow& p, unsigned row, double sense) const {
    if (row == 0) return sense > 0 ? elongation - p.forward[0] : compression - p.back[0];
    return (row == 1 ? slip : rotation) - p.forward[row] - p.back[row];
  }
  /// The largest share of a limit that flow has used.
  double used(const PlasticFlow& p) const {
    const auto share = [](double value, double limit) { return value > 0 ? value / limit : 0; };
    return std::max({share(p.forward[2] + p.back[2], rotation), share(p.forward[0], elongation),
                     share(p.back[0], compression), share(p.forward[1] + p.back[1], slip)});
  }
};

struct Member {
  /// Configuration and state while it is in no component.
  struct Own {
    Joint joint;
    JointRecord record;
    double drift_time = 0;           // of its solver
    std::array<KnownPose, 2> known;  // of its bodies
    bool fresh = true;               // never solved: joint.neutral is from where it is first seen

    void keep(Tape& tape) { tape(joint, record, drift_time, known, fresh); }
  };
  /// What its last events said.
  struct Said {
    bool yielded = false;
    double used = 0;    // capacity_used() of the last flow event
    double energy = 0;  // J dissipated by the last event
  };

  ElasticPlasticJoint* joint = nullptr;
  Structure::Impl* structure = nullptr;
  std::uint32_t id = 0;
  Component* component = nullptr;  // where it is solved, or nullptr while it is in no island
  std::size_t index = 0;           // in component->solver.joints
  Own own;
  Said said;
  BreakLimits limits;
  bool broken = false;
  bool is_here = false;  // in the island that is looked at
  double length = -1;    // of a line without force, before it was first solved
  int break_group = 0;
  int node = 0;
  std::shared_ptr<const YieldSurface> surface;
  std::shared_ptr<const RateLaw> rate;

  void set_state(const JointState& state);
  void belong_to(Component* to) { joint->component_ = component = to; }
  /// Of a piece; nullptr where it is in no island, or is none.
  static Component* component_of(const b2Body& body);
  Joint& data();
  JointRecord& record();
  const Joint& data() const { return const_cast<Member*>(this)->data(); }
  const JointRecord& record() const { return const_cast<Member*>(this)->record(); }
};

}  // namespace ductile::dynamics
