// Living inside Box2D: how a joint of ours lives in a slot that b2World made for a weld. Written against
// Box2D 2.4.1.

#include <new>
#include <utility>

#include "structure.h"

namespace ductile {

using namespace dynamics;

// The world's lists point at the weld that b2World made; a copy of it carries the links, so a derived object
// put in its place is, for the world, the same joint.
ElasticPlasticJoint* ElasticPlasticJoint::put_in_place(b2WeldJoint* weld, Member* member) {
  static_assert(sizeof(b2WeldJoint) > 256 && sizeof(ElasticPlasticJoint) <= 320,
                "b2World's block for a weld");
  const ElasticPlasticJoint copy(*weld, nullptr);
  auto* joint = new (weld) ElasticPlasticJoint(copy, member);
  joint->m_impulse.SetZero();
  return joint;
}

ElasticPlasticJoint::ElasticPlasticJoint(const b2WeldJoint& weld, Member* member)
    : b2WeldJoint(weld), member_(member) {}

ElasticPlasticJoint::~ElasticPlasticJoint() {
  if (member_ != nullptr) member_->structure->forget(*member_);
}

// A joint whose structure is gone goes on as the weld that it was.
void ElasticPlasticJoint::InitVelocityConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::InitVelocityConstraints(data);
  // An island that is given no velocity iterations moves without us; what that parts is brought together when
  // next seen.
  Structure::Impl* structure = component_ != nullptr ? component_->structure : member_->structure;
  leads_ = data.step.velocityIterations > 0 && structure->enlist(member_, component_);
}

void ElasticPlasticJoint::SolveVelocityConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::SolveVelocityConstraints(data);
  if (leads_) member_->structure->velocity(data);
}

bool ElasticPlasticJoint::SolvePositionConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::SolvePositionConstraints(data);
  if (leads_) member_->structure->position(data);
  return true;
}

// ~b2World runs no joint destructors, but those of all shapes: a shape of ours in the world tells when it is
// gone. It hangs on a disabled static body, which no query, ray or contact sees.
class WorldWatch : public b2CircleShape {
 public:
  static b2Body* post(b2World& world, Structure::Impl& structure) {
    static_assert(sizeof(b2CircleShape) > 16 && sizeof(WorldWatch) <= 32, "b2World's block for a circle");
    b2BodyDef def;
    def.enabled = false;
    b2Body* body = world.CreateBody(&def);
    b2CircleShape circle;
    b2Shape* shape = body->CreateFixture(&circle, 0)->GetShape();
    new (shape) WorldWatch(circle, structure);
    return body;
  }
  WorldWatch(const b2CircleShape& circle, Structure::Impl& structure)
      : b2CircleShape(circle), structure_(&structure) {}
  WorldWatch(const WorldWatch&) = delete;
  ~WorldWatch() override { structure_->world_is_gone(); }
  Structure::Impl* structure() const { return structure_; }

 private:
  Structure::Impl* structure_;
};

b2Body* watch_world(b2World& world, Structure::Impl& structure) { return WorldWatch::post(world, structure); }

std::vector<Structure::Impl*> structures_in(b2World& world) {
  std::vector<Structure::Impl*> found;
  for (b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext()) {
    if (body->IsEnabled() || body->GetFixtureList() == nullptr) continue;
    const b2Shape* shape = body->GetFixtureList()->GetShape();
    if (const auto* watch = dynamic_cast<const WorldWatch*>(shape)) found.push_back(watch->structure());
  }
  return found;
}

}  // namespace ductile
