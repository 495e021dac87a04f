// Several bodies at one point: joints from the first, the hub, to each of the others, and what becomes of
// them when the hub goes. And what a structure refuses to join.

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "box2d_private.h"
#include "structure.h"

namespace ductile::dynamics {

namespace {

// In the list of the world's bodies, and not one that came after.
bool lives(const b2World& world, const b2Body* body) {
  for (const b2Body* b = world.GetBodyList(); b != nullptr; b = b->GetNext()) {
    if (b == body) return (of(*b, b2Body_m_flags{}) & in_node) != 0;
  }
  return false;
}

}  // namespace

void mark(b2Body& body) { of(body, b2Body_m_flags{}) |= in_node; }

}  // namespace ductile::dynamics

namespace ductile {

using namespace dynamics;

// Only those whose hub was destroyed: a joint that a game destroyed, or whose own body went, is gone.
void Structure::Impl::join_orphans() {
  if (nodes.orphans.empty()) return;
  std::vector<ElasticPlasticJointDef> left = std::exchange(nodes.orphans, {});
  std::erase_if(left, [&](const auto& o) { return lives(*world, o.bodyA) || !lives(*world, o.bodyB); });
  std::stable_sort(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::size_t hub = i;
    const ElasticPlasticJointDef& to_hub = left[hub];
    for (; i + 1 < left.size() && left[i + 1].node == to_hub.node; ++i) {
      ElasticPlasticJointDef& o = left[i + 1];
      if (o.bodyB == to_hub.bodyB) continue;  // by a second joint of the node
      o.bodyA = to_hub.bodyB;
      o.localAnchorA = to_hub.localAnchorB;
      o.referenceAngle -= to_hub.referenceAngle;
      o.axisAngle -= to_hub.referenceAngle;
      o.userData = {};  // the game may have freed what it pointed to, as it was told that the joint is gone
      for (double& strain : o.state.elastic) strain = 0;
      join(*world, o);
    }
  }
}

const Member* Structure::Impl::member_of(const b2Body& body) {
  for (const b2JointEdge* e = body.GetJointList(); e != nullptr; e = e->next) {
    const auto* joint = ElasticPlasticJoint::cast(e->joint);
    if (joint != nullptr && joint->member_ != nullptr) return joint->member_;
  }
  return nullptr;
}

const Structure::Impl* Structure::Impl::structure_of(const b2Body& body) {
  const Member* member = member_of(body);
  return member != nullptr ? member->structure : nullptr;
}

bool Structure::Impl::is_of_another(const b2Body& body) const {
  if (!is_free(&body)) return false;
  const Impl* owner = structure_of(body);
  return owner != nullptr && owner != this;
}

std::vector<std::string> Structure::Impl::problems(const ElasticPlasticJointDef& d) const {
  std::vector<std::string> all = wrong_in(d);
  if (d.bodyA == nullptr || d.bodyB == nullptr) return all;
  if (world == nullptr) return {"structure: its world is gone; make a new structure"};
  // Without a watch it may be gone unseen, and only an address be left of it.
  if (d.bodyA->GetWorld() != world || d.bodyB->GetWorld() != world) {
    all.emplace_back("structure: bodyA or bodyB is in another world than the structure");
    return all;
  }
  if (d.rate && def.solver == SolverKind::iterative)
    all.emplace_back("structure: a rate law needs the direct solver; leave `rate` out");
  if (world->IsLocked()) all.emplace_back("structure: the world is stepping; create joints between steps");
  for (const b2Body* body : {d.bodyA, d.bodyB}) {
    if (!is_of_another(*body)) continue;
    all.emplace_back(body == d.bodyA
                         ? "structure: bodyA has joints of another structure; create this joint in that one"
                         : "structure: bodyB has joints of another structure; create this joint in that one");
  }
  return all;
}

int Structure::new_node() { return --impl_->nodes.last; }

std::vector<ElasticPlasticJoint*> Structure::pin(const b2Vec2& at, const std::vector<b2Body*>& bodies) {
  ElasticPlasticJointDef like;
  like.rows[rotation] = RowDef::free();
  return pin(at, bodies, like);
}

std::vector<ElasticPlasticJoint*> Structure::pin(const b2Vec2& at, const std::vector<b2Body*>& bodies,
                                                 const ElasticPlasticJointDef& like) {
  if (bodies.size() < 2) throw std::invalid_argument("structure: a node holds two bodies or more together");
  std::vector<ElasticPlasticJointDef> defs;
  std::string wrong;
  const int node = new_node();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i] == nullptr || std::count(bodies.begin(), bodies.end(), bodies[i]) > 1)
      throw std::invalid_argument("structure: body " + std::to_string(i) + " of a node is " +
                                  (bodies[i] == nullptr ? "no body" : "there twice") + "; name each once");
    if (i == 0) continue;
    ElasticPlasticJointDef& def = defs.emplace_back(like);
    const b2Vec2 along = bodies[i]->GetWorldCenter() - at;
    def.Initialize(bodies[0], bodies[i], at,
                   along.LengthSquared() > 0 ? along : bodies[i]->GetWorldVector({1, 0}));
    def.axisFollow = 1;
    def.node = node;
    for (const std::string& problem : impl_->problems(def)) wrong += (wrong.empty() ? "" : "\n") + problem;
  }
  if (!wrong.empty()) throw std::invalid_argument(wrong);
  std::vector<ElasticPlasticJoint*> joints;
  joints.reserve(defs.size());
  for (const ElasticPlasticJointDef& def : defs) joints.push_back(create_joint(def));
  return joints;
}

}  // namespace ductile
