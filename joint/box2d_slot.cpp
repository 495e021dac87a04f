// Living inside Box2D: how a joint of ours lives in a slot that b2World made for a weld. Written against
// Box2D 2.4.1.

#include <new>
#include <vector>

#include "blocks.h"
#include "box2d_private.h"
#include "reveal.h"
#include "structure.h"

namespace ductile::dynamics {
DUCTILE_REVEAL(b2Body, m_prev, b2Body*);
DUCTILE_REVEAL(b2Body, m_next, b2Body*);
}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

// The world's lists point at the weld that b2World made; a copy of it carries the links, so a derived object
// put in its place is, for the world, the same joint.
ElasticPlasticJoint* ElasticPlasticJoint::put_in_place(b2WeldJoint* weld, Member* member) {
  // 272 and 304 of 320 bytes where pointers have 64 bits, 208 and 220 of 224 where they have 32.
  static_assert(
      block_of(sizeof(ElasticPlasticJoint)) == block_of(sizeof(b2WeldJoint)),
      "a joint needs the block that b2World has for a weld: with these b2_user_settings it does not");
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

// A joint whose structure is gone behaves as the weld that it was.
void ElasticPlasticJoint::InitVelocityConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::InitVelocityConstraints(data);
  // An island that is given no velocity iterations moves without us; what that parts is brought together when
  // next seen.
  Structure::Impl* structure = component_ != nullptr ? component_->structures.front() : member_->structure;
  leads_ = data.step.velocityIterations > 0 && structure->island->enlist(member_, component_);
  // Now, as in the iterations other joints may come first.
  for (b2Body* body : {m_bodyA, m_bodyB})
    structure->reports.stopped += stop_if_not_finite(*body, data) ? 1 : 0;
}

void ElasticPlasticJoint::SolveVelocityConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::SolveVelocityConstraints(data);
  if (leads_) member_->structure->island->velocity(data);
}

bool ElasticPlasticJoint::SolvePositionConstraints(const b2SolverData& data) {
  if (member_ == nullptr) return b2WeldJoint::SolvePositionConstraints(data);
  if (leads_) member_->structure->island->position(data);
  return true;
}

// ~b2World runs no joint destructors, but those of all shapes: a shape of ours in the world learns when it is
// gone. It hangs on a disabled static body, which no query, ray or contact sees, at the end of the list of
// bodies, so that where all are destroyed it goes after their joints.
class WorldWatch : public b2CircleShape {
 public:
  static b2Body* post(b2World& world, Structure::Impl& structure) {
    static_assert(block_of(sizeof(WorldWatch)) == block_of(sizeof(b2CircleShape)),
                  "the watch needs the block that b2World has for a circle");
    b2BodyDef def;
    def.enabled = false;
    b2Body* body = world.CreateBody(&def);
    b2CircleShape circle;
    b2Shape* shape = body->CreateFixture(&circle, 0)->GetShape();
    body->CreateFixture(&circle, 0);  // comes before it in the body's list
    new (shape) WorldWatch(circle, structure);
    put_last(world, *body);
    return body;
  }
  WorldWatch(const b2CircleShape& circle, Structure::Impl& structure)
      : b2CircleShape(circle), structure_(&structure) {}
  WorldWatch(const WorldWatch&) = delete;
  // b2World::DestroyBody() takes fixtures out of the body's list before their shapes go, ~b2World() leaves
  // them.
  ~WorldWatch() override {
    const b2Fixture* first = structure_->watch != nullptr ? structure_->watch->GetFixtureList() : nullptr;
    structure_->watch_is_gone(first != nullptr && first->GetShape() != this && first->GetNext() != nullptr);
  }
  Structure::Impl* structure() const { return structure_; }

 private:
  static void put_last(b2World& world, b2Body& first) {
    b2Body* second = first.GetNext();
    if (second == nullptr) return;
    b2Body* last = second;
    while (last->GetNext() != nullptr) last = last->GetNext();
    of(world, b2World_m_bodyList{}) = second;
    of(*second, b2Body_m_prev{}) = nullptr;
    of(*last, b2Body_m_next{}) = &first;
    of(first, b2Body_m_prev{}) = last;
    of(first, b2Body_m_next{}) = nullptr;
  }

  Structure::Impl* structure_;
};

const WorldWatch* watch_on(const b2Body& body) {
  const b2Fixture* first = body.IsEnabled() ? nullptr : body.GetFixtureList();
  const b2Fixture* second = first != nullptr ? first->GetNext() : nullptr;
  return second != nullptr ? dynamic_cast<const WorldWatch*>(second->GetShape()) : nullptr;
}

bool Structure::is_watch(const b2Body& body) { return watch_on(body) != nullptr; }

b2Body* watch_world(b2World& world, Structure::Impl& structure) { return WorldWatch::post(world, structure); }

std::vector<Structure::Impl*> structures_in(b2World& world) {
  std::vector<Structure::Impl*> found;
  for (const b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext()) {
    if (const WorldWatch* watch = watch_on(*body)) found.push_back(watch->structure());
  }
  return found;
}

}  // namespace ductile
